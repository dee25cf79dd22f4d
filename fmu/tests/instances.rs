//! Instances come and go: creation and its refusals, many at once, and callers that are wrong about pointers.
#![allow(unsafe_code)]

mod host;

use FlexibleRocking::fmi2::*;
use FlexibleRocking::{BUILD, guid};
use host::*;
use rocking::Parameters;
use std::ffi::{CStr, CString, c_char, c_void};
use std::hint::spin_loop;
use std::ptr::{null, null_mut, with_exposed_provenance_mut};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::thread;

/// The one message of a refused instantiation.
fn refusal(arguments: Instantiate) -> String {
    let Err(log) = Host::instantiate(arguments) else { panic!("instantiated") };
    assert_eq!((log.len(), log[0].status, log[0].category.as_str()), (1, ERROR, "logStatusError"), "{log:?}");
    log[0].text.clone()
}

#[test]
fn the_library_says_what_it_is() {
    let [platform, version] = [fmi2GetTypesPlatform(), fmi2GetVersion()].map(|text| unsafe { CStr::from_ptr(text) });
    assert_eq!((platform, version), (c"default", c"2.0"));
    let [evison, mcmanus] = [Parameters::EVISON, Parameters::MCMANUS].map(|parameters| guid(&parameters.into()));
    for guid in [BUILD, &evison, &mcmanus] {
        assert_eq!((guid.len(), &guid[..1], &guid[15..16], &guid[37..]), (38, "{", "5", "}"));
    }
    assert_eq!(evison, guid(&Parameters::EVISON.into()));
    assert!(evison != mcmanus && evison != BUILD && mcmanus != BUILD);
}

#[test]
fn an_instance_that_cannot_be_made_is_null_and_the_log_says_why() {
    for other in [BUILD.to_owned(), guid(&Parameters::MCMANUS.into())] {
        assert_eq!(
            refusal(Instantiate { guid: other.clone(), ..Instantiate::default() }),
            format!(
                "fmi2Instantiate: fmuGUID = \"{other}\" is not {}: modelDescription.xml, the library and \
                 resources/parameters.toml are not of one FMU; export it again, and unpack every FMU into a folder of \
                 its own",
                guid(&Parameters::EVISON.into())
            )
        );
    }
    assert_eq!(
        refusal(Instantiate { name: "", ..Instantiate::default() }),
        "fmi2Instantiate: instanceName must not be empty"
    );
    assert_eq!(
        refusal(Instantiate { fmu_type: 2, ..Instantiate::default() }),
        "fmi2Instantiate: fmuType = 2 is not one of 0 (fmi2ModelExchange), 1 (fmi2CoSimulation)"
    );
    assert_eq!(
        refusal(Instantiate { logging_on: 2, ..Instantiate::default() }),
        "fmi2Instantiate: loggingOn = 2 is not one of 0 (fmi2False), 1 (fmi2True)"
    );
    let location = Some("file:///nowhere/100%25".to_owned());
    assert_eq!(
        refusal(Instantiate { location, ..Instantiate::default() }),
        "fmi2Instantiate: /nowhere/100%%/parameters.toml: No such file or directory (os error 2); unpack the whole \
         archive and pass its folder \"resources\""
    );
    let location = Some("/nowhere".to_owned());
    assert_eq!(
        refusal(Instantiate { location, ..Instantiate::default() }),
        "fmi2Instantiate: fmuResourceLocation = \"/nowhere\" is not a file URI of this machine, such as \
         file:///tmp/fmu/resources"
    );
}

#[test]
fn null_and_misaligned_pointers_are_errors() {
    let no_text: *const c_char = null();
    let guid = CString::new(guid(&Parameters::EVISON.into())).unwrap();
    let log = std::cell::RefCell::new(Vec::<Message>::new());
    let functions = callbacks((&raw const log).cast_mut().cast());
    unsafe {
        assert!(fmi2Instantiate(c"a".as_ptr(), 1, guid.as_ptr(), c"".as_ptr(), null(), 0, 0).is_null());
        assert!(fmi2Instantiate(no_text, 1, guid.as_ptr(), c"".as_ptr(), &functions, 0, 0).is_null());
        assert!(fmi2Instantiate(c"\xff".as_ptr(), 1, guid.as_ptr(), c"".as_ptr(), &functions, 0, 0).is_null());
    }
    let texts: Vec<_> = log.take().into_iter().map(|message| message.text).collect();
    assert_eq!(
        texts,
        [
            "fmi2Instantiate: instanceName must be a valid pointer; it is null or misaligned",
            "fmi2Instantiate: instanceName is not UTF-8 text of at most 65536 bytes",
        ]
    );

    let host = Host::started(&[]);
    let c = host.component;
    let bad = "must be a valid pointer; it is null or misaligned";
    let mut value = [0.0, 0.0];
    let misaligned = value.as_mut_ptr().wrapping_byte_add(1);
    unsafe {
        host.assert_refused(|| fmi2GetReal(c, &1, 1, misaligned), ERROR, &format!("fmi2GetReal: value {bad}"));
        let message = format!("fmi2SetDebugLogging: category {bad}");
        host.assert_refused(|| fmi2SetDebugLogging(c, 1, 1, &null()), ERROR, &message);
        host.assert_refused(
            || fmi2GetReal(c, &1, usize::MAX, &mut value[0]),
            ERROR,
            "fmi2GetReal: 18446744073709551615 values are too many for one call: at most 16777216",
        );
        host.assert_refused(
            || fmi2SetDebugLogging(c, -1, 0, null()),
            ERROR,
            "fmi2SetDebugLogging: loggingOn = -1 is not one of 0 (fmi2False), 1 (fmi2True)",
        );
        host.assert_refused(
            || fmi2GetStatus(c, 4, null_mut()),
            ERROR,
            "fmi2GetStatus: fmi2StatusKind = 4 is not one of 0 (fmi2DoStepStatus), 1 (fmi2PendingStatus), 2 \
             (fmi2LastSuccessfulTime), 3 (fmi2Terminated)",
        );
        assert_eq!(fmi2GetStringStatus(c, 1, &mut null()), DISCARD);
    }
    assert_eq!(
        host.log.take()[0].text,
        "fmi2GetStringStatus: fmi2PendingStatus has no answer here: fmi2DoStep never returns fmi2Pending, \
         fmi2GetRealStatus knows fmi2LastSuccessfulTime, fmi2GetBooleanStatus knows fmi2Terminated"
    );
}

#[test]
fn what_is_no_component_is_an_error_and_freeing_it_does_nothing() {
    let memory = [0_u64; 64];
    let other = (&raw const memory).cast_mut().cast::<c_void>();
    for c in [null_mut(), other, other.wrapping_byte_add(4)] {
        unsafe {
            assert_eq!(fmi2DoStep(c, 0.0, 1.0, 0), ERROR);
            assert_eq!(fmi2GetReal(c, &1, 1, &mut 0.0), ERROR);
            fmi2FreeInstance(c);
        }
    }
}

/// Of two threads that call one instance at the same time, one is served and the other refused: never both.
#[test]
fn a_call_while_another_thread_calls_is_refused() {
    const CALLS: usize = 200_000;
    #[derive(Default)]
    struct Inside {
        now: AtomicUsize,
        most: AtomicUsize,
        calls: AtomicUsize,
    }
    unsafe extern "C" fn look(inside: *mut c_void, _: *const c_char, _: i32, _: *const c_char, _: *const c_char) {
        let inside = unsafe { &*inside.cast::<Inside>() };
        inside.most.fetch_max(inside.now.fetch_add(1, Relaxed) + 1, Relaxed);
        inside.calls.fetch_add(1, Relaxed);
        (0..20).for_each(|_| spin_loop());
        inside.now.fetch_sub(1, Relaxed);
    }
    let inside = Inside::default();
    let logger: unsafe extern "C" fn(_, _, _, _, _) = look;
    let functions = CallbackFunctions {
        logger: Some(unsafe { std::mem::transmute::<*const (), CallbackLogger>(logger as *const ()) }),
        ..callbacks((&raw const inside).cast_mut().cast())
    };
    let folder = resources();
    let location = CString::new(format!("file://{}", folder.path().display())).unwrap();
    let guid = CString::new(guid(&Parameters::EVISON.into())).unwrap();
    let c = unsafe { fmi2Instantiate(c"talkative".as_ptr(), 1, guid.as_ptr(), location.as_ptr(), &functions, 0, 0) };
    let c = c.expose_provenance();
    // each is refused, with a message if it is served
    let call = || (0..CALLS).for_each(|_| assert_eq!(unsafe { fmi2CancelStep(with_exposed_provenance_mut(c)) }, ERROR));
    thread::scope(|scope| [(); 2].map(|()| scope.spawn(call)).map(|thread| thread.join().unwrap()));
    assert_eq!(inside.most.into_inner(), 1);
    let served = inside.calls.into_inner();
    assert!((1..2 * CALLS).contains(&served), "{served} calls were served");
    unsafe { fmi2FreeInstance(with_exposed_provenance_mut(c)) };
}

/// Sixty steps of 20 ms of an instance that is a little different from all others, one after the other by `turn`.
fn run(hosts: &[Host]) -> Vec<Vec<u8>> {
    for step in 0..60 {
        for host in hosts {
            let t = 0.02 * f64::from(step);
            assert_eq!(host.set(&[("a_g", 8.0 * (5.0 * t).sin())]), OK);
            assert_eq!(host.step(t, 0.02), OK);
        }
    }
    hosts.iter().map(Host::bytes).collect()
}

fn hosts(numbers: impl IntoIterator<Item = u32>) -> Vec<Host> {
    numbers.into_iter().map(|number| Host::started(&[("m", 100.0 + f64::from(number))])).collect()
}

#[test]
fn instances_do_not_feel_each_other() {
    let alone: Vec<_> = (0..8).flat_map(|number| run(&hosts([number]))).collect();
    assert_eq!(run(&hosts(0..8)), alone, "interleaved");
    let threads: Vec<_> = (0..8).map(|number| thread::spawn(move || run(&hosts([number])))).collect();
    let threaded: Vec<_> = threads.into_iter().flat_map(|thread| thread.join().unwrap()).collect();
    assert_eq!(threaded, alone, "on eight threads");
    assert_ne!(alone[0], alone[1]);
}
