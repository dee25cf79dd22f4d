//! Vertical ground motion, tendon and dissipators: against structures that they make another, energy, statics by hand and
//! an integration of its own.
#![allow(non_snake_case)]

mod shaking;

use approx::assert_relative_eq;
use rocking::engine::piece::Sample;
use rocking::estimates::pushover;
use rocking::levels::nonlinear;
use rocking::mechanics::energy::energy;
use rocking::mechanics::restraint::{centring_moments, stored_energy, uplift_displacement};
use rocking::run::record::Record;
use rocking::run::validity::Limits;
use rocking::run::{End, Run};
use rocking::{
    Detail, Dissipators, Engine, LinearLoad, Load, Motion, Parameters, Phase, Side, State, Structure, Transition,
    TransitionKind,
};
use shaking::shaking;

const LEVELS: [Detail; 4] = [Detail::Auto, Detail::Nonlinear, Detail::Linear, Detail::Rigid];

fn structure(parameters: Parameters) -> Structure {
    Structure::new(parameters).unwrap()
}

/// McManus's specimen with a tendon and dissipators: some tenths of its weight of 1.9 kN, its stiffness a few times that
/// which the weight takes away.
const RESTRAINED: Parameters =
    Parameters { P_0: 400.0, k_t: 2e4, xi_d: 0.2, c_d: 150.0, k_d: 2e5, F_y: 120.0, ..Parameters::MCMANUS };

/// The states and transitions of a run, at 200 instants and at its end.
fn course(run: &Run) -> (Vec<State>, u64) {
    let (start, end) = (run.ground.start(), run.ground.end());
    let mut states = Vec::new();
    let times = (0..200).map(|i| start + (end - start) * f64::from(i) / 200.0);
    let finish = run.sample(times, |at: &Sample| states.push(at.motion.state), &mut ()).unwrap();
    (states, finish.motion.transitions)
}

/// The largest difference of the components of two courses, each over the largest that the second has.
fn apart(a: &[State], b: &[State]) -> f64 {
    let most = |of: &dyn Fn(usize) -> f64| (0..a.len()).map(of).fold(0.0, f64::max);
    let relative = |c: usize| {
        let off = most(&|i| (a[i].components()[c] - b[i].components()[c]).abs());
        if off == 0.0 { 0.0 } else { off / most(&|i| b[i].components()[c].abs()) }
    };
    assert_eq!(a.len(), b.len());
    (0..4).map(relative).fold(0.0, f64::max)
}

fn with_vertical(ground: &Record, a_v: impl Fn(f64) -> f64) -> Record {
    let of = ground.times().iter().map(|time| a_v(*time)).collect();
    let vertical = Record::from_samples("up", ground.times().into(), of).unwrap();
    ground.clone().with_vertical(&vertical).unwrap()
}

#[test]
fn a_constant_vertical_acceleration_is_another_gravity() {
    let ground = shaking(3, 0.01, 250, 2.0);
    for c in [-0.2, 0.25] {
        let vertical = with_vertical(&ground, |_| c * 9.81);
        for detail in LEVELS {
            let run = Run::new(structure(Parameters::MCMANUS), &vertical);
            let shaken = Run { detail, end: End::At(ground.end()), ..run };
            let heavier = structure(Parameters { g: 9.81 * (1.0 + c), ..Parameters::MCMANUS });
            let (expected, transitions) = course(&Run { structure: heavier, ground: &ground, ..shaken.clone() });
            let (found, its) = course(&shaken);
            let off = apart(&found, &expected);
            // a rigid one comes to rest by impacts without end, which rounding cuts short
            let are_even = its == transitions || detail == Detail::Rigid;
            assert!(are_even && transitions > 2 && off < 1e-9, "{detail:?}, {c}: {off:e}, {its} of {transitions}");
        }
    }
}

/// No vertical motion, but room for it: the equations with all their terms are the equations without.
#[test]
fn what_is_zero_changes_nothing() {
    let ground = shaking(5, 0.01, 300, 3.0);
    let vertical = with_vertical(&ground, |_| 0.0);
    for detail in LEVELS {
        let run = Run { detail, end: End::At(ground.end()), ..Run::new(structure(Parameters::MCMANUS), &vertical) };
        let (expected, transitions) = course(&Run { ground: &ground, ..run.clone() });
        let (found, its) = course(&run);
        let off = apart(&found, &expected);
        assert!(its == transitions && transitions > 5 && off < 1e-9, "{detail:?}: {off:e}, {transitions}");
    }
}

/// P_0 alone, for small angles: weight at the base that has no inertia.
#[test]
fn a_prestressed_tendon_is_more_weight_at_the_base() {
    let ground = shaking(4, 0.01, 200, 4.0);
    let P_0 = 300.0;
    let &Parameters { m0, J0, B, g, .. } = &Parameters::MCMANUS;
    let more = P_0 / g;
    let heavier = Parameters { m0: m0 + more, J0: J0 - more * B * B, ..Parameters::MCMANUS };
    let run = |parameters| Run { detail: Detail::Linear, ..Run::new(structure(parameters), &ground) };
    let (expected, transitions) = course(&run(heavier));
    let (found, its) = course(&run(Parameters { P_0, ..Parameters::MCMANUS }));
    let off = apart(&found, &expected);
    assert!(its == transitions && transitions > 5 && off < 1e-9, "{off:e}, {transitions}");
}

/// Released, without damping of its own: what the structure and the restraints store falls by what the dissipators take, and
/// only by that, until the impact.
#[test]
fn energy_goes_where_the_dissipators_take_it() {
    let undamped = Parameters { zeta_fc: 0.0, ..RESTRAINED };
    for parameters in [
        Parameters { c_d: 0.0, k_d: 0.0, F_y: 0.0, ..undamped },
        Parameters { c_d: 0.0, F_y: 1e9, ..undamped },
        Parameters { k_d: 0.0, F_y: 0.0, ..undamped },
        undamped,
        Parameters { xi_d: 0.4, ..undamped },
    ] {
        let structure = structure(parameters);
        for (theta, theta_dot) in [(0.03, 0.0), (-0.02, -0.2)] {
            let initial = State { theta, theta_dot, u: 1e-3, u_dot: 0.0 };
            let mut engine = Engine::with_detail(structure, initial, 0.0, 1e-11, Detail::Nonlinear).unwrap();
            let total = |&Motion { phase, state, dissipators, .. }: &Motion| {
                let stored = stored_energy(&structure, phase.side(), state.theta, &dissipators);
                let taken = dissipators.viscous + dissipators.hysteretic;
                (energy(&structure, phase, &state) + stored + taken, taken)
            };
            let (before, _) = total(engine.motion());
            let scale = before - energy(&structure, Phase::FullContact, &State::default());
            let mut last = (0.0, 0.0);
            for _ in 0..400 {
                engine.advance(2e-3, Load::default(), &mut ()).unwrap();
                if engine.motion().phase != Phase::Rocking(Side::of(theta)) {
                    break;
                }
                let (now, taken) = total(engine.motion());
                assert!((now - before).abs() < 1e-12 * before, "{parameters:?}: {:e}", now - before);
                assert!(taken >= last.0, "{taken} {last:?}");
                last = (taken, engine.motion().time);
            }
            assert!(last.1 > 0.02, "it rocked for {} s", last.1);
            let is_taken = parameters.c_d > 0.0 || (0.0..1e9).contains(&parameters.F_y) && parameters.k_d > 0.0;
            assert_eq!(last.0 > 1e-3 * scale.abs(), is_taken, "{parameters:?}: {} of {scale} J", last.0);
        }
    }
}

/// Up to θ_m and back, by hand: elastic to F_y, yielding, unloading over 2 F_y, yielding back; the loop is Σ 2 F_y |l| cos(θ/2)
/// high.
#[test]
fn the_static_loop_is_the_flag_of_the_hand_calculation() {
    for xi_d in [0.2, 0.5] {
        let parameters = Parameters { xi_d, ..RESTRAINED };
        let structure = structure(parameters);
        let Parameters { B, k_d, F_y, P_0, k_t, m, m0, H, g, .. } = parameters;
        let most = 0.05_f64;
        let peak = Dissipators::default().moved(&structure, Side::Right, most);
        let levers = [B - xi_d, B + xi_d];
        let mut taken = 0.0;
        for theta in [0.002_f64, 0.02, 0.035] {
            let chord = 2.0 * (theta / 2.0).sin();
            let (up, down) = (
                Dissipators::default().moved(&structure, Side::Right, theta),
                peak.moved(&structure, Side::Right, theta),
            );
            let [rising, falling] = [&up, &down].map(|at| pushover::with_dissipators(&structure, theta, at).unwrap());
            let by_hand = |way: f64, u: f64| {
                let tied: f64 = levers.iter().map(|l| way * (k_d * l.abs() * chord).min(F_y) * l.abs()).sum();
                let weight = (m + m0) * g * B * theta.cos() - m * g * (H * theta.sin() + u * theta.cos());
                weight + (tied + B * (P_0 + k_t * B * chord)) * (theta / 2.0).cos()
            };
            assert_relative_eq!(rising.moment, by_hand(1.0, rising.u), max_relative = 1e-12);
            let loads =
                levers.map(|l| (F_y - k_d * l.abs() * 2.0 * ((most / 2.0).sin() - (theta / 2.0).sin())).max(-F_y));
            let tied: f64 = levers.iter().zip(loads).map(|(l, load)| load * l.abs()).sum();
            let falls = by_hand(0.0, falling.u) + tied * (theta / 2.0).cos();
            assert_relative_eq!(falling.moment, falls, max_relative = 1e-12);
            taken = down.hysteretic;
        }
        let back = peak.moved(&structure, Side::Right, 0.0);
        let stroke = |l: f64| l.abs() * 2.0 * (most / 2.0).sin() - F_y / k_d;
        let first: f64 = levers.iter().map(|l| F_y * stroke(*l)).sum();
        let second: f64 = levers.iter().map(|l| F_y * (stroke(*l) - F_y / k_d).max(0.0)).sum();
        assert_relative_eq!(peak.hysteretic, first, max_relative = 1e-12);
        assert_relative_eq!(back.hysteretic, first + second, max_relative = 1e-12);
        assert!(taken < back.hysteretic);
    }
}

/// A motion about the right pivot under `load`, by Runge and Kutta's method of fourth order with steps of 5 µs: when the
/// dissipators begin to yield and cease to, until `until` (s).
fn yields_by_runge_kutta(
    structure: &Structure,
    load: LinearLoad,
    initial: State,
    until: f64,
) -> Vec<(f64, TransitionKind)> {
    let &Parameters { m, m0, H, B, J0, P_0, k_t, xi_d, c_d, k_d, F_y, .. } = structure.parameters();
    let levers = [B - xi_d, B + xi_d];
    let elongation = |j: usize, theta: f64| 2.0 * levers[j] * (theta / 2.0).sin();
    type Modes = [(f64, f64); 2]; // whether it yields, and which way; plastic elongation
    let force = |j: usize, modes: &Modes, theta: f64| match modes[j] {
        (0.0, plastic) => k_d * (elongation(j, theta) - plastic),
        (way, _) => way * F_y,
    };
    let rates = |modes: &Modes, t: f64, y: [f64; 4]| {
        let [u, u_dot, theta, theta_dot] = y;
        let half = (theta / 2.0).cos();
        let e_t = 2.0 * B * (theta / 2.0).sin();
        let tied = |j: usize| (force(j, modes, theta) + c_d * levers[j] * half * theta_dot) * levers[j];
        let back = half * (B * (P_0 + k_t * e_t) + tied(0) + tied(1));
        let free = nonlinear::accelerations(structure, Side::Right, &State::of(y), load.at(t)).unwrap();
        let turning = J0 + m * H * H + m * (B - u).powi(2) + m0 * B * B;
        let per = back / (m * turning - m * H * m * H);
        [u_dot, free[0] + m * H * per, theta_dot, free[1] - m * per]
    };
    let step = |modes: &Modes, t: f64, y: [f64; 4], h: f64| {
        let along = |k: [f64; 4], part: f64| std::array::from_fn(|i| y[i] + part * k[i]);
        let a = rates(modes, t, y);
        let b = rates(modes, t + h / 2.0, along(a, h / 2.0));
        let c = rates(modes, t + h / 2.0, along(b, h / 2.0));
        let d = rates(modes, t + h, along(c, h));
        std::array::from_fn::<f64, 4, _>(|i| y[i] + h / 6.0 * (a[i] + 2.0 * b[i] + 2.0 * c[i] + d[i]))
    };
    let goes_on = |j: usize, modes: &Modes, y: [f64; 4]| match modes[j].0 {
        0.0 => force(j, modes, y[2]).abs() < F_y,
        way => way * levers[j] * y[3] > 0.0,
    };
    let (mut t, mut y, mut found) = (0.0, initial.components(), Vec::new());
    let mut modes = [0, 1].map(|j| {
        let beyond = (k_d * elongation(j, y[2]).abs() - F_y).max(0.0) / k_d;
        (0.0, beyond.copysign(elongation(j, y[2])) * (1.0 + 1e-13))
    });
    while t < until {
        let h = 5e-6;
        let next = step(&modes, t, y, h);
        let Some(j) = (0..2).find(|j| !goes_on(*j, &modes, next)) else {
            (t, y) = (t + h, next);
            continue;
        };
        let (mut low, mut high) = (0.0, h);
        while high - low > 1e-15 {
            let middle = 0.5 * (low + high);
            *(if goes_on(j, &modes, step(&modes, t, y, middle)) { &mut low } else { &mut high }) = middle;
        }
        (y, t) = (step(&modes, t, y, high), t + high);
        let kind = if modes[j].0 == 0.0 { TransitionKind::Yielding(j) } else { TransitionKind::Unloading(j) };
        // with a hair's breadth between what has turned and F_y
        modes[j] = match modes[j].0 {
            0.0 => (force(j, &modes, y[2]).signum(), modes[j].1),
            way => (0.0, elongation(j, y[2]) - way * F_y / k_d * (1.0 - 1e-13)),
        };
        found.push((t, kind));
    }
    found
}

#[test]
fn dissipators_yield_and_unload_when_an_independent_integration_does() {
    let structure = structure(RESTRAINED);
    for (detail, xi_d) in [(Detail::Auto, 0.2), (Detail::Nonlinear, 0.2), (Detail::Auto, 0.5)] {
        let structure = self::structure(Parameters { xi_d, ..*structure.parameters() });
        let value = Load { a_g: -2.0, F_t: 50.0, a_v: 1.5 };
        let load = LinearLoad { value, slope: Load { a_g: 9.0, F_t: -400.0, a_v: -30.0 } };
        let initial = State { theta: 0.01, theta_dot: 0.4, u: 1e-3, u_dot: 0.0 };
        let mut engine = Engine::with_detail(structure, initial, 0.0, 1e-10, detail).unwrap();
        engine.admit_vertical(true).unwrap();
        let mut seen = Vec::new();
        engine.advance(1.0, load, &mut |at: &Transition| seen.push((at.time, at.kind))).unwrap();
        let first_impact = seen
            .iter()
            .position(|(_, kind)| !matches!(kind, TransitionKind::Yielding(_) | TransitionKind::Unloading(_)));
        seen.truncate(first_impact.expect("it comes down"));
        let until = seen.last().unwrap().0 + 1e-4;
        let expected = yields_by_runge_kutta(&structure, load, initial, until);
        assert!(seen.len() >= 6, "{seen:?}");
        assert_eq!(seen.len(), expected.len(), "{seen:?} {expected:?}");
        for (found, expected) in seen.iter().zip(&expected) {
            assert!(found.1 == expected.1 && (found.0 - expected.0).abs() < 1e-9, "{seen:?} {expected:?}");
        }
    }
}

/// Undamped, u = U sin ωt below u_cr at rest: the weight falls, and the base lifts off where u meets what u_cr has come to.
#[test]
fn uplift_is_due_where_the_vertical_acceleration_and_the_prestress_put_it() {
    let parameters = Parameters { zeta_fc: 0.0, P_0: 200.0, ..Parameters::MCMANUS };
    let structure = structure(parameters);
    let &Parameters { m, H, B, g, P_0, .. } = structure.parameters();
    let omega = structure.omega_fc;
    for (side, detail) in [(Side::Right, Detail::Auto), (Side::Left, Detail::Linear)] {
        let u_cr = |t: f64| structure.u_cr * (1.0 - 40.0 * t / g) + P_0 * B / (m * H * omega * omega);
        let u = |t: f64| 0.9 * u_cr(0.0) * (omega * t).sin();
        let meets = (0..).map(|i| f64::from(i) * 1e-6).find(|t| u(*t) >= u_cr(*t)).unwrap();
        let initial = State { u_dot: side.sign() * 0.9 * u_cr(0.0) * omega, ..State::default() };
        let mut engine = Engine::with_detail(structure, initial, 0.0, 1e-12, detail).unwrap();
        engine.admit_vertical(true).unwrap();
        let mut seen = None;
        let load = LinearLoad { slope: Load { a_v: -40.0, ..Load::default() }, ..LinearLoad::default() };
        engine.advance(0.1, load, &mut |at: &Transition| _ = seen.get_or_insert(*at)).unwrap();
        let Transition { time, kind, before, .. } = seen.unwrap();
        assert!(kind == TransitionKind::Uplift(side) && (time - meets).abs() < 2e-6, "{kind:?} {time} {meets}");
        let limit = uplift_displacement(&structure, side, -40.0 * time, &Dissipators::default());
        assert_relative_eq!(side.sign() * before.u, limit, max_relative = 1e-12);
    }
    // a rigid one: m H |a_g| against the moment of what is left of the weight and of the tendon, both linear in time
    let mut engine = Engine::with_detail(structure, State::default(), 0.0, 1e-9, Detail::Rigid).unwrap();
    engine.admit_vertical(true).unwrap();
    let slope = Load { a_g: 5.0, F_t: 0.0, a_v: -40.0 };
    let mut seen = None;
    let load = LinearLoad { slope, ..LinearLoad::default() };
    engine.advance(0.2, load, &mut |at: &Transition| _ = seen.get_or_insert((at.time, at.kind))).unwrap();
    let moment = structure.gamma * m * g * B + P_0 * B;
    let due = moment / (m * H * 5.0 + structure.gamma * m * 40.0 * B);
    let (time, kind) = seen.unwrap();
    assert_eq!(kind, TransitionKind::Uplift(Side::Left));
    assert_relative_eq!(time, due, max_relative = 1e-11);
}

/// The ground falls faster than g: uplift at once where g + a_v passes 0, and validity tells of the instant.
#[test]
fn a_free_fall_lifts_the_base_off_and_is_told() {
    let structure = structure(Parameters::EVISON);
    let ground = Record::from_samples("", vec![0.0, 0.2], vec![0.01, 0.01]).unwrap();
    let vertical = with_vertical(&ground, |t| -100.0 * t);
    for detail in LEVELS {
        let run = Run { detail, end: End::At(0.11), ..Run::new(structure, &vertical) };
        let mut first = None;
        run.follow(&mut |at: &Transition| _ = first.get_or_insert((at.time, at.kind))).unwrap();
        let (time, kind) = first.unwrap();
        assert!(matches!(kind, TransitionKind::Uplift(Side::Left)), "{kind:?}");
        assert!(0.097 < time && time <= 0.0981 + 1e-12, "{detail:?}: {time}");
        let (found, _) = run.validity(Limits::default()).unwrap();
        assert_relative_eq!(found.weight.first_beyond.unwrap(), 0.0981, max_relative = 1e-12);
        assert_relative_eq!(found.weight.value, 1.0 - 11.0 / 9.81, max_relative = 1e-12);
        assert!(found.warning_of_flight().unwrap().starts_with("t = 0.0981"));
    }
    let run = Run { detail: Detail::Modal, ..Run::new(structure, &vertical) };
    assert!(run.follow(&mut ()).unwrap_err().to_string().starts_with("detail = modal has no modes of a structure"));
    let mut unprepared = Engine::new(structure, State::default(), 0.0, 1e-9).unwrap();
    let load: LinearLoad = Load { a_v: 1.0, ..Load::default() }.into();
    assert!(unprepared.advance(1.0, load, &mut ()).unwrap_err().to_string().starts_with("a_v = 1 m/s2"));
}

/// What the edges carry: in full contact the weight and the prestress; while rocking the moment about the pivot is that of
/// the ties alone; and the least that validity finds is the least of samples.
#[test]
fn the_edges_carry_what_the_ties_pull_beside_the_reactions() {
    let structure = structure(RESTRAINED);
    let &Parameters { m, m0, B, g, P_0, .. } = structure.parameters();
    let engine = Engine::new(structure, State::default(), 0.0, 1e-9).unwrap();
    let load = Load { a_v: 2.0, ..Load::default() };
    assert_relative_eq!(engine.edges(load).R_v, (m + m0) * (g + 2.0) + P_0, max_relative = 1e-14);

    let ground = with_vertical(&shaking(6, 0.01, 300, 8.0), |t| 3.0 * (30.0 * t).sin());
    for detail in [Detail::Auto, Detail::Rigid] {
        let run = Run { detail, end: End::At(ground.end()), ..Run::new(structure, &ground) };
        let (mut least, mut friction) = (f64::INFINITY, 0.0_f64);
        let mut most = [0.0_f64; 4];
        let dense = (0..150_000).map(|i| f64::from(i) * 2e-5);
        let show = |at: &Sample| {
            let (edges, reactions, ties) = (at.edges(), at.reactions(), at.restraints());
            let (sin, cos) = (at.motion.state.theta / 2.0).sin_cos();
            let pull = ties.P_t + ties.F_d1 + ties.F_d2;
            assert_relative_eq!(edges.R_v, reactions.R_v + pull * cos, max_relative = 1e-12, epsilon = 1e-9);
            assert_relative_eq!(edges.R_h, reactions.R_h - pull * sin, max_relative = 1e-12, epsilon = 1e-9);
            if let Phase::Rocking(side) = at.motion.phase {
                // about the pivot the edge has no moment: all of R_m is R_v's and the ties'
                let xi = RESTRAINED.xi_d;
                let anchored = cos * xi * (ties.F_d2 - ties.F_d1);
                let about = side.sign() * B * edges.R_v + anchored;
                assert_relative_eq!(reactions.R_m, about, max_relative = 1e-9, epsilon = 1e-6);
            }
            least = least.min(edges.R_v / ((m + m0) * g));
            friction = friction.max(edges.R_h.abs() / edges.R_v);
            let outputs = at.outputs();
            let shown = [outputs.theta, outputs.a_t, outputs.delta_t, ties.P_t];
            most.iter_mut().zip(shown).for_each(|(most, value)| *most = most.max(value.abs()));
        };
        run.sample(dense, show, &mut ()).unwrap();
        let (found, finish) = run.validity(Limits::default()).unwrap();
        let (peaks, _) = run.peaks().unwrap();
        for (sampled, peak) in most.into_iter().zip([peaks.theta(), peaks.a_t(), peaks.delta_t(), peaks.P_t()]) {
            let exact = peak.magnitude;
            assert!(sampled <= exact * (1.0 + 1e-9) && sampled > 0.99 * exact, "{detail:?}: {sampled} {exact}");
        }
        let [_, edge_load, mu, ..] = found.worst;
        assert!(finish.motion.transitions > 10);
        assert!(edge_load.value <= least && edge_load.value > least - 1e-2, "{} {least}", edge_load.value);
        assert!(mu.value >= friction && mu.value < friction * 1.02, "{} {friction}", mu.value);
    }
}

/// Four scenes at the default tolerance beside series throughout at 1e-12, within 3e-8 or a hundred times what a change of 1e-12
/// in the input moves.
#[test]
fn shaken_restrained_structures_keep_their_tolerance() {
    let evison = Parameters { P_0: 300.0, k_t: 3e4, xi_d: 0.25, c_d: 400.0, ..Parameters::EVISON };
    let scenes = [
        (Parameters::MCMANUS, Detail::Auto, 2.2),
        (evison, Detail::Linear, 7.0),
        (Parameters { c_d: 0.0, ..RESTRAINED }, Detail::Auto, 6.0),
        (RESTRAINED, Detail::Auto, 8.0),
    ];
    for (i, (parameters, detail, peak)) in scenes.into_iter().enumerate() {
        let ground =
            with_vertical(&shaking(7 + i as u32, 0.01, 400, peak), |t| 4.0 * (40.0 * t).sin() * (-0.3 * t).exp());
        let nudged = ground.clone().multiplied(1.0 + 1e-12);
        let run = Run { detail, end: End::At(ground.end()), ..Run::new(structure(parameters), &ground) };
        let by_series = if detail == Detail::Auto { Detail::Nonlinear } else { detail };
        let exact = Run { detail: by_series, tolerance: 1e-12, ..run.clone() };
        let (expected, transitions) = course(&exact);
        let (moved, _) = course(&Run { ground: &nudged, ..exact.clone() });
        let (found, its) = course(&run);
        let (off, conditioning) = (apart(&found, &expected), apart(&moved, &expected));
        println!("scene {i}: off {off:e}, conditioning {conditioning:e}, {transitions} transitions");
        assert!(its == transitions && transitions > 4, "scene {i}: {its} of {transitions}");
        assert!(off < f64::max(3e-8, 100.0 * conditioning), "scene {i}: {off:e}, conditioning {conditioning:e}");
    }
}

/// Another integrator's steps: what the host is told of yielding is what the engine finds.
#[test]
fn indicators_stay_positive_between_transitions() {
    let ground = with_vertical(&shaking(9, 0.01, 300, 8.0), |t| 3.0 * (20.0 * t).sin());
    let run = Run { end: End::At(ground.end()), ..Run::new(structure(RESTRAINED), &ground) };
    let mut yielding = 0;
    let times = (0..60_000).map(|i| f64::from(i) * 5e-5);
    let show = |at: &Sample| {
        yielding += u32::from(at.motion.dissipators.yields != [0; 2]);
        assert!(at.event_indicators().iter().all(|indicator| *indicator > -1e-9), "{:?}", at.motion);
    };
    run.sample(times, show, &mut ()).unwrap();
    assert!(yielding > 100, "{yielding}");
}

/// Pushed over and let go: where the residual forces outweigh what turns it back it comes to rest turned, otherwise in contact.
#[test]
fn what_does_not_centre_itself_stays_turned() {
    let ground = Record::at_rest(6.0);
    for (F_y, stays) in [(120.0, false), (1800.0, true)] {
        let structure = structure(Parameters { F_y, P_0: 0.0, k_t: 0.0, c_d: 2e4, ..RESTRAINED });
        let [back, residual] = centring_moments(&structure);
        assert_eq!(residual > back, stays, "{residual} {back}");
        let initial = State { theta: 0.05, ..State::default() };
        let run = Run { initial, end: End::At(6.0), ..Run::new(structure, &ground) };
        let Motion { phase, state, .. } = run.follow(&mut ()).unwrap().motion;
        assert_eq!(phase == Phase::Rocking(Side::Right) && state.theta > 1e-3, stays, "{phase:?} {state:?}");
        assert!(!stays || state.theta_dot.abs() < 1e-6, "{state:?}");
    }
}
