//! AT2, the acceleration records of PEER: a title, `ACCELERATION TIME SERIES IN UNITS OF G`, NPTS and DT, then the samples.

use super::parsed::{Parsed, published};
use super::sampling::Sampling;
use super::text::numbered;
use super::{BadLine, Reading, bad};

pub(super) fn is_its(text: &str) -> bool {
    header(text).is_some()
}

/// The line of the counts, from 1, the counts, and the title, which is two lines before them.
fn header(text: &str) -> Option<(usize, usize, f64, &str)> {
    const MOST_LINES: usize = 20;
    let lines: Vec<_> = numbered(text).take(MOST_LINES).collect();
    lines.windows(3).find_map(|lines| {
        let [(_, title), (_, unit), (line, counts)] = lines.try_into().ok()?;
        let is_header = states_g(unit) && counts.to_uppercase().contains("NPTS");
        let counts = is_header.then(|| Sampling::of(line, counts, &Reading::default()).ok())??;
        Some((line, counts.npts?, counts.dt?, title))
    })
}

/// NPTS accelerations in g after the header.
pub(super) fn parse(text: &str, how: &Reading) -> Result<Parsed, BadLine> {
    let (line, npts, dt, title) = header(text).ok_or_else(|| bad(1, "the file has no header of an AT2 file"))?;
    published(title.trim(), ("g", line - 1), dt, ("NPTS", npts), (numbered(text).skip(line), None), how)
}

/// Whether `line` says `ACCELERATION TIME SERIES IN UNITS OF G` or `ACCELERATION TIME HISTORY IN UNITS OF G. FILTER ...`.
fn states_g(line: &str) -> bool {
    let upper = line.to_uppercase();
    let unit = upper.split_once("UNITS OF").and_then(|(_, rest)| rest.split_whitespace().next());
    upper.contains("ACCELERATION") && unit.is_some_and(|unit| unit.trim_end_matches(['.', ',', ';']) == "G")
}
