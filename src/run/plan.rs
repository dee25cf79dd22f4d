//! Many runs: every structure of some populations under every ground motion at every scale factor.

use super::Run;
use super::outcome::Outcome;
use crate::parameters::{MAX_SLENDERNESS, PARAMETERS, ParameterError};
use crate::record::Record;
use crate::{Parameters, Quantity, Structure, Watch};

/// More runs than this are refused: thousands of runs a second take hours for them.
pub const MAX_RUNS: usize = 10_000_000;

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

/// What can vary; slenderness last, so that it applies to the B of the same structure.
pub const AXES: [&Quantity<Parameters>; PARAMETERS.len() + 1] = {
    const OWN: &[Quantity<Parameters>; PARAMETERS.len()] = &PARAMETERS;
    let mut axes = [&SLENDERNESS; OWN.len() + 1];
    let mut i = 0;
    while i < OWN.len() {
        axes[i] = &OWN[i];
        i += 1;
    }
    axes
};

/// Structures that count together: one in which some numbers vary, in every combination.
#[derive(Clone, Debug)]
pub struct Population {
    name: String,
    base: Parameters,
    /// Positions in [`AXES`], increasing, and the values there.
    varying: Vec<(usize, Vec<f64>)>,
}

/// A ground motion record under a name.
#[derive(Clone, Debug)]
pub struct NamedRecord {
    name: String,
    record: Record,
    /// Peak ground acceleration, m/s².
    pga: f64,
}

/// Populations × ground motions × scale factors.
#[derive(Clone, Debug)]
pub struct Plan {
    populations: Vec<Population>,
    motions: Vec<NamedRecord>,
    scales: Vec<f64>,
}

/// One run of a plan.
#[derive(Clone, Debug)]
pub struct Case<'a> {
    /// What the structure is one of.
    pub population: &'a Population,
    /// Which one, counted from 0.
    member: usize,
    /// The structure.
    pub structure: Structure,
    /// The ground motion before it is scaled.
    pub motion: &'a NamedRecord,
    /// Factor on its acceleration.
    pub scale: f64,
}

/// Why there is no plan.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum PlanError {
    /// Nothing to run.
    #[error("{0} is empty: give one or more")]
    Empty(String),
    /// A value is NaN or infinite.
    #[error("{name} = {value} is not a finite number")]
    NotFinite {
        /// What is listed.
        name: String,
        /// The refused value.
        value: f64,
    },
    /// Something would be counted twice.
    #[error("{0} is there twice and would count twice: leave one out")]
    Repeated(String),
    /// Two populations cannot be told apart.
    #[error("two populations have the name {0:?}: rename one")]
    SameName(String),
    /// No parameter is called that.
    #[error("{name:?} cannot vary: these can: {}", AXES.map(|axis| axis.name).join(", "))]
    Unknown {
        /// The refused name.
        name: String,
    },
    /// Two axes set one number.
    #[error("H and slenderness cannot both vary: slenderness sets H")]
    HeightTwice,
    /// A scale factor of 0.
    #[error("scale = 0 leaves no ground motion: leave it out")]
    NoScale,
    /// A ground motion without motion has no intensity.
    #[error("{0}: the ground acceleration is 0 throughout")]
    NoMotion(String),
    /// A structure is impossible.
    #[error("structures {population:?}: {source}")]
    Structure {
        /// Its population.
        population: String,
        /// What is wrong with it.
        source: ParameterError,
    },
    /// More than [`MAX_RUNS`].
    #[error("{structures} structures x {motions} ground motions x {scales} scale factors: more than {MAX_RUNS} runs")]
    TooMany {
        /// Structures, or more.
        structures: usize,
        /// Ground motions.
        motions: usize,
        /// Scale factors.
        scales: usize,
    },
}

impl Population {
    /// Of the one structure `base`, until something varies.
    pub fn new(name: impl Into<String>, base: Parameters) -> Population {
        Population { name: name.into(), base, varying: Vec::new() }
    }

    /// Every structure that there is so far with each of `values` of the parameter called `name`, or of `slenderness`,
    /// which is H/B: H = slenderness × B, while B, m, m0, J0 and f_fc stay.
    pub fn vary(mut self, name: &str, values: Vec<f64>) -> Result<Population, PlanError> {
        let axis =
            AXES.iter().position(|axis| axis.name == name).ok_or_else(|| PlanError::Unknown { name: name.into() })?;
        check_list(name, &values)?;
        match self.varying.binary_search_by_key(&axis, |(axis, _)| *axis) {
            Ok(_) => return Err(PlanError::Repeated(name.into())),
            Err(position) => self.varying.insert(position, (axis, values)),
        }
        let varies = |name| self.varying.iter().any(|(axis, _)| AXES[*axis].name == name);
        if varies("H") && varies(SLENDERNESS.name) {
            return Err(PlanError::HeightTwice);
        }
        Ok(self)
    }

    /// What it is called.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// How many structures there are, or [`usize::MAX`] if there are more.
    fn len(&self) -> usize {
        self.varying.iter().fold(1, |len, (_, values)| len.saturating_mul(values.len()))
    }

    /// What varies, and its value in structure `member`: the last axis changes first.
    fn values(&self, member: usize) -> impl Iterator<Item = (&'static Quantity<Parameters>, f64)> {
        let mut stride = self.len();
        self.varying.iter().map(move |(axis, values)| {
            stride /= values.len();
            (AXES[*axis], values[member / stride % values.len()])
        })
    }

    fn structure(&self, member: usize) -> Result<Structure, PlanError> {
        let mut parameters = self.base;
        self.values(member).for_each(|(axis, value)| (axis.set)(&mut parameters, value));
        Structure::new(parameters).map_err(|source| PlanError::Structure { population: self.name.clone(), source })
    }
}

impl NamedRecord {
    /// The ground motion `record`, which must not be at rest throughout.
    pub fn new(name: impl Into<String>, record: Record) -> Result<NamedRecord, PlanError> {
        let (name, pga) = (name.into(), record.pga());
        if pga > 0.0 { Ok(NamedRecord { name, record, pga }) } else { Err(PlanError::NoMotion(name)) }
    }

    /// What it is called.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its samples.
    pub fn record(&self) -> &Record {
        &self.record
    }
}

impl Plan {
    /// Every structure of `populations` under each of `motions` times each of `scales`.
    pub fn new(populations: Vec<Population>, motions: Vec<NamedRecord>, scales: Vec<f64>) -> Result<Plan, PlanError> {
        check_list("scale", &scales)?;
        if scales.contains(&0.0) {
            return Err(PlanError::NoScale);
        }
        for (name, is_empty) in [("structures", populations.is_empty()), ("records", motions.is_empty())] {
            if is_empty {
                return Err(PlanError::Empty(name.into()));
            }
        }
        for (i, one) in populations.iter().enumerate() {
            if populations[..i].iter().any(|other| other.name == one.name) {
                return Err(PlanError::SameName(one.name.clone()));
            }
        }
        for (i, one) in motions.iter().enumerate() {
            if motions[..i].iter().any(|other| other.name == one.name && other.record == one.record) {
                return Err(PlanError::Repeated(format!("the ground motion {:?}", one.name)));
            }
        }
        let plan = Plan { populations, motions, scales };
        let [structures, motions, scales] = plan.size();
        if structures.saturating_mul(motions).saturating_mul(scales) > MAX_RUNS {
            return Err(PlanError::TooMany { structures, motions, scales });
        }
        for population in &plan.populations {
            (0..population.len()).try_for_each(|member| population.structure(member).map(|_| ()))?;
        }
        Ok(plan)
    }

    /// Numbers of structures, ground motions and scale factors.
    pub fn size(&self) -> [usize; 3] {
        let structures = self.populations.iter().fold(0, |sum: usize, population| sum.saturating_add(population.len()));
        [structures, self.motions.len(), self.scales.len()]
    }

    /// The populations.
    pub fn populations(&self) -> &[Population] {
        &self.populations
    }

    /// The ground motions.
    pub fn motions(&self) -> &[NamedRecord] {
        &self.motions
    }

    /// The scale factors.
    pub fn scales(&self) -> &[f64] {
        &self.scales
    }

    /// How many runs there are.
    #[expect(clippy::len_without_is_empty, reason = "a plan is never empty")]
    pub fn len(&self) -> usize {
        self.size().into_iter().product()
    }

    /// Run `index` < [`Plan::len`]: scale factors change first, then ground motions, then structures.
    pub fn case(&self, index: usize) -> Case<'_> {
        let (rest, scale) = (index / self.scales.len(), self.scales[index % self.scales.len()]);
        let (mut member, motion) = (rest / self.motions.len(), &self.motions[rest % self.motions.len()]);
        let mut populations = self.populations.iter();
        let population = populations.find(|population| {
            let is_of_it = member < population.len();
            member -= if is_of_it { 0 } else { population.len() };
            is_of_it
        });
        let population = population.expect("the plan has such a run");
        let structure = population.structure(member).expect("the plan has been checked");
        Case { population, member, structure, motion, scale }
    }

    /// Every run, in this order.
    pub fn cases(&self) -> impl Iterator<Item = Case<'_>> {
        (0..self.len()).map(|index| self.case(index))
    }
}

impl Case<'_> {
    /// Does it.
    pub fn outcome(&self) -> Outcome {
        self.outcome_watched(&mut ())
    }

    /// Does it while `watch` sees it go by.
    pub fn outcome_watched(&self, watch: &mut impl Watch) -> Outcome {
        let ground = self.motion.record.clone().scaled(1.0, self.scale);
        Outcome::of(&Run::new(self.structure, &ground), watch)
    }

    /// Peak ground acceleration, g.
    pub fn intensity(&self) -> f64 {
        self.motion.pga * self.scale.abs() / self.structure.parameters().g
    }

    /// The structure's number on `axis`, one of [`AXES`], to the bit as it was given.
    pub fn value(&self, axis: &Quantity<Parameters>) -> f64 {
        let varying = self.population.values(self.member).find(|(varying, _)| varying.name == axis.name);
        varying.map_or_else(|| (axis.get)(self.structure.parameters()), |(_, value)| value)
    }
}

/// Finite numbers, one or more, each of them once.
fn check_list(name: &str, values: &[f64]) -> Result<(), PlanError> {
    if let Some(&value) = values.iter().find(|value| !value.is_finite()) {
        return Err(PlanError::NotFinite { name: name.into(), value });
    }
    let mut sorted = values.to_vec();
    sorted.sort_unstable_by(f64::total_cmp);
    match sorted.windows(2).find(|pair| pair[0] == pair[1]) {
        Some(pair) => Err(PlanError::Repeated(format!("{name} = {}", pair[0]))),
        None if values.is_empty() => Err(PlanError::Empty(name.into())),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fragility::Trials;
    use crate::run::outcome::{Limit, MEASURES, Summary};
    use crate::run::{End, Ending};
    use std::f64::consts::{FRAC_PI_2, TAU};

    /// A full sine of 0.5 s and 0.6 g that ends with its last sample.
    fn pulse() -> NamedRecord {
        let times: Vec<_> = (0..=50).map(|i| f64::from(i) * 0.01).collect();
        let acceleration = times.iter().map(|time| 0.6 * 9.81 * (TAU * time / 0.5).sin()).collect();
        NamedRecord::new("pulse", Record::from_samples("", times, acceleration).unwrap()).unwrap()
    }

    fn only(base: Parameters, scale: f64) -> Outcome {
        let plan = Plan::new(vec![Population::new("only", base)], vec![pulse()], vec![scale]).unwrap();
        assert_eq!(plan.len(), 1);
        plan.case(0).outcome()
    }

    /// With the record's last sample it still stands, and overturns in free motion.
    #[test]
    fn a_structure_has_until_it_is_at_rest_to_overturn() {
        let Outcome::Ended(Summary { ending, end, peaks, .. }) = only(Parameters::MCMANUS, 1.5) else { panic!() };
        assert_eq!((ending, peaks[0]), (Ending::Overturned, FRAC_PI_2));
        assert!((end - 2.96).abs() < 0.005, "{end}");
        assert_eq!(MEASURES[0], ("theta", "rad"));
        assert_eq!(peaks[7], FRAC_PI_2 / Structure::new(Parameters::MCMANUS).unwrap().tan_alpha_cg.atan());

        let Outcome::Ended(standing) = only(Parameters::MCMANUS, 1.0) else { panic!() };
        assert_eq!(standing.ending, Ending::AtRest);
        assert!(standing.end > 0.5 && standing.transitions > 0);
    }

    /// A slow structure has hardly begun to vibrate when the record ends.
    #[test]
    fn the_vibration_after_a_record_counts() {
        let slow = Parameters { m0: 0.0, J0: 0.0, f_fc: 0.2, ..Parameters::MCMANUS };
        let Outcome::Ended(found) = only(slow, 1.0) else { panic!() };
        let long = Run { end: End::At(20.0), ..Run::new(Structure::new(slow).unwrap(), &pulse().record) }.peaks();
        let (peaks, _) = long.unwrap();
        assert_eq!(found.ending, Ending::AtRest);
        for (name, found, expected) in [("u", found.peaks[1], peaks.u()), ("a_t", found.peaks[4], peaks.a_t())] {
            assert!((found - expected.magnitude).abs() < 1e-12 * found, "{name}: {found}, {expected:?}");
        }
    }

    #[test]
    fn a_run_that_cannot_be_continued_has_an_outcome() {
        let Outcome::Failed(reason) = only(Parameters { m0: 0.0, J0: 0.0, f_fc: 0.2, ..Parameters::MCMANUS }, 6.0)
        else {
            panic!()
        };
        assert!(reason.contains("cannot be continued beyond t = 0.51"), "{reason}");
    }

    #[test]
    fn cases_are_all_combinations_in_order() {
        let piers = Population::new("piers", Parameters::MCMANUS).vary("slenderness", vec![4.0, 6.3]).unwrap();
        let piers = piers.vary("B", vec![0.3, 0.2, 0.1]).unwrap();
        let wall = Population::new("wall", Parameters::EVISON);
        let scaled = NamedRecord::new("half", pulse().record.scaled(1.0, 0.5)).unwrap();
        let plan = Plan::new(vec![piers, wall], vec![pulse(), scaled], vec![1.0, -2.0]).unwrap();
        assert_eq!((plan.size(), plan.len()), ([7, 2, 2], 28));
        let [axis_B, slenderness] = [AXES[3], AXES[10]];
        let cases: Vec<_> = plan.cases().collect();
        let column = |of: fn(&Case, [&Quantity<Parameters>; 2]) -> f64, step| {
            cases.iter().step_by(step).map(|case| of(case, [axis_B, slenderness])).collect::<Vec<_>>()
        };
        assert_eq!(column(|case, _| case.scale, 1)[..3], [1.0, -2.0, 1.0]);
        assert_eq!(column(|case, [B, _]| case.value(B), 4), [0.3, 0.3, 0.2, 0.2, 0.1, 0.1, 0.285]);
        assert_eq!(column(|case, [_, slenderness]| case.value(slenderness), 4)[..3], [4.0, 6.3, 4.0]);
        assert_eq!(column(|case, _| case.structure.parameters().H, 4)[1], 6.3 * 0.3);
        let pga = 0.6 * (TAU * 0.12 / 0.5).sin();
        for (intensity, expected) in column(|case, _| case.intensity(), 1).into_iter().zip([pga, 2.0 * pga, 0.5 * pga])
        {
            assert!((intensity - expected).abs() < 1e-15);
        }
        assert_eq!(cases[26..].iter().map(|case| case.motion.name()).collect::<Vec<_>>(), ["half"; 2]);
        assert_eq!(cases[27].population.name(), "wall");
    }

    #[test]
    fn trials_are_counted_from_outcomes() {
        let scales = [0.1, 1.25, 3.0];
        let piers = Population::new("piers", Parameters::MCMANUS).vary("f_fc", vec![3.0, 4.0, 5.0]).unwrap();
        let plan = Plan::new(vec![piers], vec![pulse()], scales.into()).unwrap();
        let overturned = |case: Case| (case.intensity(), case.outcome().exceeds(&Limit::Overturning));
        let trials = Trials::count(plan.cases().map(overturned));
        let expected = scales.map(|scale| {
            let ground = pulse().record.scaled(1.0, scale);
            let overturns = |f_fc: &&f64| {
                let structure = Structure::new(Parameters { f_fc: **f_fc, ..Parameters::MCMANUS }).unwrap();
                Run::new(structure, &ground).peaks().unwrap().1.ending == Ending::Overturned
            };
            (3, [3.0, 4.0, 5.0].iter().filter(overturns).count())
        });
        assert_eq!(trials.iter().map(|at| (at.runs, at.exceedances)).collect::<Vec<_>>(), expected);
        assert_ne!(expected[0], expected[2]);
    }

    #[test]
    fn a_refused_plan_says_what_to_change() {
        let pier = || Population::new("pier", Parameters::MCMANUS);
        let plan = |populations, motions, scales| Plan::new(populations, motions, scales).unwrap_err().to_string();
        let scale = |scales| plan(vec![pier()], vec![pulse()], scales);
        assert_eq!(scale(vec![]), "scale is empty: give one or more");
        assert_eq!(scale(vec![1.0, 0.0]), "scale = 0 leaves no ground motion: leave it out");
        assert_eq!(scale(vec![1.0, f64::NAN]), "scale = NaN is not a finite number");
        assert_eq!(scale(vec![1.0, 2.0, 1.0]), "scale = 1 is there twice and would count twice: leave one out");
        assert_eq!(plan(vec![], vec![pulse()], vec![1.0]), "structures is empty: give one or more");
        assert_eq!(plan(vec![pier()], vec![], vec![1.0]), "records is empty: give one or more");
        assert_eq!(
            plan(vec![pier(); 2], vec![pulse()], vec![1.0]),
            "two populations have the name \"pier\": rename one"
        );
        assert_eq!(
            plan(vec![pier()], vec![pulse(), pulse()], vec![1.0]),
            "the ground motion \"pulse\" is there twice and would count twice: leave one out"
        );
        let slender = pier().vary("slenderness", vec![1.0, 2000.0]).unwrap();
        assert!(plan(vec![slender], vec![pulse()], vec![1.0]).starts_with("structures \"pier\": H/B = 2000"));

        let many = || (1..=4000).map(f64::from).collect::<Vec<_>>();
        let huge = PARAMETERS.iter().fold(pier(), |pier, axis| pier.vary(axis.name, many()).unwrap());
        assert!(plan(vec![huge], vec![pulse()], vec![1.0]).contains(": more than 10000000 runs"));
        assert_eq!(
            plan(vec![pier().vary("H", many()).unwrap()], vec![pulse()], many()),
            "4000 structures x 1 ground motions x 4000 scale factors: more than 10000000 runs"
        );

        let vary =
            |name: &str, values| pier().vary("H", vec![1.0]).unwrap().vary(name, values).unwrap_err().to_string();
        assert!(vary("q", vec![1.0]).starts_with("\"q\" cannot vary: these can: m, m0, H, B, J0, f_fc"));
        assert_eq!(vary("slenderness", vec![4.0]), "H and slenderness cannot both vary: slenderness sets H");
        assert_eq!(vary("H", vec![4.0]), "H is there twice and would count twice: leave one out");
        assert_eq!(vary("r", vec![]), "r is empty: give one or more");
        assert_eq!(vary("m0", vec![0.0, -0.0]), "m0 = -0 is there twice and would count twice: leave one out");
        let at_rest = NamedRecord::new("rest", Record::at_rest(1.0)).unwrap_err();
        assert_eq!(at_rest.to_string(), "rest: the ground acceleration is 0 throughout");
    }
}
