//! FMI 3.0: how its functions are called, when they may be, how instances are made.

use crate::arguments::{SWITCHES, calls};
use crate::{C, Table, Told, Version, host};
use FlexibleRocking::c_abi::Function as _;
use FlexibleRocking::fmi3::*;
use FlexibleRocking::interface::{Interface, Stepping};
use FlexibleRocking::state_machine::Stage;
use fastrand::Rng;
use host::{ERROR, OK, STAGES_OF_MODEL};
use libc::{c_char, c_int, c_void};
use std::ptr::null_mut;

pub const VERSION: Version = Version {
    functions: || Function::ALL.iter().map(|function| function.name()).collect(),
    calls: calls! { call:
        fmi3SetDebugLogging(call.flag(), call.few(), call.categories())
        fmi3EnterInitializationMode(call.flag(), call.tolerance(), call.start(), call.flag(), call.stop())
        fmi3ExitInitializationMode()
        fmi3EnterEventMode()
        fmi3Terminate()
        fmi3Reset()
        fmi3GetFloat64(call.references(&[]), call.count(), call.reals(), call.count_of_values())
        fmi3GetInt32(call.references(&["transitions"]), call.count(), call.values(), call.count_of_values())
        fmi3GetInt64(call.references(&["phase"]), call.count(), call.values(), call.count_of_values())
        fmi3GetBoolean(call.references(&["peaks"]), call.count(), call.values(), call.count_of_values())
        fmi3GetString(call.references(&["record"]), call.count(), call.values(), call.count_of_values())
        fmi3SetFloat64(call.references_to_set(), call.count(), call.reals_to_set(), call.count_of_values())
        fmi3SetInt32(call.references(&["transitions"]), call.count(), call.integers(), call.count_of_values())
        fmi3SetInt64(call.references(&["detail"]), call.count(), call.integers(), call.count_of_values())
        fmi3SetBoolean(call.references(&SWITCHES), call.count(), call.flags(), call.count_of_values())
        fmi3SetString(call.references(&["record"]), call.count(), call.texts(), call.count_of_values())
        fmi3GetFMUState(call.place_of_state())
        fmi3SetFMUState(call.state())
        fmi3FreeFMUState(call.place_of_state())
        fmi3SerializedFMUStateSize(call.state(), call.room(1))
        fmi3SerializeFMUState(call.state(), call.buffer(), call.count())
        fmi3DeserializeFMUState(call.serialized(), call.count(), call.place_of_state())
        fmi3GetDirectionalDerivative(
            call.unknowns(), call.count(), call.knowns(), call.count(), call.seed(), call.count_of_values(),
            call.derivatives(), call.count_of_values()
        )
        fmi3GetAdjointDerivative(
            call.unknowns(), call.count(), call.knowns(), call.count(), call.seed(), call.count_of_unknowns(),
            call.values(), call.count_of_values()
        )
        fmi3EvaluateDiscreteStates()
        fmi3UpdateDiscreteStates(
            call.room(1), call.room(1), call.room(1), call.room(1), call.room(1), call.real()
        )
        fmi3EnterStepMode()
        fmi3GetOutputDerivatives(
            call.references(&["R_h"]), call.count(), call.orders(), call.reals(), call.count_of_values()
        )
        fmi3DoStep(
            call.point(), call.step(), call.flag(), call.room(1), call.room(1), call.room(1), call.real()
        )
        fmi3EnterContinuousTimeMode()
        fmi3CompletedIntegratorStep(call.flag(), call.room(1), call.room(1))
        fmi3SetTime(call.time())
        fmi3SetContinuousStates(call.states(), call.count())
        fmi3GetContinuousStateDerivatives(call.reals_of(4), call.count())
        fmi3GetEventIndicators(call.reals_of(2), call.count())
        fmi3GetContinuousStates(call.reals_of(4), call.count())
        fmi3GetNominalsOfContinuousStates(call.reals_of(4), call.count())
        fmi3GetNumberOfEventIndicators(call.room(1))
        fmi3GetNumberOfContinuousStates(call.room(1))
        fmi3EnterConfigurationMode()
    },
    slave: SLAVE,
    model: MODEL,
    location: |folder| format!("{}/", folder.display()),
    instantiate,
    free: fmi3FreeInstance,
    get_state: fmi3GetFMUState,
    free_state: fmi3FreeFMUState,
    size: fmi3SerializedFMUStateSize,
    serialize: fmi3SerializeFMUState,
    event_indicators: fmi3GetEventIndicators,
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
        - x x - - x x x x  GetDirectionalDerivative GetAdjointDerivative
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
        - x x x x x  GetDirectionalDerivative GetAdjointDerivative GetContinuousStateDerivatives
        - x x x x x  GetEventIndicators GetContinuousStates GetNominalsOfContinuousStates
        - - x - - -  EvaluateDiscreteStates UpdateDiscreteStates EnterContinuousTimeMode
        - - x x - -  SetTime Terminate
        - - - x - -  EnterEventMode CompletedIntegratorStep SetContinuousStates",
};

/// A host of co-simulation may have itself called back in every step for the ground's acceleration.
fn instantiate(
    rng: &mut Rng,
    interface: Interface,
    [name, token, folder]: [*const c_char; 3],
    told: Option<&Told>,
) -> C {
    let logging_on = if rng.u8(..20) == 0 { rng.u8(..) } else { rng.u8(0..2) };
    let environment = told.map_or(null_mut(), |told| (&raw const *told).cast_mut().cast());
    let log = told.map(|_| tell as LogMessageCallback);
    let Interface::CoSimulation(Stepping { event_mode, early_return }) = interface else {
        return unsafe { fmi3InstantiateModelExchange(name, token, folder, 0, logging_on, environment, log) };
    };
    let update = told.filter(|_| rng.bool()).map(|_| update as IntermediateUpdateCallback);
    let [event_mode, early_return] =
        [event_mode, early_return].map(|flag| if rng.u8(..40) == 0 { 2 } else { u8::from(flag) });
    let required = [host::reference("a_g"), rng.u32(..200)];
    let n = if update.is_some() { 1 + usize::from(rng.u8(..20) == 0) } else { 0 };
    let required = required.as_ptr();
    unsafe {
        fmi3InstantiateCoSimulation(
            name,
            token,
            folder,
            0,
            logging_on,
            event_mode,
            early_return,
            required,
            n,
            environment,
            log,
            update,
        )
    }
}

unsafe extern "C" fn tell(environment: *mut c_void, status: c_int, _: *const c_char, text: *const c_char) {
    unsafe {
        (*environment.cast::<Told>()).tell(status, text, |c| {
            fmi3FreeInstance(c);
            assert_eq!((fmi3Terminate(c), fmi3Reset(c)), (ERROR, ERROR));
        });
    }
}

/// Sets the input or reads a value, as it is asked to, and tries the other and what it must not. What is said to it is not said
/// of the step.
unsafe extern "C" fn update(environment: *mut c_void, _: f64, set: u8, get: u8, _: u8, _: u8, _: *mut u8, _: *mut f64) {
    let told = unsafe { &*environment.cast::<Told>() };
    let ((c, a_g), before) = (told.asked.get(), told.messages.take());
    let (called, reference) = (told.call_back.replace(null_mut()), host::reference("a_g"));
    unsafe {
        fmi3FreeInstance(c);
        assert_eq!((fmi3Terminate(c), fmi3Reset(c), fmi3GetFMUState(c, &mut null_mut())), (ERROR, ERROR, ERROR));
        assert_eq!(fmi3GetFloat64(c, &reference, 1, &mut 0.0, 1) == OK, get == 1);
        assert!(set == 1 || fmi3SetFloat64(c, &reference, 1, &0.0, 1) == ERROR);
        assert!([OK, ERROR].contains(&fmi3SetFloat64(c, &reference, 1, &a_g, 1)));
    }
    told.messages.replace(before);
    told.call_back.set(called);
}
