//! The input of a command: a file, or standard input under the name `-`.

use anyhow::{Context, ensure};
use rocking_records::MAX_FILE;
use std::fs::{self, File};
use std::io::{Read, stdin};
use std::path::Path;
use std::sync::atomic::{AtomicBool, Ordering};

/// Name of standard input in messages.
pub const NAME: &str = "standard input";

static IS_READ: AtomicBool = AtomicBool::new(false);

pub fn is_standard(path: &Path) -> bool {
    path == Path::new("-")
}

/// Whether `path` can be read once only: standard input, or a pipe that is open already, which bash makes of `<(command)`.
pub fn is_stream(path: &Path) -> bool {
    let is_open = path == Path::new("/dev/stdin") || path.starts_with("/dev/fd") || path.starts_with("/proc");
    is_standard(path) || is_open && fs::metadata(path).is_ok_and(|told| !told.is_file() && !told.is_dir())
}

/// Name of the file at `path` in messages.
pub fn name(path: &Path) -> String {
    if is_standard(path) { NAME.into() } else { path.display().to_string() }
}

/// Stem of the name of a file that is made from the file at `path`.
pub fn stem(path: &Path) -> String {
    if is_standard(path) {
        "record".into()
    } else {
        path.file_stem().unwrap_or_default().to_string_lossy().into_owned()
    }
}

/// Reads the file at `path`. A stream can be read once, and its size is limited.
pub fn read(path: &Path) -> anyhow::Result<Vec<u8>> {
    if !is_stream(path) {
        return Ok(fs::read(path)?);
    }
    let (mut bytes, most) = (Vec::new(), MAX_FILE + 1);
    let read = if is_standard(path) {
        ensure!(!IS_READ.swap(true, Ordering::Relaxed), "{NAME} is read already: only one file can be `-`");
        stdin().lock().take(most).read_to_end(&mut bytes)
    } else {
        File::open(path).and_then(|file| file.take(most).read_to_end(&mut bytes))
    };
    read.with_context(|| name(path))?;
    ensure!(bytes.len() as u64 <= MAX_FILE, "{} has more than {MAX_FILE} bytes, more than any record", name(path));
    Ok(bytes)
}

pub fn text(path: &Path) -> anyhow::Result<String> {
    String::from_utf8(read(path)?).context("it is not text in UTF-8")
}
