//! Uplift: full contact → rocking.
//!
//! With s = sign(u), the base lifts off at the first instant at which
//!
//! ```text
//! s u ≥ u_cr      and      s θ̈ > 0,   θ̈ by (5, 6) at θ = θ̇ = 0
//! ```
//!
//! There the equations leave [(J0 + m0 B²)/m + (sB − u)²] θ̈ = H (c_u u̇ + k u)/m + g u − sγ g B, whatever a_g and F_t
//! are: the second condition is that the moment which turns the structure about the pivot exceeds that of its weight.
//! While |u| grows through u_cr it always does; after a landing with |u| > u_cr it may not, and leaving it out makes
//! contact open and shut without end. Of a restrained structure, or one shaken vertically, u_cr is
//! [`uplift_displacement`], another on each side; where that is not above 0 the second condition decides alone, and where
//! it is met on both sides the one that turns faster lifts off. "> 0" is taken as more than 1e-12 of the weight's moment, far above rounding.

use crate::mechanics::restraint::{Dissipators, holding_moment, uplift_displacement};
use crate::{Ramp, Side, State, Structure};

/// Smallest excess of the turning moment over the weight's, as a part of the latter: far above rounding, so that what
/// has lifted off moves away from the ground.
pub(crate) const LEAST_EXCESS: f64 = 1e-12;

/// The sign of s θ̈ at θ = θ̇ = 0 is that of s (u·`u` + u̇·`u_dot`) − `weight`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TurningMoment {
    /// Moment per displacement.
    pub u: f64,
    /// Moment per velocity.
    pub u_dot: f64,
    /// Moment of the weight, and of the tendon at rest.
    pub weight: f64,
}

impl TurningMoment {
    /// Moments of Eqs 5 and 6 over m: H (c_u u̇ + k u)/m + g u against γ g B + P_0 B/m.
    pub fn new(structure: &Structure) -> TurningMoment {
        let &crate::Parameters { m, H, B, g, P_0, .. } = structure.parameters();
        let &Structure { stiffness, damping_u, gamma, .. } = structure;
        TurningMoment { u: H * stiffness + g, u_dot: H * damping_u, weight: gamma * g * B + P_0 * B / m }
    }
}

/// The |a_top| (m/s²) from which on the base of a rigid structure lifts off: g tan α_cg + P_0 B/(m H).
pub fn least_push(structure: &Structure) -> f64 {
    let &crate::Parameters { m, H, B, g, P_0, .. } = structure.parameters();
    (1.0 + LEAST_EXCESS) * g * structure.tan_alpha_cg + (1.0 + LEAST_EXCESS) * P_0 * B / (m * H)
}

/// The condition of uplift about a side: the displacement, and the moment beside that of the weight and of the tendon at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Hold {
    /// u_cr,s, m.
    pub displacement: f64,
    /// Moment over m, m²/s².
    pub moment: f64,
}

impl Hold {
    /// The condition about `side` under the vertical acceleration `a_v` (m/s²).
    #[inline]
    pub(crate) fn about(structure: &Structure, side: Side, a_v: f64, dissipators: &Dissipators) -> Hold {
        if a_v == 0.0 && !structure.is_restrained() {
            return Hold { displacement: structure.u_cr, moment: 0.0 };
        }
        let displacement = uplift_displacement(structure, side, a_v, dissipators);
        Hold { displacement, moment: holding_moment(structure, side, a_v, dissipators) }
    }
}

/// Distance of a structure in full contact in `state` from uplift, and the side of the smaller distance. The distance is the larger
/// of what lacks in displacement, as a fraction of u_cr, and in moment, as a fraction of the weight's. Uplift is due if it is not
/// positive; if it is due about both sides, about the one that turns faster.
pub(crate) fn margin(
    structure: &Structure,
    turning: &TurningMoment,
    state: &State,
    a_v: f64,
    dissipators: &Dissipators,
) -> (f64, Side) {
    let displacement = state.u / structure.u_cr;
    let turns = ((turning.u + a_v) * state.u + turning.u_dot * state.u_dot) / turning.weight;
    let about = |side: Side| {
        let hold = Hold::about(structure, side, a_v, dissipators);
        let (s, limit) = (side.sign(), hold.displacement / structure.u_cr);
        let moment = 1.0 + LEAST_EXCESS + hold.moment / turning.weight - s * turns;
        ((limit - s * displacement).min(limit).max(moment), moment)
    };
    let (right, left) = (about(Side::Right), about(Side::Left));
    let is_right = if right.0 <= 0.0 && left.0 <= 0.0 { right.1 <= left.1 } else { right.0 <= left.0 };
    if is_right { (right.0, Side::Right) } else { (left.0, Side::Left) }
}

/// Distance from uplift of a structure in full contact in `state`, without restraints and vertical motion: positive until uplift
/// is due. For integrators that have no engine.
pub fn distance(structure: &Structure, state: &State) -> f64 {
    margin(structure, &TurningMoment::new(structure), state, 0.0, &Dissipators::NEW).0
}

/// How far |u| gets in free vibration in full contact at most, m.
pub(crate) fn farthest(structure: &Structure, state: &State) -> f64 {
    libm::hypot(state.u, state.u_dot / structure.omega_fc)
}

/// The least displacement (m), on either side, that uplift takes over `interval` (s) of a vertical acceleration `a_v`.
pub(crate) fn least_displacement(structure: &Structure, a_v: Ramp, interval: f64, dissipators: &Dissipators) -> f64 {
    let least = a_v.value.min(a_v.at(interval));
    let about = |side| Hold::about(structure, side, least, dissipators).displacement;
    about(Side::Right).min(about(Side::Left))
}
