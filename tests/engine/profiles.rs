//! Runs of structures of many masses: the exact peaks of each floor.

use crate::common::{peaks_beside_samples, sampled};
use rocking::engine::AdvanceError;
use rocking::run::peaks::Peaks;
use rocking::run::record::Record;
use rocking::run::validity::{ASSUMPTIONS, EDGE_LOAD, FRICTION, Findings, Limits, TENSION};
use rocking::run::{End, Run, RunError};
use rocking::structure::description::{Damping, Storey};
use rocking::structure::natural_quantities::Numbers;
use rocking::structure::parameters::{OF_ONE_MASS, PARAMETERS};
use rocking::{Detail, Modes, OneMass, Output, Parameters, Phase, Reactions, Sample, State, Structure};
use std::f64::consts::TAU;

/// A wavelet of 3 s that rocks the specimens, in samples of 10 ms.
fn ground() -> Record {
    sampled(301, 0.01, |t| 6.0 * (TAU * 1.1 * t).sin() * (TAU * t / 6.0).sin())
}

/// The base of `parameters` without the top mass.
fn base(parameters: &Parameters) -> Numbers {
    let of_base = PARAMETERS.iter().filter(|of| !OF_ONE_MASS.contains(&of.name));
    Numbers::of(&Vec::from_iter(of_base.map(|of| (of.name, (of.get)(parameters))))).unwrap()
}

/// Under a force on the top, from rest, and with dissipators from a start beyond their yield on ground that moves vertically, too.
#[test]
fn one_mode_is_one_mass() {
    let tied = Parameters { P_0: 400.0, k_t: 2e4, xi_d: 0.2, c_d: 150.0, k_d: 2e5, F_y: 120.0, ..Parameters::MCMANUS };
    for (parameters, theta, F_t) in [(Parameters::MCMANUS, 0.0, 60.0), (Parameters::EVISON, 0.0, 0.0), (tied, 0.1, 0.0)]
    {
        let ground = ground().with_force(&[0.0, 1.0, 3.5], &[0.0, F_t, -F_t]).unwrap();
        let upwards = sampled(301, 0.01, |t| 2.0 * theta * (TAU * 3.0 * t).sin());
        let ground = ground.with_vertical(&upwards).unwrap();
        let (tolerance, structure) = (1e-11, OneMass::new(parameters).unwrap());
        let Parameters { m, H, zeta_fc, .. } = parameters;
        let storey = Storey { m, h: H, k: structure.k };
        let frame = Structure::from_storeys(&base(&parameters), &Damping::All(zeta_fc), &[storey]).unwrap();
        for detail in [Detail::Auto, Detail::Nonlinear, Detail::Linear, Detail::Rigid, Detail::FixedBase] {
            let theta = if detail.has_uplift() { theta } else { 0.0 };
            let one = Run { detail, tolerance, ..Run::new(structure, &ground) };
            let one = Run { initial: State { theta, ..one.initial }, ..one };
            let many = Run { detail, tolerance, ..Run::of_modes(frame.clone(), &ground) };
            let many = Run { initial: State { theta, ..many.initial }, ..many };
            let of_one = Run { structure: frame.of_one_mode().unwrap(), ..one.clone() };
            let ((expected, of_one_finish), (found, finish)) = (one.peaks().unwrap(), many.peaks().unwrap());
            assert!((finish.motion.time - of_one_finish.motion.time).abs() < 1e-9, "{finish:?} {of_one_finish:?}");
            let [findings, of_one_findings] = [&one, &of_one].map(|run| run.validity(Limits::default()).unwrap().0);
            assert_same_findings(&findings, &many.validity(Limits::default()).unwrap().0);
            assert_same_findings(&findings, &of_one_findings);
            assert!(finish.motion.transitions > 2 || !detail.has_uplift(), "{}", finish.motion.transitions);
            for found in [found, of_one.peaks().unwrap().0] {
                assert_same_peaks(&found, &expected, parameters == tied);
            }
        }
    }
}

/// Whether a building of one storey has `found` the peaks that are `expected` of one mass.
fn assert_same_peaks(found: &Peaks, expected: &Peaks, is_tied: bool) {
    let of_base = [Output::theta, Output::uplift, Output::V_t, Output::M_t].map(|of| (of, of));
    let u = Output::u(0);
    let of_floor = [u, Output::delta_t(0), Output::a_t(0)].map(|of| (of, of));
    let of_storey = [(Output::drift(0), u), (Output::V(0), Output::V_t), (Output::M(0), Output::M_t)];
    let pairs = of_base.into_iter().chain(of_floor).chain(of_storey);
    let pairs = pairs.map(|(of, expected_of)| (found.of(of).unwrap(), expected.of(expected_of).unwrap()));
    let of_tendon = is_tied.then(|| (found.P_t(), expected.P_t()));
    for (found, expected) in pairs.chain(of_tendon) {
        let off = (found.magnitude - expected.magnitude).abs();
        assert!(off <= 1e-13 * expected.magnitude, "{found:?}, not {expected:?}: {off:e}");
        assert!((found.time - expected.time).abs() < 1e-6, "{found:?}, {expected:?}");
    }
}

fn assert_same_findings(expected: &Findings, found: &Findings) {
    assert_eq!((found.impacts, found.gains, found.settlings), (expected.impacts, expected.gains, expected.settlings));
    for ((assumption, expected), found) in ASSUMPTIONS.iter().zip(&expected.worst).zip(&found.worst) {
        let is_near = |found: f64, expected: f64| {
            found == expected || (found - expected).abs() <= 1e-9 * expected.abs().max(1e-3)
        };
        assert!(is_near(found.value, expected.value), "{}: {found:?} and not {expected:?}", assumption.name);
        assert!(is_near(found.beyond, expected.beyond), "{}: {found:?} and not {expected:?}", assumption.name);
    }
}

/// Three storeys, held down by a tendon of this prestress (N) and stiffness (N/m).
fn tied_storeys(P_0: f64, k_t: f64, zeta: f64) -> Structure {
    crate::modes::three_storeys(zeta, &[("r", 0.93), ("P_0", P_0), ("k_t", k_t)])
}

/// The samples are 50 µs apart. They miss a peak just before a transition by the rate there. Modes that are left out ride rigidly, so
/// that accelerations follow the ground directly.
#[test]
fn a_profile_holds_every_sample_and_no_more() {
    let ground = ground();
    for modes in 0..=3 {
        let frame = tied_storeys(0.0, 0.0, 0.02).keeping(modes).unwrap();
        let run = Run { end: End::At(4.0), ..Run::of_modes(frame.clone(), &ground) };
        let limits = Limits { friction: 0.15, ..Limits::default() };
        let (validity, finish) = run.validity(limits).unwrap();
        assert!(finish.motion.transitions > 2, "{}", finish.motion.transitions);
        let ([mut tension, mut least, mut friction], mut beyond) = ([f64::NEG_INFINITY, f64::INFINITY, 0.0], 0.0);
        let W = frame.base().m_t * frame.base().g;
        let see = |sample: &Sample<Modes>| {
            let Reactions { R_h, R_v, R_m } = sample.reactions();
            if sample.motion.phase == Phase::FullContact {
                tension = tension.max((R_m.abs() / frame.base().B - R_v) / W);
            }
            (least, friction) = (least.min(R_v / W), friction.max(R_h.abs() / R_v.max(0.0)));
            beyond += if R_h.abs() > limits.friction * R_v { 5e-5 } else { 0.0 };
        };
        let times = (0..80_000).map(|i| f64::from(i) * 5e-5);
        peaks_beside_samples(&run, times, &Output::with_peak(&frame), 1e-3, see);
        // the friction by its reciprocal: R_v comes near 0
        let worst = validity.worst;
        let [edge, slip] = [-worst[EDGE_LOAD].value, -1.0 / worst[FRICTION].value];
        for (found, sampled) in [(worst[TENSION].value, tension), (edge, -least), (slip, -1.0 / friction)] {
            let (least, most) = (sampled - 1e-9, sampled + 5e-3 * sampled.abs().max(1.0));
            assert!((least..most).contains(&found), "{modes}: {found}, sampled {sampled}");
        }
        let found = worst[FRICTION].beyond;
        assert!(found > 0.1 && (found - beyond).abs() < 1e-3, "{modes}: {found} s, sampled {beyond} s");
    }
}

/// The load of a leap is slow, and the motion follows it. The largest values are at a start with vibration, at a far end, or between.
#[test]
fn a_long_leap_in_full_contact_holds_every_sample() {
    let (times, a_g) = (vec![0.0, 20.0, 60.0, 61.0], vec![0.3, -0.2, 0.9, 0.0]);
    let ground = Record::from_samples("", times, a_g).unwrap();
    for kept in [1, 3] {
        let frame = tied_storeys(1e4, 0.0, 0.02).keeping(kept).unwrap();
        let run = Run { end: End::At(70.0), ..Run::of_modes(frame.clone(), &ground) };
        let (validity, finish) = run.validity(Limits::default()).unwrap();
        assert_eq!(finish.motion.transitions, 0);
        let mut friction = 0.0_f64;
        let see = |sample: &Sample<Modes>| {
            let Reactions { R_h, R_v, .. } = sample.edges();
            friction = friction.max(R_h.abs() / R_v);
        };
        let times = (0..70_000).map(|i| 1e-3 * f64::from(i));
        peaks_beside_samples(&run, times, &Output::with_peak(&frame), 1e-3, see);
        let found = validity.worst[FRICTION].value;
        assert!(found >= friction && found < friction * (1.0 + 1e-3), "{kept}: {found}, sampled {friction}");
    }
}

/// The vibration decays, and the rest of a leap can change neither a peak nor a finding.
#[test]
fn a_long_rest_is_seen_at_once() {
    let ground = ground();
    let [short, long] = [1e2, 1e9].map(|end| {
        let run = Run { end: End::At(end), ..Run::of_modes(tied_storeys(1e4, 2e6, 0.02), &ground) };
        let findings = run.validity(Limits::default()).unwrap().0;
        (run.peaks().unwrap().0, findings.worst)
    });
    assert_eq!(short, long);
}

/// Several modes that vibrate for ever have no largest value that is known without a look at every period: the run is refused
/// before that takes long. The largest values of one mass come in its first period, and a run without a watcher is one leap.
#[test]
fn a_rest_without_damping_ends() {
    let ground = ground();
    let one = OneMass::new(Parameters { zeta_fc: 0.0, ..Parameters::MCMANUS }).unwrap();
    let one = Run { end: End::At(1e9), ..Run::new(one, &ground) };
    let short = Run { end: End::At(20.0), ..one.clone() }; // it rests from 12 s on
    assert_eq!(
        one.peaks().unwrap().0.of(Output::a_t(0)).unwrap(),
        short.peaks().unwrap().0.of(Output::a_t(0)).unwrap()
    );
    let [worst, expected] =
        [&one, &short].map(|run| run.validity(Limits::default()).unwrap().0.worst.map(|it| it.value));
    assert_eq!(worst, expected);

    let many = Run { end: End::At(1e9), ..Run::of_modes(tied_storeys(1e4, 2e6, 0.0), &ground) };
    assert_eq!(many.follow(&mut ()).unwrap().motion.time, 1e9);
    let is_refused =
        |error: RunError| matches!(error, RunError::Advance { cause: AdvanceError::TooManyPolynomials { .. }, .. });
    assert!(is_refused(many.peaks().unwrap_err()) && is_refused(many.validity(Limits::default()).unwrap_err()));
}

/// Momentum gives r < 0, so that the first impact stops the base at full speed.
#[test]
fn the_hard_landing_of_a_squat_structure_without_modes_is_an_impact() {
    let storeys = [(40e3, 3.5, 60e6), (40e3, 7.0, 50e6)].map(|(m, h, k)| Storey { m, h, k });
    let squat = Numbers::of(&[("m0", 20e3), ("B", 7.5), ("J0", 3e4)]).unwrap();
    let frame = Structure::from_storeys(&squat, &Damping::All(0.02), &storeys).unwrap();
    let ground = Record::at_rest(2.0);
    let run = Run { detail: Detail::Rigid, end: End::At(2.0), ..Run::of_modes(frame, &ground) };
    let run = Run { initial: State { theta: 0.05, ..run.initial }, ..run };
    let (findings, finish) = run.validity(Limits::default()).unwrap();
    assert_eq!((findings.impacts, finish.motion.transitions), (1, 1));
}
