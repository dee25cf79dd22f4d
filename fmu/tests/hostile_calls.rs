//! Hostile calls: random functions in any order, with arguments from sensible to absurd.
//!
//! `FUZZ_CALLS` says how many calls to make (`make fuzz`: ten million). Calls come in sequences of a few hundred on two
//! instances; what a sequence does follows from its number alone, and a failure names it.
#![allow(unsafe_code)]

mod host;

use FlexibleRocking::c_abi::Function as _;
use FlexibleRocking::fmi2::*;
use FlexibleRocking::snapshot;
use FlexibleRocking::state_machine::Stage;
use FlexibleRocking::variables::{Causality, DataType, VARIABLES};
use fastrand::Rng;
use host::{DISCARD, ERROR, OK};
use libc::{c_char, c_int, c_uint, c_void};
use rocking::Parameters;
use rocking::engine::MAX_STEPS_PER_ADVANCE;
use rocking::motion::Work;
use rocking::run::validity::ASSUMPTIONS;
use rocking::taylor::MAX_ORDER;
use std::cell::{Cell, RefCell};
use std::ffi::{CStr, CString};
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::path::Path;
use std::ptr::{null, null_mut, without_provenance_mut};
use std::sync::atomic::{AtomicU64, Ordering};
use std::time::{Duration, Instant};
use std::{env, fmt, fs, slice, thread};
use uuid::Uuid;

/// Calls without `FUZZ_CALLS`.
const CALLS: u64 = 200_000;

const CALLS_PER_SEQUENCE: u64 = 400;

/// No crash, no panic, no leak, and what [`Sequence::call`] checks of every call.
#[test]
fn no_call_does_harm() {
    let calls = env::var("FUZZ_CALLS").map_or(CALLS, |calls| calls.parse().expect("FUZZ_CALLS is a number"));
    let resources = host::resources();
    let location = CString::new(format!("file://{}", resources.path().display())).unwrap();
    let records = records(resources.path());
    (0..20).for_each(|number| _ = Sequence::new(number, &location, &records).run()); // what a process keeps is no leak
    let sequences = AtomicU64::new(0);
    let work = || {
        let mut tally = Tally::default();
        loop {
            let number = sequences.fetch_add(1, Ordering::Relaxed);
            if number * CALLS_PER_SEQUENCE >= calls {
                return tally;
            }
            let run = || {
                let mut of_sequence = Tally::default();
                let left =
                    allocation_counter::measure(|| of_sequence = Sequence::new(number, &location, &records).run());
                assert_eq!((left.count_current, left.bytes_current), (0, 0), "something is left behind");
                of_sequence
            };
            match catch_unwind(AssertUnwindSafe(run)) {
                Ok(of_sequence) => tally.add(&of_sequence),
                Err(panic) => {
                    sequences.store(calls, Ordering::Relaxed);
                    eprintln!("in sequence {number}");
                    resume_unwind(panic)
                }
            }
        }
    };
    let mut tally = Tally::default();
    thread::scope(|scope| {
        let threads = thread::available_parallelism().unwrap().get();
        let threads: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        threads.into_iter().for_each(|thread| tally.add(&thread.join().unwrap_or_else(|panic| resume_unwind(panic))));
    });
    println!("{tally}");
    assert!(tally.calls() >= calls);
    let freed_in = tally.freed_in;
    // an update within a step is FMI 3.0's
    let is_met = |(stage, count): (Stage, u64)| stage == Stage::IntermediateUpdateMode || count > 0;
    let is_freed_in_all = Stage::ALL.into_iter().zip(freed_in).all(is_met);
    assert!(calls < CALLS || is_freed_in_all, "freed in {:?}: {freed_in:?}", Stage::ALL);
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

/// What came of the calls: OK, Discard and Error of every function.
struct Tally {
    statuses: [[u64; 3]; Function::ALL.len()],
    instances: u64,
    refused_instances: u64,
    /// Instances freed, by stage.
    freed_in: [u64; Stage::ALL.len()],
    /// Most steps of the solver in one call.
    most_steps: u64,
    longest: Duration,
    longest_function: &'static str,
}

impl Default for Tally {
    fn default() -> Tally {
        Tally {
            statuses: [[0; 3]; Function::ALL.len()],
            instances: 0,
            refused_instances: 0,
            freed_in: [0; Stage::ALL.len()],
            most_steps: 0,
            longest: Duration::ZERO,
            longest_function: "",
        }
    }
}

impl Tally {
    fn calls(&self) -> u64 {
        self.statuses.iter().flatten().sum::<u64>() + 2 * self.instances + self.refused_instances
    }

    fn add(&mut self, other: &Tally) {
        for (sum, more) in self.statuses.iter_mut().flatten().zip(other.statuses.iter().flatten()) {
            *sum += more;
        }
        for (sum, more) in self.freed_in.iter_mut().zip(other.freed_in) {
            *sum += more;
        }
        self.most_steps = self.most_steps.max(other.most_steps);
        self.instances += other.instances;
        self.refused_instances += other.refused_instances;
        if other.longest > self.longest {
            (self.longest, self.longest_function) = (other.longest, other.longest_function);
        }
    }
}

impl fmt::Display for Tally {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{} calls on {} instances ({} refused)", self.calls(), self.instances, self.refused_instances)?;
        writeln!(f, "{:28}{:>12}{:>12}{:>12}", "", "OK", "Discard", "Error")?;
        for (function, [ok, discard, error]) in Function::ALL.iter().zip(self.statuses) {
            writeln!(f, "{:28}{ok:12}{discard:12}{error:12}", function.name())?;
        }
        writeln!(f, "most steps in one call: {} of {MAX_STEPS_PER_ADVANCE}", self.most_steps)?;
        write!(f, "longest call: {:?}, {}", self.longest, self.longest_function)
    }
}

/// Where an instance logs to.
#[derive(Default)]
struct Told {
    messages: RefCell<Vec<(c_int, String)>>,
    /// Called from within the logger, unless null.
    call_back: Cell<*mut c_void>,
}

unsafe extern "C" fn tell(
    environment: *mut c_void,
    _: *const c_char,
    status: c_int,
    _: *const c_char,
    text: *const c_char,
) {
    let told = unsafe { &*environment.cast::<Told>() };
    let text = unsafe { CStr::from_ptr(text) }.to_str().unwrap();
    // not the events, of which one call may have two million
    if status != OK {
        told.messages.borrow_mut().push((status, text.to_owned()));
    }
    let c = told.call_back.get();
    if !c.is_null() {
        unsafe {
            fmi2FreeInstance(c);
            assert_eq!((fmi2DoStep(c, 0.0, 1.0, 0), fmi2Reset(c)), (ERROR, ERROR));
        }
    }
}

/// Room for one instance.
struct Slot {
    /// Null if there is none.
    c: *mut c_void,
    told: Box<Told>,
    /// The FMU states that it has handed out.
    states: Vec<*mut c_void>,
    /// One that it has handed out and freed.
    freed: *mut c_void,
}

/// A run of calls on two instances.
struct Sequence<'a> {
    rng: Rng,
    location: &'a CStr,
    records: &'a [CString],
    slots: [Slot; 2],
    /// Serialized states of both.
    bytes: Vec<Vec<u8>>,
    tally: Tally,
}

impl<'a> Sequence<'a> {
    fn new(number: u64, location: &'a CStr, records: &'a [CString]) -> Sequence<'a> {
        let slot = || Slot { c: null_mut(), told: Box::default(), states: Vec::new(), freed: null_mut() };
        Sequence {
            rng: Rng::with_seed(number),
            location,
            records,
            slots: [slot(), slot()],
            bytes: Vec::new(),
            tally: Tally::default(),
        }
    }

    fn run(mut self) -> Tally {
        for _ in 0..CALLS_PER_SEQUENCE {
            let at = self.rng.usize(..2);
            if self.slots[at].c.is_null() && self.rng.u8(..) > 8 {
                self.instantiate(at);
            } else if self.one_in(100) {
                self.free(at);
            } else {
                let function = self.function(at);
                self.call_function(at, function);
            }
        }
        (0..2).for_each(|at| self.free(at));
        self.tally
    }

    fn one_in(&mut self, n: u32) -> bool {
        self.rng.u32(..n) == 0
    }

    /// Any function, or one that leads on.
    fn function(&mut self, at: usize) -> Function {
        use Function::*;
        let leading_on: &[Function] = match self.stage(at) {
            Stage::Instantiated => {
                &[SetReal, SetReal, SetInteger, SetBoolean, SetString, SetupExperiment, EnterInitializationMode]
            }
            Stage::InitializationMode => &[SetReal, GetReal, ExitInitializationMode, ExitInitializationMode],
            Stage::StepComplete => {
                &[SetReal, SetRealInputDerivatives, DoStep, DoStep, GetReal, GetRealOutputDerivatives]
            }
            Stage::EventMode => &[SetReal, NewDiscreteStates, NewDiscreteStates, EnterContinuousTimeMode, GetReal],
            Stage::ContinuousTimeMode => &[
                SetTime,
                SetTime,
                SetContinuousStates,
                GetDerivatives,
                CompletedIntegratorStep,
                CompletedIntegratorStep,
                SetReal,
                EnterEventMode,
            ],
            Stage::IntermediateUpdateMode | Stage::StepFailed | Stage::Terminated | Stage::Error => {
                &[Reset, SetFMUstate, GetReal]
            }
        };
        let functions = if self.rng.bool() { leading_on } else { Function::ALL };
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
        let told = &self.slots[at].told;
        let mut functions = host::callbacks((&raw const **told).cast_mut().cast());
        let logger: unsafe extern "C" fn(_, _, _, _, _) = tell;
        functions.logger = (!wrong(rng)).then(|| unsafe { std::mem::transmute(logger as *const ()) });
        let functions = if wrong(rng) { null() } else { &raw const functions };
        let (kind, logging_on) = (if wrong(rng) { self.choice() } else { c_int::from(rng.bool()) }, self.choice());
        let c = unsafe { fmi2Instantiate(texts[0], kind, texts[1], texts[2], functions, 0, logging_on) };
        let slot = &mut self.slots[at];
        let messages = slot.told.messages.take();
        assert!(messages.len() <= usize::from(c.is_null()), "{messages:?}");
        slot.c = c;
        *if c.is_null() { &mut self.tally.refused_instances } else { &mut self.tally.instances } += 1;
    }

    /// In whatever state, with the FMU states that it has handed out.
    fn free(&mut self, at: usize) {
        if let Some(stage) = self.told_stage(at) {
            self.tally.freed_in[stage as usize] += 1;
        }
        let slot = &mut self.slots[at];
        unsafe { fmi2FreeInstance(slot.c) };
        slot.c = null_mut();
        slot.states.clear();
        slot.freed = null_mut();
    }

    /// The instance as bytes.
    fn serialized(&self, at: usize) -> Vec<u8> {
        let c = self.slots[at].c;
        let mut state = null_mut();
        assert_eq!(unsafe { fmi2GetFMUstate(c, &mut state) }, OK);
        let bytes = self.bytes_of(at, state);
        assert_eq!(unsafe { fmi2FreeFMUstate(c, &mut state) }, OK);
        bytes
    }

    /// One of the instance's FMU states as bytes.
    fn bytes_of(&self, at: usize, state: *mut c_void) -> Vec<u8> {
        let c = self.slots[at].c;
        let mut size = 0;
        unsafe {
            assert_eq!(fmi2SerializedFMUstateSize(c, state, &mut size), OK);
            let mut bytes = vec![0; size];
            assert_eq!(fmi2SerializeFMUstate(c, state, bytes.as_mut_ptr(), size), OK);
            bytes
        }
    }

    /// The solver's work since the start. Whatever calls have led to can be read back from its bytes.
    fn work(&self, at: usize) -> Work {
        let condition = snapshot::deserialize(&self.serialized(at)).unwrap();
        condition.course.map_or_else(Work::default, |course| course.motion.work)
    }

    /// The stage. That of a null or silent instance is of no interest.
    fn stage(&self, at: usize) -> Stage {
        self.told_stage(at).unwrap_or(Stage::Error)
    }

    /// The stage, as the refusal of a function that is never allowed tells it.
    fn told_stage(&self, at: usize) -> Option<Stage> {
        let slot = &self.slots[at];
        assert_eq!(unsafe { fmi2CancelStep(slot.c) }, ERROR);
        let messages = slot.told.messages.take();
        let is_told = |stage: &Stage| messages.iter().any(|(_, text)| text.contains(&format!("\"{stage}\"")));
        Stage::ALL.into_iter().find(is_told)
    }

    /// Where the instance is in time, if it can be asked.
    fn time(&self, at: usize) -> Option<f64> {
        let slot = &self.slots[at];
        let mut time = 0.0;
        let status = unsafe { fmi2GetRealStatus(slot.c, 2, &mut time) };
        slot.told.messages.take();
        (status == OK).then_some(time)
    }

    /// Makes `call` and checks what can be said of every call: it returns OK, Discard or Error; it is told to the host
    /// exactly if it does not return OK; if it returns Error, the instance is as it was, unless the solver got stuck.
    fn call(&mut self, at: usize, function: Function, call: impl FnOnce(*mut c_void) -> c_int) -> c_int {
        let c = self.slots[at].c;
        let before = (!c.is_null() && self.one_in(16)).then(|| self.serialized(at));
        let told = &self.slots[at].told;
        told.messages.take();
        told.call_back.set(if self.rng.u8(..64) == 0 { c } else { null_mut() });
        let begin = Instant::now();
        let status = call(c);
        let duration = begin.elapsed();
        told.call_back.set(null_mut());

        let messages = told.messages.take();
        let name = function.name();
        let column = [OK, DISCARD, ERROR].iter().position(|column| *column == status);
        let column = column.unwrap_or_else(|| panic!("{name}: {status} {messages:?}"));
        self.tally.statuses[function as usize][column] += 1;
        if duration > self.tally.longest {
            (self.tally.longest, self.tally.longest_function) = (duration, name);
        }
        let failures: Vec<_> = messages.iter().filter(|(status, _)| *status > 1).collect();
        assert!(failures.len() <= usize::from(status != OK), "{messages:?}");
        for (told_status, text) in &failures {
            assert_eq!(*told_status, status);
            assert!(text.starts_with(&format!("{name}: ")), "{text}");
        }
        let is_stuck = failures.iter().any(|(_, text)| text.contains("cannot be continued"));
        if let Some(before) = before
            && status == ERROR
            && !is_stuck
        {
            assert!(self.serialized(at) == before, "the refused {name} changed something: {failures:?}");
        }
        status
    }

    /// Calls `function` with arguments of its kind.
    fn call_function(&mut self, at: usize, function: Function) {
        use Function::*;
        match function {
            SetDebugLogging => self.set_debug_logging(at),
            SetupExperiment => self.setup_experiment(at),
            EnterInitializationMode => _ = self.call(at, function, |c| unsafe { fmi2EnterInitializationMode(c) }),
            ExitInitializationMode => _ = self.call(at, function, |c| unsafe { fmi2ExitInitializationMode(c) }),
            Terminate => _ = self.call(at, function, |c| unsafe { fmi2Terminate(c) }),
            Reset => _ = self.call(at, function, |c| unsafe { fmi2Reset(c) }),
            GetReal | GetRealOutputDerivatives => self.get_reals(at, function),
            GetInteger | GetBoolean => self.get_discrete(at, function),
            SetReal | SetRealInputDerivatives => self.set_reals(at, function),
            SetInteger | SetBoolean => self.set_integers(at, function),
            GetString | SetString => self.pass_strings(at, function),
            GetDirectionalDerivative => self.get_directional_derivative(at),
            GetFMUstate => self.get_state(at),
            SetFMUstate => self.set_state(at),
            FreeFMUstate => self.free_state(at),
            SerializedFMUstateSize | SerializeFMUstate => self.serialize(at, function),
            DeSerializeFMUstate => self.deserialize(at),
            DoStep => self.do_step(at),
            CancelStep => _ = self.call(at, function, |c| unsafe { fmi2CancelStep(c) }),
            GetStatus | GetRealStatus | GetIntegerStatus | GetBooleanStatus | GetStringStatus => {
                self.status(at, function)
            }
            EnterEventMode => _ = self.call(at, function, |c| unsafe { fmi2EnterEventMode(c) }),
            EnterContinuousTimeMode => _ = self.call(at, function, |c| unsafe { fmi2EnterContinuousTimeMode(c) }),
            NewDiscreteStates => self.new_discrete_states(at),
            CompletedIntegratorStep => self.complete_integrator_step(at),
            SetTime => self.set_time(at),
            SetContinuousStates => self.set_continuous_states(at),
            GetDerivatives | GetEventIndicators | GetContinuousStates | GetNominalsOfContinuousStates => {
                self.get_of_states(at, function)
            }
        }
    }

    /// On by some milliseconds, or anywhere.
    fn set_time(&mut self, at: usize) {
        let now = self.known_time(at);
        // a check over a long time takes as much work as a thousand others
        let time = match self.rng.u16(..4000) {
            0..8 => self.number(),
            8..200 => now + self.between(0.1, 10.0),
            200..400 => now - self.between(1e-6, 0.1),
            _ => now + self.between(1e-6, 0.1),
        };
        self.call(at, Function::SetTime, |c| unsafe { fmi2SetTime(c, time) });
    }

    /// Where the instance knows the motion to be, in time.
    fn known_time(&self, at: usize) -> f64 {
        if self.slots[at].c.is_null() {
            return 0.0;
        }
        let condition = snapshot::deserialize(&self.serialized(at)).unwrap();
        condition.course.and_then(|course| course.outside).map_or(0.0, |outside| outside.known.motion.time)
    }

    /// Small, large, or no numbers.
    fn set_continuous_states(&mut self, at: usize) {
        let n = if self.one_in(20) { self.rng.usize(..9) } else { 4 };
        let mut states: Vec<_> = (0..n)
            .map(|_| if self.one_in(20) { self.number() } else { self.sign() * self.between(1e-9, 2.0) })
            .collect();
        let (nx, x) = (self.length(n), self.pointer(&mut states));
        self.call(at, Function::SetContinuousStates, |c| unsafe { fmi2SetContinuousStates(c, x, nx) });
    }

    /// Values are finite, or left alone.
    fn get_of_states(&mut self, at: usize, function: Function) {
        let right = if function == Function::GetEventIndicators { 2 } else { 4 };
        let n = if self.one_in(20) { self.rng.usize(..9) } else { right };
        let mut values = vec![f64::NEG_INFINITY; n];
        let (length, place) = (self.length(n), self.pointer(&mut values));
        let status = self.call(at, function, |c| unsafe {
            match function {
                Function::GetDerivatives => fmi2GetDerivatives(c, place, length),
                Function::GetEventIndicators => fmi2GetEventIndicators(c, place, length),
                Function::GetContinuousStates => fmi2GetContinuousStates(c, place, length),
                _ => fmi2GetNominalsOfContinuousStates(c, place, length),
            }
        });
        let is_right = |value: &f64| if status == OK { value.is_finite() } else { *value == f64::NEG_INFINITY };
        assert!(values.iter().all(is_right), "{function:?} {status} {values:?}");
    }

    /// The work of a check is bounded as that of a step.
    fn complete_integrator_step(&mut self, at: usize) {
        let (mut event, mut end) = (c_int::MIN, c_int::MIN);
        let (to_event, to_end) = (self.pointer(slice::from_mut(&mut event)), self.pointer(slice::from_mut(&mut end)));
        let flag = self.choice();
        let status = self.call(at, Function::CompletedIntegratorStep, |c| unsafe {
            fmi2CompletedIntegratorStep(c, flag, to_event, to_end)
        });
        let is_right = |value: c_int| if status == OK { (0..2).contains(&value) } else { value == c_int::MIN };
        assert!(is_right(event) && is_right(end), "{status} {event} {end}");
    }

    /// What follows an event is above the floor: no indicator is 0, and all are positive until the host moves on.
    fn new_discrete_states(&mut self, at: usize) {
        let mut info: EventInfo = unsafe { std::mem::zeroed() };
        let place = self.pointer(slice::from_mut(&mut info));
        let status = self.call(at, Function::NewDiscreteStates, |c| unsafe { fmi2NewDiscreteStates(c, place) });
        if status == OK {
            let mut indicators = [0.0; 2];
            let c = self.slots[at].c;
            assert_eq!(unsafe { fmi2GetEventIndicators(c, indicators.as_mut_ptr(), 2) }, OK);
            assert!(indicators.iter().all(|indicator| *indicator > 0.0), "{indicators:?}");
        }
    }

    fn set_debug_logging(&mut self, at: usize) {
        let categories = [c"logEvents", c"logStatusError", c"nonsense", c"\xff%n"];
        let mut names: Vec<_> = (0..self.rng.usize(..4)).map(|_| categories[self.rng.usize(..4)].as_ptr()).collect();
        if self.one_in(20) {
            names.push(null());
        }
        let (count, names, on) = (self.length(names.len()), self.pointer(&mut names), self.choice());
        self.call(at, Function::SetDebugLogging, |c| unsafe { fmi2SetDebugLogging(c, on, count, names) });
    }

    fn setup_experiment(&mut self, at: usize) {
        let (has_tolerance, has_stop) = (self.choice(), self.choice());
        let tolerance = if self.one_in(4) { self.number() } else { self.between(1e-14, 0.1) };
        let start = if self.one_in(4) { self.number() } else { self.rng.f64() };
        let stop = if self.one_in(4) { self.number() } else { start + self.between(1.0, 1e6) };
        let call = |c| unsafe { fmi2SetupExperiment(c, has_tolerance, tolerance, start, has_stop, stop) };
        self.call(at, Function::SetupExperiment, call);
    }

    /// Values are finite, or left alone; what nobody watches for is not a number, and friction may be infinite.
    fn get_reals(&mut self, at: usize, function: Function) {
        let mut references = self.references();
        let n = references.len();
        let (mut values, mut orders) = (vec![f64::NEG_INFINITY; n], self.orders(n));
        let nvr = self.length(n);
        let (vr, order, value) = (self.pointer(&mut references), self.pointer(&mut orders), self.pointer(&mut values));
        let status = self.call(at, function, |c| unsafe {
            match function {
                Function::GetReal => fmi2GetReal(c, vr, nvr, value),
                _ => fmi2GetRealOutputDerivatives(c, vr, nvr, order, value),
            }
        });
        let is_watched = |reference: &u32, value: f64| {
            VARIABLES.get(*reference as usize).is_some_and(|variable| {
                let is_worst = ASSUMPTIONS.iter().any(|of| [of.name, of.time_name].contains(&variable.name));
                is_worst && value > 0.0 || value.is_nan() && (is_worst || variable.name.ends_with("_max"))
            })
        };
        let is_right = |(reference, value): (&u32, &f64)| match status {
            OK => value.is_finite() || is_watched(reference, *value),
            _ => *value == f64::NEG_INFINITY,
        };
        assert!(references.iter().zip(&values).all(is_right), "{function:?} {references:?} {status} {values:?}");
    }

    fn orders(&mut self, n: usize) -> Vec<c_int> {
        (0..n).map(|_| if self.one_in(20) { self.rng.i32(..) } else { 1 }).collect()
    }

    /// Values are small, or left alone.
    fn get_discrete(&mut self, at: usize, function: Function) {
        let mut references = self.references();
        let n = references.len();
        let mut values = vec![c_int::MIN; n];
        let (nvr, vr, value) = (self.length(n), self.pointer(&mut references), self.pointer(&mut values));
        let status = self.call(at, function, |c| unsafe {
            match function {
                Function::GetInteger => fmi2GetInteger(c, vr, nvr, value),
                _ => fmi2GetBoolean(c, vr, nvr, value),
            }
        });
        let is_right = |value: &c_int| if status == OK { *value >= 0 } else { *value == c_int::MIN };
        assert!(values.iter().all(is_right), "{function:?} {references:?} {status} {values:?}");
    }

    fn set_reals(&mut self, at: usize, function: Function) {
        let mut references = self.references();
        if self.rng.bool() {
            references = vec![self.input()];
        }
        let mut values: Vec<_> = references.iter().map(|r| self.value(*r)).collect();
        if self.one_in(40) {
            // the top mass above the pivot of a foundation without inertia: no step can be made
            references = ["m0", "J0", "B", "theta_0", "u_0"].map(host::reference).into();
            values = vec![0.0, 0.0, 0.3, 0.1, 0.3];
        }
        let n = references.len();
        let mut orders = self.orders(n);
        let nvr = self.length(n);
        let (vr, order, value) = (self.pointer(&mut references), self.pointer(&mut orders), self.pointer(&mut values));
        self.call(at, function, |c| unsafe {
            match function {
                Function::SetReal => fmi2SetReal(c, vr, nvr, value),
                _ => fmi2SetRealInputDerivatives(c, vr, nvr, order, value),
            }
        });
    }

    fn set_integers(&mut self, at: usize, function: Function) {
        let mut references = self.references();
        if self.rng.bool() {
            let names: &[&str] =
                if function == Function::SetInteger { &["detail"] } else { &["extrapolate", "peaks", "validity"] };
            references = vec![host::reference(names[self.rng.usize(..names.len())])];
        }
        let most = if function == Function::SetInteger { 8 } else { 3 };
        let mut values: Vec<_> = references.iter().map(|_| self.rng.i32(0..most)).collect();
        if self.one_in(16) {
            values.fill(self.rng.i32(..));
        }
        let (nvr, vr, value) = (self.length(values.len()), self.pointer(&mut references), self.pointer(&mut values));
        self.call(at, function, |c| unsafe {
            match function {
                Function::SetInteger => fmi2SetInteger(c, vr, nvr, value),
                _ => fmi2SetBoolean(c, vr, nvr, value),
            }
        });
    }

    /// Names and paths, or any bytes; what is read is text.
    fn pass_strings(&mut self, at: usize, function: Function) {
        let mut references = self.references();
        if self.rng.bool() {
            references = vec![host::reference("record")];
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
        if function == Function::GetString {
            texts.fill(null());
        }
        let (nvr, vr, text) = (self.length(texts.len()), self.pointer(&mut references), self.pointer(&mut texts));
        let status = self.call(at, function, |c| unsafe {
            match function {
                Function::GetString => fmi2GetString(c, vr, nvr, text),
                _ => fmi2SetString(c, vr, nvr, text),
            }
        });
        if function == Function::GetString {
            assert!(texts.iter().all(|text| text.is_null() == (status != OK)), "{references:?} {status} {texts:?}");
        }
    }

    /// Values are finite, or left alone.
    fn get_directional_derivative(&mut self, at: usize) {
        let mut unknowns = self.references();
        let mut knowns = if self.one_in(4) { self.references() } else { vec![self.input()] };
        let mut seed: Vec<_> = knowns.iter().map(|_| self.number()).collect();
        let mut values = vec![f64::NEG_INFINITY; unknowns.len()];
        let (n_unknown, n_known) = (self.length(unknowns.len()), self.length(knowns.len()));
        let (unknown, known) = (self.pointer(&mut unknowns), self.pointer(&mut knowns));
        let (from, to) = (self.pointer(&mut seed), self.pointer(&mut values));
        let status = self.call(at, Function::GetDirectionalDerivative, |c| unsafe {
            fmi2GetDirectionalDerivative(c, unknown, n_unknown, known, n_known, from, to)
        });
        let is_right = |value: &f64| if status == OK { value.is_finite() } else { *value == f64::NEG_INFINITY };
        assert!(values.iter().all(is_right), "{unknowns:?} by {knowns:?} {seed:?}: {status} {values:?}");
    }

    fn get_state(&mut self, at: usize) {
        let mut state = if self.rng.bool() { null_mut() } else { self.state(at) };
        let is_new = state.is_null();
        let place = self.pointer(slice::from_mut(&mut state));
        let status = self.call(at, Function::GetFMUstate, |c| unsafe { fmi2GetFMUstate(c, place) });
        if status == OK && is_new {
            self.keep(at, state);
        }
    }

    fn keep(&mut self, at: usize, state: *mut c_void) {
        let slot = &mut self.slots[at];
        assert!(!state.is_null() && !slot.states.contains(&state));
        if slot.states.len() == 8 {
            let mut oldest = slot.states.remove(0);
            assert_eq!(unsafe { fmi2FreeFMUstate(slot.c, &mut oldest) }, OK);
        }
        slot.states.push(state);
    }

    /// The instance is then what the state was.
    fn set_state(&mut self, at: usize) {
        let state = self.state(at);
        let status = self.call(at, Function::SetFMUstate, |c| unsafe { fmi2SetFMUstate(c, state) });
        if status == OK {
            assert!(self.serialized(at) == self.bytes_of(at, state));
        }
    }

    fn free_state(&mut self, at: usize) {
        let mut state = self.state(at);
        let freed = state;
        let place = self.pointer(slice::from_mut(&mut state));
        let status = self.call(at, Function::FreeFMUstate, |c| unsafe { fmi2FreeFMUstate(c, place) });
        if status == OK && !place.is_null() {
            assert!(state.is_null());
            self.slots[at].states.retain(|state| *state != freed);
            self.slots[at].freed = freed;
        }
    }

    /// Into a buffer of the right size, or another.
    fn serialize(&mut self, at: usize, function: Function) {
        let state = self.state(at);
        if function == Function::SerializedFMUstateSize {
            let mut size = 0;
            let place = self.pointer(slice::from_mut(&mut size));
            self.call(at, function, |c| unsafe { fmi2SerializedFMUstateSize(c, state, place) });
            return;
        }
        let right = if self.slots[at].states.contains(&state) { self.bytes_of(at, state).len() } else { 0 };
        let mut bytes = vec![0; if self.one_in(8) { self.rng.usize(..400) } else { right }];
        let (size, place) = (self.length(bytes.len()), self.pointer(&mut bytes));
        let status = self.call(at, function, |c| unsafe { fmi2SerializeFMUstate(c, state, place, size) });
        if status == OK {
            self.bytes.truncate(7);
            self.bytes.insert(0, bytes);
        }
    }

    fn deserialize(&mut self, at: usize) {
        let mut bytes = self.damaged_bytes();
        let is_whole = self.bytes.contains(&bytes);
        let mut state = if self.rng.bool() { null_mut() } else { self.state(at) };
        let is_new = state.is_null();
        let (size, from) = (self.length(bytes.len()), self.pointer(&mut bytes));
        let place = self.pointer(slice::from_mut(&mut state));
        let call = |c| unsafe { fmi2DeSerializeFMUstate(c, from, size, place) };
        if self.call(at, Function::DeSerializeFMUstate, call) == OK {
            assert!(!is_whole || self.bytes_of(at, state) == bytes);
            if is_new {
                self.keep(at, state);
            }
        }
    }

    /// Mostly from where the instance is, mostly over some ten milliseconds. The work is bounded.
    fn do_step(&mut self, at: usize) {
        let before = self.time(at);
        let work_before = before.map(|_| self.work(at));
        let mut point = before.unwrap_or(0.0);
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
        let go_back = self.choice();
        let status = self.call(at, Function::DoStep, |c| unsafe { fmi2DoStep(c, point, step, go_back) });
        if let (Some(before), Some(after)) = (before, self.time(at)) {
            // the host's clock is right, in which the structure may overturn before the end of the last step
            let is_on = if status == OK { after > before } else { after >= before.min(point) };
            assert!(is_on, "from {before} to {after}");
            let (work, work_before) = (self.work(at), work_before.unwrap());
            let steps = work.steps - work_before.steps;
            assert!(steps <= MAX_STEPS_PER_ADVANCE, "{steps} steps");
            assert!(work.evaluations - work_before.evaluations <= steps * MAX_ORDER as u64);
            self.tally.most_steps = self.tally.most_steps.max(steps);
        }
    }

    fn status(&mut self, at: usize, function: Function) {
        let kind = if self.one_in(8) { self.rng.i32(..) } else { self.rng.i32(0..4) };
        let (mut real, mut integer, mut text) = (0.0, 0, null());
        let real = self.pointer(slice::from_mut(&mut real));
        let integer = self.pointer(slice::from_mut(&mut integer));
        let text = self.pointer(slice::from_mut(&mut text));
        self.call(at, function, |c| unsafe {
            match function {
                Function::GetStatus => fmi2GetStatus(c, kind, integer),
                Function::GetRealStatus => fmi2GetRealStatus(c, kind, real),
                Function::GetIntegerStatus => fmi2GetIntegerStatus(c, kind, integer),
                Function::GetBooleanStatus => fmi2GetBooleanStatus(c, kind, integer),
                _ => fmi2GetStringStatus(c, kind, text),
            }
        });
    }
}
