//! The example: hostile calls, and what follows from its table.
#![allow(unsafe_code)] // the C interface

#[path = "../examples/bouncing_ball.rs"]
#[allow(dead_code)] // main
mod bouncing_ball;
mod hostile;

use bouncing_ball::{Ball as Model, fmi2, fmi3};
use fmi_unit::snapshot::Snapshot;
use fmi_unit::variables::{dependencies, position};
use fmi_unit::{Experiment, Model as _};
use hostile::{Target, hostile_calls};
use std::path::Path;

hostile_calls!(ball);

fn ball() -> Target {
    Target::of(tempfile::tempdir().unwrap(), time)
}

fn time(snapshot: &Snapshot) -> f64 {
    let mut ball = Model::open(Path::new("")).unwrap();
    ball.restore(&snapshot.model, true).unwrap();
    ball.time().unwrap()
}

/// Dependencies come from the table, and derivatives by states from differences.
#[test]
fn what_the_model_does_not_write_follows_from_what_it_does() {
    let mut ball = Model::open(Path::new("")).unwrap();
    let table = ball.variables();
    assert_eq!(dependencies(&table, position(&table, "der(h)"), false), [position(&table, "v")]);
    let calculated = table.iter().filter(|variable| variable.is_initial_unknown());
    assert_eq!(calculated.map(|variable| &*variable.name).collect::<Vec<_>>(), ["der(h)", "der(v)", "bounces"]);
    let by = ball.derivatives(&[4, 6], &[(0, 2.0), (1, 3.0)], true).unwrap();
    assert!((by[0] - 3.0).abs() < 1e-6 && (by[1] - 2.0).abs() < 1e-6, "{by:?}");
    assert_eq!((ball.states().unwrap(), ball.state_rates().unwrap()), (vec![1.0, 0.0], vec![0.0, -9.81]));
    ball.set_up(&Experiment { start_time: 2.0, ..Experiment::default() });
    assert_eq!(ball.time().unwrap(), 2.0);
}
