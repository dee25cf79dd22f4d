//! Guards: the conditions that end a phase.

use crate::engine::motion::Motion;
use crate::engine::sample::Sample;
use crate::engine::step::{Branch, Step};
use crate::engine::transition::TransitionKind;
use crate::levels::level::Level;
use crate::mechanics::lateral::Coordinates;
use crate::series::first_crossing::Crossing;

/// Event indicators are shifted by this part of α_cg or of the demand for uplift. No integration then starts on a root, and no
/// rounding makes one.
pub const BAND: f64 = 1e-9;

/// A condition that ends a phase, or changes the equations within it.
pub(crate) trait Guard<Q: Coordinates = f64>: Sync {
    /// The first instant of `step` at which the guard closes.
    fn first(&self, step: &Step<Q>) -> (Crossing, Branch);

    /// Applies the transition to `motion`, which has reached the instant at which the guard closes; none for a way that it has not.
    fn apply(&self, level: &dyn Level<Q>, motion: &mut Motion<Q>, branch: Branch) -> Option<TransitionKind>;

    /// Whether the guard certainly stays open for `ahead` (s), a tiny time.
    fn stays_open(&self, _now: &Sample<Q>, _ahead: f64) -> bool {
        false
    }

    /// Place and value of the event indicator: continuous, of order one, positive while the guard is open.
    fn indicator(&self, now: &Sample<Q>) -> (usize, f64);

    /// The way in which the guard is closed from the start, after a transition or a jump of the load, on rigid ground.
    fn closed(&self, _now: &Sample<Q>) -> Option<Branch> {
        None
    }

    /// Whether an engine that stops at transitions stops before this one.
    fn is_stop(&self) -> bool {
        true
    }
}
