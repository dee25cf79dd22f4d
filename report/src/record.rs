//! A ground motion record as the doors read it, with the sentences to print before a run.

use crate::input;
use anyhow::anyhow;
use rocking::run::record::{Record, SamplesError};
use rocking_records::{Reading, RecordError, Remedy, Unit, csv_in};
use std::path::Path;

/// A record that was read from a file or a stream.
pub struct Understood {
    /// The scaled record, in m/s².
    pub record: Record,
    /// The record as its file has it.
    pub in_file_unit: Record,
    factors: [f64; 2],
    /// Unit of the file.
    pub unit: Unit,
    /// Findings and assumptions in a sentence, then one sentence for each likely error.
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
    let (in_file_unit, source) = read.map_err(|error| match error {
        RecordError::Malformed { remedy: Some(remedy), .. } => anyhow!("{error}; {}", remedy.advice(called)),
        _ => error.into(),
    })?;
    let of_file = rocking_records::in_m_s2(in_file_unit.clone(), source.unit, g)?;
    let record = of_file.clone().scaled(factors[0], factors[1])?;
    let remedy = Remedy::Unit.advice(called);
    let sentences = source.sentences(&input::name(path), [&of_file, &record], g, &remedy);
    Ok(Understood { record, in_file_unit, factors, unit: source.unit, sentences })
}

/// Why two components are no ground motion, with the `option` that chooses the column of the vertical one at the door.
pub fn no_pair(error: SamplesError, option: &str) -> anyhow::Error {
    match error {
        SamplesError::Twice { .. } => anyhow!("{error}, or another column, {option}"),
        _ => error.into(),
    }
}

impl Understood {
    /// Sentences about assumptions and likely errors.
    pub fn warnings(&self) -> &[String] {
        &self.sentences[1..]
    }

    /// The scaled record as a table that needs no options, in s and the unit of the file: a record in g follows a g that is set later.
    pub fn table(&self) -> anyhow::Result<String> {
        let [time_scale, scale] = self.factors;
        Ok(csv_in(&self.in_file_unit.clone().scaled(time_scale, scale)?, self.unit))
    }
}
