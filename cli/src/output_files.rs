//! The files that a command writes: nothing of the user's is overwritten by mistake, and nothing is left half written.
//!
//! A file is held in memory until it is complete, then written beside its place and renamed, so that a command that fails
//! leaves what was there before. A link is followed. A file that the command reads, or writes already, is refused; a
//! device or a pipe is written through, never replaced.

use anyhow::{Context, anyhow, bail, ensure};
use same_file::is_same_file;
use std::{
    fs::{self, File},
    io::{self, Write, stdout},
    path::{Component, Path, PathBuf, Prefix, absolute, is_separator},
};
use tempfile::NamedTempFile;

/// All files of one command: those that it reads, and those that it writes.
#[derive(Default)]
pub struct OutputFiles {
    inputs: Vec<PathBuf>,
    outputs: Vec<(PathBuf, Place)>,
}

/// A file that is going to be written.
pub struct OutputFile {
    path: PathBuf,
    place: Place,
}

/// Where a path leads.
#[derive(Clone, PartialEq)]
enum Place {
    StandardOutput,
    /// A regular file, or one that is not there yet: the path without links.
    Regular(PathBuf),
    /// A device or a pipe.
    Through,
}

impl OutputFiles {
    /// Of a command that reads `inputs`; what is not there is left to whoever reads it.
    pub fn of_inputs<'a>(inputs: impl IntoIterator<Item = &'a Path>) -> OutputFiles {
        OutputFiles { inputs: inputs.into_iter().map(Path::to_owned).collect(), outputs: Vec::new() }
    }

    /// One more file that the command reads.
    pub fn add_input(&mut self, path: &Path) {
        self.inputs.push(path.into());
    }

    /// The file at `path`, or standard output for `-`; refused where a file cannot be made.
    pub fn create(&mut self, path: &Path) -> anyhow::Result<OutputFile> {
        let place = self.reserve(path)?;
        if let Place::Regular(target) = &place {
            beside(target).with_context(|| cannot_be_written(path))?;
        }
        Ok(OutputFile { path: path.into(), place })
    }

    /// Refuses `path` where it is a file that the command reads or writes already, or none that can be written. A file
    /// that grows row by row is not created here, and reserved alone.
    pub fn reserve_rows(&mut self, path: &Path) -> anyhow::Result<()> {
        let place = self.reserve(path)?;
        ensure!(matches!(place, Place::Regular(_)), "{}: rows need a file, which is read again", path.display());
        Ok(())
    }

    /// Keeps standard output for what `by` prints there.
    pub fn reserve_standard_output(&mut self, by: &str) {
        self.outputs.push((by.into(), Place::StandardOutput));
    }

    fn reserve(&mut self, path: &Path) -> anyhow::Result<Place> {
        let place = place(path).with_context(|| cannot_be_written(path))?;
        if let Place::Regular(target) = &place {
            // Two files are compared by opening them, which is a message to whoever writes to a pipe.
            let is_target = |input: &&PathBuf| input.is_file() && is_same_file(input, target).is_ok_and(|same| same);
            if let Some(input) = self.inputs.iter().find(is_target) {
                let (path, input) = (path.display(), input.display());
                bail!("{path}: this would overwrite the input {input}; name another file");
            }
        }
        if let Some((other, _)) = self.outputs.iter().find(|(_, other)| *other == place && place != Place::Through) {
            let (path, other) = (name(path), name(other));
            let other = if other == path { "something else".into() } else { other };
            bail!("{path}: {other} is written there as well; name another file");
        }
        self.outputs.push((path.into(), place.clone()));
        Ok(place)
    }
}

impl OutputFile {
    /// Standard output.
    pub fn standard_output() -> OutputFile {
        OutputFile { path: "-".into(), place: Place::StandardOutput }
    }

    /// Its path.
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Writes all of it.
    pub fn write(self, content: &[u8]) -> anyhow::Result<()> {
        let written = match &self.place {
            Place::StandardOutput => stdout().write_all(content).and_then(|()| stdout().flush()),
            Place::Regular(target) => replace(target, content),
            // What follows what another program has written there, or will write.
            Place::Through => {
                File::options().append(true).open(&self.path).and_then(|mut file| file.write_all(content))
            }
        };
        written.with_context(|| cannot_be_written(&self.path))
    }
}

fn name(path: &Path) -> String {
    if path == Path::new("-") { "standard output".into() } else { path.display().to_string() }
}

fn cannot_be_written(path: &Path) -> String {
    format!("{} cannot be written", name(path))
}

/// Where `path` leads, with what is there asked before anything is opened.
fn place(path: &Path) -> anyhow::Result<Place> {
    const FOLDER: &str = "it is a folder; name a file in it";
    if path == Path::new("-") {
        return Ok(Place::StandardOutput);
    }
    let last = path.as_os_str().as_encoded_bytes().last().copied().map(char::from);
    ensure!(!last.is_some_and(is_separator) && !path.is_dir(), FOLDER);
    match fs::metadata(path) {
        _ if is_named_device(path) => return Ok(Place::Through),
        Ok(there) if there.is_file() => return Ok(Place::Regular(path.canonicalize()?)),
        Ok(_) => return Ok(Place::Through),
        Err(error) if error.kind() == io::ErrorKind::NotFound => {}
        Err(error) => return Err(error.into()),
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let real = folder.canonicalize().map_err(|error| match error.kind() {
        io::ErrorKind::NotFound => anyhow!("there is no folder {}", folder.display()),
        _ => error.into(),
    })?;
    Ok(Place::Regular(real.join(path.file_name().context(FOLDER)?)))
}

/// Whether Windows takes `path` for a device or a pipe, as NUL in whatever folder. Elsewhere none has such a name.
fn is_named_device(path: &Path) -> bool {
    let Ok(path) = absolute(path) else { return false };
    let is_device = |first| matches!(first, Component::Prefix(prefix) if matches!(prefix.kind(), Prefix::DeviceNS(_)));
    path.components().next().is_some_and(is_device)
}

/// A file in the folder of `target` with the permissions of the one that is there, or of any new one.
fn beside(target: &Path) -> io::Result<NamedTempFile> {
    let mut builder = tempfile::Builder::new();
    #[cfg(unix)] // on Windows the folder decides, whatever the file is made for
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let file = builder.prefix(".rocking-fmu-").tempfile_in(target.parent().unwrap_or(Path::new("/")))?;
    match File::options().write(true).open(target) {
        Ok(there) => file.as_file().set_permissions(there.metadata()?.permissions())?,
        Err(error) if error.kind() == io::ErrorKind::NotFound => {}
        Err(error) => return Err(error),
    }
    Ok(file)
}

fn replace(target: &Path, content: &[u8]) -> io::Result<()> {
    let mut file = beside(target)?;
    file.write_all(content)?;
    file.persist(target)?;
    Ok(())
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::os::unix::fs::PermissionsExt;

    #[test]
    fn what_was_there_stays_until_the_file_is_complete() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out.csv");
        fs::write(&path, "before").unwrap();
        fs::set_permissions(&path, PermissionsExt::from_mode(0o640)).unwrap();
        let file = OutputFiles::default().create(&path).unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"before");
        file.write(b"after").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"after");
        assert_eq!(fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o640);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    }
}
