//! The hybrid engine.
use crate::{Phase, Side, State, Structure, state::InitialStateError};
use serde::{Deserialize, Serialize};

/// Ground acceleration over one interval, positive to the right: `value + slope·(t − start of the interval)`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct GroundAcceleration {
    /// At the start of the interval, m/s².
    pub value: f64,
    /// Its rate, m/s³.
    pub slope: f64,
}

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
}

/// What changed at a transition.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TransitionKind {
    /// Full contact → rocking.
    Uplift(Side),
    /// Rocking → rocking about the other pivot, which is the side given.
    Impact(Side),
    /// Rocking → full contact.
    Landing,
    /// |θ| reached π/2 on this side.
    Overturning(Side),
}

/// One transition, as it is reported.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transition {
    /// Its instant, s.
    pub time: f64,
    /// What changed.
    pub kind: TransitionKind,
    /// State just before.
    pub before: State,
    /// State just after.
    pub after: State,
}

/// How far an advance came.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Progress {
    /// To the end of the interval.
    Complete,
    /// To the instant of overturning, which is the motion's time now; it stays there.
    Overturned,
}

/// Why an advance failed; the motion is then as it was before.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AdvanceError {
    /// The end of the interval or the ground acceleration is not a usable number.
    #[error("{0}")]
    BadInput(String),
    /// The solver could not go on.
    #[error("{0}")]
    Stuck(String),
}

/// A structure in motion.
#[derive(Clone, Debug)]
pub struct Engine {
    structure: Structure,
    tolerance: f64,
    motion: Motion,
}

impl Engine {
    /// Starts at `time` from `initial`, to a relative `tolerance` of the results.
    pub fn new(structure: Structure, initial: State, time: f64, tolerance: f64) -> Result<Engine, InitialStateError> {
        let _ = (structure, initial, time, tolerance);
        todo!()
    }

    /// The structure.
    pub fn structure(&self) -> &Structure {
        &self.structure
    }

    /// Where it is now.
    pub fn motion(&self) -> &Motion {
        &self.motion
    }

    /// Puts it back where it was.
    pub fn set_motion(&mut self, motion: Motion) {
        self.motion = motion;
    }

    /// Advances to the time `until` (s) under `a_g`, which is given from the present time on; every transition on the
    /// way is shown to `observe`.
    pub fn advance(
        &mut self,
        until: f64,
        a_g: GroundAcceleration,
        observe: &mut dyn FnMut(&Transition),
    ) -> Result<Progress, AdvanceError> {
        let _ = (until, a_g, observe, self.tolerance);
        todo!()
    }
}
