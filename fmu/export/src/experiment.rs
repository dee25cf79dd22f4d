//! How long a simulation lasts, and how far its communication points are apart, where a host is told nothing else.

use model_description::DefaultExperiment;
use rocking::Structure;
use rocking::engine::DEFAULT_TOLERANCE;
use rocking::run::record::Record;
use std::f64::consts::TAU;

/// The whole of `record`, in steps of its samples, or of no record, in steps that show the vibration mode, 1/(20 f_u),
/// rounded to a 1, 2 or 5; then as long as a free motion is worth looking at, 10/p_l: after a pulse the structure rocks
/// farther than under it.
pub fn default_experiment(structure: &Structure, record: Option<&Record>) -> DefaultExperiment {
    let (duration, step_size) = match record {
        Some(record) => {
            let duration = record.end() - record.start();
            (duration, duration / (record.times().len() - 1) as f64)
        }
        None => (0.0, at_most(TAU / structure.omega_u / 20.0)),
    };
    let afterwards = (10.0 / structure.p_l / step_size).ceil() * step_size;
    DefaultExperiment {
        start_time: 0.0,
        stop_time: rounded(duration + afterwards),
        tolerance: DEFAULT_TOLERANCE,
        step_size: rounded(step_size),
    }
}

/// `seconds` without the noise of differences of decimal fractions.
fn rounded(seconds: f64) -> f64 {
    format!("{seconds:.8e}").parse().expect("a number in Rust's own notation")
}

/// The largest 1, 2 or 5 of any power of ten that `seconds` is not less than.
fn at_most(seconds: f64) -> f64 {
    let exponent = seconds.log10().floor();
    let digit = [5, 2].into_iter().find(|&digit| f64::from(digit) * 10f64.powf(exponent) <= seconds).unwrap_or(1);
    format!("{digit}e{exponent}").parse().expect("a number in Rust's own notation")
}

#[cfg(test)]
mod tests {
    use super::*;
    use rocking::Parameters;

    #[test]
    fn a_record_is_followed_beyond_its_end_by_its_samples() {
        let structure = Structure::new(Parameters::MCMANUS).unwrap();
        for (interval, samples) in [(0.005, 8_000), (0.01, 3), (0.02, 2_688), (1.0 / 240.0, 24_001)] {
            let times: Vec<_> = (0..samples).map(|at| 3.7 + f64::from(at) * interval).collect();
            let record = Record::from_samples("record", times, vec![1.0; samples as usize]).unwrap();
            let DefaultExperiment { stop_time, step_size, .. } = default_experiment(&structure, Some(&record));
            let shortest = record.times().windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
            assert!(step_size <= shortest * (1.0 + 1e-8), "{step_size} is longer than {interval}");
            let steps = stop_time / step_size;
            assert!((steps - steps.round()).abs() < 1e-3, "{stop_time} {step_size}");
            let afterwards = stop_time - f64::from(samples - 1) * interval;
            assert!((0.0..interval + 1e-6).contains(&(afterwards - 10.0 / structure.p_l)), "{afterwards}");
        }
    }

    #[test]
    fn numbers_are_round() {
        assert_eq!([0.0024, 0.0051, 0.02, 1.9, 7.0].map(at_most), [0.002, 0.005, 0.02, 1.0, 5.0]);
        assert_eq!(rounded(0.3 - 0.1), 0.2);
    }
}
