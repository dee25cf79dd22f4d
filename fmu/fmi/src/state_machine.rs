//! The states of an instance, as in the standard, and the parts of the tables of the functions that may be called in them. Each
//! interface of each version has a table.

use serde::{Deserialize, Serialize};
use std::fmt;

/// The stages, each with its meaning and its name in messages.
macro_rules! stages {
    ($(#[doc = $meaning:literal] $stage:ident: $name:literal)*) => {
        /// A state of FMI's state machine, called stage here: a state is the model's.
        #[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
        pub enum Stage {
            $(#[doc = $meaning] $stage,)*
        }

        impl Stage {
            /// All of them.
            pub const ALL: &[Stage] = &[$(Stage::$stage),*];
        }

        impl fmt::Display for Stage {
            fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
                f.write_str(match self { $(Stage::$stage => $name,)* })
            }
        }
    };
}

stages! {
    /// Created or reset.
    Instantiated: "instantiated"
    /// Between entering and leaving initialization.
    InitializationMode: "initialization mode"
    /// Ready for a step.
    StepComplete: "step complete"
    /// Within a step, while the host is asked for the inputs at its end.
    IntermediateUpdateMode: "intermediate update mode, for inputs"
    /// At the end of a step, while the host reads its outputs.
    IntermediateOutputs: "intermediate update mode, for outputs"
    /// A step has ended the simulation; no further step is possible.
    StepFailed: "step failed"
    /// At an event.
    EventMode: "event mode"
    /// Between events.
    ContinuousTimeMode: "continuous-time mode"
    /// The simulation is over.
    Terminated: "terminated"
    /// The model could not continue; values are for debugging only.
    Error: "error"
}

impl Stage {
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

/// A set of stages: of each the bit [`Stage::bit`].
pub type Stages = u16;

/// The stages that each function of a version may be called in, by its place in the version's `Function`.
pub type LegalStages = [Stages; 128];

/// The names of `stages`, for a message.
pub(crate) fn names(stages: Stages) -> String {
    let listed = Stage::ALL.iter().filter(|stage| stage.bit() & stages != 0);
    let names: Vec<_> = listed.map(|stage| stage.to_string()).collect();
    if names.is_empty() { "no state: this instance does not provide the function".to_owned() } else { names.join(", ") }
}

/// The tables of a version's two interfaces: the stages, and a row for the functions of the version's `Function` that may
/// be called in one. x is for both interfaces, s for a slave in co-simulation, m for a model, - for neither. The others may
/// be called nowhere.
#[cfg(not(target_family = "wasm"))]
macro_rules! tables {
    ([$($of:tt $stage:ident),*] $($($function:ident)+ [$($mark:tt)+])*) => {
        use $crate::interface::Interface;
        use $crate::state_machine::{Stage, LegalStages, is_for};

        /// The stages in which an instance for `interface` accepts each function.
        pub(crate) fn table(interface: Interface) -> &'static LegalStages {
            static CO_SIMULATION: LegalStages = of("s");
            static MODEL_EXCHANGE: LegalStages = of("m");
            if interface == Interface::ModelExchange { &MODEL_EXCHANGE } else { &CO_SIMULATION }
        }

        const fn of(interface: &str) -> LegalStages {
            let stages = [$((Stage::$stage, is_for(stringify!($of), interface))),*];
            let mut table: LegalStages = [0; 128];
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
