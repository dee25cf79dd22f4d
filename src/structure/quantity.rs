//! A named number with a unit and a range: the one table that checks, messages, files and the FMU read.

use crate::digits::with_unit;

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
pub struct OutOfRange {
    /// The quantity's name.
    pub name: &'static str,
    /// The refused value.
    pub value: f64,
    /// Its unit.
    pub unit: &'static str,
    /// Smallest value accepted.
    pub min: f64,
    /// Largest value accepted.
    pub max: f64,
    /// Description of the quantity.
    pub description: &'static str,
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
