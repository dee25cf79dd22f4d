//! Structures of many masses: rates, and one mass as a mode. An independent integration of the masses is in `test_frames.py`.

use crate::common::{engine_of, transitions, transitions_of};
use approx::assert_relative_eq;
use rocking::engine::Settings;
use rocking::mechanics::restraint::Restraints;
use rocking::run::record::Record;
use rocking::run::validity::Limits;
use rocking::run::{End, Run, Runs};
use rocking::structure::description::{Damping, Storey};
use rocking::structure::natural_quantities::Numbers;
use rocking::{
    Body, Detail, Engine, LinearLoad, Load, Mode, Modes, OneMass, Output, Parameters, Progress, Reactions, Sample,
    State, Structure, Ties, Transition, TransitionKind,
};
use std::f64::consts::TAU;

const G: f64 = 9.81;

/// Three storeys whose response is known, with `more` numbers of their base.
pub fn three_storeys(zeta: f64, more: &[(&str, f64)]) -> Structure {
    let base = Numbers::of(&[&[("m0", 20e3), ("J0", 3e4), ("B", 1.5)], more].concat()).unwrap();
    let storeys = [(4e4, 3.5, 6e7), (4e4, 7.0, 5e7), (3e4, 10.5, 4e7)].map(|(m, h, k)| Storey { m, h, k });
    Structure::from_storeys(&base, &Damping::All(zeta), &storeys).unwrap()
}

/// These storeys with `kept` of their modes; all but the first `stiffer` in frequency by this factor.
fn storeys(zeta: f64, r: f64, kept: usize, stiffer: f64) -> Structure {
    let frame = three_storeys(zeta, &[("r", r)]);
    let stiff = |of: &Mode| Mode { stiffness: of.stiffness * stiffer * stiffer, damping: of.damping * stiffer, ..*of };
    let modes = [&frame.modes()[..1], &Vec::from_iter(frame.modes()[1..].iter().map(stiff))].concat();
    Structure::of_body(*frame.body(), &modes, frame.floors()).unwrap().keeping(kept).unwrap()
}

fn body([m0, J0, B]: [f64; 3], [m_s, S_1, I_2]: [f64; 3], r: f64, g: f64) -> Body {
    Body { m0, J0, m_s, S_1, I_2, B, r: Some(r), g, c_ratio: 1.0, ties: Ties::default() }
}

fn at_rest(modes: usize) -> State<Modes> {
    let none = Modes::new(&vec![0.0; modes]);
    State { u: none, u_dot: none, theta: 0.0, theta_dot: 0.0 }
}

/// A full sine of 0.8 s at 0.3 g, in samples of 10 ms.
fn pulse(i: usize) -> f64 {
    let t = 0.01 * i as f64;
    if t < 0.8 { 0.3 * G * (TAU * t / 0.8).sin() } else { 0.0 }
}

/// Modes left out are the limit of stiff modes between landings: while rocking from θ̇ = 0.2 rad/s on, and at the uplift of a base at
/// rest, with forces on the floors.
#[test]
fn modes_left_out_are_the_limit_of_stiff_modes() {
    let forces = |t: f64| [50e3 * t, -60e3 * t, 90e3 * t];
    for (theta, theta_dot, duration, transitions) in [(1e-3, 0.2, 20, 0), (0.0, 0.0, 24, 1)] {
        let of = |frame: Structure| {
            let modes = frame.modes().len();
            let start = State { theta, theta_dot, ..at_rest(modes) };
            let mut engine = Engine::of_modes(frame.clone(), start, 0.0, Settings::default()).unwrap();
            for i in 0..duration {
                let at = |i| frame.load(1.2 * pulse(i), 0.0, &forces(0.01 * i as f64)).unwrap();
                let slope = |from: f64, to: f64| (to - from) / 0.01;
                let [from, to] = [at(i), at(i + 1)];
                let rate = forces(1.0).into_iter().zip(forces(0.0)).map(|(to, from)| to - from);
                let rate = frame.load(slope(from.a_g, to.a_g), 0.0, &Vec::from_iter(rate)).unwrap();
                engine.advance(0.01, LinearLoad { value: from, slope: rate }, &mut ()).unwrap();
            }
            assert_eq!(engine.motion().transitions, transitions);
            engine.motion().state.theta
        };
        let mut off = Vec::new();
        for stiffer in [30.0, 300.0] {
            off.push((of(storeys(0.0, 0.93, 3, stiffer)) / of(storeys(0.0, 0.93, 1, 1.0)) - 1.0).abs());
        }
        assert!(off[1] < 0.15 * off[0] && off[1] < 1e-3, "{theta}: {off:?}");
    }
}

/// The rates of `engine` under `load`, 1 ms on, are the slopes along its motion.
pub fn assert_rates_are_slopes<Q: Runs>(mut engine: Engine<Q>, load: LinearLoad<Q>, of: &str) {
    let (outputs, transitions) = (Output::all(engine.structure()), engine.motion().transitions);
    let h = 1e-5;
    let mut show = |until: f64| {
        let now = engine.motion().time;
        engine.advance(until - now, load.from(now), &mut ()).unwrap();
        let sample = engine.sample(load.at(until));
        let all = |State { u, u_dot, theta, theta_dot }: State<Q>, Reactions { R_h, R_v, R_m }, outputs: Vec<f64>| {
            [&outputs, &[R_h, R_v, R_m, theta, theta_dot][..], u.as_slice(), u_dot.as_slice()].concat()
        };
        let values = Vec::from_iter(outputs.iter().map(|output| sample.output(*output)));
        let rates = engine.rates(load.from(until));
        let slopes = Vec::from_iter(outputs.iter().map(|output| rates.of(*output)));
        let (state, reactions) = (sample.motion.state, sample.reactions());
        (all(state, reactions, values), all(sample.state_rates(), rates.reactions(), slopes))
    };
    let (before, (_, slopes), (after, _)) = (show(1e-3 - h).0, show(1e-3), show(1e-3 + h));
    assert_eq!(engine.motion().transitions, transitions);
    for (i, slope) in slopes.into_iter().enumerate() {
        let (found, size) = ((after[i] - before[i]) / (2.0 * h), after[i].abs() / h);
        let is_near = (found - slope).abs() <= 1e-5 * slope.abs() + 1e-9 * size + 1e-5;
        assert!(is_near, "{of} {i}: {found} and not {slope}");
    }
}

/// Under all loads, with all modes and with one, and of one mass at every level.
#[test]
fn rates_are_the_slopes_of_states_outputs_and_reactions() {
    for (kept, theta) in [(3, -0.02), (1, -0.02), (3, 0.0), (1, 0.0)] {
        let frame = storeys(0.02, 0.93, kept, 1.0);
        let of = |numbers: [f64; 3]| Modes::new(&numbers[..kept]);
        let (u, u_dot) = (of([0.3, 0.1, -0.05]), of([5.0, -2.0, 1.0]));
        let initial = State { u, u_dot, theta, theta_dot: if theta == 0.0 { 0.0 } else { -0.4 } };
        let settings = Settings { tolerance: 1e-11, vertical: true, ..Settings::default() };
        let engine = Engine::of_modes(frame.clone(), initial, 0.0, settings).unwrap();
        let load = |a_g, a_v, forces: [f64; 3]| frame.load(a_g, a_v, &forces).unwrap();
        let load = LinearLoad { value: load(1.0, -0.5, [9e3, -4e3, 6e3]), slope: load(40.0, 9.0, [5e5, 8e5, -7e5]) };
        assert_rates_are_slopes(engine, load, &format!("{kept} {theta}"));
    }
    let down = State { u: 2e-4, u_dot: 0.01, ..State::default() };
    let rocking = State { u: 1e-3, u_dot: -0.1, theta: 0.05, theta_dot: 0.4 };
    let rigid = State { u: 0.0, u_dot: 0.0, ..rocking };
    for (detail, initial) in [
        (Detail::Auto, down),
        (Detail::Auto, rocking),
        (Detail::Linear, rocking),
        (Detail::Modal, rocking),
        (Detail::Rigid, State::default()),
        (Detail::Rigid, rigid),
        (Detail::FixedBase, down),
    ] {
        let engine = engine_of(OneMass::new(Parameters::EVISON).unwrap(), initial, 1e-11, detail);
        let (value, slope) = (Load { a_g: 1.2, F_t: 90.0, a_v: 0.0 }, Load { a_g: 40.0, F_t: -700.0, a_v: 0.0 });
        assert_rates_are_slopes(engine, LinearLoad { value, slope }, detail.name());
    }
}

/// A mode with next to no mass has a moment of inertia nevertheless. Left out, it leaves all of its moments to the rigid rest.
#[test]
fn modes_leave_all_their_moments_or_none() {
    let (m_s, h) = (110e3, 7.0);
    let [mass, arm] = [1e-10 * m_s, 200.0 * h];
    let modes =
        [(m_s, h), (mass, arm)].map(|(mass, arm): (f64, f64)| Mode::new(20.0, 0.02, mass.sqrt(), mass.sqrt() * arm));
    let of = |power: i32| m_s * h.powi(power) + mass * arm.powi(power);
    let frame = Structure::of_body(body([20e3, 3e4, 1.5], [of(0), of(1), of(2)], 0.93, G), &modes, &[]).unwrap();
    assert_eq!(frame.rest(), [0.0; 3]);
    for (found, expected) in frame.keeping(1).unwrap().rest().into_iter().zip([mass, mass * arm, mass * arm * arm]) {
        assert!((found - expected).abs() < 1e-4 * expected, "{found} {expected}");
    }
}

#[test]
fn what_fits_no_frame_is_refused_with_the_remedy() {
    let frame = storeys(0.02, 0.93, 3, 1.0);
    assert_eq!(frame.keeping(4).unwrap_err().to_string(), "4 modes cannot be kept of 3: keep 0 to 3");
    let without_moment = Structure::of_body(Body { S_1: 0.0, ..*frame.body() }, frame.modes(), frame.floors());
    assert_eq!(
        without_moment.unwrap_err().to_string(),
        "S_1 = 0 kg.m is out of range: it must lie between 1e-9 and 1e16 kg.m (first moment of the mass above the base)"
    );
    let [mode, floor] = ["mode 2: stiffness = -1 N/m is", "floor 3: m = NaN kg is"];
    let (mut modes, mut floors) = (frame.modes().to_vec(), frame.floors().to_vec());
    (modes[1].stiffness, floors[2].mass) = (-1.0, f64::NAN);
    for (body, modes, floors, refused) in [
        (Body { B: -1.0, ..*frame.body() }, frame.modes(), frame.floors(), "B = -1 m is"),
        (*frame.body(), &modes, frame.floors(), mode),
        (*frame.body(), frame.modes(), &floors, floor),
    ] {
        let text = Structure::of_body(body, modes, floors).unwrap_err().to_string();
        assert!(text.starts_with(&format!("{refused} out of range: it must lie between")), "{text}");
    }
    let refused = frame.load(0.0, 0.0, &[1.0]).unwrap_err().to_string();
    assert_eq!(refused, "1 forces are given on 3 floors: give one for each floor, or none");
    let start = |state, detail| {
        let settings = Settings { detail, ..Settings::default() };
        Engine::of_modes(frame.clone(), state, 0.0, settings).map(|_| ()).map_err(|error| error.to_string())
    };
    assert_eq!(start(at_rest(2), Detail::Auto), Ok(()));
    let given = State { u: Modes::new(&[1e-3; 30]), ..at_rest(3) };
    let refused = "the initial state has 30 coordinates, and 3 modes move: give one coordinate for each, or 0 for all";
    assert_eq!(start(given, Detail::Auto), Err(refused.into()));
    let refused = "the initial state has 3 coordinates, and 0 modes move: give one coordinate for each, or 0 for all";
    assert_eq!(start(State { u: Modes::new(&[1e-3; 3]), ..at_rest(3) }, Detail::Rigid), Err(refused.into()));
}

/// Two masses with modes of `f` (Hz) and `zeta`, whose shapes are turned by `angle` from one mass to the other, on a wide base.
fn two_masses(f: [f64; 2], zeta: [f64; 2], angle: f64, c_ratio: f64, ties: Ties) -> Structure {
    let (m, h) = ([27e3_f64, 26e3], [2.0_f64, 8.3]);
    let shapes = [[angle.cos(), angle.sin()], [-angle.sin(), angle.cos()]];
    let mode = |j: usize| {
        let of = |x: [f64; 2]| (0..2).map(|i| m[i].sqrt() * shapes[j][i] * x[i]).sum::<f64>();
        Mode::new(TAU * f[j], zeta[j], of([1.0; 2]), of(h))
    };
    let of = |power: i32| m[0] * h[0].powi(power) + m[1] * h[1].powi(power);
    let body = Body { c_ratio, ties, ..body([10.0, 10.0, 1.7], [of(0), of(1), of(2)], 0.95, G) };
    Structure::of_body(body, &[mode(0), mode(1)], &[]).unwrap()
}

/// From the floors, the rotation and their rates at an instant, a second run goes on as the first does.
#[test]
fn a_run_from_the_state_of_another_goes_on_like_it() {
    let times = Vec::from_iter((0..=300).map(|i| 0.01 * f64::from(i)));
    let a_g = Vec::from_iter((0..=300).map(|i| 2.0 * pulse(i)));
    let whole = Record::from_samples("", times.clone(), a_g.clone()).unwrap();
    let frame = three_storeys(0.02, &[("r", 0.9)]).keeping(2).unwrap();
    let cases = [(10, false), (60, true), (100, true)];
    let rests = cases.map(|(from, _)| Record::from_samples("", times[from..].into(), a_g[from..].into()).unwrap());
    let seen = |run: Run<Modes>, from: usize| {
        let (floors, mut seen) = (frame.floors().len(), Vec::new());
        let mut show = |sample: &Sample<Modes>| {
            let of = |output: fn(usize) -> Output| Vec::from_iter((0..floors).map(|i| sample.output(output(i))));
            let [theta, theta_dot] = [Output::theta, Output::theta_dot].map(|of| sample.output(of));
            seen.push(State { u: of(Output::u), u_dot: of(Output::u_dot), theta, theta_dot });
        };
        run.sample(times[from..].iter().copied(), &mut show, &mut ()).unwrap();
        seen
    };
    let usual = |ground| Run { end: End::At(3.0), tolerance: 1e-12, ..Run::of_modes(frame.clone(), ground) };
    let first = seen(usual(&whole), 0);
    for ((from, rocks), rest) in cases.into_iter().zip(&rests) {
        assert_eq!(first[from].theta != 0.0, rocks, "{from}");
        let second = seen(Run { initial: first[from].on(&frame).unwrap(), ..usual(rest) }, from);
        for (i, (one, other)) in first[from..].iter().zip(&second).enumerate().take(100) {
            for (one, other) in one.numbers().into_iter().flatten().zip(other.numbers().into_iter().flatten()) {
                assert!((one - other).abs() < 1e-9, "from {from}, {i} samples later: {one} {other}");
            }
        }
    }
    let refused = |u: &[f64]| State { u: u.into(), ..State::default() }.on::<Modes>(&frame).unwrap_err().to_string();
    let floors = "u_0 = [0.1, 0.2] m: the structure has 3 floors, give a number for each from below, or 0 for all";
    assert_eq!(refused(&[0.1, 0.2]), floors);
    assert!(
        refused(&[0.1, 2e4, 0.0]).starts_with("u_0 = 20000 m is out of range: it must lie between -10000 and 10000 m")
    );
    let beyond = refused(&[0.01, -0.01, 0.01]);
    assert!(beyond.starts_with("u_0[1] = 0.01 m is out of reach of the 2 modes, which come as near as "), "{beyond}");
}

/// Modes of 60 Hz ring when the base comes down and lift it again. The bursts are bounded. If damping while rocking is far from damping
/// in contact, contact opens and shuts without end, and is held to the end of a period, as the findings tell.
#[test]
fn stiff_modes_that_ring_end_in_bounded_bursts() {
    let times = (0..=500).map(|i| 0.01 * f64::from(i)).collect();
    let ground = Record::from_samples("", times, (0..=500).map(|i| 1.26 * pulse(i)).collect()).unwrap();
    for (zeta, c_ratio, is_settled) in [([0.0, 0.0], 1.0, false), ([0.02, 0.0], 1.0, false), ([0.3, 0.5], 3.0, true)] {
        let frame = two_masses([2.7, 60.0], zeta, 2.5, c_ratio, Ties::default());
        let run = Run { end: End::At(5.0), ..Run::of_modes(frame.clone(), &ground) };
        let seen = transitions_of(&run);
        let period = TAU / frame.rocking_frequencies()[0];
        let burst = |from: &Transition<Modes>| {
            seen.iter().filter(|it| it.time >= from.time && it.time < from.time + period).count()
        };
        let most = seen.iter().map(burst).max().unwrap();
        let settled = seen.iter().filter(|it| it.kind == TransitionKind::Settling).count();
        assert!(most > 15 && most <= 1003 && (settled > 0) == is_settled, "{zeta:?}: {most} {settled}");
        let found = run.validity(Limits::default()).unwrap().0;
        assert!(found.settlings == settled as u64 && (found.held > 0.0) == is_settled, "{found:?}");
    }
}

/// Where the dampers hold the base down beyond the moment for uplift, the base lifts off once they give way: θ grows like t³.
#[test]
fn a_base_that_dampers_held_lifts_off_smoothly() {
    let frame = two_masses([2.7, 9.0], [0.3, 0.1], 2.5, 1.0, Ties::default());
    let of = |j: usize| frame.modes()[j].height * frame.modes()[j].stiffness;
    let u = -1.2 * frame.base().m_t * G * frame.base().B / of(0);
    let initial = State { u: Modes::new(&[u, 0.0]), u_dot: Modes::new(&[-30.0 * u, 0.0]), ..at_rest(2) };
    let mut engine = Engine::of_modes(frame, initial, 0.0, Settings { stops: true, ..Settings::default() }).unwrap();
    let load = Load { a_g: 12.0, ..Load::NONE };
    assert_eq!(engine.advance(0.2, load, &mut ()), Ok(Progress::Transition));
    engine.transit(&mut ());
    let (time, after) = (engine.motion().time, 1e-4);
    let theta_ddot = |engine: &Engine<Modes>| engine.sample(load).state_rates().theta_dot;
    let at_once = theta_ddot(&engine);
    assert_eq!(engine.advance(after, load, &mut ()), Ok(Progress::Complete));
    let (then, theta) = (theta_ddot(&engine), engine.motion().state.theta);
    assert!(time > 1e-3 && at_once.abs() < 1e-9 * then.abs(), "{time} {at_once} {then}");
    assert!((theta / (then * after * after / 6.0) - 1.0).abs() < 0.02, "{theta} {then}");
}

/// Two dissipators in the middle of the base yield and unload together, at impacts and landings too, and what they take is lost.
#[test]
fn dissipators_that_yield_together_keep_the_energy() {
    let ties = Ties { k_d: 4e7, F_y: 3e4, ..Ties::default() };
    let frame = two_masses([2.7, 9.0], [0.0, 0.0], 2.5, 1.0, ties);
    let start = State { theta: 0.05, ..at_rest(2) };
    let mut engine = Engine::of_modes(frame, start, 0.0, Settings::default()).unwrap();
    let total = |engine: &Engine<Modes>| {
        let Restraints { F_d1, F_d2, .. } = engine.sample(Load::NONE).restraints();
        engine.energy() + (F_d1 * F_d1 + F_d2 * F_d2) / (2.0 * ties.k_d) + engine.motion().dissipators.hysteretic
    };
    let (mut yielded, mut last, mut kept) = ([Vec::new(), Vec::new()], total(&engine), 0);
    for _ in 0..400 {
        let mut impacts = 0;
        for transition in transitions(&mut engine, 0.01, Load::NONE) {
            match transition.kind {
                TransitionKind::Yielding(j) | TransitionKind::Unloading(j) => yielded[j].push(transition.time),
                _ => impacts += 1,
            }
        }
        let now = total(&engine);
        if impacts == 0 {
            assert!((now / last - 1.0).abs() < 1e-11, "{}: {now} and not {last}", engine.motion().time);
            kept += 1;
        }
        last = now;
    }
    assert!(yielded[0].len() > 3 && kept > 100, "{yielded:?} {kept}");
    assert_relative_eq!(yielded[0][..], yielded[1][..], max_relative = 1e-14);
    let [first, second] = engine.motion().dissipators.plastic;
    assert_relative_eq!(first, second, max_relative = 1e-12);
}
