//! A motion as points that straight lines join: what a picture of it is drawn from.
//!
//! Nothing is sampled at an interval. Each polynomial is divided until a bound says that its series stay as close to the
//! straight lines as is allowed. Two points of the same instant have a transition, or the end of the record, between them.

use super::fall::Found;
use super::peak_watch::Peaked;
use super::peaks::{Peak, Peaks};
use super::profile::{Over, Profile};
use super::{Run, RunError};
use crate::engine::piece::{CONVERGED, Expansion, Piece, Sample, Watch};
use crate::mechanics::floors::MotionOfFloors;
use crate::mechanics::outputs::Measure;
use crate::mechanics::restraint::Restraints;
use crate::series::terms::Terms;
use crate::series::{extremes, taylor};
use crate::{FrameOutput, Modes, Outputs, Phase, Structure, Transition};
use std::fmt::Debug;

/// The largest number of times that a polynomial is divided.
const DIVISIONS: u32 = 30;

/// The error, as a multiple of the allowed one, from which on a polynomial is halved and not divided into as many parts as it
/// takes.
const NEARLY: f64 = 16.0;

/// More points of one mass are no picture: 100 MB. Points of many masses are larger and fewer.
const MOST_POINTS: usize = 1_000_000;

/// Part of its peak by which a_g may differ between the end of a piece and the start of the next without a jump.
const ROUNDING: f64 = 1e-9;

/// A function that gets the series of all lines, and the polynomial that they belong to.
#[doc(hidden)]
#[allow(private_interfaces)]
pub type Show<'a, Q> = dyn FnMut(&Expansion<Q>, &[&[f64]]) + 'a;

/// Lateral coordinates whose motion is drawn.
pub trait Drawn: Peaked<Peaks: Debug> {
    /// The outputs at a point.
    type Outputs: Clone + Debug;

    /// The peaks of a_g and of each line that is drawn, among `all` of a motion.
    #[doc(hidden)]
    fn exact(structure: &Structure, all: &Self::Peaks) -> Vec<Peak>;

    /// The kind of each line: rotation (0), elastic displacement (1), acceleration or force (2).
    #[doc(hidden)]
    fn kinds(structure: &Structure) -> Vec<usize>;

    /// The outputs of `sample`.
    #[doc(hidden)]
    fn outputs(sample: &Sample<Self>) -> Self::Outputs;

    /// Shows the series of all lines, in the order of their peaks, over the polynomial or over parts of it.
    #[doc(hidden)]
    #[allow(private_interfaces)] // the coordinates name the type, and nobody else can use it
    fn lines(of: &Expansion<Self>, show: &mut Show<Self>);
}

impl Drawn for f64 {
    type Outputs = Outputs;

    fn exact(_: &Structure, all: &Peaks) -> Vec<Peak> {
        vec![all.a_g(), all.theta(), all.u(), all.a_t()]
    }

    fn kinds(_: &Structure) -> Vec<usize> {
        vec![0, 1, 2]
    }

    fn outputs(sample: &Sample) -> Outputs {
        sample.outputs()
    }

    #[allow(private_interfaces)]
    fn lines(of: &Expansion, show: &mut Show<f64>) {
        of.series(Measure::a_t, &mut |part, a_t| {
            let arc = part.arc;
            show(part, &[arc.used(&arc.theta), arc.used(&arc.u), a_t.used()]);
        });
    }
}

/// The outputs of `frame` that are drawn: of its base, then u and a_t of each floor.
pub fn drawn(frame: &Structure) -> impl Iterator<Item = FrameOutput> + use<> {
    let floors = frame.floors().len();
    let of_floors = (0..floors).flat_map(|i| [FrameOutput::u(i), FrameOutput::a_t(i)]);
    [FrameOutput::theta, FrameOutput::V_t, FrameOutput::M_t].into_iter().chain(of_floors)
}

impl Drawn for Modes {
    /// In the order of [`drawn`].
    type Outputs = Vec<f64>;

    fn exact(frame: &Structure, all: &Profile) -> Vec<Peak> {
        let line = |line| all.of(line).expect("each line has a peak");
        [all.a_g].into_iter().chain(drawn(frame).map(line)).collect()
    }

    fn kinds(structure: &Structure) -> Vec<usize> {
        let kind = |line| match line {
            FrameOutput::theta => 0,
            FrameOutput::u(_) => 1,
            _ => 2,
        };
        drawn(structure).map(kind).collect()
    }

    fn outputs(sample: &Sample<Modes>) -> Vec<f64> {
        drawn(sample.level.structure()).map(sample.outputs()).collect()
    }

    #[allow(private_interfaces)]
    fn lines(of: &Expansion<Modes>, show: &mut Show<Modes>) {
        of.in_parts(&mut |part, is_finest| {
            let (over, end) = (Over::new(*part), part.sample(part.arc.reach));
            let last = end.outputs();
            let series = |line: FrameOutput| {
                let series = line.of(&over);
                (is_finest || part.has_converged(&series, last(line), CONVERGED)).then_some(series)
            };
            let Some(series) = drawn(over.frame()).map(series).collect::<Option<Vec<_>>>() else { return false };
            show(part, &series.iter().map(Terms::used).collect::<Vec<_>>());
            true
        });
    }
}

/// The motion at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point<O = Outputs> {
    /// Its time, s.
    pub time: f64,
    /// The phase that it belongs to; of two points at a transition the first is just before it.
    pub phase: Phase,
    /// Ground acceleration, m/s².
    pub a_g: f64,
    /// Outputs of the structure.
    pub outputs: O,
    /// Forces of its tendon and dissipators.
    pub restraints: Restraints,
}

/// A run as it is drawn.
#[derive(Clone, Debug)]
pub struct Curve<Q: Drawn = f64> {
    /// In the order of time; straight lines join them. The largest a_g and the largest of each line are among them.
    pub points: Vec<Point<Q::Outputs>>,
    /// In the order of time, too.
    pub transitions: Vec<Transition<Q>>,
    /// Exact peaks, and how the run ended.
    pub found: Found<Q>,
}

impl<Q: Drawn> Run<'_, Q> {
    /// The run as points between which θ, u and a_t of each floor leave straight lines by at most `part` of their peaks; the
    /// ground acceleration does not leave them at all. Refuses a run that takes more points than fit in 100 MB.
    pub fn curve(&self, part: f64) -> Result<Curve<Q>, RunError> {
        let (found, peaks) = self.found_and_all(&mut ())?;
        let peaks = Q::exact(&self.structure, &peaks);
        let mut tracer = Tracer {
            within: peaks[1..].iter().map(|peak| part * peak.magnitude).collect(),
            exact: peaks.iter().map(|peak| peak.time).collect(),
            pga: peaks[0].magnitude,
            most: 10 * MOST_POINTS / (6 + peaks.len()),
            is_restrained: self.structure.base().is_restrained(),
            points: Vec::new(),
            transitions: Vec::new(),
            is_torn: true,
        };
        self.follow(&mut tracer)?;
        let Tracer { points, transitions, most, .. } = tracer;
        if points.len() > most {
            return Err(RunError::TooManyPoints { most, time: points[most - 1].time });
        }
        Ok(Curve { points, transitions, found })
    }
}

/// Gathers the points of a motion as it goes by.
struct Tracer<Q: Drawn> {
    /// How far each line may be left, in its unit.
    within: Vec<f64>,
    /// Instants (s) that are to be points.
    exact: Vec<f64>,
    /// Peak of |a_g|, m/s².
    pga: f64,
    /// The largest number of points.
    most: usize,
    is_restrained: bool,
    points: Vec<Point<Q::Outputs>>,
    transitions: Vec<Transition<Q>>,
    /// Whether the next piece begins with a point of its own.
    is_torn: bool,
}

impl<Q: Drawn> Tracer<Q> {
    fn is_full(&self) -> bool {
        self.points.len() > self.most
    }

    fn see(&mut self, sample: &Sample<Q>) {
        let restraints = if self.is_restrained { sample.restraints() } else { Restraints::default() };
        let Sample { motion, load, .. } = sample;
        let (outputs, a_g) = (Q::outputs(sample), load.a_g);
        self.points.push(Point { time: motion.time, phase: motion.phase, a_g, outputs, restraints });
    }
}

impl<Q: Drawn> Watch<Q> for Tracer<Q> {
    const SEES_PIECES: bool = true;

    fn piece(&mut self, piece: &Piece<Q>) {
        if self.is_full() {
            return;
        }
        // after its last sample the ground is at rest at once
        let (start, a_g) = (piece.before.time, piece.load.at(0.0).a_g);
        let is_jolted = self.points.last_mut().is_some_and(|last| {
            last.time = start; // by the engine's clock, which rounds otherwise
            (last.a_g - a_g).abs() > ROUNDING * self.pga
        });
        if self.is_torn || is_jolted {
            self.see(&piece.sample(start));
        }
        let mut arcs = piece.arcs();
        while let Some(expansion) = arcs.next() {
            let (passed, span) = (expansion.from, expansion.arc.span);
            let mut between = Vec::new();
            Q::lines(&expansion, &mut |part, lines| {
                let (from, arc) = ((part.from - passed) / span, part.arc);
                let mut add = |sigma: f64| between.push(from + sigma * (arc.span / span));
                divide(lines, &self.within, [0.0, arc.reach], DIVISIONS, &mut add);
                add(arc.reach);
            });
            let instants = self.exact.iter().map(|time| (time - start - passed) / span);
            between.extend(instants.filter(|sigma| *sigma > 0.0 && *sigma < expansion.arc.reach));
            between.sort_by(f64::total_cmp);
            // the last of them is at the end of the arc
            for sigma in between {
                self.see(&piece.sample(expansion.time(sigma)));
            }
            if self.is_full() {
                break;
            }
        }
        self.points.pop();
        self.see(&piece.sample(start + piece.duration));
        self.is_torn = false;
    }

    fn transition(&mut self, transition: &Transition<Q>) {
        if !self.is_full() {
            self.transitions.push(*transition);
        }
        self.is_torn = true;
    }
}

/// Shows, in their order, the σ between `from` and `to` at which points are needed: between them the polynomials stay within
/// `within` of straight lines. `divisions` are left.
fn divide(lines: &[&[f64]], within: &[f64], [from, to]: [f64; 2], divisions: u32, show: &mut impl FnMut(f64)) {
    let excess = |(coefficients, within): (&&[f64], &f64)| {
        let mut series = taylor::series(coefficients);
        let over = &mut series[..coefficients.len()];
        taylor::stretch(over, from, to - from);
        let off = extremes::off_chord(over, 1.0);
        if off > 0.0 { off / within } else { 0.0 }
    };
    let most = lines.iter().zip(within).map(excess).fold(0.0, f64::max);
    if most <= 1.0 || divisions == 0 {
        return;
    }
    // a part of 1/n is off by 1/n² where terms of higher order are small
    let parts = if most < NEARLY { most.sqrt().ceil() } else { 2.0 };
    let mut start = from;
    for i in 1..parts as u32 {
        let end = from + (to - from) * f64::from(i) / parts;
        divide(lines, within, [start, end], divisions - 1, show);
        show(end);
        start = end;
    }
    divide(lines, within, [start, to], divisions - 1, show);
}
