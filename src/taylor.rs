//! Truncated Taylor series in time: the solver's representation of a motion over one step.
//!
//! Both phases' equations are analytic, so their solution over a step is expanded to as high an order as the tolerance
//! asks. The expansion is its own dense output: a transition is a root of one of its polynomials.

use crate::State;

/// Highest order of an expansion. At a local error of 1e-16 it carries ω·h of more than 3 rad per step.
pub const MAX_ORDER: usize = 28;

/// Coefficients c_k of Σ c_k τ^k, τ in s from the start of the step.
pub type Series = [f64; MAX_ORDER + 2];

/// Coefficient `k` of the product of two series.
#[inline]
pub fn product(a: &Series, b: &Series, k: usize) -> f64 {
    a[..=k].iter().zip(b[..=k].iter().rev()).map(|(a, b)| a * b).sum()
}

/// Value at `tau` of the polynomial with these coefficients.
#[inline]
pub fn evaluate(coefficients: &[f64], tau: f64) -> f64 {
    coefficients.iter().rev().fold(0.0, |sum, c| sum * tau + c)
}

/// The motion over one step: a polynomial in time for each component of the state.
#[derive(Clone, Debug)]
pub struct Arc {
    /// Elastic displacement, m.
    pub u: Series,
    /// Its rate, m/s.
    pub u_dot: Series,
    /// Rotation, rad.
    pub theta: Series,
    /// Its rate, rad/s.
    pub theta_dot: Series,
    /// Highest order in use.
    pub order: usize,
    /// Length of the step, s: over it the truncation error is within the tolerance.
    pub duration: f64,
}

impl Arc {
    /// The expansion of order 0: the state itself.
    pub fn from_state(state: &State) -> Arc {
        let constant = |value| {
            let mut series = [0.0; MAX_ORDER + 2];
            series[0] = value;
            series
        };
        Arc {
            u: constant(state.u),
            u_dot: constant(state.u_dot),
            theta: constant(state.theta),
            theta_dot: constant(state.theta_dot),
            order: 0,
            duration: 0.0,
        }
    }

    /// Raises the order by one, given the coefficients of ü and θ̈ at the present order.
    #[inline]
    pub fn push(&mut self, u_ddot: f64, theta_ddot: f64) {
        let k = self.order;
        let next = k + 1;
        let per = 1.0 / next as f64;
        self.u[next] = self.u_dot[k] * per;
        self.u_dot[next] = u_ddot * per;
        self.theta[next] = self.theta_dot[k] * per;
        self.theta_dot[next] = theta_ddot * per;
        self.order = next;
    }

    /// The coefficients of `series` up to the order in use.
    #[inline]
    pub fn used<'a>(&self, series: &'a Series) -> &'a [f64] {
        &series[..=self.order]
    }

    /// Whether the expansion consists of numbers: what is not one stays so from order to order.
    pub fn is_finite(&self) -> bool {
        let last = self.order;
        (self.u_dot[last] + self.theta_dot[last] + self.duration).is_finite()
    }

    /// The state `tau` seconds into the step.
    pub fn at(&self, tau: f64) -> State {
        State {
            u: evaluate(self.used(&self.u), tau),
            u_dot: evaluate(self.used(&self.u_dot), tau),
            theta: evaluate(self.used(&self.theta), tau),
            theta_dot: evaluate(self.used(&self.theta_dot), tau),
        }
    }
}

/// The velocities against which truncation is measured, and how small it has to be.
#[derive(Clone, Copy, Debug)]
pub struct Truncation {
    /// Largest truncated term of u̇ over the step, m/s.
    pub u_dot: f64,
    /// Largest truncated term of θ̇ over the step, rad/s.
    pub theta_dot: f64,
}

/// Fewest orders in an expansion, so that terms that vanish at rest cannot end it early.
const MIN_ORDER: usize = 5;

/// Expands the motion from `state` order by order with `accelerations` — (ü, θ̈), coefficient `k`, from an arc known
/// to order `k` — until the last two terms at the end of `interval` (s) are within `truncation`. When
/// [`MAX_ORDER`] does not reach that far, the step is as long as its last two terms allow.
#[inline]
pub fn expand(
    state: &State,
    interval: f64,
    truncation: Truncation,
    mut accelerations: impl FnMut(&Arc) -> (f64, f64),
) -> Arc {
    let mut arc = Arc::from_state(state);
    let mut power = 1.0;
    let mut small_terms = 0;
    loop {
        let (u_ddot, theta_ddot) = accelerations(&arc);
        arc.push(u_ddot, theta_ddot);
        let k = arc.order;
        power *= interval;
        let is_small = (arc.u_dot[k] * power).abs() <= truncation.u_dot
            && (arc.theta_dot[k] * power).abs() <= truncation.theta_dot;
        small_terms = if is_small { small_terms + 1 } else { 0 };
        if small_terms >= 2 && k >= MIN_ORDER {
            arc.duration = interval;
            return arc;
        }
        if k == MAX_ORDER {
            arc.duration = interval.min(longest_step(&arc, truncation));
            return arc;
        }
    }
}

/// The step (s) over which the last two terms of a full expansion stay within `truncation`.
fn longest_step(arc: &Arc, truncation: Truncation) -> f64 {
    [MAX_ORDER - 1, MAX_ORDER]
        .into_iter()
        .flat_map(|k| [(truncation.u_dot / arc.u_dot[k].abs(), k), (truncation.theta_dot / arc.theta_dot[k].abs(), k)])
        .map(|(ratio, k)| ratio.powf(1.0 / k as f64))
        .fold(f64::INFINITY, f64::min)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// u = cos t, θ = e^t: the expansion reproduces both to the truncation asked for, and says how far it holds.
    #[test]
    fn an_expansion_holds_over_the_step_it_claims() {
        let state = State { u: 1.0, u_dot: 0.0, theta: 1.0, theta_dot: 1.0 };
        for (interval, error) in [(0.1, 1e-4), (0.5, 1e-9), (1.0, 1e-14), (50.0, 1e-14)] {
            let arc = expand(&state, interval, Truncation { u_dot: error, theta_dot: error }, |arc| {
                (-arc.u[arc.order], arc.theta[arc.order])
            });
            let end = arc.at(arc.duration);
            let scale = arc.duration.exp();
            assert!((end.u - arc.duration.cos()).abs() <= error.max(4e-15 * scale));
            assert!((end.theta - arc.duration.exp()).abs() <= error.max(4e-15 * scale));
            assert!(arc.duration == interval || (arc.order == MAX_ORDER && arc.duration > 3.0));
        }
    }

    #[test]
    fn the_order_follows_the_tolerance() {
        let state = State { u: 1.0, ..State::default() };
        let order = |error| {
            expand(&state, 1.0, Truncation { u_dot: error, theta_dot: error }, |arc| (-arc.u[arc.order], 0.0)).order
        };
        assert!(order(1e-4) < order(1e-8) && order(1e-8) < order(1e-15));
    }

    #[test]
    fn a_product_is_the_cauchy_product() {
        let mut a = [0.0; MAX_ORDER + 2];
        let mut b = a;
        (a[0], a[1], a[2]) = (1.0, 2.0, 3.0);
        (b[0], b[1], b[2]) = (4.0, 5.0, 6.0);
        assert_eq!(product(&a, &b, 2), 1.0 * 6.0 + 2.0 * 5.0 + 3.0 * 4.0);
        assert_relative_eq!(evaluate(&a[..3], 2.0), 1.0 + 4.0 + 12.0);
    }
}
