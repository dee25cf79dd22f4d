//! COSMOS strong-motion data (format 1.20), volumes 1 and 2, and the corrected accelerograms of CSMIP, from which it comes.
//!
//! Channels follow one another, each with a header of text, integers, real numbers and comments. A line then states how
//! many accelerations follow, their unit and their columns; in volume 2 velocities and displacements come after them.

use super::parsed::{Parsed, Times};
use super::text::{columns, number, numbered, quote};
use super::unit::Stated;
use super::{BadLine, Column, Format, Reading, Remedy, Unit, bad, source::decide};

/// Layout that the first line states, if the file is COSMOS or CSMIP.
pub(super) fn format(text: &str) -> Option<Format> {
    let first = text.lines().next()?.to_ascii_lowercase();
    if first.contains("(format v") {
        Some(Format::Cosmos)
    } else if first.contains("corrected accelerogram") {
        Some(Format::Csmip)
    } else {
        None
    }
}

/// The line before a channel's accelerations.
struct Announced<'a> {
    line: usize,
    count: usize,
    unit: &'a str,
    /// Letters in a column; none if blanks separate the columns.
    width: Option<usize>,
    dt: f64,
}

/// The accelerations of the one channel, or of that which `how` chooses.
pub(super) fn parse(text: &str, format: Format, how: &Reading) -> Result<Parsed, BadLine> {
    let channels = channels(text, format)?;
    let channel = match (&how.column, channels.len()) {
        (_, 0) => return Err(bad(1, format!("no line of the file announces accelerations, as {format} does"))),
        (None, 1) => 0,
        (Some(Column::Number(number)), count) if (1..=count).contains(number) => number - 1,
        (asked, count) => {
            let asked = match asked {
                None => "and the file does not show which one to read".into(),
                Some(asked) => format!("but the given column is {asked}: channels have numbers"),
            };
            return Err(bad(channels[0].line, format!("{count} channel(s), {asked}")).remedied_by(Remedy::Column));
        }
    };
    let &Announced { line: announced, count, unit, width, dt } = &channels[channel];
    let stated = Unit::named(unit).map_or(Stated::Other(unit.into()), Stated::Unit);
    let (unit, unit_from) = decide(&stated, how.unit, announced)?;
    let mut parsed = Parsed::new(format, title(text, format), unit, unit_from, Times::Every(dt));
    if channels.len() > 1 {
        parsed.remark(format!("channel {} of {}", channel + 1, channels.len()));
    }
    parsed.read(numbered(text).skip(announced).take_while(|(_, line)| !ends_data(line)), width)?;
    parsed.check_count("the line before the data", count, how)?;
    Ok(parsed)
}

/// Whether `line` is one of text, which comes after the data: it announces velocities or the end.
fn ends_data(line: &str) -> bool {
    let lower = line.to_ascii_lowercase();
    lower.contains("pts") || lower.contains("points of") || lower.contains("end") || lower.contains("/&")
}

/// Words that announce accelerations.
fn channels(text: &str, format: Format) -> Result<Vec<Announced<'_>>, BadLine> {
    let mut channels = Vec::new();
    let mut reals = Reals::default();
    for (line, content) in numbered(text) {
        let lower = content.to_ascii_lowercase();
        match format {
            Format::Csmip if lower.contains("points of accel data equally spaced") => {
                channels.push(csmip(line, content)?);
            }
            Format::Cosmos if lower.contains("real-header values follow") => reals = Reals::announced(line, content)?,
            Format::Cosmos if reals.missing > 0 => reals.read(line, content)?,
            Format::Cosmos
                if !content.starts_with('|')
                    && lower.contains("pts")
                    && lower.contains("units=")
                    && lower.contains("acc") =>
            {
                channels.push(cosmos(line, content, &reals)?);
            }
            _ => {}
        }
    }
    Ok(channels)
}

/// `7500 points of accel data equally spaced at  .010 sec, in cm/sec2. (8f10.6)`, which may end after the unit, or have
/// `(units: cm/sec/sec)`.
fn csmip(line: usize, content: &str) -> Result<Announced<'_>, BadLine> {
    let unclear = || bad(line, format!("found {} where number, interval and unit are stated", quote(content)));
    let lower = content.to_ascii_lowercase();
    let count = content.split_whitespace().next().and_then(|count| count.parse().ok()).ok_or_else(unclear)?;
    let dt = lower.split_once("spaced at").and_then(|(_, rest)| step(rest.split_whitespace().next()?));
    let start = [" in ", "units:"].into_iter().find_map(|before| Some(lower.find(before)? + before.len()));
    let unit = start.and_then(|start| content.get(start..)).and_then(|rest| rest.split_whitespace().next());
    let unit = unit.ok_or_else(unclear)?.trim_end_matches(['.', ',', ')']);
    Ok(Announced { line, count, unit, width: width(content), dt: dt.ok_or_else(unclear)? })
}

/// `12725 acceleration pts, approx 63 secs, units=cm/s^2,Format=(8F10.5)`
fn cosmos<'a>(line: usize, content: &'a str, reals: &Reals) -> Result<Announced<'a>, BadLine> {
    let unclear = || bad(line, format!("found {} where number, unit and format are stated", quote(content)));
    let count = content.split_whitespace().next().and_then(|count| count.parse().ok()).ok_or_else(unclear)?;
    let start = content.to_ascii_lowercase().find("units=").ok_or_else(unclear)? + "units=".len();
    let unit = content.get(start..).and_then(|rest| rest.split([',', '(', ' ']).find(|word| !word.is_empty()));
    let dt =
        reals.step().ok_or_else(|| bad(line, "the real header states no interval of the samples: value 62, in ms"))?;
    Ok(Announced { line, count, unit: unit.ok_or_else(unclear)?, width: Some(width(content).ok_or_else(unclear)?), dt })
}

/// The letters of a column of `(8F10.3)`, the last format that `line` has.
fn width(line: &str) -> Option<usize> {
    let (_, format) = line.rsplit_once('(')?;
    let (_, width) = format.split_once(['f', 'F', 'e', 'E', 'i', 'I', 'g', 'G'])?;
    let digits = width.find(|letter: char| !letter.is_ascii_digit()).unwrap_or(width.len());
    width[..digits].parse().ok().filter(|width| (1..=100).contains(width))
}

fn step(word: &str) -> Option<f64> {
    number(word).filter(|dt| *dt > 0.0)
}

/// The real numbers of a channel's header, of which two are needed.
#[derive(Default)]
struct Reals {
    values: usize,
    missing: usize,
    width: Option<usize>,
    /// Value 34: interval of the samples as recorded, s.
    recorded: Option<f64>,
    /// Value 62: interval of the samples of this series, ms.
    of_series: Option<f64>,
}

impl Reals {
    fn announced(line: usize, content: &str) -> Result<Reals, BadLine> {
        let count = content.split_whitespace().next().and_then(|count| count.parse().ok());
        let missing = count.ok_or_else(|| bad(line, format!("found {} where a number is stated", quote(content))))?;
        Ok(Reals { missing, width: width(content), ..Reals::default() })
    }

    fn read(&mut self, line: usize, content: &str) -> Result<(), BadLine> {
        for word in columns(content, self.width) {
            let value = number(word).ok_or_else(|| bad(line, format!("{} is not a number", quote(word))))?;
            self.values += 1;
            self.missing = self.missing.saturating_sub(1);
            match self.values {
                34 => self.recorded = Some(value),
                62 => self.of_series = Some(value),
                _ => {}
            }
        }
        Ok(())
    }

    fn step(&self) -> Option<f64> {
        let positive = |value: Option<f64>| value.filter(|value| *value > 0.0);
        positive(self.of_series).map(|milliseconds| milliseconds / 1e3).or(positive(self.recorded))
    }
}

/// The event and the station, as the header's lines 2 and 5 of COSMOS, or 3 and 7 of CSMIP, have them.
fn title(text: &str, format: Format) -> String {
    let [event, station] = if format == Format::Cosmos { [1, 4] } else { [2, 6] };
    let line = |index| text.lines().nth(index).unwrap_or_default();
    let words = |line: &str| line.split_whitespace().collect::<Vec<_>>().join(" ");
    format!("{}, {}", words(line(event)), words(line(station)))
}
