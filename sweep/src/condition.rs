//! The condition of a result: how much a small change of the input grows, and how many digits of the result are therefore sure.
//!
//! The input is the ground motion, the force on the top floor and the initial values. A changed run has each number of them times 1 +
//! the change. These products are rounded to 1.1e-16, so that a change of 1e-12 is exact to 1e-4 of itself.

use crate::plan::Conditions;
use rocking::run::Ending;
use rocking::run::record::Record;

/// Relative change of the input by which the condition is found.
pub const PERTURBATION: f64 = 1e-12;

/// Relative change of the input that moves a result as far as what the engine rounds: ten roundings of a number.
const ROUNDING: f64 = 10.0 * f64::EPSILON;

/// Relative changes of the input, each in both directions, under which another outcome is looked for.
pub const TRIED: [f64; 13] = [1e-14, 1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2];

/// Condition κ of a `result` that [`PERTURBATION`] moves to `changed`: its relative change over that of the input.
pub fn condition(result: f64, changed: f64) -> f64 {
    let change = (changed - result).abs();
    if change == 0.0 { 0.0 } else { change / result.abs() / PERTURBATION }
}

/// Sure digits of a result of this `condition`, 0 to 14: −log10(2.2e-15 κ), rounded down. None are sure if the result is no number, or if
/// the change of 1e-12 moves it by more than 1 %, which is beyond proportion.
pub fn digits(condition: f64) -> u8 {
    if condition > 0.01 / PERTURBATION { 0 } else { decades(condition) }
}

/// Sure digits of an outcome that a relative `change` of the input turns into another, 0 to 13: those of κ = 1/|change|.
pub fn digits_of_outcome(change: Option<f64>) -> u8 {
    decades(1.0 / change.map_or(0.1, f64::abs))
}

fn decades(condition: f64) -> u8 {
    (-libm::log10(ROUNDING * condition)).floor().clamp(0.0, 14.0) as u8
}

/// Sure digits of a run and its changed run, each an ending, a duration (s) and the peak of |θ|: of this peak or, if the structure
/// overturns, of the time until then; 0 if the two end otherwise.
pub fn digits_of_run([(ending, duration, theta), changed]: [(Ending, f64, f64); 2]) -> u8 {
    match ending {
        _ if ending != changed.0 => 0,
        Ending::Overturned => digits(condition(duration, changed.1)),
        _ => digits(condition(theta, changed.2)),
    }
}

/// The `ground`, its accelerations and its force changed by the part `change`.
pub fn changed(ground: &Record, change: f64) -> Record {
    let record = ground.clone().multiplied(1.0 + change);
    let Some(force) = ground.force().filter(|_| change != 0.0) else { return record };
    let changed = Vec::from_iter(force.iter().map(|F_t| F_t * (1.0 + change)));
    record.with_force(&ground.times()[..force.len()], &changed).expect("it begins with the record")
}

impl Conditions {
    /// The conditions with initial values changed by the part `change`, of a run that is not changed again.
    pub fn changed(&self, change: f64) -> Conditions {
        let mut changed = Conditions { finds_condition: false, ..self.clone() };
        let initial = &mut changed.initial;
        let of_base = [&mut initial.theta, &mut initial.theta_dot];
        initial.u.iter_mut().chain(&mut initial.u_dot).chain(of_base).for_each(|of| *of *= 1.0 + change);
        changed
    }
}

/// Gives `done` the results of `count` runs. If `are_changed`, so many changed runs follow, and each result comes with that of its changed
/// run once both are there.
pub(crate) fn paired<T: Clone>(
    count: usize,
    are_changed: bool,
    mut done: impl FnMut(usize, T, Option<T>) -> bool,
) -> impl FnMut(usize, T) -> bool {
    let mut first = vec![None; count];
    move |number, result| {
        let at = number % count;
        match first[at].take() {
            _ if !are_changed => done(at, result, None),
            Some(other) if number == at => done(at, result, Some(other)),
            Some(other) => done(at, other, Some(result)),
            None => {
                first[at] = Some(result);
                true
            }
        }
    }
}
