//! Unit of a flexible rocking structure for co-simulation and model exchange, of FMI 2.0 and of FMI 3.0.
//!
//! A call of the host enters by [`fmi2`] or [`fmi3`], whose shell [`c_abi`] asks a table of [`state_machine`] whether it
//! is legal and turns pointers into slices. [`instance`], which knows no version, finds its variables in [`variables`] and
//! lets [`rocking`] do the physics; what goes wrong is a [`failure::Failure`], which [`logger`] hands to the host. All that
//! the future depends on is a [`condition::Condition`], which [`snapshot`] keeps: what was set before the start, in
//! [`setup`], the [`inputs`], and how far the motion has come; whether it can start is in `start`. [`sensitivity`]
//! differentiates by parameters. [`resources`] reads what the archive carries, and [`ground`] the records, of the archive
//! or on disk.
#![allow(non_snake_case)] // the shared library's name, and the standard's names of arguments

pub mod c_abi;
pub mod condition;
pub mod failure;
pub mod fmi2;
pub mod fmi3;
pub mod ground;
pub mod inputs;
pub mod instance;
pub mod logger;
pub mod resources;
pub mod sensitivity;
pub mod setup;
mod shown;
pub mod snapshot;
mod start;
pub mod state_machine;
pub mod variables;

use resources::Contents;
use uuid::Uuid;

/// Names the build: all that enters the library.
pub const BUILD: &str = env!("FLEXIBLE_ROCKING_BUILD");

/// The GUID of an FMU with these `contents`: binds the model description, the library and what the archive carries to
/// each other. Hosts take two FMUs of one GUID for the same, so that structures and records must differ in it.
pub fn guid(contents: &Contents) -> String {
    let build = Uuid::try_parse(BUILD).expect("the build script wrote it");
    let bytes = postcard::to_stdvec(contents).expect("numbers and text can always be written");
    Uuid::new_v5(&build, &bytes).braced().to_string()
}
