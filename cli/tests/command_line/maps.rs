//! Pulses and their overturning spectra, driven from outside.

use crate::succeed;
use rocking_sweep::pulse::DEFAULT_ERROR;
use std::collections::HashMap;
use std::fs;

/// 12 × 12 points at a level that costs little.
const MAP: &str = "
detail = 'modal'
[pulses]
shape = 'sine'
frequency = { from = 1, to = 9, count = 12 }
amplitude = { from = 0.5, to = 9, count = 12, log = true }
dimensionless = true
[[structures]]
name = 'McManus'
preset = 'mcmanus'
";

/// A row has the numbers that `simulate` prints for the pulse that `pulse` writes.
#[test]
fn a_point_is_a_simulation_of_its_pulse() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    fs::write(folder.join("map.toml"), MAP).unwrap();
    succeed(folder, "sweep map.toml");
    let mut rows = csv::Reader::from_path(folder.join("map.csv")).unwrap();
    let mut rows = rows.deserialize().map(|row| row.unwrap());
    let row: HashMap<String, String> = rows.find(|row: &HashMap<_, _>| row["fate"] == "stands").unwrap();
    let cell = |heading: &str| row[heading].as_str();
    let ratios = (cell("omega/p_l"), cell("a_p/(g tan alpha_cg)"));
    let pulse = format!("pulse sine --frequency-ratio {} --amplitude-ratio {}", ratios.0, ratios.1);
    succeed(folder, &pulse);
    let (printed, _) = succeed(folder, "simulate --record pulse.csv --detail modal --format json");
    let printed: serde_json::Value = serde_json::from_str(&printed).unwrap();
    let parameters = rocking::Parameters::MCMANUS;
    for (heading, value) in [("m[kg]", parameters.m), ("r", parameters.r), ("error", DEFAULT_ERROR)] {
        assert_eq!(cell(heading).parse(), Ok(value), "{heading}");
    }
    let alpha = rocking::OneMass::new(parameters).unwrap().tan_alpha_cg.atan();
    let peaks = printed["peaks"].as_array().unwrap();
    let theta = peaks.iter().find(|peak| peak["name"] == "theta").unwrap()["peak"].as_f64().unwrap();
    let ratio: f64 = cell("theta_max/alpha_cg").parse().unwrap();
    assert!((theta / alpha / ratio - 1.0).abs() < 1e-9, "{theta} {ratio}");
    assert_eq!(printed["transitions"].to_string(), cell("transitions"));
}
