//! The content of the archive's folder `resources`, found through the URI that the host gives: the numbers of the structure, and
//! the list of the records that were packed.

use rocking::structure::parameters::ParameterError;
use rocking::structure::quantity::Units;
use rocking::{Body, Floor, Ground, Mode, Modes, Structure, StructureError};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::{fs, io};

/// The file with the parameters of one mass, in the archive's folder `resources`.
pub const PARAMETERS_FILE: &str = "parameters.toml";

/// The file with the numbers of many masses, in the same folder in place of [`PARAMETERS_FILE`].
pub const FRAME_FILE: &str = "frame.bin";

/// The file with the names of the records, in the same folder; there is none without records that the host may set.
pub const RECORDS_FILE: &str = "records.toml";

/// An archive that a host has unpacked.
#[derive(Clone, Debug)]
pub struct Archive {
    /// Its folder `resources`.
    pub folder: PathBuf,
    /// The content of the archive.
    pub contents: Contents,
    /// The bytes of the packed records by their names: a host may delete or lock the folder once the instance is made.
    pub files: HashMap<String, Vec<u8>>,
}

/// The content of an archive.
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

/// The numbers from which a structure of many masses is made to the same bits. TOML would take 40 kB of the library.
pub fn frame_bytes(frame: &Structure) -> Vec<u8> {
    let floor = |of: &Floor| (of.mass, of.height, of.shape.numbers().to_vec());
    let floors = Vec::from_iter(frame.floors().iter().map(floor));
    let ground = frame.foundation().map(|of| &of.ground);
    let numbers = (frame.units(), frame.body(), frame.modes(), floors, ground);
    postcard::to_stdvec(&numbers).expect("numbers can always be written")
}

/// The structure of these [`frame_bytes`].
pub fn frame(bytes: &[u8]) -> Result<Structure, FrameError> {
    type Numbers = (Units, Body, Vec<Mode>, Vec<(f64, f64, Vec<f64>)>, Option<Ground>);
    let numbers = postcard::from_bytes::<Numbers>(bytes);
    let (units, body, modes, floors, ground) = numbers.map_err(|_| FrameError::NoNumbers)?;
    let floor =
        |(mass, height, shape): &(f64, f64, Vec<f64>)| Floor { mass: *mass, height: *height, shape: Modes::new(shape) };
    let frame = Structure::of_body(body, &modes, &Vec::from_iter(floors.iter().map(floor)))?.measured_in(units);
    Ok(ground.map_or(Ok(frame.clone()), |ground| frame.on(&ground))?)
}

/// Why bytes are no structure of many masses.
#[derive(Debug, PartialEq, thiserror::Error)]
pub enum FrameError {
    /// Not the numbers that were exported.
    #[error("not the numbers that were exported; export it again")]
    NoNumbers,
    /// Numbers that make no structure.
    #[error(transparent)]
    NoFrame(#[from] StructureError),
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
    /// Whether the host can set no other record.
    #[serde(default)]
    pub fixed: bool,
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
impl From<Structure> for Contents {
    fn from(structure: Structure) -> Contents {
        Contents { structure, records: Vec::new(), vertical: None, fixed: false }
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
    /// No structure of many masses.
    #[error("{file}: {1}", file = .0.display())]
    NoFrame(PathBuf, Box<FrameError>),
}

impl Archive {
    /// The one whose folder `resources` is `folder`.
    pub fn open(folder: PathBuf) -> Result<Archive, ResourceError> {
        let (of_many, file) = (folder.join(FRAME_FILE), folder.join(PARAMETERS_FILE));
        let structure = if of_many.exists() {
            let bytes = fs::read(&of_many).map_err(|error| ResourceError::Unreadable(of_many.clone(), error))?;
            frame(&bytes).map_err(|error| ResourceError::NoFrame(of_many, Box::new(error)))?
        } else {
            Structure::new(read(&file)?).map_err(|error| ResourceError::Refused(file, error))?
        };
        let list = folder.join(RECORDS_FILE);
        let Records { record: records, vertical, fixed } =
            if list.exists() { read(&list)? } else { Records::default() };
        let contents = Contents { structure, records, vertical, fixed };
        let bytes = |packed: &PackedRecord| {
            let bytes = rocking_records::read_file(&folder.join(&packed.file)).ok()?; // refused when it is followed
            Some((packed.file.clone(), bytes))
        };
        Ok(Archive { files: contents.packed().filter_map(bytes).collect(), folder, contents })
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
