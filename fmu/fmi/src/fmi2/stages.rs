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
    SetDebugLogging Reset GetFMUstate SetFMUstate FreeFMUstate SerializedFMUstateSize SerializeFMUstate
    DeSerializeFMUstate           [x x x x x x x x]
    SetupExperiment EnterInitializationMode
                                  [x - - - - - - -]
    ExitInitializationMode        [- x - - - - - -]
    Terminate                     [- - x x x x - -]
    GetReal GetInteger GetBoolean GetString GetDirectionalDerivative
                                  [- x x x x x x x]
    SetReal                       [x x x - x x - -]
    SetInteger SetBoolean SetString
                                  [x x x - x - - -]
    SetRealInputDerivatives       [s s x - - - - -]
    GetRealOutputDerivatives      [- - x x - - s s]
    DoStep                        [- - x - - - - -]
    GetStatus GetRealStatus GetIntegerStatus GetBooleanStatus GetStringStatus
                                  [- - x x - - s -]
    EnterEventMode SetTime        [- - - - x x - -]
    NewDiscreteStates EnterContinuousTimeMode
                                  [- - - - x - - -]
    CompletedIntegratorStep SetContinuousStates
                                  [- - - - - x - -]
    GetDerivatives GetEventIndicators GetContinuousStates
                                  [- m - - x x m m]
    GetNominalsOfContinuousStates [m m - - x x m m]
}
