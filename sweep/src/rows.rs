//! The rows of a sweep: headings, and what they say of each run; and the sweep that goes on where its rows end.
//!
//! A run's key stands for names, parameters, samples, scale factors, conditions, the build of the program.

use crate::outcome::{MEASURES, Outcome};
use crate::plan::{AXES, Case, Conditions, NamedRecord, Plan};
use crate::row_file::{Known, Program, RowFile, digest, fixed, heading, line};
use anyhow::ensure;
use csv::StringRecord;
use rocking::estimates::intensity::IntensityMeasure;
use rocking::mechanics::state::INITIAL_VALUES;
use rocking::run::validity::{ASSUMPTIONS, Findings, Limits, Validity};
use std::collections::{HashMap, HashSet};
use std::path::Path;
use std::ptr;
use uuid::Uuid;

/// The word for the ending of a run that has none.
const FAILED: &str = "failed";

/// A plan with the rows of its runs, as far as they are done.
#[derive(Debug)]
pub struct Sweep<'a> {
    plan: &'a Plan,
    program: &'a Program,
    validity: bool,
    keys: Vec<Key>,
    outcomes: Vec<Option<Outcome>>,
    file: RowFile,
    /// Rows of the file that are not of this sweep.
    pub others: Known<Outcome>,
}

impl<'a> Sweep<'a> {
    /// Opens the file of rows at `path`, or begins it, and finds the runs of `plan` that are in it; with `validity` a
    /// row says what its run goes beyond, too. Refuses runs that are the same, and rows that are not of a sweep.
    pub fn open(plan: &'a Plan, validity: bool, program: &'a Program, path: &Path) -> anyhow::Result<Sweep<'a>> {
        let keys = keys(plan, validity, program);
        ensure!(
            keys.iter().map(|key| key.run).collect::<HashSet<_>>().len() == keys.len(),
            "two runs are the same: values that vary differ by less than a rounding error"
        );
        let (file, mut known) = open(path)?;
        let outcomes: Vec<_> = keys.iter().map(|key| known.take(&key.run)).collect();
        Ok(Sweep { plan, program, validity, keys, outcomes, file, others: known })
    }

    /// The runs that are not done.
    pub fn missing(&self) -> Vec<usize> {
        (0..self.plan.len()).filter(|index| self.outcomes[*index].is_none()).collect()
    }

    /// Does the runs that are not done, on all threads, and adds their rows as they end; after each `goes_on` is asked.
    /// The key of every run of the plan, which its row begins with, and what became of it.
    pub fn finish(mut self, goes_on: impl Fn() -> bool + Sync) -> anyhow::Result<(Vec<Uuid>, Vec<Outcome>)> {
        let run = |&index: &usize| {
            let case = self.plan.case(index);
            let found = Findings::since(case.motion.record().start());
            let mut validity = self.validity.then(|| Validity::new(&case.structure, Limits::default(), found));
            let outcome = match &mut validity {
                Some(validity) => case.outcome_watched(validity),
                None => case.outcome(),
            };
            let beyond = validity.as_ref().map(Validity::found);
            Ok((row(&self.keys[index], &case, &outcome, beyond, self.program)?, (index, outcome)))
        };
        let done = self.file.do_runs(&self.missing(), run, goes_on)?;
        done.into_iter().for_each(|(index, outcome)| self.outcomes[index] = Some(outcome));
        let outcomes = self.outcomes.into_iter().map(|outcome| outcome.expect("every run is done"));
        Ok((self.keys.into_iter().map(|key| key.run).collect(), outcomes.collect()))
    }
}

/// Identities of a run and of its record.
#[derive(Debug)]
struct Key {
    /// Stands for all that the run depends on.
    run: Uuid,
    /// Stands for the samples of its record, whatever its file is called.
    record: Uuid,
}

/// The key of each run of `plan`, which is another one where it is asked what a run goes beyond.
fn keys(plan: &Plan, validity: bool, program: &Program) -> Vec<Key> {
    let of_motion = |of: &NamedRecord| {
        let samples = (of.record().times(), of.record().acceleration());
        let digest = match of.record().vertical() {
            None => digest(&Uuid::NAMESPACE_OID, &samples),
            Some(vertical) => digest(&Uuid::NAMESPACE_OID, &(samples, vertical)),
        };
        (ptr::from_ref(of), digest)
    };
    let digests: HashMap<_, _> = plan.motions().iter().map(of_motion).collect();
    let of_case = |case: Case| {
        let names = (case.population.name(), case.motion.name());
        let record = digests[&ptr::from_ref(case.motion)];
        let motion = (record.into_bytes(), case.motion.scale(), case.scale);
        Key { run: program.key(&(names, case.structure.parameters(), motion, case.conditions, validity)), record }
    };
    plan.cases().map(of_case).collect()
}

/// Opens the file at `path`, or begins it, and reads what its rows say.
fn open(path: &Path) -> anyhow::Result<(RowFile, Known<Outcome>)> {
    let headings = headings();
    let at = |heading: &str| headings.iter().position(|found| found == heading).expect("it is one of them");
    let (ending, after, reason) = (at("ending"), at("evaluations") + 1, at("reason"));
    RowFile::open(path, &headings, |row| {
        if &row[ending] == FAILED {
            return Ok(Outcome::Failed { time: row[ending + 1].parse()?, reason: row[reason].into() });
        }
        let summary: StringRecord = row.iter().take(after).skip(ending).collect();
        Ok(Outcome::Ended(summary.deserialize(None)?))
    })
}

/// Headings of the rows.
fn headings() -> Vec<String> {
    let quantities = AXES.map(|axis| heading(axis.name, axis.unit));
    let intensities = IntensityMeasure::ALL.map(|measure| heading(measure.name(), measure.unit()));
    let initial = INITIAL_VALUES.each_ref().map(|quantity| heading(quantity.name, quantity.unit));
    let peaks = MEASURES.map(|(name, unit)| heading(&format!("peak_{name}"), unit));
    [
        fixed(&["run", "structures", "version"]),
        quantities.into(),
        fixed(&["record", "record_digest", "record_scale", "scale"]),
        intensities.into(),
        fixed(&["detail", "tolerance", "duration[s]"]),
        initial.into(),
        fixed(&["ending", "end[s]"]),
        peaks.into(),
        fixed(&["transitions", "steps", "evaluations"]),
        ASSUMPTIONS.iter().flat_map(|of| [of.name.to_owned(), heading(of.time_name, "s")]).collect(),
        fixed(&["energy_gains", "settlings", "reason"]),
    ]
    .concat()
}

/// The row of a run.
fn row(
    key: &Key,
    case: &Case,
    outcome: &Outcome,
    beyond: Option<&Findings>,
    program: &Program,
) -> anyhow::Result<Vec<u8>> {
    let values = AXES.map(|axis| case.value(axis));
    let structure = (key.run.to_string(), case.population.name(), &program.version, values);
    let intensities = IntensityMeasure::ALL.map(|measure| case.intensity(measure));
    let record = (case.motion.name(), format!("{:016x}", key.record.as_u64_pair().0));
    let motion = (record, case.motion.scale(), case.scale, intensities);
    let Conditions { initial, detail, tolerance, duration } = case.conditions;
    let initial = INITIAL_VALUES.each_ref().map(|quantity| (quantity.get)(initial));
    let before = (structure, motion, (detail.name(), tolerance, duration, initial));
    match outcome {
        Outcome::Ended(summary) => line(&(before, summary, columns(beyond), "")),
        Outcome::Failed { time, reason } => {
            line(&(before, FAILED, time, ([""; MEASURES.len()], [""; 3]), columns(None), reason))
        }
    }
}

/// Results of the check of validity, in the order of the headings.
fn columns(beyond: Option<&Findings>) -> Vec<Option<f64>> {
    let Some(beyond) = beyond else { return vec![None; 2 * ASSUMPTIONS.len() + 2] };
    let worst = beyond.worst.iter().flat_map(|worst| [worst.value, worst.time]);
    worst.chain([beyond.gains as f64, beyond.settlings as f64]).map(Some).collect()
}
