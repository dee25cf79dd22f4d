//! The C interface of FMI 2.0 for co-simulation. Only here are pointers followed: each function turns its arguments
//! into slices and text, and calls the instance.
//!
//! Messages begin with the function that was called and end with the one to call instead: the instance knows neither.
//!
//! What C cannot promise is checked: null and misaligned pointers, lengths, numbers that stand for an enumeration, an
//! `fmi2Component` that is none (as far as that can be told), a call from within the logger callback. A panic becomes
//! `fmi2Fatal`.
//!
//! # Safety
//!
//! The rest is the host's, for every function: a component is null or what `fmi2Instantiate` returned, not freed
//! before nor while it is called; other pointers are null or point to as many values, or to a text, as the standard
//! says. A call while another one is under way, from the logger or another thread, is an `fmi2Error`.
#![allow(unsafe_code, clippy::missing_safety_doc)] // the section above

use crate::failure::Failure;
use crate::instance::{self, Instance, boolean};
use crate::logger::{Logger, Sink, Status};
use crate::state_machine::Function;
use crate::variables::{DataType, Variable};
use libc::{c_char, c_double, c_int, c_uint, c_void, size_t};
use std::any::Any;
use std::cell::{Cell, UnsafeCell};
use std::ffi::CString;
use std::mem::MaybeUninit;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU8, Ordering};
use std::{ptr, slice};

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

/// What an `fmi2Component` points to.
struct Component {
    magic: Cell<u64>,
    /// One of the following.
    availability: AtomicU8,
    instance: UnsafeCell<Instance>,
}

const READY: u8 = 0;

/// A call is under way: the host calls from within its logger, or from another thread.
const BUSY: u8 = 1;

/// A call panicked.
const BROKEN: u8 = 2;

const MAGIC: u64 = 0x526f_636b_696e_6732;

/// Longest text taken from the host, bytes.
const MAX_TEXT: usize = 1 << 16;

/// Most values or bytes taken in one call.
const MAX_LENGTH: usize = 1 << 24;

const CO_SIMULATION: c_int = 1;

/// Follows `c` if it points to a component.
unsafe fn component<'a>(c: *mut c_void) -> Option<&'a Component> {
    let c = c.cast::<Component>();
    if c.is_null() || !c.is_aligned() {
        return None;
    }
    // The magic number is read alone first: if it is wrong, the rest is no component.
    let magic = unsafe { (&raw const (*c).magic).cast::<u64>().read() };
    if magic == MAGIC { Some(unsafe { &*c }) } else { None }
}

/// Calls `body` with the instance that `c` points to, if `function` is allowed in its state. No panic gets out.
unsafe fn call(c: *mut c_void, function: Function, body: impl FnOnce(&mut Instance) -> Result<(), Failure>) -> c_int {
    let Some(component) = (unsafe { component(c) }) else { return Status::Error as c_int };
    match component.availability.compare_exchange(READY, BUSY, Ordering::Acquire, Ordering::Relaxed) {
        Ok(_) => (),
        Err(BROKEN) => return Status::Fatal as c_int,
        Err(_) => return Status::Error as c_int,
    }
    // The one reference to the instance: nobody gets here while the component is busy.
    let instance = unsafe { &mut *component.instance.get() };
    let guarded = || {
        let stage = instance.stage();
        let refused = || Err(Failure::WrongStage { stage, allowed_in: function.stages() });
        let result = if function.is_allowed_in(stage) { body(instance) } else { refused() };
        result.map_or_else(|failure| report(instance, function, &failure), |()| Status::Ok)
    };
    let (status, availability) = match catch_unwind(AssertUnwindSafe(guarded)) {
        Ok(status) => (status, READY),
        Err(panic) => {
            let failure = Failure::Panicked(panic_message(&*panic).to_owned());
            // Whatever becomes of the message, the status is known.
            let _ = catch_unwind(AssertUnwindSafe(|| report(instance, function, &failure)));
            (Status::Fatal, BROKEN)
        }
    };
    component.availability.store(availability, Ordering::Release);
    status as c_int
}

/// Logs why `function` is not done, and returns its status.
fn report(instance: &Instance, function: Function, failure: &Failure) -> Status {
    instance.report(failure.status(), &format!("{}: {failure}{}", function.name(), remedy(failure)));
    failure.status()
}

/// What to call instead.
fn remedy(failure: &Failure) -> &'static str {
    match failure {
        Failure::WrongType(Variable { data_type, .. }) => match data_type {
            DataType::Real { .. } => ": call fmi2GetReal or fmi2SetReal instead",
            DataType::Integer => ": call fmi2GetInteger instead",
            DataType::Enumeration(_) => ": call fmi2GetInteger or fmi2SetInteger instead",
            DataType::Boolean => ": call fmi2GetBoolean or fmi2SetBoolean instead",
            DataType::String => ": call fmi2GetString or fmi2SetString instead",
        },
        Failure::Fixed(_) => ": set it before fmi2ExitInitializationMode, or call fmi2Reset",
        Failure::WrongPoint { .. } => ": step from there, or go back with fmi2SetFMUstate",
        Failure::PastStop { .. } => " given to fmi2SetupExperiment: shorten it",
        Failure::WrongSize { .. } => " (fmi2SerializedFMUstateSize)",
        Failure::NoAnswer(_) => {
            ": fmi2DoStep never returns fmi2Pending, fmi2GetRealStatus knows fmi2LastSuccessfulTime, \
             fmi2GetBooleanStatus knows fmi2Terminated"
        }
        _ => "",
    }
}

fn panic_message(panic: &(dyn Any + Send)) -> &str {
    match (panic.downcast_ref::<&str>(), panic.downcast_ref::<String>()) {
        (Some(message), _) => message,
        (_, Some(message)) => message,
        _ => "panic",
    }
}

/// The `length` values at `pointer`.
unsafe fn values<'a, T>(name: &'static str, pointer: *const T, length: size_t) -> Result<&'a [T], Failure> {
    check_length(length)?;
    if length == 0 {
        return Ok(&[]);
    }
    check_pointer(name, pointer)?;
    Ok(unsafe { slice::from_raw_parts(pointer, length) })
}

/// Room for `length` values at `pointer`.
unsafe fn room<'a, T>(
    name: &'static str,
    pointer: *mut T,
    length: size_t,
) -> Result<&'a mut [MaybeUninit<T>], Failure> {
    check_length(length)?;
    if length == 0 {
        return Ok(&mut []);
    }
    check_pointer(name, pointer)?;
    Ok(unsafe { slice::from_raw_parts_mut(pointer.cast(), length) })
}

/// The value at `pointer`.
unsafe fn read<T: Copy>(name: &'static str, pointer: *const T) -> Result<T, Failure> {
    check_pointer(name, pointer)?;
    Ok(unsafe { *pointer })
}

/// Writes `value` to `pointer`.
unsafe fn write<T>(name: &'static str, pointer: *mut T, value: T) -> Result<(), Failure> {
    check_pointer(name, pointer)?;
    unsafe { pointer.write(value) };
    Ok(())
}

fn check_length(length: size_t) -> Result<(), Failure> {
    if length > MAX_LENGTH { Err(Failure::TooLong { length, limit: MAX_LENGTH }) } else { Ok(()) }
}

fn check_pointer<T>(name: &'static str, pointer: *const T) -> Result<(), Failure> {
    if pointer.is_null() || !pointer.is_aligned() { Err(Failure::BadPointer(name)) } else { Ok(()) }
}

/// The text at `pointer`.
unsafe fn text<'a>(name: &'static str, pointer: *const c_char) -> Result<&'a str, Failure> {
    check_pointer(name, pointer)?;
    let length = unsafe { libc::strnlen(pointer, MAX_TEXT + 1) };
    let bytes = unsafe { slice::from_raw_parts(pointer.cast::<u8>(), length) };
    match str::from_utf8(bytes) {
        Ok(text) if length <= MAX_TEXT => Ok(text),
        _ => Err(Failure::BadText { name, limit: MAX_TEXT }),
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
    kind.copied().ok_or(Failure::BadChoice { name: "fmi2StatusKind", value, accepted })
}

/// `fmi2GetTypesPlatform`
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetTypesPlatform() -> *const c_char {
    c"default".as_ptr()
}

/// `fmi2GetVersion`
#[unsafe(no_mangle)]
pub extern "C" fn fmi2GetVersion() -> *const c_char {
    c"2.0".as_ptr()
}

/// `fmi2Instantiate`
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2Instantiate(
    instanceName: *const c_char,
    fmuType: c_int,
    fmuGUID: *const c_char,
    fmuResourceLocation: *const c_char,
    functions: *const CallbackFunctions,
    _visible: c_int,
    loggingOn: c_int,
) -> *mut c_void {
    let create = || {
        check_pointer("functions", functions).ok()?;
        let name = unsafe { text("instanceName", instanceName) };
        let logger = Logger::new(sink(unsafe { &*functions }, name.as_ref().unwrap_or(&"")));
        let arguments = || {
            if fmuType != CO_SIMULATION {
                return Err(Failure::BadChoice { name: "fmuType", value: fmuType, accepted: "1 (fmi2CoSimulation)" });
            }
            let guid = unsafe { text("fmuGUID", fmuGUID) };
            let location = unsafe { text("fmuResourceLocation", fmuResourceLocation) };
            let events = boolean("loggingOn", loggingOn);
            if name?.is_empty() {
                return Err(Failure::NoName);
            }
            Ok((instance::open("fmuGUID", guid?, location?)?, events?))
        };
        match arguments() {
            Ok((archive, events)) => Some(Instance::new(archive, events, logger)),
            Err(failure) => {
                logger.failure(failure.status(), &format!("fmi2Instantiate: {failure}"));
                None
            }
        }
    };
    let Some(instance) = catch_unwind(create).ok().flatten() else { return ptr::null_mut() };
    let component =
        Component { magic: Cell::new(MAGIC), availability: AtomicU8::new(READY), instance: UnsafeCell::new(instance) };
    Box::into_raw(Box::new(component)).cast()
}

fn sink(functions: &CallbackFunctions, instance_name: &str) -> Sink {
    let Some(logger) = functions.logger else { return Box::new(|_, _, _| ()) };
    let environment = functions.component_environment;
    let name = CString::new(instance_name).expect("it was read up to its NUL");
    Box::new(move |status, category, message| unsafe {
        logger(environment, name.as_ptr(), status as c_int, category.as_ptr(), message.as_ptr());
    })
}

/// `fmi2FreeInstance`. Ignored for null, and while a call is under way, as from within the logger.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeInstance(c: *mut c_void) {
    let Some(component) = (unsafe { component(c) }) else { return };
    if component.availability.swap(BUSY, Ordering::Acquire) == BUSY {
        return;
    }
    // Volatile, so that a call with the freed component finds no magic number as long as the memory is not used anew.
    unsafe { component.magic.as_ptr().write_volatile(0) };
    let free = || drop(unsafe { Box::from_raw(c.cast::<Component>()) });
    // There is no one to tell that freeing panicked.
    let _ = catch_unwind(AssertUnwindSafe(free));
}

/// The functions of an instance: the name, the [`Function`] that it is, the arguments after the component, and what is
/// asked of the instance.
macro_rules! functions {
    ($(
        $(#[$doc:meta])*
        $name:ident = $function:ident($($argument:ident: $type:ty),* $(,)?) |$instance:ident| $body:block
    )*) => {
        $(
            #[doc = concat!("`", stringify!($name), "`")]
            #[doc = ""]
            $(#[$doc])*
            #[unsafe(no_mangle)]
            pub unsafe extern "C" fn $name(c: *mut c_void $(, $argument: $type)*) -> c_int {
                unsafe { call(c, Function::$function, |$instance| $body) }
            }
        )*
    };
}

functions! {
    fmi2SetDebugLogging = SetDebugLogging(
        loggingOn: c_int, nCategories: size_t, categories: *const *const c_char,
    ) |instance| {
        let names = values("categories", categories, nCategories)?;
        let names = names.iter().map(|name| text("category", *name)).collect::<Result<Vec<_>, _>>()?;
        instance.set_debug_logging(boolean("loggingOn", loggingOn)?, &names)
    }

    fmi2SetupExperiment = SetupExperiment(
        toleranceDefined: c_int, tolerance: c_double, startTime: c_double, stopTimeDefined: c_int, stopTime: c_double,
    ) |instance| {
        let tolerance = boolean("toleranceDefined", toleranceDefined)?.then_some(tolerance);
        let stop_time = boolean("stopTimeDefined", stopTimeDefined)?.then_some(stopTime);
        instance.setup_experiment(tolerance, startTime, stop_time)
    }

    fmi2EnterInitializationMode = EnterInitializationMode() |instance| { instance.enter_initialization_mode() }

    fmi2ExitInitializationMode = ExitInitializationMode() |instance| { instance.exit_initialization_mode() }

    fmi2Terminate = Terminate() |instance| { instance.terminate() }

    fmi2Reset = Reset() |instance| { instance.reset() }

    fmi2GetReal = GetReal(vr: *const c_uint, nvr: size_t, value: *mut c_double) |instance| {
        instance.get_real(values("vr", vr, nvr)?, room("value", value, nvr)?)
    }

    fmi2GetInteger = GetInteger(vr: *const c_uint, nvr: size_t, value: *mut c_int) |instance| {
        instance.get_integer(values("vr", vr, nvr)?, room("value", value, nvr)?)
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
        instance.set_boolean(values("vr", vr, nvr)?, values("value", value, nvr)?)
    }

    fmi2SetString = SetString(vr: *const c_uint, nvr: size_t, value: *const *const c_char) |instance| {
        let texts = values("value", value, nvr)?.iter().map(|value| text("value", *value)).collect::<Result<Vec<_>, _>>()?;
        instance.set_string(values("vr", vr, nvr)?, &texts)
    }

    fmi2GetFMUstate = GetFMUstate(FMUstate: *mut *mut c_void) |instance| {
        let handle = instance.get_fmu_state(read("FMUstate", FMUstate)?.addr())?;
        write("FMUstate", FMUstate, ptr::without_provenance_mut(handle))
    }

    fmi2SetFMUstate = SetFMUstate(FMUstate: *mut c_void) |instance| { instance.set_fmu_state(FMUstate.addr()) }

    /// Ignored for null.
    fmi2FreeFMUstate = FreeFMUstate(FMUstate: *mut *mut c_void) |instance| {
        if FMUstate.is_null() || read("FMUstate", FMUstate)?.is_null() {
            return Ok(());
        }
        instance.free_fmu_state(read("FMUstate", FMUstate)?.addr())?;
        write("FMUstate", FMUstate, ptr::null_mut())
    }

    fmi2SerializedFMUstateSize = SerializedFMUstateSize(FMUstate: *mut c_void, size: *mut size_t) |instance| {
        let bytes = instance.serialize_fmu_state(FMUstate.addr())?;
        write("size", size, bytes.len())
    }

    fmi2SerializeFMUstate = SerializeFMUstate(
        FMUstate: *mut c_void, serializedState: *mut u8, size: size_t,
    ) |instance| {
        let bytes = instance.serialize_fmu_state(FMUstate.addr())?;
        if size != bytes.len() {
            return Err(Failure::WrongSize { given: size, needed: bytes.len() });
        }
        check_pointer("serializedState", serializedState)?;
        ptr::copy_nonoverlapping(bytes.as_ptr(), serializedState, size);
        Ok(())
    }

    fmi2DeSerializeFMUstate = DeSerializeFMUstate(
        serializedState: *const u8, size: size_t, FMUstate: *mut *mut c_void,
    ) |instance| {
        let bytes = values("serializedState", serializedState, size)?;
        let handle = read("FMUstate", FMUstate)?.addr();
        let handle = instance.deserialize_fmu_state(bytes, handle)?;
        write("FMUstate", FMUstate, ptr::without_provenance_mut(handle))
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

    /// Whether the host will go back makes no difference: FMU states are kept until it frees them.
    fmi2DoStep = DoStep(
        currentCommunicationPoint: c_double, communicationStepSize: c_double, _noSetFMUStatePriorToCurrentPoint: c_int,
    ) |instance| {
        instance.do_step(currentCommunicationPoint, communicationStepSize)
    }

    /// Never allowed: no step is ever pending.
    fmi2CancelStep = CancelStep() |_instance| { Ok(()) }

    fmi2GetRealStatus = GetRealStatus(s: c_int, value: *mut c_double) |instance| {
        match status_kind(s)? {
            LAST_SUCCESSFUL_TIME => write("value", value, instance.time()?),
            other => Err(Failure::NoAnswer(other)),
        }
    }

    fmi2GetBooleanStatus = GetBooleanStatus(s: c_int, value: *mut c_int) |instance| {
        match status_kind(s)? {
            TERMINATED => write("value", value, c_int::from(instance.has_overturned()?)),
            other => Err(Failure::NoAnswer(other)),
        }
    }

    fmi2GetStatus = GetStatus(s: c_int, _value: *mut c_int) |_instance| { Err(Failure::NoAnswer(status_kind(s)?)) }

    fmi2GetIntegerStatus = GetIntegerStatus(s: c_int, _value: *mut c_int) |_instance| {
        Err(Failure::NoAnswer(status_kind(s)?))
    }

    fmi2GetStringStatus = GetStringStatus(s: c_int, _value: *mut *const c_char) |_instance| {
        Err(Failure::NoAnswer(status_kind(s)?))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::guid;
    use crate::resources::PARAMETERS_FILE;
    use rocking::Parameters;

    #[test]
    fn a_panic_is_fatal_and_the_instance_can_only_be_freed() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::write(folder.path().join(PARAMETERS_FILE), toml::to_string(&Parameters::EVISON).unwrap()).unwrap();
        let [guid, location] = [guid(&Parameters::EVISON.into()), format!("file://{}", folder.path().display())]
            .map(|text| CString::new(text).unwrap());
        let functions = CallbackFunctions {
            logger: None,
            allocate_memory: ptr::null(),
            free_memory: ptr::null(),
            step_finished: ptr::null(),
            component_environment: ptr::null_mut(),
        };
        unsafe {
            let c = fmi2Instantiate(c"a".as_ptr(), 1, guid.as_ptr(), location.as_ptr(), &functions, 0, 0);
            assert_eq!(fmi2EnterInitializationMode(c), Status::Ok as c_int);
            assert_eq!(call(c, Function::GetReal, |_| panic!("on purpose")), Status::Fatal as c_int);
            assert_eq!(fmi2ExitInitializationMode(c), Status::Fatal as c_int);
            assert_eq!(fmi2Reset(c), Status::Fatal as c_int);
            fmi2FreeInstance(c);
        }
    }

    #[test]
    fn the_message_of_a_panic_is_found() {
        let message = |panic: fn()| {
            let panic = catch_unwind(panic).unwrap_err();
            panic_message(&*panic).to_owned()
        };
        assert_eq!(message(|| panic!("plain")), "plain");
        assert_eq!(message(|| panic!("{} formatted", 1)), "1 formatted");
        assert_eq!(message(|| std::panic::panic_any(1)), "panic");
    }
}
