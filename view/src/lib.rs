//! A run as a page that shows the structure in motion, one file that needs nothing else, and as what such a page draws.
#![allow(non_snake_case)] // P_t, F_d1

use rocking::mechanics::restraint::Restraints;
use rocking::run::curve::{Curve, Drawn, Point, drawn};
use rocking::run::{Ending, RunError, fall::Found, peaks, profile::Profile};
use rocking::structure::{Ties, any::OF_MODE};
use rocking::{Detail, FrameOutput, Modes, Outputs, Parameters, Run};
use serde::Serialize;

/// What a page with [`MOTION`] looks like.
pub const STYLE: &str = include_str!("view.css");

/// The elements of a page that show a motion: the last in its `main`, and those after it.
pub const MOTION: &str = include_str!("motion.html");

/// The script that shows a [`Scene`] in them: the function `motionView`.
pub const SCRIPT: &str = include_str!("motion.js");

/// Parts of a peak by which what is shown may miss the motion: units of the last digit of its numbers. The first is taken
/// that needs no more than [`MOST_VALUES`].
const PARTS: [f64; 3] = [1e-4, 1e-3, 1e-2];

/// The largest number of values: about 5 MB.
const MOST_VALUES: usize = 1_000_000;

/// Part of the largest that a value on the page is rounded to, and the same of time, s.
const QUANTUM: f64 = 1e-5;
const QUANTUM_OF_TIME: f64 = 1e-7;

/// The page that shows `run`.
pub fn page<Q: Shown>(run: &Run<Q>) -> Result<String, RunError> {
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
fn curve<Q: Shown>(run: &Run<Q>) -> Result<(f64, Curve<Q>), RunError> {
    let [finest, coarser @ ..] = PARTS;
    let mut found = (finest, run.curve(finest));
    for part in coarser {
        let takes_too_many = match &found.1 {
            Ok(curve) => curve.points.len() * (2 + Q::columns(run, curve).len()) > MOST_VALUES,
            Err(error) => matches!(error, RunError::TooManyPoints { .. }),
        };
        if takes_too_many {
            found = (part, run.curve(part));
        }
    }
    Ok((found.0, found.1?))
}

/// Lateral coordinates of structures that a page shows.
pub trait Shown: Drawn {
    /// The structure as it is drawn.
    fn sizes(structure: &Self::Structure) -> Sizes;

    /// The histories of the structure, by name.
    fn columns(run: &Run<Self>, curve: &Curve<Self>) -> Vec<(String, Column)>;

    /// The peaks of the structure.
    fn peaks(structure: &Self::Structure, peaks: &Self::Peaks) -> Vec<Peak>;

    /// The peaks of the same structure of many masses on a fixed base until `end` (s).
    fn fixed(_run: &Run<Self>, _end: f64) -> Vec<Peak> {
        Vec::new()
    }
}

/// Name, magnitude in SI units, instant (s).
type Peak = (String, f64, f64);

/// A structure as it is drawn, in SI units.
#[derive(Serialize)]
pub struct Sizes {
    /// Mass above the base.
    m: f64,
    m0: f64,
    /// Height of the top.
    H: f64,
    B: f64,
    /// Lowest frequency in full contact.
    f_fc: f64,
    g: f64,
    P_0: f64,
    k_t: f64,
    xi_d: f64,
    c_d: f64,
    k_d: f64,
    /// Mass and height of each floor from below, of many masses.
    floors: Option<Vec<[f64; 2]>>,
}

impl Shown for f64 {
    fn sizes(structure: &rocking::Structure) -> Sizes {
        let &Parameters { m, m0, H, B, f_fc, g, P_0, k_t, xi_d, c_d, k_d, .. } = structure.parameters();
        Sizes { m, m0, H, B, f_fc, g, P_0, k_t, xi_d, c_d, k_d, floors: None }
    }

    fn columns(_run: &Run, Curve { points, .. }: &Curve) -> Vec<(String, Column)> {
        let column =
            |name: &str, value: fn(&Outputs) -> f64| (name.into(), Column::new(points, |at| value(&at.outputs)));
        vec![column("theta", |of| of.theta), column("u", |of| of.u), column("a_t", |of| of.a_t)]
    }

    fn peaks(structure: &rocking::Structure, all: &peaks::Peaks) -> Vec<Peak> {
        peaks::of(structure).map(|peaking| named(peaking.name, peaking.of(all))).collect()
    }
}

impl Shown for Modes {
    fn sizes(frame: &rocking::Frame) -> Sizes {
        let (body, base, &Ties { P_0, k_t, xi_d, c_d, k_d, .. }) = (frame.body(), frame.base(), &frame.base().ties);
        let floors: Vec<_> = frame.floors().iter().map(|floor| [floor.mass, floor.height]).collect();
        let H = floors.last().map_or(body.S_1 / body.m_s, |[_, height]| *height);
        let f_fc = frame.mode_table().next().map_or(0.0, |first| (OF_MODE[0].value)(&first));
        Sizes {
            m: body.m_s,
            m0: body.m0,
            H,
            B: base.B,
            f_fc,
            g: base.g,
            P_0,
            k_t,
            xi_d,
            c_d,
            k_d,
            floors: Some(floors),
        }
    }

    fn columns(run: &Run<Modes>, Curve { points, .. }: &Curve<Modes>) -> Vec<(String, Column)> {
        let column = |(i, of): (usize, FrameOutput)| (of.name(), Column::new(points, |at| at.outputs[i]));
        drawn(&run.structure).enumerate().map(column).collect()
    }

    fn peaks(_: &rocking::Frame, profile: &Profile) -> Vec<Peak> {
        profile.peaks().map(|(of, peak)| named(&of.name(), peak)).collect()
    }

    fn fixed(run: &Run<Modes>, end: f64) -> Vec<Peak> {
        let is_other = run.detail != Detail::FixedBase;
        let found = is_other.then(|| run.on_fixed_base(end).found(&mut ()).ok()).flatten();
        let peaks = |found: Found<Modes>| {
            [named("a_g", found.ground)].into_iter().chain(Modes::peaks(&run.structure, &found.peaks)).collect()
        };
        found.map_or(Vec::new(), peaks)
    }
}

fn named(name: &str, peak: peaks::Peak) -> Peak {
    (name.into(), peak.magnitude, peak.time)
}

/// What a page shows of a run.
#[derive(Serialize)]
pub struct Scene<'a> {
    title: &'a str,
    parameters: Sizes,
    start: f64,
    ending: Ending,
    /// Since when it falls: the peaks are those before.
    fall: Option<f64>,
    part: f64,
    time: Column,
    /// By name; of a restrained structure also the forces of the tendon and of the dissipators.
    columns: Vec<(String, Column)>,
    /// Index of the first point of each phase, and the phase.
    phases: Vec<(usize, &'static str)>,
    /// Quanta of time from the start, and the kind.
    transitions: Vec<(i64, &'static str)>,
    peaks: Vec<Peak>,
    /// The peaks on a fixed base, of many masses.
    fixed: Vec<Peak>,
}

/// Whole multiples of a quantum.
#[derive(Serialize)]
pub struct Column {
    quantum: f64,
    /// Of time the differences.
    values: Vec<i64>,
}

impl Column {
    fn new<O>(points: &[Point<O>], value: impl Fn(&Point<O>) -> f64) -> Column {
        let most = points.iter().map(|at| value(at).abs()).fold(0.0, f64::max);
        let quantum = if most > 0.0 { QUANTUM * most } else { 1.0 };
        Column { quantum, values: points.iter().map(|at| (value(at) / quantum).round() as i64).collect() }
    }

    /// Of the time since `start` (s).
    fn of_time<O>(points: &[Point<O>], start: f64) -> Column {
        let instants = points.iter().map(|at| quanta(at.time - start));
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
    pub fn new<Q: Shown>(run: &'a Run<Q>, part: f64, curve: &Curve<Q>) -> Scene<'a> {
        let Found { ground, ref peaks, fall, start, ref finish } = curve.found;
        let peaks = [named("a_g", ground)].into_iter().chain(Q::peaks(&run.structure, peaks)).collect();
        let points = &curve.points;
        let mut phases: Vec<_> = points.iter().map(|at| at.phase.name()).enumerate().collect();
        phases.dedup_by_key(|(_, phase)| *phase);
        let mut columns = vec![("a_g".into(), Column::new(points, |at| at.a_g))];
        columns.extend(Q::columns(run, curve));
        if Q::base(&run.structure).is_restrained() {
            let mut tie = |name: &str, force: fn(&Restraints) -> f64| {
                columns.push((name.into(), Column::new(points, |at| force(&at.restraints))));
            };
            tie("P_t", |of| of.P_t);
            tie("F_d1", |of| of.F_d1);
            tie("F_d2", |of| of.F_d2);
        }
        Scene {
            title: run.ground.title(),
            parameters: Q::sizes(&run.structure),
            start,
            ending: finish.ending,
            fall,
            part,
            time: Column::of_time(points, start),
            columns,
            phases,
            transitions: curve.transitions.iter().map(|at| (quanta(at.time - start), at.kind.name())).collect(),
            peaks,
            fixed: Q::fixed(run, finish.motion.time),
        }
    }

    /// As the script reads it.
    pub fn json(&self) -> String {
        serde_json::to_string(self).expect("its names are text")
    }
}
