//! The memory that an instance takes and leaves, and two threads that call one instance. Hosts in tests/*.py ask for the rest.
#![allow(unsafe_code)] // the C interface

mod wall;

use FlexibleRocking::fmi2::{self, CallbackFunctions, CallbackLogger};
use FlexibleRocking::resources::Contents;
use FlexibleRocking::variables::VariableTable;
use fmi_unit::{Causality, Variable};
use libc::{c_char, c_int, c_void};
use rocking::structure::description::{Damping, Storey};
use rocking::structure::natural_quantities::Numbers;
use rocking::{Ground, Parameters, Structure};
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

/// An instance of `contents` for co-simulation that logs into `environment` by a `logger`.
fn instantiate(contents: &Contents, environment: *mut c_void, logger: Option<CallbackLogger>) -> *mut c_void {
    let (allocate_memory, free_memory, step_finished) = (null(), null(), null());
    let functions =
        CallbackFunctions { logger, allocate_memory, free_memory, step_finished, component_environment: environment };
    let folder = resources(contents);
    let location = CString::new(format!("file://{}", folder.path().display())).unwrap();
    let guid = CString::new(FlexibleRocking::guid(contents)).unwrap();
    unsafe { fmi2::Instantiate(c"wall".as_ptr(), 1, guid.as_ptr(), location.as_ptr(), &functions, 0, 0) }
}

/// An instance that logs nothing.
struct Host(*mut c_void);

impl Host {
    fn new(contents: &Contents) -> Host {
        Host(instantiate(contents, null_mut(), None))
    }

    /// Enters initialization mode, with the record in the file at `path`, and with peaks and limits watched.
    fn enter(&self, path: &Path) {
        let [record, switches @ ..] = ["record", "peaks", "validity"].map(|name| reference(&contents(), name));
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
    (Host::new(&contents()), folder, path)
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
        let [first, second] = [(); 2].map(|()| Host::new(&contents()));
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

/// Hosts in real time count on this, whatever the base and the ground do, also if from 2 s on they set values without slopes, of
/// which the log warns. Peaks and limits are not watched, and nobody reads the log.
#[test]
fn no_step_allocates() {
    let one = |more| Structure::new(Parameters { J0: 1.19, f_fc: 11.0, ..more }).unwrap();
    let tied = Parameters { P_0: 500.0, k_t: 4e4, xi_d: 0.2, c_d: 30.0, k_d: 1e5, F_y: 150.0, ..Parameters::EVISON };
    let storeys = Vec::from_iter((1..=10).map(|i| Storey { m: 4e4, h: 3.5 * f64::from(i), k: 6e7 }));
    let base = Numbers::of(&[("m0", 2e4), ("J0", 3e4), ("B", 3.0)]).unwrap();
    let ten = Structure::from_storeys(&base, &Damping::All(0.02), &storeys).unwrap();
    let soft = Ground { f_v: Some(60.0), ..Ground::default() };
    let gives = Ground { mu_c: Some(0.1), fs: Some(2.0), n_points: Some(5.0), ..soft.clone() };
    let scenes = [
        one(Parameters::EVISON),
        one(tied),
        one(Parameters::EVISON).on(&soft).unwrap(),
        one(tied).on(&gives).unwrap(),
        ten.clone(),
        ten.on(&Ground { f_v: Some(4.0), ..gives }).unwrap(),
    ];
    let ground = |i: u32| [5.1, 13.7, 37.3].map(|omega: f64| 2.0 * (0.001 * omega * f64::from(i)).sin()).iter().sum();
    for structure in scenes {
        let contents = structure.into();
        let variables = VariableTable::new(&contents).variables;
        let is_output = |of: &Variable| of.causality == Causality::Output && of.data_type.limits().is_some();
        let outputs = Vec::from_iter((0..).zip(&*variables).filter(|(_, of)| is_output(of)).map(|(which, _)| which));
        let [a_g, transitions] = ["a_g", "transitions"].map(|name| reference(&contents, name));
        let (host, mut values, mut count) = (Host::new(&contents), vec![0.0; outputs.len()], 0);
        assert_eq!(unsafe { fmi2::EnterInitializationMode(host.0) }, OK);
        host.exit();
        let mut step = |i: u32| unsafe {
            let [value, next]: [f64; 2] = [i, i + 1].map(ground);
            assert_eq!(fmi2::SetReal(host.0, &a_g, 1, &value), OK);
            if i < 2000 {
                assert_eq!(fmi2::SetRealInputDerivatives(host.0, &a_g, 1, &1, &((next - value) / 0.001)), OK);
            }
            host.step(0.001 * f64::from(i), 0.001);
            assert_eq!(fmi2::GetReal(host.0, outputs.as_ptr(), outputs.len(), values.as_mut_ptr()), OK);
        };
        let allocations = Vec::from_iter((0..3000).map(|i| allocation_counter::measure(|| step(i)).count_total));
        assert_eq!(unsafe { fmi2::GetInteger(host.0, &transitions, 1, &mut count) }, OK);
        assert!(count > 10, "{count} transitions");
        assert_eq!(allocations.iter().position(|count| *count > 0), None, "{:?}", contents.description());
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
    let c = instantiate(&contents(), (&raw const inside).cast_mut().cast(), Some(logger)).expose_provenance();
    // each is refused, with a message if it is served
    let call =
        || (0..CALLS).for_each(|_| assert_eq!(unsafe { fmi2::CancelStep(with_exposed_provenance_mut(c)) }, ERROR));
    thread::scope(|scope| [(); 2].map(|()| scope.spawn(call)).map(|thread| thread.join().unwrap()));
    assert_eq!(inside.most.into_inner(), 1);
    let served = inside.calls.into_inner();
    assert!((1..2 * CALLS).contains(&served), "{served} calls were served");
    unsafe { fmi2::FreeInstance(with_exposed_provenance_mut(c)) };
}
