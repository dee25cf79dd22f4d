//! The states of an instance, as the standard has them, and what tables of the functions that may be called in them are
//! made of: one table for each interface of each version.

use serde::{Deserialize, Serialize};
use std::fmt;

/// A state of FMI's state machine, called stage here: a state is the model's.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Stage {
    /// Created or reset.
    Instantiated,
    /// Between entering and leaving initialization.
    InitializationMode,
    /// Ready for a step.
    StepComplete,
    /// Within a step, while the host is asked for the inputs at its end.
    IntermediateUpdateMode,
    /// At the end of a step, while the host reads what it has led to.
    IntermediateOutputs,
    /// A step has ended the simulation; there is nothing left to step to.
    StepFailed,
    /// At an event.
    EventMode,
    /// Between events.
    ContinuousTimeMode,
    /// The simulation is over.
    Terminated,
    /// The model could not go on; values are for debugging only.
    Error,
}

impl Stage {
    /// All of them.
    pub const ALL: [Stage; 10] = [
        Stage::Instantiated,
        Stage::InitializationMode,
        Stage::StepComplete,
        Stage::IntermediateUpdateMode,
        Stage::IntermediateOutputs,
        Stage::StepFailed,
        Stage::EventMode,
        Stage::ContinuousTimeMode,
        Stage::Terminated,
        Stage::Error,
    ];

    /// The stages within a step, in which the host is called back.
    pub(crate) const WITHIN_STEP: Stages = Stage::IntermediateUpdateMode.bit() | Stage::IntermediateOutputs.bit();

    /// Whether a step is under way.
    pub const fn is_within_step(self) -> bool {
        self.bit() & Stage::WITHIN_STEP != 0
    }

    /// The set of this stage alone.
    pub const fn bit(self) -> Stages {
        1 << self as u8
    }

    /// Whether initialization has ended.
    pub const fn has_started(self) -> bool {
        !matches!(self, Stage::Instantiated | Stage::InitializationMode)
    }
}

impl fmt::Display for Stage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Stage::Instantiated => "instantiated",
            Stage::InitializationMode => "initialization mode",
            Stage::StepComplete => "step complete",
            Stage::IntermediateUpdateMode => "intermediate update mode, for inputs",
            Stage::IntermediateOutputs => "intermediate update mode, for outputs",
            Stage::StepFailed => "step failed",
            Stage::EventMode => "event mode",
            Stage::ContinuousTimeMode => "continuous-time mode",
            Stage::Terminated => "terminated",
            Stage::Error => "error",
        })
    }
}

/// A set of stages: of each the bit [`Stage::bit`].
pub type Stages = u16;

/// The stages that each function of a version may be called in, by its place in the version's `Function`.
pub type Table = [Stages; 128];

/// The names of `stages`, for a message.
pub(crate) fn names(stages: Stages) -> String {
    let listed = Stage::ALL.into_iter().filter(|stage| stage.bit() & stages != 0);
    let names: Vec<_> = listed.map(|stage| stage.to_string()).collect();
    if names.is_empty() { "none".to_owned() } else { names.join(", ") }
}

/// The tables of a version's two interfaces: the stages, and a row for the functions of the version's `Function` that may
/// be called in one. x is for both interfaces, s for a slave in co-simulation, m for a model, - for neither. The others may
/// be called nowhere.
#[cfg(not(target_family = "wasm"))]
macro_rules! tables {
    ([$($of:tt $stage:ident),*] $($($function:ident)+ [$($mark:tt)+])*) => {
        /// The stages that each function of a slave may be called in.
        pub(crate) static CO_SIMULATION: $crate::state_machine::Table = table("s");

        /// The stages that each function of a model may be called in.
        pub(crate) static MODEL_EXCHANGE: $crate::state_machine::Table = table("m");

        const fn table(interface: &str) -> $crate::state_machine::Table {
            use $crate::state_machine::{Stage, Table, is_for};
            let stages = [$((Stage::$stage, is_for(stringify!($of), interface))),*];
            let mut table: Table = [0; 128];
            $({
                let marks = [$(is_for(stringify!($mark), interface)),+];
                let mut at = 0;
                while at < stages.len() {
                    let (stage, is_known) = stages[at];
                    $(table[Function::$function as usize] |= if is_known && marks[at] { stage.bit() } else { 0 };)+
                    at += 1;
                }
            })*
            table
        }
    };
}
#[cfg(not(target_family = "wasm"))]
pub(crate) use tables;

/// Whether `mark` is for `interface`, s or m.
pub(crate) const fn is_for(mark: &str, interface: &str) -> bool {
    mark.as_bytes()[0] == b'x' || mark.as_bytes()[0] == interface.as_bytes()[0]
}
