//! Arguments of calls, from sensible to absurd: what is read is held until the call is over, and of what is written it is
//! known whether it may be.

use crate::{C, Sequence, host};
use FlexibleRocking::state_machine::Stage;
use FlexibleRocking::variables::{DataType, VARIABLES, Value};
use libc::{c_char, c_int, c_uint};
use rocking::Parameters;
use rocking::run::validity::ASSUMPTIONS;
use std::any::Any;
use std::ffi::CString;
use std::fs;
use std::path::Path;
use std::ptr::{null, null_mut, without_provenance_mut};
use uuid::Uuid;

/// Makes the table of functions by name, each with its arguments.
macro_rules! calls {
    ($call:ident: $($name:ident($($argument:expr),*))*) => {
        &[$((stringify!($name), |c, #[allow(unused_variables)] $call| unsafe { $name(c $(, $argument)*) })),*]
    };
}
pub(crate) use calls;

/// What is a Boolean and can be set.
pub const SWITCHES: [&str; 4] = ["a_g_late", "F_t_extrapolated", "peaks", "validity"];

/// What one call is given.
#[derive(Default)]
pub struct Drawn {
    pub references: Vec<c_uint>,
    /// Values to set, where they belong to the references.
    reals: Vec<f64>,
    /// How many values there are, and how many unknowns.
    n: usize,
    unknowns: usize,
    /// Where a step begins, s.
    pub point: f64,
    /// An FMU state, and where one is read and written.
    pub state: C,
    pub place: Option<Vec<C>>,
    /// Bytes of an FMU state.
    pub deserialized: Option<Vec<u8>>,
    pub serialized: Option<Vec<u8>>,
    pub rooms: Vec<Room>,
    held: Vec<Box<dyn Any>>,
}

/// Room for `count` values of `size` bytes each.
#[derive(Debug)]
pub struct Room {
    pub words: Vec<u64>,
    size: usize,
    count: usize,
    /// Which of them are real numbers that are finite; of others it is not known.
    is_finite: Vec<bool>,
}

impl Room {
    /// Whether it is as it was, or, where the call `is_done`, has as many values in it, and no more.
    pub fn is_right(&self, is_done: bool) -> bool {
        let bytes: Vec<_> = self.words.iter().flat_map(|word| word.to_le_bytes()).collect();
        let (written, beyond) = bytes.split_at(if is_done { self.count * self.size } else { 0 });
        let is_finite = |(word, is_finite): (&u64, &bool)| !is_finite || f64::from_bits(*word).is_finite();
        beyond.iter().all(|byte| *byte == u8::MAX)
            && written.chunks(self.size.max(1)).all(|value| value.iter().any(|byte| *byte != u8::MAX))
            && (!is_done || self.words.iter().zip(&self.is_finite).all(is_finite))
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
        let (size, is_finite) = (size_of::<T>(), Vec::new());
        let mut words = vec![u64::MAX; (count * size).div_ceil(8) + 1];
        let place = words.as_mut_ptr().cast();
        self.drawn.rooms.push(Room { words, size, count, is_finite });
        self.spoilt(place)
    }

    /// Room for `right` real numbers, which are finite, or for another number of them.
    pub fn reals_of(&mut self, right: usize) -> *mut f64 {
        let n = if self.one_in(20) { self.rng.usize(..9) } else { right };
        self.finite(n)
    }

    /// Room for one real number.
    pub fn real(&mut self) -> *mut f64 {
        self.finite(1)
    }

    fn finite(&mut self, n: usize) -> *mut f64 {
        let place = self.room(n);
        self.drawn.rooms.last_mut().unwrap().is_finite = vec![true; n];
        place
    }

    /// Room for a value of each variable. What nobody watches for is not a number, and friction may be infinite.
    pub fn values<T>(&mut self) -> *mut T {
        self.room(self.drawn.references.len())
    }

    /// Room for a real number of each variable.
    pub fn reals(&mut self) -> *mut f64 {
        let is_finite = self.drawn.references.iter().map(|reference| {
            let name = VARIABLES.get(*reference as usize).map_or("", |variable| variable.name);
            let is_worst = ASSUMPTIONS.iter().any(|of| [of.name, of.time_name].contains(&name));
            !is_worst && !name.ends_with("_max")
        });
        let is_finite = is_finite.collect();
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

    /// A Boolean, or no Boolean.
    pub fn flag<T: From<u8>>(&mut self) -> T {
        if self.one_in(20) { self.rng.u8(2..) } else { self.rng.u8(..2) }.into()
    }

    /// References to variables, to those called `names` more often than not.
    pub fn references(&mut self, names: &[&str]) -> *const c_uint {
        let n = if self.one_in(50) { 1000 } else { self.rng.usize(..5) };
        let mut references: Vec<_> = (0..n)
            .map(|_| match self.rng.u8(..24) {
                0 => self.rng.u32(..),
                1 => VARIABLES.len() as c_uint,
                _ => self.rng.u32(..VARIABLES.len() as c_uint),
            })
            .collect();
        if !names.is_empty() && self.rng.bool() {
            references = vec![host::reference(names[self.rng.usize(..names.len())])];
        }
        self.drawn.n = references.len();
        self.drawn.references.clone_from(&references);
        self.hold(references)
    }

    /// References to variables that are to be set.
    pub fn references_to_set(&mut self) -> *const c_uint {
        if self.one_in(6) {
            // the top mass above the pivot of a foundation without inertia: no step can be made
            self.drawn.reals = vec![0.0, 0.0, 0.3, 0.1, 0.3];
            self.drawn.references = ["m0", "J0", "B", "theta_0", "u_0"].map(host::reference).into();
            self.drawn.n = 5;
            return self.hold(self.drawn.references.clone());
        }
        let is_continuous = self.before.as_ref().is_some_and(|of| of.stage == Stage::ContinuousTimeMode);
        let states = ["u", "u_dot", "theta", "theta_dot"];
        if is_continuous && self.one_in(4) { self.references(&states) } else { self.references(&["a_g", "F_t", "a_v"]) }
    }

    /// Values for them.
    pub fn reals_to_set(&mut self) -> *const f64 {
        let mut values = std::mem::take(&mut self.drawn.reals);
        for at in values.len()..self.drawn.references.len() + 1 {
            values.push(self.value(self.drawn.references.get(at).copied()));
        }
        self.hold(values)
    }

    /// A value for the variable `reference`: in its range or on its edge, more often than not.
    fn value(&mut self, reference: Option<c_uint>) -> f64 {
        let variable = reference.and_then(|reference| VARIABLES.get(reference as usize));
        let Some(DataType::Real { range: Some((min, max)), .. }) = variable.map(|v| v.data_type) else {
            return self.number();
        };
        match self.rng.u8(..8) {
            0 => self.number(),
            1 => [min, max][self.rng.usize(..2)],
            2 | 3 if min > 0.0 => self.between(min, max),
            2 | 3 => self.sign() * self.between(1e-6, max),
            _ => match variable.and_then(|variable| variable.start(&Parameters::EVISON.into())) {
                Some(Value::Real(start)) if start != 0.0 => (start * self.between(0.3, 3.0)).clamp(min, max),
                _ if min == 0.0 => self.between(1e-2, 1e6f64.min(max)),
                _ => self.sign() * self.between(1e-4, 50.0f64.min(max)),
            },
        }
    }

    /// A number from anywhere.
    pub fn number(&mut self) -> f64 {
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

    /// Orders of derivatives.
    pub fn orders(&mut self) -> *const c_int {
        let n = self.drawn.references.len() + 1;
        let orders = (0..n).map(|_| if self.one_in(20) { self.rng.i32(..) } else { 1 }).collect();
        self.hold(orders)
    }

    /// Small numbers, or any, as integers of some size.
    pub fn integers<T: TryFrom<i64> + Default + 'static>(&mut self) -> *const T {
        let (n, is_odd) = (self.drawn.references.len() + 1, self.one_in(16));
        let number = |rng: &mut fastrand::Rng| if is_odd { rng.i64(..) >> rng.u32(..64) } else { rng.i64(..8) };
        let integers = (0..n).map(|_| T::try_from(number(&mut self.rng)).unwrap_or_default()).collect();
        self.hold(integers)
    }

    /// Booleans, few of which are none.
    pub fn flags<T: From<u8> + 'static>(&mut self) -> *const T {
        let flags = (0..=self.drawn.references.len()).map(|_| self.flag()).collect();
        self.hold(flags)
    }

    /// Names and paths, or any bytes.
    pub fn texts(&mut self) -> *const *const c_char {
        let garbage: Vec<u8> = (0..self.rng.usize(..40)).map(|_| self.rng.u8(1..)).collect();
        let garbage = CString::new(garbage).unwrap();
        let (records, n) = (self.records, self.drawn.references.len() + 1);
        let text = |rng: &mut fastrand::Rng| match rng.u8(..40) {
            0 => null(),
            1..4 => garbage.as_ptr(),
            4..20 => records[rng.usize(..4)].as_ptr(),
            _ => records[rng.usize(..records.len())].as_ptr(),
        };
        let texts = (0..n).map(|_| text(&mut self.rng)).collect();
        self.drawn.held.push(Box::new(garbage));
        self.hold(texts)
    }

    /// How many log categories there are.
    pub fn few(&mut self) -> usize {
        self.drawn.n = self.rng.usize(..4);
        self.count()
    }

    /// Names of log categories.
    pub fn categories(&mut self) -> *const *const c_char {
        let categories = [c"logEvents", c"logStatusError", c"nonsense", c"\xff%n"];
        let category =
            |rng: &mut fastrand::Rng| if rng.u8(..40) == 0 { null() } else { categories[rng.usize(..4)].as_ptr() };
        let names = (0..self.drawn.n).map(|_| category(&mut self.rng)).collect();
        self.hold(names)
    }

    /// An FMU state of the instance, of the other one, one that is freed, or none at all.
    pub fn state(&mut self) -> C {
        let of = if self.one_in(20) { 1 - self.at } else { self.at };
        self.drawn.state = match self.rng.u8(..20) {
            0 => without_provenance_mut(self.rng.usize(..)),
            1 => null_mut(),
            2 => self.slots[of].freed,
            _ => self.rng.choice(&self.slots[of].states).copied().unwrap_or(null_mut()),
        };
        self.drawn.state
    }

    /// Where an FMU state is, or one is to be.
    pub fn place_of_state(&mut self) -> *mut C {
        if self.rng.bool() {
            self.state();
        }
        let mut place = vec![self.drawn.state];
        let pointer = place.as_mut_ptr();
        self.drawn.place = Some(place);
        self.spoilt(pointer)
    }

    /// Bytes of a state, mostly damaged.
    pub fn serialized(&mut self) -> *const u8 {
        let mut bytes = self.rng.choice(&self.bytes).cloned().unwrap_or_else(|| vec![7; 200]);
        match self.rng.u8(..6) {
            0 => (),
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
        self.drawn.n = bytes.len();
        self.drawn.deserialized = Some(bytes.clone());
        self.hold(bytes)
    }

    /// A buffer of the size that the FMU state has, or of another.
    pub fn buffer(&mut self) -> *mut u8 {
        let slot = &self.slots[self.at];
        let is_known = slot.states.contains(&self.drawn.state);
        let right = if is_known { self.version.bytes_of(slot.c, self.drawn.state).len() } else { 0 };
        let mut bytes = vec![0; if self.one_in(8) { self.rng.usize(..400) } else { right }];
        let pointer = bytes.as_mut_ptr();
        (self.drawn.n, self.drawn.serialized) = (bytes.len(), Some(bytes));
        self.spoilt(pointer)
    }

    /// A relative tolerance.
    pub fn tolerance(&mut self) -> f64 {
        if self.one_in(4) { self.number() } else { self.between(1e-14, 0.1) }
    }

    /// When a simulation starts, s.
    pub fn start(&mut self) -> f64 {
        self.drawn.point = if self.one_in(4) { self.number() } else { self.rng.f64() };
        self.drawn.point
    }

    /// When it ends, s.
    pub fn stop(&mut self) -> f64 {
        if self.one_in(4) { self.number() } else { self.drawn.point + self.between(1.0, 1e6) }
    }

    /// Mostly where the instance is, s.
    pub fn point(&mut self) -> f64 {
        self.drawn.point = self.before.as_ref().and_then(|of| of.course).map_or(0.0, |course| course.motion.time);
        if self.one_in(16) {
            self.drawn.point += self.number();
        }
        self.drawn.point
    }

    /// Mostly some ten milliseconds. A long step takes as much work as a thousand others.
    pub fn step(&mut self) -> f64 {
        let a_g = self.value(Some(host::reference("a_g")));
        let slot = &self.slots[self.at];
        slot.told.asked.set((slot.c, a_g));
        match self.rng.u16(..4000) {
            0 => 1e9,
            1..40 => self.number(),
            40..120 => 1e-300,
            // over a record
            120..200 => self.between(0.1, 10.0),
            _ => self.between(1e-4, 0.1),
        }
    }

    /// On by some milliseconds, or anywhere, s. A check over a long time takes as much work as a thousand others.
    pub fn time(&mut self) -> f64 {
        let outside = self.before.as_ref().and_then(|condition| condition.course?.outside);
        let now = outside.map_or(0.0, |outside| outside.known.motion.time);
        match self.rng.u16(..4000) {
            0..8 => self.number(),
            8..200 => now + self.between(0.1, 10.0),
            200..400 => now - self.between(1e-6, 0.1),
            _ => now + self.between(1e-6, 0.1),
        }
    }

    /// Continuous states: small, large, or no numbers.
    pub fn states(&mut self) -> *const f64 {
        self.drawn.n = if self.one_in(20) { self.rng.usize(..9) } else { 4 };
        let states = (0..self.drawn.n)
            .map(|_| if self.one_in(20) { self.number() } else { self.sign() * self.between(1e-9, 2.0) })
            .collect();
        self.hold(states)
    }

    /// What derivatives are asked of, and by what.
    pub fn unknowns(&mut self) -> *const c_uint {
        let unknowns = self.references(&["a_t", "R_v", "der(theta_dot)"]);
        self.drawn.unknowns = self.drawn.n;
        unknowns
    }

    pub fn knowns(&mut self) -> *const c_uint {
        self.references(&["a_g", "F_t", "a_v"])
    }

    /// How many values there are for the unknowns: as many, or another number.
    pub fn count_of_unknowns(&mut self) -> usize {
        self.drawn.unknowns + usize::from(self.one_in(40))
    }

    /// Changes of the knowns, or weights of the unknowns.
    pub fn seed(&mut self) -> *const f64 {
        let seed = (0..=self.drawn.n.max(self.drawn.unknowns)).map(|_| self.number()).collect();
        self.hold(seed)
    }

    /// Room for a derivative of each unknown.
    pub fn derivatives(&mut self) -> *mut f64 {
        self.finite(self.drawn.unknowns)
    }

    /// The number of an item of an enumeration.
    pub fn item(&mut self) -> c_int {
        if self.one_in(8) { self.rng.i32(..) } else { self.rng.i32(0..4) }
    }
}

/// What `record` is set to: files of the archive in `folder` and elsewhere, sound and broken, and what is no file.
pub fn records(folder: &Path) -> Vec<CString> {
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
    let (uri, long) = (format!("file://{inside}"), "a".repeat(70_000));
    let sound = ["quake.csv", "quake.csv", "Quake 2.AT2", "Quake 2.AT2"];
    let others = ["broken.csv", "huge.csv", "dense.csv", "folder.csv", "absent.csv", "", ".", "..", "../quake.csv"];
    let elsewhere = ["/dev/zero", "/dev/full", "/dev/stdin", "/", "/etc/passwd", "file:///dev/zero", "file:"];
    let texts = [&sound[..], &others, &elsewhere, &["file:///%00.csv", &inside, &uri, &long]].concat();
    texts.into_iter().map(|text| CString::new(text).unwrap()).collect()
}
