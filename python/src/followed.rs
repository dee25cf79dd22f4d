//! A run of one mass or of many, behind the same questions.

use crate::interruptible::Abandoned;
use anyhow::ensure;
use rocking::engine::motion::Work;
use rocking::engine::piece::Sample;
use rocking::estimates::response_spectrum::floor_spectrum;
use rocking::run::fall::Found;
use rocking::run::peaks::Peak;
use rocking::run::record::Record;
use rocking::run::validity::{Findings, Limits, Validity};
use rocking::run::{End, Ending, RunError};
use rocking::{Phase, Run, Side, Transition, Watch};
use rocking_report::shown::{Named, OF_FLOOR, Shown};
use rocking_report::summary::Summary;
use rocking_report::tables::{components, response_headings, response_numbers, values};
use rocking_report::validity::section;
use rocking_sweep::plan::Conditions;
use std::sync::Arc;

/// How a run went.
#[derive(Clone, Copy)]
pub struct Outcome {
    pub ending: Ending,
    pub start: f64,
    pub end: f64,
    pub fall: Option<f64>,
    pub work: Work,
    pub transitions: usize,
}

/// The phases by their numbers among the [`Samples`].
pub const PHASES: [Phase; 4] =
    [Phase::Overturned(Side::Left), Phase::FullContact, Phase::Rocking(Side::Left), Phase::Rocking(Side::Right)];

/// A motion at instants.
pub struct Samples {
    /// Of numbers.
    pub columns: Vec<Vec<f64>>,
    /// Positions in [`PHASES`].
    pub phases: Vec<u8>,
    /// How many there have been.
    pub transitions: Vec<u64>,
}

/// The questions that a run answers, whatever its structure.
pub trait Followed: Send + Sync {
    fn outcome(&self) -> Outcome;

    /// All peaks, the peak of the ground first.
    fn peaks(&self) -> Vec<(Named, Peak)>;

    /// Peaks of the floors, in the order of [`OF_FLOOR`].
    fn floors(&self) -> Vec<[f64; OF_FLOOR.len()]>;

    /// Names of the components of a state; instant, kind, and the state before and after of each transition.
    #[allow(clippy::type_complexity)]
    fn transitions(&self) -> (Vec<String>, Vec<(f64, &'static str, [Vec<f64>; 2])>);

    /// Headings of the response.
    fn headings(&self) -> Vec<String>;

    /// The motion at `times` (s), none of which is before the start, unless it is `abandoned`.
    fn sample(&self, times: &[f64], abandoned: &mut Abandoned) -> Result<Samples, RunError>;

    /// The spectrum of the acceleration of a floor, from 0 on.
    fn spectrum(&self, floor: usize, periods: &[f64], zeta: f64, abandoned: &mut Abandoned)
    -> anyhow::Result<Vec<f64>>;

    /// The findings about the model within `limits`.
    fn validity(&self, limits: Limits, abandoned: &mut Abandoned) -> Result<Findings, RunError>;

    fn page(&self) -> anyhow::Result<String>;

    /// The output of the command line's `simulate`.
    fn text(&self) -> anyhow::Result<String>;
}

/// A run with its results.
pub struct Following<Q: Shown> {
    structure: Q::Structure,
    /// The record as it shakes the structure.
    ground: Arc<Record>,
    conditions: Conditions,
    found: Found<Q>,
    transitions: Vec<Transition<Q>>,
}

impl<Q: Shown> Following<Q> {
    /// Follows `structure` to the end of the run, unless it is `abandoned`.
    pub fn new(
        structure: Q::Structure,
        ground: Arc<Record>,
        conditions: Conditions,
        abandoned: &mut Abandoned,
    ) -> Result<Following<Q>, RunError> {
        let mut transitions = Vec::new();
        let mut see = |transition: &Transition<Q>| transitions.push(*transition);
        let found = Q::run(&structure, &ground, &conditions)?.found(&mut (abandoned, &mut see))?;
        Ok(Following { structure, ground, conditions, found, transitions })
    }

    /// The run of the library.
    fn run(&self) -> Result<Run<'_, Q>, RunError> {
        Q::run(&self.structure, &self.ground, &self.conditions)
    }
}

impl<Q: Shown + rocking_view::Shown> Followed for Following<Q>
where
    Validity<Q>: Watch<Q>,
{
    fn outcome(&self) -> Outcome {
        let Found { start, fall, ref finish, .. } = self.found;
        let (end, work) = (finish.motion.time, finish.motion.work);
        Outcome { ending: finish.ending, start, end, fall, work, transitions: self.transitions.len() }
    }

    fn peaks(&self) -> Vec<(Named, Peak)> {
        Summary::<Q>::new(&self.structure, &[]).peaks(&self.found)
    }

    fn floors(&self) -> Vec<[f64; OF_FLOOR.len()]> {
        Q::floors(&self.structure, &self.found.peaks)
    }

    fn transitions(&self) -> (Vec<String>, Vec<(f64, &'static str, [Vec<f64>; 2])>) {
        let names = components::<Q>(&self.structure).into_iter().map(|(name, _)| name).collect();
        let states = |of: &Transition<Q>| [&of.before, &of.after].map(|state| values(&self.structure, state));
        (names, self.transitions.iter().map(|of| (of.time, of.kind.name(), states(of))).collect())
    }

    fn headings(&self) -> Vec<String> {
        response_headings::<Q>(&self.structure)
    }

    fn sample(&self, times: &[f64], abandoned: &mut Abandoned) -> Result<Samples, RunError> {
        let mut order: Vec<usize> = (0..times.len()).collect();
        order.sort_by(|a, b| times[*a].total_cmp(&times[*b]));
        let last = order.last().map_or(self.found.start, |last| times[*last]);
        let run = match self.found.finish.ending {
            Ending::Overturned => self.run()?,
            _ if last <= self.found.finish.motion.time => self.run()?,
            _ => Run { end: End::At(last), ..self.run()? },
        };
        let column = |_| {
            abandoned.check();
            vec![f64::NAN; times.len()]
        };
        let mut columns: Vec<_> = (2..self.headings().len()).map(column).collect();
        let (mut phases, mut transitions) = (vec![0; times.len()], vec![0; times.len()]);
        let mut next = 0;
        let mut show = |at: usize, sample: &Sample<Q>| {
            let numbers = response_numbers(&self.structure, sample);
            columns.iter_mut().zip(numbers).for_each(|(column, number)| column[at] = number);
            let phase = PHASES.iter().position(|phase| *phase == sample.motion.phase);
            (phases[at], transitions[at]) = (phase.unwrap_or(0) as u8, sample.motion.transitions);
        };
        let watching = abandoned.clone();
        let see = |sample: &Sample<Q>| {
            // the last that is shown is the end, for which there may be several times, or none
            while next < order.len() && times[order[next]] == sample.motion.time {
                watching.check();
                show(order[next], sample);
                next += 1;
            }
        };
        run.sample(order.iter().map(|index| times[*index]), see, abandoned)?;
        columns[0].copy_from_slice(times);
        for index in &order[next..] {
            transitions[*index] = self.transitions.len() as u64;
        }
        Ok(Samples { columns, phases, transitions })
    }

    fn spectrum(
        &self,
        floor: usize,
        periods: &[f64],
        zeta: f64,
        abandoned: &mut Abandoned,
    ) -> anyhow::Result<Vec<f64>> {
        let end = self.found.fall.unwrap_or(self.found.finish.motion.time);
        ensure!(end > self.found.start, "the structure falls from its start on: its floors have no spectrum");
        let acceleration = |sample: &Sample<Q>| Q::floor_acceleration(sample, floor);
        Ok(floor_spectrum(&self.run()?, end, acceleration, periods, zeta, abandoned)?)
    }

    fn validity(&self, limits: Limits, abandoned: &mut Abandoned) -> Result<Findings, RunError> {
        let run = self.run()?;
        let mut validity = run.validity_watch(limits)?;
        run.follow(&mut (abandoned, &mut validity))?;
        Ok(*validity.found())
    }

    fn page(&self) -> anyhow::Result<String> {
        Ok(rocking_view::page(&self.run()?)?)
    }

    fn text(&self) -> anyhow::Result<String> {
        let (limits, detail) = (Limits::default(), self.conditions.detail);
        let summary = Summary::new(&self.structure, &self.transitions).text(&self.found)?;
        let found = self.validity(limits, &mut Abandoned::default())?;
        let section = section::<Q>(&self.structure, detail, &found, &limits).join("\n");
        Ok(format!("{}\n{summary}{section}", self.ground.title()))
    }
}
