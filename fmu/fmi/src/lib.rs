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
#![allow(non_snake_case)] // the standard's names of arguments

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
#[cfg(test)]
mod touchy;
pub mod uri;
pub mod variables;

pub use failure::Failure;
pub use interface::Interface;
pub use logger::Logger;
pub use model::{Completed, Experiment, Model, Progress, Step, Update};
#[doc(hidden)]
pub use postcard;
pub use variables::{Causality, DataType, Enumeration, Role, Value, Variable};

/// The functions [`Model::state`] and [`Model::restore`] of a model that is all of its state and implements serde's traits.
#[macro_export]
macro_rules! state_by_serde {
    () => {
        fn state(&self, bytes: &mut ::std::vec::Vec<u8>) {
            $crate::snapshot::write_state(self, bytes);
        }

        fn restore(&mut self, bytes: &[u8]) -> ::std::result::Result<(), $crate::Failure> {
            *self = $crate::postcard::from_bytes(bytes)
                .map_err(|_| $crate::Failure::BadBytes("its content cannot be read"))?;
            Ok(())
        }
    };
}

/// Exports the functions that make instances of a [`Model`]. All others are exported with this crate.
#[macro_export]
macro_rules! export_fmu {
    ($model:ty) => {
        const _: () = {
            use ::std::ffi::{c_char, c_int, c_uint, c_void};
            use $crate::fmi2::CallbackFunctions;
            use $crate::fmi3::{IntermediateUpdateCallback, LogMessageCallback};

            #[allow(unsafe_code)]
            #[unsafe(no_mangle)]
            unsafe extern "C" fn fmi2Instantiate(
                name: *const c_char,
                fmu_type: c_int,
                guid: *const c_char,
                resources: *const c_char,
                functions: *const CallbackFunctions,
                _visible: c_int,
                logging_on: c_int,
            ) -> *mut c_void {
                unsafe { $crate::fmi2::instantiate::<$model>(name, fmu_type, guid, resources, functions, logging_on) }
            }

            #[allow(unsafe_code)]
            #[unsafe(no_mangle)]
            unsafe extern "C" fn fmi3InstantiateCoSimulation(
                name: *const c_char,
                token: *const c_char,
                resources: *const c_char,
                _visible: u8,
                logging_on: u8,
                event_mode: u8,
                early_return: u8,
                required: *const c_uint,
                n_required: usize,
                environment: *mut c_void,
                log: Option<LogMessageCallback>,
                update: Option<IntermediateUpdateCallback>,
            ) -> *mut c_void {
                let (texts, log) = ([name, token, resources], (environment, log, logging_on));
                let (flags, required) = ([event_mode, early_return], (required, n_required));
                unsafe { $crate::fmi3::instantiate_co_simulation::<$model>(texts, log, flags, required, update) }
            }

            #[allow(unsafe_code)]
            #[unsafe(no_mangle)]
            unsafe extern "C" fn fmi3InstantiateModelExchange(
                name: *const c_char,
                token: *const c_char,
                resources: *const c_char,
                _visible: u8,
                logging_on: u8,
                environment: *mut c_void,
                log: Option<LogMessageCallback>,
            ) -> *mut c_void {
                let (texts, log) = ([name, token, resources], (environment, log, logging_on));
                unsafe { $crate::fmi3::instantiate_model_exchange::<$model>(texts, log) }
            }

            // Three more arguments are not read, and not declared: the caller removes them.
            #[allow(unsafe_code)]
            #[unsafe(no_mangle)]
            unsafe extern "C" fn fmi3InstantiateScheduledExecution(
                name: *const c_char,
                token: *const c_char,
                resources: *const c_char,
                _visible: u8,
                logging_on: u8,
                environment: *mut c_void,
                log: Option<LogMessageCallback>,
            ) -> *mut c_void {
                let (texts, log) = ([name, token, resources], (environment, log, logging_on));
                unsafe { $crate::fmi3::instantiate_scheduled_execution::<$model>(texts, log) }
            }
        };
    };
}
