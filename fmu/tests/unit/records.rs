//! The record inside: against a run without the FMU, at any steps; its peaks; states; what is refused.

use crate::host::*;
use approx::assert_relative_eq;
use rocking::Output;
use rocking::engine::DEFAULT_TOLERANCE;
use rocking::run::record::Record;
use rocking::{Detail, Engine, LinearLoad, Load, Parameters, State, Structure};
use rocking_records::Reading;
use std::fs;
use std::path::{Path, PathBuf};
use tempfile::TempDir;

const SHOWN: [&str; 6] = ["theta", "u", "a_t", "theta_dot", "u_dot", "R_h"];

/// Numbers between −1 and 1 without an order that matters.
fn noise(i: usize) -> f64 {
    (3.7 * (i * i) as f64).sin()
}

/// A quake of `samples` accelerations, from another one than 0 on.
fn quake(samples: usize) -> impl Iterator<Item = f64> {
    let part = move |i| i as f64 / samples as f64;
    (0..samples).map(move |i| (1.0 - part(i)) * (0.4 * noise(i) + 0.5 * (0.6 * i as f64).cos()))
}

/// In g, at every 20 ms.
pub fn at2(samples: usize) -> String {
    let values: String = quake(samples).map(|a_g| format!("{a_g:e}\n")).collect();
    format!("PEER\nmade up\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS= {samples}, DT= .0200 SEC\n{values}")
}

/// In m/s², at uneven times from 3 s on.
fn csv(samples: usize) -> String {
    let time = |i| 3.0 + 0.015 * i as f64 + 0.006 * noise(i);
    quake(samples).enumerate().map(|(i, a_g)| format!("{},{}\n", time(i), 9.0 * a_g)).collect()
}

/// Files of records.
fn records() -> (TempDir, Vec<PathBuf>) {
    let folder = tempfile::tempdir().unwrap();
    let mut paths = Vec::new();
    for (name, text) in [("even.AT2", at2(600)), ("uneven.csv", csv(400))] {
        paths.push(folder.path().join(name));
        fs::write(paths.last().unwrap(), text).unwrap();
    }
    (folder, paths)
}

/// Multiply a record's times and accelerations: a specimen is smaller than what quakes meet.
const SCALES: (f64, f64) = (0.4, 1.25);

fn read(path: &Path) -> Record {
    let (record, _) = rocking_records::read(path, &Reading::default(), Parameters::EVISON.g).unwrap();
    record.scaled(SCALES.0, SCALES.1).unwrap()
}

/// Relative tolerance: what differs is then not the solver's.
const TOLERANCE: f64 = 1e-12;

/// Ready to step at the level `detail` under the record in the file `path`.
fn following(path: &Path, detail: Detail) -> Host {
    let host = Host::new();
    let scales = [("record_time_scale", SCALES.0), ("record_scale", SCALES.1)];
    assert_eq!(
        (host.set_integer("detail", detail as i32 + 1), host.set(&scales), host.set_boolean("peaks", 1)),
        (OK, OK, OK)
    );
    assert_eq!(host.set_record(path.to_str().unwrap()), OK);
    host.begin(Some(TOLERANCE), 0.0, None);
    host
}

/// The values after each of `steps`.
fn step_through(host: &Host, steps: impl IntoIterator<Item = f64>) -> Vec<Vec<f64>> {
    let mut time = host.last_successful_time();
    let step = |step| {
        assert_eq!(host.step(time, step), OK, "{:?}", host.log);
        time += step;
        host.try_get(&SHOWN).unwrap()
    };
    steps.into_iter().map(step).collect()
}

/// Asserts that `all` ends with `last`, to `tolerance` parts of the largest value in `all`.
fn assert_close(all: &[Vec<f64>], last: &[f64], tolerance: f64) {
    for (i, (found, expected)) in last.iter().zip(all.last().unwrap()).enumerate() {
        let largest = all.iter().fold(f64::MIN_POSITIVE, |largest, shown| largest.max(shown[i].abs()));
        assert!((found - expected).abs() <= tolerance * largest, "{}: {found}, {expected}", SHOWN[i]);
    }
}

/// The peaks of an instance, and their instants.
fn peaks(host: &Host) -> Vec<[f64; 2]> {
    let of_output = |of: Output| ["", "t_"].map(|start| host.get(&format!("{start}{}_max", of.symbol())));
    Output::PEAKS_OF_ONE.map(of_output).into()
}

/// One step over everything, steps of the samples, and steps that miss them all: the same, with the same peaks.
#[test]
fn any_step_meets_every_sample() {
    let (_folder, records) = records();
    let mut most_transitions = 0;
    for path in &records {
        let record = read(path);
        let duration = record.end() - record.start();
        for detail in Detail::ALL {
            let of_samples = following(path, detail);
            let samples = record.times().windows(2).map(|pair| pair[1] - pair[0]);
            let shown = step_through(&of_samples, samples);
            most_transitions = most_transitions.max(of_samples.integer("transitions"));
            for (count, tolerance) in [(1_u32, 1e-12), (7, 1e-9), (1000, 1e-9)] {
                let host = following(path, detail);
                let steps = vec![duration / f64::from(count); count as usize];
                assert_close(&shown, step_through(&host, steps).last().unwrap(), tolerance);
                assert_eq!(host.get("record_duration"), duration);
                for ([found, time], [expected, at]) in peaks(&host).into_iter().zip(peaks(&of_samples)) {
                    assert_relative_eq!(found, expected, max_relative = tolerance);
                    assert_relative_eq!(time, at, max_relative = 1e-9, epsilon = 1e-9);
                }
            }
        }
    }
    assert!(most_transitions > 40, "{most_transitions} transitions");
}

/// The ground is at rest before the record and after it; both jumps are where they belong, in the reactions and in the
/// rates as well, whatever the start time.
#[test]
fn a_record_comes_when_it_is_asked_for() {
    let mut shown = Vec::new();
    for start_time in [0.0, -7.0, 1048576.0] {
        let host = Host::new();
        host.write("steps.csv", "t (s),a\n5,2\n6,4\n7,1\n");
        let placement = [("record_scale", -0.5), ("record_time_scale", 0.5), ("record_start", 0.25)];
        assert_eq!((host.set(&placement), host.set_record("steps.csv"), host.set_boolean("peaks", 1)), (OK, OK, OK));
        assert_eq!((host.setup(None, start_time, None), host.enter()), (OK, OK));
        assert_eq!((host.get("record_duration"), host.get("a_ground")), (1.0, 0.0));
        assert_eq!(host.exit(), OK);
        for (step, a_ground, slope) in [
            (0.125, 0.0, 0.0),
            (0.125, -1.0, -2.0),
            (0.25, -1.5, -2.0),
            (0.25, -2.0, 3.0),
            (0.375, -0.875, 3.0),
            (0.125, 0.0, 0.0),
            (10.0, 0.0, 0.0),
        ] {
            assert_eq!((host.set(&[("a_g", 0.75)]), host.step(host.last_successful_time(), step)), (OK, OK));
            assert_eq!((host.get("a_ground"), host.rate("a_ground", 1)), (a_ground + 0.75, Ok(slope)));
            assert_eq!((host.get("a_g"), host.rate("R_h", 1).is_ok()), (0.75, true));
            shown.push((host.try_get(&SHOWN).unwrap(), host.rate("R_h", 1)));
        }
        assert_relative_eq!(host.get("t_u_max") - start_time, 0.25 + 0.6, epsilon = 0.4);
    }
    let (first, others) = shown.split_at(7);
    assert!(others.chunks(7).all(|other| other == first));

    // what is in the midst of its record at the start
    let host = Host::initializing(&[("record_start", -0.25)]);
    host.write("steps.csv", "t (s),a\n5,2\n6,4\n7,1\n");
    assert_eq!(host.set_record("steps.csv"), OK);
    assert_eq!(host.get("a_ground"), 2.5);
    let at_rest = host.get("R_h");
    assert_relative_eq!(at_rest, -Parameters::EVISON.m0 * 2.5, max_relative = 1e-12);
}

/// An input comes on top, each followed along its slope.
#[test]
fn the_input_adds_to_the_record() {
    let host = Host::initializing(&[]);
    host.write("line.csv", "t (s),a\n0,1\n1,2\n2,0\n");
    assert_eq!((host.set_record("line.csv"), host.exit()), (OK, OK));
    assert_eq!((host.set(&[("a_g", 0.5), ("F_t", 30.0)]), host.set_slope("a_g", 1, -0.25)), (OK, OK));
    assert_eq!(host.set_slope("F_t", 1, 8.0), OK);
    assert_eq!(host.step(0.0, 1.5), OK);
    let structure = Structure::new(Parameters::EVISON).unwrap();
    let mut engine = Engine::new(structure, State::default(), 0.0, DEFAULT_TOLERANCE).unwrap();
    for (duration, value, slope) in [(1.0, (1.5, 30.0), (0.75, 8.0)), (0.5, (2.25, 38.0), (-2.25, 8.0))] {
        let load = |(a_g, F_t)| Load { a_g, F_t, a_v: 0.0 };
        engine.advance(duration, LinearLoad { value: load(value), slope: load(slope) }, &mut ()).unwrap();
    }
    let state = engine.motion().state;
    assert_eq!(host.try_get(&["theta", "u", "u_dot"]).unwrap(), [state.theta, state.u, state.u_dot]);
    assert_relative_eq!(host.get("a_g"), 0.125);
    assert_relative_eq!(host.get("a_ground"), 1.125);
}

/// A record that cannot be followed is told when initialization ends, or before if its values are asked for; nothing changes.
#[test]
fn a_record_that_cannot_be_followed_is_refused() {
    let host = Host::initializing(&[]);
    let folder = host.resources.path().display().to_string();
    host.write("broken.csv", "t,a\n0,1\n0.1,root:x:0\n0.2,3\n");
    host.write("strong.csv", "t (s),a\n0,1\n1,-6000\n");
    host.write("late.csv", "t/s,a\n0.5,1\n1,0\n");
    fs::create_dir(host.resources.path().join("folder.csv")).unwrap();
    let begins = "record_v: the vertical component \"late\" begins at 0.5 s and \"strong\" at 0.0 s";
    for (record, record_v, message) in [
        ("broken.csv", "", &*format!("{folder}/broken.csv, line 3: the acceleration \"root:x:0\" is not a number")),
        ("strong.csv", "", "the record, as it is scaled: a_g = 12000 m/s2 is out of range: it must lie between"),
        (
            "",
            "up.csv",
            &format!("record_v = \"up.csv\" is not in {folder}; a path on disk needs a separator: ./up.csv"),
        ),
        ("strong.csv", "late.csv", begins),
        ("..", "", &format!("record: {folder}/.. is not a file")),
        ("folder.csv", "", &format!("record: {folder}/folder.csv is not a file")),
        ("file:a.csv", "", "record = \"file:a.csv\" is not a file URI of this machine, such as file:///tmp/record.A"),
        ("./absent.AT2", "", "record: the record ./absent.AT2 cannot be read: No such file or directory (os error"),
    ] {
        assert_eq!((host.set_record(record), host.set(&[("record_scale", 2.0)])), (OK, OK));
        assert_eq!(host.set_text("record_v", record_v), OK);
        host.assert_refused(|| host.exit(), ERROR, message);
        host.assert_refused(|| host.try_get(&["a_ground"]), Err(ERROR), message);
        assert_eq!((host.get("record_scale"), host.record().as_str()), (2.0, record));
    }
    assert_eq!(host.set_record("strong.csv"), OK);
    assert_eq!((host.set_text("record_v", ""), host.set(&[("record_scale", -1.0)]), host.exit()), (OK, OK, OK));
    assert_eq!((host.get("a_ground"), host.get("record_duration")), (-1.0, 1.0));
}

/// A record is parsed once: another run only reads the bytes of the file and scales the samples.
#[test]
fn a_record_is_kept_for_another_run() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("long.AT2");
    fs::write(&path, at2(20_000)).unwrap();
    let size = fs::metadata(&path).unwrap().len();
    let host = Host::new();
    let allocated = || {
        assert_eq!((host.set_record(path.to_str().unwrap()), host.enter()), (OK, OK));
        allocation_counter::measure(|| assert_eq!(host.exit(), OK)).bytes_total
    };
    let parsed = allocated();
    assert_eq!(host.reset(), OK);
    let (again, samples) = (allocated(), 16 * 20_000);
    assert!(again < size + samples + size / 10 && 2 * again < parsed, "{again} bytes, at first {parsed}");
}

/// The vertical component alone: the weight that the ground carries is (m + m0) (g + a_v).
#[test]
fn the_ground_carries_the_weight_under_both_accelerations() {
    let host = Host::initializing(&[("record_scale", 2.0)]);
    host.write("up.csv", "t/s,a (cm/s2)\n0,0\n1,100\n2,0\n");
    assert_eq!((host.set_text("record_v", "up.csv"), host.exit()), (OK, OK));
    assert_eq!((host.step(0.0, 0.75), host.set(&[("a_v", -12.0)])), (OK, OK));
    assert_relative_eq!(host.get("a_v_ground"), 1.5 - 12.0, max_relative = 1e-14);
    let mass = Parameters::EVISON.m + Parameters::EVISON.m0;
    assert_relative_eq!(host.get("R_v"), mass * (9.81 + 1.5 - 12.0), max_relative = 1e-12);
}

/// Before the first step the log tells what a record's file is and what is assumed of it, if events are asked for, and warns
/// of what is doubtful in any case.
#[test]
fn what_was_found_and_assumed_of_a_record_is_logged_before_the_run() {
    for (text, found, scale, doubts) in [
        ("t (s),a (g)\n0,0.1\n0.01,0.2\n", "table, ", 1.0, 0),
        ("t (s),a\n0,0.1\n0.01,0.2\n", "m/s2 assumed", 1.0, 1),
        ("t (s),a (g)\n0,90\n0.01,0\n", "table, ", 1.0, 2),
        ("t (s),a (g)\n0,90\n0.01,0\n", "table, ", 1e-3, 0),
    ] {
        let host = Host::instantiate(Instantiate { logging_on: 1, ..Instantiate::default() }).unwrap();
        host.write("a.csv", text);
        assert_eq!(host.set(&[("record_scale", scale)]), OK);
        assert_eq!(host.set_record("a.csv"), OK);
        host.begin(None, 0.0, None);
        let log = host.log.take();
        assert!(log[0].text.starts_with("a.csv: ") && log[0].text.contains(found), "{log:?}");
        assert_eq!((log[0].category.as_str(), log.len()), ("logEvents", 1 + doubts), "{log:?}");
        assert!(log[1..].iter().all(|message| message.category == "logStatusWarning"), "{log:?}");
    }
}
