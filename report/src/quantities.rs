//! Named values for people and for programs.
use rocking::digits::significant;
use serde::{Serialize, Serializer};

/// One value, its unit (`1` for a ratio) and the equation of the paper that defines it.
#[derive(Clone, Serialize)]
#[allow(missing_docs)]
pub struct NamedValue {
    pub name: String,
    pub value: f64,
    pub unit: &'static str,
    pub equation: &'static str,
    pub description: String,
}

impl NamedValue {
    /// A value of a fixed name.
    pub fn new(name: &str, value: f64, unit: &'static str, equation: &'static str, description: &str) -> NamedValue {
        NamedValue { name: name.into(), value, unit, equation, description: description.into() }
    }
}

/// The unit in which people read a force or a moment (N, N.m) of this `magnitude`: its size in SI units, and its name. Any
/// other `unit` stays.
pub fn readable(magnitude: f64, unit: &str) -> (f64, &str) {
    match unit {
        "N" if magnitude.abs() >= 1e3 => (1e3, "kN"),
        "N.m" if magnitude.abs() >= 1e3 => (1e3, "kN.m"),
        unit => (1.0, unit),
    }
}

/// The unit in which people read the peak of a motion of this `magnitude`: mm, multiples of `g` (m/s²), or that of [`readable`].
pub fn of_motion(magnitude: f64, unit: &str, g: f64) -> (f64, &str) {
    match unit {
        "m" => (1e-3, "mm"),
        "m/s2" => (g, "g"),
        unit => readable(magnitude, unit),
    }
}

/// A force or a moment in the unit of [`readable`], written by `digits`.
pub fn in_readable_unit(value: f64, unit: &str, digits: fn(f64) -> String) -> String {
    let (per_unit, unit) = readable(value, unit);
    format!("{} {unit}", digits(value / per_unit))
}

/// `lines` in columns; accelerations also in multiples of `g` (m/s²).
pub fn columns(lines: &[NamedValue], g: f64) -> String {
    let line = |NamedValue { name, value, unit, equation, description }: &NamedValue| {
        let in_g = if *unit == "m/s2" { format!("{:.4} g", value / g) } else { String::new() };
        let (per_unit, unit) = readable(*value, if *unit == "1" { "-" } else { unit });
        let value = significant(*value / per_unit);
        format!("  {name:<20} {value:>12} {unit:<6} {in_g:>10}  {equation:<13} {description}\n")
    };
    lines.iter().map(line).collect()
}

/// A number that may be infinite, for which JSON has no number: it is the text "inf" there, as in a table.
pub struct PrintedNumber(pub f64);

impl Serialize for PrintedNumber {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let PrintedNumber(value) = *self;
        if value.is_finite() { serializer.serialize_f64(value) } else { serializer.collect_str(&value) }
    }
}
