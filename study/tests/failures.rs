//! The failures are those that the gallery says.

mod synthetic;

use approx::assert_relative_eq;
use rocking::{Detail, State};
use study::failures::{Exhibit, double_crossing, grazing, history, overturning, zeno};
use study::fixed_step::FixedStep;
use study::guards::{displacement_excess, uplift_excess};
use study::hybrid::{Grid, Transitions, run};
use study::response::RunFailure;

fn series<'a>(exhibit: &'a Exhibit, name: &str) -> &'a [(f64, f64)] {
    &exhibit.series.iter().find(|(of, _)| of == name).unwrap().1
}

#[test]
fn a_dip_between_two_checks_is_missed_and_the_engine_sees_it() {
    let exhibit = double_crossing::show().unwrap();
    let lowest = |name| series(&exhibit, name).iter().map(|(_, theta)| *theta).fold(0.0, f64::min);
    assert!(
        lowest("exact integration, sign checked every 20 ms") < -1.0,
        "it goes below the ground by more than 1 mrad"
    );
    assert!(lowest("this engine") >= -1e-9);
    assert!(series(&exhibit, "checked here").iter().all(|(_, theta)| *theta > 0.0));
}

#[test]
fn the_displacement_alone_makes_contact_chatter() {
    let scene = synthetic::scene().scaled(1.5);
    let grid = Grid { method: FixedStep::RungeKutta4, h: scene.dt() / 16.0 };
    let complete = run(&scene, &grid, Transitions::Located, uplift_excess, &mut |_, _| ());
    let mut phases = Vec::new();
    let naive = run(&scene, &grid, Transitions::Located, displacement_excess, &mut |time, phase| {
        phases.push((time, phase));
    });
    let Some(RunFailure::Chatter { time }) = naive.failure else { panic!("{:?}", naive.failure) };
    assert_eq!((complete.failure, complete.transitions), (None, study::engine::reference(&scene).transitions));
    let at_once = phases.iter().filter(|(at, _)| (at - time).abs() < 1e-9).count();
    assert!(at_once > 900, "{at_once} transitions at one instant");
}

/// The times between a rigid block's impacts shrink by r each, in the end; flexible structures land.
#[test]
fn a_rigid_block_comes_to_rest_like_zeno() {
    let released = history::at_rest(zeno::STRUCTURE, State { theta: 0.04, ..State::default() }, 4.0);
    let rigid = zeno::intervals(&history::exact(&released, Detail::Rigid, []).unwrap().transitions);
    assert!(rigid.len() > 200);
    for pair in rigid[100..150].windows(2) {
        assert_relative_eq!(pair[1].1 / pair[0].1, zeno::STRUCTURE.r, max_relative = 1e-5);
    }
    let flexible = zeno::intervals(&history::exact(&released, Detail::Nonlinear, []).unwrap().transitions);
    assert!(flexible.len() < 20);
}

/// Slopes of the answer's change over the start's: 0 where L passes through 0, 1/2 where θ touches 0, 1 elsewhere.
#[test]
fn grazes_have_their_exponents() {
    for (family, exponent) in grazing::FAMILIES.iter().zip([0.0, 0.5, 1.0]) {
        let changes = family.sensitivity(&[1e-10, 1e-6]);
        let observed = (changes[1].1 / changes[0].1).log10() / 4.0;
        assert!((observed - exponent).abs() < 0.02, "{observed} instead of {exponent}");
    }
}

#[test]
fn errors_near_overturning_grow_at_the_rate_of_the_unstable_equilibrium() {
    let exhibit = overturning::show().unwrap();
    let difference = series(&exhibit, "two releases, 2·10⁻¹² apart");
    let at = |time: f64| difference.iter().find(|(t, _)| *t >= time).unwrap();
    let ((t0, d0), (t1, d1)) = (at(3.0), at(9.0));
    assert_relative_eq!((d1 / d0).ln() / (t1 - t0), overturning::growth(), max_relative = 0.01);
}
