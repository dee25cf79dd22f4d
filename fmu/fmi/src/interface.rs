//! The purpose of an instance: model exchange, or co-simulation with or without event mode and calls back.

use crate::state_machine::Stage;
use serde::{Deserialize, Serialize};
use std::ffi::c_void;

/// The side that integrates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Interface {
    /// The FMU.
    CoSimulation(Stepping),
    /// The host.
    ModelExchange,
}

/// How the host of a co-simulation meets events.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Stepping {
    /// It handles events, between steps.
    pub event_mode: bool,
    /// It accepts steps that end early.
    pub early_return: bool,
}

impl Interface {
    /// The stage in which a simulation starts.
    pub const fn first_stage(self) -> Stage {
        match self {
            Interface::CoSimulation(Stepping { event_mode: false, .. }) => Stage::StepComplete,
            Interface::CoSimulation(Stepping { event_mode: true, .. }) | Interface::ModelExchange => Stage::EventMode,
        }
    }

    /// How the host meets events that the FMU comes across.
    pub fn stepping(self) -> Stepping {
        match self {
            Interface::CoSimulation(stepping) => stepping,
            Interface::ModelExchange => Stepping::default(),
        }
    }
}

/// `fmi3IntermediateUpdateCallback`
pub type IntermediateUpdateCallback = unsafe extern "C" fn(*mut c_void, f64, u8, u8, u8, u8, *mut u8, *mut f64);

/// How a host is called back within a step. It is copied out of the instance, which the host may call meanwhile.
#[derive(Clone, Copy)]
pub(crate) struct IntermediateUpdate {
    pub update: IntermediateUpdateCallback,
    pub environment: *mut c_void,
    /// Whether the host sets inputs at the end of a step before it is computed.
    pub sets_inputs: bool,
    /// Whether it reads other variables once the step is computed.
    pub gets_outputs: bool,
}
