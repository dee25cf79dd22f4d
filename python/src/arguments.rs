//! Arguments of Python, and their errors with name, value and limit in the words of the library.

use anyhow::anyhow;
use numpy::{PyArray1, PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::call::PyCallArgs;
use pyo3::exceptions::{PyUserWarning, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyDict, PyFloat, PyInt, PyList, PyTuple};
use rocking::mechanics::state::INITIAL_VALUES;
use rocking::names::unknown;
use rocking::{Detail, Quantity, State};
use rocking_sweep::plan::Conditions;
use std::ffi::CString;
use std::io;

/// Returns the `ValueError` of these words.
macro_rules! reject {
    ($($text:tt)*) => { return Err(pyo3::exceptions::PyValueError::new_err(format!($($text)*))) };
}
pub(crate) use reject;

const BOOLS: &str = "these are bools: numbers are needed";

/// The `ValueError` that says why, or, if a file cannot be opened, what Python raises then.
pub fn refused(error: impl Into<anyhow::Error>) -> PyErr {
    let error = error.into();
    let message = rocking_report::message(&error);
    let kind = error.chain().find_map(|cause| cause.downcast_ref::<io::Error>()).map(io::Error::kind);
    match kind.filter(|kind| matches!(kind, io::ErrorKind::NotFound | io::ErrorKind::PermissionDenied)) {
        Some(kind) => io::Error::new(kind, message).into(),
        None => PyValueError::new_err(message),
    }
}

/// The number `value`, which messages call `name`: a float, an int, or a scalar of numpy.
pub fn number(name: &str, value: &Bound<'_, PyAny>) -> PyResult<f64> {
    if value.is_exact_instance_of::<PyFloat>() || value.is_exact_instance_of::<PyInt>() {
        return value.extract();
    }
    let array = array(name, value).ok().filter(|array| array.ndim() == 0);
    let numbers = array.and_then(|array| array.to_vec().ok());
    numbers.map(|of| of[0]).ok_or_else(|| PyValueError::new_err(format!("{name} = {value:?}: it is no number")))
}

pub fn integer(name: &str, value: &Bound<'_, PyAny>) -> PyResult<i64> {
    value.extract().map_err(|_| PyValueError::new_err(format!("{name} = {value:?}: a whole number is needed")))
}

/// Readers of an argument of their name, whose messages have that name.
pub mod argument {
    use super::{Bound, Detail, PyAny, PyResult, integer, number, one_of};

    macro_rules! numbers {
        ($($name:ident)*) => {$(
            pub fn $name(value: &Bound<'_, PyAny>) -> PyResult<f64> {
                number(stringify!($name), value)
            }
        )*};
    }
    pub fn floor(value: &Bound<'_, PyAny>) -> PyResult<i64> {
        integer("floor", value)
    }

    numbers!(amplification amplitude error frequency g phase scale time_scale tolerance within zeta);

    pub fn detail(value: &Bound<'_, PyAny>) -> PyResult<Detail> {
        one_of("detail", value, Detail::ALL.map(|of| (of.name(), of)))
    }
}

/// The numbers of an array of one dimension, or one number, which messages call `name`.
pub fn numbers(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Vec<f64>> {
    let array = array(name, value)?;
    if array.ndim() > 1 {
        reject!("{name} has the shape {:?}: one dimension is needed", array.shape());
    }
    array.to_vec().map_err(refused)
}

/// The rows of an array of two dimensions, which messages call `name`.
pub fn matrix(name: &str, value: &Bound<'_, PyAny>) -> PyResult<Vec<Vec<f64>>> {
    let array = array(name, value)?;
    let &[_, columns] = array.shape() else {
        reject!("{name} has the shape {:?}: two dimensions are needed", array.shape());
    };
    Ok(array.to_vec().map_err(refused)?.chunks(columns.max(1)).map(<[f64]>::to_vec).collect())
}

/// The array that numpy makes of `value`, contiguous and aligned: the one place where arrays enter. The function refuses all but
/// plain numbers, because numpy would convert the rest into wrong numbers.
fn array<'py>(name: &str, value: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArrayDyn<f64>>> {
    let refused = |why: &str| PyValueError::new_err(format!("{name}: {why}"));
    let py = value.py();
    let numpy = py.import("numpy")?;
    if numpy.getattr("ma")?.call_method1("is_masked", (value,))?.is_truthy()? {
        return Err(refused("some of it is masked: leave that out, as by .compressed(), or fill it, as by .filled(0)"));
    }
    let bools = (py.get_type::<PyBool>(), numpy.getattr("bool_")?).into_pyobject(py)?;
    let read = |of: &Bound<'py, PyAny>| -> PyResult<(Bound<'py, PyAny>, String)> {
        // numpy makes 1 of True beside other numbers
        let mut items = of.cast::<PyList>().into_iter().flatten();
        if items.any(|item| item.is_instance(&bools).is_ok_and(|is_bool| is_bool)) {
            return Err(refused(BOOLS));
        }
        let array = numpy.call_method1("asarray", (of,));
        let array = array.map_err(|error| refused(&error.value(py).to_string()))?;
        let kind = array.getattr("dtype")?.getattr("kind")?.extract()?;
        Ok((array, kind))
    };
    let listed = value.cast::<PyTuple>().map(|values| values.to_list().into_any());
    let (mut array, mut kind) = read(listed.as_ref().unwrap_or(value))?;
    if kind == "O" {
        (array, kind) = read(&array.call_method0("tolist")?)?; // of a table that has columns of other types, too
    }
    match kind.as_str() {
        "f" | "i" | "u" => Ok(numpy.call_method1("require", (array, "float64", "CA"))?.cast_into()?),
        "M" => Err(refused("these are dates: numbers are needed, such as the seconds since the first")),
        "m" => Err(refused("these are durations: numbers are needed, in s, as by / numpy.timedelta64(1, 's')")),
        "b" => Err(refused(BOOLS)),
        "c" => Err(refused("these are complex: real numbers are needed")),
        _ => Err(refused("numbers are needed, not text or other objects")),
    }
}

/// Gives a Python warning for each of `sentences`, at the line of Python that is `above` levels up.
pub fn warn(py: Python<'_>, sentences: impl IntoIterator<Item = String>, above: i32) -> PyResult<()> {
    let warn = |of: String| PyErr::warn(py, &py.get_type::<PyUserWarning>(), &CString::new(of)?, above);
    sentences.into_iter().try_for_each(warn)
}

/// An object of the class `name` of `_results.py`, made of `parts`.
pub fn result<'py>(py: Python<'py>, name: &str, parts: impl PyCallArgs<'py>) -> PyResult<Bound<'py, PyAny>> {
    py.import("flexible_rocking._results")?.call_method1(name, parts)
}

/// A Response of columns, each with its name and its unit.
pub fn response<'py, const N: usize>(
    py: Python<'py>,
    columns: [(&str, &str, Vec<f64>); N],
) -> PyResult<Bound<'py, PyAny>> {
    let (named, units) = (PyDict::new(py), PyDict::new(py));
    for (name, unit, column) in columns {
        named.set_item(name, PyArray1::from_vec(py, column))?;
        units.set_item(name, unit)?;
    }
    result(py, "Response", (named, units))
}

/// The one of `all` that `asked` names; a message calls the argument `name`.
pub fn one_of<'n, T>(name: &str, asked: &Bound<'_, PyAny>, all: impl IntoIterator<Item = (&'n str, T)>) -> PyResult<T> {
    let asked = asked.str()?.to_string();
    let (known, all): (Vec<_>, Vec<_>) = all.into_iter().unzip();
    let found = known.iter().zip(all).find_map(|(known, of)| (*known == asked).then_some(of));
    let is_unknown = || unknown(format_args!("{name} = {asked:?} is unknown"), &asked, &known);
    found.ok_or_else(|| refused(anyhow!(is_unknown())))
}

/// The conditions that runs have in common, with `initial` values by their names.
pub fn conditions(
    detail: Detail,
    tolerance: f64,
    duration: Option<&Bound<'_, PyAny>>,
    initial: Option<&Bound<'_, PyDict>>,
) -> PyResult<Conditions> {
    let duration = duration.map(|duration| number("duration", duration)).transpose()?;
    let mut state = State::default();
    for (name, value) in initial.into_iter().flatten() {
        let known = INITIAL_VALUES.iter().map(|of| of.name).chain(["detail", "tolerance", "duration", "condition"]);
        let place = one_of("argument or initial value", &name, known.zip(0..))?;
        let Some(Quantity { name, .. }) = INITIAL_VALUES.get(place) else {
            reject!("{name} is no argument of this function: see its help");
        };
        state.set(place, if name.starts_with('u') { numbers(name, &value)? } else { vec![number(name, &value)?] });
    }
    Ok(Conditions { initial: state, detail, tolerance, duration, ..Conditions::default() })
}
