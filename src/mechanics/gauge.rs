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

use crate::mechanics::lateral::{Lateral, Modes};
use crate::numbers::{Number, Turn};
use crate::structure::rest;
use crate::{Base, Mode, Structure};

/// A weighed sum of the accelerations of masses.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gauge {
    /// Sum of the weights.
    weight: f64,
    /// Σ φ of each mode.
    shape: Modes,
    /// What the modes leave of the sum of the heights, and of the sum of the weights.
    left: [f64; 2],
}

/// What a gauge reads of the structure at one instant, in numbers of the kind `N`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Reading<N> {
    /// Σ φ (c u̇ + k u)/μ of the gauge.
    pub elastic: N,
    /// Σ φ φᵀF/μ of the gauge.
    pub push: N,
    pub turn: Turn<N>,
    pub theta_dot: N,
    pub theta_ddot: N,
    pub a_g: N,
    pub a_v: N,
}

impl Gauge {
    /// The gauge of masses with this sum of weights, these sums of shapes and this sum of weighed heights, on a base with `modes`,
    /// whose sums are off by this `rounding`.
    pub(crate) fn new(modes: &[Mode], weight: f64, shape: Modes, height: f64, rounding: f64) -> Gauge {
        let of = |part: fn(&Mode) -> f64| modes.iter().enumerate().map(|(j, mode)| shape.of(j) * part(mode)).sum();
        let left = [rest(height, of(|mode| mode.height), rounding), rest(weight, of(|mode| mode.share), rounding)];
        Gauge { weight, shape, left }
    }

    /// Whether the value depends on the ground acceleration directly.
    pub fn has_feedthrough(&self) -> bool {
        self.left != [0.0; 2]
    }

    /// Σ φ (c u̇ + k u)/μ, with the part `damping` of the damping in full contact: linear in `u` and `u_dot`.
    pub(crate) fn elastic<N: Number, Q>(&self, frame: &Structure, damping: f64, u: &Q, u_dot: &Q) -> N
    where
        Q: Lateral<N>,
    {
        Q::sum(frame, |j, mode| {
            let force = u_dot.of(j) * (mode.damping * damping) + u.of(j) * mode.stiffness;
            force * self.shape.of(j) / mode.mass
        })
    }

    /// Σ φ φᵀF/μ: linear in the forces.
    pub(crate) fn push<N: Number, Q: Lateral<N>>(&self, frame: &Structure, F_t: &Q) -> N {
        Q::sum(frame, |j, mode| F_t.of(j) * self.shape.of(j) / mode.mass)
    }

    /// Σ φ u.
    pub(crate) fn displacement(&self, u: &Modes) -> f64 {
        self.shape.dot(u)
    }

    /// The force and the moment on mass that no mode carries, of a `force` (N) on a floor whose acceleration this gauge reads.
    pub(crate) fn on_rest(&self, force: f64) -> [f64; 2] {
        let [height, share] = self.left;
        [force * share, force * height]
    }

    /// The value on `base` while rocking about the pivot `s`, or at rest if s = 0.
    pub(crate) fn value<N: Number>(&self, base: &Base, s: f64, x: &Reading<N>) -> N {
        let value = x.turn.sin * (base.g * self.weight) + x.push * x.turn.cos - x.elastic;
        if !self.has_feedthrough() {
            return value;
        }
        let [height, share] = self.left;
        let ground =
            x.theta_dot * x.theta_dot * (s * base.B) + x.a_g * x.turn.cos - (x.a_v + N::constant(base.g)) * x.turn.sin;
        value + x.theta_ddot * height + ground * share
    }
}
