//! A run: one structure under one ground motion, from its first sample to the end.
//!
//! The engine goes from sample to sample, between which the ground acceleration is linear. A watcher sees every piece and
//! every transition. A run without a watcher reports only how it ended.

pub(crate) mod course;
pub mod curve;
pub mod fall;
pub mod ground_motion;
mod history;
pub mod host_step;
#[cfg(feature = "lanes")]
pub mod lanes;
pub mod levels;
pub mod peak_watch;
pub mod peaks;
mod reaction_series;
pub mod record;
pub mod residual;
mod samples;
pub mod validity;

use crate::mechanics::lateral::Coordinates;
use crate::{Engine, Modes, Sample, Watch};
pub use course::{End, Ending, Finish, LONGEST_REST, MOST_STEPS, Run, RunError, Starts};
use curve::RunCurve;
use fall::RunResult;
use levels::Comparison;
use peaks::Peaks;
use samples::Sampler;
use validity::{Findings, Limits, Validity};

impl<'a, Q: Runs> Run<'a, Q> {
    /// Follows the motion to the end.
    pub fn follow(&self, watch: &mut dyn Watch<Q>) -> Result<Finish<Q>, RunError> {
        let (ending, engine) = (Q::compiled().finish)(self, watch)?;
        Ok(Finish { ending, motion: *engine.motion() })
    }

    /// Follows the motion to the end and shows it at `times` (s), which rise; those before the start and after the end
    /// are left out, and the end itself is shown last. The samples are read from the pieces and change nothing.
    pub fn sample(
        &self,
        times: impl IntoIterator<Item = f64>,
        show: impl FnMut(&Sample<Q>),
        watch: &mut dyn Watch<Q>,
    ) -> Result<Finish<Q>, RunError> {
        let start = self.ground.start();
        let mut samples = Sampler::new(times.into_iter().filter(|time| *time >= start), show);
        let (ending, engine) = (Q::compiled().finish)(self, &mut (watch, &mut samples))?;
        samples.end(&engine);
        Ok(Finish { ending, motion: *engine.motion() })
    }

    /// The exact peaks of all of the run, a fall too, and how it ended; those that are shown are [`Run::found`]'s.
    pub fn peaks(&self) -> Result<(Peaks, Finish<Q>), RunError> {
        let mut watch = Peaks::since(self.ground.start(), &self.structure, self.detail).watch();
        let finish = self.follow(&mut watch)?;
        Ok((watch.end(), finish))
    }

    /// Follows the motion to the end, which `watch` sees, too, and finds its exact peaks.
    pub fn found(&self, watch: &mut dyn Watch<Q>) -> Result<RunResult<Q>, RunError> {
        Ok((Q::compiled().found)(self, watch)?.0)
    }

    /// Like [`Run::found`]; `validity` sees the motion, too.
    pub fn judged(&self, validity: &mut Validity, watch: &mut dyn Watch<Q>) -> Result<RunResult<Q>, RunError> {
        (Q::compiled().judged)(self, validity, watch)
    }

    /// The run as points between which θ, u and a_t of each floor leave straight lines by at most `part` of their peaks; the
    /// ground acceleration does not leave them at all. Refuses a run that takes more points than fit in 130 MB.
    pub fn curve(&self, part: f64) -> Result<RunCurve<Q>, RunError> {
        (Q::compiled().curve)(self, part)
    }

    /// The watcher of the assumptions that the run breaks.
    pub fn validity_watch(&self, limits: Limits) -> Result<Validity, RunError> {
        Ok(Validity::new(self.start()?.structure(), limits, Findings::since(self.ground.start())))
    }

    /// The assumptions that the run breaks, and its end.
    pub fn validity(&self, limits: Limits) -> Result<(Findings, Finish<Q>), RunError> {
        let mut validity = self.validity_watch(limits)?;
        let finish = self.judge(&mut validity, &mut ())?;
        Ok((*validity.found(), finish))
    }

    /// Follows the motion to the end, which `validity` and `watch` see.
    pub fn judge(&self, validity: &mut Validity, watch: &mut dyn Watch<Q>) -> Result<Finish<Q>, RunError> {
        (Q::compiled().judge)(self, validity, watch)
    }

    /// Does the run at every level.
    pub fn compare(&self) -> Result<Comparison, RunError> {
        (Q::compiled().compare)(self)
    }
}

/// Coordinates for which this crate compiles all that follows a run, so that no crate that asks for runs compiles it again.
pub trait Runs: Starts {
    /// The functions that follow runs, which the FMU does not use.
    #[doc(hidden)]
    fn compiled() -> &'static Compiled<Self>;
}

type FollowRun<Q, T> = fn(&Run<Q>, &mut dyn Watch<Q>) -> Result<T, RunError>;
type JudgeRun<Q, T> = fn(&Run<Q>, &mut Validity, &mut dyn Watch<Q>) -> Result<T, RunError>;

/// The functions that follow runs.
#[doc(hidden)]
pub struct Compiled<Q: Coordinates> {
    finish: FollowRun<Q, (Ending, Engine<Q>)>,
    /// See [`Run::found`]; also the peaks of all the motion, including a fall.
    found: FollowRun<Q, (RunResult<Q>, Peaks)>,
    judged: JudgeRun<Q, RunResult<Q>>,
    judge: JudgeRun<Q, Finish<Q>>,
    curve: fn(&Run<Q>, f64) -> Result<RunCurve<Q>, RunError>,
    compare: fn(&Run<Q>) -> Result<Comparison, RunError>,
    #[cfg(feature = "lanes")]
    each: lanes::Each<Q>,
}

macro_rules! compiled {
    ($($of:ty),*) => {$(
        impl Runs for $of {
            fn compiled() -> &'static Compiled<$of> {
                static ALL: Compiled<$of> = Compiled {
                    finish: |run, watch| run.end(watch),
                    found: fall::find,
                    judged: |run, validity, watch| Ok(fall::find(run, &mut (validity, watch))?.0),
                    judge: |run, validity, watch| run.follow(&mut (validity, watch)),
                    curve: curve::trace,
                    compare: levels::compare,
                    #[cfg(feature = "lanes")]
                    each: (lanes::find_each, lanes::rock_each),
                };
                &ALL
            }
        }
    )*};
}
compiled!(f64, Modes);

/// Follows `runs` to their ends and finds the exact peaks of each, as [`Run::found`] does. Tells `done` each result, with the
/// run's position, as the run ends; once `done` says no, the rest is left undone.
#[cfg(feature = "lanes")]
pub fn found_each<Q: Runs>(runs: &[Run<Q>], done: lanes::OnResult<Result<RunResult<Q>, RunError>>) {
    (Q::compiled().each.0)(runs, done);
}

/// Follows `runs` to their ends like [`found_each`], and tells `done` of each how it ended, the peak of θ by then, and its impacts.
#[cfg(feature = "lanes")]
pub fn rocked_each<Q: Runs>(runs: &[Run<Q>], done: lanes::OnResult<(Result<Finish<Q>, RunError>, fall::FallPeaks)>) {
    (Q::compiled().each.1)(runs, done);
}
