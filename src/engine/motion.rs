//! Everything about a structure that changes with time, in a few dozen numbers.

use crate::engine::step::Closed;
use crate::mechanics::impact::Chatter;
use crate::mechanics::lateral::Coordinates;
use crate::mechanics::reactions::Impulse;
use crate::mechanics::restraint::{Dissipators, Kept};
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

/// Everything about a structure that changes with time.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Motion<Q: Coordinates = f64> {
    /// Time, s.
    pub time: f64,
    /// State at that time.
    pub state: State<Q>,
    /// Phase at that time.
    pub phase: Phase,
    /// Transitions so far.
    pub transitions: u64,
    /// Work so far.
    pub work: Work,
    /// Impulse of the impacts on the ground so far.
    pub impulse: Impulse,
    /// The plastic elongations of the dissipators, and the energy that the dissipators have taken.
    pub dissipators: Dissipators,
    /// How far contact points of the ground have settled for good, m.
    pub settled: Q::Settled,
    pub(crate) chatter: Chatter,
    /// The guard that has closed now, before its transition is applied.
    pub(crate) due: Option<Closed>,
}

impl<Q: Coordinates> Motion<Q> {
    /// What it keeps beside the state.
    #[inline]
    pub(crate) fn kept(&self) -> Kept<'_> {
        (&self.dissipators, Q::settlements(&self.settled))
    }

    /// The side about which the structure rocks, or to which it leans on ground that gives.
    #[inline]
    pub(crate) fn side(&self) -> Side {
        if let Phase::OnGround(_) = self.phase { Side::of(self.state.theta) } else { self.phase.side() }
    }

    /// Duration from now on, s, over which contact is held because too many transitions came before.
    pub fn held(&self) -> f64 {
        self.chatter.held
    }
}
