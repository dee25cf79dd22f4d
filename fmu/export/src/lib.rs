//! Makes the FMU: an archive of the shared libraries with all that describes them.
#![allow(non_snake_case)] // the shared library's name

mod archive;
mod documentation;
mod model_description;
pub mod significant;

use FlexibleRocking::BUILD;
use FlexibleRocking::ground::GroundRecord;
use FlexibleRocking::resources::{Contents, PARAMETERS_FILE, PackedRecord, RECORDS_FILE, Records};
use archive::Entry;
use rocking::Structure;
use rocking::record::RecordError;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::{fs, io};

/// Licences of all that the shared library is made of, on every [`Platform`]; `make licenses` writes it.
const LICENSES: &str = include_str!("../resources/licenses.txt");

const ICON: &[u8] = include_bytes!("../resources/model.png");

/// A platform for which an archive can have a shared library.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Platform {
    /// Linux on x86-64.
    Linux64,
    /// Windows on x86-64.
    Windows64,
}

impl Platform {
    /// Name, for people.
    fn name(self) -> &'static str {
        match self {
            Platform::Linux64 => "Linux",
            Platform::Windows64 => "Windows",
        }
    }

    /// Where the archive has the library.
    fn path(self) -> &'static str {
        match self {
            Platform::Linux64 => "binaries/linux64/FlexibleRocking.so",
            Platform::Windows64 => "binaries/win64/FlexibleRocking.dll",
        }
    }

    /// What shared libraries begin with.
    fn magic(self) -> &'static [u8] {
        match self {
            Platform::Linux64 => b"\x7fELF",
            Platform::Windows64 => b"MZ",
        }
    }

    /// How to get ours.
    fn remedy(self) -> &'static str {
        match self {
            Platform::Linux64 => "`cargo build --release` builds it",
            Platform::Windows64 => "`make dist` builds it",
        }
    }
}

/// Why an FMU could not be made.
#[derive(Debug, thiserror::Error)]
pub enum ExportError {
    /// No such library.
    #[error("the shared library {path} does not exist: {remedy}", path = .0.display(), remedy = .1.remedy())]
    Missing(PathBuf, Platform),
    /// A library that cannot be read.
    #[error("cannot read the shared library {path}: {error}", path = .path.display())]
    Unreadable {
        /// The library.
        path: PathBuf,
        /// Why.
        error: io::Error,
    },
    /// A file of another kind, or for another platform.
    #[error("{path} is not a shared library for {name}: {remedy}", path = .0.display(), name = .1.name(), remedy = .1.remedy())]
    OtherPlatform(PathBuf, Platform),
    /// A library from other sources than this exporter, so that its variables may be others.
    #[error(
        "the shared library {path} is of another build: the name of this one, {BUILD}, does not occur in it; {remedy}",
        path = .0.display(),
        remedy = .1.remedy()
    )]
    OtherBuild(PathBuf, Platform),
    /// A file that is no record.
    #[error(transparent)]
    NoRecord(#[from] RecordError),
    /// A file whose name is not text.
    #[error("the record {path} needs a name in UTF-8", path = .0.display())]
    RecordName(PathBuf),
    /// Two records of one name, which is what the FMU knows them by.
    #[error("two records are called {0}: rename one of them; capitals and small letters are the same here")]
    SameName(String),
    /// The model description cannot be written.
    #[error("modelDescription.xml: {0}")]
    Description(#[from] ::model_description::SeError),
    /// The documentation cannot be written.
    #[error("documentation/index.html: {0}")]
    Documentation(#[from] minijinja::Error),
    /// The parameters, or the names of the records, cannot be written.
    #[error("resources: {0}")]
    Resources(#[from] toml::ser::Error),
    /// The archive cannot be made.
    #[error("the archive: {0}")]
    Archive(#[from] zip::result::ZipError),
}

/// The FMU of `structure`, with the shared libraries that `libraries` names and the `records`, of which the first is what
/// its ground follows: what it carries, and the bytes of the archive. The same structure, libraries and records give the
/// same bytes.
pub fn export(
    structure: &Structure,
    records: &[PathBuf],
    libraries: &BTreeMap<Platform, PathBuf>,
) -> Result<(Contents, Vec<u8>), ExportError> {
    let libraries = libraries.iter().map(|(&platform, path)| Ok((platform, read(path, platform)?)));
    let libraries = libraries.collect::<Result<Vec<_>, ExportError>>()?;
    let (mut contents, mut files) = (Contents::from(*structure.parameters()), Vec::new());
    for path in records {
        let record = GroundRecord::read(path)?;
        let name = path.file_name().and_then(|name| name.to_str());
        let file = name.ok_or_else(|| ExportError::RecordName(path.clone()))?.to_owned();
        if contents.records.iter().any(|packed| packed.file.to_lowercase() == file.to_lowercase()) {
            return Err(ExportError::SameName(file));
        }
        files.push(fs::read(path).map_err(|source| RecordError::Unreadable { path: path.clone(), source })?);
        contents.records.push(PackedRecord { file, digest: record.name() });
    }
    let archive = archive::archive(&entries(structure, &contents, files, libraries)?)?;
    Ok((contents, archive))
}

/// The shared library at `path`, if it is there, for `platform` and of this build.
fn read(path: &Path, platform: Platform) -> Result<Vec<u8>, ExportError> {
    let library = fs::read(path).map_err(|error| match error.kind() {
        io::ErrorKind::NotFound => ExportError::Missing(path.to_owned(), platform),
        _ => ExportError::Unreadable { path: path.to_owned(), error },
    })?;
    if !library.starts_with(platform.magic()) {
        return Err(ExportError::OtherPlatform(path.to_owned(), platform));
    }
    if !library.windows(BUILD.len()).any(|bytes| bytes == BUILD.as_bytes()) {
        return Err(ExportError::OtherBuild(path.to_owned(), platform));
    }
    Ok(library)
}

/// The content of the archive, with the `records` as they are.
fn entries(
    structure: &Structure,
    contents: &Contents,
    records: Vec<Vec<u8>>,
    libraries: Vec<(Platform, Vec<u8>)>,
) -> Result<Vec<Entry>, ExportError> {
    let entry = |path: &str, content| Entry { path: path.to_owned(), content };
    let mut entries = vec![
        entry("modelDescription.xml", model_description::model_description(contents).to_xml()?.into()),
        entry("model.png", ICON.to_vec()),
        entry("documentation/index.html", documentation::documentation(structure, contents)?.into()),
        entry("documentation/licenses/license.txt", LICENSES.into()),
        entry(&format!("resources/{PARAMETERS_FILE}"), toml::to_string(&contents.parameters)?.into()),
    ];
    if !contents.records.is_empty() {
        let names = Records { record: contents.records.clone() };
        entries.push(entry(&format!("resources/{RECORDS_FILE}"), toml::to_string(&names)?.into()));
    }
    let packed = contents.records.iter().zip(records);
    entries.extend(packed.map(|(packed, file)| entry(&format!("resources/{}", packed.file), file)));
    entries.extend(libraries.into_iter().map(|(platform, library)| entry(platform.path(), library)));
    Ok(entries)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rocking::Parameters;

    fn structure(parameters: Parameters) -> Structure {
        Structure::new(parameters).unwrap()
    }

    /// A file that passes for the library of this build.
    fn library(folder: &Path) -> PathBuf {
        let path = folder.join("library.so");
        fs::write(&path, format!("\x7fELF, some code{BUILD}more code")).unwrap();
        path
    }

    /// Why the library at `path` is refused.
    fn refusal(platform: Platform, path: &Path) -> String {
        let libraries = BTreeMap::from([(platform, path.to_owned())]);
        export(&structure(Parameters::EVISON), &[], &libraries).unwrap_err().to_string()
    }

    #[test]
    fn two_exports_of_the_same_are_the_same_bytes() {
        let folder = tempfile::tempdir().unwrap();
        let libraries = BTreeMap::from([(Platform::Linux64, library(folder.path()))]);
        let exported = |parameters| export(&structure(parameters), &[], &libraries).unwrap().1;
        let first = exported(Parameters::EVISON);
        assert_eq!(first, exported(Parameters::EVISON));
        assert_ne!(first, exported(Parameters::MCMANUS));
    }

    #[test]
    fn the_archive_holds_what_the_standard_and_the_library_look_for() {
        let libraries = vec![(Platform::Linux64, b"code".to_vec()), (Platform::Windows64, b"Windows code".to_vec())];
        let contents = Contents::from(Parameters::EVISON);
        let entries = entries(&structure(Parameters::EVISON), &contents, Vec::new(), libraries).unwrap();
        let paths: Vec<_> = entries.iter().map(|entry| entry.path.as_str()).collect();
        let expected = [
            "modelDescription.xml",
            "model.png",
            "documentation/index.html",
            "documentation/licenses/license.txt",
            "resources/parameters.toml",
            "binaries/linux64/FlexibleRocking.so",
            "binaries/win64/FlexibleRocking.dll",
        ];
        assert_eq!(paths, expected);
        assert_eq!(entries[1].content[..8], *b"\x89PNG\r\n\x1a\n");
        let parameters: Parameters = toml::from_slice(&entries[4].content).unwrap();
        assert_eq!(parameters, Parameters::EVISON);
        assert_eq!(entries[5].content, b"code");
        assert_eq!(entries[6].content, b"Windows code");
    }

    #[test]
    fn records_are_packed_as_they_are_and_the_first_is_the_default() {
        let folder = tempfile::tempdir().unwrap();
        let libraries = BTreeMap::from([(Platform::Linux64, library(folder.path()))]);
        let write = |name: &str, text: &str| {
            let path = folder.path().join(name);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(&path, text).unwrap();
            path
        };
        let [pulse, sine] = [write("pulse 1.csv", "0,1\r\n1,2\r\n"), write("sine.txt", "0,1\n1,-1\n")];
        let [same, broken] = [write("other/Sine.TXT", "0,2\n1,0\n"), write("broken.csv", "0,1\n1,?\n")];
        let export = |records: &[&PathBuf]| {
            let records: Vec<_> = records.iter().map(|path| path.to_path_buf()).collect();
            super::export(&structure(Parameters::EVISON), &records, &libraries)
        };
        let (contents, bytes) = export(&[&pulse, &sine]).unwrap();
        assert_eq!(contents.default_record(), "pulse 1.csv");
        let mut archive = zip::ZipArchive::new(io::Cursor::new(bytes)).unwrap();
        let mut read = |name: &str| io::read_to_string(archive.by_name(name).unwrap()).unwrap();
        assert_eq!(read("resources/pulse 1.csv"), "0,1\r\n1,2\r\n");
        assert_eq!(read("resources/sine.txt"), "0,1\n1,-1\n");
        assert!(read("modelDescription.xml").contains("<String start=\"pulse 1.csv\"/>"));
        let names: Records = toml::from_str(&read("resources/records.toml")).unwrap();
        assert_eq!(names.record, contents.records);
        let (swapped, _) = export(&[&sine, &pulse]).unwrap();
        assert_ne!(FlexibleRocking::guid(&swapped), FlexibleRocking::guid(&contents));

        let refusal = |records: &[&PathBuf]| export(records).unwrap_err().to_string();
        assert_eq!(
            refusal(&[&sine, &same]),
            "two records are called Sine.TXT: rename one of them; capitals and small letters are the same here"
        );
        let expected = format!("{}, line 2: the acceleration \"?\" is not a number", broken.display());
        assert_eq!(refusal(&[&sine, &broken]), expected);
    }

    #[test]
    fn a_missing_library_is_refused_with_what_to_do() {
        for (platform, remedy) in
            [(Platform::Linux64, "`cargo build --release` builds it"), (Platform::Windows64, "`make dist` builds it")]
        {
            assert_eq!(
                refusal(platform, Path::new("/nowhere/library")),
                format!("the shared library /nowhere/library does not exist: {remedy}")
            );
        }
    }

    #[test]
    fn a_library_for_another_platform_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let library = library(folder.path());
        assert_eq!(
            refusal(Platform::Windows64, &library),
            format!("{} is not a shared library for Windows: `make dist` builds it", library.display())
        );
    }

    #[test]
    fn a_library_of_another_build_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let library = library(folder.path());
        let other = fs::read_to_string(&library).unwrap().replace(BUILD, "{00000000-0000-5000-8000-000000000000}");
        fs::write(&library, other).unwrap();
        assert_eq!(
            refusal(Platform::Linux64, &library),
            format!(
                "the shared library {} is of another build: the name of this one, {BUILD}, does not occur in it; \
                 `cargo build --release` builds it",
                library.display()
            )
        );
    }
}
