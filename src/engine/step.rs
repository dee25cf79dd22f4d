//! One step of a motion in one phase, and the guard that ends it.

use crate::PressedPoints;
use crate::levels::level::Level;
use crate::levels::start::Start;
use crate::mechanics::arc::Arc;
use crate::mechanics::lateral::Coordinates;
use crate::mechanics::restraint::Dissipators;
use crate::mechanics::state::Side;
use crate::series::first_crossing::Crossing;
use serde::{Deserialize, Serialize};

/// At the reach of a step, the dissipators if it moves them, and how far points have settled for good if one yields.
pub(crate) type Moved<Q> = (Option<Dissipators>, Option<<Q as Coordinates>::Settled>);

/// One expanded step in one phase.
pub(crate) struct Step<'a, Q: Coordinates = f64> {
    pub level: &'a dyn Level<Q>,
    /// The side about which the structure rocks.
    pub side: Side,
    /// The pressed contact points of the ground.
    pub contact: PressedPoints,
    pub start: &'a Start<'a, Q>,
    pub arc: &'a Arc<Q>,
    /// The σ up to which no guard is known to close.
    pub reach: f64,
    /// Whether a guard closes there.
    pub is_cut: bool,
}

/// Which of several conditions of a guard closes: a number and a sign, with the meaning that the guard gives them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Branch {
    pub which: u8,
    pub sign: i8,
}

/// A guard of the present phase that has closed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) struct Closed {
    /// Place of the guard in [`Rules::guards`](crate::engine::phases::Rules::guards).
    pub guard: u8,
    pub branch: Branch,
}

/// Part by which the first of two crossings at one instant may come earlier by rounding.
const SAME: f64 = 1e-14;

/// Takes `crossing` if it comes before the one that is `found`. Of crossings at one instant, the first that is found counts.
pub(crate) fn see(found: &mut (Crossing, Branch), crossing: Crossing, which: usize, sign: i8) {
    if crossing.sigma() < (1.0 - SAME) * found.0.sigma() {
        *found = (crossing, Branch { which: which as u8, sign });
    }
}
