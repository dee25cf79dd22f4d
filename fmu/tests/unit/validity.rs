//! The limits that a motion passes: as the engine's own run finds it, told once, kept in states, and not watched unless it is asked for.

use crate::host::*;
use FlexibleRocking::BUILD;
use approx::assert_relative_eq;
use fmi_unit::snapshot::Snapshot;
use rocking::Output;
use rocking::run::fall::Falling;
use rocking::run::validity::{ASSUMPTIONS, Findings, Limits};
use rocking::run::{End, Run};
use rocking::{Detail, Parameters, Structure};
use rocking_records::Reading;
use std::fs;

/// With full restitution a structure gains energy at impacts, and without stiffness it takes tension to hold its base down.
const LIVELY: [(&str, f64); 2] = [("r", 1.0), ("f_fc", 4.0)];

/// A sum of two sines of 5 s in m/s², every 20 ms.
fn quake() -> String {
    let line = |i: u32| {
        let t = 0.02 * f64::from(i);
        format!("{t},{}\n", 3.0 * (9.0 * t).sin() + 2.0 * (31.0 * t).sin())
    };
    (0..=250).map(line).collect()
}

/// Ready to step, its ground about to quake.
fn host(validity: i32) -> Host {
    let host = Host::initializing(&LIVELY);
    host.write("quake.csv", &quake());
    assert_eq!((host.set_record("quake.csv"), host.set_boolean("validity", validity)), (OK, OK));
    assert_eq!(host.set_boolean("peaks", validity), OK);
    assert_eq!(host.exit(), OK, "{:?}", host.log);
    host.log.take();
    host
}

/// Over `steps` (s) from `time` (s) on.
fn step(host: &Host, mut time: f64, steps: &[f64]) {
    for step in steps {
        assert_eq!(host.step(time, *step), OK, "{:?}", host.log);
        time += step;
    }
}

/// The same run without the FMU.
fn expected() -> Findings {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("quake.csv");
    fs::write(&path, quake()).unwrap();
    let (ground, _) = rocking_records::read(&path, &Reading::default(), 9.81).unwrap();
    let structure = Structure::new(Parameters { r: 1.0, f_fc: 4.0, ..Parameters::EVISON }).unwrap();
    let run = Run { end: End::At(5.0), ..Run::new(structure, &ground) };
    run.validity(Limits::default()).unwrap().0
}

fn read(host: &Host) -> Vec<f64> {
    ASSUMPTIONS.iter().flat_map(|of| [of.name, of.time_name]).map(|name| host.get(name)).collect()
}

/// Whatever the steps, the values are those of the engine's own run, and each limit that was passed is told once.
#[test]
fn what_is_gone_beyond_is_that_of_a_run_and_told_once() {
    let expected = expected();
    for steps in [vec![5.0], vec![0.1; 50], vec![0.013, 1.7, 0.5, 2.787]] {
        let host = host(1);
        step(&host, 0.0, &steps);
        for (pair, worst) in read(&host).chunks(2).zip(&expected.worst) {
            if worst.value.is_finite() {
                assert_relative_eq!(pair[0], worst.value, max_relative = 1e-9);
            } else {
                assert_eq!(pair[0], worst.value);
            }
            assert_relative_eq!(pair[1], worst.time, max_relative = 1e-9);
        }
        assert_eq!(host.integer("energy_gains") as u64, expected.gains);
        let log = host.log.take();
        let told: Vec<_> =
            ASSUMPTIONS.iter().zip(&expected.worst).filter_map(|(of, worst)| Some((of, worst.first_beyond?))).collect();
        assert_eq!(log.len(), told.len(), "{log:?}");
        for (assumption, first) in told {
            let has_its_name = |message: &&Message| message.text.contains(&format!(" s: {} is ", assumption.name));
            let message = log.iter().find(has_its_name).unwrap();
            assert_eq!((message.status, message.category.as_str()), (WARNING, "logStatusWarning"));
            let said: f64 = message.text.split(' ').nth(2).unwrap().parse().unwrap();
            assert_relative_eq!(said, first, max_relative = 5e-6);
            assert!(message.text.contains(assumption.meaning), "{}", message.text);
        }
    }
    let passed = expected.worst.map(|worst| worst.first_beyond.is_some());
    assert!(expected.gains > 0 && passed == [true, true, true, false, false, true, false], "{expected:?}");
}

/// Of the start itself, before any step.
#[test]
fn limits_are_known_at_the_start() {
    let turned = Host::initializing(&[("theta_0", 0.02)]);
    assert_eq!((turned.set_boolean("validity", 1), turned.exit()), (OK, OK));
    assert_eq!(turned.get("R_v_min"), turned.get("R_v") / ((125.8 + 44.02) * 9.81));
    let not_down = (turned.get("tension_max"), turned.get("energy_gain_max"));
    assert_eq!(not_down, (f64::NEG_INFINITY, 0.0), "the base has not been down");
}

/// Without `validity` and `peaks` nothing is watched, and the work is the same to the last step.
#[test]
fn what_nobody_asks_for_is_not_watched() {
    let run = |validity| {
        let host = host(validity);
        step(&host, 0.0, &[5.0]);
        let course = course::<f64>(&Snapshot::deserialize(BUILD, &host.bytes()).unwrap()).unwrap();
        (host, course)
    };
    let ((_, with), (silent, without)) = (run(1), run(0));
    assert_eq!(with.motion, without.motion);
    let structure = Structure::new(Parameters { r: 1.0, f_fc: 4.0, ..Parameters::EVISON }).unwrap();
    let nothing = Falling::since(0.0, &structure, Detail::Auto);
    assert_eq!((without.peaks, without.validity), (nothing, Findings::since(0.0)));
    assert!(with.peaks.all().theta().magnitude > 0.0);
    assert_relative_eq!(with.validity.duration, 5.0, max_relative = 1e-12);
    assert!(read(&silent).iter().all(|value| value.is_nan()) && silent.integer("energy_gains") == 0);
    assert!(
        Output::PEAKS_OF_ONE
            .iter()
            .all(|of| ["", "t_"].iter().all(|t| silent.get(&format!("{t}{}_max", of.symbol())).is_nan()))
    );
    assert!(silent.log.take().is_empty());
}
