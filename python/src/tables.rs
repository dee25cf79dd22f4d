//! The tables of the file of a structure, from the keywords of Python and back.

use crate::arguments::{integer, matrix, number, numbers, refused, reject};
use anyhow::anyhow;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};
use rocking::names::unknown;
use rocking::structure::natural_quantities::{names, names_of_base};
use rocking_report::structure_file::names_of_many;
use serde::Deserialize;
use toml::{Table, Value};

/// The names of the keywords of a structure of one mass, or of many masses.
pub fn known(is_many: bool) -> Vec<String> {
    let of_one = || names().chain(["units", "ground"]).map(str::to_owned).collect();
    if is_many { names_of_many().into_iter().chain(names_of_base().map(str::to_owned)).collect() } else { of_one() }
}

/// The keywords that are given. The message names an unknown one, whatever its value is.
pub fn keywords(given: &Bound<'_, PyDict>, is_many: bool) -> PyResult<Table> {
    let known = known(is_many);
    if let Some(name) = given.keys().extract::<Vec<String>>()?.into_iter().find(|name| !known.contains(name)) {
        return Err(refused(anyhow!(unknown(format_args!("{name:?} is unknown"), &name, &known))));
    }
    entries("", given)
}

/// The keywords of many masses as tables, the numbers of the base in one of their own.
pub fn with_base(mut keywords: Table) -> Table {
    let of_base = Vec::from_iter(names_of_base().filter_map(|name| Some((name.to_owned(), keywords.remove(name)?))));
    let base = keywords.entry("base").or_insert_with(|| Table::new().into());
    if let Some(base) = base.as_table_mut() {
        for (name, number) in of_base {
            base.entry(name).or_insert(number);
        }
    }
    keywords
}

fn entries(path: &str, of: &Bound<'_, PyDict>) -> PyResult<Table> {
    let entry = |(name, of): (Bound<'_, PyAny>, Bound<'_, PyAny>)| {
        let name = name.extract::<String>()?;
        let path = if path.is_empty() { name.clone() } else { format!("{path}.{name}") };
        let value = value(&path, &name, &of)?;
        Ok((name, value))
    };
    of.iter().filter(|(_, of)| !of.is_none()).map(entry).collect()
}

/// What `of` is as the entry called `name` of a table; messages say where it is by its `path`.
fn value(path: &str, name: &str, of: &Bound<'_, PyAny>) -> PyResult<Value> {
    if let Ok(of) = of.cast::<PyDict>() {
        return Ok(entries(path, of)?.into());
    }
    let needed = |needed: &str| PyValueError::new_err(format!("{path} = {of:?}: {needed} is needed"));
    let has_items = of.len().is_ok() && !of.is_instance_of::<PyString>();
    Ok(match name {
        "units" => of.str()?.to_string().into(),
        "p_delta" => of.extract::<bool>().map_err(|_| needed("True or False"))?.into(),
        "keep" => integer(path, of)?.into(),
        "ground" => return Err(needed("flexible_rocking.Ground(f_v=...)")),
        "K" => Value::try_from(matrix(path, of)?).map_err(refused)?,
        "storeys" | "floors" | "modes" if has_items => {
            let is_frame = of.hasattr("to_dict")?;
            let rows = if is_frame { of.call_method1("to_dict", ("records",))? } else { of.clone() };
            let row = |(i, row): (usize, PyResult<_>)| value(&format!("{path}[{i}]"), "", &row?);
            (1..).zip(rows.try_iter()?).map(row).collect::<PyResult<Vec<_>>>()?.into()
        }
        _ if has_items && !names().any(|known| known == name) => numbers(path, of)?.into(),
        _ => number(path, of)?.into(),
    })
}

/// A table for each row of columns of numbers, each with the key of its entries, its name in messages and, if it is given, its numbers. The
/// rows are called `of`.
pub fn rows(columns: &[(&str, &str, Option<Bound<'_, PyAny>>)], of: &str) -> PyResult<Vec<Table>> {
    let mut rows = Vec::new();
    for (key, name, column) in columns {
        let Some(column) = column else { continue };
        let column = numbers(name, column)?;
        rows.resize(if rows.is_empty() { column.len() } else { rows.len() }, Table::new());
        if column.len() != rows.len() {
            reject!("{name} has {} numbers and must have {}, one for each {of}", column.len(), rows.len());
        }
        rows.iter_mut().zip(column).for_each(|(row, number)| drop(row.insert((*key).to_owned(), number.into())));
    }
    Ok(rows)
}

pub fn dict<'py>(py: Python<'py>, table: &Table) -> PyResult<Bound<'py, PyDict>> {
    let text = serde_json::to_string(table).map_err(refused)?; // which keeps every bit
    Ok(py.import("json")?.call_method1("loads", (text,))?.cast_into()?)
}

/// Refuses what is no ground that gives, where it is written.
#[pyfunction]
pub fn check_ground(numbers: &Bound<'_, PyDict>) -> PyResult<()> {
    rocking::Ground::deserialize(entries("ground", numbers)?).map(drop).map_err(refused)
}
