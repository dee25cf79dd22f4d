//! Shared libraries, and the platforms that an archive can have one for.

use crate::Version;
use FlexibleRocking::BUILD;
use memchr::memmem;
use object::read::macho::{FatArch, MachOFatFile32};
use object::{Architecture, BinaryFormat, FileKind, Object, ObjectKind};
use std::fs;
use std::io::{self, Cursor, Read};
use std::path::{Path, PathBuf};
use zip::ZipArchive;
use zip::result::ZipError;

/// Most bytes that are read of all libraries of an archive together. One has a few million.
const MOST: u64 = if cfg!(test) { 1 << 12 } else { 1 << 28 };

/// A platform for which an archive can have a shared library.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Platform {
    Linux64,
    LinuxArm64,
    Windows64,
    /// macOS on x86-64, or on both in one file.
    Darwin64,
    DarwinArm64,
}

impl Platform {
    pub const ALL: [Platform; 5] =
        [Platform::Linux64, Platform::LinuxArm64, Platform::Windows64, Platform::Darwin64, Platform::DarwinArm64];

    /// The tuple of the platform, its target, and the file that cargo builds for it.
    fn names(self) -> [&'static str; 3] {
        match self {
            Platform::Linux64 => ["x86_64-linux", "x86_64-unknown-linux-gnu", "libFlexibleRocking.so"],
            Platform::LinuxArm64 => ["aarch64-linux", "aarch64-unknown-linux-gnu", "libFlexibleRocking.so"],
            Platform::Windows64 => ["x86_64-windows", "x86_64-pc-windows-gnu", "FlexibleRocking.dll"],
            Platform::Darwin64 => ["x86_64-darwin", "universal2-apple-darwin", "libFlexibleRocking.dylib"],
            Platform::DarwinArm64 => ["aarch64-darwin", "aarch64-apple-darwin", "libFlexibleRocking.dylib"],
        }
    }

    /// The standard's tuple of architecture and system. The library for `x86_64-darwin` runs on both architectures.
    pub fn tuple(self) -> &'static str {
        self.names()[0]
    }

    /// The folder of the library in an archive of `version`. Hosts that know no tuples look for `darwin64` on every Mac: the
    /// library there runs on both architectures.
    pub fn folder(self, version: Version) -> &'static str {
        ::model_description::archive::folder(version, self.tuple())
    }

    /// The target by the name that cargo, or cargo-zigbuild, has for it.
    pub fn target(self) -> &'static str {
        self.names()[1]
    }

    pub fn file(self) -> &'static str {
        self.names()[2]
    }

    pub(crate) fn path(self, version: Version, name: &str) -> String {
        let (_, extension) = self.file().rsplit_once('.').expect("they have one");
        format!("binaries/{}/{name}.{extension}", self.folder(version))
    }

    /// The platform that `library` is for, by its header.
    fn of(library: &[u8]) -> Option<Platform> {
        if FileKind::parse(library) == Ok(FileKind::MachOFat32) {
            let both = MachOFatFile32::parse(library).ok()?;
            let has = |wanted| both.arches().iter().any(|arch| arch.architecture() == wanted);
            return (has(Architecture::X86_64) && has(Architecture::Aarch64)).then_some(Platform::Darwin64);
        }
        let file = object::File::parse(library).ok()?;
        let is_program =
            file.kind() == ObjectKind::Executable || file.format() == BinaryFormat::Elf && file.entry() != 0;
        match (file.format(), file.architecture()) {
            _ if is_program => None,
            (BinaryFormat::Elf, Architecture::X86_64) => Some(Platform::Linux64),
            (BinaryFormat::Elf, Architecture::Aarch64) => Some(Platform::LinuxArm64),
            (BinaryFormat::Pe, Architecture::X86_64) => Some(Platform::Windows64),
            (BinaryFormat::MachO, Architecture::X86_64) => Some(Platform::Darwin64),
            (BinaryFormat::MachO, Architecture::Aarch64) => Some(Platform::DarwinArm64),
            _ => None,
        }
    }
}

#[derive(Debug)]
pub struct Library {
    pub platform: Platform,
    pub(crate) content: Vec<u8>,
}

#[derive(Debug, thiserror::Error)]
pub enum LibraryError {
    #[error("cannot read the shared library {path}: {1}", path = .0.display())]
    Unreadable(PathBuf, io::Error),
    #[error("cannot read the libraries in {path}: {1}", path = .0.display())]
    Archive(PathBuf, ZipError),
    /// An archive without a library where an FMU has it, and a file that it holds instead.
    #[error("{path} has no shared library in a folder such as binaries/x86_64-linux; it holds {1}: give an FMU as this build exported it", path = .0.display())]
    NoneInside(PathBuf, String),
    #[error("{} is neither an FMU nor a shared library for one of {}", .0.display(), Platform::ALL.map(Platform::tuple).join(", "))]
    NoLibrary(PathBuf),
    /// A library from other sources than this exporter, so that its variables may be others.
    #[error("the shared library {} is of another build: the name of this one, {BUILD}, does not occur in it", .0.display())]
    OtherBuild(PathBuf),
}

impl Library {
    /// The shared library at `path`, or those of the FMU there.
    pub fn read(path: &Path) -> Result<Vec<Library>, LibraryError> {
        let content = fs::read(path).map_err(|error| LibraryError::Unreadable(path.to_owned(), error))?;
        Library::from_bytes(path, content)
    }

    /// The shared library in `content`, the content of the file at `path`, or the libraries of an FMU.
    pub fn from_bytes(path: &Path, content: Vec<u8>) -> Result<Vec<Library>, LibraryError> {
        if !content.starts_with(b"PK") {
            return Ok(vec![Library::new(path, content)?]);
        }
        let broken = |error| LibraryError::Archive(path.to_owned(), error);
        let mut archive = ZipArchive::new(Cursor::new(content)).map_err(broken)?;
        let (mut libraries, mut other, mut left) = (Vec::new(), None, MOST);
        for at in 0..archive.len() {
            let file = archive.by_index(at).map_err(broken)?;
            let name = file.name().map_err(broken)?.into_owned();
            if !(file.is_file() && name.starts_with("binaries/")) {
                other = other.filter(|other: &String| other.to_lowercase().contains("binaries")).or(Some(name));
                continue;
            }
            let (path, mut library) = (path.join(name), Vec::new());
            let read = file.take(left + 1).read_to_end(&mut library).map(|read| left.checked_sub(read as u64));
            let fits = read.and_then(|left| left.ok_or_else(|| io::Error::other(format!("more than {MOST} bytes"))));
            left = fits.map_err(|error| LibraryError::Unreadable(path.clone(), error))?;
            libraries.push(Library::new(&path, library)?);
        }
        if libraries.is_empty() {
            return Err(LibraryError::NoneInside(path.to_owned(), other.unwrap_or_else(|| "nothing".into())));
        }
        Ok(libraries)
    }

    /// The library with this `content`, of this build; it comes from `path`.
    fn new(path: &Path, content: Vec<u8>) -> Result<Library, LibraryError> {
        let platform = Platform::of(&content).ok_or_else(|| LibraryError::NoLibrary(path.to_owned()))?;
        if memmem::find(&content, BUILD.as_bytes()).is_none() {
            return Err(LibraryError::OtherBuild(path.to_owned()));
        }
        Ok(Library { platform, content })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use ::model_description::archive::{Entry, archive};

    /// The header alone of a shared library of 64 bits, little-endian.
    fn elf(machine: u8) -> Vec<u8> {
        let (start, shared) = (b"\x7fELF\x02\x01\x01".as_slice(), [3, 0, machine, 0, 1]);
        [start, &[0; 9], &shared, &[0; 31], &[64], &[0; 11]].concat()
    }

    fn macho(cpu: u8) -> Vec<u8> {
        let (start, dylib) = ([0xcf, 0xfa, 0xed, 0xfe, cpu, 0, 0, 1], [0, 0, 0, 0, 6]);
        [start.as_slice(), &dylib, &[0; 19]].concat()
    }

    /// Both architectures behind one header, which is big-endian.
    fn universal(cpus: &[u8]) -> Vec<u8> {
        let mut header = vec![0xca, 0xfe, 0xba, 0xbe, 0, 0, 0, cpus.len() as u8];
        for cpu in cpus {
            header.extend([1, 0, 0, *cpu, 0, 0, 0, 3, 0, 0, 1, 0, 0, 0, 0, 32, 0, 0, 0, 3]);
        }
        header
    }

    #[test]
    fn a_header_tells_the_platform() {
        let [x86, arm] = [(62, 7), (183, 12)];
        assert_eq!(Platform::of(&elf(x86.0)), Some(Platform::Linux64));
        assert_eq!(Platform::of(&elf(arm.0)), Some(Platform::LinuxArm64));
        assert_eq!(Platform::of(&macho(x86.1)), Some(Platform::Darwin64));
        assert_eq!(Platform::of(&macho(arm.1)), Some(Platform::DarwinArm64));
        assert_eq!(Platform::of(&universal(&[x86.1, arm.1])), Some(Platform::Darwin64));
        assert_eq!(Platform::of(&universal(&[arm.1])), None);
        assert_eq!(Platform::of(&elf(243)), None, "RISC-V");
        assert_eq!(Platform::of(b"PK, MZ"), None);
        assert_eq!(Platform::of(b""), None);
    }

    #[test]
    fn an_archive_has_as_many_libraries_as_fit_where_an_fmu_has_them() {
        let found = |path: &str, more: usize| {
            let content = [&elf(62), BUILD.as_bytes(), &vec![0; more]].concat();
            let entries = ["model.xml", path].map(|path| Entry { path: path.into(), content: content.clone() });
            Library::from_bytes(Path::new("a.fmu"), archive(&entries).unwrap())
        };
        assert_eq!(found("binaries/linux64/A.so", 0).unwrap()[0].platform, Platform::Linux64);
        assert!(matches!(found("binaries/linux64/A.so", 1 << 12), Err(LibraryError::Unreadable(..))));
        for path in ["A/binaries/A.so", "./binaries/A.so", "binaries\\A.so", "Binaries/A.so", ""] {
            let why = found(path, 0).unwrap_err().to_string();
            assert!(why.starts_with("a.fmu has no shared library") && why.contains(path), "{why}");
        }
    }
}
