//! Everything about a structure that changes with time, in a few dozen numbers.

use crate::levels::level::Now;
use crate::levels::rules::ChatterLimit;
use crate::mechanics::load::Load;
use crate::mechanics::reactions::Impulse;
use crate::mechanics::restraint::Dissipators;
use crate::{Phase, Side, State};
use serde::{Deserialize, Serialize};

/// Work done since the start, counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Work {
    /// Taylor steps taken.
    pub steps: u64,
    /// Right-hand-side evaluations: one for every order of every series.
    pub evaluations: u64,
}

/// What happens at the end of a step.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub(crate) enum Event {
    /// The base lifts off about this side.
    Uplift(Side),
    /// Rocking about this side is back at the ground.
    Impact(Side),
    /// |θ| is π/2 on this side.
    Overturning(Side),
    /// This dissipator begins to yield: pulled, +1, or pressed, −1.
    Yielding(u8, i8),
    /// This dissipator ceases to yield.
    Unloading(u8),
}

/// Everything about a structure that changes with time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Motion {
    /// Time, s.
    pub time: f64,
    /// State at that time.
    pub state: State,
    /// Phase at that time.
    pub phase: Phase,
    /// Transitions so far.
    pub transitions: u64,
    /// Work so far.
    pub work: Work,
    /// Impulse of the impacts on the ground so far.
    pub impulse: Impulse,
    /// What the dissipators keep and have taken.
    pub dissipators: Dissipators,
    pub(crate) chatter: Chatter,
    /// What is due now and has not been applied.
    pub(crate) due: Option<Event>,
}

impl Motion {
    /// It under `load`.
    #[inline]
    pub(crate) fn under(&self, load: Load) -> Now<'_> {
        Now { state: &self.state, load, dissipators: &self.dissipators }
    }

    /// Whether a transition is due at this instant: state and phase are those before it.
    pub fn is_transition_due(&self) -> bool {
        self.due.is_some()
    }

    /// For how long contact is held from now on because too many transitions came before, s.
    pub fn held(&self) -> f64 {
        self.chatter.held
    }
}

/// Transitions in the present period, for the guarantee of progress.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Chatter {
    /// Time since the first of them, s.
    age: f64,
    /// How many.
    transitions: u32,
    /// For how long contact is held from now on, s.
    pub held: f64,
}

impl Chatter {
    /// None so far.
    pub(crate) const NONE: Chatter = Chatter { age: f64::MAX, transitions: 0, held: 0.0 };

    /// Time goes by, s.
    #[inline]
    pub(crate) fn pass(&mut self, duration: f64) {
        self.age += duration;
        self.held = (self.held - duration).max(0.0);
    }

    /// Contact is held to the end of the period.
    pub(crate) fn hold(&mut self, limit: ChatterLimit) {
        self.held = limit.period - self.age;
    }

    /// One more transition.
    pub(crate) fn count(&mut self, limit: ChatterLimit) {
        if self.age >= limit.period {
            (self.age, self.transitions) = (0.0, 0);
        }
        self.transitions += 1;
    }

    /// Whether there may be no more of them.
    pub(crate) fn is_too_much(&self, limit: ChatterLimit) -> bool {
        self.transitions >= limit.transitions && self.age < limit.period
    }
}
