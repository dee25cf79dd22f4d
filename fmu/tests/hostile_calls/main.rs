//! Hostile calls: random functions in any order, with arguments from sensible to absurd, of every interface of either
//! version. They also meet every function in every stage, and check it against the standard's table.
//!
//! `FUZZ_CALLS` says how many calls of each interface to make (`make fuzz`: ten million). Calls come in sequences of a
//! few hundred on two instances. What a call does follows from its number and from the calls before it; of a sequence
//! that fails proptest leaves out all calls that need not be there.
#![allow(unsafe_code)]

mod arguments;
mod fmi2;
mod fmi3;
#[path = "../host/mod.rs"]
mod host;

use FlexibleRocking::condition::Condition;
use FlexibleRocking::interface::{Interface, Stepping};
use FlexibleRocking::resources::Archive;
use FlexibleRocking::snapshot;
use FlexibleRocking::state_machine::{Stage, Stages};
use arguments::Drawn;
use fastrand::Rng;
use host::{DISCARD, ERROR, OK};
use libc::{c_char, c_int, c_void};
use proptest::collection::vec;
use proptest::prelude::any;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use rocking::Parameters;
use rocking::engine::MAX_STEPS_PER_ADVANCE;
use rocking::series::taylor::MAX_ORDER;
use std::cell::{Cell, RefCell};
use std::env;
use std::ffi::{CStr, CString};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::Path;
use std::ptr::{null, null_mut};

/// Calls of each interface without `FUZZ_CALLS`.
const CALLS: u64 = 100_000;

/// On average.
const CALLS_PER_SEQUENCE: usize = 400;

/// Sequences in which all is made that is made when it is first needed.
const WARMING_UP: u32 = 20;

/// What leads on, in the stages that it is for.
const LEADING_ON: &str = "SetupExperiment EnterInitializationMode ExitInitializationMode SetReal SetFloat64 DoStep \
                          EnterEventMode NewDiscreteStates UpdateDiscreteStates EnterStepMode EnterContinuousTimeMode \
                          SetTime SetContinuousStates CompletedIntegratorStep SetFMUstate SetFMUState";

/// An instance.
type C = *mut c_void;

/// A call of an instance with arguments that are drawn for it.
type Call = fn(C, &mut Sequence) -> c_int;

/// A version of the standard.
struct Version {
    /// All of its functions that take an instance, but for the one that frees it.
    functions: fn() -> Vec<&'static str>,
    /// How each is called, but for those that are allowed nowhere and read no argument.
    calls: &'static [(&'static str, Call)],
    slave: Table,
    model: Table,
    /// The folder `resources` as this version names it.
    location: fn(&Path) -> String,
    /// Makes an instance, which tells what it logs, of a name, a token and a location.
    instantiate: fn(&mut Rng, Interface, [*const c_char; 3], Option<&Told>) -> C,
    free: unsafe extern "C" fn(C),
    get_state: unsafe extern "C" fn(C, *mut C) -> c_int,
    free_state: unsafe extern "C" fn(C, *mut C) -> c_int,
    size: unsafe extern "C" fn(C, C, *mut usize) -> c_int,
    serialize: unsafe extern "C" fn(C, C, *mut u8, usize) -> c_int,
    event_indicators: unsafe extern "C" fn(C, *mut f64, usize) -> c_int,
}

/// The stages of an interface, and in which of them functions may be called: x or -, then their names without the prefix.
struct Table {
    stages: &'static [Stage],
    rows: &'static str,
}

impl Table {
    /// The stages that `function` may be called in.
    fn allowed(&self, function: &str) -> Vec<Stage> {
        let row = self.rows.lines().find(|row| row.split_whitespace().any(|word| word == &function[4..]));
        let marks = row.unwrap_or_default().split_whitespace();
        self.stages.iter().zip(marks).filter(|(_, mark)| *mark == "x").map(|(stage, _)| *stage).collect()
    }
}

impl Version {
    fn table(&self, interface: Interface) -> &Table {
        if interface == Interface::ModelExchange { &self.model } else { &self.slave }
    }

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

const SLAVE: Interface = Interface::CoSimulation(Stepping { event_mode: false, early_return: false });

#[test]
fn no_call_of_fmi_2_co_simulation_does_harm() {
    no_call_does_harm(&fmi2::VERSION, |_| SLAVE);
}

#[test]
fn no_call_of_fmi_2_model_exchange_does_harm() {
    no_call_does_harm(&fmi2::VERSION, |_| Interface::ModelExchange);
}

#[test]
fn no_call_of_fmi_3_co_simulation_does_harm() {
    no_call_does_harm(&fmi3::VERSION, |rng| {
        Interface::CoSimulation(Stepping { event_mode: rng.bool(), early_return: rng.bool() })
    });
}

#[test]
fn no_call_of_fmi_3_model_exchange_does_harm() {
    no_call_does_harm(&fmi3::VERSION, |_| Interface::ModelExchange);
}

/// No crash, no panic, no leak, and what [`Sequence::check`] asks of every call.
fn no_call_does_harm(version: &'static Version, interface: fn(&mut Rng) -> Interface) {
    let calls = env::var("FUZZ_CALLS").map_or(CALLS, |calls| calls.parse().expect("FUZZ_CALLS is a number"));
    let resources = host::resources();
    let location = CString::new((version.location)(resources.path())).unwrap();
    let records = arguments::records(resources.path());
    // what sequences share is no leak: the records, held here
    let archive = Archive::open(resources.path().to_owned()).unwrap();
    let texts = || records.iter().filter_map(|text| text.to_str().ok()).chain([""]);
    let pairs = texts().flat_map(|record| texts().map(move |vertical| (record, vertical)));
    let _held: Vec<_> = pairs.filter_map(|(record, vertical)| archive.ground(record, vertical).ok()).collect();
    let tally = RefCell::new(Tally { tried: vec![0; version.calls.len()], done: vec![false; version.calls.len()] });
    let config = Config {
        cases: WARMING_UP + calls.div_ceil(CALLS_PER_SEQUENCE as u64) as u32,
        failure_persistence: None,
        ..Config::default()
    };
    let (mut runner, runs) =
        (TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha)), Cell::new(0));
    let checked = runner.run(&vec(any::<u64>(), 1..2 * CALLS_PER_SEQUENCE), |numbers| {
        let mut done = Ok(());
        // the counter does not outlive a panic
        let run = AssertUnwindSafe(|| {
            Sequence::new(version, interface, &location, &records).run(&numbers, &mut tally.borrow_mut());
        });
        let left = allocation_counter::measure(|| done = catch_unwind(run));
        done.unwrap_or_else(|panic| resume_unwind(panic));
        runs.set(runs.get() + 1);
        let is_left = runs.get() > WARMING_UP && (left.count_current, left.bytes_current) != (0, 0);
        assert!(!is_left, "something is left behind: {left:?}");
        Ok(())
    });
    checked.unwrap_or_else(|failure| panic!("{failure}"));
    if calls >= CALLS {
        tally.into_inner().check(version, version.table(interface(&mut Rng::with_seed(0))));
    }
}

/// What came of the calls, by the place of each function in [`Version::calls`].
struct Tally {
    /// The stages that it was called in.
    tried: Vec<Stages>,
    /// Whether it did what it is for.
    done: Vec<bool>,
}

impl Tally {
    /// Every function was called in every stage in which an instance stays, and every one that may be was done.
    fn check(&self, version: &Version, table: &Table) {
        let stays = table.stages.iter().filter(|stage| !stage.is_within_step());
        let all = stays.fold(0, |all, stage| all | 1 << *stage as u8);
        for (at, (name, _)) in version.calls.iter().enumerate() {
            assert_eq!(self.tried[at], all, "{name} was not called in every stage");
            assert_ne!(self.done[at], table.allowed(name).is_empty(), "{name}");
        }
        let is_called = |name: &&str| version.calls.iter().any(|(called, _)| called == name);
        let others = (version.functions)().into_iter().filter(|name| !is_called(name));
        others.for_each(|name| assert!(table.allowed(name).is_empty(), "{name} is not called"));
    }
}

/// Where an instance logs to.
#[derive(Default)]
struct Told {
    messages: RefCell<Vec<(c_int, String)>>,
    /// Called from within the logger, unless null.
    call_back: Cell<C>,
    /// What is called from within a step, and the input at its end.
    asked: Cell<(C, f64)>,
}

impl Told {
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

/// Room for one instance.
struct Slot {
    /// Null if there is none.
    c: C,
    told: Box<Told>,
    /// Whether it has been given a logger.
    is_heard: bool,
    /// The FMU states that it has handed out.
    states: Vec<C>,
    /// One that it has handed out and freed.
    freed: C,
    /// What it was when it was made, as bytes.
    new: Vec<u8>,
}

/// A run of calls on two instances.
struct Sequence<'a> {
    rng: Rng,
    version: &'static Version,
    interface: fn(&mut Rng) -> Interface,
    location: &'a CStr,
    records: &'a [CString],
    slots: [Slot; 2],
    /// Serialized states of both.
    bytes: Vec<Vec<u8>>,
    /// The instance that is called, and where it stands.
    at: usize,
    before: Option<Condition>,
    drawn: Drawn,
}

impl<'a> Sequence<'a> {
    fn new(
        version: &'static Version,
        interface: fn(&mut Rng) -> Interface,
        location: &'a CStr,
        records: &'a [CString],
    ) -> Self {
        let slots = [(); 2].map(|()| Slot {
            c: null_mut(),
            told: Box::default(),
            is_heard: false,
            states: Vec::new(),
            freed: null_mut(),
            new: Vec::new(),
        });
        let (rng, bytes, before, drawn) = (Rng::with_seed(0), Vec::new(), None, Drawn::default());
        Sequence { rng, version, interface, location, records, slots, bytes, at: 0, before, drawn }
    }

    fn run(mut self, numbers: &[u64], tally: &mut Tally) {
        for number in numbers {
            self.rng.seed(*number);
            self.at = self.rng.usize(..2);
            let c = self.slots[self.at].c;
            if c.is_null() && self.rng.u8(..) > 8 {
                self.instantiate();
                continue;
            }
            let before = (!c.is_null()).then(|| self.version.bytes(c));
            // whatever calls have led to can be read back
            self.before = before.as_ref().map(|bytes| snapshot::deserialize(bytes).unwrap());
            if self.one_in(100) {
                self.free(self.at);
            } else {
                self.call(before.unwrap_or_default(), tally);
            }
        }
        (0..2).for_each(|at| self.free(at));
    }

    fn one_in(&mut self, n: u32) -> bool {
        self.rng.u32(..n) == 0
    }

    fn instantiate(&mut self) {
        let wrong = |rng: &mut Rng| rng.u8(..20) == 0;
        let rng = &mut self.rng;
        let too_long = CString::new(vec![b'a'; 70_000]).unwrap();
        let names = [c"wall", c"%s%n#", c"\xff", c"", &too_long];
        let name = if wrong(rng) { names[rng.usize(..5)] } else { names[0] };
        let guid = if wrong(rng) { Parameters::MCMANUS } else { Parameters::EVISON };
        let guid = CString::new(FlexibleRocking::guid(&guid.into())).unwrap();
        let locations = [c"", c"file:///nowhere", c"file:///%00", c"http://localhost/", c"file:///dev", c"\xfe"];
        let location = if wrong(rng) { locations[rng.usize(..6)] } else { self.location };
        let mut texts = [name.as_ptr(), guid.as_ptr(), location.as_ptr()];
        if wrong(rng) {
            texts[rng.usize(..3)] = null();
        }
        let interface = (self.interface)(rng);
        let is_heard = !wrong(rng);
        let slot = &mut self.slots[self.at];
        let c = (self.version.instantiate)(rng, interface, texts, Some(&*slot.told).filter(|_| is_heard));
        let messages = slot.told.messages.take();
        assert!(messages.len() <= usize::from(c.is_null()), "{messages:?}");
        (slot.c, slot.is_heard) = (c, is_heard);
        if !c.is_null() {
            slot.new = self.version.bytes(c);
            assert_eq!(snapshot::deserialize(&slot.new).unwrap().interface, interface);
        }
    }

    /// In whatever state, with the FMU states that it has handed out.
    fn free(&mut self, at: usize) {
        let slot = &mut self.slots[at];
        unsafe { (self.version.free)(slot.c) };
        (slot.c, slot.freed) = (null_mut(), null_mut());
        slot.states.clear();
    }

    /// Calls any function, or one that leads on, of an instance that is `before`.
    fn call(&mut self, before: Vec<u8>, tally: &mut Tally) {
        let (calls, stage) = (self.version.calls, self.before.as_ref().map_or(Stage::Error, |before| before.stage));
        let mut number = self.rng.usize(..calls.len());
        // few come to an error
        if self.one_in(if stage == Stage::Error { 8 } else { 2 })
            && let Some(before) = &self.before
        {
            let table = self.version.table(before.interface);
            let is_leading_on = |name: &str| {
                LEADING_ON.split(' ').any(|word| word == &name[4..]) && table.allowed(name).contains(&stage)
            };
            let leading_on = (0..calls.len()).filter(|at| is_leading_on(calls[*at].0)).collect::<Vec<_>>();
            number = self.rng.choice(leading_on).unwrap_or(number);
        }
        let (name, call) = calls[number];
        self.drawn = Drawn::default();
        let is_calling_back = self.one_in(64);
        let Slot { c, told, .. } = &self.slots[self.at];
        let (c, _) = (*c, told.messages.take());
        told.call_back.set(if is_calling_back { c } else { null_mut() });
        let status = call(c, self);
        let Slot { told, is_heard, .. } = &self.slots[self.at];
        told.call_back.set(null_mut());
        let messages = told.messages.take();
        assert!([OK, DISCARD, ERROR].contains(&status), "{name}: {status} {messages:?}");
        tally.done[number] |= status != ERROR;
        let mut failures = messages.into_iter().filter(|(status, _)| *status > 1);
        let failure = failures.next().map(|(told, text)| {
            assert!(told == status && text.starts_with(&format!("{name}: ")), "{status}, {told}: {text}");
            text
        });
        let is_told = status != OK && !c.is_null() && *is_heard;
        assert!(failure.is_some() == is_told && failures.next().is_none(), "{name}: {status}, {failure:?}");
        if !c.is_null() {
            tally.tried[number] |= 1 << stage as u8;
            self.check(name, status, failure, &before);
        }
        for room in &self.drawn.rooms {
            assert!(room.is_right(status == OK), "{name}: {status}, {:?}, {room:x?}", self.drawn.references);
        }
        self.keep_states(status);
    }

    /// A call of `name` is refused in a stage that is not for it, and done in others. If it returns Error, the instance is
    /// as it was, unless the solver got stuck; else it is in the stage that the function leads to.
    fn check(&self, name: &str, status: c_int, failure: Option<String>, bytes: &[u8]) {
        let (slot, before) = (&self.slots[self.at], self.before.as_ref().unwrap());
        let after = self.version.bytes(slot.c);
        let allowed = self.version.table(before.interface).allowed(name);
        if !allowed.contains(&before.stage) {
            let allowed: Vec<_> = allowed.iter().map(Stage::to_string).collect();
            let allowed = if allowed.is_empty() { "none".to_owned() } else { allowed.join(", ") };
            let text = format!("{name}: not allowed in the state \"{}\"; allowed in: {allowed}", before.stage);
            assert_eq!((status, failure), (ERROR, slot.is_heard.then_some(text)));
            assert!(after == bytes, "the refused {name} changed something");
            return;
        }
        let condition = snapshot::deserialize(&after).unwrap();
        assert!(!failure.as_ref().is_some_and(|text| text.contains("not allowed in the state")), "{failure:?}");
        let stage = match &name[4..] {
            _ if status == ERROR && condition.stage == Stage::Error => {
                let is_stuck = failure.is_none_or(|text| text.contains("cannot be continued"));
                assert!(is_stuck || after == bytes, "{name} is stuck, and does not say so");
                return;
            }
            _ if status == ERROR => {
                assert!(after == bytes, "the refused {name} changed something: {failure:?}");
                return;
            }
            "SetFMUstate" | "SetFMUState" => {
                assert!(after == self.version.bytes_of(slot.c, self.drawn.state), "it is not what the state was");
                return;
            }
            "DoStep" => {
                let has_overturned =
                    status == DISCARD || self.drawn.rooms.get(1).is_some_and(|end| end.words[0] as u8 == 1);
                if has_overturned { Stage::StepFailed } else { Stage::StepComplete }
            }
            "EnterInitializationMode" => Stage::InitializationMode,
            "ExitInitializationMode" => before.interface.first_stage(),
            "EnterEventMode" => Stage::EventMode,
            "EnterStepMode" => Stage::StepComplete,
            "EnterContinuousTimeMode" => Stage::ContinuousTimeMode,
            "Terminate" => Stage::Terminated,
            "Reset" => {
                assert!(after == slot.new, "it is not what it was when it was made");
                Stage::Instantiated
            }
            _ => before.stage,
        };
        assert_eq!(condition.stage, stage, "{name} in {}: {status} {failure:?}", before.stage);
        if name.ends_with("DoStep") {
            self.check_step(before, &condition);
        }
        // what follows an event is above the floor: no indicator is 0, and all are positive until the host moves on
        if matches!(&name[4..], "NewDiscreteStates" | "UpdateDiscreteStates")
            && before.interface == Interface::ModelExchange
            && status == OK
        {
            let mut indicators = [0.0; 2];
            assert_eq!(unsafe { (self.version.event_indicators)(slot.c, indicators.as_mut_ptr(), 2) }, OK);
            assert!(indicators.iter().all(|indicator| *indicator > 0.0), "{name}: {indicators:?}");
        }
    }

    /// The work is bounded. The host's clock is right, in which the structure may overturn, or be due for a transition,
    /// before the end of the last step.
    fn check_step(&self, before: &Condition, after: &Condition) {
        let is_complete =
            after.stage == Stage::StepComplete && self.drawn.rooms.iter().take(3).all(|flag| flag.words[0] as u8 == 0);
        let [before, after] = [before, after].map(|of| of.course.unwrap().motion);
        let is_on =
            if is_complete { after.time > before.time } else { after.time >= before.time.min(self.drawn.point) };
        assert!(is_on, "from {} to {}", before.time, after.time);
        let steps = after.work.steps - before.work.steps;
        assert!(steps <= MAX_STEPS_PER_ADVANCE, "{steps} steps");
        assert!(after.work.evaluations - before.work.evaluations <= steps * MAX_ORDER as u64);
    }

    /// Notes the FMU state and the bytes that the call has made, and the state that it has freed.
    fn keep_states(&mut self, status: c_int) {
        if status != OK {
            return;
        }
        if let Some(written) = self.drawn.serialized.take() {
            self.bytes.truncate(7);
            self.bytes.insert(0, written);
        }
        let Some(&[state]) = self.drawn.place.as_deref() else { return };
        let (version, slot) = (self.version, &mut self.slots[self.at]);
        match (self.drawn.state.is_null(), state.is_null()) {
            (true, false) => {
                assert!(!slot.states.contains(&state));
                if slot.states.len() == 8 {
                    let mut oldest = slot.states.remove(0);
                    assert_eq!(unsafe { (version.free_state)(slot.c, &mut oldest) }, OK);
                }
                slot.states.push(state);
            }
            (false, true) => {
                slot.states.retain(|kept| *kept != self.drawn.state);
                slot.freed = self.drawn.state;
            }
            _ => (),
        }
        let whole = self.drawn.deserialized.take().filter(|bytes| self.bytes.contains(bytes));
        assert!(whole.is_none_or(|bytes| version.bytes_of(slot.c, state) == bytes), "it is not what the bytes were");
    }
}
