//! `export`: packs the shared libraries, with all that describes them, into an FMU.

use crate::output_files::{OutputFile, OutputFiles};
use crate::structure_args::StructureArgs;
use FlexibleRocking::guid;
use anyhow::bail;
use fmu_export::Platform;
use rocking::Structure;
use rocking::parameters::PARAMETERS;
use std::collections::BTreeMap;
use std::env;
use std::io::{Write, stdout};
use std::path::{Path, PathBuf};

/// File name of the shared library as cargo builds it.
const LIBRARY_FILE: &str = "libFlexibleRocking.so";

/// What to export.
#[derive(clap::Args)]
pub struct ExportArgs {
    #[command(flatten)]
    structure: StructureArgs,
    /// Ground motion records to pack: PEER .AT2, or .csv/.txt with lines of time (s) and acceleration (m/s2); the FMU
    /// follows the first, and the others by their names
    #[arg(long, value_name = "FILE", num_args = 1..)]
    record: Vec<PathBuf>,
    /// Archive to write; one that is there is replaced
    #[arg(short, long, value_name = "FILE.fmu", default_value = "FlexibleRocking.fmu")]
    output: PathBuf,
    /// Shared library to pack [default: libFlexibleRocking.so, built with this program]
    #[arg(long, value_name = "PATH")]
    library: Option<PathBuf>,
    /// Library for 64-bit Windows to pack as well: FlexibleRocking.dll, cross-compiled from the same sources
    #[arg(long, value_name = "PATH")]
    windows_library: Option<PathBuf>,
}

/// Writes the FMU and prints what was written.
pub fn run(args: &ExportArgs) -> anyhow::Result<()> {
    let structure = args.structure.load()?;
    let library = match &args.library {
        Some(path) => path.clone(),
        None => library_of(&env::current_exe()?)?,
    };
    let mut libraries = BTreeMap::from([(Platform::Linux64, library)]);
    libraries.extend(args.windows_library.clone().map(|path| (Platform::Windows64, path)));
    let inputs =
        args.structure.input().into_iter().chain(args.record.iter().chain(libraries.values()).map(PathBuf::as_path));
    let mut file = OutputFiles::of_inputs(inputs).create(&args.output)?;
    let (contents, archive) = fmu_export::export(&structure, &args.record, &libraries)?;
    OutputFile::named(&args.output, file.write_all(&archive))?;
    file.finish()?;
    let mut out = stdout().lock();
    writeln!(out, "{}: {} kB", args.output.display(), archive.len().div_ceil(1000))?;
    writeln!(out, "  GUID       {}", guid(&contents))?;
    writeln!(out, "  structure  {}", start_values(&structure))?;
    for packed in &contents.records {
        writeln!(out, "  record     {}", packed.file)?;
    }
    Ok(())
}

/// The shared library that was built with `executable`. Cargo makes it in the folder `deps` beside the program, and
/// links it to where the program is only if the package of the FMU was asked for as well: by `cargo build` and
/// `cargo run` in the root, but not with `-p rocking-cli`. Once installed elsewhere, the two are side by side.
fn library_of(executable: &Path) -> anyhow::Result<PathBuf> {
    let paths = [executable.with_file_name("deps").join(LIBRARY_FILE), executable.with_file_name(LIBRARY_FILE)];
    let [in_deps, beside] = &paths;
    match paths.iter().find(|path| path.exists()) {
        Some(path) => Ok(path.clone()),
        None => bail!(
            "there is neither {} nor {}: build it with `cargo build --release`, or say where it is with --library PATH",
            beside.display(),
            in_deps.display()
        ),
    }
}

/// The structure's parameters in one line.
fn start_values(structure: &Structure) -> String {
    let values = PARAMETERS.iter().map(|parameter| {
        let value = (parameter.get)(structure.parameters());
        if parameter.unit == "1" {
            format!("{} = {value}", parameter.name)
        } else {
            format!("{} = {value} {}", parameter.name, parameter.unit)
        }
    });
    values.collect::<Vec<_>>().join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn the_library_is_where_cargo_makes_it_or_beside_the_program() {
        let folder = tempfile::tempdir().unwrap();
        let [executable, beside, deps] = ["rocking-fmu", LIBRARY_FILE, "deps"].map(|name| folder.path().join(name));
        let in_deps = deps.join(LIBRARY_FILE);
        assert_eq!(
            library_of(&executable).unwrap_err().to_string(),
            format!(
                "there is neither {} nor {}: build it with `cargo build --release`, or say where it is with \
                 --library PATH",
                beside.display(),
                in_deps.display()
            )
        );
        fs::create_dir(&deps).unwrap();
        fs::write(&beside, "").unwrap();
        assert_eq!(library_of(&executable).unwrap(), beside);
        fs::write(&in_deps, "").unwrap();
        assert_eq!(library_of(&executable).unwrap(), in_deps);
    }
}
