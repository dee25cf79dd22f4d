//! COSMOS strong-motion data (format 1.20), volumes 1 and 2, and the corrected accelerograms of CSMIP, from which it comes.
//!
//! Channels follow one another, each with a header of text, integers, real numbers and comments. A line then states how
//! many accelerations follow, their unit and their columns; in volume 2 velocities and displacements come after them.

use super::parsed::{Parsed, published};
use super::text::{columns, number, numbered, quote};
use super::{BadLine, Column, Reading, Remedy, bad};

pub(super) fn is_its(text: &str) -> bool {
    text.lines().next().is_some_and(|line| line.to_ascii_lowercase().contains("(format v"))
}

pub(super) fn is_csmip(text: &str) -> bool {
    text.lines().next().is_some_and(|line| line.to_ascii_lowercase().contains("corrected accelerogram"))
}

/// The line before a channel's accelerations.
struct Announced<'a> {
    line: usize,
    /// Direction, the name of the channel in the header.
    name: &'a str,
    count: usize,
    unit: &'a str,
    /// Letters in a column; none if blanks separate the columns.
    width: Option<usize>,
    dt: f64,
}

/// The accelerations of the one channel, or of that which `how` chooses.
pub(super) fn parse(text: &str, how: &Reading) -> Result<Parsed, BadLine> {
    let channels = channels(text)?;
    let is_asked = |(index, channel): (usize, &Announced)| match &how.column {
        None => channels.len() == 1,
        Some(Column::Number(number)) => *number == index + 1,
        Some(Column::Heading(name)) => channel.name.eq_ignore_ascii_case(name.trim()),
        Some(Column::All) => false,
    };
    let asked: Vec<_> = channels.iter().enumerate().filter(|channel| is_asked(*channel)).collect();
    let [(index, &Announced { line: announced, count, unit, width, dt, .. })] = asked[..] else {
        let Some(first) = channels.first() else {
            return Err(bad(1, "no line of the file announces accelerations, as COSMOS and CSMIP do"));
        };
        let names: Vec<_> = channels.iter().map(|channel| quote(channel.name)).collect();
        let asked =
            how.column.as_ref().map_or("which one to read is not said".into(), |asked| format!("not one {asked}"));
        let problem = format!("{} channel(s) ({}), {asked}", channels.len(), names.join(", "));
        return Err(bad(first.line, problem).remedied_by(Remedy::Column));
    };
    let lines = numbered(text).skip(announced).take_while(|(_, line)| !ends_data(line));
    let count = ("the line before the data", count);
    let mut parsed = published(title(text), (unit, announced), dt, count, (lines, width), how)?;
    if channels.len() > 1 {
        let chosen = format!("channel {} of {}, {}", index + 1, channels.len(), quote(channels[index].name));
        parsed.source.remarks.insert(0, chosen);
    }
    Ok(parsed)
}

/// Whether `line` is one of text, which comes after the data: it announces velocities or the end.
fn ends_data(line: &str) -> bool {
    let lower = line.to_ascii_lowercase();
    lower.contains("pts") || lower.contains("points of") || lower.contains("end") || lower.contains("/&")
}

/// Direction on a line such as `Sta Chan  1: 360 deg (Rcrdr Chan  1)`.
fn direction(line: &str) -> Option<&str> {
    let start = line.to_ascii_lowercase().find("chan")? + "chan".len();
    let (number, name) = line.get(start..)?.split_once(':')?;
    number.trim().parse::<u32>().ok()?;
    name.trim_start().split(['(', ',']).next()?.split("  ").map(str::trim).find(|name| !name.is_empty())
}

/// The lines that announce accelerations: `12725 acceleration pts, approx 63 secs, units=cm/s^2,Format=(8F10.5)`, or
/// `7500 points of accel data equally spaced at  .010 sec, in cm/sec2. (8f10.6)`, which may end after the unit, or have
/// `(units: cm/sec/sec)`.
fn channels(text: &str) -> Result<Vec<Announced<'_>>, BadLine> {
    let mut channels = Vec::new();
    let (mut reals, mut name) = (Reals::default(), "");
    for (line, content) in numbered(text) {
        let lower = content.to_ascii_lowercase();
        name = direction(content).unwrap_or(name);
        let is_channel = lower.contains("pts") && lower.contains("units=") && lower.contains("acc")
            || lower.contains("points of accel data equally spaced");
        if lower.contains("real-header values follow") {
            reals = Reals::announced(line, content)?;
        } else if reals.missing > 0 {
            reals.read(line, content)?;
        } else if is_channel && !content.starts_with('|') {
            let unclear =
                || bad(line, format!("found {} where number, unit and step or format are stated", quote(content)));
            let count = content.split_whitespace().next().and_then(|count| count.parse().ok()).ok_or_else(unclear)?;
            let start = ["units=", "units:", " in "].iter().find_map(|before| Some(lower.find(before)? + before.len()));
            let unit = start.and_then(|start| content.get(start..)).map(|rest| rest.split([',', '(', ')', ' ']));
            let unit = unit.and_then(|mut words| words.find(|word| !word.is_empty())).ok_or_else(unclear)?;
            let own = lower.split_once("spaced at").and_then(|(_, rest)| number(rest.split_whitespace().next()?));
            let dt = own
                .filter(|dt| *dt > 0.0)
                .or(reals.step())
                .ok_or_else(|| bad(line, "no line states the interval of the samples"))?;
            channels.push(Announced { line, name, count, unit: unit.trim_end_matches('.'), width: width(content), dt });
        }
    }
    Ok(channels)
}

/// The letters of a column of `(8F10.3)`, the last format that `line` has.
fn width(line: &str) -> Option<usize> {
    let (_, format) = line.rsplit_once('(')?;
    let (_, width) = format.split_once(['f', 'F', 'e', 'E', 'i', 'I', 'g', 'G'])?;
    let digits = width.find(|letter: char| !letter.is_ascii_digit()).unwrap_or(width.len());
    width[..digits].parse().ok().filter(|width| (1..=100).contains(width))
}

/// The real numbers of a channel's header, of which two are needed.
#[derive(Default)]
struct Reals {
    values: Vec<f64>,
    missing: usize,
    width: Option<usize>,
}

impl Reals {
    fn announced(line: usize, content: &str) -> Result<Reals, BadLine> {
        let count = content.split_whitespace().next().and_then(|count| count.parse().ok());
        let missing = count.ok_or_else(|| bad(line, format!("found {} where a number is stated", quote(content))))?;
        Ok(Reals { missing, width: width(content), ..Reals::default() })
    }

    fn read(&mut self, line: usize, content: &str) -> Result<(), BadLine> {
        for word in columns(content, self.width) {
            self.values.push(number(word).ok_or_else(|| bad(line, format!("{} is not a number", quote(word))))?);
            self.missing = self.missing.saturating_sub(1);
        }
        Ok(())
    }

    /// Value 62 is the interval of the samples of this series, ms, and value 34 their interval as recorded, s.
    fn step(&self) -> Option<f64> {
        let positive = |value: usize| self.values.get(value - 1).copied().filter(|value| *value > 0.0);
        positive(62).map(|milliseconds| milliseconds / 1e3).or(positive(34))
    }
}

/// The event and the station, as the header's lines 2 and 5 of COSMOS, or 3 and 7 of CSMIP, have them.
fn title(text: &str) -> String {
    let lines = if is_its(text) { [1, 4] } else { [2, 6] };
    let words = |index| text.lines().nth(index).unwrap_or_default().split_whitespace().collect::<Vec<_>>().join(" ");
    lines.map(words).join(", ")
}
