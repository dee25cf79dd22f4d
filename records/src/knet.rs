//! ASCII of K-NET and KiK-net: seventeen lines of header, then counts of the recorder, eight a line.

use super::parsed::{Parsed, published};
use super::text::{number, numbered, quote, value_of};
use super::{BadLine, Reading, bad};

const HEADER_LINES: usize = 17;

pub(super) fn is_its(text: &str) -> bool {
    text.starts_with("Origin Time")
}

/// The step from the sampling frequency; a count times the scale factor is an acceleration in gal. The offset of the recorder
/// at rest is the mean of all counts and is subtracted.
pub(super) fn parse(text: &str, how: &Reading) -> Result<Parsed, BadLine> {
    const WIDTH: usize = 9;
    let find = |key: &str| {
        value_of(numbered(text).take(HEADER_LINES), key)
            .ok_or_else(|| bad(HEADER_LINES, format!("{key} is not in the header")))
    };
    let positive = |line, name: &str, word: &str| {
        let value = number(word.trim()).filter(|value| *value > 0.0);
        value.ok_or_else(|| bad(line, format!("{name} = {} must be a number greater than 0", quote(word))))
    };
    let (line, frequency) = find("Sampling Freq(Hz)")?;
    let frequency = positive(line, "Sampling Freq(Hz)", frequency.trim_end_matches("Hz"))?;
    let (of_factor, factor) = find("Scale Factor")?;
    let (gal, counts) = factor.split_once("(gal)/").ok_or_else(|| {
        bad(of_factor, format!("found {} where the scale factor is stated, such as 3920(gal)/6182761", quote(factor)))
    })?;
    let factor = positive(of_factor, "Scale Factor", gal)? / positive(of_factor, "Scale Factor", counts)?;
    let (line, duration) = find("Duration Time(s)")?;
    let duration = positive(line, "Duration Time(s)", duration)?;

    let parts = ["Origin Time", "Station Code", "Dir."].map(|key| find(key).map_or("", |(_, value)| value));
    let title = parts.into_iter().filter(|part| !part.is_empty()).collect::<Vec<_>>().join(", ");
    let count = ("Duration Time(s) x Sampling Freq(Hz)", (duration * frequency).round() as usize);
    let lines = (numbered(text).skip(HEADER_LINES), Some(WIDTH));
    let mut parsed = published(title, ("gal", of_factor), 1.0 / frequency, count, lines, how)?;
    parsed.values.iter_mut().for_each(|count| *count *= factor);
    let offset = parsed.values.iter().sum::<f64>() / parsed.values.len().max(1) as f64;
    parsed.values.iter_mut().for_each(|value| *value -= offset);
    parsed.remark(format!("the recorder's offset, the mean of {offset:.3} gal, is taken off"));
    Ok(parsed)
}
