//! Keeps export/resources/licenses.txt true: the licences of everything that is linked into the shared library, as one text.

use cargo_metadata::{MetadataCommand, Package};
use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::{env, fs};

/// The platforms that an archive can have a library for.
const TARGETS: [&str; 5] = [
    "x86_64-unknown-linux-gnu",
    "aarch64-unknown-linux-gnu",
    "x86_64-pc-windows-gnu",
    "x86_64-apple-darwin",
    "aarch64-apple-darwin",
];

/// Beginnings of the names of files with a licence.
const LICENSE_FILES: [&str; 5] = ["LICENSE", "LICENCE", "UNLICENSE", "COPYING", "NOTICE"];

/// With the variable `WRITE_LICENSES` the test writes the file anew.
#[test]
fn the_file_has_the_licenses_of_the_library() {
    let manifest = Path::new(env!("CARGO_MANIFEST_DIR"));
    let (file, licenses) = (manifest.join("export/resources/licenses.txt"), licenses(&manifest.join("..")));
    if env::var_os("WRITE_LICENSES").is_some() {
        fs::write(&file, &licenses).unwrap();
    }
    let written = fs::read_to_string(&file).unwrap();
    let lines = |text: &str| text.lines().map(str::to_owned).collect::<BTreeSet<_>>();
    let (old, new) = (lines(&written), lines(&licenses));
    assert!(
        written == licenses,
        "fmu/export/resources/licenses.txt is not what the shared library is made of: `WRITE_LICENSES=1 cargo test --release -p flexible-rocking-fmu --test licenses` writes it anew. \
         Missing: {:#?}. Too much: {:#?}",
        new.difference(&old).collect::<Vec<_>>(),
        old.difference(&new).collect::<Vec<_>>()
    );
}

/// A list of the packages, then every text once, under the names of the packages that it holds for.
fn licenses(workspace: &Path) -> String {
    let platforms = TARGETS.iter().flat_map(|target| ["--filter-platform".to_owned(), target.to_string()]);
    let options = ["--locked".to_owned()].into_iter().chain(platforms).collect::<Vec<_>>();
    let metadata = MetadataCommand::new().current_dir(workspace).other_options(options).exec().unwrap();
    let linked = linked(workspace);
    let mut list = String::new();
    let mut texts: BTreeMap<String, (String, Vec<String>)> = BTreeMap::new();
    for package in &metadata.packages {
        let name = format!("{} v{}", package.name, package.version);
        if !linked.contains(&name) {
            continue;
        }
        list += &format!("  {name}: {}\n", package.license.as_deref().unwrap_or("see below"));
        let found = texts_of(package, workspace);
        assert!(!found.is_empty(), "{name} comes without the text of its licence");
        for text in found {
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
    licenses
}

/// The names and versions of what the library links, without build scripts and macros.
fn linked(workspace: &Path) -> BTreeSet<String> {
    let arguments =
        "tree --locked --edges normal,no-proc-macro --prefix none --format {p} --package flexible-rocking-fmu";
    let tree = Command::new(env!("CARGO"))
        .args(arguments.split(' '))
        .args(TARGETS.iter().flat_map(|target| ["--target", target]))
        .current_dir(workspace)
        .output()
        .unwrap();
    assert!(tree.status.success(), "{}", String::from_utf8_lossy(&tree.stderr));
    let name = |line: &str| line.split(' ').take(2).collect::<Vec<_>>().join(" ");
    String::from_utf8(tree.stdout).unwrap().lines().map(name).collect()
}

/// The texts of the licence files of `package`; those of the workspace itself are in its root.
fn texts_of(package: &Package, workspace: &Path) -> Vec<String> {
    let folder = package.manifest_path.parent().map(|folder| folder.as_std_path()).filter(|_| package.source.is_some());
    let files = fs::read_dir(folder.unwrap_or(workspace)).unwrap();
    let mut files: Vec<PathBuf> = files.map(|file| file.unwrap().path()).collect();
    files.sort();
    let is_license = |file: &&PathBuf| {
        let name = file.file_name().unwrap_or_default().to_string_lossy().to_uppercase();
        file.is_file() && LICENSE_FILES.iter().any(|beginning| name.starts_with(beginning))
    };
    let text = |file: &PathBuf| fs::read_to_string(file).unwrap().trim().replace("\r\n", "\n");
    files.iter().filter(is_license).map(text).collect()
}
