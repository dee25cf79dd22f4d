//! Truncated Taylor series in time: the solver's representation of a motion over one step.
//!
//! The equations of every phase are analytic, so their solution over a step is expanded to as high an order as the
//! tolerance asks. The expansion is its own dense output: a transition is a root of one of its polynomials.
//!
//! Time within a step is σ = τ/span, 0 at its start and 1 at the end of the span that was asked for; the coefficients
//! are then the terms themselves at the end, which can be compared with the tolerance and summed as they are.

use crate::State;
use crate::mechanics::lateral::Coordinates;
use crate::mechanics::load::Ramp;
use crate::mechanics::restraint::Dissipators;

/// Highest order of an expansion. At a local error of 1e-16 it carries ω·h of more than 3 rad per step.
pub const MAX_ORDER: usize = 28;

/// The longest span, as ω·h in rad, that an expansion is tried over: more than [`MAX_ORDER`] ever reaches.
pub const LONGEST_SPAN: f64 = 8.0;

/// Coefficients c_k of Σ c_k σ^k.
pub type Series<Q = f64> = [Q; MAX_ORDER + 2];

/// A series of zeros.
pub const ZERO: Series = [0.0; MAX_ORDER + 2];

/// The series with these `coefficients`, and zeros after them.
pub(crate) fn series(coefficients: &[f64]) -> Series {
    let mut series = ZERO;
    series[..coefficients.len()].copy_from_slice(coefficients);
    series
}

/// Coefficient `n` of the product of two series.
pub(crate) fn product(a: &Series, b: &Series, n: usize) -> f64 {
    a[..=n].iter().zip(b[..=n].iter().rev()).map(|(a, b)| a * b).sum()
}

/// Adds to `$sum` the products of `$left` and `$right` factors whose orders sum to `$n`. The right ones are kept backwards, so that
/// both are read in one direction. The `$newest`, of order n, come last and not from memory: the processor can sum the others before
/// it knows them. A macro, because a closure called in wide registers would not be compiled for them.
macro_rules! add_each_product {
    ($add:expr, $sum:expr, $left:expr, $right:expr, $newest:expr, $n:expr) => {
        if $n > 0 {
            let (lefts, last_left) = $left[1..$n].as_chunks::<2>();
            let (rights, last_right) = $right[MAX_ORDER - $n + 1..MAX_ORDER].as_chunks::<2>();
            for (left, right) in lefts.iter().zip(rights) {
                $add($sum, &left[0], &right[0]);
                $add($sum, &left[1], &right[1]);
            }
            if let ([left], [right]) = (last_left, last_right) {
                $add($sum, left, right);
            }
            $add($sum, $newest.0, &$right[MAX_ORDER]);
        }
        $add($sum, &$left[0], $newest.1);
    };
}
pub(crate) use add_each_product;

/// Value at `sigma` of the polynomial with these coefficients.
#[inline]
pub fn evaluate(coefficients: &[f64], sigma: f64) -> f64 {
    if sigma == 1.0 {
        return coefficients.iter().rev().sum();
    }
    coefficients.iter().rev().fold(0.0, |sum, c| sum * sigma + c)
}

/// Σ w_k |c_k|, in four sums side by side: a sum waits for the one before it.
#[inline(always)]
pub(crate) fn weighed_sum(weights: &[f64], coefficients: &[f64]) -> f64 {
    let (fours, rest) = coefficients.as_chunks::<4>();
    let mut sums = [0.0; 4];
    for (weights, four) in weights.as_chunks::<4>().0.iter().zip(fours) {
        for i in 0..4 {
            sums[i] += weights[i] * four[i].abs();
        }
    }
    let of_rest = weights[4 * fours.len()..].iter().zip(rest).map(|(weight, c)| weight * c.abs()).sum::<f64>();
    sums.iter().sum::<f64>() + of_rest
}

/// Σ |c_k|.
#[inline]
pub(crate) fn sum_of_magnitudes(coefficients: &[f64]) -> f64 {
    weighed_sum(&[1.0; MAX_ORDER + 2], coefficients)
}

/// The orders, as weights of [`weighed_sum`].
pub(crate) const ORDERS: Series = {
    let mut orders = ZERO;
    let mut k = 0;
    while k < orders.len() {
        orders[k] = k as f64;
        k += 1;
    }
    orders
};

/// Coefficients of the same polynomial about `by`.
fn shift<Q: Coordinates>(coefficients: &mut [Q], by: f64) {
    let last = coefficients.len().saturating_sub(1);
    for start in 0..last {
        for k in (start..last).rev() {
            coefficients[k] = coefficients[k].plus(coefficients[k + 1], by);
        }
    }
}

/// Coefficients of the same polynomial over `scale` from `from` on: 0 is then what `from` was, and 1 what lay `scale` beyond.
pub fn stretch<Q: Coordinates>(coefficients: &mut [Q], from: f64, scale: f64) {
    if from != 0.0 {
        shift(coefficients, from);
    }
    coefficients.iter_mut().fold(1.0, |power, c| {
        *c = c.times(power);
        power * scale
    });
}

/// The motion over one step: a polynomial in time for each component of the state.
#[derive(Clone, Debug)]
pub struct Arc<Q = f64> {
    /// Elastic displacement, m; of many masses, the coordinates of the modes.
    pub u: Series<Q>,
    /// Its rate, m/s.
    pub u_dot: Series<Q>,
    /// Rotation, rad.
    pub theta: Series,
    /// Its rate, rad/s.
    pub theta_dot: Series,
    /// Highest order in use.
    pub order: usize,
    /// Duration of σ = 1, s.
    pub span: f64,
    /// The σ up to which the truncation error is within the tolerance; at most 1.
    pub reach: f64,
}

impl<Q: Coordinates> Default for Arc<Q> {
    fn default() -> Arc<Q> {
        let none = [Q::ZERO; MAX_ORDER + 2];
        Arc { u: none, u_dot: none, theta: ZERO, theta_dot: ZERO, order: 0, span: 0.0, reach: 0.0 }
    }
}

impl<Q: Coordinates> Arc<Q> {
    /// Becomes the motion of `other`.
    pub(crate) fn be(&mut self, other: &Arc<Q>) {
        let last = other.order;
        self.u[..=last].copy_from_slice(&other.u[..=last]);
        self.u_dot[..=last].copy_from_slice(&other.u_dot[..=last]);
        self.theta[..=last].copy_from_slice(&other.theta[..=last]);
        self.theta_dot[..=last].copy_from_slice(&other.theta_dot[..=last]);
        (self.order, self.span, self.reach) = (other.order, other.span, other.reach);
    }

    /// How long it lasts, s.
    pub fn duration(&self) -> f64 {
        self.reach * self.span
    }

    /// The coefficients of `series` up to the order in use.
    #[inline]
    pub fn used<'a, T>(&self, series: &'a Series<T>) -> &'a [T] {
        &series[..=self.order]
    }

    /// Whether the expansion consists of numbers: what is not one stays so from order to order.
    pub fn is_finite(&self) -> bool {
        let last = self.order;
        (self.u_dot[last].total() + self.theta_dot[last] + self.reach).is_finite()
    }

    /// The motion from σ = `from` to σ = `to` alone.
    pub(crate) fn between(&self, from: f64, to: f64) -> Arc<Q> {
        let (mut part, scale) = (self.clone(), to - from);
        for series in [&mut part.u, &mut part.u_dot] {
            stretch(&mut series[..=self.order], from, scale);
        }
        for series in [&mut part.theta, &mut part.theta_dot] {
            stretch(&mut series[..=self.order], from, scale);
        }
        Arc { span: self.span * scale, reach: 1.0, ..part }
    }

    /// The state at the end of the step.
    #[inline]
    pub fn end(&self) -> State<Q> {
        self.at(self.reach)
    }

    /// The state at `sigma`.
    #[inline]
    pub fn at(&self, sigma: f64) -> State<Q> {
        if sigma == 0.0 {
            return State { u: self.u[0], u_dot: self.u_dot[0], theta: self.theta[0], theta_dot: self.theta_dot[0] };
        }
        State {
            u: Q::evaluate(self.used(&self.u), sigma),
            u_dot: Q::evaluate(self.used(&self.u_dot), sigma),
            theta: evaluate(self.used(&self.theta), sigma),
            theta_dot: evaluate(self.used(&self.theta_dot), sigma),
        }
    }

    /// Bounds of the magnitudes of this motion, which ends in `end`.
    #[inline(always)]
    pub(crate) fn most(&self, end: &State<Q>) -> State<Q> {
        State {
            u: Q::most(self.used(&self.u), &end.u, self.reach),
            u_dot: Q::most(self.used(&self.u_dot), &end.u_dot, self.reach),
            theta: f64::most(self.used(&self.theta), &end.theta, self.reach),
            theta_dot: f64::most(self.used(&self.theta_dot), &end.theta_dot, self.reach),
        }
    }
}

/// The start of a step: the motion, the loads and the accuracy.
#[derive(Clone, Copy, Debug)]
pub struct Start<'a, Q = f64> {
    /// The state there.
    pub state: State<Q>,
    /// Ground acceleration from there on.
    pub a_g: Ramp,
    /// The ground acceleration that the top mass feels from there on; of many masses, the acceleration that each mode feels.
    pub a_top: Ramp<Q>,
    /// Vertical ground acceleration from there on.
    pub a_v: Ramp,
    /// The dissipators there.
    pub dissipators: &'a Dissipators,
    /// How far it may go at most, s.
    pub interval: f64,
    /// Truncation error over the largest velocities that the step can bring.
    pub local_error: f64,
}

/// At rest on ground at rest, over no time.
impl<Q: Coordinates> Default for Start<'_, Q> {
    fn default() -> Self {
        let state = State { u: Q::ZERO, u_dot: Q::ZERO, theta: 0.0, theta_dot: 0.0 };
        let (rest, a_top) = (Ramp::default(), Ramp { value: Q::ZERO, slope: Q::ZERO });
        let dissipators = &Dissipators::NEW;
        Start { state, a_g: rest, a_top, a_v: rest, dissipators, interval: 0.0, local_error: 0.0 }
    }
}

/// The largest truncated terms that a step may have.
#[derive(Clone, Copy, Debug, Default)]
pub struct Truncation<Q = f64> {
    /// Of u̇, m/s.
    pub u_dot: Q,
    /// Of θ̇, rad/s.
    pub theta_dot: f64,
}

/// Fewest orders in an expansion, so that terms that vanish at rest cannot end it early.
pub(crate) const MIN_ORDER: usize = 5;

/// 1/k, looked up.
#[inline]
pub(crate) fn reciprocal(k: usize) -> f64 {
    const RECIPROCAL: Series = {
        let mut reciprocal = ZERO;
        let mut k = 1;
        while k < reciprocal.len() {
            reciprocal[k] = 1.0 / k as f64;
            k += 1;
        }
        reciprocal
    };
    RECIPROCAL[k]
}

impl<Q: Coordinates> Arc<Q> {
    /// Expands the motion from `state` over `span` (s), order by order, until its last two terms are within
    /// `truncation`; coefficients of an earlier use are overwritten.
    ///
    /// `velocities(arc, k, per)` writes the coefficient of u̇ at order k ≥ 1 into the arc and gives the coefficient of θ̇, from u and θ to
    /// order k and from u̇ and θ̇ to order k − 1; `per` is span/k, which integrates a coefficient of order k − 1. When [`MAX_ORDER`] is not
    /// enough for the span, the arc reaches as far as its last two terms allow.
    #[inline(always)]
    pub fn expand(
        &mut self,
        state: &State<Q>,
        span: f64,
        truncation: &Truncation<Q>,
        mut velocities: impl FnMut(&mut Arc<Q>, usize, f64) -> f64,
    ) {
        self.begin(state, span);
        let mut previous_is_small = false;
        for k in 1..MAX_ORDER + 1 {
            let per = self.integrate(k);
            self.theta_dot[k] = velocities(self, k, per);
            if self.ends_at(k, truncation, &mut previous_is_small) {
                return;
            }
        }
        self.cut(truncation);
    }

    /// Begins the expansion from `state` over `span` (s).
    #[inline(always)]
    pub(crate) fn begin(&mut self, state: &State<Q>, span: f64) {
        (self.span, self.reach) = (span, 1.0);
        (self.u[0], self.u_dot[0]) = (state.u, state.u_dot);
        (self.theta[0], self.theta_dot[0]) = (state.theta, state.theta_dot);
    }

    /// Writes u and θ of order `k`, and returns span/k.
    #[inline(always)]
    pub(crate) fn integrate(&mut self, k: usize) -> f64 {
        let per = self.span * reciprocal(k);
        self.u[k].be(&self.u_dot[k - 1], per);
        self.theta[k] = self.theta_dot[k - 1] * per;
        per
    }

    /// Whether the expansion ends with order `k`, whose velocities are written.
    #[inline(always)]
    pub(crate) fn ends_at(&mut self, k: usize, truncation: &Truncation<Q>, previous_is_small: &mut bool) -> bool {
        self.order = k;
        let is_small = self.u_dot[k].is_within(&truncation.u_dot) && self.theta_dot[k].abs() <= truncation.theta_dot;
        let ends = is_small && *previous_is_small && k >= MIN_ORDER;
        *previous_is_small = is_small;
        ends
    }

    /// Cuts a full expansion to where its last two terms stay within `truncation`.
    #[inline(always)]
    pub(crate) fn cut(&mut self, truncation: &Truncation<Q>) {
        self.reach = reach(|k| (self.u_dot[k], self.theta_dot[k]), truncation);
    }
}

/// The σ ≤ 1, or slightly less, up to which the last two terms of a full expansion stay within `truncation`.
#[cold]
pub(crate) fn reach<Q: Coordinates>(velocities: impl Fn(usize) -> (Q, f64), truncation: &Truncation<Q>) -> f64 {
    let exponent = |k: usize| {
        let (u_dot, theta_dot) = velocities(k);
        logarithm(u_dot.room(&truncation.u_dot).min(truncation.theta_dot / theta_dot.abs())) / k as f64
    };
    let exponent = exponent(MAX_ORDER - 1).min(exponent(MAX_ORDER)).min(0.0);
    if exponent < -8.0 {
        return libm::exp(exponent);
    }
    // e^4x
    let x = 0.25 * exponent;
    let (even, odd) = (120.0 + 12.0 * x * x, x * (60.0 + x * x));
    ((even + odd) / (even - odd)).powi(4)
}

/// The natural logarithm of a positive `number`, or up to 0.06 less: its exponent and its mantissa, read as one integer.
fn logarithm(number: f64) -> f64 {
    (number.to_bits() as i64 - 1_f64.to_bits() as i64) as f64 * (std::f64::consts::LN_2 * f64::EPSILON)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// u = cos t, θ = e^t.
    fn cosine_and_exponential(span: f64, error: f64) -> Arc {
        let state = State { u: 1.0, u_dot: 0.0, theta: 1.0, theta_dot: 1.0 };
        let mut arc = Arc::default();
        arc.expand(&state, span, &Truncation { u_dot: error, theta_dot: error }, |arc, k, per| {
            arc.u_dot[k] = -arc.u[k - 1] * per;
            arc.theta[k - 1] * per
        });
        arc
    }

    /// The expansion reproduces both to the truncation asked for, and says how far it holds.
    #[test]
    fn an_expansion_holds_as_far_as_it_says() {
        for (span, error) in [(0.1, 1e-4), (0.5, 1e-9), (1.0, 1e-14), (50.0, 1e-14)] {
            let arc = cosine_and_exponential(span, error);
            let duration = arc.duration();
            let end = arc.end();
            let rounding = 4e-15 * duration.exp();
            assert!((end.u - duration.cos()).abs() <= error.max(rounding));
            assert!((end.theta - duration.exp()).abs() <= error.max(rounding));
            assert!(arc.reach == 1.0 || (arc.order == MAX_ORDER && duration > 3.0));
        }
    }
}
