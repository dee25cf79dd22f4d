//! Uplift: full contact → rocking.
//!
//! With s = sign(u), the base lifts off at the first instant at which
//!
//! ```text
//! s u ≥ u_cr      and      s θ̈ > 0,   θ̈ by (5, 6) at θ = θ̇ = 0
//! ```
//!
//! There Eqs 5 and 6 leave, whatever a_g and F_t are,
//!
//! ```text
//! [(J0 + m0 B²)/m + (sB − u)²] θ̈ = H (c_u u̇ + k u)/m + g u − sγ g B
//! ```
//!
//! The second condition is that the moment about the pivot exceeds the moment of the weight. It always holds while |u| grows
//! through u_cr. After a landing with |u| > u_cr it may not hold. Without this condition contact would open and shut without end.
//!
//! A structure that is restrained or shaken vertically has another u_cr on each side ([`Restraint::uplift_displacement`]). If
//! that is not above 0, the second condition decides alone. If both conditions hold on both sides, the structure lifts off about
//! the side with the larger s θ̈. "> 0" means more than 1e-12 of the weight's moment, which is far above rounding.

use crate::mechanics::restraint::{Dissipators, Restraint};
use crate::numbers::Number;
use crate::{Ramp, Side, State, Structure};

/// Smallest excess of the turning moment over the weight's, as a fraction of the latter. It is far above rounding. After uplift
/// the base therefore moves away from the ground.
pub(crate) const LEAST_EXCESS: f64 = 1e-12;

/// The equation of θ̈ at θ = θ̇ = 0: inertia · s θ̈ = s (u·`u` + u̇·`u_dot`) − `weight`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TurningMoment {
    /// Moment per displacement.
    pub u: f64,
    /// Moment per velocity.
    pub u_dot: f64,
    /// Moment of the weight, and of the tendon at rest.
    pub weight: f64,
    /// Inertia about the pivot: this, less s u times the second, plus u² times the third.
    pub inertia: [f64; 3],
}

impl TurningMoment {
    /// The inertia of linear equations, which does not change with u and is contained in the moments.
    pub(crate) const CONSTANT: [f64; 3] = [1.0, 0.0, 0.0];

    /// Moments of Eqs 5 and 6 over m: H (c_u u̇ + k u)/m + g u against γ g B + P_0 B/m.
    pub fn new(structure: &Structure) -> TurningMoment {
        let &crate::Parameters { m, H, B, g, P_0, .. } = structure.parameters();
        let &Structure { stiffness, damping_u, gamma, foundation, .. } = structure;
        let weight = gamma * g * B + P_0 * B / m;
        TurningMoment {
            u: H * stiffness + g,
            u_dot: H * damping_u,
            weight,
            inertia: [foundation + B * B, 2.0 * B, 1.0],
        }
    }

    /// The moment that turns the base to the right, at the displacement `u` (m), its rate and the vertical acceleration `a_v`.
    #[inline]
    pub(crate) fn at<N: Number>(&self, u: N, u_dot: N, a_v: N) -> N {
        (N::constant(self.u) + a_v) * u + u_dot * self.u_dot
    }

    /// Inertia about the pivot of `side` at the displacement `u` (m).
    fn inertia(&self, side: Side, u: f64) -> f64 {
        let [at_rest, by_u, by_square] = self.inertia;
        at_rest - side.sign() * u * by_u + u * u * by_square
    }
}

/// The |a_top| (m/s²) from which on the base of a rigid structure lifts off: g tan α_cg + P_0 B/(m H).
pub fn least_push(structure: &Structure) -> f64 {
    let &crate::Parameters { m, H, B, g, P_0, .. } = structure.parameters();
    (1.0 + LEAST_EXCESS) * g * structure.tan_alpha_cg + (1.0 + LEAST_EXCESS) * P_0 * B / (m * H)
}

/// The condition of uplift about a side: the displacement, and the moment beside those of the weight and of the tendon at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Hold {
    /// u_cr,s, m.
    pub displacement: f64,
    /// Moment over m, m²/s².
    pub moment: f64,
}

/// Distance of a structure in full contact in `state` from uplift, and the side of the smaller distance. The distance is the larger
/// of two missing parts: of the displacement, as a fraction of u_cr, and of the moment, as a fraction of the weight's. Uplift is due
/// if the distance is not positive. If uplift is due about both sides, the side is the one with the larger s θ̈.
pub(crate) fn margin(
    structure: &Structure,
    turning: &TurningMoment,
    state: &State,
    a_v: f64,
    dissipators: &Dissipators,
) -> (f64, Side) {
    let displacement = state.u / structure.u_cr;
    let turns = turning.at(state.u, state.u_dot, a_v) / turning.weight;
    let about = |side: Side| {
        let hold = Restraint::about(structure, side, dissipators).hold(a_v);
        let (s, limit) = (side.sign(), hold.displacement / structure.u_cr);
        let moment = 1.0 + LEAST_EXCESS + hold.moment / turning.weight - s * turns;
        ((limit - s * displacement).min(limit).max(moment), moment / turning.inertia(side, state.u))
    };
    nearer(about(Side::Right), about(Side::Left))
}

/// The smaller of the distances from uplift about the `right` and the `left` side, and its side. Each distance is given with −s θ̈. If
/// uplift is due about both sides, the smaller −s θ̈ decides.
#[inline(always)]
pub(crate) fn nearer(right: (f64, f64), left: (f64, f64)) -> (f64, Side) {
    let is_right = if right.0 <= 0.0 && left.0 <= 0.0 { right.1 <= left.1 } else { right.0 <= left.0 };
    if is_right { (right.0, Side::Right) } else { (left.0, Side::Left) }
}

/// Distance from uplift of a structure in full contact in `state`, without restraints and vertical motion: positive until uplift
/// is due. For integrators that have no engine.
pub fn distance(structure: &Structure, state: &State) -> f64 {
    margin(structure, &TurningMoment::new(structure), state, 0.0, &Dissipators::NEW).0
}

/// The largest |u| (m) that free vibration in full contact can reach.
pub(crate) fn farthest(structure: &Structure, state: &State) -> f64 {
    libm::hypot(state.u, state.u_dot / structure.omega_fc)
}

/// The smaller displacement (m) of both sides at which the base lifts off, over `interval` (s) of a vertical acceleration `a_v`.
pub(crate) fn least_displacement(structure: &Structure, a_v: Ramp, interval: f64, dissipators: &Dissipators) -> f64 {
    let least = a_v.value.min(a_v.at(interval));
    let about = |side| Restraint::about(structure, side, dissipators).uplift_displacement(least);
    about(Side::Right).min(about(Side::Left))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::levels::nonlinear::accelerations;
    use crate::{Load, Parameters};
    use approx::assert_relative_eq;

    /// The displacement that is missing, then the moment, with residual forces of the dissipators and a vertical acceleration.
    #[test]
    fn the_margin_is_the_larger_of_the_missing_displacement_and_moment() {
        let parameters = Parameters { P_0: 200.0, xi_d: 0.1, k_d: 1e5, F_y: 400.0, ..Parameters::MCMANUS };
        let structure = Structure::new(parameters).unwrap();
        let Parameters { m, m0, H, B, g, P_0, xi_d, k_d, .. } = parameters;
        let turning = TurningMoment::new(&structure);
        let dissipators = Dissipators { plastic: [2e-3, -1e-3], ..Dissipators::NEW };
        let a_v = -1.5;
        let residual = -k_d * 2e-3 * (B - xi_d) + k_d * 1e-3 * (B + xi_d);
        let held = ((m + m0) * (g + a_v) + P_0) * B + residual; // N·m
        let weight = (m + m0) * g * B + P_0 * B;
        for u_dot in [0.4, -0.4] {
            let state = State { u: 0.6 * structure.u_cr, u_dot, ..State::default() };
            let elastic = structure.k * state.u;
            let turns = H * (elastic + structure.c_u * u_dot) + m * (g + a_v) * state.u;
            let expected = ((held - H * elastic) / weight).max((held - turns) / weight);
            let (found, side) = margin(&structure, &turning, &state, a_v, &dissipators);
            assert_eq!(side, Side::Right);
            assert_relative_eq!(found, expected, max_relative = 1e-10);
        }
    }

    /// The ground falls faster than the structure could. By Eqs 5 and 6 the side of the larger s θ̈ is not the side of the larger
    /// moment. The base lifts off about the former.
    #[test]
    fn the_structure_lifts_off_about_the_side_that_turns_faster() {
        let structure = Structure::new(Parameters { zeta_fc: 0.1, ..Parameters::MCMANUS }).unwrap();
        let turning = TurningMoment::new(&structure);
        let load = Load { a_v: -60.0, ..Load::default() };
        for side in [Side::Right, Side::Left] {
            let s = side.sign();
            let u = s * 2e-3;
            let u_dot = -(turning.u + load.a_v) * u / turning.u_dot - s * 0.005;
            let state = State { u, u_dot, ..State::default() };
            let faster = |side: Side| {
                let theta_ddot = accelerations(&structure, side, &state, load, &Dissipators::NEW).unwrap()[1];
                side.sign() * theta_ddot
            };
            assert!(faster(side) > faster(side.opposite()) && faster(side.opposite()) > 0.0);
            assert!(s * turning.at(u, u_dot, load.a_v) < 0.0);
            let (distance, found) = margin(&structure, &turning, &state, load.a_v, &Dissipators::NEW);
            assert!(distance <= 0.0 && found == side, "{distance} {found:?}");
        }
    }
}
