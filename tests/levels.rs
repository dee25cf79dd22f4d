//! The levels of detail from outside: each against its own closed form or an independent integration.
#![allow(non_snake_case)]

use approx::{assert_abs_diff_eq, assert_relative_eq};
use rocking::estimates::effective_frequency::time_to_impact;
use rocking::{Detail, Engine, Parameters, Phase, Progress, Ramp, Side, State, Structure, Transition, TransitionKind};

const STILL: Ramp = Ramp { value: 0.0, slope: 0.0 };

fn mcmanus() -> Structure {
    Structure::new(Parameters::MCMANUS).unwrap()
}

/// A ground motion of `count` samples, dt apart (s): a sum of sines that grow and fade, m/s².
fn shaking(seed: u32, dt: f64, count: usize, peak: f64) -> Vec<f64> {
    let phase = f64::from(seed);
    let sample = |i: usize| {
        let t = i as f64 * dt;
        let envelope = (t / 2.0).min(1.0) * (-0.15 * t).exp();
        let waves = (5.1 * t + phase).sin() + 0.7 * (13.7 * t + 2.0 * phase).sin() + 0.4 * (37.3 * t + phase).cos();
        peak * envelope * waves
    };
    (0..count).map(sample).collect()
}

/// Runs `samples`, linear in between, and shows the state at each; transitions go to `transitions`.
fn run(
    structure: Structure,
    detail: Detail,
    tolerance: f64,
    dt: f64,
    samples: &[f64],
    transitions: &mut Vec<Transition>,
) -> Vec<State> {
    let mut engine = Engine::with_detail(structure, State::default(), 0.0, tolerance, detail).unwrap();
    let mut states = vec![State::default()];
    for (i, pair) in samples.windows(2).enumerate() {
        let a_g = Ramp { value: pair[0], slope: (pair[1] - pair[0]) / dt };
        engine
            .advance((i + 1) as f64 * dt - engine.motion().time, a_g, &mut |transition: &Transition| {
                transitions.push(*transition)
            })
            .unwrap();
        states.push(engine.motion().state);
    }
    states
}

fn largest(states: &[State], of: fn(&State) -> f64) -> f64 {
    states.iter().map(|state| of(state).abs()).fold(0.0, f64::max)
}

/// max |Δθ|/max |θ|
fn distance(states: &[State], reference: &[State]) -> f64 {
    let differences = states.iter().zip(reference).map(|(a, b)| (a.theta - b.theta).abs());
    differences.fold(0.0, f64::max) / largest(reference, |state| state.theta)
}

/// `auto` gives the answer of `nonlinear` to the tolerance asked, over ten scenes. No method does better than the scene's own conditioning, taken as what a change of 1e-15 in
/// the input does.
#[test]
fn auto_agrees_with_nonlinear_to_the_tolerance() {
    for scene in 0..10 {
        let samples = shaking(scene, 0.01, 1000, 2.0 + 0.15 * f64::from(scene));
        let mut transitions = Vec::new();
        let reference = run(mcmanus(), Detail::Nonlinear, 1e-13, 0.01, &samples, &mut transitions);
        assert!(transitions.len() > 10, "scene {scene}: {} transitions", transitions.len());
        let changed: Vec<f64> = samples.iter().map(|a_g| a_g * (1.0 + 1e-12)).collect();
        let changed = run(mcmanus(), Detail::Nonlinear, 1e-13, 0.01, &changed, &mut Vec::new());
        let floor = 1e-3 * distance(&changed, &reference);
        for tolerance in [1e-6, 1e-8, 1e-10] {
            let states = run(mcmanus(), Detail::Auto, tolerance, 0.01, &samples, &mut Vec::new());
            let error = distance(&states, &reference);
            assert!(
                error <= tolerance.max(floor),
                "scene {scene}, tolerance {tolerance:e}: error {error:e}, {floor:e}"
            );
        }
    }
}

/// What linearisation neglects is of second order: as the motion shrinks with everything that drives it, the distance
/// of `linear` from `nonlinear` shrinks at least in proportion.
#[test]
fn linear_tends_to_nonlinear_as_the_motion_shrinks() {
    let error = |scale: f64| {
        // the same motion at a smaller scale: gravity and the push are smaller, lengths and times are kept
        let structure = Structure::new(Parameters { g: 9.81 * scale, ..Parameters::MCMANUS }).unwrap();
        let samples = shaking(3, 0.01, 150, 6.0 * scale);
        let mut transitions = Vec::new();
        let linear = run(structure, Detail::Linear, 1e-10, 0.01, &samples, &mut transitions);
        assert!(!transitions.is_empty());
        distance(&linear, &run(structure, Detail::Nonlinear, 1e-10, 0.01, &samples, &mut Vec::new()))
    };
    let errors = [error(1.0), error(0.1), error(0.01)];
    assert!(errors[0] < 0.2 && errors[1] < 0.2 * errors[0] && errors[2] < 0.2 * errors[1], "{errors:?}");
}

/// Eq 11 alone: a structure so stiff that u does not matter falls back in the time of Eq 14; with the full
/// equations but for the square of the angle.
#[test]
fn a_stiff_structure_falls_back_in_the_time_of_equation_14() {
    let structure = Structure::new(Parameters { f_fc: 2e3, zeta_fc: 0.5, ..Parameters::EVISON }).unwrap();
    let released = State { theta: 0.04, u: structure.u_cr, ..State::default() };
    for (detail, tolerance) in [(Detail::Auto, 1e-2), (Detail::Linear, 1e-4), (Detail::Modal, 1e-4)] {
        let mut engine = Engine::with_detail(structure, released, 0.0, 1e-10, detail).unwrap();
        let mut impacts = Vec::new();
        engine.advance(0.2, STILL, &mut |impact: &Transition| impacts.push(impact.time)).unwrap();
        assert_relative_eq!(impacts[0], time_to_impact(&structure, 0.04), max_relative = tolerance);
    }
}

/// A rigid body that falls back under a steady push strikes with the energy that weight and push gave it: Eq 6 with u = 0
/// over θ.
#[test]
fn rigid_rocks_as_its_equation_says() {
    let structure = mcmanus();
    let &Parameters { m, m0, H, B, g, r, .. } = structure.parameters();
    let push = Ramp { value: 1.0, slope: 0.0 };
    let initial = State { theta: -0.05, theta_dot: 0.1, ..State::default() };
    // of the weight and of the push, about the left pivot
    let work = |theta: f64| {
        let (sin, cos) = theta.sin_cos();
        -m * g * H * cos + (m + m0) * g * B * sin - push.value * (m * H * sin + (m + m0) * B * cos)
    };
    let squared = initial.theta_dot.powi(2) + 2.0 * (work(0.0) - work(initial.theta)) / structure.J_P;
    let mut engine = Engine::with_detail(structure, initial, 0.0, 1e-10, Detail::Rigid).unwrap();
    let mut impacts = Vec::new();
    engine.advance(1.0, push, &mut |impact: &Transition| impacts.push(*impact)).unwrap();
    assert_eq!(impacts[0].kind, TransitionKind::Impact(Side::Right));
    assert_abs_diff_eq!(impacts[0].before.theta_dot, squared.sqrt(), epsilon = 1e-10);
    assert_eq!(impacts[0].after.theta_dot, r * impacts[0].before.theta_dot);
}

/// Zeno: the rigid structure comes to rest through finitely many impacts, with no more energy left than a step's error has.
#[test]
fn rigid_comes_to_rest_with_less_energy_than_the_tolerance() {
    let structure = Structure::new(Parameters { r: 0.9, ..Parameters::MCMANUS }).unwrap();
    let &Parameters { m, H, g, .. } = structure.parameters();
    for tolerance in [1e-4, 1e-9] {
        let released = State { theta: 0.1, ..State::default() };
        let mut engine = Engine::with_detail(structure, released, 0.0, tolerance, Detail::Rigid).unwrap();
        let mut transitions = Vec::new();
        engine.advance(30.0, STILL, &mut |transition: &Transition| transitions.push(*transition)).unwrap();
        let landing = transitions.last().unwrap();
        assert_eq!(landing.kind, TransitionKind::Landing);
        assert_eq!(engine.motion().phase, Phase::FullContact);
        let theta_dot = structure.parameters().r * landing.before.theta_dot;
        let overturning_energy = 0.5 * m * g * H * structure.tan_alpha_cg.powi(2);
        let left = (1e-5 * tolerance).min(1e-11);
        assert!(0.5 * structure.J_P * theta_dot * theta_dot <= left * left * overturning_energy);
        // each impact keeps r of the velocity: as many of them as it takes
        let first = transitions[0].before.theta_dot;
        let enough = ((left * structure.p_l * structure.tan_alpha_cg / first.abs()).ln() / 0.9f64.ln()).ceil();
        assert_eq!(transitions.len() as f64, enough);
    }
}

/// Uplift of the rigid structure is at |a_g| = g tan α_cg.
#[test]
fn rigid_lifts_off_when_the_push_exceeds_its_slenderness() {
    let structure = mcmanus();
    let limit = 9.81 * structure.tan_alpha_cg;
    let ramp = Ramp { value: 0.0, slope: 2.0 * limit };
    let mut engine = Engine::with_detail(structure, State::default(), 0.0, 1e-9, Detail::Rigid).unwrap();
    let mut first = None;
    engine.advance(0.55, ramp, &mut |transition: &Transition| first = first.or(Some(*transition))).unwrap();
    let first = first.unwrap();
    assert_eq!(first.kind, TransitionKind::Uplift(Side::Left)); // ground to the right, structure to the left
    assert_abs_diff_eq!(first.time, 0.5, epsilon = 1e-11);
    assert!(engine.motion().state.theta < 0.0);
}

/// Where two levels have the same equations, they give the same transitions: the rules are one.
#[test]
fn a_small_shaking_lifts_nothing_at_any_level() {
    let samples = shaking(1, 0.01, 400, 0.2);
    for detail in Detail::ALL {
        let mut transitions = Vec::new();
        let states = run(mcmanus(), detail, 1e-10, 0.01, &samples, &mut transitions);
        assert!(transitions.is_empty(), "{}", detail.name());
        let reference = run(mcmanus(), Detail::Nonlinear, 1e-13, 0.01, &samples, &mut Vec::new());
        if detail != Detail::Rigid {
            for (state, reference) in states.iter().zip(&reference) {
                assert_abs_diff_eq!(state.u, reference.u, epsilon = 1e-13);
            }
        }
    }
}

/// A structure that has come to rest stays so, in one call or in many, long after its motion is too small for numbers.
#[test]
fn rest_lasts_at_every_level() {
    for detail in Detail::ALL {
        for f_fc in [5.0, 400.0] {
            let structure = Structure::new(Parameters { f_fc, zeta_fc: 0.1, ..Parameters::MCMANUS }).unwrap();
            let theta = if detail == Detail::FixedBase { 0.0 } else { 1e-3 };
            let u = if detail == Detail::Rigid { 0.0 } else { 0.9 * structure.u_cr };
            let initial = State { theta, u, ..State::default() };
            let start = || Engine::with_detail(structure, initial, 0.0, 1e-9, detail).unwrap();
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
            let structure = Structure::new(Parameters { zeta_fc, r: 0.9, ..Parameters::MCMANUS }).unwrap();
            let initial = State { theta: 0.05, ..State::default() };
            let mut engine = Engine::with_detail(structure, initial, 0.0, 1e-9, detail).unwrap();
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

#[test]
fn initial_states_that_a_level_cannot_have_are_refused() {
    let refused = |detail, initial| Engine::with_detail(mcmanus(), initial, 0.0, 1e-9, detail).unwrap_err().to_string();
    let turned = State { theta: 0.1, ..State::default() };
    assert!(refused(Detail::FixedBase, turned).starts_with("theta_0 = 0.1 rad contradicts detail = fixed_base"));
    let deformed = State { u: 0.01, ..State::default() };
    assert!(refused(Detail::Rigid, deformed).starts_with("u_0 = 0.01 m, u_dot_0 = 0.0 m/s contradict detail = rigid"));
}

/// Stepping allocates nothing, at any level, through any transition.
#[test]
fn stepping_allocates_nothing() {
    let samples = shaking(2, 0.01, 1000, 3.0);
    for detail in Detail::ALL {
        let mut engine = Engine::with_detail(mcmanus(), State::default(), 0.0, 1e-9, detail).unwrap();
        let mut transitions = 0;
        let counted = allocation_counter::measure(|| {
            for (i, pair) in samples.windows(2).enumerate() {
                let a_g = Ramp { value: pair[0], slope: (pair[1] - pair[0]) / 0.01 };
                let progress = engine
                    .advance((i + 1) as f64 * 0.01 - engine.motion().time, a_g, &mut |_: &Transition| transitions += 1)
                    .unwrap();
                if progress == Progress::Overturned {
                    break;
                }
            }
        });
        assert_eq!(counted.count_total, 0, "{}", detail.name());
        assert!(transitions > 0 || detail == Detail::FixedBase, "{}", detail.name());
    }
}
