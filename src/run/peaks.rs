//! The largest magnitudes of a motion and their instants, exact: between the ends of its pieces too.
//!
//! A bound on a piece tells most of the time that it holds nothing larger than what has been seen. Where it does not,
//! each output is a series in time (`output_series`), which rises or falls throughout between the points where
//! it is stationary (`extremes`): the largest magnitude is at one of these or at an end. A piece that may hold more than
//! what has been seen is first kept, since most are soon beaten by the end of another.

use crate::engine::piece::{Equations, KeptPiece, Piece, Watch};
use crate::mechanics::outputs::Measure;
use crate::series::extremes;
use crate::series::extremes::Bound;
use crate::{Motion, Outputs, Structure, Transition};
use serde::{Deserialize, Serialize};

/// A bound above the largest magnitude by no more than this part of it may be rounding.
const ROUNDING: f64 = 1e-14;

/// Magnitudes that differ by no more than this part are the same but for what rounding adds up to in many steps.
const SAME: f64 = 1e-12;

/// How often an exact leap is halved before a polynomial is asked for: a bound on a half has a quarter of the slack.
const HALVINGS: u32 = 2;

/// How many pieces are kept at most.
const KEPT: usize = 32;

/// The largest magnitude of a quantity, and its instant.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Peak {
    /// In the quantity's unit.
    pub magnitude: f64,
    /// The first instant that has it, s.
    pub time: f64,
}

impl Peak {
    fn see(&mut self, value: f64, time: f64) {
        let magnitude = value.abs();
        if !self.may_be_same(magnitude) {
            return;
        }
        let is_more = magnitude > self.magnitude * (1.0 + SAME);
        let time = if is_more { time } else { time.min(self.time) };
        *self = Peak { magnitude: magnitude.max(self.magnitude), time };
    }

    /// Whether a magnitude of at most `bound` may be more than it, or the same.
    #[inline]
    fn may_be_same(&self, bound: f64) -> bool {
        bound >= self.magnitude * (1.0 - SAME)
    }

    /// Whether a magnitude of at most `bound` at `time` (s) or later may be more than it, or the same and sooner.
    fn may_change(&self, bound: f64, time: f64) -> bool {
        bound > self.magnitude * if time < self.time { 1.0 - SAME } else { 1.0 + ROUNDING }
    }
}

/// Peaks of the motion that has been watched.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Peaks {
    /// In the order of [`Measure::ALL`].
    largest: [Peak; 4],
    ground: Peak,
    /// Of the structure: m, H and B.
    m: f64,
    H: f64,
    B: f64,
    /// Right-hand-side evaluations that it took to find them.
    evaluations: u64,
}

/// A peak's name and unit, and which it is.
#[derive(Debug)]
pub struct Peaking {
    /// Symbol of the quantity.
    pub name: &'static str,
    /// Its unit.
    pub unit: &'static str,
    /// Its peak.
    pub of: fn(&Peaks) -> Peak,
}

/// All peaks: what to call them, in which unit.
pub const PEAKS: [Peaking; 7] = [
    Peaking { name: "theta", unit: "rad", of: |peaks| peaks.theta() },
    Peaking { name: "u", unit: "m", of: |peaks| peaks.u() },
    Peaking { name: "delta_t", unit: "m", of: |peaks| peaks.delta_t() },
    Peaking { name: "uplift", unit: "m", of: |peaks| peaks.uplift() },
    Peaking { name: "a_t", unit: "m/s2", of: |peaks| peaks.a_t() },
    Peaking { name: "V_t", unit: "N", of: |peaks| peaks.V_t() },
    Peaking { name: "M_t", unit: "N.m", of: |peaks| peaks.M_t() },
];

impl Peaks {
    /// Of `structure`, nothing seen yet.
    pub fn new(structure: &Structure) -> Peaks {
        Peaks::since(0.0, structure)
    }

    /// The same from `time` (s) on, which is the instant of what stays 0.
    pub fn since(time: f64, structure: &Structure) -> Peaks {
        let &crate::Parameters { m, H, B, .. } = structure.parameters();
        let none = Peak { magnitude: 0.0, time };
        Peaks { largest: [none; 4], ground: none, m, H, B, evaluations: 0 }
    }

    /// Whether they are those of a structure with these masses and lengths.
    pub fn are_of(&self, structure: &Structure) -> bool {
        let &crate::Parameters { m, H, B, .. } = structure.parameters();
        (self.m, self.H, self.B) == (m, H, B)
    }

    /// The `outputs` at `time` (s), which need not be in a piece.
    pub fn see_instant(&mut self, time: f64, outputs: &Outputs) {
        Measure::ALL.into_iter().for_each(|measure| self.see(measure, time, outputs));
    }

    /// Of the rotation |θ|, rad.
    pub fn theta(&self) -> Peak {
        self.largest[Measure::Theta as usize]
    }

    /// Of the elastic displacement |u|, m.
    pub fn u(&self) -> Peak {
        self.largest[Measure::U as usize]
    }

    /// Of the lateral displacement of the top mass |δ_t|, m (Eq 26).
    pub fn delta_t(&self) -> Peak {
        self.largest[Measure::DeltaT as usize]
    }

    /// Of the uplift δ_u = 2 B sin|θ|, m (Eq 25): with |θ|, which never exceeds π/2.
    pub fn uplift(&self) -> Peak {
        let theta = self.theta();
        Peak { magnitude: 2.0 * self.B * theta.magnitude.sin(), ..theta }
    }

    /// Of the acceleration of the top mass |a_t|, m/s² (Eq 27).
    pub fn a_t(&self) -> Peak {
        self.largest[Measure::At as usize]
    }

    /// Of |V_t| = m |a_t|, N (Eqs 2, 23).
    pub fn V_t(&self) -> Peak {
        self.times_a_t(self.m)
    }

    /// Of |M_t| = m H |a_t|, N·m (Eqs 3, 24).
    pub fn M_t(&self) -> Peak {
        self.times_a_t(self.m * self.H)
    }

    fn times_a_t(&self, factor: f64) -> Peak {
        let a_t = self.a_t();
        Peak { magnitude: factor * a_t.magnitude, ..a_t }
    }

    /// Of the ground acceleration |a_g|, m/s²: linear in a piece.
    pub fn a_g(&self) -> Peak {
        self.ground
    }

    /// Right-hand-side evaluations that finding them took beside those of the motion itself.
    pub fn evaluations(&self) -> u64 {
        self.evaluations
    }

    /// Looks for more of them in the pieces of a motion.
    pub fn watch(&mut self) -> PeakWatch<'_> {
        PeakWatch { peaks: self, kept: Vec::new(), is_torn: true }
    }

    /// The same for that of θ alone, and with it of the uplift: the others stay as they are.
    pub fn watch_theta(&mut self) -> ThetaWatch<'_> {
        ThetaWatch { peaks: self }
    }

    /// Looks for those of `measures` at the part of `piece` in hand, where it may hold larger magnitudes; `halvings` are left.
    fn look(&mut self, measures: &[Measure], piece: &mut Piece, halvings: u32) {
        let start = piece.before.time + piece.passed();
        if !self.may_change_within(measures, &piece.crude_bounds(), start) {
            return;
        }
        let bounds = piece.bounds();
        let mut is_open = false;
        for &measure in measures {
            let bound = &bounds[measure as usize];
            if self.may_change(measure, bound.ends, start) {
                self.see_ends(measure, piece);
            }
            is_open |= self.is_open(measure, bound, start);
        }
        if !is_open {
            return;
        }
        if halvings > 0
            && let Some(halves) = piece.halves()
        {
            for half in halves {
                piece.part = half;
                self.look(measures, piece, halvings - 1);
            }
            return;
        }
        let begin = piece.passed();
        loop {
            piece.arc();
            for &measure in measures {
                if self.is_open(measure, &bounds[measure as usize], start) {
                    self.search(measure, piece);
                }
            }
            if !piece.skip() {
                break;
            }
            piece.skip_middle(begin);
        }
    }

    /// Whether magnitudes of `measures` within `bounds` from `time` (s) on may change what has been seen.
    fn may_change_within(&self, measures: &[Measure], bounds: &[f64; 4], time: f64) -> bool {
        measures.iter().any(|measure| self.may_change(*measure, bounds[*measure as usize], time))
    }

    /// Whether a magnitude of at most `bound` from `time` (s) on may do so.
    fn may_change(&self, measure: Measure, bound: f64, time: f64) -> bool {
        self.largest[measure as usize].may_change(bound, time)
    }

    /// Whether a magnitude of at most `bound` may be more than what has been seen, or the same.
    #[inline]
    fn may_be_same(&self, measure: Measure, bound: f64) -> bool {
        bound > 0.0 && self.largest[measure as usize].may_be_same(bound)
    }

    /// Whether it may do so between the ends.
    fn is_open(&self, measure: Measure, bound: &Bound, time: f64) -> bool {
        bound.may_turn() && self.may_change(measure, bound.largest(), time)
    }

    /// Looks at both ends of the part in hand.
    fn see_ends(&mut self, measure: Measure, piece: &Piece) {
        for (tau, outputs) in piece.ends() {
            self.see(measure, piece.before.time + tau, &outputs);
        }
    }

    /// Looks at the arc wherever `measure` is stationary.
    fn search(&mut self, measure: Measure, piece: &Piece) {
        let (start, span) = (piece.before.time + piece.passed(), piece.arc.span);
        piece.series(measure, &mut |from, arc, series| {
            let series = arc.used(series);
            if !self.may_change(measure, extremes::bound_by_cubic(series, arc.reach), start + from * span) {
                return;
            }
            extremes::stationary_points(series, arc.reach, |sigma| {
                let sigma = from + sigma * arc.span / span;
                self.see(measure, start + sigma * span, &piece.outputs(sigma));
            });
        });
    }

    fn see(&mut self, measure: Measure, time: f64, outputs: &Outputs) {
        self.largest[measure as usize].see(measure.of(outputs), time);
    }
}

/// Looks for peaks in the pieces of a motion.
#[derive(Debug)]
pub struct PeakWatch<'a> {
    peaks: &'a mut Peaks,
    /// Pieces that may hold more than what has been seen, and bounds of what they hold.
    kept: Vec<([f64; 4], KeptPiece)>,
    /// Whether the next piece may begin with other outputs than the last one ended with.
    is_torn: bool,
}

impl PeakWatch<'_> {
    /// The peaks so far.
    pub(super) fn peaks(&self) -> &Peaks {
        self.peaks
    }

    /// Looks at what has been kept, the latest first, which is often the largest.
    fn look_back(&mut self, equations: &mut Equations) {
        while let Some((bounds, mut piece)) = self.kept.pop() {
            if self.peaks.may_change_within(&Measure::ALL, &bounds, piece.before().time) {
                let mut piece = piece.piece(equations);
                self.peaks.look(&Measure::ALL, &mut piece, HALVINGS);
                self.peaks.evaluations += piece.evaluations();
            }
        }
    }
}

impl Watch for PeakWatch<'_> {
    const SEES_PIECES: bool = true;

    fn piece(&mut self, piece: &mut Piece) {
        for tau in [0.0, piece.duration] {
            self.peaks.ground.see(piece.load.at(tau).a_g, piece.before.time + tau);
        }
        let bounds = piece.crude_bounds();
        let is_torn = std::mem::take(&mut self.is_torn);
        if !Measure::ALL.iter().any(|measure| self.peaks.may_be_same(*measure, bounds[*measure as usize])) {
            return;
        }
        if is_torn {
            self.peaks.see_instant(piece.before.time, &piece.first_outputs());
        }
        self.peaks.see_instant(piece.before.time + piece.duration, &piece.last_outputs());
        let peaks = &*self.peaks;
        let may_change =
            |bounds: &[f64; 4], motion: &Motion| peaks.may_change_within(&Measure::ALL, bounds, motion.time);
        if !may_change(&bounds, piece.before) {
            return;
        }
        if self.kept.len() == KEPT {
            self.kept.retain(|(bounds, piece)| may_change(bounds, piece.before()));
        }
        if self.kept.len() == KEPT {
            self.look_back(&mut piece.equations());
        }
        self.kept.push((bounds, piece.keep()));
    }

    fn transition(&mut self, _transition: &Transition) {
        self.is_torn = true;
    }

    fn done(&mut self, equations: &mut Equations) {
        self.look_back(equations);
    }
}

/// Looks for the peak of θ alone in the pieces of a motion.
#[derive(Debug)]
pub struct ThetaWatch<'a> {
    peaks: &'a mut Peaks,
}

impl Watch for ThetaWatch<'_> {
    const SEES_PIECES: bool = true;

    #[inline]
    fn piece(&mut self, piece: &mut Piece) {
        if !self.peaks.may_be_same(Measure::Theta, piece.crude_bound_of_theta()) {
            return;
        }
        match piece.bound_of_theta() {
            Some(bound) => {
                let start = piece.before.time;
                for (tau, state) in [piece.part.start, piece.part.end] {
                    self.peaks.largest[Measure::Theta as usize].see(state.theta, start + tau);
                }
                if self.peaks.is_open(Measure::Theta, &bound, start) {
                    self.peaks.search(Measure::Theta, piece);
                }
            }
            None => {
                self.peaks.look(&[Measure::Theta], piece, HALVINGS);
                self.peaks.evaluations += piece.evaluations();
            }
        }
    }
}
