//! The files that a command writes, of which none is a file that it reads, or writes already.

use crate::{input, talk::say};
use anyhow::{Context, bail, ensure};
use std::{
    fs,
    io::{Write, stdout},
    path::{Path, PathBuf},
};

/// All files of one command: those that it reads, and those that it writes.
#[derive(Default)]
pub struct OutputFiles {
    inputs: Vec<PathBuf>,
    outputs: Vec<PathBuf>,
}

/// A file that is going to be written, once all of it is known.
pub struct OutputFile {
    path: PathBuf,
}

impl OutputFiles {
    /// Of a command that reads `inputs`.
    pub fn of_inputs<'a>(inputs: impl IntoIterator<Item = &'a Path>) -> OutputFiles {
        OutputFiles { inputs: inputs.into_iter().map(Path::to_owned).collect(), outputs: Vec::new() }
    }

    /// One more file that the command reads.
    pub fn add_input(&mut self, path: &Path) {
        self.inputs.push(path.into());
    }

    /// The file at `path`, or standard output for `-`. Refuses one that the command reads, or writes already.
    pub fn create(&mut self, path: &Path) -> anyhow::Result<OutputFile> {
        if let Ok(target) = path.canonicalize() {
            let is_target = |input: &&PathBuf| input.canonicalize().is_ok_and(|input| input == target);
            if let Some(input) = self.inputs.iter().find(is_target) {
                bail!("{}: this would overwrite the input {}; name another file", path.display(), input.display());
            }
        }
        ensure!(
            self.outputs.iter().all(|other| other != path),
            "{}: something else is written there as well; name another file",
            path.display()
        );
        self.outputs.push(path.into());
        Ok(OutputFile { path: path.into() })
    }
}

impl OutputFile {
    /// Standard output.
    pub fn standard_output() -> OutputFile {
        OutputFile { path: "-".into() }
    }

    /// Writes all of it.
    pub fn write(self, content: &[u8]) -> anyhow::Result<()> {
        if input::is_standard(&self.path) {
            let written = stdout().write_all(content).and_then(|()| stdout().flush());
            return written.context("standard output cannot be written");
        }
        fs::write(&self.path, content).with_context(|| format!("{} cannot be written", self.path.display()))
    }

    /// Writes all of it, and says where, as `what`.
    pub fn write_as(self, what: &str, content: &[u8]) -> anyhow::Result<()> {
        let path = self.path.clone();
        self.write(content)?;
        if !input::is_standard(&path) {
            say!("{what:<14} {}", path.display());
        }
        Ok(())
    }
}
