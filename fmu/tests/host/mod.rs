//! A host: loads nothing, calls the C functions of either version directly, keeps what is logged.
#![allow(unsafe_code, dead_code, unused_imports)] // the C interface; every test file uses a part of this

use FlexibleRocking::fmi2::{self, CallbackFunctions, CallbackLogger, EventInfo};
use FlexibleRocking::fmi3::{self, IntermediateUpdateCallback, LogMessageCallback};
use FlexibleRocking::resources::{Contents, FRAME_FILE, PARAMETERS_FILE, frame_bytes};
use FlexibleRocking::unit::{Condition, Course, Unit};
use FlexibleRocking::variables::Table;
use fmi_unit::interface::Stepping;
use fmi_unit::snapshot::Snapshot;
use fmi_unit::variables::{position, state_references};
use fmi_unit::{DataType, Model, Update, Variable};
use libc::{c_char, c_int, c_uint, c_void};
use rocking::engine::Moves;
use rocking::{Body, Floor, Mode, Modes, Parameters, Structure, Ties};
use std::cell::{Cell, RefCell};
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
pub fn course<Q: Moves>(snapshot: &Snapshot) -> Option<Course<Q>> {
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
    pub is_fmi_3: bool,
    pub is_model: bool,
    pub log: Box<Log>,
    /// The folder `resources` of the FMU.
    pub resources: TempDir,
    pub variables: Arc<[Variable]>,
    /// For FMI 3.0, which has it when initialization begins.
    experiment: Cell<(bool, f64, f64, bool, f64)>,
    pub around: fn(bool),
}

/// The arguments of a function that makes an instance.
pub struct Instantiate {
    pub is_fmi_3: bool,
    pub name: &'static str,
    pub fmu_type: c_int,
    /// For FMI 3.0.
    pub stepping: Stepping,
    pub required: Vec<c_uint>,
    pub update: Option<IntermediateUpdateCallback>,
    pub guid: Option<String>,
    pub location: Option<String>,
    pub logging_on: c_int,
    pub resources: TempDir,
    /// Called before and after each call; whether it is before.
    pub around: fn(bool),
}

impl Default for Instantiate {
    fn default() -> Instantiate {
        Instantiate {
            is_fmi_3: false,
            name: "wall",
            fmu_type: CO_SIMULATION,
            stepping: Stepping::default(),
            required: Vec::new(),
            update: None,
            guid: None,
            location: None,
            logging_on: 0,
            resources: resources(),
            around: |_| (),
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
    std::fs::write(folder.path().join(FRAME_FILE), frame_bytes(&frame)).unwrap();
    folder
}

pub type Text = *const c_char;

unsafe fn record(log: *mut c_void, instance: &str, status: c_int, [category, text]: [Text; 2]) {
    let [category, text] = [category, text].map(|text| unsafe { CStr::from_ptr(text) }.to_str().unwrap().to_owned());
    let log = unsafe { &*log.cast::<Log>() };
    log.borrow_mut().push(Message { instance: instance.to_owned(), status, category, text });
}

unsafe extern "C" fn record_2(log: *mut c_void, instance: Text, status: c_int, category: Text, text: Text) {
    unsafe { record(log, CStr::from_ptr(instance).to_str().unwrap(), status, [category, text]) }
}

unsafe extern "C" fn record_3(log: *mut c_void, status: c_int, category: Text, text: Text) {
    unsafe { record(log, "", status, [category, text]) }
}

/// Callbacks that log into `environment` by a `logger`, which has no further arguments to read, so that it may be declared without
/// them.
pub fn callbacks(
    environment: *mut c_void,
    logger: unsafe extern "C" fn(*mut c_void, Text, c_int, Text, Text),
) -> CallbackFunctions {
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

/// The value reference of a variable in FMI 2.0.
pub fn reference(name: &str) -> c_uint {
    position(&VARIABLES, name) as c_uint
}

/// Calls the function of the instance's version. The versions have names and arguments of their own, or the same.
macro_rules! call {
    ($of:ident, $both:ident($($argument:expr),*)) => { call!($of, $both($($argument),*), $both($($argument),*)) };
    ($of:ident, $two:ident($($a:expr),*), $three:ident($($b:expr),*)) => {{
        ($of.around)(true);
        let c = $of.component;
        let status = unsafe { if $of.is_fmi_3 { fmi3::$three(c, $($b),*) } else { fmi2::$two(c, $($a),*) } };
        ($of.around)(false);
        status
    }};
}

pub(crate) use call;

/// `value` if a call was done, else its status.
fn done<T>(status: c_int, value: T) -> Result<T, c_int> {
    if status == OK { Ok(value) } else { Err(status) }
}

/// Methods for functions of which nothing but their names differs between the versions.
macro_rules! alike {
    ($($method:ident($($argument:ident: $type:ty)?): $two:ident $three:ident)*) => {
        impl Host {
            $(pub fn $method(&self $(, $argument: $type)?) -> c_int {
                call!(self, $two($($argument)?), $three($($argument)?))
            })*
        }
    };
}

alike! {
    exit(): ExitInitializationMode ExitInitializationMode
    terminate(): Terminate Terminate
    reset(): Reset Reset
    enter_event_mode(): EnterEventMode EnterEventMode
    go_on(): EnterContinuousTimeMode EnterContinuousTimeMode
    set_time(time: f64): SetTime SetTime
    go_back(state: *mut c_void): SetFMUstate SetFMUState
}

impl Host {
    /// Just instantiated, or the log.
    pub fn instantiate(arguments: Instantiate) -> Result<Host, Vec<Message>> {
        let Instantiate { is_fmi_3, name, fmu_type, stepping, update, logging_on, resources, around, .. } = arguments;
        let (model, log) = (Unit::<f64>::open(resources.path()).unwrap(), Box::<Log>::default());
        let start = if is_fmi_3 { "" } else { "file://" };
        let location = arguments.location.unwrap_or_else(|| format!("{start}{}", resources.path().display()));
        let guid = arguments.guid.unwrap_or_else(|| model.token());
        let texts = [name, &guid, &location].map(|text| CString::new(text).unwrap());
        let [name, guid, location] = texts.each_ref().map(|text| text.as_ptr());
        let (to, log_3) = ((&raw const *log).cast_mut().cast(), Some(record_3 as LogMessageCallback));
        let (functions, model_of_3, slave_of_3) =
            (callbacks(to, record_2), fmi3::InstantiateModelExchange, fmi3::InstantiateCoSimulation);
        let [on, events, early] = [logging_on == 1, stepping.event_mode, stepping.early_return].map(u8::from);
        let (of, n) = (arguments.required.as_ptr(), arguments.required.len());
        around(true);
        let component = unsafe {
            match (is_fmi_3, fmu_type) {
                (false, _) => fmi2::Instantiate(name, fmu_type, guid, location, &functions, 0, logging_on),
                (_, MODEL_EXCHANGE) => model_of_3(name, guid, location, 0, on, to, log_3),
                _ => slave_of_3(name, guid, location, 0, on, events, early, of, n, to, log_3, update),
            }
        };
        around(false);
        if component.is_null() {
            return Err(log.take());
        }
        let (is_model, variables, experiment) = (fmu_type == MODEL_EXCHANGE, model.variables(), Cell::default());
        Ok(Host { component, is_fmi_3, is_model, log, resources, variables, experiment, around })
    }

    pub fn new() -> Host {
        Host::instantiate(Instantiate::default()).unwrap()
    }

    /// Of FMI 3.0; without a stepping for model exchange.
    pub fn new_of_3(stepping: Option<Stepping>) -> Host {
        let (fmu_type, stepping) = (stepping.is_some().into(), stepping.unwrap_or_default());
        Host::instantiate(Instantiate { is_fmi_3: true, fmu_type, stepping, ..Instantiate::default() }).unwrap()
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
        host.start();
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
        assert_eq!((host.setup(None, 0.0, None), host.enter()), (OK, OK));
        host
    }

    /// Ready to step, at t = 0.
    pub fn started(start_values: &[(&str, f64)]) -> Host {
        let host = Host::initializing(start_values);
        host.start();
        host
    }

    /// Ends initialization, and for a model goes on to continuous-time mode.
    pub fn start(&self) {
        assert_eq!(self.exit(), OK, "{:?}", self.log);
        if self.is_model {
            assert_eq!((self.update().is_ok(), self.go_on()), (true, OK), "{:?}", self.log);
        }
    }

    /// Passes tolerance and times, and initializes.
    pub fn begin(&self, tolerance: Option<f64>, start: f64, stop: Option<f64>) {
        let called = (self.setup(tolerance, start, stop), self.enter(), self.exit());
        assert_eq!(called, (OK, OK, OK), "{:?}", self.log);
    }

    /// Passes tolerance and times, in FMI 3.0 when initialization begins.
    pub fn setup(&self, tolerance: Option<f64>, start: f64, stop: Option<f64>) -> c_int {
        let number = |given: Option<f64>| (given.is_some(), given.unwrap_or_default());
        let ((is_defined, tolerance), (stops, stop)) = (number(tolerance), number(stop));
        self.experiment.set((is_defined, tolerance, start, stops, stop));
        if self.is_fmi_3 {
            return OK;
        }
        unsafe { fmi2::SetupExperiment(self.component, is_defined.into(), tolerance, start, stops.into(), stop) }
    }

    pub fn enter(&self) -> c_int {
        let (is_defined, tolerance, start, stops, stop) = self.experiment.get();
        let (is_defined, stops) = (is_defined.into(), stops.into());
        call!(self, EnterInitializationMode(), EnterInitializationMode(is_defined, tolerance, start, stops, stop))
    }

    /// The value reference of the variable `name`.
    pub fn at(&self, name: &str) -> c_uint {
        position(&self.variables, name) as c_uint + c_uint::from(self.is_fmi_3)
    }

    fn all_at(&self, names: &[&str]) -> Vec<c_uint> {
        names.iter().map(|name| self.at(name)).collect()
    }

    pub fn set(&self, values: &[(&str, f64)]) -> c_int {
        let (names, values): (Vec<_>, Vec<_>) = values.iter().copied().unzip();
        self.set_by_reference(&self.all_at(&names), &values)
    }

    pub fn set_by_reference(&self, references: &[c_uint], values: &[f64]) -> c_int {
        let (at, n, values) = (references.as_ptr(), references.len(), values.as_ptr());
        call!(self, SetReal(at, n, values), SetFloat64(at, n, values, n))
    }

    pub fn set_integer(&self, name: &str, value: c_int) -> c_int {
        let at = self.at(name);
        call!(self, SetInteger(&at, 1, &value), SetInt64(&at, 1, &value.into(), 1))
    }

    pub fn set_boolean(&self, name: &str, value: c_int) -> c_int {
        let at = self.at(name);
        call!(self, SetBoolean(&at, 1, &value), SetBoolean(&at, 1, &(value as u8), 1))
    }

    /// Sets the record.
    pub fn set_record(&self, record: &str) -> c_int {
        self.set_text("record", record)
    }

    /// Sets the text `name`.
    pub fn set_text(&self, name: &str, value: &str) -> c_int {
        let (at, value) = (self.at(name), CString::new(value).unwrap());
        call!(self, SetString(&at, 1, &value.as_ptr()), SetString(&at, 1, &value.as_ptr(), 1))
    }

    /// The record.
    pub fn record(&self) -> String {
        let (at, mut text) = (self.at("record"), ptr::null());
        assert_eq!(call!(self, GetString(&at, 1, &mut text), GetString(&at, 1, &mut text, 1)), OK);
        unsafe { CStr::from_ptr(text) }.to_str().unwrap().to_owned()
    }

    /// Writes `text` as the file `name` of the archive's resources.
    pub fn write(&self, name: &str, text: &str) {
        std::fs::write(self.resources.path().join(name), text).unwrap();
    }

    /// Sets the slope of an input, in FMI 2.0.
    pub fn set_slope(&self, name: &str, order: c_int, slope: f64) -> c_int {
        unsafe { fmi2::SetRealInputDerivatives(self.component, &self.at(name), 1, &order, &slope) }
    }

    /// Values, or the status.
    pub fn try_get(&self, names: &[&str]) -> Result<Vec<f64>, c_int> {
        let (references, n, mut values) = (self.all_at(names), names.len(), vec![f64::MAX; names.len()]);
        let (at, to) = (references.as_ptr(), values.as_mut_ptr());
        let status = call!(self, GetReal(at, n, to), GetFloat64(at, n, to, n));
        assert!(status == OK || values.iter().all(|value| *value == f64::MAX), "a refused call wrote {values:?}");
        done(status, values)
    }

    pub fn get(&self, name: &str) -> f64 {
        self.try_get(&[name]).unwrap_or_else(|_| panic!("{:?}", self.log))[0]
    }

    pub fn integer(&self, name: &str) -> c_int {
        let (at, mut value, mut wide) = (self.at(name), c_int::MAX, i64::MAX);
        let of = self.variables[position(&self.variables, name)].data_type;
        let status = if of == DataType::Integer {
            call!(self, GetInteger(&at, 1, &mut value), GetInt32(&at, 1, &mut value, 1))
        } else {
            call!(self, GetInteger(&at, 1, &mut value), GetInt64(&at, 1, &mut wide, 1))
        };
        assert_eq!(status, OK, "{:?}", self.log);
        if wide == i64::MAX { value } else { wide as c_int }
    }

    pub fn try_boolean(&self, name: &str) -> Result<c_int, c_int> {
        let (at, mut value, mut short) = (self.at(name), 0, 0);
        let status = call!(self, GetBoolean(&at, 1, &mut value), GetBoolean(&at, 1, &mut short, 1));
        done(status, value + c_int::from(short))
    }

    pub fn rate(&self, name: &str, order: c_int) -> Result<f64, c_int> {
        let (at, mut rate) = (self.at(name), f64::MAX);
        let status = call!(
            self,
            GetRealOutputDerivatives(&at, 1, &order, &mut rate),
            GetOutputDerivatives(&at, 1, &order, &mut rate, 1)
        );
        done(status, rate)
    }

    /// The derivatives of `unknowns` where each of `knowns` changes by so much, or the status.
    pub fn derive(&self, unknowns: &[&str], knowns: &[(&str, f64)]) -> Result<Vec<f64>, c_int> {
        let (names, seed): (Vec<_>, Vec<_>) = knowns.iter().copied().unzip();
        let (of, by, mut found) = (self.all_at(unknowns), self.all_at(&names), vec![f64::MAX; unknowns.len()]);
        let ((of, n), (by, m), seed, to) =
            ((of.as_ptr(), of.len()), (by.as_ptr(), by.len()), seed.as_ptr(), found.as_mut_ptr());
        let status = call!(
            self,
            GetDirectionalDerivative(of, n, by, m, seed, to),
            GetDirectionalDerivative(of, n, by, m, seed, m, to, n)
        );
        done(status, found)
    }

    /// The derivative of `of` by `by`.
    pub fn derivative(&self, of: &str, by: &str) -> f64 {
        self.derive(&[of], &[(by, 1.0)]).unwrap_or_else(|_| panic!("{:?}", self.log))[0]
    }

    pub fn step(&self, time: f64, step: f64) -> c_int {
        self.step_to(time, step).0
    }

    /// The status of a step, and in FMI 3.0 whether there is an event, the end, an early return, and when.
    pub fn step_to(&self, time: f64, step: f64) -> (c_int, [u8; 3], f64) {
        let (mut flags, mut reached) = ([0; 3], f64::NAN);
        let [event, end, early] = &mut flags;
        let status = call!(self, DoStep(time, step, 0), DoStep(time, step, 0, event, end, early, &mut reached));
        (status, flags, reached)
    }

    pub fn set_states(&self, states: &[f64]) -> c_int {
        call!(self, SetContinuousStates(states.as_ptr(), states.len()))
    }

    pub fn states(&self) -> Result<Vec<f64>, c_int> {
        let mut states = vec![f64::MAX; state_references(&self.variables).count()];
        done(call!(self, GetContinuousStates(states.as_mut_ptr(), states.len())), states)
    }

    pub fn derivatives(&self) -> Result<Vec<f64>, c_int> {
        let mut rates = vec![f64::MAX; state_references(&self.variables).count()];
        let (to, n) = (rates.as_mut_ptr(), rates.len());
        done(call!(self, GetDerivatives(to, n), GetContinuousStateDerivatives(to, n)), rates)
    }

    pub fn indicators(&self) -> Result<[f64; 2], c_int> {
        let mut indicators = [f64::MAX; 2];
        done(call!(self, GetEventIndicators(indicators.as_mut_ptr(), 2)), indicators)
    }

    /// Whether the complete step asks for event mode, and for the end.
    pub fn complete(&self) -> Result<(bool, bool), c_int> {
        let (mut event, mut end, mut event_3, mut end_3) = (0, 0, 0, 0);
        let status = call!(
            self,
            CompletedIntegratorStep(1, &mut event, &mut end),
            CompletedIntegratorStep(1, &mut event_3, &mut end_3)
        );
        done(status, (event == 1 || event_3 == 1, end == 1 || end_3 == 1))
    }

    pub fn update(&self) -> Result<Update, c_int> {
        let (mut info, mut flags, mut time): (EventInfo, _, _) = (unsafe { std::mem::zeroed() }, [0; 5], 0.0);
        let [needed, end, nominals, values, is_foreseen] = &mut flags;
        let status = call!(
            self,
            NewDiscreteStates(&mut info),
            UpdateDiscreteStates(needed, end, nominals, values, is_foreseen, &mut time)
        );
        assert_eq!((info.new_discrete_states_needed, info.nominals_of_continuous_states_changed), (0, 0));
        assert_eq!((flags[0], flags[2]), (0, 0));
        let update = Update {
            has_ended: info.terminate_simulation == 1 || flags[1] == 1,
            has_new_states: info.values_of_continuous_states_changed == 1 || flags[3] == 1,
            next_event: (info.next_event_time_defined == 1 || flags[4] == 1).then_some(info.next_event_time + time),
        };
        done(status, update)
    }

    /// Goes to the host's states at `time` (s), and through the event if the completed step asks for one.
    pub fn go_to(&self, time: f64, states: &[f64]) {
        assert_eq!((self.set_time(time), self.set_states(states)), (OK, OK));
        if self.complete().unwrap().0 {
            assert_eq!((self.enter_event_mode(), self.update().is_ok(), self.go_on()), (OK, true, OK));
        }
    }

    /// One step of the semi-implicit Euler method from `time` (s), with the event that it asks for.
    pub fn integrate(&self, time: f64, step: f64) {
        assert_eq!(self.set_time(time), OK);
        let (mut states, rates) = (self.states().unwrap(), self.derivatives().unwrap());
        for at in [1, 0, 3, 2] {
            states[at] += step * if at % 2 == 1 { rates[at] } else { states[at + 1] };
        }
        self.go_to(time + step, &states);
    }

    /// In FMI 2.0.
    pub fn last_successful_time(&self) -> f64 {
        let mut time = f64::MAX;
        assert_eq!(unsafe { fmi2::GetRealStatus(self.component, 2, &mut time) }, OK);
        time
    }

    /// In FMI 2.0.
    pub fn is_terminated(&self) -> bool {
        let mut terminated = c_int::MAX;
        assert_eq!(unsafe { fmi2::GetBooleanStatus(self.component, 3, &mut terminated) }, OK);
        terminated == 1
    }

    /// Keeps the present state: into `state`, or a new one for null.
    pub fn try_keep(&self, mut state: *mut c_void) -> Result<*mut c_void, c_int> {
        done(call!(self, GetFMUstate(&mut state), GetFMUState(&mut state)), state)
    }

    pub fn keep(&self) -> *mut c_void {
        self.try_keep(ptr::null_mut()).unwrap()
    }

    pub fn free_state(&self, mut state: *mut c_void) -> c_int {
        let status = call!(self, FreeFMUstate(&mut state), FreeFMUState(&mut state));
        assert_eq!(state.is_null(), status == OK);
        status
    }

    pub fn size(&self, state: *mut c_void) -> Result<usize, c_int> {
        let mut size = usize::MAX;
        let status = call!(self, SerializedFMUstateSize(state, &mut size), SerializedFMUStateSize(state, &mut size));
        done(status, size)
    }

    pub fn serialize(&self, state: *mut c_void, size: usize) -> Result<Vec<u8>, c_int> {
        let mut bytes = vec![0; size];
        let to = bytes.as_mut_ptr();
        done(call!(self, SerializeFMUstate(state, to, size), SerializeFMUState(state, to, size)), bytes)
    }

    pub fn deserialize(&self, bytes: &[u8]) -> Result<*mut c_void, c_int> {
        let (from, n, mut state) = (bytes.as_ptr(), bytes.len(), ptr::null_mut());
        let status = call!(self, DeSerializeFMUstate(from, n, &mut state), DeserializeFMUState(from, n, &mut state));
        done(status, state)
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
        let (n, names) = (pointers.len(), pointers.as_ptr());
        call!(self, SetDebugLogging(on.into(), n, names), SetDebugLogging(on.into(), n, names))
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
        call!(self, FreeInstance());
    }
}
