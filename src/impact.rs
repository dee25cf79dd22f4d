//! Impact: what happens when s θ returns to 0.
//!
//! L is the angular momentum about the pivot that comes down, −s, just before:
//!
//! ```text
//! L = m H (u̇ + H θ̇) − [ m (B² − u²) + m0 B² − J0 ] θ̇
//! ```
//!
//! - L θ̇ > 0: rocking goes on about the other pivot: s ← −s, θ̇ ← r θ̇, u and u̇ unchanged;
//! - otherwise full contact: u̇ ← u̇ + H θ̇ (horizontal momentum is kept), θ = θ̇ = 0.

use crate::{Phase, Side, State, Structure};

/// Angular momentum L about the pivot that comes down, kg·m²/s, of a structure that touches the ground (θ = 0).
pub fn angular_momentum(structure: &Structure, before: &State) -> f64 {
    let &crate::Parameters { m, m0, H, B, J0, .. } = structure.parameters();
    let &State { u, u_dot, theta_dot, .. } = before;
    m * H * (u_dot + H * theta_dot) - (m * (B * B - u * u) + m0 * B * B - J0) * theta_dot
}

/// Phase and state just after an impact that ends rocking about `side` in the state `before`.
pub fn resolve(structure: &Structure, side: Side, before: &State) -> (Phase, State) {
    if angular_momentum(structure, before) * before.theta_dot > 0.0 {
        let theta_dot = structure.parameters().r * before.theta_dot;
        (Phase::Rocking(side.opposite()), State { theta: 0.0, theta_dot, ..*before })
    } else {
        (Phase::FullContact, land(structure, before))
    }
}

/// The coefficient of restitution below which this rule can raise the energy at an impact with u = 0:
///
/// ```text
/// r < 1 − 4 (m + m0) B²/J_P
/// ```
///
/// Where u̇ and θ̇ differ in sign, taking momentum from the base and not from the top mass adds to the energy:
/// ΔE = −(1−r) m H u̇ θ̇ − ½ (1−r²) J_P θ̇². Rocking goes on only for L θ̇ > 0, which bounds u̇/θ̇ from below; at that bound
/// ΔE > 0 is this condition.
pub fn gaining_restitution(structure: &Structure) -> f64 {
    let &crate::Parameters { m, m0, B, .. } = structure.parameters();
    1.0 - 4.0 * (m + m0) * B * B / structure.J_P
}

/// The state just after landing: both pivots down, horizontal momentum kept.
pub fn land(structure: &Structure, before: &State) -> State {
    let u_dot = before.u_dot + structure.parameters().H * before.theta_dot;
    State { u: before.u, u_dot, theta: 0.0, theta_dot: 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Parameters;
    use crate::energy::energy;
    use approx::assert_relative_eq;
    use nalgebra::Vector2;

    /// L written out from its definition: Σ r × m v about the pivot that comes down, plus the foundation's own spin.
    #[test]
    fn angular_momentum_is_that_of_the_masses_about_the_other_pivot() {
        let structure = Structure::new(Parameters::MCMANUS).unwrap();
        let &Parameters { m, m0, H, B, J0, .. } = structure.parameters();
        for side in [Side::Right, Side::Left] {
            let s = side.sign();
            let state = State { u: 0.004, u_dot: -0.3, theta: 0.0, theta_dot: -0.2 * s };
            let pivot = Vector2::new(s * B, 0.0);
            let top = Vector2::new(state.u, H);
            let middle = Vector2::new(0.0, 0.0);
            // θ > 0 turns clockwise: v = θ̇ (y − y_P, −(x − x_P)), plus u̇ along x for the top
            let velocity =
                |point: Vector2<f64>| state.theta_dot * Vector2::new(point.y - pivot.y, -(point.x - pivot.x));
            let incoming = -pivot;
            let clockwise = |point: Vector2<f64>, velocity: Vector2<f64>| {
                let arm = point - incoming;
                arm.y * velocity.x - arm.x * velocity.y
            };
            let expected = m * clockwise(top, velocity(top) + Vector2::new(state.u_dot, 0.0))
                + m0 * clockwise(middle, velocity(middle))
                + J0 * state.theta_dot;
            assert_relative_eq!(angular_momentum(&structure, &state), expected, max_relative = 1e-13);
        }
    }

    /// Just below that restitution an impact at the least u̇/θ̇ with L θ̇ > 0 raises the energy; just above none does.
    #[test]
    fn energy_can_grow_below_the_gaining_restitution() {
        for parameters in [Parameters::EVISON, Parameters::MCMANUS] {
            let limit = gaining_restitution(&Structure::new(parameters).unwrap());
            for (r, can_gain) in [(limit - 1e-6, true), (limit + 1e-6, false)] {
                let structure = Structure::new(Parameters { r, ..parameters }).unwrap();
                let &Parameters { m, m0, H, B, J0, .. } = structure.parameters();
                let least = ((m + m0) * B * B - J0 - m * H * H) / (m * H);
                let theta_dot = -0.3;
                let before = State { u: 0.0, u_dot: theta_dot * (least + 1e-9), theta: 0.0, theta_dot };
                let (phase, after) = resolve(&structure, Side::Right, &before);
                assert_eq!(phase, Phase::Rocking(Side::Left));
                let gain = energy(&structure, phase, &after) - energy(&structure, Phase::Rocking(Side::Right), &before);
                assert_eq!(gain > 0.0, can_gain, "r = {r}: {gain} J");
            }
        }
    }

    #[test]
    fn rocking_goes_on_or_ends_by_the_sign_of_the_momentum() {
        let structure = Structure::new(Parameters::EVISON).unwrap();
        let turning = State { u: 1e-4, u_dot: 0.0, theta: 0.0, theta_dot: -0.1 };
        let (phase, after) = resolve(&structure, Side::Right, &turning);
        assert_eq!(phase, Phase::Rocking(Side::Left));
        assert_eq!(after, State { theta_dot: -0.1 * 0.96, ..turning });

        let vibrating = State { u_dot: 0.5, ..turning };
        let (phase, after) = resolve(&structure, Side::Right, &vibrating);
        assert_eq!(phase, Phase::FullContact);
        assert_eq!(after, State { u: 1e-4, u_dot: 0.5 - 1.05 * 0.1, theta: 0.0, theta_dot: 0.0 });
    }
}
