//! Which function may be called when: FMI 3.0, sections 2.3 and 4.2.1. Beside the standard's states stand "step
//! failed", to which overturning leads, after which there is nothing to step to, and "error", in which the solver could
//! not go on.

use super::Function;
use crate::state_machine::{Stage, Table, table};

#[rustfmt::skip]
table! {
    [                                Instantiated,
                                       InitializationMode,
                                         StepComplete,
                                           EventMode,
                                             IntermediateUpdateMode,
                                               IntermediateOutputs,
                                                 StepFailed,
                                                   Terminated,
                                                     Error]
    SetDebugLogging                 [x x x x x x x x x]
    EnterInitializationMode         [x - - - - - - - -]
    ExitInitializationMode          [- x - - - - - - -]
    EnterEventMode                  [- - x - - - - - -]
    Terminate                       [- - x x - - x - -]
    Reset                           [x x x x - - x x x]
    GetFloat64                      [x x x x - x x x x]
    GetInt32                        [x x x x - x x x x]
    GetInt64                        [x x x x - x x x x]
    GetBoolean                      [x x x x - x x x x]
    GetString                       [x x x x - x x x x]
    SetFloat64                      [x x x x x - - - -]
    SetInt32                        [x x x x - - - - -]
    SetInt64                        [x x x x - - - - -]
    SetBoolean                      [x x x x - - - - -]
    SetString                       [x x x x - - - - -]
    GetFMUState                     [x x x x - - x x x]
    SetFMUState                     [x x x x - - x x x]
    FreeFMUState                    [x x x x - - x x x]
    SerializedFMUStateSize          [x x x x - - x x x]
    SerializeFMUState               [x x x x - - x x x]
    DeserializeFMUState             [x x x x - - x x x]
    GetDirectionalDerivative        [- x x x - - x x x]
    GetAdjointDerivative            [- x x x - - x x x]
    EvaluateDiscreteStates          [- - - x - - - - -]
    UpdateDiscreteStates            [- - - x - - - - -]
    EnterStepMode                   [- - - x - - - - -]
    GetOutputDerivatives            [- - x - - x x x x]
    DoStep                          [- - x - - - - - -]
    GetNumberOfEventIndicators      [x x x x x x x x x]
    GetNumberOfContinuousStates     [x x x x x x x x x]
}
