//! Result of the parsers of all layouts: samples as the file gives them.

use super::text::{columns, nine_digits, number, quote, without_blanks};
use super::{BadLine, Format, MAX_SAMPLES, Reading, Record, Remedy, Source, Unit, UnitFrom, bad};

/// Steps that differ by no more than this part are the same.
const SAME_STEP: f64 = 1e-6;

/// Part of a step that the last of rounded times may be off.
const ROUNDING: f64 = 0.1;

/// The samples of a file, with the findings about them.
#[derive(Debug)]
pub(super) struct Parsed {
    pub title: String,
    pub times: Times,
    pub values: Vec<f64>,
    pub source: Source,
    last_line: usize,
}

/// Times of the samples.
#[derive(Debug)]
pub(super) enum Times {
    /// One sample every so many seconds.
    Every(f64),
    /// Samples at these times, s.
    At(Vec<f64>),
}

impl Times {
    /// The step (s), and whether it is `dt` (s): times as they are written may be rounded, and after the last step be off by
    /// a tenth of one. A single time has no step.
    pub fn have_step(&self, dt: f64) -> Option<(f64, bool)> {
        match self {
            Times::Every(step) => Some((*step, (step - dt).abs() <= SAME_STEP * dt)),
            Times::At(times) if times.len() > 1 => {
                let (steps, duration) = ((times.len() - 1) as f64, times[times.len() - 1] - times[0]);
                Some((nine_digits(duration / steps), (duration - steps * dt).abs() < ROUNDING * dt))
            }
            Times::At(_) => None,
        }
    }
}

impl Parsed {
    /// Starts without samples.
    pub fn new(format: Format, title: impl Into<String>, unit: Unit, unit_from: UnitFrom, times: Times) -> Parsed {
        let source = Source { format, unit, unit_from, remarks: Vec::new() };
        Parsed { title: title.into(), times, values: Vec::new(), source, last_line: 1 }
    }

    /// Adds the accelerations on `lines`, in columns of `width` letters, or with blanks between them.
    pub fn read<'a>(
        &mut self,
        lines: impl Iterator<Item = (usize, &'a str)>,
        width: Option<usize>,
    ) -> Result<(), BadLine> {
        for line in without_blanks(lines) {
            let (line, values) = line?;
            for word in columns(values, width) {
                let no_number = || bad(line, format!("the acceleration {} is not a number", quote(word)));
                self.add(number(word).ok_or_else(no_number)?, line)?;
            }
        }
        Ok(())
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

    /// Adds a finding or an assumption.
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

    /// The record, once all of the file is read.
    pub fn record(self, how: &Reading) -> Result<(Record, Source), BadLine> {
        let Parsed { title, times, values: acceleration, source, last_line } = self;
        if let (Some((stated, false)), Some(asked)) = (how.dt.and_then(|dt| times.have_step(dt)), how.dt) {
            let problem = format!("the file states a sample every {stated:?} s, but the given step is {asked:?} s");
            return Err(bad(last_line, problem));
        }
        let has_columns = matches!(source.format, Format::Table | Format::Cosmos | Format::Csmip);
        if let (false, Some(asked)) = (has_columns, &how.column) {
            return Err(bad(1, format!("the given column is {asked}, but a file of {} has none", source.format)));
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
        record.map(|record| (record, source)).map_err(|error| bad(last_line, error.to_string()))
    }
}
