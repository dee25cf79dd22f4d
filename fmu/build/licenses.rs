//! The licences of everything that is linked into the shared library, as one text.

use cargo_metadata::{MetadataCommand, Package};
use std::collections::{BTreeMap, BTreeSet};
use std::path::Path;
use std::process::Command;
use std::{env, error, fs, io};

/// What begins the name of a file with a licence.
const LICENSE_FILES: [&str; 5] = ["LICENSE", "LICENCE", "UNLICENSE", "COPYING", "NOTICE"];

/// A list of the crates, then every text once, under the names of the crates that it holds for.
pub fn licenses(workspace: &Path) -> Result<String, Box<dyn error::Error>> {
    let linked = linked(workspace)?;
    let metadata = MetadataCommand::new().current_dir(workspace).other_options(["--offline".to_owned()]).exec()?;
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

/// The names and versions of what the library alone depends on, without the program, build scripts and macros.
fn linked(workspace: &Path) -> Result<BTreeSet<String>, Box<dyn error::Error>> {
    let arguments = "tree --offline --no-default-features --edges normal,no-proc-macro --prefix none";
    let tree = Command::new(env::var_os("CARGO").ok_or("CARGO is not set")?)
        .args(arguments.split(' '))
        .args(["--package", env!("CARGO_PKG_NAME"), "--format", "{p}"])
        .current_dir(workspace)
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
