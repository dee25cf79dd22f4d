//! θ, u and a_t as series in time, and how far two motions are apart, exactly.
//!
//! The time that both motions have covered is compared and dropped, so that neither motion is kept whole.

use crate::engine::piece::{Piece, Watch};
use crate::mechanics::outputs::Measure;
use crate::series::extremes;
use crate::series::taylor::{self, Series};

/// Part of the vibration period 2π/ω_u: u̇, and with it a_t, jumps at a landing. If one motion has landed and the other
/// lands within this time, their distance is this jump and says nothing about the motions.
const SAME_LANDING: f64 = 1e-3;

/// The part of a motion that is still to be compared.
#[derive(Clone, Debug, Default)]
pub struct History {
    pub sections: Vec<Section>,
}

/// The motion over one polynomial.
#[derive(Clone, Debug)]
pub struct Section {
    start: f64,
    end: f64,
    /// Transitions before it.
    transitions: u64,
    /// Duration of σ = 1, s.
    span: f64,
    series: [Series; 3],
}

/// How far two motions of a structure have been apart.
#[derive(Clone, Copy, Debug)]
pub struct Distance {
    omega_u: f64,
    /// The largest |Δθ| (rad), |Δu| (m) and |Δa_t| (m/s²) over the time that both have covered.
    pub largest: [f64; 3],
    /// Since the one has had a transition that the other has not: how long, s, and how far they have been apart.
    apart: (f64, [f64; 3]),
}

impl Distance {
    /// Of a structure whose vibration mode has the circular frequency `omega_u` (rad/s), nothing seen yet.
    pub fn new(omega_u: f64) -> Distance {
        Distance { omega_u, largest: [0.0; 3], apart: (0.0, [0.0; 3]) }
    }

    /// Compares what follows of both motions, as far as both are known: how many sections of each need not be kept.
    pub fn go_on(&mut self, ours: &[Section], theirs: &[Section]) -> [usize; 2] {
        let Distance { omega_u, largest, apart } = self;
        let mut done = [0; 2];
        while let (Some(a), Some(b)) = (ours.get(done[0]), theirs.get(done[1])) {
            let (from, to) = (a.start.max(b.start), a.end.min(b.end));
            if to > from {
                let are_even = a.transitions == b.transitions;
                *apart = if are_even { (0.0, [0.0; 3]) } else { (apart.0 + (to - from), apart.1) };
                let of_these = if are_even { &mut *largest } else { &mut apart.1 };
                for (i, of_these) in of_these.iter_mut().enumerate() {
                    *of_these = f64::max(*of_these, difference(a, b, i, from, to, *of_these));
                }
                if apart.0 * *omega_u >= SAME_LANDING * std::f64::consts::TAU {
                    largest.iter_mut().zip(apart.1).for_each(|(largest, apart)| *largest = largest.max(apart));
                }
            }
            done[usize::from(a.end > b.end)] += 1;
        }
        done
    }
}

/// The largest difference of series `i` from time `from` to time `to`, if it is more than `least`.
fn difference(a: &Section, b: &Section, i: usize, from: f64, to: f64, least: f64) -> f64 {
    let (mut difference, subtracted) = (a.over(i, from, to), b.over(i, from, to));
    difference.iter_mut().zip(subtracted).for_each(|(a, b)| *a -= b);
    if extremes::bound(&difference, 1.0) <= least {
        return least;
    }
    extremes::largest(&difference, 1.0)
}

impl Section {
    /// Series `i` with σ = 0 at time `from` and σ = 1 at time `to`.
    fn over(&self, i: usize, from: f64, to: f64) -> Series {
        let mut series = self.series[i];
        let order = series.iter().rposition(|c| *c != 0.0).unwrap_or(0);
        taylor::stretch(&mut series[..=order], (from - self.start) / self.span, (to - from) / self.span);
        series
    }
}

impl Watch for History {
    const SEES_PIECES: bool = true;

    fn piece(&mut self, piece: &Piece) {
        let transitions = piece.before.transitions;
        let mut arcs = piece.arcs();
        while let Some(expansion) = arcs.next() {
            let (start, span) = (expansion.time(0.0), expansion.arc.span);
            expansion.series(Measure::a_t, &mut |from, arc, a_t| {
                let start = start + from * span;
                let series = [arc.series(|k| arc.theta[k]), arc.series(|k| arc.u[k]), *a_t];
                self.sections.push(Section { start, end: start + arc.duration(), transitions, span: arc.span, series });
            });
        }
    }
}
