//! The licences of everything that is linked into the shared library, as one text.

use cargo_metadata::{MetadataCommand, Package};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::Command;
use std::{env, error, fs, io};

/// What begins the name of a file with a licence.
const LICENSE_FILES: [&str; 5] = ["LICENSE", "LICENCE", "UNLICENSE", "COPYING", "NOTICE"];

/// A list of the crates, then every text once, under the names of the crates that it holds for. `folder` is scratch.
pub fn licenses(workspace: &Path, folder: &Path) -> Result<String, Box<dyn error::Error>> {
    depend_on_the_library(workspace, folder)?;
    let options = ["--offline".to_owned(), "--filter-platform".to_owned(), env::var("TARGET")?];
    let metadata = MetadataCommand::new().current_dir(folder).other_options(options).exec()?;
    let linked = linked(folder)?;
    let mut list = String::new();
    let mut texts: BTreeMap<String, (String, Vec<String>)> = BTreeMap::new();
    for package in &metadata.packages {
        let name = format!("{} v{}", package.name, package.version);
        if !linked.contains(&name) {
            continue;
        }
        list += &format!("  {name}: {}\n", package.license.as_deref().unwrap_or("see below"));
        for text in texts_of(package, workspace)? {
            let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
            texts.entry(words).or_insert((text, Vec::new())).1.push(name.clone());
        }
    }
    let mut licenses = format!(
        "FlexibleRocking is free software under the MIT license or the Apache License 2.0, as you choose.\n\n\
         Its shared library is made of these packages and of the Rust standard library (MIT OR Apache-2.0):\n\n{list}"
    );
    for (text, names) in texts.into_values() {
        licenses += &format!("\n{}\n{}:\n\n{text}\n", "=".repeat(80), names.join(", "));
    }
    Ok(licenses)
}

/// Makes `folder` a package that depends on the library alone. Asked from within the workspace, cargo wants every
/// package of every member, and this build may not have downloaded those.
fn depend_on_the_library(workspace: &Path, folder: &Path) -> io::Result<()> {
    let (name, path) = (env!("CARGO_PKG_NAME"), workspace.join("fmu"));
    let manifest = format!(
        "[workspace]\n[package]\nname = \"links-the-library\"\nedition = \"2024\"\n[lib]\npath = \"none.rs\"\n\
         [dependencies]\n{name} = {{ path = {path:?}, default-features = false }}\n"
    );
    fs::write(folder.join("Cargo.toml"), manifest)?;
    fs::copy(workspace.join("Cargo.lock"), folder.join("Cargo.lock"))?;
    Ok(())
}

/// The names and versions of what the library depends on, without build scripts and macros.
fn linked(folder: &Path) -> Result<BTreeSet<String>, Box<dyn error::Error>> {
    let arguments = "tree --offline --edges normal,no-proc-macro --prefix none --format {p} --package";
    let tree = Command::new(env::var_os("CARGO").ok_or("CARGO is not set")?)
        .args(arguments.split(' '))
        .args([env!("CARGO_PKG_NAME"), "--target", &env::var("TARGET")?])
        .current_dir(folder)
        .output()?;
    if !tree.status.success() {
        return Err(String::from_utf8_lossy(&tree.stderr).into());
    }
    let name = |line: &str| line.split(' ').take(2).collect::<Vec<_>>().join(" ");
    Ok(String::from_utf8(tree.stdout)?.lines().map(name).collect())
}

/// The texts of the licence files of `package`; those of the workspace itself are in its root.
fn texts_of(package: &Package, workspace: &Path) -> io::Result<Vec<String>> {
    let folder = package.manifest_path.parent().map(|folder| folder.as_std_path()).filter(|_| package.source.is_some());
    let mut files: Vec<_> = fs::read_dir(folder.unwrap_or(workspace))?.collect::<Result<_, _>>()?;
    files.sort_by_key(|file| file.file_name());
    let is_license = |file: &&fs::DirEntry| {
        let name = file.file_name().to_string_lossy().to_uppercase();
        file.path().is_file() && LICENSE_FILES.iter().any(|beginning| name.starts_with(beginning))
    };
    files.iter().filter(is_license).map(|file| Ok(fs::read_to_string(file.path())?.trim().to_owned())).collect()
}
