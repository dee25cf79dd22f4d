//! ASCII of the Engineering Strong-Motion database and of ITACA (DYNA), and of the European Strong-Motion Database before it
//! (ESD): lines of `KEY: value`, then the accelerations.

use super::parsed::{Parsed, published};
use super::sampling::{count, step};
use super::text::{number, numbered, quote, value_of};
use super::{BadLine, Reading, bad};

const LONGEST_HEADER: usize = 200;

/// Names in a header: of the step, by which files are recognised, the number of samples, the unit, and the parts of a title.
type Keys = [&'static str; 7];
const ESM: Keys =
    ["SAMPLING_INTERVAL_S", "NDATA", "UNITS", "EVENT_NAME", "EVENT_DATE_YYYYMMDD", "STATION_CODE", "STREAM"];
const ESD: Keys = [
    "sampling period",
    "number of samples",
    "units",
    "earthquake code",
    "station code",
    "waveform code",
    "orientation",
];

/// Begins the line before each series of ESD: `-> corrected acceleration time histories`.
const SERIES: &str = "->";

pub(super) fn is_its(text: &str) -> bool {
    value_of(numbered(text).take(LONGEST_HEADER).filter(|(_, line)| line.contains(':')), ESM[0]).is_some()
}

pub(super) fn is_esd(text: &str) -> bool {
    numbered(text).take(LONGEST_HEADER).any(|(_, line)| is_series(line)) && value_of(numbered(text), ESD[0]).is_some()
}

fn is_series(line: &str) -> bool {
    line.starts_with(SERIES) && line.contains("acceleration")
}

pub(super) fn parse(text: &str, how: &Reading) -> Result<Parsed, BadLine> {
    let is_key =
        |line: &str| line.split_once(':').is_some_and(|(key, _)| number(key).is_none()) || line.trim().is_empty();
    let header = numbered(text).take(LONGEST_HEADER).take_while(|(_, line)| is_key(line)).count();
    let (line, data_type) = value_of(numbered(text).take(header), "DATA_TYPE").unwrap_or((1, "ACCELERATION"));
    if !data_type.eq_ignore_ascii_case("ACCELERATION") {
        return Err(bad(line, format!("DATA_TYPE is {}, and accelerations are needed", quote(data_type))));
    }
    samples(text, how, ESM, header)
}

/// The first series of ESD.
pub(super) fn esd(text: &str, how: &Reading) -> Result<Parsed, BadLine> {
    samples(text, how, ESD, numbered(text).take_while(|(_, line)| !is_series(line)).count() + 1)
}

/// The samples after so many lines of a header, which states step, number and unit.
fn samples(text: &str, how: &Reading, keys: Keys, header: usize) -> Result<Parsed, BadLine> {
    let find = |key: &str| value_of(numbered(text).take(header), key);
    let needed = |key: &str| find(key).ok_or_else(|| bad(header.max(1), format!("{key} is not in the header")));
    let [of_step, of_count, of_unit, title @ ..] = keys;
    let (of_units, units) = needed(of_unit)?;
    let unit = (units.split(',').next().unwrap_or_default(), of_units);
    let (line, dt) = needed(of_step)?;
    let dt = step(of_step, "", &[&*dt.to_uppercase()]).map_err(|problem| bad(line, problem))?;
    let (line, npts) = needed(of_count)?;
    let npts = count(of_count, npts).map_err(|problem| bad(line, problem))?;
    let title = title.into_iter().filter_map(find).map(|(_, value)| value).filter(|value| !value.is_empty());
    let lines = numbered(text).skip(header).take_while(|(_, line)| !line.starts_with(SERIES));
    published(title.collect::<Vec<_>>().join(", "), unit, dt, (of_count, npts), (lines, None), how)
}
