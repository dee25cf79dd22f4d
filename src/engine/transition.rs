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
    /// This dissipator, the first (0) at +ξ_d, begins to yield.
    Yielding(usize),
    /// It ceases to yield.
    Unloading(usize),
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
            TransitionKind::Yielding(0) => "yielding of the first dissipator",
            TransitionKind::Yielding(_) => "yielding of the second dissipator",
            TransitionKind::Unloading(0) => "unloading of the first dissipator",
            TransitionKind::Unloading(_) => "unloading of the second dissipator",
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

/// Takes `motion` to what `event` leads to: the transition to be reported.
#[inline]
pub(crate) fn resolve(
    level: &(impl Level + ?Sized),
    structure: &Structure,
    motion: &mut Motion,
    event: Event,
) -> Transition {
    let before = motion.state;
    let yields = match event {
        Event::Yielding(which, way) => Some((TransitionKind::Yielding(which.into()), usize::from(which), way)),
        Event::Unloading(which) => Some((TransitionKind::Unloading(which.into()), usize::from(which), 0)),
        _ => None,
    };
    if let Some((kind, which, way)) = yields {
        motion.transitions += 1;
        motion.dissipators.yields[which] = way;
        // it ceases to where the elongation turns round
        motion.state.theta_dot = if way == 0 { 0.0 } else { before.theta_dot };
        return Transition { time: motion.time, kind, before, after: motion.state };
    }
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
        Event::Yielding(..) | Event::Unloading(_) => unreachable!("they change no phase"),
    };
    motion.chatter.count(limit);
    motion.transitions += 1;
    motion.impulse = motion.impulse.and(Impulse::of(structure, (motion.phase, &before), (phase, &after)));
    motion.phase = phase;
    motion.state = after;
    if level.ties().is_some() {
        let rocking = if let Phase::Rocking(side) = phase { Some((side, after.theta_dot)) } else { None };
        motion.dissipators = motion.dissipators.after(structure, rocking);
    }
    Transition { time: motion.time, kind, before, after }
}
