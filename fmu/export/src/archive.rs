//! Archives that depend on nothing but what is in them: the same entries give the same bytes.

use std::fs::Permissions;
use std::io::{self, Seek, Write};
use std::os::unix::fs::PermissionsExt;
use std::path::{Path, PathBuf};
use zip::result::ZipError;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, ZipWriter};

/// Why an archive could not be written.
#[derive(Debug, thiserror::Error)]
pub enum ArchiveError {
    /// No file can be made where the archive is to be.
    #[error("cannot create a file in {folder}: {error}", folder = .folder.display())]
    Folder {
        /// The folder.
        folder: PathBuf,
        /// Why.
        error: io::Error,
    },
    /// The archive cannot be completed.
    #[error("cannot write the archive: {0}")]
    Content(#[from] ZipError),
    /// The complete archive cannot get its name.
    #[error("cannot write {target}: {error}", target = .target.display())]
    Target {
        /// The archive.
        target: PathBuf,
        /// Why.
        error: io::Error,
    },
}

/// A file of an archive.
pub struct Entry {
    /// Its path in the archive.
    pub path: String,
    /// Its content.
    pub content: Vec<u8>,
}

/// Writes `entries`, in their order, as the archive `target`, and returns its size in bytes.
///
/// An archive that was there before is replaced once the new one is complete, and kept if it cannot be completed.
pub fn write(target: &Path, entries: &[Entry]) -> Result<u64, ArchiveError> {
    let folder = match target.parent() {
        Some(folder) if !folder.as_os_str().is_empty() => folder,
        _ => Path::new("."),
    };
    let readable = Permissions::from_mode(0o666); // less the umask, as for any new file
    let mut file = tempfile::Builder::new()
        .prefix(".rocking-fmu-")
        .permissions(readable)
        .tempfile_in(folder)
        .map_err(|error| ArchiveError::Folder { folder: folder.to_owned(), error })?;
    let size = compress(entries, file.as_file_mut())?;
    match file.persist(target) {
        Ok(_) => Ok(size),
        Err(failed) => Err(ArchiveError::Target { target: target.to_owned(), error: failed.error }),
    }
}

/// Writes `entries` with fixed times and permissions, and returns the number of bytes.
fn compress(entries: &[Entry], to: impl Write + Seek) -> Result<u64, ZipError> {
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .last_modified_time(DateTime::DEFAULT) // 1980-01-01, the first day that an archive can express
        .unix_permissions(0o644);
    let mut archive = ZipWriter::new(to);
    for entry in entries {
        archive.start_file(entry.path.as_str(), options)?;
        archive.write_all(&entry.content)?;
    }
    Ok(archive.finish()?.stream_position()?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;
    use std::io::Read;

    fn entries() -> [Entry; 2] {
        [
            Entry { path: "b/long.txt".into(), content: b"rock ".repeat(1000) },
            Entry { path: "a.txt".into(), content: b"and roll".to_vec() },
        ]
    }

    #[test]
    fn what_was_written_is_read_back_in_order_without_a_trace_of_when() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("one.zip");
        let size = write(&target, &entries()).unwrap();
        assert_eq!(size, fs::metadata(&target).unwrap().len());
        let mut archive = zip::ZipArchive::new(fs::File::open(&target).unwrap()).unwrap();
        assert_eq!(archive.file_names().collect::<Result<Vec<_>, _>>().unwrap(), ["b/long.txt", "a.txt"]);
        for (index, entry) in entries().iter().enumerate() {
            let mut file = archive.by_index(index).unwrap();
            assert_eq!(file.last_modified(), Some(DateTime::from_date_and_time(1980, 1, 1, 0, 0, 0).unwrap()));
            assert_eq!(file.unix_mode(), Some(0o100644));
            assert_eq!(file.compression(), CompressionMethod::Deflated);
            let mut content = Vec::new();
            file.read_to_end(&mut content).unwrap();
            assert_eq!(content, entry.content);
        }
    }

    #[test]
    fn a_failed_write_leaves_nothing_and_keeps_what_was_there() {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("one.zip");
        fs::write(&target, "before").unwrap();
        let twice = [entries(), entries()].into_iter().flatten().collect::<Vec<_>>();
        assert!(write(&target, &twice).unwrap_err().to_string().contains("Duplicate filename"));
        assert_eq!(fs::read(&target).unwrap(), b"before");
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);

        let nowhere = folder.path().join("nowhere");
        let message = write(&nowhere.join("one.zip"), &entries()).unwrap_err().to_string();
        assert!(
            message.starts_with(&format!("cannot create a file in {}: No such file", nowhere.display())),
            "{message}"
        );
    }
}
