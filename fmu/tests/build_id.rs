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
    folders.map(|folder| named_with(&format!("{folder}/lib.rs"), "one\ntwo\n"));
    let before = named_with(lock, "1\n2\n");
    for file in [lock.to_owned()].into_iter().chain(folders.map(|folder| format!("{folder}/lib.rs"))) {
        let text = fs::read_to_string(package.join(&file)).unwrap();
        assert_eq!(named_with(&file, &text.replace('\n', "\r\n")), before, "{file}, as git checks it out on Windows");
        assert_ne!(named_with(&file, &format!("{text} ")), before, "{file}");
        assert_eq!(named_with(&file, &text), before, "{file}");
    }
    assert_eq!(named_with("../cli/src/main.rs", "1"), before);
    assert_ne!(named_with("../src/of/a/new.rs", "1"), before);
}
