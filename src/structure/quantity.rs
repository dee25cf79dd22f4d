//! A named number with a unit and a range: the one table that checks, messages, files and the FMU read.

use crate::digits::{short, with_unit};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::fmt::Display;

/// The units in which a description gives masses and forces; lengths are in m and times in s.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub enum Units {
    /// SI units.
    #[default]
    #[serde(rename = "N, m, kg")]
    Newtons,
    /// 1000 times the SI unit of each number that contains a mass or a force.
    #[serde(rename = "kN, m, t")]
    Kilonewtons,
}

impl Units {
    /// The size (SI) of the unit among these that stands for the SI `unit`.
    fn size(self, unit: &str) -> f64 {
        if self.name(unit) == unit { 1.0 } else { 1e3 }
    }

    /// The `value` of a number whose SI unit is `unit`, in SI units.
    pub fn in_si(self, value: f64, unit: &str) -> f64 {
        self.size(unit) * value
    }

    /// The name of the unit among these that stands for the SI `unit`.
    pub fn name(self, unit: &str) -> Cow<'_, str> {
        match (self, unit.strip_prefix("kg"), unit.strip_prefix('N')) {
            (Units::Kilonewtons, Some(rest), _) => format!("t{rest}").into(),
            (Units::Kilonewtons, _, Some(rest)) => format!("kN{rest}").into(),
            _ => unit.into(),
        }
    }

    /// `value`, in the SI `unit`, for a sentence in these units.
    pub fn show(self, value: f64, unit: &str) -> String {
        with_unit(value / self.size(unit), &self.name(unit))
    }

    /// As [`Units::show`], but with these `digits` of a number in an SI unit.
    pub fn show_by(self, digits: impl Fn(f64) -> String, value: f64, unit: &str) -> String {
        if self.name(unit) == unit { format!("{} {unit}", digits(value)) } else { self.show(value, unit) }
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
#[error("{}", self.shown(Units::Newtons))]
#[allow(missing_docs)] // as in [`Quantity`]
pub struct OutOfRange {
    pub name: &'static str,
    pub value: f64,
    pub unit: &'static str,
    pub min: f64,
    pub max: f64,
    pub description: &'static str,
}

impl OutOfRange {
    /// The message with its numbers in `units`.
    pub fn shown(&self, units: Units) -> String {
        let &OutOfRange { name, value, unit, min, max, description } = self;
        let ([value, max], min) = ([value, max].map(|of| units.show(of, unit)), short(min / units.size(unit)));
        format!("{name} = {value} is out of range: it must lie between {min} and {max} ({description})")
    }
}

/// Why numbers are refused, in words: the number, its value, the limit and the remedy. It has the words in all [`Units`], and displays
/// those in SI units.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{}", .0[0])]
pub struct Refused(Box<[String; 2]>);

impl Refused {
    /// The message of another error, the same in all units.
    pub fn by(error: impl Display) -> Refused {
        Refused::shown(|_| error.to_string())
    }

    /// This `message`, which shows its numbers in the units that it is given.
    pub fn shown(message: impl Fn(Units) -> String) -> Refused {
        Refused(Box::new([Units::Newtons, Units::Kilonewtons].map(message)))
    }

    /// This message with its numbers in `units`.
    pub fn in_units(&self, units: Units) -> Refused {
        Refused::by(&self.0[units as usize])
    }

    /// This message about a part of the whole, which it names first.
    pub fn of(&self, part: &str) -> Refused {
        Refused::shown(|units| format!("{part}: {}", self.0[units as usize]))
    }
}

impl From<OutOfRange> for Refused {
    fn from(error: OutOfRange) -> Refused {
        Refused::shown(|units| error.shown(units))
    }
}

/// Refuses what is not so, with this message.
pub fn ensure(is_so: bool, message: impl FnOnce() -> String) -> Result<(), Refused> {
    if is_so { Ok(()) } else { Err(Refused::by(message())) }
}

/// Refuses what is not so, with this message as of [`Refused::shown`].
pub(crate) fn ensure_in(is_so: bool, message: impl Fn(Units) -> String) -> Result<(), Refused> {
    if is_so { Ok(()) } else { Err(Refused::shown(message)) }
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
