//! Mechanical energy: constant between impacts when c_u = 0 and a_g = 0.

use crate::mechanics::instant::Instant;
use crate::mechanics::load::Load;
use crate::mechanics::outputs::height;
use crate::numbers::Number;
use crate::{Parameters, Phase, State, Structure};

/// Energy in J, zero at height zero:
///
/// ```text
/// E = ½ m [(u̇ + Hθ̇)² + (sB−u)² θ̇²] + ½ (J0 + m0 B²) θ̇² + ½ k u² + m g [(sB−u) sin θ + H cos θ] + s m0 g B sin θ
/// ```
///
/// s does not matter in full contact, where θ = θ̇ = 0.
pub fn energy(structure: &Structure, phase: Phase, state: &State) -> f64 {
    mechanical(&Instant::of(structure, phase, state, Load::default()))
}

/// Energy at the instant `x`, J.
fn mechanical<N: Number>(x: &Instant<N>) -> N {
    kinetic(x) + x.u * (0.5 * x.structure.k) * x.u + potential(x)
}

/// Kinetic energy, J.
pub(crate) fn kinetic<N: Number>(x: &Instant<N>) -> N {
    let &Parameters { m, m0, H, B, J0, .. } = x.structure.parameters();
    let (along, across) = (x.u_dot + x.theta_dot * H, x.lever() * x.theta_dot);
    (along * along + across * across) * (0.5 * m) + x.theta_dot * (0.5 * (J0 + m0 * B * B)) * x.theta_dot
}

/// Potential energy of the weights, J.
fn potential<N: Number>(x: &Instant<N>) -> N {
    let &Parameters { m, m0, g, .. } = x.structure.parameters();
    height(x) * (m * g) + x.turn.sin * (m0 * g * x.pivot())
}
