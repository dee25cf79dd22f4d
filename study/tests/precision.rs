//! A small version of the work-precision diagrams.

mod synthetic;

use indicatif::ProgressBar;
use study::engine;
use study::precision::{Curve, Diagram, Family, Limits, measure, write};
use study::response::{Errors, Failure};

/// Five points to each curve, whatever a run takes.
const SMALL: Limits = Limits { run: 0.0, points: 5 };

fn small() -> Diagram {
    measure(&synthetic::scene(), SMALL, &ProgressBar::hidden()).unwrap()
}

fn curve<'a>(diagram: &'a Diagram, family: Family, name: &str) -> &'a Curve {
    diagram.curves.iter().find(|curve| curve.family == family && curve.name == name).unwrap()
}

fn errors(curve: &Curve) -> Vec<f64> {
    curve.points.iter().map(|point| point.errors.as_ref().unwrap().theta).collect()
}

#[test]
fn the_curves_are_what_the_methods_are_known_for() {
    let diagram = small();
    // 6 levels, 6 textbook methods twice, 6 solvers of libraries, 3 ways to feed the FMU
    assert_eq!(diagram.curves.len(), 27);
    assert!(diagram.curves.iter().all(|curve| curve.points.len() == 5));
    assert!((1e-13..1e-10).contains(&diagram.conditioning.theta), "{:?}", diagram.conditioning);

    let auto = curve(&diagram, Family::Ours, "this project, auto");
    for (point, error) in auto.points.iter().zip(errors(auto)) {
        assert!(error < point.setting, "{error} at tolerance {}", point.setting);
    }
    let located = errors(curve(&diagram, Family::Located, "RK4"));
    let at_step_ends = errors(curve(&diagram, Family::AtStepEnds, "RK4"));
    assert!(located[4] < 1e-3 * at_step_ends[4], "{located:?} {at_step_ends:?}");
    let evaluations: Vec<f64> =
        curve(&diagram, Family::AtStepEnds, "RK4").points.iter().map(|point| point.evaluations).collect();
    assert_eq!(evaluations, [4.0, 8.0, 16.0, 32.0, 64.0]);

    let slope = errors(curve(&diagram, Family::Fmu, "FMU, input with slope"));
    let held = errors(curve(&diagram, Family::Fmu, "FMU, input held"));
    let inside = errors(curve(&diagram, Family::Fmu, "FMU, record inside"));
    assert!(inside.iter().all(|error| *error < 1e-9), "{inside:?}");
    assert!(slope.iter().all(|error| *error < 1e-9) && held.iter().all(|error| *error > 1e-4), "{slope:?} {held:?}");
}

#[test]
fn libraries_are_exact_where_their_events_are_and_fall_where_not() {
    let diagram = small();
    for name in ["ode_solvers Dopri5", "ode_solvers Dop853", "differential-equations DOP853"] {
        let errors = errors(curve(&diagram, Family::Library, name));
        assert!(errors[4] < 1e-2, "{name}: {errors:?}");
    }
    let own_events = curve(&diagram, Family::Library, "differential-equations DOP853, its events");
    let falls = own_events.points.iter().filter(|point| matches!(point.errors, Err(Failure::ThroughTheFloor { .. })));
    assert!(falls.count() >= 3, "{own_events:?}");
}

/// The exact response is the one that RK4, which shares no code with the engine, tends to.
#[test]
fn the_reference_is_confirmed_by_another_method() {
    use study::fixed_step::runge_kutta_4::RungeKutta4;
    use study::guards::uplift_excess;
    use study::hybrid::{Grid, Transitions, run};
    let scene = synthetic::scene();
    let grid = Grid { method: &RungeKutta4, h: scene.dt() / 512.0 };
    let fine = run(&scene, &grid, Transitions::Located, uplift_excess, &mut |_, _| ());
    let exact = engine::reference(&scene);
    assert_eq!(fine.transitions, exact.transitions);
    let errors = Errors::of(&fine, &exact).unwrap();
    assert!(errors.theta < 1e-11 && errors.u < 1e-9 && errors.a_t < 1e-9, "{errors:?}");
}

#[test]
fn the_command_writes_what_it_has_measured() {
    let docs = tempfile::tempdir().unwrap();
    let scene = synthetic::scene();
    write(std::slice::from_ref(&scene), SMALL, docs.path(), &ProgressBar::hidden()).unwrap();
    let mut csv = csv::Reader::from_path(docs.path().join("accuracy-synthetic.csv")).unwrap();
    let rows: Vec<_> = csv.records().map(Result::unwrap).collect();
    assert_eq!(rows.len(), 27 * 5);
    let row = rows.iter().find(|row| &row[0] == "this project, auto" && row[3].starts_with("1.000000e-3")).unwrap();
    let response = engine::run(&scene, rocking::Detail::Auto, 1e-3, &mut ());
    let errors = Errors::of(&response, &engine::reference(&scene)).unwrap();
    assert_eq!(row[8], format!("{:.3e}", errors.theta));
    assert_eq!(row[7], response.transitions.to_string());
    assert_eq!(row[6], format!("{:.3}", response.evaluations as f64 / scene.intervals() as f64));
    let page = std::fs::read_to_string(docs.path().join("accuracy.md")).unwrap();
    assert!(page.contains("falls through the floor"), "{page}");
}
