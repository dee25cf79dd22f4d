//! A run on its way to its end.

use crate::digits::with_unit;
use crate::engine::{AdvanceError, DEFAULT_TOLERANCE, Settings};
use crate::mechanics::lateral::Coordinates;
use crate::run::ground_motion::{Segment, Segments};
use crate::run::record::Record;
use crate::structure::quantity::{Refused, ensure};
use crate::{Detail, Engine, LinearLoad, Load, Modes, Motion, Progress, State, Structure, Watch};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;
use std::fmt;
use std::iter::repeat_n;

/// For how long a structure may rock on after its record, in units of 1/p_l: amplitudes change by e^±1 in each.
pub const LONGEST_REST: f64 = 100.0;

/// Steps that a run may take: half a minute to five minutes of computing. The pier of README takes some thousands.
pub const MOST_STEPS: u64 = 5_000_000;

/// A structure under a ground motion, and how the engine follows it.
#[derive(Clone, Debug)]
pub struct Run<'a, Q: Coordinates = f64> {
    /// The structure.
    pub structure: Structure,
    /// The ground motion.
    pub ground: &'a Record,
    /// State at the first sample.
    pub initial: State<Q>,
    /// Level of detail.
    pub detail: Detail,
    /// Relative tolerance of the results.
    pub tolerance: f64,
    /// End of the run, unless the structure overturns.
    pub end: End,
}

/// When a run ends.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum End {
    /// When the record is over, the structure stands in full contact with its energy too small to lift it, and has
    /// vibrated there for a period (2π/p_l without vibration): all that follows is smaller. It is given [`LONGEST_REST`] to come down.
    AtRest,
    /// At this time, s. After the record the ground is at rest.
    At(f64),
}

/// How a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Ending {
    /// The structure stands, and will.
    #[serde(rename = "at rest")]
    AtRest,
    /// |θ| reached π/2.
    #[serde(rename = "overturned")]
    Overturned,
    /// The time asked for was over.
    #[serde(rename = "at time")]
    AtTime,
    /// It still rocked [`LONGEST_REST`] after the record: what becomes of it is not known.
    #[serde(rename = "still rocking")]
    StillRocking,
}

impl Ending {
    /// Whether the structure overturned; None if the run ended before this was certain.
    pub fn overturned(self) -> Option<bool> {
        (self != Ending::StillRocking).then_some(self == Ending::Overturned)
    }
}

impl fmt::Display for Ending {
    /// As it is called in files.
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        self.serialize(out)
    }
}

/// End of a run.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Finish<Q: Coordinates = f64> {
    /// How it ended.
    pub ending: Ending,
    /// The motion then.
    pub motion: Motion<Q>,
}

/// Why there is no result.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[allow(missing_docs)] // the messages name the fields
pub enum RunError {
    /// The run cannot start.
    #[error(transparent)]
    Refused(#[from] Refused),
    /// It takes more steps than one of its segments may.
    #[error("the steps of the run end by t = {} of {}: {advice}", with_unit(*time, "s"), with_unit(*until, "s"))]
    TooLong { time: f64, until: f64, advice: String },
    /// The run takes more than [`MOST_STEPS`].
    #[error("the run used up its {MOST_STEPS} steps at t = {}: {advice}", with_unit(*time, "s"))]
    TooManySteps { time: f64, advice: String },
    /// It takes more points than a curve may have.
    #[error(
        "a picture of the run needs more than {most} points, which end at t = {}; give it a shorter duration",
        with_unit(*time, "s")
    )]
    TooManyPoints { most: usize, time: f64 },
    /// The run cannot go on.
    #[error("{cause}")]
    Advance { time: f64, cause: AdvanceError },
}

impl RunError {
    /// Instant at which a run that had begun failed, s.
    pub fn time(&self) -> Option<f64> {
        match self {
            RunError::Advance { time, .. } | RunError::TooLong { time, .. } | RunError::TooManySteps { time, .. } => {
                Some(*time)
            }
            RunError::Refused(_) | RunError::TooManyPoints { .. } => None,
        }
    }
}

impl<'a> Run<'a> {
    /// Of `structure` under `ground` from rest, at the level of detail `auto` to the default tolerance, until nothing
    /// more can happen.
    pub fn new(structure: impl Into<Structure>, ground: &'a Record) -> Run<'a> {
        Run::from_rest(structure.into(), ground)
    }
}

impl<'a> Run<'a, Modes> {
    /// Of the structure `frame` of many masses under `ground` from rest, like [`Run::new`].
    pub fn of_modes(frame: Structure, ground: &'a Record) -> Run<'a, Modes> {
        Run::from_rest(frame, ground)
    }
}

impl<'a, Q: Coordinates> Run<'a, Q> {
    fn from_rest(structure: Structure, ground: &'a Record) -> Run<'a, Q> {
        let u = Q::parts(&structure, 0.0);
        let initial = State { u, u_dot: u, theta: 0.0, theta_dot: 0.0 };
        let (detail, tolerance, end) = (Detail::Auto, DEFAULT_TOLERANCE, End::AtRest);
        Run { structure, ground, initial, detail, tolerance, end }
    }

    /// The same structure on a fixed base, from rest under the same ground motion until `end` (s).
    pub fn on_fixed_base(&self, end: f64) -> Run<'a, Q> {
        let (detail, tolerance, end) = (Detail::FixedBase, self.tolerance, End::At(end));
        Run { detail, tolerance, end, ..Run::from_rest(self.structure.clone(), self.ground) }
    }
}

/// Coordinates of structures that a run starts.
pub trait Starts: Coordinates {
    /// Starts an engine.
    #[doc(hidden)]
    const START: Starter<Self>;
}

impl Starts for f64 {
    const START: Starter<f64> = Engine::with;
}

impl Starts for Modes {
    const START: Starter<Modes> = Engine::of_modes;
}

/// Starts a structure at a time (s) from a state.
type Starter<Q> = fn(Structure, State<Q>, f64, Settings) -> Result<Engine<Q>, Refused>;

impl<'a, Q: Starts> Run<'a, Q> {
    /// The run before its start.
    pub(super) fn course(&self) -> Result<Follower<Q, Segments<'a>>, RunError> {
        let until = match self.end {
            End::AtRest => self.ground.end(),
            End::At(end) => end,
        };
        let segments = self.ground.segments(until - self.ground.start());
        Ok(Follower { engine: self.start()?, segments, end: self.end, rest: LONGEST_REST })
    }

    /// The structure at the first sample.
    pub(super) fn start(&self) -> Result<Engine<Q>, RunError> {
        let start = self.ground.start();
        if let End::At(end) = self.end {
            ensure(end > start && end.is_finite(), || {
                format!(
                    "the run cannot end at {end:?} s: a finite time after the record's first sample, at {start:?} s, is needed"
                )
            })?;
        }
        ensure(self.ground.force().is_none() || !self.structure.floors().is_empty(), || {
            "the force on the top floor needs a structure with floors; give masses, heights and shapes".into()
        })?;
        let &Run { ref structure, ground, initial, detail, tolerance, .. } = self;
        let settings = Settings { detail, tolerance, vertical: ground.vertical().is_some(), stops: false };
        Ok(Q::START(structure.clone(), initial, start, settings)?)
    }

    /// Follows the motion to the end, which `watch` sees.
    pub(super) fn end(&self, watch: &mut dyn Watch<Q>) -> Result<(Ending, Engine<Q>), RunError> {
        self.course()?.finish(&mut (&mut (), watch))
    }
}

/// A run on its way, segment by segment: from sample to sample of its record, and then for 1/p_l each until nothing more can
/// happen.
pub(super) struct Follower<Q: Coordinates, Segments> {
    pub engine: Engine<Q>,
    /// The ground motion that is left.
    pub segments: Segments,
    pub end: End,
    /// Time for which the structure may still rock after the record, in units of 1/p_l.
    pub rest: f64,
}

impl<Q: Coordinates, Segments: Iterator<Item = Segment>> Follower<Q, Segments> {
    /// Follows the motion to the end.
    pub(super) fn finish<W: Watch<Q>>(mut self, watch: &mut W) -> Result<(Ending, Engine<Q>), RunError> {
        loop {
            if let Some(ending) = self.go_on(watch)? {
                return Ok((ending, self.engine));
            }
        }
    }

    /// Follows the motion over the next segment. Returns the ending of the run if the run has ended.
    #[inline(always)]
    pub(super) fn go_on<W: Watch<Q>>(&mut self, watch: &mut W) -> Result<Option<Ending>, RunError> {
        let (segment, ending) = match self.next()? {
            Ok(next) => next,
            Err(ending) => return Ok(Some(ending)),
        };
        let load = load_of(self.engine.structure(), segment.ground);
        let progress =
            self.engine.advance(segment.duration, load, watch).map_err(|cause| error(&self.engine, cause))?;
        if progress == Progress::Overturned {
            return Ok(Some(Ending::Overturned));
        }
        self.engine.set_time(segment.until);
        Ok(ending)
    }

    /// The next segment, and the ending of the run after that segment if the run ends there. The inner error is the ending if the run
    /// ends here.
    #[inline(always)]
    pub(super) fn next(&mut self) -> Result<Result<(Segment, Option<Ending>), Ending>, RunError> {
        let &Motion { time, work, .. } = self.engine.motion();
        let next = self.segments.next().map_or_else(|| self.come_to_rest(), |segment| Ok((segment, None)));
        if next.is_ok() && work.steps > MOST_STEPS {
            return Err(RunError::TooManySteps { time, advice: shorter(self.engine.structure()) });
        }
        Ok(next)
    }

    /// The next segment after the record, and the ending of the run after that segment if the run ends there. Fails with the ending if
    /// the run ends here.
    fn come_to_rest(&mut self) -> Result<(Segment, Option<Ending>), Ending> {
        let Follower { engine, end, rest, .. } = self;
        let p_l = engine.structure().base().p_l;
        let omega = match engine.settings().detail {
            Detail::Rigid => p_l, // whatever modes it would have
            _ => engine.structure().vibration().contact,
        };
        if let End::At(end) = *end {
            engine.set_time(end);
            return Err(Ending::AtTime);
        }
        let stays_down = engine.stays_down();
        if *rest == 0.0 && !stays_down {
            return Err(Ending::StillRocking);
        }
        *rest -= 1.0;
        let (duration, ending) = if stays_down { (TAU / omega, Some(Ending::AtRest)) } else { (1.0 / p_l, None) };
        let until = engine.motion().time + duration;
        Ok((Segment { since: 0.0, duration, until, ground: LinearLoad::default() }, ending))
    }
}

/// Advice on a run of `structure` with too many steps: the numbers that make them, if there are such.
fn shorter(structure: &Structure) -> String {
    structure.many_steps().into_iter().chain(["give a shorter duration".into()]).collect::<Vec<_>>().join("; ")
}

/// Why a run of `engine` cannot go on.
#[cold]
pub(super) fn error<Q: Coordinates>(engine: &Engine<Q>, cause: AdvanceError) -> RunError {
    match cause {
        AdvanceError::TooLong { time, until } => RunError::TooLong { time, until, advice: shorter(engine.structure()) },
        cause => RunError::Advance { time: cause.time().unwrap_or(engine.motion().time), cause },
    }
}

/// The force `F_t` (N) on the top floor of `structure`.
#[cold]
fn on_top<Q: Coordinates>(structure: &Structure, F_t: f64) -> Q {
    let below = structure.floors().len().saturating_sub(1);
    Q::of_forces(structure, repeat_n(0.0, below).chain([F_t]))
}

/// The load of the `ground`, and of the force on the top floor, on `structure`.
#[inline(always)]
pub(super) fn load_of<Q: Coordinates>(structure: &Structure, ground: LinearLoad) -> LinearLoad<Q> {
    let on_top = |F_t| if F_t == 0.0 { Q::ZERO } else { on_top(structure, F_t) };
    let [value, slope] = [ground.value, ground.slope].map(|Load { a_g, F_t, a_v }| Load { a_g, F_t: on_top(F_t), a_v });
    LinearLoad { value, slope }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::structure::description::{Damping, Storey};
    use crate::structure::natural_quantities::Numbers;

    /// A base with little inertia under damped modes.
    #[test]
    fn a_run_ends_after_its_most_steps_with_their_cause() {
        let ground = Record::from_samples("", vec![1.0, 1.01, 1.02], vec![0.0, 1.0, 0.0]).unwrap();
        let base = Numbers::of(&[("m0", 2.95e6), ("J0", 1150.0), ("B", 0.1355), ("r", 0.5)]).unwrap();
        let storeys = [[2.5e5, 38.0, 1.6e10], [5.3e5, 94.0, 2.3e10]].map(|[m, h, k]| Storey { m, h, k });
        let slender = Structure::from_storeys(&base, &Damping::All(0.5), &storeys).unwrap();
        let cause = "B = 0.1355 m with J0 = 1150 kg.m2 takes some 1e6 steps of computing for each second of a motion";
        assert!(slender.doubts().iter().any(|doubt| doubt.starts_with(cause)), "{:?}", slender.doubts());
        let run = Run::of_modes(slender, &ground);
        let mut follower = Run { initial: State { theta: 1e-3, ..run.initial }, ..run }.course().unwrap();
        assert_eq!(follower.go_on(&mut ()).unwrap(), None);
        let mut motion = *follower.engine.motion();
        assert!((5_000..20_000).contains(&motion.work.steps), "{}", motion.work.steps);
        motion.work.steps = MOST_STEPS + 1;
        follower.engine.set_motion(motion);
        let error = follower.finish(&mut ()).unwrap_err().to_string();
        assert!(error.starts_with(&format!("the run used up its 5000000 steps at t = 1.01 s: {cause}")), "{error}");
    }
}
