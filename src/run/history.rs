//! The compared quantities as series in time, and how far two motions are apart, exactly.
//!
//! The time that both motions have covered is compared and dropped, so that neither motion is kept whole.

use crate::Output;
use crate::engine::piece::{Piece, Watch};
use crate::mechanics::arc::stretch;
use crate::mechanics::lateral::Coordinates;
use crate::series::extremes;
use crate::series::taylor::{self, Series};

/// Part of the longest period of vibration while rocking: u̇, and with it a_t, jumps at a landing. If one motion has landed and the other
/// lands within this time, their distance is this jump and says nothing about the motions.
const SAME_LANDING: f64 = 1e-3;

/// The part of a motion that is still to be compared.
#[derive(Clone, Debug)]
pub struct History {
    /// The compared quantities.
    pub lines: Vec<Output>,
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
    series: Vec<Series>,
}

/// How far two motions of a structure have been apart.
#[derive(Clone, Debug)]
pub struct Distance {
    omega: f64,
    /// The largest difference of each compared quantity over the time that both have covered.
    pub largest: Vec<f64>,
    /// Since the one has had a transition that the other has not: how long, s, and how far they have been apart.
    apart: (f64, Vec<f64>),
}

impl Distance {
    /// Of `count` quantities of a structure that vibrates with the circular frequency `omega` (rad/s) at least while it rocks,
    /// nothing seen yet.
    pub fn new(omega: f64, count: usize) -> Distance {
        Distance { omega, largest: vec![0.0; count], apart: (0.0, vec![0.0; count]) }
    }

    /// Compares what follows of both motions, as far as both are known: how many sections of each need not be kept.
    pub fn go_on(&mut self, ours: &[Section], theirs: &[Section]) -> [usize; 2] {
        let Distance { omega, largest, apart } = self;
        let mut done = [0; 2];
        while let (Some(a), Some(b)) = (ours.get(done[0]), theirs.get(done[1])) {
            let (from, to) = (a.start.max(b.start), a.end.min(b.end));
            if to > from {
                let are_even = a.transitions == b.transitions;
                if are_even {
                    apart.0 = 0.0;
                    apart.1.fill(0.0);
                } else {
                    apart.0 += to - from;
                }
                let of_these = if are_even { &mut *largest } else { &mut apart.1 };
                for (i, of_these) in of_these.iter_mut().enumerate() {
                    *of_these = f64::max(*of_these, difference(a, b, i, from, to, *of_these));
                }
                if apart.0 * *omega >= SAME_LANDING * std::f64::consts::TAU {
                    largest.iter_mut().zip(&apart.1).for_each(|(largest, apart)| *largest = largest.max(*apart));
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
        stretch(&mut series[..=order], (from - self.start) / self.span, (to - from) / self.span);
        series
    }
}

impl<Q: Coordinates> Watch<Q> for History {
    fn piece(&mut self, piece: &Piece<Q>) {
        let transitions = piece.before.transitions;
        let mut arcs = piece.arcs();
        while let Some(expansion) = arcs.next() {
            expansion.series(&self.lines, &mut |part, lines| {
                let (start, arc) = (part.time(0.0), part.arc);
                let series = lines.iter().map(|line| taylor::series(line.used())).collect();
                self.sections.push(Section { start, end: start + arc.duration(), transitions, span: arc.span, series });
            });
        }
    }
}
