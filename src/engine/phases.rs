//! The phases of a motion as data: which guards are watched, and what happens when each of them closes.
//!
//! The loop of the [engine](crate::engine) expands the motion, finds the first guard that closes, and applies the guard's transition.
//! A new kind of contact is one more [`Rules`] here, with its guards.

use crate::engine::contacts::{self, Points, Tied};
use crate::engine::friction::Sliding;
use crate::engine::guard::{BAND, Guard};
use crate::engine::motion::Motion;
use crate::engine::sample::Sample;
use crate::engine::step::{Branch, Moved, Step};
use crate::engine::transition::{TransitionKind, enter};
use crate::engine::yielding::{self, Yielding};
use crate::levels::level::{Level, LevelSubject};
use crate::mechanics::arc::Arc;
use crate::mechanics::impact;
use crate::mechanics::lateral::Coordinates;
use crate::mechanics::state::most_change;
use crate::numbers::Real;
use crate::series::extremes::off_chord;
use crate::series::first_crossing::{Crossing, Gap, first_time_all_closed};
use crate::series::taylor::{evaluate, sum_of_magnitudes};
use crate::{Phase, Side, Structure};
use std::f64::consts::FRAC_PI_2;

/// A phase as the loop knows it.
pub(crate) struct Rules<Q: Coordinates = f64> {
    /// Duration of the phase at most, s.
    pub lasts: Option<fn(&Motion<Q>) -> f64>,
    /// A cheap proof that no guard closes over a step.
    pub stays: Option<fn(&Step<Q>) -> bool>,
    pub guards: &'static [&'static dyn Guard<Q>],
    /// How a step moves what is kept beside the state.
    pub moved: fn(&Step<Q>) -> Moved<Q>,
}

impl<Q: Coordinates> Rules<Q> {
    /// A phase in which the base does not move, without guards.
    pub(super) const RESTING: Rules<Q> = Rules { lasts: None, stays: None, guards: &[], moved: |_| (None, None) };

    /// Full contact that is held after too many transitions.
    const HELD: &'static Rules<Q> = &Rules { lasts: Some(Motion::held), ..Rules::RESTING };

    /// Full contact.
    const CONTACT: &'static Rules<Q> = &Rules { guards: &[&Uplift], ..Rules::RESTING };

    /// Rocking about either side.
    const ROCKING: &'static Rules<Q> = &Rules {
        stays: Some(|step| stays_about(step.arc, step.side)),
        guards: &[&Overturning, &Impact],
        moved: yielding::moved,
        ..Rules::RESTING
    };

    /// Rocking with dissipators that may yield.
    const ROCKING_YIELDING: &'static Rules<Q> =
        &Rules { guards: &[&Yielding, &Overturning, &Impact], moved: yielding::moved, ..Rules::RESTING };

    /// Ground that gives.
    const ON_GROUND: &'static Rules<Q> = &Rules { guards: &[&Overturning, &Points], ..Rules::RESTING };

    /// Ground that gives, with a tendon or dissipators, or with points that may yield, or under a base that may slide.
    const ON_GROUND_TIED: &'static Rules<Q> =
        &Rules { guards: &[&Overturning, &Points, &Tied, &Sliding], moved: contacts::moved, ..Rules::RESTING };
}

/// The phase of `motion` of `structure`; none once the structure has overturned.
#[inline]
pub(crate) fn of<Q: Coordinates>(structure: &Structure, motion: &Motion<Q>) -> Option<&'static Rules<Q>> {
    match motion.phase {
        Phase::FullContact if motion.held() > 0.0 => Some(Rules::HELD),
        Phase::FullContact => Some(Rules::CONTACT),
        Phase::Rocking(_) if structure.base().ties.F_y > 0.0 => Some(Rules::ROCKING_YIELDING),
        Phase::Rocking(_) => Some(Rules::ROCKING),
        Phase::OnGround(_) => {
            Q::foundation(structure).map(|of| match structure.base().is_restrained() || of.may_stay_moved() {
                true => Rules::ON_GROUND_TIED,
                false => Rules::ON_GROUND,
            })
        }
        Phase::Overturned(_) => None,
    }
}

/// The base lifts off about the side of the sign.
struct Uplift;

impl<Q: Coordinates> Guard<Q> for Uplift {
    fn first(&self, step: &Step<Q>) -> (Crossing, Branch) {
        let Some(liftable) = step.level.liftable() else { return (Crossing::None, Branch::default()) };
        let (crossing, side) = liftable.first(step.start, step.arc);
        (crossing, about(side))
    }

    fn apply(&self, level: &dyn Level<Q>, motion: &mut Motion<Q>, branch: Branch) -> Option<TransitionKind> {
        let side = Side::of(branch.sign.into());
        enter(level, motion, Phase::Rocking(side), motion.state);
        Some(TransitionKind::Uplift(side))
    }

    fn stays_open(&self, now: &Sample<Q>, ahead: f64) -> bool {
        let start = now.level.subject().start(now.motion.state, now.motion.kept(), now.load.into(), ahead);
        now.level.liftable().is_none_or(|liftable| liftable.stays_for(&start))
    }

    fn indicator(&self, now: &Sample<Q>) -> (usize, f64) {
        (0, uplift_margin(now).0 + BAND)
    }

    fn closed(&self, now: &Sample<Q>) -> Option<Branch> {
        let (margin, side) = uplift_margin(now);
        (margin <= 0.0).then_some(about(side))
    }
}

fn uplift_margin<Q: Coordinates>(Sample { motion, load, level }: &Sample<Q>) -> (f64, Side) {
    level.uplift_margin(&motion.state, *load, &motion.dissipators)
}

fn about(side: Side) -> Branch {
    Branch { which: 0, sign: if side == Side::Right { 1 } else { -1 } }
}

/// |θ| reaches π/2.
struct Overturning;

impl<Q: Coordinates> Guard<Q> for Overturning {
    fn first(&self, step: &Step<Q>) -> (Crossing, Branch) {
        let theta = step.arc.used(&step.arc.theta);
        let falls = Gap::new(theta, -step.side.sign(), FRAC_PI_2);
        (first_time_all_closed([falls], step.reach), Branch::default())
    }

    fn apply(&self, level: &dyn Level<Q>, motion: &mut Motion<Q>, _branch: Branch) -> Option<TransitionKind> {
        let side = motion.side();
        enter(level, motion, Phase::Overturned(side), motion.state);
        Some(TransitionKind::Overturning(side))
    }

    fn stays_open(&self, now: &Sample<Q>, ahead: f64) -> bool {
        let state = &now.motion.state;
        state.theta.abs() < FRAC_PI_2 - most_change(ahead, state.theta_dot)
    }

    fn indicator(&self, now: &Sample<Q>) -> (usize, f64) {
        (1, 1.0 - now.motion.state.theta.abs() / FRAC_PI_2)
    }

    fn is_stop(&self) -> bool {
        false
    }
}

/// s θ returns to 0.
struct Impact;

impl<Q: Coordinates> Guard<Q> for Impact {
    /// A start at θ = 0 is a root of θ. With z leading zeros the polynomial that is searched is therefore s θ/σ^z. The start is then
    /// no return, and a return right after the start is found. A coefficient that underflows counts as zero. If θ is zero
    /// throughout, over a step of 1e-200 s say, there is no return.
    fn first(&self, step: &Step<Q>) -> (Crossing, Branch) {
        let theta = step.arc.used(&step.arc.theta);
        let crossing = match theta.iter().position(|c| c.is_normal()) {
            Some(zeros) => {
                let height = Gap::new(&theta[zeros..], step.side.sign(), 0.0);
                first_time_all_closed([height], step.reach)
            }
            None => Crossing::None,
        };
        (crossing, Branch::default())
    }

    fn apply(&self, level: &dyn Level<Q>, motion: &mut Motion<Q>, _branch: Branch) -> Option<TransitionKind> {
        let (before, &LevelSubject { ref structure, local_error, .. }) = (motion.state, level.subject());
        let (kind, phase, after) = if motion.chatter.settles(structure) {
            (TransitionKind::Settling, Phase::FullContact, impact::land::<Q>(structure, &before))
        } else {
            match impact::resolve::<Q>(structure, local_error, motion.phase.side(), &before) {
                (Phase::Rocking(side), after) => (TransitionKind::Impact(side), Phase::Rocking(side), after),
                (phase, after) => (TransitionKind::Landing, phase, after),
            }
        };
        enter(level, motion, phase, level.admissible(phase, after));
        Some(kind)
    }

    fn stays_open(&self, now: &Sample<Q>, ahead: f64) -> bool {
        let state = &now.motion.state;
        state.theta.abs() >= most_change(ahead, state.theta_dot)
    }

    fn indicator(&self, now: &Sample<Q>) -> (usize, f64) {
        let Motion { phase, state, .. } = &now.motion;
        let alpha_cg = libm::atan(now.level.structure().base().tan_alpha_cg);
        (0, phase.side().sign() * state.theta / alpha_cg + BAND)
    }
}

/// Whether the magnitudes of the terms of θ prove that s θ stays between 0 and π/2 on `arc`.
fn stays_about<Q: Coordinates>(arc: &Arc<Q>, side: Side) -> bool {
    let (theta, reach, s) = (arc.used(&arc.theta), arc.reach, side.sign());
    let excursion = if reach < 1.0 {
        reach * theta[1..].iter().rev().fold(0.0, |sum, c| sum * reach + c.abs())
    } else {
        sum_of_magnitudes(&theta[1..])
    };
    let first = arc.theta[1..4].iter().rev().map(|c| s * c);
    let lead = reach * first.fold(0.0, |lead, c| if c < 0.0 { 0.0 } else { lead * reach + c });
    let start = s * theta[0];
    let (end, off) = match excursion < start {
        true => (start, excursion), // most steps need no more
        false => (s * evaluate(theta, reach), off_chord(theta, reach)),
    };
    room([start, end], [excursion, if start < 0.0 { 0.0 } else { lead }, off]) > 0.0
}

/// The room that s θ keeps to 0 and π/2 over a step from `start` to `end`, by bounds of how far it leaves its start (`excursion`) and its
/// chord (`off`). A motion stays above its start if the terms of the first orders, none of which lowers it, add up to a `lead` that
/// exceeds the sum of all others.
#[inline(always)]
pub(crate) fn room<N: Real>([start, end]: [N; 2], [excursion, lead, off]: [N; 3]) -> N {
    let above = (start - excursion).max(lead + lead - excursion).max(start.min(end) - off);
    above.min(start.like(FRAC_PI_2) - (excursion + start))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Motions that start above the ground, from the ground with a velocity, and from there at rest. A proof holds at every sample, and
    /// most that stay above are proved.
    #[test]
    fn a_motion_that_is_proved_to_stay_above_the_ground_does_so() {
        let (random, side) = (&mut fastrand::Rng::with_seed(1), Side::Left);
        let (mut proved, mut above) = ([0; 3], [0; 3]);
        for i in 0..30_000 {
            let (mut arc, zeros) =
                (Arc::<f64> { order: 6, span: 1.0, reach: [1.0, 0.5][i % 2], ..Arc::default() }, i % 3);
            (zeros..7).for_each(|k| arc.theta[k] = 0.5_f64.powi((k - zeros) as i32) * (2.0 * random.f64() - 1.0));
            let at = |j: i32| side.sign() * evaluate(arc.used(&arc.theta), f64::from(j) / 100.0 * arc.reach);
            let (stays, is_above) = (stays_about(&arc, side), (1..=100).all(|j| (0.0..FRAC_PI_2).contains(&at(j))));
            assert!(is_above || !stays, "{arc:?}");
            proved[zeros] += i32::from(stays);
            above[zeros] += i32::from(is_above);
        }
        assert!((0..3).all(|zeros| 2 * proved[zeros] > above[zeros]), "{proved:?} of {above:?}");
    }
}
