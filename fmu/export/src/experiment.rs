//! How long a simulation lasts, and how far its communication points are apart, where a host is told nothing else.

use FlexibleRocking::ground::GroundRecord;
use model_description::DefaultExperiment;
use rocking::Structure;
use rocking::engine::DEFAULT_TOLERANCE;
use rocking::run::{LONGEST_REST, Run};
use std::f64::consts::TAU;

/// The experiment that a host is offered.
///
/// With a record on the `ground`, the steps are those of the record's samples. The experiment ends when the `structure` stands for
/// good or overturns, like a run without a stated end. Without a record, the experiment lasts 10/p_l. Its steps of 1/(20 f_u),
/// rounded to a 1, 2 or 5, show the vibration mode.
pub fn default_experiment(structure: &Structure, ground: Option<&GroundRecord>) -> DefaultExperiment {
    let p_l = structure.base().p_l;
    let (duration, step_size) = match ground.map(|ground| ground.in_m_s2(structure.base().g)) {
        Some(record) => {
            let of_record = record.end() - record.start();
            let structure = structure.clone();
            let end = match structure.one() {
                Some(_) => Run::new(structure, &record).follow(&mut ()).map(|finish| finish.motion.time),
                None => Run::of_modes(structure, &record).follow(&mut ()).map(|finish| finish.motion.time),
            };
            let duration = end.map_or(of_record + LONGEST_REST / p_l, |end| end - record.start());
            (duration, of_record / (record.times().len() - 1) as f64)
        }
        None => (10.0 / p_l, at_most(TAU / structure.vibration().rocking[0] / 20.0)),
    };
    let (stop_time, step_size) = (rounded((duration / step_size).ceil() * step_size), rounded(step_size));
    DefaultExperiment { start_time: 0.0, stop_time, tolerance: DEFAULT_TOLERANCE, step_size }
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

    #[test]
    fn numbers_are_round() {
        assert_eq!([0.0024, 0.0051, 0.02, 1.9, 7.0].map(at_most), [0.002, 0.005, 0.02, 1.0, 5.0]);
        assert_eq!(rounded(0.3 - 0.1), 0.2);
    }
}
