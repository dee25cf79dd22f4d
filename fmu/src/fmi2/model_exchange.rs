//! Which function may be called when: FMI 2.0, section 3.2.3, for a model. Since FMI 2.0.1 time is set at an event of
//! models without continuous states alone; hosts that do so here are let.

use super::Function;
use crate::state_machine::{Stage, Table, table};

#[rustfmt::skip]
table! {
    [                              Instantiated,
                                     InitializationMode,
                                       EventMode,
                                         ContinuousTimeMode,
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
    SetReal                       [x x x x - -]
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
    EnterEventMode                [- - x x - -]
    NewDiscreteStates             [- - x - - -]
    EnterContinuousTimeMode       [- - x - - -]
    CompletedIntegratorStep       [- - - x - -]
    SetTime                       [- - x x - -]
    SetContinuousStates           [- - - x - -]
    GetDerivatives                [- x x x x x]
    GetEventIndicators            [- x x x x x]
    GetContinuousStates           [- x x x x x]
    GetNominalsOfContinuousStates [x x x x x x]
}
