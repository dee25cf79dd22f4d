//! Result of the parsers of all layouts: samples as the file gives them.

use super::text::{columns, nine_digits, no_number, number, without_blanks};
use super::{BadLine, MAX_SAMPLES, Origin, Reading, Record, Remedy, TABLE, Unit, UnitFrom, bad, source::of_file};

/// Steps that differ by no more than this part are the same.
const SAME_STEP: f64 = 1e-6;

/// Part of a step that rounded times may be off, or half a unit of the last of their decimals, of which there are fewer than these.
const ROUNDING: f64 = 0.1;
const MOST_DECIMALS: i32 = 7;

/// The samples of a file, with the findings about them.
#[derive(Debug)]
pub(super) struct Parsed {
    pub title: String,
    pub times: Times,
    pub values: Vec<f64>,
    pub source: Origin,
    last_line: usize,
}

#[derive(Debug)]
pub(super) enum Times {
    /// One sample every so many seconds.
    Every(f64),
    /// Samples at these times, s.
    At(Vec<f64>),
}

impl Times {
    /// These times, which must have the step `dt` (s), or the first sample that contradicts and what they have. Times of
    /// few digits are made even.
    pub fn with_step(self, dt: f64) -> Result<Times, (usize, String)> {
        let times = match self {
            Times::Every(step) if (step - dt).abs() <= SAME_STEP * dt => return Ok(self),
            Times::Every(step) => return Err((0, format!("a sample every {step:?} s"))),
            Times::At(times) if times.len() < 2 => return Ok(Times::At(times)),
            Times::At(times) => times,
        };
        let step = nine_digits((times[times.len() - 1] - times[0]) / (times.len() - 1) as f64);
        let even = |i: usize| times[0] + i as f64 * dt;
        let off = (0..times.len()).map(|i| (times[i] - even(i)).abs()).fold(0.0, f64::max);
        let is_whole = |unit: f64| times.iter().all(|time| (time / unit - (time / unit).round()).abs() < SAME_STEP);
        let last_digit = (0..MOST_DECIMALS).map(|decimals| 0.1_f64.powi(decimals)).find(|unit| is_whole(*unit));
        let is_missing = |i: &usize| times[*i] - times[i - 1] > 1.5 * dt && (step - dt).abs() < ROUNDING * dt;
        let missing = (1..times.len()).find(is_missing);
        match missing {
            _ if off <= SAME_STEP * dt => Ok(Times::At(times)),
            _ if off <= (0.5 + SAME_STEP) * last_digit.unwrap_or(0.0) || off < ROUNDING * dt => {
                Ok(Times::At((0..times.len()).map(even).collect()))
            }
            Some(i) => Err((i, format!("no sample between {:?} and {:?} s", times[i - 1], times[i]))),
            _ if (step - dt).abs() > SAME_STEP * dt => Err((0, format!("a sample every {step:?} s"))),
            _ => Err((0, format!("a sample every {step:?} s on average, but up to {off:.3} s beside the even times"))),
        }
    }
}

/// The samples on `lines` of a published file, one every `step` (s), in columns of `width` letters or with blanks between them. The
/// header states the `unit`, on a line, and the `count`, under a name.
pub(super) fn published<'a>(
    title: impl Into<String>,
    unit: (&str, usize),
    step: f64,
    count: (&str, usize),
    (lines, width): (impl Iterator<Item = (usize, &'a str)>, Option<usize>),
    how: &Reading,
) -> Result<Parsed, BadLine> {
    let (unit, unit_from) = of_file(unit.0, how.unit, unit.1)?;
    let mut parsed = Parsed::new(title, unit, unit_from, Times::Every(step));
    for line in without_blanks(lines) {
        let (line, values) = line?;
        for word in columns(values, width) {
            let no_number = || bad(line, format!("the acceleration {}", no_number(word)));
            parsed.add(number(word).ok_or_else(no_number)?, line)?;
        }
    }
    parsed.check_count(count.0, count.1, how)?;
    Ok(parsed)
}

impl Parsed {
    pub fn new(title: impl Into<String>, unit: Unit, unit_from: UnitFrom, times: Times) -> Parsed {
        let source = Origin { format: TABLE, unit, unit_from, remarks: Vec::new() };
        Parsed { title: title.into(), times, values: Vec::new(), source, last_line: 1 }
    }

    /// Adds the acceleration that stands on `line`.
    pub fn add(&mut self, acceleration: f64, line: usize) -> Result<(), BadLine> {
        if self.values.len() == MAX_SAMPLES {
            return Err(bad(line, format!("more than {MAX_SAMPLES} samples")));
        }
        self.values.push(acceleration);
        self.last_line = line;
        Ok(())
    }

    pub fn remark(&mut self, remark: impl Into<String>) {
        self.source.remarks.push(remark.into());
    }

    /// Whether there are as many samples as `name` states.
    pub fn check_count(&mut self, name: &str, stated: usize, how: &Reading) -> Result<(), BadLine> {
        let found = self.values.len();
        if found == stated {
            return Ok(());
        }
        let problem = format!("{name} states {stated} samples, and the file has {found}");
        if !how.ignores_count {
            return Err(bad(self.last_line, problem).remedied_by(Remedy::IgnoreCount));
        }
        self.remark(problem);
        Ok(())
    }

    /// The record, once all of the file in the layout `format` is read.
    pub fn record(self, how: &Reading, format: &'static str) -> Result<(Record, Origin), BadLine> {
        let Parsed { title, mut times, values: acceleration, source, last_line } = self;
        if let Some(asked) = how.dt {
            let contradicted =
                |(_, found)| bad(last_line, format!("the file states {found}, but the given step is {asked:?} s"));
            times = times.with_step(asked).map_err(contradicted)?;
        }
        let count = acceleration.len();
        if count < 2 {
            return Err(bad(last_line, format!("the file ends after {count} sample(s); two or more are needed")));
        }
        let times: Vec<f64> = match times {
            Times::At(times) => times,
            Times::Every(dt) => (0..count).map(|i| i as f64 * dt).collect(),
        };
        let record = Record::from_samples(title, times, acceleration);
        record.map(|record| (record, Origin { format, ..source })).map_err(|error| bad(last_line, error.to_string()))
    }
}
