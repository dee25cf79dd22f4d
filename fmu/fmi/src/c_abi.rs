//! The common part of the C interfaces of all versions of the standard. Only here, in [`fmi2`](crate::fmi2) and in
//! [`fmi3`](crate::fmi3) are pointers followed: each function turns its arguments into slices and text, and calls the
//! instance.
//!
//! Messages begin with the function that was called and end with the one to call instead: the instance knows neither.
//!
//! C makes no promise about arguments. Each call therefore checks null and misaligned pointers, lengths, numbers of an enumeration
//! and calls from within the logger. It also checks, as far as it can, whether a component is one. A panic becomes [`Status::Fatal`]. A call
//! computes with the floating point control that Rust assumes, whatever the host's is.
//!
//! # Safety
//!
//! The host keeps these rules, for every function. A component is null, or an instance that the same version's function for
//! instantiation returned. No instance is freed before it is called or while it is called. Other pointers are null or point
//! to as many values, or to a text, as the standard says. A call while another one is under way, from the logger or another
//! thread, is an error.
#![allow(unsafe_code, clippy::missing_safety_doc)] // the section above

use crate::failure::Failure;
use crate::instance::Instance;
use crate::interface::{Interface, IntermediateUpdate};
use crate::logger::{Category, Logger, Sink, Status};
use crate::model::Model;
use crate::state_machine::{LegalStages, Stage, Stages, names};
use crate::variables::DataType;
use libc::{c_char, c_int, c_void, size_t};
use std::any::Any;
#[cfg(any(target_arch = "x86_64", target_arch = "aarch64"))]
use std::arch::asm;
use std::cell::{Cell, UnsafeCell};
use std::ffi::CString;
use std::marker::PhantomData;
use std::mem::MaybeUninit;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicU8, Ordering};
use std::{ptr, slice};

/// The functions of a version of the standard that take an instance; [`functions!`] lists them.
pub trait Function: Copy + Sized + 'static {
    /// All of them.
    const ALL: &'static [Self];

    /// The words of this version.
    const WORDS: Words;

    /// Its place among all of them.
    fn place(self) -> usize;

    /// Its name in the C interface.
    fn name(self) -> &'static str;

    /// The stages in which an instance for `interface` accepts each function.
    fn table(interface: Interface) -> &'static LegalStages;
}

/// The words of a version in the names of its functions, and its first value reference.
pub struct Words {
    pub(crate) version: &'static str,
    /// The first number in a component of this version.
    pub(crate) magic: u64,
    /// The value reference of the variable at position 0.
    pub(crate) first: u32,
    pub(crate) real: &'static str,
    pub(crate) integer: &'static str,
    pub(crate) enumeration: &'static str,
    pub(crate) state: &'static str,
    pub(crate) set_up: &'static str,
}

impl Words {
    /// The function to call instead of one that met `failure`, as the end of a message.
    fn remedy(&self, failure: &Failure) -> String {
        let Words { version, integer, state, set_up, .. } = self;
        match failure {
            Failure::WrongType { data_type, .. } => {
                let of = match data_type {
                    DataType::Integer => return format!(": call {version}Get{integer} instead"),
                    DataType::Real { .. } => self.real,
                    DataType::Enumeration(_) => self.enumeration,
                    DataType::Boolean => "Boolean",
                    DataType::String => "String",
                };
                format!(": call {version}Get{of} or {version}Set{of} instead")
            }
            Failure::Fixed { .. } => {
                format!(": set it before {version}ExitInitializationMode, or call {version}Reset")
            }
            Failure::WrongPoint { .. } => format!(": step from there, or go back with {version}Set{state}"),
            Failure::StepBack { .. } => format!("; to go back, call {version}Set{state}"),
            Failure::PastStop { .. } => format!(" given to {version}{set_up}: shorten it"),
            Failure::WrongSize { .. } => format!(" ({version}Serialized{state}Size)"),
            Failure::Panicked(_) => "; the instance can only be freed".into(),
            _ => String::new(),
        }
    }
}

/// The instance behind a component, for a host that speaks the version with the functions `F`.
#[repr(C)] // the magic number first, whatever the version
struct Component<F> {
    magic: Cell<u64>,
    /// [`READY`], [`BUSY`] or [`BROKEN`].
    availability: AtomicU8,
    /// Whether a step is under way in which the host is called back, and which goes on with the instance.
    calls_back: AtomicBool,
    /// The stages in which the instance accepts each function.
    allowed_in: &'static LegalStages,
    instance: UnsafeCell<Instance>,
    version: PhantomData<F>,
}

const READY: u8 = 0;

/// A call is under way: the host calls from within its logger, or from another thread.
const BUSY: u8 = 1;

/// A call panicked.
const BROKEN: u8 = 2;

/// Longest text that a host may pass, bytes.
const MAX_TEXT: usize = 1 << 16;

/// Most values or bytes that a host may pass in one call.
const MAX_LENGTH: usize = 1 << 24;

/// The parts of an instance: model, interface, the host that is called back, and whether the log categories are on.
pub(crate) type Parts = (Box<dyn Model>, Interface, Option<IntermediateUpdate>, bool);

/// A component with the instance of the `parts`, which switches the log `categories`. If `function` finds no parts or panics, the
/// result is null and the log has the reason.
pub(crate) fn instantiate<F: Function>(
    function: &str,
    categories: &[Category],
    sink: Sink,
    parts: impl FnOnce() -> Result<Parts, Failure>,
) -> *mut c_void {
    let _control = Control::usual_after(Control::read());
    let mut logger = Logger::new(sink);
    let create = || {
        let (model, interface, host, on) = parts()?;
        Ok((Instance::of(model, F::WORDS.first, interface, host), F::table(interface), on))
    };
    let (instance, allowed_in, on) =
        match catch_unwind(AssertUnwindSafe(create)).unwrap_or_else(|panic| Err(panicked(panic))) {
            Ok(created) => created,
            Err(failure) => {
                send(&logger, failure.status(), &format!("{}{function}: {failure}", F::WORDS.version));
                return ptr::null_mut();
            }
        };
    logger.switch(categories, on);
    let component = Component::<F> {
        magic: Cell::new(F::WORDS.magic),
        availability: AtomicU8::new(READY),
        calls_back: AtomicBool::new(false),
        allowed_in,
        instance: UnsafeCell::new(instance(logger)),
        version: PhantomData,
    };
    Box::into_raw(Box::new(component)).cast()
}

/// The model in the folder `resources`, whose token must be `given`, the argument `name`.
pub(crate) fn open<M: Model>(name: &'static str, given: &str, resources: &Path) -> Result<Box<dyn Model>, Failure> {
    let model = M::open(resources)?;
    let needed = model.token();
    if given != needed {
        return Err(Failure::WrongToken { name, given: given.to_owned(), needed });
    }
    Ok(model)
}

/// Frees a component. Does nothing for null, and while a call is under way, as from within the logger or a callback.
pub(crate) unsafe fn free<F: Function>(c: *mut c_void) {
    let Some(component) = (unsafe { component::<F>(c) }) else { return };
    if component.calls_back.load(Ordering::Relaxed) || component.availability.swap(BUSY, Ordering::Acquire) == BUSY {
        return;
    }
    // Volatile, so that a call with the freed component finds no magic number as long as the memory is not used anew.
    unsafe { component.magic.as_ptr().write_volatile(0) };
    let free = || drop(unsafe { Box::from_raw(c.cast::<Component<F>>()) });
    // Freeing has no status to return: a panic is swallowed.
    let _ = catch_unwind(AssertUnwindSafe(free));
}

/// Follows `c` if it points to a component.
#[inline]
unsafe fn component<'a, F: Function>(c: *mut c_void) -> Option<&'a Component<F>> {
    let c = c.cast::<Component<F>>();
    if c.is_null() || !c.is_aligned() {
        return None;
    }
    // The magic number is read alone first: if it is wrong, the rest is no component.
    let magic = unsafe { (&raw const (*c).magic).cast::<u64>().read() };
    if magic == F::WORDS.magic { Some(unsafe { &*c }) } else { None }
}

/// Calls the host back within a step of the instance that `c` points to, which is not freed meanwhile.
pub(crate) unsafe fn call_back<F: Function>(c: *mut c_void, host: impl FnOnce()) {
    let Some(component) = (unsafe { component::<F>(c) }) else { return };
    component.calls_back.store(true, Ordering::Relaxed);
    host();
    component.calls_back.store(false, Ordering::Relaxed);
}

/// Calls `body` with the instance that `c` points to, if `function` is allowed in its stage. The rest of a call, after the host has
/// been called back, is allowed in the stages that `it_goes_on` in instead. A panic becomes [`Status::Fatal`].
#[inline]
pub(crate) unsafe fn call<F: Function>(
    c: *mut c_void,
    function: F,
    it_goes_on: Option<Stages>,
    body: impl FnOnce(&mut Instance) -> Result<(), Failure>,
) -> c_int {
    let Some(component) = (unsafe { component::<F>(c) }) else { return Status::Error as c_int };
    let mut register = 0;
    Control::store(&mut register);
    match component.availability.compare_exchange(READY, BUSY, Ordering::Acquire, Ordering::Relaxed) {
        Ok(_) => (),
        Err(BROKEN) => return Status::Fatal as c_int,
        Err(_) => return Status::Error as c_int,
    }
    // The exchange waits until the register is stored. The read is volatile so that it does not come before.
    let _control = Control::usual_after(unsafe { ptr::read_volatile(&register) });
    // This is the only reference to the instance: no other call gets here while the component is busy.
    let instance = unsafe { &mut *component.instance.get() };
    let guarded = || {
        let allowed = || component.allowed_in[function.place()];
        let (stage, stages) = (instance.stage, it_goes_on.unwrap_or_else(allowed));
        let result = if stage.bit() & stages != 0 { body(instance) } else { Err(wrong_stage(stage, stages)) };
        result.map_or_else(|failure| report(&instance.logger, function, failure), |()| Status::Ok)
    };
    match catch_unwind(AssertUnwindSafe(guarded)) {
        Ok(status) => {
            component.availability.store(READY, Ordering::Release);
            status as c_int
        }
        Err(panic) => {
            report(&instance.logger, function, panicked(panic));
            component.availability.store(BROKEN, Ordering::Release);
            Status::Fatal as c_int
        }
    }
}

/// [`call`], compiled once for all functions that hosts do not call at every step.
#[inline(never)]
pub(crate) unsafe fn call_seldom<F: Function>(
    c: *mut c_void,
    function: F,
    body: &mut dyn FnMut(&mut Instance) -> Result<(), Failure>,
) -> c_int {
    unsafe { call(c, function, None, body) }
}

/// The host's floating point control, which comes back at the end of a call: rounding, traps, and whether tiny numbers count as 0.
/// A number of 32 bits, as wide as what the register is written to: a wider one would wait for the memory.
struct Control(u32);

impl Control {
    /// Rounding to nearest, no traps, tiny numbers as they are.
    const USUAL: u32 = if cfg!(target_arch = "x86_64") { 0x1f80 } else { 0 };

    /// The sticky flags of the register, which are no control.
    const FLAGS: u32 = if cfg!(target_arch = "x86_64") { 0x3f } else { 0 };

    /// Takes the usual control until the value is dropped, given the host's `register`.
    #[inline]
    fn usual_after(register: u32) -> Control {
        let control = Control(register & !Control::FLAGS);
        control.exchange(Control::USUAL);
        control
    }

    /// Sets the control to `to` and keeps the flags, if the control is another one.
    #[inline]
    fn exchange(&self, to: u32) {
        if self.0 != Control::USUAL {
            Control::write(to | Control::read() & Control::FLAGS);
        }
    }

    #[inline]
    fn read() -> u32 {
        let mut register = 0;
        Control::store(&mut register);
        register
    }

    #[inline]
    fn store(_register: &mut u32) {
        #[cfg(target_arch = "x86_64")]
        unsafe {
            asm!("stmxcsr [{}]", in(reg) &raw mut *_register, options(nostack, preserves_flags))
        };
        #[cfg(target_arch = "aarch64")]
        unsafe {
            asm!("mrs {:x}, fpcr", out(reg) * _register, options(nostack, preserves_flags))
        };
    }

    #[inline]
    fn write(_register: u32) {
        #[cfg(target_arch = "x86_64")]
        unsafe {
            asm!("ldmxcsr [{}]", in(reg) &raw const _register, options(nostack, preserves_flags))
        };
        #[cfg(target_arch = "aarch64")]
        unsafe {
            asm!("msr fpcr, {}", in(reg) u64::from(_register), options(nostack, preserves_flags))
        };
    }
}

impl Drop for Control {
    fn drop(&mut self) {
        self.exchange(self.0);
    }
}

#[cold]
#[inline(never)]
fn wrong_stage(stage: Stage, stages: Stages) -> Failure {
    Failure::WrongStage { stage, allowed_in: names(stages) }
}

/// Logs why `function` is not done, and returns its status.
#[cold]
#[inline(never)]
fn report<F: Function>(logger: &Logger, function: F, failure: Failure) -> Status {
    send(logger, failure.status(), &format!("{}: {failure}{}", function.name(), F::WORDS.remedy(&failure)));
    failure.status()
}

/// Logs why a call returns `status`, which is known even if the logger panics.
fn send(logger: &Logger, status: Status, message: &str) {
    let _ = catch_unwind(AssertUnwindSafe(|| logger.failure(status, message)));
}

fn panicked(panic: Box<dyn Any + Send>) -> Failure {
    Failure::Panicked(match (panic.downcast_ref::<&str>(), panic.downcast_ref::<String>()) {
        (Some(message), _) => message.to_string(),
        (_, Some(message)) => message.clone(),
        _ => "panic".into(),
    })
}

/// The `length` values at `pointer`.
#[inline]
pub(crate) unsafe fn values<'a, T>(name: &'static str, pointer: *const T, length: size_t) -> Result<&'a [T], Failure> {
    Ok(unsafe { slice::from_raw_parts(start(name, pointer.cast_mut(), length)?, length) })
}

/// Room for `length` values at `pointer`.
#[inline]
pub(crate) unsafe fn room<'a, T>(
    name: &'static str,
    pointer: *mut T,
    length: size_t,
) -> Result<&'a mut [MaybeUninit<T>], Failure> {
    Ok(unsafe { slice::from_raw_parts_mut(start(name, pointer, length)?.cast(), length) })
}

/// The start of `length` values at `pointer`; where there are none, the pointer may be anything.
#[inline]
fn start<T>(name: &'static str, pointer: *mut T, length: size_t) -> Result<*mut T, Failure> {
    if length > MAX_LENGTH {
        return Err(Failure::TooLong { length, limit: MAX_LENGTH });
    }
    if length == 0 { Ok(ptr::dangling_mut()) } else { check_pointer(name, pointer).map(|()| pointer) }
}

/// Writes `numbers` to `pointer`, if `count`, the argument `of`, says that there is room for as many.
pub(crate) unsafe fn write_all<T: From<V>, V>(
    name: &'static str,
    pointer: *mut T,
    (of, count): (&'static str, size_t),
    numbers: Vec<V>,
) -> Result<(), Failure> {
    check_count(of, count, numbers.len())?;
    let places = unsafe { room(name, pointer, count) }?;
    places.iter_mut().zip(numbers).for_each(|(place, number)| _ = place.write(number.into()));
    Ok(())
}

/// Writes `numbers` to `places`, of which there are as many: one by one, since a wider copy would wait for numbers just computed.
#[inline]
pub(crate) fn fill<T: Copy>(places: &mut [MaybeUninit<T>], numbers: &[T]) {
    assert_eq!(places.len(), numbers.len());
    places.iter_mut().zip(numbers).for_each(|(place, number)| unsafe { place.as_mut_ptr().write_volatile(*number) });
}

/// Refuses a number of values, given as `name`, that is not the right one.
pub(crate) fn check_count(name: &'static str, given: size_t, needed: size_t) -> Result<(), Failure> {
    if given == needed { Ok(()) } else { Err(Failure::WrongCount { name, given, needed }) }
}

pub(crate) unsafe fn read<T: Copy>(name: &'static str, pointer: *const T) -> Result<T, Failure> {
    check_pointer(name, pointer)?;
    Ok(unsafe { *pointer })
}

/// The truth that the Boolean `value`, given as `name`, stands for: `accepted` says how the version writes both.
pub(crate) fn truth(name: &str, value: c_int, accepted: &'static str) -> Result<bool, Failure> {
    match value {
        0 | 1 => Ok(value == 1),
        _ => Err(Failure::BadChoice { name: name.into(), value, accepted }),
    }
}

pub(crate) unsafe fn write<T>(name: &'static str, pointer: *mut T, value: T) -> Result<(), Failure> {
    check_pointer(name, pointer)?;
    unsafe { pointer.write(value) };
    Ok(())
}

#[inline]
pub(crate) fn check_pointer<T>(name: &'static str, pointer: *const T) -> Result<(), Failure> {
    if pointer.is_null() || !pointer.is_aligned() { Err(Failure::BadPointer(name)) } else { Ok(()) }
}

pub(crate) unsafe fn text<'a>(name: &'static str, pointer: *const c_char) -> Result<&'a str, Failure> {
    check_pointer(name, pointer)?;
    let length = unsafe { libc::strnlen(pointer, MAX_TEXT + 1) };
    let bytes = unsafe { slice::from_raw_parts(pointer.cast::<u8>(), length) };
    match str::from_utf8(bytes) {
        Ok(text) if length <= MAX_TEXT => Ok(text),
        _ => Err(Failure::BadText { name, limit: MAX_TEXT }),
    }
}

/// The `length` log categories named at `pointer`; without any, all are meant.
pub(crate) unsafe fn named_categories(length: size_t, pointer: *const *const c_char) -> Result<Vec<Category>, Failure> {
    let named = |name: &*const c_char| {
        let name = unsafe { text("category", *name) }?;
        Category::named(name).ok_or_else(|| Failure::UnknownCategory(name.to_owned()))
    };
    let names = unsafe { values("categories", pointer, length) }?;
    if names.is_empty() { Ok(Category::ALL.into()) } else { names.iter().map(named).collect() }
}

/// `message` for the host, with every one of `marks`, which mean something to it, doubled. A NUL would end it.
pub(crate) fn escaped(message: &str, marks: &[char]) -> CString {
    let mut escaped = String::with_capacity(message.len());
    for c in message.chars() {
        escaped.extend(marks.contains(&c).then_some(c));
        escaped.push(if c == '\0' { char::REPLACEMENT_CHARACTER } else { c });
    }
    CString::new(escaped).expect("every NUL is replaced")
}

/// The functions that take an instance, without the version in front of their names: the arguments after the component,
/// and what is asked of the instance, nothing of those that are never allowed. Those in brackets call the instance
/// themselves; those in braces make one, free it or take none. Hosts call those with `[often]` at every step. The macro
/// `$export` exports all of them for a model, where the types of the arguments are in scope.
macro_rules! functions {
    (@) => { |_| Ok(()) };
    (@ |$instance:ident| $body:block) => { |$instance| $body };
    (@call [often] $c:ident $name:ident $body:expr) => { $crate::c_abi::call($c, Function::$name, None, $body) };
    (@call [] $c:ident $name:ident $body:expr) => { $crate::c_abi::call_seldom($c, Function::$name, &mut $body) };
    ($version:literal $export:ident
    $({
        $(#[$other_doc:meta])*
        $other:ident($($other_argument:ident: $other_type:ty),* $(,)?) $(-> $returned:ty)? $other_body:block
    })* $([
        $(#[$apart_doc:meta])*
        $apart:ident($($apart_argument:ident: $apart_type:ty),* $(,)?) $apart_body:block
    ])* $(
        $(#[$doc:meta])*
        $name:ident($($argument:ident: $type:ty),* $(,)?) $([$often:ident])? $(|$instance:ident| $body:block)?
    )*) => {
        /// The functions of this version that take an instance, except for the one that frees it, which may always be
        /// called.
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum Function {
            $(#[doc = concat!("`", $version, stringify!($apart), "`")] $apart,)*
            $(#[doc = concat!("`", $version, stringify!($name), "`")] $name,)*
        }

        impl $crate::c_abi::Function for Function {
            const ALL: &'static [Function] = &[$(Function::$apart,)* $(Function::$name),*];
            const WORDS: $crate::c_abi::Words = WORDS;

            fn place(self) -> usize {
                self as usize
            }

            fn name(self) -> &'static str {
                match self {
                    $(Function::$apart => concat!($version, stringify!($apart)),)*
                    $(Function::$name => concat!($version, stringify!($name)),)*
                }
            }

            fn table(interface: Interface) -> &'static $crate::state_machine::LegalStages {
                stages::table(interface)
            }
        }

        $(
            #[doc = concat!("`", $version, stringify!($other), "`")]
            #[doc = ""]
            $(#[$other_doc])*
            pub unsafe fn $other<M: $crate::Model>($($other_argument: $other_type),*) $(-> $returned)? $other_body
        )*

        $(
            #[doc = concat!("`", $version, stringify!($apart), "`")]
            #[doc = ""]
            $(#[$apart_doc])*
            pub unsafe fn $apart($($apart_argument: $apart_type),*) -> c_int $apart_body
        )*

        $(
            #[doc = concat!("`", $version, stringify!($name), "`")]
            #[doc = ""]
            $(#[$doc])*
            #[inline]
            pub unsafe fn $name(c: *mut c_void $(, $argument: $type)*) -> c_int {
                unsafe {
                    $crate::c_abi::functions!(
                        @call [$($often)?] c $name $crate::c_abi::functions!(@ $(|$instance| $body)?)
                    )
                }
            }
        )*

        #[doc(hidden)]
        #[macro_export]
        macro_rules! $export {
            ($model:ty, $module:ident) => {
                $crate::exported! {
                    $module, $version [::<$model>]: $($other($($other_argument: $other_type),*) $(-> $returned)?;)*
                }
                $crate::exported! {
                    $module, $version []:
                    $($apart($($apart_argument: $apart_type),*) -> c_int;)*
                    $($name(c: *mut c_void $(, $argument: $type)*) -> c_int;)*
                }
            };
        }
    };
}
pub(crate) use functions;

/// [`functions!`], with those that differ between the versions in nothing but their words and the type of a Boolean.
macro_rules! shared_functions {
    (
        $version:literal $export:ident $boolean:ty,
        $state:ident: [$get:ident $set:ident $free:ident $size_of:ident $serialize:ident $deserialize:ident],
        $x:ident $nx:ident $nominals:ident $ni:ident: [$get_rates:ident],
        $($own:tt)*
    ) => {
        $crate::c_abi::functions! {
            $version $export
            $($own)*

            ExitInitializationMode() |instance| { instance.exit_initialization_mode() }

            EnterEventMode() |instance| { instance.enter_event_mode() }

            EnterContinuousTimeMode() |instance| { instance.enter(Stage::ContinuousTimeMode) }

            Terminate() |instance| { instance.terminate() }

            Reset() |instance| { instance.reset() }

            /// Keeps the state of the instance in the FMU state that is pointed to, or in a new one for null.
            $get($state: *mut *mut c_void) |instance| {
                let handle = instance.get_fmu_state(read(stringify!($state), $state)?.addr())?;
                write(stringify!($state), $state, ptr::without_provenance_mut(handle))
            }

            $set($state: *mut c_void) |instance| {
                instance.set_fmu_state($state.addr(), stages::table(instance.interface)[Function::$get as usize])
            }

            /// Ignored for null.
            $free($state: *mut *mut c_void) |instance| {
                if $state.is_null() || read(stringify!($state), $state)?.is_null() {
                    return Ok(());
                }
                instance.snapshots.free(read(stringify!($state), $state)?.addr())?;
                write(stringify!($state), $state, ptr::null_mut())
            }

            $size_of($state: *mut c_void, size: *mut size_t) |instance| {
                write("size", size, instance.serialize_fmu_state($state.addr())?.len())
            }

            $serialize($state: *mut c_void, serializedState: *mut u8, size: size_t) |instance| {
                let bytes = instance.serialize_fmu_state($state.addr())?;
                if size != bytes.len() {
                    return Err(Failure::WrongSize { given: size, needed: bytes.len() });
                }
                fill(room("serializedState", serializedState, size)?, &bytes);
                Ok(())
            }

            /// Keeps the state that the bytes hold, as that of the instance is kept.
            $deserialize(serializedState: *const u8, size: size_t, $state: *mut *mut c_void) |instance| {
                let bytes = values("serializedState", serializedState, size)?;
                let handle = instance.deserialize_fmu_state(bytes, read(stringify!($state), $state)?.addr())?;
                write(stringify!($state), $state, ptr::without_provenance_mut(handle))
            }

            /// `noSetFMUStatePriorToCurrentPoint` is ignored: FMU states are kept until the host frees them.
            CompletedIntegratorStep(
                _noSetFMUStatePriorToCurrentPoint: $boolean, enterEventMode: *mut $boolean,
                terminateSimulation: *mut $boolean,
            ) |instance| {
                check_pointer("enterEventMode", enterEventMode)?;
                check_pointer("terminateSimulation", terminateSimulation)?;
                let Completed { needs_event_mode, has_ended } = instance.completed_integrator_step()?;
                write("enterEventMode", enterEventMode, needs_event_mode.into())?;
                write("terminateSimulation", terminateSimulation, has_ended.into())
            }

            SetTime(time: f64) |instance| { instance.set_time(time) }

            SetContinuousStates($x: *const f64, $nx: size_t) |instance| {
                check_count(stringify!($nx), $nx, instance.count(|role| *role == Role::State))?;
                instance.set_continuous_states(values(stringify!($x), $x, $nx)?)
            }

            $get_rates(derivatives: *mut f64, $nx: size_t) |instance| {
                write_all("derivatives", derivatives, (stringify!($nx), $nx), instance.model.state_rates()?)
            }

            GetEventIndicators(eventIndicators: *mut f64, $ni: size_t) |instance| {
                write_all("eventIndicators", eventIndicators, (stringify!($ni), $ni), instance.model.indicators()?)
            }

            GetContinuousStates($x: *mut f64, $nx: size_t) |instance| {
                write_all(stringify!($x), $x, (stringify!($nx), $nx), instance.model.states()?)
            }

            GetNominalsOfContinuousStates($nominals: *mut f64, $nx: size_t) |instance| {
                write_all(stringify!($nominals), $nominals, (stringify!($nx), $nx), instance.model.nominals()?)
            }
        }
    };
}
pub(crate) use shared_functions;

/// Exports functions of a version for a model.
#[doc(hidden)]
#[macro_export]
macro_rules! exported {
    (@ $module:ident $name:ident [$($of_model:tt)*]) => { $crate::$module::$name$($of_model)* };
    ($module:ident, $version:literal $of_model:tt: $($name:ident($($argument:ident: $type:ty),*) $(-> $returned:ty)?;)*) => { $(
        #[doc = concat!("`", $version, stringify!($name), "`")]
        #[unsafe(export_name = concat!($version, stringify!($name)))]
        pub unsafe extern "C" fn $name($($argument: $type),*) $(-> $returned)? {
            unsafe { $crate::exported!(@ $module $name $of_model)($($argument),*) }
        }
    )* };
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::panic::panic_any;

    #[test]
    fn a_message_is_a_format_that_prints_itself() {
        assert_eq!(escaped("100 % of #5\0 ü", &['%', '#']).to_str().unwrap(), "100 %% of ##5\u{fffd} ü");
        assert_eq!(escaped("100 % of #5", &['#']).to_str().unwrap(), "100 % of ##5");
    }

    #[test]
    fn a_panic_while_an_instance_is_made_is_logged() {
        let panics: [(fn() -> _, _); 3] =
            [(|| panic!("plain"), "plain"), (|| panic!("{} made", 1), "1 made"), (|| panic_any(1), "panic")];
        for (parts, message) in panics {
            let (tell, told) = std::sync::mpsc::channel();
            let sink: Sink = Some(Box::new(move |_, _, text| tell.send(text.to_owned()).unwrap()));
            assert!(instantiate::<crate::fmi3::Function>("Instantiate", &[], sink, parts).is_null());
            let expected = format!("fmi3Instantiate: internal failure, please report it: {message}");
            assert_eq!(told.recv().unwrap(), expected);
        }
    }
}
