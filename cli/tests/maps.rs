//! Pulses and their overturning spectra, driven from outside.

mod command_line;

use command_line::succeed;
use rocking_sweep::pulse::DEFAULT_ERROR;
use std::{
    fs,
    path::Path,
    process::{Command, Stdio},
    thread::sleep,
    time::Duration,
};
use tempfile::TempDir;

/// 12 × 12 points with a boundary in the middle, at a level that costs little.
const MAP: &str = "
detail = 'modal'
refine = 1
condition = true
[pulses]
shape = 'sine'
error = 1e-3
frequency = { from = 1, to = 9, count = 12 }
amplitude = { from = 0.5, to = 9, count = 12, log = true }
dimensionless = true
[[structures]]
name = 'McManus'
preset = 'mcmanus'
";

fn map(toml: &str) -> TempDir {
    let folder = TempDir::new().unwrap();
    fs::write(folder.path().join("map.toml"), toml).unwrap();
    folder
}

/// The rows of a file, sorted.
fn rows(folder: &Path, name: &str) -> Vec<String> {
    let text = fs::read_to_string(folder.join(name)).unwrap();
    let mut rows: Vec<_> = text.lines().skip(1).map(str::to_owned).collect();
    rows.sort_unstable();
    rows
}

/// The place of a column.
fn column(folder: &Path, name: &str, heading: &str) -> usize {
    let text = fs::read_to_string(folder.join(name)).unwrap();
    let found = text.lines().next().unwrap().split(',').position(|found| found == heading);
    found.unwrap_or_else(|| panic!("no {heading}"))
}

/// The same points to the bit for any number of threads, and the same picture.
#[test]
fn a_map_is_the_same_however_it_came_about() {
    let folder = map(MAP);
    let folder = folder.path();
    let (printed, _) = succeed(folder, "sweep map.toml --threads 1 -o one.csv --picture one.svg");
    succeed(folder, "sweep map.toml --threads 2 -o two.csv --picture two.svg");
    let expected = rows(folder, "one.csv");
    assert!(expected.len() > 144, "no refinement");
    assert_eq!(rows(folder, "two.csv"), expected);

    let picture = |name: &str| fs::read(folder.join(name)).unwrap();
    assert!(picture("one.svg") == picture("two.svg"));
    let (again, said) = succeed(folder, "sweep map.toml -o two.csv --picture two.svg");
    assert_eq!(again, printed);
    assert!(!said.contains("points in"), "something was run again: {said}");
    assert_eq!(rows(folder, "two.csv"), expected);
}

/// Whoever stops a sweep is told that it can go on, and finds no file of it but the rows.
#[cfg(target_os = "linux")]
#[test]
fn a_stopped_map_leaves_its_rows_alone() {
    let folder = map(&MAP.replace("count = 12 }", "count = 400 }"));
    let folder = folder.path();
    // whatever the tests themselves are deaf to, as under nohup or in the background of a script
    let mut sweep = Command::new("env")
        .args(["--default-signal", env!("CARGO_BIN_EXE_rocking-fmu"), "sweep", "map.toml"])
        .current_dir(folder)
        .stderr(Stdio::piped())
        .spawn()
        .unwrap();
    let rows = || fs::read_to_string(folder.join("map.csv")).map_or(0, |text| text.lines().count());
    while rows() < 10 {
        assert_eq!(sweep.try_wait().unwrap(), None, "it has ended by itself");
        sleep(Duration::from_millis(5));
    }
    assert!(Command::new("kill").args(["-INT", &sweep.id().to_string()]).status().unwrap().success());
    let end = sweep.wait_with_output().unwrap();
    let said = String::from_utf8(end.stderr).unwrap();
    assert_eq!(end.status.code(), Some(130), "{said}");
    assert!(said.ends_with("stopped: finished runs are in map.csv; the same command continues from there\n"), "{said}");
    let mut names: Vec<_> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    names.sort_unstable();
    assert_eq!(names, ["map.csv", "map.toml"]);
}

/// What a row says of a point is what `simulate` says of the pulse that `pulse` writes.
#[test]
fn a_point_is_a_simulation_of_its_pulse() {
    let folder = map(&MAP.replace("error = 1e-3", ""));
    let folder = folder.path();
    succeed(folder, "sweep map.toml -o map.csv");
    let row = rows(folder, "map.csv").into_iter().find(|row| row.contains(",stands,")).unwrap();
    let cell = |heading: &str| row.split(',').nth(column(folder, "map.csv", heading)).unwrap();
    let ratios = (cell("omega/p_l"), cell("a_p/(g tan alpha_cg)"));
    let pulse = format!("pulse sine --frequency-ratio {} --amplitude-ratio {}", ratios.0, ratios.1);
    succeed(folder, &pulse);
    let (printed, _) = succeed(folder, "simulate --record pulse.csv --detail modal --format json");
    let printed: serde_json::Value = serde_json::from_str(&printed).unwrap();
    let parameters = rocking::Parameters::MCMANUS;
    for (heading, value) in [("m[kg]", parameters.m), ("r", parameters.r), ("error", DEFAULT_ERROR)] {
        assert_eq!(cell(heading).parse(), Ok(value), "{heading}");
    }
    let alpha = rocking::Structure::new(parameters).unwrap().tan_alpha_cg.atan();
    let peaks = printed["peaks"].as_array().unwrap();
    let theta = peaks.iter().find(|peak| peak["name"] == "theta").unwrap()["peak"].as_f64().unwrap();
    let ratio: f64 = cell("theta_max/alpha_cg").parse().unwrap();
    assert!((theta / alpha / ratio - 1.0).abs() < 1e-9, "{theta} {ratio}");
    assert_eq!(printed["transitions"].to_string(), cell("transitions"));
}
