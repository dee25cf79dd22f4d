//! Gives the library the name of its build.

mod build_id;

use std::error::Error;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn Error>> {
    let workspace = PathBuf::from(std::env::var("CARGO_MANIFEST_DIR")?).join("..");
    for read in [build_id::SOURCES.as_slice(), &build_id::MANIFESTS, &[build_id::LOCK]].concat() {
        println!("cargo::rerun-if-changed=../{read}");
    }
    println!("cargo::rustc-env=FLEXIBLE_ROCKING_BUILD={}", build_id::build_id(&workspace)?);
    if std::env::var("CARGO_CFG_TARGET_OS")? == "macos" {
        // Not where it was built.
        println!("cargo::rustc-cdylib-link-arg=-Wl,-install_name,@rpath/libFlexibleRocking.dylib");
    }
    Ok(())
}
