//! Unit of a flexible rocking structure for co-simulation and model exchange, of FMI 2.0 and of FMI 3.0.
//!
//! The C functions, stages and FMU states are [`fmi_unit`]'s, the physics is [`rocking`]'s. A file of this list knows
//! nothing of the lines above it.
//!
//! | file | does |
//! |---|---|
//! | [`unit`] | the model, of one mass or of many: what an instance is asked: values, start, steps, events, its state as bytes |
//! | `derivatives`, `outside` | derivatives of outputs; the motion under the host's integrator |
//! | `shown` | the values of all computed real numbers at an instant |
//! | `advance` | the structure on its ground over one step |
//! | `scene` | the structure on its ground, from its start on |
//! | `motion_log` | the messages about transitions and limits |
//! | `failure` | every message about what is refused |
//! | [`variables`], `floor_variables`, `source` | the table of variables |
//! | `setup`, `inputs` | what is set before the start and during the simulation |
//! | [`ground`], [`resources`] | records; what the archive carries |
//!
//! In a browser no host calls C functions: the table of variables alone is used there.
#![cfg_attr(target_family = "wasm", allow(dead_code))]

mod advance;
mod derivatives;
mod failure;
mod floor_variables;
pub mod ground;
mod inputs;
mod model_exchange;
mod motion_log;
pub mod resources;
pub mod rocking_model;
mod scene;
mod setup;
mod shown;
pub mod source;
pub mod variables;

use resources::Contents;
use uuid::Uuid;

#[cfg(not(target_family = "wasm"))]
fmi_unit::export_fmu!(rocking_model::RockingModel);

/// Names the build: all that enters the library.
pub const BUILD: &str = env!("FLEXIBLE_ROCKING_BUILD");

/// The GUID of an FMU with these `contents`: binds the model description, the library and what the archive carries to
/// each other. Hosts take two FMUs of one GUID for the same, so that structures and records must differ in it.
pub fn guid(contents: &Contents) -> String {
    let build = Uuid::try_parse(BUILD).expect("the build script wrote it");
    Uuid::new_v5(&build, &contents.to_bytes()).braced().to_string()
}
