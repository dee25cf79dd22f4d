//! What people read: labels, symbols and units, and the places that show an output. All doors have them from here.

use serde::Serialize;
use std::f64::consts::PI;

/// A place that shows a run.
#[derive(Clone, Copy, Debug, PartialEq, PartialOrd, Serialize)]
pub enum Place {
    /// The structure on the page moves by the output.
    Scene,
    /// The numbers of the page at its cursor.
    Numbers,
    /// The histories of the page.
    Page,
    /// The histories of the page, on ground that gives.
    PageOnGround,
    /// Pictures of histories.
    Histories,
    /// The command line's picture of the histories of one mass.
    OneMass,
    /// Pictures over the height, at the floors.
    Floors,
    /// Pictures over the height, along the storeys.
    Storeys,
    /// Pictures over the height, at the feet of the storeys.
    Feet,
}

/// An output, or the ground acceleration, as people read it.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct Legend {
    /// The label in words.
    pub label: &'static str,
    /// The symbol in an equation.
    pub symbol: &'static str,
    /// The places that show it.
    pub places: &'static [Place],
}

/// The ground acceleration, which all pictures over time show first.
pub const GROUND: Legend =
    Legend { label: "ground acceleration", symbol: "a_g", places: &[Place::Page, Place::Numbers] };

/// Who reads a quantity in a unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Reader {
    /// Pictures, pages, tables for people and hosts.
    All,
    /// Hosts of FMUs.
    Hosts,
    /// The axis of a history on the page if the largest magnitude (SI) is from the first on and below the second.
    Axes(f64, f64),
    /// Nobody: limits are given in it.
    Limits,
}

/// The units in the place of those of SI: the name, the unit of SI as FMI writes it, the size there (None is g, the structure's own), and who
/// reads it.
pub const UNITS: [(&str, &str, Option<f64>, Reader); 12] = [
    ("deg", "rad", Some(PI / 180.0), Reader::Hosts),
    ("mrad", "rad", Some(1e-3), Reader::Axes(0.0, 0.1)),
    ("%", "rad", Some(1e-2), Reader::Limits),
    ("cm", "m", Some(1e-2), Reader::Limits),
    ("mm", "m", Some(1e-3), Reader::All),
    ("ms", "s", Some(1e-3), Reader::Hosts),
    ("g", "m/s2", None, Reader::All),
    ("cm/s2", "m/s2", Some(1e-2), Reader::Limits),
    ("kN", "N", Some(1e3), Reader::All),
    ("MN", "N", Some(1e6), Reader::Axes(1e7, f64::INFINITY)),
    ("kN.m", "N.m", Some(1e3), Reader::All),
    ("%", "1", Some(1e-2), Reader::Limits),
];

/// The size and the name of the unit in the place of `unit` (SI) in pictures; `g` in m/s².
pub fn in_pictures(unit: &str, g: f64) -> (f64, &str) {
    let read = UNITS.iter().find(|(_, of, _, reader)| *of == unit && *reader == Reader::All);
    read.map_or((1.0, unit), |(name, _, size, _)| (size.unwrap_or(g), *name))
}
