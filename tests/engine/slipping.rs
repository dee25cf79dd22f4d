//! The base that slides and the ground that yields: printed numbers, closed forms, energy. An independent integration is in
//! `test_ground.py`.

use crate::common::transitions;
use rocking::engine::Settings;
use rocking::run::residual::Residual;
use rocking::{
    Engine, Friction, Ground, Modes, Output, Parameters, Side, State, Structure, Transition, TransitionKind,
};

const EVISON: Parameters = Parameters { J0: 1.1918415, f_fc: 11.0, ..Parameters::EVISON };

fn engine(parameters: Parameters, ground: &Ground, u: f64, theta: f64) -> Engine<Modes> {
    let structure = Structure::new(parameters).unwrap().on(ground).unwrap();
    let settings = Settings { tolerance: 1e-12, vertical: true, ..Settings::default() };
    let [u, u_dot] = [u, 0.0].map(|of| Modes::new(&[of]));
    Engine::of_modes(structure, State { u, u_dot, theta, theta_dot: 0.0 }, 0.0, settings).unwrap()
}

fn evison(mu_c: f64, fs: Option<f64>) -> Engine<Modes> {
    let ground = Ground { f_v: Some(160.0), zeta_v: Some(0.2), mu_c: Some(mu_c), fs, ..Ground::default() };
    engine(EVISON, &ground, 0.75246734e-3, 0.04)
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

/// What leaves the structure is in the ground, in friction and in settlements for good.
#[test]
fn energy_is_kept() {
    for (mu_c, fs, zeta_v, points) in [(0.5, None, 0.2, 2.0), (0.2, Some(3.0), 0.2, 2.0), (0.1, Some(1.5), 0.0, 5.0)] {
        let (zeta_v, n_points) = (Some(zeta_v), Some(points));
        let ground = Ground { f_v: Some(60.0), zeta_v, n_points, mu_c: Some(mu_c), fs, ..Ground::default() };
        let mut engine = engine(Parameters { zeta_fc: 0.0, ..EVISON }, &ground, 0.75246734e-3, 0.04);
        let load = engine.structure().load(0.0, 0.0, &[]).unwrap();
        let before = engine.energy();
        let seen = transitions(&mut engine, 0.7, load).len();
        let of = |output| engine.sample(load).output(output);
        let plastic = if fs.is_some() { of(Output::E_plastic) } else { 0.0 };
        let [ground, friction] = [Output::E_foundation, Output::E_friction].map(of);
        let lost = before - engine.energy() - ground - friction - plastic;
        assert!(lost.abs() < 1e-12 * before, "{lost:e} of {before}: {ground} {friction} {plastic}, {seen} transitions");
        assert!(friction > 1e-6 && (fs.is_none() || plastic > 1e-3), "{friction} {plastic}");
    }
}

/// Newmark's block, whose ground is held at A for t_0: it moves by −½ A t_0² (A/μ_c g − 1), and stops at A t_0/μ_c g, but for the vibration of its
/// mass.
#[test]
fn a_block_slides_as_newmark_s() {
    let block = Parameters { H: 1e-3, f_fc: 1e3, J0: 10.0, ..EVISON };
    let (mu_c, a, t_0) = (0.3, 6.0, 0.2);
    let ground = Ground { f_v: Some(500.0), zeta_v: Some(1.0), mu_c: Some(mu_c), ..Ground::default() };
    let mut engine = engine(block, &ground, 0.0, 0.0);
    let load = |a_g: f64| engine.structure().load(a_g, 0.0, &[]).unwrap();
    let [pulse, none] = [load(a), load(0.0)];
    let mut events = transitions(&mut engine, t_0, pulse);
    events.extend(transitions(&mut engine, 1.0, none));
    let (stops, x) = (a * t_0 / (mu_c * block.g), engine.sample(none).output(Output::x));
    assert!((x / (-0.5 * a * t_0 * t_0 * (a / (mu_c * block.g) - 1.0)) - 1.0).abs() < 1e-3, "{x}");
    let [.., last] = events.as_slice() else { panic!("{events:?}") };
    assert!(last.kind == STICK && (last.time / stops - 1.0).abs() < 1e-3, "{last:?}, not {stops}");
}

/// A structure that comes to rest on two points that have settled does so where the rest is solved.
#[test]
fn a_structure_comes_to_the_rest_that_is_solved() {
    let ground = Ground { f_v: Some(60.0), zeta_v: Some(0.5), fs: Some(1.5), ..Ground::default() };
    let mut engine = engine(Parameters { zeta_fc: 0.2, ..EVISON }, &ground, 0.75246734e-3, 0.04);
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
