//! A file of rows that grows as runs end: headings, and a row for every run that is done.
//!
//! A row begins with the run's key, which stands for all that the run depends on. It ends with a checksum. So rows may
//! stand in any order, and those of other runs among them. Lines may end as the editor has them that has been at the file.
//!
//! A row is written at once and whole when its run ends. Whatever ends the program, the file then holds complete rows,
//! and at most part of one more at its end, which is cut off when the runs go on.
use FlexibleRocking::BUILD;
use anyhow::{Context, anyhow, bail, ensure};
use csv::{ReaderBuilder, StringRecord, WriterBuilder};
use serde::Serialize;
use std::{
    fs::{File, TryLockError},
    io::{Read, Seek, SeekFrom, Write},
    path::{Path, PathBuf},
};
use uuid::Uuid;

/// An open file, to which rows can be added.
pub struct RowFile {
    path: PathBuf,
    file: File,
    /// Of what is complete.
    length: u64,
    has_failed: bool,
}

/// The key of what depends on the build of the program and on `of`.
pub fn key(of: &impl Serialize) -> Uuid {
    digest(&Uuid::try_parse(BUILD).expect("the build script wrote it"), of)
}

/// A number that stands for `of` in `namespace`.
pub fn digest(namespace: &Uuid, of: &impl Serialize) -> Uuid {
    Uuid::new_v5(namespace, &postcard::to_allocvec(of).expect("numbers and slices can be serialized"))
}

impl RowFile {
    /// Opens the file at `path` under these `headings`, or begins it, and has its complete rows read.
    pub fn open<T>(
        path: &Path,
        headings: &[String],
        read: impl FnOnce(&[u8]) -> anyhow::Result<T>,
    ) -> anyhow::Result<(RowFile, T)> {
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
        let headings = line(&headings)?;
        let (found, length) = if headings.starts_with(&content) {
            file.rewind().and_then(|()| file.write_all(&headings)).with_context(named)?;
            (read(&[])?, headings.len())
        } else {
            let first = content.split(|byte| *byte == b'\n').next().unwrap_or_default();
            if without_end(first) != without_end(&headings) {
                return Err(no_headings(without_end(first), &headings)).with_context(named);
            }
            let rows = content.get(first.len() + 1..).unwrap_or_default();
            let complete = rows.iter().rposition(|byte| *byte == b'\n').map_or(0, |last| last + 1);
            check_rows(&rows[..complete]).with_context(named)?;
            (read(&rows[..complete]).with_context(named)?, content.len() - rows.len() + complete)
        };
        file.set_len(length as u64).with_context(named)?;
        Ok((RowFile { path: path.into(), file, length: length as u64, has_failed: false }, found))
    }

    /// Adds a row. After a failure there is none to add.
    pub fn append(&mut self, Row(row): &Row) -> anyhow::Result<()> {
        let named = || format!("{} cannot be written", self.path.display());
        ensure!(!self.has_failed, named());
        let written = self.file.seek(SeekFrom::Start(self.length)).and_then(|_| self.file.write_all(row));
        if let Err(error) = written {
            self.has_failed = true;
            let cut = self.file.set_len(self.length);
            return Err(cut.err().unwrap_or(error)).with_context(named);
        }
        self.length += row.len() as u64;
        Ok(())
    }
}

/// A row with its checksum, as it is written: whoever has the file in hand has nothing left to compute.
pub struct Row(Vec<u8>);

impl Row {
    /// Of these values; numbers read back to the same bits.
    pub fn new(values: &impl Serialize) -> anyhow::Result<Row> {
        let mut row = line(values)?;
        row.pop();
        let checksum = checksum(&row);
        row.extend(format!(",{checksum}\n").into_bytes());
        Ok(Row(row))
    }
}

/// The headings of columns that are called the same whatever the sweep is of.
pub fn fixed(headings: &[&str]) -> Vec<String> {
    headings.iter().map(|heading| (*heading).to_owned()).collect()
}

/// Each of `rows` with its line in the file.
pub fn records(rows: &[u8]) -> impl Iterator<Item = (u64, csv::Result<StringRecord>)> {
    (2..).zip(ReaderBuilder::new().has_headers(false).from_reader(rows).into_records())
}

/// The key that `row` begins with.
pub fn key_of(row: &StringRecord) -> anyhow::Result<Uuid> {
    Ok(Uuid::try_parse(row.get(0).context("it is too short")?)?)
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
        anyhow!(
            "the headings in line 1 are those of another kind of sweep (of records, of pulses) or of another version of this \
             program: {advice}\n{expected}"
        )
    } else {
        anyhow!("line 1, {first:?}, is not the headings of a sweep's rows: {advice}\n{expected}")
    }
}

/// The headings that all versions begin with.
pub const FIRST_HEADINGS: [&str; 2] = ["run", "structures"];

/// A line without what ends it.
fn without_end(line: &[u8]) -> &[u8] {
    let line = line.strip_suffix(b"\n").unwrap_or(line);
    line.strip_suffix(b"\r").unwrap_or(line)
}

fn line(of: &impl Serialize) -> anyhow::Result<Vec<u8>> {
    let mut writer = WriterBuilder::new().has_headers(false).from_writer(Vec::new());
    writer.serialize(of)?;
    Ok(writer.into_inner()?)
}

/// Refuses complete `rows` of which one is not as it was written.
fn check_rows(rows: &[u8]) -> anyhow::Result<()> {
    for (line, row) in (2..).zip(rows.split_inclusive(|byte| *byte == b'\n')) {
        check(without_end(row))
            .with_context(|| format!("line {line} is not a row as it was written: remove it, to do its run again"))?;
    }
    Ok(())
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
