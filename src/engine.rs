//! The hybrid engine: phase equations → step → guard → transition, repeated to the end of an interval.
//!
//! A step is a Taylor series ([`crate::series::taylor`]) that ends where its truncation error meets the tolerance, at the end
//! of the interval, or at the first transition on it, which [`crate::series::first_crossing`] cannot pass. At the start of
//! rocking θ is exactly 0; its leading zero coefficients are divided out before the search for its return, so that
//! neither is a return within microseconds missed nor the start taken for one.
//!
//! Steps are bounded as transitions are ([`crate::levels::rules`]): an advance takes at most one for itself, two for each
//! transition, and one for each 1/Ω of time, Ω the largest of ω_u, 2 ζ_u ω_u, 2 ζ_fc ω_fc and p_l, and of what restraints
//! add to these. Only what is thrown
//! about takes more, up to four for each 1/Ω with |θ̇|, |u̇|/ρ and √(|ü|/ρ) among them, ρ² = (J0 + m0 B²)/m + (sB − u)².
//! One call takes at most [`MAX_STEPS_PER_ADVANCE`] steps. What is left of a long one once the base is down for good takes
//! no more of them where full contact has an exact flow.

pub mod motion;
pub mod piece;
pub mod transition;
pub(crate) mod yielding;

use crate::levels::detail::{AnyLevel, Detail, Model, by_level};
use crate::levels::level::Level;
use crate::mechanics::load::{LOADS, LinearLoad, Load, Ramp};
use crate::mechanics::reactions::{Impulse, Reactions};
use crate::mechanics::restraint::{Angles, Dissipators, Restraint, Restraints};
use crate::mechanics::state::InitialStateError;
use crate::series::first_crossing::{Crossing, Guard, first_time_all_closed};
use crate::series::taylor::{Arc, Start, sum_of_magnitudes};
use crate::structure::quantity::with_unit;
use crate::{Outputs, Phase, Side, State, Structure};
use motion::{Chatter, Event, Motion, Work};
use piece::{Piece, Sample, Watch};
use std::f64::consts::FRAC_PI_2;

/// The default relative tolerance of the results.
pub const DEFAULT_TOLERANCE: f64 = 1e-9;

/// Part of the tolerance that one step may use up. Impacts amplify an error by orders of magnitude over a record, and a
/// series pays for each with only one more coefficient or so.
const LOCAL_SHARE: f64 = 1e-5;

/// What it may use up at most, however loose the tolerance is: ten times the relative change of 1e-12 in the input by
/// which conditioning is judged. An answer that such a change moves by less than a tenth of the tolerance is then within
/// it, although impacts amplify the change by 1e8, as a tolerance of 1e-3 admits.
const LARGEST_LOCAL_ERROR: f64 = 1e-11;

/// Steps that one advance may take, a second or two of computing, and some ten of what is thrown about so wildly that every
/// step has to be searched for transitions throughout; a longer interval has to be cut.
pub const MAX_STEPS_PER_ADVANCE: u64 = 2_000_000;

/// An advance over more than this, as ω_fc h in rad, may be long over before it ends.
const FAR: f64 = 1000.0;

/// A step shorter than this part of 1/ω_u is not the doing of the step's end or of a transition: the solution ends.
const STALLED: f64 = 1e-12;

/// Whether `tolerance` is a relative tolerance of results.
pub fn check_tolerance(tolerance: f64) -> Result<(), InitialStateError> {
    if tolerance > 0.0 && tolerance < 1.0 { Ok(()) } else { Err(InitialStateError::Tolerance(tolerance)) }
}

/// How far an advance came.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// To the end of the interval.
    Complete,
    /// To the instant of overturning, which is the motion's time now; it stays there.
    Overturned,
    /// To the instant at which another transition is due, where it was asked to stop there
    /// ([`Engine::stop_at_transitions`]).
    Transition,
}

/// Why an advance failed; the motion is then as it was before, whatever has been shown on the way.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum AdvanceError {
    /// The interval is not positive and finite.
    #[error(
        "cannot advance from t = {} over {}: a finite time greater than 0 is needed",
        with_unit(*from, "s"),
        with_unit(*interval, "s")
    )]
    NotAhead {
        /// The motion's time, s.
        from: f64,
        /// The refused interval, s.
        interval: f64,
    },
    /// The load is not finite over the interval.
    #[error(
        "{name} = {} with slope {}/s is not finite over {}: give finite loads",
        with_unit(*value, unit),
        with_unit(*slope, unit),
        with_unit(*interval, "s")
    )]
    Load {
        /// `a_g` or `F_t`.
        name: &'static str,
        /// Its unit.
        unit: &'static str,
        /// At the start.
        value: f64,
        /// Per second.
        slope: f64,
        /// The interval, s.
        interval: f64,
    },
    /// The ground moves vertically, which it was not to ([`Engine::admit_vertical`]).
    #[error("a_v = {} with slope {slope:?} m/s3: this structure was to be shaken horizontally alone", with_unit(*value, "m/s2"))]
    Vertical {
        /// At the start, m/s².
        value: f64,
        /// m/s³.
        slope: f64,
    },
    /// Too many steps for one call.
    #[error(
        "one advance may take {MAX_STEPS_PER_ADVANCE} steps; they ended at t = {} of {}: advance in shorter intervals",
        with_unit(*time, "s"),
        with_unit(*until, "s")
    )]
    TooLong {
        /// Where the steps ended, s.
        time: f64,
        /// End of the interval, s.
        until: f64,
    },
    /// The equations have no finite solution from here on.
    #[error(
        "the motion cannot be continued beyond t = {} (u = {}, theta = {}): the top mass passes above the pivot of a \
         foundation without inertia (m0, J0 too small), or the numbers overflow",
        with_unit(*time, "s"),
        with_unit(*u, "m"),
        with_unit(*theta, "rad")
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

impl AdvanceError {
    /// The instant from which on it cannot go on, s, where that lies within the interval.
    pub fn time(&self) -> Option<f64> {
        match *self {
            AdvanceError::TooLong { time, .. } | AdvanceError::Singular { time, .. } => Some(time),
            AdvanceError::NotAhead { .. } | AdvanceError::Load { .. } | AdvanceError::Vertical { .. } => None,
        }
    }
}

/// A structure in motion.
#[derive(Debug)]
pub struct Engine {
    model: Box<Model>,
    motion: Motion,
    /// Whether the ground may move vertically.
    vertical: bool,
    /// Whether an advance ends where a transition is due.
    stops: bool,
    /// An advance over more than this, s, is taken in parts.
    far: f64,
    /// The step in hand.
    arc: Arc,
}

impl Engine {
    /// Starts at `time` (s) from `initial`, to a relative `tolerance` of the results, at the level of detail `auto`.
    pub fn new(structure: Structure, initial: State, time: f64, tolerance: f64) -> Result<Engine, InitialStateError> {
        Engine::with_detail(structure, initial, time, tolerance, Detail::Auto)
    }

    /// Starts at `time` (s) from `initial`, to a relative `tolerance` of the results, at the level of detail `detail`. The
    /// dissipators of a structure that starts turned have been moved there slowly from rest; what that took is not counted.
    pub fn with_detail(
        structure: Structure,
        initial: State,
        time: f64,
        tolerance: f64,
        detail: Detail,
    ) -> Result<Engine, InitialStateError> {
        let phase = initial.initial_phase()?;
        check_tolerance(tolerance)?;
        let local_error = (LOCAL_SHARE * tolerance).clamp(f64::EPSILON / 2.0, LARGEST_LOCAL_ERROR);
        detail.check_start(&initial)?;
        let restrained = structure.is_restrained();
        detail.check_restrained(restrained)?;
        let model = Box::new(Model::new(structure, detail, local_error, restrained));
        let chord = model.level.ties().unwrap_or(Angles::Any).chord(initial.theta, 0.0);
        let moved = Dissipators::NEW.moved_by(&structure, phase.side(), chord);
        let motion = Motion {
            time,
            state: initial,
            phase,
            transitions: 0,
            work: Work::default(),
            impulse: Impulse::default(),
            dissipators: Dissipators { hysteretic: 0.0, ..moved },
            chatter: Chatter::NONE,
            due: None,
        };
        let far = FAR / structure.omega_fc;
        Ok(Engine { model, motion, vertical: false, stops: false, far, arc: Arc::default() })
    }

    /// The structure.
    pub fn structure(&self) -> &Structure {
        &self.model.structure
    }

    /// Where it is now.
    pub fn motion(&self) -> &Motion {
        &self.motion
    }

    /// Puts it back where it was.
    pub fn set_motion(&mut self, motion: Motion) {
        self.motion = motion;
    }

    /// Sets its clock to `time` (s). Nothing but the times that it tells depends on it.
    pub fn set_time(&mut self, time: f64) {
        self.motion.time = time;
    }

    /// Admits a vertical ground acceleration from now on, or none again. Unless this is called, there is none.
    pub fn admit_vertical(&mut self, admitted: bool) -> Result<(), InitialStateError> {
        let Model { structure, detail, local_error, .. } = *self.model;
        let restrained = structure.is_restrained() || admitted;
        detail.check_restrained(restrained)?;
        if admitted != self.vertical {
            *self.model = Model::new(structure, detail, local_error, restrained);
            self.vertical = admitted;
        }
        Ok(())
    }

    /// Whether an advance ends at the first transition but overturning, before it: [`Engine::transit`] applies it, or the
    /// next advance. Unless this is called, it does not.
    pub fn stop_at_transitions(&mut self, stops: bool) {
        self.stops = stops;
    }

    /// Applies the transition that is due, if there is one, and shows it to `watch`.
    pub fn transit<W: Watch>(&mut self, watch: &mut W) {
        if let Some(event) = self.motion.due.take() {
            let Engine { model, motion, .. } = self;
            watch.transition(&transition::resolve(&*model.level, &model.structure, motion, event));
        }
    }

    /// Advances by `interval` (s) under `load`, which is given from the present time on. Every piece and every
    /// transition on the way is shown to `watch`, once.
    pub fn advance<W: Watch>(
        &mut self,
        interval: f64,
        load: impl Into<LinearLoad>,
        watch: &mut W,
    ) -> Result<Progress, AdvanceError> {
        self.advance_within(self.motion.work.steps + MAX_STEPS_PER_ADVANCE, interval, load.into(), watch)
    }

    /// Advances until `last_step` steps have been taken since the start.
    #[inline]
    pub(crate) fn advance_within<W: Watch>(
        &mut self,
        last_step: u64,
        interval: f64,
        load: LinearLoad,
        watch: &mut W,
    ) -> Result<Progress, AdvanceError> {
        self.check(interval, &load)?;
        if self.motion.due.is_some() {
            return self.advance_past_transition(last_step, interval, load, watch);
        }
        if interval > self.far {
            return self.advance_far(last_step, interval, load, watch);
        }
        let &mut Engine { ref model, ref mut motion, stops, ref mut arc, .. } = self;
        // each level gets a loop of its own, so that nothing stands between the loop and the level's equations
        by_level!(&model.level, level => {
            Hand { model, level, arc, last_step, stops }.advance(motion, interval, load, watch)
        })
    }

    /// Advances over a long time: in parts, each twice as long as the one before, until all that is left is one leap.
    #[cold]
    fn advance_far<W: Watch>(
        &mut self,
        last_step: u64,
        interval: f64,
        load: LinearLoad,
        watch: &mut W,
    ) -> Result<Progress, AdvanceError> {
        let (before, until) = (self.motion, self.motion.time + interval);
        let (mut elapsed, mut part) = (0.0, std::mem::replace(&mut self.far, f64::INFINITY));
        let far = part;
        let mut result = Ok(Progress::Complete);
        while elapsed < interval && result == Ok(Progress::Complete) {
            let (left, load) = (interval - elapsed, load.from(elapsed));
            let is_last = part >= left || self.can_leap(left, load);
            result = self.advance_within(last_step, if is_last { left } else { part }, load, watch);
            elapsed = if is_last { interval } else { elapsed + part };
            if result == Ok(Progress::Complete) {
                self.motion.time = if is_last { until } else { before.time + elapsed };
            }
            part *= 2.0;
        }
        self.far = far;
        result.map_err(|mut error| {
            self.motion = before;
            if let AdvanceError::TooLong { until: told, .. } = &mut error {
                *told = until;
            }
            error
        })
    }

    /// Whether `interval` (s) under `load` is one leap.
    fn can_leap(&self, interval: f64, load: LinearLoad) -> bool {
        let Engine { model, motion, .. } = self;
        let start = model.start(motion.state, &motion.dissipators, load, interval);
        motion.held() == 0.0 && model.level.leap(&model.structure, motion.phase, &start).is_some()
    }

    /// Advances from where a transition is due.
    #[cold]
    fn advance_past_transition<W: Watch>(
        &mut self,
        last_step: u64,
        interval: f64,
        load: LinearLoad,
        watch: &mut W,
    ) -> Result<Progress, AdvanceError> {
        let before = self.motion;
        self.transit(watch);
        let result = self.advance_within(last_step, interval, load, watch);
        if result.is_err() {
            self.motion = before;
        }
        result
    }

    /// Whether `load` can act over `interval` (s).
    #[inline]
    pub(crate) fn check(&self, interval: f64, load: &LinearLoad) -> Result<(), AdvanceError> {
        let is_ahead = interval > 0.0 && interval <= f64::MAX;
        let is_admitted = is_ahead && load.is_finite_over(interval) && (!load.is_vertical() || self.vertical);
        if is_admitted { Ok(()) } else { self.refusal(interval, load) }
    }

    /// Why it cannot.
    #[cold]
    fn refusal(&self, interval: f64, load: &LinearLoad) -> Result<(), AdvanceError> {
        if !(interval > 0.0 && interval <= f64::MAX) {
            return Err(AdvanceError::NotAhead { from: self.motion.time, interval });
        }
        let Ramp { value, slope } = load.upwards();
        if !self.vertical && (value, slope) != (0.0, 0.0) {
            return Err(AdvanceError::Vertical { value, slope });
        }
        let end = load.at(interval);
        let Some(bad) = LOADS.iter().find(|quantity| !(quantity.get)(&end).is_finite()) else { return Ok(()) };
        let [value, slope] = [&load.value, &load.slope].map(bad.get);
        Err(AdvanceError::Load { name: bad.name, unit: bad.unit, value, slope, interval })
    }

    /// Whether certainly no transition comes within `ahead` (s), a tiny time, under `load`.
    pub fn goes_on_for(&self, ahead: f64, load: LinearLoad) -> bool {
        let Engine { model, motion, .. } = self;
        let &Motion { phase, state, ref dissipators, .. } = motion;
        let way = |rate: f64| ahead * (rate.abs() + 1.0); // at most, whatever accelerates it
        match phase {
            Phase::FullContact => {
                let start = model.start(state, dissipators, load, ahead);
                state.u.abs() + way(state.u_dot) < model.level.least_displacement(&model.structure, &start)
            }
            Phase::Rocking(side) => {
                let change = way(state.theta_dot);
                let yields = |angles| {
                    let [_, theta_ddot] = self.sample(load.value).accelerations();
                    let changes = [change, way(2.0 * theta_ddot)];
                    yielding::least_margin(&model.structure, side, angles, dissipators, &state, changes) <= 0.0
                };
                (change..FRAC_PI_2 - change).contains(&state.theta.abs()) && !model.level.ties().is_some_and(yields)
            }
            Phase::Overturned(_) => true,
        }
    }

    /// Whether the structure, in full contact now, stays there while nothing acts on it.
    pub fn stays_down(&self) -> bool {
        self.motion.phase == Phase::FullContact
            && self.model.level.stays_down(&self.model.structure, &self.motion.state, &self.motion.dissipators)
    }

    /// The motion now, under `load`.
    pub fn sample(&self, load: Load) -> Sample<'_> {
        Sample { motion: self.motion, load, model: &self.model }
    }

    /// The outputs now under `load`; once overturned, those of the instant before.
    pub fn outputs(&self, load: Load) -> Outputs {
        self.model.outputs(self.motion.phase.in_motion(), &self.motion.under(load)) // a sample would copy the motion
    }

    /// The reactions now under `load`; once overturned, those of the instant before.
    pub fn reactions(&self, load: Load) -> Reactions {
        self.sample(load).reactions()
    }

    /// What the edges of the base carry of the reactions now under `load`.
    pub fn edges(&self, load: Load) -> Reactions {
        self.sample(load).edges()
    }

    /// The forces of the restraints now.
    pub fn restraints(&self) -> Restraints {
        self.sample(Load::default()).restraints()
    }

    /// Rates of the forces of the restraints now under `load`, N/s; 0 once overturned.
    pub fn restraint_rates(&self, load: Load) -> Restraints {
        let (structure, Motion { phase, state, dissipators, .. }) = (&self.model.structure, &self.motion);
        if let Phase::Overturned(_) = phase {
            return Restraints::default();
        }
        let [_, theta_ddot] = self.sample(load).accelerations();
        let angles = self.model.level.ties().unwrap_or(Angles::Any);
        Restraints::rates(&Restraint::about(structure, phase.side(), dissipators), angles, state, theta_ddot)
    }

    /// Time derivatives of the outputs and reactions now under `load`, from the equations of motion; 0 once overturned.
    /// At a transition they are those just after it.
    pub fn rates(&self, load: LinearLoad) -> (Outputs, Reactions) {
        let derivatives = self.derivatives(load);
        let Motion { phase, state, .. } = &self.motion;
        let outputs = self.model.output_rates(*phase, state, derivatives, load);
        (outputs, Reactions::rates(&self.model.structure, *phase, state, derivatives, load))
    }

    /// (ü, θ̈) and (u⃛, θ⃛) now under `load`, from the first terms of the series; 0 once overturned.
    fn derivatives(&self, load: LinearLoad) -> [[f64; 2]; 2] {
        let Engine { model, motion: Motion { phase, state, dissipators, .. }, .. } = self;
        if let Phase::Overturned(_) = phase {
            return [[0.0; 2]; 2];
        }
        let mut arc = Arc::default();
        let start = Start { local_error: 1.0, ..model.start(*state, dissipators, load, 1.0) };
        model.level.series(&model.structure, *phase, &start, &mut arc);
        let derivative = |k: i32, factor: f64| {
            [arc.u_dot[k as usize], arc.theta_dot[k as usize]].map(|c| factor * c / arc.span.powi(k))
        };
        [derivative(1, 1.0), derivative(2, 2.0)]
    }
}

/// What an advance has in hand.
struct Hand<'a, L> {
    model: &'a Model,
    /// Its level.
    level: &'a L,
    /// The step.
    arc: &'a mut Arc,
    /// Steps since the start after which it ends.
    last_step: u64,
    /// Whether it ends where a transition is due.
    stops: bool,
}

impl<L: Level> Hand<'_, L> {
    /// [`Engine::advance`] of `now`.
    fn advance<W: Watch>(
        &mut self,
        now: &mut Motion,
        interval: f64,
        load: LinearLoad,
        watch: &mut W,
    ) -> Result<Progress, AdvanceError> {
        if let Some(end) = self.leap(now, &self.model.start(now.state, &now.dissipators, load, interval)) {
            if now.work.steps == self.last_step {
                return Err(AdvanceError::TooLong { time: now.time, until: now.time + interval });
            }
            if W::SEES_PIECES {
                watch.piece(&Piece { before: now, duration: interval, load, end, model: self.model, arc: None });
            }
            now.state = end;
            now.time += interval;
            now.work.steps += 1;
            now.chatter.pass(interval);
            return Ok(Progress::Complete);
        }
        let mut before = None;
        let result = self.step(now, &mut before, interval, load, watch);
        if let (Err(_), Some(before)) = (&result, before) {
            *now = before;
        }
        result
    }

    /// Advances over `interval` (s), step by step. A motion that takes more than one is kept as it was `before`: a step that
    /// fails changes nothing.
    #[inline(always)]
    fn step<W: Watch>(
        &mut self,
        motion: &mut Motion,
        before: &mut Option<Motion>,
        interval: f64,
        load: LinearLoad,
        watch: &mut W,
    ) -> Result<Progress, AdvanceError> {
        let Start { a_g, a_top, a_v, local_error, .. } =
            self.model.start(motion.state, &motion.dissipators, load, interval);
        let start = motion.time;
        let until = start + interval;
        // Time runs from the start of the interval: transitions are then as sharp at t = 1000 s as at 0.
        let mut elapsed = 0.0;
        while elapsed < interval {
            let left = interval - elapsed;
            let begin = Start {
                state: motion.state,
                a_g: a_g.from(elapsed),
                a_top: a_top.from(elapsed),
                a_v: a_v.from(elapsed),
                dissipators: &motion.dissipators,
                interval: left,
                local_error,
            };
            let event = match motion.phase {
                Phase::FullContact => self.step_in_full_contact(begin, motion.chatter.held),
                Phase::Rocking(side) => self.step_while_rocking(&begin, side),
                Phase::Overturned(_) => break,
            };
            let duration = self.arc.duration();
            if !self.arc.is_finite() || self.arc.reach < 1.0 && self.is_at_its_end(motion.phase, motion.state, event) {
                let State { u, theta, .. } = motion.state;
                return Err(AdvanceError::Singular { time: motion.time, u, theta });
            }
            if motion.work.steps == self.last_step {
                return Err(AdvanceError::TooLong { time: motion.time, until });
            }
            if duration < left {
                before.get_or_insert(*motion);
            }
            motion.work.steps += 1;
            motion.work.evaluations += self.arc.order as u64;
            let state = self.arc.end();
            // what lasts for no time, as contact where uplift is due at once, is no motion
            if W::SEES_PIECES && duration > 0.0 {
                let (load, arc) = (load.from(elapsed), Some(&*self.arc));
                watch.piece(&Piece { before: motion, duration, load, end: state, model: self.model, arc });
            }
            if let (Some(angles), Phase::Rocking(side)) = (self.level.ties(), motion.phase) {
                let moved =
                    yielding::moved(&self.model.structure, side, angles, &motion.dissipators, self.arc, self.arc.reach);
                motion.dissipators = moved;
            }
            motion.state = state;
            motion.chatter.pass(duration);
            elapsed = if duration == left { interval } else { elapsed + duration };
            motion.time = if elapsed < interval { start + elapsed } else { until };
            if let Some(event) = event {
                if self.stops && !matches!(event, Event::Overturning(_)) {
                    motion.due = Some(event);
                    return Ok(Progress::Transition);
                }
                watch.transition(&transition::resolve(self.level, &self.model.structure, motion, event));
            }
        }
        match motion.phase {
            Phase::Overturned(_) => Ok(Progress::Overturned),
            _ => Ok(Progress::Complete),
        }
    }

    /// The state at the end of `start` where it is known exactly and no transition can happen until then.
    #[inline]
    fn leap(&mut self, now: &Motion, start: &Start) -> Option<State> {
        if now.chatter.held > 0.0 {
            return None;
        }
        self.level.leap(&self.model.structure, now.phase, start).filter(State::is_finite)
    }

    /// Whether the step in hand, which goes from `state` to less than what was asked for, is the last that there can be.
    fn is_at_its_end(&self, phase: Phase, state: State, event: Option<Event>) -> bool {
        let has_stalled = self.arc.duration() <= STALLED / self.model.structure.omega_u;
        has_stalled && event.is_none() || self.level.is_singular(&self.model.structure, phase, &state)
    }

    /// Motion in full contact, cut at uplift; none of it for the first `held` seconds.
    fn step_in_full_contact(&mut self, mut start: Start, held: f64) -> Option<Event> {
        let is_held = held > 0.0;
        if is_held {
            start.interval = start.interval.min(held);
        }
        self.level.series(&self.model.structure, Phase::FullContact, &start, self.arc);
        if is_held {
            return None;
        }
        let (crossing, side) = self.level.first_uplift(&self.model.structure, &start, self.arc);
        cut(self.arc, crossing, Event::Uplift(side))
    }

    /// Rocking about `side`, cut at impact or overturning.
    fn step_while_rocking(&mut self, start: &Start, side: Side) -> Option<Event> {
        self.level.series(&self.model.structure, Phase::Rocking(side), start, self.arc);
        let mut end = None;
        if let Some(angles) = self.level.ties() {
            let (crossing, event) = yielding::first(&self.model.structure, side, angles, start.dissipators, self.arc);
            end = cut(self.arc, crossing, event);
        }
        if stays_about(self.arc, side) {
            return end;
        }
        match first_overturning(self.arc, side) {
            Crossing::None => (),
            crossing => end = cut(self.arc, crossing, Event::Overturning(side)),
        }
        match first_return(self.arc, side) {
            Crossing::None => end,
            crossing => cut(self.arc, crossing, Event::Impact(side)),
        }
    }
}

/// Ends `arc` at `crossing`; `event` is what happens there.
fn cut(arc: &mut Arc, crossing: Crossing, event: Event) -> Option<Event> {
    match crossing {
        Crossing::None => None,
        Crossing::NoneUntil(sigma) => {
            arc.reach = sigma;
            None
        }
        Crossing::At(sigma) => {
            arc.reach = sigma;
            Some(event)
        }
    }
}

/// Whether the magnitudes of the terms of θ prove that neither guard of rocking about `side` closes on `arc`.
fn stays_about(arc: &Arc, side: Side) -> bool {
    let start = side.sign() * arc.theta[0];
    let excursion = sum_of_magnitudes(&arc.theta[1..=arc.order]);
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
