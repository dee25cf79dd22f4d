//! The functions of both versions of the standard by the arguments that they take, and what holds of all of them.
#![allow(dead_code)] // every test file uses a part of this

pub mod fmi2;
pub mod fmi3;

use crate::host::{DISCARD, ERROR, OK};
use FlexibleRocking::c_abi::Function as _;
use FlexibleRocking::snapshot;
use FlexibleRocking::state_machine::Stage;
use std::ffi::{c_char, c_int, c_uint, c_void};
use std::fmt::Debug;
use std::ptr::{null, null_mut};

/// An instance.
pub type C = *mut c_void;

/// What an instance has logged: status and text.
pub type Messages = Vec<(c_int, String)>;

/// A version of the standard.
pub trait Version {
    type Function: FlexibleRocking::c_abi::Function + PartialEq + Debug;

    /// With what the names of its functions begin.
    const PREFIX: &'static str;

    /// What is called to look at an instance.
    const LOOKING: Looking;

    /// How to call `function`.
    fn call(function: Self::Function) -> Call;
}

/// Functions with which an instance is looked at and freed.
pub struct Looking {
    pub free: unsafe extern "C" fn(C),
    pub get_state: unsafe extern "C" fn(C, *mut C) -> c_int,
    pub free_state: unsafe extern "C" fn(C, *mut C) -> c_int,
    pub size: unsafe extern "C" fn(C, C, *mut usize) -> c_int,
    pub serialize: unsafe extern "C" fn(C, C, *mut u8, usize) -> c_int,
    pub event_indicators: unsafe extern "C" fn(C, *mut f64, usize) -> c_int,
}

/// A function by its arguments: value references come with their number; the last number, where there is one, is that
/// of values, which FMI 3.0 is given as well.
pub enum Call {
    Plain(fn(C) -> c_int),
    SetDebugLogging(fn(C, c_int, usize, *const *const c_char) -> c_int),
    /// Tolerance, start and stop time.
    SetUp(fn(C, c_int, f64, f64, c_int, f64) -> c_int),
    GetReals(fn(C, *const c_uint, usize, *mut f64, usize) -> c_int),
    GetRates(fn(C, *const c_uint, usize, *const c_int, *mut f64, usize) -> c_int),
    SetReals(fn(C, *const c_uint, usize, *const f64, usize) -> c_int),
    SetSlopes(fn(C, *const c_uint, usize, *const c_int, *const f64) -> c_int),
    /// Of values of so many bytes.
    GetDiscrete(usize, fn(C, *const c_uint, usize, *mut c_void, usize) -> c_int),
    /// The same, of these variables, more often than not.
    SetDiscrete(&'static [&'static str], usize, fn(C, *const c_uint, usize, *const c_void, usize) -> c_int),
    GetStrings(fn(C, *const c_uint, usize, *mut *const c_char, usize) -> c_int),
    SetStrings(fn(C, *const c_uint, usize, *mut *const c_char, usize) -> c_int),
    /// Unknowns, knowns, seed and what comes out.
    Directional(fn(C, [*const c_uint; 2], [usize; 2], *const f64, *mut f64) -> c_int),
    Adjoint(fn(C, [*const c_uint; 2], [usize; 2], *const f64, *mut f64) -> c_int),
    GetState(unsafe extern "C" fn(C, *mut C) -> c_int),
    SetState(unsafe extern "C" fn(C, C) -> c_int),
    FreeState(unsafe extern "C" fn(C, *mut C) -> c_int),
    StateSize(unsafe extern "C" fn(C, C, *mut usize) -> c_int),
    Serialize(unsafe extern "C" fn(C, C, *mut u8, usize) -> c_int),
    Deserialize(unsafe extern "C" fn(C, *const u8, usize, *mut C) -> c_int),
    /// Point, step, a Boolean, three that come out, and the time that is reached, in FMI 3.0.
    DoStep(fn(C, f64, f64, c_int, [*mut u8; 3], *mut f64) -> c_int),
    /// Which status, and where to.
    Status(fn(C, c_int, *mut c_void) -> c_int),
    SetTime(unsafe extern "C" fn(C, f64) -> c_int),
    SetStates(unsafe extern "C" fn(C, *const f64, usize) -> c_int),
    /// So many numbers.
    GetNumbers(usize, unsafe extern "C" fn(C, *mut f64, usize) -> c_int),
    /// How many there are.
    Count(usize, unsafe extern "C" fn(C, *mut usize) -> c_int),
    /// A Boolean, and two that come out, of so many bytes.
    CompleteStep(usize, fn(C, c_int, *mut c_void, *mut c_void) -> c_int),
    /// With one of the pointers to what comes out null, if any.
    Update(fn(C, Option<usize>) -> c_int),
}

/// All that the future of the instance `c` depends on.
pub fn bytes<V: Version>(c: C) -> Vec<u8> {
    let mut state = null_mut();
    unsafe {
        assert_eq!((V::LOOKING.get_state)(c, &mut state), OK);
        let bytes = bytes_of::<V>(c, state);
        assert_eq!((V::LOOKING.free_state)(c, &mut state), OK);
        bytes
    }
}

/// The FMU state `state` of `c` as bytes.
pub fn bytes_of<V: Version>(c: C, state: C) -> Vec<u8> {
    let mut size = 0;
    unsafe {
        assert_eq!((V::LOOKING.size)(c, state, &mut size), OK);
        let mut bytes = vec![0; size];
        assert_eq!((V::LOOKING.serialize)(c, state, bytes.as_mut_ptr(), size), OK);
        bytes
    }
}

/// Calls `function` with arguments that are of no use, but harmless where it is allowed.
fn call<V: Version>(c: C, function: V::Function) -> c_int {
    let keep = || {
        let mut state = null_mut();
        assert_eq!(unsafe { (V::LOOKING.get_state)(c, &mut state) }, OK);
        state
    };
    let mut place = [0_u64; 4];
    let [one, other, ..] = place.each_mut().map(|place| (&raw mut *place).cast::<c_void>());
    unsafe {
        match V::call(function) {
            Call::Plain(call) => call(c),
            Call::SetDebugLogging(call) => call(c, 0, 0, null()),
            Call::SetUp(call) => call(c, 0, 0.0, 0.0, 0, 0.0),
            Call::GetReals(call) => call(c, null(), 0, null_mut(), 0),
            Call::GetRates(call) => call(c, null(), 0, null(), null_mut(), 0),
            Call::SetReals(call) => call(c, null(), 0, null(), 0),
            Call::SetSlopes(call) => call(c, null(), 0, null(), null()),
            Call::GetDiscrete(_, call) => call(c, null(), 0, null_mut(), 0),
            Call::SetDiscrete(_, _, call) => call(c, null(), 0, null(), 0),
            Call::GetStrings(call) | Call::SetStrings(call) => call(c, null(), 0, null_mut(), 0),
            Call::Directional(call) | Call::Adjoint(call) => call(c, [null(); 2], [0; 2], null(), null_mut()),
            Call::GetState(call) => call(c, &mut null_mut()),
            Call::SetState(call) => call(c, keep()),
            Call::FreeState(call) => call(c, null_mut()),
            Call::StateSize(call) => call(c, keep(), &mut 0),
            Call::Serialize(call) => {
                let (state, mut bytes) = (keep(), bytes::<V>(c));
                call(c, state, bytes.as_mut_ptr(), bytes.len())
            }
            Call::Deserialize(call) => {
                let bytes = bytes::<V>(c);
                call(c, bytes.as_ptr(), bytes.len(), &mut null_mut())
            }
            Call::DoStep(call) => call(c, 0.0, 1e-3, 0, [one.cast(); 3], other.cast()),
            Call::Status(call) => call(c, 2, one), // fmi2LastSuccessfulTime
            Call::SetTime(call) => call(c, 0.0),
            Call::SetStates(call) => call(c, [0.0; 4].as_ptr(), 4),
            Call::GetNumbers(n, call) => call(c, one.cast(), n),
            Call::Count(_, call) => call(c, &mut 0),
            Call::CompleteStep(_, call) => call(c, 0, one, other),
            Call::Update(call) => call(c, None),
        }
    }
}

/// What an allowed call of the function `name` returns, and where it leads; a simulation starts in `first`.
fn outcome(name: &str, stage: Stage, first: Stage) -> (c_int, Stage) {
    match name {
        // where the equations are singular
        "GetDerivatives" | "GetContinuousStateDerivatives" if stage == Stage::Error => (DISCARD, stage),
        "EnterInitializationMode" => (OK, Stage::InitializationMode),
        "ExitInitializationMode" => (OK, first),
        "EnterEventMode" => (OK, Stage::EventMode),
        "EnterStepMode" => (OK, Stage::StepComplete),
        "EnterContinuousTimeMode" => (OK, Stage::ContinuousTimeMode),
        "Terminate" => (OK, Stage::Terminated),
        "Reset" => (OK, Stage::Instantiated),
        "GetStatus" | "GetIntegerStatus" | "GetBooleanStatus" | "GetStringStatus" => (DISCARD, stage),
        _ => (OK, stage),
    }
}

/// Every function in every one of `stages` in which an instance stays, as `table`, which has them as columns, allows
/// it, also after a reset; what is in no row of it is allowed nowhere. `host_in` makes a host in a stage, `look` gives
/// its instance and takes its log.
pub fn check<V: Version, H>(
    table: &str,
    stages: &[Stage],
    first: Stage,
    host_in: fn(Stage) -> H,
    look: fn(&H) -> (C, Messages),
) {
    let stage_of = |c: C| snapshot::deserialize(&bytes::<V>(c)).unwrap().stage;
    let rows: Vec<Vec<_>> = table.trim().lines().map(|row| row.split_whitespace().collect()).collect();
    let names: Vec<_> = V::Function::ALL.iter().map(|function| &function.name()[V::PREFIX.len()..]).collect();
    assert!(rows.iter().all(|row| names.contains(&row[0]) && row.len() == 1 + stages.len()));
    for (&function, name) in V::Function::ALL.iter().zip(names) {
        let row = rows.iter().find(|row| row[0] == name);
        let is_allowed = |stage: &Stage| {
            let column = stages.iter().position(|column| column == stage);
            row.zip(column).is_some_and(|(row, column)| row[1 + column] != "-")
        };
        let allowed: Vec<_> = Stage::ALL.iter().filter(|stage| is_allowed(stage)).map(Stage::to_string).collect();
        let allowed = if allowed.is_empty() { "none".to_owned() } else { allowed.join(", ") };
        for from in stages.iter().copied().filter(|stage| !stage.is_within_step()) {
            for is_reset in [false, true] {
                let host = host_in(from);
                let (c, _) = look(&host);
                assert_eq!(stage_of(c), from);
                assert!(!is_reset || call_named::<V>(c, "Reset") == OK);
                let (stage, before) = (if is_reset { Stage::Instantiated } else { from }, bytes::<V>(c));
                look(&host);
                let status = call::<V>(c, function);
                let (_, log) = look(&host);
                if is_allowed(&stage) {
                    let found = (status, stage_of(c));
                    assert_eq!(found, outcome(name, stage, first), "{name} in {stage}: {log:?}");
                    assert_eq!(log.len(), usize::from(status != OK), "{log:?}");
                } else {
                    let text =
                        format!("{}{name}: not allowed in the state \"{stage}\"; allowed in: {allowed}", V::PREFIX);
                    assert_eq!((status, log), (ERROR, vec![(ERROR, text)]));
                    assert_eq!(bytes::<V>(c), before, "the refused {name} changed something");
                }
            }
        }
    }
}

/// Calls the function `name`.
fn call_named<V: Version>(c: C, name: &str) -> c_int {
    let is_it = |function: &&V::Function| function.name()[V::PREFIX.len()..] == *name;
    call::<V>(c, *V::Function::ALL.iter().find(is_it).unwrap())
}
