//! A step of rocking of several runs at once, each to the order that it would have by itself.

use super::{Equations, Expanded, NonlinearRocking, Products, Recurrence};
use crate::numbers::lanes::{Lanes, MOST};
use crate::series::extremes::OFF_CHORD;
use crate::series::taylor::{self, Arc, MAX_ORDER, MIN_ORDER, Start, Truncation, reciprocal};
use crate::{Side, State};
use pulp::{Simd, WithSimd};
use std::f64::consts::FRAC_PI_2;

/// What rounding may add to a bound that is summed in another order, as a factor.
const ROUNDING: f64 = 1.0 + 1e-13;

/// A step of one run.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct RockingStep {
    pub equations: Equations<f64>,
    pub theta: f64,
    /// s.
    pub side: f64,
    /// s.
    pub span: f64,
    pub truncation: Truncation,
}

/// Result of a step of one run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Stepped {
    /// The order of its series.
    pub order: usize,
    /// s.
    pub duration: f64,
    /// Whether the series proves that no guard closes.
    pub stays: bool,
    /// State at its end.
    pub end: State,
    /// Bounds of the magnitudes of the state over it.
    pub most: State,
}

impl NonlinearRocking {
    /// The step from `start` of a structure that is not tied, as one of several.
    #[inline]
    pub(crate) fn step(&self, side: Side, start: &Start) -> RockingStep {
        let span = self.pace.span(start);
        RockingStep {
            equations: self.equations::<false>(side, start, span),
            theta: start.state.theta,
            side: side.sign(),
            span,
            truncation: self.pace.truncation(start, span),
        }
    }
}

/// The steps of several runs.
#[derive(Debug)]
pub(crate) struct Steps<S: Simd> {
    simd: S,
    steps: [RockingStep; MOST],
    products: Products<Lanes<S>>,
    /// u, u̇, θ and θ̇, order by order.
    series: [[Lanes<S>; 4]; MAX_ORDER + 1],
    order: Lanes<S>,
    /// The part of each series' span up to which the series holds.
    reach: [f64; MOST],
    end: [Lanes<S>; 4],
    most: [Lanes<S>; 4],
    /// 1 where a series proves that no guard closes.
    stays: Lanes<S>,
}

impl<S: Simd> Steps<S> {
    pub(crate) fn new(simd: S) -> Steps<S> {
        let zero = Lanes::splat(simd, 0.0);
        Steps {
            simd,
            steps: [RockingStep::default(); MOST],
            products: Products::new(zero),
            series: [[zero; 4]; MAX_ORDER + 1],
            order: zero,
            reach: [1.0; MOST],
            end: [zero; 4],
            most: [zero; 4],
            stays: zero,
        }
    }

    /// Puts the step of a run into `lane`.
    #[inline]
    pub(crate) fn put(&mut self, lane: usize, step: &RockingStep) {
        self.steps[lane] = *step;
    }

    /// Takes the steps.
    pub(crate) fn take(&mut self) {
        self.simd.vectorize(Taken(self));
    }

    /// The step of the run in `lane`.
    #[inline]
    pub(crate) fn of(&self, lane: usize) -> Stepped {
        let state = |[u, u_dot, theta, theta_dot]: &[Lanes<S>; 4]| State {
            u: u.of(lane),
            u_dot: u_dot.of(lane),
            theta: theta.of(lane),
            theta_dot: theta_dot.of(lane),
        };
        Stepped {
            order: self.order.of(lane) as usize,
            duration: self.reach[lane] * self.steps[lane].span,
            stays: self.stays.of(lane) == 1.0,
            end: state(&self.end),
            most: state(&self.most),
        }
    }

    /// Writes the series of the run in `lane` into `arc`.
    pub(crate) fn write(&self, lane: usize, arc: &mut Arc) {
        let order = self.order.of(lane) as usize;
        for (k, [u, u_dot, theta, theta_dot]) in self.series.iter().enumerate().take(order + 1) {
            (arc.u[k], arc.u_dot[k]) = (u.of(lane), u_dot.of(lane));
            (arc.theta[k], arc.theta_dot[k]) = (theta.of(lane), theta_dot.of(lane));
        }
        (arc.order, arc.span, arc.reach) = (order, self.steps[lane].span, self.reach[lane]);
    }
}

/// Taking steps.
struct Taken<'a, S: Simd>(&'a mut Steps<S>);

impl<S: Simd> WithSimd for Taken<'_, S> {
    type Output = ();

    #[inline(always)]
    fn with_simd<T: Simd>(self, _simd: T) {
        let Steps { simd, steps, products, series, reach, .. } = self.0;
        let simd = *simd;
        let of = |number: fn(&RockingStep) -> f64| Lanes::load(simd, &steps.each_ref().map(number));
        let equations = Equations {
            u: of(|step| step.equations.u),
            u_dot: of(|step| step.equations.u_dot),
            theta_dot: of(|step| step.equations.theta_dot),
            sin: of(|step| step.equations.sin),
            cos: of(|step| step.equations.cos),
            push: [of(|step| step.equations.push[0]), of(|step| step.equations.push[1])],
            ground: [of(|step| step.equations.ground[0]), of(|step| step.equations.ground[1])],
            gravity: [of(|step| step.equations.gravity[0]), of(|step| step.equations.gravity[1])],
            H: of(|step| step.equations.H),
            weight_offset: of(|step| step.equations.weight_offset),
            lever: of(|step| step.equations.lever),
            foundation: of(|step| step.equations.foundation),
            stiffness: of(|step| step.equations.stiffness),
            damping_u: of(|step| step.equations.damping_u),
        };
        let (theta, side, span) = (of(|step| step.theta), of(|step| step.side), of(|step| step.span));
        let (truncation, truncation_turning) = (of(|step| step.truncation.u_dot), of(|step| step.truncation.theta_dot));
        let (u, u_dot, theta_dot, g) = (equations.u, equations.u_dot, equations.theta_dot, equations.gravity[0]);
        let mut recurrence = Recurrence::new(equations);
        let (none, never) = (g.like(-0.0), g.like(1.0).is_less(g.like(0.0)));
        let (mut ended, mut was_small, mut order) = (never, never, g.like(0.0));
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
            order = ended.choose(order, g.like(k as f64));
            last = k;
            let is_small = u_dot.abs().is_at_most(truncation).and(theta_dot.abs().is_at_most(truncation_turning));
            if k >= MIN_ORDER {
                ended = ended.or(is_small.and(was_small));
                if ended.all() {
                    break;
                }
            }
            was_small = is_small;
        }
        *reach = [1.0; MOST];
        if !ended.all() {
            let ended = ended.choose(g.like(1.0), g.like(0.0));
            for lane in (0..S::F64_LANES).filter(|lane| ended.of(*lane) == 0.0) {
                let velocities = |k: usize| (series[k][1].of(lane), series[k][3].of(lane));
                reach[lane] = taylor::reach(velocities, &steps[lane].truncation).min(1.0);
            }
        }
        let sigma = Lanes::load(simd, reach);
        let sum = sigma.is_less(g.like(1.0)).choose(g.like(0.0), none);
        let (mut end, mut off, mut excursion) = ([sum; 4], [g.like(0.0); 4], g.like(0.0));
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
            self.0.most[i] = (number.abs().max(end[i].abs()) + off[i]) * rounding;
        }
        let start = side * theta;
        let stays =
            (excursion * rounding).is_less(start).and(((excursion + start) * rounding).is_less(g.like(FRAC_PI_2)));
        let size = end[0].abs() + end[1].abs() + end[2].abs() + end[3].abs();
        let is_finite = size.is_at_most(g.like(f64::MAX));
        (self.0.end, self.0.order) = (end, order);
        self.0.stays = stays.and(is_finite).choose(g.like(1.0), g.like(0.0));
    }
}

impl<S: Simd> Expanded for Lanes<S> {
    /// θ̇, w θ̇, w.
    type Left = [Lanes<S>; 3];
    /// cos θ, sin θ, w, θ̇, G.
    type Right = [Lanes<S>; 5];

    #[inline(always)]
    fn constant(self, value: f64) -> Self {
        self.like(value)
    }

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
        (newest_left, newest_right): (&Self::Left, &Self::Right),
        n: usize,
    ) -> [Self; 6] {
        let mut sum = [newest_left[0].like(0.0); 6];
        if n > 0 {
            for (left, right) in left[1..n].iter().zip(&right[MAX_ORDER - n + 1..MAX_ORDER]) {
                add_products(&mut sum, left, right);
            }
            add_products(&mut sum, newest_left, &right[MAX_ORDER]);
        }
        add_products(&mut sum, &left[0], newest_right);
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
