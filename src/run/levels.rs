//! Levels of detail compared on one run: the errors of each, what it costs, and the cheapest that will do.
//!
//! A level of a structure of many masses is also the number of modes that are kept ([`Structure::keeping`]).

use super::course::{Ending, Follower, Run, RunError, Starts};
use super::curve::{lines, peaks_of};
use super::fall::FallWatch;
use super::history::{Distance, History};
use super::peaks::Peaks;
use crate::engine::motion::Work;
use crate::mechanics::lateral::Coordinates;
use crate::run::ground_motion::Segment;
use crate::{Detail, Output, State, Structure};
use std::fmt;

/// Tolerance of the run that all others are measured by.
pub const REFERENCE_TOLERANCE: f64 = 1e-12;

/// The levels that are compared, the one of the fewest equations first.
pub const SIMPLEST_FIRST: [Detail; 6] =
    [Detail::FixedBase, Detail::Rigid, Detail::Modal, Detail::Linear, Detail::Auto, Detail::Nonlinear];

/// Rule by which [`Comparison::recommended`] chooses among the levels whose errors are small enough.
pub const RULE: &str = "the cheapest level, or the simplest of equally cheap levels,";

/// Levels go on together, from sample to sample, but no longer than this over the highest ω_u at once: of what lies between nothing is kept.
const LONGEST_STRETCH: f64 = 2000.0;

/// Measure of the error of a level.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Criterion {
    /// Peak of |θ|.
    Theta,
    /// Peak of |u|, of each floor.
    U,
    /// Peak of |a_t|, of each floor, and of V_t and M_t.
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
    pub const ALL: [Criterion; 6] = {
        use Criterion::{At, AtHistory, Theta, ThetaHistory, U, UHistory};
        [Theta, U, At, ThetaHistory, UHistory, AtHistory]
    };

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

/// A level of detail, and for a structure of many masses how many of its modes are kept.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Choice {
    /// The level.
    pub detail: Detail,
    /// Modes that are kept, of how many; None if an engine of one coordinate moves the structure.
    pub modes: Option<[usize; 2]>,
}

impl fmt::Display for Choice {
    fn fmt(&self, out: &mut fmt::Formatter) -> fmt::Result {
        let name = self.detail.name();
        match self.modes {
            Some([kept, all]) => out.pad(&format!("{name}, {kept} of {all}")),
            None => out.pad(name),
        }
    }
}

/// The modes of a structure, all kept, unless an engine of one coordinate moves it.
fn all_modes(structure: &Structure) -> Option<[usize; 2]> {
    structure.of_mode().is_err().then_some([structure.modes().len(); 2])
}

/// The levels to compare on `run`, the one of the fewest equations first.
fn choices<'a, Q: Starts>(run: &Run<'a, Q>) -> Vec<(Choice, Run<'a, Q>)> {
    let Some([all, _]) = all_modes(&run.structure) else {
        let of = |detail| (Choice { detail, modes: None }, Run { detail, ..run.clone() });
        return SIMPLEST_FIRST.map(of).into();
    };
    let of = |(detail, kept): (Detail, usize)| {
        let (structure, places) =
            (run.structure.keeping(kept).expect("not more modes than there are"), run.structure.lowest_places(kept));
        let part = |of: &Q| Q::each(&structure, |j, _| places.get(j).map_or(0.0, |place| of.of(*place)));
        let initial = State { u: part(&run.initial.u), u_dot: part(&run.initial.u_dot), ..run.initial };
        (Choice { detail, modes: Some([kept, all]) }, Run { structure, initial, detail, ..run.clone() })
    };
    let fewer = |detail| (1..=all).map(move |kept| (detail, kept));
    let fixed = fewer(Detail::FixedBase).chain([(Detail::Rigid, 0)]);
    let moving = fewer(Detail::Linear).chain(fewer(Detail::Auto)).chain([(Detail::Nonlinear, all)]);
    fixed.chain(moving).map(of).collect()
}

/// Result of a level on a run.
#[derive(Clone, Debug)]
pub struct LevelResult {
    /// The level.
    pub choice: Choice,
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
    pub response: LevelResult,
    /// Relative errors, in the order of [`Criterion::ALL`]: of several floors the largest.
    pub errors: [f64; 6],
    /// Whether it predicts overturning, or none, as the reference does; None if the reference leaves it open.
    pub is_right_about_overturning: Option<bool>,
}

/// All levels on one run.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// Eqs 1, 5, 6 to [`REFERENCE_TOLERANCE`].
    pub reference: LevelResult,
    /// The simplest first, each to the tolerance of the run.
    pub verdicts: Vec<Verdict>,
    /// The level `auto` without the vertical ground acceleration, if the run has one.
    pub without_vertical: Option<Result<Verdict, RunError>>,
    /// Levels that cannot do the run, and why.
    pub refused: Vec<(Choice, RunError)>,
}

pub(super) fn compare<Q: Starts>(run: &Run<Q>) -> Result<Comparison, RunError> {
    let of_all = |detail| Choice { detail, modes: all_modes(&run.structure) };
    let exact = Run { detail: Detail::Nonlinear, tolerance: REFERENCE_TOLERANCE, ..run.clone() };
    let (level_ground, is_vertical) = (run.ground.clone().without_vertical(), run.ground.vertical().is_some());
    let level = Run { detail: Detail::Auto, ground: &level_ground, ..run.clone() };
    let mut runs = choices(run);
    runs.extend(is_vertical.then(|| (of_all(level.detail), level)));
    let mut reference = start(&exact, of_all(exact.detail))?;
    let mut trials = Vec::from_iter(runs.iter().map(|(choice, run)| start(run, *choice)));
    while reference.ending.is_none() || trials.iter().flatten().any(|trial| trial.ending.is_none()) {
        reference.go_on()?;
        for trial in &mut trials {
            if let Some(error) = trial.as_mut().ok().and_then(|trial| trial.go_on().err()) {
                *trial = Err(error);
            }
        }
        trials.iter_mut().flatten().for_each(|trial| trial.compare(&reference));
        let known = reference.history.sections.len();
        let done = trials.iter().flatten().map(|trial| trial.compared).min().unwrap_or(known);
        reference.history.sections.drain(..done);
        trials.iter_mut().flatten().for_each(|trial| trial.compared -= done);
    }
    let (reference, all, _) = reference.response();
    let found = trials.into_iter().map(|trial| {
        let (response, _, distance) = trial?.response();
        Ok(Verdict::new(&run.structure, response, &distance, &reference, &all))
    });
    let mut found: Vec<Result<Verdict, RunError>> = found.collect();
    let without_vertical = is_vertical.then(|| found.pop()).flatten();
    let (mut verdicts, mut refused) = (Vec::new(), Vec::new());
    for (found, (choice, _)) in found.into_iter().zip(&runs) {
        match found {
            Ok(verdict) => verdicts.push(verdict),
            Err(error) => refused.push((*choice, error)),
        }
    }
    Ok(Comparison { verdicts, reference, without_vertical, refused })
}

/// A level on its way.
struct Trial<Q: Coordinates, Segments> {
    choice: Choice,
    course: Follower<Q, Segments>,
    peaks: FallWatch<Q>,
    /// The part of the motion that is still to be compared with the reference.
    history: History,
    /// From the reference.
    distance: Distance,
    /// How many sections of the reference it has been compared with.
    compared: usize,
    /// How it ended, once it has.
    ending: Option<Ending>,
}

/// Of `run`.
fn start<'a, Q: Starts>(
    run: &Run<'a, Q>,
    choice: Choice,
) -> Result<Trial<Q, impl Iterator<Item = Segment> + use<'a, Q>>, RunError> {
    let lines = lines(&run.structure);
    let [slowest, fastest] = run.structure.vibration().rocking;
    let Follower { engine, segments, end, rest } = run.course()?;
    let segments = segments.flat_map(move |segment| cut(segment, LONGEST_STRETCH / fastest));
    Ok(Trial {
        choice,
        course: Follower { engine, segments, end, rest },
        peaks: run.watch_falling(),
        distance: Distance::new(slowest, lines.len()),
        history: History { lines, sections: Vec::new() },
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

impl<Q: Starts, Segments: Iterator<Item = Segment>> Trial<Q, Segments> {
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
    fn response(self) -> (LevelResult, Peaks, Distance) {
        let motion = self.course.engine.motion();
        let ending = self.ending.expect("it has been followed to its end");
        let (transitions, work) = (motion.transitions, motion.work);
        let seen = self.peaks.end();
        let (peaks, all) = (seen.peaks().clone(), seen.all().clone());
        (LevelResult { choice: self.choice, peaks, ending, transitions, work }, all, self.distance)
    }
}

/// A difference in proportion to what is expected: 0 where there is none, ∞ where nothing is expected.
pub fn relative((difference, expected): (f64, f64)) -> f64 {
    if difference == 0.0 { 0.0 } else { difference / expected }
}

impl LevelResult {
    /// Steps and evaluations together: an exact leap costs about as much as an evaluation.
    pub fn cost(&self) -> u64 {
        self.work.steps + self.work.evaluations
    }
}

/// For rotation, elastic displacements, and accelerations and forces among `lines`, the largest of the `differences` in proportion to
/// what is `expected`.
fn errors(lines: &[Output], differences: &[f64], expected: &[f64]) -> [f64; 3] {
    let mut errors = [0.0; 3];
    for (line, pair) in lines.iter().zip(differences.iter().copied().zip(expected.iter().copied())) {
        let kind = match line {
            Output::theta => 0,
            Output::u(_) => 1,
            _ => 2,
        };
        errors[kind] = f64::max(errors[kind], relative(pair));
    }
    errors
}

impl Verdict {
    /// Of a `response` that has been this far from the `reference`, whose peaks are these with a fall, `all` of it.
    fn new(
        structure: &Structure,
        response: LevelResult,
        distance: &Distance,
        reference: &LevelResult,
        all: &Peaks,
    ) -> Verdict {
        let lines = &lines(structure);
        let magnitudes = |peaks: &Peaks| Vec::from_iter(peaks_of(lines, peaks).map(|peak| peak.magnitude));
        let [found, expected] = [&response.peaks, &reference.peaks].map(magnitudes);
        let differences: Vec<_> =
            found.iter().zip(&expected).map(|(found, expected)| (found - expected).abs()).collect();
        let [theta, u, a_t] = errors(lines, &differences, &expected);
        let [theta_history, u_history, a_t_history] = errors(lines, &distance.largest, &magnitudes(all));
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
    /// Cost of `response` as a multiple of the cost of the level `auto` with all modes; None if `auto` cannot do the run.
    pub fn cost_over_auto(&self, response: &LevelResult) -> Option<f64> {
        let auto = Choice { detail: Detail::Auto, ..self.reference.choice };
        let auto = self.verdicts.iter().find(|verdict| verdict.response.choice == auto);
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
    use crate::run::peaks::Peaks;
    use crate::run::record::Record;
    use crate::structure::description::tests::three_storeys;
    use crate::{Modes, OneMass, Parameters};

    fn verdict(detail: Detail, errors: [f64; 6], cost: u64) -> Verdict {
        let structure = OneMass::new(Parameters::MCMANUS).unwrap();
        let work = Work { steps: 0, evaluations: cost };
        let response = LevelResult {
            choice: Choice { detail, modes: None },
            peaks: Peaks::since(0.0, &structure.into(), detail),
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
        let structure = OneMass::new(Parameters { m0: 0.0, J0: 0.0, f_fc: 0.2, ..Parameters::MCMANUS }).unwrap();
        let times: Vec<_> = (0..=400).map(|i| f64::from(i) * 0.02).collect();
        let a_g = times.iter().map(|t| (std::f64::consts::TAU * t / 4.0).sin()).collect();
        let a_v = times.iter().map(|t| if *t > 0.01 { -15.0 } else { 0.0 }).collect();
        let upwards = Record::from_samples("", times.clone(), a_v).unwrap();
        let ground = Record::from_samples("", times, a_g).unwrap().with_vertical(&upwards).unwrap();
        let comparison = compare(&Run::new(structure, &ground)).unwrap();
        let refused: Vec<_> = comparison.refused.iter().map(|(choice, _)| choice.detail).collect();
        assert_eq!((refused, comparison.reference.ending), (vec![Detail::Modal], Ending::Overturned));
        assert!(matches!(comparison.without_vertical, Some(Err(RunError::Advance { .. }))));
    }

    #[test]
    fn each_of_two_equal_modes_keeps_its_initial_value() {
        let (frame, ground) = (three_storeys(), Record::from_samples("", vec![0.0, 1.0], vec![0.0, 1.0]).unwrap());
        let modes = [frame.modes()[2]; 2];
        let run = Run::of_modes(Structure::of_body(*frame.body(), &modes, &[]).unwrap(), &ground);
        let u = [1e-3, 2e-3];
        for (_, run) in choices(&Run { initial: State { u: Modes::new(&u), ..run.initial }, ..run }) {
            assert_eq!(run.initial.u.numbers(), &u[..run.structure.modes().len()]);
        }
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
            of.recommended(within, criteria).map(|verdict| verdict.response.choice.detail)
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
