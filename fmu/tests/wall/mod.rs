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

/// The folder `resources` of an archive with these `contents`.
pub fn resources(contents: &Contents) -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join(CONTENTS_FILE), contents.to_bytes()).unwrap();
    folder
}

/// The value reference of a variable of such an archive in FMI 2.0.
pub fn reference(contents: &Contents, name: &str) -> u32 {
    position(&VariableTable::new(contents).variables, name) as u32
}
