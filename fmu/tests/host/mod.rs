//! A host: loads nothing, calls the C functions directly, keeps what is logged.
#![allow(unsafe_code, dead_code)] // the C interface; every test file uses a part of this

use FlexibleRocking::fmi2::*;
use FlexibleRocking::guid;
use FlexibleRocking::masses::Masses;
use FlexibleRocking::resources::{Contents, FRAME_FILE, FrameNumbers, PARAMETERS_FILE};
use FlexibleRocking::unit::{Condition, Course};
use FlexibleRocking::variables::Table;
use fmi_unit::Variable;
use fmi_unit::snapshot::Snapshot;
use libc::{c_char, c_int, c_uint, c_void};
use rocking::{Body, Floor, Mode, Modes, Parameters, Structure, Ties};
use std::cell::RefCell;
use std::ffi::{CStr, CString};
use std::ptr;
use std::sync::{Arc, LazyLock};
use tempfile::TempDir;

/// `fmi2ModelExchange`
pub const MODEL_EXCHANGE: c_int = 0;
/// `fmi2CoSimulation`
pub const CO_SIMULATION: c_int = 1;

pub const OK: c_int = 0;
pub const WARNING: c_int = 1;
pub const DISCARD: c_int = 2;
pub const ERROR: c_int = 3;

/// How far the simulation had come that `snapshot` is of, once it had started.
pub fn course<Q: Masses>(snapshot: &Snapshot) -> Option<Course<Q>> {
    postcard::from_bytes::<Condition<Q>>(&snapshot.model).unwrap().2
}

/// One message, as the host's logger got it.
#[derive(Clone, Debug, PartialEq)]
pub struct Message {
    pub instance: String,
    pub status: c_int,
    pub category: String,
    pub text: String,
}

type Log = RefCell<Vec<Message>>;

/// An instance, and the folder and log that it needs.
pub struct Host {
    pub component: *mut c_void,
    pub log: Box<Log>,
    /// Its folder `resources`.
    pub resources: TempDir,
}

/// The arguments of `fmi2Instantiate` that tests vary.
pub struct Instantiate {
    pub name: &'static str,
    pub fmu_type: c_int,
    pub guid: String,
    pub location: Option<String>,
    pub logging_on: c_int,
}

impl Default for Instantiate {
    fn default() -> Instantiate {
        Instantiate {
            name: "wall",
            fmu_type: CO_SIMULATION,
            guid: guid(&contents(Parameters::EVISON)),
            location: None,
            logging_on: 0,
        }
    }
}

/// The contents of an archive of one mass without records.
pub fn contents(parameters: Parameters) -> Contents {
    Structure::new(parameters).unwrap().into()
}

/// A folder `resources` with the parameters of Evison's wall.
pub fn resources() -> TempDir {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join(PARAMETERS_FILE), toml::to_string(&Parameters::EVISON).unwrap()).unwrap();
    folder
}

/// A folder `resources` with two floors of which one mode is kept, and dissipators.
pub fn resources_of_many() -> TempDir {
    let ties = Ties { xi_d: 1.0, c_d: 2e4, k_d: 2e7, F_y: 4e4, ..Ties::default() };
    let r = Some(0.93);
    let body = Body { m0: 2e4, J0: 3e4, m_s: 7e4, S_1: 3.5e5, I_2: 2e6, B: 1.5, r, g: 9.81, c_ratio: 1.0, ties };
    let floor = |height, shape| Floor { mass: 3.5e4, height, shape: Modes::new(&[shape]) };
    let frame = Structure::of_body(body, &[Mode::new(20.0, 0.02, 250.0, 1.4e3)], &[floor(3.5, 2e-3), floor(7.0, 4e-3)])
        .unwrap();
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join(FRAME_FILE), FrameNumbers::from(&frame).to_string()).unwrap();
    folder
}

unsafe extern "C" fn record(
    environment: *mut c_void,
    instance: *const c_char,
    status: c_int,
    category: *const c_char,
    message: *const c_char,
) {
    let [instance, category, text] =
        [instance, category, message].map(|text| unsafe { CStr::from_ptr(text) }.to_str().unwrap().to_owned());
    let log = unsafe { &*environment.cast::<Log>() };
    log.borrow_mut().push(Message { instance, status, category, text });
}

/// Callbacks that log into `environment`. The logger has no further arguments to read, so that it may be declared
/// without them.
pub fn callbacks(environment: *mut c_void) -> CallbackFunctions {
    let logger: unsafe extern "C" fn(_, _, _, _, _) = record;
    CallbackFunctions {
        logger: Some(unsafe { std::mem::transmute::<*const (), CallbackLogger>(logger as *const ()) }),
        allocate_memory: ptr::null(),
        free_memory: ptr::null(),
        step_finished: ptr::null(),
        component_environment: environment,
    }
}

/// The variables, with the start values of Evison's wall.
pub static VARIABLES: LazyLock<Arc<[Variable]>> = LazyLock::new(|| Table::new(&contents(Parameters::EVISON)).variables);

pub fn reference(name: &str) -> c_uint {
    VARIABLES.iter().position(|variable| variable.name == name).unwrap_or_else(|| panic!("{name}")) as c_uint
}

fn references(names: &[&str]) -> Vec<c_uint> {
    names.iter().map(|name| reference(name)).collect()
}

/// `value` if a call was done, else its status.
fn done<T>(status: c_int, value: T) -> Result<T, c_int> {
    if status == OK { Ok(value) } else { Err(status) }
}

impl Host {
    /// Just instantiated, or the log.
    pub fn instantiate(arguments: Instantiate) -> Result<Host, Vec<Message>> {
        let resources = resources();
        let log = Box::<Log>::default();
        let location = arguments.location.unwrap_or_else(|| format!("file://{}", resources.path().display()));
        let [name, guid, location] =
            [arguments.name, &arguments.guid, &location].map(|text| CString::new(text).unwrap());
        let component = unsafe {
            fmi2Instantiate(
                name.as_ptr(),
                arguments.fmu_type,
                guid.as_ptr(),
                location.as_ptr(),
                &callbacks((&raw const *log).cast_mut().cast()),
                0,
                arguments.logging_on,
            )
        };
        if component.is_null() { Err(log.take()) } else { Ok(Host { component, log, resources }) }
    }

    pub fn new() -> Host {
        Host::instantiate(Instantiate::default()).unwrap()
    }

    /// In initialization mode.
    pub fn initializing(start_values: &[(&str, f64)]) -> Host {
        Host::new().initialized(start_values)
    }

    /// For model exchange, just instantiated.
    pub fn new_model() -> Host {
        Host::instantiate(Instantiate { fmu_type: MODEL_EXCHANGE, ..Instantiate::default() }).unwrap()
    }

    /// For model exchange, in continuous-time mode, at t = 0.
    pub fn going_model(start_values: &[(&str, f64)]) -> Host {
        let host = Host::new_model().initialized(start_values);
        assert_eq!((host.exit(), host.update().is_ok(), host.go_on()), (OK, true, OK), "{:?}", host.log);
        host
    }

    /// The same in initialization mode.
    pub fn initialized(self, start_values: &[(&str, f64)]) -> Host {
        let host = self;
        let (details, reals): (Vec<_>, Vec<_>) = start_values.iter().partition(|(name, _)| *name == "detail");
        assert_eq!(host.set(&reals), OK, "{:?}", host.log);
        for (name, number) in details {
            assert_eq!(host.set_integer(name, number as c_int), OK, "{:?}", host.log);
        }
        assert_eq!(host.setup(None, 0.0, None), OK);
        assert_eq!(host.enter(), OK);
        host
    }

    /// Ready to step, at t = 0.
    pub fn started(start_values: &[(&str, f64)]) -> Host {
        let host = Host::initializing(start_values);
        assert_eq!(host.exit(), OK, "{:?}", host.log);
        host
    }

    pub fn setup(&self, tolerance: Option<f64>, start: f64, stop: Option<f64>) -> c_int {
        let (defined, tolerance) = (tolerance.is_some().into(), tolerance.unwrap_or_default());
        unsafe {
            fmi2SetupExperiment(
                self.component,
                defined,
                tolerance,
                start,
                stop.is_some().into(),
                stop.unwrap_or_default(),
            )
        }
    }

    pub fn enter(&self) -> c_int {
        unsafe { fmi2EnterInitializationMode(self.component) }
    }

    pub fn exit(&self) -> c_int {
        unsafe { fmi2ExitInitializationMode(self.component) }
    }

    pub fn terminate(&self) -> c_int {
        unsafe { fmi2Terminate(self.component) }
    }

    pub fn reset(&self) -> c_int {
        unsafe { fmi2Reset(self.component) }
    }

    pub fn set(&self, values: &[(&str, f64)]) -> c_int {
        let (names, values): (Vec<_>, Vec<_>) = values.iter().copied().unzip();
        self.set_by_reference(&references(&names), &values)
    }

    pub fn set_by_reference(&self, references: &[c_uint], values: &[f64]) -> c_int {
        unsafe { fmi2SetReal(self.component, references.as_ptr(), references.len(), values.as_ptr()) }
    }

    pub fn set_integer(&self, name: &str, value: c_int) -> c_int {
        unsafe { fmi2SetInteger(self.component, &reference(name), 1, &value) }
    }

    pub fn set_boolean(&self, name: &str, value: c_int) -> c_int {
        unsafe { fmi2SetBoolean(self.component, &reference(name), 1, &value) }
    }

    /// Sets the record.
    pub fn set_record(&self, record: &str) -> c_int {
        self.set_text("record", record)
    }

    /// Sets the text `name`.
    pub fn set_text(&self, name: &str, value: &str) -> c_int {
        let value = CString::new(value).unwrap();
        unsafe { fmi2SetString(self.component, &reference(name), 1, &value.as_ptr()) }
    }

    /// The record.
    pub fn record(&self) -> String {
        let mut text = ptr::null();
        assert_eq!(unsafe { fmi2GetString(self.component, &reference("record"), 1, &mut text) }, OK);
        unsafe { CStr::from_ptr(text) }.to_str().unwrap().to_owned()
    }

    /// Writes `text` as the file `name` of the archive's resources.
    pub fn write(&self, name: &str, text: &str) {
        std::fs::write(self.resources.path().join(name), text).unwrap();
    }

    pub fn set_slope(&self, name: &str, order: c_int, slope: f64) -> c_int {
        unsafe { fmi2SetRealInputDerivatives(self.component, &reference(name), 1, &order, &slope) }
    }

    /// Values, or the status.
    pub fn try_get(&self, names: &[&str]) -> Result<Vec<f64>, c_int> {
        let (references, mut values) = (references(names), vec![f64::MAX; names.len()]);
        let status = unsafe { fmi2GetReal(self.component, references.as_ptr(), names.len(), values.as_mut_ptr()) };
        assert!(status == OK || values.iter().all(|value| *value == f64::MAX), "a refused call wrote {values:?}");
        done(status, values)
    }

    pub fn get(&self, name: &str) -> f64 {
        self.try_get(&[name]).unwrap_or_else(|_| panic!("{:?}", self.log))[0]
    }

    pub fn integer(&self, name: &str) -> c_int {
        let mut value = c_int::MAX;
        assert_eq!(unsafe { fmi2GetInteger(self.component, &reference(name), 1, &mut value) }, OK, "{:?}", self.log);
        value
    }

    pub fn try_boolean(&self, name: &str) -> Result<c_int, c_int> {
        let mut value = c_int::MAX;
        done(unsafe { fmi2GetBoolean(self.component, &reference(name), 1, &mut value) }, value)
    }

    pub fn rate(&self, name: &str, order: c_int) -> Result<f64, c_int> {
        let mut value = f64::MAX;
        done(unsafe { fmi2GetRealOutputDerivatives(self.component, &reference(name), 1, &order, &mut value) }, value)
    }

    pub fn step(&self, time: f64, step: f64) -> c_int {
        unsafe { fmi2DoStep(self.component, time, step, 0) }
    }

    pub fn set_time(&self, time: f64) -> c_int {
        unsafe { fmi2SetTime(self.component, time) }
    }

    pub fn set_states(&self, states: [f64; 4]) -> c_int {
        unsafe { fmi2SetContinuousStates(self.component, states.as_ptr(), 4) }
    }

    /// Four values or two, by a function that writes them.
    fn written<const N: usize>(
        &self,
        get: unsafe extern "C" fn(*mut c_void, *mut f64, usize) -> c_int,
    ) -> Result<[f64; N], c_int> {
        let mut values = [f64::MAX; N];
        done(unsafe { get(self.component, values.as_mut_ptr(), N) }, values)
    }

    pub fn states(&self) -> Result<[f64; 4], c_int> {
        self.written(fmi2GetContinuousStates)
    }

    pub fn derivatives(&self) -> Result<[f64; 4], c_int> {
        self.written(fmi2GetDerivatives)
    }

    pub fn indicators(&self) -> Result<[f64; 2], c_int> {
        self.written(fmi2GetEventIndicators)
    }

    /// Whether the complete step asks for event mode, and for the end.
    pub fn complete(&self) -> Result<(bool, bool), c_int> {
        let (mut event, mut end) = (c_int::MAX, c_int::MAX);
        let status = unsafe { fmi2CompletedIntegratorStep(self.component, 1, &mut event, &mut end) };
        done(status, (event == 1, end == 1))
    }

    pub fn enter_event_mode(&self) -> c_int {
        unsafe { fmi2EnterEventMode(self.component) }
    }

    pub fn update(&self) -> Result<EventInfo, c_int> {
        let mut info: EventInfo = unsafe { std::mem::zeroed() };
        let status = unsafe { fmi2NewDiscreteStates(self.component, &mut info) };
        assert_eq!((info.new_discrete_states_needed, info.nominals_of_continuous_states_changed), (0, 0));
        done(status, info)
    }

    /// On to continuous-time mode.
    pub fn go_on(&self) -> c_int {
        unsafe { fmi2EnterContinuousTimeMode(self.component) }
    }

    /// One step of the semi-implicit Euler method from `time` (s), with the event that it asks for.
    pub fn integrate(&self, time: f64, step: f64) {
        assert_eq!(self.set_time(time), OK);
        let ([u, u_dot, theta, theta_dot], [_, u_ddot, _, theta_ddot]) =
            (self.states().unwrap(), self.derivatives().unwrap());
        let (u_dot, theta_dot) = (u_dot + step * u_ddot, theta_dot + step * theta_ddot);
        let end = [u + step * u_dot, u_dot, theta + step * theta_dot, theta_dot];
        assert_eq!((self.set_time(time + step), self.set_states(end)), (OK, OK));
        if self.complete().unwrap().0 {
            assert_eq!(self.enter_event_mode(), OK);
            assert!(self.update().is_ok());
            assert_eq!(self.go_on(), OK);
        }
    }

    pub fn last_successful_time(&self) -> f64 {
        let mut time = f64::MAX;
        assert_eq!(unsafe { fmi2GetRealStatus(self.component, 2, &mut time) }, OK);
        time
    }

    pub fn is_terminated(&self) -> bool {
        let mut terminated = c_int::MAX;
        assert_eq!(unsafe { fmi2GetBooleanStatus(self.component, 3, &mut terminated) }, OK);
        terminated == 1
    }

    /// Keeps the present state: into `state`, or a new one for null.
    pub fn try_keep(&self, mut state: *mut c_void) -> Result<*mut c_void, c_int> {
        done(unsafe { fmi2GetFMUstate(self.component, &mut state) }, state)
    }

    pub fn keep(&self) -> *mut c_void {
        self.try_keep(ptr::null_mut()).unwrap()
    }

    pub fn go_back(&self, state: *mut c_void) -> c_int {
        unsafe { fmi2SetFMUstate(self.component, state) }
    }

    pub fn free_state(&self, mut state: *mut c_void) -> c_int {
        let status = unsafe { fmi2FreeFMUstate(self.component, &mut state) };
        assert_eq!(state.is_null(), status == OK);
        status
    }

    pub fn size(&self, state: *mut c_void) -> Result<usize, c_int> {
        let mut size = usize::MAX;
        done(unsafe { fmi2SerializedFMUstateSize(self.component, state, &mut size) }, size)
    }

    pub fn serialize(&self, state: *mut c_void, size: usize) -> Result<Vec<u8>, c_int> {
        let mut bytes = vec![0; size];
        done(unsafe { fmi2SerializeFMUstate(self.component, state, bytes.as_mut_ptr(), size) }, bytes)
    }

    pub fn deserialize(&self, bytes: &[u8]) -> Result<*mut c_void, c_int> {
        let mut state = ptr::null_mut();
        done(unsafe { fmi2DeSerializeFMUstate(self.component, bytes.as_ptr(), bytes.len(), &mut state) }, state)
    }

    /// All that the instance's future depends on, as bytes.
    pub fn bytes(&self) -> Vec<u8> {
        let state = self.keep();
        let bytes = self.serialize(state, self.size(state).unwrap()).unwrap();
        assert_eq!(self.free_state(state), OK);
        bytes
    }

    pub fn set_debug_logging(&self, on: bool, categories: &[&str]) -> c_int {
        let categories: Vec<_> = categories.iter().map(|name| CString::new(*name).unwrap()).collect();
        let pointers: Vec<_> = categories.iter().map(|name| name.as_ptr()).collect();
        unsafe { fmi2SetDebugLogging(self.component, on.into(), pointers.len(), pointers.as_ptr()) }
    }

    /// Asserts that `call` is refused with a message that has `message` in it, and changes nothing.
    pub fn assert_refused<T: std::fmt::Debug + PartialEq>(&self, call: impl FnOnce() -> T, refused: T, message: &str) {
        let before = self.bytes();
        self.log.borrow_mut().clear();
        assert_eq!(call(), refused, "{:?}", self.log);
        let log = self.log.take();
        assert!(log.len() == 1 && log[0].text.contains(message), "{log:?} instead of {message}");
        assert_eq!((log[0].status, log[0].category.as_str()), (ERROR, "logStatusError"));
        assert_eq!(self.bytes(), before, "the refused call changed something");
    }
}

impl Drop for Host {
    fn drop(&mut self) {
        unsafe { fmi2FreeInstance(self.component) }
    }
}
