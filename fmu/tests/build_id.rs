//! The name of the build covers what enters the library, and nothing else.

#[path = "../build/build_id.rs"]
mod build_id;

use build_id::{LOCK, MANIFESTS, SOURCES, build_id};
use std::fs;
use std::path::Path;
use tempfile::TempDir;

/// A copy of all that the function reads.
fn workspace() -> TempDir {
    let from = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let copy = tempfile::tempdir().unwrap();
    for file in MANIFESTS.iter().chain(&[LOCK]) {
        fs::create_dir_all(copy.path().join(file).parent().unwrap()).unwrap();
        fs::copy(from.join(file), copy.path().join(file)).unwrap();
    }
    for source in SOURCES {
        fs::create_dir_all(copy.path().join(source)).unwrap();
        fs::copy(from.join(source).join("lib.rs"), copy.path().join(source).join("lib.rs")).unwrap();
    }
    copy
}

/// Whether the name changes with `change` of the text of `file`.
fn changes(file: &str, change: impl Fn(&str) -> String) -> bool {
    let workspace = workspace();
    let path = workspace.path().join(file);
    let before = build_id(workspace.path()).unwrap();
    let text = fs::read_to_string(&path).unwrap_or_default();
    assert_ne!(change(&text), text, "{file} does not change");
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, change(&text)).unwrap();
    build_id(workspace.path()).unwrap() != before
}

/// Gives the one package called `name` another version in the text of Cargo.lock.
fn updated(lock: &str, name: &str) -> String {
    let entry = format!("\nname = \"{name}\"\nversion = \"");
    assert_eq!(lock.matches(&entry).count(), 1, "{name}");
    lock.replace(&entry, &format!("{entry}9"))
}

#[test]
fn what_enters_the_library_changes_it() {
    assert!(changes("src/lib.rs", |text| format!("{text} ")));
    assert!(changes("src/of/a/new.rs", |_| "1".into()));
    assert!(changes("fmu/src/variables.rs", |_| "1".into()));
    assert!(changes("Cargo.toml", |text| text.replace("lto = true", "lto = false")));
    assert!(changes("Cargo.toml", |text| text.replace("wide = \"1\"", "wide = \"0.9\"")));
    assert!(changes("Cargo.toml", |text| text.replace("edition = \"2024\"", "edition = \"2021\"")));
    assert!(changes("fmu/Cargo.toml", |text| text.replace("\"cdylib\"", "\"dylib\"")));
    for linked in ["wide", "matrixmultiply", "serde_derive", "sha1_smol"] {
        assert!(changes(LOCK, |lock| updated(lock, linked)), "{linked}");
    }
}

#[test]
fn nothing_else_changes_it() {
    let other = [
        "cli/src/main.rs",
        "sweep/src/fragility.rs",
        "cli/Cargo.toml",
        "fmu/export/resources/model.svg",
        "fmu/export/src/documentation.rs",
        "fmu/tests/unit/steps.rs",
        "modelDescription/src/lib.rs",
        "study/src/main.rs",
        "tests/edges.rs",
    ];
    for file in other {
        assert!(!changes(file, |_| "1".into()), "{file}");
    }
    assert!(!changes("Cargo.toml", |text| text.replace("\"cli\"", "\"command\"")));
    assert!(!changes("Cargo.toml", |text| text.replace("fastrand = \"2\"", "fastrand = \"3\"")));
    assert!(!changes("fmu/Cargo.toml", |text| text.replace("fastrand = \"2\"", "fastrand = \"3\"")));
    assert!(!changes("src/lib.rs", |text| text.replace('\n', "\r\n")), "as git checks it out on Windows");
    for other in ["clap", "plotters", "zip", "quick-xml", "fastrand", "minijinja"] {
        assert!(!changes(LOCK, |lock| updated(lock, other)), "{other}");
    }
}
