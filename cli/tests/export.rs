//! `export` as a user runs it: it finds the shared library that cargo has built with it, in whatever profile.

use std::env::consts::{ARCH, DLL_PREFIX, DLL_SUFFIX, OS};
use std::fs;
use std::path::Path;
use std::process::{Command, Output};

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
