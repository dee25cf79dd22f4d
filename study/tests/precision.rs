//! A small version of the work-precision diagrams.

mod synthetic;

use indicatif::ProgressBar;
use study::engine;
use study::precision::{MethodCurve, StudyLimits, measure, write};
use study::response::RunFailure;

/// Five points to each curve, whatever a run takes.
const SMALL: StudyLimits = StudyLimits { run: 0.0, points: 5 };

fn errors(curve: &MethodCurve) -> Vec<f64> {
    curve.points.iter().map(|point| point.errors.as_ref().unwrap().theta).collect()
}

#[test]
fn the_curves_are_what_the_methods_are_known_for() {
    let diagram = measure(&synthetic::scene(), SMALL, None, &ProgressBar::hidden()).unwrap();
    let curve = |name| diagram.curves.iter().find(|curve| curve.name == name).unwrap();
    // 6 levels, 6 textbook methods twice, 6 solvers of libraries, this project with the input held
    assert_eq!(diagram.curves.len(), 25);
    assert!(diagram.curves.iter().all(|curve| curve.points.len() == 5));
    assert!((1e-13..1e-10).contains(&diagram.conditioning.theta), "{:?}", diagram.conditioning);

    let auto = curve("this project, auto");
    for (point, error) in auto.points.iter().zip(errors(auto)) {
        assert!(error < point.setting, "{error} at tolerance {}", point.setting);
    }
    let at_step_ends = curve("RK4, transitions at step ends");
    let evaluations: Vec<f64> = at_step_ends.points.iter().map(|point| point.evaluations).collect();
    assert_eq!(evaluations, [4.0, 8.0, 16.0, 32.0, 64.0]);
    assert!(errors(curve("RK4"))[4] < 1e-3 * errors(at_step_ends)[4]);

    assert!(errors(curve("this project, input held")).iter().all(|error| *error > 1e-4));

    for name in ["ode_solvers Dopri5", "ode_solvers Dop853", "differential-equations DOP853"] {
        assert!(errors(curve(name))[4] < 1e-2, "{name}");
    }
    let own_events = curve("differential-equations DOP853, its events");
    let falls =
        own_events.points.iter().filter(|point| matches!(point.errors, Err(RunFailure::ThroughTheFloor { .. })));
    assert!(falls.count() >= 3, "{own_events:?}");
}

#[test]
fn the_command_writes_what_it_has_measured() {
    let docs = tempfile::tempdir().unwrap();
    let scene = synthetic::scene();
    write(std::slice::from_ref(&scene), SMALL, None, docs.path(), &ProgressBar::hidden()).unwrap();
    let mut csv = csv::Reader::from_path(docs.path().join("accuracy-synthetic.csv")).unwrap();
    let rows: Vec<_> = csv.records().map(Result::unwrap).collect();
    assert_eq!(rows.len(), 25 * 5);
    let row = rows.iter().find(|row| &row[0] == "this project, auto" && row[2].starts_with("1.000000e-3")).unwrap();
    let response = engine::run(&scene, rocking::Detail::Auto, 1e-3, &mut ());
    let errors = response.errors(&engine::reference(&scene)).unwrap();
    assert_eq!(row[6], format!("{:.3e}", errors.theta));
    assert_eq!(row[5], response.transitions.to_string());
    assert_eq!(row[4], format!("{:.3}", response.evaluations as f64 / scene.intervals() as f64));
    assert!(rows.iter().any(|row| row[9].starts_with("falls through the ground")));
}
