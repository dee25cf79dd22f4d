//! The Python module: the same crates as the command line's, as Python's objects. What is computed, the library
//! computes; here arguments are read, and results are given the form that Python has for them.
#![allow(non_snake_case)] // H, B, J0: the paper's own letters

mod advice;
mod arguments;
mod record;
mod run;
mod structure;
mod sweep;

use arguments::{one_of, refused};
use fmu_export::{Library, Version};
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use rocking_cli::output_files::OutputFiles;
use rocking_records::{csv, vertical_csv};
use std::ffi::OsString;
use std::path::PathBuf;

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

/// What the command line `rocking-fmu` does with `arguments`, the first of which is its name: its exit code. `program`
/// is the path of the console script, beside whose folder the archive with the libraries is.
#[pyfunction]
fn command_line(py: Python<'_>, program: PathBuf, arguments: Vec<OsString>) -> u8 {
    py.detach(|| rocking_cli::main(program, arguments))
}

/// A ground motion to pack: a record, under its title, or a file.
#[derive(FromPyObject)]
enum Packed {
    Record(Py<record::Record>),
    File(PathBuf),
}

/// Writes the FMU to `target`: of `structure`, with `records` inside, of which it follows the first, with its vertical component.
#[pyfunction]
fn export(
    py: Python<'_>,
    target: PathBuf,
    structure: &structure::Structure,
    records: Vec<Packed>,
    name: &str,
    fmi: u32,
    library: PathBuf,
) -> PyResult<()> {
    let version = one_of("fmi", &fmi.to_string(), [("2", Version::Fmi2), ("3", Version::Fmi3)])?;
    let name_of = |record: &record::Record, ending: &str| {
        let is_plain = |letter: char| letter.is_alphanumeric() || letter == '-';
        PathBuf::from(record.0.title().replace(|letter| !is_plain(letter), "_") + ending)
    };
    let content = |packed: &Packed| match packed {
        Packed::Record(record) => Ok((name_of(record.get(), ".csv"), csv(&record.get().0).into_bytes())),
        Packed::File(path) => Ok((path.clone(), rocking_records::read_file(path)?)),
    };
    let vertical = |packed: &Packed| match packed {
        Packed::Record(record) => {
            vertical_csv(&record.get().0).map(|table| (name_of(record.get(), "_v.csv"), table.into_bytes()))
        }
        Packed::File(_) => None,
    };
    if let Some(other) = records.iter().skip(1).position(|record| vertical(record).is_some()) {
        let needed = "the FMU follows the first alone, and no other may have a vertical component";
        return Err(PyValueError::new_err(format!("record {}: {needed}", other + 2)));
    }
    let written = py.detach(|| -> anyhow::Result<()> {
        let mut files = OutputFiles::of_inputs([library.as_path()]);
        for packed in &records {
            if let Packed::File(path) = packed {
                files.add_input(path);
            }
        }
        let target = files.create(&target)?;
        let vertical = records.first().and_then(vertical);
        let records = records.iter().map(content).collect::<Result<_, rocking_records::RecordError>>()?;
        let (libraries, name) = (Library::read(&library)?, name.parse()?);
        let (_, archive) = fmu_export::export(version, &name, &structure.0, records, vertical, &libraries)?;
        target.write(&archive)
    });
    written.map_err(refused)
}
