//! Accelerations of floors, storey shears, base shear and overturning moment: weighed sums of the accelerations of masses.
//!
//! With e = (c u̇ + k u)/μ of each mode, the acceleration of floor i along the turning e_x is
//!
//! ```text
//! a_i = g sin θ − Σ φ_i e + (h_i − Σ φ_i h) θ̈ + (1 − Σ φ_i Γ/μ) b,      b = sB θ̇² + a_g cos θ − (g + a_v) sin θ
//! V_k = Σ m_i a_i,   M_k = Σ m_i (h_i − h_{k−1}) a_i  of the floors from k on,      V_t = Σ m_i a_i,   M_t = Σ m_i h_i a_i
//! ```
//!
//! The last two terms vanish if the modes carry the whole mass. Then no output depends on the ground acceleration directly.

use crate::mechanics::arc::Arc;
use crate::mechanics::instant::Instant;
use crate::mechanics::lateral::{Coordinates, Lateral, Modes};
use crate::mechanics::reach::Magnitudes;
use crate::numbers::Number;
use crate::series::taylor::{ORDERS, ZERO, evaluate};
use crate::structure::rest;
use crate::{Base, Mode, Ramp};

/// Parts of the largest weight that rounding may leave between two gauges that measure the same.
const ROUNDING: f64 = 1e-14;

/// A weighed sum of the accelerations of masses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gauge {
    /// Sum of the weights.
    weight: f64,
    /// Σ φ of each mode, and Σ φ k/μ, Σ φ c/μ, Σ φ/μ.
    shape: Modes,
    stiffness: Modes,
    damping: Modes,
    push: Modes,
    /// The rest beside the modes of the sum of the heights, and of the sum of the weights.
    left: [f64; 2],
}

impl Gauge {
    /// The gauge of masses with this sum of weights, these sums of shapes and this sum of weighed heights, on a base with `modes`,
    /// whose sums are off by this `rounding`.
    pub(crate) fn new(modes: &[Mode], weight: f64, shape: Modes, height: f64, rounding: f64) -> Gauge {
        let of = |part: fn(&Mode) -> f64| modes.iter().enumerate().map(|(j, mode)| shape.of(j) * part(mode)).sum();
        let left = [rest(height, of(|mode| mode.height), rounding), rest(weight, of(|mode| mode.share), rounding)];
        let per_mass = |part: fn(&Mode) -> f64| {
            Modes::new(&Vec::from_iter(modes.iter().enumerate().map(|(j, mode)| shape.of(j) * part(mode) / mode.mass)))
        };
        let [stiffness, damping, push] =
            [|of: &Mode| of.stiffness, |of: &Mode| of.damping, |_: &Mode| 1.0].map(per_mass);
        Gauge { weight, shape, stiffness, damping, push, left }
    }

    /// Whether the value depends on the ground acceleration directly.
    pub fn has_feedthrough(&self) -> bool {
        self.left != [0.0; 2]
    }

    /// Whether no mode moves what is measured.
    pub(crate) fn is_rigid(&self) -> bool {
        self.shape.numbers().is_empty()
    }

    /// The value as a multiple of the value of `other`, if all weights are in this proportion.
    pub(crate) fn over(&self, other: &Gauge) -> Option<f64> {
        let ratio = self.weight / other.weight;
        let are_same = |own: &[f64], other: &[f64]| {
            let most = own.iter().fold(0.0, |most: f64, own| most.max(own.abs()));
            own.iter().zip(other).all(|(own, other)| (own - ratio * other).abs() <= ROUNDING * most)
        };
        let is_multiple = are_same(self.shape.numbers(), other.shape.numbers())
            && (0..2).all(|i| are_same(&self.left[i..=i], &other.left[i..=i]));
        is_multiple.then_some(ratio)
    }

    /// Σ φ (c u̇ + k u)/μ, with the part `damping` of the damping in full contact: linear in `u` and `u_dot`.
    #[inline]
    pub(crate) fn elastic<N: Number, Q: Lateral<N>>(&self, damping: f64, u: &Q, u_dot: &Q) -> N {
        u_dot.weighed(&self.damping) * damping + u.weighed(&self.stiffness)
    }

    /// Σ φ φᵀF/μ: linear in the forces.
    #[inline]
    pub(crate) fn push<N: Number, Q: Lateral<N>>(&self, F_t: &Q) -> N {
        F_t.weighed(&self.push)
    }

    /// Σ φ u.
    pub(crate) fn displacement<Q: Coordinates>(&self, u: &Q) -> f64 {
        u.weighed(&self.shape)
    }

    /// The force and the moment on mass that no mode carries, of a `force` (N) on a floor whose acceleration this gauge reads.
    pub(crate) fn on_rest(&self, force: f64) -> [f64; 2] {
        let [height, share] = self.left;
        [force * share, force * height]
    }

    /// The value at the instant `x` while rocking about the pivot s, or at rest if s = 0.
    #[inline]
    pub(crate) fn at<N: Number, Q: Lateral<N>>(&self, x: &Instant<N, Q>) -> N {
        let (base, [height, share]) = (x.base(), self.left);
        let elastic = self.elastic(x.damping, &x.u, &x.u_dot);
        let value = x.turn.sin * (base.g * (self.weight - share)) + self.push(&x.F_t) * x.turn.cos - elastic;
        if !self.has_feedthrough() {
            return value;
        }
        let ground = x.theta_dot * x.theta_dot * (x.s * base.B) + x.a_g * x.turn.cos - x.a_v * x.turn.sin;
        value + x.theta_ddot * height + ground * share
    }

    /// Bound of the magnitude of the terms of [`Gauge::at`] in θ and in the ground acceleration over a polynomial, within `most`.
    /// They are added up before they are bounded, because θ̈ opposes the ground acceleration.
    pub(crate) fn turning<Q: Coordinates>(
        &self,
        base: &Base,
        (arc, a_g): (&Arc<Q>, Ramp),
        most: &Magnitudes<Q>,
    ) -> f64 {
        let ([height, share], mut linear) = (self.left, ZERO);
        let tilt = base.g * (self.weight - share);
        for k in 0..=arc.order {
            let theta_ddot = if k < arc.order { ORDERS[k + 1] * arc.theta_dot[k + 1] / arc.span } else { 0.0 };
            linear[k] = height * theta_ddot + tilt * arc.theta[k];
        }
        linear[0] += share * a_g.value;
        linear[1] += share * a_g.slope * arc.span;
        let linear = arc.used(&linear);
        let &Magnitudes { theta, theta_dot, a_g, a_v, .. } = most;
        let ground = base.B * theta_dot * theta_dot + a_g * theta * theta / 2.0 + a_v * theta;
        let rest = share.abs() * ground + tilt.abs() * theta * theta * theta / 6.0;
        f64::most(linear, &evaluate(linear, arc.reach), arc.reach) + rest
    }
}
