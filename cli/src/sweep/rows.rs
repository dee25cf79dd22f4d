//! The file of a sweep: headings, and a row for every run that is done.
//!
//! A row begins with the run's key, which stands for all that the run depends on: names, parameters, samples, scale
//! factor, the build of the program. It ends with a checksum. So rows may stand in any order, and those of other runs
//! among them.
//!
//! A row is written at once and whole when its run ends. Whatever ends the program, the file then holds complete rows,
//! and at most part of one more at its end, which is cut off when the sweep goes on.
use FlexibleRocking::BUILD;
use anyhow::{Context, bail, ensure};
use csv::{ReaderBuilder, StringRecord, WriterBuilder};
use rocking::run::{
    outcome::{MEASURES, Outcome},
    plan::{AXES, Case, NamedRecord, Plan},
    validity::{ASSUMPTIONS, Found as Beyond},
};
use serde::Serialize;
use std::{
    collections::HashMap,
    fs::{File, TryLockError},
    io::{Read, Seek, SeekFrom, Write},
    path::{Path, PathBuf},
    ptr,
};
use uuid::Uuid;

/// The word for the ending of a run that has none.
const FAILED: &str = "failed";

/// Columns of what a run goes beyond, empty where that is not asked for.
const BEYOND: usize = 2 * ASSUMPTIONS.len() + 2;

/// Columns of an ended run's outcome beside its peaks: ending, end; transitions, steps, evaluations.
const OTHERS: usize = 5;

/// An open file, to which rows can be added.
pub struct Rows {
    path: PathBuf,
    file: File,
    /// Of what is complete.
    length: u64,
    has_failed: bool,
}

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

/// The key of each run of `plan`, which is another one where it is asked what a run goes beyond.
pub fn keys(plan: &Plan, validity: bool) -> Vec<Uuid> {
    let build = Uuid::try_parse(BUILD).expect("the build script wrote it");
    let digest = |of: &NamedRecord| {
        let samples = (of.record().times(), of.record().acceleration());
        (ptr::from_ref(of), key(&Uuid::NAMESPACE_OID, &samples).into_bytes())
    };
    let digests: HashMap<_, _> = plan.motions().iter().map(digest).collect();
    let of_case = |case: Case| {
        let names = (case.population.name(), case.motion.name());
        key(&build, &(names, case.structure.parameters(), digests[&ptr::from_ref(case.motion)], case.scale, validity))
    };
    plan.cases().map(of_case).collect()
}

fn key(namespace: &Uuid, of: &impl Serialize) -> Uuid {
    Uuid::new_v5(namespace, &postcard::to_allocvec(of).expect("numbers and slices can be serialized"))
}

impl Rows {
    /// Opens the file at `path`, or begins it, and finds the rows of the runs that have `keys`.
    pub fn open(path: &Path, keys: &[Uuid]) -> anyhow::Result<(Rows, Found)> {
        let named = || path.display().to_string();
        let mut file =
            File::options().read(true).write(true).create(true).truncate(false).open(path).with_context(named)?;
        match file.try_lock() {
            Ok(()) => {}
            Err(TryLockError::WouldBlock) => bail!("{}: another sweep is writing to it: wait for its end", named()),
            Err(TryLockError::Error(error)) => return Err(error).with_context(named),
        }
        let mut content = Vec::new();
        file.read_to_end(&mut content).with_context(named)?;
        let header = header()?;
        let (found, length) = if header.starts_with(&content) {
            file.rewind().and_then(|()| file.write_all(&header)).with_context(named)?;
            (read(&[], keys)?, header.len())
        } else if let Some(rows) = content.strip_prefix(header.as_slice()) {
            let complete = rows.iter().rposition(|byte| *byte == b'\n').map_or(0, |last| last + 1);
            (read(&rows[..complete], keys).with_context(named)?, header.len() + complete)
        } else {
            let first = content.split(|byte| *byte == b'\n').next().unwrap_or_default();
            let expected = String::from_utf8_lossy(&header);
            if check(first).is_ok() {
                bail!("{}: line 1 is a row: put the headings back before it:\n{expected}", named());
            }
            let first: String = String::from_utf8_lossy(first).chars().take(120).collect();
            bail!(
                "{}, line 1: {first:?} are not the headings of a sweep's rows: name another file with -o, or remove \
                 this one. These are the headings:\n{expected}",
                named()
            );
        };
        file.set_len(length as u64).with_context(named)?;
        Ok((Rows { path: path.into(), file, length: length as u64, has_failed: false }, found))
    }

    /// Adds the row of a run; its numbers read back to the same bits. After a failure there is none to add.
    pub fn append(
        &mut self,
        key: &Uuid,
        case: &Case,
        outcome: &Outcome,
        beyond: Option<&Beyond>,
    ) -> anyhow::Result<()> {
        let named = || format!("{} cannot be written", self.path.display());
        let row = row(key, case, outcome, beyond)?;
        ensure!(!self.has_failed, named());
        let written = self.file.seek(SeekFrom::Start(self.length)).and_then(|_| self.file.write_all(&row));
        if let Err(error) = written {
            self.has_failed = true;
            let cut = self.file.set_len(self.length);
            return Err(cut.err().unwrap_or(error)).with_context(named);
        }
        self.length += row.len() as u64;
        Ok(())
    }
}

/// The line before the first row.
fn header() -> anyhow::Result<Vec<u8>> {
    let heading = |name: &str, unit: &str| if unit == "1" { name.into() } else { format!("{name}[{unit}]") };
    let motion = ["record", "scale", "PGA[g]", "ending", "end[s]"].map(String::from);
    let headings = ["run", "structures"].map(String::from).into_iter();
    let headings = headings.chain(AXES.map(|axis| heading(axis.name, axis.unit))).chain(motion);
    let headings = headings.chain(MEASURES.map(|(name, unit)| heading(&format!("peak_{name}"), unit)));
    let headings = headings.chain(["transitions", "steps", "evaluations"].map(String::from));
    let headings = headings.chain(ASSUMPTIONS.iter().flat_map(|of| [of.name.into(), heading(of.time_name, "s")]));
    line(&headings.chain(["energy_gains", "settlings", "reason", "checksum"].map(String::from)).collect::<Vec<_>>())
}

fn row(key: &Uuid, case: &Case, outcome: &Outcome, beyond: Option<&Beyond>) -> anyhow::Result<Vec<u8>> {
    let structure = (key.to_string(), case.population.name(), AXES.map(|axis| case.value(axis)));
    let identity = (structure, case.motion.name(), case.scale, case.intensity());
    let mut row = match outcome {
        Outcome::Ended(summary) => line(&(identity, summary, columns(beyond), "")),
        Outcome::Failed(reason) => line(&(identity, FAILED, [""; MEASURES.len() + OTHERS - 1], columns(None), reason)),
    }?;
    row.pop();
    let checksum = checksum(&row);
    row.extend(format!(",{checksum}\n").into_bytes());
    Ok(row)
}

/// What a run goes beyond, in the order of the headings.
fn columns(beyond: Option<&Beyond>) -> Vec<Option<f64>> {
    let Some(beyond) = beyond else { return vec![None; BEYOND] };
    let worst = beyond.worst.iter().flat_map(|worst| [worst.value, worst.time]);
    worst.chain([beyond.gains as f64, beyond.settlings as f64]).map(Some).collect()
}

fn line(of: &impl Serialize) -> anyhow::Result<Vec<u8>> {
    let mut writer = WriterBuilder::new().has_headers(false).from_writer(Vec::new());
    writer.serialize(of)?;
    Ok(writer.into_inner()?)
}

/// What complete `rows` say of the runs that have `keys`.
fn read(rows: &[u8], keys: &[Uuid]) -> anyhow::Result<Found> {
    for (line, row) in (2..).zip(rows.split_inclusive(|byte| *byte == b'\n')) {
        check(&row[..row.len() - 1])
            .with_context(|| format!("line {line} is not a row as it was written: remove it, to do its run again"))?;
    }
    let numbers: HashMap<_, _> = keys.iter().zip(0..).collect();
    ensure!(
        numbers.len() == keys.len(),
        "two runs are the same: values that vary differ by less than a rounding error"
    );
    let mut found = Found { outcomes: vec![None; keys.len()], ..Found::default() };
    for (line, row) in (2..).zip(ReaderBuilder::new().has_headers(false).from_reader(rows).into_records()) {
        let (key, outcome) = parse(&row?).with_context(|| format!("line {line} cannot be read"))?;
        match numbers.get(&key).map(|number: &usize| &mut found.outcomes[*number]) {
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
    let ending = 2 + AXES.len() + 3;
    let ended = ending + MEASURES.len() + OTHERS;
    let reason = ended + BEYOND;
    let outcome = if field(ending)? == FAILED {
        Outcome::Failed(field(reason)?.into())
    } else {
        let summary: StringRecord = row.iter().take(ended).skip(ending).collect();
        Outcome::Ended(summary.deserialize(None)?)
    };
    Ok((Uuid::try_parse(field(0)?)?, outcome))
}

/// Whether `row`, without the end of the line, ends with the checksum of what comes before it.
fn check(row: &[u8]) -> anyhow::Result<()> {
    let comma = row.iter().rposition(|byte| *byte == b',').context("it has one column")?;
    let (expected, found) = (checksum(&row[..comma]), String::from_utf8_lossy(&row[comma + 1..]));
    ensure!(found == expected, "its checksum is {expected} and not {found:?}");
    Ok(())
}

fn checksum(row: &[u8]) -> String {
    let (checksum, _) = Uuid::new_v5(&Uuid::NAMESPACE_OID, row).as_u64_pair();
    format!("{checksum:016x}")
}
