//! The records that the ground follows: found by name or path, read once, and shared by all instances of the process.

use crate::resources::{self, Archive};
use rocking::record::{MAX_SAMPLES, Reading, Record, RecordError, Source, Unit};
use std::error::Error;
use std::path::{MAIN_SEPARATOR, Path, PathBuf, is_separator};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::SystemTime;
use std::{fs, io};
use uuid::Uuid;

/// Names the samples of a record, and their unit.
pub type Digest = [u8; 16];

/// A record that the ground can follow.
#[derive(Debug)]
pub struct GroundRecord {
    /// The record, as its file gives it.
    pub record: Record,
    /// The unit of its accelerations.
    pub unit: Unit,
    /// Names both.
    pub digest: Digest,
}

/// Why a record cannot be had.
#[derive(Debug, thiserror::Error)]
pub enum GroundError {
    /// No file of that name.
    #[error("record = {name:?} is not in {folder}: {error}; a path on disk needs a separator: .{MAIN_SEPARATOR}{name}", folder = .folder.display())]
    NotInArchive {
        /// What is asked for.
        name: String,
        /// Where it should be.
        folder: PathBuf,
        /// Why it is not.
        error: io::Error,
    },
    /// A name that leads out of the archive.
    #[error("record = {0:?} is no file of the archive")]
    Outside(String),
    /// Not the URI of a local file.
    #[error("record = {0:?} is not a file URI of this machine, such as file:///tmp/record.AT2")]
    NotAFileUri(String),
    /// The file is no record.
    #[error("record: {error}{cause}", cause = .error.source().map(|cause| format!(": {cause}")).unwrap_or_default())]
    NoRecord {
        /// Why.
        #[from]
        error: RecordError,
    },
    /// A file of the archive is not what was packed.
    #[error("record = {0:?} in the archive is not the one that was exported with it; export it again")]
    Changed(String),
}

impl GroundRecord {
    /// Reads it; accelerations whose unit its file does not state are in m/s².
    pub fn read(path: &Path) -> Result<GroundRecord, RecordError> {
        let (record, Source { unit, .. }) = Record::read_raw(path, &Reading::default())?;
        let numbers = record.times().iter().chain(record.acceleration());
        let bytes: Vec<_> = numbers.flat_map(|number| number.to_le_bytes()).chain([unit as u8]).collect();
        let digest = Uuid::new_v5(&Uuid::NAMESPACE_OID, &bytes).into_bytes();
        Ok(GroundRecord { record, unit, digest })
    }

    /// The digest, as archives have it.
    pub fn name(&self) -> String {
        Uuid::from_bytes(self.digest).to_string()
    }
}

/// Records that have been read, the latest last.
static READ: Mutex<Vec<(Identity, Arc<GroundRecord>)>> = Mutex::new(Vec::new());

/// What tells that a file is still the one that was read.
#[derive(PartialEq)]
struct Identity {
    path: PathBuf,
    size: u64,
    modified: Option<SystemTime>,
}

impl Archive {
    /// The record that `text` asks for: none if it is empty; one of the archive's by its name, or a file by its path or URI.
    pub fn record(&self, text: &str) -> Result<Option<Arc<GroundRecord>>, GroundError> {
        if text.is_empty() {
            return Ok(None);
        }
        let is_uri = text.split_once(':').is_some_and(|(scheme, _)| scheme.eq_ignore_ascii_case("file"));
        if is_uri {
            let path = resources::path(text).ok_or_else(|| GroundError::NotAFileUri(text.to_owned()))?;
            return Ok(Some(read_once(&path)?));
        }
        if text.contains(is_separator) {
            return Ok(Some(read_once(Path::new(text))?));
        }
        let path = self.folder.join(text);
        let real = match fs::canonicalize(&path) {
            Ok(real) => real,
            Err(error) => {
                return Err(GroundError::NotInArchive { name: text.to_owned(), folder: self.folder.clone(), error });
            }
        };
        if real.parent() != fs::canonicalize(&self.folder).ok().as_deref() {
            return Err(GroundError::Outside(text.to_owned()));
        }
        let record = read_once(&path)?;
        match self.contents.records.iter().find(|packed| packed.file == text) {
            Some(packed) if packed.digest != record.name() => Err(GroundError::Changed(text.to_owned())),
            _ => Ok(Some(record)),
        }
    }
}

/// The record in the file `path`, which is read unless it has been. As many are kept as have [`MAX_SAMPLES`] together,
/// the latest ones.
fn read_once(path: &Path) -> Result<Arc<GroundRecord>, RecordError> {
    let identity = identity(path).map_err(|source| RecordError::Unreadable { path: path.into(), source })?;
    // The lock is held while a file is read, so that none is read twice at a time. What is locked is whole after a panic.
    let mut read = READ.lock().unwrap_or_else(PoisonError::into_inner);
    if let Some((_, record)) = read.iter().find(|(of, _)| *of == identity) {
        return Ok(Arc::clone(record));
    }
    let record = Arc::new(GroundRecord::read(path)?);
    read.retain(|(of, _)| of.path != identity.path);
    read.push((identity, Arc::clone(&record)));
    let mut samples = 0;
    let kept = read.iter().rev().take_while(|(_, record)| {
        samples += record.record.times().len();
        samples <= MAX_SAMPLES
    });
    let dropped = read.len() - kept.count();
    read.drain(..dropped);
    Ok(record)
}

fn identity(path: &Path) -> io::Result<Identity> {
    let path = fs::canonicalize(path)?;
    let told = fs::metadata(&path)?;
    Ok(Identity { size: told.len(), modified: told.modified().ok(), path })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::resources::Contents;
    use rocking::Parameters;

    fn archive(folder: &Path) -> Archive {
        Archive { folder: folder.to_owned(), contents: Contents::from(Parameters::EVISON) }
    }

    #[test]
    fn a_record_is_read_once_until_its_file_changes() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("pulse 1.csv");
        fs::write(&file, "t/s,a\n0,1\n1,2\n").unwrap();
        let archive = archive(folder.path());
        let read = |text: &str| archive.record(text).unwrap().unwrap();
        let first = read("pulse 1.csv");
        let uri = format!("FILE://{}", file.display()).replace(' ', "%20");
        for text in [file.to_str().unwrap(), &uri, &format!("{}/./pulse 1.csv", folder.path().display())] {
            assert!(Arc::ptr_eq(&first, &read(text)), "{text} was read again");
        }
        fs::write(&file, "t/s,a\n0,1\n1,2\n2,3\n").unwrap();
        let second = read("pulse 1.csv");
        assert_eq!(second.record.times(), [0.0, 1.0, 2.0]);
        assert_ne!(first.digest, second.digest);
        let paths = READ.lock().unwrap().iter().filter(|(of, _)| of.path.ends_with("pulse 1.csv")).count();
        assert_eq!(paths, 1, "a file that has changed is kept twice");
    }

    #[test]
    fn what_is_no_record_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let at = folder.path().display();
        let resources = folder.path().join("resources");
        fs::create_dir_all(resources.join("folder.csv")).unwrap();
        fs::write(folder.path().join("outside.csv"), "t/s,a\n0,1\n1,2\n").unwrap();
        fs::write(resources.join("broken.csv"), "0,1\nroot:x:0:0:secret,2\n").unwrap();
        std::os::unix::fs::symlink(folder.path().join("outside.csv"), resources.join("link.csv")).unwrap();
        let archive = archive(&resources);
        let refusal = |text: &str| archive.record(text).unwrap_err().to_string();
        assert_eq!(
            refusal("absent.csv"),
            format!(
                "record = \"absent.csv\" is not in {at}/resources: No such file or directory (os error 2); a path on \
                 disk needs a separator: ./absent.csv"
            )
        );
        assert_eq!(refusal("link.csv"), "record = \"link.csv\" is no file of the archive");
        assert_eq!(refusal(".."), "record = \"..\" is no file of the archive");
        assert_eq!(refusal("folder.csv"), format!("record: {at}/resources/folder.csv is not a file"));
        assert_eq!(
            refusal("broken.csv"),
            format!("record: {at}/resources/broken.csv, line 2: the time \"root:x:0:0:secret\" is not a number")
        );
        assert_eq!(
            refusal("file://elsewhere/a.csv"),
            "record = \"file://elsewhere/a.csv\" is not a file URI of this machine, such as file:///tmp/record.AT2"
        );
        assert_eq!(
            refusal(&format!("{at}/absent.AT2")),
            format!("record: the record {at}/absent.AT2 cannot be read: No such file or directory (os error 2)")
        );
        assert!(archive.record("").unwrap().is_none());
        assert!(archive.record(&format!("{at}/outside.csv")).unwrap().is_some());
    }
}
