//! Archives that depend on nothing but what is in them: the same entries give the same bytes.

use std::io::{Cursor, Write};
use zip::result::ZipError;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, DateTime, System, ZipWriter};

/// A file of an archive.
pub struct Entry {
    /// Its path in the archive.
    pub path: String,
    /// Its content.
    pub content: Vec<u8>,
}

/// The archive of `entries`, in their order, with fixed times and permissions.
pub fn archive(entries: &[Entry]) -> Result<Vec<u8>, ZipError> {
    let options = SimpleFileOptions::default()
        .compression_method(CompressionMethod::Deflated)
        .last_modified_time(DateTime::DEFAULT) // 1980-01-01, the first day that an archive can express
        .system(System::Unix) // whatever it is written on
        .unix_permissions(0o644);
    let mut archive = ZipWriter::new(Cursor::new(Vec::new()));
    for entry in entries {
        archive.start_file(entry.path.as_str(), options)?;
        archive.write_all(&entry.content)?;
    }
    Ok(archive.finish()?.into_inner())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Read;

    fn entries() -> [Entry; 2] {
        [
            Entry { path: "b/long.txt".into(), content: b"rock ".repeat(1000) },
            Entry { path: "a.txt".into(), content: b"and roll".to_vec() },
        ]
    }

    #[test]
    fn what_was_written_is_read_back_in_order_without_a_trace_of_when() {
        let mut archive = zip::ZipArchive::new(Cursor::new(archive(&entries()).unwrap())).unwrap();
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
    fn two_files_of_one_name_are_refused() {
        let twice = [entries(), entries()].into_iter().flatten().collect::<Vec<_>>();
        assert!(archive(&twice).unwrap_err().to_string().contains("Duplicate filename"));
    }
}
