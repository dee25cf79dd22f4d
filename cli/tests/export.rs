//! `export` as a user runs it: it finds the shared library that cargo has built with it, in whatever profile.

use std::process::Command;

#[test]
fn the_library_of_the_same_build_is_found_and_packed() {
    let folder = tempfile::tempdir().unwrap();
    let mut export = Command::new(env!("CARGO_BIN_EXE_rocking-fmu"));
    let output = export.current_dir(folder.path()).args(["export", "--preset", "evison"]).output().unwrap();
    let stdout = String::from_utf8(output.stdout).unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let size = folder.path().join("FlexibleRocking.fmu").metadata().unwrap().len();
    let start = format!("FlexibleRocking.fmu: {} kB\n  GUID       {{", size.div_ceil(1000));
    assert!(stdout.starts_with(&start) && stdout.contains("  structure  m = 125.8 kg, "), "{stdout}");
}
