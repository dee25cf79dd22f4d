//! A ground motion record as the doors read it, with the sentences to print before a run.

use crate::input;
use anyhow::anyhow;
use rocking::run::record::{Record, SamplesError};
use rocking_records::{Origin, Reading, RecordError, Remedy, Unit, csv_in, doubt_of_peak, doubts};
use std::path::Path;

/// A ground motion that was read from files or streams.
pub struct Understood {
    /// The scaled ground motion, in m/s².
    pub record: Record,
    /// The ground motion as its files have it.
    pub in_file_unit: Record,
    /// Factors on the times and on the accelerations.
    pub factors: [f64; 2],
    /// Units of the horizontal and of the vertical component.
    pub units: [Unit; 2],
    /// Statements of the file, if the ground motion is of a file.
    pub source: Option<Origin>,
    /// Findings in a sentence, then one sentence for each assumption and for each likely error.
    pub sentences: Vec<String>,
}

/// Reads the record at `path` as `how` says and multiplies its times and its accelerations by `factors`. A record's g means
/// `g` (m/s²). Messages name an option as it is `called` at the door.
pub fn understand(
    path: &Path,
    how: &Reading,
    factors: [f64; 2],
    g: f64,
    called: fn(&str) -> String,
) -> anyhow::Result<Understood> {
    let read = match input::is_stream(path) {
        true => rocking_records::from_bytes(Path::new(&input::name(path)), &input::read(path)?, how),
        false => rocking_records::read_raw(path, how),
    };
    Understood::new(&input::name(path), advised(read, called)?, factors, g, called)
}

/// The result of reading a file; an error names the option that would help.
pub fn advised<T>(read: Result<T, RecordError>, called: fn(&str) -> String) -> anyhow::Result<T> {
    read.map_err(|error| match error {
        RecordError::Malformed { remedy: Some(remedy), .. } => anyhow!("{error}; {}", remedy.advice(called)),
        _ => error.into(),
    })
}

/// Why two components are no ground motion, with the `option` that chooses the column of the vertical one at the door.
pub fn no_pair(error: SamplesError, option: &str) -> anyhow::Error {
    match error {
        SamplesError::Twice { .. } => anyhow!("{error}, or another column, {option}"),
        _ => error.into(),
    }
}

impl Understood {
    /// The ground motion of the file called `name`; the other arguments are those of [`understand`].
    pub fn new(
        name: &str,
        (in_file_unit, source): (Record, Origin),
        factors: [f64; 2],
        g: f64,
        called: fn(&str) -> String,
    ) -> anyhow::Result<Understood> {
        let of_file = rocking_records::in_m_s2(in_file_unit.clone(), source.unit, g)?;
        let record = of_file.clone().scaled(factors[0], factors[1])?;
        let warnings = source.assumption(&Remedy::Unit.advice(called)).into_iter().chain(doubts(&record, g));
        let warnings = warnings.map(|warning| format!("{name}: {warning}"));
        let sentences = [source.findings(name, &of_file, g)].into_iter().chain(warnings).collect();
        let units = [source.unit; 2];
        Ok(Understood { record, in_file_unit, factors, units, source: Some(source), sentences })
    }

    /// A ground motion in m/s² that is of no file, multiplied by `factors`.
    pub fn made(in_file_unit: Record, factors: [f64; 2], g: f64) -> anyhow::Result<Understood> {
        let record = in_file_unit.clone().scaled(factors[0], factors[1])?;
        let sentences = [record.title().to_owned()].into_iter().chain(doubt_of_peak(&record, g)).collect();
        let units = [Unit::MetrePerSecondSquared; 2];
        Ok(Understood { record, in_file_unit, factors, units, source: None, sentences })
    }

    /// This ground motion with the vertical component `up`. Like an FMU, which scales a record that it has read, this function first puts
    /// both at the same times, in the units of their files. `option` as in [`no_pair`], `g` in m/s².
    pub fn with_vertical(self, up: Understood, g: f64, option: &str) -> anyhow::Result<Understood> {
        let in_file_unit = self.in_file_unit.with_vertical(&up.in_file_unit).map_err(|error| no_pair(error, option))?;
        let (units, [time_scale, scale]) = ([self.units[0], up.units[0]], self.factors);
        let record = rocking_records::each_in_m_s2(in_file_unit.clone(), units, g)?.scaled(time_scale, scale)?;
        Ok(Understood { record, in_file_unit, units, ..self })
    }

    /// The scaled record as tables that need no options, in s and the unit of the file: a record in g follows a g that is set later. The
    /// first is of the horizontal component, the other of the vertical one, if there is one.
    pub fn tables(&self) -> anyhow::Result<(String, Option<String>)> {
        let [time_scale, scale] = self.factors;
        Ok(csv_in(&self.in_file_unit.clone().scaled(time_scale, scale)?, self.units))
    }
}
