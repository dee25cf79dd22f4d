//! Which function may be called when: FMI 2.0, section 4.2.4 for a slave whose steps are synchronous (it is never in the
//! standard's states "step in progress" and "step canceled"), section 3.2.3 for a model. Since FMI 2.0.1 time is set at an
//! event of models without continuous states alone; hosts that do so here are let.

use super::Function;
use crate::state_machine::tables;

#[rustfmt::skip]
tables! {
    [                             x Instantiated,
                                    x InitializationMode,
                                      s StepComplete,
                                        s StepFailed,
                                          m EventMode,
                                            m ContinuousTimeMode,
                                              x Terminated,
                                                x Error]
    SetDebugLogging               [x x x x x x x x]
    SetupExperiment               [x - - - - - - -]
    EnterInitializationMode       [x - - - - - - -]
    ExitInitializationMode        [- x - - - - - -]
    Terminate                     [- - x x x x - -]
    Reset                         [x x x x x x x x]
    GetReal                       [- x x x x x x x]
    GetInteger                    [- x x x x x x x]
    GetBoolean                    [- x x x x x x x]
    GetString                     [- x x x x x x x]
    SetReal                       [x x x - x x - -]
    SetInteger                    [x x x - x - - -]
    SetBoolean                    [x x x - x - - -]
    SetString                     [x x x - x - - -]
    GetFMUstate                   [x x x x x x x x]
    SetFMUstate                   [x x x x x x x x]
    FreeFMUstate                  [x x x x x x x x]
    SerializedFMUstateSize        [x x x x x x x x]
    SerializeFMUstate             [x x x x x x x x]
    DeSerializeFMUstate           [x x x x x x x x]
    GetDirectionalDerivative      [- x x x x x x x]
    SetRealInputDerivatives       [s s x - - - - -]
    GetRealOutputDerivatives      [- - x x - - s s]
    DoStep                        [- - x - - - - -]
    GetStatus                     [- - x x - - s -]
    GetRealStatus                 [- - x x - - s -]
    GetIntegerStatus              [- - x x - - s -]
    GetBooleanStatus              [- - x x - - s -]
    GetStringStatus               [- - x x - - s -]
    EnterEventMode                [- - - - x x - -]
    NewDiscreteStates             [- - - - x - - -]
    EnterContinuousTimeMode       [- - - - x - - -]
    CompletedIntegratorStep       [- - - - - x - -]
    SetTime                       [- - - - x x - -]
    SetContinuousStates           [- - - - - x - -]
    GetDerivatives                [- m - - x x m m]
    GetEventIndicators            [- m - - x x m m]
    GetContinuousStates           [- m - - x x m m]
    GetNominalsOfContinuousStates [m m - - x x m m]
}
