//! The records that the ground follows: found by name or path, and shared by all instances of the process that hold
//! them.

use crate::resources::{self, Archive};
use rocking::run::record::{Record, SamplesError};
use rocking_records::{Reading, RecordError, Source, Unit};
use std::error::Error;
use std::path::{MAIN_SEPARATOR, Path, PathBuf, is_separator};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError, Weak};
use std::{fs, io};
use uuid::Uuid;

/// Names the samples of a record, and their unit.
pub type Digest = [u8; 16];

/// A record that the ground can follow.
#[derive(Debug)]
pub struct GroundRecord {
    /// The record, as its file gives it, or as the files of both components give them.
    pub record: Record,
    /// The units of its accelerations, and of the vertical ones.
    pub units: [Unit; 2],
    /// Names all of it.
    pub digest: Digest,
    /// What it is made of, if of two files: they need not be read again while it is held.
    _components: Vec<Arc<GroundRecord>>,
}

/// Why a record cannot be had.
#[derive(Debug, thiserror::Error)]
pub enum GroundError {
    /// No file of that name.
    #[error("{parameter} = {name:?} is not in {folder}: {error}; a path on disk needs a separator: .{MAIN_SEPARATOR}{name}", folder = .folder.display())]
    NotInArchive {
        /// Who asks: the parameter.
        parameter: &'static str,
        /// What is asked for.
        name: String,
        /// Where it should be.
        folder: PathBuf,
        /// Why it is not.
        error: io::Error,
    },
    /// A name that leads out of the archive.
    #[error("{parameter} = {name:?} is no file of the archive")]
    Outside {
        /// Who asks: the parameter.
        parameter: &'static str,
        /// What is asked for.
        name: String,
    },
    /// Not the URI of a local file.
    #[error("{parameter} = {uri:?} is not a file URI of this machine, such as file:///tmp/record.AT2")]
    NotAFileUri {
        /// Who asks: the parameter.
        parameter: &'static str,
        /// What is asked for.
        uri: String,
    },
    /// The file is no record.
    #[error("{parameter}: {error}{cause}", cause = .error.source().map(|cause| format!(": {cause}")).unwrap_or_default())]
    NoRecord {
        /// Who asks: the parameter.
        parameter: &'static str,
        /// Why.
        error: RecordError,
    },
    /// The components do not belong together.
    #[error("record_v: {0}")]
    NoPair(#[from] SamplesError),
    /// A file of the archive is not what was packed.
    #[error("{parameter} = {name:?} in the archive is not the one that was exported with it; export it again")]
    Changed {
        /// Who asks: the parameter.
        parameter: &'static str,
        /// What is asked for.
        name: String,
    },
}

impl GroundRecord {
    /// Reads `bytes`, which are the content of the file at `path`; accelerations whose unit that does not state are in m/s².
    pub fn from_bytes(path: &Path, bytes: &[u8]) -> Result<GroundRecord, RecordError> {
        let (record, Source { unit, .. }) = rocking_records::from_bytes(path, bytes, &Reading::default())?;
        let numbers = record.times().iter().chain(record.acceleration());
        let bytes: Vec<_> = numbers.flat_map(|number| number.to_le_bytes()).chain([unit as u8]).collect();
        let digest = Uuid::new_v5(&Uuid::NAMESPACE_OID, &bytes).into_bytes();
        Ok(GroundRecord { record, units: [unit; 2], digest, _components: Vec::new() })
    }

    /// The ground motion of both components; of `vertical` alone on ground that rests horizontally.
    fn with_vertical(
        horizontal: Option<Arc<GroundRecord>>,
        vertical: Arc<GroundRecord>,
    ) -> Result<GroundRecord, SamplesError> {
        let (up, unit) = (&vertical.record, vertical.units[0]);
        let (record, unit, of_horizontal) = match &horizontal {
            Some(horizontal) => (horizontal.record.clone(), horizontal.units[0], horizontal.digest),
            None => (up.clone().multiplied(0.0), unit, Digest::default()),
        };
        let digest = pair(of_horizontal, vertical.digest);
        let (record, units) = (record.with_vertical(up)?, [unit, vertical.units[0]]);
        Ok(GroundRecord { record, units, digest, _components: horizontal.into_iter().chain([vertical]).collect() })
    }

    /// The digest, as archives have it.
    pub fn name(&self) -> String {
        Uuid::from_bytes(self.digest).to_string()
    }
}

/// The records that instances hold. The list owns none of them: when the last instance goes nothing is left, so that a
/// library that is loaded and unloaded for every run leaves nothing behind.
static HELD: Mutex<Records> = Mutex::new(Records::new());

type Records = Vec<(Content, Weak<GroundRecord>)>;

/// Names all that a record is made of: the bytes of its file and the file's name, or its components.
type Content = Uuid;

impl Drop for GroundRecord {
    fn drop(&mut self) {
        let mut held = held();
        held.retain(|(_, record)| record.strong_count() > 0);
        if held.is_empty() {
            *held = Records::new();
        }
    }
}

/// What is locked is whole after a panic.
fn held() -> MutexGuard<'static, Records> {
    HELD.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The one of `held` with this content, if somebody holds it.
fn find(held: &Records, content: Content) -> Option<Arc<GroundRecord>> {
    held.iter().filter(|(of, _)| *of == content).find_map(|(_, record)| record.upgrade())
}

/// Names the pair of a `horizontal` component, all zeros if there is none, and a `vertical` one.
fn pair(horizontal: Digest, vertical: Digest) -> Digest {
    Uuid::new_v5(&Uuid::from_bytes(horizontal), &vertical).into_bytes()
}

impl Archive {
    /// The ground motion that the parameters `record` and `record_v` ask for: none if both are empty; files of the archive by
    /// their names, or others by their paths or URIs.
    pub fn ground(&self, record: &str, record_v: &str) -> Result<Option<Arc<GroundRecord>>, GroundError> {
        let horizontal = self.component("record", record)?;
        let Some(vertical) = self.component("record_v", record_v)? else { return Ok(horizontal) };
        let of_horizontal = horizontal.as_ref().map_or(Digest::default(), |horizontal| horizontal.digest);
        let content = Uuid::from_bytes(pair(of_horizontal, vertical.digest));
        Ok(Some(shared(content, || GroundRecord::with_vertical(horizontal, vertical))?))
    }

    /// The record that `text`, the value of `parameter`, asks for.
    fn component(&self, parameter: &'static str, text: &str) -> Result<Option<Arc<GroundRecord>>, GroundError> {
        if text.is_empty() {
            return Ok(None);
        }
        let read = |path: &Path| read(path).map_err(|error| GroundError::NoRecord { parameter, error });
        let is_uri = text.split_once(':').is_some_and(|(scheme, _)| scheme.eq_ignore_ascii_case("file"));
        if is_uri {
            let path =
                resources::path(text).ok_or_else(|| GroundError::NotAFileUri { parameter, uri: text.to_owned() })?;
            return read(&path).map(Some);
        }
        if text.contains(is_separator) {
            return read(Path::new(text)).map(Some);
        }
        let (path, name) = (self.folder.join(text), text.to_owned());
        let real = match fs::canonicalize(&path) {
            Ok(real) => real,
            Err(error) => {
                return Err(GroundError::NotInArchive { parameter, name, folder: self.folder.clone(), error });
            }
        };
        if real.parent() != fs::canonicalize(&self.folder).ok().as_deref() {
            return Err(GroundError::Outside { parameter, name });
        }
        let record = read(&path)?;
        match self.contents.packed().find(|packed| packed.file == text) {
            Some(packed) if packed.digest != record.name() => Err(GroundError::Changed { parameter, name }),
            _ => Ok(Some(record)),
        }
    }
}

/// Names the `bytes` of the file `path`.
fn content(path: &Path, bytes: &[u8]) -> Content {
    let name = path.file_name().unwrap_or_default().as_encoded_bytes();
    Uuid::new_v5(&Uuid::new_v5(&Uuid::NAMESPACE_OID, name), bytes)
}

/// The record in the file `path`, which is parsed unless somebody holds a record of the same content.
fn read(path: &Path) -> Result<Arc<GroundRecord>, RecordError> {
    let bytes = rocking_records::read_file(path)?;
    shared(content(path, &bytes), || GroundRecord::from_bytes(path, &bytes))
}

/// The record of this `content` that somebody holds, or else the one that is `made`. That is done without the lock: of two
/// threads that make the same, one will throw its record away.
fn shared<E>(content: Content, made: impl FnOnce() -> Result<GroundRecord, E>) -> Result<Arc<GroundRecord>, E> {
    if let Some(record) = find(&held(), content) {
        return Ok(record);
    }
    let made = Arc::new(made()?);
    let mut held = held();
    let other = find(&held, content);
    if other.is_none() {
        held.push((content, Arc::downgrade(&made)));
    }
    drop(held); // a record that goes takes the lock
    Ok(other.unwrap_or(made))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::resources::{Contents, PackedRecord};
    use rocking::Parameters;

    fn archive(folder: &Path) -> Archive {
        Archive { folder: folder.to_owned(), contents: Contents::from(Parameters::EVISON) }
    }

    /// Whoever holds a record shares it, wherever its file is; a file that is rewritten is another record, even with
    /// the same size and time.
    #[test]
    fn a_record_is_known_by_its_content() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("pulse 1.csv");
        fs::write(&file, "t/s,a\n0,1\n1,2\n").unwrap();
        let modified = fs::metadata(&file).unwrap().modified().unwrap();
        let archive = archive(folder.path());
        let read = |text: &str| archive.component("record", text).unwrap().unwrap();
        let first = read("pulse 1.csv");
        let copied = folder.path().join("copy");
        fs::create_dir(&copied).unwrap();
        fs::copy(&file, copied.join("pulse 1.csv")).unwrap();
        let uri = format!("FILE://{}", file.display()).replace(' ', "%20");
        for text in [file.to_str().unwrap(), &uri, copied.join("pulse 1.csv").to_str().unwrap()] {
            assert!(Arc::ptr_eq(&first, &read(text)), "{text} was parsed again");
        }
        fs::write(&file, "t/s,a\n0,1\n1,3\n").unwrap();
        fs::File::options().write(true).open(&file).unwrap().set_modified(modified).unwrap();
        let second = read("pulse 1.csv");
        assert_eq!((first.record.acceleration(), second.record.acceleration()), (&[1.0, 2.0][..], &[1.0, 3.0][..]));
        assert_ne!(first.digest, second.digest);
        let ours = content(&file, &fs::read(&file).unwrap());
        let count = || held().iter().filter(|(of, _)| *of == ours).count();
        assert_eq!((count(), read("pulse 1.csv").digest, count()), (1, second.digest, 1));
        drop(second);
        assert_eq!(count(), 0);
    }

    /// A record that was packed is the one whose samples the archive names.
    #[test]
    fn a_packed_record_that_was_altered_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("pulse.csv");
        fs::write(&file, "t/s,a\n0,1\n1,2\n").unwrap();
        let digest = GroundRecord::from_bytes(&file, b"t/s,a\n0,1\n1,2\n").unwrap().name();
        let mut archive = archive(folder.path());
        archive.contents.records.push(PackedRecord { file: "pulse.csv".to_owned(), digest });
        assert!(archive.component("record", "pulse.csv").unwrap().is_some());
        fs::write(&file, "t/s,a\n0,1\n1,3\n").unwrap();
        assert_eq!(
            archive.component("record", "pulse.csv").unwrap_err().to_string(),
            "record = \"pulse.csv\" in the archive is not the one that was exported with it; export it again"
        );
        assert!(archive.component("record", file.to_str().unwrap()).unwrap().is_some(), "by its path it is any file");
    }

    /// Threads that take and drop the same records all the time: each gets what is in its file.
    #[test]
    fn threads_share_records() {
        let folder = tempfile::tempdir().unwrap();
        let archive = archive(folder.path());
        for name in 0..3 {
            fs::write(folder.path().join(format!("{name}.csv")), format!("t/s,a\n0,{name}\n1,2\n")).unwrap();
        }
        std::thread::scope(|scope| {
            for thread in 0..4 {
                let archive = &archive;
                scope.spawn(move || {
                    for round in 0..300 {
                        let name = (thread + round) % 3;
                        let record = archive.component("record", &format!("{name}.csv")).unwrap().unwrap();
                        assert_eq!(record.record.acceleration(), [f64::from(name), 2.0]);
                    }
                });
            }
        });
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
        let refusal = |text: &str| archive.component("record", text).unwrap_err().to_string();
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
        assert!(archive.component("record", "").unwrap().is_none());
        assert!(archive.component("record", &format!("{at}/outside.csv")).unwrap().is_some());
    }
}
