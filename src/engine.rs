//! The hybrid engine: phase equations → step → guard → transition, repeated to the end of an interval.
//!
//! A step is a Taylor series ([`crate::taylor`]) that ends where its truncation error meets the tolerance, at the end
//! of the interval, or at the first transition on it, which [`crate::first_crossing`] cannot pass. At the start of
//! rocking θ is exactly 0; its leading zero coefficients are divided out before the search for its return, so that
//! neither is a return within microseconds missed nor the start taken for one.
//!
//! # Progress
//!
//! Transitions are counted from the first of them on for a vibration period 2π/ω_u, then anew. After
//! [`MAX_TRANSITIONS_PER_PERIOD`] the next impact is a landing whatever its momentum, and contact is held to the end of
//! the period ([`TransitionKind::Settling`]): it sees two more at most. Bounces that fast are the start of infinitely
//! many in finite time, which end in contact; neither specimen comes near them. Steps are then bounded too: an advance
//! takes at most one for itself, two for each transition, and one for each 1/Ω of time, Ω the largest of ω_u, 2 ζ_u ω_u,
//! 2 ζ_fc ω_fc and p_l. Only what is thrown about takes more, up to four for each 1/Ω with |θ̇|, |u̇|/ρ and √(|ü|/ρ) among
//! them, ρ² = (J0 + m0 B²)/m + (sB − u)². The rigid limit, which has no vibration and does come to rest by ever faster
//! impacts, has [`MAX_RIGID_TRANSITIONS_PER_PERIOD`] for each 1/p_l instead. One call takes at most
//! [`MAX_STEPS_PER_ADVANCE`] steps.

use crate::detail::{Detail, RockingEquations};
use crate::first_crossing::{Crossing, Guard, first_time_all_closed};
use crate::full_contact::ExactContact;
use crate::load::{LinearLoad, Load};
use crate::reactions::{Impulse, Reactions};
use crate::state::InitialStateError;
use crate::taylor::{Arc, Start};
use crate::{Outputs, Phase, Side, State, Structure, full_contact, impact, rigid_rocking, uplift};
use serde::{Deserialize, Serialize};
use std::f64::consts::{FRAC_PI_2, TAU};

/// The default relative tolerance of the results.
pub const DEFAULT_TOLERANCE: f64 = 1e-9;

/// Part of the tolerance that one step may use up. Impacts amplify an error by orders of magnitude over a record, and a
/// series pays for each with only one more coefficient or so.
const LOCAL_SHARE: f64 = 1e-5;

/// Transitions within one period of the vibration mode (2π/ω_u) after which contact is held.
pub const MAX_TRANSITIONS_PER_PERIOD: u32 = 1000;

/// Transitions within 1/p_l after which contact is held at the rigid level: coming to rest with r = 0.9998 takes as
/// many.
pub const MAX_RIGID_TRANSITIONS_PER_PERIOD: u32 = 100_000;

/// Steps that one advance may take, a second or two of computing, and some ten of what is thrown about so wildly that every
/// step has to be searched for transitions throughout; a longer interval has to be cut.
pub const MAX_STEPS_PER_ADVANCE: u64 = 2_000_000;

/// A step shorter than this part of 1/ω_u is not the doing of the step's end or of a transition: the solution ends.
const STALLED: f64 = 1e-12;

/// Part of its inertia at u = 0, height apart, that a structure must keep about its pivot: with less of it, (6) − H (5)
/// asks for steps without number on the way to a singularity.
const LEAST_INERTIA: f64 = 1e-6;

/// Work done since the start, counted.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Work {
    /// Taylor steps taken.
    pub steps: u64,
    /// Right-hand-side evaluations: one for every order of every series.
    pub evaluations: u64,
}

/// Transitions since the start of the present vibration period, for the guarantee of progress.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
struct Burst {
    /// Time of the first of them, s.
    start: f64,
    /// How many.
    transitions: u32,
    /// Until when contact is held, s.
    held_until: f64,
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
    /// Ground acceleration at that time, m/s², 0 before the first advance.
    pub a_g: f64,
    /// Impulse of the impacts on the ground so far.
    pub impulse: Impulse,
    burst: Burst,
}

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

/// How far an advance came.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// To the end of the interval.
    Complete,
    /// To the instant of overturning, which is the motion's time now; it stays there.
    Overturned,
}

/// Why an advance failed; the motion is then as it was before, whatever transitions have been shown on the way.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AdvanceError {
    /// The end of the interval does not lie ahead.
    #[error("cannot advance from t = {from} s to {until} s: the end must be a finite time that lies ahead")]
    NotAhead {
        /// The motion's time, s.
        from: f64,
        /// The refused end, s.
        until: f64,
    },
    /// The load is not finite over the interval.
    #[error("{name} = {value} {unit} with slope {slope} {unit}/s is not finite up to t = {until} s: give finite loads")]
    Load {
        /// `a_g` or `F_t`.
        name: &'static str,
        /// Its unit.
        unit: &'static str,
        /// At the start.
        value: f64,
        /// Per second.
        slope: f64,
        /// End of the interval, s.
        until: f64,
    },
    /// Too many steps for one call.
    #[error(
        "one advance may take {MAX_STEPS_PER_ADVANCE} steps; they ended at t = {time} s of {until} s: advance in \
         shorter intervals"
    )]
    TooLong {
        /// Where the steps ended, s.
        time: f64,
        /// End of the interval, s.
        until: f64,
    },
    /// The equations have no finite solution from here on.
    #[error(
        "the motion cannot be continued beyond t = {time} s (u = {u} m, theta = {theta} rad): the top mass passes \
         above the pivot of a foundation without inertia (m0, J0 too small), or the numbers overflow"
    )]
    Singular {
        /// s.
        time: f64,
        /// m.
        u: f64,
        /// rad.
        theta: f64,
    },
}

/// A structure in motion.
#[derive(Clone, Debug)]
pub struct Engine {
    structure: Structure,
    detail: Detail,
    tolerance: f64,
    motion: Motion,
    contact: ExactContact,
    rocking: RockingEquations,
    /// The step in hand.
    arc: Arc,
}

/// What happens at the end of a step.
enum StepEnd {
    Quiet,
    HoldOver,
    Uplift(Side),
    Impact(Side),
    Overturning(Side),
}

impl Engine {
    /// Starts at `time` (s) from `initial`, to a relative `tolerance` of the results, at the level of detail `auto`.
    pub fn new(structure: Structure, initial: State, time: f64, tolerance: f64) -> Result<Engine, InitialStateError> {
        Engine::with_detail(structure, initial, time, tolerance, Detail::Auto)
    }

    /// The same at the level `detail`.
    pub fn with_detail(
        structure: Structure,
        initial: State,
        time: f64,
        tolerance: f64,
        detail: Detail,
    ) -> Result<Engine, InitialStateError> {
        let phase = initial.initial_phase(detail)?;
        let motion = Motion {
            time,
            state: initial,
            phase,
            transitions: 0,
            work: Work::default(),
            a_g: 0.0,
            impulse: Impulse::default(),
            burst: Burst { start: f64::MIN, transitions: 0, held_until: f64::MIN },
        };
        Ok(Engine {
            structure,
            detail,
            tolerance,
            motion,
            contact: ExactContact::new(&structure),
            rocking: RockingEquations::new(detail, &structure),
            arc: Arc::default(),
        })
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

    /// Advances to the time `until` (s) under `load`, which is given from the present time on; every transition on the
    /// way is shown to `observe`.
    pub fn advance(
        &mut self,
        until: f64,
        load: impl Into<LinearLoad>,
        observe: &mut dyn FnMut(&Transition),
    ) -> Result<Progress, AdvanceError> {
        let start = self.motion.time;
        let interval = until - start;
        if !(interval > 0.0 && interval.is_finite()) {
            return Err(AdvanceError::NotAhead { from: start, until });
        }
        let load: LinearLoad = load.into();
        let (first, last) = (load.value, load.at(interval));
        for (name, unit, ends, slope) in [
            ("a_g", "m/s2", [first.a_g, last.a_g], load.slope.a_g),
            ("F_t", "N", [first.F_t, last.F_t], load.slope.F_t),
        ] {
            if !ends.iter().all(|end| end.is_finite()) {
                return Err(AdvanceError::Load { name, unit, value: ends[0], slope, until });
            }
        }
        let (a_g, a_top) = (load.on_foundation(), load.on_top(&self.structure));
        let local_error = (LOCAL_SHARE * self.tolerance).max(f64::EPSILON / 2.0);
        if let Some(state) = self.leap(&Start { state: self.motion.state, a_g, a_top, interval, local_error }) {
            self.motion.state = state;
            self.motion.time = until;
            self.motion.a_g = a_g.at(interval);
            self.motion.work.steps += 1;
            return Ok(Progress::Complete);
        }
        let mut motion = self.motion;
        let last_step = motion.work.steps + MAX_STEPS_PER_ADVANCE;
        // Time runs from the start of the interval: transitions are then as sharp at t = 1000 s as at 0.
        let mut elapsed = 0.0;
        while elapsed < interval {
            let left = interval - elapsed;
            let begin = Start {
                state: motion.state,
                a_g: a_g.from(elapsed),
                a_top: a_top.from(elapsed),
                interval: left,
                local_error,
            };
            let end = match motion.phase {
                Phase::FullContact => self.step_in_full_contact(begin, motion.burst.held_until - motion.time),
                Phase::Rocking(side) => self.step_while_rocking(&begin, side),
                Phase::Overturned(_) => break,
            };
            let (arc, duration) = (&self.arc, self.arc.duration());
            let has_stalled = arc.reach < 1.0 && duration <= STALLED / self.structure.omega_u;
            let has_ended = has_stalled && matches!(end, StepEnd::Quiet);
            if !arc.is_finite() || has_ended || self.is_above_massless_pivot(&motion) {
                let State { u, theta, .. } = motion.state;
                return Err(AdvanceError::Singular { time: motion.time, u, theta });
            }
            if motion.work.steps == last_step {
                return Err(AdvanceError::TooLong { time: motion.time, until });
            }
            motion.work.steps += 1;
            motion.work.evaluations += arc.order as u64;
            motion.state = arc.end();
            elapsed = if duration == left { interval } else { elapsed + duration };
            motion.time = if elapsed < interval { start + elapsed } else { until };
            motion.a_g = a_g.at(elapsed);
            if let Some(transition) = self.resolve(&mut motion, end) {
                observe(&transition);
            }
        }
        self.motion = motion;
        match motion.phase {
            Phase::Overturned(_) => Ok(Progress::Overturned),
            _ => Ok(Progress::Complete),
        }
    }

    /// The outputs now, with the force `F_t` (N) on the top mass; once overturned, those of the instant before.
    pub fn outputs(&self, F_t: f64) -> Outputs {
        let Motion { state, a_g, .. } = &self.motion;
        match self.detail {
            Detail::Rigid => Outputs::of_rigid(&self.structure, self.moving_phase(), state, Load { a_g: *a_g, F_t }),
            _ => Outputs::of(&self.structure, self.moving_phase(), state, F_t),
        }
    }

    /// The reactions now under `load`; once overturned, those of the instant before.
    pub fn reactions(&self, load: Load) -> Reactions {
        let (phase, state) = (self.moving_phase(), &self.motion.state);
        let accelerations = self.rocking.accelerations(&self.structure, phase, state, load);
        Reactions::of(&self.structure, phase, state, accelerations, load)
    }

    /// The phase now, or that in which the structure overturned.
    fn moving_phase(&self) -> Phase {
        match self.motion.phase {
            Phase::Overturned(side) => Phase::Rocking(side),
            phase => phase,
        }
    }

    /// Time derivatives of the outputs and reactions now under `load`, from the equations of motion; 0 once overturned.
    /// At a transition they are those just after it.
    pub fn rates(&mut self, load: LinearLoad) -> (Outputs, Reactions) {
        let derivatives = self.derivatives(load);
        let (structure, Motion { phase, state, .. }) = (&self.structure, &self.motion);
        let outputs = match self.detail {
            Detail::Rigid => Outputs::rates_of_rigid(structure, *phase, state, derivatives, load),
            _ => Outputs::rates_by(structure, *phase, state, derivatives[0], load),
        };
        (outputs, Reactions::rates(structure, *phase, state, derivatives, load))
    }

    /// (ü, θ̈) and (u⃛, θ⃛) now under `load`, from the first terms of the series; 0 once overturned.
    fn derivatives(&mut self, load: LinearLoad) -> [[f64; 2]; 2] {
        let Motion { phase, state, .. } = self.motion;
        let (a_g, a_top) = (load.on_foundation(), load.on_top(&self.structure));
        let start = Start { state, a_g, a_top, interval: 1.0, local_error: 1.0 };
        let (structure, arc) = (&self.structure, &mut self.arc);
        match phase {
            Phase::FullContact if self.detail == Detail::Rigid => rigid_rocking::rest(&start, arc),
            Phase::FullContact => full_contact::series(structure, &start, arc),
            Phase::Rocking(side) => self.rocking.series(structure, side, &start, arc),
            Phase::Overturned(_) => return [[0.0; 2]; 2],
        }
        let derivative = |k: i32, factor: f64| {
            [arc.u_dot[k as usize], arc.theta_dot[k as usize]].map(|c| factor * c / arc.span.powi(k))
        };
        [derivative(1, 1.0), derivative(2, 2.0)]
    }

    /// The state at the end of `start` where it is known exactly and no transition can happen until then.
    #[inline]
    fn leap(&mut self, start: &Start) -> Option<State> {
        let state = match (self.detail, self.motion.phase) {
            (Detail::FixedBase, Phase::FullContact) => self.contact.leap(start, f64::INFINITY),
            (Detail::Auto | Detail::Linear | Detail::Modal, Phase::FullContact)
                if self.motion.burst.held_until <= self.motion.time =>
            {
                self.contact.leap(start, self.structure.u_cr)
            }
            (_, Phase::Rocking(side)) => self.rocking.leap(side, start),
            _ => None,
        };
        state.filter(State::is_finite)
    }

    /// Whether next to nothing but its height keeps the structure from turning about its pivot.
    fn is_above_massless_pivot(&self, motion: &Motion) -> bool {
        let (Phase::Rocking(side), RockingEquations::Nonlinear(_)) = (motion.phase, &self.rocking) else {
            return false;
        };
        let (foundation, B) = (self.structure.foundation, self.structure.parameters().B);
        let lever = side.sign() * B - motion.state.u;
        foundation + lever * lever < LEAST_INERTIA * (foundation + B * B)
    }

    /// Motion in full contact, cut at uplift; none of it for the first `held` seconds.
    fn step_in_full_contact(&mut self, mut start: Start, held: f64) -> StepEnd {
        let is_held = held > 0.0;
        if is_held {
            start.interval = start.interval.min(held);
        }
        let (structure, arc) = (&self.structure, &mut self.arc);
        match self.detail {
            Detail::Rigid => rigid_rocking::rest(&start, arc),
            _ => full_contact::series(structure, &start, arc),
        }
        if is_held {
            return if arc.duration() == held { StepEnd::HoldOver } else { StepEnd::Quiet };
        }
        let (crossing, side) = match self.detail {
            Detail::FixedBase => return StepEnd::Quiet,
            Detail::Rigid => rigid_rocking::first_uplift(structure, start.a_top, arc.span),
            _ => uplift::first_on(structure, &self.rocking.turning_moment(structure), arc),
        };
        cut(arc, crossing, StepEnd::Uplift(side))
    }

    /// Rocking about `side`, cut at impact or overturning.
    fn step_while_rocking(&mut self, start: &Start, side: Side) -> StepEnd {
        let arc = &mut self.arc;
        self.rocking.series(&self.structure, side, start, arc);
        if stays_about(arc, side) {
            return StepEnd::Quiet;
        }
        let overturning = first_overturning(arc, side);
        let end = cut(arc, overturning, StepEnd::Overturning(side));
        match first_return(arc, side) {
            Crossing::None => end,
            crossing => cut(arc, crossing, StepEnd::Impact(side)),
        }
    }

    /// Applies to `motion` what happens at the end of a step; a transition is returned to be reported.
    fn resolve(&self, motion: &mut Motion, end: StepEnd) -> Option<Transition> {
        let before = motion.state;
        let (kind, phase, after) = match end {
            StepEnd::Quiet => return None,
            StepEnd::HoldOver => {
                motion.burst.held_until = f64::MIN;
                return None;
            }
            StepEnd::Uplift(side) => (TransitionKind::Uplift(side), Phase::Rocking(side), before),
            StepEnd::Overturning(side) => (TransitionKind::Overturning(side), Phase::Overturned(side), before),
            StepEnd::Impact(side) => self.resolve_impact(motion, side),
        };
        let (period, _) = self.chatter_limit();
        if motion.time >= motion.burst.start + period {
            motion.burst.start = motion.time;
            motion.burst.transitions = 0;
        }
        motion.burst.transitions += 1;
        motion.transitions += 1;
        motion.impulse = motion.impulse.and(Impulse::of(&self.structure, (motion.phase, &before), (phase, &after)));
        motion.phase = phase;
        motion.state = after;
        Some(Transition { time: motion.time, kind, before, after })
    }

    /// What follows when rocking about `side` ends at the ground.
    fn resolve_impact(&self, motion: &mut Motion, side: Side) -> (TransitionKind, Phase, State) {
        let (structure, before) = (&self.structure, &motion.state);
        let (period, most) = self.chatter_limit();
        let period_end = motion.burst.start + period;
        if motion.burst.transitions >= most && motion.time < period_end {
            motion.burst.held_until = period_end;
            let after = match self.detail {
                Detail::Rigid => State::default(),
                _ => impact::land(structure, before),
            };
            return (TransitionKind::Settling, Phase::FullContact, after);
        }
        let (phase, after) = match self.detail {
            Detail::Rigid => rigid_rocking::resolve_impact(structure, side, before, self.tolerance),
            _ => impact::resolve(structure, side, before),
        };
        match phase {
            Phase::Rocking(side) => (TransitionKind::Impact(side), phase, after),
            _ => (TransitionKind::Landing, phase, after),
        }
    }

    /// The period (s) that may see no more than so many transitions.
    fn chatter_limit(&self) -> (f64, u32) {
        match self.detail {
            Detail::Rigid => (1.0 / self.structure.p_l, MAX_RIGID_TRANSITIONS_PER_PERIOD),
            _ => (TAU / self.structure.omega_u, MAX_TRANSITIONS_PER_PERIOD),
        }
    }
}

/// Ends `arc` at `crossing`, and says whether the transition `end` happens there.
fn cut(arc: &mut Arc, crossing: Crossing, end: StepEnd) -> StepEnd {
    match crossing {
        Crossing::None => StepEnd::Quiet,
        Crossing::NoneUntil(sigma) => {
            arc.reach = sigma;
            StepEnd::Quiet
        }
        Crossing::At(sigma) => {
            arc.reach = sigma;
            end
        }
    }
}

/// Whether the magnitudes of the terms of θ prove that neither guard of rocking about `side` closes on `arc`.
fn stays_about(arc: &Arc, side: Side) -> bool {
    let start = side.sign() * arc.theta[0];
    let excursion: f64 = arc.theta[1..=arc.order].iter().map(|c| c.abs()).sum();
    excursion < start && excursion + start < FRAC_PI_2
}

/// The first instant of a rocking `arc` at which |θ| reaches π/2.
fn first_overturning(arc: &Arc, side: Side) -> Crossing {
    let theta = arc.used(&arc.theta);
    first_time_all_closed([Guard::new(theta, -side.sign(), FRAC_PI_2)], arc.reach)
}

/// The first instant of a rocking `arc` at which s θ returns to 0. A start at θ = 0 is divided out: s θ/σ^z is
/// searched, z the number of leading zeros, so that the start is no return and a return right after it is not missed.
/// What underflows counts as zero; a θ that is zero throughout, over a step of 1e-200 s say, has not returned.
fn first_return(arc: &Arc, side: Side) -> Crossing {
    let theta = arc.used(&arc.theta);
    match theta.iter().position(|c| c.is_normal()) {
        Some(zeros) => first_time_all_closed([Guard::new(&theta[zeros..], side.sign(), 0.0)], arc.reach),
        None => Crossing::None,
    }
}
