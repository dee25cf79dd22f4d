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

/// A unit in the place of one of SI.
#[derive(Clone, Copy, Debug)]
pub struct ReadUnit {
    /// Its name.
    pub name: &'static str,
    /// The unit of SI, as FMI writes it.
    pub of: &'static str,
    /// Its size in that unit; None is g, the structure's own.
    size: Option<f64>,
    /// Who reads it.
    pub reader: Reader,
}

const fn unit(name: &'static str, of: &'static str, size: f64, reader: Reader) -> ReadUnit {
    ReadUnit { name, of, size: Some(size), reader }
}

/// The units beside those of SI.
pub const UNITS: [ReadUnit; 12] = [
    unit("deg", "rad", PI / 180.0, Reader::Hosts),
    unit("mrad", "rad", 1e-3, Reader::Axes(0.0, 0.1)),
    unit("%", "rad", 1e-2, Reader::Limits),
    unit("cm", "m", 1e-2, Reader::Limits),
    unit("mm", "m", 1e-3, Reader::All),
    unit("ms", "s", 1e-3, Reader::Hosts),
    ReadUnit { name: "g", of: "m/s2", size: None, reader: Reader::All },
    unit("cm/s2", "m/s2", 1e-2, Reader::Limits),
    unit("kN", "N", 1e3, Reader::All),
    unit("MN", "N", 1e6, Reader::Axes(1e7, f64::INFINITY)),
    unit("kN.m", "N.m", 1e3, Reader::All),
    unit("%", "1", 1e-2, Reader::Limits),
];

impl ReadUnit {
    /// Its size in the unit of SI; `g` in m/s².
    pub fn size(&self, g: f64) -> f64 {
        self.size.unwrap_or(g)
    }

    /// The size and the name of the unit in the place of `unit` (SI) in pictures; `g` in m/s².
    pub fn in_pictures(unit: &str, g: f64) -> (f64, &str) {
        let read = UNITS.iter().find(|read| read.of == unit && read.reader == Reader::All);
        read.map_or((1.0, unit), |read| (read.size(g), read.name))
    }
}
