//! `advise` and `estimate`: how little of the model will do, and what is known without a time history.

use crate::arguments::{argument, conditions, one_of, refused, reject, result};
use crate::interruptible::interruptible;
use crate::record::RecordArgument;
use crate::structure::PyStructure;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict, PyString};
use rocking::Detail;
use rocking::engine::DEFAULT_TOLERANCE;
use rocking::estimates::demand::INSTANT_TRANSITION;
use rocking::run::levels::Criterion;
use rocking::run::validity::Limits;
use rocking_report::advice::LevelAdvice;
use rocking_report::estimate as estimates;
use rocking_report::quantities::columns;
use rocking_report::run::RunSetup;

/// The criteria that `value` names: one name, or several.
fn criteria(value: &Bound<'_, PyAny>) -> PyResult<Vec<Criterion>> {
    let is_one = value.is_instance_of::<PyString>();
    let names = if is_one { vec![value.clone()] } else { value.try_iter()?.collect::<PyResult<Vec<_>>>()? };
    let criterion = |name| one_of("of", name, Criterion::ALL.map(|of| (of.name(), of)));
    names.iter().map(criterion).collect()
}

/// Runs every level of detail and names the cheapest level whose errors stay `within` a part of the reference,
/// `nonlinear` at the tolerance 1e-12, or the simplest of equally cheap levels. A level of a structure of many masses is also how
/// many of its modes are kept; the rest of the mass turns rigidly with the base.
///
/// of: the results whose errors must not exceed `within`, by default all. One or several of "theta", "u", "a_t" (peaks; for many
/// masses the peaks of every floor), "theta_history", "u_history", "a_t_history". duration and initial values as in `simulate`.
/// Raises ValueError if the reference cannot be run.
#[pyfunction]
#[pyo3(signature = (structure, record, *, within=0.05, of=None, duration=None, **initial))]
pub fn advise<'py>(
    py: Python<'py>,
    structure: &PyStructure,
    record: RecordArgument,
    #[pyo3(from_py_with = argument::within)] within: f64,
    of: Option<&Bound<'_, PyAny>>,
    duration: Option<&Bound<'_, PyAny>>,
    initial: Option<&Bound<'_, PyDict>>,
) -> PyResult<Bound<'py, PyAny>> {
    if !(within > 0.0 && within < 1.0) {
        reject!("within = {within} is out of range: more than 0 and less than 1 is needed");
    }
    let criteria = of.map_or(Ok(Criterion::ALL.into()), criteria)?;
    let conditions = conditions(Detail::Auto, DEFAULT_TOLERANCE, duration, initial)?;
    conditions.check(&structure.of).map_err(refused)?;
    let ground = record.0.get().under(structure.of.base().g);
    let run = RunSetup { structure: structure.of.clone(), ground, conditions };
    let (text, advice) = interruptible(py, move |_| -> anyhow::Result<_> {
        let advice = run.advice(within, &criteria)?;
        let title = format!("{}, {} samples", run.ground.title(), run.ground.times().len());
        Ok((run.advice_text(&title, &advice, &Limits::default())?, advice))
    })?;
    let level = |LevelAdvice { choice, errors, overturned, work, cost, .. }: &LevelAdvice| {
        let level = PyDict::new(py);
        level.set_item("level", choice.detail.name())?;
        if let Some([kept, _]) = choice.modes {
            level.set_item("keep", kept)?;
        }
        for (criterion, error) in Criterion::ALL.iter().zip(errors) {
            level.set_item(criterion.name(), error)?;
        }
        level.set_item("overturned", overturned)?;
        level.set_item("steps", work.steps)?;
        level.set_item("evaluations", work.evaluations)?;
        level.set_item("cost_of_auto", cost)?;
        Ok(level)
    };
    let levels = advice.levels.iter().map(level).collect::<PyResult<Vec<_>>>()?;
    let detail = advice.advised.map(|choice| choice.detail.name());
    let keep = advice.advised.and_then(|choice| choice.modes).map(|[kept, _]| kept);
    result(py, "Advice", (detail, keep, levels, text))
}

/// The demands without a time history (Eqs 4, 21 to 24), a dict of numbers by name in SI units; printed, with units and
/// equations.
///
/// record: what shakes it; without one the ground is at rest. amplification: C, 0 to 2, 2 for an instant change of
/// sides (Eq 21). Raises ValueError where C is out of range.
#[pyfunction]
#[pyo3(signature = (structure, record=None, *, amplification=INSTANT_TRANSITION))]
#[pyo3(text_signature = "(structure, record=None, *, amplification=2.0)")]
pub fn estimate<'py>(
    py: Python<'py>,
    structure: &PyStructure,
    record: Option<RecordArgument>,
    #[pyo3(from_py_with = argument::amplification)] amplification: f64,
) -> PyResult<Bound<'py, PyAny>> {
    let structure = structure.one("estimate")?;
    let g = structure.parameters().g;
    let record = record.map(|RecordArgument(record)| record.get().under(g));
    let estimated = interruptible(py, move |_| estimates::Estimate::new(&structure, record.as_deref(), amplification))?;
    let values = estimated.terms.iter().map(|line| (&line.name, line.value)).into_py_dict(py)?;
    result(py, "Estimate", (values, columns(&estimated.terms, g)))
}
