//! What the library and the exporter know of their own build: its name and its licences.

mod build_id;
mod licenses;

use std::path::PathBuf;
use std::{env, error, fs};

fn main() -> Result<(), Box<dyn error::Error>> {
    let variable = |name| env::var(name).map(PathBuf::from);
    let workspace = variable("CARGO_MANIFEST_DIR")?.join("..");
    println!("cargo::rustc-env=FLEXIBLE_ROCKING_BUILD={}", build_id::build_id(&workspace)?);
    let folder = variable("OUT_DIR")?;
    fs::write(folder.join("license.txt"), licenses::licenses(&workspace, &folder)?)?;
    Ok(())
}
