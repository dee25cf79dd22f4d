//! A run of a structure of one mass or of many: what every door prints, writes and draws comes from here.

use crate::quantities::NamedValue;
use crate::tables::{AFTER, Line, line};
use anyhow::ensure;
use rocking::engine::motion::Work;
use rocking::estimates::response_spectrum::{FloorContents, floor_spectra};
use rocking::mechanics::restraint::Dissipators;
use rocking::run::curve;
use rocking::run::peaks::{Peak, Peaks};
use rocking::run::record::Record;
use rocking::run::residual::Residual;
use rocking::run::validity::{Findings, Limits};
use rocking::run::{End, Ending, Finish, RunError, Runs, fall};
use rocking::{Modes, Output, Phase, Run, State, Structure, Transition, TransitionKind, Watch};
use rocking_sweep::condition::{self, PERTURBATION, TRIED, condition, digits, digits_of_outcome, digits_of_run};
use rocking_sweep::{plan::Conditions, with_run};
use serde::Serialize;
use std::sync::Arc;

pub type Named = (String, &'static str);

/// Names and units of the peaks of a floor, and of the storey below the floor, after its height.
pub const OF_FLOOR: [(&str, &str); 7] = {
    use Output::{M, V, a_t, delta_t, drift, u};
    const fn of(output: Output) -> (&'static str, &'static str) {
        (output.symbol(), output.unit())
    }
    [("h", "m"), of(u(0)), of(drift(0)), of(delta_t(0)), of(a_t(0)), of(V(0)), of(M(0))]
};

/// The usual periods of a floor spectrum: 100 from 0.02 to 4 s.
pub fn usual_periods() -> Vec<f64> {
    (0..100).map(|i| 0.02 * libm::pow(200.0, f64::from(i) / 99.0)).collect()
}

/// A structure under a ground motion, and how the engine follows it.
#[derive(Clone)]
pub struct RunSetup {
    pub structure: Structure,
    /// The record as it shakes the structure.
    pub ground: Arc<Record>,
    pub conditions: Conditions,
}

/// The results of a run; instants are in s.
#[derive(Clone, Serialize)]
pub struct RunReport {
    pub start: f64,
    pub end: f64,
    pub ending: Ending,
    /// None if the structure still rocks at the end.
    pub overturned: Option<bool>,
    /// Start of the fall of a structure that overturns.
    pub fall: Option<f64>,
    /// All peaks, the peak of the ground first; if the structure overturns, those before it falls.
    pub peaks: Vec<NamedPeak>,
    /// What is left at the end on ground that slips and yields.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub residuals: Vec<NamedValue>,
    /// Of a structure with dissipators.
    #[serde(flatten)]
    pub(crate) taken: Option<Dissipated>,
    pub(crate) first_uplift: Option<f64>,
    pub(crate) first_impact: Option<f64>,
    pub transitions: u64,
    #[serde(flatten)]
    pub work: Work,
    #[serde(skip)]
    pub events: Vec<Event>,
    #[serde(skip)]
    pub(crate) phase: Phase,
    /// Right-hand-side evaluations that the search for the peaks took, if it counts them.
    #[serde(skip)]
    pub(crate) for_peaks: Option<u64>,
    /// How sure the results are, if the condition is found.
    #[serde(flatten)]
    pub sure: Option<SureDigits>,
    /// The findings about the model, if limits were given.
    #[serde(skip)]
    pub findings: Option<Findings>,
}

/// The largest magnitude of a quantity, and the first instant that has it, s.
#[derive(Clone, Serialize)]
pub struct NamedPeak {
    pub name: String,
    #[serde(rename = "peak")]
    pub magnitude: f64,
    pub unit: &'static str,
    pub time: f64,
    /// Sure digits, if the condition is found.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub digits: Option<u8>,
}

#[derive(Clone, Copy, Serialize)]
pub struct SureDigits {
    /// Sure digits of the peak of θ or, if the structure overturns, of the time until then, as in the rows of a sweep.
    pub digits: u8,
    pub overturning_digits: u8,
    /// The least relative change of the input, of those tried, that decides otherwise.
    pub overturning_change: Option<f64>,
}

/// Energy (J) that the dissipators took until the end of a run, and the rotation (rad) that is left.
#[derive(Clone, Copy, Serialize)]
pub(crate) struct Dissipated {
    pub E_viscous: f64,
    pub E_hysteretic: f64,
    pub theta_end: f64,
}

/// A transition at a time, s.
#[derive(Clone)]
pub struct Event {
    pub time: f64,
    pub kind: TransitionKind,
    /// The state before and after, in the order of [`RunSetup::components`].
    pub states: [Vec<f64>; 2],
}

pub struct SampledMotion {
    /// The numbers, in the order of [`RunSetup::columns`].
    pub columns: Vec<Vec<f64>>,
    /// Positions in [`Phase::SHOWN`].
    pub phases: Vec<u8>,
    pub transitions: Vec<u64>,
}

/// A run as points that straight lines join, at times in s.
pub struct MotionCurve {
    pub found: RunReport,
    pub times: Vec<f64>,
    pub phases: Vec<Phase>,
    /// a_g and the drawn outputs by name.
    pub columns: Vec<(String, Vec<f64>)>,
}

pub fn event_line(event: &Event) -> impl Serialize {
    (event.time, event.kind.name(), &event.states)
}

/// A watcher of any run.
pub trait Watcher: Watch<f64> + Watch<Modes> + Clone {
    /// Ends the work if nobody waits for it.
    fn check(&self) {}
}

impl Watcher for () {}

impl RunSetup {
    /// Follows the motion to its end, and finds its exact peaks; with `limits`, how far it breaks the assumptions of the model, too. If the
    /// conditions say so, changed runs find how many digits of the results are sure.
    pub fn found(&self, limits: Option<Limits>, watch: &mut impl Watcher) -> Result<RunReport, RunError> {
        let mut report = with_run!(self.conditions, self.structure, &self.ground, run => found(&run, limits, watch))??;
        if self.conditions.finds_condition {
            self.assure(&mut report, &mut watch.clone());
        }
        Ok(report)
    }

    /// Finds how many digits of the results of the run in the `report` are sure: none if the changed run fails.
    fn assure(&self, report: &mut RunReport, watch: &mut impl Watcher) {
        let changed = |change| RunSetup {
            structure: self.structure.clone(),
            ground: Arc::new(condition::changed(&self.ground, change)),
            conditions: self.conditions.changed(change),
        };
        let found = changed(PERTURBATION).found(None, watch).ok();
        for (at, peak) in report.peaks.iter_mut().enumerate() {
            let of = |found: &RunReport| digits(condition(peak.magnitude, found.peaks[at].magnitude));
            peak.digits = Some(found.as_ref().map_or(0, of));
        }
        let of_run =
            |of: &RunReport| (of.ending, of.end - of.start, of.peak("theta").map_or(0.0, |peak| peak.magnitude));
        let digits = found.map_or(0, |found| digits_of_run([of_run(report), of_run(&found)]));
        let change = TRIED.into_iter().flat_map(|change| [change, -change]).find(|change| {
            let RunSetup { structure, ground, conditions } = changed(*change);
            let end = with_run!(conditions, structure, &ground, run => run.follow(watch).map(|end| end.ending));
            matches!(end, Ok(Ok(ending)) if ending.overturned() != report.overturned)
        });
        report.sure =
            Some(SureDigits { digits, overturning_digits: digits_of_outcome(change), overturning_change: change });
    }

    /// The results of the same structure on a fixed base, from rest under the same ground motion until `end` (s).
    pub fn on_fixed_base(&self, end: f64) -> Result<RunReport, RunError> {
        with_run!(self.conditions, self.structure, &self.ground, run => found(&run.on_fixed_base(end), None, &mut ()))?
    }

    pub fn validity(&self, limits: Limits, watch: &mut impl Watcher) -> Result<Findings, RunError> {
        with_run!(self.conditions, self.structure, &self.ground, run => {
            let mut validity = run.validity_watch(limits)?;
            run.judge(&mut validity, watch)?;
            Ok(*validity.found())
        })?
    }

    /// Shows the motion at `times` (s), which rise; those before the start and after the end are left out, and the end itself is
    /// shown last. The motion goes on until `end` (s), if given.
    pub fn sample(
        &self,
        times: impl IntoIterator<Item = f64>,
        end: Option<f64>,
        mut show: impl FnMut(Line),
        watch: &mut impl Watcher,
    ) -> Result<(), RunError> {
        with_run!(self.conditions, self.structure, &self.ground, run => {
            let (outputs, run) = (Output::all(&run.structure.at(run.detail)), Run { end: end.map_or(run.end, End::At), ..run });
            run.sample(times, |sample| show(line(sample, outputs.iter().copied().map(sample.outputs()).collect())), watch).map(|_| ())
        })?
    }

    /// The motion at `times` (s) in any order, none of which is before the start. After the end the ground is at rest and the motion
    /// continues; after overturning all values are NaN.
    pub fn at(&self, found: &RunReport, times: &[f64], watch: &mut impl Watcher) -> Result<SampledMotion, RunError> {
        let mut order: Vec<usize> = (0..times.len()).collect();
        order.sort_by(|a, b| times[*a].total_cmp(&times[*b]));
        let last = order.last().map_or(found.start, |last| times[*last]);
        let end = (found.ending != Ending::Overturned && last > found.end).then_some(last);
        let column = |_| {
            watch.check();
            vec![f64::NAN; times.len()]
        };
        let mut columns: Vec<_> = self.columns().iter().map(column).collect();
        let (mut phases, mut transitions) = (vec![0; times.len()], vec![0; times.len()]);
        let (mut next, waiting) = (0, watch.clone());
        let see = |Line(numbers, phase, count): Line| {
            // the last that is shown is the end, for which there may be several times, or none
            while next < order.len() && times[order[next]] == numbers[0] {
                waiting.check();
                let at = order[next];
                columns.iter_mut().zip(&numbers).for_each(|(column, number)| column[at] = *number);
                phases[at] = phase.number() as u8;
                transitions[at] = count;
                next += 1;
            }
        };
        self.sample(order.iter().map(|index| times[*index]), end, see, watch)?;
        columns[0].copy_from_slice(times);
        order[next..].iter().for_each(|index| transitions[*index] = found.transitions);
        Ok(SampledMotion { columns, phases, transitions })
    }

    /// The spectra of the accelerations of `floors`, from 0 on, until the end of the run or the start of the fall.
    pub fn spectra(
        &self,
        found: &RunReport,
        floors: &[usize],
        periods: &[f64],
        zeta: f64,
        watch: &mut impl Watcher,
    ) -> anyhow::Result<Vec<Vec<f64>>> {
        let end = found.fall.unwrap_or(found.end);
        ensure!(end > found.start, "the structure falls from its start on: its floors have no spectrum");
        let all = floors.iter().flat_map(|&floor| periods.iter().map(move |&T| FloorContents { floor, T, zeta }));
        let contents = Vec::from_iter(all);
        let found = with_run!(self.conditions, self.structure, &self.ground, run => floor_spectra(&run, end, &contents, watch))?;
        Ok(found?.chunks(periods.len().max(1)).map(<[f64]>::to_vec).collect())
    }

    /// The run as points between which θ, u and a_t of each floor leave straight lines by at most `part` of their peaks.
    pub fn curve(&self, part: f64) -> Result<MotionCurve, RunError> {
        with_run!(self.conditions, self.structure, &self.ground, run => curve(&run, part))?
    }

    /// The outputs at the level of detail.
    pub fn outputs(&self) -> Vec<Named> {
        let structure = self.structure.at(self.conditions.detail);
        Output::all(&structure).into_iter().map(|of| (of.name(&structure), of.unit())).collect()
    }

    /// Names and units of the numbers of a line of the response: ground acceleration, outputs, reactions and restraints.
    pub fn columns(&self) -> Vec<Named> {
        let named = |(name, unit): (&str, &'static str)| (name.to_owned(), unit);
        let before = [("time", "s"), ("a_g", "m/s2")].map(named);
        before.into_iter().chain(self.outputs()).chain(AFTER.map(named)).collect()
    }

    /// Headings of the response; phase and number of transitions are last.
    pub fn headings(&self) -> Vec<String> {
        let numbers = self.columns().into_iter().map(|(name, unit)| format!("{name}[{unit}]"));
        numbers.chain(["phase", "transitions"].map(str::to_owned)).collect()
    }

    /// Headings of the transitions: instant, kind, and the state before and after.
    pub fn event_headings(&self) -> Vec<String> {
        let components = self.components();
        let state = |when| components.iter().map(move |(name, unit)| format!("{name}_{when}[{unit}]"));
        ["time[s]", "kind"].map(str::to_owned).into_iter().chain(state("before")).chain(state("after")).collect()
    }

    /// The components of a state: elastic displacements and velocities, then rotation and angular velocity.
    pub fn components(&self) -> Vec<Named> {
        let is_of_strut = |(name, _): &Named| matches!(symbol(name), "u" | "u_dot");
        let of_base = [("theta".to_owned(), "rad"), ("theta_dot".to_owned(), "rad/s")];
        self.outputs().into_iter().filter(is_of_strut).chain(of_base).collect()
    }

    /// The peaks of each floor from below, in the order of [`OF_FLOOR`]. One mass is a floor.
    pub fn floors(&self, found: &RunReport) -> Vec<[f64; OF_FLOOR.len()]> {
        let peak = |name: &str| found.peak(name).map_or(f64::NAN, |peak| peak.magnitude);
        match self.structure.is_one_mass() {
            true => {
                let [u, delta_t, a_t, V, M] = ["u", "delta_t", "a_t", "V_t", "M_t"].map(peak);
                vec![[self.structure.parameters().H, u, u, delta_t, a_t, V, M]]
            }
            false => {
                let of = |(number, height): (usize, f64)| {
                    OF_FLOOR.map(|(name, _)| if name == "h" { height } else { peak(&format!("{name}[{number}]")) })
                };
                (1..).zip(self.structure.floors().iter().map(|floor| floor.height)).map(of).collect()
            }
        }
    }
}

impl RunReport {
    pub fn peak(&self, name: &str) -> Option<Peak> {
        let peak = self.peaks.iter().find(|peak| peak.name == name)?;
        Some(Peak { magnitude: peak.magnitude, time: peak.time })
    }
}

impl NamedPeak {
    pub(crate) fn all(structure: &Structure, peaks: &Peaks) -> Vec<NamedPeak> {
        let peak = |of: Output| Some(NamedPeak::new(of.name(structure), of.unit(), peaks.of(of)?));
        Output::with_peak(structure).into_iter().filter_map(peak).collect()
    }

    fn new(name: impl Into<String>, unit: &'static str, Peak { magnitude, time }: Peak) -> NamedPeak {
        NamedPeak { name: name.into(), magnitude, unit, time, digits: None }
    }
}

/// The name of an output without the number of a floor.
pub(crate) fn symbol(name: &str) -> &str {
    name.split('[').next().unwrap_or(name)
}

fn found<Q: Runs>(run: &Run<Q>, limits: Option<Limits>, watch: &mut dyn Watch<Q>) -> Result<RunReport, RunError> {
    let mut transitions = Vec::new();
    let mut see = |transition: &Transition<Q>| transitions.push(*transition);
    let mut validity = limits.map(|limits| run.validity_watch(limits)).transpose()?;
    let found = match &mut validity {
        Some(validity) => run.judged(validity, &mut (watch, &mut see))?,
        None => run.found(&mut (watch, &mut see))?,
    };
    Ok(RunReport { findings: validity.map(|of| *of.found()), ..results(run, &found, &transitions) })
}

fn results<Q: Runs>(run: &Run<Q>, found: &fall::RunResult<Q>, transitions: &[Transition<Q>]) -> RunReport {
    let structure = &run.structure.moved_at(run.detail);
    let &fall::RunResult { ground, ref peaks, fall, start, finish: Finish { ending, ref motion } } = found;
    let floors = |of: &Q| Vec::from_iter(structure.floors().iter().map(|floor| floor.displacement(of)));
    let state = |of: &State<Q>| [floors(&of.u), floors(&of.u_dot), vec![of.theta, of.theta_dot]].concat();
    let event = |of: &Transition<Q>| Event { time: of.time, kind: of.kind, states: [&of.before, &of.after].map(state) };
    let first = |is_meant: fn(&TransitionKind) -> bool| {
        transitions.iter().find(|transition| is_meant(&transition.kind)).map(|transition| transition.time)
    };
    let Dissipators { viscous: E_viscous, hysteretic: E_hysteretic, .. } = motion.dissipators;
    let taken = Dissipated { E_viscous, E_hysteretic, theta_end: motion.state.theta };
    let residuals = Residual::all(structure).map(|of @ &Residual { name, unit, description, .. }| {
        NamedValue::new(name, of.of(structure, motion), unit, "", description)
    });
    RunReport {
        start,
        end: motion.time,
        ending,
        overturned: ending.overturned(),
        fall,
        peaks: [NamedPeak::new("a_g", "m/s2", ground)].into_iter().chain(NamedPeak::all(structure, peaks)).collect(),
        residuals: residuals.collect(),
        taken: structure.base().takes_energy().then_some(taken),
        first_uplift: first(|kind| matches!(kind, TransitionKind::Uplift(_) | TransitionKind::Release(_))),
        first_impact: first(|kind| kind.is_impact()),
        transitions: motion.transitions,
        work: motion.work,
        events: transitions.iter().map(event).collect(),
        phase: motion.phase,
        for_peaks: structure.one().map(|_| peaks.evaluations()),
        sure: None,
        findings: None,
    }
}

fn curve<Q: Runs>(run: &Run<Q>, part: f64) -> Result<MotionCurve, RunError> {
    let curve::RunCurve { points, transitions, found } = run.curve(part)?;
    let mut columns = vec![("a_g".to_owned(), points.iter().map(|at| at.a_g).collect())];
    for (i, output) in Output::drawn(&run.structure.at(run.detail)).into_iter().enumerate() {
        columns.push((output.name(&run.structure), points.iter().map(|at| at.outputs[i]).collect()));
    }
    let (times, phases) = points.iter().map(|at| (at.time, at.phase)).unzip();
    Ok(MotionCurve { found: results(run, &found, &transitions), times, phases, columns })
}
