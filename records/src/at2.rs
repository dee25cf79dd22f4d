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

#[cfg(test)]
mod tests {
    use super::*;

    /// The step of 3 samples, as each header variant states it.
    const COUNTS: [(&str, f64); 6] = [
        ("NPTS=     3  DT=  0.0050 SEC,", 0.005),
        ("NPTS= 3 DT= 0.0050000", 0.005),
        ("NPTS=3,DT=.02SEC", 0.02),
        ("3, .5 NPTS, DT", 0.5),
        ("npts=   3, dt=   5.0e-3 sec", 0.005),
        ("\tNPTS =\t3 ,\tDT =\t1D-2\tSEC", 0.01),
    ];

    const TITLE: &str = "San Fernando, 2/9/1971, Pacoima Dam (upper left abut), 164";

    #[test]
    fn every_header_variant_gives_the_same_samples() {
        for (counts, dt) in COUNTS {
            let first = "PEER NGA STRONG MOTION DATABASE RECORD";
            let values = " .1297983E-02\t-.4E-03\n1.2d-03  \n\n \n";
            let text = format!("{first}\n{TITLE}\nACCELERATION TIME SERIES IN UNITS OF G\n{counts}\n{values}");
            let read = |text: &str| crate::parse(text, &Reading::default()).unwrap().0;
            let record = read(&text);
            assert_eq!(read(&format!("a line more\n{text}")), record, "the header may start later");
            assert_eq!(record.title(), TITLE);
            assert_eq!(record.times(), [0.0, dt, 2.0 * dt], "{counts}");
            assert_eq!(record.acceleration(), [0.1297983e-2, -0.4e-3, 1.2e-3], "{counts}");
        }
    }
}
