//! The program `rocking-fmu`.

use std::env;
use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(rocking_cli::main(env::current_exe().unwrap_or_default(), env::args_os()))
}
