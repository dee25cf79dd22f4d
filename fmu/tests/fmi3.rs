//! FMI 3.0: which call is allowed when, and random calls in any order.
//!
//! `FUZZ_CALLS` says how many random calls to make. What a sequence of them does follows from its number alone.
#![allow(unsafe_code)] // the C interface

use FlexibleRocking::c_abi::Function as _;
use FlexibleRocking::condition::{Interface, Stepping};
use FlexibleRocking::fmi3::co_simulation::STAGES;
use FlexibleRocking::fmi3::*;
use FlexibleRocking::resources::PARAMETERS_FILE;
use FlexibleRocking::snapshot;
use FlexibleRocking::state_machine::Stage;
use FlexibleRocking::variables::VARIABLES;
use fastrand::Rng;
use libc::{c_char, c_int, c_uint, c_void};
use rocking::Parameters;
use std::cell::RefCell;
use std::env;
use std::ffi::{CStr, CString};
use std::ptr::{null, null_mut, without_provenance_mut};
use tempfile::TempDir;

const OK: c_int = 0;
const DISCARD: c_int = 2;
const ERROR: c_int = 3;

/// Random calls without `FUZZ_CALLS`.
const CALLS: u64 = 24_000;

const CALLS_PER_SEQUENCE: u64 = 400;

/// The standard's sections 2.3 and 4.2.1, by the functions that each state names: instantiated, initialization mode, step
/// mode, event mode, intermediate update mode, step failed, terminated, error. The last three are the standard's
/// "terminated": after overturning, after `fmi3Terminate`, after an error; after the first of them a simulation has still to
/// be terminated. Within an intermediate update the inputs can be set.
const STANDARD: &str = "
    SetDebugLogging                 x x x x - x x x
    EnterInitializationMode         x - - - - - - -
    ExitInitializationMode          - x - - - - - -
    EnterEventMode                  - - x - - - - -
    Terminate                       - - x x - x - -
    Reset                           x x x x - x x x
    GetFloat64                      x x x x - x x x
    GetInt32                        x x x x - x x x
    GetInt64                        x x x x - x x x
    GetBoolean                      x x x x - x x x
    GetString                       x x x x - x x x
    SetFloat64                      x x x x x - - -
    SetInt32                        x x x x - - - -
    SetInt64                        x x x x - - - -
    SetBoolean                      x x x x - - - -
    SetString                       x x x x - - - -
    GetFMUState                     x x x x - x x x
    SetFMUState                     x x x x - x x x
    FreeFMUState                    x x x x - x x x
    SerializedFMUStateSize          x x x x - x x x
    SerializeFMUState               x x x x - x x x
    DeserializeFMUState             x x x x - x x x
    GetDirectionalDerivative        - x x x - x x x
    GetAdjointDerivative            - x x x - x x x
    EvaluateDiscreteStates          - - - x - - - -
    UpdateDiscreteStates            - - - x - - - -
    EnterStepMode                   - - - x - - - -
    GetOutputDerivatives            - - x - - x x x
    DoStep                          - - x - - - - -
";

/// Functions of what this unit has not.
const NOT_PROVIDED: &str = "GetFloat32 GetInt8 GetUInt8 GetInt16 GetUInt16 GetUInt32 GetUInt64 GetBinary GetClock SetFloat32 SetInt8 SetUInt8 SetInt16 SetUInt16 SetUInt32 SetUInt64 SetBinary SetClock GetNumberOfVariableDependencies GetVariableDependencies EnterConfigurationMode ExitConfigurationMode GetIntervalDecimal GetIntervalFraction GetShiftDecimal GetShiftFraction SetIntervalDecimal SetIntervalFraction SetShiftDecimal SetShiftFraction EnterContinuousTimeMode CompletedIntegratorStep SetTime SetContinuousStates GetContinuousStateDerivatives GetEventIndicators GetContinuousStates GetNominalsOfContinuousStates GetNumberOfEventIndicators GetNumberOfContinuousStates ActivateModelPartition";

type Log = RefCell<Vec<(c_int, String)>>;

struct Host {
    c: *mut c_void,
    log: Box<Log>,
    _resources: TempDir,
}

unsafe extern "C" fn record(log: *mut c_void, status: c_int, _: *const c_char, text: *const c_char) {
    let text = unsafe { CStr::from_ptr(text) }.to_str().unwrap().to_owned();
    unsafe { &*log.cast::<Log>() }.borrow_mut().push((status, text));
}

fn reference(name: &str) -> c_uint {
    VARIABLES.iter().position(|variable| variable.name == name).unwrap() as c_uint
}

fn resources() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join(PARAMETERS_FILE), toml::to_string(&Parameters::EVISON).unwrap()).unwrap();
    folder
}

impl Host {
    fn new(stepping: Stepping) -> Host {
        let (resources, log) = (resources(), Box::<Log>::default());
        let token = CString::new(FlexibleRocking::guid(&Parameters::EVISON.into())).unwrap();
        let folder = CString::new(format!("{}/", resources.path().display())).unwrap();
        let [event_mode, early_return] = [stepping.event_mode, stepping.early_return].map(u8::from);
        let environment = (&raw const *log).cast_mut().cast();
        let (name, token, folder) = (c"wall".as_ptr(), token.as_ptr(), folder.as_ptr());
        let c = unsafe {
            fmi3InstantiateCoSimulation(
                name,
                token,
                folder,
                0,
                0,
                event_mode,
                early_return,
                null(),
                0,
                environment,
                Some(record),
                None,
            )
        };
        assert!(!c.is_null(), "{log:?}");
        Host { c, log, _resources: resources }
    }

    fn set(&self, values: &[(&str, f64)]) {
        for (name, value) in values {
            assert_eq!(unsafe { fmi3SetFloat64(self.c, &reference(name), 1, value, 1) }, OK, "{:?}", self.log);
        }
    }

    /// In initialization mode.
    fn initializing(values: &[(&str, f64)]) -> Host {
        let host = Host::new(Stepping { event_mode: true, early_return: true });
        host.set(values);
        assert_eq!(unsafe { fmi3EnterInitializationMode(host.c, 0, 0.0, 0.0, 0, 0.0) }, OK);
        host
    }

    /// In event mode.
    fn at_event(values: &[(&str, f64)]) -> Host {
        let host = Host::initializing(values);
        assert_eq!(unsafe { fmi3ExitInitializationMode(host.c) }, OK, "{:?}", host.log);
        host
    }

    /// Ready for a step.
    fn started(values: &[(&str, f64)]) -> Host {
        let host = Host::at_event(values);
        assert_eq!(unsafe { fmi3EnterStepMode(host.c) }, OK);
        host
    }

    fn step(&self, time: f64, step: f64) -> c_int {
        let (mut flags, mut reached) = ([0u8; 3], 0.0);
        let [event, terminate, early] = &mut flags;
        unsafe { fmi3DoStep(self.c, time, step, 0, event, terminate, early, &mut reached) }
    }

    fn bytes(&self) -> Vec<u8> {
        let (mut state, mut size) = (null_mut(), 0);
        unsafe {
            assert_eq!(fmi3GetFMUState(self.c, &mut state), OK);
            assert_eq!(fmi3SerializedFMUStateSize(self.c, state, &mut size), OK);
            let mut bytes = vec![0; size];
            assert_eq!(fmi3SerializeFMUState(self.c, state, bytes.as_mut_ptr(), size), OK);
            assert_eq!(fmi3FreeFMUState(self.c, &mut state), OK);
            bytes
        }
    }

    /// As its state tells.
    fn stage(&self) -> Stage {
        snapshot::deserialize(&self.bytes()).unwrap().stage
    }
}

impl Drop for Host {
    fn drop(&mut self) {
        unsafe { fmi3FreeInstance(self.c) }
    }
}

fn host_in(stage: Stage) -> Host {
    match stage {
        Stage::Instantiated => Host::new(Stepping { event_mode: true, early_return: true }),
        Stage::InitializationMode => Host::initializing(&[]),
        Stage::StepComplete => Host::started(&[]),
        Stage::EventMode => Host::at_event(&[]),
        Stage::StepFailed => {
            let host = Host::started(&[("theta_0", 1.5), ("theta_dot_0", 1.0)]);
            assert_eq!(host.step(0.0, 1.0), OK);
            host
        }
        Stage::Terminated => {
            let host = Host::started(&[]);
            assert_eq!(unsafe { fmi3Terminate(host.c) }, OK);
            host
        }
        // the top mass above the pivot of a foundation without inertia: the equations of motion are singular
        Stage::Error => {
            let host = Host::started(&[("m0", 0.0), ("J0", 0.0), ("theta_0", 0.1), ("u_0", 0.285)]);
            assert_eq!(host.step(0.0, 0.1), ERROR);
            host
        }
        other => panic!("no instance stays in {other}"),
    }
}

/// Calls `function` with arguments that are of no use, but harmless where it is allowed.
fn call(host: &Host, function: Function) -> c_int {
    let c = host.c;
    let keep = || {
        let mut state = null_mut();
        assert_eq!(unsafe { fmi3GetFMUState(c, &mut state) }, OK);
        state
    };
    let mut flags = [0u8; 5];
    unsafe {
        match function {
            Function::SetDebugLogging => fmi3SetDebugLogging(c, 0, 0, null()),
            Function::EnterInitializationMode => fmi3EnterInitializationMode(c, 0, 0.0, 0.0, 0, 0.0),
            Function::ExitInitializationMode => fmi3ExitInitializationMode(c),
            Function::EnterEventMode => fmi3EnterEventMode(c),
            Function::Terminate => fmi3Terminate(c),
            Function::Reset => fmi3Reset(c),
            Function::GetFloat64 => fmi3GetFloat64(c, null(), 0, null_mut(), 0),
            Function::GetInt32 => fmi3GetInt32(c, null(), 0, null_mut(), 0),
            Function::GetInt64 => fmi3GetInt64(c, null(), 0, null_mut(), 0),
            Function::GetBoolean => fmi3GetBoolean(c, null(), 0, null_mut(), 0),
            Function::GetString => fmi3GetString(c, null(), 0, null_mut(), 0),
            Function::SetFloat64 => fmi3SetFloat64(c, null(), 0, null(), 0),
            Function::SetInt32 => fmi3SetInt32(c, null(), 0, null(), 0),
            Function::SetInt64 => fmi3SetInt64(c, null(), 0, null(), 0),
            Function::SetBoolean => fmi3SetBoolean(c, null(), 0, null(), 0),
            Function::SetString => fmi3SetString(c, null(), 0, null(), 0),
            Function::GetFMUState => fmi3GetFMUState(c, &mut null_mut()),
            Function::SetFMUState => fmi3SetFMUState(c, keep()),
            Function::FreeFMUState => fmi3FreeFMUState(c, null_mut()),
            Function::SerializedFMUStateSize => fmi3SerializedFMUStateSize(c, keep(), &mut 0),
            Function::SerializeFMUState => {
                let mut bytes = host.bytes();
                fmi3SerializeFMUState(c, keep(), bytes.as_mut_ptr(), bytes.len())
            }
            Function::DeserializeFMUState => {
                let bytes = host.bytes();
                fmi3DeserializeFMUState(c, bytes.as_ptr(), bytes.len(), &mut null_mut())
            }
            Function::GetDirectionalDerivative => {
                fmi3GetDirectionalDerivative(c, null(), 0, null(), 0, null(), 0, null_mut(), 0)
            }
            Function::GetAdjointDerivative => {
                fmi3GetAdjointDerivative(c, null(), 0, null(), 0, null(), 0, null_mut(), 0)
            }
            Function::EvaluateDiscreteStates => fmi3EvaluateDiscreteStates(c),
            Function::UpdateDiscreteStates => {
                let [a, b, d, e, f] = &mut flags;
                fmi3UpdateDiscreteStates(c, a, b, d, e, f, &mut 0.0)
            }
            Function::EnterStepMode => fmi3EnterStepMode(c),
            Function::GetOutputDerivatives => fmi3GetOutputDerivatives(c, null(), 0, null(), null_mut(), 0),
            Function::DoStep => host.step(0.0, 1e-3),
            Function::GetFloat32 => fmi3GetFloat32(c, null(), 0, null_mut(), 0),
            Function::GetInt8 => fmi3GetInt8(c, null(), 0, null_mut(), 0),
            Function::GetUInt8 => fmi3GetUInt8(c, null(), 0, null_mut(), 0),
            Function::GetInt16 => fmi3GetInt16(c, null(), 0, null_mut(), 0),
            Function::GetUInt16 => fmi3GetUInt16(c, null(), 0, null_mut(), 0),
            Function::GetUInt32 => fmi3GetUInt32(c, null(), 0, null_mut(), 0),
            Function::GetUInt64 => fmi3GetUInt64(c, null(), 0, null_mut(), 0),
            Function::GetBinary => fmi3GetBinary(c, null(), 0, null_mut(), null_mut(), 0),
            Function::GetClock => fmi3GetClock(c, null(), 0, null_mut()),
            Function::SetFloat32 => fmi3SetFloat32(c, null(), 0, null(), 0),
            Function::SetInt8 => fmi3SetInt8(c, null(), 0, null(), 0),
            Function::SetUInt8 => fmi3SetUInt8(c, null(), 0, null(), 0),
            Function::SetInt16 => fmi3SetInt16(c, null(), 0, null(), 0),
            Function::SetUInt16 => fmi3SetUInt16(c, null(), 0, null(), 0),
            Function::SetUInt32 => fmi3SetUInt32(c, null(), 0, null(), 0),
            Function::SetUInt64 => fmi3SetUInt64(c, null(), 0, null(), 0),
            Function::SetBinary => fmi3SetBinary(c, null(), 0, null(), null(), 0),
            Function::SetClock => fmi3SetClock(c, null(), 0, null()),
            Function::GetNumberOfVariableDependencies => fmi3GetNumberOfVariableDependencies(c, 0, null_mut()),
            Function::GetVariableDependencies => {
                fmi3GetVariableDependencies(c, 0, null_mut(), null_mut(), null_mut(), null_mut(), 0)
            }
            Function::EnterConfigurationMode => fmi3EnterConfigurationMode(c),
            Function::ExitConfigurationMode => fmi3ExitConfigurationMode(c),
            Function::GetIntervalDecimal => fmi3GetIntervalDecimal(c, null(), 0, null_mut(), null_mut()),
            Function::GetIntervalFraction => fmi3GetIntervalFraction(c, null(), 0, null_mut(), null_mut(), null_mut()),
            Function::GetShiftDecimal => fmi3GetShiftDecimal(c, null(), 0, null_mut()),
            Function::GetShiftFraction => fmi3GetShiftFraction(c, null(), 0, null_mut(), null_mut()),
            Function::SetIntervalDecimal => fmi3SetIntervalDecimal(c, null(), 0, null()),
            Function::SetIntervalFraction => fmi3SetIntervalFraction(c, null(), 0, null(), null()),
            Function::SetShiftDecimal => fmi3SetShiftDecimal(c, null(), 0, null()),
            Function::SetShiftFraction => fmi3SetShiftFraction(c, null(), 0, null(), null()),
            Function::EnterContinuousTimeMode => fmi3EnterContinuousTimeMode(c),
            Function::CompletedIntegratorStep => fmi3CompletedIntegratorStep(c, 0, null_mut(), null_mut()),
            Function::SetTime => fmi3SetTime(c, 0.0),
            Function::SetContinuousStates => fmi3SetContinuousStates(c, null(), 0),
            Function::GetContinuousStateDerivatives => fmi3GetContinuousStateDerivatives(c, null_mut(), 0),
            Function::GetEventIndicators => fmi3GetEventIndicators(c, null_mut(), 0),
            Function::GetContinuousStates => fmi3GetContinuousStates(c, null_mut(), 0),
            Function::GetNominalsOfContinuousStates => fmi3GetNominalsOfContinuousStates(c, null_mut(), 0),
            Function::GetNumberOfEventIndicators => fmi3GetNumberOfEventIndicators(c, null_mut()),
            Function::GetNumberOfContinuousStates => fmi3GetNumberOfContinuousStates(c, null_mut()),
            Function::ActivateModelPartition => fmi3ActivateModelPartition(c, 0, 0.0),
        }
    }
}

/// Where an allowed call of [`call`] leads.
fn after(function: Function, stage: Stage) -> Stage {
    match function {
        Function::EnterInitializationMode => Stage::InitializationMode,
        Function::ExitInitializationMode | Function::EnterEventMode => Stage::EventMode,
        Function::EnterStepMode => Stage::StepComplete,
        Function::Terminate => Stage::Terminated,
        Function::Reset => Stage::Instantiated,
        _ => stage,
    }
}

#[test]
fn a_call_is_allowed_where_the_standard_says_so() {
    let mut rows: Vec<Vec<_>> = STANDARD.trim().lines().map(|row| row.split_whitespace().collect()).collect();
    rows.extend(NOT_PROVIDED.split_whitespace().map(|name| [vec![name], vec!["-"; STAGES.len()]].concat()));
    assert_eq!(rows.len(), Function::ALL.len());
    for row in rows {
        let name = format!("fmi3{}", row[0]);
        let function = *Function::ALL.iter().find(|function| function.name() == name).unwrap();
        let is_allowed = |stage: &Stage| row[1 + STAGES.iter().position(|column| column == stage).unwrap()] == "x";
        let allowed: Vec<_> =
            Stage::ALL.into_iter().filter(|stage| STAGES.contains(stage) && is_allowed(stage)).collect();
        let names: Vec<_> = allowed.iter().map(Stage::to_string).collect();
        let names = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
        for stage in STAGES.iter().copied().filter(|stage| *stage != Stage::IntermediateUpdateMode) {
            let host = host_in(stage);
            assert_eq!(host.stage(), stage);
            host.log.borrow_mut().clear();
            let (before, status) = (host.bytes(), call(&host, function));
            let log = host.log.take();
            if allowed.contains(&stage) {
                assert_eq!((status, host.stage()), (OK, after(function, stage)), "{name} in {stage}: {log:?}");
                assert!(log.is_empty(), "{log:?}");
            } else {
                let refusal = format!("{name}: not allowed in the state \"{stage}\"; allowed in: {names}");
                assert_eq!((status, log), (ERROR, vec![(ERROR, refusal)]));
                assert_eq!(host.bytes(), before, "the refused {name} changed something");
            }
        }
    }
}

/// An instance is of one version: the other's functions find no component in it.
#[test]
fn the_other_versions_functions_refuse_an_instance() {
    let host = Host::started(&[]);
    unsafe {
        assert_eq!(FlexibleRocking::fmi2::fmi2Reset(host.c), ERROR);
        FlexibleRocking::fmi2::fmi2FreeInstance(host.c);
    }
    assert_eq!(host.stage(), Stage::StepComplete);
}

/// What a host that is called back may do: set inputs, and nothing else; least of all free the instance.
struct Called {
    c: *mut c_void,
    end: f64,
}

unsafe extern "C" fn update(environment: *mut c_void, _: f64, _: u8, _: u8, _: u8, _: u8, _: *mut u8, _: *mut f64) {
    let &Called { c, end } = unsafe { &*environment.cast::<Called>() };
    let (a_g, m) = (reference("a_g"), reference("m"));
    unsafe {
        fmi3FreeInstance(c);
        let (mut flags, mut reached, mut value, mut state) = ([0u8; 3], 0.0, 0.0, null_mut());
        let [event, terminate, early] = &mut flags;
        assert_eq!(fmi3DoStep(c, 0.0, 1.0, 0, event, terminate, early, &mut reached), ERROR);
        assert_eq!((fmi3Reset(c), fmi3GetFMUState(c, &mut state)), (ERROR, ERROR));
        assert_eq!(fmi3GetFloat64(c, &a_g, 1, &mut value, 1), ERROR);
        assert_eq!((fmi3SetFloat64(c, &m, 1, &end, 1), fmi3SetFloat64(c, &a_g, 1, &f64::NAN, 1)), (ERROR, ERROR));
        assert_eq!(fmi3SetFloat64(c, &a_g, 1, &end, 1), OK);
    }
}

#[test]
fn a_host_that_is_called_back_sets_inputs_and_does_no_harm() {
    let resources = resources();
    let token = CString::new(FlexibleRocking::guid(&Parameters::EVISON.into())).unwrap();
    let folder = CString::new(resources.path().to_str().unwrap()).unwrap();
    let mut called = Called { c: null_mut(), end: 2.0 };
    let (name, token, folder) = (c"wall".as_ptr(), token.as_ptr(), folder.as_ptr());
    let (a_g, environment) = (reference("a_g"), &raw mut called);
    let with = |required: &[c_uint]| unsafe {
        let (required, n) = (required.as_ptr(), required.len());
        let environment = environment.cast();
        fmi3InstantiateCoSimulation(name, token, folder, 0, 0, 0, 0, required, n, environment, None, Some(update))
    };
    assert!(with(&[a_g, reference("theta")]).is_null(), "theta is no intermediate variable");
    let c = with(&[a_g]);
    unsafe {
        (*environment).c = c;
        assert_eq!((fmi3EnterInitializationMode(c, 0, 0.0, 0.0, 0, 0.0), fmi3ExitInitializationMode(c)), (OK, OK));
        let (mut flags, mut reached, mut value) = ([0u8; 3], 0.0, 0.0);
        let [event, terminate, early] = &mut flags;
        for (time, end) in [(0.0, 2.0), (0.25, -1.0)] {
            (*environment).end = end;
            assert_eq!(fmi3DoStep(c, time, 0.25, 0, event, terminate, early, &mut reached), OK);
            assert_eq!((fmi3GetFloat64(c, &a_g, 1, &mut value, 1), value, reached), (OK, end, time + 0.25));
        }
        // an input that runs out of its range on the way ends the step and is as it was
        (*environment).end = 1e4;
        assert_eq!(fmi3SetFloat64(c, &a_g, 1, &3.0, 1), OK);
        assert_eq!(fmi3DoStep(c, 0.5, 0.25, 0, event, terminate, early, null_mut()), ERROR);
        assert_eq!((fmi3GetFloat64(c, &a_g, 1, &mut value, 1), value), (OK, 3.0));
        fmi3FreeInstance(c);
    }
}

/// Random functions with arguments from sensible to absurd: a call returns OK, Discard or Error, says why if it is not OK, and
/// changes nothing if it is Error, unless the solver got stuck; nothing is left behind.
#[test]
fn no_call_does_harm() {
    let calls = env::var("FUZZ_CALLS").map_or(CALLS, |calls| calls.parse().expect("FUZZ_CALLS is a number"));
    let mut done = vec![[0u64; 2]; Function::ALL.len()];
    random_calls(0, &mut done); // what a process keeps is no leak
    for number in 0..calls / CALLS_PER_SEQUENCE {
        let left = allocation_counter::measure(|| random_calls(number, &mut done));
        assert_eq!((left.count_current, left.bytes_current), (0, 0), "sequence {number} leaves something behind");
    }
    if calls >= CALLS {
        for (function, [ok, _]) in Function::ALL.iter().zip(&done) {
            let is_provided = !NOT_PROVIDED.split_whitespace().any(|name| function.name()[4..] == *name);
            assert_eq!(*ok > 0, is_provided, "{} was never done", function.name());
        }
    }
}

fn random_calls(number: u64, done: &mut [[u64; 2]]) {
    let mut rng = Rng::with_seed(number);
    let stepping = Stepping { event_mode: rng.bool(), early_return: rng.bool() };
    let host = Host::new(stepping);
    let (mut states, mut bytes, mut time) = (Vec::new(), Vec::new(), 0.0);
    for _ in 0..CALLS_PER_SEQUENCE {
        use Function::*;
        let stage = snapshot::deserialize(&host.bytes()).unwrap();
        assert_eq!(stage.interface, Interface::CoSimulation(stepping));
        time = stage.course.map_or(time, |course| course.motion.time);
        let leading_on: &[Function] = match stage.stage {
            Stage::Instantiated => &[SetFloat64, SetFloat64, EnterInitializationMode],
            Stage::InitializationMode => &[SetFloat64, GetFloat64, ExitInitializationMode, ExitInitializationMode],
            Stage::EventMode => &[UpdateDiscreteStates, EnterStepMode, EnterStepMode, GetFloat64],
            Stage::StepComplete => &[SetFloat64, DoStep, DoStep, DoStep, EnterEventMode],
            _ => &[Reset, SetFMUState, GetFloat64],
        };
        let functions = if rng.bool() { leading_on } else { Function::ALL };
        let function = functions[rng.usize(..functions.len())];
        let before = (rng.u8(..4) == 0).then(|| host.bytes());
        host.log.borrow_mut().clear();
        let status = random_call(&mut rng, &host, function, time, &mut states, &mut bytes);
        let (log, name) = (host.log.take(), function.name());
        assert!([OK, DISCARD, ERROR].contains(&status), "{name}: {status} {log:?}");
        let failures: Vec<_> = log.iter().filter(|(status, _)| *status > 1).collect();
        assert_eq!(failures.len(), usize::from(status != OK), "{name}: {log:?}");
        assert!(
            failures.iter().all(|(told, text)| *told == status && text.starts_with(&format!("{name}: "))),
            "{log:?}"
        );
        let is_stuck = failures.iter().any(|(_, text)| text.contains("cannot be continued"));
        if let Some(before) = before.filter(|_| status == ERROR && !is_stuck) {
            assert!(host.bytes() == before, "the refused {name} changed something: {log:?}");
        }
        done[Function::ALL.iter().position(|one| *one == function).unwrap()][usize::from(status != OK)] += 1;
    }
}

fn number(rng: &mut Rng) -> f64 {
    match rng.u8(..8) {
        0 => *rng.choice(&[f64::NAN, f64::INFINITY, -f64::INFINITY, 0.0, 5e-324, f64::MAX, -1e300]).unwrap(),
        1 => f64::from_bits(rng.u64(..)),
        2 => (rng.f64() - 0.5) * 10f64.powi(rng.i32(-12..12)),
        _ => rng.f64(),
    }
}

/// A pointer to `values`, or a bad one.
fn pointer<T>(rng: &mut Rng, values: &mut [T]) -> *mut T {
    match rng.u8(..60) {
        0 => null_mut(),
        1 if align_of::<T>() > 1 => values.as_mut_ptr().wrapping_byte_add(1),
        _ => values.as_mut_ptr(),
    }
}

fn random_call(
    rng: &mut Rng,
    host: &Host,
    function: Function,
    time: f64,
    states: &mut Vec<*mut c_void>,
    bytes: &mut Vec<u8>,
) -> c_int {
    let c = host.c;
    let n = rng.usize(..4);
    let named = match function {
        Function::SetInt64 => vec!["detail"],
        Function::SetBoolean => vec!["peaks", "validity", "extrapolate"],
        Function::GetInt64 => vec!["phase", "detail"],
        Function::GetInt32 => vec!["transitions"],
        Function::GetBoolean => vec!["overturned", "peaks"],
        Function::GetString | Function::SetString => vec!["record"],
        _ => vec!["a_g", "F_t", "theta_0", "u_0", "m", "B"],
    };
    let mut references: Vec<c_uint> = (0..n)
        .map(|_| match rng.u8(..8) {
            0 => rng.u32(..),
            1..3 => rng.u32(..VARIABLES.len() as c_uint),
            _ => reference(rng.choice(&named).unwrap()),
        })
        .collect();
    let length = if rng.u8(..30) == 0 { [usize::MAX, 1 << 40][rng.usize(..2)] } else { n };
    let vr = pointer(rng, &mut references);
    // as many as variables; more are said to be there only of what is refused for that
    let claimed = if rng.u8(..30) == 0 { n + 1 } else { length };
    let mut reals: Vec<f64> = (0..=n).map(|_| number(rng)).collect();
    let real = pointer(rng, &mut reals);
    let mut flags: Vec<u8> = (0..6).map(|_| rng.u8(..3)).collect();
    let mut state = match rng.u8(..10) {
        0 => without_provenance_mut(rng.usize(..)),
        1 => null_mut(),
        _ => rng.choice(states.iter()).copied().unwrap_or(null_mut()),
    };
    unsafe {
        match function {
            Function::SetDebugLogging => fmi3SetDebugLogging(c, flags[0], 0, null()),
            Function::EnterInitializationMode => {
                fmi3EnterInitializationMode(c, flags[0], reals[0], time, flags[1], number(rng))
            }
            Function::GetFloat64 => fmi3GetFloat64(c, vr, length, real, claimed),
            Function::SetFloat64 => fmi3SetFloat64(c, vr, length, real, claimed),
            Function::GetInt32 => fmi3GetInt32(c, vr, length, [0i32; 5].as_mut_ptr(), claimed),
            Function::SetInt32 => fmi3SetInt32(c, vr, length, [0i32; 5].as_ptr(), claimed),
            Function::GetInt64 => fmi3GetInt64(c, vr, length, [0i64; 5].as_mut_ptr(), claimed),
            Function::SetInt64 => fmi3SetInt64(c, vr, length, [rng.i64(-1..9); 5].as_ptr(), claimed),
            Function::GetBoolean => fmi3GetBoolean(c, vr, length, flags.as_mut_ptr(), claimed),
            Function::SetBoolean => fmi3SetBoolean(c, vr, length, flags.as_ptr(), claimed),
            Function::GetString => fmi3GetString(c, vr, length, [null(); 5].as_mut_ptr(), claimed),
            Function::SetString => {
                let texts = [c"", c"absent.csv", c"\xff", c"/dev/zero"].map(CStr::as_ptr);
                fmi3SetString(c, vr, length, [texts[rng.usize(..4)]; 5].as_ptr(), claimed)
            }
            Function::GetDirectionalDerivative | Function::GetAdjointDerivative => {
                let known = reference(["a_g", "F_t", "m", "theta"][rng.usize(..4)]);
                let mut unknowns =
                    [reference("a_t"), reference("R_v"), references.first().copied().unwrap_or_default()];
                let (m, mut to) = (rng.usize(..4), [0.0; 3]);
                let unknown = pointer(rng, &mut unknowns);
                if function == Function::GetAdjointDerivative {
                    let seed = [number(rng), 1.0, 2.0];
                    fmi3GetAdjointDerivative(c, unknown, m, &known, 1, seed.as_ptr(), m, to.as_mut_ptr(), 1)
                } else {
                    fmi3GetDirectionalDerivative(c, unknown, m, &known, 1, &number(rng), 1, to.as_mut_ptr(), m)
                }
            }
            Function::GetOutputDerivatives => {
                let orders = [if rng.u8(..10) == 0 { rng.i32(..) } else { 1 }; 5];
                let reference = [reference("v_t"), reference("theta"), rng.u32(..200)][rng.usize(..3)];
                fmi3GetOutputDerivatives(c, &reference, 1, orders.as_ptr(), real, 1)
            }
            Function::DoStep => {
                let point = if rng.u8(..16) == 0 { number(rng) } else { time };
                let step = match rng.u8(..60) {
                    0 => number(rng),
                    1 => 1e-300,
                    _ => 10f64.powf(-3.0 * rng.f64()),
                };
                let (mut reached, [event, terminate, early, ..]) = (0.0, &mut flags[..]) else { unreachable!() };
                let early: *mut u8 = if rng.u8(..40) == 0 { null_mut() } else { early };
                let status = fmi3DoStep(c, point, step, 0, event, terminate, early, &mut reached);
                assert!(status != OK || (point..=point + step).contains(&reached), "{point} {step} {reached}");
                status
            }
            Function::UpdateDiscreteStates => {
                let [a, b, d, e, f, ..] = &mut flags[..] else { unreachable!() };
                fmi3UpdateDiscreteStates(c, a, b, d, e, f, pointer(rng, &mut [0.0]))
            }
            Function::GetFMUState => {
                let is_new = state.is_null();
                let status = fmi3GetFMUState(c, &mut state);
                if status == OK && is_new {
                    states.push(state);
                }
                status
            }
            Function::SetFMUState => fmi3SetFMUState(c, state),
            Function::FreeFMUState => {
                let freed = state;
                let status = fmi3FreeFMUState(c, &mut state);
                states.retain(|state| status != OK || *state != freed);
                status
            }
            Function::SerializeFMUState => {
                *bytes = host.bytes();
                let mut room = vec![0; bytes.len()];
                fmi3SerializeFMUState(c, state, room.as_mut_ptr(), room.len())
            }
            Function::DeserializeFMUState => {
                if !bytes.is_empty() && rng.bool() {
                    let at = rng.usize(..bytes.len());
                    bytes[at] ^= 1 << rng.u8(..8);
                }
                let status = fmi3DeserializeFMUState(c, bytes.as_ptr(), bytes.len(), &mut state);
                if status == OK && !states.contains(&state) {
                    states.push(state);
                }
                status
            }
            Function::SerializedFMUStateSize => fmi3SerializedFMUStateSize(c, state, &mut 0),
            other => call(host, other),
        }
    }
}
