//! A record as tables that are read without options; their numbers read back to the same bits.

use super::Unit;
use rocking::run::record::Record;

/// The horizontal component of `record` as CSV; the accelerations are in `unit`, which the heading states.
pub fn csv_in(record: &Record, unit: Unit) -> String {
    table(record, &format!("a_g[{unit}]"), record.acceleration())
}

/// The vertical component, if there is one, likewise.
pub fn vertical_csv(record: &Record, unit: Unit) -> Option<String> {
    record.vertical().map(|a_v| table(record, &format!("a_v[{unit}]"), a_v))
}

fn table(record: &Record, heading: &str, accelerations: &[f64]) -> String {
    let samples = record.times().iter().zip(accelerations);
    let lines: String = samples.map(|(time, a)| format!("{time:?},{a:?}\n")).collect();
    format!("time[s],{heading}\n{lines}")
}
