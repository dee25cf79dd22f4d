//! The levels of detail from outside: rest, bounds, memory. What tolerances promise is in
//! `tolerance.rs`.

use crate::common::{engine_of, shaking, start, transitions};
use approx::assert_abs_diff_eq;
use rocking::mechanics::impact::MAX_RIGID_TRANSITIONS_PER_PERIOD;
use rocking::{Detail, OneMass, Parameters, Phase, Progress, Ramp, Side, State, Transition, TransitionKind};

const STILL: Ramp = Ramp { value: 0.0, slope: 0.0 };

/// Zeno: the rigid structure comes to rest through finitely many impacts, with no more energy left than a step's error has.
#[test]
fn rigid_comes_to_rest_with_less_energy_than_the_tolerance() {
    let structure = OneMass::new(Parameters { r: 0.9, ..Parameters::MCMANUS }).unwrap();
    let &Parameters { m, H, g, .. } = structure.parameters();
    for tolerance in [1e-4, 1e-9] {
        let released = State { theta: 0.1, ..State::default() };
        let mut engine = engine_of(structure, released, tolerance, Detail::Rigid);
        let transitions = transitions(&mut engine, 30.0, STILL);
        let landing = transitions.last().unwrap();
        assert_eq!(landing.kind, TransitionKind::Landing);
        assert_eq!(engine.motion().phase, Phase::FullContact);
        let theta_dot = structure.parameters().r * landing.before.theta_dot;
        let overturning_energy = 0.5 * m * g * H * structure.base().tan_alpha_cg.powi(2);
        let left = (1e-5 * tolerance).min(1e-11);
        assert!(0.5 * structure.base().J_P * theta_dot * theta_dot <= left * left * overturning_energy);
        // each impact keeps r of the velocity: as many of them as it takes
        let first = transitions[0].before.theta_dot;
        let enough =
            ((left * structure.base().p_l * structure.base().tan_alpha_cg / first.abs()).ln() / 0.9f64.ln()).ceil();
        assert_eq!(transitions.len() as f64, enough);
    }
}

/// More impacts than a period may see end in contact, which is held to the end of the period whatever pushes.
#[test]
fn too_many_impacts_end_in_contact() {
    let structure = OneMass::new(Parameters { r: 0.9999, ..Parameters::MCMANUS }).unwrap();
    let period = 1.0 / structure.base().p_l;
    let released = State { theta: 1e-11, ..State::default() };
    let mut engine = engine_of(structure, released, 1e-9, Detail::Rigid);
    let mut advance = |interval, value| transitions(&mut engine, interval, Ramp { value, slope: 0.0 });
    let transitions = [advance(0.9 * period, 0.0), advance(0.2 * period, 9.0)].concat();
    let [settling, uplift] = transitions[transitions.len() - 2..] else { unreachable!() };
    assert_eq!(transitions.len(), MAX_RIGID_TRANSITIONS_PER_PERIOD as usize + 2);
    assert_eq!((settling.kind, uplift.kind), (TransitionKind::Settling, TransitionKind::Uplift(Side::Left)));
    assert_abs_diff_eq!(uplift.time, transitions[0].time + period, epsilon = 1e-12);
}

/// A structure that has come to rest stays so, in one call or in many, long after its motion is too small for numbers.
#[test]
fn rest_lasts_at_every_level() {
    for detail in Detail::ALL {
        for f_fc in [5.0, 400.0] {
            let structure = OneMass::new(Parameters { f_fc, zeta_fc: 0.1, ..Parameters::MCMANUS }).unwrap();
            let theta = if detail == Detail::FixedBase { 0.0 } else { 1e-3 };
            let u = if detail == Detail::Rigid { 0.0 } else { 0.9 * structure.u_cr };
            let initial = State { theta, u, ..State::default() };
            let start = || engine_of(structure, initial, 1e-9, detail);
            let mut at_once = start();
            at_once.advance(1000.0, STILL, &mut ()).unwrap();
            let mut bit_by_bit = start();
            for k in 1..=20_000 {
                bit_by_bit.advance(f64::from(k) * 0.05 - bit_by_bit.motion().time, STILL, &mut ()).unwrap();
            }
            for engine in [at_once, bit_by_bit] {
                let State { u, u_dot, theta, theta_dot } = engine.motion().state;
                assert!([u, u_dot, theta, theta_dot].iter().all(|x| x.abs() < 1e-30), "{}", detail.name());
            }
        }
    }
}

/// Once it is down for good the rest of a step of any length is one leap: down to nothing, or, without damping, with the
/// energy that its last landing left.
#[test]
fn what_is_down_for_good_takes_no_more_steps() {
    for detail in [Detail::Auto, Detail::Linear, Detail::Modal, Detail::Rigid] {
        for (zeta_fc, a_g) in [(0.02, 0.0), (0.0, 0.0), (0.0, 0.4), (1e-6, -0.4)] {
            let structure = OneMass::new(Parameters { zeta_fc, r: 0.9, ..Parameters::MCMANUS }).unwrap();
            let initial = State { theta: 0.05, ..State::default() };
            let mut engine = engine_of(structure, initial, 1e-9, detail);
            let mut landed = State::default();
            let load = Ramp { value: a_g, slope: 0.0 };
            engine.advance(1e9, load, &mut |transition: &Transition| landed = transition.after).unwrap();
            let name = format!("{}, zeta_fc = {zeta_fc}, a_g = {a_g}", detail.name());
            assert!(engine.motion().work.steps < 20_000, "{name}: {} steps", engine.motion().work.steps);
            assert_eq!((engine.motion().time, engine.motion().phase), (1e9, Phase::FullContact), "{name}");
            if detail == Detail::Rigid {
                continue;
            }
            let rest = -a_g / structure.omega_fc.powi(2);
            let amplitude = |state: &State| (state.u - rest).hypot(state.u_dot / structure.omega_fc);
            let expected = if zeta_fc == 0.0 { amplitude(&landed) } else { 0.0 };
            let off = (amplitude(&engine.motion().state) - expected).abs();
            assert!(off < 1e-9 * structure.u_cr, "{name}: {off} beside {expected}");
        }
    }
}

/// Stepping allocates nothing, at any level, through any transition.
#[test]
fn stepping_allocates_nothing() {
    let ground = shaking(2, 0.01, 1000, 3.0);
    for detail in Detail::ALL {
        let mut engine = start(Parameters::MCMANUS, State::default(), detail);
        let mut transitions = 0;
        let counted = allocation_counter::measure(|| {
            for pair in ground.acceleration().windows(2) {
                let a_g = Ramp { value: pair[0], slope: (pair[1] - pair[0]) / 0.01 };
                let progress = engine.advance(0.01, a_g, &mut |_: &Transition| transitions += 1).unwrap();
                if progress == Progress::Overturned {
                    break;
                }
            }
        });
        assert_eq!(counted.count_total, 0, "{}", detail.name());
        assert!(transitions > 0 || detail == Detail::FixedBase, "{}", detail.name());
    }
}
