//! Arguments of calls, from sensible to absurd: what is read is held until the call is over, and of what is written it is
//! known whether it may be.

use super::{C, Sequence};
use fmi_unit::state_machine::Stage;
use fmi_unit::{Causality, DataType, Role, Value, Variable};
use libc::{c_char, c_uint};
use std::any::Any;
use std::ffi::CStr;
use std::ops::Range;
use std::ptr::{null, null_mut, without_provenance_mut};

/// Makes the table of functions by name, each with its arguments: those of both versions, with the names that differ, and
/// those of one version.
macro_rules! calls {
    (@ $call:ident $($name:ident($($argument:expr),*))*) => {
        &[$((stringify!($name), |c, #[allow(unused_variables)] $call| unsafe { $name(c $(, $argument)*) })),*]
    };
    ($call:ident: [$get:ident $set:ident $free:ident $size:ident $save:ident $load:ident] $rates:ident $($own:tt)*) => {
        calls! { @ $call
            SetDebugLogging($call.integer(0..2), $call.few(), $call.texts(&CATEGORIES))
            ExitInitializationMode()
            Terminate()
            Reset()
            $get($call.place_of_state())
            $set($call.state())
            $free($call.place_of_state())
            $size($call.state(), $call.room(1))
            $save($call.state(), $call.buffer(), $call.count())
            $load($call.serialized(), $call.count(), $call.place_of_state())
            EnterEventMode()
            EnterContinuousTimeMode()
            CompletedIntegratorStep($call.integer(0..2), $call.room(1), $call.room(1))
            SetTime($call.time())
            SetContinuousStates($call.states(), $call.count())
            $rates($call.reals($call.subject.states().count()), $call.count())
            GetEventIndicators($call.reals($call.subject.indicators()), $call.count())
            GetContinuousStates($call.reals($call.subject.states().count()), $call.count())
            GetNominalsOfContinuousStates($call.reals($call.subject.states().count()), $call.count())
            $($own)*
        }
    };
}
pub(crate) use calls;

/// Log categories, the first two of which exist.
pub const CATEGORIES: [&CStr; 4] = [c"logEvents", c"logStatusError", c"nonsense", c"\xff%n"];

type Meant = fn(&Variable) -> bool;

/// Any variable, none of them more often than others.
pub const ANY: Meant = |_| false;
pub const INTEGER: Meant = |variable| variable.data_type == DataType::Integer;
pub const NUMBER: Meant = |variable| matches!(variable.data_type, DataType::Enumeration(_));
pub const BOOLEAN: Meant = |variable| variable.data_type == DataType::Boolean;
pub const TEXT: Meant = |variable| variable.data_type == DataType::String;
pub const NUMBER_TO_SET: Meant = |variable| NUMBER(variable) && variable.causality == Causality::Parameter;
pub const SWITCH: Meant = |variable| BOOLEAN(variable) && variable.causality == Causality::Parameter;
pub const OUTPUT: Meant = |variable| variable.causality == Causality::Output && variable.is_continuous;
pub const INPUT: Meant = |variable| variable.causality == Causality::Input;
const STATE: Meant = |variable| variable.role == Role::State;

#[derive(Default)]
pub struct CallData {
    pub references: Vec<c_uint>,
    /// Values to set, where they belong to the references.
    reals: Vec<f64>,
    /// How many values there are, and how many unknowns.
    n: usize,
    unknowns: usize,
    /// An FMU state, and where one is read and written.
    pub state: C,
    pub place: Option<Vec<C>>,
    /// Whether the bytes of an FMU state are forged.
    pub is_forged: bool,
    /// Room for the bytes of an FMU state.
    pub serialized: Option<Vec<u8>>,
    pub rooms: Vec<Buffer>,
    held: Vec<Box<dyn Any>>,
}

/// Room for `count` values of `size` bytes each.
#[derive(Debug)]
pub struct Buffer {
    pub words: Vec<u64>,
    size: usize,
    count: usize,
    /// Whether they are real numbers that are finite; of others it is not known.
    is_finite: bool,
}

impl Buffer {
    /// Whether it is as it was, or, where the call `is_done`, has as many values in it, and no more.
    pub fn is_right(&self, is_done: bool) -> bool {
        let bytes: Vec<_> = self.words.iter().flat_map(|word| word.to_le_bytes()).collect();
        let (written, beyond) = bytes.split_at(if is_done { self.count * self.size } else { 0 });
        let is_number = |word: &u64| !self.is_finite || f64::from_bits(*word).is_finite();
        beyond.iter().all(|byte| *byte == u8::MAX)
            && written.chunks(self.size.max(1)).all(|value| value.iter().any(|byte| *byte != u8::MAX))
            && (!is_done || self.words.iter().take(self.count).all(is_number))
    }
}

/// The words of the tables of calls.
impl Sequence<'_> {
    /// Holds `values` until the call is over. A pointer to them, or a bad one.
    fn hold<T: 'static>(&mut self, mut values: Vec<T>) -> *mut T {
        let pointer = values.as_mut_ptr();
        self.drawn.held.push(Box::new(values));
        self.spoilt(pointer)
    }

    fn spoilt<T>(&mut self, pointer: *mut T) -> *mut T {
        match self.rng.u8(..100) {
            0 => null_mut(),
            1 if align_of::<T>() > 1 => pointer.wrapping_byte_add(1),
            _ => pointer,
        }
    }

    /// Room for `count` values.
    pub fn room<T>(&mut self, count: usize) -> *mut T {
        self.drawn.n = count;
        let size = size_of::<T>();
        let mut words = vec![u64::MAX; (count * size).div_ceil(8) + 1];
        let place = words.as_mut_ptr().cast();
        self.drawn.rooms.push(Buffer { words, size, count, is_finite: false });
        self.spoilt(place)
    }

    /// Room for `count` real numbers, which are finite.
    pub fn finite(&mut self, count: usize) -> *mut f64 {
        let place = self.room(count);
        self.drawn.rooms.last_mut().unwrap().is_finite = !self.is_forged;
        place
    }

    /// The same, or for another number of them.
    pub fn reals(&mut self, right: usize) -> *mut f64 {
        let n = if self.one_in(20) { self.rng.usize(..9) } else { right };
        self.finite(n)
    }

    pub fn derivatives(&mut self) -> *mut f64 {
        self.finite(self.drawn.unknowns)
    }

    pub fn values<T>(&mut self) -> *mut T {
        self.room(self.drawn.references.len())
    }

    /// Room for a real number of each variable.
    pub fn reals_of_references(&mut self) -> *mut f64 {
        let subject = self.subject;
        let may_be_infinite = |variable: &Variable| (subject.may_be_infinite)(&variable.name);
        let named = self.drawn.references.iter().filter_map(|reference| subject.variables.get(*reference as usize));
        let is_finite = !self.is_forged && !named.into_iter().any(may_be_infinite);
        let place = self.values();
        self.drawn.rooms.last_mut().unwrap().is_finite = is_finite;
        place
    }

    /// How many values there are: as many as there are, or more than any call takes.
    pub fn count(&mut self) -> usize {
        let too_many = [usize::MAX, 1 << 40, (1 << 24) + 1][self.rng.usize(..3)];
        if self.one_in(40) { too_many } else { self.drawn.n }
    }

    /// How many values there are for as many variables: as many, or another number.
    pub fn count_of_values(&mut self) -> usize {
        self.drawn.n + usize::from(self.one_in(40))
    }

    /// How many texts there are.
    pub fn few(&mut self) -> usize {
        self.drawn.n = self.rng.usize(..4);
        self.count()
    }

    /// A `usual` integer, or any.
    pub fn integer<T: TryFrom<i64> + Default>(&mut self, usual: Range<i64>) -> T {
        let any = self.rng.i64(..) >> self.rng.u32(..64);
        T::try_from(if self.one_in(20) { any } else { self.rng.i64(usual) }).unwrap_or_default()
    }

    /// As many as there are references, and one more.
    pub fn integers<T: TryFrom<i64> + Default + 'static>(&mut self, usual: Range<i64>) -> *const T {
        let integers = (0..=self.drawn.references.len()).map(|_| self.integer(usual.clone())).collect();
        self.hold(integers)
    }

    /// References to variables, to one that `is_meant` more often than not.
    pub fn references(&mut self, is_meant: Meant) -> *const c_uint {
        let n = if self.one_in(50) { 1000 } else { self.rng.usize(..5) };
        let last = self.subject.variables.len() as c_uint;
        let mut references: Vec<_> =
            (0..n).map(|_| if self.one_in(24) { self.rng.u32(last..) } else { self.rng.u32(..last) }).collect();
        let meant = (0..).zip(&*self.subject.variables).filter(|(_, variable)| is_meant(variable));
        let meant = meant.map(|(reference, _)| reference);
        if self.rng.bool()
            && let Some(meant) = self.rng.choice(meant.collect::<Vec<_>>())
        {
            references = vec![meant];
        }
        self.drawn.references = references;
        self.hold_references()
    }

    /// Holds the references, which this version counts from its own first.
    fn hold_references(&mut self) -> *const c_uint {
        self.drawn.n = self.drawn.references.len();
        let first = self.version.first_reference;
        self.hold(self.drawn.references.iter().map(|reference| reference.wrapping_add(first)).collect())
    }

    /// References to variables that are to be set.
    pub fn references_to_set(&mut self) -> *const c_uint {
        if self.one_in(6) && !self.subject.sticks.is_empty() {
            (self.drawn.references, self.drawn.reals) = self.subject.sticks.iter().copied().unzip();
            return self.hold_references();
        }
        let is_continuous = self.before.as_ref().is_some_and(|of| of.stage == Stage::ContinuousTimeMode);
        if is_continuous && self.one_in(4) { self.references(STATE) } else { self.references(INPUT) }
    }

    pub fn reals_to_set(&mut self) -> *const f64 {
        let mut values = std::mem::take(&mut self.drawn.reals);
        for at in values.len()..self.drawn.references.len() + 1 {
            values.push(self.value(self.drawn.references.get(at).copied()));
        }
        self.hold(values)
    }

    /// A value for the variable `reference`: in its range or on its edge, more often than not.
    fn value(&mut self, reference: Option<c_uint>) -> f64 {
        let variable = reference.and_then(|reference| self.subject.variables.get(reference as usize));
        let Some(DataType::Real { range: Some((min, max)), .. }) = variable.map(|v| v.data_type) else {
            return self.number();
        };
        match self.rng.u8(..8) {
            0 => self.number(),
            1 => [min, max][self.rng.usize(..2)],
            2 | 3 if min > 0.0 => self.between(min, max),
            2 | 3 => self.sign() * self.between(1e-6, max),
            _ => match variable.and_then(|variable| variable.start.clone()) {
                Some(Value::Real(start)) if start != 0.0 => (start * self.between(0.3, 3.0)).clamp(min, max),
                _ if min == 0.0 => self.between(1e-2, 1e6f64.min(max)),
                _ => self.sign() * self.between(1e-4, 50.0f64.min(max)),
            },
        }
    }

    /// A number from anywhere.
    fn number(&mut self) -> f64 {
        const SPECIAL: &str = "nan inf -inf 0 -0 5e-324 3e-308 -1e-300 2e-16 1 1.7e308 -1.7e308";
        match self.rng.u8(..8) {
            0 | 1 => self.rng.choice(SPECIAL.split(' ').collect::<Vec<_>>()).unwrap().parse().unwrap(),
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

    /// The same, or a number from anywhere.
    pub fn within(&mut self, low: f64, high: f64) -> f64 {
        if self.one_in(16) { self.number() } else { self.between(low, high) }
    }

    /// As many of the texts `of` as there are values, and one more; half of them of the first two.
    pub fn texts<T: AsRef<CStr>>(&mut self, of: &[T]) -> *const *const c_char {
        let text = |rng: &mut fastrand::Rng| match rng.u8(..40) {
            0 => null(),
            1..20 => of[rng.usize(..2)].as_ref().as_ptr(),
            _ => of[rng.usize(..of.len())].as_ref().as_ptr(),
        };
        let texts = (0..=self.drawn.n).map(|_| text(&mut self.rng)).collect();
        self.hold(texts)
    }

    /// An FMU state of the instance, one that is freed, or none at all.
    pub fn state(&mut self) -> C {
        self.drawn.state = match self.rng.u8(..20) {
            0 => without_provenance_mut(self.rng.usize(..)),
            1 => null_mut(),
            2 => self.freed,
            _ => self.rng.choice(&self.states).copied().unwrap_or(null_mut()),
        };
        self.drawn.state
    }

    /// A place with an FMU state, or for one.
    pub fn place_of_state(&mut self) -> *mut C {
        if self.rng.bool() {
            self.state();
        }
        let mut place = vec![self.drawn.state];
        let pointer = place.as_mut_ptr();
        self.drawn.place = Some(place);
        self.spoilt(pointer)
    }

    /// Bytes of a state, mostly forged, with the right checksum, or damaged.
    pub fn serialized(&mut self) -> *const u8 {
        let kept = self.rng.choice(&self.bytes).cloned().unwrap_or_else(|| self.version.bytes(self.c));
        let mut state = self.subject.read(&kept);
        (0..self.rng.u8(..4)).filter(|_| self.subject.checks).for_each(|_| self.damage(&mut state.model));
        let any = *self.rng.choice(Stage::ALL).unwrap();
        state.stage = if self.one_in(4) { any } else { state.stage };
        let mut bytes = state.serialize(&self.subject.build);
        self.drawn.is_forged = bytes != kept;
        (0..self.rng.u8(..16) / 15).for_each(|_| self.damage(&mut bytes));
        self.drawn.n = bytes.len();
        self.hold(bytes)
    }

    fn damage(&mut self, bytes: &mut Vec<u8>) {
        let at = self.rng.usize(..bytes.len().max(1));
        match self.rng.u8(..16) {
            0 => bytes.truncate(at),
            1 => bytes.push(0),
            _ => bytes.iter_mut().skip(at).take(1).for_each(|byte| *byte ^= 1 << self.rng.u8(..8)),
        }
    }

    /// A buffer of the size that the FMU state has, or of another.
    pub fn buffer(&mut self) -> *mut u8 {
        let is_known = self.states.contains(&self.drawn.state);
        let right = if is_known { self.version.bytes_of(self.c, self.drawn.state).len() } else { 0 };
        let mut bytes = vec![0; if self.one_in(8) { self.rng.usize(..400) } else { right }];
        let pointer = bytes.as_mut_ptr();
        (self.drawn.n, self.drawn.serialized) = (bytes.len(), Some(bytes));
        self.spoilt(pointer)
    }

    /// Mostly where the instance is, s.
    pub fn point(&mut self) -> f64 {
        let now = self.before.as_ref().map_or(0.0, self.subject.time);
        if self.one_in(16) { self.number() } else { now }
    }

    /// Mostly some ten milliseconds. A long step takes as much work as a thousand others.
    pub fn step(&mut self) -> f64 {
        match self.rng.u16(..4000) {
            0 => 1e9,
            1..40 => self.number(),
            40..120 => 1e-300,
            120..200 => self.between(0.1, 10.0),
            _ => self.between(1e-4, 0.1),
        }
    }

    /// On by some milliseconds, or anywhere, s. A check over a long time takes as much work as a thousand others.
    pub fn time(&mut self) -> f64 {
        let now = self.before.as_ref().map_or(0.0, self.subject.time);
        match self.rng.u16(..4000) {
            0..8 => self.number(),
            8..200 => now + self.between(0.1, 10.0),
            200..400 => now - self.between(1e-6, 0.1),
            _ => now + self.between(1e-6, 0.1),
        }
    }

    /// Continuous states: small, large, or no numbers.
    pub fn states(&mut self) -> *const f64 {
        self.drawn.n = if self.one_in(20) { self.rng.usize(..9) } else { self.subject.states().count() };
        let states = (0..self.drawn.n).map(|_| self.sign() * self.within(1e-9, 2.0)).collect();
        self.hold(states)
    }

    /// The variables that derivatives are asked of.
    pub fn unknowns(&mut self) -> *const c_uint {
        let unknowns = self.references(|variable| OUTPUT(variable) || matches!(variable.role, Role::RateOf(_)));
        self.drawn.unknowns = self.drawn.n;
        unknowns
    }

    /// Changes of the knowns.
    pub fn seed(&mut self) -> *const f64 {
        let seed = (0..=self.drawn.n).map(|_| self.number()).collect();
        self.hold(seed)
    }
}
