//! Peaks of leaps, of equal crests and of contact that lasts no time, and what finding peaks costs. That none is missed
//! is in `missed_peaks.rs`.

use crate::common::{peaks_beside_samples, sampled, shaking};
use crate::modes::three_storeys;
use rocking::run::peaks::Peaks;
use rocking::run::record::Record;
use rocking::run::{End, Run, Runs};
use rocking::{Detail, Engine, OneMass, Output, Parameters, Ramp, State};

/// A leap over many vibrations, which takes many polynomials: what is read of it is as if it had been cut.
#[test]
fn a_long_leap_is_read_to_its_end() {
    let stiff = Parameters { m: 100.0, m0: 50.0, H: 2.0, B: 0.3, J0: 0.0, f_fc: 80.0, r: 0.97, ..Parameters::MCMANUS };
    let structure = OneMass::new(stiff).unwrap();
    let initial = State { theta: 0.1, theta_dot: 0.15, u: 1e-5, u_dot: 0.02 };
    for detail in [Detail::Modal, Detail::Linear, Detail::FixedBase] {
        let initial =
            if detail == Detail::FixedBase { State { theta: 0.0, theta_dot: 0.0, ..initial } } else { initial };
        let results = [0.3, 1e-3].map(|dt| {
            let ground = sampled((0.3 / dt) as usize + 1, dt, |_| 0.0);
            let run = Run { detail, initial, tolerance: 1e-12, end: End::At(0.3), ..Run::new(structure, &ground) };
            let mut read = Vec::new();
            let instants = (0..300).map(|i| f64::from(i) * 1e-3 + 3e-4);
            let finish = run.sample(instants, |sample| read.push(sample.output(Output::delta_t(0))), &mut ()).unwrap();
            (run.peaks().unwrap().0, read, finish.motion.work.steps)
        });
        let [(at_once, read_at_once, steps), (cut, read_cut, _)] = &results;
        assert!(detail != Detail::FixedBase || *steps == 1, "{detail:?} takes {steps} steps");
        for output in Output::PEAKS_OF_ONE {
            let [whole, cut] = [at_once, cut].map(|peaks| peaks.of(output).unwrap().magnitude);
            assert!((whole - cut).abs() <= 1e-11 * cut, "{detail:?}: {} = {whole} {cut}", output.symbol());
        }
        let largest = (cut.of(Output::delta_t(0)).unwrap()).magnitude;
        for (whole, cut) in read_at_once.iter().zip(read_cut) {
            assert!((whole - cut).abs() <= 1e-10 * largest, "{detail:?}: {whole} {cut}");
        }
    }
}

/// Full contact is linear, and a power of 2 keeps all digits.
#[test]
fn peaks_in_contact_are_in_proportion_to_the_ground_motion_however_small() {
    fn peaks<Q: Runs>(run: Run<Q>) -> Vec<f64> {
        let peaks = Run { end: End::At(20.0), ..run.clone() }.peaks().unwrap().0;
        Output::with_peak(&run.structure).into_iter().map(|of| peaks.of(of).unwrap().magnitude).collect()
    }
    let part = 2.0_f64.powi(-400);
    let [whole, tiny] = [1e-3, 1e-3 * part].map(|peak| shaking(1, 0.02, 200, peak));
    for detail in [Detail::Auto, Detail::Nonlinear] {
        let of_one = |ground| peaks(Run { detail, ..Run::new(OneMass::new(Parameters::MCMANUS).unwrap(), ground) });
        let of_many = |ground| peaks(Run { detail, ..Run::of_modes(three_storeys(0.02, &[]), ground) });
        let [whole, tiny] = [&whole, &tiny].map(|ground| [of_one(ground), of_many(ground)].concat());
        assert_eq!(Vec::from_iter(whole.iter().map(|of| part * of)), tiny, "{detail:?}");
    }
}

/// A leap of a million vibrations: its peaks are within a period of an end, and looking for them takes no time.
#[test]
fn a_leap_without_end_is_looked_at_at_its_ends() {
    let undamped = OneMass::new(Parameters { zeta_fc: 0.0, ..Parameters::MCMANUS }).unwrap();
    let damped = OneMass::new(Parameters::MCMANUS).unwrap();
    let heavy = OneMass::new(Parameters { zeta_fc: 0.99, ..Parameters::MCMANUS }).unwrap();
    let initial = State { u: 1e-3, u_dot: 0.02, ..State::default() };
    for structure in [undamped, damped, heavy] {
        for duration in [20.0, 2e5, 1e12] {
            let ground = Record::from_samples("ramp", vec![0.0, duration], vec![-0.3, 0.2]).unwrap();
            let run = Run { initial, tolerance: 1e-12, end: End::At(duration), ..Run::new(structure, &ground) };
            let (peaks, finish) = run.peaks().unwrap();
            assert_eq!(finish.motion.work.steps, 1);
            assert!(peaks.evaluations() < 20_000, "{}", peaks.evaluations());
            let first = Run { end: End::At(2.0), ..run.clone() }.peaks().unwrap().0;
            let [whole, first] = [peaks, first].map(|peaks| peaks.of(Output::u(0)).unwrap().magnitude);
            assert!((whole / first - 1.0).abs() < 1e-9, "{whole} {first}");
        }
    }
}

/// Where the ground jumps hard enough to lift the base off, contact lasts no time: no motion shows its a_t.
#[test]
fn contact_of_no_duration_is_no_motion() {
    let structure = OneMass::new(Parameters::MCMANUS).unwrap();
    let ground = sampled(201, 1e-3, |t| 6.85 * (40.0 * t).cos());
    for (detail, c_ratio) in [(Detail::Rigid, 1.0), (Detail::Auto, 3.0), (Detail::Linear, 0.2)] {
        let structure = OneMass::new(Parameters { c_ratio, ..*structure.parameters() }).unwrap();
        // beyond uplift from the start
        let u = if detail == Detail::Rigid { 0.0 } else { 1.5 * structure.u_cr };
        let initial = State { u, u_dot: 20.0 * u, ..State::default() };
        let run = Run { detail, initial, end: End::At(0.2), ..Run::new(structure, &ground) };
        let times = (0..=200_000).map(|i| f64::from(i) * 1e-6);
        peaks_beside_samples(&run, times, &[Output::a_t(0)], 1e-4, |_| ());
    }
}

/// Undamped, each crest is as high as the first but for rounding: the first counts, and no crest that was seen is higher.
#[test]
fn the_first_of_equal_peaks_counts() {
    let structure = OneMass::new(Parameters { zeta_fc: 0.0, ..Parameters::MCMANUS }).unwrap();
    let omega = structure.omega_fc;
    for (u, u_dot) in [(1e-3, 0.0), (-1e-3, 0.0), (6e-4, 0.02), (-6e-4, 0.02)] {
        let crest = f64::atan2(u_dot, omega * u).rem_euclid(std::f64::consts::PI) / omega;
        for step in [1000.0, 333.3, 0.01, 7e-3] {
            let mut engine = Engine::new(structure, State { u, u_dot, ..State::default() }, 0.0, 1e-9).unwrap();
            let (mut peaks, mut highest) = (Peaks::since(0.0, &structure.into(), Detail::Auto), u.abs());
            for _ in 0..f64::ceil(100.0 / step).max(2.0) as u32 {
                let mut watch = peaks.watch();
                engine.advance(step, Ramp::default(), &mut watch).unwrap();
                peaks = watch.end();
                highest = highest.max(engine.motion().state.u.abs());
            }
            let peak = peaks.of(Output::u(0)).unwrap();
            assert!((peak.time - crest).abs() < 1e-6, "u = {u}, u_dot = {u_dot}, {step}: {peak:?} {crest}");
            assert!(peak.magnitude >= highest, "u = {u}, u_dot = {u_dot}, {step}: {peak:?} {highest}");
        }
    }
}

/// Watching changes no bit of the motion, and of what is rocked by series it asks for next to nothing.
#[test]
fn watching_costs_little_and_changes_nothing() {
    let structure = OneMass::new(Parameters::MCMANUS).unwrap();
    let ground = shaking(2, 0.01, 1500, 2.0);
    for detail in Detail::ALL {
        let run = Run { detail, ..Run::new(structure, &ground) };
        let unwatched = run.follow(&mut ()).unwrap();
        let (peaks, watched) = run.peaks().unwrap();
        assert_eq!(watched, unwatched);
        let (evaluations, of_motion) = (peaks.evaluations(), watched.motion.work.evaluations);
        match detail {
            Detail::Nonlinear | Detail::Rigid => assert_eq!(evaluations, 0),
            Detail::Auto => assert!(100 * evaluations < 15 * of_motion, "{evaluations} beside {of_motion}"),
            // a sample leapt over costs no evaluation; one in ten or so is expanded for its peaks
            _ => assert!(evaluations < 2 * 1500, "{}: {evaluations} beside {of_motion}", detail.name()),
        }
    }
}
