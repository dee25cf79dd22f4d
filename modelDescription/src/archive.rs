//! Archives that depend on nothing but what is in them: the same entries give the same bytes.

use crate::{ModelDescription, Version};
use fmi_unit::Model;
use std::error::Error;
use std::io::{Cursor, Write};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};
use zip::result::ZipError;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, System, ZipWriter};

/// A file of an archive.
pub struct Entry {
    /// Its path in the archive.
    pub path: String,
    /// Its content.
    pub content: Vec<u8>,
}

/// The archive of `entries`, in their order, with fixed times and permissions.
pub fn archive(entries: &[Entry]) -> Result<Vec<u8>, ZipError> {
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .last_modified_time(DateTime::DEFAULT) // 1980-01-01, the first day that an archive can express
        .system(System::Unix) // whatever it is written on
        .unix_permissions(0o644);
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    for entry in entries {
        archive.start_file(entry.path.as_str(), options)?;
        archive.write_all(&entry.content)?;
    }
    Ok(archive.finish()?.into_inner())
}

/// The folder of a library for the platform `tuple`, as FMI 3.0 names it, in an archive of `version`. FMI 2.0 has names for
/// x86 alone; since 2.0.4 it asks for the tuples of FMI 3.0 for all others.
pub fn folder(version: Version, tuple: &str) -> &str {
    match (version, tuple) {
        (Version::Fmi2, "x86_64-linux") => "linux64",
        (Version::Fmi2, "x86_64-windows") => "win64",
        (Version::Fmi2, "x86_64-darwin") => "darwin64",
        _ => tuple,
    }
}

/// Writes the FMU that `description` describes to `path`, for hosts of `version`, with the shared `library` of this
/// platform.
pub fn write_fmu(
    path: &Path,
    description: &ModelDescription,
    version: Version,
    library: &Path,
) -> Result<(), Box<dyn Error>> {
    let (architecture, system) = (env::consts::ARCH, env::consts::OS.replace("macos", "darwin"));
    let tuple = format!("{architecture}-{system}");
    let folder = folder(version, &tuple);
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder)?;
    }
    let binary = format!("binaries/{folder}/{}{}", description.name, env::consts::DLL_SUFFIX);
    let entries =
        [("modelDescription.xml".to_owned(), description.to_xml(version).into()), (binary, fs::read(library)?)];
    Ok(fs::write(path, archive(&entries.map(|(path, content)| Entry { path, content }))?)?)
}

/// Writes the FMU `name` of the `model` of an example to the path that the program is called with; a second argument, 3, asks
/// for FMI 3.0. The functions are in the example `library`, of the type `cdylib`.
pub fn write_example(name: &str, model: &dyn Model, library: &str) -> Result<(), Box<dyn Error>> {
    let arguments: Vec<_> = env::args().skip(1).collect();
    let path = arguments.first().ok_or("call it with the path of the FMU to write")?;
    let version = if arguments.get(1).is_some_and(|version| version == "3") { Version::Fmi3 } else { Version::Fmi2 };
    let (token, variables) = (model.token(), &*model.variables());
    let description = ModelDescription { name, token, variables, ..ModelDescription::default() };
    write_fmu(Path::new(path), &description, version, &example(library)?)
}

/// Builds the example `name`, of the type `cdylib`, beside the example that runs, and returns the library.
fn example(name: &str) -> Result<PathBuf, Box<dyn Error>> {
    let program = env::current_exe()?;
    let folder = program.parent().ok_or("the example is in no folder")?;
    let profile: &[_] = if cfg!(debug_assertions) { &[] } else { &["--release"] };
    let cargo = Command::new("cargo").args(["build", "--quiet", "--example", name]).args(profile).status()?;
    if !cargo.success() {
        return Err(format!("cargo cannot build the example {name}").into());
    }
    Ok(folder.join(format!("{}{name}{}", env::consts::DLL_PREFIX, env::consts::DLL_SUFFIX)))
}
