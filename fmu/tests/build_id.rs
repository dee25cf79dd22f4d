//! The name of the build covers the sources of the library and the versions of its dependencies, on every system alike.

#[path = "../build.rs"]
#[allow(dead_code)] // main
mod build;

use build::{CONTENT, build_id};
use std::fs;

#[test]
fn sources_and_versions_change_it_and_ends_of_lines_do_not() {
    let workspace = tempfile::tempdir().unwrap();
    let package = workspace.path().join("fmu");
    let named_with = |file: &str, text: &str| {
        let path = package.join(file);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
        build_id(&package).unwrap_or_default()
    };
    let [lock, folders @ ..] = CONTENT;
    let files: Vec<_> = folders.iter().map(|folder| format!("{folder}/lib.rs")).chain([lock.to_owned()]).collect();
    let before = files.iter().fold(String::new(), |_, file| named_with(file, "one\ntwo\n"));
    for file in &files {
        assert_eq!(named_with(file, "one\r\ntwo\r\n"), before, "{file}, as git checks it out on Windows");
        assert_ne!(named_with(file, "one\ntwo\n "), before, "{file}");
        assert_eq!(named_with(file, "one\ntwo\n"), before, "{file}");
    }
    for file in ["../cli/src/main.rs", "../src/.lib.rs.swp", "../src/.#lib.rs", "../src/lib.rs~"] {
        assert_eq!(named_with(file, "1"), before, "{file}");
    }
    assert_ne!(named_with("../src/of/a/new.rs", "1"), before);
}
