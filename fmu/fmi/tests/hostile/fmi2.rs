//! FMI 2.0: how its functions are called, when they may be, how instances are made.

use super::arguments::*;
use super::{C, ERROR, FunctionTable, HostLog, TestedVersion};
use crate::fmi2::*;
use fastrand::Rng;
use fmi_unit::c_abi::Function as _;
use fmi_unit::interface::Interface;
use fmi_unit::state_machine::Stage::*;
use libc::{c_char, c_int, c_void};
use std::ptr::null;

pub const VERSION: TestedVersion = TestedVersion {
    name: "fmi2",
    functions: || Function::ALL.iter().map(|function| &function.name()[4..]).collect(),
    calls: calls! { call: [GetFMUstate SetFMUstate FreeFMUstate SerializedFMUstateSize SerializeFMUstate DeSerializeFMUstate] GetDerivatives
        SetupExperiment(
            call.integer(0..2), call.within(1e-14, 0.1), call.within(1e-3, 1.0), call.integer(0..2), call.within(1.0, 1e6)
        )
        EnterInitializationMode()
        GetReal(call.references(ANY), call.count(), call.reals_of_references())
        GetInteger(call.references(NUMBER), call.count(), call.values())
        GetBoolean(call.references(BOOLEAN), call.count(), call.values())
        GetString(call.references(TEXT), call.count(), call.values())
        SetReal(call.references_to_set(), call.count(), call.reals_to_set())
        SetInteger(call.references(NUMBER_TO_SET), call.count(), call.integers(0..8))
        SetBoolean(call.references(SWITCH), call.count(), call.integers(0..2))
        SetString(call.references(TEXT), call.count(), call.texts(&call.subject.texts))
        GetDirectionalDerivative(
            call.unknowns(), call.count(), call.references(INPUT), call.count(), call.seed(), call.derivatives()
        )
        SetRealInputDerivatives(call.references_to_set(), call.count(), call.integers(1..2), call.reals_to_set())
        GetRealOutputDerivatives(
            call.references(OUTPUT), call.count(), call.integers(1..2), call.reals_of_references()
        )
        DoStep(call.point(), call.step(), call.integer(0..2))
        CancelStep()
        GetStatus(call.integer(0..4), call.room(1))
        GetRealStatus(call.integer(0..4), call.finite(1))
        GetIntegerStatus(call.integer(0..4), call.room(1))
        GetBooleanStatus(call.integer(0..4), call.room(1))
        GetStringStatus(call.integer(0..4), call.room(1))
        NewDiscreteStates(call.room(1))
    },
    table: TABLE,
    first_reference: 0,
    location: |folder| format!("file://{}", folder.display()),
    instantiate,
    free: FreeInstance,
    get_state: GetFMUstate,
    free_state: FreeFMUstate,
    size: SerializedFMUstateSize,
    serialize: SerializeFMUstate,
};

/// The tables of FMI 2.0.4: section 4.2.4 for a slave, whose steps are synchronous, so that it is never in a step in progress
/// or canceled, and section 3.2.3 for a model. Some functions are for some variables only, or their values good for
/// debugging only. Since 2.0.1 time is set at an event of models without continuous states alone, before of all.
const TABLE: FunctionTable = FunctionTable {
    stages: &[
        ("x", Instantiated),
        ("x", InitializationMode),
        ("s", StepComplete),
        ("s", StepFailed),
        ("m", EventMode),
        ("m", ContinuousTimeMode),
        ("x", Terminated),
        ("x", Error),
    ],
    rows: "\
        x x x x x x x x  SetDebugLogging Reset GetFMUstate SetFMUstate FreeFMUstate
        x x x x x x x x  SerializedFMUstateSize SerializeFMUstate DeSerializeFMUstate
        x - - - - - - -  SetupExperiment EnterInitializationMode
        - x - - - - - -  ExitInitializationMode
        x x x - x x - -  SetReal
        x x x - x - - -  SetInteger SetBoolean SetString
        s s s - - - - -  SetRealInputDerivatives
        - x x x x x x x  GetReal GetInteger GetBoolean GetString GetDirectionalDerivative
        - - s s - - s s  GetRealOutputDerivatives
        - - s - - - - -  DoStep
        - - s s - - s -  GetStatus GetRealStatus GetIntegerStatus GetBooleanStatus GetStringStatus
        - - x x x x - -  Terminate
        m m - - m m m m  GetNominalsOfContinuousStates
        - m - - m m m m  GetDerivatives GetEventIndicators GetContinuousStates
        - - - - m - - -  NewDiscreteStates EnterContinuousTimeMode
        - - - - m m - -  SetTime EnterEventMode
        - - - - - m - -  CompletedIntegratorStep SetContinuousStates",
};

fn instantiate(rng: &mut Rng, interface: Interface, [name, guid, location]: [*const c_char; 3], told: &HostLog) -> C {
    // the logger has no further arguments to read, so that it may be declared without them
    let logger: unsafe extern "C" fn(_, _, _, _, _) = tell;
    let functions = CallbackFunctions {
        logger: Some(unsafe { std::mem::transmute::<*const (), CallbackLogger>(logger as *const ()) }),
        allocate_memory: null(),
        free_memory: null(),
        step_finished: null(),
        component_environment: (&raw const *told).cast_mut().cast(),
    };
    let kind = c_int::from(interface != Interface::ModelExchange);
    unsafe { Instantiate(name, kind, guid, location, &functions, 0, rng.i32(0..2)) }
}

type TextPointer = *const c_char;

unsafe extern "C" fn tell(told: *mut c_void, _: TextPointer, status: c_int, _: TextPointer, text: TextPointer) {
    unsafe {
        (*told.cast::<HostLog>()).tell(status, text, |c| {
            FreeInstance(c);
            assert_eq!((DoStep(c, 0.0, 1.0, 0), Reset(c)), (ERROR, ERROR));
        });
    }
}
