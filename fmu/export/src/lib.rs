//! Makes the FMU: an archive of the shared libraries with all that describes them.

mod documentation;
mod experiment;
mod library;
mod model_description;
mod units;

use ::model_description::DefaultExperiment;
pub use ::model_description::Version;
use ::model_description::archive::{Entry, archive};
use FlexibleRocking::ground::GroundRecord;
pub use FlexibleRocking::resources::Contents;
use FlexibleRocking::resources::{CONTENTS_FILE, ContentsError, PackedRecord};
pub use library::{Library, LibraryError, Platform};
use rocking::run::record::SamplesError;
use rocking_records::RecordError;
use std::path::{Path, PathBuf};
use std::str::FromStr;

/// Licences of all that the shared library is made of, on every [`Platform`]; `WRITE_LICENSES=1 cargo test --release -p flexible-rocking-fmu --test licenses` writes it.
const LICENSES: &str = include_str!("../resources/licenses.txt");

const ICON: &[u8] = include_bytes!("../resources/model.png");

/// The name of a model in its description, and of the files of its libraries.
#[derive(Clone, Debug)]
pub struct ModelName(String);

impl ModelName {
    pub fn as_str(&self) -> &str {
        &self.0
    }
}

impl Default for ModelName {
    fn default() -> ModelName {
        ModelName("FlexibleRocking".into())
    }
}

impl FromStr for ModelName {
    type Err = ExportError;

    /// Accepts any identifier of C, as the standard does.
    fn from_str(name: &str) -> Result<ModelName, ExportError> {
        let is_word = |c: char| c == '_' || c.is_ascii_alphanumeric();
        if name.chars().all(is_word) && name.starts_with(|c: char| !c.is_ascii_digit()) {
            Ok(ModelName(name.into()))
        } else {
            Err(ExportError::Name(name.into()))
        }
    }
}

/// Accepts a `target` that ends in .fmu.
pub fn check_target(target: &Path) -> Result<(), ExportError> {
    let is_fmu = target.extension().is_some_and(|suffix| suffix.eq_ignore_ascii_case("fmu"));
    if is_fmu { Ok(()) } else { Err(ExportError::Suffix(target.into())) }
}

#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    #[error("the name {0:?} must consist of the letters a to z and A to Z, digits and _, and not begin with a digit")]
    Name(String),
    #[error("{} does not end in .fmu, as hosts require: add .fmu", .0.display())]
    Suffix(PathBuf),
    #[error("two shared libraries are for {}: leave one out", .0.tuple())]
    SamePlatform(Platform),
    /// A structure of many masses without modes.
    #[error("the FMU moves modes: {0}; for a rigid structure set detail = rigid")]
    Structure(#[from] ContentsError),
    #[error(transparent)]
    NoPair(#[from] SamplesError),
    #[error(transparent)]
    NoRecord(#[from] RecordError),
    #[error("the record {path} needs a name in UTF-8", path = .0.display())]
    RecordName(PathBuf),
    #[error(
        "the archive would have two files called {0}: rename the record; capitals and small letters are the same here"
    )]
    SameName(String),
    #[error("the archive: {0}")]
    Archive(#[from] zip::result::ZipError),
}

pub type RecordFile = (PathBuf, Vec<u8>);

/// The FMU of `contents`, yet without records, under `name` for hosts of `version`: its contents, and the bytes of the archive.
///
/// The archive has the shared `libraries` and the `records`. The ground follows the first record, and `vertical` is its vertical
/// component. The same name, contents, libraries and records give the same bytes.
pub fn export(
    version: Version,
    name: &ModelName,
    mut contents: Contents,
    records: Vec<RecordFile>,
    vertical: Option<RecordFile>,
    libraries: &[Library],
) -> Result<(Contents, Vec<u8>), ExportError> {
    let mut libraries: Vec<_> = libraries.iter().collect();
    libraries.sort_by_key(|library| library.platform);
    if let Some(two) = libraries.windows(2).find(|two| two[0].platform == two[1].platform) {
        return Err(ExportError::SamePlatform(two[0].platform));
    }
    Contents::from_bytes(&contents.to_bytes())?;
    let mut files = Vec::new();
    let mut pack = |contents: &Contents, (path, content): RecordFile| {
        let record = GroundRecord::from_bytes(&path, &content, contents.structure.base().g)?;
        let name = path.file_name().and_then(|name| name.to_str());
        let file = name.ok_or_else(|| ExportError::RecordName(path.clone()))?.to_owned();
        let mut names = contents.packed().map(|packed| packed.file.as_str()).chain([CONTENTS_FILE]);
        if names.any(|name| name.to_lowercase() == file.to_lowercase()) {
            return Err(ExportError::SameName(file));
        }
        files.push(content);
        Ok((PackedRecord { file, digest: record.name() }, record))
    };
    let mut ground = None;
    for record in records {
        let (packed, record) = pack(&contents, record)?;
        contents.records.push(packed);
        ground.get_or_insert(record);
    }
    if let Some(vertical) = vertical {
        let (packed, record) = pack(&contents, vertical)?;
        contents.vertical = Some(packed);
        ground = Some(GroundRecord::with_vertical(ground, &record)?);
    }
    let experiment = experiment::default_experiment(&contents.structure, ground.as_ref());
    let archive = archive(&entries(version, name.as_str(), &contents, experiment, files, &libraries)?)?;
    Ok((contents, archive))
}

/// The content of the archive, with the `records` as they are.
fn entries(
    version: Version,
    name: &str,
    contents: &Contents,
    experiment: DefaultExperiment,
    records: Vec<Vec<u8>>,
    libraries: &[&Library],
) -> Result<Vec<Entry>, ExportError> {
    let entry = |path: &str, content| Entry { path: path.to_owned(), content };
    let page = documentation::documentation(version, name, contents, libraries);
    let description = model_description::xml(version, name, contents, experiment);
    let icon = if version == Version::Fmi2 { "model.png" } else { "terminalsAndIcons/icon.png" };
    let mut entries = vec![entry("modelDescription.xml", description.into()), entry(icon, ICON.to_vec())];
    entries.extend([
        entry("documentation/index.html", page.into()),
        entry("documentation/licenses/license.txt", LICENSES.into()),
        entry(&format!("resources/{CONTENTS_FILE}"), contents.to_bytes()),
    ]);
    let packed = contents.packed().zip(records);
    entries.extend(packed.map(|(packed, file)| entry(&format!("resources/{}", packed.file), file)));
    entries
        .extend(libraries.iter().map(|library| entry(&library.platform.path(version, name), library.content.clone())));
    Ok(entries)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rocking::{Parameters, Structure};

    fn structure(parameters: Parameters) -> Structure {
        Structure::new(parameters).unwrap()
    }

    /// A library that passes for the one of this build for `platform`.
    fn library(platform: Platform) -> Library {
        Library { platform, content: platform.target().into() }
    }

    #[test]
    fn two_exports_of_the_same_are_the_same_bytes() {
        let exported = |of, platforms: [Platform; 2]| {
            let contents = structure(of).into();
            export(Version::Fmi2, &ModelName::default(), contents, Vec::new(), None, &platforms.map(library)).unwrap().1
        };
        let [linux, windows] = [Platform::Linux64, Platform::Windows64];
        let first = exported(Parameters::EVISON, [linux, windows]);
        assert_eq!(first, exported(Parameters::EVISON, [windows, linux]));
        assert_ne!(first, exported(Parameters::MCMANUS, [linux, windows]));
    }

    #[test]
    fn the_archive_holds_what_the_standard_and_the_library_look_for() {
        let libraries = Platform::ALL.map(library);
        let libraries: Vec<_> = libraries.iter().collect();
        let contents = Contents::from(structure(Parameters::EVISON));
        let experiment = experiment::default_experiment(&contents.structure, None);
        let of_2 = (
            ["model.png"].as_slice(),
            ["linux64/Pier.so", "aarch64-linux/Pier.so", "win64/Pier.dll", "darwin64/Pier.dylib"],
        );
        let of_3 = (
            ["terminalsAndIcons/icon.png"].as_slice(),
            ["x86_64-linux/Pier.so", "aarch64-linux/Pier.so", "x86_64-windows/Pier.dll", "x86_64-darwin/Pier.dylib"],
        );
        for (version, (own, binaries)) in [(Version::Fmi2, of_2), (Version::Fmi3, of_3)] {
            let entries = entries(version, "Pier", &contents, experiment, Vec::new(), &libraries).unwrap();
            let (binary, other): (Vec<_>, Vec<_>) =
                entries.iter().partition(|entry| entry.path.starts_with("binaries/"));
            let paths = |entries: &[&Entry]| entries.iter().map(|entry| entry.path.clone()).collect::<Vec<_>>();
            let common = ["documentation/index.html", "documentation/licenses/license.txt", "resources/contents.bin"];
            assert_eq!(paths(&other), [&["modelDescription.xml"], own, &common].concat());
            let expected = [&binaries[..], &["aarch64-darwin/Pier.dylib"]].concat();
            assert_eq!(paths(&binary), expected.iter().map(|path| format!("binaries/{path}")).collect::<Vec<_>>());
            let libraries: Vec<_> = binary.iter().map(|entry| str::from_utf8(&entry.content).unwrap()).collect();
            assert_eq!(libraries, Platform::ALL.map(Platform::target));
            assert_eq!(Contents::from_bytes(&other.last().unwrap().content).unwrap(), contents);
        }
    }
}
