//! Transitions: their kinds, what follows from each, and the limit on how many there may be.
//!
//! # Progress
//!
//! Transitions are counted from the first of them on for a vibration period 2π/ω_u, then anew. After
//! [`MAX_TRANSITIONS_PER_PERIOD`] the next impact is a landing whatever its momentum, and contact is held to the end of
//! the period ([`TransitionKind::Settling`]): it sees two more at most. Bounces that fast are the start of infinitely
//! many in finite time, which end in contact; neither specimen comes near them. The rigid limit, which has no vibration
//! and does come to rest by ever faster impacts, has [`MAX_RIGID_TRANSITIONS_PER_PERIOD`] for each 1/p_l instead.

use crate::detail::Level;
use crate::engine::Motion;
use crate::reactions::Impulse;
use crate::{Phase, Side, State, Structure};
use serde::{Deserialize, Serialize};

/// Transitions within one period of the vibration mode (2π/ω_u) after which contact is held.
pub const MAX_TRANSITIONS_PER_PERIOD: u32 = 1000;

/// Transitions within 1/p_l after which contact is held at the rigid level: coming to rest with r = 0.9998 takes as
/// many.
pub const MAX_RIGID_TRANSITIONS_PER_PERIOD: u32 = 100_000;

/// What changed at a transition.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TransitionKind {
    /// Full contact → rocking about this side.
    Uplift(Side),
    /// Rocking → rocking about the other pivot, which is the side given.
    Impact(Side),
    /// Rocking → full contact.
    Landing,
    /// Rocking → full contact, held to the end of a vibration period that saw too many transitions.
    Settling,
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

/// What happens at the end of a step.
#[derive(Clone, Copy)]
pub(crate) enum Event {
    /// The base lifts off about this side.
    Uplift(Side),
    /// Rocking about this side is back at the ground.
    Impact(Side),
    /// |θ| is π/2 on this side.
    Overturning(Side),
}

/// How many transitions a period (s) may see.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ChatterLimit {
    pub period: f64,
    pub transitions: u32,
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

    fn count(&mut self, limit: ChatterLimit) {
        if self.age >= limit.period {
            (self.age, self.transitions) = (0.0, 0);
        }
        self.transitions += 1;
    }

    fn is_too_much(&self, limit: ChatterLimit) -> bool {
        self.transitions >= limit.transitions && self.age < limit.period
    }
}

/// The `motion` after what `event` leads to, and the transition to be reported.
pub(crate) fn resolve(
    level: &dyn Level,
    structure: &Structure,
    mut motion: Motion,
    event: Event,
) -> (Motion, Transition) {
    let before = motion.state;
    let limit = level.chatter_limit(structure);
    let (kind, phase, after) = match event {
        Event::Uplift(side) => (TransitionKind::Uplift(side), Phase::Rocking(side), before),
        Event::Overturning(side) => (TransitionKind::Overturning(side), Phase::Overturned(side), before),
        Event::Impact(_) if motion.chatter.is_too_much(limit) => {
            motion.chatter.held = limit.period - motion.chatter.age;
            (TransitionKind::Settling, Phase::FullContact, level.land(structure, &before))
        }
        Event::Impact(side) => match level.after_impact(structure, side, &before) {
            (Phase::Rocking(side), after) => (TransitionKind::Impact(side), Phase::Rocking(side), after),
            (phase, after) => (TransitionKind::Landing, phase, after),
        },
    };
    motion.chatter.count(limit);
    motion.transitions += 1;
    motion.impulse = motion.impulse.and(Impulse::of(structure, (motion.phase, &before), (phase, &after)));
    motion.phase = phase;
    motion.state = after;
    (motion, Transition { time: motion.time, kind, before, after })
}
