//! FMI 3.0: which call is allowed when, and that it is one instance with FMI 2.0.
#![allow(unsafe_code)] // the C interface

mod calls;
mod host;

use FlexibleRocking::fmi3::*;
use FlexibleRocking::interface::{Interface, Stepping};
use FlexibleRocking::snapshot;
use FlexibleRocking::state_machine::Stage;
use calls::fmi3::Fmi3;
use calls::{C, Messages, bytes, check};
use host::{ERROR, OK, STAGES_OF_MODEL, reference, resources};
use rocking::Parameters;
use std::cell::RefCell;
use std::ffi::{CStr, CString};
use std::ffi::{c_char, c_int, c_uint, c_void};
use std::ptr::{null, null_mut};
use tempfile::TempDir;

/// The standard's sections 2.3 and 4.2.1, by the functions that each state names: instantiated, initialization mode,
/// step mode, event mode, intermediate update mode, step failed, terminated, error. The last three are the standard's
/// "terminated": after overturning, after `fmi3Terminate`, after an error; after the first of them a simulation has
/// still to be terminated. Within an intermediate update the inputs can be set, or all values be had: it is said which,
/// and a step is no state to keep or to leave. The numbers of states and of event indicators can be had at any time, as
/// of the Reference FMUs.
const STANDARD: &str = "
    SetDebugLogging                 x x x x x x x x x
    EnterInitializationMode         x - - - - - - - -
    ExitInitializationMode          - x - - - - - - -
    EnterEventMode                  - - x - - - - - -
    Terminate                       - - x x - - x - -
    Reset                           x x x x - - x x x
    GetFloat64                      x x x x - x x x x
    GetInt32                        x x x x - x x x x
    GetInt64                        x x x x - x x x x
    GetBoolean                      x x x x - x x x x
    GetString                       x x x x - x x x x
    SetFloat64                      x x x x x - - - -
    SetInt32                        x x x x - - - - -
    SetInt64                        x x x x - - - - -
    SetBoolean                      x x x x - - - - -
    SetString                       x x x x - - - - -
    GetFMUState                     x x x x - - x x x
    SetFMUState                     x x x x - - x x x
    FreeFMUState                    x x x x - - x x x
    SerializedFMUStateSize          x x x x - - x x x
    SerializeFMUState               x x x x - - x x x
    DeserializeFMUState             x x x x - - x x x
    GetDirectionalDerivative        - x x x - - x x x
    GetAdjointDerivative            - x x x - - x x x
    EvaluateDiscreteStates          - - - x - - - - -
    UpdateDiscreteStates            - - - x - - - - -
    EnterStepMode                   - - - x - - - - -
    GetOutputDerivatives            - - x - - x x x x
    DoStep                          - - x - - - - - -
    GetNumberOfEventIndicators      x x x x x x x x x
    GetNumberOfContinuousStates     x x x x x x x x x
";

/// The stages of co-simulation.
const STAGES: [Stage; 9] = [
    Stage::Instantiated,
    Stage::InitializationMode,
    Stage::StepComplete,
    Stage::EventMode,
    Stage::IntermediateUpdateMode,
    Stage::IntermediateOutputs,
    Stage::StepFailed,
    Stage::Terminated,
    Stage::Error,
];

/// The standard's sections 2.3 and 3.2.1 for a model: instantiated, initialization mode, event mode, continuous-time
/// mode, terminated, error, which is the standard's "terminated" after an error. Beyond them the Reference FMUs let
/// time be set at an event, and the numbers be had at any time.
const STANDARD_OF_MODEL: &str = "
    SetDebugLogging                 x x x x x x
    EnterInitializationMode         x - - - - -
    ExitInitializationMode          - x - - - -
    EnterEventMode                  - - - x - -
    Terminate                       - - x x - -
    Reset                           x x x x x x
    GetFloat64                      x x x x x x
    GetInt32                        x x x x x x
    GetInt64                        x x x x x x
    GetBoolean                      x x x x x x
    GetString                       x x x x x x
    SetFloat64                      x x x x - -
    SetInt32                        x x x - - -
    SetInt64                        x x x - - -
    SetBoolean                      x x x - - -
    SetString                       x x x - - -
    GetFMUState                     x x x x x x
    SetFMUState                     x x x x x x
    FreeFMUState                    x x x x x x
    SerializedFMUStateSize          x x x x x x
    SerializeFMUState               x x x x x x
    DeserializeFMUState             x x x x x x
    GetDirectionalDerivative        - x x x x x
    GetAdjointDerivative            - x x x x x
    EvaluateDiscreteStates          - - x - - -
    UpdateDiscreteStates            - - x - - -
    EnterContinuousTimeMode         - - x - - -
    CompletedIntegratorStep         - - - x - -
    SetTime                         - - x x - -
    SetContinuousStates             - - - x - -
    GetContinuousStateDerivatives   - x x x x x
    GetEventIndicators              - x x x x x
    GetContinuousStates             - x x x x x
    GetNominalsOfContinuousStates   - x x x x x
    GetNumberOfEventIndicators      x x x x x x
    GetNumberOfContinuousStates     x x x x x x
";

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

impl Host {
    fn new(interface: Interface) -> Host {
        let (resources, log) = (resources(), Box::<Log>::default());
        let token = CString::new(FlexibleRocking::guid(&Parameters::EVISON.into())).unwrap();
        let folder = CString::new(format!("{}/", resources.path().display())).unwrap();
        let environment = (&raw const *log).cast_mut().cast();
        let (name, token, folder) = (c"wall".as_ptr(), token.as_ptr(), folder.as_ptr());
        let c = unsafe {
            match interface {
                Interface::ModelExchange => {
                    fmi3InstantiateModelExchange(name, token, folder, 0, 0, environment, Some(record))
                }
                Interface::CoSimulation(Stepping { event_mode, early_return }) => {
                    let (event_mode, early_return, log) = (event_mode.into(), early_return.into(), Some(record as _));
                    let none = null();
                    fmi3InstantiateCoSimulation(
                        name,
                        token,
                        folder,
                        0,
                        0,
                        event_mode,
                        early_return,
                        none,
                        0,
                        environment,
                        log,
                        None,
                    )
                }
            }
        };
        assert!(!c.is_null(), "{log:?}");
        Host { c, log, _resources: resources }
    }

    /// For co-simulation, to be stopped at transitions.
    fn new_slave() -> Host {
        Host::new(Interface::CoSimulation(Stepping { event_mode: true, early_return: true }))
    }

    fn set(&self, values: &[(&str, f64)]) {
        for (name, value) in values {
            assert_eq!(unsafe { fmi3SetFloat64(self.c, &reference(name), 1, value, 1) }, OK, "{:?}", self.log);
        }
    }

    /// The same in initialization mode.
    fn initializing(self, values: &[(&str, f64)]) -> Host {
        self.set(values);
        assert_eq!(unsafe { fmi3EnterInitializationMode(self.c, 0, 0.0, 0.0, 0, 0.0) }, OK);
        self
    }

    /// The same in event mode.
    fn at_event(self, values: &[(&str, f64)]) -> Host {
        let host = self.initializing(values);
        assert_eq!(unsafe { fmi3ExitInitializationMode(host.c) }, OK, "{:?}", host.log);
        host
    }

    /// For co-simulation, ready for a step.
    fn started(values: &[(&str, f64)]) -> Host {
        let host = Host::new_slave().at_event(values);
        assert_eq!(unsafe { fmi3EnterStepMode(host.c) }, OK);
        host
    }

    /// For model exchange, in continuous-time mode.
    fn going_model(values: &[(&str, f64)]) -> Host {
        let host = Host::new(Interface::ModelExchange).at_event(values);
        host.update();
        assert_eq!(unsafe { fmi3EnterContinuousTimeMode(host.c) }, OK);
        host
    }

    /// What `fmi3UpdateDiscreteStates` tells: four Booleans, and when the next event is.
    fn update(&self) -> ([bool; 4], Option<f64>) {
        let (mut flags, mut next) = ([u8::MAX; 5], f64::NAN);
        let [needed, end, nominals, values, is_foreseen] = &mut flags;
        let status = unsafe { fmi3UpdateDiscreteStates(self.c, needed, end, nominals, values, is_foreseen, &mut next) };
        assert_eq!(status, OK, "{:?}", self.log);
        let [told @ .., is_foreseen] = flags.map(|flag| [false, true][usize::from(flag)]);
        (told, is_foreseen.then_some(next))
    }

    /// Numbers of a model, by a function that writes them.
    fn written<const N: usize>(&self, get: unsafe extern "C" fn(*mut c_void, *mut f64, usize) -> c_int) -> [f64; N] {
        let mut values = [f64::MAX; N];
        assert_eq!(unsafe { get(self.c, values.as_mut_ptr(), N) }, OK, "{:?}", self.log);
        values
    }

    fn get<const N: usize>(&self, names: [&str; N]) -> [f64; N] {
        let (references, mut values) = (names.map(reference), [f64::MAX; N]);
        assert_eq!(unsafe { fmi3GetFloat64(self.c, references.as_ptr(), N, values.as_mut_ptr(), N) }, OK);
        values
    }

    /// Goes to the state that `bytes` hold.
    fn go_to(&self, bytes: &[u8]) {
        let mut state = null_mut();
        unsafe {
            assert_eq!(fmi3DeserializeFMUState(self.c, bytes.as_ptr(), bytes.len(), &mut state), OK);
            assert_eq!((fmi3SetFMUState(self.c, state), fmi3FreeFMUState(self.c, &mut state)), (OK, OK));
        }
    }

    fn step(&self, time: f64, step: f64) -> c_int {
        let (mut flags, mut reached) = ([0u8; 3], 0.0);
        let [event, terminate, early] = &mut flags;
        unsafe { fmi3DoStep(self.c, time, step, 0, event, terminate, early, &mut reached) }
    }

    fn bytes(&self) -> Vec<u8> {
        bytes::<Fmi3>(self.c)
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

/// The top mass above the pivot of a foundation without inertia: the equations of motion are singular.
const ABOVE_THE_PIVOT: [(&str, f64); 4] = [("m0", 0.0), ("J0", 0.0), ("theta_0", 0.1), ("u_0", 0.285)];

fn slave_in(stage: Stage) -> Host {
    match stage {
        Stage::Instantiated => Host::new_slave(),
        Stage::InitializationMode => Host::new_slave().initializing(&[]),
        Stage::StepComplete => Host::started(&[]),
        Stage::EventMode => Host::new_slave().at_event(&[]),
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
        Stage::Error => {
            let host = Host::started(&ABOVE_THE_PIVOT);
            assert_eq!(host.step(0.0, 0.1), ERROR);
            host
        }
        other => panic!("no instance stays in {other}"),
    }
}

fn model_in(stage: Stage) -> Host {
    let new = || Host::new(Interface::ModelExchange);
    match stage {
        Stage::Instantiated => new(),
        Stage::InitializationMode => new().initializing(&[]),
        Stage::EventMode => new().at_event(&[]),
        Stage::ContinuousTimeMode => Host::going_model(&[]),
        Stage::Terminated => {
            let host = Host::going_model(&[]);
            assert_eq!(unsafe { fmi3Terminate(host.c) }, OK);
            host
        }
        Stage::Error => {
            let host = Host::going_model(&ABOVE_THE_PIVOT);
            let (mut event, mut end) = (0, 0);
            unsafe {
                assert_eq!(fmi3SetTime(host.c, 0.1), OK);
                assert_eq!(fmi3CompletedIntegratorStep(host.c, 0, &mut event, &mut end), ERROR);
            }
            host
        }
        other => panic!("no model is ever in {other}"),
    }
}

fn look(host: &Host) -> (C, Messages) {
    (host.c, host.log.take())
}

#[test]
fn a_call_of_a_slave_is_allowed_where_the_standard_says_so() {
    check::<Fmi3, _>(STANDARD, &STAGES, Stage::EventMode, slave_in, look);
}

#[test]
fn a_call_of_a_model_is_allowed_where_the_standard_says_so() {
    check::<Fmi3, _>(STANDARD_OF_MODEL, &STAGES_OF_MODEL, Stage::EventMode, model_in, look);
}

/// The same calls lead to the same bytes, from which either goes on.
#[test]
fn a_model_is_the_same_in_both_versions() {
    let starts = [("theta_0", 0.02), ("u_0", 5e-4), ("a_g", 0.5)];
    let (two, three) = (host::Host::going_model(&starts), Host::going_model(&starts));
    assert_eq!(three.bytes(), two.bytes());
    assert_eq!(three.written(fmi3GetNominalsOfContinuousStates), two.nominals().unwrap());
    let states = [2e-4, -0.01, 0.015, -0.2];
    unsafe {
        assert_eq!((fmi3SetTime(three.c, 0.1), two.set_time(0.1)), (OK, OK));
        assert_eq!((fmi3SetContinuousStates(three.c, states.as_ptr(), 4), two.set_states(states)), (OK, OK));
    }
    assert_eq!(three.written(fmi3GetContinuousStateDerivatives), two.derivatives().unwrap());
    assert_eq!(three.written(fmi3GetEventIndicators), two.indicators().unwrap());
    assert_eq!(three.bytes(), two.bytes());
    let (mut event, mut end) = (u8::MAX, u8::MAX);
    unsafe {
        assert_eq!((fmi3SetTime(three.c, 0.35), two.set_time(0.35)), (OK, OK));
        assert_eq!(fmi3CompletedIntegratorStep(three.c, 1, &mut event, &mut end), OK);
        assert_eq!(two.complete(), Ok((event == 1, end == 1)));
        assert_eq!((event, end), (1, 0));
        assert_eq!((fmi3EnterEventMode(three.c), two.enter_event_mode()), (OK, OK));
    }
    assert_eq!(three.bytes(), two.bytes());
    let before = two.bytes();
    assert_eq!(
        (three.update(), two.update().unwrap().values_of_continuous_states_changed),
        (([false, false, false, true], None), 1)
    );
    assert_eq!(three.bytes(), two.bytes());
    assert_ne!(three.bytes(), before);
    three.go_to(&before);
    assert!(three.update().0[3]);
    assert_eq!((three.bytes(), two.integer("transitions")), (two.bytes(), 1));
}

/// What a host is told of as a number of variables, and what it can look up by name.
#[test]
fn the_indicators_are_variables() {
    for (starts, time) in [([("u_0", 3e-4)], 0.0), ([("theta_0", 0.02)], 0.05), ([("theta_0", -0.3)], 1.0)] {
        let host = Host::going_model(&starts);
        assert_eq!(unsafe { fmi3SetTime(host.c, time) }, OK);
        assert_eq!(host.written(fmi3GetEventIndicators), host.get(["phase_indicator", "overturning_indicator"]));
    }
    let (host, mut count) = (Host::new(Interface::ModelExchange), [0; 2]);
    let [indicators, states] = &mut count;
    unsafe {
        assert_eq!(
            (fmi3GetNumberOfEventIndicators(host.c, indicators), fmi3GetNumberOfContinuousStates(host.c, states)),
            (OK, OK)
        )
    };
    assert_eq!(count, [2, 4]);
}

/// An acceleration that a host sets at an event lifts a rigid structure off there and then, unless it is to come one
/// step late.
#[test]
fn what_acts_at_an_event_is_what_lifts_off_there() {
    for (a_g_late, phase_after) in [(0, 3), (1, 1)] {
        let host = Host::new_slave();
        let (rigid, mut phase) = (5, 0);
        assert_eq!(unsafe { fmi3SetInt64(host.c, &reference("detail"), 1, &rigid, 1) }, OK);
        assert_eq!(unsafe { fmi3SetBoolean(host.c, &reference("a_g_late"), 1, &a_g_late, 1) }, OK);
        let host = host.at_event(&[]);
        host.set(&[("a_g", -50.0)]);
        host.update();
        assert_eq!(unsafe { fmi3GetInt64(host.c, &reference("phase"), 1, &mut phase, 1) }, OK);
        assert_eq!(phase, phase_after, "a_g_late = {a_g_late}");
    }
}

/// A host can go to a state that an instance of its own kind has kept, and to no other.
#[test]
fn a_state_is_taken_by_an_instance_of_its_kind_alone() {
    let plain = Host::new(Interface::CoSimulation(Stepping::default()));
    for (bytes, slave) in [(Host::going_model(&[]).bytes(), Host::started(&[])), (Host::started(&[]).bytes(), plain)] {
        let (before, mut state) = (slave.bytes(), null_mut());
        unsafe {
            assert_eq!(fmi3DeserializeFMUState(slave.c, bytes.as_ptr(), bytes.len(), &mut state), OK);
            assert_eq!(fmi3SetFMUState(slave.c, state), ERROR);
        }
        assert_eq!(slave.bytes(), before);
        let message = "fmi3SetFMUState: the FMU state was kept by an instance of another kind: model exchange, co-simulation, \
                       and co-simulation with eventModeUsed or earlyReturnAllowed have states of their own";
        assert_eq!(slave.log.take(), [(ERROR, message.to_owned())]);
    }
}

/// Messages name the function that was called, and end with the function of this version to call instead.
#[test]
fn a_refusal_names_the_function_and_what_to_call() {
    let host = Host::new(Interface::CoSimulation(Stepping::default()));
    let (c, mut flag, mut real) = (host.c, 0, 0.0);
    let refused = |status: c_int, message: &str| {
        assert_eq!(status, ERROR);
        assert_eq!(host.log.take(), [(ERROR, message.to_owned())]);
    };
    unsafe {
        assert_eq!((fmi3EnterInitializationMode(c, 0, 0.0, 0.0, 1, 2.0), fmi3ExitInitializationMode(c)), (OK, OK));
        let mut get = |name| fmi3GetFloat64(c, &reference(name), 1, &mut real, 1);
        refused(get("transitions"), "fmi3GetFloat64: transitions is an integer: call fmi3GetInt32 instead");
        let message = "fmi3GetFloat64: phase is an enumeration: call fmi3GetInt64 or fmi3SetInt64 instead";
        refused(get("phase"), message);
        let message = "fmi3GetFloat64: peaks is a Boolean: call fmi3GetBoolean or fmi3SetBoolean instead";
        refused(get("peaks"), message);
        let message = "fmi3GetFloat64: record is a string: call fmi3GetString or fmi3SetString instead";
        refused(get("record"), message);
        let message = "fmi3GetInt64: theta is a real number: call fmi3GetFloat64 or fmi3SetFloat64 instead";
        refused(fmi3GetInt64(c, &reference("theta"), 1, &mut 0, 1), message);
        let message = "fmi3SetFloat64: m is fixed once the simulation has started: set it before fmi3ExitInitializationMode, \
                       or call fmi3Reset";
        refused(fmi3SetFloat64(c, &reference("m"), 1, &1.0, 1), message);
        refused(fmi3GetFloat64(c, &2, 1, &mut real, 2), "fmi3GetFloat64: nValues = 2 is not 1");
        let message = "fmi3GetUInt8: not allowed in the state \"step complete\"; allowed in: none";
        refused(fmi3GetUInt8(c, &2, 1, &mut 0, 1), message);
        let message = "fmi3EnterEventMode: there is no event mode: the instance was made with eventModeUsed = false";
        refused(fmi3EnterEventMode(c), message);
        let mut step = |time: f64, step: f64| fmi3DoStep(c, time, step, 0, &mut flag, &mut 0, &mut 0, &mut 0.0);
        let message = "fmi3DoStep: currentCommunicationPoint = 1 s is not where the FMU is, t = 0 s: step from there, or go \
                       back with fmi3SetFMUState";
        refused(step(1.0, 0.1), message);
        let message = "fmi3DoStep: the step would end at t = 3 s, past stopTime = 2 s given to fmi3EnterInitializationMode: \
                       shorten it";
        refused(step(0.0, 3.0), message);
        let (mut state, size) = (null_mut(), host.bytes().len());
        assert_eq!(fmi3GetFMUState(c, &mut state), OK);
        let message = format!(
            "fmi3SerializeFMUState: size = 0 does not fit: the serialized FMU state takes {size} bytes \
             (fmi3SerializedFMUStateSize)"
        );
        refused(fmi3SerializeFMUState(c, state, null_mut(), 0), &message);
        let model = Host::going_model(&[]);
        assert_eq!((fmi3SetTime(model.c, -1.0), fmi3CompletedIntegratorStep(model.c, 1, &mut 0, &mut 0)), (OK, ERROR));
        assert!(
            model.log.take()[0]
                .1
                .ends_with("time goes on from an event or a complete step, or goes back with fmi3SetFMUState")
        );
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

/// A host that is called back. It may set inputs before a step is computed and read afterwards, and nothing else; least
/// of all free the instance.
struct Called {
    c: *mut c_void,
    /// What the input is to be at the end of the next step.
    end: f64,
    /// When it read theta and its rate, and what these were.
    read: Vec<[f64; 3]>,
}

unsafe extern "C" fn update(
    environment: *mut c_void,
    time: f64,
    set: u8,
    get: u8,
    finished: u8,
    _: u8,
    _: *mut u8,
    _: *mut f64,
) {
    let Called { c, end, read } = unsafe { &mut *environment.cast::<Called>() };
    let (c, theta, a_g, m) = (*c, reference("theta"), reference("a_g"), reference("m"));
    unsafe {
        fmi3FreeInstance(c);
        let (mut flags, mut reached, mut value, mut rate, mut state) = ([0u8; 3], 0.0, 0.0, 0.0, null_mut());
        let [event, terminate, early] = &mut flags;
        assert_eq!(fmi3DoStep(c, 0.0, 1.0, 0, event, terminate, early, &mut reached), ERROR);
        assert_eq!((fmi3Reset(c), fmi3GetFMUState(c, &mut state)), (ERROR, ERROR));
        assert_eq!(fmi3SetDebugLogging(c, 0, 0, null()), OK);
        let got = fmi3GetFloat64(c, &theta, 1, &mut value, 1);
        let got = (got, fmi3GetOutputDerivatives(c, &theta, 1, &1, &mut rate, 1));
        assert_eq!((fmi3SetFloat64(c, &m, 1, end, 1), fmi3SetFloat64(c, &a_g, 1, &f64::NAN, 1)), (ERROR, ERROR));
        let was_set = fmi3SetFloat64(c, &a_g, 1, end, 1);
        match (set, get, finished) {
            (1, 0, 0) => assert_eq!((was_set, got), (OK, (ERROR, ERROR))),
            (0, 1, 1) => {
                assert_eq!((was_set, got), (ERROR, (OK, OK)));
                read.push([time, value, rate]);
            }
            other => panic!("{other:?}"),
        }
    }
}

#[test]
fn a_host_that_is_called_back_sets_inputs_reads_and_does_no_harm() {
    let resources = resources();
    let token = CString::new(FlexibleRocking::guid(&Parameters::EVISON.into())).unwrap();
    let folder = CString::new(resources.path().to_str().unwrap()).unwrap();
    let mut called = Called { c: null_mut(), end: 2.0, read: Vec::new() };
    let (name, token, folder) = (c"wall".as_ptr(), token.as_ptr(), folder.as_ptr());
    let (a_g, theta, environment) = (reference("a_g"), reference("theta"), &raw mut called);
    let with = |required: &[c_uint], environment: *mut Called| unsafe {
        let (required, n, environment) = (required.as_ptr(), required.len(), environment.cast());
        fmi3InstantiateCoSimulation(name, token, folder, 0, 0, 0, 0, required, n, environment, None, Some(update))
    };
    assert!(with(&[a_g, c_uint::MAX], environment).is_null());
    for (required, sets, reads) in [(&[a_g][..], true, false), (&[theta], false, true), (&[a_g, theta], true, true)] {
        let c = with(required, environment);
        unsafe {
            (*environment).c = c;
            assert_eq!(fmi3SetFloat64(c, &reference("theta_0"), 1, &0.3, 1), OK);
            assert_eq!((fmi3EnterInitializationMode(c, 0, 0.0, 0.0, 0, 0.0), fmi3ExitInitializationMode(c)), (OK, OK));
            let (mut flags, mut reached, mut value, mut rate) = ([0u8; 3], 0.0, 0.0, 0.0);
            let [event, terminate, early] = &mut flags;
            for (time, end) in [(0.0, 2.0), (0.25, -1.0)] {
                (*environment).end = end;
                assert_eq!(fmi3DoStep(c, time, 0.25, 0, event, terminate, early, &mut reached), OK);
                assert_eq!((fmi3GetFloat64(c, &a_g, 1, &mut value, 1), value), (OK, if sets { end } else { 0.0 }));
                assert_eq!(fmi3GetFloat64(c, &theta, 1, &mut value, 1), OK);
                assert_eq!(fmi3GetOutputDerivatives(c, &theta, 1, &1, &mut rate, 1), OK);
                let read = std::mem::take(&mut (*environment).read);
                assert_eq!(read, if reads { vec![[time + 0.25, value, rate]] } else { vec![] });
            }
            // an input that runs out of its range on the way ends the step and is as it was
            (*environment).end = 1e4;
            assert_eq!(fmi3SetFloat64(c, &a_g, 1, &3.0, 1), OK);
            assert_eq!(fmi3DoStep(c, 0.5, 0.25, 0, event, terminate, early, null_mut()), ERROR);
            assert_eq!((fmi3GetFloat64(c, &a_g, 1, &mut value, 1), value), (OK, 3.0));
            // the instant of overturning is where it reads last
            (*environment).end = 0.0;
            assert_eq!(fmi3DoStep(c, 0.5, 100.0, 0, event, terminate, early, &mut reached), OK);
            let ends: Vec<_> = std::mem::take(&mut (*environment).read).iter().map(|read| read[0]).collect();
            assert_eq!((*terminate, ends), (1, if reads { vec![reached] } else { vec![] }));
            fmi3FreeInstance(c);
        }
    }
}
