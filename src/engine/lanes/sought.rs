//! Watchers of several runs seek this in steps that are taken together: limits, bounds of the quantities, and the steps that are shown
//! later. A step that may hold a peak is put off, since the steps after it mostly hold larger values.

use super::number::{Answers, Lanes, MOST, PerRun, load, put};
use crate::engine::Engine;
use crate::engine::motion::Motion;
use crate::engine::piece::{Piece, Watch};
use crate::mechanics::lateral::Coordinates;
use crate::numbers::Real;
use crate::{LinearLoad, Ramp, State};
use pulp::Simd;
use std::ops::Range;

/// The most modes of structures that leap together.
pub(super) const MOST_MODES: usize = 8;

/// Factor by which rounding may raise a bound that is summed in another order.
pub(super) const ROUNDING: f64 = 1.0 + 1e-13;

/// How many steps of a run are put off at most, but for those that have been beaten.
const MOST_PUT_OFF: usize = 64;

/// Part of a bound from below that is not used, so that rounding and [peaks that are the same](crate::run::peaks) never matter.
const SLACK: f64 = 1e-9;

/// A watcher of a motion whose steps are taken among others.
pub(crate) trait Passes<Q: Coordinates = f64>: Watch<Q> {
    /// Puts what the watcher must see of the structure of `engine` in its present phase into a `lane` of `sought`.
    fn seek(&self, engine: &Engine<Q>, lane: usize, sought: &mut Sought<Q>);

    /// Passes a piece that the watcher need not see.
    fn pass(&mut self);

    /// Sees a piece whose quantities are within these `bounds`, when it may look at the motion within the piece later.
    fn put_off(&mut self, piece: &Piece<Q>, bounds: &[f64]);
}

/// Limits, bounds and steps for the watchers of several runs.
#[derive(Debug, Default)]
pub(crate) struct Sought<Q> {
    quantities: Vec<PeakOfRuns>,
    /// A piece must be seen at once if |θ| may be no more than the first, or is at least the second at its end.
    pub turned: [PerRun; 2],
    /// Steps that may hold a peak, in order of time, and bounds of the quantities over them.
    put_off: [(Vec<PutOff<Q>>, Vec<f64>); MOST],
}

/// A quantity of each run.
#[derive(Clone, Debug, Default)]
#[repr(align(64))]
struct PeakOfRuns {
    /// The least magnitude that must be seen.
    least: PerRun,
    /// [Weights](crate::mechanics::reach::Reach::weights) of θ and of each u and u̇.
    turn: [PerRun; 3],
    elastic: [[PerRun; 2]; MOST_MODES],
    /// Bound of what no weights bound: infinite if there are no weights, so that every step is shown.
    rest: PerRun,
    /// Bound over the last step.
    bound: PerRun,
}

/// A step that is shown to a watcher after others.
#[derive(Debug)]
struct PutOff<Q> {
    /// s.
    time: f64,
    duration: f64,
    a_g: Ramp,
    start: State<Q>,
    end: State<Q>,
    /// The place of its bounds.
    bounds: Range<usize>,
}

/// u and u̇ of each of N modes, and θ, or magnitudes of these.
#[derive(Clone, Copy)]
pub(super) struct Turned<S: Simd, const N: usize> {
    pub u: [Lanes<S>; N],
    pub u_dot: [Lanes<S>; N],
    pub theta: Lanes<S>,
}

/// A step of several runs: the motion at both ends, and how far it leaves its chord.
pub(super) struct StepOfRuns<S: Simd, const N: usize> {
    pub ends: [Turned<S, N>; 2],
    pub off: Turned<S, N>,
}

/// How a step bends: the changes over the step that the slopes at both ends would bring, and how far the motion leaves the cubics with
/// these slopes.
pub(super) struct Bend<S: Simd, const N: usize> {
    pub slopes: [Turned<S, N>; 2],
    pub off_cubic: Turned<S, N>,
}

impl<S: Simd, const N: usize> StepOfRuns<S, N> {
    /// Bounds of the magnitudes.
    #[inline(always)]
    pub(super) fn most(&self) -> Turned<S, N> {
        let ([start, end], mut most) = (&self.ends, self.off);
        for j in 0..N {
            most.u[j] = start.u[j].abs().max(end.u[j].abs()) + most.u[j];
            most.u_dot[j] = start.u_dot[j].abs().max(end.u_dot[j].abs()) + most.u_dot[j];
        }
        Turned { theta: start.theta.abs().max(end.theta.abs()) + most.theta, ..most }
    }
}

impl PeakOfRuns {
    /// The weighed sum of u and u̇ in `of`, and the part of θ: with the signs of the weights, or with their magnitudes.
    #[inline(always)]
    fn weigh<S: Simd, const N: usize, const SIGNED: bool>(&self, simd: S, of: &Turned<S, N>) -> [Lanes<S>; 2] {
        let (mut elastic, mut turning) = (Lanes::splat(simd, 0.0), Lanes::load(simd, &self.turn[0]));
        for j in 0..N {
            let [mut u, mut u_dot] = load(simd, &self.elastic[j]);
            if !SIGNED {
                (u, u_dot) = (u.abs(), u_dot.abs());
            }
            elastic = elastic + u * of.u[j] + u_dot * of.u_dot[j];
        }
        if !SIGNED {
            turning = turning.abs();
        }
        [elastic, turning * of.theta]
    }

    /// Bounds of the part of u and u̇ and of all of the quantity, given those of the motion and of 1 − cos θ.
    #[inline(always)]
    fn most<S: Simd, const N: usize>(&self, simd: S, of: &Turned<S, N>, versine: Lanes<S>) -> [Lanes<S>; 2] {
        let [elastic, turning] = self.weigh::<S, N, false>(simd, of);
        let [of_versine, rest] = [&self.turn[2], &self.rest].map(|row| Lanes::load(simd, row));
        [elastic, (elastic + turning + of_versine * versine + rest) * versine.like(ROUNDING)]
    }
}

impl<Q: Coordinates> Sought<Q> {
    /// Seeks `quantities` in `lane`. Of each: the least magnitude that must be seen, the weights of θ, a bound of the rest, and the weights
    /// of each of so many modes.
    pub(crate) fn seek<Elastic: Fn(usize) -> [f64; 2]>(
        &mut self,
        (lane, modes): (usize, usize),
        quantities: impl Iterator<Item = (f64, [f64; 3], f64, Elastic)>,
    ) {
        let mut count = 0;
        for (i, (least, turn, rest, elastic)) in quantities.enumerate() {
            if i == self.quantities.len() {
                self.quantities.push(PeakOfRuns::default());
            }
            let of = &mut self.quantities[i];
            (of.least[lane], of.rest[lane]) = (least, rest);
            put(&mut of.turn, lane, turn);
            of.elastic.iter_mut().take(modes).enumerate().for_each(|(j, rows)| put(rows, lane, elastic(j)));
            count = i + 1;
        }
        for of in &mut self.quantities[count..] {
            let rows = of.turn.iter_mut().chain(of.elastic.iter_mut().flatten());
            rows.chain([&mut of.rest]).for_each(|row| row[lane] = 0.0);
        }
    }

    /// Whether steps within these magnitudes certainly hold no peak.
    #[inline(always)]
    pub(super) fn are_passed<S: Simd, const N: usize>(&self, simd: S, most: &Turned<S, N>) -> Answers<S> {
        let zero = Lanes::splat(simd, 0.0);
        let (mut passed, versine) = (zero.is_at_most(zero), zero.like(0.5) * most.theta * most.theta);
        for of in &self.quantities {
            let [_, bound] = of.most(simd, most, versine);
            passed = passed & (bound.is_less(Lanes::load(simd, &of.least)) | bound.is_at_most(zero));
        }
        passed
    }

    /// Finds bounds of what is sought over a step of this `stretch` and `bend`. Raises the least magnitudes `where_so` by values at the
    /// ends and in the middle of the step.
    #[inline(always)]
    pub(super) fn bound<S: Simd, const N: usize>(
        &mut self,
        simd: S,
        (stretch, bend): (&StepOfRuns<S, N>, &Bend<S, N>),
        where_so: Answers<S>,
    ) {
        let most = stretch.most();
        let (theta, one, zero) = (most.theta, most.theta.like(1.0), most.theta.like(0.0));
        let versine = one.like(0.5) * theta * theta;
        let cubic = versine * theta / one.like(3.0);
        for of in &mut self.quantities {
            let [elastic, simple] = of.most(simd, &most, versine);
            let [_, of_cubic, of_versine] = load(simd, &of.turn);
            let [least, rest] = [&of.least, &of.rest].map(|row| Lanes::load(simd, row));
            simple.store(&mut of.bound);
            let seen = where_so.choose(simple, zero);
            if (seen.is_less(least) | seen.is_at_most(zero)).all() {
                continue;
            }
            let curved = (elastic + of_versine) * versine + of_cubic * cubic + rest;
            let [off, off_turning] = of.weigh::<S, N, false>(simd, &bend.off_cubic);
            let off = off + off_turning;
            // the cubic of the linear part lies among the control points of its halves
            let mut ends = [[one; 2]; 2];
            for (i, [value, slope]) in ends.iter_mut().enumerate() {
                let [elastic, turning] = of.weigh::<S, N, true>(simd, &stretch.ends[i]);
                let [elastic_slope, turning_slope] = of.weigh::<S, N, true>(simd, &bend.slopes[i]);
                (*value, *slope) = (elastic + turning, (elastic_slope + turning_slope) / one.like(3.0));
            }
            let ([[start, rise], [end, fall]], half) = (ends, one.like(0.5));
            let [second, third] = [start + rise, end - fall];
            let [first, middle, last] = [half * (start + second), half * (second + third), half * (third + end)];
            let [before, after] = [half * (first + middle), half * (middle + last)];
            let (largest, middle) = (start.abs().max(end.abs()), (half * (before + after)).abs());
            let among = first.abs().max(before.abs()).max(after.abs()).max(last.abs()).max(middle);
            // what is rounded is of the size of the sum of all magnitudes
            let bound = largest.max(among + off) + curved + simple * one.like(ROUNDING - 1.0);
            simple.min(bound).store(&mut of.bound);
            let known = largest.max(middle - off) - curved - simple * one.like(SLACK);
            where_so.choose(least.max(known), least).store(&mut of.least);
        }
    }

    /// Whether a step within these bounds of the run in `lane` may hold a peak.
    fn may_hold(&self, lane: usize, bounds: &[f64]) -> bool {
        let may_hold = |(bound, of): (&f64, &PeakOfRuns)| *bound > 0.0 && *bound >= of.least[lane];
        bounds.iter().zip(&self.quantities).any(may_hold)
    }

    /// Puts off a step of the run in `lane`, the last one that has bounds. Returns whether it may put off another one.
    pub(super) fn put_off(
        &mut self,
        lane: usize,
        (time, duration, a_g): (f64, f64, Ramp),
        [start, end]: [State<Q>; 2],
    ) -> bool {
        let (mut steps, mut all) = std::mem::take(&mut self.put_off[lane]);
        let bounds = all.len()..all.len() + self.quantities.len();
        all.extend(self.quantities.iter().map(|of| of.bound[lane]));
        steps.push(PutOff { time, duration, a_g, start, end, bounds });
        if steps.len() == MOST_PUT_OFF {
            steps.retain(|step| self.may_hold(lane, &all[step.bounds.clone()]));
        }
        let may_go_on = steps.len() < MOST_PUT_OFF;
        self.put_off[lane] = (steps, all);
        may_go_on
    }

    /// Shows what has been put off of the run of `engine` in `lane`, which entered with the motion of `engine`.
    pub(super) fn show<W: Passes<Q>>(&mut self, lane: usize, engine: &Engine<Q>, watch: &mut W) {
        let Engine { level, motion, room, .. } = engine;
        let (mut steps, mut all) = std::mem::take(&mut self.put_off[lane]);
        for PutOff { time, duration, a_g, start, end, bounds } in &steps {
            if *time > motion.time {
                watch.pass();
            }
            let bounds = &all[bounds.clone()];
            if self.may_hold(lane, bounds) {
                let before = &Motion { time: *time, state: *start, ..*motion };
                let load = LinearLoad::default().on_ground((*a_g).into());
                let piece = Piece { before, duration: *duration, load, end: *end, level: &**level, arc: None, room };
                watch.put_off(&piece, bounds);
            }
        }
        steps.clear();
        all.clear();
        self.put_off[lane] = (steps, all);
    }
}
