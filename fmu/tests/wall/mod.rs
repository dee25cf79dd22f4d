//! The FMU of Evison's wall.

use FlexibleRocking::resources::{CONTENTS_FILE, Contents};
use FlexibleRocking::variables::VariableTable;
use fmi_unit::variables::position;
use rocking::{Parameters, Structure};
use tempfile::TempDir;

/// The contents of its archive, without records.
pub fn contents() -> Contents {
    Structure::new(Parameters::EVISON).unwrap().into()
}

/// Its folder `resources`.
pub fn resources() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join(CONTENTS_FILE), contents().to_bytes()).unwrap();
    folder
}

/// The value reference of a variable in FMI 2.0.
pub fn reference(name: &str) -> u32 {
    position(&VariableTable::new(&contents()).variables, name) as u32
}
