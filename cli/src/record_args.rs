//! Which ground motion record a command works on, how it is read, and how it is scaled.
use crate::{input, significant::short, talk::say};
use anyhow::anyhow;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use rocking::run::record::Record;
use rocking_records::{Column, Reading, RecordError, Unit, csv_in};
use serde::Deserialize;
use std::path::{Path, PathBuf};

/// The record asked for, if any.
#[derive(clap::Args)]
#[command(next_help_heading = "Ground motion")]
pub struct RecordArgs {
    /// Ground motion record, `-` for standard input: PEER .AT2, ESM, K-NET, COSMOS or CSMIP as published, or a table of text
    #[arg(long, value_name = "FILE")]
    pub record: Option<PathBuf>,
    /// Vertical component of the record, positive upwards, in a file of its own: read and scaled by the same options
    #[arg(long, value_name = "FILE", requires = "record")]
    pub record_v: Option<PathBuf>,
    /// How it is read and scaled.
    #[command(flatten)]
    pub options: RecordOptions,
}

/// How a record is read and scaled: on the command line, and beside its file's name in the file of a sweep.
#[derive(clap::Args, Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RecordOptions {
    /// Unit of accelerations, if the file does not state it [default: m/s2]
    #[arg(long, value_parser = one_of(Unit::NAMES), requires = "record")]
    pub unit: Option<Unit>,
    /// Time between the samples of a record without times; a record's own times must agree with it
    #[arg(long, value_name = "SECONDS", requires = "record", allow_negative_numbers = true)]
    pub dt: Option<f64>,
    /// Column of the accelerations, by number or heading, or `all` if every number on every line is one; or channel of a
    /// COSMOS or CSMIP file, by number
    #[arg(long, value_name = "COLUMN", requires = "record")]
    pub column: Option<Column>,
    /// Read all samples, even if the file states another number of them
    #[arg(long, requires = "record")]
    pub ignore_npts: bool,
    /// Multiplies the record's times [default: 1]
    #[arg(long, value_name = "FACTOR", requires = "record", allow_negative_numbers = true)]
    pub time_scale: Option<f64>,
    /// Multiplies the record's accelerations [default: 1]
    #[arg(long, value_name = "FACTOR", requires = "record", allow_negative_numbers = true)]
    pub scale: Option<f64>,
}

impl RecordArgs {
    /// The record, scaled; `g` (m/s²) is what a record's g stands for. Says what was read, and what was assumed.
    pub fn load(&self, g: f64) -> anyhow::Result<Option<Record>> {
        let Some(path) = &self.record else { return Ok(None) };
        let record = self.options.load("record", path, g)?;
        let Some(vertical) = &self.record_v else { return Ok(Some(record)) };
        Ok(Some(record.with_vertical(&self.options.load("record_v", vertical, g)?)?))
    }

    /// The files that are read.
    pub fn inputs(&self) -> impl Iterator<Item = &Path> {
        self.record.iter().chain(&self.record_v).map(PathBuf::as_path)
    }
}

/// A record as it is understood.
pub struct Understood {
    /// Scaled, in m/s².
    pub record: Record,
    /// Scaled, in the unit of its file.
    in_file_unit: Record,
    unit: Unit,
    /// What was found and assumed, then what is likely wrong.
    pub sentences: Vec<String>,
}

impl RecordOptions {
    /// The record in the file at `path`, scaled, in m/s²; `g` (m/s²) is what a record's g stands for. Says what was read as
    /// `what`, and what was assumed.
    fn load(&self, what: &str, path: &Path, g: f64) -> anyhow::Result<Record> {
        let understood = self.understand(path, g)?;
        understood.say(&format!("{what:<14} "));
        let record = understood.record;
        if self.time_scale.is_some() || self.scale.is_some() {
            say!("scaled         {}, peak {} g", rocking_records::steps(&record), short(record.pga() / g));
        }
        Ok(record)
    }

    /// Reads the record at `path` and says nothing yet; `g` in m/s².
    pub fn understand(&self, path: &Path, g: f64) -> anyhow::Result<Understood> {
        let &RecordOptions { unit, dt, ref column, ignore_npts: ignores_count, .. } = self;
        let [time_scale, scale] = self.factors();
        let how = Reading { unit, dt, column: column.clone(), ignores_count };
        let read = match input::is_stream(path) {
            true => rocking_records::from_bytes(Path::new(&input::name(path)), &input::read(path)?, &how),
            false => rocking_records::read_raw(path, &how),
        };
        let (in_file_unit, source) = read.map_err(with_remedy)?;
        let (record, source) = rocking_records::in_m_s2(in_file_unit.clone(), source, g)?;
        let sentences = source.sentences(&input::name(path), &record, g);
        let in_file_unit = in_file_unit.scaled(time_scale, scale)?;
        Ok(Understood { record: record.scaled(time_scale, scale)?, in_file_unit, unit: source.unit, sentences })
    }

    /// Factors on the record's times and on its accelerations.
    pub fn factors(&self) -> [f64; 2] {
        [self.time_scale, self.scale].map(|factor| factor.unwrap_or(1.0))
    }

    /// Whether a file is read as it is.
    pub fn are_none(&self) -> bool {
        *self == RecordOptions::default()
    }
}

impl Understood {
    /// Says what was found and assumed, after `label`, and warns of what is likely wrong.
    pub fn say(&self, label: &str) {
        say!("{label}{}", self.sentences[0]);
        self.warnings().for_each(|warning| say!("{warning}"));
    }

    /// What is likely wrong, a line each.
    pub fn warnings(&self) -> impl Iterator<Item = String> {
        self.sentences[1..].iter().map(|warning| format!("warning: {warning}"))
    }

    /// The unit of its file.
    pub fn unit(&self) -> Unit {
        self.unit
    }

    /// It as a table that is read without options, in s and the unit of its file: one in g follows a g that is set later.
    pub fn table(&self) -> String {
        csv_in(&self.in_file_unit, self.unit)
    }
}

/// The error with what helps.
fn with_remedy(error: RecordError) -> anyhow::Error {
    match error {
        RecordError::Malformed { remedy: Some(remedy), .. } => anyhow!("{error}; {remedy}"),
        _ => error.into(),
    }
}

/// Takes one of `all` by its name.
pub fn one_of<T: Copy + Send + Sync + 'static>(
    all: impl IntoIterator<Item = (impl Into<PossibleValue>, T)>,
) -> impl TypedValueParser<Value = T> {
    let (names, values): (Vec<PossibleValue>, Vec<T>) = all.into_iter().map(|(name, of)| (name.into(), of)).unzip();
    PossibleValuesParser::new(names.clone()).map(move |asked| {
        let found = names.iter().position(|name| name.matches(&asked, false));
        values[found.expect("clap accepts these names alone")]
    })
}
