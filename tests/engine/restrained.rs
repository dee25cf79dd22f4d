//! Vertical ground motion, tendon and dissipators: against structures that they make another, and statics by hand.

use crate::common::{distance, engine_of, peaks_beside_samples, shaking, transitions, transitions_of};
use approx::assert_relative_eq;
use rocking::engine::Settings;
use rocking::mechanics::restraint::centring_moments;
use rocking::run::ground_motion::Elapsed;
use rocking::run::record::Record;
use rocking::run::validity::{Limits, WEIGHT, of_structure};
use rocking::run::{End, Run};
use rocking::{
    Detail, Engine, GroundMotion, LinearLoad, Load, Motion, OneMass, Output, Parameters, Phase, Sample, Side, State,
    Transition, TransitionKind,
};
use std::mem::discriminant;

const LEVELS: [Detail; 4] = [Detail::Auto, Detail::Nonlinear, Detail::Linear, Detail::Rigid];

fn structure(parameters: Parameters) -> OneMass {
    OneMass::new(parameters).unwrap()
}

/// The |u| at which the base lifts off under a_v: { [(m + m0)(g + a_v) + P_0] B }/(m H ω_fc²), m, with dissipators that are new.
fn uplift_displacement(one: &OneMass, a_v: f64) -> f64 {
    let &Parameters { m, m0, H, B, g, P_0, .. } = one.parameters();
    ((m + m0) * (g + a_v) + P_0) * B / (H * one.k)
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
    assert_eq!(a.len(), b.len());
    let all = |of: &[State], c: usize| Vec::from_iter(of.iter().map(|state| state.components()[c]));
    (0..4).map(|c| distance(&all(a, c), &all(b, c))).fold(0.0, f64::max)
}

fn with_vertical(ground: &Record, a_v: impl Fn(f64) -> f64) -> Record {
    let of = ground.times().iter().map(|time| a_v(*time)).collect();
    let vertical = Record::from_samples("up", ground.times().into(), of).unwrap();
    ground.clone().with_vertical(&vertical).unwrap()
}

/// Even where it is 0: the equations with all their terms are the equations without.
#[test]
fn a_constant_vertical_acceleration_is_another_gravity() {
    let ground = shaking(3, 0.01, 250, 2.0);
    for c in [-0.2, 1e-300, 0.25] {
        let vertical = with_vertical(&ground, |_| c * 9.81);
        for detail in LEVELS {
            let run = Run::new(structure(Parameters::MCMANUS), &vertical);
            let shaken = Run { detail, end: End::At(ground.end()), ..run };
            let heavier = structure(Parameters { g: 9.81 * (1.0 + c), ..Parameters::MCMANUS });
            let (expected, transitions) = course(&Run { structure: heavier.into(), ground: &ground, ..shaken.clone() });
            let (found, its) = course(&shaken);
            let off = apart(&found, &expected);
            // a rigid one comes to rest by impacts without end, which rounding cuts short
            let are_even = its == transitions || detail == Detail::Rigid;
            assert!(are_even && transitions > 2 && off < 1e-9, "{detail:?}, {c}: {off:e}, {its} of {transitions}");
        }
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

/// Undamped, u = U sin ωt below u_cr at rest: the weight falls, and the base lifts off where u meets what u_cr has come to.
#[test]
fn uplift_is_due_where_the_vertical_acceleration_and_the_prestress_put_it() {
    let parameters = Parameters { zeta_fc: 0.0, P_0: 200.0, ..Parameters::MCMANUS };
    let structure = structure(parameters);
    let &Parameters { m, H, B, g, P_0, .. } = structure.parameters();
    let omega = structure.omega_fc;
    for (side, detail) in [(Side::Right, Detail::Auto), (Side::Left, Detail::Linear)] {
        let u_cr = |t: f64| (structure.gamma * (g - 40.0 * t) * B + P_0 * B / m) / (H * omega * omega);
        let u = |t: f64| 0.9 * u_cr(0.0) * (omega * t).sin();
        let meets = (0..).map(|i| f64::from(i) * 1e-6).find(|t| u(*t) >= u_cr(*t)).unwrap();
        let initial = State { u_dot: side.sign() * 0.9 * u_cr(0.0) * omega, ..State::default() };
        let settings = Settings { detail, tolerance: 1e-12, vertical: true, ..Settings::default() };
        let mut engine = Engine::with(structure, initial, 0.0, settings).unwrap();
        let load = LinearLoad { slope: Load { a_v: -40.0, ..Load::default() }, ..LinearLoad::default() };
        let Transition { time, kind, before, .. } = transitions(&mut engine, 0.1, load)[0];
        assert!(kind == TransitionKind::Uplift(side) && (time - meets).abs() < 2e-6, "{kind:?} {time} {meets}");
        let limit = uplift_displacement(&structure, -40.0 * time);
        assert_relative_eq!(side.sign() * before.u, limit, max_relative = 1e-12);
    }
    // a rigid one: m H |a_g| against the moment of what is left of the weight and of the tendon, both linear in time
    let settings = Settings { detail: Detail::Rigid, vertical: true, ..Settings::default() };
    let mut engine = Engine::with(structure, State::default(), 0.0, settings).unwrap();
    let slope = Load { a_g: 5.0, F_t: 0.0, a_v: -40.0 };
    let load = LinearLoad { slope, ..LinearLoad::default() };
    let Transition { time, kind, .. } = transitions(&mut engine, 0.2, load)[0];
    let moment = structure.gamma * m * g * B + P_0 * B;
    let due = moment / (m * H * 5.0 + structure.gamma * m * 40.0 * B);
    assert_eq!(kind, TransitionKind::Uplift(Side::Left));
    assert_relative_eq!(time, due, max_relative = 1e-11);
}

/// Beyond u_cr on its way back, which the ground turns round: the base lifts off where what turns it outweighs what holds it.
#[test]
fn uplift_waits_for_the_moment() {
    let parameters = Parameters { zeta_fc: 0.5, P_0: 200.0, ..Parameters::MCMANUS };
    let structure = structure(parameters);
    let Parameters { m, m0, H, B, g, P_0, .. } = parameters;
    let u_cr = uplift_displacement(&structure, 0.0);
    let initial = State { u: 1.2 * u_cr, u_dot: -0.1, ..State::default() };
    let slope = Load { a_v: -2000.0, ..Load::default() };
    let load = LinearLoad { value: Load { a_g: -60.0, F_t: 0.0, a_v: 2.0 }, slope };
    let settings = Settings { tolerance: 1e-12, vertical: true, ..Settings::default() };
    let mut engine = Engine::with(structure, initial, 0.0, settings).unwrap();
    let Transition { time, kind, before: State { u, u_dot, .. }, .. } = transitions(&mut engine, 0.1, load)[0];
    assert!(kind == TransitionKind::Uplift(Side::Right) && time > 1e-4, "{kind:?} {time}");
    let weight = g + load.at(time).a_v;
    let turning = H * (structure.k * u + structure.c_u * u_dot) + m * weight * u;
    assert_relative_eq!(turning, ((m + m0) * weight + P_0) * B, max_relative = 1e-10);
}

/// The ground falls faster than g: uplift at once where g + a_v passes 0, and validity tells of the instant.
#[test]
fn a_free_fall_lifts_the_base_off_and_is_told() {
    let structure = structure(Parameters::EVISON);
    let ground = Record::from_samples("", vec![0.0, 0.2], vec![0.01, 0.01]).unwrap();
    let vertical = with_vertical(&ground, |t| -100.0 * t);
    for detail in LEVELS {
        let run = Run { detail, end: End::At(0.11), ..Run::new(structure, &vertical) };
        let Transition { time, kind, .. } = transitions_of(&run)[0];
        assert!(matches!(kind, TransitionKind::Uplift(Side::Left)), "{kind:?}");
        assert!(0.097 < time && time <= 0.0981 + 1e-12, "{detail:?}: {time}");
        let (found, _) = run.validity(Limits::default()).unwrap();
        let weight = found.worst[WEIGHT];
        assert_relative_eq!(weight.first_beyond.unwrap(), 0.0981, max_relative = 1e-12);
        assert_relative_eq!(weight.value, 1.0 - 11.0 / 9.81, max_relative = 1e-12);
        let warning = found.warning(WEIGHT, &Limits::default()).unwrap();
        assert!(warning.starts_with("t = 0.0981"), "{warning}");
        assert!(warning.contains("weight_min is at or below 0: no weight holds the base down"), "{warning}");
    }
    let run = Run { detail: Detail::Modal, ..Run::new(structure, &vertical) };
    assert!(run.follow(&mut ()).unwrap_err().to_string().starts_with("detail = modal has no modes of a structure"));
    let mut unprepared = Engine::new(structure, State::default(), 0.0, 1e-9).unwrap();
    let load: LinearLoad = Load { a_v: 1.0, ..Load::default() }.into();
    assert!(unprepared.advance(1.0, load, &mut ()).unwrap_err().to_string().starts_with("a_v = 1 m/s2"));
}

/// In full contact the edges carry the weight and the prestress. While rocking their moment about the pivot is the moment of
/// the ties. The least load that validity finds is the least of dense samples.
#[test]
fn the_edges_carry_what_the_ties_pull_beside_the_reactions() {
    let structure = structure(RESTRAINED);
    let &Parameters { m, m0, B, g, P_0, .. } = structure.parameters();
    let load = Load { a_v: 2.0, ..Load::default() };
    for detail in LEVELS.into_iter().chain([Detail::FixedBase]) {
        let engine = engine_of(structure, State::default(), 1e-9, detail);
        assert_relative_eq!(engine.sample(load).edges().R_v, (m + m0) * (g + 2.0) + P_0, max_relative = 1e-14);
    }

    let ground = with_vertical(&shaking(6, 0.01, 300, 8.0), |t| 3.0 * (30.0 * t).sin());
    for detail in [Detail::Auto, Detail::Rigid] {
        let run = Run { detail, end: End::At(ground.end()), ..Run::new(structure, &ground) };
        let (mut least, mut friction) = (f64::INFINITY, 0.0_f64);
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
        };
        let outputs = [Output::theta, Output::a_t(0), Output::delta_t(0), Output::P_t];
        peaks_beside_samples(&run, dense, &outputs, 0.01, show);
        let (found, finish) = run.validity(Limits::default()).unwrap();
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

/// Just before a transition one of them is next to 0, also where a dissipator yields.
#[test]
fn indicators_stay_positive_between_transitions_and_vanish_there() {
    let gentle = shaking(7, 0.01, 400, 2.2);
    let strong = with_vertical(&shaking(9, 0.01, 300, 8.0), |t| 3.0 * (20.0 * t).sin());
    let tied = LEVELS.map(|detail| (RESTRAINED, detail, &strong)).into_iter();
    let free =
        [Detail::Auto, Detail::Linear, Detail::Modal, Detail::Rigid].map(|of| (Parameters::MCMANUS, of, &gentle));
    for (parameters, detail, ground) in tied.chain(free) {
        let run = Run { detail, end: End::At(ground.end()), ..Run::new(structure(parameters), ground) };
        let settings = Settings { detail, vertical: ground.vertical().is_some(), ..Settings::default() };
        let mut engine = Engine::with(structure(parameters), State::default(), 0.0, settings).unwrap();
        let ends = Vec::from_iter(transitions_of(&run).iter().map(|at| at.time));
        let mut times = Vec::from_iter((1..60_000).map(|i| f64::from(i) * 5e-5));
        times.extend(ends.iter().map(|end| end - 1e-9).filter(|time| *time > 0.0));
        times.sort_by(f64::total_cmp);
        let show = |at: &Sample| {
            engine.set_motion(at.motion);
            let [one, other] = engine.event_indicators(at.load);
            let is_last = ends.iter().any(|end| *end > at.motion.time && end - at.motion.time < 2e-9);
            let least = one.min(other);
            assert!(least > -1e-9 && (least < 1e-3 || !is_last), "{detail:?} {least} {:?}", at.motion);
        };
        run.sample(times, show, &mut ()).unwrap();
        assert!(ends.len() > 3, "{detail:?} {}", ends.len());
    }
}

/// Pushed over and let go: where the residual forces outweigh what turns it back it comes to rest turned, otherwise in contact.
#[test]
fn what_does_not_centre_itself_stays_turned() {
    let ground = Record::at_rest(6.0);
    for (F_y, stays) in [(120.0, false), (1800.0, true)] {
        let structure = structure(Parameters { F_y, P_0: 0.0, k_t: 0.0, c_d: 2e4, ..RESTRAINED });
        let [back, residual] = centring_moments(structure.base());
        assert_eq!(residual > back, stays, "{residual} {back}");
        let initial = State { theta: 0.05, ..State::default() };
        let run = Run { initial, end: End::At(6.0), ..Run::new(structure, &ground) };
        let Motion { phase, state, .. } = run.follow(&mut ()).unwrap().motion;
        assert_eq!(phase == Phase::Rocking(Side::Right) && state.theta > 1e-3, stays, "{phase:?} {state:?}");
        assert!(!stays || state.theta_dot.abs() < 1e-6, "{state:?}");
    }
}

/// A dissipator at the edge that the base rocks about does not move: it neither begins nor ceases to yield there.
#[test]
fn a_dissipator_at_the_edge_never_yields_about_that_edge() {
    let ground = shaking(5, 0.01, 300, 5.0);
    let mut yieldings = 0;
    for (detail, F_y) in LEVELS.into_iter().flat_map(|detail| [30.0, 80.0, 200.0].map(|F_y| (detail, F_y))) {
        let at_edge = Parameters { xi_d: Parameters::MCMANUS.B, k_d: 1e6, F_y, ..Parameters::MCMANUS };
        let run = Run { detail, end: End::At(3.0), ..Run::new(structure(at_edge), &ground) };
        for at in transitions_of(&run) {
            if let TransitionKind::Yielding(which) | TransitionKind::Unloading(which) = at.kind {
                let beside = usize::from(at.before.theta < 0.0); // the first is at the right edge
                assert!(which != beside, "{detail:?}, {F_y} N: {at:?}");
                yieldings += 1;
            }
        }
    }
    assert!(yieldings > 50, "{yieldings}");
}

/// At each level the tendon's force is the one that its equations have, and the peak the largest of it.
#[test]
fn the_tendon_pulls_by_the_elongation_of_its_level() {
    let Parameters { B, P_0, k_t, .. } = RESTRAINED;
    let released = State { theta: 0.15, ..State::default() };
    let ground = Record::at_rest(1.0);
    for detail in LEVELS {
        let run = Run { detail, initial: released, ..Run::new(structure(RESTRAINED), &ground) };
        let mut most = 0.0_f64;
        let mut see = |at: &Sample| {
            let theta = at.motion.state.theta.abs();
            let e = if detail == Detail::Linear { B * theta } else { 2.0 * B * (theta / 2.0).sin() };
            assert_relative_eq!(at.restraints().P_t, P_0 + k_t * e, max_relative = 1e-14);
            most = most.max(at.restraints().P_t);
        };
        run.sample((0..100).map(|i| 0.01 * f64::from(i)), &mut see, &mut ()).unwrap();
        assert_eq!(run.peaks().unwrap().0.P_t().magnitude, most);
    }
    let constant = Run { initial: released, ..Run::new(structure(Parameters { k_t: 0.0, ..RESTRAINED }), &ground) };
    let lifted = Run { initial: State { theta: -0.01, theta_dot: -0.2, ..released }, ..constant };
    let (peaks, _) = lifted.peaks().unwrap();
    assert!(peaks.theta().time > 0.0);
    assert_eq!((peaks.P_t().magnitude, peaks.P_t().time), (P_0, 0.0));
}

/// Before each transition of structures with ties on ground that moves vertically, it is known that one may come; between two
/// of them, that none comes.
#[test]
fn a_transition_is_foreseen_whatever_brings_it() {
    let ground = shaking(7, 0.01, 400, 9.0);
    let vertical = with_vertical(&ground, |t| 3.0 * (31.0 * t).sin());
    let yielding = Parameters { c_d: 0.0, F_y: 60.0, ..RESTRAINED };
    for (parameters, ground) in [(yielding, &ground), (yielding, &vertical), (Parameters::MCMANUS, &vertical)] {
        for detail in [Detail::Auto, Detail::Linear, Detail::Rigid] {
            let run = Run { detail, end: End::At(ground.end()), ..Run::new(structure(parameters), ground) };
            let mut transitions = vec![0.0];
            transitions.extend(transitions_of(&run).iter().map(|at| at.time));
            assert!(transitions.len() > 5, "{detail:?}: {}", transitions.len());
            let (motion, ahead) = (GroundMotion::from(ground), 1e-10);
            let foresees = |time: f64| {
                let (tolerance, vertical) = (run.tolerance, ground.vertical().is_some());
                let settings = Settings { detail, tolerance, vertical, stops: false };
                let mut engine = Engine::with(run.structure.clone(), run.initial, 0.0, settings).unwrap();
                motion.advance(&mut engine, &mut Elapsed::default(), time, LinearLoad::default(), &mut ()).unwrap();
                !engine.goes_on_for(ahead, motion.at(Elapsed::default().and(time)))
            };
            let mut quiet = 0;
            for pair in transitions.windows(2).filter(|pair| pair[1] - pair[0] > 1e-6) {
                assert!(foresees(pair[1] - 1e-11), "{detail:?} {pair:?}");
                quiet += usize::from(!foresees(0.5 * (pair[0] + pair[1])));
            }
            // a rigid base that is down may be lifted by a jump of the load
            assert!(quiet > 2 && (detail == Detail::Rigid || quiet + 3 > transitions.len() / 2), "{detail:?}: {quiet}");
        }
    }
}

/// A tendon holds the base down beyond u_cr of the weight: the parameters alone tell where that is beyond the edge.
#[test]
fn the_warning_of_a_base_held_down_beyond_its_edge_knows_the_tendon() {
    let tied = structure(Parameters { P_0: 5e5, ..Parameters::MCMANUS });
    assert_relative_eq!(tied.u_cr, uplift_displacement(&tied, 0.0), max_relative = 1e-14);
    let warnings = of_structure(&tied.into(), Detail::Auto);
    assert!(warnings[0].starts_with("u_cr = 0.6") && warnings[0].contains("exceeds B = 0.285 m"), "{warnings:?}");
    // u k H = (W + P_0) B less the moment m g u of the weight, beyond which it topples
    let &Parameters { m, m0, H, B, g, P_0, .. } = tied.parameters();
    let balanced = ((m + m0) * g * B + P_0 * B) / (tied.k * H + m * g);
    let shown = warnings[0].split("up to u = ").nth(1).and_then(|rest| rest.split(' ').next()).unwrap();
    assert_relative_eq!(shown.parse::<f64>().unwrap(), balanced, max_relative = 5e-6);
}

/// A dissipator that has yielded up to an impact is back at F_y at the next impact: no yielding begins there, however time is cut.
#[test]
fn no_dissipator_begins_to_yield_at_an_impact() {
    let ground = shaking(5, 0.01, 300, 3.0);
    for (detail, part) in LEVELS.into_iter().flat_map(|detail| [0.5, 0.8, 1.2].map(|part| (detail, part))) {
        let yielding = Parameters { xi_d: part * Parameters::MCMANUS.B, k_d: 1e5, F_y: 100.0, ..Parameters::MCMANUS };
        let followed_to = |end: End| {
            let run = Run { detail, end, ..Run::new(structure(yielding), &ground) };
            (run.follow(&mut ()).unwrap().motion.time, transitions_of(&run))
        };
        let (end, transitions) = followed_to(End::AtRest);
        let kinds = |of: &[Transition]| of.iter().map(|at| discriminant(&at.kind)).collect::<Vec<_>>();
        assert_eq!(kinds(&transitions), kinds(&followed_to(End::At(end)).1), "{detail:?} {part}");
        let at_impact = |pair: &[Transition]| {
            matches!(pair[0].kind, TransitionKind::Yielding(_))
                && matches!(pair[1].kind, TransitionKind::Impact(_) | TransitionKind::Landing)
                && pair[1].time - pair[0].time < 1e-9
        };
        assert!(transitions.len() > 20 && !transitions.windows(2).any(at_impact), "{detail:?} {part}");
    }
}

/// Against 4000 instants: no force is larger, and the peak is the force at its instant, or just before an impact then. Pulled to
/// their yield force, elastoplastic dissipators alone have no larger one.
#[test]
fn peaks_of_the_dissipators_are_their_largest_forces() {
    let ground = shaking(5, 0.01, 300, 4.0);
    let yielding = Parameters { c_d: 0.0, ..RESTRAINED };
    for parameters in [RESTRAINED, yielding, Parameters { k_d: 0.0, F_y: 0.0, ..RESTRAINED }] {
        for detail in [Detail::Auto, Detail::Linear] {
            let run = Run { detail, end: End::At(3.0), ..Run::new(structure(parameters), &ground) };
            let outputs = [Output::F_d1, Output::F_d2];
            let peaks = peaks_beside_samples(&run, (0..4000).map(|i| 7.5e-4 * f64::from(i)), &outputs, 0.1, |_| ());
            for output in outputs {
                let (peak, mut there) = (peaks.of(output).unwrap(), 0.0_f64);
                let see = |at: &Sample| there = there.max(at.output(output).abs());
                let until = End::At(peak.time + 1e-9);
                Run { end: until, ..run.clone() }.sample([peak.time - 1e-9, peak.time], see, &mut ()).unwrap();
                assert_relative_eq!(there, peak.magnitude, max_relative = 1e-6);
                assert!(parameters != yielding || (peak.magnitude / parameters.F_y - 1.0).abs() < 1e-12);
            }
        }
    }
}
