//! The files that a command writes. A command cannot overwrite its inputs, replace a file of parameters, or write one file twice.

use crate::input;
use anyhow::{Context, bail, ensure};
use std::{
    fs::{self, File},
    io::{self, Write, stdout},
    path::{Path, PathBuf},
};

/// All files of one command: those that it reads, and those that it writes.
#[derive(Default)]
pub struct OutputFiles {
    inputs: Vec<PathBuf>,
    outputs: Vec<PathBuf>,
}

/// A file that a command writes when its content is complete.
pub struct OutputFile {
    path: PathBuf,
    /// Canonical path of the file.
    target: PathBuf,
}

/// Ending of files that commands read and do not write.
const READ: &str = "toml";

impl OutputFiles {
    pub fn of_inputs<'a>(inputs: impl IntoIterator<Item = &'a Path>) -> OutputFiles {
        OutputFiles { inputs: inputs.into_iter().map(Path::to_owned).collect(), outputs: Vec::new() }
    }

    pub fn add_input(&mut self, path: &Path) {
        self.inputs.push(path.into());
    }

    /// The file at `path`, or standard output for `-`. The path cannot be an input, another output, an existing file of [`READ`], a
    /// folder, or a file in a folder that does not exist.
    pub fn create(&mut self, path: &Path) -> anyhow::Result<OutputFile> {
        let (shown, target) = (path.display(), place(path)?);
        let is_target = |input: &&PathBuf| input.canonicalize().is_ok_and(|input| input == target);
        if let Some(input) = self.inputs.iter().find(is_target) {
            bail!("{shown}: this would overwrite the input {}; name another file", input.display());
        }
        ensure!(!self.outputs.contains(&target), "{shown}: something else is written there as well; name another file");
        let is_read = target.extension().is_some_and(|ending| ending.eq_ignore_ascii_case(READ));
        if is_read && target.exists() {
            bail!("{shown}: this would replace a file of parameters; name another file");
        }
        self.outputs.push(target.clone());
        Ok(OutputFile { path: path.into(), target })
    }
}

/// Canonical path of the file at `path`, which need not exist.
fn place(path: &Path) -> anyhow::Result<PathBuf> {
    if input::is_standard(path) {
        return Ok(path.into());
    }
    let (shown, folder) = (path.display(), folder_of(path));
    ensure!(!path.is_dir(), "{shown}: this is a folder; name a file");
    ensure!(folder.is_dir(), "{shown}: there is no folder {}; make it first", folder.display());
    let anew = || folder.canonicalize().map(|folder| folder.join(path.file_name().unwrap_or_default()));
    path.canonicalize().or_else(|_| anew()).with_context(|| shown.to_string())
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

impl OutputFile {
    pub fn standard_output() -> OutputFile {
        OutputFile { path: "-".into(), target: "-".into() }
    }

    /// The path, as the user gave it.
    pub fn path(&self) -> &Path {
        &self.path
    }

    pub fn write(self, content: &[u8]) -> anyhow::Result<()> {
        if input::is_standard(&self.path) {
            let written = stdout().write_all(content).and_then(|()| stdout().flush());
            return written.context("standard output cannot be written");
        }
        let written = match fs::metadata(&self.path) {
            Ok(there) if !there.is_file() => fs::write(&self.path, content), // a device or a pipe
            _ => replace(&self.target, content),
        };
        written.with_context(|| format!("{} cannot be written", self.path.display()))
    }
}

/// Writes a new file beside `target`, which then replaces `target` and keeps its permissions. A full disk loses nothing.
fn replace(target: &Path, content: &[u8]) -> io::Result<()> {
    // `make_in` and `as_file_mut` leave the name of the new file out of errors
    let create = |path: &Path| File::options().write(true).create_new(true).open(path);
    let mut file = tempfile::Builder::new().prefix(".rocking-fmu-").make_in(folder_of(target), create)?;
    match File::options().write(true).open(target) {
        Ok(there) => file.as_file().set_permissions(there.metadata()?.permissions())?,
        Err(error) if error.kind() == io::ErrorKind::NotFound => {}
        Err(error) => return Err(error),
    }
    file.as_file_mut().write_all(content)?;
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
        let before = fs::hard_link(&path, folder.path().join("before")).map(|()| folder.path().join("before")).unwrap();
        OutputFiles::default().create(&path).unwrap().write(b"after").unwrap();
        assert_eq!((fs::read(&path).unwrap(), fs::read(before).unwrap()), (b"after".into(), b"before".into()));
        assert_eq!(fs::metadata(&path).unwrap().permissions().mode() & 0o777, 0o640);
        assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 2);
        if cfg!(target_os = "linux") {
            let refused = OutputFiles::default().create(Path::new("/proc/out.csv")).unwrap().write(b"").unwrap_err();
            let expected = "/proc/out.csv cannot be written: No such file or directory (os error 2)";
            assert_eq!(crate::message(&refused), expected);
        }
        let structure = folder.path().join("other.TOML");
        assert!(OutputFiles::default().create(&structure).is_ok());
        fs::write(&structure, "m = 1").unwrap();
        let refused = OutputFiles::default().create(&structure).err().unwrap().to_string();
        assert!(refused.ends_with("other.TOML: this would replace a file of parameters; name another file"));
    }
}
