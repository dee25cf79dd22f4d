//! Hostile calls of the example.
#![allow(unsafe_code)] // the C interface

#[path = "../examples/bouncing_ball.rs"]
#[allow(dead_code)] // main
mod bouncing_ball;
mod hostile;

use bouncing_ball::{Ball as Model, fmi2, fmi3};
use fmi_unit::Model as _;
use fmi_unit::snapshot::Snapshot;
use fmi_unit::state_machine::Stage;
use hostile::{Subject, hostile_calls};
use std::path::Path;

hostile_calls!(ball);

fn ball() -> Subject {
    let never_in = &[Stage::StepFailed, Stage::Error];
    Subject { never_in, ..Subject::of(tempfile::tempdir().unwrap(), time) }
}

fn time(snapshot: &Snapshot) -> f64 {
    let mut ball = Model::open(Path::new("")).unwrap();
    ball.restore(&snapshot.model).unwrap();
    ball.time().unwrap()
}
