//! A motion as points that straight lines join: what a picture of it is drawn from.
//!
//! Nothing is sampled at an interval. Each polynomial is divided until a bound says that its series stay as close to the
//! straight lines as is allowed. Two points of the same instant have a transition, or the end of the record, between them.

use super::fall::Found;
use super::{Run, RunError};
use crate::engine::piece::{Piece, Watch};
use crate::mechanics::outputs::Measure;
use crate::mechanics::restraint::Restraints;
use crate::series::{extremes, taylor};
use crate::{Outputs, Phase, Transition};

/// The largest number of times that a polynomial is divided.
const DIVISIONS: u32 = 30;

/// The error, as a multiple of the allowed one, from which on a polynomial is halved and not divided into as many parts as it
/// takes.
const NEARLY: f64 = 16.0;

/// More points are no picture: 100 MB.
const MOST_POINTS: usize = 1_000_000;

/// Part of its peak by which a_g may differ between the end of a piece and the start of the next without a jump.
const ROUNDING: f64 = 1e-9;

/// The motion at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// Its time, s.
    pub time: f64,
    /// The phase that it belongs to; of two points at a transition the first is just before it.
    pub phase: Phase,
    /// Ground acceleration, m/s².
    pub a_g: f64,
    /// Outputs of the structure.
    pub outputs: Outputs,
    /// Forces of its tendon and dissipators.
    pub restraints: Restraints,
}

/// A run as it is drawn.
#[derive(Clone, Debug)]
pub struct Curve {
    /// In the order of time; straight lines join them. The largest a_g, θ, u and a_t of all of it are among them.
    pub points: Vec<Point>,
    /// In the order of time, too.
    pub transitions: Vec<Transition>,
    /// Exact peaks, and how the run ended.
    pub found: Found,
}

impl Run<'_> {
    /// The run as points between which θ, u and a_t leave straight lines by at most `part` of their peaks; the ground
    /// acceleration does not leave them at all. Refuses a run that takes more than a million of them.
    pub fn curve(&self, part: f64) -> Result<Curve, RunError> {
        let (found, peaks) = self.found_and_all(&mut ())?;
        let within = [peaks.theta(), peaks.u(), peaks.a_t()].map(|peak| part * peak.magnitude);
        let exact = [peaks.a_g(), peaks.theta(), peaks.u(), peaks.a_t()].map(|peak| peak.time);
        let pga = peaks.a_g().magnitude;
        let (points, transitions, is_restrained) = (Vec::new(), Vec::new(), self.structure.is_restrained());
        let mut tracer = Tracer { within, exact, pga, is_restrained, points, transitions, is_torn: true };
        self.follow(&mut tracer)?;
        let Tracer { points, transitions, .. } = tracer;
        if points.len() > MOST_POINTS {
            return Err(RunError::TooManyPoints { most: MOST_POINTS, time: points[MOST_POINTS - 1].time });
        }
        Ok(Curve { points, transitions, found })
    }
}

/// Gathers the points of a motion as it goes by.
struct Tracer {
    /// How far θ (rad), u (m) and a_t (m/s²) may leave the lines.
    within: [f64; 3],
    /// Instants (s) that are to be points.
    exact: [f64; 4],
    /// Peak of |a_g|, m/s².
    pga: f64,
    is_restrained: bool,
    points: Vec<Point>,
    transitions: Vec<Transition>,
    /// Whether the next piece begins with a point of its own.
    is_torn: bool,
}

impl Tracer {
    fn is_full(&self) -> bool {
        self.points.len() > MOST_POINTS
    }

    fn see(&mut self, piece: &Piece, tau: f64, outputs: Outputs) {
        let (time, phase) = (piece.before.time + tau, piece.before.phase);
        let restraints = if self.is_restrained { piece.sample(time).restraints() } else { Restraints::default() };
        self.points.push(Point { time, phase, a_g: piece.load.at(tau).a_g, outputs, restraints });
    }
}

impl Watch for Tracer {
    const SEES_PIECES: bool = true;

    fn piece(&mut self, piece: &Piece) {
        if self.is_full() {
            return;
        }
        let [(_, first), (duration, last)] = piece.whole().ends();
        // after its last sample the ground is at rest at once
        let a_g = piece.load.at(0.0).a_g;
        let is_jolted = self.points.last_mut().is_some_and(|last| {
            last.time = piece.before.time; // by the engine's clock, which rounds otherwise
            (last.a_g - a_g).abs() > ROUNDING * self.pga
        });
        if self.is_torn || is_jolted {
            self.see(piece, 0.0, first);
        }
        let mut arcs = piece.arcs();
        while let Some(expansion) = arcs.next() {
            let (passed, span) = (expansion.from, expansion.arc.span);
            let mut between = Vec::new();
            expansion.series(Measure::a_t, &mut |from, arc, a_t| {
                let [theta, u, a_t] = [&arc.theta, &arc.u, a_t].map(|series| arc.used(series));
                let part = arc.span / span;
                divide([theta, u, a_t], self.within, [0.0, arc.reach], DIVISIONS, &mut |sigma| {
                    between.push(from + sigma * part);
                });
                between.push(from + arc.reach * part);
            });
            let instants = self.exact.map(|time| (time - piece.before.time - passed) / span);
            between.extend(instants.iter().filter(|sigma| **sigma > 0.0 && **sigma < expansion.arc.reach));
            between.sort_by(f64::total_cmp);
            // the last of them is at the end of the arc
            for sigma in between {
                self.see(piece, passed + sigma * span, expansion.outputs(sigma));
            }
            if self.is_full() {
                break;
            }
        }
        self.points.pop();
        self.see(piece, duration, last);
        self.is_torn = false;
    }

    fn transition(&mut self, transition: &Transition) {
        if !self.is_full() {
            self.transitions.push(*transition);
        }
        self.is_torn = true;
    }
}

/// Shows, in their order, the σ between `from` and `to` at which points are needed: between them the polynomials stay within
/// `within` of straight lines. `divisions` are left.
fn divide(
    coefficients: [&[f64]; 3],
    within: [f64; 3],
    [from, to]: [f64; 2],
    divisions: u32,
    show: &mut impl FnMut(f64),
) {
    let excess = |(coefficients, within): (&[f64], f64)| {
        let mut series = taylor::ZERO;
        let over = &mut series[..coefficients.len()];
        over.copy_from_slice(coefficients);
        taylor::stretch(over, from, to - from);
        let off = extremes::off_chord(over, 1.0);
        if off > 0.0 { off / within } else { 0.0 }
    };
    let most = coefficients.into_iter().zip(within).map(excess).fold(0.0, f64::max);
    if most <= 1.0 || divisions == 0 {
        return;
    }
    // a part of 1/n is off by 1/n² where terms of higher order are small
    let parts = if most < NEARLY { most.sqrt().ceil() } else { 2.0 };
    let mut start = from;
    for i in 1..parts as u32 {
        let end = from + (to - from) * f64::from(i) / parts;
        divide(coefficients, within, [start, end], divisions - 1, show);
        show(end);
        start = end;
    }
    divide(coefficients, within, [start, to], divisions - 1, show);
}
