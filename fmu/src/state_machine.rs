//! Which function may be called when: FMI 2.0, section 4.2.4, for a slave whose steps are synchronous (it is never in
//! the standard's states "step in progress" and "step canceled").

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
    /// The structure has overturned; there is nothing left to step to.
    StepFailed,
    /// The simulation is over.
    Terminated,
    /// The solver could not go on; values are good for debugging only.
    Error,
}

impl Stage {
    /// All of them.
    pub const ALL: [Stage; 6] = [
        Stage::Instantiated,
        Stage::InitializationMode,
        Stage::StepComplete,
        Stage::StepFailed,
        Stage::Terminated,
        Stage::Error,
    ];

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
            Stage::StepFailed => "step failed (overturned)",
            Stage::Terminated => "terminated",
            Stage::Error => "error",
        })
    }
}

macro_rules! functions {
    ($($function:ident $instantiated:tt $initialization:tt $complete:tt $failed:tt $terminated:tt $error:tt,)*) => {
        /// The functions of an instance, but for `fmi2FreeInstance`, which may always be called.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Function {
            $(#[doc = concat!("`fmi2", stringify!($function), "`")] $function,)*
        }

        impl Function {
            /// All of them.
            pub const ALL: &[Function] = &[$(Function::$function),*];

            /// Its name in the C interface.
            pub const fn name(self) -> &'static str {
                match self {
                    $(Function::$function => concat!("fmi2", stringify!($function)),)*
                }
            }

            /// Whether it may be called in `stage`.
            pub const fn is_allowed_in(self, stage: Stage) -> bool {
                match self {
                    $(Function::$function => match stage {
                        Stage::Instantiated => functions!(@ $instantiated),
                        Stage::InitializationMode => functions!(@ $initialization),
                        Stage::StepComplete => functions!(@ $complete),
                        Stage::StepFailed => functions!(@ $failed),
                        Stage::Terminated => functions!(@ $terminated),
                        Stage::Error => functions!(@ $error),
                    },)*
                }
            }
        }
    };
    (@ x) => { true };
    (@ -) => { false };
}

#[rustfmt::skip]
functions! {
    //                       instantiated
    //                          initialization mode
    //                             step complete
    //                                step failed
    //                                   terminated
    //                                      error
    SetDebugLogging          x  x  x  x  x  x,
    SetupExperiment          x  -  -  -  -  -,
    EnterInitializationMode  x  -  -  -  -  -,
    ExitInitializationMode   -  x  -  -  -  -,
    Terminate                -  -  x  x  -  -,
    Reset                    x  x  x  x  x  x,
    GetReal                  -  x  x  x  x  x,
    GetInteger               -  x  x  x  x  x,
    GetBoolean               -  x  x  x  x  x,
    GetString                -  x  x  x  x  x,
    SetReal                  x  x  x  -  -  -,
    SetInteger               x  x  x  -  -  -,
    SetBoolean               x  x  x  -  -  -,
    SetString                x  x  x  -  -  -,
    GetFMUstate              x  x  x  x  x  x,
    SetFMUstate              x  x  x  x  x  x,
    FreeFMUstate             x  x  x  x  x  x,
    SerializedFMUstateSize   x  x  x  x  x  x,
    SerializeFMUstate        x  x  x  x  x  x,
    DeSerializeFMUstate      x  x  x  x  x  x,
    GetDirectionalDerivative -  x  x  x  x  x,
    SetRealInputDerivatives  x  x  x  -  -  -,
    GetRealOutputDerivatives -  -  x  x  x  x,
    DoStep                   -  -  x  -  -  -,
    CancelStep               -  -  -  -  -  -,
    GetStatus                -  -  x  x  x  -,
    GetRealStatus            -  -  x  x  x  -,
    GetIntegerStatus         -  -  x  x  x  -,
    GetBooleanStatus         -  -  x  x  x  -,
    GetStringStatus          -  -  x  x  x  -,
}

impl Function {
    /// The stages that it may be called in, for a message.
    pub fn stages(self) -> String {
        let names: Vec<_> =
            Stage::ALL.into_iter().filter(|stage| self.is_allowed_in(*stage)).map(|stage| stage.to_string()).collect();
        if names.is_empty() { "none".to_owned() } else { names.join(", ") }
    }
}
