//! FMI 3.0 where it is not FMI 2.0: events, messages, calls back within a step.

use crate::host::{self, ERROR, OK, resources};
use FlexibleRocking::fmi3::*;
use fmi_unit::interface::Stepping;
use libc::{c_char, c_int, c_uint, c_void};
use rocking::Parameters;
use std::cell::RefCell;
use std::ffi::{CStr, CString};
use std::ptr::{null, null_mut};
use tempfile::TempDir;

fn reference(name: &str) -> c_uint {
    host::reference(name) + 1
}

type Log = RefCell<Vec<String>>;

struct Host {
    c: *mut c_void,
    log: Box<Log>,
    _resources: TempDir,
}

/// Of a refusal the text, of another message the category.
unsafe extern "C" fn record(log: *mut c_void, status: c_int, category: *const c_char, text: *const c_char) {
    let text = if status == ERROR { text } else { category };
    let text = unsafe { CStr::from_ptr(text) }.to_str().unwrap().to_owned();
    unsafe { &*log.cast::<Log>() }.borrow_mut().push(text);
}

impl Host {
    /// For co-simulation, or for model exchange.
    fn new(stepping: Option<Stepping>) -> Host {
        let (resources, log) = (resources(), Box::<Log>::default());
        let token = CString::new(FlexibleRocking::guid(&crate::host::contents(Parameters::EVISON))).unwrap();
        let folder = CString::new(format!("{}/", resources.path().display())).unwrap();
        let [name, token, folder] = [c"wall".as_ptr(), token.as_ptr(), folder.as_ptr()];
        let (log_of, record) = ((&raw const *log).cast_mut().cast(), Some(record as LogMessageCallback));
        let c = match stepping {
            Some(Stepping { event_mode, early_return }) => unsafe {
                let [events, early] = [event_mode.into(), early_return.into()];
                let (required, count, update) = (null(), 0, None);
                fmi3InstantiateCoSimulation(
                    name, token, folder, 0, 0, events, early, required, count, log_of, record, update,
                )
            },
            None => unsafe { fmi3InstantiateModelExchange(name, token, folder, 0, 0, log_of, record) },
        };
        assert!(!c.is_null(), "{log:?}");
        Host { c, log, _resources: resources }
    }

    /// After initialization, up to `stop_time` (s).
    fn started(stepping: Option<Stepping>, stop_time: f64) -> Host {
        let host = Host::new(stepping);
        unsafe {
            assert_eq!(fmi3EnterInitializationMode(host.c, 0, 0.0, 0.0, 1, stop_time), OK);
            assert_eq!(fmi3ExitInitializationMode(host.c), OK);
        }
        host
    }

    /// As bytes of its state.
    fn bytes(&self) -> Vec<u8> {
        let (mut state, mut size) = (null_mut(), 0);
        unsafe {
            assert_eq!(fmi3GetFMUState(self.c, &mut state), OK);
            assert_eq!(fmi3SerializedFMUStateSize(self.c, state, &mut size), OK);
            let mut bytes = vec![0; size];
            assert_eq!(fmi3SerializeFMUState(self.c, state, bytes.as_mut_ptr(), size), OK);
            bytes
        }
    }
}

impl Drop for Host {
    fn drop(&mut self) {
        unsafe { fmi3FreeInstance(self.c) }
    }
}

/// An acceleration that a host sets at an event lifts a rigid structure off there and then, unless it is to come one
/// step late.
#[test]
fn what_acts_at_an_event_is_what_lifts_off_there() {
    for (a_g_late, phase_after) in [(0, 3), (1, 1)] {
        let host = Host::new(Some(Stepping { event_mode: true, early_return: true }));
        let (c, rigid, mut phase, mut flags, mut next) = (host.c, 5, 0, [0; 5], 0.0);
        let [needed, end, nominals, values, is_foreseen] = &mut flags;
        unsafe {
            assert_eq!(fmi3SetInt64(c, &reference("detail"), 1, &rigid, 1), OK);
            assert_eq!(fmi3SetBoolean(c, &reference("a_g_late"), 1, &a_g_late, 1), OK);
            assert_eq!((fmi3EnterInitializationMode(c, 0, 0.0, 0.0, 0, 0.0), fmi3ExitInitializationMode(c)), (OK, OK));
            assert_eq!(fmi3SetFloat64(c, &reference("a_g"), 1, &-50.0, 1), OK);
            assert_eq!(fmi3UpdateDiscreteStates(c, needed, end, nominals, values, is_foreseen, &mut next), OK);
            assert_eq!(fmi3GetInt64(c, &reference("phase"), 1, &mut phase, 1), OK);
        }
        assert_eq!((phase, flags), (phase_after, [0; 5]), "a_g_late = {a_g_late}");
    }
}

/// A host that handles events but no early return gets whole steps, from the start time that it has set, whatever it read before.
#[test]
fn a_step_ends_early_for_hosts_that_take_it_alone() {
    let host = Host::new(Some(Stepping { event_mode: true, early_return: false }));
    let (c, mut flags, mut time) = (host.c, [0; 3], f64::NAN);
    let [event, end, early] = &mut flags;
    unsafe {
        assert_eq!(fmi3SetFloat64(c, &reference("theta_0"), 1, &0.02, 1), OK);
        assert_eq!(fmi3GetFloat64(c, &reference("theta"), 1, &mut time, 1), OK);
        assert_eq!((fmi3EnterInitializationMode(c, 0, 0.0, 5.0, 0, 0.0), fmi3ExitInitializationMode(c)), (OK, OK));
        assert_eq!(fmi3EnterStepMode(c), OK);
        assert_eq!(fmi3DoStep(c, 5.0, 1.0, 0, event, end, early, &mut time), OK);
    }
    assert_eq!((flags, time), ([0; 3], 6.0));
}

/// A host can go to a state that an instance of its own kind has kept, and to no other.
#[test]
fn a_state_is_taken_by_an_instance_of_its_kind_alone() {
    let kinds = [None, Some(Stepping::default()), Some(Stepping { event_mode: true, early_return: true })];
    for (of, by) in [(0, 1), (1, 2), (2, 0)] {
        let (bytes, host) = (Host::started(kinds[of], 2.0).bytes(), Host::started(kinds[by], 2.0));
        let mut state = null_mut();
        unsafe {
            assert_eq!(fmi3DeserializeFMUState(host.c, bytes.as_ptr(), bytes.len(), &mut state), OK);
            assert_eq!(fmi3SetFMUState(host.c, state), ERROR);
        }
        let message = "fmi3SetFMUState: the FMU state was kept by an instance for the other interface, or with another \
                       eventModeUsed or earlyReturnAllowed";
        assert_eq!(host.log.take(), [message]);
    }
}

/// Messages name the function that was called, and end with the function of this version to call instead.
#[test]
fn a_refusal_names_the_function_and_what_to_call() {
    let host = Host::started(Some(Stepping::default()), 2.0);
    let (c, mut state, mut real) = (host.c, null_mut(), 0.0);
    let (size, model) = (host.bytes().len(), Host::started(None, 2.0));
    unsafe {
        assert_eq!(fmi3GetFMUState(c, &mut state), OK);
        let mut get = |name| fmi3GetFloat64(c, &reference(name), 1, &mut real, 1);
        let step = |time: f64, step: f64| fmi3DoStep(c, time, step, 0, &mut 0, &mut 0, &mut 0, &mut 0.0);
        let refused = [
            ["transitions", "phase", "peaks", "record"].map(&mut get).into_iter().max().unwrap(),
            fmi3GetInt64(c, &reference("theta"), 1, &mut 0, 1),
            fmi3SetFloat64(c, &reference("m"), 1, &1.0, 1),
            fmi3GetFloat64(c, &0, 1, &mut 0.0, 1),
            fmi3GetFloat64(c, &2, 1, &mut 0.0, 2),
            fmi3GetUInt8(c, &0, 1),
            fmi3GetAdjointDerivative(c),
            fmi3EnterEventMode(c),
            step(1.0, 0.1),
            step(0.0, 3.0),
            fmi3SerializeFMUState(c, state, null_mut(), 0),
            fmi3GetDirectionalDerivative(c, &2, 1, &0, 1, &1.0, 2, &mut 0.0, 1),
        ];
        assert_eq!(refused, [ERROR; 12]);
        assert_eq!((fmi3GetUInt8(c, null(), 0), fmi3SetBinary(c, null(), 0)), (OK, OK));
        assert_eq!((fmi3EnterContinuousTimeMode(model.c), fmi3SetTime(model.c, -1.0)), (OK, OK));
        assert_eq!(fmi3CompletedIntegratorStep(model.c, 1, &mut 0, &mut 0), ERROR);
    }
    let bytes = format!("takes {size} bytes (fmi3SerializedFMUStateSize)");
    let expected = [
        "fmi3GetFloat64: transitions is an integer: call fmi3GetInt32 instead",
        "fmi3GetFloat64: phase is an enumeration: call fmi3GetInt64 or fmi3SetInt64 instead",
        "fmi3GetFloat64: peaks is a Boolean: call fmi3GetBoolean or fmi3SetBoolean instead",
        "fmi3GetFloat64: record is a string: call fmi3GetString or fmi3SetString instead",
        "fmi3GetInt64: theta is a real number: call fmi3GetFloat64 or fmi3SetFloat64 instead",
        "fmi3SetFloat64: m is fixed once the simulation has started: set it before fmi3ExitInitializationMode, or call \
         fmi3Reset",
        &format!("fmi3GetFloat64: value reference 0 does not exist; they run from 1 to {}", host::VARIABLES.len()),
        "fmi3GetFloat64: nValues = 2 is not 1",
        "fmi3GetUInt8: this FMU has no variables of this type",
        "fmi3GetAdjointDerivative: not allowed in the state \"step complete\"; allowed in: none",
        "fmi3EnterEventMode: there is no event mode: the instance was made with eventModeUsed = false",
        "fmi3DoStep: currentCommunicationPoint = 1 s differs from the time of the FMU, t = 0 s: step from there, or go back with \
         fmi3SetFMUState",
        "fmi3DoStep: the step would end at t = 3 s, past stopTime = 2 s given to fmi3EnterInitializationMode: shorten it",
        &format!("fmi3SerializeFMUState: size = 0 does not fit: the serialized FMU state {bytes}"),
        "fmi3GetDirectionalDerivative: nSeed = 2 is not 1",
    ];
    assert_eq!(host.log.take(), expected);
    let ends = "time must not fall below the last event or complete step; to go back, call fmi3SetFMUState";
    assert!(model.log.take()[0].ends_with(ends));
}

/// Each category is switched by itself; the reasons of refused calls are always logged.
#[test]
fn a_host_hears_the_categories_that_it_switches_on() {
    let (all, warnings): (&[_], &[_]) = (&[], &[c"logStatusWarning".as_ptr()]);
    for (switched, expected) in [
        (vec![], vec![]),
        (vec![(1, all)], vec!["logStatusWarning", "logEvents"]),
        (vec![(1, all), (0, warnings)], vec!["logEvents"]),
        (vec![(1, warnings)], vec!["logStatusWarning"]),
        (vec![(1, all), (0, all)], vec![]),
    ] {
        let host = Host::new(Some(Stepping::default()));
        unsafe {
            for (on, names) in switched {
                assert_eq!(fmi3SetDebugLogging(host.c, on, names.len(), names.as_ptr()), OK);
            }
            let starts = [reference("theta_0"), reference("r")];
            assert_eq!(fmi3SetFloat64(host.c, starts.as_ptr(), 2, [0.01, 0.5].as_ptr(), 2), OK);
            assert_eq!(
                (fmi3EnterInitializationMode(host.c, 0, 0.0, 0.0, 0, 0.0), fmi3ExitInitializationMode(host.c)),
                (OK, OK)
            );
            assert_eq!(fmi3DoStep(host.c, 0.0, 0.5, 0, &mut 0, &mut 0, &mut 0, &mut 0.0), OK);
            assert_eq!(fmi3EnterStepMode(host.c), ERROR);
        }
        let mut log = host.log.take();
        assert!(log.pop().is_some_and(|text| text.starts_with("fmi3EnterStepMode: not allowed")));
        log.dedup();
        assert_eq!(log, expected);
    }
}

/// An instance is of one version: the other's functions find no component in it.
#[test]
fn the_other_versions_functions_refuse_an_instance() {
    let host = Host::started(None, 2.0);
    let before = host.bytes();
    unsafe {
        assert_eq!(FlexibleRocking::fmi2::fmi2Reset(host.c), ERROR);
        FlexibleRocking::fmi2::fmi2FreeInstance(host.c);
    }
    assert_eq!(host.bytes(), before);
}

/// A host that is called back: it sets inputs before a step is computed, and reads afterwards.
struct Called {
    c: *mut c_void,
    /// The input at the end of the next step.
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
        let (mut value, mut rate) = (0.0, 0.0);
        assert_eq!(fmi3SetDebugLogging(c, 0, 0, null()), OK);
        fmi3FreeInstance(c);
        assert_eq!((fmi3Terminate(c), fmi3Reset(c), fmi3GetFMUState(c, &mut null_mut())), (ERROR, ERROR, ERROR));
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
    let token = CString::new(FlexibleRocking::guid(&crate::host::contents(Parameters::EVISON))).unwrap();
    let folder = CString::new(resources.path().to_str().unwrap()).unwrap();
    let mut called = Called { c: null_mut(), end: 2.0, read: Vec::new() };
    let [name, token, folder] = [c"wall".as_ptr(), token.as_ptr(), folder.as_ptr()];
    let (a_g, theta, environment) = (reference("a_g"), reference("theta"), &raw mut called);
    let with = |required: &[c_uint], environment: *mut Called| unsafe {
        let (required, count, environment) = (required.as_ptr(), required.len(), environment.cast());
        let instantiate = fmi3InstantiateCoSimulation;
        instantiate(name, token, folder, 0, 0, 0, 0, required, count, environment, None, Some(update))
    };
    assert!(with(&[a_g, c_uint::MAX], environment).is_null() && with(&[0], environment).is_null());
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
            // a step that is refused asks for nothing
            (*environment).end = 1e4;
            assert_eq!(fmi3SetFloat64(c, &a_g, 1, &3.0, 1), OK);
            assert_eq!(fmi3DoStep(c, 0.5, 0.25, 0, event, terminate, early, null_mut()), ERROR);
            assert_eq!((fmi3GetFloat64(c, &a_g, 1, &mut value, 1), value), (OK, 3.0));
            // the host reads last at the instant of overturning
            (*environment).end = 0.0;
            assert_eq!(fmi3DoStep(c, 0.5, 100.0, 0, event, terminate, early, &mut reached), OK);
            let ends: Vec<_> = std::mem::take(&mut (*environment).read).iter().map(|read| read[0]).collect();
            assert_eq!((*terminate, *early, ends), (1, 0, if reads { vec![reached] } else { vec![] }));
            fmi3FreeInstance(c);
        }
    }
}
