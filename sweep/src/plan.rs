//! Many runs: every structure of some populations under every ground motion at every scale factor.

use crate::condition::{PERTURBATION, changed, digits_of_run, paired};
use crate::outcome::{self, Measure, MeasurePlaces, Outcome, Summary};
use crate::{Refused, ensure};
use rocking::digits::with_unit;
use rocking::engine::{DEFAULT_TOLERANCE, Settings};
use rocking::estimates::intensity::{
    IntensityMeasure, arias_intensity, average_spectral_acceleration, cumulative_absolute_velocity, peak_velocity,
    significant_duration,
};
use rocking::estimates::response_spectrum::spectral_acceleration;
use rocking::names::unknown;
use rocking::run::fall::RunResult;
use rocking::run::record::Record;
use rocking::run::validity::{Findings, Limits};
use rocking::run::{End, Run, RunError, Runs, found_each};
use rocking::structure::description::{DescribedNumber, Description};
use rocking::structure::doubts::doubted;
use rocking::structure::parameters::{MAX_SLENDERNESS, OF_ONE_MASS, PARAMETERS};
use rocking::{Detail, Modes, Parameters, Quantity, State, Structure};
use serde::Serialize;
use std::array;
use std::borrow::Cow;
use std::collections::{HashMap, HashSet};
use std::sync::{LazyLock, OnceLock};

/// More runs than this are refused: thousands of runs a second take hours for them.
pub const MAX_RUNS: usize = 10_000_000;

const CHECKED: &str = "the plan has been checked";

/// H/B, which varies H at constant B; m, m0, J0 and f_fc stay as they are.
const SLENDERNESS: Quantity<Parameters> = Quantity {
    name: "slenderness",
    unit: "1",
    description: "height of the top mass over half-width of the base, H/B",
    min: 0.0,
    max: MAX_SLENDERNESS,
    get: |parameters| parameters.H / parameters.B,
    set: |parameters, slenderness| parameters.H = slenderness * parameters.B,
};

/// Parameters that can vary. The slenderness is last and therefore uses the B of the same structure.
pub static AXES: LazyLock<[&Quantity<Parameters>; PARAMETERS.len() + 1]> =
    LazyLock::new(|| array::from_fn(|i| PARAMETERS.get(i).unwrap_or(&SLENDERNESS)));

/// Position of the quantity called `name` in [`AXES`], or their number.
fn place(name: &str) -> usize {
    AXES.iter().position(|axis| axis.name == name).unwrap_or(AXES.len())
}

/// The numbers of storeys and of ground that `structure` was made of.
fn beyond_axes(structure: &Structure) -> impl Iterator<Item = DescribedNumber> + use<> {
    let all = structure.description().map_or_else(Vec::new, Description::numbers);
    all.into_iter().filter(|of| place(&of.name) == AXES.len())
}

/// Names and units of the numbers of storeys and of ground of all `structures`, beside [`AXES`].
pub fn numbers_of<'a>(structures: impl IntoIterator<Item = &'a Structure>) -> Vec<Measure> {
    let mut all = Vec::new();
    for DescribedNumber { name, unit, .. } in structures.into_iter().flat_map(beyond_axes) {
        let number = (name, unit.to_owned());
        if !all.contains(&number) {
            all.push(number);
        }
    }
    all
}

/// The values of these `numbers` of `structure`; NaN if the structure has no such number.
pub fn values_of(structure: &Structure, numbers: &[Measure]) -> Vec<f64> {
    if numbers.is_empty() {
        return Vec::new();
    }
    let own: HashMap<_, _> = beyond_axes(structure).map(|of| (of.name, of.value)).collect();
    numbers.iter().map(|(name, _)| own.get(name).copied().unwrap_or(f64::NAN)).collect()
}

/// Structures that count together: one in which some numbers vary, in every combination, or several.
#[derive(Clone, Debug)]
pub struct Population {
    pub name: String,
    /// One or more.
    bases: Vec<Structure>,
    /// Names of numbers, those of [`AXES`] first and in their order, and their values.
    varying: Vec<(String, Vec<f64>)>,
}

#[derive(Clone, Debug)]
pub struct NamedRecord {
    pub name: String,
    /// Samples before they are scaled.
    pub record: Record,
    /// Factor on the acceleration of this ground motion only.
    pub scale: f64,
    /// Measures of the record's intensity, in SI units.
    pga: f64,
    pgv: f64,
    cav: f64,
    /// Times g, m²/s³.
    arias: f64,
    duration: f64,
}

#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Conditions {
    /// State at the first sample, with u and u̇ of each floor, or of none.
    pub initial: State<Vec<f64>>,
    pub detail: Detail,
    /// Relative tolerance of the results.
    pub tolerance: f64,
    /// Time from the first sample to the end of a run, s; without it a run goes on until nothing more can happen.
    pub duration: Option<f64>,
    /// Whether the sure digits of the results are found, by runs under a [`changed`] input.
    pub finds_condition: bool,
}

/// `$do` with `$run`, the library's run of one mass or of many of `$structure` under `$ground` and `$conditions`.
#[macro_export]
macro_rules! with_run {
    ($conditions:expr, $structure:expr, $ground:expr, $run:ident => $do:expr) => {
        match $structure.of_one_mode() {
            Some(structure) => $conditions.run::<f64>(structure, $ground).map(|$run| $do),
            None => $conditions.run::<::rocking::Modes>($structure.clone(), $ground).map(|$run| $do),
        }
    };
}

impl Default for Conditions {
    fn default() -> Conditions {
        let (initial, detail, tolerance) = (State::default(), Detail::default(), DEFAULT_TOLERANCE);
        Conditions { initial, detail, tolerance, duration: None, finds_condition: false }
    }
}

/// Populations × ground motions × scale factors.
#[derive(Clone, Debug)]
pub struct Plan {
    pub populations: Vec<Population>,
    pub motions: Vec<NamedRecord>,
    scales: Vec<f64>,
    /// Conditions of all runs, which have been checked.
    pub(crate) conditions: Conditions,
    /// Measures of all structures, each once.
    pub measures: Vec<Measure>,
    /// Names and units of the numbers of storeys and of ground of all structures.
    pub numbers: Vec<Measure>,
    layouts: Vec<MeasurePlaces>,
    /// A sentence for each number that is usual in another unit, once for each population.
    pub doubts: Vec<String>,
    /// The largest half-width of a base, m.
    pub widest: f64,
    /// Of every structure under every ground motion.
    spectral: Vec<Spectral>,
}

/// Spectral accelerations of a ground motion before it is scaled, m/s²: worked out when asked for.
#[derive(Clone, Debug, Default)]
struct Spectral {
    sa: OnceLock<f64>,
    average: OnceLock<f64>,
    /// A period (s), a damping ratio and S_a there.
    at: OnceLock<(f64, f64, f64)>,
}

#[derive(Clone, Debug)]
pub struct Case<'a> {
    plan: &'a Plan,
    /// Number of the run in the plan, from 0.
    pub index: usize,
    pub population: &'a Population,
    /// Number of the structure in its population, from 0.
    member: usize,
    pub structure: Structure,
    layout: &'a MeasurePlaces,
    /// The ground motion before it is scaled.
    pub motion: &'a NamedRecord,
    /// Factor on its acceleration, beside its own.
    pub scale: f64,
    /// Relative change of the input.
    change: f64,
    /// Runs of different groups do not depend on each other: the ground motion's number, or where there is one alone the
    /// structure's.
    pub group: usize,
}

impl Population {
    /// Population of the one structure `base`, until something varies.
    pub fn new(name: impl Into<String>, base: impl Into<Structure>) -> Population {
        Population { name: name.into(), bases: vec![base.into()], varying: Vec::new() }
    }

    /// Population of the structures `bases`, at least one.
    pub fn of(name: impl Into<String>, bases: Vec<Structure>) -> Result<Population, Refused> {
        let name = name.into();
        ensure(!bases.is_empty(), || is_empty(&format!("structures {name:?}")))?;
        Ok(Population { name, bases, varying: Vec::new() })
    }

    /// Every structure that there is so far with each of `values` of the parameter called `name`, or of `slenderness`,
    /// which is H/B: H = slenderness × B, while B, m, m0, J0 and f_fc stay. Of a building, parameters of the base can vary. Numbers of
    /// storeys and of ground have the names of [`Description::numbers`].
    pub fn vary(mut self, name: &str, values: Vec<f64>) -> Result<Population, Refused> {
        let is_building = self.bases.iter().any(|base| !base.is_one_mass());
        let can_vary = |name: &str| !is_building || !(OF_ONE_MASS.contains(&name) || name == SLENDERNESS.name);
        let axes = AXES.iter().map(|axis| axis.name.to_owned()).filter(|name| can_vary(name));
        let known: Vec<_> = axes.chain(numbers_of(&self.bases).into_iter().map(|(name, _)| name)).collect();
        ensure(known.iter().any(|known| known == name), || {
            let why = if can_vary(name) { "" } else { " in a building, whose modes determine it" };
            format!("{name:?} cannot vary{why}: these can: {}", known.join(", "))
        })?;
        check_list(name, &values)?;
        let varies = |name| self.varying.iter().any(|(varying, _)| varying == name);
        ensure(!varies(name), || is_there_twice(name))?;
        let sets_H = |name| [SLENDERNESS.name, "H"].contains(&name);
        ensure(!(sets_H(name) && (varies("H") || varies(SLENDERNESS.name))), || {
            "H and slenderness cannot both vary: slenderness sets H".into()
        })?;
        self.varying.push((name.into(), values));
        self.varying.sort_by_key(|(name, _)| place(name));
        Ok(self)
    }

    /// How many structures there are, or [`usize::MAX`] if there are more.
    fn len(&self) -> usize {
        self.varying.iter().fold(self.bases.len(), |len, (_, values)| len.saturating_mul(values.len()))
    }

    /// Names of varying numbers and their values in structure `member`. The last one changes first.
    fn values(&self, member: usize) -> impl Iterator<Item = (&str, f64)> {
        let mut stride = self.len() / self.bases.len();
        self.varying.iter().map(move |(name, values)| {
            stride /= values.len();
            (&**name, values[member / stride % values.len()])
        })
    }

    /// The structure of this number, from 0.
    pub fn structure(&self, member: usize) -> Result<Structure, Refused> {
        let base = &self.bases[member / (self.len() / self.bases.len())];
        if self.varying.is_empty() {
            return Ok(base.clone());
        }
        let parameters = base.description().map_or_else(|| base.parameters(), |of| of.parameters);
        let (mut parameters, mut others) = (parameters, HashMap::new());
        for (name, value) in self.values(member) {
            match AXES.get(place(name)) {
                Some(axis) => (axis.set)(&mut parameters, value),
                None => drop(others.insert(name, value)),
            }
        }
        let structure = match base.description().filter(|_| !others.is_empty()) {
            Some(of) => {
                let of = Description { parameters, ..of.clone() };
                let values = of.numbers().into_iter().map(|of| others.get(&*of.name).copied().unwrap_or(of.value));
                of.with(&Vec::from_iter(values)).structure()
            }
            None => base.with(parameters),
        };
        let structure = structure.map_err(|problem| Refused::by(format!("structures {:?}: {problem}", self.name)));
        Ok(structure?.measured_in(base.units()))
    }
}

impl NamedRecord {
    /// The ground motion `record`, which must not be at rest throughout, with its accelerations times `scale`.
    pub fn new(name: impl Into<String>, record: Record, scale: f64) -> Result<NamedRecord, Refused> {
        let (name, pga) = (name.into(), record.pga());
        let is_in_motion = pga != 0.0 && scale != 0.0;
        ensure(is_in_motion, || format!("the ground motion {name:?} is at rest throughout: leave it out"))?;
        ensure(scale.is_finite(), || format!("scale of {name:?} = {scale} is not a finite number"))?;
        let (pgv, cav) = (peak_velocity(&record), cumulative_absolute_velocity(&record));
        let (arias, [first, last]) = (arias_intensity(&record, 1.0), significant_duration(&record));
        Ok(NamedRecord { name, record, scale, pga, pgv, cav, arias, duration: last - first })
    }

    /// Whether the `other` ground motion is this one, except for digits that a file rounds: no value differs by more than 1e-4 of
    /// the largest.
    pub(crate) fn is_same(&self, other: &NamedRecord) -> bool {
        const ROUNDING: f64 = 1e-4;
        fn parts(of: &NamedRecord) -> [(&[f64], f64, f64); 4] {
            let (NamedRecord { record, scale, pga, .. }, a_g) = (of, of.record.acceleration());
            let [a_v, F_t] = [record.vertical(), record.force()].map(Option::unwrap_or_default);
            let (largest, most_F_t) = (scale * pga, F_t.iter().fold(0.0, |most: f64, F_t| most.max(F_t.abs())));
            [(record.times(), 1.0, record.end()), (a_g, *scale, largest), (a_v, *scale, largest), (F_t, 1.0, most_F_t)]
        }
        parts(self).into_iter().zip(parts(other)).all(|((these, factor, most), (others, of_others, _))| {
            let is_near = |(a, b): (&f64, &f64)| (factor * a - of_others * b).abs() <= ROUNDING * most.abs();
            these.len() == others.len() && these.iter().zip(others).all(is_near)
        })
    }
}

impl Conditions {
    /// The run of `structure` under `ground`, which an engine of coordinates `Q` moves.
    pub fn run<'a, Q: Runs>(&self, structure: Structure, ground: &'a Record) -> Result<Run<'a, Q>, Refused> {
        let (initial, &Conditions { detail, tolerance, .. }) = (self.initial.on(&structure)?, self);
        let end = self.duration.map_or(End::AtRest, |duration| End::At(ground.start() + duration));
        Ok(Run { structure, ground, initial, detail, tolerance, end })
    }

    /// Refuses, with the reason, what no run of `structure` can have.
    pub fn check(&self, structure: &Structure) -> Result<(), Refused> {
        let duration = self.duration.unwrap_or(1.0);
        ensure(duration > 0.0 && duration.is_finite(), || {
            format!("duration = {} is out of range: a finite number greater than 0 is needed", with_unit(duration, "1"))
        })?;
        let settings = Settings { detail: self.detail, tolerance: self.tolerance, ..Settings::default() };
        let ground = Record::at_rest(1.0);
        fn start<Q: Runs>(run: Run<Q>, settings: Settings) -> Result<(), Refused> {
            Q::START(run.structure, run.initial, 0.0, settings).map(|_| ())
        }
        with_run!(self, structure, &ground, run => start(run, settings))?
    }
}

impl Plan {
    /// Every structure of `populations` under each of `motions` times each of `scales`, all under these `conditions`. Each structure is
    /// made once here.
    pub fn new(
        mut populations: Vec<Population>,
        motions: Vec<NamedRecord>,
        scales: Vec<f64>,
        conditions: Conditions,
    ) -> Result<Plan, Refused> {
        check_list("scale", &scales)?;
        ensure(!scales.contains(&0.0), || "scale = 0 leaves no ground motion: leave it out".into())?;
        ensure(!populations.is_empty(), || is_empty("structures"))?;
        ensure(!motions.is_empty(), || is_empty("records"))?;
        check_names("populations", populations.iter().map(|of| &of.name))?;
        check_names("ground motions", motions.iter().map(|of| &of.name))?;
        for base in populations.iter_mut().flat_map(|of| &mut of.bases) {
            conditions.check(base)?;
            if conditions.finds_condition {
                conditions.changed(PERTURBATION).check(base)?;
            }
            *base = base.at(conditions.detail);
        }
        let (measures, layouts, spectral, doubts, widest) = (Vec::new(), Vec::new(), Vec::new(), Vec::new(), 0.0);
        let numbers = numbers_of(populations.iter().flat_map(|of| &of.bases));
        let mut plan =
            Plan { populations, motions, scales, conditions, measures, numbers, layouts, doubts, widest, spectral };
        let [structures, motions, scales] = plan.size();
        ensure(structures.saturating_mul(motions).saturating_mul(scales) <= MAX_RUNS, || {
            format!(
                "{structures} structures x {motions} ground motions x {scales} scale factors: more than {MAX_RUNS} runs"
            )
        })?;
        plan.spectral = vec![Spectral::default(); structures * motions];
        let mut said = HashSet::new();
        for (population, name) in plan.populations.iter().map(|of| (of, &of.name)) {
            for member in 0..population.len() {
                let structure = population.structure(member)?;
                if plan.layouts.iter().all(|layout| !layout.is_of(&structure)) {
                    plan.layouts.push(MeasurePlaces::new(&structure, &mut plan.measures));
                }
                let doubts = structure.doubts().into_iter();
                let news = doubts.filter(|doubt| said.insert((name, doubted(doubt).to_owned())));
                plan.doubts.extend(news.map(|doubt| format!("{name}: {doubt}")));
                plan.widest = plan.widest.max(structure.base().B);
            }
        }
        Ok(plan)
    }

    /// The plan with the measure S_a of each of these `contents`, such as S_a[3](0.5 s): an oscillator of this period on floor 3, with 5 %
    /// damping or, as in S_a[3](0.5 s, 2 %), another.
    pub fn with_contents(mut self, contents: &[String]) -> Result<Plan, Refused> {
        for given in contents {
            let (contents, name) = outcome::contents(given)?;
            ensure(self.measures.iter().all(|(of, _)| *of != name), || is_there_twice(&name))?;
            let has_floor = self.layouts.iter_mut().map(|of| of.measure_too(contents, self.measures.len()));
            let have_floor = has_floor.filter(|has_floor| *has_floor).count();
            ensure(have_floor > 0, || format!("{name}: no structure has a floor {}", contents.floor + 1))?;
            self.measures.push((name, "m/s2".into()));
        }
        Ok(self)
    }

    /// Numbers of structures, ground motions and scale factors.
    pub fn size(&self) -> [usize; 3] {
        let structures = self.populations.iter().fold(0, |sum: usize, population| sum.saturating_add(population.len()));
        [structures, self.motions.len(), self.scales.len()]
    }

    #[expect(clippy::len_without_is_empty, reason = "a plan is never empty")]
    pub fn len(&self) -> usize {
        self.size().into_iter().product()
    }

    /// Run `index` < [`Plan::len`]: scale factors change first, then ground motions, then structures.
    pub fn case(&self, index: usize) -> Case<'_> {
        self.cases_of([index]).next().expect("there is one")
    }

    pub fn cases(&self) -> impl Iterator<Item = Case<'_>> {
        self.cases_of(0..self.len())
    }

    /// The runs `indices`. Neighbours of the same structure share it.
    pub fn cases_of(&self, indices: impl IntoIterator<Item = usize>) -> impl Iterator<Item = Case<'_>> {
        let mut last = None;
        indices.into_iter().map(move |index| {
            let (pair, scale) = (index / self.scales.len(), self.scales[index % self.scales.len()]);
            let (number, motion) = (pair / self.motions.len(), pair % self.motions.len());
            let made = last.take().filter(|(of, _)| *of == number);
            let (_, made) = last.insert(made.unwrap_or_else(|| (number, self.member(number))));
            let (population, member, structure, layout) = made.clone();
            let (group, motion) = (if self.motions.len() > 1 { motion } else { pair }, &self.motions[motion]);
            Case { plan: self, index, population, member, structure, layout, motion, scale, change: 0.0, group }
        })
    }

    /// The structure of this `number` in the plan: its population, its number there, itself, and the layout of its measures.
    fn member(&self, mut number: usize) -> (&Population, usize, Structure, &MeasurePlaces) {
        let mut populations = self.populations.iter();
        let population = populations.find(|population| {
            let is_of_it = number < population.len();
            number -= if is_of_it { 0 } else { population.len() };
            is_of_it
        });
        let population = population.expect("the plan has such a structure");
        let structure = population.structure(number).expect(CHECKED);
        let layout = self.layouts.iter().find(|layout| layout.is_of(&structure)).expect(CHECKED);
        (population, number, structure, layout)
    }

    /// Does the runs `indices` on one thread, several at a time, and tells `done` the outcome of each as it ends.
    /// With `validity` each is by itself, and its findings say how far it breaks the assumptions of the model. Once `done` says no,
    /// the rest is left undone.
    pub fn each_outcome(
        &self,
        indices: &[usize],
        validity: bool,
        mut done: impl FnMut(&Case, Outcome, Option<Findings>) -> bool,
    ) {
        let (mut cases, finds_condition) =
            (Vec::from_iter(self.cases_of(indices.iter().copied())), self.conditions.finds_condition);
        if finds_condition {
            let changed = cases.clone().into_iter().map(|case| Case { change: PERTURBATION, ..case });
            cases.extend(changed);
        }
        let mut done = paired(indices.len(), finds_condition, |at, (outcome, findings), changed| {
            let case: &Case = &cases[at];
            done(case, case.sure(outcome, changed.map(|(outcome, _)| outcome)), findings)
        });
        if validity {
            cases.iter().enumerate().all(|(number, case)| {
                let (outcome, findings) = case.judged();
                done(number, (outcome, Some(findings)))
            });
            return;
        }
        let (mut of_one, mut of_many) = (Vec::new(), Vec::new());
        for (number, case) in cases.iter().enumerate() {
            match case.structure.of_one_mode() {
                Some(structure) => of_one.push(((number, case), structure)),
                None => of_many.push(((number, case), case.structure.clone())),
            }
        }
        let mut done = |number, outcome| done(number, (outcome, None));
        if together::<f64>(of_one, &mut done) {
            together::<Modes>(of_many, &mut done);
        }
    }
}

/// Does these cases together, each with its number, and tells `done` the outcome of each as it ends. Returns whether to go on.
fn together<Q: Runs>(cases: Vec<((usize, &Case), Structure)>, done: &mut impl FnMut(usize, Outcome) -> bool) -> bool {
    let grounds: Vec<_> = cases.iter().map(|((_, case), _)| case.ground()).collect();
    let (cases, structures): (Vec<_>, Vec<_>) = cases.into_iter().unzip();
    let run = |((structure, ground), (_, case)): (_, &(_, &Case))| {
        case.conditions().run::<Q>(structure, ground).expect(CHECKED)
    };
    let runs: Vec<_> = structures.into_iter().zip(&grounds).zip(&cases).map(run).collect();
    let mut goes_on = true;
    found_each(&runs, &mut |at, found| {
        let (number, case) = cases[at];
        goes_on = done(number, case.outcome_of(&runs[at], found));
        goes_on
    });
    goes_on
}

impl Case<'_> {
    pub fn outcome(&self) -> Outcome {
        let found = with_run!(self.conditions(), self.structure, &self.ground(), run => self.outcome_of(&run, run.found(&mut ())));
        found.expect(CHECKED)
    }

    /// Does it, and finds how far it breaks the assumptions of the model.
    fn judged(&self) -> (Outcome, Findings) {
        let judged = with_run!(self.conditions(), self.structure, &self.ground(), run => {
            let mut validity = run.validity_watch(Limits::default()).expect(CHECKED);
            (self.outcome_of(&run, run.judged(&mut validity, &mut ())), *validity.found())
        });
        judged.expect(CHECKED)
    }

    fn outcome_of<Q: Runs>(&self, run: &Run<Q>, found: Result<RunResult<Q>, RunError>) -> Outcome {
        Outcome::found(run, (self.layout, self.plan.measures.len()), found)
    }

    fn ground(&self) -> Record {
        changed(&self.motion.record.clone().multiplied(self.factor()), self.change)
    }

    fn conditions(&self) -> Conditions {
        self.plan.conditions.changed(self.change)
    }

    /// The `outcome` with its sure digits, if there is the outcome of the `changed` run.
    fn sure(&self, mut outcome: Outcome, changed: Option<Outcome>) -> Outcome {
        let of_run = |of: &Summary| (of.ending, of.end - self.motion.record.start(), of.peaks[self.layout.rotation()]);
        if let (Outcome::Ended(own), Some(changed)) = (&mut outcome, changed) {
            own.digits = Some(match &changed {
                Outcome::Ended(changed) => digits_of_run([of_run(own), of_run(changed)]),
                Outcome::Failed { .. } => 0,
            });
        }
        outcome
    }

    /// How strong the ground motion is, in the unit of `measure`.
    pub fn intensity(&self, measure: IntensityMeasure) -> f64 {
        let Parameters { g, f_fc, zeta_fc, .. } = self.structure.parameters();
        let (NamedRecord { record, .. }, Spectral { sa, average, at }) =
            (self.motion, &self.plan.spectral[self.pair()]);
        let unscaled = match measure {
            IntensityMeasure::Pga => self.motion.pga / g,
            IntensityMeasure::Pgv => self.motion.pgv,
            IntensityMeasure::Sa => sa.get_or_init(|| spectral_acceleration(record, f_fc.recip(), zeta_fc)) / g,
            IntensityMeasure::AverageSa => {
                average.get_or_init(|| average_spectral_acceleration(record, f_fc.recip(), zeta_fc)) / g
            }
            IntensityMeasure::SaAt(T, zeta) => {
                match at.get_or_init(|| (T, zeta, spectral_acceleration(record, T, zeta))) {
                    (period, ratio, found) if (*period, *ratio) == (T, zeta) => found / g,
                    _ => spectral_acceleration(record, T, zeta) / g,
                }
            }
            IntensityMeasure::Cav => self.motion.cav,
            IntensityMeasure::Arias => return self.motion.arias / g * self.factor().powi(2),
            IntensityMeasure::Duration => return self.motion.duration,
        };
        unscaled * self.factor().abs()
    }

    /// Number of the structure and ground motion among all pairs of the plan, from 0.
    pub(crate) fn pair(&self) -> usize {
        self.index / self.plan.scales.len()
    }

    pub(crate) fn structure_number(&self) -> usize {
        self.pair() / self.plan.motions.len()
    }

    pub(crate) fn motion_number(&self) -> usize {
        self.pair() % self.plan.motions.len()
    }

    fn factor(&self) -> f64 {
        self.motion.scale * self.scale
    }

    /// The structure's number on `axis`, one of [`AXES`], to the bit as it was given; NaN if a building has none.
    pub fn value(&self, axis: &Quantity<Parameters>) -> f64 {
        let varying = self.population.values(self.member).find(|(varying, _)| *varying == axis.name);
        varying.map_or_else(|| (axis.get)(&self.structure.parameters()), |(_, value)| value)
    }
}

pub fn measure(name: &str) -> Result<IntensityMeasure, Refused> {
    let is_unknown = || {
        let spectral = ["S_a(1 s)", "S_a(1 s, 2 %)"].map(Cow::from);
        let known = [&IntensityMeasure::ALL.map(IntensityMeasure::name)[..], &spectral].concat();
        Refused::by(unknown(format_args!("intensity = {name:?} is unknown"), name, &known))
    };
    IntensityMeasure::read(name).ok_or_else(is_unknown)
}

fn is_empty(name: &str) -> String {
    format!("{name} is empty: give one or more")
}

fn is_there_twice(what: &str) -> String {
    format!("{what} is there twice and would count twice: leave one out")
}

fn check_names<'a>(kind: &str, names: impl Iterator<Item = &'a String>) -> Result<(), Refused> {
    let mut seen = HashSet::new();
    let repeated = { names }.find(|name| !seen.insert(*name));
    ensure(repeated.is_none(), || {
        format!("two {kind} have the name {:?}: rename one or leave one out", repeated.map_or("", String::as_str))
    })
}

/// Finite numbers, one or more, each of them once.
fn check_list(name: &str, values: &[f64]) -> Result<(), Refused> {
    if let Some(value) = values.iter().find(|value| !value.is_finite()) {
        return Err(Refused::by(format!("{name} = {value} is not a finite number")));
    }
    ensure(!values.is_empty(), || is_empty(name))?;
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    match sorted.windows(2).find(|pair| pair[0] == pair[1]) {
        Some(pair) => Err(Refused::by(is_there_twice(&format!("{name} = {}", with_unit(pair[0], "1"))))),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::exceedances::count;
    use crate::outcome::Limit;
    use rocking::estimates::response_spectrum::{FloorContents, floor_spectra};
    use rocking::run::{End, Ending};
    use rocking::structure::description::{Damping, Storey};
    use rocking::structure::natural_quantities::Numbers;
    use rocking::{OneMass, Output};
    use std::collections::BTreeMap;
    use std::f64::consts::TAU;

    /// A full sine of 0.5 s and 0.6 g that ends with its last sample.
    fn pulse() -> NamedRecord {
        let times: Vec<_> = (0..=50).map(|i| f64::from(i) * 0.01).collect();
        let acceleration = times.iter().map(|time| 0.6 * 9.81 * (TAU * time / 0.5).sin()).collect();
        NamedRecord::new("pulse", Record::from_samples("", times, acceleration).unwrap(), 1.0).unwrap()
    }

    /// A plan under the usual conditions.
    fn usual(populations: Vec<Population>, motions: Vec<NamedRecord>, scales: Vec<f64>) -> Plan {
        Plan::new(populations, motions, scales, Conditions::default()).unwrap()
    }

    fn structure(parameters: Parameters) -> Structure {
        Structure::new(parameters).unwrap()
    }

    /// The bits are those of the library, run by run, contents included; a limit on all floors counts the largest of them.
    #[test]
    fn a_building_is_swept_and_counted() {
        let storeys = [(4e4, 3.5, 6e7), (4e4, 7.0, 5e7), (3e4, 10.5, 4e7)].map(|(m, h, k)| Storey { m, h, k });
        let core = |k_t| {
            let base = Numbers::of(&[("m0", 20e3), ("J0", 3e4), ("B", 1.5), ("k_t", k_t)]).unwrap();
            Structure::from_storeys(&base, &Damping::All(0.02), &storeys).unwrap()
        };
        let cores = Population::new("cores", core(0.0)).vary("k_t", vec![0.0, 1e6]).unwrap();
        let pier = Population::new("pier", structure(Parameters::MCMANUS));
        let slow = NamedRecord::new("slow", pulse().record.scaled(2.0, 1.0).unwrap(), 1.0).unwrap();
        let plan = usual(vec![cores, pier], vec![pulse(), slow], vec![0.3, 0.6, 0.9, 1.2]);
        let contents = [(2, 0.1, 0.05, "S_a[3](0.1 s)"), (0, 0.3, 0.02, "S_a[1](0.30 s, 2 %)")];
        let plan = plan.with_contents(&contents.map(|(.., name)| name.into())).unwrap();
        let contents = contents.map(|(floor, T, zeta, _)| FloorContents { floor, T, zeta });
        let (outcomes, mut largest) = (Vec::from_iter(plan.cases().map(|case| case.outcome())), Vec::new());
        for (case, outcome) in plan.cases().zip(&outcomes).take(16) {
            let ground = case.motion.record.clone().multiplied(case.scale);
            let structure = core(if largest.len() < 8 { 0.0 } else { 1e6 });
            let run = Run::of_modes(structure.clone(), &ground);
            let found = run.found(&mut ()).unwrap();
            let Outcome::Ended(Summary { ending, end, peaks, .. }) = outcome else { panic!() };
            assert_eq!((*ending, *end), (found.finish.ending, found.finish.motion.time));
            let named: BTreeMap<_, _> = plan.measures.iter().map(|(name, _)| &**name).zip(peaks).collect();
            for of in Output::with_peak(&structure) {
                assert_eq!(*named[&*of.name(&structure)], found.peaks.of(of).unwrap().magnitude, "{of:?}");
            }
            let until = found.fall.unwrap_or(found.finish.motion.time);
            let expected = floor_spectra(&run, until, &contents, &mut ()).unwrap();
            assert_eq!(["S_a[3](0.1 s)", "S_a[1](0.3 s, 2 %)"].map(|name| *named[name])[..], expected);
            largest.push(["a_t[1]", "a_t[2]", "a_t[3]"].map(|a_t| *named[a_t]).into_iter().fold(0.0, f64::max));
        }
        let limits = ["a_t >= 0.5 g", "drift[2] >= 15 mm", "S_a[3](0.1 s) >= 1 g"]
            .map(|text| Limit::read(text, &plan.measures).unwrap());
        let [cores, pier] = &count(&plan, IntensityMeasure::Pga, &limits, &outcomes)[..] else { panic!() };
        let exceeding = |of: usize| cores.fragilities[of].tallies.iter().map(|tally| tally.exceedances).sum::<usize>();
        let own = largest.iter().filter(|a_t| **a_t >= 0.5 * 9.81).count();
        assert!((1..16).contains(&own), "{largest:?}");
        assert_eq!(exceeding(1), own);
        assert!((1..16).contains(&exceeding(3)));
        for not_of_pier in [2, 3] {
            assert_eq!(pier.fragilities[not_of_pier].curve, Err(Refused::by("no run is counted")));
        }
        let refused = plan.clone().with_contents(&["S_a[4](1 s)".into()]).unwrap_err().to_string();
        assert_eq!(refused, "S_a[4](1 s): no structure has a floor 4");
    }

    #[test]
    fn cases_are_all_combinations_in_order() {
        let piers =
            Population::new("piers", structure(Parameters::MCMANUS)).vary("slenderness", vec![4.0, 6.3]).unwrap();
        let piers = piers.vary("B", vec![0.3, 0.2, 0.1]).unwrap();
        let wall = Population::new("wall", structure(Parameters::EVISON));
        let halved = NamedRecord::new("half", pulse().record, 0.5).unwrap();
        let plan = usual(vec![piers, wall], vec![pulse(), halved], vec![1.0, -2.0]);
        assert_eq!((plan.size(), plan.len()), ([7, 2, 2], 28));
        let [axis_B, slenderness] =
            ["B", "slenderness"].map(|name| *AXES.iter().find(|axis| axis.name == name).unwrap());
        let cases: Vec<_> = plan.cases().collect();
        let column = |of: fn(&Case, [&Quantity<Parameters>; 2]) -> f64, step| {
            cases.iter().step_by(step).map(|case| of(case, [axis_B, slenderness])).collect::<Vec<_>>()
        };
        assert_eq!(column(|case, _| case.scale, 1)[..3], [1.0, -2.0, 1.0]);
        assert_eq!(column(|case, [B, _]| case.value(B), 4), [0.3, 0.3, 0.2, 0.2, 0.1, 0.1, 0.285]);
        assert_eq!(column(|case, [_, slenderness]| case.value(slenderness), 4)[..3], [4.0, 6.3, 4.0]);
        assert_eq!(column(|case, _| case.structure.parameters().H, 4)[1], 6.3 * 0.3);
        let both = Population::of("both", [Parameters::EVISON, Parameters::MCMANUS].map(structure).into()).unwrap();
        let both = usual(vec![both.vary("r", vec![0.9, 0.8]).unwrap()], vec![pulse()], vec![1.0]);
        let numbers = both.cases().map(|case| (case.structure.parameters().m, case.structure.parameters().r));
        assert_eq!(numbers.collect::<Vec<_>>(), [(125.8, 0.9), (125.8, 0.8), (130.1, 0.9), (130.1, 0.8)]);
        assert!(
            Population::of("none", Vec::new()).unwrap_err().to_string().starts_with("structures \"none\" is empty")
        );
        assert_eq!(cases[26..].iter().map(|case| &case.motion.name).collect::<Vec<_>>(), ["half"; 2]);
        assert_eq!(cases[27].population.name, "wall");
    }

    /// Against the run itself: the same conditions, the same bits.
    #[test]
    fn conditions_are_those_of_every_run() {
        let initial = State { theta: 0.05, u: vec![1e-3], ..State::default() };
        let (detail, duration) = (Detail::Linear, Some(0.7));
        let conditions = Conditions { initial, detail, tolerance: 1e-6, duration, ..Conditions::default() };
        let pier = Population::new("pier", structure(Parameters::MCMANUS));
        let plan = Plan::new(vec![pier], vec![pulse()], vec![0.5], conditions.clone()).unwrap();
        let ground = pulse().record.multiplied(0.5);
        let Conditions { detail, tolerance, .. } = conditions;
        let usual = Run::new(OneMass::new(Parameters::MCMANUS).unwrap(), &ground);
        let initial = State { theta: 0.05, u: 1e-3, ..State::default() };
        let run = Run { initial, detail, tolerance, end: End::At(0.7), ..usual.clone() };
        let outcome = |run: &Run| plan.case(0).outcome_of(run, run.found(&mut ()));
        assert_eq!(plan.case(0).outcome(), outcome(&run));
        let Outcome::Ended(Summary { ending, end, .. }) = plan.case(0).outcome() else { panic!() };
        assert_eq!((ending, end), (Ending::AtTime, 0.7));
        assert_ne!(plan.case(0).outcome(), outcome(&Run { detail: Detail::Auto, ..run }));
        assert_ne!(plan.case(0).outcome(), outcome(&usual));
    }

    /// A record with a factor of its own is the record with its samples multiplied; measures grow with it.
    #[test]
    fn a_record_may_have_a_scale_of_its_own() {
        let piers = || Population::new("piers", structure(Parameters::MCMANUS)).vary("f_fc", vec![2.0, 5.0]).unwrap();
        let own = NamedRecord::new("own", pulse().record, -0.5).unwrap();
        let multiplied = NamedRecord::new("multiplied", pulse().record.multiplied(-0.5), 1.0).unwrap();
        let plan = usual(vec![piers()], vec![pulse(), own, multiplied], vec![2.0]);
        for structure in [0, 3] {
            let [whole, own, multiplied] = [0, 1, 2].map(|motion| plan.case(structure + motion));
            assert_eq!(own.outcome(), multiplied.outcome());
            for measure in IntensityMeasure::ALL {
                let [whole, own, multiplied] = [&whole, &own, &multiplied].map(|case| case.intensity(measure));
                let factor = match measure {
                    IntensityMeasure::Duration => 1.0,
                    IntensityMeasure::Arias => 0.25,
                    _ => 0.5,
                };
                for expected in [multiplied, factor * whole] {
                    assert!((own - expected).abs() <= 1e-14 * own, "{measure:?}: {own} {expected}");
                }
            }
        }
        let [f_2, f_5] = [0, 3].map(|index| plan.case(index).intensity(IntensityMeasure::Sa));
        let at = |text| plan.case(0).intensity(measure(text).unwrap());
        let of = |T, zeta| 2.0 * spectral_acceleration(&pulse().record, T, zeta) / 9.81;
        let texts = ["S_a(1.0 s)", "S_a(1 s, 2 %)", "S_a(0.3s)"];
        assert_eq!(texts.map(at), [of(1.0, 0.05), of(1.0, 0.02), of(0.3, 0.05)]);
        assert_eq!(measure(texts[0]).unwrap().name(), "S_a(1 s)");
        for unknown in ["S_a(0 s)", "S_a(1)", "S_a(1 s, 2)"] {
            assert!(measure(unknown).unwrap_err().to_string().starts_with(&format!("intensity = {unknown:?} is")));
        }
        let expected = |T| 2.0 * spectral_acceleration(&pulse().record, T, 0.02) / 9.81;
        assert_eq!([f_2, f_5], [0.5, 0.2].map(expected));
        assert_eq!([0, 1, 2, 3, 4, 5].map(|index| plan.case(index).group), [0, 1, 2, 0, 1, 2]);
        let alone = usual(vec![piers()], vec![pulse()], vec![1.0, 2.0]);
        assert_eq!([0, 1, 2, 3].map(|index| alone.case(index).group), [0, 0, 1, 1]);
    }
}
