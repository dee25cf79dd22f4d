//! The start of a step, how far it may go and how exact it must be, and the expansion of the motion from there, order by order.

use crate::mechanics::arc::Arc;
use crate::mechanics::lateral::Coordinates;
use crate::mechanics::restraint::Dissipators;
use crate::numbers::Real;
use crate::series::taylor::{LONGEST_SPAN, MAX_ORDER, NEGLIGIBLE, reciprocal};
use crate::structure::ground::{NONE_SETTLED, Settlements};
use crate::{Base, OneMass, Ramp, State};

/// Fewest orders of a step, so that terms that vanish at rest cannot end it early.
pub(crate) const MIN_ORDER: usize = 5;

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
    /// How far contact points have settled for good, m.
    pub settled: &'a Settlements,
    /// How far it may go at most, s.
    pub interval: f64,
    /// Truncation error over the largest velocities that the step can bring.
    pub local_error: f64,
}

/// At rest on ground at rest, over no time.
impl<Q: Coordinates> Default for Start<'_, Q> {
    fn default() -> Self {
        let (state, a_g, a_top, a_v) = Default::default();
        let dissipators = &Dissipators::NEW;
        Start { state, a_g, a_top, a_v, dissipators, settled: &NONE_SETTLED, interval: 0.0, local_error: 0.0 }
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

/// The length and the accuracy of steps of a structure with an elastic strut.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Pace<N = f64> {
    /// The longest span that a series is tried over, s.
    pub longest_span: N,
    /// ω_u or ω_fc, rad/s, and its reciprocal.
    pub omega: N,
    pub longest_response: N,
    /// g tan α_cg, or next to nothing, m/s².
    pub gravity: N,
    /// Height from which a velocity turns the base, m.
    pub height: N,
}

impl Pace {
    /// While `structure` rocks.
    pub(crate) fn rocking(structure: &OneMass) -> Pace {
        let (H, &Base { g, tan_alpha_cg, .. }) = (structure.parameters().H, structure.base());
        Pace::new(structure.rocking_rate, structure.omega_u, g * tan_alpha_cg, H)
    }

    /// In full contact, with so much gravity that no term of a structure at rest underflows.
    #[inline(always)]
    pub(crate) fn down(&OneMass { omega_fc, stiffness, u_cr, .. }: &OneMass) -> Pace {
        Pace::new(omega_fc, omega_fc, NEGLIGIBLE * stiffness * u_cr, f64::INFINITY)
    }

    #[inline(always)]
    fn new(rate: f64, omega: f64, gravity: f64, height: f64) -> Pace {
        Pace { longest_span: LONGEST_SPAN / rate, omega, longest_response: 1.0 / omega, gravity, height }
    }

    /// The truncation that `start` requires over a step of `span` s.
    #[inline]
    pub(crate) fn truncation(&self, start: &Start, span: f64) -> Truncation {
        let &Start { state, a_top, local_error, .. } = start;
        let [u_dot, theta_dot] =
            self.largest([state.u, state.u_dot, state.theta_dot], [a_top.value, a_top.slope], span);
        Truncation { u_dot: local_error * u_dot, theta_dot: local_error * theta_dot }
    }
}

impl<N: Real> Pace<N> {
    /// The span of a series over at most `interval`, s.
    #[inline(always)]
    pub(crate) fn span(&self, interval: N) -> N {
        interval.min(self.longest_span)
    }

    /// The largest |u̇| and |θ̇| that a step of `span` s from (u, u̇, θ̇) can bring under the load `value` + `slope` τ.
    #[inline(always)]
    pub(crate) fn largest(&self, [u, u_dot, theta_dot]: [N; 3], [value, slope]: [N; 2], span: N) -> [N; 2] {
        let response_time = span.min(self.longest_response);
        let forcing = value.abs() + slope.abs() * span + self.gravity;
        let u_dot = u_dot.abs() + response_time * (self.omega * self.omega * u.abs() + forcing);
        [u_dot, theta_dot.abs() + u_dot / self.height]
    }
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
        (self.span, self.reach) = (span, 1.0);
        (self.u[0], self.u_dot[0]) = (state.u, state.u_dot);
        (self.theta[0], self.theta_dot[0]) = (state.theta, state.theta_dot);
        let mut previous_is_small = false;
        for k in 1..MAX_ORDER + 1 {
            let per = span * reciprocal(k);
            self.u[k].be(&self.u_dot[k - 1], per);
            self.theta[k] = self.theta_dot[k - 1] * per;
            self.u_dot[k].count_as(&state.u_dot);
            self.theta_dot[k] = velocities(self, k, per);
            let is_small =
                self.u_dot[k].is_within(&truncation.u_dot) && self.theta_dot[k].abs() <= truncation.theta_dot;
            if is_small && previous_is_small && k + self.spared >= MIN_ORDER {
                self.order = k; // not at every order: the next one would read its numbers from memory
                return;
            }
            previous_is_small = is_small;
        }
        (self.order, self.reach) = (MAX_ORDER, reach(|k| (self.u_dot[k], self.theta_dot[k]), truncation));
    }
}

/// The σ ≤ 1, or slightly less, up to which the last two terms of a full expansion stay within `truncation`.
#[cold]
pub(crate) fn reach<Q: Coordinates>(velocities: impl Fn(usize) -> (Q, f64), truncation: &Truncation<Q>) -> f64 {
    let exponent = |k: usize| {
        let (u_dot, theta_dot) = velocities(k);
        let of_modes = u_dot.as_slice().iter().enumerate().map(|(j, u_dot)| truncation.u_dot.of(j) / u_dot.abs());
        logarithm(of_modes.fold(f64::INFINITY, f64::min).min(truncation.theta_dot / theta_dot.abs())) / k as f64
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
