//! Hostile calls: random functions in any order, with arguments from sensible to absurd, of every interface of either
//! version.
//!
//! `FUZZ_CALLS` says how many calls of each interface to make (`make fuzz`: ten million). Calls come in sequences of a
//! few hundred on two instances. What a call does follows from its number and from the calls before it; of a sequence
//! that fails proptest leaves out all calls that need not be there.
#![allow(unsafe_code)]

#[path = "../calls/mod.rs"]
mod calls;
mod fmi2;
mod fmi3;
#[path = "../host/mod.rs"]
mod host;

use FlexibleRocking::c_abi::Function as _;
use FlexibleRocking::condition::Condition;
use FlexibleRocking::interface::{Interface, Stepping};
use FlexibleRocking::resources::Archive;
use FlexibleRocking::snapshot;
use FlexibleRocking::state_machine::Stage;
use FlexibleRocking::variables::{Causality, DataType, VARIABLES};
use calls::{C, Call, Version, fmi2::Fmi2, fmi3::Fmi3};
use fastrand::Rng;
use host::{DISCARD, ERROR, OK};
use proptest::collection::vec;
use proptest::prelude::any;
use proptest::test_runner::{Config, RngAlgorithm, TestRng, TestRunner};
use rocking::Parameters;
use rocking::engine::MAX_STEPS_PER_ADVANCE;
use rocking::run::validity::ASSUMPTIONS;
use rocking::series::taylor::MAX_ORDER;
use std::cell::{Cell, RefCell};
use std::ffi::{CStr, CString};
use std::ffi::{c_char, c_int, c_uint, c_void};
use std::marker::PhantomData;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::Path;
use std::ptr::{null, null_mut, without_provenance_mut};
use std::slice;
use std::{env, fs};
use uuid::Uuid;

/// Calls of each interface without `FUZZ_CALLS`.
const CALLS: u64 = 100_000;

/// On average.
const CALLS_PER_SEQUENCE: usize = 400;

/// Sequences in which all is made that is made when it is first needed.
const WARMING_UP: u32 = 20;

/// What sequences of hostile calls need of a version of the standard.
trait Hostile: Version {
    /// Functions that lead on from `stage`.
    fn leading_on(stage: Stage) -> &'static [Self::Function];

    /// The folder `resources` as this version names it.
    fn location(folder: &Path) -> String;

    /// Makes an instance of `interface`, which tells `told` what it logs, of a name, a token and a location.
    fn instantiate(rng: &mut Rng, interface: Interface, texts: [*const c_char; 3], told: Option<&Told>) -> C;
}

const SLAVE: Interface = Interface::CoSimulation(Stepping { event_mode: false, early_return: false });

#[test]
fn no_call_of_fmi_2_co_simulation_does_harm() {
    no_call_does_harm::<Fmi2>(|_| SLAVE);
}

#[test]
fn no_call_of_fmi_2_model_exchange_does_harm() {
    no_call_does_harm::<Fmi2>(|_| Interface::ModelExchange);
}

#[test]
fn no_call_of_fmi_3_co_simulation_does_harm() {
    no_call_does_harm::<Fmi3>(|rng| {
        Interface::CoSimulation(Stepping { event_mode: rng.bool(), early_return: rng.bool() })
    });
}

#[test]
fn no_call_of_fmi_3_model_exchange_does_harm() {
    no_call_does_harm::<Fmi3>(|_| Interface::ModelExchange);
}

/// No crash, no panic, no leak, and what [`Sequence::call`] checks of every call.
fn no_call_does_harm<V: Hostile>(interface: fn(&mut Rng) -> Interface) {
    let calls = env::var("FUZZ_CALLS").map_or(CALLS, |calls| calls.parse().expect("FUZZ_CALLS is a number"));
    let resources = host::resources();
    let location = CString::new(V::location(resources.path())).unwrap();
    let records = records(resources.path());
    // what sequences share is no leak: the records, held here
    let archive = Archive::open(resources.path().to_owned()).unwrap();
    let texts = || records.iter().filter_map(|text| text.to_str().ok()).chain([""]);
    let pairs = texts().flat_map(|record| texts().map(move |vertical| (record, vertical)));
    let _held: Vec<_> = pairs.filter_map(|(record, vertical)| archive.ground(record, vertical).ok()).collect();
    let none = vec![false; V::Function::ALL.len()];
    let tally =
        RefCell::new(Tally { done: none.clone(), never: none, met: Default::default(), left: Default::default() });
    let config = Config {
        cases: WARMING_UP + calls.div_ceil(CALLS_PER_SEQUENCE as u64) as u32,
        failure_persistence: None,
        ..Config::default()
    };
    let (mut runner, runs) =
        (TestRunner::new_with_rng(config, TestRng::deterministic_rng(RngAlgorithm::ChaCha)), Cell::new(0));
    let checked = runner.run(&vec(any::<u64>(), 1..2 * CALLS_PER_SEQUENCE), |numbers| {
        let sequence = || Sequence::<V>::new(interface, &location, &records);
        let mut done = Ok(());
        // the counter does not outlive a panic
        let run = AssertUnwindSafe(|| sequence().run(&numbers, &mut tally.borrow_mut()));
        let left = allocation_counter::measure(|| done = catch_unwind(run));
        done.unwrap_or_else(|panic| resume_unwind(panic));
        runs.set(runs.get() + 1);
        let is_left = runs.get() > WARMING_UP && (left.count_current, left.bytes_current) != (0, 0);
        assert!(!is_left, "something is left behind: {left:?}");
        Ok(())
    });
    checked.unwrap_or_else(|failure| panic!("{failure}"));
    let Tally { done, never, met, left } = tally.into_inner();
    if calls >= CALLS {
        assert!(met.iter().filter(|is_met| **is_met).count() >= 6 && met == left, "met {met:?}, left {left:?}");
        for ((function, is_done), is_never) in V::Function::ALL.iter().zip(done).zip(never) {
            assert_ne!(is_done, is_never, "{} was never done", function.name());
        }
    }
}

/// What `record` is set to: files of the archive in `folder` and elsewhere, sound and broken, and what is no file.
fn records(folder: &Path) -> Vec<CString> {
    let write = |name: &str, text: &str| fs::write(folder.join(name), text).unwrap();
    let samples: String =
        (0..300).map(|i| format!("{:.3},{:.3}\n", 0.01 * f64::from(i), f64::from(i * i % 19 - 9))).collect();
    write("quake.csv", &samples);
    write("Quake 2.AT2", "-\n-\nACCELERATION IN UNITS OF G\n4, .005 NPTS, DT\n.1 -.2 .4 1e-3\n");
    write("broken.csv", "0,1\n1,%s%n#\n");
    write("huge.csv", "-1e308,1\n1e308,2\n");
    write("dense.csv", "0,1e-300\n5e-324,1e3\n1e-323,2\n1,-1e4\n");
    fs::create_dir(folder.join("folder.csv")).unwrap();
    let inside = folder.join("quake.csv").display().to_string();
    let mut texts: Vec<_> = [
        "quake.csv",
        "quake.csv",
        "Quake 2.AT2",
        "Quake 2.AT2",
        "broken.csv",
        "huge.csv",
        "dense.csv",
        "folder.csv",
        "absent.csv",
        "",
        ".",
        "..",
        "../quake.csv",
        "/dev/zero",
        "/dev/full",
        "/dev/stdin",
        "/",
        "/etc/passwd",
        "file:///dev/zero",
        "file:",
        "file:///%00.csv",
        &inside,
    ]
    .map(|text| CString::new(text).unwrap())
    .into();
    texts.push(CString::new(format!("file://{inside}")).unwrap());
    texts.push(CString::new(vec![b'a'; 70_000]).unwrap());
    texts
}

/// What came of the calls.
struct Tally {
    /// Which functions were done.
    done: Vec<bool>,
    /// Which are said to be allowed nowhere.
    never: Vec<bool>,
    /// Which stages instances have been in.
    met: [bool; Stage::ALL.len()],
    /// Which stages they have been freed in.
    left: [bool; Stage::ALL.len()],
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
}

/// A run of calls on two instances.
struct Sequence<'a, V: Hostile> {
    rng: Rng,
    interface: fn(&mut Rng) -> Interface,
    location: &'a CStr,
    records: &'a [CString],
    slots: [Slot; 2],
    /// Serialized states of both.
    bytes: Vec<Vec<u8>>,
    version: PhantomData<fn() -> V>,
}

impl<'a, V: Hostile> Sequence<'a, V> {
    fn new(interface: fn(&mut Rng) -> Interface, location: &'a CStr, records: &'a [CString]) -> Self {
        let slot =
            || Slot { c: null_mut(), told: Box::default(), is_heard: false, states: Vec::new(), freed: null_mut() };
        let (rng, slots, bytes) = (Rng::with_seed(0), [slot(), slot()], Vec::new());
        Sequence { rng, interface, location, records, slots, bytes, version: PhantomData }
    }

    fn run(mut self, numbers: &[u64], tally: &mut Tally) {
        for number in numbers {
            self.rng.seed(*number);
            let at = self.rng.usize(..2);
            let is_in_error = self.condition(at).is_some_and(|condition| condition.stage == Stage::Error);
            if self.slots[at].c.is_null() && self.rng.u8(..) > 8 {
                self.instantiate(at);
            } else if self.one_in(if is_in_error { 5 } else { 100 }) {
                self.free(at, tally);
            } else {
                let function = self.function(at, tally);
                self.call_function(at, function, tally);
            }
        }
        (0..2).for_each(|at| self.free(at, tally));
    }

    fn one_in(&mut self, n: u32) -> bool {
        self.rng.u32(..n) == 0
    }

    /// Any function, or one that leads on.
    fn function(&mut self, at: usize, tally: &mut Tally) -> V::Function {
        let stage = self.condition(at).map(|condition| condition.stage);
        stage.iter().for_each(|stage| tally.met[*stage as usize] = true);
        let leading_on = V::leading_on(stage.unwrap_or(Stage::Error));
        let functions = if self.rng.bool() { leading_on } else { V::Function::ALL };
        functions[self.rng.usize(..functions.len())]
    }

    /// A number from anywhere.
    fn number(&mut self) -> f64 {
        const SPECIAL: [f64; 20] = [
            f64::NAN,
            f64::INFINITY,
            f64::NEG_INFINITY,
            0.0,
            -0.0,
            5e-324,
            -5e-324,
            f64::MIN_POSITIVE,
            1e-300,
            -1e-300,
            f64::EPSILON,
            1e-9,
            1.0,
            -1.0,
            1e9,
            -1e9,
            1e300,
            -1e300,
            f64::MAX,
            f64::MIN,
        ];
        match self.rng.u8(..8) {
            0 | 1 => SPECIAL[self.rng.usize(..SPECIAL.len())],
            2 => f64::from_bits(self.rng.u64(..)),
            3 | 4 => 2.0 * self.rng.f64() - 1.0,
            _ => self.sign() * self.between(1e-12, 1e12),
        }
    }

    fn sign(&mut self) -> f64 {
        if self.rng.bool() { 1.0 } else { -1.0 }
    }

    /// Evenly distributed in its logarithm.
    fn between(&mut self, low: f64, high: f64) -> f64 {
        (low.ln() + self.rng.f64() * (high / low).ln()).exp()
    }

    /// A value for the variable `reference`: in its range or on its edge, more often than not.
    fn value(&mut self, reference: c_uint) -> f64 {
        let variable = VARIABLES.get(reference as usize);
        let Some(DataType::Real { range: Some((min, max)), .. }) = variable.map(|v| v.data_type) else {
            return self.number();
        };
        match self.rng.u8(..8) {
            0 => self.number(),
            1 => [min, max][self.rng.usize(..2)],
            2 | 3 if min > 0.0 => self.between(min, max),
            2 | 3 => self.sign() * self.between(1e-6, max),
            _ => match variable.unwrap().name {
                "m" | "m0" | "J0" => self.between(1.0, 1e4),
                "H" => self.between(0.5, 20.0),
                "B" => self.between(0.1, 3.0),
                "f_fc" => self.between(0.5, 50.0),
                "zeta_fc" => self.between(1e-3, 0.3),
                "r" => self.between(0.5, 1.0),
                "g" => 9.81,
                "a_g" => self.sign() * self.between(0.1, 50.0),
                "F_t" => self.sign() * self.between(1.0, 1e4),
                "a_v" => self.sign() * self.between(0.1, 20.0),
                "P_0" | "F_y" | "c_d" => self.between(1.0, 1e4),
                "k_t" | "k_d" => self.between(1e3, 1e7),
                "xi_d" => self.between(0.05, 3.0),
                "record_scale" | "record_time_scale" => self.between(0.1, 3.0),
                _ => self.sign() * self.between(1e-4, 0.5),
            },
        }
    }

    fn reference(&mut self) -> c_uint {
        match self.rng.u8(..24) {
            0 => self.rng.u32(..),
            1 => VARIABLES.len() as c_uint,
            2 => c_uint::MAX,
            _ => self.rng.u32(..VARIABLES.len() as c_uint),
        }
    }

    fn input(&mut self) -> c_uint {
        let is_input = |reference: &c_uint| VARIABLES[*reference as usize].causality == Causality::Input;
        self.rng.choice((0..VARIABLES.len() as c_uint).filter(is_input).collect::<Vec<_>>()).unwrap()
    }

    fn references(&mut self) -> Vec<c_uint> {
        let n = if self.one_in(50) { 1000 } else { self.rng.usize(..5) };
        let mut references: Vec<_> = (0..n).map(|_| self.reference()).collect();
        if self.rng.bool() {
            references.truncate(1);
        }
        references
    }

    /// How many values the host says there are: as many as there are, or more than any call takes.
    fn length(&mut self, n: usize) -> usize {
        if self.one_in(40) { [usize::MAX, 1 << 40, (1 << 24) + 1][self.rng.usize(..3)] } else { n }
    }

    /// A pointer to `values`, or a bad one.
    fn pointer<T>(&mut self, values: &mut [T]) -> *mut T {
        match self.rng.u8(..100) {
            0 => null_mut(),
            1 if align_of::<T>() > 1 => values.as_mut_ptr().wrapping_byte_add(1),
            _ => values.as_mut_ptr(),
        }
    }

    fn choice(&mut self) -> c_int {
        match self.rng.u8(..20) {
            0 => self.rng.i32(..),
            1 => -1,
            2 => 2,
            _ => self.rng.i32(0..2),
        }
    }

    /// How many values there are said to be for `nvr` variables: as many, or another number.
    fn claimed(&mut self, nvr: usize) -> usize {
        if self.one_in(40) { nvr.wrapping_add(1) } else { nvr }
    }

    /// An FMU state of the instance, of the other one, one that is freed, or none at all.
    fn state(&mut self, at: usize) -> *mut c_void {
        let of = if self.one_in(20) { 1 - at } else { at };
        match self.rng.u8(..20) {
            0 => without_provenance_mut(self.rng.usize(..)),
            1 => null_mut(),
            2 => self.slots[of].freed,
            _ => self.rng.choice(&self.slots[of].states).copied().unwrap_or(null_mut()),
        }
    }

    /// Bytes of a state, mostly damaged.
    fn damaged_bytes(&mut self) -> Vec<u8> {
        let Some(mut bytes) = self.rng.choice(&self.bytes).cloned() else {
            return (0..self.rng.usize(..200)).map(|_| self.rng.u8(..)).collect();
        };
        match self.rng.u8(..6) {
            0 => return bytes,
            1 => bytes.truncate(self.rng.usize(..bytes.len())),
            2 => bytes.extend((0..=self.rng.usize(..64)).map(|_| 0)),
            _ => {
                for _ in 0..=self.rng.usize(..4) {
                    let at = self.rng.usize(..bytes.len());
                    bytes[at] ^= 1 << self.rng.u8(..8);
                }
            }
        }
        // A checksum that is right again lets the damage through to what lies behind it.
        if self.rng.bool()
            && let Some((damaged, checksum)) = bytes.split_last_chunk_mut::<16>()
        {
            *checksum = Uuid::new_v5(&Uuid::NAMESPACE_OID, damaged).into_bytes();
        }
        bytes
    }

    fn instantiate(&mut self, at: usize) {
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
        let told = Some(&*self.slots[at].told).filter(|_| is_heard);
        let c = V::instantiate(rng, interface, texts, told);
        let slot = &mut self.slots[at];
        let messages = slot.told.messages.take();
        assert!(messages.len() <= usize::from(c.is_null()), "{messages:?}");
        (slot.c, slot.is_heard) = (c, is_heard);
        slot.told.asked.set((c, 0.0));
        let is_of_kind = self.condition(at).is_none_or(|condition| condition.interface == interface);
        assert!(is_of_kind, "not of the interface {interface:?}");
    }

    /// In whatever state, with the FMU states that it has handed out.
    fn free(&mut self, at: usize, tally: &mut Tally) {
        if let Some(condition) = self.condition(at) {
            tally.left[condition.stage as usize] = true;
        }
        let slot = &mut self.slots[at];
        unsafe { (V::LOOKING.free)(slot.c) };
        slot.c = null_mut();
        slot.states.clear();
        slot.freed = null_mut();
    }

    /// The instance as bytes.
    fn serialized(&self, at: usize) -> Vec<u8> {
        calls::bytes::<V>(self.slots[at].c)
    }

    /// One of the instance's FMU states as bytes.
    fn bytes_of(&self, at: usize, state: C) -> Vec<u8> {
        calls::bytes_of::<V>(self.slots[at].c, state)
    }

    /// Where the instance stands, if there is one. Whatever calls have led to can be read back from its bytes.
    fn condition(&self, at: usize) -> Option<Condition> {
        (!self.slots[at].c.is_null()).then(|| snapshot::deserialize(&self.serialized(at)).unwrap())
    }

    /// Makes `call` and checks what can be said of every call: it returns OK, Discard or Error; it is told to the host
    /// exactly if it does not return OK; if it returns Error, the instance is as it was, unless the solver got stuck.
    fn call(&mut self, at: usize, function: V::Function, tally: &mut Tally, call: impl FnOnce(C) -> c_int) -> c_int {
        let c = self.slots[at].c;
        let before = (!c.is_null() && self.one_in(16)).then(|| self.serialized(at));
        let told = &self.slots[at].told;
        told.messages.take();
        told.call_back.set(if self.rng.u8(..64) == 0 { c } else { null_mut() });
        let status = call(c);
        told.call_back.set(null_mut());

        let messages = told.messages.take();
        let name = function.name();
        assert!([OK, DISCARD, ERROR].contains(&status), "{name}: {status} {messages:?}");
        let number = V::Function::ALL.iter().position(|one| *one == function).unwrap();
        tally.done[number] |= status != ERROR;
        let failures: Vec<_> = messages.iter().filter(|(status, _)| *status > 1).collect();
        let is_told = status != OK && !c.is_null() && self.slots[at].is_heard;
        assert_eq!(failures.len(), usize::from(is_told), "{messages:?}");
        for (told_status, text) in &failures {
            assert_eq!(*told_status, status);
            assert!(text.starts_with(&format!("{name}: ")), "{text}");
            tally.never[number] |= text.ends_with("allowed in: none");
        }
        // of one that is not heard it is not known
        let is_stuck = !is_told || failures.iter().any(|(_, text)| text.contains("cannot be continued"));
        if let Some(before) = before
            && status == ERROR
            && !is_stuck
        {
            assert!(self.serialized(at) == before, "the refused {name} changed something: {failures:?}");
        }
        status
    }

    /// Calls `function` with arguments of its kind.
    fn call_function(&mut self, at: usize, function: V::Function, tally: &mut Tally) {
        let (name, mut made) = (function.name(), None);
        let mut references = self.references();
        match V::call(function) {
            Call::Plain(call) => _ = self.call(at, function, tally, call),
            Call::SetDebugLogging(call) => {
                let categories = [c"logEvents", c"logStatusError", c"nonsense", c"\xff%n"];
                let mut names: Vec<_> =
                    (0..self.rng.usize(..4)).map(|_| categories[self.rng.usize(..4)].as_ptr()).collect();
                if self.one_in(20) {
                    names.push(null());
                }
                let (count, names, on) = (self.length(names.len()), self.pointer(&mut names), self.choice());
                self.call(at, function, tally, |c| call(c, on, count, names));
            }
            Call::SetUp(call) => {
                let (has_tolerance, has_stop) = (self.choice(), self.choice());
                let tolerance = if self.one_in(4) { self.number() } else { self.between(1e-14, 0.1) };
                let start = if self.one_in(4) { self.number() } else { self.rng.f64() };
                let stop = if self.one_in(4) { self.number() } else { start + self.between(1.0, 1e6) };
                self.call(at, function, tally, |c| call(c, has_tolerance, tolerance, start, has_stop, stop));
            }
            // values are finite, or left alone; what nobody watches for is not a number, and friction may be infinite
            Call::GetReals(call) => {
                let mut values = vec![f64::NEG_INFINITY; references.len()];
                let nvr = self.length(references.len());
                let (n, vr, value) = (self.claimed(nvr), self.pointer(&mut references), self.pointer(&mut values));
                let status = self.call(at, function, tally, |c| call(c, vr, nvr, value, n));
                let is_right = |(reference, value): (&u32, &f64)| match status {
                    OK => value.is_finite() || is_watched(*reference, *value),
                    _ => *value == f64::NEG_INFINITY,
                };
                assert!(references.iter().zip(&values).all(is_right), "{name} {references:?} {status} {values:?}");
            }
            Call::GetRates(call) => {
                let (mut values, mut orders) =
                    (vec![f64::NEG_INFINITY; references.len()], self.orders(references.len()));
                let nvr = self.length(references.len());
                let (vr, order, value) =
                    (self.pointer(&mut references), self.pointer(&mut orders), self.pointer(&mut values));
                let status = self.call(at, function, tally, |c| call(c, vr, nvr, order, value, nvr));
                assert!(are_written(status, &values), "{name} {references:?} {status} {values:?}");
            }
            Call::SetReals(call) => {
                let mut values = self.reals_to_set(at, &mut references);
                let nvr = self.length(references.len());
                let (n, vr, value) = (self.claimed(nvr), self.pointer(&mut references), self.pointer(&mut values));
                self.call(at, function, tally, |c| call(c, vr, nvr, value, n));
            }
            Call::SetSlopes(call) => {
                let mut values = self.reals_to_set(at, &mut references);
                let (mut orders, nvr) = (self.orders(references.len()), self.length(references.len()));
                let (vr, order, value) =
                    (self.pointer(&mut references), self.pointer(&mut orders), self.pointer(&mut values));
                self.call(at, function, tally, |c| call(c, vr, nvr, order, value));
            }
            // values are small, or left alone
            Call::GetDiscrete(size, call) => {
                let mut values = vec![UNWRITTEN; references.len()];
                let (nvr, vr) = (self.length(references.len()), self.pointer(&mut references));
                let value = self.place(&mut values);
                let status = self.call(at, function, tally, |c| call(c, vr, nvr, value, nvr));
                let written = written(&values, size);
                assert!(
                    written.iter().take(references.len()).all(|value| value.is_some() == (status == OK)),
                    "{name} {references:?} {status} {written:?}"
                );
            }
            Call::SetDiscrete(names, size, call) => {
                if self.rng.bool() {
                    references = vec![host::reference(names[self.rng.usize(..names.len())])];
                }
                let most = if names == ["detail"] { 8 } else { 3 };
                let odd = self.one_in(16).then(|| self.rng.i64(..));
                let mut bytes = Vec::new();
                for _ in &references {
                    let value = odd.unwrap_or_else(|| self.rng.i64(0..most));
                    bytes.extend(&value.to_le_bytes()[..size]); // of a number of so many bytes, small or cut
                }
                bytes.resize(bytes.len().next_multiple_of(8), 0);
                let words = bytes.chunks_exact(8).map(|word| u64::from_le_bytes(word.try_into().unwrap()));
                let mut values: Vec<_> = words.collect();
                let (nvr, vr) = (self.length(references.len()), self.pointer(&mut references));
                let value = self.place(&mut values);
                self.call(at, function, tally, |c| call(c, vr, nvr, value, nvr));
            }
            Call::GetStrings(call) => {
                let mut texts = vec![null(); references.len()];
                if self.rng.bool() {
                    (references, texts) = (vec![host::reference("record")], vec![null()]);
                }
                let (nvr, vr, text) =
                    (self.length(texts.len()), self.pointer(&mut references), self.pointer(&mut texts));
                let status = self.call(at, function, tally, |c| call(c, vr, nvr, text, nvr));
                assert!(texts.iter().all(|text| text.is_null() == (status != OK)), "{references:?} {status} {texts:?}");
            }
            // names and paths, or any bytes
            Call::SetStrings(call) => {
                if self.rng.bool() {
                    references = vec![host::reference(if self.rng.bool() { "record" } else { "record_v" })];
                }
                let garbage: Vec<u8> = (0..self.rng.usize(..40)).map(|_| self.rng.u8(1..)).collect();
                let garbage = CString::new(garbage).unwrap();
                let mut texts: Vec<_> = references
                    .iter()
                    .map(|_| match self.rng.u8(..40) {
                        0 => null(),
                        1..4 => garbage.as_ptr(),
                        4..20 => self.records[self.rng.usize(..4)].as_ptr(),
                        _ => self.records[self.rng.usize(..self.records.len())].as_ptr(),
                    })
                    .collect();
                let (nvr, vr, text) =
                    (self.length(texts.len()), self.pointer(&mut references), self.pointer(&mut texts));
                self.call(at, function, tally, |c| call(c, vr, nvr, text, nvr));
            }
            Call::Directional(call) => self.get_derivatives(at, function, tally, references, call, false),
            Call::Adjoint(call) => self.get_derivatives(at, function, tally, references, call, true),
            Call::GetState(call) => {
                let mut state = if self.rng.bool() { null_mut() } else { self.state(at) };
                let is_new = state.is_null();
                let place = self.pointer(slice::from_mut(&mut state));
                let status = self.call(at, function, tally, |c| unsafe { call(c, place) });
                made = Some(state).filter(|_| status == OK && is_new);
            }
            // the instance is then what the state was
            Call::SetState(call) => {
                let state = self.state(at);
                if self.call(at, function, tally, |c| unsafe { call(c, state) }) == OK {
                    assert!(self.serialized(at) == self.bytes_of(at, state));
                }
            }
            Call::FreeState(call) => {
                let mut state = self.state(at);
                let freed = state;
                let place = self.pointer(slice::from_mut(&mut state));
                let status = self.call(at, function, tally, |c| unsafe { call(c, place) });
                if status == OK && !place.is_null() {
                    assert!(state.is_null());
                    self.slots[at].states.retain(|state| *state != freed);
                    self.slots[at].freed = freed;
                }
            }
            Call::StateSize(call) => {
                let (state, mut size) = (self.state(at), 0);
                let place = self.pointer(slice::from_mut(&mut size));
                self.call(at, function, tally, |c| unsafe { call(c, state, place) });
            }
            // into a buffer of the right size, or another
            Call::Serialize(call) => {
                let state = self.state(at);
                let right = if self.slots[at].states.contains(&state) { self.bytes_of(at, state).len() } else { 0 };
                let mut bytes = vec![0; if self.one_in(8) { self.rng.usize(..400) } else { right }];
                let (size, place) = (self.length(bytes.len()), self.pointer(&mut bytes));
                if self.call(at, function, tally, |c| unsafe { call(c, state, place, size) }) == OK {
                    self.bytes.truncate(7);
                    self.bytes.insert(0, bytes);
                }
            }
            Call::Deserialize(call) => {
                let mut bytes = self.damaged_bytes();
                let is_whole = self.bytes.contains(&bytes);
                let mut state = if self.rng.bool() { null_mut() } else { self.state(at) };
                let is_new = state.is_null();
                let (size, from) = (self.length(bytes.len()), self.pointer(&mut bytes));
                let place = self.pointer(slice::from_mut(&mut state));
                if self.call(at, function, tally, |c| unsafe { call(c, from, size, place) }) == OK {
                    assert!(!is_whole || self.bytes_of(at, state) == bytes);
                    made = Some(state).filter(|_| is_new);
                }
            }
            Call::DoStep(call) => self.do_step(at, function, tally, call),
            Call::Status(call) => {
                let kind = if self.one_in(8) { self.rng.i32(..) } else { self.rng.i32(0..4) };
                let mut value = [UNWRITTEN];
                let place = self.place(&mut value);
                self.call(at, function, tally, |c| call(c, kind, place));
            }
            // on by some milliseconds, or anywhere
            Call::SetTime(call) => {
                let outside = self.condition(at).and_then(|condition| condition.course?.outside);
                let now = outside.map_or(0.0, |outside| outside.known.motion.time);
                // a check over a long time takes as much work as a thousand others
                let time = match self.rng.u16(..4000) {
                    0..8 => self.number(),
                    8..200 => now + self.between(0.1, 10.0),
                    200..400 => now - self.between(1e-6, 0.1),
                    _ => now + self.between(1e-6, 0.1),
                };
                self.call(at, function, tally, |c| unsafe { call(c, time) });
            }
            // small, large, or no numbers
            Call::SetStates(call) => {
                let n = if self.one_in(20) { self.rng.usize(..9) } else { 4 };
                let mut states: Vec<_> = (0..n)
                    .map(|_| if self.one_in(20) { self.number() } else { self.sign() * self.between(1e-9, 2.0) })
                    .collect();
                let (nx, x) = (self.length(n), self.pointer(&mut states));
                self.call(at, function, tally, |c| unsafe { call(c, x, nx) });
            }
            Call::GetNumbers(right, call) => {
                let n = if self.one_in(20) { self.rng.usize(..9) } else { right };
                let mut values = vec![f64::NEG_INFINITY; n];
                let (length, place) = (self.length(n), self.pointer(&mut values));
                let status = self.call(at, function, tally, |c| unsafe { call(c, place, length) });
                assert!(are_written(status, &values), "{name} {status} {values:?}");
            }
            Call::Count(right, call) => {
                let mut count = usize::MAX;
                let place = self.pointer(slice::from_mut(&mut count));
                let status = self.call(at, function, tally, |c| unsafe { call(c, place) });
                assert_eq!(count, if status == OK { right } else { usize::MAX });
            }
            // the work of a check is bounded as that of a step
            Call::CompleteStep(size, call) => {
                let (mut event, mut end, flag) = ([UNWRITTEN], [UNWRITTEN], self.choice());
                let (to_event, to_end) = (self.place(&mut event), self.place(&mut end));
                let status = self.call(at, function, tally, |c| call(c, flag, to_event, to_end));
                let is_right =
                    |value: Option<i64>| if status == OK { matches!(value, Some(0 | 1)) } else { value.is_none() };
                assert!(is_right(written(&event, size)[0]) && is_right(written(&end, size)[0]), "{event:?} {end:?}");
            }
            // what follows an event is above the floor: no indicator is 0, and all are positive until the host moves on
            Call::Update(call) => {
                let spoilt = self.one_in(30).then(|| self.rng.usize(..6));
                let status = self.call(at, function, tally, |c| call(c, spoilt));
                if status == OK && self.condition(at).is_some_and(|of| of.interface == Interface::ModelExchange) {
                    let mut indicators = [0.0; 2];
                    let c = self.slots[at].c;
                    assert_eq!(unsafe { (V::LOOKING.event_indicators)(c, indicators.as_mut_ptr(), 2) }, OK);
                    assert!(indicators.iter().all(|indicator| *indicator > 0.0), "{indicators:?}");
                }
            }
        }
        made.into_iter().for_each(|state| self.keep(at, state));
    }

    fn orders(&mut self, n: usize) -> Vec<c_int> {
        (0..n).map(|_| if self.one_in(20) { self.rng.i32(..) } else { 1 }).collect()
    }

    /// Room for Booleans or integers, or a bad pointer.
    fn place(&mut self, values: &mut [u64]) -> *mut c_void {
        match self.rng.u8(..100) {
            0 => null_mut(),
            _ => values.as_mut_ptr().cast(),
        }
    }

    /// Values for `references`, or for others.
    fn reals_to_set(&mut self, at: usize, references: &mut Vec<c_uint>) -> Vec<f64> {
        if self.rng.bool() {
            *references = vec![self.input()];
        }
        if self.one_in(8) && self.condition(at).is_some_and(|condition| condition.stage == Stage::ContinuousTimeMode) {
            *references = vec![host::reference(["u", "u_dot", "theta", "theta_dot"][self.rng.usize(..4)])];
        }
        if self.one_in(40) {
            // the top mass above the pivot of a foundation without inertia: no step can be made
            *references = ["m0", "J0", "B", "theta_0", "u_0"].map(host::reference).into();
            return vec![0.0, 0.0, 0.3, 0.1, 0.3];
        }
        references.iter().map(|reference| self.value(*reference)).collect()
    }

    /// Values are finite, or left alone.
    fn get_derivatives(
        &mut self,
        at: usize,
        function: V::Function,
        tally: &mut Tally,
        mut unknowns: Vec<c_uint>,
        call: fn(C, [*const c_uint; 2], [usize; 2], *const f64, *mut f64) -> c_int,
        is_adjoint: bool,
    ) {
        if self.rng.bool() {
            unknowns = ["a_t", "R_v", "der(theta_dot)"].map(host::reference).into();
        }
        let mut knowns = if self.one_in(4) { self.references() } else { vec![self.input()] };
        let (from, to) = if is_adjoint { (&unknowns, &knowns) } else { (&knowns, &unknowns) };
        let (n_from, mut values) = (from.len(), vec![f64::NEG_INFINITY; to.len()]);
        let mut seed: Vec<_> = (0..n_from).map(|_| self.number()).collect();
        let n = [self.length(unknowns.len()), self.length(knowns.len())];
        let of = [self.pointer(&mut unknowns).cast_const(), self.pointer(&mut knowns).cast_const()];
        let (seed, value) = (self.pointer(&mut seed), self.pointer(&mut values));
        let status = self.call(at, function, tally, |c| call(c, of, n, seed, value));
        // sums of what is finite may be too large
        let is_right = are_written(status, &values) || is_adjoint && status == OK;
        assert!(is_right, "{unknowns:?} by {knowns:?}: {status} {values:?}");
    }

    fn keep(&mut self, at: usize, state: C) {
        let slot = &mut self.slots[at];
        assert!(!state.is_null() && !slot.states.contains(&state));
        if slot.states.len() == 8 {
            let mut oldest = slot.states.remove(0);
            assert_eq!(unsafe { (V::LOOKING.free_state)(slot.c, &mut oldest) }, OK);
        }
        slot.states.push(state);
    }

    /// Mostly from where the instance is, mostly over some ten milliseconds. The work is bounded.
    fn do_step(
        &mut self,
        at: usize,
        function: V::Function,
        tally: &mut Tally,
        call: fn(C, f64, f64, c_int, [*mut u8; 3], *mut f64) -> c_int,
    ) {
        let motion = |sequence: &Self| sequence.condition(at)?.course.map(|course| course.motion);
        let before = motion(self);
        let mut point = before.map_or(0.0, |motion| motion.time);
        if self.one_in(16) {
            point += self.number();
        }
        // a long one takes as much work as a thousand others
        let step = match self.rng.u16(..4000) {
            0 => 1e9,
            1..40 => self.number(),
            // over a record
            120..200 => self.between(0.1, 10.0),
            40..120 => 1e-300,
            _ => self.between(1e-4, 0.1),
        };
        let (go_back, mut flags, mut reached) = (self.choice(), [0; 3], f64::NAN);
        let mut pointers = flags.each_mut().map(|flag| &raw mut *flag);
        if self.one_in(40) {
            pointers[self.rng.usize(..3)] = null_mut();
        }
        let reached = self.pointer(slice::from_mut(&mut reached));
        let asked = self.value(host::reference("a_g"));
        self.slots[at].told.asked.set((self.slots[at].c, asked));
        let status = self.call(at, function, tally, |c| call(c, point, step, go_back, pointers, reached));
        if let (Some(before), Some(after)) = (before, motion(self)) {
            // the host's clock is right, in which the structure may overturn, or be due for a transition, before the
            // end of the last step
            let is_complete = status == OK && flags == [0; 3];
            let is_on = if is_complete { after.time > before.time } else { after.time >= before.time.min(point) };
            assert!(is_on, "from {} to {}", before.time, after.time);
            let steps = after.work.steps - before.work.steps;
            assert!(steps <= MAX_STEPS_PER_ADVANCE, "{steps} steps");
            assert!(after.work.evaluations - before.work.evaluations <= steps * MAX_ORDER as u64);
        }
    }
}

/// What a place of eight bytes holds until something is written there.
const UNWRITTEN: u64 = 0x8080_8080_8080_8080;

/// What has been written to `places` as numbers of `size` bytes, where something has.
fn written(places: &[u64], size: usize) -> Vec<Option<i64>> {
    let bytes: Vec<_> = places.iter().flat_map(|place| place.to_le_bytes()).collect();
    let number = |bytes: &[u8]| {
        let is_negative = bytes.last().is_some_and(|last| *last >= 0x80);
        let sum = bytes.iter().rev().fold(0, |sum, byte| sum << 8 | i64::from(*byte));
        Some(sum).filter(|_| !is_negative)
    };
    bytes.chunks_exact(size).map(number).collect()
}

/// Whether `values` are finite, or left alone by a call that has been refused.
fn are_written(status: c_int, values: &[f64]) -> bool {
    values.iter().all(|value| if status == OK { value.is_finite() } else { *value == f64::NEG_INFINITY })
}

/// Whether `value` is that of a variable for which somebody has to watch, and nobody does, or of a friction that is
/// infinite.
fn is_watched(reference: u32, value: f64) -> bool {
    VARIABLES.get(reference as usize).is_some_and(|variable| {
        let is_worst = ASSUMPTIONS.iter().any(|of| [of.name, of.time_name].contains(&variable.name));
        is_worst && value > 0.0 || value.is_nan() && (is_worst || variable.name.ends_with("_max"))
    })
}
