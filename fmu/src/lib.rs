//! FMI 2.0 co-simulation unit of a flexible rocking structure.
//!
//! A call of the host enters by [`c_abi`], which turns pointers into slices and nothing else. [`instance`] asks
//! [`state_machine`] whether the call is legal, finds its variables in [`variables`], and lets [`rocking`] do the
//! physics; what goes wrong is a [`failure::Failure`], which [`logger`] hands to the host. [`snapshot`] keeps FMU states
//! and [`resources`] reads the parameters that the archive carries.
#![allow(non_snake_case)] // the shared library's name, and the standard's names of arguments

pub mod c_abi;
pub mod failure;
pub mod instance;
pub mod logger;
pub mod resources;
pub mod snapshot;
pub mod state_machine;
pub mod variables;

/// Binds the library to the model description written for it.
pub const GUID: &str = env!("FLEXIBLE_ROCKING_GUID");
