//! A record as tables that are read without options; their numbers read back to the same bits.
use rocking::run::record::Record;

/// The horizontal component of `record` as CSV, in s and m/s².
pub fn csv(record: &Record) -> String {
    table(record, "a_g", record.acceleration())
}

/// The vertical component, if there is one, likewise.
pub fn vertical_csv(record: &Record) -> Option<String> {
    record.vertical().map(|a_v| table(record, "a_v", a_v))
}

fn table(record: &Record, called: &str, accelerations: &[f64]) -> String {
    let samples = record.times().iter().zip(accelerations);
    let lines: String = samples.map(|(time, a)| format!("{time:?},{a:?}\n")).collect();
    format!("time[s],{called}[m/s2]\n{lines}")
}
