//! The Python module: the same crates as the command line's, as Python's objects. The library computes; this crate reads
//! arguments and gives results their form in Python.
#![expect(clippy::too_many_arguments, reason = "keywords of Python")]

mod advice;
mod arguments;
mod interruptible;
mod record;
mod run;
mod structure;
mod sweep;
mod tables;

use arguments::{one_of, refused, reject, warn};
use fmu_export::{Contents, Library, Version};
use interruptible::interruptible;
use pyo3::prelude::*;
use rocking_records::Reading;
use rocking_report::output_files::OutputFiles;
use rocking_report::record::understand;
use std::path::PathBuf;

/// The engine of `flexible_rocking`, which has what is here under its own names.
#[pymodule]
mod _native {
    #[pymodule_export]
    use super::{
        advice::{advise, estimate},
        export,
        record::{PyRecord, pulse},
        run::{PyRun, simulate},
        structure::{PyStructure, numbers_of, varied},
        sweep::{PyCurve, columns_of, design, exceeds, fragility, heading_of, overturning_map, sweep},
        tables::check_ground,
    };

    #[pymodule_export]
    #[expect(non_upper_case_globals, reason = "as Python has it")]
    const __version__: &str = env!("CARGO_PKG_VERSION");
}

/// A ground motion to pack: a record, under its title, or a file.
enum ToPack {
    Record(Py<record::PyRecord>),
    File(PathBuf),
}

impl<'a, 'py> FromPyObject<'a, 'py> for ToPack {
    type Error = PyErr;

    fn extract(value: Borrowed<'a, 'py, PyAny>) -> PyResult<ToPack> {
        match value.cast::<record::PyRecord>() {
            Ok(of) => Ok(ToPack::Record(of.to_owned().unbind())),
            Err(_) => value.extract().map(ToPack::File).map_err(|_| record::no_record(&value)),
        }
    }
}

/// Writes the FMU to `target`: of `structure`, with `records` inside, of which it follows the first, with its vertical component.
#[pyfunction]
fn export(
    py: Python<'_>,
    target: PathBuf,
    structure: &structure::PyStructure,
    records: Vec<ToPack>,
    name: String,
    fmi: &Bound<'_, PyAny>,
    library: PathBuf,
    strings: bool,
) -> PyResult<()> {
    let structure = structure.of.clone();
    let version = one_of("fmi", fmi, [("2", Version::Fmi2), ("3", Version::Fmi3)])?;
    let mut files = OutputFiles::of_inputs([library.as_path()]);
    for packed in &records {
        if let ToPack::File(path) = packed {
            files.add_input(path);
        }
    }
    let file = files.create(&target).map_err(refused)?;
    fmu_export::check_target(&target).map_err(refused)?;
    let is_plain = |letter: char| letter.is_alphanumeric() || letter == '-';
    // the file, or the tables of the record, the vertical component last
    let contents = |packed: &ToPack| -> PyResult<Vec<(PathBuf, Vec<u8>)>> {
        let path = match packed {
            ToPack::Record(record) => {
                let tables = record.get().tables().map_err(refused)?;
                let name = record.get().title().replace(|letter| !is_plain(letter), "_");
                let files = ["", "_v"].map(|ending| PathBuf::from(format!("{name}{ending}.csv")));
                return Ok(files.into_iter().zip(tables.into_iter().map(String::into_bytes)).collect());
            }
            ToPack::File(path) => path,
        };
        let understood = understand(path, &Reading::default(), [1.0; 2], structure.base().g, str::to_owned);
        warn(py, understood.map_err(refused)?.sentences[1..].to_vec(), 2)?;
        Ok(vec![(path.clone(), rocking_records::read_file(path).map_err(refused)?)])
    };
    let mut records: Vec<_> = records.iter().map(contents).collect::<PyResult<_>>()?;
    if let Some(other) = records.iter().skip(1).position(|record| record.len() > 1) {
        let needed = "the FMU follows the first alone, and no other may have a vertical component";
        reject!("record {}: {needed}", other + 2);
    }
    let vertical = records.first_mut().filter(|first| first.len() > 1).and_then(Vec::pop);
    interruptible(py, move |_| -> anyhow::Result<()> {
        let (libraries, name) = (Library::read(&library)?, name.parse()?);
        let records = records.into_iter().flatten().collect();
        let contents = Contents { fixed: !strings, ..structure.into() };
        let (_, archive) = fmu_export::export(version, &name, contents, records, vertical, &libraries)?;
        file.write(&archive)
    })
}
