//! Gives the library the name of its build.

use std::error::Error;
use std::path::Path;
use std::{fs, io};
use uuid::Uuid;

/// The lock file, and the folders with the sources of the library, from the folder of this package.
pub const CONTENT: [&str; 5] = ["../Cargo.lock", "../src", "../records/src", "fmi/src", "src"];

fn main() -> Result<(), Box<dyn Error>> {
    for path in CONTENT {
        println!("cargo::rerun-if-changed={path}");
    }
    println!("cargo::rustc-env=FLEXIBLE_ROCKING_BUILD={}", build_id(Path::new(""))?);
    if std::env::var("CARGO_CFG_TARGET_OS")? == "macos" {
        // Not where it was built.
        println!("cargo::rustc-cdylib-link-arg=-Wl,-install_name,@rpath/libFlexibleRocking.dylib");
    }
    Ok(())
}

/// The name of the library that is built from the folder `package`: a GUID over the sources and the versions of all dependencies.
/// Compiler, target and the ends of lines are left out, because the libraries in one archive share the name.
pub fn build_id(package: &Path) -> io::Result<String> {
    let mut content = String::new();
    CONTENT.iter().try_for_each(|path| add(package, path, &mut content))?;
    Ok(Uuid::new_v5(&Uuid::NAMESPACE_OID, content.as_bytes()).braced().to_string())
}

/// Appends the file `path` of `package`, or the `.rs` files under it in the order of their names, to `content`. Editors leave
/// other files there, and links to nothing.
fn add(package: &Path, path: &str, content: &mut String) -> io::Result<()> {
    let place = package.join(path);
    if place.is_file() {
        *content += &format!("{path}\n{}", fs::read_to_string(place)?.replace("\r\n", "\n"));
        return Ok(());
    }
    let mut names = fs::read_dir(&place)?
        .map(|entry| Ok(entry?.file_name().to_string_lossy().into_owned()))
        .collect::<io::Result<Vec<_>>>()?;
    names.sort();
    names.retain(|name| name.ends_with(".rs") && !name.starts_with('.') || place.join(name).is_dir());
    names.iter().try_for_each(|name| add(package, &format!("{path}/{name}"), content))
}
