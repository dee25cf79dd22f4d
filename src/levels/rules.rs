//! How many transitions there may be.
//!
//! Transitions are counted from the first of them on for a vibration period 2π/ω_u, then from 0 again. After
//! [`MAX_TRANSITIONS_PER_PERIOD`] the next impact is a landing whatever its momentum, and contact is held to the end of
//! the period ([`Settling`](crate::TransitionKind::Settling)): it sees two more at most. Bounces that fast are the start of infinitely
//! many in finite time, which end in contact; neither specimen comes near them. The rigid limit, which has no vibration
//! and does come to rest by ever faster impacts, has [`MAX_RIGID_TRANSITIONS_PER_PERIOD`] for each 1/p_l instead.

use crate::structure::Vibration;
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
}
