//! The interfaces of FMI, of versions 2.0 and 3.0, for co-simulation and model exchange, around a model of one trait.
//!
//! An author writes a [`Model`] and exports it from a library of the type `cdylib`:
//!
//! ```ignore
//! fmi_unit::export_fmu!(BouncingBall);
//! ```
//!
//! A call of the host goes down this list; what is on a line knows nothing of the lines above it.
//!
//! | file | does |
//! |---|---|
//! | [`fmi2`], [`fmi3`] | name the C functions and their arguments, and the stages that each may be called in |
//! | [`c_abi`] | checks stage and pointers, makes slices of pointers, catches panics, logs why a call failed |
//! | [`instance`] | goes from stage to stage, checks references, types and ranges, and asks the model |
//! | [`snapshot`] | FMU states as bytes |
//! | [`model`] | the trait of a model |
//! | [`sensitivity`] | derivatives by differences |
//! | [`failure`] | every message about a call that is refused |
//! | [`variables`] | the table of variables, and what depends on what |
//! | [`interface`], [`logger`], [`state_machine`], [`uri`] | who integrates; messages to the host; stages, and tables of them; paths |
#![cfg_attr(target_family = "wasm", allow(dead_code))] // in a browser no host calls C functions
#![warn(missing_docs)]

#[cfg(not(target_family = "wasm"))]
pub mod c_abi;
pub mod failure;
#[cfg(not(target_family = "wasm"))]
pub mod fmi2;
#[cfg(not(target_family = "wasm"))]
pub mod fmi3;
pub mod instance;
pub mod interface;
pub mod logger;
pub mod model;
pub mod sensitivity;
pub mod snapshot;
pub mod state_machine;
pub mod uri;
pub mod variables;

pub use failure::Failure;
pub use interface::Interface;
#[cfg(not(target_family = "wasm"))]
#[doc(hidden)]
pub use libc;
pub use logger::Logger;
pub use model::{Completed, Experiment, Model, StepEnd, StepRequest, Update};
pub use variables::{Causality, DataType, Enumeration, Role, Value, Variable};

/// The functions [`Model::state`] and [`Model::restore`] of a model that is all of its state and implements serde's traits.
#[macro_export]
macro_rules! state_by_serde {
    () => {
        fn state(&self, bytes: &mut ::std::vec::Vec<u8>) {
            $crate::snapshot::write_state(self, bytes);
        }

        fn restore(&mut self, bytes: &[u8], _has_started: bool) -> ::std::result::Result<(), $crate::Failure> {
            *self = $crate::snapshot::read_state(bytes)?;
            Ok(())
        }
    };
}

/// Exports the functions of both versions for a [`Model`], in modules `fmi2` and `fmi3`.
#[macro_export]
macro_rules! export_fmu {
    ($model:ty) => {
        /// The functions of FMI 2.0.
        #[allow(unsafe_code, non_snake_case, clippy::missing_safety_doc)] // as in `fmi_unit::c_abi`
        pub mod fmi2 {
            use super::*;
            pub use $crate::fmi2::*;
            use $crate::libc::{c_char, c_double, c_int, c_uint, c_void, size_t};

            $crate::export_fmi2!($model, fmi2);
        }

        /// The functions of FMI 3.0.
        #[allow(unsafe_code, non_snake_case, clippy::missing_safety_doc, clippy::too_many_arguments)]
        pub mod fmi3 {
            use super::*;
            pub use $crate::fmi3::*;
            use $crate::libc::{c_char, c_int, c_uint, c_void, size_t};

            $crate::export_fmi3!($model, fmi3);
        }
    };
}
