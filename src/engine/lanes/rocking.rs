//! Steps of rocking of several runs, from sample to sample.

use super::number::{Lanes, MOST, PerRun, load, put};
use super::sought::{Bend, Passes, ROUNDING, Sought, StepOfRuns, Turned};
use crate::engine::motion::{Motion, Work};
use crate::engine::phases::room;
use crate::engine::{Advance, Engine, FAR, STALLED};
use crate::levels::Elastic;
use crate::levels::level::Level;
use crate::levels::nonlinear::{Equations, Expanded, LEAST_INERTIA, NonlinearRocking, Products, Recurrence, Rocker};
use crate::levels::start::{self, MIN_ORDER, Pace, Truncation};
use crate::mechanics::arc::Arc;
use crate::mechanics::lateral::Coordinates;
use crate::numbers::Real;
use crate::series::extremes::{OFF_CHORD, OFF_CUBIC};
use crate::series::taylor::{MAX_ORDER, add_each_product, reciprocal};
use crate::{Ramp, State};
use pulp::{Simd, WithSimd};
use std::any::Any;

/// The samples of a record that end whole segments of a run.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SegmentEnds<'a> {
    /// s.
    pub times: &'a [f64],
    /// m/s².
    pub a_g: &'a [f64],
    /// The sample that ends the next segment.
    pub next: usize,
    /// The first sample that ends none.
    pub last: usize,
}

impl SegmentEnds<'_> {
    /// Time and ground acceleration of a `sample`, if there is one.
    #[inline(always)]
    pub(super) fn at(&self, sample: usize) -> Option<[f64; 2]> {
        Some([*self.times.get(sample)?, *self.a_g.get(sample)?])
    }
}

/// Steps of rocking of several runs, from sample to sample.
#[derive(Debug)]
pub(crate) struct RockingLanes<'a, S: Simd, Q> {
    simd: S,
    runs: LaneRuns<'a, Q>,
    products: Products<Lanes<S>>,
    /// Of the last step: u, u̇, θ and θ̇, order by order.
    series: [[Lanes<S>; 4]; MAX_ORDER + 1],
}

/// Several runs that rock, before and after the last step.
#[derive(Debug, Default)]
#[repr(align(64))]
struct LaneRuns<'a, Q> {
    sought: Sought<Q>,
    samples: [SegmentEnds<'a>; MOST],
    entered: [usize; MOST],
    /// 1 where there is a run.
    is_there: PerRun,
    /// The numbers of a [`Rocker`], and of a [`Pace`].
    rocker: [PerRun; 6],
    pace: [PerRun; 5],
    local_error: PerRun,
    gravity: PerRun,
    side: PerRun,
    /// u, u̇, θ and θ̇ at the start of the next step.
    state: [PerRun; 4],
    /// Of the present segment: its start (s), the ground acceleration from there on, its duration, the time that has passed (s), and 1 where
    /// another sample comes after it.
    start: PerRun,
    a_g: PerRun,
    slope: PerRun,
    interval: PerRun,
    elapsed: PerRun,
    may_go_on: PerRun,
    /// The longest segment that is not taken in parts, s.
    part: PerRun,
    /// Time and ground acceleration of the sample that ends the segment, and of the sample after it, which is written number by number a
    /// step before it is read.
    ends: [[PerRun; 2]; 2],
    /// The run's age among its transitions, its steps and evaluations until then, and the most steps.
    age: PerRun,
    steps: PerRun,
    evaluations: PerRun,
    most_steps: PerRun,
    /// Of the last step: its order, its span (s), the part of the span up to which the series holds, and the state there.
    order: PerRun,
    span: PerRun,
    reach: PerRun,
    end: [PerRun; 4],
    /// 1 where the watcher need not see the last step or a part from its start.
    is_passed: PerRun,
    /// 1 where the run has gone on.
    has_gone_on: PerRun,
}

impl<'a, S: Simd, Q: Coordinates> RockingLanes<'a, S, Q> {
    pub(crate) fn new(simd: S) -> RockingLanes<'a, S, Q> {
        let zero = Lanes::splat(simd, 0.0);
        let series = [[zero; 4]; MAX_ORDER + 1];
        RockingLanes { simd, runs: LaneRuns::default(), products: Products::new(zero), series }
    }

    /// Puts the run of `engine`, whose `advance` leads to the first of these samples, into `lane`, for at most so many steps since its start.
    #[inline]
    pub(crate) fn enter<W: Passes<Q>>(
        &mut self,
        (lane, most_steps): (usize, u64),
        engine: &Engine<Q>,
        advance: &Advance<Q>,
        samples: SegmentEnds<'a>,
        watch: &W,
    ) {
        let (runs, level) = (&mut self.runs, by_equations_5_and_6(&*engine.level).expect("another level steps alone"));
        let (motion, rocking) = (&engine.motion, &level.rocking);
        watch.seek(engine, lane, &mut runs.sought);
        let side = motion.phase.side();
        let Rocker { H, pivot, weight_offset, foundation, stiffness, damping_u } = rocking.rocker(side);
        put(&mut runs.rocker, lane, [H, pivot, weight_offset, foundation, stiffness, damping_u]);
        let Pace { longest_span, omega, longest_response, gravity, height } = rocking.pace;
        put(&mut runs.pace, lane, [longest_span, omega, longest_response, gravity, height]);
        runs.local_error[lane] = level.subject().local_error;
        runs.gravity[lane] = engine.structure().base().g;
        (runs.side[lane], runs.is_there[lane]) = (side.sign(), 1.0);
        let &Motion { state: State { u, u_dot, theta, theta_dot }, work, chatter, .. } = motion;
        put(&mut runs.state, lane, [u.of(0), u_dot.of(0), theta, theta_dot]);
        let Ramp { value, slope } = advance.load.on_foundation();
        (runs.a_g[lane], runs.slope[lane], runs.interval[lane]) = (value, slope, advance.end);
        (runs.elapsed[lane], runs.start[lane]) = (advance.elapsed, advance.start);
        runs.part[lane] = FAR / engine.structure().vibration().contact;
        (runs.age[lane], runs.steps[lane]) = (chatter.age, work.steps as f64);
        (runs.evaluations[lane], runs.most_steps[lane]) =
            (work.evaluations as f64, most_steps.min(advance.last_step) as f64);
        (runs.samples[lane], runs.entered[lane]) = (samples, samples.next);
        // the end of a part is no sample
        runs.may_go_on[lane] = f64::from(samples.next < samples.last && advance.end == advance.interval);
        runs.write(0, lane, samples.next.wrapping_sub(1));
        runs.write(1, lane, samples.next);
    }

    /// Takes steps as long as all runs go on: the bases certainly stay up, and the watchers need not see it at once.
    /// Returns how many steps each run has taken.
    pub(crate) fn step(&mut self) -> u64 {
        let mut steps = 0;
        let mut all_go_on = true;
        while all_go_on {
            self.simd.vectorize(StepRocking(self));
            let runs = &mut self.runs;
            let is_there = runs.is_there;
            steps += 1;
            for lane in (0..S::F64_LANES).filter(|lane| is_there[*lane] == 1.0) {
                if runs.has_gone_on[lane] == 0.0 {
                    all_go_on = false;
                } else if runs.elapsed[lane] == 0.0 {
                    let SegmentEnds { times, next, last, .. } = &mut runs.samples[lane];
                    runs.start[lane] = times[*next - 1];
                    *next += 1;
                    runs.may_go_on[lane] = f64::from(*next < *last);
                    runs.write(1, lane, runs.samples[lane].next);
                }
            }
        }
        steps
    }

    /// Whether the run in `lane` has gone on.
    #[inline]
    pub(crate) fn has_gone_on(&self, lane: usize) -> bool {
        self.runs.has_gone_on[lane] == 1.0
    }

    /// Brings `engine` to the start of the step that the run in `lane` was about to take, all but its time. Returns the sample that ends
    /// the segment, if the run has passed one, and the time that has passed since the start of the segment.
    #[inline]
    pub(crate) fn catch_up<W: Passes<Q>>(
        &mut self,
        lane: usize,
        engine: &mut Engine<Q>,
        watch: &mut W,
    ) -> Option<(Option<usize>, f64)> {
        let (steps, runs) = (self.runs.steps[lane] as u64, &mut self.runs);
        if steps == engine.motion.work.steps {
            return None;
        }
        runs.sought.show(lane, engine, watch);
        let motion = &mut engine.motion;
        motion.state = state_of(&runs.state, lane);
        motion.chatter.age = runs.age[lane];
        motion.work = Work { steps, evaluations: runs.evaluations[lane] as u64 };
        watch.pass();
        motion.time = runs.start[lane];
        let next = runs.samples[lane].next;
        Some(((next > runs.entered[lane]).then(|| next - 1), runs.elapsed[lane]))
    }

    /// Takes the run in `lane` out.
    pub(crate) fn leave(&mut self, lane: usize) {
        self.runs.is_there[lane] = 0.0;
    }

    /// Writes the series of the run in `lane` into `arc`. Returns whether the watcher need not see the step or a part from its start.
    pub(super) fn write(&self, lane: usize, arc: &mut Arc<Q>) -> bool {
        let order = self.runs.order[lane] as usize;
        for (k, [u, u_dot, theta, theta_dot]) in self.series.iter().enumerate().take(order + 1) {
            arc.u[k].set(0, u.of(lane));
            arc.u_dot[k].set(0, u_dot.of(lane));
            (arc.theta[k], arc.theta_dot[k]) = (theta.of(lane), theta_dot.of(lane));
        }
        (arc.order, arc.span, arc.reach) = (order, self.runs.span[lane], self.runs.reach[lane]);
        self.runs.is_passed[lane] == 1.0
    }
}

/// The state of the run in `lane`, which has one mode.
fn state_of<Q: Coordinates>(rows: &[PerRun; 4], lane: usize) -> State<Q> {
    let [u, u_dot, theta, theta_dot] = rows.map(|row| row[lane]);
    let mut state = State::<Q> { theta, theta_dot, ..State::default() };
    state.u.set(0, u);
    state.u_dot.set(0, u_dot);
    state
}

impl<Q: Coordinates> LaneRuns<'_, Q> {
    /// Writes a `sample` of the run in `lane`, if there is one.
    #[inline]
    fn write(&mut self, end: usize, lane: usize, sample: usize) {
        self.samples[lane].at(sample).into_iter().for_each(|at| put(&mut self.ends[end], lane, at));
    }

    /// Puts off the last step of the run in `lane`.
    fn put_off(&mut self, lane: usize) {
        let (SegmentEnds { next, last, .. }, elapsed) = (&mut self.samples[lane], self.elapsed[lane]);
        let (time, duration) = (self.start[lane] + elapsed, self.interval[lane] - elapsed);
        let a_g = Ramp { value: self.a_g[lane], slope: self.slope[lane] }.from(elapsed);
        let states = [&self.state, &self.end].map(|of| state_of(of, lane));
        if !self.sought.put_off(lane, (time, duration, a_g), states) {
            *last = (*last).min(*next);
        }
    }
}

/// The `level` by its type, if it is Eqs 5 and 6. A fixed base, which never rocks, has the same type.
#[inline(always)]
pub(super) fn by_equations_5_and_6<Q: Coordinates>(level: &dyn Level<Q>) -> Option<&Elastic<NonlinearRocking>> {
    (level as &dyn Any).downcast_ref()
}

/// Taking steps of rocking.
struct StepRocking<'s, 'a, S: Simd, Q>(&'s mut RockingLanes<'a, S, Q>);

impl<S: Simd, Q: Coordinates> WithSimd for StepRocking<'_, '_, S, Q> {
    type Output = ();

    #[inline(always)]
    fn with_simd<T: Simd>(self, _simd: T) {
        let StepRocking(RockingLanes { simd, runs: of, products, series }) = self;
        let simd = *simd;
        let row = |row: &PerRun| Lanes::load(simd, row);
        let [u, u_dot, theta, theta_dot] = load(simd, &of.state);
        let (side, slope, elapsed) = (row(&of.side), row(&of.slope), row(&of.elapsed));
        let (a_g, interval) = (row(&of.a_g) + slope * elapsed, row(&of.interval) - elapsed);
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
        let (mut ended, mut was_small, mut order) = (row(&of.is_there).is_less(one), one.is_less(zero), zero);
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
                of.reach[lane] = start::reach(velocities, &truncation);
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
        let lead = start.is_less(zero).choose(zero, lead * sigma);
        let stays = zero.is_less(room([start, side * end[2]], [excursion * rounding, lead, off[2] * rounding]));
        let size = end[0].abs() + end[1].abs() + end[2].abs() + end[3].abs();
        let stays = stays & size.is_at_most(g.like(f64::MAX));
        let before = Turned { u: [u], u_dot: [u_dot], theta };
        let after = Turned { u: [end[0]], u_dot: [end[1]], theta: end[2] };
        let stretch = StepOfRuns { ends: [before, after], off: Turned { u: [off[0]], u_dot: [off[1]], theta: off[2] } };
        let least = start.abs().min(end[2].abs()) - off[2] * rounding;
        let [above, below] = load(simd, &of.sought.turned);
        let is_free = above.is_less(least) & end[2].abs().is_less(below);
        let is_passed = of.sought.are_passed(simd, &stretch.most());
        let (duration, is_there) = (sigma * span, row(&of.is_there));
        let is_whole = interval.is_at_most(duration);
        // a part of a segment is not put off, since its polynomial would be another one
        let is_part = duration.is_less(interval) & is_passed & row(&of.interval).is_at_most(row(&of.part));
        let (steps, lever) = (row(&of.steps), rocker.pivot - u);
        let least_inertia = (rocker.foundation + rocker.pivot * rocker.pivot) * g.like(LEAST_INERTIA);
        let is_part = is_part & least_inertia.is_at_most(rocker.foundation + lever * lever);
        let is_part = is_part & (longest_response * g.like(2.0 * STALLED)).is_less(duration);
        let goes_on = is_whole & one.is_at_most(row(&of.may_go_on)) | is_part;
        let goes_on = goes_on & stays & is_free & one.is_at_most(is_there) & steps.is_less(row(&of.most_steps));
        let passes = goes_on & is_whole;
        let is_put_off = is_passed.choose(zero, passes.choose(one, zero));
        let is_passed = is_passed & is_free;
        if !is_put_off.is_at_most(zero).all() {
            let (mut off_cubic, mut slope) = ([zero; 4], [zero; 4]);
            for (k, numbers) in series.iter().enumerate().take(last + 1).skip(1) {
                let (order, weight) = (g.like(k as f64), g.like(if k > 3 { OFF_CUBIC * k as f64 } else { 0.0 }));
                for (i, number) in numbers.iter().enumerate() {
                    slope[i] = slope[i] + order * *number;
                    off_cubic[i] = off_cubic[i] + weight * number.abs();
                }
            }
            let from = Turned { u: [u_dot * span], u_dot: [series[1][1]], theta: theta_dot * span };
            let to = Turned { u: [slope[0]], u_dot: [slope[1]], theta: slope[2] };
            let [u, u_dot, theta, _] = off_cubic;
            let bend = Bend { slopes: [from, to], off_cubic: Turned { u: [u], u_dot: [u_dot], theta } };
            of.sought.bound(simd, (&stretch, &bend), passes);
            (0..S::F64_LANES).filter(|lane| is_put_off.of(*lane) == 1.0).for_each(|lane| of.put_off(lane));
        }
        for (i, number) in series[0].into_iter().enumerate() {
            goes_on.choose(end[i], number).store(&mut of.state[i]);
        }
        let ([time, a], [time_next, a_next]) = (load(simd, &of.ends[0]), load(simd, &of.ends[1]));
        let interval_next = time_next - time;
        passes.choose(a, row(&of.a_g)).store(&mut of.a_g);
        passes.choose((a_next - a) / interval_next, slope).store(&mut of.slope);
        passes.choose(interval_next, row(&of.interval)).store(&mut of.interval);
        passes.choose(time_next, time).store(&mut of.ends[0][0]);
        passes.choose(a_next, a).store(&mut of.ends[0][1]);
        goes_on.choose(passes.choose(zero, elapsed + duration), elapsed).store(&mut of.elapsed);
        goes_on.choose(steps + one, steps).store(&mut of.steps);
        let (age, evaluations) = (row(&of.age), row(&of.evaluations));
        goes_on.choose(age + duration, age).store(&mut of.age);
        goes_on.choose(evaluations + order, evaluations).store(&mut of.evaluations);
        is_passed.choose(one, zero).store(&mut of.is_passed);
        goes_on.choose(one, zero).store(&mut of.has_gone_on);
        order.store(&mut of.order);
        span.store(&mut of.span);
    }
}

impl<S: Simd> Expanded for Lanes<S> {
    /// θ̇, w θ̇, w.
    type Left = [Lanes<S>; 3];
    /// cos θ, sin θ, w, θ̇, G.
    type Right = [Lanes<S>; 5];

    #[inline(always)]
    fn left(turning: Self, lever_turning: Self, lever: Self) -> Self::Left {
        [turning, lever_turning, lever]
    }

    #[inline(always)]
    fn right(cos: Self, sin: Self, next_lever: Self, turning: Self, weight: Self) -> Self::Right {
        [cos, sin, next_lever, turning, weight]
    }

    #[inline(always)]
    fn products(
        left: &[Self::Left; MAX_ORDER + 1],
        right: &[Self::Right; MAX_ORDER + 1],
        newest: (&Self::Left, &Self::Right),
        n: usize,
    ) -> [Self; 6] {
        let mut sum = [newest.0[0].like(0.0); 6];
        add_each_product!(add_products, &mut sum, left, right, newest, n);
        sum
    }
}

#[inline(always)]
fn add_products<S: Simd>(sum: &mut [Lanes<S>; 6], left: &[Lanes<S>; 3], right: &[Lanes<S>; 5]) {
    let &[turning, lever_turning, lever] = left;
    let &[cos, sin, next_lever, right_turning, weight] = right;
    sum[0] = sum[0] + turning * cos;
    sum[1] = sum[1] + turning * sin;
    sum[2] = sum[2] + turning * next_lever;
    sum[3] = sum[3] + lever_turning * next_lever;
    sum[4] = sum[4] + lever_turning * right_turning;
    sum[5] = sum[5] + lever * weight;
}
