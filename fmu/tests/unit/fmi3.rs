//! FMI 3.0 where it is not FMI 2.0: events, calls back within a step.

use crate::host::*;
use FlexibleRocking::fmi3;
use fmi_unit::interface::Stepping;
use libc::{c_uint, c_void};
use std::cell::{Cell, RefCell};
use std::ptr::{null, null_mut};

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
    host: Host,
    /// The input at the end of the next step.
    end: Cell<f64>,
    /// When it read theta and its rate, and what these were.
    read: RefCell<Vec<[f64; 3]>>,
}

thread_local! {
    static CALLED: Cell<*const Called> = const { Cell::new(null()) };
}

unsafe extern "C" fn update(_: *mut c_void, time: f64, set: u8, get: u8, done: u8, _: u8, _: *mut u8, _: *mut f64) {
    let Called { host, end, read } = unsafe { &*CALLED.get() };
    unsafe { fmi3::FreeInstance(host.component) };
    assert_eq!(host.set_debug_logging(false, &[]), OK);
    assert_eq!((host.terminate(), host.reset(), host.try_keep(null_mut())), (ERROR, ERROR, Err(ERROR)));
    let got = (host.try_get(&["theta"]), host.rate("theta", 1));
    assert_eq!((host.set(&[("m", end.get())]), host.set(&[("a_g", f64::NAN)])), (ERROR, ERROR));
    let was_set = host.set(&[("a_g", end.get())]);
    match (set, get, done) {
        (1, 0, 0) => assert_eq!((was_set, got), (OK, (Err(ERROR), Err(ERROR)))),
        (0, 1, 1) => {
            assert_eq!(was_set, ERROR);
            read.borrow_mut().push([time, got.0.unwrap()[0], got.1.unwrap()]);
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_host_that_is_called_back_sets_inputs_reads_and_does_no_harm() {
    let with = |required: &[c_uint]| {
        let (required, update) = (required.into(), Some(update as fmi3::IntermediateUpdateCallback));
        Host::instantiate(Instantiate { is_fmi_3: true, required, update, ..Instantiate::default() })
    };
    let [a_g, theta] = ["a_g", "theta"].map(|name| reference(name) + 1);
    assert!(with(&[a_g, c_uint::MAX]).is_err() && with(&[0]).is_err());
    for (required, sets, reads) in [(&[a_g][..], true, false), (&[theta], false, true), (&[a_g, theta], true, true)] {
        let called = Called { host: with(required).unwrap(), end: Cell::default(), read: RefCell::default() };
        let Called { host, end, read } = &called;
        CALLED.set(&raw const called);
        assert_eq!(host.set(&[("theta_0", 0.3)]), OK);
        host.begin(None, 0.0, None);
        for (time, a_g) in [(0.0, 2.0), (0.25, -1.0)] {
            end.set(a_g);
            assert_eq!((host.step(time, 0.25), host.get("a_g")), (OK, if sets { a_g } else { 0.0 }));
            let shown = [time + 0.25, host.get("theta"), host.rate("theta", 1).unwrap()];
            assert_eq!(read.take(), if reads { vec![shown] } else { vec![] });
        }
        // a step that is refused asks for nothing
        end.set(1e4);
        assert_eq!(host.set(&[("a_g", 3.0)]), OK);
        let refused = unsafe { fmi3::DoStep(host.component, 0.5, 0.25, 0, &mut 0, &mut 0, &mut 0, null_mut()) };
        assert_eq!((refused, host.get("a_g")), (ERROR, 3.0));
        // the host reads last at the instant of overturning
        end.set(0.0);
        let (status, [_, terminate, early], reached) = host.step_to(0.5, 100.0);
        let ends: Vec<_> = read.take().iter().map(|read| read[0]).collect();
        assert_eq!((status, terminate, early, ends), (OK, 1, 0, if reads { vec![reached] } else { vec![] }));
    }
}
