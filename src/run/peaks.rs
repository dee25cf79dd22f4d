//! The largest magnitudes of a motion and their instants, exact: between the ends of its pieces too.
//!
//! In a piece that may hold a larger magnitude ([`peak_watch`](super::peak_watch)) each output is expanded as a series in time
//! (`levels::shown`). Between its stationary points (`extremes`) a series only rises or falls, so that the largest magnitude is at
//! a stationary point or at an end.

use super::peak_watch::{PeakWatch, Peaked};
#[cfg(feature = "lanes")]
use crate::engine::lanes::{Bounded, Passes};
use crate::engine::piece::{Expansion, Part, Piece, Sample, Watch};
use crate::levels::shown::Searched;
use crate::mechanics::outputs::{Measure, OUTPUTS, PeakRule, Sizes};
use crate::mechanics::restraint::Angles;
use crate::series::extremes::{self, Bound};
use crate::{Base, Ties};
use crate::{Detail, Floor, Outputs, Phase, State, Structure, Transition, TransitionKind};
use serde::{Deserialize, Serialize};

/// A bound above the largest magnitude by no more than this part of it may be rounding.
const ROUNDING: f64 = 1e-14;

/// Magnitudes that differ by no more than this part are the same but for what rounding adds up to in many steps.
const SAME: f64 = 1e-12;

/// How often an exact leap is halved before a polynomial is asked for: a bound on a half has a quarter of the slack.
const HALVINGS: u32 = 2;

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
        let is_more = magnitude > self.magnitude * (1.0 + SAME);
        let time = if is_more { time } else { time.min(self.time) };
        *self = Peak { magnitude: magnitude.max(self.magnitude), time };
    }

    /// Whether a magnitude of at most `bound` may equal or exceed the peak.
    #[inline]
    pub(super) fn may_be_same(&self, bound: f64) -> bool {
        bound >= self.magnitude * (1.0 - SAME)
    }

    /// Whether a magnitude of at most `bound` at `time` (s) or later may be more than it, or the same and sooner.
    pub(super) fn may_change(&self, bound: f64, time: f64) -> bool {
        bound > self.magnitude * if time < self.time { 1.0 - SAME } else { 1.0 + ROUNDING }
    }
}

/// Peaks of the motion that has been watched.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Peaks {
    /// Peaks of the searched outputs, in the order of [`Measure::SEARCHED`].
    largest: Searched<Peak>,
    ground: Peak,
    /// Sizes of the structure, which give the peaks that come with others.
    sizes: Sizes,
    tendon: Tendon,
    /// Right-hand-side evaluations that the search took.
    evaluations: u64,
}

/// The tendon of a base, as far as the peak of its force needs it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Tendon {
    /// Prestress and stiffness.
    P_0: f64,
    k_t: f64,
    /// Elongation at this level of detail.
    angles: Angles,
    /// The start of the motion, s.
    start: f64,
}

impl Tendon {
    /// The tendon of `base` at the level `detail` from `start` (s) on.
    pub(super) fn new(base: &Base, detail: Detail, start: f64) -> Tendon {
        let Ties { P_0, k_t, .. } = base.ties;
        Tendon { P_0, k_t, angles: detail.angles(), start }
    }

    /// Peak of the force P_t = P_0 + k_t e, N, under a base of the half-width `B` (m). It comes with the peak of |θ|, unless the
    /// force is constant.
    pub(super) fn peak(&self, B: f64, theta: Peak) -> Peak {
        let &Tendon { P_0, k_t, angles, start } = self;
        let magnitude = P_0 + k_t * B * angles.chord(theta.magnitude, 0.0).length;
        Peak { magnitude, time: if k_t > 0.0 { theta.time } else { start } }
    }
}

/// Whether `base` has a tendon.
pub(super) fn has_tendon(base: &Base) -> bool {
    base.ties.P_0 > 0.0 || base.ties.k_t > 0.0
}

/// A row of the table of peaks.
#[derive(Clone, Copy, Debug)]
pub struct Peaking {
    /// Symbol of the quantity.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    quantity: Quantity,
}

/// A quantity that has a peak.
#[derive(Clone, Copy, Debug)]
enum Quantity {
    Output(Measure),
    Tendon,
}

impl Peaking {
    /// The peak of the quantity among `peaks`.
    pub fn of(&self, peaks: &Peaks) -> Peak {
        match self.quantity {
            Quantity::Output(measure) => peaks.of(measure),
            Quantity::Tendon => peaks.P_t(),
        }
    }
}

/// The number of outputs that have a peak.
const COUNT: usize = {
    let (mut count, mut i) = (0, 0);
    while i < OUTPUTS.len() {
        count += !matches!(OUTPUTS[i].peak, PeakRule::None) as usize;
        i += 1;
    }
    count
};

/// The peaks of the outputs, each at the place that its row in the table of outputs gives it.
pub const PEAKS: [Peaking; COUNT] = {
    let mut peaks = [TENDON; COUNT];
    let mut i = 0;
    while i < OUTPUTS.len() {
        let output = &OUTPUTS[i];
        if let PeakRule::Searched(place) | PeakRule::With(place, ..) = output.peak {
            peaks[place] = Peaking { name: output.name, unit: output.unit, quantity: Quantity::Output(output.measure) };
        }
        i += 1;
    }
    peaks
};

/// The force of the tendon.
pub(super) const TENDON: Peaking = Peaking { name: "P_t", unit: "N", quantity: Quantity::Tendon };

/// The peaks that `structure` has: all of [`PEAKS`], and with a tendon the peak of its force.
pub fn of(structure: &Structure) -> impl Iterator<Item = &'static Peaking> + use<> {
    let tendon = has_tendon(structure.base()).then_some(const { &TENDON });
    const { &PEAKS }.iter().chain(tendon)
}

impl Peaks {
    /// Peaks of `structure` at the level `detail` from `time` (s) on, before any motion. A peak that stays 0 has this instant.
    pub fn since(time: f64, structure: &Structure, detail: Detail) -> Peaks {
        let (Floor { mass: m, height: H, .. }, B) = (structure.floors()[0], structure.base().B);
        let (none, tendon) = (Peak { magnitude: 0.0, time }, Tendon::new(structure.base(), detail, time));
        let largest = [none; Measure::SEARCHED.len()];
        Peaks { largest, ground: none, sizes: Sizes { m, H, B }, tendon, evaluations: 0 }
    }

    /// Sees the `outputs` at `time` (s), which need not be in a piece.
    pub fn see_instant(&mut self, time: f64, outputs: &Outputs) {
        Measure::SEARCHED.into_iter().for_each(|measure| self.see(measure, time, outputs));
    }

    /// Peak of an output that has one; of any other output the peak is 0.
    pub fn of(&self, measure: Measure) -> Peak {
        match measure.row().peak {
            PeakRule::None => Peak::default(),
            PeakRule::Searched(_) => self.largest[measure.place()],
            PeakRule::With(_, measure, magnitude) => {
                let peak = self.of(measure);
                Peak { magnitude: magnitude(&self.sizes, peak.magnitude), ..peak }
            }
        }
    }

    /// Peak of the rotation |θ|, rad.
    pub fn theta(&self) -> Peak {
        self.of(Measure::theta)
    }

    /// Peak of the elastic displacement |u|, m.
    pub fn u(&self) -> Peak {
        self.of(Measure::u)
    }

    /// Peak of the lateral displacement of the top mass |δ_t|, m (Eq 26).
    pub fn delta_t(&self) -> Peak {
        self.of(Measure::delta_t)
    }

    /// Peak of the uplift δ_u = 2 B sin|θ|, m (Eq 25). It comes with the peak of |θ|, which never exceeds π/2.
    pub fn uplift(&self) -> Peak {
        self.of(Measure::uplift)
    }

    /// Peak of the tendon's force P_t = P_0 + k_t e, N.
    pub fn P_t(&self) -> Peak {
        self.tendon.peak(self.sizes.B, self.theta())
    }

    /// Peak of the acceleration of the top mass |a_t|, m/s² (Eq 27).
    pub fn a_t(&self) -> Peak {
        self.of(Measure::a_t)
    }

    /// Peak of |V_t| = m |a_t|, N (Eqs 2, 23).
    pub fn V_t(&self) -> Peak {
        self.of(Measure::V_t)
    }

    /// Peak of |M_t| = m H |a_t|, N·m (Eqs 3, 24).
    pub fn M_t(&self) -> Peak {
        self.of(Measure::M_t)
    }

    /// Peak of the ground acceleration |a_g|, m/s², which is linear in a piece.
    pub fn a_g(&self) -> Peak {
        self.ground
    }

    /// Right-hand-side evaluations that the search took beside those of the motion.
    pub fn evaluations(&self) -> u64 {
        self.evaluations
    }

    /// The watcher that searches the pieces of a motion for larger peaks. The peaks are complete once the watcher is dropped.
    pub fn watch(&mut self) -> PeakWatch<'_> {
        PeakWatch::new(self)
    }

    /// The watcher that searches for the peaks of θ and of the uplift only.
    pub fn watch_theta(&mut self) -> ThetaWatch<'_> {
        ThetaWatch { peaks: self, impacts: 0 }
    }

    /// Looks for those of `measures` in `part`, where it may hold larger magnitudes; `halvings` are left.
    fn look(&mut self, measures: &[Measure], part: &Part, halvings: u32) {
        let start = part.piece.before.time + part.start.0;
        if !self.may_change_within(measures, &part.crude_bounds(), start) {
            return;
        }
        let bounds = part.bounds();
        let mut is_open = false;
        for &measure in measures {
            let bound = &bounds[measure.place()];
            if self.may_change(measure, bound.ends, start) {
                for (tau, outputs) in part.ends() {
                    self.see(measure, part.piece.before.time + tau, &outputs);
                }
            }
            is_open |= self.is_open(measure, bound, start);
        }
        if !is_open {
            return;
        }
        if halvings > 0
            && let Some(halves) = part.halves()
        {
            halves.iter().for_each(|half| self.look(measures, half, halvings - 1));
            return;
        }
        let mut arcs = part.arcs();
        while let Some(expansion) = arcs.next() {
            for &measure in measures {
                if self.is_open(measure, &bounds[measure.place()], start) {
                    self.search(measure, &expansion);
                }
            }
            arcs.skip_middle();
        }
        self.evaluations += arcs.evaluations;
    }

    /// Whether magnitudes of `measures` within `bounds` from `time` (s) on may change what has been seen.
    fn may_change_within(&self, measures: &[Measure], bounds: &Searched<f64>, time: f64) -> bool {
        measures.iter().any(|measure| self.may_change(*measure, bounds[measure.place()], time))
    }

    /// Whether a magnitude of at most `bound` from `time` (s) on may change the peak of `measure`.
    fn may_change(&self, measure: Measure, bound: f64, time: f64) -> bool {
        self.largest[measure.place()].may_change(bound, time)
    }

    /// Whether a magnitude of at most `bound` may equal or exceed the peak of `measure`.
    #[inline]
    fn may_be_same(&self, measure: Measure, bound: f64) -> bool {
        bound > 0.0 && self.largest[measure.place()].may_be_same(bound)
    }

    /// Whether the peak of `measure` may change between the ends.
    fn is_open(&self, measure: Measure, bound: &Bound, time: f64) -> bool {
        bound.may_turn() && self.may_change(measure, bound.largest(), time)
    }

    /// Looks at a polynomial wherever `measure` is stationary.
    fn search(&mut self, measure: Measure, expansion: &Expansion) {
        expansion.series(measure, &mut |part, series| {
            if !self.may_change(measure, extremes::bound_by_cubic(series.used(), part.arc.reach), part.time(0.0)) {
                return;
            }
            extremes::stationary_points(series.used(), part.arc.reach, |sigma| {
                self.see(measure, part.time(sigma), &part.outputs(sigma));
            });
        });
    }

    fn see(&mut self, measure: Measure, time: f64, outputs: &Outputs) {
        self.largest[measure.place()].see(measure.of(outputs), time);
    }
}

impl Peaked for f64 {
    type Peaks = Peaks;
    type Bounds = Searched<f64>;

    fn none(time: f64, structure: &Structure, detail: Detail) -> Peaks {
        Peaks::since(time, structure, detail)
    }

    fn goes_on(peaks: &Peaks) -> bool {
        peaks.largest.iter().any(|peak| peak.magnitude > 0.0)
    }

    fn see_ground(peaks: &mut Peaks, a_g: f64, time: f64) {
        peaks.ground.see(a_g, time);
    }

    fn see_instant(peaks: &mut Peaks, sample: &Sample) {
        peaks.see_instant(sample.motion.time, &sample.outputs());
    }

    fn see(peaks: &mut Peaks, piece: &Piece, tau: f64, state: &State) {
        peaks.see_instant(piece.before.time + tau, &piece.outputs(tau, state));
    }

    fn bounds(_: &Peaks, piece: &Piece) -> Searched<f64> {
        piece.whole().crude_bounds()
    }

    #[inline]
    fn may_be_same(peaks: &Peaks, bounds: &Searched<f64>) -> bool {
        Measure::SEARCHED.iter().any(|measure| peaks.may_be_same(*measure, bounds[measure.place()]))
    }

    fn may_change(peaks: &Peaks, bounds: &Searched<f64>, time: f64) -> bool {
        peaks.may_change_within(&Measure::SEARCHED, bounds, time)
    }

    fn look(peaks: &mut Peaks, piece: &Piece) {
        peaks.look(&Measure::SEARCHED, &piece.whole(), HALVINGS);
    }
}

#[cfg(feature = "lanes")]
impl Passes for ThetaWatch<'_> {
    #[inline(always)]
    fn passes(&mut self, step: &Bounded) -> bool {
        !self.peaks.may_be_same(Measure::theta, step.most.theta)
    }
}

/// Looks for the peak of θ alone in the pieces of a motion, and counts impacts.
#[derive(Debug)]
pub struct ThetaWatch<'a> {
    pub(super) peaks: &'a mut Peaks,
    /// Number of impacts and landings.
    pub(super) impacts: u64,
}

impl Watch for ThetaWatch<'_> {
    const SEES_PIECES: bool = true;

    #[inline]
    fn piece(&mut self, piece: &Piece) {
        let (peaks, before) = (&mut *self.peaks, piece.before);
        if before.phase == Phase::FullContact {
            return;
        }
        let Some(arc) = piece.arc else { return peaks.look(&[Measure::theta], &piece.whole(), HALVINGS) };
        if !peaks.may_be_same(Measure::theta, arc.most(&arc.theta, piece.end.theta)) {
            return;
        }
        for (tau, state) in [(0.0, before.state), (piece.duration, piece.end)] {
            peaks.largest[Measure::theta.place()].see(state.theta, before.time + tau);
        }
        let [range] = extremes::ranges(|k| [arc.theta[k]], arc.order, arc.reach);
        if peaks.is_open(Measure::theta, &range.and(0.0, 0.0), before.time) {
            peaks.search(Measure::theta, &Expansion { piece, from: 0.0, arc });
        }
    }

    fn transition(&mut self, transition: &Transition) {
        use TransitionKind::{Impact, Landing, Settling};
        self.impacts += u64::from(matches!(transition.kind, Impact(_) | Landing | Settling));
    }
}
