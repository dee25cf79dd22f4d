//! `export` as a user runs it: it finds the shared library that cargo has built with it, in whatever profile.

use std::env::consts::{ARCH, DLL_PREFIX, DLL_SUFFIX, OS};
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

#[test]
fn the_library_of_the_same_build_is_found_and_packed() {
    let folder = tempfile::tempdir().unwrap();
    let mut export = Command::new(env!("CARGO_BIN_EXE_rocking-fmu"));
    let output = export.current_dir(folder.path()).args(["export", "--preset", "evison"]).output().unwrap();
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.success(), "{said}");
    let size = folder.path().join("FlexibleRocking.fmu").metadata().unwrap().len();
    let start = format!("FlexibleRocking.fmu: {} kB\n  GUID       {{", size.div_ceil(1000));
    assert!(said.contains(&start) && said.contains("  structure  m = 125.8 kg, "), "{said}");
}

/// The libraries are looked for where cargo makes them, beside the program, and in an archive where an installation has it;
/// a name goes into the archive and is its file's.
#[test]
fn libraries_are_found_where_they_are_built_and_where_they_are_installed() {
    let folder = tempfile::tempdir().unwrap();
    let program = Path::new(env!("CARGO_BIN_EXE_rocking-fmu"));
    let own = format!("{DLL_PREFIX}FlexibleRocking{DLL_SUFFIX}");
    let library = program.with_file_name("deps").join(&own);
    let bin = folder.path().join("bin");
    fs::create_dir(&bin).unwrap();
    let copy = bin.join(program.file_name().unwrap());
    fs::copy(program, &copy).unwrap();
    let export = |arguments: &[&str]| -> Output {
        Command::new(&copy).current_dir(folder.path()).arg("export").args(arguments).output().unwrap()
    };
    let refusal = |arguments: &[&str]| {
        let output = export(arguments);
        assert!(!output.status.success());
        String::from_utf8(output.stderr).unwrap()
    };
    let platforms = |arguments: &[&str]| {
        let output = export(arguments);
        assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
        let said = String::from_utf8(output.stderr).unwrap();
        let line = said.lines().find_map(|line| line.strip_prefix("  platforms  ")).map(str::to_owned);
        let written = said.lines().find_map(|line| line.strip_suffix(" kB")).and_then(|line| line.split(':').next());
        (line.unwrap(), written.unwrap().to_owned())
    };

    let none = refusal(&[]);
    assert!(none.contains("there is no shared library to pack, neither ") && none.contains("--library PATH"), "{none}");
    let text = folder.path().join("text.so");
    fs::write(&text, "no library").unwrap();
    let other = refusal(&["--library", "text.so"]);
    assert!(other.contains("text.so is neither an FMU nor a shared library for one of x86_64-linux, "), "{other}");
    let absent = refusal(&["--library", "absent.so"]);
    assert!(absent.contains("cannot read the shared library absent.so: No such file"), "{absent}");

    fs::copy(&library, bin.join(&own)).unwrap();
    let (platform, file) = platforms(&["--name", "Pier1"]);
    assert_eq!((platform.contains(", "), file.as_str()), (false, "Pier1.fmu"));
    fs::remove_file(bin.join(&own)).unwrap();

    let share = folder.path().join("share/flexible-rocking");
    fs::create_dir_all(&share).unwrap();
    fs::rename(folder.path().join("Pier1.fmu"), share.join("FlexibleRocking.fmu")).unwrap();
    assert_eq!(platforms(&[]), (platform.clone(), "FlexibleRocking.fmu".to_owned()));
    let library = library.to_str().unwrap();
    assert_eq!(platforms(&["--library", library, "-o", "a.fmu"]), (platform.clone(), "a.fmu".to_owned()));
    let twice = refusal(&["--library", library, "a.fmu", "-o", "b.fmu"]);
    let tuple = format!("{ARCH}-{OS}"); // as FMI 3.0 calls it
    assert!(twice.ends_with(&format!("error: two shared libraries are for {tuple}: leave one out\n")), "{twice}");

    // Built for a named target, from other sources.
    let stale = folder.path().join("x86_64-unknown-linux-gnu/dist/libFlexibleRocking.so");
    fs::create_dir_all(stale.parent().unwrap()).unwrap();
    let mut bytes = fs::read(library).unwrap();
    let build = FlexibleRocking::BUILD.as_bytes();
    let places: Vec<_> = memchr::memmem::find_iter(&bytes, build).collect();
    places.iter().for_each(|at| bytes[at + 1] ^= 1);
    fs::write(&stale, bytes).unwrap();
    let output = export(&[]);
    let stderr = String::from_utf8(output.stderr).unwrap();
    let left_out = format!("{} is left out: it is of another build\n", stale.canonicalize().unwrap().display());
    assert!(stderr.contains(&left_out), "{stderr}");
    let stale = refusal(&["--library", stale.to_str().unwrap()]);
    assert!(stale.contains(" is of another build: the name of this one, {"), "{stale}");
}

/// `--record` packs files that are records, and says which.
#[test]
fn records_are_packed_and_named() {
    let folder = tempfile::tempdir().unwrap();
    let export = |arguments: &[&str]| {
        let mut export = Command::new(env!("CARGO_BIN_EXE_rocking-fmu"));
        export.current_dir(folder.path()).arg("export").args(arguments).output().unwrap()
    };
    for (name, text) in [("pulse.csv", "0,.1\n.5,.2\n"), ("sine.txt", "0,.1\n.5,.2\n"), ("broken.csv", "0,1\n1,?\n")] {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    let output = export(&["--record", "pulse.csv", "sine.txt", "-o", "quakes.fmu"]);
    let said = String::from_utf8(output.stderr).unwrap();
    assert!(said.ends_with("\n  record     pulse.csv\n  record     sine.txt\n"), "{said}");
    let assumed = "sine.txt: table, separated by commas, column 2; m/s2 assumed, for the file does not state it";
    assert!(said.contains(assumed), "{said}");
    let output = export(&["--record", "broken.csv", "-o", "broken.fmu"]);
    let stderr = String::from_utf8(output.stderr).unwrap();
    assert!(stderr.ends_with("\nerror: broken.csv, line 2: the acceleration \"?\" is not a number\n"), "{stderr}");
    assert!(!output.status.success() && !folder.path().join("broken.fmu").exists());
}
