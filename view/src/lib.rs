//! A run as a page that shows the structure in motion, one file that needs nothing else, and as what such a page draws.
#![allow(non_snake_case)] // P_t, F_d1

use rocking::mechanics::restraint::Restraints;
use rocking::run::curve::{Curve, Point};
use rocking::run::{Ending, RunError, fall::Found, peaks};
use rocking::{Outputs, Parameters, Run};
use serde::Serialize;

/// What a page with [`MOTION`] looks like.
pub const STYLE: &str = include_str!("view.css");

/// The elements of a page that show a motion: the last in its `main`, and those after it.
pub const MOTION: &str = include_str!("motion.html");

/// The script that shows a [`Scene`] in them: the function `motionView`.
pub const SCRIPT: &str = include_str!("motion.js");

/// Parts of a peak by which what is shown may miss the motion: units of the last digit of its numbers. The first is taken
/// that needs no more than [`MOST_POINTS`].
const PARTS: [f64; 3] = [1e-4, 1e-3, 1e-2];

/// About 5 MB.
const MOST_POINTS: usize = 200_000;

/// Part of the largest that a value on the page is rounded to, and the same of time, s.
const QUANTUM: f64 = 1e-5;
const QUANTUM_OF_TIME: f64 = 1e-7;

/// The page that shows `run`.
pub fn page(run: &Run) -> Result<String, RunError> {
    let (part, curve) = curve(run)?;
    // in JSON a < stands within strings alone; escaped it cannot end the element that holds the data
    let data = Scene::new(run, part, &curve).json().replace('<', "\\u003c");
    Ok(include_str!("view.html")
        .replacen("/*style*/", STYLE, 1)
        .replacen("/*motion*/", MOTION, 1)
        .replacen("/*motion.js*/", SCRIPT, 1)
        .replacen("/*view.js*/", include_str!("view.js"), 1)
        .replacen("/*data*/", &data, 1))
}

/// The run as a curve, and how exact it is.
fn curve(run: &Run) -> Result<(f64, Curve), RunError> {
    let [finest, coarser @ ..] = PARTS;
    let mut found = (finest, run.curve(finest));
    for part in coarser {
        let takes_too_many = match &found.1 {
            Ok(curve) => curve.points.len() > MOST_POINTS,
            Err(error) => matches!(error, RunError::TooManyPoints { .. }),
        };
        if takes_too_many {
            found = (part, run.curve(part));
        }
    }
    Ok((found.0, found.1?))
}

/// What a page shows of a run.
#[derive(Serialize)]
pub struct Scene<'a> {
    title: &'a str,
    parameters: &'a Parameters,
    start: f64,
    ending: Ending,
    /// Since when it falls: the peaks are those before.
    fall: Option<f64>,
    part: f64,
    time: Column,
    a_g: Column,
    theta: Column,
    u: Column,
    a_t: Column,
    /// Forces of the tendon and of the dissipators, of a restrained structure.
    #[serde(flatten)]
    ties: Option<Ties>,
    /// Index of the first point of each phase, and the phase.
    phases: Vec<(usize, &'static str)>,
    /// Quanta of time from the start, and the kind.
    transitions: Vec<(i64, &'static str)>,
    /// By name: magnitude in SI units, instant (s).
    peaks: Vec<(&'static str, f64, f64)>,
}

/// Forces, N.
#[derive(Serialize)]
struct Ties {
    P_t: Column,
    F_d1: Column,
    F_d2: Column,
}

/// Whole multiples of a quantum.
#[derive(Serialize)]
struct Column {
    quantum: f64,
    /// Of time the differences.
    values: Vec<i64>,
}

impl Column {
    fn new(curve: &Curve, value: impl Fn(&Point) -> f64) -> Column {
        let most = curve.points.iter().map(|at| value(at).abs()).fold(0.0, f64::max);
        let quantum = if most > 0.0 { QUANTUM * most } else { 1.0 };
        Column { quantum, values: curve.points.iter().map(|at| (value(at) / quantum).round() as i64).collect() }
    }

    /// Of the time since `start` (s).
    fn of_time(curve: &Curve, start: f64) -> Column {
        let instants = curve.points.iter().map(|at| quanta(at.time - start));
        let differences = instants.scan(0, |before, instant| Some(instant - std::mem::replace(before, instant)));
        Column { quantum: QUANTUM_OF_TIME, values: differences.collect() }
    }
}

/// A length of time, s.
fn quanta(duration: f64) -> i64 {
    (duration / QUANTUM_OF_TIME).round() as i64
}

impl<'a> Scene<'a> {
    /// Of a `run` whose `curve` leaves the motion by at most this `part` of its peaks.
    pub fn new(run: &'a Run, part: f64, curve: &Curve) -> Scene<'a> {
        let Found { ground: a_g, peaks: found, fall, start, finish } = curve.found;
        let column = |value: fn(&Outputs) -> f64| Column::new(curve, move |at| value(&at.outputs));
        let mut phases: Vec<_> = curve.points.iter().map(|at| at.phase.name()).enumerate().collect();
        phases.dedup_by_key(|(_, phase)| *phase);
        let tie = |force: fn(&Restraints) -> f64| Column::new(curve, move |at| force(&at.restraints));
        let ties = || Ties { P_t: tie(|of| of.P_t), F_d1: tie(|of| of.F_d1), F_d2: tie(|of| of.F_d2) };
        let all_peaks = peaks::of(&run.structure).map(|peaking| (peaking.name, peaking.of(&found)));
        let all_peaks = [("a_g", a_g)].into_iter().chain(all_peaks);
        Scene {
            title: run.ground.title(),
            parameters: run.structure.parameters(),
            start,
            ending: finish.ending,
            fall,
            part,
            time: Column::of_time(curve, start),
            a_g: Column::new(curve, |at| at.a_g),
            theta: column(|outputs| outputs.theta),
            u: column(|outputs| outputs.u),
            a_t: column(|outputs| outputs.a_t),
            ties: run.structure.is_restrained().then(ties),
            phases,
            transitions: curve.transitions.iter().map(|at| (quanta(at.time - start), at.kind.name())).collect(),
            peaks: all_peaks.map(|(name, peak)| (name, peak.magnitude, peak.time)).collect(),
        }
    }

    /// As the script reads it.
    pub fn json(&self) -> String {
        serde_json::to_string(self).expect("its names are text")
    }
}
