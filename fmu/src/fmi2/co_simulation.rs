//! Which function may be called when: FMI 2.0, section 4.2.4, for a slave whose steps are synchronous (it is never in
//! the standard's states "step in progress" and "step canceled").

use super::Function;
use crate::state_machine::{Stage, Table, table};

#[rustfmt::skip]
table! {
    [                              Instantiated,
                                     InitializationMode,
                                       StepComplete,
                                         StepFailed,
                                           Terminated,
                                             Error]
    SetDebugLogging               [x x x x x x]
    SetupExperiment               [x - - - - -]
    EnterInitializationMode       [x - - - - -]
    ExitInitializationMode        [- x - - - -]
    Terminate                     [- - x x - -]
    Reset                         [x x x x x x]
    GetReal                       [- x x x x x]
    GetInteger                    [- x x x x x]
    GetBoolean                    [- x x x x x]
    GetString                     [- x x x x x]
    SetReal                       [x x x - - -]
    SetInteger                    [x x x - - -]
    SetBoolean                    [x x x - - -]
    SetString                     [x x x - - -]
    GetFMUstate                   [x x x x x x]
    SetFMUstate                   [x x x x x x]
    FreeFMUstate                  [x x x x x x]
    SerializedFMUstateSize        [x x x x x x]
    SerializeFMUstate             [x x x x x x]
    DeSerializeFMUstate           [x x x x x x]
    GetDirectionalDerivative      [- x x x x x]
    SetRealInputDerivatives       [x x x - - -]
    GetRealOutputDerivatives      [- - x x x x]
    DoStep                        [- - x - - -]
    GetStatus                     [- - x x x -]
    GetRealStatus                 [- - x x x -]
    GetIntegerStatus              [- - x x x -]
    GetBooleanStatus              [- - x x x -]
    GetStringStatus               [- - x x x -]
}
