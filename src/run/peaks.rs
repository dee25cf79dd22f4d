//! The largest magnitudes of a motion and their instants, exact: between the ends of its pieces too.
//!
//! Bounds over a piece tell most of the time that an output has no larger magnitude there than so far
//! ([`peak_watch`](super::peak_watch)). Otherwise the output is expanded as a series in time. Between its stationary points
//! (`extremes`) a series only rises or falls, so that the largest magnitude is at a stationary point or at an end. The series tells
//! the instant; the value there comes from the state.

use crate::engine::piece::{CONVERGED, Expansion, Piece};
use crate::mechanics::instant::Instant;
use crate::mechanics::lateral::Coordinates;
use crate::mechanics::outputs::Search;
use crate::mechanics::reach::Magnitudes;
use crate::mechanics::restraint::{Angles, Restraint, Restraints, restraints};
use crate::series::extremes;
use crate::structure::gauge::Reach;
use crate::{Base, Detail, Output, State, Structure, Ties};
use serde::{Deserialize, Serialize};

/// A bound above the largest magnitude by no more than this part of it may be rounding.
const ROUNDING: f64 = 1e-14;

/// Magnitudes that agree in all bits but these, 2e-10 of them, are the same but for what rounding adds up to in many steps. Which of them
/// are the same does not depend on the order in which they are seen.
const SAME: u64 = 0xF_FFFF;

/// The largest magnitude of a quantity, and its instant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Peak {
    /// In the quantity's unit.
    pub magnitude: f64,
    /// The first instant that has it, s.
    pub time: f64,
}

impl Peak {
    pub(super) fn see(&mut self, value: f64, time: f64) {
        let magnitude = value.abs();
        if !self.may_be_same(magnitude) {
            return;
        }
        let seen = Peak { magnitude, time };
        let time = if seen.least() > self.least() { time } else { time.min(self.time) };
        *self = Peak { magnitude: magnitude.max(self.magnitude), time };
    }

    /// Whether a magnitude of at most `bound` may equal or exceed the peak.
    #[inline]
    fn may_be_same(&self, bound: f64) -> bool {
        bound >= self.least()
    }

    /// The least magnitude that may equal or exceed the peak.
    #[inline]
    pub(super) fn least(&self) -> f64 {
        f64::from_bits(self.magnitude.to_bits() & !SAME)
    }

    /// Whether a magnitude of at most `bound` at `time` (s) or later may be more than it, or the same and sooner.
    fn may_change(&self, bound: f64, time: f64) -> bool {
        bound > self.magnitude * (1.0 + ROUNDING) || time < self.time && self.may_be_same(bound)
    }
}

/// Peaks of the motion that has been watched.
#[derive(Clone, Debug, PartialEq)]
pub struct Peaks {
    /// Half-width of the base, m.
    B: f64,
    /// The peaks that are searched.
    pub(super) searched: Vec<Searched>,
    /// Outputs whose peaks come with one of these: its place, and the multiple that they are of it.
    with: Vec<(Output, usize, f64)>,
    tendon: Tendon,
    /// Peaks of the forces of the dissipators, unless θ alone is searched.
    pair: Option<[Peak; 2]>,
    /// Right-hand-side evaluations that the search took.
    pub(super) evaluations: u64,
}

/// A peak that is searched.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Searched {
    pub output: Output,
    pub peak: Peak,
    /// The place of the output among the reaches.
    pub place: usize,
}

impl Searched {
    #[inline(always)]
    fn bound<Q: Coordinates>(&self, (structure, reaches): (&Structure, &[Reach]), bounds: &Magnitudes<Q>) -> f64 {
        reaches[self.place].bound(self.output, structure, bounds)
    }

    /// Sees the output at the instant `x`, at `time` (s), and returns its value.
    #[inline]
    fn see<Q: Coordinates>(&mut self, x: &Instant<f64, Q>, time: f64) -> f64 {
        let value = self.output.of(x);
        self.peak.see(value, time);
        value
    }
}

/// The tendon of a base, as far as the peak of its force needs it.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Tendon {
    /// Prestress and stiffness.
    P_0: f64,
    k_t: f64,
    /// Elongation at this level of detail.
    angles: Angles,
    /// The start of the motion, s.
    start: f64,
}

impl Peaks {
    /// Peaks of `structure` at the level `detail` from `time` (s) on, before any motion. A peak that stays 0 has this instant.
    pub fn since(time: f64, structure: &Structure, detail: Detail) -> Peaks {
        let structure = &structure.at(detail);
        let (&Base { B, ties: Ties { P_0, k_t, .. }, .. }, none) = (structure.base(), Peak { magnitude: 0.0, time });
        let (mut searched, mut with): (Vec<Searched>, Vec<_>) = (Vec::new(), Vec::new());
        let places = Vec::from_iter(Output::bounded(structure));
        let mut search = |output: Output| {
            let same = searched.iter().position(|of| of.output == output);
            same.or_else(|| {
                let place = places.iter().position(|of| *of == output)?; // on rigid ground ties have none
                searched.push(Searched { output, peak: none, place });
                Some(searched.len() - 1)
            })
        };
        let mut alone: Vec<Output> = Vec::new();
        for output in Output::with_peak(structure) {
            let over = |other: &Output| Some((*other, output.over(*other, structure)?));
            match alone.iter().find_map(over) {
                _ if output.search() == Search::Parts => {
                    let parts = output.parts(structure);
                    with.extend(parts.filter_map(|(part, factor)| Some((output, search(part)?, factor))));
                }
                Some((other, factor)) => with.extend(search(other).map(|place| (output, place, factor))),
                None => alone.extend(search(output).map(|_| output)),
            }
        }
        let tendon = Tendon { P_0, k_t, angles: detail.angles(), start: time };
        Peaks { B, searched, with, tendon, pair: Some([none; 2]), evaluations: 0 }
    }

    /// Peak of an output that has one.
    pub fn of(&self, output: Output) -> Option<Peak> {
        if output == Output::uplift && self.with.iter().all(|(of, ..)| *of != output) {
            // it comes with the peak of |θ|, which never exceeds π/2
            let theta = self.theta();
            return Some(Peak { magnitude: 2.0 * self.B * libm::sin(theta.magnitude), ..theta });
        }
        let searched = match output {
            Output::P_t => Some(self.P_t()),
            Output::F_d1 => self.pair.map(|pair| pair[0]),
            Output::F_d2 => self.pair.map(|pair| pair[1]),
            _ => self.searched.iter().find(|of| of.output == output).map(|of| of.peak),
        };
        searched.or_else(|| {
            let parts = self.with.iter().filter(|(of, ..)| *of == output).map(|(_, place, factor)| {
                let peak = self.searched[*place].peak;
                Peak { magnitude: factor.abs() * peak.magnitude, ..peak }
            });
            parts.reduce(|a, b| if b.magnitude > a.magnitude { b } else { a })
        })
    }

    /// Peak of the rotation |θ|, rad.
    pub fn theta(&self) -> Peak {
        self.searched[0].peak
    }

    /// Peak of the tendon's force P_t = P_0 + k_t e, N. It comes with the peak of |θ|, unless the force is constant.
    pub fn P_t(&self) -> Peak {
        if let Some(of) = self.searched.iter().find(|of| of.output == Output::P_t) {
            return of.peak;
        }
        let (theta, &Tendon { P_0, k_t, angles, start }) = (self.theta(), &self.tendon);
        let magnitude = P_0 + k_t * self.B * angles.chord(theta.magnitude, 0.0).length;
        Peak { magnitude, time: if k_t > 0.0 { theta.time } else { start } }
    }

    /// Right-hand-side evaluations that the search took beside those of the motion.
    pub fn evaluations(&self) -> u64 {
        self.evaluations
    }

    /// The peaks alone: of all outputs that are searched, and of the forces of the dissipators.
    pub(super) fn numbers(&self) -> Vec<Peak> {
        self.searched.iter().map(|of| of.peak).chain(self.pair.into_iter().flatten()).collect()
    }

    /// The same with other [`Peaks::numbers`]; none if they are not as many.
    pub(super) fn with_numbers(&self, numbers: &[Peak]) -> Option<Peaks> {
        let (mut peaks, (searched, pair)) = (self.clone(), numbers.split_last_chunk()?);
        peaks.searched.iter_mut().zip(searched).for_each(|(of, peak)| of.peak = *peak);
        (peaks.searched.len() == searched.len()).then_some(Peaks { pair: Some(*pair), ..peaks })
    }

    /// The peak of θ alone.
    pub fn of_theta(mut self) -> Peaks {
        self.searched.truncate(1);
        Peaks { with: Vec::new(), pair: None, ..self }
    }

    /// Whether θ alone is searched, which rests in full contact.
    #[inline]
    pub(super) fn is_of_theta(&self) -> bool {
        self.pair.is_none()
    }

    /// Whether the peaks are of a motion that has begun.
    pub(super) fn goes_on(&self) -> bool {
        self.searched.iter().any(|of| of.peak.magnitude > 0.0)
    }

    /// Sees the values at the instant `x`, at `time` (s).
    pub(super) fn see<Q: Coordinates>(&mut self, x: &Instant<f64, Q>, time: f64) {
        self.searched.iter_mut().for_each(|of| _ = of.see(x, time));
    }

    /// Sees the values at the end of `piece`, and at its start if the piece before ended with others, of all that may equal or exceed its
    /// peak within `most`. Returns whether a peak may change between the ends, and puts bounds of what is searched into `bounds`.
    pub(super) fn see_ends<Q: Coordinates>(
        &mut self,
        piece: &Piece<Q>,
        is_torn: bool,
        most: &Magnitudes<Q>,
        mut bounds: Option<&mut Vec<f64>>,
    ) -> bool {
        let (&Piece { before, duration, load, end, .. }, structure) = (piece, piece.level.structure());
        let times = [before.time, before.time + duration];
        let (mut first, mut last, mut off, mut may_change) = (None, None, None, false);
        let mut see_first = |of: &mut Searched| {
            // what has a bound of its own between the ends does not read θ̈
            let shown = || match is_torn {
                true => piece.shown(0.0, &before.state),
                false => {
                    let x = Instant::of(structure, before.phase, &before.state, load.value);
                    Instant { settled: Q::settlements(&before.settled), ..x }
                }
            };
            of.see(first.get_or_insert_with(shown), times[0])
        };
        for of in &mut self.searched {
            let mut bound = of.bound((structure, structure.reaches()), most);
            if bound > 0.0 && of.peak.may_be_same(bound) {
                let last = of.see(last.get_or_insert_with(|| piece.shown(duration, &end)), times[1]);
                if is_torn {
                    see_first(of);
                }
                if of.peak.may_change(bound, times[0]) {
                    let off = off.get_or_insert_with(|| piece.whole().off_chord());
                    let reach = &structure.reaches()[of.place];
                    let off =
                        off.as_ref().map_or(f64::INFINITY, |off| reach.off_chord(of.output, structure, most, off));
                    if off < f64::INFINITY {
                        bound = bound.min(see_first(of).abs().max(last.abs()) + off);
                    }
                }
            }
            may_change |= of.peak.may_change(bound, times[0]);
            if let Some(bounds) = &mut bounds {
                bounds.push(bound);
            }
        }
        may_change
    }

    /// How far all that is searched reaches, in the least magnitudes that may equal or exceed the peaks.
    pub(super) fn reach(&self, structure: &Structure) -> Option<Reach> {
        let reaches = structure.reaches();
        Reach::together(structure, self.searched.iter().map(|of| (&reaches[of.place], of.peak.least())))
    }

    /// Whether magnitudes of `structure` within `bounds` may equal or exceed a peak.
    #[inline(always)]
    pub(super) fn may_be_same<Q: Coordinates>(&self, structure: &Structure, bounds: &Magnitudes<Q>) -> bool {
        let reaches = structure.reaches();
        let may_be_same = |of: &Searched| {
            let bound = of.bound((structure, reaches), bounds);
            bound > 0.0 && of.peak.may_be_same(bound)
        };
        self.searched.iter().any(may_be_same)
    }

    /// Whether magnitudes of `structure` within `bounds` at `time` (s) or later may change a peak.
    pub(super) fn may_change<Q: Coordinates>(&self, structure: &Structure, bounds: &Magnitudes<Q>, time: f64) -> bool {
        let reaches = structure.reaches();
        self.searched.iter().any(|of| of.peak.may_change(of.bound((structure, reaches), bounds), time))
    }

    /// The largest of these `bounds` of what is searched, in the peaks so far.
    pub(super) fn over(&self, bounds: &[f64]) -> f64 {
        let over =
            |(of, bound): (&Searched, &f64)| if of.peak.magnitude > 0.0 { bound / of.peak.magnitude } else { *bound };
        self.searched.iter().zip(bounds).map(over).fold(0.0, f64::max)
    }

    /// Whether what is searched may change a peak within these `bounds` at `time` (s) or later.
    pub(super) fn may_change_within(&self, bounds: &[f64], time: f64) -> bool {
        self.searched.iter().zip(bounds).any(|(of, bound)| of.peak.may_change(*bound, time))
    }

    /// Looks for larger magnitudes between the ends of `piece`, within these `bounds` of what is searched if they are known.
    pub(super) fn look<Q: Coordinates>(&mut self, piece: &Piece<Q>, bounds: &[f64]) {
        let mut arcs = piece.arcs();
        while let Some(expansion) = arcs.next() {
            self.look_over(&expansion, bounds);
            arcs.skip_middle();
            let (structure, start) = (piece.level.structure(), piece.before.time);
            if arcs.left.is_some_and(|rest| !self.may_change(structure, &rest.most(), start + rest.start.0)) {
                break;
            }
        }
        self.evaluations += arcs.evaluations;
    }

    /// Looks for larger forces of the dissipators in `piece`. They depend on θ and θ̇ alone, and on y on ground that gives.
    pub(super) fn look_at_dissipators<Q: Coordinates>(&mut self, piece: &Piece<Q>) {
        let (structure, before) = (piece.level.structure(), piece.before);
        let (angles, Some(pair)) = (self.tendon.angles, &mut self.pair) else { return };
        let forces = |state: &State<Q>| {
            let x = Instant::of(structure, before.phase, state, piece.load.value);
            of_pair(restraints(&x, angles, &before.dissipators))
        };
        for (time, state) in [(before.time, before.state), (before.time + piece.duration, piece.end)] {
            pair.iter_mut().zip(forces(&state)).for_each(|(peak, force)| peak.see(force, time));
        }
        let most = piece.whole().most();
        let bounds = match Q::foundation(structure) {
            Some(_) => [f64::INFINITY; 2],
            None => {
                let restraint = Restraint::about(structure.base(), before.phase.side(), &before.dissipators);
                restraint.most(most.theta, most.theta_dot)
            }
        };
        if !pair.iter().zip(bounds).any(|(peak, bound)| peak.may_change(bound, before.time)) {
            return;
        }
        let is_linear = Q::foundation(structure).is_some(); // in y, sin θ and their rates, of which there are series
        let mut arcs = piece.arcs();
        while let Some(expansion) = arcs.next() {
            expansion.in_parts(&mut |part, is_finest| {
                let reach = part.arc.reach;
                let series = of_pair(restraints(&part.over(!is_linear), angles, &before.dissipators));
                let mut ends = series.iter().zip(forces(&part.arc.at(reach)));
                if !is_linear && !is_finest && !ends.all(|(series, last)| part.has_converged(series, last, CONVERGED)) {
                    return false;
                }
                for (which, series) in series.iter().enumerate() {
                    extremes::stationary_points(series.used(), reach, |sigma| {
                        pair[which].see(forces(&part.arc.at(sigma))[which], part.time(sigma));
                    });
                }
                true
            });
        }
    }

    /// Looks at a polynomial.
    fn look_over<Q: Coordinates>(&mut self, expansion: &Expansion<Q>, bounds: &[f64]) {
        let turns = self.searched.iter().any(|of| !of.output.is_component());
        expansion.in_parts(&mut |part, is_finest| {
            let (structure, most) = (part.piece.level.structure(), part.most());
            let (reach, start) = (part.arc.reach, part.time(0.0));
            let (mut ends, mut over) = (None, None);
            let bounds = bounds.iter().copied().chain(std::iter::repeat(f64::INFINITY));
            for (of, bound) in self.searched.iter_mut().zip(bounds) {
                if !of.peak.may_change(bound, start) {
                    continue;
                }
                let bound = of.bound((structure, structure.reaches()), &most);
                if !of.peak.may_change(bound, start) {
                    continue;
                }
                let ends = ends.get_or_insert_with(|| [part.shown(0.0), part.shown(reach)]);
                of.see(&ends[0], start);
                let at_end = of.see(&ends[1], part.time(reach));
                let Searched { output, peak, .. } = of;
                let series = output.smooth(over.get_or_insert_with(|| part.over(turns)));
                if !is_finest && !output.is_component() && !part.has_converged(&series, at_end, CONVERGED) {
                    return false;
                }
                extremes::stationary_points(series.used(), reach, |sigma| {
                    peak.see(output.of(&part.shown(sigma)), part.time(sigma));
                });
            }
            true
        });
    }
}

/// The forces of the dissipators.
fn of_pair<N>(Restraints { F_d1, F_d2, .. }: Restraints<N>) -> [N; 2] {
    [F_d1, F_d2]
}
