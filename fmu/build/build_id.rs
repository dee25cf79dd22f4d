//! Names the build: a GUID over every source that the library and the model description are made from, so that a
//! library refuses a model description that was not written for it.

use std::path::{Path, PathBuf};
use std::{fs, io};
use uuid::Uuid;

/// Relative to the workspace.
const SOURCES: [&str; 8] = [
    "Cargo.lock",
    "Cargo.toml",
    "fmu/Cargo.toml",
    "fmu/build",
    "fmu/src",
    "modelDescription/Cargo.toml",
    "modelDescription/src",
    "src",
];

/// The GUID of the sources in `workspace`, which are watched from now on.
pub fn build_id(workspace: &Path) -> io::Result<String> {
    let mut files = Vec::new();
    for source in SOURCES {
        println!("cargo::rerun-if-changed=../{source}");
        collect(workspace, Path::new(source), &mut files)?;
    }
    files.sort();
    let mut content = Vec::new();
    for file in files {
        let bytes = fs::read(workspace.join(&file))?;
        content.extend(format!("{} {}\n", file.display(), bytes.len()).into_bytes());
        content.extend(bytes);
    }
    Ok(Uuid::new_v5(&Uuid::NAMESPACE_OID, &content).braced().to_string())
}

/// Appends `path` (relative to `workspace`), or all files under it.
fn collect(workspace: &Path, path: &Path, files: &mut Vec<PathBuf>) -> io::Result<()> {
    if !workspace.join(path).is_dir() {
        files.push(path.to_owned());
        return Ok(());
    }
    for entry in fs::read_dir(workspace.join(path))? {
        collect(workspace, &path.join(entry?.file_name()), files)?;
    }
    Ok(())
}
