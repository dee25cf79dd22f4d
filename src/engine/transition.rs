//! Transitions: their kinds, and what follows from each.

use crate::engine::motion::{Event, Motion};
use crate::levels::level::Level;
use crate::mechanics::impact;
use crate::mechanics::reactions::Impulse;
use crate::{Phase, Side, State, Structure};

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

impl TransitionKind {
    /// What it is called.
    pub const fn name(self) -> &'static str {
        match self {
            TransitionKind::Uplift(Side::Left) => "uplift left",
            TransitionKind::Uplift(Side::Right) => "uplift right",
            TransitionKind::Impact(Side::Left) => "impact left",
            TransitionKind::Impact(Side::Right) => "impact right",
            TransitionKind::Landing => "landing",
            TransitionKind::Settling => "settling",
            TransitionKind::Overturning(Side::Left) => "overturning left",
            TransitionKind::Overturning(Side::Right) => "overturning right",
        }
    }
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

/// The `motion` after what `event` leads to, and the transition to be reported.
#[inline]
pub(crate) fn resolve(
    level: &(impl Level + ?Sized),
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
            motion.chatter.hold(limit);
            let landed = level.admissible(Phase::FullContact, impact::land(structure, &before));
            (TransitionKind::Settling, Phase::FullContact, landed)
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
