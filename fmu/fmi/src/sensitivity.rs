//! Derivatives by differences, for quantities that have no formula.
//!
//! Differences to either side are extrapolated to the limit of no difference (Neville's scheme, its entry of least change). A
//! limit that has not settled to 1e-4 ([`LARGEST_CHANGE`]) is refused, and so are limits of both sides that differ by more: the
//! value has a kink there. Tests find the limit right to 1e-6.

use crate::failure::Failure;
use crate::model::Model;
use crate::variables::{Causality, Role, Value, state_references};

/// The largest change that the scheme may last make, relative to the derivative, or to the value of the unknown over the
/// magnitude of the known if that is more.
const LARGEST_CHANGE: f64 = 1e-4;

/// First difference, in parts of the known's magnitude.
const FIRST: f64 = 0.1;

/// Differences, each half of the one before.
const DIFFERENCES: i32 = 12;

/// The derivatives of the values that `shown` gives for a number, at `x`, whose magnitude is `scale`. A derivative that does
/// not settle is none.
pub fn by_differences(x: f64, scale: f64, shown: &mut dyn FnMut(f64) -> Option<Vec<f64>>) -> Option<Vec<Option<f64>>> {
    let here = shown(x)?;
    let sides = [-1.0, 1.0].map(|sign| {
        let places = (0..DIFFERENCES).map(|k| x + sign * (FIRST * scale) * 0.5_f64.powi(k));
        places.filter(|place| *place != x).filter_map(|place| Some((place - x, shown(place)?))).collect::<Vec<_>>()
    });
    let derivative = |(at, here): (usize, &f64)| {
        let settled = |side: &Vec<(f64, Vec<f64>)>| {
            let found = limit(side.iter().map(|(step, values)| (*step, (values[at] - here) / step)))?;
            let (limit, change) = found;
            (change <= LARGEST_CHANGE * limit.abs().max(here.abs() / scale)).then_some(found)
        };
        // a side along which a kink lies nearby settles not, and the other one alone tells
        let [below, above] = sides.each_ref().map(settled);
        let are_same = |((a, _), (b, _)): ((f64, f64), (f64, f64))| {
            (a - b).abs() <= LARGEST_CHANGE * a.abs().max(b.abs()).max(here.abs() / scale)
        };
        let is_kink = below.zip(above).is_some_and(|both| !are_same(both));
        let best = below.into_iter().chain(above).filter(|_| !is_kink).min_by(|(_, a), (_, b)| a.total_cmp(b));
        best.map(|(limit, _)| limit)
    };
    Some(here.iter().enumerate().map(derivative).collect())
}

/// The limit of `quotients`, given with their steps, at the step 0, and the change that the scheme last made to it.
fn limit(quotients: impl Iterator<Item = (f64, f64)>) -> Option<(f64, f64)> {
    let (mut steps, mut row) = (Vec::new(), Vec::<f64>::new());
    let mut best: Option<(f64, f64)> = None;
    for (step, quotient) in quotients {
        let before = std::mem::replace(&mut row, vec![quotient]);
        steps.push(step);
        for (column, diagonal) in before.iter().enumerate() {
            let farther = steps[steps.len() - 2 - column];
            let value = row[column] + (row[column] - diagonal) * step / (farther - step);
            let change = (value - row[column]).abs().max((value - diagonal).abs());
            if best.is_none_or(|(_, least)| change < least) {
                best = Some((value, change));
            }
            row.push(value);
        }
    }
    best
}

/// The derivatives of `of` along `direction` by inputs, before the simulation `has_started` by real parameters, and afterwards by
/// states.
pub fn along<M: Model + ?Sized>(
    model: &mut M,
    of: &[u32],
    direction: &[(u32, f64)],
    has_started: bool,
) -> Result<Vec<f64>, Failure> {
    let variables = model.variables();
    let (states, nominals) = (model.states()?, model.nominals()?);
    let mut sums = vec![0.0; of.len()];
    for (reference, change) in direction {
        let known = &variables[*reference as usize];
        let is_parameter =
            !has_started && matches!((&known.start, known.causality), (Some(Value::Real(_)), Causality::Parameter));
        let is_state = has_started && known.role == Role::State;
        if !(is_parameter || is_state || known.causality == Causality::Input) {
            let knowns = state_references(&variables).map(|state| model.name(state)).collect::<Vec<_>>().join(", ");
            return Err(Failure::NoKnown { name: model.name(*reference), knowns });
        }
        let which = state_references(&variables).position(|state| is_state && state == *reference);
        let (x, nominal) = match which {
            Some(which) => (states[which], nominals[which]),
            None => (model.values(&[*reference])?[0], known.nominal.unwrap_or(1.0)),
        };
        let scale = if is_parameter && x != 0.0 { x.abs() } else { nominal.max(x.abs()) };
        let set = |model: &mut M, value: f64| match which {
            Some(which) => {
                let mut states = states.clone();
                states[which] = value;
                model.set_states(&states)
            }
            None if is_parameter => {
                model.set(*reference, Value::Real(value));
                Ok(())
            }
            None => model.set_inputs(&[*reference], &[value]),
        };
        let found = by_differences(x, scale, &mut |value| {
            (is_state || known.data_type.accepts(value)).then_some(())?;
            set(model, value).ok()?;
            model.values(of).ok()
        });
        set(model, x)?;
        for (at, sum) in sums.iter_mut().enumerate() {
            let Some(by) = found.as_ref().and_then(|found| found[at]) else {
                return Err(Failure::NoRate { name: model.name(of[at]), time: model.time()? });
            };
            *sum += change * by;
        }
    }
    Ok(sums)
}
