//! The vibration of a structure that rocks, alone: Eqs 7 and 8 without ground motion and gravity, which only adds the
//! slow fall of the rocking mode.
//!
//! ```text
//! ü + H θ̈ + (c_u/m) u̇ + ω_fc² u = 0,      H ü + (J_P/m) θ̈ = 0
//!
//! E/m = ½ (u̇ + Hθ̇)² + ½ (J_P/m − H²) θ̇² + ½ ω_fc² u²
//! ```
//!
//! With χ = m H²/J_P this is an oscillator of frequency ω_u = ω_fc/√(1−χ) and damping ratio ζ_u = ζ_fc/√(1−χ) (c_u =
//! c_fc); χ = 0 is full contact. Here H = 1 m and ω_u = 1 rad/s, so that steps are in units of 1/ω_u.

use crate::equations::LateralEquations;
use crate::fixed_step::MovingPoint;
use nalgebra::Vector2;

#[derive(Clone, Copy, Debug)]
pub struct FreeVibration {
    pub chi: f64,     // modal participation χ; 0 with both pivots down
    pub zeta_fc: f64, // damping ratio in full contact
}

impl FreeVibration {
    /// ω_fc in units of ω_u.
    fn omega_fc(&self) -> f64 {
        (1.0 - self.chi).sqrt()
    }

    /// Elastic displacement 1, at rest.
    pub fn start(&self) -> MovingPoint {
        MovingPoint { position: Vector2::new(1.0, 0.0), velocity: Vector2::zeros(), acceleration: None }
    }

    pub fn energy(&self, point: &MovingPoint) -> f64 {
        let [u_dot, theta_dot] = point.velocity.into();
        // (J_P/m − H²) θ̇², with θ̇ = 0 throughout in full contact
        let foundation = if self.chi > 0.0 { (1.0 / self.chi - 1.0) * theta_dot * theta_dot } else { 0.0 };
        0.5 * ((u_dot + theta_dot).powi(2) + foundation + (self.omega_fc() * point.position[0]).powi(2))
    }
}

impl LateralEquations for FreeVibration {
    fn acceleration(&self, _: f64, position: Vector2<f64>, velocity: Vector2<f64>) -> Vector2<f64> {
        let omega = self.omega_fc();
        let force = -2.0 * self.zeta_fc * omega * velocity[0] - omega * omega * position[0];
        let u_ddot = force / (1.0 - self.chi);
        Vector2::new(u_ddot, -self.chi * u_ddot)
    }
}
