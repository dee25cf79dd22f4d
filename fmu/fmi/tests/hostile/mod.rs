//! Hostile calls: random functions in any order, with arguments from sensible to absurd, of every interface of either
//! version. From 100,000 on they also meet every function in every stage, and check it against the standard's table.
//!
//! `FUZZ_CALLS` says how many calls of each interface to make (`make heavy`: 100,000). Calls come in sequences of a
//! few hundred. The number of a call and the calls before it determine what it does. proptest shortens a sequence that
//! fails to the calls that it needs.

mod arguments;
mod fmi2;
mod fmi3;

use crate::Model;
use arguments::CallData;
use fastrand::Rng;
use fmi_unit::interface::{Interface, Stepping};
use fmi_unit::logger::Status;
use fmi_unit::snapshot::Snapshot;
use fmi_unit::state_machine::{Stage, Stages};
use fmi_unit::{Model as _, Role, Variable, variables};
use libc::{c_char, c_int, c_uint, c_void};
use proptest::collection::vec;
use proptest::prelude::any;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use std::cell::{Cell, RefCell};
use std::env;
use std::ffi::{CStr, CString};
use std::path::Path;
use std::ptr::{null, null_mut};
use std::sync::Arc;
use tempfile::TempDir;

const OK: c_int = Status::Ok as c_int;
const WARNING: c_int = Status::Warning as c_int;
const DISCARD: c_int = Status::Discard as c_int;
const ERROR: c_int = Status::Error as c_int;

/// Calls of each interface without `FUZZ_CALLS`.
const CALLS: u64 = 20_000;

/// So many calls meet every function in every stage.
const CALLS_OF_ALL_STAGES: u64 = 100_000;

/// On average.
const CALLS_PER_SEQUENCE: usize = 400;

/// The functions that lead on from their stages.
const LEADING_ON: &str = "SetupExperiment EnterInitializationMode ExitInitializationMode SetReal SetFloat64 DoStep \
                          EnterEventMode NewDiscreteStates UpdateDiscreteStates EnterStepMode EnterContinuousTimeMode \
                          SetTime SetContinuousStates CompletedIntegratorStep SetFMUstate SetFMUState \
                          DeSerializeFMUstate DeserializeFMUState";

pub type C = *mut c_void;

/// The model that is called.
pub struct Target {
    /// Its folder `resources`.
    pub resources: TempDir,
    pub variables: Arc<[Variable]>,
    pub token: CString,
    pub build: String,
    /// The time of a state, s; of a motion that the host integrates, where it was last known.
    pub time: fn(&Snapshot) -> f64,
    /// Texts to set, the first two of them right.
    pub texts: Vec<CString>,
    /// Values from which no step can be made.
    pub sticks: Vec<(c_uint, f64)>,
    /// Whether it checks the numbers of a state, which may then be forged.
    pub checks: bool,
    /// Whether a variable of that name may be infinite or not a number.
    pub may_be_infinite: fn(&str) -> bool,
    /// Checks the states before and after a step.
    pub check_step: fn(&Snapshot, &Snapshot),
}

impl Target {
    /// A model that does nothing out of the ordinary, opened in the folder `resources`.
    pub fn of(resources: TempDir, time: fn(&Snapshot) -> f64) -> Target {
        let model = Model::open(resources.path()).unwrap();
        Target {
            variables: model.variables(),
            token: CString::new(model.token()).unwrap(),
            build: model.build(),
            resources,
            time,
            texts: vec![c"some".into(), c"text".into()],
            sticks: Vec::new(),
            checks: false,
            may_be_infinite: |_| false,
            check_step: |_, _| (),
        }
    }

    fn states(&self) -> impl Iterator<Item = u32> {
        variables::state_references(&self.variables)
    }

    fn indicators(&self) -> usize {
        variables::references(&self.variables, |role| *role == Role::Indicator).len()
    }

    fn read(&self, bytes: &[u8]) -> Snapshot {
        Snapshot::deserialize(&self.build, bytes).unwrap()
    }
}

type Call = fn(C, &mut Sequence) -> c_int;

struct TestedVersion {
    /// The start of the functions' names in C.
    name: &'static str,
    /// All of its functions that take an instance, but for the one that frees it.
    functions: fn() -> Vec<&'static str>,
    /// How each is called, but for those that are allowed nowhere, and those of types that no variable has.
    calls: &'static [(&'static str, Call)],
    table: FunctionTable,
    first_reference: c_uint,
    /// The folder `resources` as this version names it.
    location: fn(&Path) -> String,
    /// Makes an instance, which tells what it logs, of a name, a token and a location.
    instantiate: fn(&mut Rng, Interface, [*const c_char; 3], &HostLog) -> C,
    free: unsafe extern "C" fn(C),
    get_state: unsafe extern "C" fn(C, *mut C) -> c_int,
    free_state: unsafe extern "C" fn(C, *mut C) -> c_int,
    size: unsafe extern "C" fn(C, C, *mut usize) -> c_int,
    serialize: unsafe extern "C" fn(C, C, *mut u8, usize) -> c_int,
}

/// The stages of a version, and in which of them functions may be called: x is for both interfaces, s for a slave, m for a
/// model, - for neither.
struct FunctionTable {
    stages: &'static [(&'static str, Stage)],
    /// A mark for each stage, then the names of functions.
    rows: &'static str,
}

impl FunctionTable {
    /// The stages of `interface` in which a function with these `marks` may be called.
    fn marked<'a>(&self, marks: impl Iterator<Item = &'a str>, interface: Interface) -> Vec<Stage> {
        let own = if interface == Interface::ModelExchange { "m" } else { "s" };
        let is_one = |mark: &str| mark == "x" || mark == own;
        let marked = self.stages.iter().zip(marks).filter(|((of, _), mark)| is_one(of) && is_one(mark));
        marked.map(|((_, stage), _)| *stage).collect()
    }

    /// The stages of `interface` that `function` may be called in.
    fn allowed(&self, function: &str, interface: Interface) -> Vec<Stage> {
        let row = self.rows.lines().find(|row| row.split_whitespace().any(|word| word == function));
        self.marked(row.unwrap_or_default().split_whitespace(), interface)
    }
}

impl TestedVersion {
    /// All that the future of the instance `c` depends on.
    fn bytes(&self, c: C) -> Vec<u8> {
        let mut state = null_mut();
        unsafe {
            assert_eq!((self.get_state)(c, &mut state), OK);
            let bytes = self.bytes_of(c, state);
            assert_eq!((self.free_state)(c, &mut state), OK);
            bytes
        }
    }

    /// The FMU state `state` of `c` as bytes.
    fn bytes_of(&self, c: C, state: C) -> Vec<u8> {
        let mut size = 0;
        unsafe {
            assert_eq!((self.size)(c, state, &mut size), OK);
            let mut bytes = vec![0; size];
            assert_eq!((self.serialize)(c, state, bytes.as_mut_ptr(), size), OK);
            bytes
        }
    }
}

/// The tests of the model that the function `$subject` makes.
macro_rules! hostile_calls {
    ($subject:ident) => {
        hostile_calls! { $subject:
            no_call_of_fmi_2_co_simulation_does_harm(2, false)
            no_call_of_fmi_2_model_exchange_does_harm(2, true)
            no_call_of_fmi_3_co_simulation_does_harm(3, false)
            no_call_of_fmi_3_model_exchange_does_harm(3, true)
        }
    };
    ($subject:ident: $($name:ident($version:literal, $is_model:literal))*) => { $(
        #[test]
        fn $name() {
            hostile::no_call_does_harm(&$subject(), $version, $is_model);
        }
    )* };
}
pub(crate) use hostile_calls;

/// No crash, no panic, and what [`Sequence::check`] asks of every call.
pub fn no_call_does_harm(subject: &Target, version: u8, is_model: bool) {
    let (version, interface): (_, fn(&mut Rng) -> Interface) = match (version, is_model) {
        (2, false) => (&fmi2::VERSION, |_| Interface::CoSimulation(Stepping::default())),
        (2, true) => (&fmi2::VERSION, |_| Interface::ModelExchange),
        (_, false) => (&fmi3::VERSION, |rng| {
            Interface::CoSimulation(Stepping { event_mode: rng.bool(), early_return: rng.bool() })
        }),
        (_, true) => (&fmi3::VERSION, |_| Interface::ModelExchange),
    };
    let calls = env::var("FUZZ_CALLS").map_or(CALLS, |calls| calls.parse().expect("FUZZ_CALLS is a number"));
    let location = CString::new((version.location)(subject.resources.path())).unwrap();
    let tally = RefCell::new(CallTally(vec![(0, false); version.calls.len()]));
    let config = Config {
        cases: calls.div_ceil(CALLS_PER_SEQUENCE as u64) as u32,
        failure_persistence: None,
        ..Config::default()
    };
    let mut runner = TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha));
    let checked = runner.run(&vec(any::<u64>(), 1..2 * CALLS_PER_SEQUENCE), |numbers| {
        let sequence = Sequence {
            rng: Rng::with_seed(0),
            subject,
            version,
            interface,
            location: &location,
            c: null_mut(),
            told: HostLog::default(),
            states: Vec::new(),
            is_forged: false,
            is_long: false,
            freed: null_mut(),
            new: Vec::new(),
            before: None,
            bytes: Vec::new(),
            drawn: CallData::default(),
        };
        sequence.run(&numbers, &mut tally.borrow_mut());
        Ok(())
    });
    checked.unwrap_or_else(|failure| panic!("{failure}"));
    if calls >= CALLS_OF_ALL_STAGES {
        tally.into_inner().check(version, interface(&mut Rng::with_seed(0)));
    }
}

/// The stages that each function was called in, by its place in [`TestedVersion::calls`], and whether it did what it is for.
struct CallTally(Vec<(Stages, bool)>);

impl CallTally {
    /// Every function was called in every stage in which an instance stays, and every one that may be was done.
    fn check(&self, version: &TestedVersion, interface: Interface) {
        let allowed = |name: &str| version.table.allowed(name, interface);
        let stages = version.table.marked(version.table.stages.iter().map(|(mark, _)| *mark), interface);
        let stays = stages.iter().filter(|stage| !stage.is_within_step());
        let all = stays.fold(0, |all, stage| all | 1 << *stage as u8);
        for ((name, _), (tried, is_done)) in version.calls.iter().zip(&self.0) {
            assert_eq!(*tried, all, "{name} was not called in every stage");
            assert_ne!(*is_done, allowed(name).is_empty(), "{name}");
        }
        let is_called = |name: &&str| version.calls.iter().any(|(called, _)| called == name);
        let others = (version.functions)().into_iter().filter(|name| !is_called(name));
        others.for_each(|name| assert!(allowed(name).is_empty(), "{name} is not called"));
    }
}

#[derive(Default)]
struct HostLog {
    messages: RefCell<Vec<(c_int, String)>>,
    /// Called from within the logger, unless null.
    call_back: Cell<C>,
}

impl HostLog {
    /// Takes a message, and calls `harm`, of which nothing may come, with the instance.
    unsafe fn tell(&self, status: c_int, text: *const c_char, harm: impl FnOnce(C)) {
        let text = unsafe { CStr::from_ptr(text) }.to_str().unwrap();
        // not the events, of which one call may have two million
        if status != OK {
            self.messages.borrow_mut().push((status, text.to_owned()));
        }
        let c = self.call_back.get();
        if !c.is_null() {
            harm(c);
        }
    }
}

/// A run of calls on one instance after the other.
struct Sequence<'a> {
    rng: Rng,
    subject: &'a Target,
    version: &'static TestedVersion,
    interface: fn(&mut Rng) -> Interface,
    location: &'a CStr,
    /// The instance; null if there is none.
    c: C,
    told: HostLog,
    /// The FMU states that it has handed out, and whether one of them may be forged.
    states: Vec<C>,
    is_forged: bool,
    /// Whether a step of the instance has taken all the work that a step may take: a host soon frees such an instance.
    is_long: bool,
    /// An FMU state that the instance has handed out and freed.
    freed: C,
    /// The new instance as bytes, and the instance before the next call.
    new: Vec<u8>,
    before: Option<Snapshot>,
    bytes: Vec<Vec<u8>>,
    drawn: CallData,
}

impl Sequence<'_> {
    fn run(mut self, numbers: &[u64], tally: &mut CallTally) {
        for number in numbers {
            self.rng.seed(*number);
            if self.c.is_null() {
                self.instantiate();
            } else if self.one_in(if self.is_long { 4 } else { 100 }) {
                self.free();
            } else {
                self.call(tally);
            }
        }
        self.free();
    }

    fn one_in(&mut self, n: u32) -> bool {
        self.rng.u32(..n) == 0
    }

    /// Of right texts, or with a wrong one among them, which is refused.
    fn instantiate(&mut self) {
        let mut texts = [c"wall".as_ptr(), self.subject.token.as_ptr(), self.location.as_ptr()];
        let too_long = CString::new(vec![b'a'; 70_000]).unwrap();
        let wrong = [null(), c"".as_ptr(), c"\xff".as_ptr(), too_long.as_ptr()];
        let mut is_wrong = self.one_in(10);
        if is_wrong {
            let (at, by) = (self.rng.usize(..3), self.rng.usize(..4));
            texts[at] = wrong[by];
            is_wrong = (at, by) != (2, 1); // a model may need no folder
        }
        let interface = (self.interface)(&mut self.rng);
        self.c = (self.version.instantiate)(&mut self.rng, interface, texts, &self.told);
        let messages = self.told.messages.take();
        assert_eq!(messages.len(), usize::from(self.c.is_null()), "{messages:?}");
        assert!(self.c.is_null() || !is_wrong);
        if !self.c.is_null() {
            self.new = self.version.bytes(self.c);
            assert_eq!(self.subject.read(&self.new).interface, interface);
        }
    }

    /// In whatever state, with the FMU states that it has handed out.
    fn free(&mut self) {
        unsafe { (self.version.free)(self.c) };
        (self.c, self.freed, self.is_forged, self.is_long) = (null_mut(), null_mut(), false, false);
        self.states.clear();
    }

    /// Calls any function, or one that leads on.
    fn call(&mut self, tally: &mut CallTally) {
        let bytes = self.version.bytes(self.c);
        let before = self.subject.read(&bytes);
        let (calls, stage) = (self.version.calls, before.stage);
        let mut number = self.rng.usize(..calls.len());
        // few come to an error
        if self.one_in(if stage == Stage::Error { 8 } else { 2 }) {
            let allowed = |name: &str| self.version.table.allowed(name, before.interface);
            let is_leading_on =
                |name: &str| LEADING_ON.split(' ').any(|word| word == name) && allowed(name).contains(&stage);
            let leading_on = (0..calls.len()).filter(|at| is_leading_on(calls[*at].0)).collect::<Vec<_>>();
            number = self.rng.choice(leading_on).unwrap_or(number);
        }
        let (name, call) = calls[number];
        (self.before, self.drawn) = (Some(before), CallData::default());
        let is_calling_back = self.one_in(64);
        self.told.call_back.set(if is_calling_back { self.c } else { null_mut() });
        self.told.messages.take();
        let status = call(self.c, self);
        self.told.call_back.set(null_mut());
        let messages = self.told.messages.take();
        assert!([OK, DISCARD, ERROR].contains(&status), "{name}: {status} {messages:?}");
        let (tried, is_done) = &mut tally.0[number];
        (*tried, *is_done) = (*tried | 1 << stage as u8, *is_done || status != ERROR);
        let failures: Vec<_> = messages.into_iter().filter(|(status, _)| *status > WARNING).collect();
        assert_eq!(failures.len(), usize::from(status != OK), "{name}: {status}, {failures:?}");
        let failure = failures.into_iter().next().map(|(told, text)| {
            assert!(
                told == status && text.starts_with(&format!("{}{name}: ", self.version.name)),
                "{status}, {told}: {text}"
            );
            text
        });
        self.is_long |= failure.as_ref().is_some_and(|text| text.contains("steps of an advance"));
        self.check(name, status, failure, &bytes);
        for room in &self.drawn.rooms {
            assert!(room.is_right(status == OK), "{name}: {status}, {:?}, {room:x?}", self.drawn.references);
        }
        if status == OK {
            self.keep_states();
        }
    }

    /// A call of `name` is refused in a stage that is not for it, and done in others. If it returns Error, the instance is
    /// as it was, unless the solver got stuck; else it is in the stage that the function leads to.
    fn check(&self, name: &str, status: c_int, failure: Option<String>, bytes: &[u8]) {
        let before = self.before.as_ref().unwrap();
        let after = self.version.bytes(self.c);
        let allowed = self.version.table.allowed(name, before.interface);
        if !allowed.contains(&before.stage) {
            let allowed: Vec<_> = allowed.iter().map(Stage::to_string).collect();
            let allowed = if allowed.is_empty() {
                "no state: this instance does not provide the function".to_owned()
            } else {
                allowed.join(", ")
            };
            let (version, stage) = (self.version.name, before.stage);
            let text = format!("{version}{name}: not allowed in the state \"{stage}\"; allowed in: {allowed}");
            assert_eq!((status, failure), (ERROR, Some(text)));
            assert!(after == bytes, "the refused {name} changed something");
            return;
        }
        let condition = self.subject.read(&after);
        let is_said = |text: &str| failure.as_ref().is_some_and(|failure| failure.contains(text));
        assert!(!is_said("not allowed in the state"), "{failure:?}");
        let stage = match name {
            _ if status == ERROR => {
                let is_stuck = condition.stage == Stage::Error && before.stage != Stage::Error;
                assert!(is_stuck || after == bytes, "the refused {name} changed something: {failure:?}");
                return;
            }
            "SetFMUstate" | "SetFMUState" => {
                let kept = self.version.bytes_of(self.c, self.drawn.state);
                assert!(self.is_forged || after == kept, "it is not what the state was");
                return;
            }
            "DoStep" => {
                self.check_step(before, &condition);
                let has_ended = status == DISCARD || self.drawn.rooms.get(1).is_some_and(|end| end.words[0] as u8 == 1);
                if has_ended { Stage::StepFailed } else { Stage::StepComplete }
            }
            "EnterInitializationMode" => Stage::InitializationMode,
            "ExitInitializationMode" => before.interface.first_stage(),
            "EnterEventMode" => Stage::EventMode,
            "EnterStepMode" => Stage::StepComplete,
            "EnterContinuousTimeMode" => Stage::ContinuousTimeMode,
            "Terminate" => Stage::Terminated,
            "GetNumberOfContinuousStates" | "GetNumberOfEventIndicators" => {
                let counts = [self.subject.states().count(), self.subject.indicators()];
                assert_eq!(self.drawn.rooms[0].words[0] as usize, counts[usize::from(name.ends_with("Indicators"))]);
                before.stage
            }
            "Reset" => {
                assert!(after == self.new, "it is not what it was when it was made");
                Stage::Instantiated
            }
            _ => before.stage,
        };
        assert_eq!(condition.stage, stage, "{name} in {}: {status} {failure:?}", before.stage);
    }

    /// Time goes on over a step that is neither cut short nor ends the simulation.
    fn check_step(&self, before: &Snapshot, after: &Snapshot) {
        let is_whole =
            after.stage == Stage::StepComplete && self.drawn.rooms.iter().take(3).all(|flag| flag.words[0] as u8 == 0);
        let [from, to] = [before, after].map(self.subject.time);
        assert!(!is_whole || to > from, "from {from} to {to}");
        (self.subject.check_step)(before, after);
    }

    /// Notes the FMU state and the bytes that the call has made, and the state that it has freed.
    fn keep_states(&mut self) {
        self.is_forged |= self.drawn.is_forged;
        if let Some(written) = self.drawn.serialized.take() {
            self.bytes.truncate(7);
            self.bytes.insert(0, written);
        }
        let Some(&[state]) = self.drawn.place.as_deref() else { return };
        if state.is_null() {
            self.states.retain(|kept| *kept != self.drawn.state);
            self.freed = self.drawn.state;
        } else if self.drawn.state.is_null() {
            assert!(!self.states.contains(&state));
            self.states.push(state);
        }
    }
}
