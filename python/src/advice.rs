//! `advise` and `estimate`: how little of the model will do, and what is known without a time history.

use crate::arguments::{conditions, one_of, refused};
use crate::record::Record;
use crate::structure::Structure;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rocking::engine::DEFAULT_TOLERANCE;
use rocking::estimates::demand::INSTANT_TRANSITION;
use rocking::run::levels::{Criterion, Verdict, compare};
use rocking::run::validity::Limits;
use rocking_report::quantities::write_columns;
use rocking_report::{advice, estimate as estimates};

/// Every level of detail on one scene, and which is the cheapest that will do: what `advise` returns. print(advice)
/// shows it.
#[pyclass(frozen, module = "flexible_rocking")]
pub struct Advice {
    text: String,
    /// The level that is advised; None where none is good enough.
    #[pyo3(get)]
    detail: Option<&'static str>,
    levels: Vec<(Verdict, Option<f64>)>,
}

#[pymethods]
impl Advice {
    /// The levels, a dict each: level, relative errors by criterion, overturned (None where it still rocks), steps,
    /// evaluations, cost_of_auto (steps and evaluations over those of auto).
    #[getter]
    fn levels<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyDict>>> {
        let level = |(verdict, cost): &(Verdict, Option<f64>)| {
            let level = PyDict::new(py);
            level.set_item("level", verdict.response.detail.name())?;
            for (criterion, error) in Criterion::ALL.iter().zip(verdict.errors) {
                level.set_item(criterion.name(), error)?;
            }
            level.set_item("overturned", verdict.response.ending.overturned())?;
            level.set_item("steps", verdict.response.work.steps)?;
            level.set_item("evaluations", verdict.response.work.evaluations)?;
            level.set_item("cost_of_auto", cost)?;
            Ok(level)
        };
        self.levels.iter().map(level).collect()
    }

    fn __repr__(&self) -> &str {
        &self.text
    }
}

/// Runs every level of detail and names the cheapest level whose errors stay `within` a part of the reference,
/// `nonlinear` at the tolerance 1e-12, or the simplest of equally cheap levels.
///
/// of: what must stay within it, of "theta", "u", "a_t" (peaks) and "theta_history", "u_history", "a_t_history";
/// without it all of them. duration and initial values as in `simulate`. Raises ValueError where the reference cannot
/// be run.
#[pyfunction]
#[pyo3(signature = (structure, record, *, within=0.05, of=None, duration=None, **initial))]
pub fn advise(
    py: Python<'_>,
    structure: &Structure,
    record: &Record,
    within: f64,
    of: Option<Vec<String>>,
    duration: Option<f64>,
    initial: Option<&Bound<'_, PyDict>>,
) -> PyResult<Advice> {
    if !(within > 0.0 && within < 1.0) {
        let needed = "more than 0 and less than 1 is needed";
        return Err(PyValueError::new_err(format!("within = {within} is out of range: {needed}")));
    }
    let criterion = |name: &String| one_of("of", name, Criterion::ALL.map(|of| (of.name(), of)));
    let criteria: Vec<_> = match of {
        Some(names) => names.iter().map(criterion).collect::<PyResult<_>>()?,
        None => Criterion::ALL.into(),
    };
    let conditions = conditions("auto", DEFAULT_TOLERANCE, duration, initial)?;
    conditions.check(&structure.0).map_err(refused)?;
    let advised = py.detach(|| -> anyhow::Result<Advice> {
        let run = conditions.run(structure.0, &record.0);
        let comparison = compare(&run)?;
        let title = format!("{}, {} samples", record.0.title(), record.0.times().len());
        let text = advice::text(&title, &run, &comparison, (within, &criteria), Limits::default())?;
        let detail = comparison.recommended(within, &criteria).map(|verdict| verdict.response.detail.name());
        let cost = |verdict: &Verdict| comparison.cost_over_auto(&verdict.response);
        let levels = comparison.verdicts.iter().map(|verdict| (verdict.clone(), cost(verdict))).collect();
        Ok(Advice { text, detail, levels })
    });
    advised.map_err(refused)
}

/// The demands without a time history (Eqs 4, 21 to 24), a dict of numbers by name in SI units; printed, with units and
/// equations.
///
/// record: what shakes it; without one the ground is at rest. amplification: C, 0 to 2, 2 for an instant change of
/// sides (Eq 21). Raises ValueError where C is out of range.
#[pyfunction]
#[pyo3(signature = (structure, record=None, *, amplification=INSTANT_TRANSITION))]
pub fn estimate<'py>(
    py: Python<'py>,
    structure: &Structure,
    record: Option<&Record>,
    amplification: f64,
) -> PyResult<Bound<'py, PyAny>> {
    let record = record.map(|record| &record.0);
    let estimated = py.detach(|| estimates::Estimate::new(&structure.0, record, amplification)).map_err(refused)?;
    let mut text = String::new();
    write_columns(&mut text, &estimated.terms, structure.0.parameters().g).map_err(refused)?;
    let values = PyDict::new(py);
    estimated.terms.iter().try_for_each(|line| values.set_item(&line.name, line.value))?;
    py.import("flexible_rocking._results")?.call_method1("Estimate", (values, text))
}
