//! A ground motion record as the doors read it, with the sentences to print before a run.

use crate::input;
use anyhow::anyhow;
use rocking::run::record::Record;
use rocking_records::{Reading, RecordError, Unit, csv_in};
use std::path::Path;

/// A record that was read from a file or a stream.
pub struct Understood {
    /// The scaled record, in m/s².
    pub record: Record,
    /// The scaled record, in the unit of its file.
    pub in_file_unit: Record,
    /// Unit of the file.
    pub unit: Unit,
    /// Findings and assumptions in a sentence, then one sentence for each likely error.
    pub sentences: Vec<String>,
}

/// Reads the record at `path` as `how` says and multiplies its times and its accelerations by `factors`. A record's g means
/// `g` (m/s²).
pub fn understand(path: &Path, how: &Reading, factors: [f64; 2], g: f64) -> anyhow::Result<Understood> {
    let read = match input::is_stream(path) {
        true => rocking_records::from_bytes(Path::new(&input::name(path)), &input::read(path)?, how),
        false => rocking_records::read_raw(path, how),
    };
    let (in_file_unit, source) = read.map_err(with_remedy)?;
    let (record, source) = rocking_records::in_m_s2(in_file_unit.clone(), source, g)?;
    let sentences = source.sentences(&input::name(path), &record, g);
    let [time_scale, scale] = factors;
    let in_file_unit = in_file_unit.scaled(time_scale, scale)?;
    Ok(Understood { record: record.scaled(time_scale, scale)?, in_file_unit, unit: source.unit, sentences })
}

/// The error with its remedy.
fn with_remedy(error: RecordError) -> anyhow::Error {
    match error {
        RecordError::Malformed { remedy: Some(remedy), .. } => anyhow!("{error}; {remedy}"),
        _ => error.into(),
    }
}

impl Understood {
    /// Warnings of likely errors, a line each.
    pub fn warnings(&self) -> impl Iterator<Item = String> {
        self.sentences[1..].iter().map(|warning| format!("warning: {warning}"))
    }

    /// The record as a table that needs no options, in s and the unit of the file: a record in g follows a g that is set later.
    pub fn table(&self) -> String {
        csv_in(&self.in_file_unit, self.unit)
    }
}
