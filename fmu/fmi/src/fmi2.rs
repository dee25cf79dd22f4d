//! The C interface of FMI 2.0: what its functions are called, and what they pass. See [`c_abi`] for what
//! holds of all of them.
#![allow(unsafe_code, clippy::missing_safety_doc)] // as in `c_abi`

mod stages;

use crate::c_abi::{
    self, Words, check_pointer, complete_step, escaped, fill, free_state, functions, keep_state, named_categories,
    read_all, read_state, room, text, values, write, write_all, write_state, write_state_size,
};
use crate::failure::Failure;
use crate::instance::Instance;
use crate::interface::{Interface, Stepping};
use crate::logger::{Category, Logger, Sink};
use crate::model::{Experiment, Progress, Update};
use crate::state_machine::{Stage, Table};
use crate::uri;
use crate::variables::{DataType, Role};
use libc::{c_char, c_double, c_int, c_uint, c_void, size_t};
use std::ffi::CString;

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

const MAGIC: u64 = 0x466d_6955_6e69_7432;

const MODEL_EXCHANGE: c_int = 0;
const CO_SIMULATION: c_int = 1;

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
    let Some(logger) = functions.logger else { return Box::new(|_, _, _| ()) };
    let environment = functions.component_environment;
    let name = CString::new(instance_name).expect("it was read up to its NUL");
    // the host reads a message as a printf format, in which # marks variables
    Box::new(move |status, category, message| unsafe {
        logger(environment, name.as_ptr(), status as c_int, category.as_ptr(), escaped(message, &['%', '#']).as_ptr());
    })
}

/// The truth that the `fmi2Boolean` `value`, given as `name`, stands for.
fn boolean(name: &str, value: c_int) -> Result<bool, Failure> {
    match value {
        0 => Ok(false),
        1 => Ok(true),
        _ => Err(Failure::BadChoice { name: name.into(), value, accepted: "0 (fmi2False), 1 (fmi2True)" }),
    }
}

/// The items of `fmi2StatusKind`, by number.
const STATUS_KINDS: [&str; 4] = ["fmi2DoStepStatus", "fmi2PendingStatus", LAST_SUCCESSFUL_TIME, TERMINATED];
const LAST_SUCCESSFUL_TIME: &str = "fmi2LastSuccessfulTime";
const TERMINATED: &str = "fmi2Terminated";

/// The item of `fmi2StatusKind` that a host asks for.
fn status_kind(value: c_int) -> Result<&'static str, Failure> {
    let accepted = "0 (fmi2DoStepStatus), 1 (fmi2PendingStatus), 2 (fmi2LastSuccessfulTime), 3 (fmi2Terminated)";
    let kind = usize::try_from(value).ok().and_then(|at| STATUS_KINDS.get(at));
    kind.copied().ok_or(Failure::BadChoice { name: "fmi2StatusKind".into(), value, accepted })
}

const WORDS: Words = Words {
    real: "fmi2GetReal or fmi2SetReal",
    integer: "fmi2GetInteger",
    enumeration: "fmi2GetInteger or fmi2SetInteger",
    boolean: "fmi2GetBoolean or fmi2SetBoolean",
    string: "fmi2GetString or fmi2SetString",
    fixing: "fmi2ExitInitializationMode",
    reset: "fmi2Reset",
    set_state: "fmi2SetFMUstate",
    set_up: "fmi2SetupExperiment",
    state_size: "fmi2SerializedFMUstateSize",
    status: "fmi2DoStep never returns fmi2Pending, fmi2GetRealStatus knows fmi2LastSuccessfulTime, \
             fmi2GetBooleanStatus knows fmi2Terminated",
};

functions! {
    export_fmi2

    { fmi2GetTypesPlatform() -> *const c_char { c"default".as_ptr() } }

    { fmi2GetVersion() -> *const c_char { c"2.0".as_ptr() } }

    { fmi2Instantiate(
        instanceName: *const c_char, fmuType: c_int, fmuGUID: *const c_char, fmuResourceLocation: *const c_char,
        functions: *const CallbackFunctions, _visible: c_int, loggingOn: c_int,
    ) -> *mut c_void {
        let create = || {
            check_pointer("functions", functions).ok()?;
            let name = unsafe { text("instanceName", instanceName) };
            let mut logger = Logger::new(sink(unsafe { &*functions }, name.as_ref().unwrap_or(&"")));
            let arguments = || {
                let accepted = "0 (fmi2ModelExchange), 1 (fmi2CoSimulation)";
                let interface = match fmuType {
                    MODEL_EXCHANGE => Interface::ModelExchange,
                    CO_SIMULATION => Interface::CoSimulation(Stepping::default()),
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
                Ok((c_abi::open::<M>("fmuGUID", guid?, &folder)?, interface, events?))
            };
            match arguments() {
                Ok((model, interface, events)) => {
                    let allowed_in: &Table = match interface {
                        Interface::ModelExchange => &stages::MODEL_EXCHANGE,
                        Interface::CoSimulation(_) => &stages::CO_SIMULATION,
                    };
                    logger.switch(&[Category::Events], events);
                    Some((Instance::new(model, 0, interface, logger, None), allowed_in))
                }
                Err(failure) => {
                    logger.failure(failure.status(), &format!("fmi2Instantiate: {failure}"));
                    None
                }
            }
        };
        c_abi::instantiate::<Function, M>(create)
    } }

    {
        /// Ignored for null, and while a call is under way, as from within the logger.
        fmi2FreeInstance(c: *mut c_void) { unsafe { c_abi::free::<Function, M>(c) } }
    }

    fmi2SetDebugLogging = SetDebugLogging(
        loggingOn: c_int, nCategories: size_t, categories: *const *const c_char,
    ) |instance| {
        let has_events = named_categories(nCategories, categories)?.contains(&Category::Events);
        instance.logger.switch(&[Category::Events], boolean("loggingOn", loggingOn)? && has_events);
        Ok(())
    }

    fmi2SetupExperiment = SetupExperiment(
        toleranceDefined: c_int, tolerance: c_double, startTime: c_double, stopTimeDefined: c_int, stopTime: c_double,
    ) |instance| {
        let tolerance = boolean("toleranceDefined", toleranceDefined)?.then_some(tolerance);
        let stop_time = boolean("stopTimeDefined", stopTimeDefined)?.then_some(stopTime);
        instance.set_up(Experiment { tolerance, start_time: startTime, stop_time })
    }

    fmi2EnterInitializationMode = EnterInitializationMode() |instance| { instance.enter(Stage::InitializationMode) }

    fmi2ExitInitializationMode = ExitInitializationMode() |instance| { instance.exit_initialization_mode() }

    fmi2Terminate = Terminate() |instance| { instance.terminate() }

    fmi2Reset = Reset() |instance| { instance.reset() }

    fmi2GetReal = GetReal(vr: *const c_uint, nvr: size_t, value: *mut c_double) |instance| {
        let (references, places) = (values("vr", vr, nvr)?, room("value", value, nvr)?);
        fill(places, instance.get_real(references)?);
        Ok(())
    }

    fmi2GetInteger = GetInteger(vr: *const c_uint, nvr: size_t, value: *mut c_int) |instance| {
        instance.get_numbers(values("vr", vr, nvr)?, room("value", value, nvr)?, |data_type| {
            matches!(data_type, DataType::Integer | DataType::Enumeration(_))
        })
    }

    fmi2GetBoolean = GetBoolean(vr: *const c_uint, nvr: size_t, value: *mut c_int) |instance| {
        instance.get_boolean(values("vr", vr, nvr)?, room("value", value, nvr)?)
    }

    fmi2GetString = GetString(vr: *const c_uint, nvr: size_t, value: *mut *const c_char) |instance| {
        instance.get_string(values("vr", vr, nvr)?, room("value", value, nvr)?)
    }

    fmi2SetReal = SetReal(vr: *const c_uint, nvr: size_t, value: *const c_double) |instance| {
        instance.set_real(values("vr", vr, nvr)?, values("value", value, nvr)?)
    }

    fmi2SetInteger = SetInteger(vr: *const c_uint, nvr: size_t, value: *const c_int) |instance| {
        instance.set_integer(values("vr", vr, nvr)?, values("value", value, nvr)?)
    }

    fmi2SetBoolean = SetBoolean(vr: *const c_uint, nvr: size_t, value: *const c_int) |instance| {
        instance.set_boolean(values("vr", vr, nvr)?, values("value", value, nvr)?, boolean)
    }

    fmi2SetString = SetString(vr: *const c_uint, nvr: size_t, value: *const *const c_char) |instance| {
        let texts = values("value", value, nvr)?.iter().map(|value| text("value", *value)).collect::<Result<Vec<_>, _>>()?;
        instance.set_string(values("vr", vr, nvr)?, &texts)
    }

    fmi2GetFMUstate = GetFMUstate(FMUstate: *mut *mut c_void) |instance| { keep_state(instance, "FMUstate", FMUstate) }

    fmi2SetFMUstate = SetFMUstate(FMUstate: *mut c_void) |instance| { instance.set_fmu_state(FMUstate.addr()) }

    /// Ignored for null.
    fmi2FreeFMUstate = FreeFMUstate(FMUstate: *mut *mut c_void) |instance| { free_state(instance, "FMUstate", FMUstate) }

    fmi2SerializedFMUstateSize = SerializedFMUstateSize(FMUstate: *mut c_void, size: *mut size_t) |instance| {
        write_state_size(instance, FMUstate, size)
    }

    fmi2SerializeFMUstate = SerializeFMUstate(
        FMUstate: *mut c_void, serializedState: *mut u8, size: size_t,
    ) |instance| {
        write_state(instance, FMUstate, serializedState, size)
    }

    fmi2DeSerializeFMUstate = DeSerializeFMUstate(
        serializedState: *const u8, size: size_t, FMUstate: *mut *mut c_void,
    ) |instance| {
        read_state(instance, serializedState, size, "FMUstate", FMUstate)
    }

    fmi2GetDirectionalDerivative = GetDirectionalDerivative(
        vUnknown_ref: *const c_uint, nUnknown: size_t, vKnown_ref: *const c_uint, nKnown: size_t,
        dvKnown: *const c_double, dvUnknown: *mut c_double,
    ) |instance| {
        let unknowns = values("vUnknown_ref", vUnknown_ref, nUnknown)?;
        let (knowns, seed) = (values("vKnown_ref", vKnown_ref, nKnown)?, values("dvKnown", dvKnown, nKnown)?);
        instance.get_directional_derivative(unknowns, knowns, seed, room("dvUnknown", dvUnknown, nUnknown)?)
    }

    fmi2SetRealInputDerivatives = SetRealInputDerivatives(
        vr: *const c_uint, nvr: size_t, order: *const c_int, value: *const c_double,
    ) |instance| {
        let (orders, slopes) = (values("order", order, nvr)?, values("value", value, nvr)?);
        instance.set_real_input_derivatives(values("vr", vr, nvr)?, orders, slopes)
    }

    fmi2GetRealOutputDerivatives = GetRealOutputDerivatives(
        vr: *const c_uint, nvr: size_t, order: *const c_int, value: *mut c_double,
    ) |instance| {
        let (orders, rates) = (values("order", order, nvr)?, room("value", value, nvr)?);
        instance.get_real_output_derivatives(values("vr", vr, nvr)?, orders, rates)
    }

    /// `noSetFMUStatePriorToCurrentPoint` is ignored: FMU states are kept until the host frees them.
    fmi2DoStep = DoStep(
        currentCommunicationPoint: c_double, communicationStepSize: c_double, _noSetFMUStatePriorToCurrentPoint: c_int,
    ) |instance| {
        let progress = instance.do_step(currentCommunicationPoint, communicationStepSize)?;
        if progress == Progress::Ended { instance.ending()?.map_or(Ok(()), Err) } else { Ok(()) }
    }

    /// Never allowed: no step is ever pending.
    fmi2CancelStep = CancelStep()

    fmi2GetStatus = GetStatus(s: c_int, _value: *mut c_int) |_instance| { Err(Failure::NoAnswer(status_kind(s)?)) }

    fmi2GetRealStatus = GetRealStatus(s: c_int, value: *mut c_double) |instance| {
        match status_kind(s)? {
            LAST_SUCCESSFUL_TIME => write("value", value, instance.model.time()?),
            other => Err(Failure::NoAnswer(other)),
        }
    }

    fmi2GetIntegerStatus = GetIntegerStatus(s: c_int, _value: *mut c_int) |_instance| {
        Err(Failure::NoAnswer(status_kind(s)?))
    }

    fmi2GetBooleanStatus = GetBooleanStatus(s: c_int, value: *mut c_int) |instance| {
        match status_kind(s)? {
            TERMINATED => write("value", value, c_int::from(instance.ending()?.is_some())),
            other => Err(Failure::NoAnswer(other)),
        }
    }

    fmi2GetStringStatus = GetStringStatus(s: c_int, _value: *mut *const c_char) |_instance| {
        Err(Failure::NoAnswer(status_kind(s)?))
    }

    fmi2EnterEventMode = EnterEventMode() |instance| { instance.enter_event_mode() }

    fmi2NewDiscreteStates = NewDiscreteStates(fmi2eventInfo: *mut EventInfo) |instance| {
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

    fmi2EnterContinuousTimeMode = EnterContinuousTimeMode() |instance| { instance.enter(Stage::ContinuousTimeMode) }

    /// `noSetFMUStatePriorToCurrentPoint` is ignored: FMU states are kept until the host frees them.
    fmi2CompletedIntegratorStep = CompletedIntegratorStep(
        _noSetFMUStatePriorToCurrentPoint: c_int, enterEventMode: *mut c_int, terminateSimulation: *mut c_int,
    ) |instance| {
        complete_step(instance, enterEventMode, terminateSimulation)
    }

    fmi2SetTime = SetTime(time: c_double) |instance| { instance.set_time(time) }

    fmi2SetContinuousStates = SetContinuousStates(x: *const c_double, nx: size_t) |instance| {
        let needed = instance.count(|role| *role == Role::State);
        instance.set_continuous_states(read_all("x", x, ("nx", nx), needed)?)
    }

    fmi2GetDerivatives = GetDerivatives(derivatives: *mut c_double, nx: size_t) |instance| {
        write_all("derivatives", derivatives, ("nx", nx), instance.model.state_rates()?)
    }

    fmi2GetEventIndicators = GetEventIndicators(eventIndicators: *mut c_double, ni: size_t) |instance| {
        write_all("eventIndicators", eventIndicators, ("ni", ni), instance.model.indicators()?)
    }

    fmi2GetContinuousStates = GetContinuousStates(x: *mut c_double, nx: size_t) |instance| {
        write_all("x", x, ("nx", nx), instance.model.states()?)
    }

    fmi2GetNominalsOfContinuousStates = GetNominalsOfContinuousStates(
        x_nominal: *mut c_double, nx: size_t,
    ) |instance| {
        write_all("x_nominal", x_nominal, ("nx", nx), instance.model.nominals()?)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::logger::Status;
    use crate::touchy::{PANICS, Touchy, token};
    use std::ptr;

    #[test]
    fn a_panic_is_fatal_and_the_instance_can_only_be_freed() {
        let functions = CallbackFunctions {
            logger: None,
            allocate_memory: ptr::null(),
            free_memory: ptr::null(),
            step_finished: ptr::null(),
            component_environment: ptr::null_mut(),
        };
        unsafe {
            let c =
                fmi2Instantiate::<Touchy>(c"a".as_ptr(), 1, token().as_ptr(), c"file:///".as_ptr(), &functions, 0, 0);
            assert_eq!(fmi2EnterInitializationMode::<Touchy>(c), Status::Ok as c_int);
            assert_eq!(fmi2GetReal::<Touchy>(c, &PANICS, 1, &mut 0.0), Status::Fatal as c_int);
            assert_eq!(fmi2ExitInitializationMode::<Touchy>(c), Status::Fatal as c_int);
            assert_eq!(fmi2Reset::<Touchy>(c), Status::Fatal as c_int);
            fmi2FreeInstance::<Touchy>(c);
        }
    }
}
