//! FMI 3.0: how its functions are called, when they may be, how instances are made.

use super::arguments::{
    CATEGORIES, calls, is_any, is_boolean, is_integer, is_number, is_number_to_set, is_output, is_switch, is_text,
};
use super::{C, ERROR, STAGES_OF_MODEL, Table, Told, Version};
use crate::fmi3::*;
use fastrand::Rng;
use fmi_unit::c_abi::Function as _;
use fmi_unit::interface::{Interface, Stepping};
use fmi_unit::state_machine::Stage;
use libc::{c_char, c_int, c_void};
use std::ptr::null;

pub const VERSION: Version = Version {
    name: "fmi3",
    functions: || Function::ALL.iter().map(|function| &function.name()[4..]).collect(),
    calls: calls! { call: [GetFMUState SetFMUState FreeFMUState SerializedFMUStateSize SerializeFMUState DeserializeFMUState]
        GetContinuousStateDerivatives
        EnterInitializationMode(
            call.integer(0..2), call.within(1e-14, 0.1), call.within(1e-3, 1.0), call.integer(0..2), call.within(1.0, 1e6)
        )
        GetFloat64(call.references(is_any), call.count(), call.reals_of_references(), call.count_of_values())
        GetInt32(call.references(is_integer), call.count(), call.values(), call.count_of_values())
        GetInt64(call.references(is_number), call.count(), call.values(), call.count_of_values())
        GetBoolean(call.references(is_boolean), call.count(), call.values(), call.count_of_values())
        GetString(call.references(is_text), call.count(), call.values(), call.count_of_values())
        SetFloat64(call.references_to_set(), call.count(), call.reals_to_set(), call.count_of_values())
        SetInt32(call.references(is_integer), call.count(), call.integers(0..8), call.count_of_values())
        SetInt64(call.references(is_number_to_set), call.count(), call.integers(0..8), call.count_of_values())
        SetBoolean(call.references(is_switch), call.count(), call.integers(0..2), call.count_of_values())
        SetString(call.references(is_text), call.count(), call.texts(&call.subject.texts), call.count_of_values())
        GetDirectionalDerivative(
            call.unknowns(), call.count(), call.knowns(), call.count(), call.seed(), call.count_of_values(),
            call.derivatives(), call.count_of_values()
        )
        EvaluateDiscreteStates()
        UpdateDiscreteStates(
            call.room(1), call.room(1), call.room(1), call.room(1), call.room(1), call.finite(1)
        )
        EnterStepMode()
        GetOutputDerivatives(
            call.references(is_output), call.count(), call.integers(1..2), call.reals_of_references(), call.count_of_values()
        )
        DoStep(
            call.point(), call.step(), call.integer(0..2), call.room(1), call.room(1), call.room(1), call.finite(1)
        )
        GetNumberOfEventIndicators(call.room(1))
        GetNumberOfContinuousStates(call.room(1))
        EnterConfigurationMode()
    },
    slave: SLAVE,
    model: MODEL,
    first_reference: 1,
    location: |folder| format!("{}/", folder.display()),
    instantiate,
    free: FreeInstance,
    get_state: GetFMUState,
    free_state: FreeFMUState,
    size: SerializedFMUStateSize,
    serialize: SerializeFMUState,
};

/// The standard's sections 2.3 and 4.2.1, by the functions that each state names. Step failed, terminated and error are
/// its "terminated"; after the first of them a simulation has still to be terminated. Within an intermediate update the
/// inputs can be set, or all values be had: it is said which, and a step is no state to keep or to leave. The numbers of
/// states and of event indicators can be had at any time, as of the Reference FMUs.
const SLAVE: Table = Table {
    stages: &[
        Stage::Instantiated,
        Stage::InitializationMode,
        Stage::StepComplete,
        Stage::IntermediateUpdateMode,
        Stage::IntermediateOutputs,
        Stage::StepFailed,
        Stage::EventMode,
        Stage::Terminated,
        Stage::Error,
    ],
    rows: "\
        x x x x x x x x x  SetDebugLogging GetNumberOfEventIndicators GetNumberOfContinuousStates
        x x x - - x x x x  Reset GetFMUState SetFMUState FreeFMUState
        x x x - - x x x x  SerializedFMUStateSize SerializeFMUState DeserializeFMUState
        x - - - - - - - -  EnterInitializationMode
        - x - - - - - - -  ExitInitializationMode
        x x x x - - x - -  SetFloat64
        x x x - - - x - -  SetInt32 SetInt64 SetBoolean SetString
        x x x - x x x x x  GetFloat64 GetInt32 GetInt64 GetBoolean GetString
        - x x - - x x x x  GetDirectionalDerivative
        - - x - x x - x x  GetOutputDerivatives
        - - x - - - - - -  DoStep EnterEventMode
        - - x - - x x - -  Terminate
        - - - - - - x - -  EvaluateDiscreteStates UpdateDiscreteStates EnterStepMode",
};

/// The standard's sections 2.3 and 3.2.1 for a model; error is its "terminated" after an error. Beyond them the Reference
/// FMUs let time be set at an event, and the numbers be had at any time.
const MODEL: Table = Table {
    stages: &STAGES_OF_MODEL,
    rows: "\
        x x x x x x  SetDebugLogging GetNumberOfEventIndicators GetNumberOfContinuousStates Reset
        x x x x x x  GetFMUState SetFMUState FreeFMUState SerializedFMUStateSize SerializeFMUState DeserializeFMUState
        x x x x x x  GetFloat64 GetInt32 GetInt64 GetBoolean GetString
        x - - - - -  EnterInitializationMode
        - x - - - -  ExitInitializationMode
        x x x x - -  SetFloat64
        x x x - - -  SetInt32 SetInt64 SetBoolean SetString
        - x x x x x  GetDirectionalDerivative GetContinuousStateDerivatives
        - x x x x x  GetEventIndicators GetContinuousStates GetNominalsOfContinuousStates
        - - x - - -  EvaluateDiscreteStates UpdateDiscreteStates EnterContinuousTimeMode
        - - x x - -  SetTime Terminate
        - - - x - -  EnterEventMode CompletedIntegratorStep SetContinuousStates",
};

fn instantiate(rng: &mut Rng, interface: Interface, [name, token, folder]: [*const c_char; 3], told: &Told) -> C {
    let (told, tell) = ((&raw const *told).cast_mut().cast(), Some(tell as LogMessageCallback));
    let (events, required, count, update) = (rng.u8(0..2), null(), 0, None);
    unsafe {
        match interface {
            Interface::CoSimulation(Stepping { event_mode, early_return }) => {
                let [event_mode, early] = [event_mode.into(), early_return.into()];
                InstantiateCoSimulation(
                    name, token, folder, 0, events, event_mode, early, required, count, told, tell, update,
                )
            }
            Interface::ModelExchange => InstantiateModelExchange(name, token, folder, 0, events, told, tell),
        }
    }
}

unsafe extern "C" fn tell(environment: *mut c_void, status: c_int, _: *const c_char, text: *const c_char) {
    unsafe {
        (*environment.cast::<Told>()).tell(status, text, |c| {
            FreeInstance(c);
            assert_eq!((Terminate(c), Reset(c)), (ERROR, ERROR));
        });
    }
}
