//! ASCII of the Engineering Strong-Motion database and of ITACA (DYNA): lines of `KEY: value`, then one acceleration a
//! line.

use super::parsed::{Parsed, Times};
use super::sampling::Sampling;
use super::text::{number, numbered, quote};
use super::{BadLine, Reading, bad, source::of_file};

const LONGEST_HEADER: usize = 200;

/// The key by which these files are known.
const STEP: &str = "SAMPLING_INTERVAL_S";

/// Whether `text` is one of these files.
pub(super) fn is_its(text: &str) -> bool {
    text.lines().take(LONGEST_HEADER).any(|line| value_of(line, STEP).is_some())
}

/// The step from SAMPLING_INTERVAL_S, the unit from UNITS, the number of samples from NDATA.
pub(super) fn parse(text: &str, how: &Reading) -> Result<Parsed, BadLine> {
    let is_key =
        |line: &str| line.split_once(':').is_some_and(|(key, _)| number(key).is_none()) || line.trim().is_empty();
    let header: Vec<_> = numbered(text).take(LONGEST_HEADER).take_while(|(_, line)| is_key(line)).collect();
    let find = |key: &str| header.iter().find_map(|(line, text)| Some((*line, value_of(text, key)?)));
    let needed = |key: &str| find(key).ok_or_else(|| bad(header.len().max(1), format!("{key} is not in the header")));

    let (line, data_type) = find("DATA_TYPE").unwrap_or((1, "ACCELERATION"));
    if !data_type.eq_ignore_ascii_case("ACCELERATION") {
        return Err(bad(line, format!("DATA_TYPE is {}, and accelerations are needed", quote(data_type))));
    }
    let (line, units) = needed("UNITS")?;
    let (unit, unit_from) = of_file(units, how.unit, line)?;
    let (line, _) = needed(STEP)?;
    let dt = Sampling::of(line, header[line - 1].1)?.dt.ok_or_else(|| bad(line, format!("{STEP} is no number")))?;
    let (line, _) = needed("NDATA")?;
    let count = Sampling::of(line, header[line - 1].1)?.npts.ok_or_else(|| bad(line, "NDATA is no whole number"))?;

    let title = ["EVENT_NAME", "EVENT_DATE_YYYYMMDD", "STATION_CODE", "STREAM"].map(find);
    let title = title.into_iter().flatten().map(|(_, value)| value).filter(|value| !value.is_empty());
    let title = title.collect::<Vec<_>>().join(", ");
    let mut parsed = Parsed::new(title, unit, unit_from, Times::Every(dt));
    parsed.read(numbered(text).skip(header.len()), None)?;
    parsed.check_count("NDATA", count, how)?;
    Ok(parsed)
}

/// Value of `key` on `line`.
fn value_of<'a>(line: &'a str, key: &str) -> Option<&'a str> {
    line.trim_start().strip_prefix(key)?.trim_start().strip_prefix(':').map(str::trim)
}
