//! FMI 3.0 where it is not FMI 2.0: events, calls back within a step.

use crate::host::{self, ERROR, Host, OK, resources};
use FlexibleRocking::fmi3;
use fmi_unit::interface::Stepping;
use libc::{c_uint, c_void};
use rocking::Parameters;
use std::ffi::CString;
use std::ptr::{null, null_mut};

fn reference(name: &str) -> c_uint {
    host::reference(name) + 1
}

/// An acceleration that a host sets at an event lifts a rigid structure off there and then, unless it is to come one
/// step late.
#[test]
fn what_acts_at_an_event_is_what_lifts_off_there() {
    for (a_g_late, phase_after) in [(0, 3), (1, 1)] {
        let host = Host::new_of_3(Some(Stepping { event_mode: true, early_return: true }));
        assert_eq!((host.set_integer("detail", 5), host.set_boolean("a_g_late", a_g_late)), (OK, OK));
        host.begin(None, 0.0, None);
        assert_eq!((host.set(&[("a_g", -50.0)]), host.update()), (OK, Ok(Default::default())));
        assert_eq!(host.integer("phase"), phase_after, "a_g_late = {a_g_late}");
    }
}

/// A host that handles events but no early return gets whole steps, from the start time that it has set, whatever it read before.
#[test]
fn a_step_ends_early_for_hosts_that_take_it_alone() {
    let host = Host::new_of_3(Some(Stepping { event_mode: true, early_return: false }));
    assert_eq!((host.set(&[("theta_0", 0.02)]), host.get("theta")), (OK, 0.02));
    host.begin(None, 5.0, None);
    assert_eq!(unsafe { fmi3::EnterStepMode(host.component) }, OK);
    assert_eq!(host.step_to(5.0, 1.0), (OK, [0; 3], 6.0));
}

/// A host can go to a state that an instance of its own kind has kept, and to no other.
#[test]
fn a_state_is_taken_by_an_instance_of_its_kind_alone() {
    let kinds = [None, Some(Stepping::default()), Some(Stepping { event_mode: true, early_return: true })];
    for (of, by) in [(0, 1), (1, 2), (2, 0)] {
        let [of, by] = [of, by].map(|kind| Host::new_of_3(kinds[kind]));
        let state = by.deserialize(&of.bytes()).unwrap();
        let message = "fmi3SetFMUState: the FMU state was kept by an instance for the other interface, or with another \
                       eventModeUsed or earlyReturnAllowed";
        by.assert_refused(|| by.go_back(state), ERROR, message);
    }
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
        assert_eq!(fmi3::SetDebugLogging(c, 0, 0, null()), OK);
        fmi3::FreeInstance(c);
        assert_eq!((fmi3::Terminate(c), fmi3::Reset(c), fmi3::GetFMUState(c, &mut null_mut())), (ERROR, ERROR, ERROR));
        let got = fmi3::GetFloat64(c, &theta, 1, &mut value, 1);
        let got = (got, fmi3::GetOutputDerivatives(c, &theta, 1, &1, &mut rate, 1));
        assert_eq!((fmi3::SetFloat64(c, &m, 1, end, 1), fmi3::SetFloat64(c, &a_g, 1, &f64::NAN, 1)), (ERROR, ERROR));
        let was_set = fmi3::SetFloat64(c, &a_g, 1, end, 1);
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
    let token = CString::new(FlexibleRocking::guid(&host::contents(Parameters::EVISON))).unwrap();
    let folder = CString::new(resources.path().to_str().unwrap()).unwrap();
    let mut called = Called { c: null_mut(), end: 2.0, read: Vec::new() };
    let [name, token, folder] = [c"wall".as_ptr(), token.as_ptr(), folder.as_ptr()];
    let (a_g, theta, environment) = (reference("a_g"), reference("theta"), &raw mut called);
    let with = |required: &[c_uint], environment: *mut Called| unsafe {
        let (required, count, environment) = (required.as_ptr(), required.len(), environment.cast());
        let instantiate = fmi3::InstantiateCoSimulation;
        instantiate(name, token, folder, 0, 0, 0, 0, required, count, environment, None, Some(update))
    };
    assert!(with(&[a_g, c_uint::MAX], environment).is_null() && with(&[0], environment).is_null());
    for (required, sets, reads) in [(&[a_g][..], true, false), (&[theta], false, true), (&[a_g, theta], true, true)] {
        let c = with(required, environment);
        unsafe {
            (*environment).c = c;
            assert_eq!(fmi3::SetFloat64(c, &reference("theta_0"), 1, &0.3, 1), OK);
            assert_eq!(
                (fmi3::EnterInitializationMode(c, 0, 0.0, 0.0, 0, 0.0), fmi3::ExitInitializationMode(c)),
                (OK, OK)
            );
            let (mut flags, mut reached, mut value, mut rate) = ([0u8; 3], 0.0, 0.0, 0.0);
            let [event, terminate, early] = &mut flags;
            for (time, end) in [(0.0, 2.0), (0.25, -1.0)] {
                (*environment).end = end;
                assert_eq!(fmi3::DoStep(c, time, 0.25, 0, event, terminate, early, &mut reached), OK);
                assert_eq!((fmi3::GetFloat64(c, &a_g, 1, &mut value, 1), value), (OK, if sets { end } else { 0.0 }));
                assert_eq!(fmi3::GetFloat64(c, &theta, 1, &mut value, 1), OK);
                assert_eq!(fmi3::GetOutputDerivatives(c, &theta, 1, &1, &mut rate, 1), OK);
                let read = std::mem::take(&mut (*environment).read);
                assert_eq!(read, if reads { vec![[time + 0.25, value, rate]] } else { vec![] });
            }
            // a step that is refused asks for nothing
            (*environment).end = 1e4;
            assert_eq!(fmi3::SetFloat64(c, &a_g, 1, &3.0, 1), OK);
            assert_eq!(fmi3::DoStep(c, 0.5, 0.25, 0, event, terminate, early, null_mut()), ERROR);
            assert_eq!((fmi3::GetFloat64(c, &a_g, 1, &mut value, 1), value), (OK, 3.0));
            // the host reads last at the instant of overturning
            (*environment).end = 0.0;
            assert_eq!(fmi3::DoStep(c, 0.5, 100.0, 0, event, terminate, early, &mut reached), OK);
            let ends: Vec<_> = std::mem::take(&mut (*environment).read).iter().map(|read| read[0]).collect();
            assert_eq!((*terminate, *early, ends), (1, 0, if reads { vec![reached] } else { vec![] }));
            fmi3::FreeInstance(c);
        }
    }
}
