//! What Python's arguments say, and how they are refused: by name, value and limit, in the words of the library.

use numpy::{PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rocking::mechanics::state::INITIAL_VALUES;
use rocking::{Detail, State};
use rocking_sweep::plan::Conditions;

/// The `ValueError` that says why.
pub fn refused(error: impl Into<anyhow::Error>) -> PyErr {
    PyValueError::new_err(rocking_report::message(&error.into()))
}

/// The number that `value` is, which messages call `name`.
pub fn number(name: &str, value: &Bound<'_, PyAny>) -> PyResult<f64> {
    value.extract().map_err(|_| PyValueError::new_err(format!("{name} = {value:?}: it is no number")))
}

/// The numbers of an array of one dimension, or what numpy makes one of, which messages call `name`.
pub fn numbers(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    let py = value.py();
    let array = py.import("numpy")?.call_method1("asarray", (value, "float64"));
    let array = array.map_err(|error| PyValueError::new_err(format!("{name}: {}", error.value(py))))?;
    let array = array.cast_into::<PyArrayDyn<f64>>()?;
    if array.ndim() != 1 {
        let shape = array.shape();
        return Err(PyValueError::new_err(format!("{name} has the shape {shape:?}: one dimension is needed")));
    }
    Ok(array.readonly().as_array().iter().copied().collect())
}

/// The one of `all` that is called `asked`; a message calls what is asked for `name`.
pub fn one_of<T, const N: usize>(name: &str, asked: &str, all: [(&str, T); N]) -> PyResult<T> {
    let known = all.each_ref().map(|(known, _)| *known).join(", ");
    let found = all.into_iter().find_map(|(known, of)| (known == asked).then_some(of));
    found.ok_or_else(|| PyValueError::new_err(format!("{name} = {asked:?} is unknown; these are known: {known}")))
}

/// What runs have in common: the level called `detail`, and `initial` values by their names.
pub fn conditions(
    detail: &str,
    tolerance: f64,
    duration: Option<f64>,
    initial: Option<&Bound<'_, PyDict>>,
) -> PyResult<Conditions> {
    let detail = one_of("detail", detail, Detail::ALL.map(|of| (of.name(), of)))?;
    let mut state = State::default();
    for (name, value) in initial.into_iter().flatten() {
        let name: String = name.extract()?;
        let quantity = one_of("initial value", &name, INITIAL_VALUES.each_ref().map(|of| (of.name, of)))?;
        (quantity.set)(&mut state, number(&name, &value)?);
    }
    Ok(Conditions { initial: state, detail, tolerance, duration })
}
