//! A named number with a unit and a range: the one table that checks, messages, files and the FMU read.

use crate::digits::{short, with_unit};
use serde::{Deserialize, Serialize};
use std::fmt::Display;

/// The units in which a description gives masses and forces; lengths are in m and times in s.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum Units {
    /// SI units.
    #[default]
    #[serde(rename = "N, m, kg")]
    Newtons,
    /// 1000 times the SI unit of each number in [`LARGE`].
    #[serde(rename = "kN, m, t")]
    Kilonewtons,
}

/// Each SI unit that contains a mass or a force, and 1000 times this unit.
pub const LARGE: [(&str, &str); 7] = [
    ("kg", "t"),
    ("kg.m", "t.m"),
    ("kg.m2", "t.m2"),
    ("N", "kN"),
    ("N/m", "kN/m"),
    ("N.s/m", "kN.s/m"),
    ("N.m/rad", "kN.m/rad"),
];

impl Units {
    /// The `value` of a number whose SI unit is `unit`, in SI units.
    pub fn in_si(self, value: f64, unit: &str) -> f64 {
        let is_large = self == Units::Kilonewtons && LARGE.iter().any(|(si, _)| *si == unit);
        if is_large { 1e3 * value } else { value }
    }

    /// The `message` about numbers in SI units, with these numbers as they were given: before a unit, and before "and" and a number.
    pub fn message(self, message: impl Display) -> String {
        let message = message.to_string();
        let mut words: Vec<String> = message.split(' ').map(str::to_owned).collect();
        for i in (0..words.len()).filter(|_| self == Units::Kilonewtons) {
            let is_mark = |letter| "(),;:?".contains(letter);
            let Some((si, large)) = LARGE.iter().find(|(si, _)| *si == words[i].trim_matches(is_mark)) else {
                continue;
            };
            words[i] = words[i].replace(si, large);
            let before = if i > 2 && words[i - 2] == "and" { vec![i - 1, i - 3] } else { vec![i.saturating_sub(1)] };
            let numbers = before.into_iter().map_while(|j| Some((j, words[j].parse::<f64>().ok()?)));
            numbers.collect::<Vec<_>>().into_iter().for_each(|(j, number)| words[j] = short(number / 1e3));
        }
        words.join(" ")
    }
}

/// A number of `T`, such as a parameter or an initial value, with its name, unit and range.
#[derive(Debug)]
pub struct Quantity<T> {
    /// Symbol of the field, as in files and in the FMU.
    pub name: &'static str,
    /// Unit, as FMI writes it (`kg.m2`); `1` for a ratio.
    pub unit: &'static str,
    /// Description in one line.
    pub description: &'static str,
    /// Smallest value accepted.
    pub min: f64,
    /// Largest value accepted.
    pub max: f64,
    /// Reads the number.
    pub get: fn(&T) -> f64,
    /// Writes the number without a check.
    pub set: fn(&mut T, f64),
}

/// A number outside the range of its quantity (or not a number at all).
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "{name} = {} is out of range: it must lie between {} and {} ({description})",
    with_unit(*value, unit),
    with_unit(*min, "1"),
    with_unit(*max, unit)
)]
#[allow(missing_docs)] // as in [`Quantity`]
pub struct OutOfRange {
    pub name: &'static str,
    pub value: f64,
    pub unit: &'static str,
    pub min: f64,
    pub max: f64,
    pub description: &'static str,
}

/// Why numbers are refused, in words: the number, its value, the limit and the remedy.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Refused(pub String);

impl Refused {
    /// The message of another error.
    pub fn by(error: impl Display) -> Refused {
        Refused(error.to_string())
    }
}

impl From<OutOfRange> for Refused {
    fn from(error: OutOfRange) -> Refused {
        Refused::by(error)
    }
}

/// Refuses what is not so, with this message.
pub fn ensure(is_so: bool, message: impl FnOnce() -> String) -> Result<(), Refused> {
    if is_so { Ok(()) } else { Err(Refused(message())) }
}

impl Quantity<f64> {
    /// The limits of a number that no field holds.
    pub const fn limit(
        name: &'static str,
        unit: &'static str,
        [min, max]: [f64; 2],
        description: &'static str,
    ) -> Self {
        Quantity { name, unit, description, min, max, get: |of| *of, set: |of, value| *of = value }
    }
}

impl<T> Quantity<T> {
    /// Accepts `value` (in the unit of the quantity) if it is in range. NaN and ±∞ are out of range.
    #[inline]
    pub fn check(&self, value: f64) -> Result<(), OutOfRange> {
        if (self.min..=self.max).contains(&value) { Ok(()) } else { Err(self.refused(value)) }
    }

    #[cold]
    fn refused(&self, value: f64) -> OutOfRange {
        let &Quantity { name, unit, description, min, max, .. } = self;
        OutOfRange { name, value, unit, min, max, description }
    }
}

/// A [`Quantity`] whose name is the name of the field that holds it.
#[macro_export]
macro_rules! quantity {
    ($name:ident [$unit:literal] $min:expr, $max:expr, $description:literal) => {
        $crate::quantity!(stringify!($name), $name [$unit] $min, $max, $description)
    };
    ($name:expr, $field:ident [$unit:literal] $min:expr, $max:expr, $description:literal) => {
        $crate::structure::quantity::Quantity {
            name: $name,
            unit: $unit,
            description: $description,
            min: $min,
            max: $max,
            get: |of| of.$field,
            set: |of, value| of.$field = value,
        }
    };
}
pub use quantity;
