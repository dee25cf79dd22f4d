//! Which ground motion record a command works on, and how it is scaled.
use clap::builder::{PossibleValuesParser, TypedValueParser};
use rocking::record::{Record, Unit};
use std::path::PathBuf;

/// The record asked for, if any.
#[derive(clap::Args)]
#[command(next_help_heading = "Ground motion")]
pub struct RecordArgs {
    /// Ground motion record: PEER .AT2, or .csv/.txt with lines of time (s) and acceleration
    #[arg(long, value_name = "FILE")]
    pub record: Option<PathBuf>,
    /// Unit of the accelerations in a .csv/.txt record; an .AT2 record is in g
    #[arg(long, default_value = "m/s2", value_parser = unit_parser(), requires = "record")]
    unit: Unit,
    /// Multiplies the record's times
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = positive, requires = "record")]
    time_scale: f64,
    /// Multiplies the record's accelerations
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, allow_negative_numbers = true, requires = "record")]
    scale: f64,
}

impl RecordArgs {
    /// The record, scaled; `g` (m/s²) is what a record's g stands for.
    pub fn load(&self, g: f64) -> anyhow::Result<Option<Record>> {
        let read = |path| Ok(Record::read(path, self.unit, g)?.scaled(self.time_scale, self.scale));
        self.record.as_deref().map(read).transpose()
    }
}

/// A number of seconds, or a factor on them.
pub fn positive(text: &str) -> Result<f64, String> {
    match text.parse() {
        Ok(number) if number > 0.0 && f64::is_finite(number) => Ok(number),
        _ => Err("a finite number greater than 0 is needed".into()),
    }
}

fn unit_parser() -> impl TypedValueParser<Value = Unit> {
    PossibleValuesParser::new(["g", "m/s2"]).map(|name| match name.as_str() {
        "g" => Unit::G,
        _ => Unit::MetrePerSecondSquared,
    })
}
