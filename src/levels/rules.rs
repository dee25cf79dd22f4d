//! How many transitions there may be, and how a rigid structure comes to rest.
//!
//! Transitions are counted from the first of them on for a vibration period 2π/ω_u, then from 0 again. After
//! [`MAX_TRANSITIONS_PER_PERIOD`] the next impact is a landing whatever its momentum, and contact is held to the end of
//! the period ([`Settling`](crate::TransitionKind::Settling)): it sees two more at most. Bounces that fast are the start of infinitely
//! many in finite time, which end in contact; neither specimen comes near them. The rigid limit, which has no vibration
//! and does come to rest by ever faster impacts, has [`MAX_RIGID_TRANSITIONS_PER_PERIOD`] for each 1/p_l instead.
//!
//! With r < 1 a rigid structure comes to rest by infinitely many impacts in finite time. The engine brings it to rest at the first
//! impact after which |θ̇| ≤ ε p_l tan α_cg, where ε is the error that a step may have. Later impacts amplify the error of this rest
//! like the error of a step. The kinetic energy that is left out, ½ J_P θ̇², is at most the part ε² of ½ m g H tan² α_cg, the energy
//! for overturning at small angles. Any other impact leaves r θ̇ about the other pivot, however squat the structure is. The momentum
//! rule of elastic structures would depend on the shape alone.

use crate::mechanics::impact::restitution;
use crate::mechanics::lateral::Coordinates;
use crate::structure::mode::Vibration;
use crate::{Base, Phase, Side, State, Structure};
use std::f64::consts::TAU;

/// Transitions within one period of the vibration mode (2π/ω_u) after which contact is held.
pub const MAX_TRANSITIONS_PER_PERIOD: u32 = 1000;

/// Transitions within 1/p_l after which contact is held at the rigid level: coming to rest with r = 0.9997 takes as
/// many.
pub const MAX_RIGID_TRANSITIONS_PER_PERIOD: u32 = 100_000;

/// How many transitions a period (s) may see.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ChatterLimit {
    pub period: f64,
    pub transitions: u32,
}

impl ChatterLimit {
    /// The limit of a structure that vibrates so.
    pub(crate) fn of(vibration: Vibration) -> ChatterLimit {
        ChatterLimit { period: TAU / vibration.rocking[0], transitions: MAX_TRANSITIONS_PER_PERIOD }
    }

    /// The limit of a rigid structure.
    pub(crate) fn of_rigid(base: &Base) -> ChatterLimit {
        ChatterLimit { period: 1.0 / base.p_l, transitions: MAX_RIGID_TRANSITIONS_PER_PERIOD }
    }
}

/// Phase and state just after an impact of a rigid structure that ends rocking about `side` in the state `before`, in steps of this
/// `local_error`.
pub(crate) fn after_rigid_impact<Q: Coordinates>(
    structure: &Structure,
    local_error: f64,
    side: Side,
    before: &State<Q>,
) -> (Phase, State<Q>) {
    let &Base { p_l, tan_alpha_cg, .. } = structure.base();
    let r = restitution(structure, side, before);
    if r * before.theta_dot.abs() <= local_error * p_l * tan_alpha_cg {
        return (Phase::FullContact, State { theta: 0.0, theta_dot: 0.0, ..*before });
    }
    (Phase::Rocking(side.opposite()), State { theta: 0.0, theta_dot: r * before.theta_dot, ..*before })
}
