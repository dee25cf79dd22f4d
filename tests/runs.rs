//! Runs from outside: levels compared on fine records, ends, start times.

use rocking::run::record::Record;
use rocking::run::{End, Run, RunError, levels};
use rocking::{Detail, Engine, Parameters, Ramp, State, Structure};

/// However finely a record is sampled, the histories of two levels are as far apart.
#[test]
fn histories_do_not_depend_on_how_finely_a_record_is_sampled() {
    let structure = Structure::new(Parameters { f_fc: 1.0, ..Parameters::MCMANUS }).unwrap();
    let coarse = |i: usize| if i > 150 { 0.0 } else { 4.0 * (0.09 * i as f64).sin() };
    let errors = [1, 100].map(|parts| {
        let times = (0..=300 * parts).map(|i| i as f64 * 0.01 / parts as f64).collect();
        let linear = |i: usize| {
            let (k, part) = (i / parts, (i % parts) as f64 / parts as f64);
            coarse(k) * (1.0 - part) + coarse(k + 1) * part
        };
        let ground = Record::from_samples("sine", times, (0..=300 * parts).map(linear).collect()).unwrap();
        let run = Run { end: End::At(3.0), ..Run::new(structure, &ground) };
        levels::compare(&run).unwrap().verdicts.into_iter().map(|verdict| verdict.errors).collect::<Vec<_>>()
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
    let structure = Structure::new(Parameters::MCMANUS).unwrap();
    let most = |dt: f64, samples: usize| {
        let times = (0..samples).map(|i| i as f64 * dt).collect();
        let waves = (0..samples).map(|i| 2.0 * (0.09 * i as f64).sin()).collect();
        let ground = Record::from_samples("waves", times, waves).unwrap();
        let run = Run { end: End::At(ground.end()), ..Run::new(structure, &ground) };
        allocation_counter::measure(|| drop(levels::compare(&run).unwrap())).bytes_max
    };
    let short = most(0.01, 1000);
    for (dt, samples) in [(0.01, 10_000), (100.0, 11)] {
        let long = most(dt, samples);
        assert!(long < 10_000_000.max(2 * short), "{dt} s, {samples} samples: {long} bytes beside {short}");
    }
}

#[test]
fn an_end_that_is_none_is_refused() {
    let ground = Record::from_samples("x", vec![2.0, 3.0], vec![5.0, -3.0]).unwrap();
    let structure = Structure::new(Parameters::MCMANUS).unwrap();
    for end in [1.0, 2.0, f64::NAN, f64::INFINITY] {
        let refused = Run { end: End::At(end), ..Run::new(structure, &ground) }.peaks();
        assert!(matches!(refused, Err(RunError::End { start: 2.0, .. })), "{refused:?}");
    }
}

/// The motion does not depend on the clock in any bit.
#[test]
fn the_same_bits_at_every_start_time() {
    let structure = Structure::new(Parameters::MCMANUS).unwrap();
    for detail in Detail::ALL {
        let motions = [0.0, -1000.0, 1e6, 1.7e9, 1e12].map(|start| {
            let mut engine = Engine::with_detail(structure, State::default(), start, 1e-9, detail).unwrap();
            let a_g = |i: u32| 4.0 * (0.13 * f64::from(i)).sin() + 2.0 * (0.71 * f64::from(i)).cos();
            for i in 0..1000 {
                let ramp = Ramp { value: a_g(i), slope: (a_g(i + 1) - a_g(i)) / 0.01 };
                engine.advance(0.01, ramp, &mut ()).unwrap();
            }
            (engine.motion().state, engine.motion().transitions, engine.motion().work)
        });
        assert!(motions.iter().all(|motion| *motion == motions[0]), "{detail:?}");
    }
}
