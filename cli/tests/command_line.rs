//! A tour of the command line: every command, right and wrong, in a folder with a record of every layout; what each prints
//! is compared with `tour.txt`.
//!
//! There, `$` begins a command, `!` a line on standard error; any other line is on standard output, and `[1]` is an exit
//! code other than 0. `WRITE_TOUR=1 cargo test -p rocking-cli --test command_line` writes it anew from its commands.
//! `columns NAME ...` prints the columns of the table on standard input by their headings; `FIRST..LAST` is a range.

#[path = "../../records/tests/layouts/mod.rs"]
#[allow(dead_code)] // what else is known of each file
mod layouts;

use std::fmt::Write;
use std::path::Path;
use std::process::{Command, Output};
use std::{env, fs};

const SAMPLES: usize = 400;

const COLUMNS: &str = r#"columns() {
    local heading name fields; IFS= read -r heading
    number() { tr , '\n' <<< "$heading" | grep -nxF "$1" | cut -d: -f1 | grep . || echo "no column $1" >&2; }
    for name; do fields+=,$(number "${name%%..*}")-$(number "${name##*..}"); done
    (echo "$heading"; cat) | cut -d, -f"${fields#,}"
}"#;

#[test]
fn every_command_of_the_tour_prints_what_it_printed() {
    let script = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/tour.txt");
    let expected = fs::read_to_string(&script).unwrap();
    let folder = tempfile::tempdir().unwrap();
    for (number, layout) in layouts::all(SAMPLES).into_iter().enumerate() {
        let (stem, extension) = (layout.path.file_stem().unwrap(), layout.path.extension().unwrap());
        let name = format!("{}{number}.{}", stem.to_str().unwrap(), extension.to_str().unwrap());
        fs::write(folder.path().join(name), layout.bytes).unwrap();
    }
    let bin = tempfile::tempdir().unwrap();
    install(bin.path());
    let mut printed = String::new();
    for block in blocks(&expected) {
        if block.starts_with('#') {
            printed += block;
            continue;
        }
        let command = block.lines().next().unwrap();
        let found = transcript(folder.path(), bin.path(), command);
        if env::var_os("WRITE_TOUR").is_none() {
            assert_eq!(found, block, "\n{found}");
        }
        printed += &found;
    }
    if env::var_os("WRITE_TOUR").is_some() {
        fs::write(script, printed).unwrap();
    }
}

/// Comments, and commands with what they print, each up to the next.
fn blocks(text: &str) -> Vec<&str> {
    let starts = ["\n$ ", "\n# "].into_iter().flat_map(|start| text.match_indices(start)).map(|(index, _)| index + 1);
    let mut starts: Vec<_> = starts.chain([0, text.len()]).collect();
    starts.sort_unstable();
    starts.windows(2).map(|pair| &text[pair[0]..pair[1]]).collect()
}

/// Copies the program and this machine's library to `bin`, where no library for another machine is found beside them.
fn install(bin: &Path) {
    let program = Path::new(env!("CARGO_BIN_EXE_rocking-fmu"));
    fs::create_dir(bin.join("deps")).unwrap();
    for file in ["rocking-fmu", "deps/libFlexibleRocking.so"] {
        fs::copy(program.with_file_name(file), bin.join(file)).unwrap();
    }
}

/// The command in `line`, and what it prints in `folder`, without what differs between machines.
fn transcript(folder: &Path, bin: &Path, line: &str) -> String {
    let path = format!("{}:{}", bin.display(), env::var("PATH").unwrap());
    let command = format!("{COLUMNS}\n{}", line.trim_start_matches("$ "));
    let mut shell = Command::new("bash");
    shell.arg("-c").arg(command).current_dir(folder).env("PATH", path).env("LC_ALL", "C");
    let Output { status, stdout, stderr } = shell.output().unwrap();
    let plain = |bytes: Vec<u8>| {
        let text = String::from_utf8(bytes).unwrap().replace(&folder.display().to_string(), "[FOLDER]");
        text.replace(env!("CARGO_PKG_VERSION"), "[VERSION]")
            .replace(FlexibleRocking::BUILD, "[BUILD]")
            .replace(&FlexibleRocking::BUILD[1..9], "[BUILD]")
    };
    let mut out = format!("{line}\n{}", plain(stdout));
    if !out.ends_with('\n') {
        out += "\n";
    }
    for said in plain(stderr).lines() {
        writeln!(out, "! {}", without_numbers_of_this_build(said).trim_end()).unwrap();
    }
    if !status.success() {
        writeln!(out, "[{}]", status.code().unwrap()).unwrap();
    }
    out
}

/// The size and the name of the library that is packed.
fn without_numbers_of_this_build(line: &str) -> String {
    match line.split_once(['{']) {
        Some((before, _)) if line.contains("GUID") => format!("{before}[GUID]"),
        _ if line.ends_with(" kB") => format!("{}: [SIZE] kB", line.split(':').next().unwrap()),
        _ => line.to_owned(),
    }
}
