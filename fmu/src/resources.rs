//! The content of the archive's folder `resources`, found through the URI that the host gives: the numbers of the structure, and
//! the list of the records that were packed.

use rocking::structure::description::Description;
use rocking::{Refused, Structure};
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::path::PathBuf;
use std::{fs, io};

/// The file with the [`Contents`] of an archive, in its folder `resources`.
pub const CONTENTS_FILE: &str = "contents.bin";

/// An archive that a host has unpacked.
#[derive(Clone, Debug)]
pub struct Archive {
    /// Its folder `resources`.
    pub folder: PathBuf,
    pub contents: Contents,
    /// The bytes of the packed records by their names: a host may delete or lock the folder once the instance is made.
    pub files: HashMap<String, Vec<u8>>,
}

#[derive(Clone, Debug, PartialEq)]
pub struct Contents {
    /// The structure; the parameters of one mass are start values.
    pub structure: Structure,
    /// The first is the one that the ground follows unless the host sets another.
    pub records: Vec<PackedRecord>,
    /// The one that it follows vertically unless the host sets another.
    pub vertical: Option<PackedRecord>,
    /// Whether the FMU has no string parameters, so that the host can set no other record.
    pub fixed: bool,
}

#[derive(Debug, thiserror::Error)]
pub enum ContentsError {
    #[error("not the numbers that were exported; export it again")]
    NoNumbers,
    #[error(transparent)]
    NoStructure(#[from] Refused),
}

#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct PackedRecord {
    /// Its file in the folder `resources`.
    pub file: String,
    pub digest: String,
}

impl Contents {
    pub fn description(&self) -> &Description {
        self.structure.description().expect("an FMU is of a structure that was described")
    }

    /// The values of the numbers of the structure that a host may set.
    pub fn numbers(&self) -> Vec<f64> {
        self.description().numbers().into_iter().map(|of| of.value).collect()
    }

    /// The structure with these values of its [`Contents::numbers`].
    pub fn with(&self, numbers: &[f64]) -> Result<Structure, Refused> {
        if self.numbers() == numbers {
            return Ok(self.structure.clone()); // its modes have been found
        }
        Ok(self.description().with(numbers).structure()?.measured_in(self.structure.units()))
    }

    /// The bytes of [`CONTENTS_FILE`]. As TOML they would take 200 kB of the library.
    pub fn to_bytes(&self) -> Vec<u8> {
        let Contents { structure, records, vertical, fixed } = self;
        let contents = (self.description(), structure.units(), records, vertical, fixed);
        postcard::to_stdvec(&contents).expect("numbers and text can always be written")
    }

    /// The contents of which these are the [`Contents::to_bytes`].
    pub fn from_bytes(bytes: &[u8]) -> Result<Contents, ContentsError> {
        let Ok(((description, units, records, vertical, fixed), [])) = postcard::take_from_bytes(bytes) else {
            return Err(ContentsError::NoNumbers);
        };
        let structure = Description::structure(&description)?.measured_in(units);
        Ok(Contents { structure, records, vertical, fixed })
    }

    /// The record that the ground follows unless the host sets another; none if empty.
    pub fn default_record(&self) -> &str {
        self.records.first().map_or("", |packed| &packed.file)
    }

    pub fn packed(&self) -> impl Iterator<Item = &PackedRecord> {
        self.records.iter().chain(&self.vertical)
    }
}

/// Without records.
impl From<Structure> for Contents {
    fn from(structure: Structure) -> Contents {
        Contents { structure, records: Vec::new(), vertical: None, fixed: false }
    }
}

#[derive(Debug, thiserror::Error)]
pub enum ResourceError {
    #[error("{file}: {1}; unpack the whole archive and pass its folder \"resources\"", file = .0.display())]
    Unreadable(PathBuf, io::Error),
    #[error("{file}: {1}", file = .0.display())]
    NoContents(PathBuf, Box<ContentsError>),
}

impl Archive {
    pub fn open(folder: PathBuf) -> Result<Archive, ResourceError> {
        let file = folder.join(CONTENTS_FILE);
        let bytes = fs::read(&file).map_err(|error| ResourceError::Unreadable(file.clone(), error))?;
        let contents = Contents::from_bytes(&bytes).map_err(|error| ResourceError::NoContents(file, error.into()))?;
        let bytes = |packed: &PackedRecord| {
            let bytes = rocking_records::read_file(&folder.join(&packed.file)).ok()?; // refused when it is followed
            Some((packed.file.clone(), bytes))
        };
        Ok(Archive { files: contents.packed().filter_map(bytes).collect(), folder, contents })
    }
}
