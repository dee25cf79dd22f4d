//! The content of the archive's folder `resources`, found through the URI that the host gives: the numbers of the structure, and
//! the list of the records that were packed.

use rocking::structure::parameters::ParameterError;
use rocking::{Body, Floor, Ground, Mode, Modes, Structure, StructureError, Ties};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::collections::HashMap;
use std::fmt::{self, Display, Formatter};
use std::path::{Path, PathBuf};
use std::str::FromStr;
use std::{fs, io};

/// The file with the parameters of one mass, in the archive's folder `resources`.
pub const PARAMETERS_FILE: &str = "parameters.toml";

/// The file with the numbers of many masses, in the same folder in place of [`PARAMETERS_FILE`].
pub const FRAME_FILE: &str = "frame.txt";

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

/// The numbers from which a structure of many masses is made to the same bits: as text, three lines of numbers. TOML would
/// take 40 kB of the library.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameNumbers {
    /// m0, J0, m_s, S_1, I_2, B, g, c_ratio, P_0, k_t, xi_d, c_d, k_d, F_y, and r if the structure has one.
    body: Vec<f64>,
    /// Of each mode mass, gamma, share, height, stiffness and damping.
    modes: Vec<f64>,
    /// Of each floor mass, height, and the displacement per coordinate of each mode.
    floors: Vec<f64>,
    /// Place, stiffness and damping of each contact point of ground that gives.
    points: Vec<f64>,
}

/// Numbers of a structure without r, and of a mode.
const OF_BODY: usize = 14;
const OF_MODE: usize = 6;
const OF_POINT: usize = 3;

/// Lines of other numbers, or of another count of them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Incomplete;

impl Display for FrameNumbers {
    fn fmt(&self, text: &mut Formatter) -> fmt::Result {
        let points = [&self.points].into_iter().filter(|points| !points.is_empty());
        for line in [&self.body, &self.modes, &self.floors].into_iter().chain(points) {
            line.iter().try_for_each(|number| write!(text, "{number:?} "))?;
            writeln!(text)?;
        }
        Ok(())
    }
}

impl FromStr for FrameNumbers {
    type Err = Incomplete;

    fn from_str(text: &str) -> Result<FrameNumbers, Incomplete> {
        let mut lines = text.lines();
        let number = |word: &str| word.parse().ok().filter(|number: &f64| number.is_finite());
        let mut line =
            || -> Option<Vec<f64>> { lines.next().unwrap_or_default().split_whitespace().map(number).collect() };
        let (Some(body), Some(modes), Some(floors), Some(points)) = (line(), line(), line(), line()) else {
            return Err(Incomplete);
        };
        let of_floor = 2 + modes.len() / OF_MODE;
        let are_all = (OF_BODY..=OF_BODY + 1).contains(&body.len())
            && modes.len().is_multiple_of(OF_MODE)
            && floors.len().is_multiple_of(of_floor)
            && points.len().is_multiple_of(OF_POINT);
        if are_all { Ok(FrameNumbers { body, modes, floors, points }) } else { Err(Incomplete) }
    }
}

impl From<&Structure> for FrameNumbers {
    fn from(frame: &Structure) -> FrameNumbers {
        let &Body { m0, J0, m_s, S_1, I_2, B, r, g, c_ratio, ties } = frame.body();
        let Ties { P_0, k_t, xi_d, c_d, k_d, F_y } = ties;
        let body = [m0, J0, m_s, S_1, I_2, B, g, c_ratio, P_0, k_t, xi_d, c_d, k_d, F_y].into_iter().chain(r);
        let mode = |of: &Mode| [of.mass, of.gamma, of.share, of.height, of.stiffness, of.damping];
        let floor = |of: &Floor| [&[of.mass, of.height], of.shape.numbers()].concat();
        FrameNumbers {
            body: body.collect(),
            modes: frame.modes().iter().flat_map(mode).collect(),
            floors: frame.floors().iter().flat_map(floor).collect(),
            points: frame
                .foundation()
                .into_iter()
                .flat_map(|of| &of.points)
                .flat_map(|of| [of.xi, of.k, of.c])
                .collect(),
        }
    }
}

impl FrameNumbers {
    /// The structure.
    pub fn frame(&self) -> Result<Structure, StructureError> {
        let mut body = self.body.iter().copied();
        let mut next = || body.next().unwrap_or(f64::NAN);
        let [m0, J0, m_s, S_1, I_2, B, g, c_ratio] = std::array::from_fn(|_| next());
        let [P_0, k_t, xi_d, c_d, k_d, F_y] = std::array::from_fn(|_| next());
        let ties = Ties { P_0, k_t, xi_d, c_d, k_d, F_y };
        let body = Body { m0, J0, m_s, S_1, I_2, B, r: body.next(), g, c_ratio, ties };
        let mode = |&[mass, gamma, share, height, stiffness, damping]: &[f64; OF_MODE]| Mode {
            mass,
            gamma,
            share,
            height,
            stiffness,
            damping,
        };
        let modes: Vec<_> = self.modes.as_chunks().0.iter().map(mode).collect();
        let floor = |of: &[f64]| Floor { mass: of[0], height: of[1], shape: Modes::new(&of[2..]) };
        let floors = Vec::from_iter(self.floors.chunks_exact(2 + modes.len()).map(floor));
        let frame = Structure::of_body(body, &modes, &floors)?;
        if self.points.is_empty() {
            return Ok(frame);
        }
        let list = |which: usize| self.points.iter().skip(which).step_by(OF_POINT).copied().collect();
        frame.on(&Ground { xi: list(0), k: list(1), c: list(2), ..Ground::default() })
    }
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
    /// Not the numbers of many masses.
    #[error("{file}: not the lines of numbers that were exported; export it again", file = .0.display())]
    NoNumbers(PathBuf),
    /// Numbers that make no structure of many masses.
    #[error("{file}: {1}", file = .0.display())]
    NoFrame(PathBuf, Box<StructureError>),
}

impl Archive {
    /// The one whose folder `resources` is `folder`.
    pub fn open(folder: PathBuf) -> Result<Archive, ResourceError> {
        let (of_many, file) = (folder.join(FRAME_FILE), folder.join(PARAMETERS_FILE));
        let structure = if of_many.exists() {
            let text =
                fs::read_to_string(&of_many).map_err(|error| ResourceError::Unreadable(of_many.clone(), error))?;
            let numbers: FrameNumbers = text.parse().map_err(|_| ResourceError::NoNumbers(of_many.clone()))?;
            numbers.frame().map_err(|error| ResourceError::NoFrame(of_many, Box::new(error)))?
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

#[cfg(test)]
mod tests {
    use super::*;
    use rocking::Parameters;

    #[test]
    fn a_refusal_names_the_file_and_the_reason() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join(PARAMETERS_FILE);
        let refusal = || Archive::open(folder.path().to_owned()).unwrap_err().to_string();
        assert!(refusal().starts_with(&format!("{}: No such file", file.display())), "{}", refusal());

        let evison = "m = 125.8\nm0 = 44.02\nH = 1.05\nB = 0.285\nf_fc = 11\nzeta_fc = 0.015\nr = 0.96\nJ0 = 0\nc_ratio = 1\ng = 9.81\n";
        fs::write(&file, evison).unwrap();
        let archive = Archive::open(folder.path().to_owned()).unwrap();
        assert_eq!(archive.contents.structure, Structure::new(Parameters::EVISON).unwrap());

        fs::write(&file, evison.replace("r = 0.96", "r = 1.5")).unwrap();
        assert!(refusal().contains("r = 1.5 is out of range"), "{}", refusal());
        fs::write(&file, evison.replace("r = 0.96", "e = 0.96")).unwrap();
        assert!(refusal().contains("missing field `r`"), "{}", refusal());
    }

    #[test]
    fn a_structure_of_many_masses_needs_all_its_numbers() {
        let body = Body {
            m0: 1.0,
            J0: 0.1,
            m_s: 2.0,
            S_1: 6.0,
            I_2: 20.0,
            B: 0.5,
            r: None,
            g: 9.81,
            c_ratio: 1.0,
            ties: Ties::default(),
        };
        let floor = Floor { mass: 2.0, height: 3.0, shape: Modes::new(&[1.0]) };
        let frame = Structure::of_body(body, &[Mode::new(20.0, 0.02, 1.2, 4.0)], &[floor]).unwrap();
        let frame = frame.on(&Ground { f_v: Some(40.0), ..Ground::default() }).unwrap();
        let whole = FrameNumbers::from(&frame).to_string();
        let read = |text: &str| text.parse::<FrameNumbers>().map(|numbers| numbers.frame().unwrap());
        assert_eq!(read(&whole), Ok(frame));
        let lines: Vec<Vec<_>> = whole.lines().map(|line| line.split_whitespace().collect()).collect();
        for (line, word) in (0..lines.len()).flat_map(|line| (0..lines[line].len()).map(move |word| (line, word))) {
            let [mut less, mut none] = [lines.clone(), lines.clone()];
            less[line].remove(word);
            none[line][word] = "NaN";
            for changed in [less, none] {
                assert_eq!(
                    read(&changed.iter().map(|line| line.join(" ") + "\n").collect::<String>()),
                    Err(Incomplete)
                );
            }
        }
    }
}
