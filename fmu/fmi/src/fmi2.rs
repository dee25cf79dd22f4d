//! The C interface of FMI 2.0: what its functions are called, and what they pass. See [`c_abi`] for what
//! holds of all of them.
#![allow(unsafe_code, clippy::missing_safety_doc, clippy::too_many_arguments)] // as in `c_abi`; the standard's arguments

mod stages;

use crate::c_abi::{self, *};
use crate::failure::Failure;
use crate::interface::{Interface, Stepping};
use crate::logger::{Category, Sink};
use crate::model::{Completed, Experiment, StepEnd, Update};
use crate::state_machine::Stage;
use crate::uri;
use crate::variables::{DataType, Role};
use libc::{c_char, c_double, c_int, c_uint, c_void, size_t};
use std::ffi::CString;
use std::ptr;

/// `fmi2CallbackLogger`
pub type CallbackLogger = unsafe extern "C" fn(*mut c_void, *const c_char, c_int, *const c_char, *const c_char, ...);

/// `fmi2CallbackFunctions`
#[repr(C)]
pub struct CallbackFunctions {
    /// Takes messages.
    pub logger: Option<CallbackLogger>,
    /// Not used: memory is Rust's own.
    pub allocate_memory: *const c_void,
    /// Not used.
    pub free_memory: *const c_void,
    /// Not used: steps are synchronous.
    pub step_finished: *const c_void,
    /// Handed back to the logger.
    pub component_environment: *mut c_void,
}

/// `fmi2EventInfo`
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C)]
pub struct EventInfo {
    /// Whether `fmi2NewDiscreteStates` has to be called again: never.
    pub new_discrete_states_needed: c_int,
    /// Whether the simulation is over.
    pub terminate_simulation: c_int,
    /// Whether magnitudes of states have changed: never.
    pub nominals_of_continuous_states_changed: c_int,
    /// Whether the states are not those that the host set.
    pub values_of_continuous_states_changed: c_int,
    /// Whether the time of the next event is known.
    pub next_event_time_defined: c_int,
    /// Time of the next event, s.
    pub next_event_time: c_double,
}

fn sink(functions: &CallbackFunctions, instance_name: &str) -> Sink {
    let logger = functions.logger?;
    let environment = functions.component_environment;
    let name = CString::new(instance_name).expect("it was read up to its NUL");
    // the host reads a message as a printf format, in which # marks variables
    Some(Box::new(move |status, category, message| unsafe {
        logger(environment, name.as_ptr(), status as c_int, category.as_ptr(), escaped(message, &['%', '#']).as_ptr());
    }))
}

/// The truth that the `fmi2Boolean` `value`, given as `name`, stands for.
fn boolean(name: &str, value: c_int) -> Result<bool, Failure> {
    truth(name, value, "0 (fmi2False), 1 (fmi2True)")
}

/// The item of `fmi2StatusKind` that a host asks for.
fn status_kind(value: c_int) -> Result<&'static str, Failure> {
    let kinds = ["fmi2DoStepStatus", "fmi2PendingStatus", "fmi2LastSuccessfulTime", "fmi2Terminated"];
    let accepted = "0 (fmi2DoStepStatus), 1 (fmi2PendingStatus), 2 (fmi2LastSuccessfulTime), 3 (fmi2Terminated)";
    let kind = usize::try_from(value).ok().and_then(|at| kinds.get(at));
    kind.copied().ok_or(Failure::BadChoice { name: "fmi2StatusKind".into(), value, accepted })
}

const WORDS: Words = Words {
    version: "fmi2",
    magic: 0x466d_6955_6e69_7432,
    first: 0,
    real: "Real",
    integer: "Integer",
    enumeration: "Integer",
    state: "FMUstate",
    set_up: "SetupExperiment",
};

shared_functions! {
    "fmi2" export_fmi2 c_int,
    FMUstate: [GetFMUstate SetFMUstate FreeFMUstate SerializedFMUstateSize SerializeFMUstate DeSerializeFMUstate],
    x nx x_nominal ni: [GetDerivatives],

    { GetTypesPlatform() -> *const c_char { c"default".as_ptr() } }

    { GetVersion() -> *const c_char { c"2.0".as_ptr() } }

    { Instantiate(
        instanceName: *const c_char, fmuType: c_int, fmuGUID: *const c_char, fmuResourceLocation: *const c_char,
        functions: *const CallbackFunctions, _visible: c_int, loggingOn: c_int,
    ) -> *mut c_void {
        if check_pointer("functions", functions).is_err() {
            return ptr::null_mut();
        }
        let name = unsafe { text("instanceName", instanceName) };
        let sink = sink(unsafe { &*functions }, name.as_ref().unwrap_or(&""));
        c_abi::instantiate::<Function>("Instantiate", &[Category::Events], sink, || {
            let accepted = "0 (fmi2ModelExchange), 1 (fmi2CoSimulation)";
            let interface = match fmuType {
                0 => Interface::ModelExchange,
                1 => Interface::CoSimulation(Stepping::default()),
                value => return Err(Failure::BadChoice { name: "fmuType".into(), value, accepted }),
            };
            let guid = unsafe { text("fmuGUID", fmuGUID) };
            let location = unsafe { text("fmuResourceLocation", fmuResourceLocation) };
            let events = boolean("loggingOn", loggingOn);
            if name?.is_empty() {
                return Err(Failure::NoName);
            }
            let location = location?;
            let folder = uri::path(location).ok_or_else(|| Failure::NotAFileUri(location.to_owned()))?;
            Ok((c_abi::open::<M>("fmuGUID", guid?, &folder)?, interface, None, events?))
        })
    } }

    {
        /// Ignored for null, and while a call is under way, as from within the logger.
        FreeInstance(c: *mut c_void) { unsafe { c_abi::free::<Function>(c) } }
    }

    SetDebugLogging(loggingOn: c_int, nCategories: size_t, categories: *const *const c_char) |instance| {
        let has_events = named_categories(nCategories, categories)?.contains(&Category::Events);
        instance.logger.switch(&[Category::Events], boolean("loggingOn", loggingOn)? && has_events);
        Ok(())
    }

    SetupExperiment(
        toleranceDefined: c_int, tolerance: c_double, startTime: c_double, stopTimeDefined: c_int, stopTime: c_double,
    ) |instance| {
        let tolerance = boolean("toleranceDefined", toleranceDefined)?.then_some(tolerance);
        let stop_time = boolean("stopTimeDefined", stopTimeDefined)?.then_some(stopTime);
        instance.set_up(Experiment { tolerance, start_time: startTime, stop_time })
    }

    EnterInitializationMode() |instance| { instance.enter(Stage::InitializationMode) }

    GetReal(vr: *const c_uint, nvr: size_t, value: *mut c_double) [often] |instance| {
        let (references, places) = (values("vr", vr, nvr)?, room("value", value, nvr)?);
        fill(places, instance.get_real(references)?);
        Ok(())
    }

    GetInteger(vr: *const c_uint, nvr: size_t, value: *mut c_int) |instance| {
        let is_number = |data_type: &DataType| matches!(data_type, DataType::Integer | DataType::Enumeration(_));
        write_all("value", value, ("nvr", nvr), instance.get_numbers(values("vr", vr, nvr)?, is_number)?)
    }

    GetBoolean(vr: *const c_uint, nvr: size_t, value: *mut c_int) |instance| {
        write_all("value", value, ("nvr", nvr), instance.get_booleans(values("vr", vr, nvr)?)?)
    }

    GetString(vr: *const c_uint, nvr: size_t, value: *mut *const c_char) |instance| {
        write_all("value", value, ("nvr", nvr), instance.get_texts(values("vr", vr, nvr)?)?)
    }

    SetReal(vr: *const c_uint, nvr: size_t, value: *const c_double) [often] |instance| {
        instance.set_real(values("vr", vr, nvr)?, values("value", value, nvr)?)
    }

    SetInteger(vr: *const c_uint, nvr: size_t, value: *const c_int) |instance| {
        instance.set_integer(values("vr", vr, nvr)?, values("value", value, nvr)?)
    }

    SetBoolean(vr: *const c_uint, nvr: size_t, value: *const c_int) |instance| {
        instance.set_boolean(values("vr", vr, nvr)?, values("value", value, nvr)?, boolean)
    }

    SetString(vr: *const c_uint, nvr: size_t, value: *const *const c_char) |instance| {
        let texts = values("value", value, nvr)?.iter().map(|value| text("value", *value)).collect::<Result<Vec<_>, _>>()?;
        instance.set_string(values("vr", vr, nvr)?, &texts)
    }

    GetDirectionalDerivative(
        vUnknown_ref: *const c_uint, nUnknown: size_t, vKnown_ref: *const c_uint, nKnown: size_t,
        dvKnown: *const c_double, dvUnknown: *mut c_double,
    ) |instance| {
        let unknowns = values("vUnknown_ref", vUnknown_ref, nUnknown)?;
        let (knowns, seed) = (values("vKnown_ref", vKnown_ref, nKnown)?, values("dvKnown", dvKnown, nKnown)?);
        let found = instance.get_directional_derivative(unknowns, knowns, seed)?;
        write_all("dvUnknown", dvUnknown, ("nUnknown", nUnknown), found)
    }

    SetRealInputDerivatives(
        vr: *const c_uint, nvr: size_t, order: *const c_int, value: *const c_double,
    ) [often] |instance| {
        let (orders, slopes) = (values("order", order, nvr)?, values("value", value, nvr)?);
        instance.set_real_input_derivatives(values("vr", vr, nvr)?, orders, slopes)
    }

    GetRealOutputDerivatives(
        vr: *const c_uint, nvr: size_t, order: *const c_int, value: *mut c_double,
    ) |instance| {
        let rates = instance.get_real_output_derivatives(values("vr", vr, nvr)?, values("order", order, nvr)?)?;
        write_all("value", value, ("nvr", nvr), rates)
    }

    /// `noSetFMUStatePriorToCurrentPoint` is ignored: FMU states are kept until the host frees them.
    DoStep(
        currentCommunicationPoint: c_double, communicationStepSize: c_double, _noSetFMUStatePriorToCurrentPoint: c_int,
    ) [often] |instance| {
        let progress = instance.do_step(currentCommunicationPoint, communicationStepSize)?;
        if progress == StepEnd::Ended { instance.ending()?.map_or(Ok(()), Err) } else { Ok(()) }
    }

    /// Never allowed: no step is ever pending.
    CancelStep()

    GetStatus(s: c_int, _value: *mut c_int) |_instance| { Err(Failure::NoAnswer(status_kind(s)?)) }

    GetRealStatus(s: c_int, value: *mut c_double) |instance| {
        match status_kind(s)? {
            "fmi2LastSuccessfulTime" => write("value", value, instance.model.time()?),
            other => Err(Failure::NoAnswer(other)),
        }
    }

    GetIntegerStatus(s: c_int, _value: *mut c_int) |_instance| { Err(Failure::NoAnswer(status_kind(s)?)) }

    GetBooleanStatus(s: c_int, value: *mut c_int) |instance| {
        match status_kind(s)? {
            "fmi2Terminated" => write("value", value, c_int::from(instance.ending()?.is_some())),
            other => Err(Failure::NoAnswer(other)),
        }
    }

    GetStringStatus(s: c_int, _value: *mut *const c_char) |_instance| { Err(Failure::NoAnswer(status_kind(s)?)) }

    NewDiscreteStates(fmi2eventInfo: *mut EventInfo) |instance| {
        check_pointer("fmi2eventInfo", fmi2eventInfo)?;
        let Update { has_ended, has_new_states, next_event } = instance.update_discrete_states()?;
        write("fmi2eventInfo", fmi2eventInfo, EventInfo {
            new_discrete_states_needed: 0,
            terminate_simulation: has_ended.into(),
            nominals_of_continuous_states_changed: 0,
            values_of_continuous_states_changed: has_new_states.into(),
            next_event_time_defined: next_event.is_some().into(),
            next_event_time: next_event.unwrap_or_default(),
        })
    }
}
