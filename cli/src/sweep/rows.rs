//! The rows of a sweep: headings, and what they say of each run.
//!
//! A run's key stands for names, parameters, samples, scale factors, conditions, the build of the program.
use super::row_file::{Known, RowFile, digest, fixed, key, line};
use crate::cause::{heading, version};
use csv::StringRecord;
use rocking::estimates::intensity::IntensityMeasure;
use rocking::mechanics::state::INITIAL_VALUES;
use rocking::run::validity::{ASSUMPTIONS, Found as Beyond};
use rocking_sweep::outcome::{MEASURES, Outcome};
use rocking_sweep::plan::{AXES, Case, Conditions, NamedRecord, Plan};
use std::{collections::HashMap, path::Path, ptr};
use uuid::Uuid;

/// The word for the ending of a run that has none.
const FAILED: &str = "failed";

/// What tells a run and its record from others.
pub struct Key {
    /// Stands for all that the run depends on.
    pub run: Uuid,
    /// Stands for the same where what it goes beyond is asked for, and was not, or the other way round.
    pub otherwise: Uuid,
    /// Stands for the samples of its record, whatever its file is called.
    record: Uuid,
}

/// The key of each run of `plan`, which is another one where it is asked what a run goes beyond.
pub fn keys(plan: &Plan, validity: bool) -> Vec<Key> {
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
        let run = |validity: bool| key(&(names, case.structure.parameters(), motion, case.conditions, validity));
        Key { run: run(validity), otherwise: run(!validity), record }
    };
    plan.cases().map(of_case).collect()
}

/// Opens the file at `path`, or begins it, and reads what its rows say.
pub fn open(path: &Path) -> anyhow::Result<(RowFile, Known<Outcome>)> {
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

/// What stands before the first row.
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
pub fn row(key: &Key, case: &Case, outcome: &Outcome, beyond: Option<&Beyond>) -> anyhow::Result<Vec<u8>> {
    let values = AXES.map(|axis| case.value(axis));
    let structure = (key.run.to_string(), case.population.name(), version(), values);
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

/// What a run goes beyond, in the order of the headings.
fn columns(beyond: Option<&Beyond>) -> Vec<Option<f64>> {
    let Some(beyond) = beyond else { return vec![None; 2 * ASSUMPTIONS.len() + 2] };
    let worst = beyond.worst.iter().flat_map(|worst| [worst.value, worst.time]);
    worst.chain([beyond.gains as f64, beyond.settlings as f64]).map(Some).collect()
}
