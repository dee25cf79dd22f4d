//! A motion as points that straight lines join: what a picture of it is drawn from.
//!
//! Nothing is sampled at an interval: each stretch is halved until a bound says that its series leave the line between its
//! ends by no more than is allowed. Where two points have the same instant there is a transition between them,
//! or the record ends there.

use super::peaks::Peaks;
use super::{Finish, Run, RunError};
use crate::outputs::Measure;
use crate::piece::{Piece, Watch};
use crate::{Outputs, Phase, Transition, extremes, taylor};

/// How often a stretch of one polynomial is halved at most.
const HALVINGS: u32 = 30;

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
    /// What the structure shows.
    pub outputs: Outputs,
}

/// A run as it is drawn.
#[derive(Clone, Debug)]
pub struct Curve {
    /// In the order of time; straight lines join them. The peaks of a_g, θ, u and a_t are among them.
    pub points: Vec<Point>,
    /// In the order of time, too.
    pub transitions: Vec<Transition>,
    /// Exact peaks.
    pub peaks: Peaks,
    /// How the run ended.
    pub finish: Finish,
}

impl Run<'_> {
    /// The run as points between which θ, u and a_t leave straight lines by at most `part` of their peaks; the ground
    /// acceleration does not leave them at all.
    pub fn curve(&self, part: f64) -> Result<Curve, RunError> {
        let (peaks, _) = self.peaks()?;
        let within = [peaks.theta(), peaks.u(), peaks.a_t()].map(|peak| part * peak.magnitude);
        let exact = [peaks.a_g(), peaks.theta(), peaks.u(), peaks.a_t()].map(|peak| peak.time);
        let pga = peaks.a_g().magnitude;
        let mut tracer = Tracer { within, exact, pga, points: Vec::new(), transitions: Vec::new(), is_torn: true };
        let finish = self.follow(&mut tracer)?;
        let Tracer { points, transitions, .. } = tracer;
        Ok(Curve { points, transitions, peaks, finish })
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
    points: Vec<Point>,
    transitions: Vec<Transition>,
    /// Whether the next piece begins with a point of its own.
    is_torn: bool,
}

impl Tracer {
    fn see(&mut self, piece: &Piece, tau: f64, outputs: Outputs) {
        let (time, phase) = (piece.before.time + tau, piece.before.phase);
        self.points.push(Point { time, phase, a_g: piece.load.at(tau).a_g, outputs });
    }
}

impl Watch for Tracer {
    const SEES_PIECES: bool = true;

    fn piece(&mut self, piece: &mut Piece) {
        let [(_, first), (duration, last)] = piece.ends();
        // after its last sample the ground is at rest at once
        let a_g = piece.load.at(0.0).a_g;
        let is_jolted = self.points.last_mut().is_some_and(|last| {
            last.time = piece.before.time; // by the engine's clock, which rounds otherwise
            (last.a_g - a_g).abs() > ROUNDING * self.pga
        });
        if self.is_torn || is_jolted {
            self.see(piece, 0.0, first);
        }
        loop {
            let (passed, span) = (piece.passed(), piece.arc().span);
            let mut between = Vec::new();
            piece.series(Measure::At, &mut |from, arc, a_t| {
                let [theta, u, a_t] = [&arc.theta, &arc.u, a_t].map(|series| arc.used(series));
                let part = arc.span / span;
                halve([theta, u, a_t], self.within, [0.0, arc.reach], HALVINGS, &mut |sigma| {
                    between.push(from + sigma * part);
                });
                between.push(from + arc.reach * part);
            });
            let instants = self.exact.map(|time| (time - piece.before.time - passed) / span);
            between.extend(instants.iter().filter(|sigma| **sigma > 0.0 && **sigma < piece.arc().reach));
            between.sort_by(f64::total_cmp);
            for sigma in between {
                let outputs = piece.outputs(sigma);
                self.see(piece, passed + sigma * span, outputs);
            }
            // the last of them is at the end of the arc
            if !piece.skip() {
                break;
            }
        }
        self.points.pop();
        self.see(piece, duration, last);
        self.is_torn = false;
    }

    fn transition(&mut self, transition: &Transition) {
        self.transitions.push(*transition);
        self.is_torn = true;
    }
}

/// Shows, in their order, the σ between `from` and `to` at which the polynomials have to be known so that they leave the
/// lines between them by no more than `within`.
fn halve(coefficients: [&[f64]; 3], within: [f64; 3], [from, to]: [f64; 2], halvings: u32, show: &mut impl FnMut(f64)) {
    let is_within = |(coefficients, within): (&[f64], f64)| {
        let mut series = taylor::ZERO;
        let over = &mut series[..coefficients.len()];
        over.copy_from_slice(coefficients);
        taylor::stretch(over, from, to - from);
        extremes::off_chord(over, 1.0) <= within
    };
    if halvings == 0 || coefficients.into_iter().zip(within).all(is_within) {
        return;
    }
    let middle = 0.5 * (from + to);
    halve(coefficients, within, [from, middle], halvings - 1, show);
    show(middle);
    halve(coefficients, within, [middle, to], halvings - 1, show);
}
