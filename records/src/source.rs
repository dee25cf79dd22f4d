//! Options for reading a record's file, and the findings and assumptions about the file.

use super::text::quote;
use super::unit::HeadingUnit;
use super::{BadLine, Record, Remedy, Unit, bad};
use rocking::digits::short;
use serde::{Deserialize, Deserializer, de::Error};
use std::fmt;

/// Options of the user for facts that a file does not state.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Reading {
    /// Unit of the accelerations; must be the unit that a published file states, and overrides the heading of a table.
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

/// Origin of a record: statements of its file, and assumptions about missing statements.
#[derive(Clone, Debug, PartialEq)]
pub struct Origin {
    /// Name of its layout: one of [`FORMATS`](crate::FORMATS), or `table`.
    pub format: &'static str,
    pub unit: Unit,
    pub unit_from: UnitFrom,
    /// Other findings and assumptions, such as the column and the number of lines of headings.
    pub remarks: Vec<String>,
}

impl Origin {
    /// Findings and assumptions in a sentence, for `record` (m/s²), which was read from the file called `name`. The peak is
    /// reported in units of `g` (m/s²).
    pub fn findings(&self, name: &str, record: &Record, g: f64) -> String {
        let unit_from = match self.unit_from {
            UnitFrom::File => "as the file states",
            UnitFrom::User | UnitFrom::Overridden(_) => "as given",
            UnitFrom::Assumed => "assumed",
        };
        let remarks: String = self.remarks.iter().map(|remark| format!(", {remark}")).collect();
        let (format, unit, samples) = (self.format, self.unit, record.times().len());
        let (steps, peak) = (steps(record), short(record.pga() / g));
        format!("{name}: {format}{remarks}; {unit} {unit_from}; {samples} samples, {steps}, peak {peak} g")
    }

    /// A warning of a unit that is assumed, with the `remedy`, or that a heading contradicts.
    pub fn assumption(&self, remedy: &str) -> Option<String> {
        match self.unit_from {
            UnitFrom::Assumed => {
                Some(format!("the file states no unit of acceleration: {} is assumed; {remedy}", self.unit))
            }
            UnitFrom::Overridden(unit) => {
                Some(format!("the heading states {unit}, and the given unit is {}", self.unit))
            }
            UnitFrom::File | UnitFrom::User => None,
        }
    }
}

/// The time between the samples of `record`, in words.
pub fn steps(record: &Record) -> String {
    let steps = record.times().windows(2).map(|pair| pair[1] - pair[0]);
    let (least, most) = steps.fold((f64::INFINITY, 0.0_f64), |(least, most), step| (least.min(step), most.max(step)));
    let [least, most] = [least, most].map(short);
    if least == most { format!("step {least} s") } else { format!("steps of {least} to {most} s") }
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum UnitFrom {
    File,
    /// The user, if the file states no unit.
    User,
    /// The user, although the heading of a table states this unit.
    Overridden(Unit),
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

impl Column {
    /// The text by which the column was asked for.
    pub fn as_asked(&self) -> String {
        match self {
            Column::Heading(heading) => heading.clone(),
            Column::All | Column::Number(_) => self.to_string(),
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

/// The unit that a published file states on `line`; the user must not contradict it.
pub(super) fn of_file(stated: &str, asked: Option<Unit>, line: usize) -> Result<(Unit, UnitFrom), BadLine> {
    let problem = match (Unit::named(stated), asked) {
        (Some(unit), Some(asked)) if unit != asked => {
            format!("the file states accelerations in {unit}, but the given unit is {asked}")
        }
        (Some(unit), _) => return Ok((unit, UnitFrom::File)),
        (None, _) => {
            let known = Unit::NAMES.map(|(name, _)| name).join(", ");
            format!("the accelerations are in {}, which is none of {known}", quote(stated))
        }
    };
    Err(bad(line, problem))
}

/// The unit of the user, else the one that the headings of a table state, the last on `line`, else m/s².
pub(super) fn of_heading(stated: HeadingUnit, asked: Option<Unit>, line: usize) -> Result<(Unit, UnitFrom), BadLine> {
    match (stated, asked) {
        (HeadingUnit::Unit(unit), Some(asked)) if unit != asked => Ok((asked, UnitFrom::Overridden(unit))),
        (HeadingUnit::Unit(unit), _) => Ok((unit, UnitFrom::File)),
        (_, Some(asked)) => Ok((asked, UnitFrom::User)),
        (HeadingUnit::Nothing, None) => Ok((Unit::MetrePerSecondSquared, UnitFrom::Assumed)),
        (HeadingUnit::Unclear(text), None) => {
            let problem = format!("{} does not say clearly in which unit the accelerations are", quote(&text));
            Err(bad(line, problem).remedied_by(Remedy::Unit))
        }
    }
}
