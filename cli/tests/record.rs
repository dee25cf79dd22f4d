//! `record` driven from outside.

mod command_line;

use approx::assert_relative_eq;
use command_line::{DT, SAMPLES, folder, succeed};
use serde_json::Value;
use std::f64::consts::{PI, TAU};
use std::fs;

const G: f64 = 9.81;

/// A sine of A and T: A T/π, π/(2 g) A² T/2, A T²/(2π), but for the chords' share of (ω h)²/6.
#[test]
fn what_a_record_amounts_to_is_that_of_a_sine() {
    let folder = folder();
    let (printed, _) = succeed(folder.path(), "record pulse.AT2 --format json --picture pulse.svg -o pulse.csv");
    let printed: Value = serde_json::from_str(&printed).unwrap();
    let lines = printed["rows"].as_array().unwrap();
    let amount = |name: &str| lines.iter().find(|line| line["name"] == name).unwrap()["value"].as_f64().unwrap();
    assert_eq!((&printed["file"], &printed["record_unit"]), (&"pulse.AT2".into(), &"g".into()));
    assert_eq!((&printed["scale"], &printed["time_scale"]), (&1.0.into(), &1.0.into()));
    assert!(printed["record"].is_string() && printed["version"].is_string(), "{printed}");
    let (a, period) = (0.6 * G, 0.5);
    let error = (TAU / period * DT).powi(2) / 4.0;
    assert_relative_eq!(amount("PGA"), a, max_relative = error);
    assert_relative_eq!(amount("PGV"), a * period / PI, max_relative = error);
    assert_relative_eq!(amount("I_A"), PI / (2.0 * G) * a * a * period / 2.0, max_relative = error);
    assert_relative_eq!(2.0 * amount("t_5") + amount("D_5-95"), period, max_relative = 1e-9); // the sine is as strong from behind
    assert_relative_eq!(amount("v_end"), 0.0, epsilon = 1e-12);
    assert_relative_eq!(amount("d_end"), a * period * period / TAU, max_relative = error);
    assert_eq!(amount("samples"), SAMPLES as f64);
    let table = fs::read_to_string(folder.path().join("pulse.csv")).unwrap();
    assert!(table.starts_with("time[s],a_g[g]\n0.0,0.0\n0.01,"), "{table}");
    assert!(fs::read_to_string(folder.path().join("pulse.svg")).unwrap().contains("period T (s)"));
}
