//! FMI 3.0: how its functions are called, when they may be, how instances are made.

use super::arguments::*;
use super::{C, ERROR, FunctionTable, HostLog, TestedVersion};
use crate::fmi3::*;
use fastrand::Rng;
use fmi_unit::c_abi::Function as _;
use fmi_unit::interface::{Interface, Stepping};
use fmi_unit::state_machine::Stage::*;
use libc::{c_char, c_int, c_void};
use std::ptr::null;

pub const VERSION: TestedVersion = TestedVersion {
    name: "fmi3",
    functions: || Function::ALL.iter().map(|function| &function.name()[4..]).collect(),
    calls: calls! { call: [GetFMUState SetFMUState FreeFMUState SerializedFMUStateSize SerializeFMUState DeserializeFMUState]
        GetContinuousStateDerivatives
        EnterInitializationMode(
            call.integer(0..2), call.within(1e-14, 0.1), call.within(1e-3, 1.0), call.integer(0..2), call.within(1.0, 1e6)
        )
        GetFloat64(call.references(ANY), call.count(), call.reals_of_references(), call.count_of_values())
        GetInt32(call.references(INTEGER), call.count(), call.values(), call.count_of_values())
        GetInt64(call.references(NUMBER), call.count(), call.values(), call.count_of_values())
        GetBoolean(call.references(BOOLEAN), call.count(), call.values(), call.count_of_values())
        GetString(call.references(TEXT), call.count(), call.values(), call.count_of_values())
        SetFloat64(call.references_to_set(), call.count(), call.reals_to_set(), call.count_of_values())
        SetInt32(call.references(INTEGER), call.count(), call.integers(0..8), call.count_of_values())
        SetInt64(call.references(NUMBER_TO_SET), call.count(), call.integers(0..8), call.count_of_values())
        SetBoolean(call.references(SWITCH), call.count(), call.integers(0..2), call.count_of_values())
        SetString(call.references(TEXT), call.count(), call.texts(&call.subject.texts), call.count_of_values())
        GetDirectionalDerivative(
            call.unknowns(), call.count(), call.references(INPUT), call.count(), call.seed(), call.count_of_values(),
            call.derivatives(), call.count_of_values()
        )
        EvaluateDiscreteStates()
        UpdateDiscreteStates(
            call.room(1), call.room(1), call.room(1), call.room(1), call.room(1), call.finite(1)
        )
        EnterStepMode()
        GetOutputDerivatives(
            call.references(OUTPUT), call.count(), call.integers(1..2), call.reals_of_references(), call.count_of_values()
        )
        DoStep(
            call.point(), call.step(), call.integer(0..2), call.room(1), call.room(1), call.room(1), call.finite(1)
        )
        GetNumberOfEventIndicators(call.room(1))
        GetNumberOfContinuousStates(call.room(1))
        EnterConfigurationMode()
    },
    table: TABLE,
    first_reference: 1,
    location: |folder| format!("{}/", folder.display()),
    instantiate,
    free: FreeInstance,
    get_state: GetFMUState,
    free_state: FreeFMUState,
    size: SerializedFMUStateSize,
    serialize: SerializeFMUState,
};

/// The standard's sections 2.3, 4.2.1 for a slave and 3.2.1 for a model, by the functions that each state names. Step failed,
/// terminated and error are its "terminated"; after a failed step a simulation has still to be terminated. Within an
/// intermediate update the host can either set inputs or get all values; a step is no state to keep or to leave. As in the
/// Reference FMUs, the numbers of states and of event indicators can be had at any time, and time can be set at an event.
const TABLE: FunctionTable = FunctionTable {
    stages: &[
        ("x", Instantiated),
        ("x", InitializationMode),
        ("s", StepComplete),
        ("s", IntermediateUpdateMode),
        ("s", IntermediateOutputs),
        ("s", StepFailed),
        ("x", EventMode),
        ("m", ContinuousTimeMode),
        ("x", Terminated),
        ("x", Error),
    ],
    rows: "\
        x x x x x x x x x x  SetDebugLogging GetNumberOfEventIndicators GetNumberOfContinuousStates
        x x x - - x x x x x  Reset GetFMUState SetFMUState FreeFMUState
        x x x - - x x x x x  SerializedFMUStateSize SerializeFMUState DeserializeFMUState
        x - - - - - - - - -  EnterInitializationMode
        - x - - - - - - - -  ExitInitializationMode
        x x x x - - x x - -  SetFloat64
        x x x - - - x - - -  SetInt32 SetInt64 SetBoolean SetString
        x x x - x x x x x x  GetFloat64 GetInt32 GetInt64 GetBoolean GetString
        - x x - - x x x x x  GetDirectionalDerivative
        - - s - s s - - s s  GetOutputDerivatives
        - - s - - - - - - -  DoStep
        - - s - - - - m - -  EnterEventMode
        - - x - - x x x - -  Terminate
        - - - - - - x - - -  EvaluateDiscreteStates UpdateDiscreteStates
        - - - - - - s - - -  EnterStepMode
        - m - - - - m m m m  GetContinuousStateDerivatives GetNominalsOfContinuousStates
        - m - - - - m m m m  GetEventIndicators GetContinuousStates
        - - - - - - m - - -  EnterContinuousTimeMode
        - - - - - - m m - -  SetTime
        - - - - - - - m - -  CompletedIntegratorStep SetContinuousStates",
};

fn instantiate(rng: &mut Rng, interface: Interface, [name, token, folder]: [*const c_char; 3], told: &HostLog) -> C {
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
        (*environment.cast::<HostLog>()).tell(status, text, |c| {
            FreeInstance(c);
            assert_eq!((Terminate(c), Reset(c)), (ERROR, ERROR));
        });
    }
}
