//! Instances come and go: what they say of themselves, calls at the same time, many at once.

use crate::host::*;
use FlexibleRocking::fmi2;
use FlexibleRocking::{BUILD, guid};
use rocking::Parameters;
use std::ffi::{CStr, CString, c_void};
use std::hint::spin_loop;
use std::ptr::with_exposed_provenance_mut;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::thread;

#[test]
fn the_library_says_what_it_is() {
    let [platform, version] =
        unsafe { [fmi2::GetTypesPlatform(), fmi2::GetVersion()].map(|text| CStr::from_ptr(text)) };
    assert_eq!((platform, version), (c"default", c"2.0"));
    let [evison, mcmanus] = [Parameters::EVISON, Parameters::MCMANUS].map(|parameters| guid(&contents(parameters)));
    for guid in [BUILD, &evison, &mcmanus] {
        assert_eq!((guid.len(), &guid[..1], &guid[15..16], &guid[37..]), (38, "{", "5", "}"));
    }
    assert_eq!(evison, guid(&contents(Parameters::EVISON)));
    assert!(evison != mcmanus && evison != BUILD && mcmanus != BUILD);
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
    unsafe extern "C" fn look(inside: *mut c_void, _: Text, _: i32, _: Text, _: Text) {
        let inside = unsafe { &*inside.cast::<Inside>() };
        inside.most.fetch_max(inside.now.fetch_add(1, Relaxed) + 1, Relaxed);
        inside.calls.fetch_add(1, Relaxed);
        (0..20).for_each(|_| spin_loop());
        inside.now.fetch_sub(1, Relaxed);
    }
    let inside = Inside::default();
    let functions = callbacks((&raw const inside).cast_mut().cast(), look);
    let folder = resources();
    let location = CString::new(format!("file://{}", folder.path().display())).unwrap();
    let guid = CString::new(guid(&contents(Parameters::EVISON))).unwrap();
    let c = unsafe { fmi2::Instantiate(c"talkative".as_ptr(), 1, guid.as_ptr(), location.as_ptr(), &functions, 0, 0) };
    let c = c.expose_provenance();
    // each is refused, with a message if it is served
    let call =
        || (0..CALLS).for_each(|_| assert_eq!(unsafe { fmi2::CancelStep(with_exposed_provenance_mut(c)) }, ERROR));
    thread::scope(|scope| [(); 2].map(|()| scope.spawn(call)).map(|thread| thread.join().unwrap()));
    assert_eq!(inside.most.into_inner(), 1);
    let served = inside.calls.into_inner();
    assert!((1..2 * CALLS).contains(&served), "{served} calls were served");
    unsafe { fmi2::FreeInstance(with_exposed_provenance_mut(c)) };
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
