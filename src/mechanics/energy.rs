//! Mechanical energy: constant between impacts when c_u = 0 and a_g = 0.

use crate::{Phase, State, Structure};

/// Energy in J, zero at height zero:
///
/// ```text
/// E = ½ m [(u̇ + Hθ̇)² + (sB−u)² θ̇²] + ½ (J0 + m0 B²) θ̇² + ½ k u² + m g [(sB−u) sin θ + H cos θ] + s m0 g B sin θ
/// ```
///
/// In full contact θ = θ̇ = 0 and s does not matter.
pub fn energy(structure: &Structure, phase: Phase, state: &State) -> f64 {
    let &crate::Parameters { m, m0, H, B, J0, g, .. } = structure.parameters();
    let &State { u, u_dot, theta, theta_dot } = state;
    let s = phase.side().sign();
    let (sin, cos) = libm::sincos(theta);
    let lever = s * B - u;
    let kinetic = 0.5 * m * ((u_dot + H * theta_dot).powi(2) + (lever * theta_dot).powi(2))
        + 0.5 * (J0 + m0 * B * B) * theta_dot * theta_dot;
    let potential = m * g * (lever * sin + H * cos) + s * m0 * g * B * sin;
    kinetic + 0.5 * structure.k * u * u + potential
}
