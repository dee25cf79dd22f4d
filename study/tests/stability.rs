//! Measured limits of stability against theory, and the trap of uplift.

use indicatif::ProgressBar;
use study::response::Failure;
use study::stability::limits::Limit;
use study::stability::{Grid, map, uplift_trap, write};

#[test]
fn measured_limits_are_those_of_theory() {
    let cells = map(Grid { columns: 5, rows: 4 }, &ProgressBar::hidden());
    assert_eq!(cells.len(), 6 * (5 * 4 + 3));
    for cell in &cells {
        assert!(cell.deviation() < 0.02, "{cell:?}");
    }
    // both kinds of exception are there
    assert!(cells.iter().any(|cell| cell.measured == Limit::Never && cell.vibration.zeta_fc == 0.0));
    assert!(cells.iter().filter(|cell| cell.measured == Limit::Unbounded).all(|cell| cell.method >= 4));
}

/// The same step before and after uplift: as exact as the next method down, gone soon after.
#[test]
fn a_step_that_is_stable_down_is_unstable_up() {
    let scene = uplift_trap::scene().unwrap();
    let (omega_fc, omega_u) = (scene.structure.omega_fc, scene.structure.omega_u);
    assert!(omega_fc * uplift_trap::STEP < 2.0 && omega_u * uplift_trap::STEP > 2.0);
    let exact = study::engine::reference(&scene);
    let unstable = uplift_trap::response(&scene, 2);
    let Some(Failure::Diverged { time }) = unstable.failure else { panic!("{:?}", unstable.failure) };
    let uplift = exact.samples.iter().position(|sample| sample.theta != 0.0).unwrap();
    assert!(time > uplift as f64 * uplift_trap::STEP);
    for (sample, exact) in unstable.samples.iter().zip(&exact.samples).take(uplift) {
        assert!((sample.u - exact.u).abs() < 0.02 * scene.structure.u_cr);
    }
    assert_eq!(uplift_trap::response(&scene, 4).failure, None);
}

#[test]
fn the_command_writes_what_it_has_measured() {
    let docs = tempfile::tempdir().unwrap();
    write(Grid { columns: 2, rows: 2 }, docs.path(), &ProgressBar::hidden()).unwrap();
    let mut csv = csv::Reader::from_path(docs.path().join("stability.csv")).unwrap();
    let rows: Vec<_> = csv.records().map(Result::unwrap).collect();
    assert_eq!(rows.len(), 6 * (2 * 2 + 3));
    let of_central_difference = rows.iter().filter(|row| &row[0] == "central difference");
    for row in of_central_difference {
        let measured: f64 = row[4].parse().unwrap();
        assert!((measured - 2.0).abs() < 0.04 && &row[5] == "2.00000", "{row:?}");
    }
    let page = std::fs::read_to_string(docs.path().join("stability.md")).unwrap();
    assert!(page.contains("| Evison | 11.0 | 36.6 | 3.3 |"), "{page}");
    assert!(page.contains("| RK4 | 2.828 |"), "{page}");
}
