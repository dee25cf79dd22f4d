//! The states of an instance, as the standard has them, and what tables of the functions that may be called in them are
//! made of: one table for each interface of each version.

use serde::{Deserialize, Serialize};
use std::fmt;

/// A state of FMI's state machine, called stage here: `State` is that of the structure.
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
    /// The same at its end, while the host reads what it has led to.
    IntermediateOutputs,
    /// The structure has overturned; there is nothing left to step to.
    StepFailed,
    /// At an event.
    EventMode,
    /// Between events.
    ContinuousTimeMode,
    /// The simulation is over.
    Terminated,
    /// The solver could not go on; values are good for debugging only.
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

    /// Whether a step is under way, within which the host has the instance on loan.
    pub const fn is_within_step(self) -> bool {
        matches!(self, Stage::IntermediateUpdateMode | Stage::IntermediateOutputs)
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
            Stage::StepFailed => "step failed (overturned)",
            Stage::EventMode => "event mode",
            Stage::ContinuousTimeMode => "continuous-time mode",
            Stage::Terminated => "terminated",
            Stage::Error => "error",
        })
    }
}

/// Whether a function may be called in a stage.
pub type IsAllowed<F> = fn(F, Stage) -> bool;

/// The stages that `function` may be called in, for a message.
pub(crate) fn stages<F: Copy>(function: F, is_allowed: IsAllowed<F>) -> String {
    let names: Vec<_> =
        Stage::ALL.into_iter().filter(|stage| is_allowed(function, *stage)).map(|stage| stage.to_string()).collect();
    if names.is_empty() { "none".to_owned() } else { names.join(", ") }
}

/// A table of an interface: the stages that it knows, and a row for every function of the version's `Function`, with x
/// where it may be called and - where not; behind a last - those that may be called nowhere.
macro_rules! table {
    ([$($stage:ident),* $(,)?] $($function:ident [$($mark:tt)+])* - $($never:ident)*) => {
        /// The stages of this interface.
        const STAGES: &[Stage] = &[$(Stage::$stage),*];

        /// Whether `function` may be called in `stage`.
        pub(crate) fn is_allowed(function: Function, stage: Stage) -> bool {
            let marks: [bool; STAGES.len()] = match function {
                $(Function::$function => [$($crate::state_machine::table!(@ $mark)),+],)*
                $(Function::$never)|* => return false,
            };
            STAGES.iter().zip(marks).any(|(column, mark)| mark && *column == stage)
        }
    };
    (@ x) => { true };
    (@ -) => { false };
}
pub(crate) use table;
