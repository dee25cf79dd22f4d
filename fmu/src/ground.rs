//! The records that the ground follows, found by name or path.

use crate::resources::Archive;
use fmi_unit::uri;
use rocking::run::record::{Record, SamplesError};
use rocking_records::{Reading, RecordError, Unit};
use std::borrow::Cow;
use std::error::Error;
use std::path::{MAIN_SEPARATOR, Path, PathBuf, is_separator};
use std::sync::Arc;
use uuid::Uuid;

/// Names the samples of a record, and their unit.
pub type RecordDigest = [u8; 16];

#[derive(Debug)]
pub struct GroundRecord {
    /// The record, as its file gives it, or as the files of both components give them.
    pub record: Record,
    /// The units of its accelerations, and of the vertical ones.
    pub units: [Unit; 2],
    pub digest: RecordDigest,
    /// Sentences about each file: first the content, then an assumption.
    pub sentences: Vec<Vec<String>>,
}

/// A record, and the name of the texts and the files that it was read from.
pub(crate) type CachedRecord = (Uuid, Arc<GroundRecord>);

/// Why a record cannot be had. Each names the parameter that asks for it.
#[derive(Debug, thiserror::Error)]
pub enum GroundError {
    #[error("{0} = {1:?} is not in {folder}; a path on disk needs a separator: .{MAIN_SEPARATOR}{1}", folder = .2.display())]
    NotInArchive(&'static str, String, PathBuf),
    #[error("{0} = {1:?} is not a file URI of this machine, such as file:///tmp/record.AT2")]
    NotAFileUri(&'static str, String),
    #[error("{0}: {1}{cause}", cause = .1.source().map(|cause| format!(": {cause}")).unwrap_or_default())]
    NoRecord(&'static str, RecordError),
    #[error("record_v: {0}")]
    NoPair(#[from] SamplesError),
    #[error("{0} = {1:?} in the archive is not the one that was exported with it; export it again")]
    Changed(&'static str, String),
}

impl GroundRecord {
    /// Reads `bytes`, which are the content of the file at `path`; accelerations whose unit that does not state are in m/s².
    /// A g stands for `g` (m/s²) in what is said of the record.
    pub fn from_bytes(path: &Path, bytes: &[u8], g: f64) -> Result<GroundRecord, RecordError> {
        let (record, source) = rocking_records::from_bytes(path, bytes, &Reading::default())?;
        let unit = source.unit;
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let found = rocking_records::in_m_s2(record.clone(), unit, g).map(|record| source.findings(&name, &record, g));
        let assumed = source.assumption("head its column with the unit, such as a (g)");
        let sentences = found.into_iter().chain(assumed.map(|assumed| format!("{name}: {assumed}"))).collect();
        let numbers = record.times().iter().chain(record.acceleration());
        let bytes: Vec<_> = numbers.flat_map(|number| number.to_le_bytes()).chain([unit as u8]).collect();
        let digest = Uuid::new_v5(&Uuid::NAMESPACE_OID, &bytes).into_bytes();
        Ok(GroundRecord { record, units: [unit; 2], digest, sentences: vec![sentences] })
    }

    /// The ground motion of both components; of `vertical` alone on ground that rests horizontally.
    pub fn with_vertical(
        horizontal: Option<GroundRecord>,
        vertical: &GroundRecord,
    ) -> Result<GroundRecord, SamplesError> {
        let (up, unit) = (&vertical.record, vertical.units[0]);
        let (record, units, of_horizontal, mut sentences) = match horizontal {
            Some(along) => (along.record, [along.units[0], unit], along.digest, along.sentences),
            None => (up.clone().multiplied(0.0), [unit; 2], RecordDigest::default(), Vec::new()),
        };
        sentences.extend(vertical.sentences.iter().cloned());
        let digest = Uuid::new_v5(&Uuid::from_bytes(of_horizontal), &vertical.digest).into_bytes();
        Ok(GroundRecord { record: record.with_vertical(up)?, units, digest, sentences })
    }

    /// The record with its accelerations in m/s², if a g is `g` (m/s²).
    pub fn in_m_s2(&self, g: f64) -> Record {
        let [unit, vertical_unit] = self.units.map(|unit| unit.in_m_s2(g));
        self.record.clone().multiplied_each(unit, vertical_unit)
    }

    /// The digest, as archives have it.
    pub fn name(&self) -> String {
        Uuid::from_bytes(self.digest).to_string()
    }
}

struct NamedFile<'a> {
    parameter: &'static str,
    text: &'a str,
    path: PathBuf,
    bytes: Cow<'a, [u8]>,
}

impl Archive {
    /// The ground motion of the parameters `record` and `record_v`; none if both are empty.
    ///
    /// Files of the archive are called by their names, others by their paths or URIs. Messages about a record give accelerations in
    /// the unit `g` (m/s²). The record is parsed, and kept, unless it is `kept` already.
    pub(crate) fn ground(
        &self,
        record: &str,
        record_v: &str,
        g: f64,
        kept: &mut Option<CachedRecord>,
    ) -> Result<Option<Arc<GroundRecord>>, GroundError> {
        let (along, up) = (self.read("record", record)?, self.read("record_v", record_v)?);
        if along.is_none() && up.is_none() {
            return Ok(None);
        }
        let parts =
            [&along, &up].map(|of| of.as_ref().map_or([[].as_slice(); 2], |of| [of.text.as_bytes(), &of.bytes]));
        let of_g = Uuid::new_v5(&Uuid::NAMESPACE_OID, &g.to_le_bytes());
        let name = parts.as_flattened().iter().fold(of_g, |name, part| Uuid::new_v5(&name, part));
        if let Some((_, ground)) = kept.as_ref().filter(|(of, _)| *of == name) {
            return Ok(Some(Arc::clone(ground)));
        }
        let along = along.map(|along| self.parse(along, g)).transpose()?;
        let ground = match up.map(|up| self.parse(up, g)).transpose()? {
            Some(up) => Some(GroundRecord::with_vertical(along, &up)?),
            None => along,
        };
        let ground = ground.map(Arc::new);
        *kept = ground.clone().map(|ground| (name, ground));
        Ok(ground)
    }

    /// The file that `text`, the value of `parameter`, asks for.
    fn read<'a>(&'a self, parameter: &'static str, text: &'a str) -> Result<Option<NamedFile<'a>>, GroundError> {
        if text.is_empty() {
            return Ok(None);
        }
        let is_uri = text.split_once(':').is_some_and(|(scheme, _)| scheme.eq_ignore_ascii_case("file"));
        let path = if is_uri {
            uri::path(text).ok_or_else(|| GroundError::NotAFileUri(parameter, text.to_owned()))?
        } else if text.contains(is_separator) {
            PathBuf::from(text)
        } else {
            let path = self.folder.join(text);
            if !self.files.contains_key(text) && !path.exists() {
                return Err(GroundError::NotInArchive(parameter, text.to_owned(), self.folder.clone()));
            }
            path
        };
        let bytes = match self.files.get(text) {
            Some(bytes) => Cow::Borrowed(bytes.as_slice()),
            None => rocking_records::read_file(&path).map_err(|error| GroundError::NoRecord(parameter, error))?.into(),
        };
        Ok(Some(NamedFile { parameter, text, path, bytes }))
    }

    /// The record in that file; one that was packed must be as it was.
    fn parse(
        &self,
        NamedFile { parameter, text, path, bytes }: NamedFile,
        g: f64,
    ) -> Result<GroundRecord, GroundError> {
        let record =
            GroundRecord::from_bytes(&path, &bytes, g).map_err(|error| GroundError::NoRecord(parameter, error))?;
        match self.contents.packed().find(|packed| packed.file == text) {
            Some(packed) if packed.digest != record.name() => Err(GroundError::Changed(parameter, text.to_owned())),
            _ => Ok(record),
        }
    }
}
