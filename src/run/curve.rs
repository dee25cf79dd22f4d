//! A motion as points that straight lines join: what a picture of it is drawn from.
//!
//! Nothing is sampled at an interval. Each polynomial is divided until a bound says that its series stay as close to the
//! straight lines as is allowed. Two points of the same instant have a transition, or the end of the record, between them.

use super::course::{Run, RunError, Starts};
use super::fall::{RunResult, find};
use super::peaks::{Peak, Peaks};
use crate::engine::piece::{Piece, Watch};
use crate::engine::sample::Sample;
use crate::mechanics::arc::stretch;
use crate::mechanics::lateral::Coordinates;
use crate::series::terms::Terms;
use crate::series::{extremes, taylor};
use crate::{Output, Phase, Structure, Transition};

/// The largest number of times that a polynomial is divided.
const DIVISIONS: u32 = 30;

/// The error, as a multiple of the allowed one, from which on a polynomial is halved and not divided into as many parts as it
/// takes.
const NEARLY: f64 = 16.0;

/// More points of one mass are no picture: 150 MB. Points of many masses are larger and fewer.
const MOST_POINTS: usize = 1_000_000;

/// Part of its peak by which a_g may differ between the end of a piece and the start of the next without a jump.
const ROUNDING: f64 = 1e-9;

/// The outputs of `structure` that a picture follows and that levels are compared by: of its base, then u and a_t of each floor.
pub(super) fn lines(structure: &Structure) -> Vec<Output> {
    let of_base: &[Output] =
        if structure.is_one_mass() { &[Output::theta] } else { &[Output::theta, Output::V_t, Output::M_t] };
    let of_floors = (0..structure.floors().len()).flat_map(|i| [Output::u(i), Output::a_t(i)]);
    of_base.iter().copied().chain(of_floors).collect()
}

/// The peak of each of `lines` among `peaks`.
pub(super) fn peaks_of<'a>(lines: &'a [Output], peaks: &'a Peaks) -> impl Iterator<Item = Peak> + 'a {
    lines.iter().map(|line| peaks.of(*line).expect("each line has a peak"))
}

/// The motion at one instant.
#[derive(Clone, Debug, PartialEq)]
pub struct CurvePoint {
    /// Its time, s.
    pub time: f64,
    /// The phase that it belongs to; of two points at a transition the first is just before it.
    pub phase: Phase,
    /// Ground acceleration, m/s².
    pub a_g: f64,
    /// Outputs of the structure, in the order of [`Output::drawn`].
    pub outputs: Vec<f64>,
}

/// A run as it is drawn.
#[derive(Clone, Debug)]
pub struct RunCurve<Q: Coordinates = f64> {
    /// In the order of time; straight lines join them. The largest a_g and the largest of each line are among them.
    pub points: Vec<CurvePoint>,
    /// In the order of time, too.
    pub transitions: Vec<Transition<Q>>,
    /// Exact peaks, and how the run ended.
    pub found: RunResult<Q>,
}

pub(super) fn trace<Q: Starts>(run: &Run<Q>, part: f64) -> Result<RunCurve<Q>, RunError> {
    let (found, peaks) = find(run, &mut ())?;
    let (mut lines, structure, a_g) = (lines(&run.structure), &run.structure.at(run.detail), found.ground);
    lines.extend([Output::N_left, Output::N_right].iter().flat_map(|of| of.parts(structure)).map(|(part, _)| part));
    let peaks = Vec::from_iter(peaks_of(&lines, &peaks));
    let mut tracer = Tracer {
        within: peaks.iter().map(|peak| part * peak.magnitude).collect(),
        exact: [a_g].iter().chain(&peaks).map(|peak| peak.time).collect(),
        pga: a_g.magnitude,
        most: 10 * MOST_POINTS / (7 + peaks.len()),
        lines,
        drawn: Output::drawn(structure),
        points: Vec::new(),
        transitions: Vec::new(),
        is_torn: true,
    };
    run.end(&mut tracer)?;
    let Tracer { points, transitions, most, .. } = tracer;
    if points.len() > most {
        return Err(RunError::TooManyPoints { most, time: points[most - 1].time });
    }
    Ok(RunCurve { points, transitions, found })
}

/// Gathers the points of a motion as it goes by.
struct Tracer<Q: Coordinates> {
    lines: Vec<Output>,
    /// The outputs at each point.
    drawn: Vec<Output>,
    /// How far each line may be left, in its unit.
    within: Vec<f64>,
    /// Instants (s) that are to be points.
    exact: Vec<f64>,
    /// Peak of |a_g|, m/s².
    pga: f64,
    /// The largest number of points.
    most: usize,
    points: Vec<CurvePoint>,
    transitions: Vec<Transition<Q>>,
    /// Whether the next piece begins with a point of its own.
    is_torn: bool,
}

impl<Q: Coordinates> Tracer<Q> {
    fn is_full(&self) -> bool {
        self.points.len() > self.most
    }

    fn see(&mut self, sample: &Sample<Q>) {
        let Sample { motion, load, .. } = sample;
        let (outputs, a_g) = (self.drawn.iter().copied().map(sample.outputs()).collect(), load.a_g);
        self.points.push(CurvePoint { time: motion.time, phase: motion.phase.shown(motion.state.theta), a_g, outputs });
    }
}

impl<Q: Coordinates> Watch<Q> for Tracer<Q> {
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
            expansion.series(&self.lines, &mut |part, lines| {
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
fn divide(lines: &[Terms], within: &[f64], [from, to]: [f64; 2], divisions: u32, show: &mut impl FnMut(f64)) {
    let excess = |(line, within): (&Terms, &f64)| {
        let coefficients = line.used();
        let mut series = taylor::series(coefficients);
        let over = &mut series[..coefficients.len()];
        stretch(over, from, to - from);
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
