//! The files that a command writes: nothing of the user's is overwritten by mistake, and nothing is left half written.
//!
//! A file is written beside its place and gets its name when it is complete, so that a command that fails leaves what
//! was there before. A link is followed. A file that the command reads, or writes already, is refused; a device or a pipe
//! is written through, never replaced.

use anyhow::{Context, anyhow, bail, ensure};
use same_file::is_same_file;
#[cfg(unix)]
use std::os::unix::fs::{FileTypeExt, MetadataExt, PermissionsExt, chown};
use std::{
    fs::{self, File, Metadata},
    io::{self, BufWriter, StdoutLock, Write, stdout},
    path::{Component, Path, PathBuf, Prefix, absolute, is_separator},
    sync::{Mutex, PoisonError},
};
use tempfile::NamedTempFile;

/// Links that are followed one after the other, as in Linux itself.
const LONGEST_CHAIN_OF_LINKS: usize = 40;

/// Folders of what programs have opened, under names that a shell gives to commands: Linux's, macOS's.
const FOLDERS_OF_OPEN_FILES: [&str; 2] = ["/proc", "/dev/fd"];

/// Files that have been begun, under the names that they have until they are complete.
static BEGUN: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

/// All files of one command: those that it reads, and those that it writes.
#[derive(Default)]
pub struct OutputFiles {
    inputs: Vec<PathBuf>,
    outputs: Vec<(PathBuf, Place)>,
}

/// A file that is being written; one that is not finished leaves no trace.
pub struct OutputFile {
    path: PathBuf,
    to: To,
}

/// Where a path leads.
#[derive(Clone, PartialEq)]
enum Place {
    StandardOutput,
    /// A regular file, or one that is not there yet: the path without links.
    Regular(PathBuf),
    /// A device, a pipe, or what another program has opened.
    Through,
}

enum To {
    StandardOutput(BufWriter<StdoutLock<'static>>),
    Beside { file: BufWriter<NamedTempFile>, target: PathBuf },
    Through(BufWriter<File>),
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

    /// Begins the file at `path`, or standard output for `-`.
    pub fn create(&mut self, path: &Path) -> anyhow::Result<OutputFile> {
        let to = match self.reserve(path)? {
            Place::StandardOutput => Ok(To::StandardOutput(BufWriter::new(stdout().lock()))),
            Place::Regular(target) => beside(&target).map(|file| To::Beside { file: BufWriter::new(file), target }),
            // What follows what another program has written there, or will write.
            Place::Through => File::options().append(true).open(path).map(BufWriter::new).map(To::Through),
        };
        Ok(OutputFile { path: path.into(), to: to.with_context(|| cannot_be_written(path))? })
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
                bail!("{path}: it would overwrite {input}, which is read; name another file");
            }
        }
        if let Some((other, _)) = self.outputs.iter().find(|(_, other)| *other == place && place != Place::Through) {
            let (path, other) = (name(path), name(other));
            let other = if other == path { "something else".into() } else { other };
            bail!("{path}: {other} is written there, too; name another file");
        }
        self.outputs.push((path.into(), place.clone()));
        Ok(place)
    }
}

impl Write for OutputFile {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.writer().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.writer().flush()
    }
}

impl OutputFile {
    fn writer(&mut self) -> &mut dyn Write {
        match &mut self.to {
            To::StandardOutput(out) => out,
            To::Beside { file, .. } => file,
            To::Through(file) => file,
        }
    }

    /// Says of an error in writing which file it was.
    pub fn named<T>(path: &Path, written: io::Result<T>) -> anyhow::Result<T> {
        written.with_context(|| cannot_be_written(path))
    }

    /// Writes out what is held back, and gives the file its name.
    pub fn finish(mut self) -> anyhow::Result<()> {
        let flushed = self.flush();
        let path = self.path;
        OutputFile::named(&path, flushed)?;
        if let To::Beside { file, target } = self.to {
            let file = file.into_inner().map_err(io::IntoInnerError::into_error);
            let finished = file.and_then(|file| file.persist(target).map_err(|failed| failed.error));
            OutputFile::named(&path, finished)?;
        }
        Ok(())
    }
}

/// Removes what is not complete, for a command that ends here and now: while it holds what is returned, nothing is begun.
pub fn remove_unfinished() -> impl Drop {
    let begun = BEGUN.lock().unwrap_or_else(PoisonError::into_inner);
    for path in begun.iter() {
        // one that is complete has another name
        let _ = fs::remove_file(path);
    }
    begun
}

fn name(path: &Path) -> String {
    if path == Path::new("-") { "standard output".into() } else { path.display().to_string() }
}

fn cannot_be_written(path: &Path) -> String {
    format!("{} cannot be written", name(path))
}

/// Where `path` leads, with what is there asked before anything is opened.
fn place(path: &Path) -> anyhow::Result<Place> {
    if path == Path::new("-") {
        return Ok(Place::StandardOutput);
    }
    ensure!(!path.as_os_str().is_empty(), "its name is empty");
    let last = path.as_os_str().as_encoded_bytes().last().copied().map(char::from);
    ensure!(!last.is_some_and(is_separator), "it is a folder; name a file in it");
    if is_named_device(path) {
        return Ok(Place::Through);
    }
    match fs::metadata(path) {
        Ok(told) if told.is_dir() => bail!("it is a folder; name a file in it"),
        #[cfg(unix)]
        Ok(told) if told.file_type().is_block_device() => bail!("it is a block device"),
        Ok(told) if !told.is_file() => return Ok(Place::Through),
        Ok(_) => {}
        Err(error) if error.kind() == io::ErrorKind::NotFound => {}
        Err(error) => return Err(error.into()),
    }
    let mut path = path.to_owned();
    for _ in 0..=LONGEST_CHAIN_OF_LINKS {
        let name = path.file_name().context("it is a folder; name a file in it")?;
        let folder = match path.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        let real = dunce::canonicalize(folder).map_err(|error| match error.kind() {
            io::ErrorKind::NotFound => anyhow!("there is no folder {}", folder.display()),
            _ => error.into(),
        })?;
        if FOLDERS_OF_OPEN_FILES.iter().any(|folder| real.starts_with(folder)) {
            return Ok(Place::Through);
        }
        let target = real.join(name);
        match fs::read_link(&target) {
            Ok(link) => path = real.join(link),
            Err(_) => return Ok(Place::Regular(target)),
        }
    }
    bail!("its links have no end")
}

/// Whether Windows takes `path` for a device or a pipe, as NUL in whatever folder. Elsewhere none has such a name.
fn is_named_device(path: &Path) -> bool {
    let Ok(path) = absolute(path) else { return false };
    let is_device = |first| matches!(first, Component::Prefix(prefix) if matches!(prefix.kind(), Prefix::DeviceNS(_)));
    path.components().next().is_some_and(is_device)
}

/// A file in the folder of `target` with the owner and the permissions of the one that is there, or of any new one.
fn beside(target: &Path) -> io::Result<NamedTempFile> {
    let there = match File::options().write(true).open(target) {
        Ok(file) => Some(file.metadata()?),
        Err(error) if error.kind() == io::ErrorKind::NotFound => None,
        Err(error) => return Err(error),
    };
    let folder = target.parent().unwrap_or(Path::new("/"));
    let mut begun = BEGUN.lock().unwrap_or_else(PoisonError::into_inner);
    let file = as_any_new_file(tempfile::Builder::new().prefix(".rocking-fmu-")).tempfile_in(folder);
    let file = file.map_err(|error| io::Error::new(error.kind(), in_folder(folder, &error)))?;
    begun.push(file.path().into());
    if let Some(there) = there {
        take_over(&file, &there)?;
    }
    Ok(file)
}

/// Readable for all, less the umask.
#[cfg(unix)]
fn as_any_new_file<'a, 'b, 'c>(builder: &'a mut tempfile::Builder<'b, 'c>) -> &'a mut tempfile::Builder<'b, 'c> {
    builder.permissions(fs::Permissions::from_mode(0o666))
}

/// On Windows the folder decides, whatever the file is made for.
#[cfg(windows)]
fn as_any_new_file<'a, 'b, 'c>(builder: &'a mut tempfile::Builder<'b, 'c>) -> &'a mut tempfile::Builder<'b, 'c> {
    builder
}

/// Gives `file` the owner and the permissions of the one that is `there`.
#[cfg(unix)]
fn take_over(file: &NamedTempFile, there: &Metadata) -> io::Result<()> {
    let own = file.as_file().metadata()?;
    if (own.uid(), own.gid()) != (there.uid(), there.gid()) {
        // Who may write to a file may not always give it away; the file is then the writer's.
        let _ = chown(file.path(), Some(there.uid()), Some(there.gid()));
    }
    file.as_file().set_permissions(there.permissions())
}

/// On Windows the folder has given it both; what is read-only cannot be replaced.
#[cfg(windows)]
fn take_over(_: &NamedTempFile, _: &Metadata) -> io::Result<()> {
    Ok(())
}

fn in_folder(folder: &Path, error: &io::Error) -> String {
    let reason = error.raw_os_error().map(io::Error::from_raw_os_error);
    let reason = reason.map_or(error.to_string(), |reason| reason.to_string());
    format!("no file can be made in {}: {reason}", folder.display())
}

#[cfg(all(test, unix))]
mod tests {
    use super::*;
    use std::fs::Permissions;
    use std::os::unix::fs::symlink;

    fn write(files: &mut OutputFiles, path: &Path, text: &str) -> anyhow::Result<()> {
        let mut file = files.create(path)?;
        file.write_all(text.as_bytes())?;
        file.finish()
    }

    fn names(folder: &Path) -> Vec<String> {
        let names = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<_> = names.collect();
        names.sort();
        names
    }

    #[test]
    fn what_was_there_stays_until_the_file_is_complete() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out.csv");
        fs::write(&path, "before").unwrap();
        fs::set_permissions(&path, Permissions::from_mode(0o640)).unwrap();
        let mut unfinished = OutputFiles::default().create(&path).unwrap();
        unfinished.write_all(b"half").unwrap();
        unfinished.flush().unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"before");
        drop(unfinished);
        assert_eq!(names(folder.path()), ["out.csv"]);
        write(&mut OutputFiles::default(), &path, "after").unwrap();
        assert_eq!(fs::read(&path).unwrap(), b"after");
        assert_eq!(fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o640);
        assert_eq!(names(folder.path()), ["out.csv"]);
    }

    #[test]
    fn links_are_followed_and_kept() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::create_dir(at("far")).unwrap();
        symlink("far/target.csv", at("second.csv")).unwrap();
        symlink(at("second.csv"), at("first.csv")).unwrap();
        for text in ["to a file that is not there", "to one that is"] {
            write(&mut OutputFiles::default(), &at("first.csv"), text).unwrap();
            assert_eq!(fs::read_to_string(at("far/target.csv")).unwrap(), text);
        }
        assert!(fs::symlink_metadata(at("first.csv")).unwrap().is_symlink());
        assert!(fs::symlink_metadata(at("second.csv")).unwrap().is_symlink());
        symlink("round.csv", at("round.csv")).unwrap();
        assert!(OutputFiles::default().create(&at("round.csv")).is_err());
    }

    #[test]
    fn a_file_that_is_read_or_written_already_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        fs::write(at("record.csv"), "0,1\n1,2\n").unwrap();
        fs::hard_link(at("record.csv"), at("same.csv")).unwrap();
        symlink("record.csv", at("link.csv")).unwrap();
        let record = at("record.csv");
        let mut files = OutputFiles::of_inputs([record.as_path(), &at("absent")]);
        for name in ["record.csv", "same.csv", "link.csv", "./record.csv"] {
            let expected = format!("it would overwrite {}, which is read; name another file", record.display());
            let message = files.create(&at(name)).err().unwrap().to_string();
            assert!(message.ends_with(&expected), "{message}");
        }
        symlink("out.csv", at("out link.csv")).unwrap();
        let _out = files.create(&at("out.csv")).unwrap();
        for name in ["out.csv", "out link.csv"] {
            let message = files.create(&at(name)).err().unwrap().to_string();
            assert!(message.ends_with("is written there, too; name another file"), "{message}");
            assert!(files.reserve_rows(&at(name)).is_err());
        }
        files.reserve_rows(&at("rows.csv")).unwrap();
        assert!(files.create(&at("rows.csv")).is_err());
    }

    #[test]
    fn what_is_no_regular_file_is_written_through_or_refused() {
        let folder = tempfile::tempdir().unwrap();
        let link = folder.path().join("null");
        symlink("/dev/null", &link).unwrap();
        let mut files = OutputFiles::default();
        for path in [&link, Path::new("/dev/null"), &link] {
            write(&mut files, path, "gone").unwrap();
        }
        assert!(fs::metadata(&link).unwrap().file_type().is_char_device());
        let refusal = |path: &Path| format!("{:#}", OutputFiles::default().create(path).err().unwrap());
        let at = folder.path().display();
        assert_eq!(refusal(folder.path()), format!("{at} cannot be written: it is a folder; name a file in it"));
        assert_eq!(
            refusal(&folder.path().join("no/out.csv")),
            format!("{at}/no/out.csv cannot be written: there is no folder {at}/no")
        );
        let full = write(&mut OutputFiles::default(), Path::new("/dev/full"), "text").unwrap_err();
        assert_eq!(format!("{full:#}"), "/dev/full cannot be written: No space left on device (os error 28)");
    }
}
