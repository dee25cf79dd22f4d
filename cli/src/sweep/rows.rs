//! The rows of a sweep: headings, and what they say of each run.
//!
//! A run's key stands for names, parameters, samples, scale factors, conditions, the build of the program.
use super::row_file::{FIRST_HEADINGS, Row, RowFile, digest, fixed, key, key_of, records};
use crate::cause::{heading, version};
use anyhow::{Context, bail, ensure};
use csv::StringRecord;
use rocking::estimates::intensity::IntensityMeasure;
use rocking::mechanics::state::INITIAL_VALUES;
use rocking::run::validity::{ASSUMPTIONS, Found as Beyond};
use rocking_sweep::outcome::{MEASURES, Outcome};
use rocking_sweep::plan::{AXES, Case, Conditions, NamedRecord, Plan};
use std::{
    collections::{HashMap, HashSet},
    path::Path,
    ptr,
};
use uuid::Uuid;

/// The word for the ending of a run that has none.
const FAILED: &str = "failed";

/// Columns of what a run goes beyond, empty where that is not asked for.
const BEYOND: usize = 2 * ASSUMPTIONS.len() + 2;
/// Columns before the ending: the key, the name of the population and the program's version; the structure; the record, its
/// digest, its scale and the sweep's; intensities; detail, tolerance, duration and initial values.
const BEFORE: usize = 3 + AXES.len() + 4 + IntensityMeasure::ALL.len() + 3 + INITIAL_VALUES.len();

/// Columns of an ended run's outcome beside its peaks: ending, end; transitions, steps, evaluations.
const OTHERS: usize = 5;

/// What the file holds.
#[derive(Default)]
pub struct Found {
    /// By the number of the run.
    pub outcomes: Vec<Option<Outcome>>,
    /// How many rows are of other runs.
    pub others: usize,
    /// How many rows say again what another one says.
    pub repeated: usize,
}

/// What tells a run and its record from others.
pub struct Key {
    /// Stands for all that the run depends on.
    pub run: Uuid,
    /// Stands for the same where what it goes beyond is asked for, and was not, or the other way round.
    otherwise: Uuid,
    /// Stands for the samples of its record, whatever its file is called.
    record: Uuid,
}

/// The key of each run of `plan`, which is another one where it is asked what a run goes beyond.
pub fn keys(plan: &Plan, validity: bool) -> Vec<Key> {
    let of_motion = |of: &NamedRecord| {
        let samples = (of.record().times(), of.record().acceleration());
        (ptr::from_ref(of), digest(&Uuid::NAMESPACE_OID, &samples))
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

/// Opens the file at `path`, or begins it, and finds the rows of the runs that have `keys`.
pub fn open(path: &Path, keys: &[Key]) -> anyhow::Result<(RowFile, Found)> {
    RowFile::open(path, &headings(), |rows| read(rows, keys))
}

/// What stands before the first row.
fn headings() -> Vec<String> {
    let quantities = AXES.map(|axis| heading(axis.name, axis.unit));
    let intensities = IntensityMeasure::ALL.map(|measure| heading(measure.name(), measure.unit()));
    let initial = INITIAL_VALUES.each_ref().map(|quantity| heading(quantity.name, quantity.unit));
    let peaks = MEASURES.map(|(name, unit)| heading(&format!("peak_{name}"), unit));
    [
        fixed(&FIRST_HEADINGS),
        fixed(&["version"]),
        quantities.into(),
        fixed(&["record", "record_digest", "record_scale", "scale"]),
        intensities.into(),
        fixed(&["detail", "tolerance", "duration[s]"]),
        initial.into(),
        fixed(&["ending", "end[s]"]),
        peaks.into(),
        fixed(&["transitions", "steps", "evaluations"]),
        ASSUMPTIONS.iter().flat_map(|of| [of.name.to_owned(), heading(of.time_name, "s")]).collect(),
        fixed(&["energy_gains", "settlings", "reason", "checksum"]),
    ]
    .concat()
}

/// The row of a run.
pub fn row(key: &Key, case: &Case, outcome: &Outcome, beyond: Option<&Beyond>) -> anyhow::Result<Row> {
    let values = AXES.map(|axis| case.value(axis));
    let structure = (key.run.to_string(), case.population.name(), version(), values);
    let intensities = IntensityMeasure::ALL.map(|measure| case.intensity(measure));
    let record = (case.motion.name(), format!("{:016x}", key.record.as_u64_pair().0));
    let motion = (record, case.motion.scale(), case.scale, intensities);
    let Conditions { initial, detail, tolerance, duration } = case.conditions;
    let initial = INITIAL_VALUES.each_ref().map(|quantity| (quantity.get)(initial));
    let before = (structure, motion, (detail.name(), tolerance, duration, initial));
    match outcome {
        Outcome::Ended(summary) => Row::new(&(before, summary, columns(beyond), "")),
        Outcome::Failed { time, reason } => {
            Row::new(&(before, FAILED, time, [""; MEASURES.len() + OTHERS - 2], columns(None), reason))
        }
    }
}

/// What a run goes beyond, in the order of the headings.
fn columns(beyond: Option<&Beyond>) -> Vec<Option<f64>> {
    let Some(beyond) = beyond else { return vec![None; BEYOND] };
    let worst = beyond.worst.iter().flat_map(|worst| [worst.value, worst.time]);
    worst.chain([beyond.gains as f64, beyond.settlings as f64]).map(Some).collect()
}

/// What complete `rows` say of the runs that have `keys`.
fn read(rows: &[u8], keys: &[Key]) -> anyhow::Result<Found> {
    let numbers: HashMap<_, _> = keys.iter().map(|key| key.run).zip(0..).collect();
    ensure!(
        numbers.len() == keys.len(),
        "two runs are the same: values that vary differ by less than a rounding error"
    );
    let otherwise: HashSet<_> = keys.iter().map(|key| key.otherwise).collect();
    let mut found = Found { outcomes: vec![None; keys.len()], ..Found::default() };
    for (line, row) in records(rows) {
        let (key, outcome) = parse(&row?).with_context(|| format!("line {line} cannot be read"))?;
        match numbers.get(&key).map(|number: &usize| &mut found.outcomes[*number]) {
            None if otherwise.contains(&key) => bail!(
                "line {line} is of a run of this sweep, but with --validity or without it, unlike now: give it as \
                 then, or name another file with -o"
            ),
            None => found.others += 1,
            Some(Some(known)) if *known == outcome => found.repeated += 1,
            Some(Some(_)) => bail!("line {line} contradicts another row of run {key}: remove one of them"),
            Some(unknown) => *unknown = Some(outcome),
        }
    }
    Ok(found)
}

fn parse(row: &StringRecord) -> anyhow::Result<(Uuid, Outcome)> {
    let field = |index: usize| row.get(index).context("it is too short");
    let ended = BEFORE + MEASURES.len() + OTHERS;
    let reason = ended + BEYOND;
    let outcome = if field(BEFORE)? == FAILED {
        Outcome::Failed { time: field(BEFORE + 1)?.parse()?, reason: field(reason)?.into() }
    } else {
        let summary: StringRecord = row.iter().take(ended).skip(BEFORE).collect();
        Outcome::Ended(summary.deserialize(None)?)
    };
    Ok((key_of(row)?, outcome))
}
