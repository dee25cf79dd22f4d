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

use crate::Gauge;
use crate::mechanics::instant::Instant;
use crate::mechanics::lateral::Lateral;
use crate::numbers::Number;

impl Gauge {
    /// The value at the instant `x` while rocking about the pivot s, or at rest if s = 0.
    #[inline]
    pub(crate) fn at<N: Number, Q: Lateral<N>>(&self, x: &Instant<N, Q>) -> N {
        let (base, [height, share]) = (x.base(), self.left);
        let elastic = x.u_dot.weighed(&self.damping) * x.damping + x.u.weighed(&self.stiffness);
        let value = x.turn.sin * (base.g * (self.weight - share)) + x.F_t.weighed(&self.push) * x.turn.cos - elastic;
        if !self.has_feedthrough() {
            return value;
        }
        let ground = x.theta_dot * x.theta_dot * x.pivot() + x.a_g * x.turn.cos - x.a_v * x.turn.sin;
        value + x.theta_ddot * height + ground * share
    }
}
