//! A run as a page that shows the structure in motion, one file that needs nothing else, and as what such a page draws.

use rocking::mechanics::shown::Legend;
use rocking::run::Ending;
use serde::Serialize;

pub const STYLE: &str = include_str!("view.css");

/// The elements of a page that show a motion: the last in its `main`, and those after it.
pub const MOTION: &str = include_str!("motion.html");

/// The script that shows a [`ShownScene`] in them: the function `motionView`.
pub const SCRIPT: &str = include_str!("motion.js");

/// Part of the largest that a value on the page is rounded to, and the same of time, s.
const QUANTUM: f64 = 1e-5;
const QUANTUM_OF_TIME: f64 = 1e-7;

/// The content of a page about a run.
#[derive(Serialize)]
pub struct ShownScene {
    pub title: String,
    pub parameters: Sizes,
    /// Start of the run, s.
    pub start: f64,
    pub ending: Ending,
    /// Since when it falls, s: the peaks are those before.
    pub fall: Option<f64>,
    /// Part of its peak by which a column may leave the motion.
    pub part: f64,
    pub time: Quanta,
    pub quantities: Vec<ShownQuantity>,
    /// By name; of a restrained structure also the forces of the tendon and of the dissipators.
    pub columns: Vec<(String, Quanta)>,
    /// Index of the first point of each phase, and the phase.
    pub phases: Vec<(usize, &'static str)>,
    /// Quanta of time from the start, and the kind.
    pub transitions: Vec<(i64, &'static str)>,
    /// The peaks of the ground and of the structure.
    pub peaks: Vec<DrawnPeak>,
    /// The peaks on a fixed base, of many masses.
    pub fixed: Vec<DrawnPeak>,
}

/// A quantity as the page shows it, an output of floors once: its name without the number of a floor; its unit, and the size of that in SI
/// units; units of the axis of its history, their sizes, and from and below which largest magnitude it has them; the quantity of which it is a
/// multiple in every motion, and the factor.
#[derive(Serialize)]
pub struct ShownQuantity {
    pub name: &'static str,
    #[serde(flatten)]
    pub legend: Legend,
    pub unit: &'static str,
    pub per: f64,
    pub axes: Vec<(&'static str, f64, f64, f64)>,
    pub over: Option<(&'static str, f64)>,
}

/// Name, magnitude in SI units, instant (s).
pub type DrawnPeak = (String, f64, f64);

/// A structure as it is drawn, in SI units.
#[derive(Serialize)]
pub struct Sizes {
    /// Mass above the base.
    pub m: f64,
    pub m0: f64,
    /// Height of the top.
    pub H: f64,
    pub B: f64,
    /// Lowest frequency in full contact.
    pub f_fc: f64,
    pub g: f64,
    /// The name of each tie's force, its place along the base, and the size and name of its unit.
    pub ties: Vec<(&'static str, f64, f64, &'static str)>,
    /// Places of the contact points on ground that gives.
    pub points: Vec<f64>,
    /// Mass and height of each floor from below, of many masses.
    pub floors: Option<Vec<[f64; 2]>>,
}

/// Whole multiples of a quantum.
#[derive(Serialize)]
pub struct Quanta {
    quantum: f64,
    /// The differences from 0 on.
    values: Vec<i64>,
}

impl Quanta {
    fn of(values: &[f64], quantum: f64) -> Quanta {
        let whole = values.iter().map(|value| (value / quantum).round() as i64);
        let differences = whole.scan(0, |before, value| Some(value - std::mem::replace(before, value)));
        Quanta { quantum, values: differences.collect() }
    }

    pub fn new(values: &[f64]) -> Quanta {
        let most = values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        Quanta::of(values, if most > 0.0 { QUANTUM * most } else { 1.0 })
    }

    /// Of the `times` of the points since `start` (s).
    pub fn of_time(times: &[f64], start: f64) -> Quanta {
        Quanta::of(&Vec::from_iter(times.iter().map(|time| time - start)), QUANTUM_OF_TIME)
    }
}

/// A length of time (s) in quanta.
pub fn quanta(duration: f64) -> i64 {
    (duration / QUANTUM_OF_TIME).round() as i64
}

impl ShownScene {
    pub fn values(&self) -> usize {
        self.time.values.len() * (1 + self.columns.len())
    }

    pub fn json(&self) -> String {
        serde_json::to_string(self).expect("its names are text")
    }

    pub fn page(&self) -> String {
        // in JSON a < stands within strings alone; escaped it cannot end the element that holds the data
        let data = self.json().replace('<', "\\u003c");
        include_str!("view.html")
            .replacen("/*style*/", STYLE, 1)
            .replacen("/*motion*/", MOTION, 1)
            .replacen("/*motion.js*/", SCRIPT, 1)
            .replacen("/*view.js*/", include_str!("view.js"), 1)
            .replacen("/*data*/", &data, 1)
    }
}
