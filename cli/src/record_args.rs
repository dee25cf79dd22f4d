//! Which ground motion record a command works on, how it is read, and how it is scaled.
use crate::{significant::short, talk::say};
use anyhow::{anyhow, ensure};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use rocking::record::{Column, Reading, Record, RecordError, Remedy, Source, Unit, UnitFrom};
use std::path::{Path, PathBuf};

/// The record asked for, if any.
#[derive(clap::Args)]
#[command(next_help_heading = "Ground motion")]
pub struct RecordArgs {
    /// Ground motion record: PEER .AT2, ESM, K-NET, COSMOS or CSMIP as published, or columns of text (.csv, .txt, .dat)
    #[arg(long, value_name = "FILE")]
    pub record: Option<PathBuf>,
    /// Unit of accelerations whose file does not state it [default: m/s2]
    #[arg(long, value_parser = unit_parser(), requires = "record")]
    unit: Option<Unit>,
    /// Time between the samples of a record without times: one column; times that are there must not contradict it
    #[arg(long, value_name = "SECONDS", value_parser = positive, requires = "record", allow_negative_numbers = true)]
    dt: Option<f64>,
    /// Column that has the accelerations, by number or heading; or channel of a COSMOS or CSMIP file, by number
    #[arg(long, value_name = "COLUMN", value_parser = column, requires = "record")]
    column: Option<Column>,
    /// Take the samples that are there where the file states another number of them
    #[arg(long, requires = "record")]
    ignore_npts: bool,
    /// Multiplies the record's times
    #[arg(
        long,
        value_name = "FACTOR",
        default_value_t = 1.0,
        value_parser = positive,
        requires = "record",
        allow_negative_numbers = true
    )]
    time_scale: f64,
    /// Multiplies the record's accelerations
    #[arg(
        long,
        value_name = "FACTOR",
        default_value_t = 1.0,
        value_parser = finite,
        requires = "record",
        allow_negative_numbers = true
    )]
    scale: f64,
}

impl RecordArgs {
    /// The record, scaled; `g` (m/s²) is what a record's g stands for. Says what was read, and what was assumed.
    pub fn load(&self, g: f64) -> anyhow::Result<Option<Record>> {
        let Some(path) = &self.record else { return Ok(None) };
        let &RecordArgs { unit, dt, ref column, ignore_npts: ignores_count, time_scale, scale, .. } = self;
        let how = Reading { unit, dt, column: column.clone(), ignores_count };
        let (record, source) = Record::read(path, &how, g).map_err(with_remedy)?;
        say!("record         {}", described(path, &record, &source, g));
        say_warnings(path, &source);
        if (time_scale, scale) == (1.0, 1.0) {
            return Ok(Some(record));
        }
        let record = record.scaled(time_scale, scale);
        let slopes = record.times().windows(2).zip(record.acceleration().windows(2));
        let is_finite = |(t, a): (&[f64], &[f64])| ((a[1] - a[0]) / (t[1] - t[0])).is_finite();
        ensure!(
            record.pga().is_finite() && slopes.into_iter().all(is_finite),
            "--time-scale {time_scale:?} and --scale {scale:?} leave no ground motion with finite accelerations and slopes"
        );
        say!("scaled         {}, peak {} g", steps(&record), short(record.pga() / g));
        Ok(Some(record))
    }
}

impl RecordArgs {
    /// Factors on the record's times and on its accelerations.
    pub fn factors(&self) -> [f64; 2] {
        [self.time_scale, self.scale]
    }
}

/// What a record's file is, and what was assumed where it says nothing, in a line; `g` (m/s²) is what a record's g stands
/// for.
pub fn described(path: &Path, record: &Record, source: &Source, g: f64) -> String {
    let unit_from = match source.unit_from {
        UnitFrom::File => "as the file states",
        UnitFrom::User => "as --unit says",
        UnitFrom::Assumed => "assumed, for the file does not state it",
    };
    let remarks: String = source.remarks.iter().map(|remark| format!(", {remark}")).collect();
    let (format, unit, peak) = (source.format, source.unit, short(record.pga() / g));
    let (path, samples) = (path.display(), record.times().len());
    format!("{path}: {format}{remarks}; {unit} {unit_from}; {samples} samples, {}, peak {peak} g", steps(record))
}

/// Says what is likely wrong with the record in the file at `path`, a line each.
pub fn say_warnings(path: &Path, source: &Source) {
    for warning in &source.warnings {
        say!("warning: {}: {warning}", path.display());
    }
}

/// The time between samples.
fn steps(record: &Record) -> String {
    let steps = record.times().windows(2).map(|pair| pair[1] - pair[0]);
    let (least, most) = steps.fold((f64::INFINITY, 0.0_f64), |(least, most), step| (least.min(step), most.max(step)));
    let [least, most] = [least, most].map(short);
    if least == most { format!("step {least} s") } else { format!("steps of {least} to {most} s") }
}

/// The error with the option that helps.
fn with_remedy(error: RecordError) -> anyhow::Error {
    let RecordError::Malformed { remedy: Some(remedy), .. } = &error else { return error.into() };
    let remedy = match remedy {
        Remedy::IgnoreCount => "--ignore-npts takes those",
        Remedy::Step => "give it with --dt SECONDS",
        Remedy::Column => "choose with --column, by number or heading",
        Remedy::Channel => "choose with --column, by number",
        Remedy::Unit => "say with --unit what they are",
    };
    anyhow!("{error}; {remedy}")
}

fn column(text: &str) -> Result<Column, String> {
    match text.parse() {
        Ok(0) => Err("columns are counted from 1".into()),
        Ok(number) => Ok(Column::Number(number)),
        Err(_) => Ok(Column::Heading(text.into())),
    }
}

/// A number of seconds, or a factor on them.
pub fn positive(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(number) if number > 0.0 && f64::is_finite(number) => Ok(number),
        _ => Err("a finite number greater than 0 is needed".into()),
    }
}

fn finite(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(number) if f64::is_finite(number) => Ok(number),
        _ => Err("a finite number is needed".into()),
    }
}

fn unit_parser() -> impl TypedValueParser<Value = Unit> {
    PossibleValuesParser::new(Unit::NAMES.map(|(name, _)| name)).map(|asked| {
        let found = Unit::NAMES.into_iter().find(|(name, _)| *name == asked);
        found.expect("clap accepts these names alone").1
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_column_has_a_number_or_a_heading() {
        assert_eq!(column("3"), Ok(Column::Number(3)));
        assert_eq!(column("E-W"), Ok(Column::Heading("E-W".into())));
        assert!(column("0").is_err());
    }
}
