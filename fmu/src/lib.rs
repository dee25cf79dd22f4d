//! Unit of a flexible rocking structure for co-simulation and model exchange, of FMI 2.0 and of FMI 3.0.
//!
//! A call of the host goes down this list; what is on a line knows nothing of the lines above it.
//!
//! | file | does |
//! |---|---|
//! | [`fmi2`], [`fmi3`] | name the C functions and their arguments, and the stages that each may be called in |
//! | [`c_abi`] | checks stage and pointers, makes slices of pointers, catches panics, logs why a call failed |
//! | `instance` | goes from stage to stage; `do_step`, `get_values`, `set_values`, `derivatives`, `model_exchange` |
//! | [`snapshot`], [`condition`] | FMU states as bytes; all that the future of an instance depends on |
//! | `sensitivity` | derivatives by states |
//! | `present` | what an instance holds between two calls: stage, setup, inputs, model |
//! | `shown` | the values of all computed Reals at an instant |
//! | `advance` | the model over one step |
//! | `model` | the structure on its ground, from its start on |
//! | `motion_log` | the messages about transitions and limits |
//! | `failure` | every message about a call that is refused |
//! | [`variables`] | the table of variables |
//! | `setup`, `inputs`, [`interface`] | what is set before the start and during the simulation; who integrates |
//! | [`ground`], [`resources`] | records; what the archive carries |
//! | [`logger`], [`state_machine`] | messages to the host; the stages, and tables of them |
//!
//! The physics is [`rocking`]'s. In a browser no host calls C functions: the table of variables alone is used there.
#![cfg_attr(target_family = "wasm", allow(dead_code))]
#![allow(non_snake_case)] // the shared library's name, and the standard's names of arguments

mod advance;
#[cfg(not(target_family = "wasm"))]
pub mod c_abi;
pub mod condition;
mod failure;
#[cfg(not(target_family = "wasm"))]
pub mod fmi2;
#[cfg(not(target_family = "wasm"))]
pub mod fmi3;
pub mod ground;
mod inputs;
mod instance;
pub mod interface;
pub mod logger;
mod model;
mod motion_log;
mod present;
pub mod resources;
mod sensitivity;
mod setup;
mod shown;
pub mod snapshot;
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
