//! The Python module: the same crates as the command line's, as Python's objects. What is computed, the library computes; here
//! arguments are read, and results are given the form that Python has for them.
#![allow(non_snake_case)] // H, B, J0: the paper's own letters

mod advice;
mod arguments;
mod record;
mod run;
mod structure;
mod sweep;

use pyo3::prelude::*;

/// The engine of `flexible_rocking`, which has what is here under its own names.
#[pymodule]
mod _native {
    #[pymodule_export]
    use super::advice::{Advice, advise, estimate};
    #[pymodule_export]
    use super::record::{Record, pulse};
    #[pymodule_export]
    use super::run::{Peak, Run, Transition, Worst, simulate};
    #[pymodule_export]
    use super::structure::Structure;
    #[pymodule_export]
    use super::sweep::{Curve, fragility, intensity_measures, measure_of, sweep};
    #[pymodule_export]
    use super::{command_line, export};
}

/// What the command line `rocking-fmu` does with `arguments`, the first of which is its name: its exit code. `program` is the
/// path of the console script, beside whose folder the archive with the libraries is.
#[pyfunction]
fn command_line(py: Python<'_>, program: std::path::PathBuf, arguments: Vec<std::ffi::OsString>) -> u8 {
    py.detach(|| rocking_cli::main(program, arguments))
}

/// Writes the FMU to `target`: of `structure`, with the files of `records` inside, of which it follows the first.
#[pyfunction]
fn export(
    py: Python<'_>,
    target: std::path::PathBuf,
    structure: &structure::Structure,
    records: Vec<std::path::PathBuf>,
    name: &str,
    fmi: u32,
    library: std::path::PathBuf,
) -> PyResult<()> {
    use fmu_export::{Library, ModelName, Version};
    let version = arguments::one_of("fmi", &fmi.to_string(), [("2", Version::Fmi2), ("3", Version::Fmi3)])?;
    let written = py.detach(|| -> anyhow::Result<()> {
        let libraries = Library::read(&library)?;
        let name: ModelName = name.parse()?;
        let (_, archive) = fmu_export::export(version, &name, &structure.0, &records, &libraries)?;
        Ok(std::fs::write(target, archive)?)
    });
    written.map_err(arguments::refused)
}
