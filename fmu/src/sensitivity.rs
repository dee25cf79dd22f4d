//! Derivatives by the states, which have no formula.
//!
//! Differences to either side of the state are extrapolated to the limit of no difference (Neville's scheme, its entry of
//! least change). A limit that has not settled to 1e-4 ([`LARGEST_CHANGE`]) is refused; the tests find it right to 1e-6.

use crate::failure::Failure;
use crate::model::Model;
use crate::setup::Setup;
use crate::shown::Shown;
use crate::variables::Variable;
use rocking::mechanics::state::COMPONENTS;
use rocking::{LinearLoad, Phase, State};

/// The largest change that the scheme may last make, relative to the derivative, or to the unknown's value over the
/// state's magnitude where that is more.
const LARGEST_CHANGE: f64 = 1e-4;

/// First difference, in parts of the state's magnitude.
const FIRST: f64 = 0.1;

/// Differences, each half of the one before.
const DIFFERENCES: i32 = 12;

/// The derivatives of `unknowns` by the state `which` in the present phase under `inputs`. While the base rocks, θ is moved
/// away from 0 only: at 0 the height of the free edge has a kink.
pub(crate) fn by_state(
    model: &mut Model,
    setup: &Setup,
    inputs: LinearLoad,
    unknowns: &[&'static Variable],
    which: usize,
) -> Result<Vec<f64>, Failure> {
    let motion = *model.engine.motion();
    let components = motion.state.components();
    let x = components[which];
    let scale = x.abs().max(State::usual(model.engine.structure()).components()[which]);
    let load = model.load(setup, inputs).value;
    let mut shown = |value: f64| {
        let mut components = components;
        components[which] = value;
        model.engine.set_state(State::of(components));
        let shown = Shown::new(model, setup, load);
        let values = unknowns.iter().map(|variable| shown.value(variable.source).unwrap_or_default()).collect();
        Some(values).filter(|values: &Vec<f64>| values.iter().all(|value| value.is_finite()))
    };
    let signs = match motion.phase {
        Phase::Rocking(side) if COMPONENTS[which] == "theta" => vec![side.sign()],
        _ => vec![-1.0, 1.0],
    };
    let here = shown(x).unwrap_or_else(|| vec![f64::NAN; unknowns.len()]);
    let sides = signs.into_iter().map(|sign| {
        let places = (0..DIFFERENCES).map(|k| x + sign * (FIRST * scale) * 0.5_f64.powi(k));
        places.filter(|place| *place != x).filter_map(|place| Some((place - x, shown(place)?))).collect::<Vec<_>>()
    });
    let sides: Vec<_> = sides.collect();
    model.engine.set_motion(motion);
    let derivative = |(at, here): (usize, &f64)| {
        let of_side = |side: &Vec<_>| {
            limit(side.iter().map(|(step, values): &(f64, Vec<f64>)| (*step, (values[at] - here) / step)))
        };
        let best = sides.iter().filter_map(of_side).min_by(|(_, a), (_, b)| a.total_cmp(b));
        let is_settled = |(limit, change): &(f64, f64)| *change <= LARGEST_CHANGE * limit.abs().max(here.abs() / scale);
        let found = best.filter(is_settled).map(|(limit, _)| limit);
        found.ok_or(Failure::NoRate { variable: unknowns[at], time: motion.time })
    };
    here.iter().enumerate().map(derivative).collect()
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
