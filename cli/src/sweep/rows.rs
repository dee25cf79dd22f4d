//! The file of a sweep: headings, and a row for every run that is done.
//!
//! A row begins with the run's key, which stands for all that the run depends on: names, parameters, samples, scale
//! factors, conditions, the build of the program. It ends with a checksum. So rows may stand in any order, and those of
//! other runs among them. Lines may end as the editor has them that has been at the file.
//!
//! A row is written at once and whole when its run ends. Whatever ends the program, the file then holds complete rows,
//! and at most part of one more at its end, which is cut off when the sweep goes on.
use FlexibleRocking::BUILD;
use anyhow::{Context, anyhow, bail, ensure};
use csv::{ReaderBuilder, StringRecord, WriterBuilder};
use rocking::{
    intensity::IntensityMeasure,
    run::outcome::{MEASURES, Outcome},
    run::plan::{AXES, Case, Conditions, NamedRecord, Plan},
    run::validity::{ASSUMPTIONS, Found as Beyond},
    state::INITIAL_VALUES,
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
/// Columns before the ending: the key and the name of the population; the structure; the record, its scale and the
/// sweep's; intensities; detail, tolerance, duration and initial values.
const BEFORE: usize = 2 + AXES.len() + 3 + IntensityMeasure::ALL.len() + 3 + INITIAL_VALUES.len();

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
        let motion = (digests[&ptr::from_ref(case.motion)], case.motion.scale(), case.scale);
        key(&build, &(names, case.structure.parameters(), motion, case.conditions, validity))
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
        } else {
            let first = content.split(|byte| *byte == b'\n').next().unwrap_or_default();
            if without_end(first) != without_end(&header) {
                return Err(no_headings(without_end(first), &header)).with_context(named);
            }
            let rows = content.get(first.len() + 1..).unwrap_or_default();
            let complete = rows.iter().rposition(|byte| *byte == b'\n').map_or(0, |last| last + 1);
            (read(&rows[..complete], keys).with_context(named)?, content.len() - rows.len() + complete)
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

/// Why `line` cannot stand where `header` belongs.
fn no_headings(line: &[u8], header: &[u8]) -> anyhow::Error {
    let expected = String::from_utf8_lossy(header);
    if check(line).is_ok() {
        return anyhow!("line 1 is a row: put the headings back before it:\n{expected}");
    }
    let first: String = String::from_utf8_lossy(line).chars().take(120).collect();
    let advice = "name another file with -o, or remove this one. These are the headings:";
    if line.starts_with(FIRST_HEADINGS.join(",").as_bytes()) {
        anyhow!("the headings in line 1 are those of another version of this program: {advice}\n{expected}")
    } else {
        anyhow!("line 1, {first:?}, is not the headings of a sweep's rows: {advice}\n{expected}")
    }
}

/// The headings that all versions begin with.
const FIRST_HEADINGS: [&str; 2] = ["run", "structures"];

/// A line without what ends it.
fn without_end(line: &[u8]) -> &[u8] {
    let line = line.strip_suffix(b"\n").unwrap_or(line);
    line.strip_suffix(b"\r").unwrap_or(line)
}

/// The line before the first row.
fn header() -> anyhow::Result<Vec<u8>> {
    let heading = |name: &str, unit: &str| if unit == "1" { name.into() } else { format!("{name}[{unit}]") };
    let quantities = AXES.map(|axis| heading(axis.name, axis.unit));
    let intensities = IntensityMeasure::ALL.map(|measure| heading(measure.name(), measure.unit()));
    let initial = INITIAL_VALUES.each_ref().map(|quantity| heading(quantity.name, quantity.unit));
    let peaks = MEASURES.map(|(name, unit)| heading(&format!("peak_{name}"), unit));
    let fixed = |headings: &[&str]| headings.iter().map(|heading| (*heading).to_owned()).collect::<Vec<_>>();
    let headings = [
        fixed(&FIRST_HEADINGS),
        quantities.into(),
        fixed(&["record", "record_scale", "scale"]),
        intensities.into(),
        fixed(&["detail", "tolerance", "duration[s]"]),
        initial.into(),
        fixed(&["ending", "end[s]"]),
        peaks.into(),
        fixed(&["transitions", "steps", "evaluations"]),
        ASSUMPTIONS.iter().flat_map(|of| [of.name.to_owned(), heading(of.time_name, "s")]).collect(),
        fixed(&["energy_gains", "settlings", "reason", "checksum"]),
    ];
    line(&headings.concat())
}

fn row(key: &Uuid, case: &Case, outcome: &Outcome, beyond: Option<&Beyond>) -> anyhow::Result<Vec<u8>> {
    let structure = (key.to_string(), case.population.name(), AXES.map(|axis| case.value(axis)));
    let intensities = IntensityMeasure::ALL.map(|measure| case.intensity(measure));
    let motion = (case.motion.name(), case.motion.scale(), case.scale, intensities);
    let Conditions { initial, detail, tolerance, duration } = case.conditions;
    let initial = INITIAL_VALUES.each_ref().map(|quantity| (quantity.get)(initial));
    let before = (structure, motion, (detail.name(), tolerance, duration, initial));
    let mut row = match outcome {
        Outcome::Ended(summary) => line(&(before, summary, columns(beyond), "")),
        Outcome::Failed { time, reason } => {
            line(&(before, FAILED, time, [""; MEASURES.len() + OTHERS - 2], columns(None), reason))
        }
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
        check(without_end(row))
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
    let ended = BEFORE + MEASURES.len() + OTHERS;
    let reason = ended + BEYOND;
    let outcome = if field(BEFORE)? == FAILED {
        Outcome::Failed { time: field(BEFORE + 1)?.parse()?, reason: field(reason)?.into() }
    } else {
        let summary: StringRecord = row.iter().take(ended).skip(BEFORE).collect();
        Outcome::Ended(summary.deserialize(None)?)
    };
    Ok((Uuid::try_parse(field(0)?)?, outcome))
}

/// Whether `row`, a line without its end, ends with the checksum of what comes before it.
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
