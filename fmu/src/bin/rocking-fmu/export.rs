//! `export`: packs the shared libraries, with all that describes them, into an FMU.

mod documentation;
mod model_description;

use crate::archive::{self, Entry};
use crate::structure_args::StructureArgs;
use FlexibleRocking::resources::PARAMETERS_FILE;
use FlexibleRocking::{BUILD, guid};
use anyhow::{Context, bail};
use rocking::Structure;
use rocking::parameters::PARAMETERS;
use std::io::{self, Write, stdout};
use std::path::{Path, PathBuf};
use std::{env, fs};

/// File name of the shared library as cargo builds it.
const LIBRARY_FILE: &str = "libFlexibleRocking.so";

/// Licences of all that the shared library is made of.
const LICENSES: &str = include_str!(concat!(env!("OUT_DIR"), "/license.txt"));

/// A platform for which an archive can have a shared library.
struct Platform {
    name: &'static str,
    /// What its shared libraries begin with.
    magic: &'static [u8],
    /// How to get ours.
    remedy: &'static str,
}

const LINUX: Platform = Platform {
    name: "Linux",
    magic: b"\x7fELF",
    remedy: "build it with `cargo build --release`, or say where it is with --library PATH",
};

const WINDOWS: Platform = Platform { name: "Windows", magic: b"MZ", remedy: "`make dist` builds it" };

const ICON: &[u8] = include_bytes!("../../../resources/model.png");

/// What to export.
#[derive(clap::Args)]
pub struct ExportArgs {
    #[command(flatten)]
    structure: StructureArgs,
    /// Archive to write; one that is there is replaced
    #[arg(short, long, value_name = "FILE.fmu", default_value = "FlexibleRocking.fmu")]
    output: PathBuf,
    /// Shared library to pack [default: libFlexibleRocking.so beside this program]
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
        Some(path) => read_library(path, &LINUX)?,
        None => read_library(&library_of(&env::current_exe()?), &LINUX)?,
    };
    let windows_library = args.windows_library.as_deref().map(|path| read_library(path, &WINDOWS));
    let windows_library = windows_library.transpose()?;
    let size = archive::write(&args.output, &entries(&structure, library, windows_library)?)?;
    let mut out = stdout().lock();
    writeln!(out, "{}: {} kB", args.output.display(), size.div_ceil(1000))?;
    writeln!(out, "  GUID       {}", guid(structure.parameters()))?;
    writeln!(out, "  structure  {}", start_values(&structure))?;
    Ok(())
}

/// The shared library that was built with `executable`: beside it, where `cargo build` leaves it, or in the folder
/// `deps` there. `cargo run` brings only the latter up to date.
fn library_of(executable: &Path) -> PathBuf {
    let in_deps = executable.with_file_name("deps").join(LIBRARY_FILE);
    if in_deps.exists() { in_deps } else { executable.with_file_name(LIBRARY_FILE) }
}

/// The shared library at `path`, if it is there, for `platform` and of this build.
fn read_library(path: &Path, platform: &Platform) -> anyhow::Result<Vec<u8>> {
    let &Platform { name, magic, remedy } = platform;
    let library = match fs::read(path) {
        Err(error) if error.kind() == io::ErrorKind::NotFound => {
            bail!("the shared library {} does not exist: {remedy}", path.display())
        }
        result => result.with_context(|| format!("cannot read the shared library {}", path.display()))?,
    };
    if !library.starts_with(magic) {
        bail!("{} is not a shared library for {name}: {remedy}", path.display());
    }
    if !library.windows(BUILD.len()).any(|bytes| bytes == BUILD.as_bytes()) {
        bail!(
            "the shared library {} is of another build: the name of this one, {BUILD}, does not occur in it; {remedy}",
            path.display()
        );
    }
    Ok(library)
}

/// The content of the archive.
fn entries(structure: &Structure, library: Vec<u8>, windows_library: Option<Vec<u8>>) -> anyhow::Result<Vec<Entry>> {
    let parameters = structure.parameters();
    let entry = |path: &str, content| Entry { path: path.to_owned(), content };
    let mut entries = vec![
        entry("modelDescription.xml", model_description::model_description(parameters).to_xml()?.into()),
        entry("model.png", ICON.to_vec()),
        entry("binaries/linux64/FlexibleRocking.so", library),
        entry("documentation/index.html", documentation::documentation(structure)?.into()),
        entry("documentation/licenses/license.txt", LICENSES.into()),
        entry(&format!("resources/{PARAMETERS_FILE}"), toml::to_string(parameters)?.into()),
    ];
    entries.extend(windows_library.map(|library| entry("binaries/win64/FlexibleRocking.dll", library)));
    Ok(entries)
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
    use clap::Parser;
    use rocking::Parameters;

    #[derive(Parser)]
    struct Command {
        #[command(flatten)]
        export: ExportArgs,
    }

    fn export(arguments: &[&str]) -> anyhow::Result<()> {
        run(&Command::parse_from(["export"].iter().chain(arguments)).export)
    }

    /// A file that passes for the library of this build.
    fn library(folder: &Path) -> PathBuf {
        let path = folder.join(LIBRARY_FILE);
        fs::write(&path, format!("\x7fELF, some code{BUILD}more code")).unwrap();
        path
    }

    #[test]
    fn two_exports_of_the_same_are_the_same_bytes() {
        let folder = tempfile::tempdir().unwrap();
        let library = library(folder.path());
        let exported = |preset: &str, name: &str| {
            let target = folder.path().join(name);
            let [library, output] = [&library, &target].map(|path| path.to_str().unwrap());
            export(&["--preset", preset, "--library", library, "-o", output]).unwrap();
            fs::read(target).unwrap()
        };
        let first = exported("evison", "first.fmu");
        assert_eq!(first, exported("evison", "second.fmu"));
        assert_ne!(first, exported("mcmanus", "third.fmu"));
    }

    #[test]
    fn the_archive_holds_what_the_standard_and_the_library_look_for() {
        let windows = Some(b"Windows code".to_vec());
        let entries = entries(&Structure::new(Parameters::EVISON).unwrap(), b"code".to_vec(), windows).unwrap();
        let paths: Vec<_> = entries.iter().map(|entry| entry.path.as_str()).collect();
        let expected = [
            "modelDescription.xml",
            "model.png",
            "binaries/linux64/FlexibleRocking.so",
            "documentation/index.html",
            "documentation/licenses/license.txt",
            "resources/parameters.toml",
            "binaries/win64/FlexibleRocking.dll",
        ];
        assert_eq!(paths, expected);
        assert_eq!(entries[1].content[..8], *b"\x89PNG\r\n\x1a\n");
        assert_eq!(entries[2].content, b"code");
        let parameters: Parameters = toml::from_slice(&entries[5].content).unwrap();
        assert_eq!(parameters, Parameters::EVISON);
        assert_eq!(entries[6].content, b"Windows code");
    }

    /// Every package that the library needs, none that only the program does, and the texts that go with them.
    #[test]
    fn the_licenses_are_those_of_the_library() {
        let (list, texts) = LICENSES.split_once("====").unwrap();
        for package in ["rocking", "nalgebra", "postcard", "serde", "toml"] {
            assert!(list.contains(&format!("  {package} v")), "{package}");
            assert!(texts.contains(&format!("{package} v")), "{package}");
        }
        for package in ["clap", "zip", "thiserror-impl", "cargo_metadata", "proptest"] {
            assert!(!list.contains(&format!("  {package} v")), "{package}");
        }
        for words in
            ["Permission is hereby granted, free of charge", "Apache License\n", "the FlexibleRocking contributors"]
        {
            assert!(texts.contains(words), "{words}");
        }
        for line in list.lines().filter(|line| line.starts_with("  ")) {
            let package = line.trim().split(':').next().unwrap();
            assert!(texts.contains(package), "the text of {line} is missing");
        }
    }

    #[test]
    fn the_library_is_beside_the_program_unless_cargo_run_has_just_built_it() {
        let folder = tempfile::tempdir().unwrap();
        let executable = folder.path().join("rocking-fmu");
        let beside = library(folder.path());
        assert_eq!(library_of(&executable), beside);
        let deps = folder.path().join("deps");
        fs::create_dir(&deps).unwrap();
        assert_eq!(library_of(&executable), beside);
        let in_deps = library(&deps);
        assert_eq!(library_of(&executable), in_deps);
    }

    #[test]
    fn a_missing_library_is_refused_with_what_to_do() {
        let refusal = |arguments: &[&str]| export(arguments).unwrap_err().to_string();
        assert_eq!(
            refusal(&["--library", "/nowhere/libFlexibleRocking.so"]),
            "the shared library /nowhere/libFlexibleRocking.so does not exist: build it with `cargo build --release`, \
             or say where it is with --library PATH"
        );
        let folder = tempfile::tempdir().unwrap();
        let library = library(folder.path());
        assert_eq!(
            refusal(&["--library", library.to_str().unwrap(), "--windows-library", "/nowhere/FlexibleRocking.dll"]),
            "the shared library /nowhere/FlexibleRocking.dll does not exist: `make dist` builds it"
        );
    }

    #[test]
    fn a_library_for_another_platform_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let library = library(folder.path());
        let path = library.to_str().unwrap();
        assert_eq!(
            export(&["--library", path, "--windows-library", path]).unwrap_err().to_string(),
            format!("{path} is not a shared library for Windows: `make dist` builds it")
        );
    }

    #[test]
    fn a_library_of_another_build_is_refused_and_nothing_is_written() {
        let folder = tempfile::tempdir().unwrap();
        let library = library(folder.path());
        let other = fs::read_to_string(&library).unwrap().replace(BUILD, "{00000000-0000-5000-8000-000000000000}");
        fs::write(&library, other).unwrap();
        let target = folder.path().join("FlexibleRocking.fmu");
        let [path, output] = [&library, &target].map(|path| path.to_str().unwrap());
        let message = export(&["--library", path, "--output", output]).unwrap_err().to_string();
        let start =
            format!("the shared library {path} is of another build: the name of this one, {BUILD}, does not occur");
        assert!(message.starts_with(&start), "{message}");
        assert!(!target.exists());
    }
}
