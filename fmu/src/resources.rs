//! The content of the archive's folder `resources`, found through the URI that the host gives: the parameters, and
//! the list of the records that were packed.

use rocking::Parameters;
use rocking::structure::parameters::ParameterError;
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::{fs, io};

/// The file with the parameters, in the archive's folder `resources`.
pub const PARAMETERS_FILE: &str = "parameters.toml";

/// The file with the names of the records, in the same folder; there is none without records.
pub const RECORDS_FILE: &str = "records.toml";

/// An archive that a host has unpacked.
#[derive(Clone, Debug)]
pub struct Archive {
    /// Its folder `resources`.
    pub folder: PathBuf,
    /// The content of the archive.
    pub contents: Contents,
}

/// The content of an archive.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Contents {
    /// Start values.
    pub parameters: Parameters,
    /// The first is the one that the ground follows unless the host sets another.
    pub records: Vec<PackedRecord>,
    /// The one that it follows vertically unless the host sets another.
    pub vertical: Option<PackedRecord>,
}

/// A record of an archive.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PackedRecord {
    /// Its file in the folder `resources`.
    pub file: String,
    /// Names its samples.
    pub digest: String,
}

/// The content of [`RECORDS_FILE`].
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Records {
    /// The records, the default first.
    #[serde(default)]
    pub record: Vec<PackedRecord>,
    /// The default of the vertical component.
    pub vertical: Option<PackedRecord>,
}

impl Contents {
    /// The record that the ground follows unless the host sets another; none if empty.
    pub fn default_record(&self) -> &str {
        self.records.first().map_or("", |packed| &packed.file)
    }

    /// The vertical component that it follows unless the host sets another; none if empty.
    pub fn default_vertical(&self) -> &str {
        self.vertical.as_ref().map_or("", |packed| &packed.file)
    }

    /// All that are packed.
    pub fn packed(&self) -> impl Iterator<Item = &PackedRecord> {
        self.records.iter().chain(&self.vertical)
    }
}

/// Without records.
impl From<Parameters> for Contents {
    fn from(parameters: Parameters) -> Contents {
        Contents { parameters, records: Vec::new(), vertical: None }
    }
}

/// Why the parameters could not be read.
#[derive(Debug, thiserror::Error)]
pub enum ResourceError {
    /// No such file, or not readable.
    #[error("{file}: {1}; unpack the whole archive and pass its folder \"resources\"", file = .0.display())]
    Unreadable(PathBuf, io::Error),
    /// Not the TOML that is needed.
    #[error("{file}: {1}", file = .0.display())]
    Malformed(PathBuf, Box<toml::de::Error>),
    /// A parameter out of range.
    #[error("{file}: {1}", file = .0.display())]
    Refused(PathBuf, ParameterError),
}

impl Archive {
    /// The one whose folder `resources` is `folder`.
    pub fn open(folder: PathBuf) -> Result<Archive, ResourceError> {
        let file = folder.join(PARAMETERS_FILE);
        let parameters: Parameters = read(&file)?;
        parameters.check().map_err(|error| ResourceError::Refused(file, error))?;
        let list = folder.join(RECORDS_FILE);
        let Records { record: records, vertical } = if list.exists() { read(&list)? } else { Records::default() };
        Ok(Archive { folder, contents: Contents { parameters, records, vertical } })
    }
}

/// The content of the TOML file `file`.
fn read<T: DeserializeOwned>(file: &Path) -> Result<T, ResourceError> {
    let file = file.to_owned();
    match fs::read_to_string(&file).map(|text| toml::from_str(&text)) {
        Ok(Ok(content)) => Ok(content),
        Ok(Err(error)) => Err(ResourceError::Malformed(file, Box::new(error))),
        Err(error) => Err(ResourceError::Unreadable(file, error)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_refusal_names_the_file_and_the_reason() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join(PARAMETERS_FILE);
        let refusal = || Archive::open(folder.path().to_owned()).unwrap_err().to_string();
        assert!(refusal().starts_with(&format!("{}: No such file", file.display())), "{}", refusal());

        let evison = "m = 125.8\nm0 = 44.02\nH = 1.05\nB = 0.285\nf_fc = 11\nzeta_fc = 0.015\nr = 0.96\nJ0 = 0\nc_ratio = 1\ng = 9.81\n";
        fs::write(&file, evison).unwrap();
        let archive = Archive::open(folder.path().to_owned()).unwrap();
        assert_eq!(archive.contents, Contents::from(Parameters::EVISON));

        fs::write(&file, evison.replace("r = 0.96", "r = 1.5")).unwrap();
        assert!(refusal().contains("r = 1.5 is out of range"), "{}", refusal());
        fs::write(&file, evison.replace("r = 0.96", "e = 0.96")).unwrap();
        assert!(refusal().contains("missing field `r`"), "{}", refusal());
    }
}
