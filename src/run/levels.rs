//! Levels of detail compared on one run: the errors of each, what it costs, and the cheapest that will do.

use super::fall::{FallWatch, FallingPeaks};
use super::history::{Distance, History};
use super::peaks::Peaks;
use super::{Ending, Follower, Run, RunError};
use crate::Detail;
use crate::engine::motion::Work;
use crate::run::ground_motion::Segment;

/// Tolerance of the run that all others are measured by.
pub const REFERENCE_TOLERANCE: f64 = 1e-12;

/// The levels that are compared, the one of the fewest equations first.
pub const SIMPLEST_FIRST: [Detail; 6] =
    [Detail::FixedBase, Detail::Rigid, Detail::Modal, Detail::Linear, Detail::Auto, Detail::Nonlinear];

/// Rule by which [`Comparison::recommended`] chooses among the levels whose errors are small enough.
pub const RULE: &str = "the cheapest level, or the simplest of equally cheap levels,";

/// Levels go on together, from sample to sample, but no longer than this over ω_u at once: of what lies between nothing is kept.
const LONGEST_STRETCH: f64 = 2000.0;

/// Measure of the error of a level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Criterion {
    /// Peak of |θ|.
    Theta,
    /// Peak of |u|.
    U,
    /// Peak of |a_t|, and with it of V_t and M_t.
    At,
    /// θ over time: largest difference over the largest |θ|, until one of the structures lies; a fall is in both.
    ThetaHistory,
    /// u over time, likewise.
    UHistory,
    /// a_t over time, likewise.
    AtHistory,
}

impl Criterion {
    /// All of them.
    pub const ALL: [Criterion; 6] = [
        Criterion::Theta,
        Criterion::U,
        Criterion::At,
        Criterion::ThetaHistory,
        Criterion::UHistory,
        Criterion::AtHistory,
    ];

    /// Its name on the command line and in tables.
    pub const fn name(self) -> &'static str {
        match self {
            Criterion::Theta => "theta",
            Criterion::U => "u",
            Criterion::At => "a_t",
            Criterion::ThetaHistory => "theta_history",
            Criterion::UHistory => "u_history",
            Criterion::AtHistory => "a_t_history",
        }
    }
}

/// Result of a level on a run.
#[derive(Clone, Debug)]
pub struct Response {
    /// The level.
    pub detail: Detail,
    /// Its peaks: of a structure that overturns, those before it falls.
    pub peaks: Peaks,
    /// How it ended.
    pub ending: Ending,
    /// Transitions.
    pub transitions: u64,
    /// Steps and right-hand-side evaluations.
    pub work: Work,
}

/// A level beside the reference.
#[derive(Clone, Debug)]
pub struct Verdict {
    /// Result of the level.
    pub response: Response,
    /// Relative errors, in the order of [`Criterion::ALL`].
    pub errors: [f64; 6],
    /// Whether it predicts overturning, or none, as the reference does; None if the reference leaves it open.
    pub is_right_about_overturning: Option<bool>,
}

/// All levels on one run.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// Eqs 1, 5, 6 to [`REFERENCE_TOLERANCE`].
    pub reference: Response,
    /// In the order of [`SIMPLEST_FIRST`], each to the tolerance of the run.
    pub verdicts: Vec<Verdict>,
    /// The level `auto` without the vertical ground acceleration, if the run has one.
    pub without_vertical: Option<Result<Verdict, RunError>>,
    /// Levels that cannot do the run, and why.
    pub refused: Vec<(Detail, RunError)>,
}

/// Does `run` at every level.
pub fn compare(run: &Run) -> Result<Comparison, RunError> {
    let since = |detail| FallingPeaks::since(run.ground.start(), &run.structure, detail);
    let (mut exact_peaks, mut peaks) = (since(Detail::Nonlinear), SIMPLEST_FIRST.map(since));
    let mut level_peaks = since(Detail::Auto);
    let level_ground = run.ground.clone().without_vertical();
    let exact = Run { detail: Detail::Nonlinear, tolerance: REFERENCE_TOLERANCE, ..run.clone() };
    let mut reference = start(&exact, &mut exact_peaks)?;
    let (mut trials, mut refused, mut without_vertical) = (Vec::new(), Vec::new(), None);
    for (detail, peaks) in SIMPLEST_FIRST.into_iter().zip(&mut peaks) {
        match start(&Run { detail, ..run.clone() }, peaks) {
            Ok(trial) => trials.push(trial),
            Err(error) => refused.push((detail, error)),
        }
    }
    if run.ground.vertical().is_some() {
        let run = Run { detail: Detail::Auto, ground: &level_ground, ..run.clone() };
        trials.push(Trial { is_level: true, ..start(&run, &mut level_peaks)? });
    }
    while reference.ending.is_none() || trials.iter().any(|trial| trial.ending.is_none()) {
        reference.go_on()?;
        trials.retain_mut(|trial| {
            let Err(error) = trial.go_on() else { return true };
            if trial.is_level {
                without_vertical = Some(Err(error));
            } else {
                refused.push((trial.run.detail, error));
            }
            false
        });
        trials.iter_mut().for_each(|trial| trial.compare(&reference));
        let known = reference.history.sections.len();
        let done = trials.iter().map(|trial| trial.compared).min().unwrap_or(known);
        reference.history.sections.drain(..done);
        trials.iter_mut().for_each(|trial| trial.compared -= done);
    }
    let (reference, all, _) = reference.response();
    let mut verdicts = Vec::new();
    for trial in trials {
        let is_level = trial.is_level;
        let (response, _, distance) = trial.response();
        let verdict = Verdict::new(response, distance, &reference, &all);
        if is_level {
            without_vertical = Some(Ok(verdict));
        } else {
            verdicts.push(verdict);
        }
    }
    refused.sort_by_key(|(detail, _)| SIMPLEST_FIRST.iter().position(|of_all| of_all == detail));
    Ok(Comparison { verdicts, reference, without_vertical, refused })
}

/// A level on its way.
struct Trial<'a, Segments> {
    run: Run<'a>,
    /// Whether its ground moves horizontally alone and the reference's does not.
    is_level: bool,
    course: Follower<f64, Segments>,
    peaks: FallWatch<'a>,
    /// The part of the motion that is still to be compared with the reference.
    history: History,
    /// From the reference.
    distance: Distance,
    /// How many sections of the reference it has been compared with.
    compared: usize,
    /// How it ended, once it has.
    ending: Option<Ending>,
}

/// Of `run`, whose `peaks` will be there.
fn start<'a>(
    run: &Run<'a>,
    peaks: &'a mut FallingPeaks,
) -> Result<Trial<'a, impl Iterator<Item = Segment> + use<'a>>, RunError> {
    let omega_u = run.structure.omega_u;
    let Follower { engine, segments, end, rest } = run.course()?;
    let segments = segments.flat_map(move |segment| cut(segment, LONGEST_STRETCH / omega_u));
    Ok(Trial {
        run: run.clone(),
        is_level: false,
        course: Follower { engine, segments, end, rest },
        peaks: peaks.watch(),
        history: History::default(),
        distance: Distance::new(omega_u),
        compared: 0,
        ending: None,
    })
}

/// `segment` in equal segments of at most `longest` (s).
fn cut(segment: Segment, longest: f64) -> impl Iterator<Item = Segment> {
    let Segment { since, duration, until, ground } = segment;
    let count = (duration / longest).ceil().max(1.0);
    let passed = move |i: f64| if i == count { duration } else { duration * (i / count) };
    (0..count as u64).map(move |i| {
        let [from, to] = [passed(i as f64), passed((i + 1) as f64)];
        Segment { since: since + from, duration: to - from, until: until - (duration - to), ground: ground.from(from) }
    })
}

impl<Segments: Iterator<Item = Segment>> Trial<'_, Segments> {
    /// Follows the motion over the next segment unless the run has ended.
    fn go_on(&mut self) -> Result<(), RunError> {
        if self.ending.is_none() {
            self.ending = self.course.go_on(&mut (&mut self.peaks, &mut self.history))?;
        }
        Ok(())
    }

    /// Compares as much of it as is known with as much as is known of the `reference`.
    fn compare(&mut self, reference: &Self) {
        let (ours, theirs) = (&mut self.history.sections, &reference.history.sections);
        let [done, compared] = self.distance.go_on(ours, &theirs[self.compared..]);
        ours.drain(..done);
        self.compared += compared;
        // what the one goes on for after the other has ended is compared with nothing
        if self.ending.is_some() && ours.is_empty() {
            self.compared = theirs.len();
        }
        if reference.ending.is_some() && self.compared == theirs.len() {
            ours.clear();
        }
    }

    /// The response, the peaks of all the motion, and the distance from the reference.
    fn response(self) -> (Response, Peaks, Distance) {
        let motion = self.course.engine.motion();
        let ending = self.ending.expect("it has been followed to its end");
        let peaks = self.peaks.end();
        let (transitions, work) = (motion.transitions, motion.work);
        let response = Response { detail: self.run.detail, peaks: *peaks.peaks(), ending, transitions, work };
        (response, *peaks.all(), self.distance)
    }
}

/// A difference in proportion to what is expected: 0 where there is none, ∞ where nothing is expected.
pub fn relative((difference, expected): (f64, f64)) -> f64 {
    if difference == 0.0 { 0.0 } else { difference / expected }
}

impl Response {
    /// Steps and evaluations together: an exact leap costs about as much as an evaluation.
    pub fn cost(&self) -> u64 {
        self.work.steps + self.work.evaluations
    }
}

impl Verdict {
    /// Of a `response` that has been this far from the `reference`, whose peaks are these with a fall, `all` of it.
    fn new(response: Response, distance: Distance, reference: &Response, all: &Peaks) -> Verdict {
        let peaks = [Peaks::theta, Peaks::u, Peaks::a_t].map(|of| {
            let [found, expected] = [&response.peaks, &reference.peaks].map(|peaks| of(peaks).magnitude);
            ((found - expected).abs(), expected)
        });
        let expected = [all.theta(), all.u(), all.a_t()];
        let histories = std::array::from_fn(|i| (distance.largest[i], expected[i].magnitude));
        let [theta, u, a_t] = peaks.map(relative);
        let [theta_history, u_history, a_t_history] = <[_; 3]>::map(histories, relative);
        Verdict {
            is_right_about_overturning: reference
                .ending
                .overturned()
                .map(|overturned| response.ending.overturned() == Some(overturned)),
            errors: [theta, u, a_t, theta_history, u_history, a_t_history],
            response,
        }
    }

    /// Whether it is right about overturning, or leaves it open as the reference does, and its errors by every one of `criteria` are at most `within`.
    pub fn is_within(&self, within: f64, criteria: &[Criterion]) -> bool {
        let error = |criterion: &Criterion| self.errors[*criterion as usize];
        let is_right = self.is_right_about_overturning.unwrap_or(self.response.ending.overturned().is_none());
        is_right && criteria.iter().map(error).all(|error| error <= within)
    }
}

impl Comparison {
    /// Cost of `response` as a multiple of the cost of the level `auto`; None if `auto` cannot do the run.
    pub fn cost_over_auto(&self, response: &Response) -> Option<f64> {
        let auto = self.verdicts.iter().find(|verdict| verdict.response.detail == Detail::Auto);
        auto.map(|auto| response.cost() as f64 / auto.response.cost() as f64)
    }

    /// Returns the cheapest level whose errors by every one of `criteria` are at most `within`; the one of the fewest
    /// equations if several levels have the least cost.
    pub fn recommended(&self, within: f64, criteria: &[Criterion]) -> Option<&Verdict> {
        let admitted = self.verdicts.iter().filter(|verdict| verdict.is_within(within, criteria));
        admitted.min_by_key(|verdict| verdict.response.cost()) // the first of several
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::record::Record;
    use crate::{Parameters, Structure};

    fn verdict(detail: Detail, errors: [f64; 6], cost: u64) -> Verdict {
        let structure = Structure::new(Parameters::MCMANUS).unwrap();
        let work = Work { steps: 0, evaluations: cost };
        let response = Response {
            detail,
            peaks: Peaks::since(0.0, &structure, detail),
            ending: Ending::AtRest,
            transitions: 0,
            work,
        };
        Verdict { response, errors, is_right_about_overturning: Some(true) }
    }

    /// With the vertical component the structure falls at once. Without it the top mass comes above the pivot of a foundation
    /// without inertia.
    #[test]
    fn a_failure_without_the_vertical_component_is_no_failure_of_the_level() {
        let structure = Structure::new(Parameters { m0: 0.0, J0: 0.0, f_fc: 0.2, ..Parameters::MCMANUS }).unwrap();
        let times: Vec<_> = (0..=400).map(|i| f64::from(i) * 0.02).collect();
        let a_g = times.iter().map(|t| (std::f64::consts::TAU * t / 4.0).sin()).collect();
        let a_v = times.iter().map(|t| if *t > 0.01 { -15.0 } else { 0.0 }).collect();
        let upwards = Record::from_samples("", times.clone(), a_v).unwrap();
        let ground = Record::from_samples("", times, a_g).unwrap().with_vertical(&upwards).unwrap();
        let comparison = compare(&Run::new(structure, &ground)).unwrap();
        let refused: Vec<_> = comparison.refused.iter().map(|(detail, _)| *detail).collect();
        assert_eq!((refused, comparison.reference.ending), (vec![Detail::Modal], Ending::Overturned));
        assert!(matches!(comparison.without_vertical, Some(Err(RunError::Advance { .. }))));
    }

    #[test]
    fn the_cheapest_level_within_the_limit_is_advised_or_the_simplest_of_equally_cheap_ones() {
        let mut comparison = Comparison {
            reference: verdict(Detail::Nonlinear, [0.0; 6], 100).response,
            verdicts: vec![
                verdict(Detail::FixedBase, [1.0, 0.5, 0.5, 1.0, 1.0, 1.0], 10),
                verdict(Detail::Rigid, [0.01, 1.0, 0.2, 0.01, 1.0, 1.0], 90),
                verdict(Detail::Modal, [0.04, 0.03, 0.03, 0.03, 0.06, 0.03], 29),
                verdict(Detail::Linear, [0.02, 0.01, 0.01, 0.03, 0.01, 0.03], 20),
                verdict(Detail::Auto, [0.0; 6], 80),
            ],
            without_vertical: None,
            refused: Vec::new(),
        };
        let all = Criterion::ALL;
        let advice = |of: &Comparison, within: f64, criteria: &[Criterion]| {
            of.recommended(within, criteria).map(|verdict| verdict.response.detail)
        };
        assert_eq!(advice(&comparison, 0.1, &all), Some(Detail::Linear), "linear beats modal in both cost and error");
        assert_eq!(advice(&comparison, 0.015, &[Criterion::Theta]), Some(Detail::Auto), "auto beats rigid in both");
        assert_eq!(advice(&comparison, 0.001, &all), Some(Detail::Auto));
        comparison.verdicts[2].response.work.evaluations = 20;
        assert_eq!(advice(&comparison, 0.1, &all), Some(Detail::Modal), "modal costs as much as linear");
        assert_eq!(advice(&comparison, 0.05, &all), Some(Detail::Linear), "the history of u by modal is off by 6 %");
        assert_eq!(advice(&comparison, 0.05, &[Criterion::Theta, Criterion::At]), Some(Detail::Modal));
        for wrong_or_unsure in [Some(false), None] {
            comparison.verdicts[3].is_right_about_overturning = wrong_or_unsure;
            assert_eq!(advice(&comparison, 0.05, &all), Some(Detail::Auto));
        }
        comparison.verdicts.pop();
        assert_eq!(advice(&comparison, 0.001, &all), None);
    }
}
