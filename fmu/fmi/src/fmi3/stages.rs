//! Which function may be called when: FMI 3.0, section 2.3, 4.2.1 for a slave, 3.2.1 for a model. Beside the standard's
//! states stand "step failed", to which a step leads that ends the simulation, and "error", in which
//! the solver could not go on.

use super::Function;
use crate::state_machine::tables;

#[rustfmt::skip]
tables! {
    [                             x Instantiated,
                                    x InitializationMode,
                                      s StepComplete,
                                        s IntermediateUpdateMode,
                                          s IntermediateOutputs,
                                            s StepFailed,
                                              x EventMode,
                                                m ContinuousTimeMode,
                                                  x Terminated,
                                                    x Error]
    SetDebugLogging GetNumberOfEventIndicators GetNumberOfContinuousStates
                                  [x x x x x x x x x x]
    EnterInitializationMode       [x - - - - - - - - -]
    ExitInitializationMode        [- x - - - - - - - -]
    EnterEventMode                [- - x - - - - x - -]
    Terminate                     [- - x - - x x x - -]
    Reset GetFMUState SetFMUState FreeFMUState SerializedFMUStateSize SerializeFMUState DeserializeFMUState
                                  [x x x - - x x x x x]
    GetFloat64 GetInt32 GetInt64 GetBoolean GetString GetFloat32 GetInt8 GetUInt8 GetInt16 GetUInt16 GetUInt32
    GetUInt64 GetBinary GetClock  [x x x - x x x x x x]
    SetFloat64                    [x x x x - - x x - -]
    SetInt32 SetInt64 SetBoolean SetString SetFloat32 SetInt8 SetUInt8 SetInt16 SetUInt16 SetUInt32 SetUInt64
    SetBinary SetClock            [x x x - - - x - - -]
    GetDirectionalDerivative      [- x x - - x x x x x]
    EvaluateDiscreteStates UpdateDiscreteStates
                                  [- - - - - - x - - -]
    EnterStepMode                 [- - - - - - s - - -]
    GetOutputDerivatives          [- - x - x x - - s s]
    DoStep                        [- - x - - - - - - -]
    EnterContinuousTimeMode       [- - - - - - m - - -]
    CompletedIntegratorStep SetContinuousStates
                                  [- - - - - - - x - -]
    SetTime                       [- - - - - - m x - -]
    GetContinuousStateDerivatives GetEventIndicators GetContinuousStates GetNominalsOfContinuousStates
                                  [- m - - - - m x m m]
}
