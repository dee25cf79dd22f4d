//! A record as tables that are read without options; their numbers read back to the same bits.

use super::Unit;
use rocking::run::record::Record;

/// The components of `record` as CSV, the horizontal one first and the vertical one if there is one. The accelerations are in
/// `units`, which the headings state.
pub fn csv_in(record: &Record, [unit, vertical]: [Unit; 2]) -> (String, Option<String>) {
    let table = |heading: String, accelerations: &[f64]| {
        let samples = record.times().iter().zip(accelerations);
        let lines: String = samples.map(|(time, a)| format!("{time:?},{a:?}\n")).collect();
        format!("time[s],{heading}\n{lines}")
    };
    let a_v = record.vertical().map(|a_v| table(format!("a_v[{vertical}]"), a_v));
    (table(format!("a_g[{unit}]"), record.acceleration()), a_v)
}
