//! The program that results name.

use FlexibleRocking::BUILD;
use rocking_sweep::row_file::Program;
use uuid::Uuid;

/// Version of the program, and the first digits of its build.
pub fn version() -> String {
    format!("{}+{}", env!("CARGO_PKG_VERSION"), &BUILD[1..9])
}

/// The program, as the rows of a sweep name it.
pub fn program() -> Program {
    Program { build: Uuid::try_parse(BUILD).expect("the build script wrote it"), version: version() }
}
