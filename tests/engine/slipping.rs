//! The base that slides and the ground that yields: printed numbers, closed forms, energy. An independent integration is in
//! `test_ground.py`.

use crate::common::transitions;
use crate::ground::{EVISON, engine, ground, one_mass};
use crate::modes::three_storeys;
use approx::assert_relative_eq;
use fastrand::Rng;
use rocking::engine::Settings;
use rocking::run::residual::Residual;
use rocking::{
    Dissipators, Engine, Friction, Ground, Modes, Output, Parameters, Side, State, Transition, TransitionKind,
};
use std::collections::HashMap;

fn evison(mu_c: f64, fs: Option<f64>) -> Engine<Modes> {
    let ground = Ground { mu_c: Some(mu_c), fs, ..ground(160.0, 0.2, 2) };
    engine(&one_mass(EVISON, ground), 0.75246734e-3, 0.04)
}

/// Asserts these kinds and instants (s) among the transitions.
fn assert_events(seen: &[Transition<Modes>], expected: &[(TransitionKind, f64)]) {
    for (kind, time) in expected {
        let is_there = seen.iter().any(|of| of.kind == *kind && (of.time - time).abs() < 2e-9);
        assert!(is_there, "{kind:?} at {time}: {:?}", seen.iter().map(|of| (of.kind, of.time)).collect::<Vec<_>>());
    }
}

use Friction::{Slides, Sticks};
use TransitionKind::{Holds, Release, Settles, Touch};

const LEFT: TransitionKind = TransitionKind::Friction(Slides(Side::Left));
const RIGHT: TransitionKind = TransitionKind::Friction(Slides(Side::Right));
const FLIGHT: TransitionKind = TransitionKind::Friction(Friction::Free);
const STICK: TransitionKind = TransitionKind::Friction(Sticks);

#[test]
fn evison_slips_at_the_printed_instants() {
    let follow = |mu_c: f64, fs: Option<f64>| {
        let mut engine = evison(mu_c, fs);
        let load = engine.structure().load(0.0, 0.0, &[]).unwrap();
        (transitions(&mut engine, 0.5, load), engine)
    };
    let (events, _) = follow(0.8, None);
    assert_events(&events, &[(LEFT, 0.171186307), (STICK, 0.171193413)]);
    let (events, _) = follow(0.5, None);
    let expected = [
        (LEFT, 0.170925319),
        (STICK, 0.171989983),
        (RIGHT, 0.189107072),
        (Release(0), 0.189350219),
        (Touch(0), 0.195868234),
        (STICK, 0.195993166),
    ];
    assert_events(&events, &expected);
    let (events, engine) = follow(0.2, None);
    let x = engine.sample(engine.structure().load(0.0, 0.0, &[]).unwrap()).output(Output::x);
    assert_eq!(events.len(), 29);
    assert!((x + 12.23739513e-3).abs() < 1e-11, "{x}");
    let (events, engine) = follow(0.5, Some(3.0));
    let expected =
        [(Touch(0), 0.167986795), (Settles(0), 0.167986795), (Settles(1), 0.168192486), (Holds(1), 0.171161924)];
    assert_events(&events, &expected);
    let load = engine.structure().load(0.0, 0.0, &[]).unwrap();
    let s = [0, 1].map(|i| engine.sample(load).output(Output::s(i)));
    assert!((s[0] - 3.5520066e-3).abs() < 1e-10 && (s[1] - 1.9437923e-3).abs() < 1e-10, "{s:?}");
}

/// What the ground does to random structures on random ground, accelerated in steps, is in their energy, in the ground, in friction, in
/// settlements for good and in the ties, of a bed, with all ties and any number of modes.
#[test]
fn energy_is_kept() {
    let (random, mut seen) = (&mut Rng::with_seed(70), HashMap::<_, usize>::new());
    for scene in 0..100 {
        let mut one_of = |of: &[f64]| of[random.usize(0..of.len())];
        let weight = 130e3 * 9.81;
        let [P_0, c_d] = [[0.0, 0.1], [0.0, 1.0]].map(|of| weight * one_of(&of));
        let ties = [("P_0", P_0), ("k_t", 10.0 * weight), ("xi_d", 1.2), ("c_d", c_d)];
        let ties = [&ties[..], &[("k_d", 30.0 * weight), ("F_y", 0.1 * weight)]].concat();
        let frame = three_storeys(0.0, if one_of(&[0.0, 0.0, 1.0]) > 0.0 { &ties } else { &[] });
        let ground = Ground {
            f_v: Some(one_of(&[5.0, 12.0, 30.0])),
            zeta_v: Some(one_of(&[0.0, 0.0, 0.02, 0.2])),
            n_points: Some(one_of(&[2.0, 3.0, 11.0, 21.0])),
            mu_c: Some(one_of(&[-1.0, 0.0, 0.1, 0.3, 0.8])).filter(|mu_c| *mu_c >= 0.0),
            fs: Some(one_of(&[0.0, 1.0 + 1e-9, 1.5, 3.0])).filter(|fs| *fs > 0.0),
            ..Ground::default()
        };
        let theta = one_of(&[0.0, 0.0, 1e-3, -0.05]);
        let structure = frame.keeping(one_of(&[0.0, 1.0, 3.0]) as usize).unwrap().on(&ground).unwrap();
        let still = Modes::new(&vec![0.0; structure.modes().len()]);
        let settings = Settings { tolerance: 1e-12, vertical: true, ..Settings::default() };
        let state = State { u: still, u_dot: still, theta, theta_dot: 0.0 };
        let mut engine = Engine::of_modes(structure.clone(), state, 0.0, settings).unwrap();
        let (m_t, S_1) = (structure.base().m_t, structure.body().S_1);
        let whole = |engine: &Engine<Modes>| {
            let now = engine.sample(structure.load(0.0, 0.0, &[]).unwrap());
            let Dissipators { viscous, hysteretic, friction, settling, .. } = engine.motion().dissipators;
            engine.energy() + now.output(Output::E_foundation) + viscous + hysteretic + friction + settling
        };
        // the work of an acceleration of the ground is it times the change of these, along and up
        let moved = |engine: &Engine<Modes>| {
            let (state, now) = (engine.motion().state, engine.sample(structure.load(0.0, 0.0, &[]).unwrap()));
            let offset: f64 =
                structure.modes().iter().enumerate().map(|(j, mode)| mode.gamma * state.u.numbers()[j]).sum();
            let ((sin, cos), x) = (state.theta.sin_cos(), now.output(Output::x));
            let x = if x.is_nan() { 0.0 } else { x };
            [m_t * x + S_1 * sin + offset * cos, m_t * now.output(Output::y) + S_1 * cos - offset * sin]
        };
        let (start, mut given, mut size) = (whole(&engine), 0.0, 0.0);
        for _ in 0..90 {
            let [a_g, a_v] =
                [8.0, if scene % 2 == 0 { 0.0 } else { 25.0 }].map(|most| most * (2.0 * random.f64() - 1.0));
            let before = moved(&engine);
            for it in transitions(&mut engine, 0.01, structure.load(a_g, a_v, &[]).unwrap()) {
                *seen.entry(it.kind.name()).or_default() += 1;
            }
            let after = moved(&engine);
            for (a, i) in [(a_g, 0), (a_v, 1)] {
                given -= a * (after[i] - before[i]);
                size += (a * (after[i] - before[i])).abs();
            }
        }
        let lost = start + given - whole(&engine);
        assert!(lost.abs() < 1e-12 * (start.abs() + size), "{scene}: {lost:e} of {start} and {size}: {ground:?}");
    }
    let of_ground = [LEFT, RIGHT, STICK, FLIGHT, Settles(0), Holds(0), Touch(0), Release(0)];
    let of_ties = [TransitionKind::Slack, TransitionKind::Yielding(0), TransitionKind::Unloading(1)];
    assert!(of_ground.iter().chain(&of_ties).all(|of| seen.get(of.name()) > Some(&10)), "{seen:?}");
}

/// Newmark's block, whose ground is held at A for t_0: it moves by −½ A t_0² (A/μ_c g − 1), and stops at A t_0/μ_c g. Almost all mass is in
/// the base, so that it does not rock.
#[test]
fn a_block_slides_as_newmark_s() {
    let block = Parameters { m: 1e-3, H: 1e-3, f_fc: 1e3, J0: 1e6, m0: 170.0, ..EVISON };
    let (mu_c, a, t_0) = (0.3, 6.0, 0.2);
    let ground = Ground { f_v: Some(5.0), zeta_v: Some(0.2), mu_c: Some(mu_c), ..Ground::default() };
    let mut engine = engine(&one_mass(block, ground), 0.0, 0.0);
    let [pulse, none] = [a, 0.0].map(|a_g| engine.structure().load(a_g, 0.0, &[]).unwrap());
    let mut events = transitions(&mut engine, t_0, pulse);
    events.extend(transitions(&mut engine, 1.0, none));
    let (held, x) = (mu_c * block.g, engine.sample(none).output(Output::x));
    assert_relative_eq!(x, -0.5 * a * t_0 * t_0 * (a / held - 1.0), max_relative = 1e-8);
    assert!(matches!(events[..], [stop] if stop.kind == STICK), "{events:?}");
    assert_relative_eq!(events[0].time, a * t_0 / held, max_relative = 1e-8);
}

/// A structure that comes to rest on two points that have settled does so where the rest is solved.
#[test]
fn a_structure_comes_to_the_rest_that_is_solved() {
    let ground = Ground { f_v: Some(60.0), zeta_v: Some(0.5), fs: Some(1.5), ..Ground::default() };
    let mut engine = engine(&one_mass(Parameters { zeta_fc: 0.2, ..EVISON }, ground), 0.75246734e-3, 0.04);
    let load = engine.structure().load(0.0, 0.0, &[]).unwrap();
    transitions(&mut engine, 60.0, load);
    let left = |name: &str| {
        let residual = Residual::all(engine.structure()).find(|of| of.name == name).unwrap();
        residual.of(engine.structure(), engine.motion())
    };
    let (theta, settlement) = (engine.motion().state.theta, engine.sample(load).output(Output::settlement));
    assert!(left("tilt").abs() > 1e-4);
    assert!((theta - left("theta_res")).abs() < 1e-9 * theta.abs(), "{theta} {}", left("theta_res"));
    assert!((settlement - left("settlement_res")).abs() < 1e-9 * settlement, "{settlement}");
}
