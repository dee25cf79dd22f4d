//! Derivatives that have no formula: by what is set before the start, and by the states later on.
//!
//! Differences to either side of the value are extrapolated to the limit of no difference (Neville's scheme, its entry
//! of least change), each within the value's range and without passing 0, at which phases change and ranges end. Where
//! both sides have room, they must agree: at a step or a kink there is no derivative. What is returned is exact to
//! [`ACCURACY`], or to what rounding leaves of reactions that are small beside the forces they are made of.

use crate::failure::Failure;
use crate::ground::GroundRecord;
use crate::model::Model;
use crate::setup::Setup;
use crate::shown::Shown;
use crate::variables::{DataType, Variable};
use rocking::mechanics::state::COMPONENTS;
use rocking::{LinearLoad, Parameters, Phase, State};
use std::sync::Arc;

/// Relative to the derivative, or to the unknown's value over the known's scale where that is more.
pub const ACCURACY: f64 = 1e-8;

/// How far two limits may be apart, as [`ACCURACY`] counts it, that are not taken for a step or a kink.
const AGREEMENT: f64 = 1e-4;

/// First difference, in parts of the known's scale.
const FIRST: f64 = 0.1;

/// Differences, each half of the one before.
const DIFFERENCES: i32 = 12;

/// The derivatives of `unknowns` by `known` at the start that `setup` describes, under `ground` and `inputs`.
pub(crate) fn sensitivities(
    setup: &Setup,
    ground: &Option<Arc<GroundRecord>>,
    inputs: LinearLoad,
    unknowns: &[&'static Variable],
    known: &'static Variable,
) -> Result<Vec<f64>, Failure> {
    let depends = |variable: &Variable| variable.initial_dependencies.contains(&known.name);
    let shown = |value: f64| {
        let mut setup = setup.clone();
        known.source.set(&mut setup, value);
        let model = Model::new(&setup, ground.clone())?;
        let shown = Shown::new(&model, &setup, model.load(&setup, inputs).value);
        Ok::<Vec<_>, Failure>(
            unknowns.iter().map(|variable| shown.value(variable.source).unwrap_or_default()).collect(),
        )
    };
    if !unknowns.iter().any(|variable| depends(variable)) {
        return Ok(vec![0.0; unknowns.len()]);
    }
    let x = known.source.setting(setup).ok_or(Failure::NoKnown(known))?;
    let scale = scale(known, x, &setup.parameters);
    let here = shown(x)?;
    let first = [1.0, -1.0].map(|sign| first_step(known, x, sign, scale));
    let found = derivatives(x, scale, first, &here, |place| shown(place).ok());
    let checked = unknowns.iter().zip(found).map(|(&variable, found)| match found {
        _ if !depends(variable) => Ok(0.0),
        found => found.ok_or(Failure::NoSensitivity { variable, known }),
    });
    checked.collect()
}

/// The derivatives of `unknowns` by the state `which` in the present phase under `inputs`. θ is moved away from the
/// floor alone, at which the height of the free edge has a kink.
pub(crate) fn by_state(
    model: &mut Model,
    setup: &Setup,
    inputs: LinearLoad,
    unknowns: &[&'static Variable],
    which: usize,
) -> Result<Vec<f64>, Failure> {
    let motion = *model.engine.motion();
    let components = motion.state.components();
    let scale = components[which].abs().max(State::usual(model.engine.structure()).components()[which]);
    let load = model.load(setup, inputs).value;
    let mut shown = |value: f64| {
        let mut components = components;
        components[which] = value;
        model.engine.set_state(State::of(components));
        let shown = Shown::new(model, setup, load);
        let values = unknowns.iter().map(|variable| shown.value(variable.source).unwrap_or_default()).collect();
        Some(values).filter(|values: &Vec<f64>| values.iter().all(|value| value.is_finite()))
    };
    let x = components[which];
    let first = [1.0, -1.0].map(|sign| match motion.phase {
        Phase::Rocking(side) if COMPONENTS[which] == "theta" && side.sign() != sign => 0.0,
        _ => FIRST * scale,
    });
    let found = shown(x).map(|here| derivatives(x, scale, first, &here, &mut shown));
    model.engine.set_motion(motion);
    let found = found.unwrap_or_else(|| vec![None; unknowns.len()]);
    let failed = |variable| Failure::NoRate { variable, time: motion.time };
    unknowns.iter().zip(found).map(|(&variable, found)| found.ok_or(failed(variable))).collect()
}

/// The derivatives at `x` of what `at` tells, `here` there, by differences from `first` upwards and downwards on;
/// `None` where there is none.
fn derivatives(
    x: f64,
    scale: f64,
    first: [f64; 2],
    here: &[f64],
    mut at: impl FnMut(f64) -> Option<Vec<f64>>,
) -> Vec<Option<f64>> {
    let sides = [1.0, -1.0].into_iter().zip(first).map(|(sign, first)| {
        let places = (0..DIFFERENCES).map(|k| x + sign * first * 0.5_f64.powi(k));
        places.filter(|place| *place != x).filter_map(|place| Some((place - x, at(place)?))).collect::<Vec<_>>()
    });
    let sides: Vec<_> = sides.collect();
    let reach = |side: &[(f64, Vec<f64>)]| side.first().map_or(0.0, |(step, _)| step.abs());
    let farthest = sides.iter().map(|side| reach(side)).fold(0.0, f64::max);
    let derivative = |(which, here): (usize, &f64)| {
        let floor = here.abs() / scale;
        let agree = |distance: f64, value: f64| distance <= AGREEMENT * value.abs().max(floor);
        let limits = sides.iter().filter(|side| !side.is_empty() && reach(side) >= FIRST * farthest).map(|side| {
            limit(side.iter().map(|(step, values)| (*step, (values[which] - here) / step)))
                .filter(|(limit, change)| agree(*change, *limit))
        });
        match limits.collect::<Option<Vec<_>>>().as_deref() {
            Some([(limit, _)]) => Some(*limit),
            Some([(a, of_a), (b, of_b)]) if agree((a - b).abs(), *a) => Some(if of_a < of_b { *a } else { *b }),
            _ => None,
        }
    };
    here.iter().enumerate().map(derivative).collect()
}

/// What counts as a change of size one: the value itself, or more where it is small beside the structure.
fn scale(known: &Variable, x: f64, &Parameters { m, H, B, g, .. }: &Parameters) -> f64 {
    let DataType::Real { unit, .. } = known.data_type else { return x.abs() };
    let natural = match unit {
        "kg" => m,
        "kg.m2" => m * B * B,
        "m" => B,
        "m/s" => B * (g / H).sqrt(),
        "rad/s" => (g / H).sqrt(),
        "s" => (H / g).sqrt(),
        "N" => m * g,
        "N/m" => m * g / B,
        "N.s/m" => m * (g / H).sqrt(),
        "rad" | "1" => 1.0,
        _ => 0.0,
    };
    natural.max(x.abs())
}

/// The largest step from `x` towards `sign`.
fn first_step(known: &Variable, x: f64, sign: f64, scale: f64) -> f64 {
    let DataType::Real { range: Some((min, max)), .. } = known.data_type else { return 0.0 };
    let room = if sign > 0.0 { max - x } else { x - min };
    let to_zero = if x * sign < 0.0 { 0.5 * x.abs() } else { f64::INFINITY };
    (FIRST * scale).min(room).min(to_zero)
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
