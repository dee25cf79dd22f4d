//! The hybrid engine from outside: the paper's numbers, conservation, independence of cuts, guarantee of progress.
#![allow(non_snake_case)]

use approx::{assert_abs_diff_eq, assert_relative_eq};
use proptest::prelude::*;
use rocking::engine::DEFAULT_TOLERANCE;
use rocking::levels::rules::MAX_TRANSITIONS_PER_PERIOD;
use rocking::mechanics::energy::energy;
use rocking::run::peaks::Peaks;
use rocking::{Engine, Motion, Parameters, Phase, Progress, Ramp, Side, State, Structure, Transition, TransitionKind};
use std::f64::consts::{FRAC_PI_2, TAU};

const STILL: Ramp = Ramp { value: 0.0, slope: 0.0 };

/// Advances and collects the transitions.
fn advance(engine: &mut Engine, until: f64, a_g: Ramp) -> Vec<Transition> {
    let mut transitions = Vec::new();
    engine
        .advance(until - engine.motion().time, a_g, &mut |transition: &Transition| transitions.push(*transition))
        .unwrap();
    transitions
}

fn is_impact(transition: &&Transition) -> bool {
    matches!(transition.kind, TransitionKind::Impact(_))
}

fn evison_released(structure: &Structure) -> Engine {
    let released = State { theta: 0.04, u: structure.u_cr, ..State::default() };
    Engine::new(*structure, released, 0.0, DEFAULT_TOLERANCE).unwrap()
}

/// An advance that ends at transitions meets the same ones, each before it is applied: the last state of rocking is on the
/// ground, that of full contact at the limit of uplift.
#[test]
fn an_advance_can_end_at_every_transition() {
    let structure = Structure::new(Parameters { r: 0.85, ..Parameters::EVISON }).unwrap();
    let released = State { theta: 0.01, ..State::default() };
    let new = || Engine::new(structure, released, 0.0, DEFAULT_TOLERANCE).unwrap();
    let (mut through, mut to_each) = (new(), new());
    let expected = advance(&mut through, 1.0, STILL);
    to_each.stop_at_transitions(true);
    let mut transitions = Vec::new();
    while to_each.motion().time < 1.0 {
        let due = to_each.advance(1.0 - to_each.motion().time, STILL, &mut ()).unwrap() == Progress::Transition;
        let Motion { phase, state, .. } = *to_each.motion();
        assert_eq!(to_each.motion().is_transition_due(), due);
        if due {
            let met = if phase == Phase::FullContact { state.u.abs() - structure.u_cr } else { state.theta };
            assert!(met.abs() < 1e-14 || phase == Phase::FullContact && met > 0.0, "{phase:?} {state:?}");
            to_each.transit(&mut |transition: &Transition| transitions.push(*transition));
            assert_ne!(to_each.motion().phase, phase);
        }
    }
    assert!(expected.len() > 10);
    assert_eq!(transitions.len(), expected.len());
    for (transition, expected) in transitions.iter().zip(&expected) {
        assert_eq!(transition.kind, expected.kind);
        assert_abs_diff_eq!(transition.time, expected.time, epsilon = 1e-10);
        assert_abs_diff_eq!(transition.after.u_dot, expected.after.u_dot, epsilon = 1e-8);
    }
    // what is due is applied by the next advance if nobody has
    let mut left = new();
    left.stop_at_transitions(true);
    while left.motion().time < 1.0 {
        left.advance(1.0 - left.motion().time, STILL, &mut ()).unwrap();
    }
    assert_eq!(left.motion().state, to_each.motion().state);
}

#[test]
fn evisons_free_vibration_has_its_impacts_and_its_peak() {
    let structure = Structure::new(Parameters::EVISON).unwrap();
    let mut engine = evison_released(&structure);
    let transitions = advance(&mut engine, 2.0, STILL);
    let impacts: Vec<f64> = transitions.iter().filter(is_impact).map(|impact| impact.time).take(6).collect();
    let expected = [0.168487319, 0.486378723, 0.783968665, 1.062370970, 1.321721172, 1.562668213];
    for (impact, expected) in impacts.iter().zip(expected) {
        assert_abs_diff_eq!(*impact, expected, epsilon = 1e-9);
    }

    let mut peaks = Peaks::new(&structure);
    evison_released(&structure).advance(2.0, STILL, &mut peaks.watch()).unwrap();
    assert_abs_diff_eq!(peaks.a_t().magnitude / 9.81, 0.92061, epsilon = 5e-6);
    assert_abs_diff_eq!(peaks.a_t().time, 1.3349, epsilon = 6e-5);
}

/// Without damping and ground motion the energy is constant between impacts, and each impact loses what its formula
/// says.
#[test]
fn energy_is_kept_between_impacts() {
    let structure = Structure::new(Parameters { zeta_fc: 0.0, ..Parameters::MCMANUS }).unwrap();
    let released = State { theta: 0.02, u: -0.001, ..State::default() };
    let mut engine = Engine::new(structure, released, 0.0, 1e-11).unwrap();
    let mut phase = engine.motion().phase;
    let mut expected = energy(&structure, phase, &released);
    let transitions = advance(&mut engine, 5.0, STILL);
    assert!(transitions.len() > 10);
    for transition in transitions {
        assert_relative_eq!(energy(&structure, phase, &transition.before), expected, max_relative = 1e-12);
        phase = match transition.kind {
            TransitionKind::Yielding(_) | TransitionKind::Unloading(_) => panic!("nothing is restrained"),
            TransitionKind::Uplift(side) | TransitionKind::Impact(side) => Phase::Rocking(side),
            TransitionKind::Overturning(side) => Phase::Overturned(side),
            TransitionKind::Landing | TransitionKind::Settling => Phase::FullContact,
        };
        expected = energy(&structure, phase, &transition.after);
    }
    let Motion { phase, state, .. } = *engine.motion();
    assert_relative_eq!(energy(&structure, phase, &state), expected, max_relative = 1e-12);
}

#[test]
fn a_tall_push_overturns_at_a_right_angle_and_stays_there() {
    let structure = Structure::new(Parameters::MCMANUS).unwrap();
    let mut engine = Engine::new(structure, State::default(), 10.0, DEFAULT_TOLERANCE).unwrap();
    let push = Ramp { value: -6.0, slope: 0.0 };
    let mut last = None;
    let progress = engine.advance(20.0, push, &mut |transition: &Transition| last = Some(*transition)).unwrap();
    assert_eq!(progress, Progress::Overturned);
    let end = *engine.motion();
    assert_eq!(last.unwrap().kind, TransitionKind::Overturning(Side::Right));
    assert_abs_diff_eq!(end.state.theta, FRAC_PI_2, epsilon = 1e-14);
    assert!(end.time > 10.0 && end.time < 20.0);
    assert_eq!(engine.advance(30.0, STILL, &mut ()).unwrap(), Progress::Overturned);
    assert_eq!(*engine.motion(), end);
}

fn log(low: f64, high: f64) -> impl Strategy<Value = f64> {
    (low.ln()..high.ln()).prop_map(f64::exp)
}

prop_compose! {
    /// A structure from a lab specimen to a bridge pier.
    fn any_parameters()(
        (m, mass_ratio, inertia) in (log(1.0, 1e6), 0.02..2.02, 0.0..1.0),
        (B, slenderness) in (log(0.1, 10.0), 1.0..10.0),
        (f_fc, zeta_fc) in (log(0.5, 100.0), prop_oneof![0.0..0.2, 0.2..2.0]),
        (c_ratio, r) in (0.0..2.0, 0.5..=1.0),
    ) -> Parameters {
        let (m0, H, J0) = (mass_ratio * m, slenderness * B, inertia * m * B * B);
        Parameters { m, m0, H, B, J0, f_fc, zeta_fc, c_ratio, r, ..Parameters::EVISON }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    /// Random structures under random ground motion: time reaches the end or the structure overturns, without bursts of
    /// transitions, and the work stays under its bound.
    #[test]
    fn any_structure_gets_through_any_shaking(
        parameters in any_parameters(),
        samples in prop::collection::vec(-1.0..1.0f64, 150),
        intensity in 0.0..3.0f64,
        dt in 0.002..0.05f64,
    ) {
        let structure = Structure::new(parameters).unwrap();
        let scale = intensity * structure.tan_alpha_cg * parameters.g * 2.0;
        let mut engine = Engine::new(structure, State::default(), 0.0, DEFAULT_TOLERANCE).unwrap();
        let mut in_this_period = std::collections::VecDeque::new();
        let period = TAU / structure.omega_u;
        let mut settled = 0;
        for (k, pair) in samples.windows(2).enumerate() {
            let a_g = Ramp { value: scale * pair[0], slope: scale * (pair[1] - pair[0]) / dt };
            let mut most = 0;
            let progress = engine.advance((k + 1) as f64 * dt - engine.motion().time, a_g, &mut |transition: &Transition| {
                settled += u32::from(transition.kind == TransitionKind::Settling);
                in_this_period.push_back(transition.time);
                while transition.time - in_this_period[0] > period {
                    in_this_period.pop_front();
                }
                most = most.max(in_this_period.len());
            }).unwrap();
            // any period overlaps at most two of those that the engine counts in
            prop_assert!(most <= 2 * (MAX_TRANSITIONS_PER_PERIOD as usize + 2));
            if progress == Progress::Overturned {
                break;
            }
        }
        let Motion { time, phase, work, transitions, .. } = *engine.motion();
        prop_assert!(matches!(phase, Phase::Overturned(_)) || time == (samples.len() - 1) as f64 * dt);
        let fastest = structure.omega_u.max(2.0 * structure.zeta_u * structure.omega_u).max(structure.p_l);
        let bound = samples.len() as f64 + 2.0 * transitions as f64 + fastest * time;
        prop_assert!((work.steps as f64) < bound, "{} steps, bound {bound}", work.steps);
        prop_assert!(settled == 0, "settled {settled} times");
    }
}
