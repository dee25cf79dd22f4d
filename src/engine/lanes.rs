//! Engines whose steps are taken together: leaps in full contact, and steps of rocking by Eqs 5 and 6.
//!
//! A register of the processor has one number of each run. The operations on the numbers of a run are those of the run by itself,
//! in the same order, so that all results have the same bits. The bounds for watchers are a little wider: what they prove, the run
//! by itself proves too. A step that may hold a peak is put off: the steps after it mostly hold larger values.

use super::{
    Advance, AdvanceError, Engine, Loop, MAX_STEPS_PER_ADVANCE, Progress, Settings, is_at_its_end, leap_under, leapt,
};
use crate::engine::motion::Motion;
use crate::engine::phases;
use crate::engine::piece::{Piece, Watch};
use crate::levels::detail::Elastic;
use crate::levels::full_contact::ExactContact;
use crate::levels::level::{Level, Pace, off_chord};
use crate::levels::nonlinear::{Equations, NonlinearRocking, Products, Recurrence, Rocker};
use crate::levels::oscillator::{Flow, Oscillator};
use crate::numbers::Real;
use crate::numbers::lanes::{Answers, Lanes, MOST};
use crate::series::extremes::OFF_CHORD;
use crate::series::taylor::{self, Arc, LONGEST_SPAN, MAX_ORDER, MIN_ORDER, Start, Truncation, reciprocal};
use crate::{Detail, LinearLoad, Phase, Ramp, State, Transition};
use pulp::{Simd, WithSimd};
use std::f64::consts::FRAC_PI_2;

/// Factor by which rounding may raise a bound that is summed in another order.
const ROUNDING: f64 = 1.0 + 1e-13;

/// The most quantities whose peaks a watcher seeks.
pub(crate) const MOST_SOUGHT: usize = 4;

/// How many steps of a run are put off before those that have been beaten are dropped, and how many at most.
const PUT_OFF: usize = 16;
const MOST_PUT_OFF: usize = 256;

/// Part of a bound from below that is not used, so that rounding and [peaks that are the same](crate::run::peaks) never matter.
const SLACK: f64 = 1e-9;

/// How many leaps are looked at to find the two durations of most of them.
const LOOKED_AHEAD: usize = 4;

/// A number of each run.
pub(crate) type Row = [f64; MOST];

/// What the watchers of several runs seek.
#[derive(Debug, Default)]
pub(crate) struct Sought {
    /// How many quantities.
    pub count: usize,
    /// The [weights](crate::mechanics::reach::Reach::of_one) of each quantity.
    pub weights: [[Row; 5]; MOST_SOUGHT],
    /// The least magnitude of each quantity that must be seen.
    pub least: [Row; MOST_SOUGHT],
    /// A piece must be seen at once if |θ| may be no more than the first, or is at least the second at its end.
    pub turned: [Row; 2],
    /// Steps that may hold a peak, in order of time.
    put_off: [Vec<PutOff>; MOST],
}

/// A step that is shown to a watcher after others.
#[derive(Debug)]
struct PutOff {
    /// The sample that ends it.
    sample: usize,
    /// s.
    duration: f64,
    a_g: Ramp,
    start: State,
    end: State,
    /// Bounds of what is sought.
    bounds: [f64; MOST_SOUGHT],
}

/// A step of several runs: u, u̇ and θ at both ends, and how far each leaves its chord.
struct Stretch<S: Simd> {
    ends: [[Lanes<S>; 3]; 2],
    off: [Lanes<S>; 3],
}

/// A watcher of a motion whose steps are taken among others.
pub(crate) trait Passes: Watch {
    /// Puts what the watcher must see of the structure of `engine` in its present phase into a `lane` of `sought`.
    fn seek(&self, engine: &Engine, lane: usize, sought: &mut Sought);

    /// Passes a piece that the watcher need not see.
    fn pass(&mut self);

    /// Sees a piece whose quantities are within these `bounds`, when it may look at the motion within the piece later.
    fn put_off(&mut self, piece: &Piece, bounds: &[f64; MOST_SOUGHT]);
}

/// Watches a motion after the piece under way, which it `passes` if the watcher need not see it.
struct After<'a, W> {
    watch: &'a mut W,
    passes: bool,
}

impl<W: Passes> Watch for After<'_, W> {
    fn piece(&mut self, piece: &Piece) {
        if std::mem::take(&mut self.passes) { self.watch.pass() } else { self.watch.piece(piece) }
    }

    fn transition(&mut self, transition: &Transition) {
        self.passes = false; // a step without duration is no piece
        self.watch.transition(transition);
    }
}

impl<S: Simd> Stretch<S> {
    /// Bounds of the magnitudes.
    #[inline(always)]
    fn most(&self) -> [Lanes<S>; 3] {
        let [start, end] = &self.ends;
        let mut most = self.off;
        for ((most, start), end) in most.iter_mut().zip(start).zip(end) {
            *most = start.abs().max(end.abs()) + *most;
        }
        most
    }
}

impl Sought {
    /// Whether steps within these magnitudes of u, u̇ and θ certainly hold no peak.
    #[inline(always)]
    fn are_passed<S: Simd>(&self, simd: S, [u, u_dot, theta]: [Lanes<S>; 3]) -> Answers<S> {
        let zero = Lanes::splat(simd, 0.0);
        let (mut passed, versine) = (zero.is_at_most(zero), zero.like(0.5) * theta * theta);
        for (weights, least) in self.weights[..self.count].iter().zip(&self.least) {
            let [of_u, of_u_dot, of_theta, _, of_versine] = load(simd, weights);
            let bound = of_u.abs() * u + of_u_dot.abs() * u_dot + of_theta.abs() * theta + of_versine * versine;
            let bound = bound * zero.like(ROUNDING);
            passed = passed & (bound.is_less(Lanes::load(simd, least)) | bound.is_at_most(zero));
        }
        passed
    }

    /// Bounds of what is sought over a step of `stretch`. Raises the least magnitudes `where_so` by values at the ends of the step.
    #[inline(always)]
    fn bounds<S: Simd>(&mut self, simd: S, stretch: &Stretch<S>, where_so: Answers<S>) -> [Row; MOST_SOUGHT] {
        let (mut bounds, most @ [.., theta]) = ([[0.0; MOST]; MOST_SOUGHT], stretch.most());
        let (one, versine) = (theta.like(1.0), theta.like(0.5) * theta * theta);
        let cubic = versine * theta / theta.like(3.0);
        for i in 0..self.count {
            let [of_u, of_u_dot, of_theta, of_cubic, of_versine] = load(simd, &self.weights[i]);
            let linear = |[u, u_dot, theta]: [Lanes<S>; 3]| of_u * u + of_u_dot * u_dot + of_theta * theta;
            let elastic = |[u, u_dot, _]: [Lanes<S>; 3]| of_u.abs() * u + of_u_dot.abs() * u_dot;
            let largest = linear(stretch.ends[0]).abs().max(linear(stretch.ends[1]).abs());
            let curved = (elastic(most) + of_versine) * versine + of_cubic * cubic;
            let off = elastic(stretch.off) + of_theta.abs() * stretch.off[2];
            ((largest + off + curved) * one.like(ROUNDING)).store(&mut bounds[i]);
            let least = Lanes::load(simd, &self.least[i]);
            where_so.choose(least.max((largest - curved) * one.like(1.0 - SLACK)), least).store(&mut self.least[i]);
        }
        bounds
    }

    /// Whether a step within these bounds of the run in `lane` may hold a peak.
    fn may_hold(&self, lane: usize, bounds: &[f64; MOST_SOUGHT]) -> bool {
        bounds[..self.count].iter().zip(&self.least).any(|(bound, least)| *bound > 0.0 && *bound >= least[lane])
    }

    /// Puts off a step of the run in `lane`. Returns whether it may put off another one.
    fn put_off(&mut self, lane: usize, step: PutOff) -> bool {
        self.put_off[lane].push(step);
        if self.put_off[lane].len().is_multiple_of(PUT_OFF) {
            let mut steps = std::mem::take(&mut self.put_off[lane]);
            steps.retain(|step| self.may_hold(lane, &step.bounds));
            self.put_off[lane] = steps;
        }
        self.put_off[lane].len() < MOST_PUT_OFF
    }

    /// Shows what has been put off of the run of `engine` in `lane`, which `entered` at this one of the samples at `times`.
    fn show<W: Passes>(&mut self, lane: usize, (times, entered): (&[f64], usize), engine: &Engine, watch: &mut W) {
        let Engine { level, motion, room, .. } = engine;
        let mut steps = std::mem::take(&mut self.put_off[lane]);
        for PutOff { sample, duration, a_g, start, end, bounds } in steps.drain(..) {
            let is_later = sample > entered;
            if is_later {
                watch.pass();
            }
            if self.may_hold(lane, &bounds) {
                let time = if is_later { times[sample - 1] } else { motion.time };
                let before = &Motion { time, state: start, ..*motion };
                let piece = Piece { before, duration, load: a_g.into(), end, level: &**level, arc: None, room };
                watch.put_off(&piece, &bounds);
            }
        }
        self.put_off[lane] = steps;
    }
}

/// The samples of a record that end whole segments of a run.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Samples<'a> {
    /// s.
    pub times: &'a [f64],
    /// m/s².
    pub a_g: &'a [f64],
    /// The sample that ends the next segment.
    pub next: usize,
    /// The first sample that ends none.
    pub last: usize,
}

/// Puts the numbers of the run in `lane` into their rows.
#[inline(always)]
fn put<const K: usize>(rows: &mut [Row; K], lane: usize, numbers: [f64; K]) {
    rows.iter_mut().zip(numbers).for_each(|(row, number)| row[lane] = number);
}

/// The rows as numbers of all runs.
#[inline(always)]
fn load<S: Simd, const K: usize>(simd: S, rows: &[Row; K]) -> [Lanes<S>; K] {
    let mut numbers = [Lanes::splat(simd, 0.0); K];
    for (number, row) in numbers.iter_mut().zip(rows) {
        *number = Lanes::load(simd, row);
    }
    numbers
}

/// Leaps in full contact of several runs, from sample to sample.
#[derive(Debug, Default)]
#[repr(align(64))]
pub(crate) struct Contacts<'a> {
    sought: Sought,
    samples: [Samples<'a>; MOST],
    entered: [usize; MOST],
    /// 1 where there is a run.
    is_there: Row,
    /// The contact of the run that is there, or was there last.
    exact: [Option<ExactContact>; MOST],
    oscillator: Oscillator<Row>,
    u_cr: Row,
    /// The longest leap that may be put off, s: a watcher looks at a longer one piece by piece.
    longest: Row,
    u: Row,
    u_dot: Row,
    age: Row,
    /// Two durations (s) with the numbers of the [`Flow`] over each, and which of them is the newer one. Between two powers of 2 the times
    /// i dt of a record differ by one of two numbers.
    flows: [[Row; 7]; 2],
    newer: [usize; MOST],
    /// The time of a sample and the ground acceleration there. A sample is written number by number a leap before it is read as rows,
    /// since the processor would otherwise wait for the numbers.
    ends: [[Row; 2]; 2],
    /// 1 where the last leap has been taken.
    is_taken: Row,
}

impl<'a> Contacts<'a> {
    /// Puts the run of `engine`, which has come to these samples, into `lane`.
    pub(crate) fn enter<W: Passes>(&mut self, lane: usize, engine: &Engine, samples: Samples<'a>, watch: &W) {
        let (one, motion) = (engine.structure().one().expect("it is of one mass"), engine.motion());
        watch.seek(engine, lane, &mut self.sought);
        (self.samples[lane], self.entered[lane], self.is_there[lane]) = (samples, samples.next, 1.0);
        (self.u_cr[lane], self.age[lane]) = (one.u_cr, motion.chatter.age);
        self.longest[lane] = LONGEST_SPAN / engine.structure().vibration().rocking[1];
        (self.u[lane], self.u_dot[lane]) = (motion.state.u, motion.state.u_dot);
        let level = by_equations_5_and_6(&*engine.level).expect(STEPS_ALONE);
        let exact = level.contact().expect("it may leap");
        if self.exact[lane].as_ref().is_none_or(|kept| kept.oscillator != exact.oscillator) {
            let Oscillator { omega, zeta } = exact.oscillator;
            (self.oscillator.omega[lane], self.oscillator.zeta[lane]) = (omega, zeta);
            self.flows.iter_mut().for_each(|[duration, ..]| duration[lane] = 0.0);
            self.exact[lane] = Some(exact.clone());
        }
        self.prepare(lane);
    }

    /// Keeps the flows of the next leaps of the run in `lane`.
    #[inline]
    fn prepare(&mut self, lane: usize) {
        let (Samples { times, next, last, .. }, Some(exact)) = (self.samples[lane], &self.exact[lane]) else { return };
        for ends in times[next - 1..last.min(next + LOOKED_AHEAD)].windows(2).rev() {
            let duration = ends[1] - ends[0];
            if self.flows.iter().all(|[kept, ..]| kept[lane] != duration) {
                self.newer[lane] = 1 - self.newer[lane];
                let Flow { free: [m11, m12, m21, m22], step, ramp } = *exact.flow(duration);
                put(&mut self.flows[self.newer[lane]], lane, [duration, m11, m12, m21, m22, step, ramp]);
            }
        }
    }

    /// Leaps as often as all runs do: while the bases certainly stay down and the watchers need not see it.
    pub(crate) fn step<S: Simd>(&mut self, simd: S) {
        let is_there = self.is_there;
        let lanes = || (0..S::F64_LANES).filter(|lane| is_there[*lane] == 1.0);
        let left = |samples: &Samples| samples.last.saturating_sub(samples.next);
        loop {
            let most = lanes().map(|lane| left(&self.samples[lane])).min();
            simd.vectorize(Leapt(simd, self, most.unwrap_or(0)));
            if !lanes().all(|lane| self.goes_on(lane)) {
                return;
            }
            lanes().for_each(|lane| self.prepare(lane)); // a duration is new
        }
    }

    /// Whether the run in `lane` has leapt and may do so again.
    #[inline]
    pub(crate) fn goes_on(&self, lane: usize) -> bool {
        self.is_taken[lane] == 1.0 && self.samples[lane].next < self.samples[lane].last
    }

    /// Takes the run in `lane` out. Returns the next sample.
    pub(crate) fn leave<W: Passes>(&mut self, lane: usize, engine: &mut Engine, watch: &mut W) -> usize {
        self.is_there[lane] = 0.0;
        let Samples { times, next, .. } = self.samples[lane];
        if next > self.entered[lane] {
            self.sought.show(lane, (times, self.entered[lane]), engine, watch);
            let motion = &mut engine.motion;
            motion.state = State { u: self.u[lane], u_dot: self.u_dot[lane], theta: 0.0, theta_dot: 0.0 };
            (motion.chatter.age, motion.time) = (self.age[lane], times[next - 1]);
            motion.work.steps += (next - self.entered[lane]) as u64;
            watch.pass();
        }
        next
    }

    /// Puts off the leap over a `stretch` that is `ahead` of the next one of each run, where it is taken and not passed.
    #[inline(always)]
    fn put_off<S: Simd>(
        &mut self,
        simd: S,
        stretch: &Stretch<S>,
        ahead: usize,
        is_taken: Answers<S>,
        is_passed: Answers<S>,
    ) {
        let bounds = self.sought.bounds(simd, stretch, is_taken);
        let (one, zero) = (Lanes::splat(simd, 1.0), Lanes::splat(simd, 0.0));
        let is_put_off = is_passed.choose(zero, is_taken.choose(one, zero));
        for lane in (0..S::F64_LANES).filter(|lane| self.is_there[*lane] == 1.0 && is_put_off.of(*lane) == 1.0) {
            let Samples { times, a_g, next, last } = &mut self.samples[lane];
            let sample = *next + ahead;
            let duration = times[sample] - times[sample - 1];
            let a_g = Ramp::between(a_g[sample - 1], a_g[sample], duration);
            let [start, end] =
                stretch.ends.map(|[u, u_dot, _]| State { u: u.of(lane), u_dot: u_dot.of(lane), ..State::default() });
            let bounds = bounds.map(|of| of[lane]);
            if !self.sought.put_off(lane, PutOff { sample, duration, a_g, start, end, bounds }) {
                *last = (*last).min(sample + 1);
            }
        }
    }

    /// Writes the sample that is `ahead` of the next one of each run.
    #[inline(always)]
    fn write(&mut self, ahead: usize) {
        let [time, a] = &mut self.ends[ahead % 2];
        for (lane, Samples { times, a_g, next, .. }) in self.samples.iter().enumerate() {
            let sample = (next + ahead).wrapping_sub(1);
            if let (Some(next_time), Some(next_a)) = (times.get(sample), a_g.get(sample)) {
                (time[lane], a[lane]) = (*next_time, *next_a);
            }
        }
    }
}

/// Leaping, at most as often as this.
struct Leapt<'c, 'a, S: Simd>(S, &'c mut Contacts<'a>, usize);

impl<S: Simd> WithSimd for Leapt<'_, '_, S> {
    type Output = ();

    #[inline(always)]
    fn with_simd<T: Simd>(self, _simd: T) {
        let Leapt(simd, of, left) = self;
        let row = |row: &Row| Lanes::load(simd, row);
        let oscillator = Oscillator { omega: row(&of.oscillator.omega), zeta: row(&of.oscillator.zeta) };
        let (mut u, mut u_dot, mut age, u_cr) = (row(&of.u), row(&of.u_dot), row(&of.age), row(&of.u_cr));
        let (one, none, largest) = (u.like(1.0), u.like(0.0), u.like(f64::MAX));
        let is_absent = row(&of.is_there).is_less(one);
        let (mut is_taken, mut leaps) = (none.is_less(one), 0);
        of.write(0);
        of.write(1);
        let [mut time, mut a] = load(simd, &of.ends[0]);
        while leaps < left {
            of.write(leaps + 2);
            let [time_next, a_next] = load(simd, &of.ends[(leaps + 1) % 2]);
            let duration = time_next - time;
            let is_first = duration.is_equal(row(&of.flows[0][0]));
            let mut flow = [none; 7];
            for ((number, first), second) in flow.iter_mut().zip(&of.flows[0]).zip(&of.flows[1]) {
                *number = is_first.choose(row(first), row(second));
            }
            let [kept, m11, m12, m21, m22, step, ramp] = flow;
            if !(duration.is_equal(kept) | is_absent).all() {
                break;
            }
            let slope = (a_next - a) / duration;
            let [u_end, u_dot_end] = Flow { free: [m11, m12, m21, m22], step, ramp }.driven([u, u_dot], a, slope);
            let swing = oscillator.swing([u, u_dot], a, slope, duration);
            let is_low = oscillator.farthest(&swing, [u, u_end], slope, duration).is_less(u_cr);
            let [swing_u, swing_u_dot, u_ddot, jerk] = oscillator.swings(&swing);
            let per_bend = duration * duration / u.like(8.0);
            let off = [off_chord(swing_u, [u_ddot, per_bend]), off_chord(swing_u_dot, [jerk, per_bend]), none];
            let stretch = Stretch { ends: [[u, u_dot, none], [u_end, u_dot_end, none]], off };
            let is_finite =
                (u_end + u_dot_end).abs().is_at_most(largest) & (a + slope * duration).abs().is_at_most(largest);
            is_taken = is_low & is_finite;
            let is_passed = of.sought.are_passed(simd, stretch.most());
            if !(is_passed | is_absent).all() {
                is_taken = is_taken & (is_passed | duration.is_at_most(row(&of.longest)));
                of.put_off(simd, &stretch, leaps, is_taken, is_passed);
            }
            leaps += 1;
            if !(is_taken | is_absent).all() {
                (u, u_dot) = (is_taken.choose(u_end, u), is_taken.choose(u_dot_end, u_dot));
                age = is_taken.choose(age + duration, age);
                break;
            }
            (u, u_dot, age, time, a) = (u_end, u_dot_end, age + duration, time_next, a_next);
        }
        is_taken.choose(one, none).store(&mut of.is_taken);
        for (number, row) in [(u, &mut of.u), (u_dot, &mut of.u_dot), (age, &mut of.age)] {
            number.store(row);
        }
        for (Samples { next, .. }, is_taken) in of.samples.iter_mut().zip(of.is_taken) {
            *next += leaps - usize::from(is_taken == 0.0);
        }
    }
}

/// Steps of rocking of several runs, from sample to sample.
#[derive(Debug)]
pub(crate) struct Rocking<'a, S: Simd> {
    simd: S,
    runs: Runs<'a>,
    products: Products<Lanes<S>>,
    /// Of the last step: u, u̇, θ and θ̇, order by order.
    series: [[Lanes<S>; 4]; MAX_ORDER + 1],
}

/// Several runs that rock, before and after the last step.
#[derive(Debug, Default)]
#[repr(align(64))]
struct Runs<'a> {
    sought: Sought,
    samples: [Samples<'a>; MOST],
    entered: [usize; MOST],
    /// False if the run is new in its lane, or if a watcher has seen a piece or a transition, which may change its limits.
    is_known: [bool; MOST],
    /// 1 where there is a run.
    is_there: Row,
    /// The numbers of a [`Rocker`], and of a [`Pace`].
    rocker: [Row; 6],
    pace: [Row; 5],
    local_error: Row,
    gravity: Row,
    side: Row,
    /// Of the next step: u, u̇, θ and θ̇ at its start, the ground acceleration from there on, its time at most (s), and 1 where another
    /// sample comes after it.
    state: [Row; 4],
    a_g: Row,
    slope: Row,
    interval: Row,
    may_go_on: Row,
    /// The run's age among its transitions, and its evaluations until then.
    age: Row,
    evaluations: Row,
    /// Of the last step: its order, its span (s), the part of the span up to which the series holds, and the state there.
    order: Row,
    span: Row,
    reach: Row,
    end: [Row; 4],
    /// 1 where the last step's series proves that no guard closes, and where the watcher need not see the step or a part from its start.
    stays: Row,
    is_passed: Row,
    /// 1 where the run has gone on to the next sample.
    has_gone_on: Row,
}

impl<'a, S: Simd> Rocking<'a, S> {
    pub(crate) fn new(simd: S) -> Rocking<'a, S> {
        let zero = Lanes::splat(simd, 0.0);
        let series = [[zero; 4]; MAX_ORDER + 1];
        Rocking { simd, runs: Runs::default(), products: Products::new(zero), series }
    }

    /// Puts the run of `engine`, whose `advance` leads to the first of these samples, into `lane`.
    #[inline]
    pub(crate) fn enter<W: Passes>(
        &mut self,
        lane: usize,
        engine: &Engine,
        advance: &Advance<f64>,
        samples: Samples<'a>,
        watch: &W,
    ) {
        let (runs, level) = (&mut self.runs, by_equations_5_and_6(&*engine.level).expect(STEPS_ALONE));
        let (motion, rocking) = (&engine.motion, level.rocking());
        if !std::mem::replace(&mut runs.is_known[lane], true) {
            watch.seek(engine, lane, &mut runs.sought);
            let (side, one) = (motion.phase.side(), engine.structure().one());
            let Rocker { H, pivot, weight_offset, foundation, stiffness, damping_u } = rocking.rocker(side);
            put(&mut runs.rocker, lane, [H, pivot, weight_offset, foundation, stiffness, damping_u]);
            let Pace { longest_span, omega, longest_response, gravity, height } = rocking.pace;
            put(&mut runs.pace, lane, [longest_span, omega, longest_response, gravity, height]);
            runs.local_error[lane] = level.subject().local_error;
            runs.gravity[lane] = one.expect("it is of one mass").parameters().g;
            (runs.side[lane], runs.is_there[lane]) = (side.sign(), 1.0);
        }
        let Start { state: State { u, u_dot, theta, theta_dot }, a_g, interval, .. } =
            advance.start(level.subject(), motion);
        put(&mut runs.state, lane, [u, u_dot, theta, theta_dot]);
        (runs.a_g[lane], runs.slope[lane], runs.interval[lane]) = (a_g.value, a_g.slope, interval);
        (runs.age[lane], runs.evaluations[lane]) = (motion.chatter.age, 0.0);
        let left = advance.last_step.saturating_sub(motion.work.steps) as usize;
        let last = samples.last.min(samples.next.saturating_add(left));
        (runs.samples[lane], runs.entered[lane]) = (Samples { last, ..samples }, samples.next);
        // the end of a part is no sample
        runs.may_go_on[lane] = f64::from(samples.next < last && advance.end == advance.interval);
    }

    /// Takes steps as long as all runs go on to their next samples: the bases certainly stay up, and the watchers need not see it.
    /// Returns how many steps each run has taken.
    pub(crate) fn step(&mut self) -> u64 {
        let mut steps = 0;
        let mut all_go_on = true;
        while all_go_on {
            self.simd.vectorize(Taken(self));
            let runs = &mut self.runs;
            steps += 1;
            for lane in (0..S::F64_LANES).filter(|lane| runs.is_there[*lane] == 1.0) {
                if runs.has_gone_on[lane] == 0.0 {
                    all_go_on = false;
                    continue;
                }
                let Samples { times, a_g, next, last } = &mut runs.samples[lane];
                let duration = times[*next] - times[*next - 1];
                let Ramp { value, slope } = Ramp::between(a_g[*next - 1], a_g[*next], duration);
                *next += 1;
                runs.may_go_on[lane] = f64::from(*next < *last);
                (runs.a_g[lane], runs.slope[lane], runs.interval[lane]) = (value, slope, duration);
            }
        }
        steps
    }

    /// Whether the run in `lane` has gone on to its next sample.
    #[inline]
    pub(crate) fn has_gone_on(&self, lane: usize) -> bool {
        self.runs.has_gone_on[lane] == 1.0
    }

    /// Brings `engine` to the sample before the step that the run in `lane` was about to take. Returns the next sample if that is another
    /// one than that where it was.
    #[inline]
    pub(crate) fn catch_up<W: Passes>(&mut self, lane: usize, engine: &mut Engine, watch: &mut W) -> Option<usize> {
        let (Samples { times, next, .. }, entered) = (self.runs.samples[lane], self.runs.entered[lane]);
        let passed = next - entered;
        if passed == 0 {
            return None;
        }
        self.runs.sought.show(lane, (times, entered - 1), engine, watch);
        let motion = &mut engine.motion;
        let [u, u_dot, theta, theta_dot] = &self.runs.state;
        motion.state = State { u: u[lane], u_dot: u_dot[lane], theta: theta[lane], theta_dot: theta_dot[lane] };
        (motion.chatter.age, motion.time) = (self.runs.age[lane], times[next - 2]);
        motion.work.steps += passed as u64;
        motion.work.evaluations += self.runs.evaluations[lane] as u64;
        watch.pass();
        Some(next - 1)
    }

    /// Takes the run in `lane` out.
    pub(crate) fn leave(&mut self, lane: usize) {
        (self.runs.is_there[lane], self.runs.is_known[lane]) = (0.0, false);
    }

    /// Writes the series of the run in `lane` into `arc`.
    #[cold]
    fn write(&self, lane: usize, arc: &mut Arc) {
        let order = self.runs.order[lane] as usize;
        for (k, [u, u_dot, theta, theta_dot]) in self.series.iter().enumerate().take(order + 1) {
            (arc.u[k], arc.u_dot[k]) = (u.of(lane), u_dot.of(lane));
            (arc.theta[k], arc.theta_dot[k]) = (theta.of(lane), theta_dot.of(lane));
        }
        (arc.order, arc.span, arc.reach) = (order, self.runs.span[lane], self.runs.reach[lane]);
    }
}

impl Runs<'_> {
    /// Puts off the last step of the run in `lane`.
    fn put_off(&mut self, lane: usize, bounds: &[Row; MOST_SOUGHT]) {
        let Samples { next, last, .. } = &mut self.samples[lane];
        let (sample, duration) = (*next - 1, self.interval[lane]);
        let a_g = Ramp { value: self.a_g[lane], slope: self.slope[lane] };
        let [start, end] = [&self.state, &self.end].map(|of| {
            let [u, u_dot, theta, theta_dot] = of;
            State { u: u[lane], u_dot: u_dot[lane], theta: theta[lane], theta_dot: theta_dot[lane] }
        });
        let bounds = bounds.map(|of| of[lane]);
        if !self.sought.put_off(lane, PutOff { sample, duration, a_g, start, end, bounds }) {
            *last = (*last).min(*next);
        }
    }
}

/// Taking steps of rocking.
struct Taken<'s, 'a, S: Simd>(&'s mut Rocking<'a, S>);

impl<S: Simd> WithSimd for Taken<'_, '_, S> {
    type Output = ();

    #[inline(always)]
    fn with_simd<T: Simd>(self, _simd: T) {
        let Taken(Rocking { simd, runs: of, products, series }) = self;
        let simd = *simd;
        let row = |row: &Row| Lanes::load(simd, row);
        let [u, u_dot, theta, theta_dot] = load(simd, &of.state);
        let (side, a_g, slope, interval) = (row(&of.side), row(&of.a_g), row(&of.slope), row(&of.interval));
        let [H, pivot, weight_offset, foundation, stiffness, damping_u] = load(simd, &of.rocker);
        let rocker = Rocker { H, pivot, weight_offset, foundation, stiffness, damping_u };
        let [longest_span, omega, longest_response, gravity, height] = load(simd, &of.pace);
        let pace = Pace { longest_span, omega, longest_response, gravity, height };
        let span = pace.span(interval);
        let [largest, largest_turning] = pace.largest([u, u_dot, theta_dot], [a_g, slope], span);
        let local_error = row(&of.local_error);
        let (truncation, truncation_turning) = (local_error * largest, local_error * largest_turning);
        let (g, push) = (row(&of.gravity), [a_g, slope * span]);
        let (none, one, zero) = (g.like(-0.0), g.like(1.0), g.like(0.0));
        // no force acts
        let equations =
            Equations { rocker, u, u_dot, theta_dot, turn: theta.sin_cos(), push, ground: push, gravity: [g, zero] };
        let mut recurrence = Recurrence::new(equations);
        let is_there = row(&of.is_there);
        let (mut ended, mut was_small, mut order) = (is_there.is_less(one), one.is_less(zero), zero);
        let (mut last, mut of_order) = (0, [u, u_dot, theta, theta_dot]);
        series[0] = of_order;
        for (k, places) in series.iter_mut().enumerate().skip(1) {
            let [_, u_dot, _, theta_dot] = of_order;
            let per = span * g.like(reciprocal(k));
            let (u, theta) = (u_dot * per, theta_dot * per);
            let (u_dot, theta_dot) = recurrence.next::<false>(products, k, u, per, |none| none);
            of_order = [u, u_dot, theta, theta_dot];
            // what has ended adds nothing
            for (place, number) in places.iter_mut().zip(of_order) {
                *place = ended.choose(none, number);
            }
            order = order + ended.choose(zero, one);
            last = k;
            let is_small = u_dot.abs().is_at_most(truncation) & theta_dot.abs().is_at_most(truncation_turning);
            if k >= MIN_ORDER {
                ended = ended | is_small & was_small;
                if ended.all() {
                    break;
                }
            }
            was_small = is_small;
        }
        of.reach = [1.0; MOST];
        if !ended.all() {
            let ended = ended.choose(one, zero);
            for lane in (0..S::F64_LANES).filter(|lane| ended.of(*lane) == 0.0) {
                let truncation = Truncation { u_dot: truncation.of(lane), theta_dot: truncation_turning.of(lane) };
                let velocities = |k: usize| (series[k][1].of(lane), series[k][3].of(lane));
                of.reach[lane] = taylor::reach(velocities, &truncation);
            }
        }
        let sigma = row(&of.reach);
        let sum = sigma.is_less(one).choose(zero, none);
        let (mut end, mut off, mut excursion) = ([sum; 4], [zero; 4], zero);
        for k in (1..last + 1).rev() {
            let weight = g.like(OFF_CHORD[k]);
            for (i, number) in series[k].into_iter().enumerate() {
                end[i] = end[i] * sigma + number;
                off[i] = (off[i] + weight * number.abs()) * sigma;
            }
            excursion = (excursion + series[k][2].abs()) * sigma;
        }
        let rounding = g.like(ROUNDING);
        for (i, number) in series[0].into_iter().enumerate() {
            end[i] = end[i] * sigma + number;
            end[i].store(&mut of.end[i]);
        }
        let start = side * theta;
        // as the run by itself proves that no guard closes
        let mut lead = zero;
        for [_, _, theta, _] in series[1..4].iter().rev() {
            let term = side * *theta;
            lead = term.is_less(zero).choose(zero, lead * sigma + term);
        }
        let leads = zero.is_at_most(start) & (excursion * rounding).is_less(sigma * (lead + lead));
        let rises = (excursion * rounding).is_less(start) | (off[2] * rounding).is_less(start.min(side * end[2]));
        let stays = (rises | leads) & ((excursion + start) * rounding).is_less(g.like(FRAC_PI_2));
        let size = end[0].abs() + end[1].abs() + end[2].abs() + end[3].abs();
        let stays = stays & size.is_at_most(g.like(f64::MAX));
        let stretch = Stretch { ends: [[u, u_dot, theta], [end[0], end[1], end[2]]], off: [off[0], off[1], off[2]] };
        let least = start.abs().min(end[2].abs()) - off[2] * rounding;
        let [above, below] = load(simd, &of.sought.turned);
        let is_free = above.is_less(least) & end[2].abs().is_less(below);
        let is_passed = of.sought.are_passed(simd, stretch.most());
        let duration = sigma * span;
        let is_whole = duration.is_at_most(interval) & interval.is_at_most(duration);
        let goes_on = stays & is_free & is_whole & one.is_at_most(is_there.min(row(&of.may_go_on)));
        let is_put_off = is_passed.choose(zero, goes_on.choose(one, zero));
        let is_passed = is_passed & is_free;
        if !is_put_off.is_at_most(zero).all() {
            let bounds = of.sought.bounds(simd, &stretch, goes_on);
            (0..S::F64_LANES).filter(|lane| is_put_off.of(*lane) == 1.0).for_each(|lane| of.put_off(lane, &bounds));
        }
        for (i, number) in series[0].into_iter().enumerate() {
            goes_on.choose(end[i], number).store(&mut of.state[i]);
        }
        let (age, evaluations) = (row(&of.age), row(&of.evaluations));
        goes_on.choose(age + duration, age).store(&mut of.age);
        goes_on.choose(evaluations + order, evaluations).store(&mut of.evaluations);
        stays.choose(one, zero).store(&mut of.stays);
        is_passed.choose(one, zero).store(&mut of.is_passed);
        goes_on.choose(one, zero).store(&mut of.has_gone_on);
        order.store(&mut of.order);
        span.store(&mut of.span);
    }
}

const STEPS_ALONE: &str = "another level steps alone";

/// The `level` by its type, if it is Eqs 5 and 6.
#[inline(always)]
fn by_equations_5_and_6(level: &dyn Level) -> Option<&Elastic<NonlinearRocking>> {
    level.as_any()?.downcast_ref()
}

impl Engine {
    /// Whether the structure rocks by Eqs 5 and 6 without ties, so that its steps can be taken among others.
    pub(crate) fn is_for_lanes(&self) -> bool {
        by_equations_5_and_6(&*self.level).is_some() && !self.level.subject().is_tied
    }

    /// Whether such a structure is in full contact from which it may lift off, and leaps there.
    #[inline]
    pub(crate) fn may_leap(&self) -> bool {
        let Motion { phase, chatter, .. } = &self.motion;
        *phase == Phase::FullContact && chatter.held <= 0.0 && self.settings.detail == Detail::Auto
    }

    /// Advances such a structure by `interval` (s) under `load` like [`Engine::go_on`], on `advance` unless one leap is all of it.
    pub(crate) fn begin<W: Passes>(
        &mut self,
        interval: f64,
        load: LinearLoad,
        advance: &mut Option<Advance<f64>>,
        watch: &mut W,
    ) -> Result<Option<Progress>, AdvanceError> {
        self.check(interval, &load)?;
        let (may_leap, level, motion) = (self.may_leap(), &*self.level, &mut self.motion);
        if may_leap && let Some(end) = leap_under(level, motion, interval, load) {
            leapt((level, &self.room), motion, interval, load, end, watch)?;
            return Ok(Some(Progress::Complete));
        }
        let last_step = motion.work.steps + MAX_STEPS_PER_ADVANCE;
        let advance = advance.insert(Advance::new(level.structure(), motion.time, interval, load, last_step));
        self.go_on(advance, false, true, watch)
    }

    /// Goes on with `advance` to its end, or to a step of rocking, if the engine `stops` before it. The engine has the next series
    /// already if the series `is_expanded`.
    #[inline(always)]
    pub(crate) fn go_on(
        &mut self,
        advance: &mut Advance<f64>,
        mut is_expanded: bool,
        stops: bool,
        watch: &mut dyn Watch,
    ) -> Result<Option<Progress>, AdvanceError> {
        let Engine { level, motion, arc, room, settings: Settings { stops: at_transitions, .. }, .. } = self;
        let level = &**level;
        let is_next = |phase: Phase| stops && matches!(phase, Phase::Rocking(_));
        if !is_expanded && is_next(motion.phase) && advance.elapsed < advance.end {
            return Ok(None);
        }
        let expand = |phase: Phase, start: &Start, arc: &mut Arc| {
            match phase {
                _ if std::mem::take(&mut is_expanded) => {}
                _ if is_next(phase) => return false,
                _ => level.series(phase, start, arc),
            }
            true
        };
        let phases = |motion: &Motion| phases::of::<f64>(level.structure(), motion);
        Loop { level, phases, expand, arc, room, stops: *at_transitions }.go(motion, &mut None, advance, watch)
    }

    /// Takes the step of `advance` that was taken in `lane` of `steps`, and goes on like [`Engine::go_on`] to the next step of rocking.
    #[inline]
    pub(crate) fn take<S: Simd, W: Passes>(
        &mut self,
        steps: &mut Rocking<'_, S>,
        lane: usize,
        advance: &mut Advance<f64>,
        watch: &mut W,
    ) -> Result<Option<Progress>, AdvanceError> {
        let (level, runs) = (&*self.level, &mut steps.runs);
        let duration = runs.reach[lane] * runs.span[lane];
        let is_whole = duration == advance.end - advance.elapsed;
        let is_last = !is_whole && is_at_its_end(level, &self.motion, duration, None);
        let stays = runs.stays[lane] == 1.0 && !is_last && self.motion.work.steps != advance.last_step;
        let is_passed = runs.is_passed[lane] == 1.0;
        runs.is_known[lane] &= stays && is_passed;
        if !runs.is_known[lane] {
            steps.write(lane, &mut self.arc);
        }
        if !stays {
            return self.go_on(advance, true, true, &mut After { watch, passes: is_passed });
        }
        let [u, u_dot, theta, theta_dot] = &steps.runs.end;
        let end = State { u: u[lane], u_dot: u_dot[lane], theta: theta[lane], theta_dot: theta_dot[lane] };
        if is_passed {
            watch.pass();
        } else {
            let (Engine { level, motion, arc, room, .. }, load) = (&*self, advance.load.from(advance.elapsed));
            watch.piece(&Piece { before: motion, duration, load, end, level: &**level, arc: Some(arc), room });
        }
        let motion = &mut self.motion;
        motion.work.steps += 1;
        motion.work.evaluations += steps.runs.order[lane] as u64;
        motion.state = end;
        motion.chatter.pass(duration);
        motion.time = advance.pass(duration);
        if advance.elapsed >= advance.interval {
            return Ok(Some(Progress::Complete));
        }
        self.go_on(advance, false, true, watch)
    }
}
