//! The file of a sweep: a line that names the build and the inputs, headings, and a row for every run that is done.
//!
//! A row is written at once and whole when its run ends. Whatever ends the program, the file then holds complete rows,
//! and at most part of one more at its end, which is cut off when the sweep goes on.
use super::{
    outcome::{MEASURES, Outcome},
    plan::{Plan, Run, heading},
};
use FlexibleRocking::BUILD;
use anyhow::{Context, bail, ensure};
use csv::{StringRecord, WriterBuilder};
use std::{
    fs::{File, TryLockError},
    io::{Read, Seek, SeekFrom, Write},
    path::{Path, PathBuf},
};

/// Lines before the first row.
const HEADER_LINES: u64 = 2;

/// An open file, to which rows can be added.
pub struct Rows {
    path: PathBuf,
    writer: csv::Writer<File>,
}

impl Rows {
    /// Opens the file at `path`, or begins it, and returns the outcome of every run that it holds.
    pub fn open(path: &Path, plan: &Plan) -> anyhow::Result<(Rows, Vec<Option<Outcome>>)> {
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
        let header = header(plan)?;
        let outcomes = if header.starts_with(&content) {
            file.rewind().and_then(|()| file.write_all(&header)).with_context(named)?;
            vec![None; plan.len()]
        } else if let Some(rows) = content.strip_prefix(header.as_slice()) {
            let complete = rows.iter().rposition(|byte| *byte == b'\n').map_or(0, |last| last + 1);
            let outcomes = outcomes(&rows[..complete], plan).with_context(named)?;
            let end = (header.len() + complete) as u64;
            file.set_len(end).and_then(|()| file.seek(SeekFrom::Start(end))).with_context(named)?;
            outcomes
        } else {
            bail!(
                "{} holds something else: it begins with {:?} and this sweep's rows with {:?}. The TOML file, a record \
                 or the program has changed: name another file with -o, or remove this one to do all runs again",
                named(),
                first_line(&content),
                first_line(&header)
            );
        };
        let writer = WriterBuilder::new().has_headers(false).from_writer(file);
        Ok((Rows { path: path.into(), writer }, outcomes))
    }

    /// Adds the row of a run; its numbers read back to the same bits.
    pub fn append(&mut self, run: &Run, outcome: &Outcome) -> anyhow::Result<()> {
        let identity = (run.index, hex(run.digest()), run.population);
        let row = (identity, run.values(), run.record(), run.scale, run.pga(), outcome);
        self.writer
            .serialize(row)
            .and_then(|()| Ok(self.writer.flush()?))
            .with_context(|| format!("{} cannot be written", self.path.display()))
    }
}

/// The lines before the first row.
fn header(plan: &Plan) -> anyhow::Result<Vec<u8>> {
    let mut header = format!("# rocking-fmu sweep, build {BUILD}, inputs {}\n", hex(plan.digest())).into_bytes();
    let identity = ["run", "inputs", "structures"].map(String::from);
    let motion = ["record", "scale", "PGA[g]", "overturned", "overturned_at[s]"].map(String::from);
    let peaks = MEASURES.map(|(name, unit)| heading(&format!("peak_{name}"), unit));
    let work = ["transitions", "steps", "evaluations"].map(String::from);
    let headings = identity.into_iter().chain(plan.headings()).chain(motion).chain(peaks).chain(work);
    let mut writer = csv::Writer::from_writer(&mut header);
    writer.write_record(headings)?;
    writer.flush()?;
    drop(writer);
    Ok(header)
}

/// What complete `rows` say, by the number of the run.
fn outcomes(rows: &[u8], plan: &Plan) -> anyhow::Result<Vec<Option<Outcome>>> {
    let mut outcomes = vec![None; plan.len()];
    for row in csv::ReaderBuilder::new().has_headers(false).from_reader(rows).into_records() {
        let row = row?;
        let line = HEADER_LINES + row.position().map_or(0, csv::Position::line);
        let (index, outcome) =
            read(&row, plan).with_context(|| format!("line {line} is not a row of this sweep: remove it"))?;
        ensure!(outcomes[index].is_none(), "line {line} is a second row of run {index}: remove it");
        outcomes[index] = Some(outcome);
    }
    Ok(outcomes)
}

/// A row's number and outcome; the inputs that it names must be those of the run of that number.
fn read(row: &StringRecord, plan: &Plan) -> anyhow::Result<(usize, Outcome)> {
    let (index, inputs) = (row[0].parse()?, &row[1]);
    ensure!(index < plan.len(), "run {index} does not exist: there are {}", plan.len());
    let expected = hex(plan.run(index).digest());
    ensure!(inputs == expected, "the inputs of run {index} are {expected} and not {inputs:?}");
    let before_outcome = 6 + plan.headings().count();
    let outcome: StringRecord = row.iter().skip(before_outcome).collect();
    Ok((index, outcome.deserialize(None)?))
}

fn hex(digest: u64) -> String {
    format!("{digest:016x}")
}

/// The first line of `content`, or as much of it as a message can hold.
fn first_line(content: &[u8]) -> String {
    const SHOWN: usize = 120;
    String::from_utf8_lossy(content).lines().next().unwrap_or_default().chars().take(SHOWN).collect()
}
