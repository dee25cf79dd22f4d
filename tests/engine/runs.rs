//! Runs from outside: levels compared on fine records, ends.

use crate::common::{sampled, transitions_of};
use crate::modes::three_storeys;
use rocking::run::levels::Criterion;
use rocking::run::record::Record;
use rocking::run::{End, Run, levels};
use rocking::{Detail, OneMass, Parameters, Sample, Structure, Transition};

/// However finely a record is sampled, the histories of two levels are as far apart.
#[test]
fn histories_do_not_depend_on_how_finely_a_record_is_sampled() {
    let structure = OneMass::new(Parameters { f_fc: 1.0, ..Parameters::MCMANUS }).unwrap();
    let coarse = |i: usize| if i > 150 { 0.0 } else { 4.0 * (0.09 * i as f64).sin() };
    let errors = [1, 100].map(|parts| {
        let times = (0..=300 * parts).map(|i| i as f64 * 0.01 / parts as f64).collect();
        let linear = |i: usize| {
            let (k, part) = (i / parts, (i % parts) as f64 / parts as f64);
            coarse(k) * (1.0 - part) + coarse(k + 1) * part
        };
        let ground = Record::from_samples("sine", times, (0..=300 * parts).map(linear).collect()).unwrap();
        let run = Run { end: End::At(3.0), ..Run::new(structure, &ground) };
        run.compare().unwrap().verdicts.into_iter().map(|verdict| verdict.errors).collect::<Vec<_>>()
    });
    for (coarse, fine) in errors[0].iter().zip(&errors[1]) {
        for (coarse, fine) in coarse.iter().zip(fine) {
            assert!((coarse - fine).abs() <= 1e-6 * coarse.max(1e-3), "{coarse} {fine}");
        }
    }
    assert!(errors[1][0][3] > 0.99, "the fixed base has all of theta wrong");
}

/// Levels are compared as they go on: what is kept of a long record, or of a long time between two samples, is no more than of
/// a short one.
#[test]
fn comparing_levels_takes_no_more_memory_for_more_of_them() {
    let structure = OneMass::new(Parameters::MCMANUS).unwrap();
    let most = |dt: f64, samples: usize| {
        let ground = sampled(samples, dt, |t| 2.0 * (0.09 * t / dt).sin());
        let run = Run { end: End::At(ground.end()), ..Run::new(structure, &ground) };
        allocation_counter::measure(|| drop(run.compare().unwrap())).bytes_max
    };
    let short = most(0.01, 1000);
    for (dt, samples) in [(0.01, 10_000), (100.0, 11)] {
        let long = most(dt, samples);
        assert!(long < 10_000_000.max(2 * short), "{dt} s, {samples} samples: {long} bytes beside {short}");
    }
}

/// Fewer modes cost less and err more. Advice names how many of them are enough.
#[test]
fn a_level_of_a_frame_is_also_how_many_modes_are_kept() {
    let storeys = three_storeys(0.02, &[("r", 0.93)]);
    let frame = Structure::of_body(*storeys.body(), storeys.modes(), &[]).unwrap();
    let ground = sampled(301, 0.01, |t| 4.0 * t / 3.0 * (9.0 * t).sin());
    let comparison = Run::of_modes(frame, &ground).compare().unwrap();
    let errors = |detail, kept| {
        let is_it = |of: &&levels::Verdict| of.response.choice == levels::Choice { detail, modes: Some([kept, 3]) };
        let verdict = comparison.verdicts.iter().find(is_it).unwrap();
        (verdict.errors, verdict.response.cost())
    };
    let [one, two, all] = [1, 2, 3].map(|kept| errors(Detail::Auto, kept));
    assert!(all.0.iter().all(|error| *error < 1e-12) && all.1 > two.1 && two.1 > one.1);
    assert!(one.0.iter().zip(two.0).all(|(one, two)| *one > 1.3 * two || *one == 0.0), "{one:?} {two:?}");
    assert_eq!(errors(Detail::FixedBase, 3).0[0], 1.0);
    let advised = |within, criteria: &[Criterion]| {
        comparison.recommended(within, criteria).map(|verdict| verdict.response.choice.to_string())
    };
    assert_eq!(advised(0.05, &[Criterion::Theta]).as_deref(), Some("linear, 1 of 3"));
    assert_eq!(advised(0.05, &[Criterion::Theta, Criterion::At]).as_deref(), Some("linear, 3 of 3"));
    assert_eq!(advised(0.001, &Criterion::ALL).as_deref(), Some("auto, 3 of 3"));
}

/// Instants an ulp before a transition, which often lie between the clocks of two pieces, are shown before the transition; each
/// requested instant is shown once, alone or among others.
#[test]
fn every_instant_of_a_run_is_shown() {
    let wave = |t: f64| 3.0 * (std::f64::consts::TAU * 1.3 * t).sin() * (-((t - 2.0) / 1.5).powi(2)).exp();
    let ground = sampled(600, 0.02, wave);
    let run = Run::new(OneMass::new(Parameters::MCMANUS).unwrap(), &ground);
    let transitions = transitions_of(&run);
    let mut instants = Vec::from_iter(transitions.iter().flat_map(|of| [of.time.next_down(), of.time]));
    instants.sort_by(f64::total_cmp);
    let sampled = |instants: &[f64]| {
        let mut shown = Vec::new();
        let show = |at: &Sample| shown.push((at.motion.time, at.motion.transitions as usize, at.motion.state.u));
        run.sample(instants.iter().copied(), show, &mut ()).unwrap();
        shown.pop(); // the end
        shown
    };
    let together = sampled(&instants);
    assert_eq!(together.len(), instants.len());
    for (instant, shown) in instants.iter().zip(together) {
        let count = transitions.partition_point(|of| of.time <= *instant);
        assert_eq!((shown.0, shown.1), (*instant, count));
        assert_eq!(sampled(&[*instant]), [shown]);
        let is_before = |of: &Transition| of.time > instant.next_up() || of.before.u == shown.2;
        assert!(transitions.get(count).is_none_or(is_before), "{shown:?}");
    }
}

#[test]
fn an_end_that_is_none_is_refused() {
    let ground = Record::from_samples("x", vec![2.0, 3.0], vec![5.0, -3.0]).unwrap();
    let structure = OneMass::new(Parameters::MCMANUS).unwrap();
    for end in [1.0, 2.0, f64::NAN, f64::INFINITY] {
        let refused = Run { end: End::At(end), ..Run::new(structure, &ground) }.peaks().unwrap_err().to_string();
        let expected = "a finite time after the record's first sample, at 2.0 s, is needed";
        assert_eq!(refused, format!("the run cannot end at {end:?} s: {expected}"));
    }
}
