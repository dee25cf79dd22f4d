//! Writes the FMU (FMI 2.0) of a specimen of the paper: `specimen LIBRARY (evison | mcmanus) FILE.fmu`. It is built in half the time
//! of `rocking-fmu`, whose `export` writes the same bytes.

use fmu_export::{Library, ModelName, Version, export};
use rocking::{Parameters, Structure};
use std::error::Error;
use std::path::Path;
use std::{env, fs};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments = Vec::from_iter(env::args().skip(1));
    let [library, specimen, output] = &arguments[..] else {
        return Err("call it as specimen LIBRARY (evison | mcmanus) FILE.fmu".into());
    };
    let structure = Structure::new(Parameters::preset(specimen)?)?;
    let libraries = Library::read(Path::new(library))?;
    let (_, archive) = export(Version::Fmi2, &ModelName::default(), structure.into(), Vec::new(), None, &libraries)?;
    Ok(fs::write(output, archive)?)
}
