//! The structure behind FMI's functions, as a host calls them.
#![allow(unsafe_code, non_snake_case)] // the C interface; F_t and names of the standard

mod directional_derivatives;
mod every_interface;
mod fmi3;
mod fmu_states;
#[path = "../host/mod.rs"]
mod host;
mod inputs;
mod instances;
mod logging;
mod model_exchange;
mod records;
mod refusals;
mod steps;
mod validity;
mod variables;
