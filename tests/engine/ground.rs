//! Ground that gives: printed numbers, closed forms, energy. An independent integration is in `test_ground.py`.

use crate::common::{peaks_beside_samples, sampled, transitions};
use crate::modes::{assert_rates_are_slopes, three_storeys};
use approx::assert_relative_eq;
use rocking::engine::{Progress, Settings};
use rocking::estimates::restoring::flag;
use rocking::run::record::Record;
use rocking::run::validity::{FRICTION, Limits, of_structure};
use rocking::run::{End, Ending, Run};
use rocking::structure::description::{Damping, Storey};
use rocking::structure::doubts::doubted;
use rocking::structure::natural_quantities::Numbers;
use rocking::{
    Detail, Engine, Ground, LinearLoad, Modes, Output, Parameters, Piece, Reactions, Sample, State, Structure,
    Transition, TransitionKind, Watch,
};
use std::f64::consts::TAU;

pub const EVISON: Parameters = Parameters { J0: 1.1918415, f_fc: 11.0, ..Parameters::EVISON };

pub fn ground(f_v: f64, zeta_v: f64, points: usize) -> Ground {
    Ground { f_v: Some(f_v), zeta_v: Some(zeta_v), n_points: Some(points as f64), ..Ground::default() }
}

pub fn one_mass(parameters: Parameters, ground: Ground) -> Structure {
    Structure::new(parameters).unwrap().on(&ground).unwrap()
}

fn frame(ground: Ground) -> Structure {
    three_storeys(0.0, &[]).on(&ground).unwrap()
}

pub fn engine(structure: &Structure, u: f64, theta: f64) -> Engine<Modes> {
    let settings = Settings { tolerance: 1e-12, vertical: true, ..Settings::default() };
    let none = Modes::new(&vec![0.0; structure.modes().len()]);
    let u = if u == 0.0 { none } else { Modes::new(&[u]) };
    Engine::of_modes(structure.clone(), State { u, u_dot: none, theta, theta_dot: 0.0 }, 0.0, settings).unwrap()
}

pub fn load(structure: &Structure, a_g: f64, a_v: f64) -> LinearLoad<Modes> {
    structure.load(a_g, a_v, &[]).unwrap().into()
}

#[test]
fn rigid_ground_takes_the_place_of_ground_that_gives() {
    let rigid = Ground { f_v: Some(0.0), ..Ground::default() };
    assert_eq!(frame(ground(10.0, 0.2, 2)).on(&rigid).unwrap(), three_storeys(0.0, &[]));
}

#[test]
fn evison_on_two_springs_has_its_six_events_and_peaks() {
    let structure = one_mass(EVISON, ground(160.0, 0.2, 2));
    let mut engine = engine(&structure, 0.75246734e-3, 0.04);
    assert_relative_eq!(structure.foundation().unwrap().y_s, -9.70664855e-6, max_relative = 1e-9);
    let no_load = structure.load(0.0, 0.0, &[]).unwrap();
    assert_relative_eq!(engine.sample(no_load).output(Output::y), 11.37754695e-3, max_relative = 1e-9);
    let events = transitions(&mut engine, 0.5, no_load);
    use TransitionKind::{Release, Touch};
    let expected = [
        (Touch(0), 0.167986795),
        (Release(1), 0.170751817),
        (Release(0), 0.189341689),
        (Touch(0), 0.196002570),
        (Touch(1), 0.487288998),
        (Release(0), 0.490062871),
    ];
    assert_eq!(events.len(), expected.len(), "{events:?}");
    for (Transition { kind, time, .. }, (of, at)) in events.into_iter().zip(expected) {
        assert!(kind == of && (time - at).abs() < 1e-9, "{kind:?} {time}");
    }
    let none = Record::from_samples("none", vec![0.0, 0.5], vec![0.0, 0.0]).unwrap();
    let run = Run { end: End::At(0.5), tolerance: 1e-12, ..Run::of_modes(structure, &none) };
    let initial = State { u: Modes::new(&[0.75246734e-3]), theta: 0.04, ..run.initial };
    let (peaks, _) = Run { initial, ..run }.peaks().unwrap();
    let of = |output| peaks.of(output).unwrap();
    assert_relative_eq!(of(Output::a_t(0)).magnitude / 9.81, 0.79264971, max_relative = 1e-8);
    assert!((of(Output::a_t(0)).time - 0.176901).abs() < 5e-7);
    assert_relative_eq!(of(Output::settlement).magnitude, 0.113399e-3, max_relative = 5e-6);
    assert_relative_eq!(of(Output::N_right).magnitude, 10765.40, max_relative = 5e-7);
}

/// Storeys are stiffer than the ground, so that their frequencies do not tell how fast the base relaxes on its dashpots.
#[test]
fn dashpots_under_stiff_storeys_take_no_more_steps_than_their_rates_need() {
    let steps = |J0: f64, count: usize, k: f64, ground: Ground, until: f64| {
        let base = Numbers::of(&[("m0", 1e5), ("J0", J0), ("B", 6.0)]).unwrap();
        let storeys = Vec::from_iter((1..=count).map(|i| Storey { m: 5e4, h: 3.0 * i as f64, k }));
        let structure = Structure::from_storeys(&base, &Damping::All(0.02), &storeys).unwrap().on(&ground).unwrap();
        let mut engine = engine(&structure, 0.0, 1e-3);
        transitions(&mut engine, until, load(&structure, 0.0, 0.0));
        engine.motion().work.steps
    };
    let of_six = [0.0, 0.1, 0.4, 1.0].map(|zeta| steps(1e6, 6, 1e9, ground(2.0, zeta, 2), 1.0));
    assert!(of_six[0] < 100 && of_six.iter().all(|steps| *steps <= of_six[0]), "{of_six:?}");
    let of_two = steps(1e3, 2, 1e11, ground(0.45, 1.0, 2), 1e-3);
    assert!(of_two < 20, "{of_two}");
}

/// The next step, however short, has a transition that this one missed, and once it has been applied nothing is due. A dissipator
/// that has turned round does not yield again where another integrator elongates it by 1e-10 of the settlement at rest.
#[test]
fn a_transition_within_rounding_of_the_end_of_a_step_happens_once() {
    let tied = Parameters { P_0: 50.0, k_t: 4e4, xi_d: 0.2, k_d: 1e5, F_y: 150.0, ..EVISON };
    let structure = one_mass(tied, ground(160.0, 0.2, 2));
    let no_load = load(&structure, 0.0, 0.0);
    let begin = || engine(&structure, 0.75246734e-3, 0.04);
    let expected = transitions(&mut begin(), 0.5, no_load);
    for (i, transition) in expected.iter().enumerate().filter(|(_, transition)| transition.time > 0.0) {
        for places in -4..=4 {
            let mut engine = begin();
            let until = transition.time * (1.0 + f64::from(places) * f64::EPSILON);
            let mut found = transitions(&mut engine, until, no_load);
            found.extend(transitions(&mut engine, 16.0 * f64::EPSILON, no_load));
            let kinds = |of: &[Transition<Modes>]| Vec::from_iter(of.iter().map(|transition| transition.kind));
            assert_eq!(kinds(&found), kinds(&expected[..=i]), "{places}");
            assert!(!engine.is_due(no_load.value), "{transition:?} {places}");
            if let TransitionKind::Unloading(_) = transition.kind {
                for way in [-1e-10, 1e-10] {
                    let state = engine.motion().state;
                    let mut numbers = state.u.numbers().to_vec();
                    numbers[1] += way * structure.foundation().unwrap().y_s;
                    engine.set_state(State { u: Modes::new(&numbers), ..state });
                    assert_eq!(transitions(&mut engine, 1e-7, no_load), [], "{transition:?}");
                    engine.set_state(state);
                }
            }
        }
    }
    assert!(expected.iter().any(|transition| matches!(transition.kind, TransitionKind::Unloading(_))));
}

/// In vertical motion all points of a bed act at one instant. Without weight a drop rebounds by
///
/// ```text
/// exp[−(2 ζ/√(1−ζ²)) atan2(√(1−ζ²), ζ)],   e⁻² at ζ = 1,   exp[−(2 ζ/√(ζ²−1)) ln(ζ + √(ζ²−1))] above
/// ```
#[test]
fn a_drop_rebounds_as_one_spring_and_dashpot_do() {
    for (zeta, expected) in [(0.05_f64, 0.859), (0.2, 0.572), (1.0, 0.135), (2.0, 0.048)] {
        let rebound = match zeta {
            1.0 => f64::exp(-2.0),
            ..1.0 => {
                let root = (1.0 - zeta * zeta).sqrt();
                (-2.0 * zeta / root * root.atan2(zeta)).exp()
            }
            _ => {
                let root = (zeta * zeta - 1.0_f64).sqrt();
                (-2.0 * zeta / root * (zeta + root).ln()).exp()
            }
        };
        assert!((rebound - expected).abs() < 6e-4);
        let structure = one_mass(EVISON, ground(20.0, zeta, 11));
        let mut engine = engine(&structure, 0.0, 0.0);
        // the springs throw the base up, the ground comes after it for a while, and meets it at a constant velocity
        let seen = [(0.5, -9.81), (0.01, 90.0), (2.0, -9.81)]
            .map(|(interval, a_v)| transitions(&mut engine, interval, load(&structure, 0.0, a_v)))
            .concat();
        assert_eq!(seen.len(), 33, "{seen:?}");
        for (act, of) in seen.chunks(11).zip([TransitionKind::Release(0), TransitionKind::Touch(0)]) {
            assert!(act.iter().all(|it| it.kind.name() == of.name() && it.time == act[0].time), "{act:?}");
        }
        let [fallen, rebounds] = [11, 22].map(|at| seen[at].after.u_dot.numbers()[1]);
        assert_relative_eq!(rebounds, -rebound * fallen, max_relative = 1e-10);
        assert!(engine.motion().state.theta.abs() < 1e-15);
    }
}

/// The moment of the points under a structure that is held turned, also as a flag less that of the weight: two springs, and beds beside the
/// closed form of a uniform bed,
///
/// ```text
/// W B θ/(3 θ_u) to W B/3, then W B (1 − ⅔ √(θ_u/θ)),   θ_u = W/(K_z B)
/// ```
#[test]
fn static_moments_are_the_closed_forms() {
    let moment = |points: usize, at: f64| {
        let structure = one_mass(Parameters::MCMANUS, ground(200.0, 0.2, points));
        let (base, foundation) = (structure.base(), structure.foundation().unwrap());
        let weight = base.m_t * base.g;
        let sin = at * weight / (foundation.sum(0) * base.B);
        let engine = engine(&structure, 0.0, sin.asin());
        let at_rest = structure.load(0.0, 0.0, &[]).unwrap();
        let forces = Vec::from_iter((0..points).map(|i| engine.sample(at_rest).output(Output::N(i))));
        assert_relative_eq!(forces.iter().sum::<f64>(), weight, max_relative = 1e-12);
        let moment: f64 = foundation.points.iter().zip(forces).map(|(point, force)| point.xi * force).sum();
        let held = flag(&structure, sin.asin(), 1).unwrap()[1].moment + base.g * structure.body().S_1 * sin;
        assert_relative_eq!(held, moment * sin.asin().cos(), max_relative = 1e-12);
        moment / (weight * base.B)
    };
    for (at, expected) in [(0.5, 0.5), (1.0, 1.0), (7.0, 1.0)] {
        assert_relative_eq!(moment(2, at), expected, max_relative = 1e-12);
    }
    for (points, at, above) in
        [(11, 0.5, 0.0), (11, 4.0, 0.007), (11, 10.0, 0.009), (11, 100.0, 0.058), (21, 10.0, 0.002)]
    {
        let uniform = if at < 1.0 { at / 3.0 } else { 1.0 - 2.0 / 3.0 / f64::sqrt(at) };
        assert!((moment(points, at) / uniform - 1.0 - above).abs() < 6e-4, "{points} {at} {}", moment(points, at));
    }
}

/// At rest the ground carries the weight and the prestress. A run on a bed comes to rest, and stays on a fixed base.
#[test]
fn a_structure_at_rest_is_carried_and_comes_to_rest() {
    let tied = Parameters { P_0: 500.0, k_t: 1e4, ..EVISON };
    let structure = one_mass(tied, ground(30.0, 0.2, 7));
    let (engine, at_rest) = (engine(&structure, 0.0, 0.0), structure.load(0.0, 0.0, &[]).unwrap());
    let weight = structure.base().m_t * structure.base().g;
    let carried: f64 = (0..7).map(|i| engine.sample(at_rest).output(Output::N(i))).sum();
    assert_relative_eq!(carried, weight + 500.0, max_relative = 1e-12);
    assert_relative_eq!(engine.sample(at_rest).reactions().R_v, weight, max_relative = 1e-9);
    assert_relative_eq!(engine.sample(at_rest).edges().R_v, weight + 500.0, max_relative = 1e-9);
    assert_eq!(engine.sample(at_rest).output(Output::contact), 1.0);

    let pulse = Record::from_samples("pulse", vec![0.0, 0.1, 0.2], vec![0.0, 9.0, 0.0]).unwrap();
    let run = Run::of_modes(one_mass(EVISON, ground(60.0, 0.2, 3)), &pulse);
    let finish = run.follow(&mut ()).unwrap();
    assert!(finish.ending == Ending::AtRest && finish.motion.transitions > 4, "{finish:?}");
    // at the level fixed_base ground that gives has no outputs, and the rest is as on rigid ground
    let fixed = Run { detail: Detail::FixedBase, end: End::At(1.0), ..run.clone() };
    let on_rigid = Run { structure: Structure::new(EVISON).unwrap(), ..fixed.clone() };
    let [peaks, expected] = [&fixed, &on_rigid].map(|run| run.peaks().unwrap().0.of(Output::a_t(0)).unwrap());
    assert_relative_eq!(peaks.magnitude, expected.magnitude, max_relative = 1e-12);
    let [shown, rigid] = [&run, &fixed].map(|of| Output::all(&of.structure.at(of.detail)));
    let found = fixed.curve(1e-3).unwrap().found.peaks;
    let see =
        |sample: &Sample<Modes>| assert!(shown.iter().all(|of| sample.output(*of).is_nan() != rigid.contains(of)));
    assert!([Output::N_left, Output::settlement, Output::N(1)].iter().all(|of| found.of(*of).is_none()));
    fixed.sample([0.5], see, &mut ()).unwrap();
    let tied = Parameters { P_0: 500.0, k_t: 1e4, xi_d: 0.2, c_d: 900.0, k_d: 1e5, F_y: 150.0, ..EVISON };
    let tied = Run { end: End::At(2.0), ..Run::of_modes(one_mass(tied, ground(60.0, 0.2, 3)), &pulse) };
    let times = (0..200_000).map(|i| 1e-5 * f64::from(i));
    let (limits, mut friction, mut beyond) = (Limits { friction: 0.2, ..Limits::default() }, 0.0_f64, 0.0);
    peaks_beside_samples(&tied, times, &Output::OF_TIES, 1e-4, |sample| {
        let Reactions { R_h, R_v, .. } = sample.edges();
        friction = friction.max(R_h.abs() / R_v.max(0.0));
        beyond += if R_h.abs() > limits.friction * R_v { 1e-5 } else { 0.0 };
    });
    let found = tied.validity(limits).unwrap().0.worst[FRICTION];
    assert!(found.value >= friction && (found.beyond - beyond).abs() < 1e-3, "{found:?} {friction} {beyond}");
    let refusal = Run { detail: Detail::Linear, ..run }.peaks().unwrap_err().to_string();
    assert!(refusal.contains("choose auto, nonlinear, rigid or fixed_base"), "{refusal}");
    let refusal = structure.one_mass("estimate").unwrap_err().to_string();
    assert!(refusal.starts_with("estimate needs rigid ground, because"), "{refusal}");
}

/// Most of the stiffness of the how-to's footing is in the outer points. Nine points have strips of B/4, the outer ones of B/8.
#[test]
fn the_pressure_does_not_depend_on_the_number_of_points() {
    let pier = Parameters { m: 1.2e6, m0: 0.4e6, J0: 1.7e6, H: 22.0, B: 3.5, f_fc: 0.8, ..Parameters::MCMANUS };
    let pulse = sampled(201, 0.01, |t| 3.0 * (TAU * t / 2.0).sin());
    let peaks = [(0.82, 5), (0.82, 9), (0.82, 15), (0.82, 21), (0.5, 9), (0.5, 21)].map(|(kr_ratio, n)| {
        let ground = Ground { f_v: None, k_v: Some(1.52e9), kr_ratio: Some(kr_ratio), ..ground(0.0, 0.2, n) };
        let run = Run { end: End::At(4.0), ..Run::of_modes(one_mass(pier, ground), &pulse) };
        let times = (0..40_000).map(|i| 1e-4 * f64::from(i));
        let peaks = peaks_beside_samples(&run, times, &[Output::pressure], 1e-3, |sample| {
            let N = |i| sample.output(Output::N(i));
            let edge = |outer, next| (N(outer) + N(next) * (1.0 / 3.0 - 0.125) / 0.25) / (pier.B / 3.0);
            let inner = (1..8).map(|i| N(i) / (pier.B / 4.0)).fold(0.0, f64::max);
            let expected = edge(0, 1).max(edge(8, 7)).max(inner);
            assert!(n != 9 || (sample.output(Output::pressure) - expected).abs() <= 1e-12 * expected);
        });
        peaks.of(Output::pressure).unwrap().magnitude
    });
    let are_near = |peaks: &[f64]| peaks.iter().all(|peak| (peak / peaks[0] - 1.0).abs() < 0.1);
    assert!(are_near(&peaks[..4]) && are_near(&peaks[4..]), "{peaks:?}");
}

/// The forces of the points carry the momentum balance, with forces on floors, vertical motion and mass that turns rigidly.
#[test]
fn the_points_carry_the_reactions() {
    for structure in [frame(ground(12.0, 0.1, 5)), frame(ground(12.0, 0.1, 5)).keeping(1).unwrap()] {
        let mut engine = engine(&structure, 0.0, 0.01);
        let [value, slope] = [(2.0, -1.0, 4e4), (9.0, 30.0, -2e5)]
            .map(|(a_g, a_v, force)| structure.load(a_g, a_v, &[force, 0.0, -0.5 * force]).unwrap());
        engine.advance(0.3, LinearLoad { value, slope }, &mut ()).unwrap();
        let load = LinearLoad { value, slope }.at(0.3);
        let (reactions, points) = (engine.sample(load).reactions(), &structure.foundation().unwrap().points);
        let forces = Vec::from_iter((0..5).map(|i| engine.sample(load).output(Output::N(i))));
        let turned = engine.motion().state.theta.cos();
        let moment: f64 = points.iter().zip(&forces).map(|(point, force)| point.xi * force).sum();
        assert_relative_eq!(reactions.R_v, forces.iter().sum(), max_relative = 1e-10);
        assert_relative_eq!(reactions.R_m, turned * moment, max_relative = 1e-9);
        engine.set_time(0.0);
        assert_rates_are_slopes(engine, LinearLoad { value: load, slope }, "on ground");
    }
}

#[test]
fn frequencies_are_the_printed_ones() {
    let of = |structure: Structure| {
        structure.frequencies_on_ground().into_iter().map(|omega| omega / TAU).collect::<Vec<_>>()
    };
    let mcmanus = of(one_mass(Parameters::MCMANUS, ground(40.0, 0.0, 2)));
    let frame = of(frame(ground(12.0, 0.1, 2)));
    let expected: [&[f64]; 2] =
        [&[4.16323761, 40.0, 58.45388815], &[1.93761549, 7.10814155, 10.04614086, 12.0, 54.46823722]];
    for (found, expected) in [mcmanus, frame].iter().zip(expected) {
        assert_eq!(found.len(), expected.len());
        found.iter().zip(expected).for_each(|(f, of)| assert_relative_eq!(f, of, max_relative = 2e-9));
    }
}

/// A step that cannot end says so long before its 2,000,000 steps; a structure that falls on the way has fallen.
#[test]
fn a_step_without_end_is_refused_early() {
    struct Pieces(u64);
    impl Watch<Modes> for Pieces {
        fn piece(&mut self, _: &Piece<Modes>) {
            self.0 += 1;
        }
    }
    let structure = one_mass(EVISON, ground(60.0, 0.2, 2));
    let (mut engine, mut pieces) = (engine(&structure, 0.0, 0.02), Pieces(0));
    let error = engine.advance(1e9, load(&structure, 0.0, 0.0), &mut pieces).unwrap_err();
    assert!(error.to_string().starts_with("the 2000000 steps of an advance end by t = "), "{error}");
    assert!(error.time().unwrap() < 1e6 && engine.motion().time == 0.0 && pieces.0 < 100_000, "{}", pieces.0);
    assert_eq!(engine.advance(1e9, load(&structure, 6.0, 0.0), &mut ()).unwrap(), Progress::Overturned);
}

/// The acceleration of the base adds to that of mass that no mode carries.
#[test]
fn no_sample_exceeds_the_peaks_of_a_structure_with_modes_left_out() {
    let shaken = sampled(301, 0.01, |t| 6.0 * ((6.0 * t).sin() + 0.6 * (20.0 * t).cos()));
    let outputs = [Output::V_t, Output::M_t, Output::a_t(1), Output::V(0), Output::M(0), Output::M(1)];
    for kept in 0..3 {
        let structure = frame(ground(8.0, 0.0, 2)).keeping(kept).unwrap();
        let run = Run { end: End::At(4.0), ..Run::of_modes(structure, &shaken) };
        peaks_beside_samples(&run, (0..40_000).map(|i| 1e-4 * f64::from(i)), &outputs, 1e-3, |_| ());
    }
}

/// A change of the base changes the points as a new description does, and nothing needs r.
#[test]
fn the_points_follow_the_base() {
    for points in [2, 5] {
        for on in [ground(5.0, 0.3, points), Ground { k_v: Some(6.5e8), f_v: None, ..ground(5.0, 0.3, points) }] {
            let described = |B, m0| {
                let one = [("m", 1.2e6), ("H", 22.0), ("J0", 2e6), ("f_fc", 0.8), ("zeta_fc", 0.03)];
                let given = Numbers::of(&[&one[..], &[("B", B), ("m0", m0)]].concat()).unwrap();
                given.on(on.clone()).structure(None).unwrap()
            };
            let narrow = described(3.0, 1.2e5);
            assert!(of_structure(&narrow, Detail::Auto).is_empty());
            let unused = narrow.with(Parameters { r: 0.9, ..narrow.parameters() }).unwrap();
            assert!(of_structure(&unused, Detail::Auto).is_empty() && doubted(&unused.doubts()[0]) == "r");
            assert!(!narrow.doubts().iter().any(|doubt| doubted(doubt) == "r"));
            let bouncing = narrow.on(&ground(900.0, 0.0, points)).unwrap();
            assert!(of_structure(&bouncing, Detail::Auto)[0].contains("few sure digits; lower f_v, or raise zeta_v"));
            let wide = narrow.with(Parameters { B: 3.5, m0: 6e5, ..narrow.parameters() }).unwrap();
            assert_eq!(wide.foundation(), described(3.5, 6e5).foundation());
            assert_ne!(wide.foundation(), narrow.foundation());
        }
    }
}
