//! The motion over one step, as polynomials in time.

use crate::mechanics::lateral::{Coordinates, Lateral};
use crate::mechanics::load::Ramp;
use crate::mechanics::state::State;
use crate::series::taylor::{MAX_ORDER, Series, ZERO, evaluate};
use crate::series::terms::Terms;
use crate::structure::mode::Modes;

/// Coefficients of the same polynomial over `scale` from `from` on: 0 is then what `from` was, and 1 what lay `scale` beyond.
pub fn stretch<Q: Coordinates>(coefficients: &mut [Q], from: f64, scale: f64) {
    let shifted = if from == 0.0 { 0 } else { coefficients.len().saturating_sub(1) };
    for start in 0..shifted {
        for k in (start..shifted).rev() {
            coefficients[k] = coefficients[k].plus(coefficients[k + 1], from);
        }
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
    /// How many of the fewest orders of a step are not needed.
    pub(crate) spared: usize,
    /// Duration of σ = 1, s.
    pub span: f64,
    /// The σ up to which the truncation error is within the tolerance; at most 1.
    pub reach: f64,
}

impl<Q: Coordinates> Default for Arc<Q> {
    fn default() -> Arc<Q> {
        let none = [Q::ZERO; MAX_ORDER + 2]; // as all else: rooms of zeros cost nothing
        Arc { u: none, u_dot: none, theta: ZERO, theta_dot: ZERO, order: 0, spared: 0, span: 0.0, reach: 0.0 }
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

/// Coordinates over a step as power series.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Polynomials<'a, Q> {
    /// The coefficients of a motion.
    Motion(&'a [Q]),
    /// Forces that are linear in time, and the span (s).
    Load(Ramp<Q>, f64),
}

impl<Q: Coordinates> Polynomials<'_, Q> {
    /// A sum of coordinates, which is `linear` in them.
    fn sum(&self, linear: impl Fn(&Q) -> f64) -> Terms {
        match self {
            Polynomials::Motion(coefficients) => Terms::from_fn(coefficients.len() - 1, |k| linear(&coefficients[k])),
            Polynomials::Load(Ramp { value, slope }, span) => Terms::ramp(linear(value), linear(slope) * span),
        }
    }
}

impl<Q: Coordinates> Lateral<Terms> for Polynomials<'_, Q> {
    type Of = Q;

    fn of(&self, j: usize) -> Terms {
        self.sum(|of| of.of(j))
    }

    fn weighed(&self, weights: &Modes) -> Terms {
        self.sum(|of| of.weighed(weights))
    }
}
