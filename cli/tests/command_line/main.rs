//! The command line, run as a user would: a folder with a ground motion, commands, what they print.
#![allow(non_snake_case)] // H, V_t, M_t: the paper's own letters

mod advise;
mod cli;
mod maps;
mod tour;
mod validity;

use std::{
    fs,
    path::Path,
    process::{Command, Output},
};
use tempfile::TempDir;

/// A full sine of 0.6 g and 0.5 s and rest after it, 401 samples: lifts and lands the McManus specimen.
const SAMPLES: usize = 401;
const DT: f64 = 0.01;

fn pulse(i: usize) -> f64 {
    let time = i as f64 * DT;
    if time < 0.5 { 0.6 * (std::f64::consts::TAU * time / 0.5).sin() } else { 0.0 }
}

/// An empty folder with the pulse in it as `pulse.AT2`.
fn folder() -> TempDir {
    let folder = TempDir::new().unwrap();
    let values: Vec<_> = (0..SAMPLES).map(|i| format!("{:e}", pulse(i))).collect();
    let lines: Vec<_> = values.chunks(5).map(|line| line.join("  ")).collect();
    let header = "PEER\nFull sine\nACCELERATION TIME SERIES IN UNITS OF G\nNPTS=    401, DT=   .0100 SEC,\n";
    fs::write(folder.path().join("pulse.AT2"), format!("{header}{}\n", lines.join("\n"))).unwrap();
    folder
}

/// Runs a command that succeeds, and returns its standard output and standard error.
fn succeed(folder: &Path, arguments: &str) -> (String, String) {
    let mut command = Command::new(env!("CARGO_BIN_EXE_rocking-fmu"));
    let Output { status, stdout, stderr } =
        command.current_dir(folder).args(arguments.split_whitespace()).output().unwrap();
    let (stdout, stderr) = (String::from_utf8(stdout).unwrap(), String::from_utf8(stderr).unwrap());
    assert!(status.success(), "{arguments}: {stderr}");
    (stdout, stderr)
}
