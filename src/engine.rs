//! The hybrid engine: phase equations → step → guard → transition, repeated to the end of an interval.
//!
//! A step is a Taylor series of the motion ([`crate::series::taylor`]). A step ends at the first transition, at the end of the
//! interval, or where its truncation error reaches the tolerance. [`crate::series::first_crossing`] finds the first transition and
//! cannot step over it. Phases say which guards are watched, and what happens when a guard closes.
//!
//! The number of steps is bounded because the number of transitions is ([`crate::mechanics::impact`]). One advance takes at most one
//! step, plus two steps per transition, plus one step per time 1/Ω. The rate Ω is the largest of ω_u, 2 ζ_u ω_u, 2 ζ_fc ω_fc, p_l
//! and the rates that restraints add. A violent motion takes up to four steps per 1/Ω, and Ω is then the largest of these rates and
//! |θ̇|, |u̇|/ρ and √(|ü|/ρ), where ρ² = (J0 + m0 B²)/m + (sB − u)². Of many masses, ω_u is the highest frequency while rocking, and
//! 2 ζ_u ω_u is the largest 2 ζ ω of the modes times J_P/(J_P − Σ μ h²). One call takes at most [`MAX_STEPS_PER_ADVANCE`] steps. At levels
//! with an exact flow of full contact, one step covers the rest of a long interval once the base stays down for good.

pub(crate) mod contacts;
pub(crate) mod friction;
pub(crate) mod guard;
#[cfg(feature = "lanes")]
pub(crate) mod lanes;
pub mod motion;
pub(crate) mod phases;
pub mod piece;
pub(crate) mod sample;
pub(crate) mod step;
pub mod transition;
pub(crate) mod yielding;

use crate::digits::with_unit;
use crate::levels::detail::Detail;
use crate::levels::level::{Level, derivatives};
use crate::levels::start::Start;
use crate::mechanics::arc::Arc;
use crate::mechanics::contact;
use crate::mechanics::energy::energy;
use crate::mechanics::impact::Chatter;
use crate::mechanics::instant::{Instant, Second};
use crate::mechanics::lateral::{Coordinates, Duals, Lateral};
use crate::mechanics::load::{LOADS, LinearLoad, Load, Ramp};
use crate::mechanics::reactions::{Impulse, Reactions};
use crate::mechanics::restraint::{Dissipators, Restraints, levers, restraints};
use crate::mechanics::state::Properties;
use crate::numbers::dual::Dual;
use crate::series::first_crossing::Crossing;
use crate::structure::mode::Modes;
use crate::structure::quantity::{Quantity, Refused, ensure};
use crate::{Foundation, Output, Phase, State, Structure};
use motion::{Motion, Work};
use phases::Rules;
use piece::{LeapRoom, Piece, Watch};
use sample::{Sample, shown};
use step::{Closed, Step};
use transition::Transition;

/// The default relative tolerance of the results.
pub const DEFAULT_TOLERANCE: f64 = 1e-9;

/// Part of the tolerance that one step may use up. Impacts amplify an error by orders of magnitude over a record, and a
/// series pays for each with only one more coefficient or so.
const LOCAL_SHARE: f64 = 1e-5;

/// The largest truncation error of a step, however loose the tolerance is: ten times the relative change of 1e-12 in the input
/// by which conditioning is judged. If such a change moves an answer by less than a tenth of the tolerance, the answer is within
/// the tolerance, although impacts amplify the change by 1e8. In 492 random scenes at a tolerance of 1e-3, a bound of 1e-10 saves 7 %
/// of the evaluations, a bound of 1e-9 saves 15 % and lets one scene exceed its tolerance (tests/tolerance.rs with COUNT=500).
const LARGEST_LOCAL_ERROR: f64 = 1e-11;

/// Steps that one advance may take: a second or two of computing, or some ten seconds of a motion so violent that every step is
/// searched for transitions throughout. A longer interval has to be cut.
pub const MAX_STEPS_PER_ADVANCE: u64 = 2_000_000;

/// Polynomials that watchers may ask for of one leap, whose number no step counts: seconds of computing, for buildings ten or more.
pub const MOST_POLYNOMIALS: u64 = 200_000;

/// An interval longer than FAR/ω_fc is advanced in parts, because the structure may come to rest long before its end.
const FAR: f64 = 1000.0;

/// If a step ends without a transition and is shorter than this part of 1/ω_u, the solution ends there.
const STALLED: f64 = 1e-12;

/// Whether `tolerance` is a relative tolerance of results.
pub fn check_tolerance(tolerance: f64) -> Result<(), Refused> {
    ensure(tolerance > 0.0 && tolerance < 1.0, || {
        format!("tolerance = {} is out of range: it must be between 0 and 1, such as 1e-9", with_unit(tolerance, "1"))
    })
}

/// How far an advance came.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Progress {
    /// To the end of the interval.
    Complete,
    /// To the instant of overturning, at which the motion's time stays.
    Overturned,
    /// To the instant at which another transition is due, if the engine stops there ([`Settings::stops`]).
    Transition,
}

/// The reason why an advance failed. The motion is then as before the advance, whatever has been shown on the way.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs)] // the messages name the fields
pub enum AdvanceError {
    /// An interval or a load that no motion can follow.
    #[error(transparent)]
    Refused(#[from] Refused),
    /// Too many steps for one call.
    #[error(
        "the {MAX_STEPS_PER_ADVANCE} steps of an advance end by t = {} of {}: advance in shorter intervals",
        with_unit(*time, "s"),
        with_unit(*until, "s")
    )]
    TooLong { time: f64, until: f64 },
    /// Watchers asked for too many polynomials of an interval that the engine leapt over.
    #[error(
        "the vibration from t = {} to {} does not die away, and its peaks, validity or picture take more than {MOST_POLYNOMIALS} \
         series: give a shorter time or damping",
        with_unit(*time, "s"),
        with_unit(*until, "s")
    )]
    TooManyPolynomials { time: f64, until: f64 },
    /// The equations have no finite solution from here on.
    #[error(
        "the motion cannot be continued beyond t = {} (u = {}, theta = {}): the mass passes above the pivot of a \
         foundation without inertia (m0, J0 too small), or the numbers overflow",
        with_unit(*time, "s"),
        with_unit(*u, "m"),
        with_unit(*theta, "rad")
    )]
    Singular { time: f64, u: f64, theta: f64 },
}

impl AdvanceError {
    /// The instant beyond which the motion cannot continue, s, if the instant lies within the interval.
    pub fn time(&self) -> Option<f64> {
        match *self {
            AdvanceError::TooLong { time, .. }
            | AdvanceError::TooManyPolynomials { time, .. }
            | AdvanceError::Singular { time, .. } => Some(time),
            AdvanceError::Refused(_) => None,
        }
    }
}

/// The task of an engine.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Settings {
    /// Level of detail.
    pub detail: Detail,
    /// Relative tolerance of the results.
    pub tolerance: f64,
    /// Whether the ground may move vertically.
    pub vertical: bool,
    /// Whether an advance ends at the first transition except overturning, before the transition: [`Engine::transit`] applies it,
    /// or the next advance.
    pub stops: bool,
}

impl Default for Settings {
    fn default() -> Settings {
        Settings { detail: Detail::Auto, tolerance: DEFAULT_TOLERANCE, vertical: false, stops: false }
    }
}

impl Settings {
    /// The level of detail at which `structure` moves that is turned by `theta` (rad).
    fn level<Q: Coordinates>(self, kind: &Kind<Q>, structure: Structure, theta: f64) -> LevelOrNot<Q> {
        check_tolerance(self.tolerance)?;
        let local_error = (LOCAL_SHARE * self.tolerance).clamp(f64::EPSILON / 2.0, LARGEST_LOCAL_ERROR);
        let level = (kind.level)(self.detail, structure, local_error, self.vertical)?;
        ensure(self.detail.has_uplift() || theta == 0.0, || {
            format!(
                "theta_0 = {theta:?} rad contradicts detail = fixed_base, where the base cannot turn: set theta_0 to 0"
            )
        })?;
        Ok(level)
    }
}

/// Advances an engine, whose motion `before` is kept, by an interval (s) under a load until a last step.
type GoOn<Q> = fn(
    &mut Engine<Q>,
    &mut Option<Motion<Q>>,
    (f64, LinearLoad<Q>, u64),
    &mut dyn Watch<Q>,
) -> Result<Progress, AdvanceError>;

type LevelOrNot<Q> = Result<Box<dyn Level<Q>>, Refused>;

/// The functions of structures with the coordinates `Q` that are compiled here alone: a generic function would be compiled again in every
/// crate that follows runs.
#[derive(Debug)]
struct Kind<Q: Coordinates> {
    level: fn(Detail, Structure, f64, bool) -> LevelOrNot<Q>,
    watched: fn(&Structure, &Motion<Q>) -> Option<&'static Rules<Q>>,
    advance: GoOn<Q>,
}

static ONE: Kind<f64> = Kind { level: Detail::level_of_one, watched: phases::of, advance: Engine::go_on_by_steps };
static MANY: Kind<Modes> = Kind { level: Detail::level_of_modes, watched: phases::of, advance: Engine::go_on_by_steps };

/// A structure in motion.
#[derive(Debug)]
pub struct Engine<Q: Coordinates = f64> {
    kind: &'static Kind<Q>,
    level: Box<dyn Level<Q>>,
    /// The structure that the level moves, at hand without a call.
    structure: Structure,
    settings: Settings,
    motion: Motion<Q>,
    /// The step in hand.
    arc: Arc<Q>,
    room: LeapRoom<Q>,
}

impl Engine {
    /// Starts at `time` (s) from `initial`, to a relative `tolerance` of the results, at the level of detail `auto`.
    pub fn new(structure: impl Into<Structure>, initial: State, time: f64, tolerance: f64) -> Result<Engine, Refused> {
        Engine::with(structure, initial, time, Settings { tolerance, ..Settings::default() })
    }

    /// Starts at `time` (s) from `initial`. The dissipators of a structure that starts turned have been moved there slowly from
    /// rest; the energy that they took on the way is not counted.
    pub fn with(
        structure: impl Into<Structure>,
        initial: State,
        time: f64,
        settings: Settings,
    ) -> Result<Engine, Refused> {
        let phase = initial.initial_phase()?;
        let level = settings.level(&ONE, structure.into(), initial.theta)?;
        let State { u, u_dot, .. } = initial;
        ensure(settings.detail.has_strut() || (u, u_dot) == (0.0, 0.0), || {
            format!(
                "u_0 = {u:?} m, u_dot_0 = {u_dot:?} m/s contradict detail = rigid, where u is always 0: set both to 0"
            )
        })?;
        Ok(Engine::start(&ONE, level, settings, time, initial, phase))
    }
}

impl Engine<Modes> {
    /// Starts the structure `frame` of many masses at `time` (s) from `state`, at any level of detail but `modal`. At the level `rigid`
    /// the structure that moves has no modes. Of dissipators see [`Engine::with`].
    pub fn of_modes(
        frame: Structure,
        state: State<Modes>,
        time: f64,
        settings: Settings,
    ) -> Result<Engine<Modes>, Refused> {
        // coordinates of modes have no limits, but are numbers
        let [u, u_dot] = [&state.u, &state.u_dot].map(|numbers| 0.0 * numbers.total());
        let phase = State { u, u_dot, theta: state.theta, theta_dot: state.theta_dot }.initial_phase()?;
        let more = frame.foundation().map_or(0, Foundation::coordinates);
        let level = settings.level(&MANY, frame, state.theta)?;
        let (State { u, u_dot, .. }, modes) = (state, level.structure().modes().len());
        for numbers in [u, u_dot] {
            let given = numbers.count;
            ensure(given == modes || given == modes + more || numbers.is_within(&Modes::ZERO), || {
                format!(
                    "the initial state has {given} coordinates, and {modes} modes move: give one coordinate for each, or 0 for all"
                )
            })?;
        }
        let of_frame = |numbers: Modes| Modes::each(level.structure(), |j, _| numbers.of(j));
        let state = State { u: of_frame(u), u_dot: of_frame(u_dot), ..state };
        let (ground, base) = (level.structure().foundation().cloned(), *level.structure().base());
        let mut engine = Engine::start(&MANY, level, settings, time, state, phase);
        if let Some(ground) = ground {
            let state = ground.begin(&state, &base);
            let (dissipators, settled) = (ground.moved(&state, &base), ground.settled(&state));
            let phase = Phase::OnGround(ground.contact(&state, &settled, &base));
            engine.motion = Motion { state, phase, dissipators, settled, ..engine.motion };
        }
        Ok(engine)
    }

    /// Mechanical energy now, J.
    pub fn energy(&self) -> f64 {
        let Motion { phase, state, .. } = &self.motion;
        match phase {
            Phase::OnGround(pressed) => contact::energy(self.structure(), *pressed, state, self.motion.kept()),
            Phase::FullContact | Phase::Rocking(_) | Phase::Overturned(_) => energy(self.structure(), *phase, state),
        }
    }
}

impl<Q: Coordinates> Engine<Q> {
    /// The engine of a structure that starts in `phase`, its dissipators moved there slowly from rest.
    fn start(
        kind: &'static Kind<Q>,
        level: Box<dyn Level<Q>>,
        settings: Settings,
        time: f64,
        state: State<Q>,
        phase: Phase,
    ) -> Engine<Q> {
        let subject = level.subject();
        let (base, chord) = (subject.structure.base(), subject.detail.angles().chord(state.theta, 0.0).length);
        let moved = Dissipators::NEW.moved_to(base, |j| levers(base, phase.side())[j] * chord);
        let motion = Motion {
            time,
            state,
            phase,
            transitions: 0,
            work: Work::default(),
            impulse: Impulse::default(),
            dissipators: Dissipators { hysteretic: 0.0, ..moved },
            settled: Q::Settled::default(),
            chatter: Chatter::NONE,
            due: None,
        };
        Engine::of(kind, level, settings, motion)
    }

    fn of(kind: &'static Kind<Q>, level: Box<dyn Level<Q>>, settings: Settings, motion: Motion<Q>) -> Engine<Q> {
        let structure = level.structure().clone();
        Engine { kind, level, structure, settings, motion, arc: Arc::default(), room: LeapRoom::default() }
    }

    /// The same structure in the same motion, with other `settings`.
    pub fn remade(&self, settings: Settings) -> Result<Engine<Q>, Refused> {
        let level = settings.level(self.kind, self.structure.clone(), self.motion.state.theta)?;
        Ok(Engine::of(self.kind, level, settings, self.motion))
    }

    /// Whether certainly no transition comes within `ahead` (s), a tiny time, under `load`.
    pub fn goes_on_for(&self, ahead: f64, load: LinearLoad<Q>) -> bool {
        let now = self.sample(load.value);
        self.watched().is_none_or(|watched| watched.guards.iter().all(|guard| guard.stays_open(&now, ahead)))
    }

    /// The values of outputs now under `load`; once overturned, the values of the instant before.
    #[inline]
    pub fn outputs(&self, load: Load<Q>) -> impl Fn(Output) -> f64 {
        // a sample would copy the motion
        let Motion { phase, state, .. } = &self.motion;
        let kept = self.motion.kept();
        let x = shown::<Q>(&*self.level, phase.in_motion(self.structure()), (state, load), kept);
        move |output| output.in_motion(&x, kept)
    }

    /// Time derivatives now under `load`, from the equations of motion; 0 once overturned. The derivatives at a transition are taken
    /// just after the transition.
    pub fn rates(&self, load: LinearLoad<Q>) -> Rates<'_, Q> {
        let (Motion { phase, state, .. }, kept) = (&self.motion, self.motion.kept());
        let is_over = phase.properties().is_over;
        let none = Second { u_ddot: Q::each(self.structure(), |_, _| 0.0), theta_ddot: 0.0 };
        let [second, third] = match is_over {
            true => [none; 2],
            false => derivatives(&*self.level, *phase, (state, kept, load), &mut Arc::default()),
        };
        let state = self.level.admissible(*phase, *state);
        let x = Instant::moving(self.structure(), *phase, &state, &second, load);
        let x = Instant { settled: kept.1, ..x };
        let u_ddot = Duals { value: second.u_ddot, rate: third.u_ddot };
        let theta_ddot = Dual { value: second.theta_ddot, rate: third.theta_ddot };
        Rates { x, second: Second { u_ddot, theta_ddot }, is_over }
    }

    /// Rates of the forces of the restraints now under `load`, N/s; 0 once overturned.
    pub fn restraint_rates(&self, load: Load<Q>) -> Restraints {
        let Motion { phase, state, dissipators, .. } = &self.motion;
        if phase.properties().is_over {
            return Restraints::default();
        }
        let (second, angles) = (self.sample(load).second(), self.level.subject().detail.angles());
        let x = Instant::moving(self.structure(), *phase, state, &second, load.into());
        let Restraints { P_t, F_d1, F_d2 } = restraints(&x, angles, dissipators);
        Restraints { P_t: P_t.rate, F_d1: F_d1.rate, F_d2: F_d2.rate }
    }

    /// The structure.
    pub fn structure(&self) -> &Structure {
        &self.structure
    }

    /// Whether the structure, in full contact now, stays there while nothing acts on it.
    pub fn stays_down(&self) -> bool {
        let Motion { phase, state, .. } = &self.motion;
        !phase.properties().rotates && self.level.stays_down(state, self.motion.kept())
    }

    /// The motion now, under `load`.
    pub fn sample(&self, load: Load<Q>) -> Sample<'_, Q> {
        Sample { motion: self.motion, load, level: &*self.level }
    }

    /// The settings of the engine.
    pub fn settings(&self) -> Settings {
        self.settings
    }

    /// The motion now.
    pub fn motion(&self) -> &Motion<Q> {
        &self.motion
    }

    /// Whether the structure has the phase of this `motion`, which may come from bytes.
    pub fn admits(&self, motion: &Motion<Q>) -> bool {
        let (ground, Properties { is_over, is_down, .. }) =
            (Q::foundation(self.structure()), motion.phase.properties());
        match motion.phase {
            Phase::OnGround(of) => ground.is_some_and(|ground| ground.admits(of)),
            _ if is_over => true,
            _ => ground.is_none() && (is_down || self.settings.detail.has_uplift()),
        }
    }

    /// Puts the structure in this `motion`.
    pub fn set_motion(&mut self, motion: Motion<Q>) {
        self.motion = motion;
    }

    /// Sets whether an advance ends at the first transition ([`Settings::stops`]).
    pub fn set_stops(&mut self, stops: bool) {
        self.settings.stops = stops;
    }

    /// Sets the clock to `time` (s). Nothing but the times that the engine reports depends on it.
    pub fn set_time(&mut self, time: f64) {
        self.motion.time = time;
    }

    /// The guards of the present phase; none once the structure has overturned.
    pub(crate) fn watched(&self) -> Option<&'static Rules<Q>> {
        (self.kind.watched)(self.structure(), &self.motion)
    }

    /// Applies the transition that is due, if there is one, and shows it to `watch`.
    pub fn transit<W: Watch<Q> + ?Sized>(&mut self, watch: &mut W) {
        if let Some(transition) = transit(&*self.level, self.watched(), &mut self.motion) {
            watch.transition(&transition);
        }
    }

    /// Advances by `interval` (s) under `load`, which is given from the present time on. Every piece and every
    /// transition on the way is shown to `watch`, once.
    pub fn advance<W: Watch<Q>>(
        &mut self,
        interval: f64,
        load: impl Into<LinearLoad<Q>>,
        watch: &mut W,
    ) -> Result<Progress, AdvanceError> {
        self.advance_within(self.motion.work.steps + MAX_STEPS_PER_ADVANCE, interval, load.into(), watch)
    }

    /// As [`Engine::advance`], but fails as too long if the motion needs more than `last_step` steps since its start.
    #[inline]
    pub fn advance_within<W: Watch<Q>>(
        &mut self,
        last_step: u64,
        interval: f64,
        load: LinearLoad<Q>,
        watch: &mut W,
    ) -> Result<Progress, AdvanceError> {
        self.check(interval, &load)?;
        let mut before = None;
        if self.motion.due.is_some() {
            before = Some(self.motion);
            self.transit(watch);
        }
        // most advances are one leap
        let leapt = (self.motion.work.steps != last_step).then(|| self.leap(interval, load, watch)).flatten();
        let result = match leapt {
            Some(Ok(())) => {
                self.motion.time += interval;
                return Ok(Progress::Complete);
            }
            Some(Err(error)) => Err(error),
            None => (self.kind.advance)(self, &mut before, (interval, load, last_step), watch),
        };
        if let (Err(_), Some(before)) = (&result, before) {
            self.motion = before;
        }
        result
    }

    /// Takes the motion, all but its time, over `interval` (s) in one leap, if there is such a leap.
    #[inline(always)]
    fn leap<W: Watch<Q>>(
        &mut self,
        interval: f64,
        load: LinearLoad<Q>,
        watch: &mut W,
    ) -> Option<Result<(), AdvanceError>> {
        let Engine { level, motion, room, .. } = self;
        let end = leap_under(&**level, motion, interval, load)?;
        Some(leapt((&**level, room), motion, interval, load, end, watch))
    }

    /// Advances step by step.
    fn go_on_by_steps(
        &mut self,
        before: &mut Option<Motion<Q>>,
        (interval, load, last_step): (f64, LinearLoad<Q>, u64),
        watch: &mut dyn Watch<Q>,
    ) -> Result<Progress, AdvanceError> {
        let Engine { level, motion, arc, room, settings: Settings { stops, .. }, .. } = self;
        let (level, stops) = (&**level, *stops);
        let expand = |phase: Phase, start: &Start<Q>, arc: &mut Arc<Q>| {
            level.series(phase, start, arc);
            true
        };
        let mut advance = Advance::new(level.structure(), motion.time, interval, load, last_step);
        let progress = Loop { level, expand, arc, room, stops }.go(motion, before, &mut advance, watch)?;
        Ok(progress.expect("every series is there"))
    }

    /// Whether `load` can act over `interval` (s).
    #[inline]
    pub(crate) fn check(&self, interval: f64, load: &LinearLoad<Q>) -> Result<(), AdvanceError> {
        let is_ahead = interval > 0.0 && interval <= f64::MAX;
        let is_admitted = is_ahead && load.is_finite_over(interval) && (!load.is_vertical() || self.settings.vertical);
        if is_admitted { Ok(()) } else { self.refusal(interval, load) }
    }

    /// The reason why `load` cannot act over `interval` (s).
    #[cold]
    fn refusal(&self, interval: f64, load: &LinearLoad<Q>) -> Result<(), AdvanceError> {
        let over = with_unit(interval, "s");
        ensure(interval > 0.0 && interval <= f64::MAX, || {
            let from = with_unit(self.motion.time, "s");
            format!("cannot advance from t = {from} over {over}: a finite time greater than 0 is needed")
        })?;
        let Ramp { value, slope } = load.upwards();
        ensure(self.settings.vertical || (value, slope) == (0.0, 0.0), || {
            let value = with_unit(value, "m/s2");
            format!("a_v = {value} with slope {slope:?} m/s3: this structure was to be shaken horizontally alone")
        })?;
        let [end, value, slope] = [load.at(interval), load.value, load.slope].map(|load| Load {
            a_g: load.a_g,
            F_t: load.F_t.total(),
            a_v: load.a_v,
        });
        for &Quantity { name, unit, get, .. } in &LOADS {
            ensure(get(&end).is_finite(), || {
                let [value, slope] = [&value, &slope].map(|load| with_unit(get(load), unit));
                format!("{name} = {value} with slope {slope}/s is not finite over {over}: give finite loads")
            })?;
        }
        Ok(())
    }
}

/// Time derivatives of outputs and reactions.
#[derive(Debug)]
pub struct Rates<'a, Q: Coordinates = f64> {
    x: Instant<'a, Dual<f64>, Duals<Q>>,
    second: Second<Dual<f64>, Duals<Q>>,
    /// Whether the structure has overturned, after which nothing changes.
    is_over: bool,
}

impl<Q: Coordinates> Rates<'_, Q> {
    /// The rate of `output`.
    #[inline(never)]
    pub fn of(&self, output: Output) -> f64 {
        let Rates { x, ref second, is_over } = *self;
        let rate = || output.added_up_rate(&x).unwrap_or_else(|| output.of(&x.accelerated(second)).rate);
        if is_over { 0.0 } else { rate() }
    }

    /// The rates of the reactions.
    #[inline(never)]
    pub fn reactions(&self) -> Reactions {
        let of = |of: Dual<f64>| if self.is_over { 0.0 } else { of.rate };
        let Reactions { R_h, R_v, R_m } = Reactions::at(&self.x, &self.second);
        Reactions { R_h: of(R_h), R_v: of(R_v), R_m: of(R_m) }
    }
}

/// Applies the transition that is due in `motion`, if there is one, in the phase that is `watched`.
fn transit<Q: Coordinates>(
    level: &dyn Level<Q>,
    watched: Option<&Rules<Q>>,
    motion: &mut Motion<Q>,
) -> Option<Transition<Q>> {
    let (Closed { guard, branch }, before) = (motion.due.take()?, motion.state);
    let kind = watched?.guards.get(usize::from(guard))?.apply(level, motion, branch)?;
    motion.transitions += 1;
    Some(Transition { time: motion.time, kind, before, after: motion.state })
}

/// The state after `interval` (s) of `motion` under `load`, if it is known exactly and no transition can happen until then.
#[inline(always)]
fn leap_under<Q: Coordinates>(
    level: &dyn Level<Q>,
    motion: &Motion<Q>,
    interval: f64,
    load: LinearLoad<Q>,
) -> Option<State<Q>> {
    // no level leaps on ground that gives, where a step need not be made ready in vain
    if motion.chatter.held > 0.0 || !motion.phase.properties().may_leap {
        return None;
    }
    let start = level.subject().start(motion.state, motion.kept(), load, interval);
    level.leap(motion.phase, &start).filter(State::is_finite)
}

/// Takes `motion`, all but its time, over a leap to the state `end`. Fails if watchers need too many polynomials of the leap.
#[inline(always)]
fn leapt<Q: Coordinates, W: Watch<Q> + ?Sized>(
    (level, room): (&dyn Level<Q>, &LeapRoom<Q>),
    motion: &mut Motion<Q>,
    duration: f64,
    load: LinearLoad<Q>,
    end: State<Q>,
    watch: &mut W,
) -> Result<(), AdvanceError> {
    if watch.sees_pieces() {
        room.left.set(MOST_POLYNOMIALS);
        watch.piece(&Piece { before: motion, duration, load, end, level, arc: None, room });
        if room.left.get() == 0 {
            return Err(AdvanceError::TooManyPolynomials { time: motion.time, until: motion.time + duration });
        }
    }
    motion.state = end;
    motion.work.steps += 1;
    motion.chatter.pass(duration);
    Ok(())
}

/// An advance on its way.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Advance<Q> {
    /// Its start and its end, s.
    start: f64,
    until: f64,
    interval: f64,
    load: LinearLoad<Q>,
    /// Steps since the start of the motion after which the advance ends.
    last_step: u64,
    /// Seconds since the start: time runs from there, so that transitions are as sharp at t = 1000 s as at 0.
    elapsed: f64,
    /// The end of the present part, s since the start, and the duration of the next part, s.
    end: f64,
    part: f64,
}

impl<Q: Coordinates> Advance<Q> {
    #[inline(always)]
    fn new(structure: &Structure, start: f64, interval: f64, load: LinearLoad<Q>, last_step: u64) -> Advance<Q> {
        let part = FAR / structure.vibration().contact;
        let end = if interval > part { 0.0 } else { interval };
        Advance { start, until: start + interval, interval, load, last_step, elapsed: 0.0, end, part }
    }

    /// Passes `duration` (s) and returns the time.
    #[inline(always)]
    fn pass(&mut self, duration: f64) -> f64 {
        let is_all = duration == self.end - self.elapsed;
        self.elapsed = if is_all { self.end } else { self.elapsed + duration };
        if self.elapsed < self.interval { self.start + self.elapsed } else { self.until }
    }
}

/// The loop over the steps of one advance.
struct Loop<'a, Q: Coordinates, E> {
    level: &'a dyn Level<Q>,
    /// Writes the series of a step, or says that the series is not there yet.
    expand: E,
    /// The step.
    arc: &'a mut Arc<Q>,
    room: &'a LeapRoom<Q>,
    /// Whether the advance ends where a transition is due.
    stops: bool,
}

impl<Q: Coordinates, E: FnMut(Phase, &Start<Q>, &mut Arc<Q>) -> bool> Loop<'_, Q, E> {
    /// Goes on with `advance` step by step: expands the motion, finds the first guard that closes, applies its transition. A long
    /// interval is taken in parts, each twice as long as the one before, until the rest is one leap. The motion `before` the first
    /// change is kept: an advance that fails changes nothing. Returns none where a series is not there yet.
    #[inline(never)]
    fn go(
        &mut self,
        motion: &mut Motion<Q>,
        before: &mut Option<Motion<Q>>,
        on_the_way: &mut Advance<Q>,
        watch: &mut dyn Watch<Q>,
    ) -> Result<Option<Progress>, AdvanceError> {
        let level = self.level;
        let mut advance = *on_the_way; // in registers
        let Advance { until, interval, load, last_step, .. } = advance;
        let Start { a_g, a_top, a_v, local_error, .. } =
            level.subject().start(motion.state, motion.kept(), load, interval);
        loop {
            let Some(watched) = phases::of(level.structure(), motion) else { return Ok(Some(Progress::Overturned)) };
            let Advance { elapsed, part, .. } = advance;
            if elapsed >= interval {
                return Ok(Some(Progress::Complete));
            }
            if elapsed >= advance.end {
                if elapsed > 0.0 {
                    let reached = level.longest_step() * last_step.saturating_sub(motion.work.steps) as f64;
                    if interval - elapsed > reached {
                        return Err(AdvanceError::TooLong { time: motion.time + reached, until });
                    }
                }
                before.get_or_insert_with(|| *motion);
                advance.end = if elapsed + part < interval { elapsed + part } else { interval };
                advance.part *= 2.0;
                let load = load.from(elapsed);
                let leap = |to: f64| Some((to, leap_under(level, motion, to - elapsed, load)?));
                if let Some((to, state)) = leap(interval).or_else(|| leap(advance.end)) {
                    advance.end = to;
                    leapt((level, self.room), motion, to - elapsed, load, state, watch)?;
                    motion.time = advance.pass(to - elapsed);
                    continue;
                }
            }
            let left = advance.end - elapsed;
            let begin = Start {
                state: motion.state,
                a_g: a_g.from(elapsed),
                a_top: a_top.from(elapsed),
                a_v: a_v.from(elapsed),
                dissipators: &motion.dissipators,
                settled: Q::settlements(&motion.settled),
                interval: watched.lasts.map_or(left, |lasts| left.min(lasts(motion))),
                local_error,
            };
            if !(self.expand)(motion.phase, &begin, self.arc) {
                *on_the_way = advance;
                return Ok(None);
            }
            let (side, contact) = (motion.side(), motion.phase.contact());
            let mut step =
                Step { level, side, contact, start: &begin, arc: self.arc, reach: self.arc.reach, is_cut: false };
            let closed = first(watched, &mut step);
            let (reach, (moved, settled)) = (step.reach, (watched.moved)(&step));
            self.arc.reach = reach;
            let duration = self.arc.duration();
            let has_stalled = || closed.is_none() && duration <= STALLED / level.structure().vibration().rocking[1];
            let is_at_its_end = || has_stalled() || level.is_singular(motion.phase, &motion.state);
            if !self.arc.is_finite() || reach < 1.0 && is_at_its_end() {
                let (State { u, theta, .. }, structure) = (motion.state, level.structure());
                let u = Q::sum(structure, |j, mode| mode.gamma * u.of(j)) / structure.body().m_s;
                return Err(AdvanceError::Singular { time: motion.time, u, theta });
            }
            if motion.work.steps == last_step {
                return Err(AdvanceError::TooLong { time: motion.time, until });
            }
            if duration < left {
                before.get_or_insert_with(|| *motion);
            }
            motion.work.steps += 1;
            motion.work.evaluations += self.arc.order as u64;
            let state = self.arc.end();
            // a step without duration, as in contact if uplift is due at once, is no motion
            if watch.sees_pieces() && duration > 0.0 {
                let (load, arc) = (load.from(elapsed), Some(&*self.arc));
                let room = self.room;
                watch.piece(&Piece { before: motion, duration, load, end: state, level, arc, room });
            }
            motion.state = state;
            if let Some(moved) = moved {
                motion.dissipators = moved;
            }
            if let Some(settled) = settled {
                motion.settled = settled;
            }
            motion.chatter.pass(duration);
            motion.time = advance.pass(duration);
            motion.due = closed;
            if let Some(Closed { guard, .. }) = closed {
                if self.stops && watched.guards[usize::from(guard)].is_stop() {
                    return Ok(Some(Progress::Transition));
                }
                transit(level, Some(watched), motion).iter().for_each(|transition| watch.transition(transition));
            }
        }
    }
}

/// The first guard of `watched` that closes on `step`, which is cut there.
#[inline]
pub(crate) fn first<Q: Coordinates>(watched: &Rules<Q>, step: &mut Step<Q>) -> Option<Closed> {
    if watched.stays.is_some_and(|stays| stays(step)) {
        return None;
    }
    let mut closed = None;
    for (place, guard) in watched.guards.iter().enumerate() {
        let (crossing, branch) = guard.first(step);
        if crossing != Crossing::None {
            (step.reach, step.is_cut) = (crossing.sigma(), true);
            closed = matches!(crossing, Crossing::At(_)).then_some(Closed { guard: place as u8, branch });
        }
    }
    closed
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{OneMass, Parameters};

    /// Truncation below rounding would be work without an effect.
    #[test]
    fn a_step_is_no_more_exact_than_rounding() {
        let structure = OneMass::new(Parameters::EVISON).unwrap();
        let of =
            |tolerance| Engine::new(structure, State::default(), 0.0, tolerance).unwrap().level.subject().local_error;
        assert_eq!([1e-15, 1e-9, 0.1].map(of), [0.5 * f64::EPSILON, LOCAL_SHARE * 1e-9, LARGEST_LOCAL_ERROR]);
    }
}
