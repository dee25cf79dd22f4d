//! A named number with a unit and a range: the one table that checks, messages, files and the FMU read.

/// One number of `T` (a parameter of the structure, an initial value): what it is called, its unit, its range.
#[derive(Debug)]
pub struct Quantity<T> {
    /// The field's own symbol, as in files and in the FMU.
    pub name: &'static str,
    /// Unit, as FMI writes it (`kg.m2`); `1` for a ratio.
    pub unit: &'static str,
    /// What it is, in one line.
    pub description: &'static str,
    /// Smallest value accepted.
    pub min: f64,
    /// Largest value accepted.
    pub max: f64,
    /// Reads it.
    pub get: fn(&T) -> f64,
    /// Writes it, unchecked.
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
    /// What the quantity is.
    pub description: &'static str,
}

impl<T> Quantity<T> {
    /// Accepts `value` (in the quantity's unit), or says by name, value and limit why not. NaN and ±∞ are refused.
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

/// `value` with its unit, which a ratio has none of, in digits that stay few.
pub fn with_unit(value: f64, unit: &str) -> String {
    let digits = if value.abs() < 1e7 { format!("{value:?}") } else { format!("{value:e}") };
    let digits = digits.strip_suffix(".0").unwrap_or(&digits);
    if unit == "1" { digits.into() } else { format!("{digits} {unit}") }
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
