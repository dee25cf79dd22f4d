//! Named values for people and for programs.
use crate::run::RunSetup;
use rocking::Output;
use rocking::digits::significant;
use rocking::mechanics::shown::{GROUND, Legend, Place, in_pictures};
use serde::{Serialize, Serializer};

/// One value, its unit (`1` for a ratio) and the equation of the paper that defines it.
#[derive(Clone, Serialize)]
pub struct NamedValue {
    pub name: String,
    pub value: f64,
    pub unit: &'static str,
    pub equation: &'static str,
    pub description: String,
}

impl NamedValue {
    pub fn new(name: &str, value: f64, unit: &'static str, equation: &'static str, description: &str) -> NamedValue {
        NamedValue { name: name.into(), value, unit, equation, description: description.into() }
    }
}

/// The unit in which people read the peak of a motion of this `magnitude`: its size in SI units, and its name; `g` in m/s². Forces
/// and moments below 1000 stay in SI units.
pub fn of_motion(magnitude: f64, unit: &str, g: f64) -> (f64, &str) {
    let (per_unit, name) = in_pictures(unit, g);
    if per_unit >= 1e3 && magnitude.abs() < per_unit { (1.0, unit) } else { (per_unit, name) }
}

/// The same of a force or a moment. Any other `unit` stays.
pub fn readable(magnitude: f64, unit: &str) -> (f64, &str) {
    if matches!(unit, "N" | "N.m") { of_motion(magnitude, unit, 1.0) } else { (1.0, unit) }
}

impl RunSetup {
    /// The ground acceleration and the outputs that `place` shows, of floors the top, each with its name, and the size (SI) and name of its
    /// unit.
    pub fn histories(&self, place: Place) -> Vec<(String, Legend, (f64, &'static str))> {
        let (structure, g) = (&self.structure, self.structure.base().g);
        let is_top = |of: &Output| of.number().is_none_or(|number| number + 1 == structure.floors().len());
        let outputs = Output::shown_in(place, structure).into_iter().filter(is_top);
        let named = outputs.filter_map(|of| Some((of.name(structure), *of.legend()?, in_pictures(of.unit(), g))));
        [(GROUND.symbol.into(), GROUND, in_pictures("m/s2", g))].into_iter().chain(named).collect()
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
