//! Mechanical energy: constant between impacts when c_u = 0 and a_g = 0.

use crate::mechanics::instant::Instant;
use crate::mechanics::lateral::{Coordinates, Lateral};
use crate::mechanics::load::Load;
use crate::numbers::Number;
use crate::{Base, Phase, State, Structure};

/// Energy in J, zero at height zero:
///
/// ```text
/// E = Σ { ½ μ [(u̇ + hθ̇)² + w² θ̇²] + ½ k u² + Γ g [w sin θ + h cos θ] } + ½ (J0 + m0 B²) θ̇² + s m0 g B sin θ + S_res g cos θ
/// ```
///
/// The sum is over the modes, w = sB Γ/μ − u. One mass has μ = Γ = m and h = H. s does not matter in full contact, where θ = θ̇ = 0.
pub fn energy<Q: Coordinates>(structure: &Structure, phase: Phase, state: &State<Q>) -> f64 {
    mechanical(&Instant::of(structure, phase, state, Load::NONE))
}

/// Energy at the instant `x`, J.
pub(super) fn mechanical<N: Number, Q: Lateral<N>>(x: &Instant<N, Q>) -> N {
    kinetic(x) + Q::sum(x.structure, |j, mode| x.u.of(j) * (0.5 * mode.stiffness) * x.u.of(j)) + potential(x)
}

/// Kinetic energy, J.
pub(crate) fn kinetic<N: Number, Q: Lateral<N>>(x: &Instant<N, Q>) -> N {
    let &Base { m0, J0, .. } = x.base();
    let of_modes = Q::sum(x.structure, |j, mode| {
        let along = x.u_dot.of(j) + x.theta_dot * mode.height;
        let across = x.place(j, mode).lever(x.pivot()) * x.theta_dot;
        (along * along + across * across) * (0.5 * mode.mass)
    });
    of_modes + x.theta_dot * (0.5 * (J0 + m0 * x.pivot() * x.pivot())) * x.theta_dot
}

/// Potential energy of the weights, J.
fn potential<N: Number, Q: Lateral<N>>(x: &Instant<N, Q>) -> N {
    let &Base { m0, S_res, g, .. } = x.base();
    let of_modes = Q::sum(x.structure, |j, mode| x.place(j, mode).up(x.pivot(), &x.turn) * (mode.gamma * g));
    let of_base = of_modes + x.turn.sin * (m0 * g * x.pivot());
    if S_res == 0.0 { of_base } else { of_base + x.turn.cos * (S_res * g) }
}
