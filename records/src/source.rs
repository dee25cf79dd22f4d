//! Options for reading a record's file, and the findings and assumptions about the file.

use super::text::quote;
use super::unit::{Stated, mentions_unit};
use super::{BadLine, Record, Remedy, Unit, bad, doubts};
use rocking::digits::short;
use serde::{Deserialize, Deserializer, de::Error};
use std::fmt;

/// Options of the user for facts that a file does not state.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reading {
    /// Unit of the accelerations; must be the unit that the file states, if the file clearly states one.
    pub unit: Option<Unit>,
    /// Time between two samples of a file without times, s.
    pub dt: Option<f64>,
    /// Column, or channel of a COSMOS file, with the accelerations.
    pub column: Option<Column>,
    /// Whether all samples are read even if the file states another number of them.
    pub ignores_count: bool,
}

/// Position of the accelerations in a table.
#[derive(Clone, Debug, PartialEq, Deserialize)]
#[serde(untagged)]
pub enum Column {
    /// Every number is one, whatever the line it stands on: `all`.
    #[serde(deserialize_with = "all")]
    All,
    /// One column, by its number, counted from 1.
    Number(usize),
    /// One column, by its heading, or what stands before the unit in it.
    Heading(String),
}

/// A layout of files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Acceleration records of PEER.
    At2,
    /// Columns of text.
    Table,
    /// ASCII of the Engineering Strong-Motion database and of ITACA.
    Esm,
    /// ASCII of K-NET and KiK-net.
    KNet,
    /// COSMOS strong-motion data, volumes 1 and 2.
    Cosmos,
    /// Corrected accelerograms of CSMIP, volume 2.
    Csmip,
}

/// Origin of a record: statements of its file, and assumptions about missing statements.
#[derive(Clone, Debug, PartialEq)]
pub struct Source {
    /// Its layout.
    pub format: Format,
    /// Unit of the accelerations in the file.
    pub unit: Unit,
    /// Origin of the unit.
    pub unit_from: UnitFrom,
    /// Other findings and assumptions, such as the column and the number of lines of headings.
    pub remarks: Vec<String>,
}

impl Source {
    /// Findings and assumptions in a sentence, for `record` (m/s²), which was read from the file called `name`. The peak is
    /// reported in units of `g` (m/s²).
    pub fn findings(&self, name: &str, record: &Record, g: f64) -> String {
        let unit_from = match self.unit_from {
            UnitFrom::File => "as the file states",
            UnitFrom::User => "as given",
            UnitFrom::Assumed => "assumed",
        };
        let remarks: String = self.remarks.iter().map(|remark| format!(", {remark}")).collect();
        let (format, unit, samples) = (self.format, self.unit, record.times().len());
        let (steps, peak) = (steps(record), short(record.pga() / g));
        format!("{name}: {format}{remarks}; {unit} {unit_from}; {samples} samples, {steps}, peak {peak} g")
    }

    /// A warning of a unit that is assumed, with the `remedy`.
    pub fn assumption(&self, remedy: &str) -> Option<String> {
        let assumed = || format!("the file states no unit of acceleration: {} is assumed; {remedy}", self.unit);
        (self.unit_from == UnitFrom::Assumed).then(assumed)
    }

    /// The [findings](Source::findings) about a record, then a sentence for an [assumption](Source::assumption) and for each
    /// of the [`doubts`] about the `scaled` record.
    pub fn sentences(&self, name: &str, [record, scaled]: [&Record; 2], g: f64, remedy: &str) -> Vec<String> {
        let warnings = self.assumption(remedy).into_iter().chain(doubts(scaled, g));
        let warnings = warnings.map(|warning| format!("{name}: {warning}"));
        [self.findings(name, record, g)].into_iter().chain(warnings).collect()
    }
}

/// The time between the samples of `record`, in words.
pub fn steps(record: &Record) -> String {
    let steps = record.times().windows(2).map(|pair| pair[1] - pair[0]);
    let (least, most) = steps.fold((f64::INFINITY, 0.0_f64), |(least, most), step| (least.min(step), most.max(step)));
    let [least, most] = [least, most].map(short);
    if least == most { format!("step {least} s") } else { format!("steps of {least} to {most} s") }
}

/// Origin of the unit of a record.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnitFrom {
    /// The file.
    File,
    /// The user, if the file states no unit.
    User,
    /// An assumption, if neither states a unit.
    Assumed,
}

const ALL: &str = "all";

fn all<'de, D: Deserializer<'de>>(word: D) -> Result<(), D::Error> {
    let is_all = String::deserialize(word)? == ALL;
    is_all.then_some(()).ok_or_else(|| D::Error::custom("another column"))
}

impl From<&str> for Column {
    /// `all`, a number or a heading.
    fn from(text: &str) -> Column {
        match text.parse() {
            Ok(number) => Column::Number(number),
            Err(_) if text == ALL => Column::All,
            Err(_) => Column::Heading(text.into()),
        }
    }
}

impl fmt::Display for Column {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Column::All => out.write_str(ALL),
            Column::Number(number) => write!(out, "{number}"),
            Column::Heading(heading) => out.write_str(&quote(heading)),
        }
    }
}

impl fmt::Display for Format {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        out.write_str(match self {
            Format::At2 => "PEER AT2",
            Format::Table => "table",
            Format::Esm => "ESM ASCII",
            Format::KNet => "K-NET ASCII",
            Format::Cosmos => "COSMOS",
            Format::Csmip => "CSMIP V2",
        })
    }
}

/// Decides the unit: the unit that the file clearly states on `line`, else the unit of the user, else m/s². The user must not
/// contradict a clear statement, nor a unit of something else.
pub(super) fn decide(stated: &Stated, asked: Option<Unit>, line: usize) -> Result<(Unit, UnitFrom), BadLine> {
    let contradicted = |stated: &dyn fmt::Display, asked: Unit| {
        Err(bad(line, format!("the file states accelerations in {stated}, but the given unit is {asked}")))
    };
    match (stated, asked) {
        (Stated::Other(text), None) if mentions_unit(text) => {
            let problem = format!("{} does not say clearly in which unit the accelerations are", quote(text));
            Err(bad(line, problem).remedied_by(Remedy::Unit))
        }
        (Stated::Other(text), Some(asked)) if mentions_unit(text) => Ok((asked, UnitFrom::User)),
        (Stated::Unit(unit), Some(asked)) if *unit != asked => contradicted(unit, asked),
        (Stated::Unit(unit), _) => Ok((*unit, UnitFrom::File)),
        (Stated::Other(other), Some(asked)) => contradicted(&quote(other), asked),
        (Stated::Nothing | Stated::Multiplied(_), Some(asked)) => Ok((asked, UnitFrom::User)),
        (Stated::Multiplied(heading), None) => {
            let problem = format!("{} has a factor: the unit of the accelerations is not clear", quote(heading));
            Err(bad(line, problem).remedied_by(Remedy::Unit))
        }
        (Stated::Nothing, None) => Ok((Unit::MetrePerSecondSquared, UnitFrom::Assumed)),
        (Stated::Other(other), None) => {
            let known = Unit::NAMES.map(|(name, _)| name).join(", ");
            Err(bad(line, format!("the accelerations are in {}, which is none of {known}", quote(other))))
        }
    }
}
