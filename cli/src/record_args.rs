//! Which ground motion record a command works on, how it is read, and how it is scaled.
use crate::options::{on_command_line, one_of};
use crate::talk::{say, warning};
use anyhow::{Context, ensure};
use rocking::digits::short;
use rocking::run::record::Record;
use rocking_records::{Column, LAYOUTS, Reading, Unit};
use rocking_report::input;
use rocking_report::record::{Understood, understand};
use serde::Deserialize;
use std::path::{Path, PathBuf};

#[derive(clap::Args)]
#[command(next_help_heading = "Ground motion")]
pub struct RecordArgs {
    #[arg(long, value_name = "FILE", help = help_of_record())]
    pub record: Option<PathBuf>,
    #[command(flatten)]
    pub vertical: VerticalArgs,
    #[command(flatten)]
    pub options: RecordOptions,
}

/// Help on the option or argument of a record, with the layouts that are read.
pub fn help_of_record() -> String {
    format!("Ground motion record, `-` for standard input: {LAYOUTS}")
}

#[derive(clap::Args, Default)]
#[command(next_help_heading = "Ground motion")]
pub struct VerticalArgs {
    /// Vertical component of the (first) record, positive upwards: read and scaled by the same options
    #[arg(long, value_name = "FILE", requires = "record")]
    pub record_v: Option<PathBuf>,
    /// Column or channel of the vertical component, in the (first) record if --record-v is not given [default: that of --column]
    #[arg(long, value_name = "COLUMN", requires = "record")]
    pub column_v: Option<Column>,
}

/// How a record is read and scaled: on the command line, and beside its file's name in the file of a sweep.
#[derive(clap::Args, Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(deny_unknown_fields, default)]
pub struct RecordOptions {
    /// Unit of accelerations, if the file does not state it, or its heading is wrong [default: m/s2]
    #[arg(long, value_parser = one_of(Unit::NAMES), requires = "record")]
    pub unit: Option<Unit>,
    /// Time between the samples of a record without times; a record's own times must agree with it
    #[arg(long, value_name = "SECONDS", requires = "record", allow_hyphen_values = true)]
    pub dt: Option<f64>,
    /// Column of the accelerations, by number or heading, or `all` if every number on every line is one; or channel, by
    /// number or direction
    #[arg(long, value_name = "COLUMN", requires = "record")]
    pub column: Option<Column>,
    /// Read all samples, even if the file states another number of them
    #[arg(long, requires = "record")]
    pub ignore_npts: bool,
    /// Multiplies the record's times [default: 1]
    #[arg(long, value_name = "FACTOR", requires = "record", allow_hyphen_values = true)]
    pub time_scale: Option<f64>,
    /// Multiplies the record's accelerations [default: 1]
    #[arg(long, value_name = "FACTOR", requires = "record", allow_hyphen_values = true)]
    pub scale: Option<f64>,
}

impl VerticalArgs {
    /// The file of the vertical component, if there is one. The file may be the `record`.
    pub fn file<'a>(&'a self, record: Option<&'a PathBuf>) -> Option<&'a PathBuf> {
        self.record_v.as_ref().or(record.filter(|_| self.column_v.is_some()))
    }
}

impl RecordArgs {
    /// Reads and scales the record, and reports what it found and assumed. A record's g means `g` (m/s²).
    pub fn load(&self, g: f64) -> anyhow::Result<Option<Understood>> {
        let Some(path) = &self.record else { return Ok(None) };
        let mut understood = self.options.load("record", path, g)?;
        if let Some(vertical) = self.vertical.file(Some(path)) {
            let up = self.options.with_column(&self.vertical.column_v).load("record_v", vertical, g)?;
            understood = understood.with_vertical(up, g, "--column-v")?;
        }
        Ok(Some(understood))
    }

    pub fn inputs(&self) -> impl Iterator<Item = &Path> {
        self.record.iter().chain(&self.vertical.record_v).map(PathBuf::as_path)
    }
}

impl RecordOptions {
    /// Reads and scales the record in the file at `path`, in m/s²; a record's g means `g` (m/s²). Reports findings and
    /// assumptions under the name `what`.
    fn load(&self, what: &str, path: &Path, g: f64) -> anyhow::Result<Understood> {
        let understood = self.understand(path, g, on_command_line)?;
        say_understood(&format!("{what:<14} "), &understood);
        let record = &understood.record;
        if self.time_scale.is_some() || self.scale.is_some() {
            say!("scaled         {}, peak {} g", rocking_records::steps(record), short(record.pga() / g));
        }
        Ok(understood)
    }

    /// Reads the record at `path`, whose options are `called` so in messages; `g` in m/s².
    pub fn understand(&self, path: &Path, g: f64, called: fn(&str) -> String) -> anyhow::Result<Understood> {
        let &RecordOptions { unit, dt, ref column, ignore_npts: ignores_count, .. } = self;
        let how = Reading { unit, dt, column: column.clone(), ignores_count };
        understand(path, &how, self.factors(), g, called)
    }

    /// The same options for a `column` of its own, if any.
    pub fn with_column(&self, column: &Option<Column>) -> RecordOptions {
        RecordOptions { column: column.clone().or(self.column.clone()), ..self.clone() }
    }

    /// Factors on the record's times and on its accelerations.
    pub fn factors(&self) -> [f64; 2] {
        [self.time_scale, self.scale].map(|factor| factor.unwrap_or(1.0))
    }
}

/// The scaled record that is `understood`, with the force on the top floor in the table at `path`, if there is one; `g` in m/s². The
/// force, whose times no scale changes, is put beside the accelerations in m/s² before these are multiplied, as a sweep needs it.
pub fn with_force(understood: Understood, path: Option<&Path>, g: f64) -> anyhow::Result<Record> {
    let Some(path) = path else { return Ok(understood.record) };
    let name = || format!("force = {}", path.display());
    let what = || format!("{}: a table with the columns time[s] and F_t[N] is needed", name());
    let bytes = input::read(path).with_context(name)?;
    let mut table = csv::Reader::from_reader(&*bytes);
    let headings: Vec<_> = table.headers().with_context(what)?.iter().collect();
    ensure!(headings == ["time[s]", "F_t[N]"], "{}; its first line is {:?}", what(), headings.join(","));
    let rows = table.into_deserialize::<(f64, f64)>().collect::<Result<_, _>>();
    let (times, F_t): (Vec<_>, Vec<_>) = rows.with_context(what)?;
    let Understood { in_file_unit, units, factors: [time_scale, scale], .. } = understood;
    let record = rocking_records::each_in_m_s2(in_file_unit, units, g)?.scaled(time_scale, 1.0)?;
    Ok(record.with_force(&times, &F_t).with_context(name)?.multiplied(scale))
}

/// Prints findings and assumptions about a record after `label`, and warnings.
pub fn say_understood(label: &str, understood: &Understood) {
    say!("{label}{}", understood.sentences[0]);
    understood.sentences[1..].iter().for_each(|warning| warning!("{warning}"));
}
