//! `export` as a user runs it: it finds the shared library that cargo has built with it, in whatever profile.

use std::process::Command;

#[test]
fn the_library_of_the_same_build_is_found_and_packed() {
    let folder = tempfile::tempdir().unwrap();
    let mut export = Command::new(env!("CARGO_BIN_EXE_rocking-fmu"));
    let output = export.current_dir(folder.path()).args(["export", "--preset", "evison"]).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{said}");
    let size = folder.path().join("FlexibleRocking.fmu").metadata().unwrap().len();
    let start = format!("FlexibleRocking.fmu: {} kB\n  GUID       {{", size.div_ceil(1000));
    assert!(said.starts_with(&start) && said.contains("  structure  m = 125.8 kg, "), "{said}");
}

/// `--record` packs files that are records, and says which.
#[test]
fn records_are_packed_and_named() {
    let folder = tempfile::tempdir().unwrap();
    let export = |arguments: &[&str]| {
        let mut export = Command::new(env!("CARGO_BIN_EXE_rocking-fmu"));
        export.current_dir(folder.path()).arg("export").args(arguments).output().unwrap()
    };
    for (name, text) in [("pulse.csv", "0,1\n1,2\n"), ("sine.txt", "0,1\n1,2\n"), ("broken.csv", "0,1\n1,?\n")] {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    let output = export(&["--record", "pulse.csv", "sine.txt", "-o", "quakes.fmu"]);
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.ends_with("\n  record     pulse.csv\n  record     sine.txt\n"), "{said}");
    let assumed = "sine.txt: table, separated by commas, column 2; m/s2 assumed, for the file does not state it";
    assert!(said.contains(assumed), "{said}");
    let output = export(&["--record", "broken.csv", "-o", "broken.fmu"]);
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert_eq!(stderr, "error: broken.csv, line 2: the acceleration \"?\" is not a number\n");
    assert!(!output.status.success() && !folder.path().join("broken.fmu").exists());
}
