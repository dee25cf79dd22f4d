//! A file of rows that grows as runs end: headings, and a row for every run that is done.
//!
//! A row begins with the run's key, which stands for all that the run depends on. So rows may stand in any order, and
//! those of other runs among them.
//!
//! A thread writes the rows of its last runs together, at least ten times a second. However the program ends, the file holds complete
//! rows and at most a part of one more. That part is cut off when the runs continue.

use anyhow::{Context, bail, ensure};
use csv::{ReaderBuilder, StringRecord, WriterBuilder};
use rayon::prelude::*;
use serde::Serialize;
use sha1_smol::Sha1;
use std::{
    collections::HashMap,
    fs::{File, TryLockError},
    io::{Read, Seek, SeekFrom, Write},
    path::{Path, PathBuf},
    sync::Mutex,
    time::Instant,
};
use uuid::{Builder, Uuid};

/// Runs that a thread does together: enough for full lanes to the end, and few enough to share them out and to stop soon.
const FEWEST_TOGETHER: usize = 16;
const MOST_TOGETHER: usize = 128;

/// How often each thread takes runs, if there are few.
const SHARES: usize = 4;

#[derive(Debug)]
pub struct RowFile {
    path: PathBuf,
    /// The file, and the length of its complete rows.
    file: Mutex<(File, u64)>,
}

/// Contents of the rows in the file, each a `T` by its key, until they are taken.
pub type Known<T> = HashMap<Uuid, T>;

#[derive(Clone, Debug)]
pub struct Program {
    /// Identifies all of the program that a run depends on.
    pub build: Uuid,
    /// Version in the rows: of the packages, with the first digits of the build.
    pub version: String,
}

impl Program {
    /// The program of this `build`, a GUID in braces.
    pub fn of(build: &str) -> Program {
        let version = format!("{}+{}", env!("CARGO_PKG_VERSION"), &build[1..9]);
        Program { build: Uuid::try_parse(build).expect("a build script wrote it"), version }
    }
}

/// Becomes a number that identifies all that was added in this order: a UUID of version 5.
#[derive(Clone)]
pub struct Digest(Sha1);

impl Digest {
    /// Nothing in `namespace`, such as the build of a program that a result depends on.
    pub fn new(namespace: &Uuid) -> Digest {
        Digest(Sha1::from(namespace))
    }

    pub fn and(mut self, of: &impl Serialize) -> Digest {
        let bytes = postcard::to_extend(of, Vec::with_capacity(1024)).expect("numbers and slices can be serialized");
        self.0.update(&bytes);
        self
    }

    pub fn uuid(&self) -> Uuid {
        let bytes = self.0.digest().bytes();
        Builder::from_sha1_bytes(*bytes.first_chunk().expect("there are 20")).into_uuid()
    }
}

/// A sentence about the `count` rows in the file at `path` that were not taken: rows of other runs or points, `what`.
pub fn others(count: usize, path: &Path, what: &str) -> Option<String> {
    let others = format!("row(s) are of {what} (other inputs, or another build of the program): kept");
    (count > 0).then(|| format!("{}: {count} {others}", path.display()))
}

impl RowFile {
    /// Opens the file at `path` under these `headings`, or begins it, and has its complete rows parsed.
    pub fn open<T>(
        path: &Path,
        headings: &[String],
        parse: impl Fn(&StringRecord) -> anyhow::Result<T>,
    ) -> anyhow::Result<(RowFile, Known<T>)> {
        let open = || {
            ensure!(path.is_file() || !path.exists(), "rows need a file, which is read again: name one");
            let mut file = File::options().read(true).write(true).create(true).truncate(false).open(path)?;
            match file.try_lock() {
                Ok(()) => {}
                Err(TryLockError::WouldBlock) => bail!("another sweep is writing to it: wait for its end"),
                Err(TryLockError::Error(error)) => return Err(error.into()),
            }
            let mut content = Vec::new();
            file.read_to_end(&mut content)?;
            let first = line(&headings);
            let mut known = Known::default();
            if first.starts_with(&content) {
                file.rewind()?;
                file.write_all(&first)?;
                return Ok((file, first.len(), known));
            }
            let length = content.iter().rposition(|byte| *byte == b'\n').map_or(0, |last| last + 1);
            let mut rows = ReaderBuilder::new().from_reader(&content[..length]);
            ensure!(
                rows.headers()? == headings,
                "line 1 is not the headings of rows of this sweep, with its intensity, limits, condition and --validity, in this version: name another file"
            );
            for row in rows.records() {
                let row = row?;
                let read = || Ok::<_, anyhow::Error>((Uuid::try_parse(&row[0])?, parse(&row)?));
                let at = row.position().map_or(0, csv::Position::line);
                let (key, value) =
                    read().with_context(|| format!("line {at} cannot be read: remove it, to do its run again"))?;
                known.insert(key, value);
            }
            Ok((file, length, known))
        };
        let (file, length, known) = open().with_context(|| path.display().to_string())?;
        file.set_len(length as u64)?;
        (&file).seek(SeekFrom::Start(length as u64))?;
        Ok((RowFile { path: path.into(), file: Mutex::new((file, length as u64)) }, known))
    }

    /// Adds all of these rows, or nothing, and leaves none behind.
    fn append(&self, rows: &mut Vec<u8>) -> anyhow::Result<()> {
        let mut guard = self.file.lock().expect("no thread panics with the file in hand");
        let (file, length) = &mut *guard;
        let written = file.write_all(rows);
        if written.is_err() {
            file.seek(SeekFrom::Start(*length))?;
            file.set_len(*length)?;
        }
        let added = std::mem::take(rows).len();
        written.with_context(|| format!("{} cannot be written", self.path.display()))?;
        *length += added as u64;
        Ok(())
    }
}

/// Does `runs` on all threads, several together: `run` hands out each result, which goes to `keep`, and its row, which goes to the
/// `file`, until `keep` fails.
pub fn do_runs<T: Sync, R>(
    runs: &[T],
    file: Option<&RowFile>,
    run: impl Fn(&[T], &mut dyn FnMut(R, &[u8]) -> bool) + Sync,
    keep: impl Fn(R) -> anyhow::Result<()> + Sync,
) -> anyhow::Result<()> {
    let together = (runs.len() / (SHARES * rayon::current_num_threads())).clamp(FEWEST_TOGETHER, MOST_TOGETHER);
    runs.par_chunks(together).try_for_each(|runs| {
        let (mut result, mut rows, mut written) = (Ok(()), Vec::new(), Instant::now());
        let write = |rows: &mut Vec<u8>| file.map_or(Ok(()), |file| file.append(rows));
        run(runs, &mut |done, row| {
            rows.extend(row);
            result = keep(done);
            if result.is_ok() && written.elapsed().as_secs_f64() > 0.1 {
                (result, written) = (write(&mut rows), Instant::now());
            }
            result.is_ok()
        });
        write(&mut rows).and(result)
    })
}

pub fn heading(name: &str, unit: &str) -> String {
    if unit == "1" { name.into() } else { format!("{name}[{unit}]") }
}

/// Name and unit of the column with this [`heading`]; a number in brackets is of a floor.
pub fn name_and_unit(heading: &str) -> (&str, &str) {
    let parts = heading.strip_suffix(']').and_then(|of| of.rsplit_once('['));
    parts.filter(|(_, unit)| unit.parse::<usize>().is_err()).unwrap_or((heading, "1"))
}

/// The headings of columns that are called the same whatever the sweep is of.
pub fn fixed(headings: &[&str]) -> Vec<String> {
    headings.iter().map(|heading| (*heading).to_owned()).collect()
}

/// A line of these values; numbers read back to the same bits.
pub fn line(of: &impl Serialize) -> Vec<u8> {
    let mut rows = WriterBuilder::new().has_headers(false).from_writer(Vec::new());
    rows.serialize(of).expect("numbers and texts can be written to memory");
    rows.into_inner().expect("numbers and texts can be written to memory")
}
