//! The memory that an instance takes and leaves, and two threads that call one instance. Hosts in tests/*.py ask for the rest.
#![allow(unsafe_code)] // the C interface

mod wall;

use FlexibleRocking::fmi2::{self, CallbackFunctions, CallbackLogger};
use libc::{c_char, c_int, c_void};
use std::ffi::CString;
use std::fs;
use std::hint::spin_loop;
use std::path::{Path, PathBuf};
use std::ptr::{null, null_mut, with_exposed_provenance_mut};
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};
use std::thread;
use tempfile::TempDir;
use wall::{contents, reference, resources};

const OK: c_int = 0;
const ERROR: c_int = 3;

/// An instance for co-simulation that logs into `environment` by a `logger`.
fn instantiate(environment: *mut c_void, logger: Option<CallbackLogger>) -> *mut c_void {
    let (allocate_memory, free_memory, step_finished) = (null(), null(), null());
    let functions =
        CallbackFunctions { logger, allocate_memory, free_memory, step_finished, component_environment: environment };
    let folder = resources();
    let location = CString::new(format!("file://{}", folder.path().display())).unwrap();
    let guid = CString::new(FlexibleRocking::guid(&contents())).unwrap();
    unsafe { fmi2::Instantiate(c"wall".as_ptr(), 1, guid.as_ptr(), location.as_ptr(), &functions, 0, 0) }
}

/// An instance that logs nothing.
struct Host(*mut c_void);

impl Host {
    fn new() -> Host {
        Host(instantiate(null_mut(), None))
    }

    /// Enters initialization mode, with the record in the file at `path`, and with peaks and limits watched.
    fn enter(&self, path: &Path) {
        let [record, switches @ ..] = ["record", "peaks", "validity"].map(reference);
        let path = CString::new(path.to_str().unwrap()).unwrap();
        unsafe {
            assert_eq!(fmi2::SetString(self.0, &record, 1, &path.as_ptr()), OK);
            assert_eq!(fmi2::SetBoolean(self.0, switches.as_ptr(), 2, [1, 1].as_ptr()), OK);
            assert_eq!(fmi2::SetupExperiment(self.0, 0, 0.0, 0.0, 0, 0.0), OK);
            assert_eq!(fmi2::EnterInitializationMode(self.0), OK);
        }
    }

    fn exit(&self) {
        assert_eq!(unsafe { fmi2::ExitInitializationMode(self.0) }, OK);
    }

    fn step(&self, time: f64, step: f64) {
        assert_eq!(unsafe { fmi2::DoStep(self.0, time, step, 0) }, OK);
    }

    /// Keeps the present state: into `state`, or a new one for null.
    fn keep(&self, mut state: *mut c_void) -> *mut c_void {
        assert_eq!(unsafe { fmi2::GetFMUstate(self.0, &mut state) }, OK);
        state
    }

    fn go_back(&self, state: *mut c_void) {
        assert_eq!(unsafe { fmi2::SetFMUstate(self.0, state) }, OK);
    }
}

impl Drop for Host {
    fn drop(&mut self) {
        unsafe { fmi2::FreeInstance(self.0) }
    }
}

/// A host, and a folder with the file of a record of so many samples.
fn host_and_record(samples: u32) -> (Host, TempDir, PathBuf) {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("quake.csv");
    fs::write(&path, quake(samples)).unwrap();
    (Host::new(), folder, path)
}

/// A table of so many samples, every 20 ms.
fn quake(samples: u32) -> String {
    let line = |i| format!("{:.2},{:.4}\n", 0.02 * f64::from(i), 4.0 * (0.6 * f64::from(i)).cos());
    (0..samples).map(line).collect()
}

/// Neither a record, nor the states that were kept amid a run: hosts that unload the library after every run count on this.
#[test]
fn nothing_is_left_when_the_last_instance_goes() {
    let folder = tempfile::tempdir().unwrap();
    let run = |name: &str| {
        let path = folder.path().join(name);
        fs::write(&path, quake(2000)).unwrap();
        let [first, second] = [Host::new(), Host::new()];
        for host in [&first, &second] {
            host.enter(&path);
            host.exit();
            host.step(0.0, 1.0);
            host.go_back(host.keep(null_mut()));
        }
    };
    run("first.csv");
    let left = allocation_counter::measure(|| run("second.csv"));
    assert_eq!((left.bytes_current, left.count_current), (0, 0));
}

/// The engine is not built anew where only the motion differs.
#[test]
fn a_state_that_is_kept_again_takes_little_memory() {
    let (host, _folder, path) = host_and_record(600);
    host.enter(&path);
    host.exit();
    host.step(0.0, 1.0);
    let state = host.keep(null_mut());
    host.step(1.0, 0.01);
    let kept = allocation_counter::measure(|| assert_eq!(host.keep(state), state));
    let gone_back = allocation_counter::measure(|| host.go_back(state));
    // the numbers of the peaks are a list; going back reads this list, the inputs, the numbers of the structure, the state at the
    // start and the names of the records anew, and makes the two lists of the peaks of it
    assert_eq!((kept.count_total, gone_back.count_total), (1, 10));
}

/// A record is parsed once: another run only reads the bytes of the file and scales the samples.
#[test]
fn a_record_is_kept_for_another_run() {
    let (host, _folder, path) = host_and_record(20_000);
    let size = fs::metadata(&path).unwrap().len();
    let allocated = || {
        host.enter(&path);
        allocation_counter::measure(|| host.exit()).bytes_total
    };
    let parsed = allocated();
    assert_eq!(unsafe { fmi2::Reset(host.0) }, OK);
    let (again, samples) = (allocated(), 16 * 20_000);
    assert!(again < size + samples + size / 10 && 2 * again < parsed, "{again} bytes, at first {parsed}");
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
    type Text = *const c_char;
    // it has no further arguments to read, so that it may be declared without them
    unsafe extern "C" fn look(inside: *mut c_void, _: Text, _: c_int, _: Text, _: Text) {
        let inside = unsafe { &*inside.cast::<Inside>() };
        inside.most.fetch_max(inside.now.fetch_add(1, Relaxed) + 1, Relaxed);
        inside.calls.fetch_add(1, Relaxed);
        (0..20).for_each(|_| spin_loop());
        inside.now.fetch_sub(1, Relaxed);
    }
    let logger: unsafe extern "C" fn(_, _, _, _, _) = look;
    let logger = unsafe { std::mem::transmute::<*const (), CallbackLogger>(logger as *const ()) };
    let inside = Inside::default();
    let c = instantiate((&raw const inside).cast_mut().cast(), Some(logger)).expose_provenance();
    // each is refused, with a message if it is served
    let call =
        || (0..CALLS).for_each(|_| assert_eq!(unsafe { fmi2::CancelStep(with_exposed_provenance_mut(c)) }, ERROR));
    thread::scope(|scope| [(); 2].map(|()| scope.spawn(call)).map(|thread| thread.join().unwrap()));
    assert_eq!(inside.most.into_inner(), 1);
    let served = inside.calls.into_inner();
    assert!((1..2 * CALLS).contains(&served), "{served} calls were served");
    unsafe { fmi2::FreeInstance(with_exposed_provenance_mut(c)) };
}
