//! The edges of what the engine accepts: parameters at the ends of their ranges, angles and steps next to nothing, at
//! every level of detail.

use crate::common::{engine_of, start, transitions};
use approx::{assert_abs_diff_eq, assert_relative_eq};
use proptest::prelude::*;
use rocking::engine::AdvanceError;
use rocking::mechanics::energy::energy;
use rocking::{
    Detail, Engine, Load, Motion, OneMass, Output, Parameters, Phase, Progress, State, Transition, TransitionKind,
};
use std::f64::consts::FRAC_PI_2;

/// All but the fixed base.
const ROCKING: [Detail; 5] = [Detail::Auto, Detail::Nonlinear, Detail::Linear, Detail::Modal, Detail::Rigid];

/// Next to no mass on a foundation without any.
const LIGHT: Parameters = Parameters { m: 1e-6, m0: 0.0, c_ratio: 1.0, r: 1.0, ..Parameters::EVISON };

/// Evison's wall from `initial` through the instants `until` under the ground acceleration `a_g`.
fn run(detail: Detail, initial: State, a_g: f64, until: &[f64]) -> (Motion, Vec<Transition>) {
    let mut engine = start(Parameters::EVISON, initial, detail);
    let advance = |until: &f64| {
        let interval = until - engine.motion().time;
        transitions(&mut engine, interval, Load::ground(a_g))
    };
    let transitions = Vec::from_iter(until.iter().flat_map(advance));
    (*engine.motion(), transitions)
}

/// A structure that lifts off at t = 0: deformed beyond u_cr, or pushed if its level has no u.
fn lifting_off(detail: Detail) -> (State, f64) {
    let u_cr = OneMass::new(Parameters::EVISON).unwrap().u_cr;
    match detail {
        Detail::Rigid => (State::default(), 9.0),
        _ => (State { u: 1.000001 * u_cr, ..State::default() }, 0.0),
    }
}

fn kinds(transitions: &[Transition]) -> Vec<TransitionKind> {
    transitions.iter().map(|transition| transition.kind).collect()
}

/// A step that ends right after an uplift, where θ is next to nothing or has underflowed, makes no difference.
#[test]
fn a_step_may_end_right_after_an_uplift() {
    for detail in ROCKING {
        let (initial, a_g) = lifting_off(detail);
        let (whole, whole_transitions) = run(detail, initial, a_g, &[0.01]);
        assert_eq!(whole_transitions.len(), if detail == Detail::Rigid { 1 } else { 3 });
        for cut in [1e-300, 1e-200, 1e-160, 1e-155, 1e-100, 1e-30, 1e-18, 1e-12, 1e-9] {
            let (motion, transitions) = run(detail, initial, a_g, &[cut, 0.01]);
            assert_eq!(kinds(&transitions), kinds(&whole_transitions), "{} cut at {cut:e}", detail.name());
            for (one, other) in transitions.iter().zip(&whole_transitions) {
                assert_abs_diff_eq!(one.time, other.time, epsilon = 1e-14);
            }
            assert_relative_eq!(motion.state.u, whole.state.u, max_relative = 1e-12);
            assert_relative_eq!(motion.state.theta, whole.state.theta, max_relative = 1e-12);
        }
    }
}

/// An initial angle next to nothing is none: what falls lands at once, what rises rises.
#[test]
fn an_angle_next_to_nothing_is_none() {
    for detail in ROCKING {
        for (initial, a_g) in [(State::default(), 0.1), lifting_off(detail)] {
            let (flat, _) = run(detail, initial, a_g, &[0.01]);
            for theta in [5e-324, 1e-320, 1e-310, 1e-307, 1e-300, 1e-160, 1e-100, 1e-30] {
                let (motion, transitions) = run(detail, State { theta, ..initial }, a_g, &[0.01]);
                let of = format!("{} from {theta:e} under {a_g}: {transitions:?}", detail.name());
                assert_eq!(motion.phase, flat.phase, "{of}");
                assert!((motion.state.u - flat.state.u).abs() <= 1e-12 * flat.state.u.abs(), "{of}");
                assert!((motion.state.theta - flat.state.theta).abs() <= 1e-12 * flat.state.theta.abs(), "{of}");
            }
        }
    }
}

/// Released at u_cr, where next to nothing lifts it and damping soon brings it back; the first step ends before that.
#[test]
fn a_step_may_end_right_before_a_return() {
    let stiff = Parameters { H: 500.0, B: 10.0, J0: 9.999999999999999e-5, f_fc: 1e4, zeta_fc: 0.99, ..LIGHT };
    let structure = OneMass::new(stiff).unwrap();
    let released = State { u: structure.u_cr, ..State::default() };
    let run = |until: &[f64]| {
        let mut engine = Engine::new(structure, released, 0.0, 1e-10).unwrap();
        until
            .iter()
            .for_each(|until| _ = engine.advance(until - engine.motion().time, Load::default(), &mut ()).unwrap());
        *engine.motion()
    };
    let (whole, cut) = (run(&[1e-9]), run(&[2e-9 / (2.0 * structure.zeta_u * structure.omega_u), 1e-9]));
    assert_eq!(whole.phase, cut.phase);
    assert_relative_eq!(whole.state.u, cut.state.u, max_relative = 1e-12);
}

/// A soft strut without a foundation's inertia: damping slows the top mass on its way above the pivot, which it never
/// reaches, while steps shrink with the square of the distance.
#[test]
fn a_way_without_end_is_told_for_what_it_is() {
    let soft = Parameters { B: 1e-3, f_fc: 1e-3, zeta_fc: 0.96, c_ratio: 2.875, ..LIGHT };
    let structure = OneMass::new(Parameters { H: 0.04189042488611558, J0: 0.0, ..soft });
    let released = State { theta: 0.0265, ..State::default() };
    let mut engine = Engine::new(structure.unwrap(), released, 0.0, 1e-10).unwrap();
    let before = *engine.motion();
    let Err(AdvanceError::Singular { time, u, .. }) = engine.advance(0.01, Load::default(), &mut ()) else {
        panic!("goes on")
    };
    assert!(time < 2e-3 && (u - 1e-3).abs() < 1e-6, "{time} s, {u} m");
    assert_eq!(*engine.motion(), before);
}

/// A number of `edges`, or a number between `low` and `high`, evenly distributed in its logarithm.
fn edge_or(edges: &'static [f64], low: f64, high: f64) -> impl Strategy<Value = f64> {
    prop_oneof![1 => prop::sample::select(edges), 2 => (low.ln()..high.ln()).prop_map(f64::exp)]
}

prop_compose! {
    /// Lengths and masses of the laboratory and of bridges, all else up to its limits.
    fn at_the_edges()(
        m in edge_or(&[1e-6, 1e12], 1.0, 1e6),
        B in edge_or(&[1e-3, 10.0], 0.05, 10.0),
        slenderness in edge_or(&[50.0, 1e3, 1.0], 0.1, 50.0),
        mass_ratio in edge_or(&[0.0], 1e-4, 10.0),
        inertia in edge_or(&[0.0], 1e-3, 1e4),
        f_fc in edge_or(&[1e-3, 1e4], 1e-3, 1e4),
        zeta_fc in edge_or(&[0.0, 0.99], 1e-4, 0.99),
        c_ratio in edge_or(&[0.0, 1.0], 1e-3, 100.0),
        r in edge_or(&[1.0, 1e-3], 0.5, 1.0),
    ) -> Parameters {
        let (m0, H, J0) = (mass_ratio * m, slenderness * B, inertia * m * B * B);
        Parameters { m, m0, H, B, J0, f_fc, zeta_fc, c_ratio, r, ..Parameters::EVISON }
    }
}

prop_compose! {
    /// Initial values over their natural sizes: u over u_cr, θ over tan α_cg, rates over these in a radian of vibration and
    /// rocking.
    fn over_natural_sizes()(
        u in prop_oneof![Just(0.0), Just(1.0), -1.5..1.5f64],
        u_dot in prop_oneof![2 => Just(0.0), 1 => -1.5..1.5f64],
        theta in prop_oneof![3 => Just(0.0), 1 => Just(-1e-12), 3 => -1.2..1.2f64],
        theta_dot in prop_oneof![2 => Just(0.0), 1 => -1.5..1.5f64],
    ) -> State {
        State { u, u_dot, theta, theta_dot }
    }
}

fn initial(structure: &OneMass, detail: Detail, over: State) -> State {
    let theta = (over.theta * structure.base().tan_alpha_cg).clamp(-1.5, 1.5);
    let theta_dot = (over.theta_dot * structure.base().tan_alpha_cg * structure.base().p_l).clamp(-1e3, 1e3);
    State {
        u: if detail == Detail::Rigid { 0.0 } else { (over.u * structure.u_cr).clamp(-1e4, 1e4) },
        u_dot: if detail == Detail::Rigid {
            0.0
        } else {
            (over.u_dot * structure.u_cr * structure.omega_fc).clamp(-1e4, 1e4)
        },
        theta: if detail == Detail::FixedBase { 0.0 } else { theta },
        theta_dot: if detail == Detail::FixedBase || theta == 0.0 { 0.0 } else { theta_dot },
    }
}

/// The sum of the magnitudes that the energy is made of, J.
fn energy_scale(structure: &OneMass, state: &State) -> f64 {
    let &Parameters { m, m0, H, B, J0, g, .. } = structure.parameters();
    let State { u, u_dot, theta_dot, .. } = *state;
    0.5 * m * ((u_dot.abs() + H * theta_dot.abs()).powi(2) + ((B + u.abs()) * theta_dot).powi(2))
        + 0.5 * (J0 + m0 * B * B) * theta_dot.powi(2)
        + 0.5 * structure.k * u * u
        + m * g * (H + B + u.abs())
        + m0 * g * B
}

fn phase_after(kind: TransitionKind) -> Phase {
    match kind {
        TransitionKind::Uplift(side) | TransitionKind::Impact(side) => Phase::Rocking(side),
        TransitionKind::Overturning(side) => Phase::Overturned(side),
        TransitionKind::Landing | TransitionKind::Settling => Phase::FullContact,
        _ => unreachable!("nothing is restrained, and the ground is rigid"),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    /// Whatever the parameters, the level, the load and the steps: numbers stay numbers, the structure stays above the
    /// floor, transitions come in their order, and energy does not grow by itself. Only a foundation without inertia
    /// has motions that end.
    #[test]
    fn the_corners_hold(
        parameters in at_the_edges(),
        over in over_natural_sizes(),
        detail in prop::sample::select(Detail::ALL.as_slice()),
        peak in edge_or(&[0.0, 981.0], 1e-3, 1e4),
        samples in prop::collection::vec((-1.0..1.0f64, -1.0..1.0f64, edge_or(&[1e-300, 1e-18, 1.0], 1e-9, 1.0)), 1..8),
        longest in edge_or(&[1.0], 0.1, 300.0),
    ) {
        let Ok(structure) = OneMass::new(parameters) else { return Ok(()) };
        let start = initial(&structure, detail, over);
        let mut engine = engine_of(structure, start, 1e-10, detail);
        let fastest = structure.omega_u.max(2.0 * structure.zeta_u * structure.omega_u).max(structure.base().p_l);
        let (mut phase, mut last, mut scale) = (engine.motion().phase, start, energy_scale(&structure, &start));
        for (a_g, F_t, part) in samples {
            let time = engine.motion().time;
            let until = time + part * longest / fastest;
            if until <= time {
                continue;
            }
            let load = Load { a_g: peak * a_g, F_t: peak * parameters.m * F_t, a_v: 0.0 };
            let mut transitions = Vec::new();
            match engine.advance(until - engine.motion().time, load, &mut |transition: &Transition| transitions.push(*transition)) {
                Ok(progress) => {
                    let overturned = matches!(engine.motion().phase, Phase::Overturned(_));
                    prop_assert_eq!(progress == Progress::Overturned, overturned);
                }
                Err(AdvanceError::Singular { u, .. }) => {
                    let foundation = (parameters.J0 + parameters.m0 * parameters.B.powi(2)) / parameters.m;
                    prop_assert!(foundation < 1e-2 * parameters.B.powi(2), "u = {u}");
                    return Ok(());
                }
                Err(error) => prop_assert!(false, "{error}"),
            }
            let Motion { state, phase: now, .. } = *engine.motion();
            let outputs = Output::all(engine.structure()).into_iter().map(engine.outputs(load));
            let outputs = Vec::from_iter(outputs);
            let reactions = engine.sample(load).reactions();
            prop_assert!(outputs.iter().chain(&[reactions.R_h, reactions.R_v]).all(|x| x.is_finite()), "{outputs:?} {reactions:?}");
            match now {
                Phase::FullContact => prop_assert_eq!((state.theta, state.theta_dot), (0.0, 0.0)),
                Phase::Rocking(side) => prop_assert!((-1e-12..FRAC_PI_2).contains(&(side.sign() * state.theta))),
                Phase::Overturned(side) => prop_assert!((side.sign() * state.theta - FRAC_PI_2).abs() < 1e-9),
                _ => unreachable!("the ground is rigid"),
            }
            prop_assert!(transitions.is_sorted_by(|one, next| one.time <= next.time));
            if peak == 0.0 && matches!(detail, Detail::Auto | Detail::Nonlinear) {
                let end = Transition { time: until, kind: TransitionKind::Landing, before: state, after: state };
                for (i, Transition { kind, before, after, .. }) in transitions.iter().chain([&end]).enumerate() {
                    scale = scale.max(energy_scale(&structure, before));
                    let gain = energy(&structure.into(), phase, before) - energy(&structure.into(), phase, &last);
                    prop_assert!(gain <= 1e-8 * scale, "{gain} J of {scale} J before transition {i}");
                    last = *after;
                    if i == transitions.len() {
                        break;
                    }
                    if phase_after(*kind) == Phase::FullContact {
                        let gain = energy(&structure.into(), Phase::FullContact, after) - energy(&structure.into(), phase, before);
                        prop_assert!(gain <= 1e-12 * scale, "{gain} J of {scale} J at a landing");
                    }
                    phase = phase_after(*kind);
                }
            } else {
                (phase, last) = (now, state);
            }
        }
    }
}
