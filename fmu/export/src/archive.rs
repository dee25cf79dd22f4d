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
