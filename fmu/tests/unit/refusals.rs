//! Refused calls: each says why and changes nothing.

use crate::host::*;
use FlexibleRocking::fmi2::{self, CallbackFunctions};
use FlexibleRocking::{BUILD, fmi3, guid};
use fmi_unit::interface::Stepping;
use libc::{c_int, c_void};
use rocking::Parameters;
use std::ptr::{null, null_mut, without_provenance_mut};

/// The message in the log, in the words of FMI 2.0, and the call.
type Refused = (&'static str, fn(&Host) -> c_int);

const INSTANTIATED: &[Refused] = &[
    ("tolerance = 1 is out of range: it must be between 0 and 1, such as 1e-9", |h| {
        initialize(h, Some(1.0), 0.0, None)
    }),
    ("tolerance = NaN is out of range", |h| initialize(h, Some(f64::NAN), 0.0, None)),
    ("startTime = NaN is out of range: it must be finite", |h| initialize(h, None, f64::NAN, None)),
    ("stopTime = 1.9 is out of range: it must be finite and not before startTime = 2 s", |h| {
        initialize(h, None, 2.0, Some(1.9))
    }),
    ("loggingOn = 2 is not one of 0 (fmi2False), 1 (fmi2True)", |h| call!(h, SetDebugLogging(2, 0, null()))),
    ("category must be a valid pointer", |h| call!(h, SetDebugLogging(1, 1, &null()))),
];

/// None of the values of a call is taken over; the first that is wrong is told.
const INITIALIZING: &[Refused] = &[
    ("r = 0 is out of range: it must lie between 0.001 and 1 (", |h| h.set(&[("H", 2.0), ("a_g", 1.0), ("r", 0.0)])),
    ("a_g = 20000 m/s2 is out of range: it must lie between", |h| h.set(&[("a_g", 2e4)])),
    ("theta cannot be set: it is an output, computed by the FMU", |h| h.set(&[("u_0", 1e-3), ("theta", 0.1)])),
    ("chi cannot be set: it is a calculated parameter, computed by the FMU", |h| h.set(&[("chi", f64::NAN)])),
    ("phase cannot be set: it is a local variable, computed by the FMU", |h| h.set_integer("phase", 1)),
    ("detail = 0 is out of range: 1 = auto", |h| h.set_integer("detail", 0)),
    ("peaks = 2 is not one of 0 (fmi2False), 1 (fmi2True)", |h| h.set_boolean("peaks", 2)),
    ("record is a string: call fmi2GetString or fmi2SetString instead", |h| h.set(&[("record", 1.0)])),
    ("phase is an enumeration: call fmi2GetInteger or fmi2SetInteger instead", |h| get(h, &["phase"])),
    ("overturned is a Boolean: call fmi2GetBoolean or fmi2SetBoolean instead", |h| get(h, &["theta", "overturned"])),
    (
        "theta cannot be a known of a directional derivative: only the inputs can, before the simulation starts real",
        |h| derive_by(h, "a_t", "theta"),
    ),
    ("m is a real number: call fmi2GetReal or fmi2SetReal instead", |h| h.set_integer("m", 1)),
    ("transitions is an integer: call fmi2GetInteger instead", |h| h.try_boolean("transitions").unwrap_err()),
    ("value reference 4000000000 does not exist; they run from 0 to ", |h| {
        h.set_by_reference(&[4_000_000_000, h.at("phase")], &[1.0; 2])
    }),
    ("value must be a valid pointer; it is null or misaligned", |h| {
        let at = h.at("record");
        call!(h, SetString(&at, 1, &null()), SetString(&at, 1, &null(), 1))
    }),
    ("value must be a valid pointer; it is null or misaligned", |h| {
        let bad = without_provenance_mut(9);
        call!(h, GetReal(&1, 1, bad), GetFloat64(&1, 1, bad, 1))
    }),
    ("18446744073709551615 values are too many for one call: at most 16777216", |h| {
        call!(h, GetReal(&1, usize::MAX, &mut 0.0), GetFloat64(&1, usize::MAX, &mut 0.0, usize::MAX))
    }),
];

/// From 10 s to 12 s, at 10.5 s.
const STEPPING: &[Refused] = &[
    ("m is fixed once the simulation has started: set it before fmi2ExitInitializationMode, or call fmi2Reset", |h| {
        h.set(&[("a_g", 1.0), ("m", 0.5)])
    }),
    ("record is fixed once the simulation has started", |h| h.set_record("b.csv")),
    ("peaks is fixed once the simulation has started", |h| h.set_boolean("peaks", 1)),
    ("detail is fixed once the simulation has started", |h| h.set_integer("detail", 2)),
    ("order = 2 for theta is out of range: only derivatives of order 1 exist", |h| h.rate("theta", 2).unwrap_err()),
    ("phase has no derivative: only continuous real outputs have", |h| h.rate("phase", 1).unwrap_err()),
    ("phase has no derivative: only continuous real outputs have", |h| derive(h, "phase", 1.0)),
    ("F_t has no derivative: only continuous real outputs have", |h| derive(h, "F_t", 1.0)),
    ("m cannot be a known of a directional derivative: only the inputs can, before", |h| derive_by(h, "a_t", "m")),
    (
        "delta_t cannot be a known of a directional derivative: only the inputs can, before the simulation starts real parameters \
      and, once it has started, u, u_dot, theta, theta_dot and time",
        |h| derive_by(h, "a_t", "delta_t"),
    ),
    ("theta_max has no derivative: only continuous real outputs have", |h| derive(h, "theta_max", 1.0)),
    ("the derivative of a_g, NaN, is out of range: it must be finite", |h| derive(h, "a_t", f64::NAN)),
    ("a_g has no derivative: only continuous real outputs have", |h| h.rate("a_g", 1).unwrap_err()),
    ("chi has no derivative: only continuous real outputs have", |h| h.rate("chi", 1).unwrap_err()),
    ("I_v has no derivative: only continuous real outputs have", |h| h.rate("I_v", 1).unwrap_err()),
    (
        "currentCommunicationPoint = 10 s differs from the time of the FMU, t = 10.5 s: step from there, or go back with \
         fmi2SetFMUstate",
        |h| h.step(10.0, 0.5),
    ),
    ("currentCommunicationPoint = 10.501 s differs from the time of the FMU", |h| h.step(10.501, 0.5)),
    ("currentCommunicationPoint = NaN s differs from the time of the FMU", |h| h.step(f64::NAN, 0.5)),
    (
        "communicationStepSize = 0 s is out of range: it must be positive, finite, large enough to move t = 10.5 s, and end",
        |h| h.step(10.5, 0.0),
    ),
    ("communicationStepSize = -0.1 s is out of range", |h| h.step(10.5, -0.1)),
    ("communicationStepSize = NaN s is out of range", |h| h.step(10.5, f64::NAN)),
    ("communicationStepSize = inf s is out of range", |h| h.step(10.5, f64::INFINITY)),
    ("communicationStepSize = 1e-16 s is out of range", |h| h.step(10.5, 1e-16)),
    ("the step would end at t = 12.1 s, past stopTime = 12 s given to fmi2SetupExperiment: shorten it", |h| {
        h.step(10.5, 1.6)
    }),
];

/// Under a = 1 m/s² that grows by 1e5 m/s³.
const OF_FMI_2: &[Refused] = &[
    ("order = 2 for a_g is out of range: only derivatives of order 1 exist", |h| h.set_slope("a_g", 2, 1.0)),
    ("order = 0 for a_g is out of range: only derivatives of order 1 exist", |h| h.set_slope("a_g", 0, 1.0)),
    ("the derivative of a_g, NaN, is out of range: it must be finite", |h| h.set_slope("a_g", 1, f64::NAN)),
    ("theta has no derivative that can be set: only the inputs have", |h| h.set_slope("theta", 1, 1.0)),
    ("at the end of the step, a_g = 20001 m/s2 is out of range: it must lie between -10000 and 10000 m/s2 (", |h| {
        h.step(10.5, 0.2)
    }),
    ("fmi2StatusKind = 4 is not one of 0 (fmi2DoStepStatus), 1 (fmi2PendingStatus), 2 (fmi2Last", |h| unsafe {
        fmi2::GetStatus(h.component, 4, null_mut())
    }),
];

const OF_FMI_3: &[Refused] = &[
    ("fmi3GetFloat64: nValues = 2 is not 1", |h| unsafe { fmi3::GetFloat64(h.component, &2, 1, &mut 0.0, 2) }),
    ("fmi3GetDirectionalDerivative: nSeed = 2 is not 1", |h| unsafe {
        fmi3::GetDirectionalDerivative(h.component, &2, 1, &0, 1, &1.0, 2, &mut 0.0, 1)
    }),
    ("fmi3GetUInt8: this FMU has no variables of this type", |h| unsafe { fmi3::GetUInt8(h.component, &0, 1) }),
    ("fmi3GetAdjointDerivative: not allowed in the state \"step complete\"; allowed in: none", |h| unsafe {
        fmi3::GetAdjointDerivative(h.component)
    }),
    ("fmi3EnterEventMode: there is no event mode: the instance was made with eventModeUsed = false", |h| {
        h.enter_event_mode()
    }),
];

/// The message of FMI 3.0 that says the same as one of FMI 2.0.
fn of_fmi_3(message: &str) -> String {
    let words = [
        ("value must", "values must"),
        ("from 0 to", "from 1 to"),
        ("GetInteger instead", "GetInt32 instead"),
        ("Integer", "Int64"),
        ("Real", "Float64"),
        ("FMUstate", "FMUState"),
        ("SetupExperiment", "EnterInitializationMode"),
        ("fmi2", "fmi3"),
    ];
    words.iter().fold(message.to_owned(), |message, (of_2, of_3)| message.replace(of_2, of_3))
}

/// The status of the call that passes tolerance and times.
fn initialize(host: &Host, tolerance: Option<f64>, start: f64, stop: Option<f64>) -> c_int {
    let status = host.setup(tolerance, start, stop);
    if status == OK { host.enter() } else { status }
}

fn get(host: &Host, names: &[&str]) -> c_int {
    host.try_get(names).unwrap_err()
}

fn derive_by(host: &Host, of: &str, known: &str) -> c_int {
    host.derive(&[of], &[(known, 1.0)]).unwrap_err()
}

/// The status of a derivative along a_g.
fn derive(host: &Host, of: &str, change: f64) -> c_int {
    host.derive(&[of], &[("a_g", change)]).unwrap_err()
}

#[test]
fn a_refused_call_says_why_and_changes_nothing() {
    for is_fmi_3 in [false, true] {
        let [new, initializing, stepping] =
            [(); 3].map(|()| Host::instantiate(Instantiate { is_fmi_3, ..Instantiate::default() }).unwrap());
        stepping.begin(None, 10.0, Some(12.0));
        assert_eq!((initializing.enter(), stepping.step(10.0, 0.5)), (OK, OK));
        for (host, calls) in [(new, INSTANTIATED), (initializing, INITIALIZING), (stepping, STEPPING)] {
            for (message, call) in calls {
                let message = if is_fmi_3 { of_fmi_3(message) } else { (*message).to_owned() };
                host.assert_refused(|| call(&host), ERROR, &message);
            }
        }
    }
    let [of_2, of_3] = [Host::new(), Host::new_of_3(Some(Stepping::default()))];
    of_2.begin(None, 10.5, None);
    of_3.begin(None, 0.0, None);
    assert_eq!((of_2.set(&[("a_g", 1.0)]), of_2.set_slope("a_g", 1, 1e5)), (OK, OK));
    for (host, calls) in [(&of_2, OF_FMI_2), (&of_3, OF_FMI_3)] {
        calls.iter().for_each(|(message, call)| host.assert_refused(|| call(host), ERROR, message));
    }
    assert_eq!(
        unsafe { (fmi3::GetUInt8(of_3.component, null(), 0), fmi3::SetBinary(of_3.component, null(), 0)) },
        (OK, OK)
    );
}

/// Hosts set all start values again, also after the start.
#[test]
fn a_fixed_parameter_may_be_set_to_the_value_that_it_has() {
    let host = Host::started(&[("theta_0", 0.02)]);
    assert_eq!(host.step(0.0, 0.1), OK);
    let before = host.bytes();
    assert_eq!(host.set(&[("m", host.get("m")), ("theta_0", 0.02)]), OK);
    let others = (host.set_record(""), host.set_boolean("peaks", 0), host.set_integer("detail", 1));
    assert_eq!(others, (OK, OK, OK));
    assert!(host.bytes() == before);
}

#[test]
fn a_status_that_is_never_there_is_discarded() {
    let host = Host::started(&[]);
    assert_eq!(unsafe { fmi2::GetStringStatus(host.component, 1, &mut null()) }, DISCARD);
    let text = "fmi2GetStringStatus: fmi2PendingStatus has no answer here: fmi2DoStep never returns fmi2Pending, \
                fmi2GetRealStatus knows fmi2LastSuccessfulTime, fmi2GetBooleanStatus knows fmi2Terminated";
    assert_eq!(host.log.take()[0].text, text);
}

#[test]
fn contradictions_are_refused_when_initialization_ends_and_can_be_put_right() {
    let host = Host::initializing(&[("theta_dot_0", 0.5)]);
    let message = "theta_dot_0 = 0.5 rad/s contradicts theta_0 = 0 (full contact, where theta and theta_dot are both 0): \
                   set theta_dot_0 to 0, or theta_0 to an angle with the sign of the pivot that the structure rocks about";
    host.assert_refused(|| host.exit(), ERROR, message);
    host.assert_refused(|| get(&host, &["m", "theta"]), ERROR, message);
    assert_eq!(host.get("theta_dot_0"), 0.5);
    assert_eq!(host.set(&[("theta_0", 0.02), ("H", 1000.0), ("B", 0.5)]), OK);
    let message = "H/B = 2000 is out of range: H must not exceed 1000 B; lower H or raise B";
    host.assert_refused(|| host.exit(), ERROR, message);
    assert_eq!((host.set(&[("B", 500.0)]), host.exit()), (OK, OK));
    assert_eq!(host.try_get(&["theta", "theta_dot", "H"]).unwrap(), [0.02, 0.5, 1000.0]);
}

/// The arguments of a host that makes an instance, and the one message that it gets instead.
#[test]
fn an_instance_that_cannot_be_made_is_null_and_the_log_says_why() {
    let with = Instantiate::default;
    let [own, other] = [Parameters::EVISON, Parameters::MCMANUS].map(|parameters| guid(&contents(parameters)));
    let location = |text: &str| Some(text.to_owned());
    let wrong = |guid: &str| format!("fmuGUID = \"{guid}\" is not {own}: modelDescription.xml, the library ");
    for (arguments, message) in [
        (Instantiate { guid: Some(BUILD.to_owned()), ..with() }, wrong(BUILD).as_str()),
        (Instantiate { guid: Some(other.clone()), ..with() }, &wrong(&other)),
        (Instantiate { name: "", ..with() }, "instanceName must not be empty"),
        (
            Instantiate { fmu_type: 2, ..with() },
            "fmuType = 2 is not one of 0 (fmi2ModelExchange), 1 (fmi2CoSimulation)",
        ),
        (Instantiate { logging_on: 2, ..with() }, "loggingOn = 2 is not one of 0 (fmi2False), 1 (fmi2True)"),
        (
            Instantiate { location: location("file:///nowhere/100%25"), ..with() },
            "/nowhere/100%%/parameters.toml: No such file or directory (os error 2); unpack the whole archive and pass ",
        ),
        (
            Instantiate { location: location("/nowhere"), ..with() },
            "fmuResourceLocation = \"/nowhere\" is not a file URI of this machine, such as file:///tmp/fmu/resources",
        ),
    ] {
        let Err(log) = Host::instantiate(arguments) else { panic!("instantiated") };
        assert_eq!((log.len(), log[0].status, log[0].category.as_str()), (1, ERROR, "logStatusError"), "{log:?}");
        assert!(log[0].text.starts_with(&format!("fmi2Instantiate: {message}")), "{}", log[0].text);
    }
}

/// Null, other memory, a misaligned pointer, and an instance of the other version.
#[test]
fn what_is_no_component_is_an_error_and_freeing_it_does_nothing() {
    let (memory, of_2, of_3) = ([0_u64; 64], Host::new(), Host::new_of_3(None));
    let other = (&raw const memory).cast_mut().cast::<c_void>();
    let before = [of_2.bytes(), of_3.bytes()];
    for c in [null_mut(), other, other.wrapping_byte_add(4), of_3.component] {
        unsafe {
            assert_eq!((fmi2::DoStep(c, 0.0, 1.0, 0), fmi2::GetReal(c, &1, 1, &mut 0.0)), (ERROR, ERROR));
            fmi2::FreeInstance(c);
        }
    }
    unsafe {
        assert_eq!(fmi3::Reset(of_2.component), ERROR);
        fmi3::FreeInstance(of_2.component);
    }
    assert_eq!([of_2.bytes(), of_3.bytes()], before);
    let functions: *const CallbackFunctions = null();
    assert!(unsafe { fmi2::Instantiate(c"a".as_ptr(), 1, null(), null(), functions, 0, 0) }.is_null());
}
