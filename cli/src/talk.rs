//! Messages of a command, on standard error: a program that reads the results does not see them.

use indicatif::ProgressBar;
use rocking_report::{input, message, output_files::OutputFile};
use std::io::{Write, stderr};
use std::sync::atomic::{AtomicBool, Ordering};

/// Says a line on standard error, unless the user wants quiet. A closed standard error is no failure.
macro_rules! say {
    ($($text:tt)*) => {
        if !$crate::talk::is_quiet() {
            use std::io::Write as _;
            let _ = writeln!(std::io::stderr(), $($text)*);
        }
    };
}
pub(crate) use say;

/// More lines of one kind than this are not read.
const FEW: usize = 5;

/// Says `lines` of one kind of things, which are called `what`: of many the first.
pub fn say_few(lines: &[String], what: &str) {
    let shown = if lines.len() > FEW + 1 { FEW } else { lines.len() };
    lines[..shown].iter().for_each(|line| say!("{line}"));
    if shown < lines.len() {
        say!("... and {} more {what}", lines.len() - shown);
    }
}

static QUIET: AtomicBool = AtomicBool::new(false);

/// Suppresses all messages except errors.
pub fn be_quiet() {
    QUIET.store(true, Ordering::Relaxed);
}

/// Whether nothing is to be said but errors.
pub fn is_quiet() -> bool {
    QUIET.load(Ordering::Relaxed)
}

/// Writes `content` to `file`, and says the path of the file as that of `what`.
pub fn write_as(file: OutputFile, what: &str, content: &[u8]) -> anyhow::Result<()> {
    let path = file.path().to_owned();
    file.write(content)?;
    if !input::is_standard(&path) {
        say!("{what:<14} {}", path.display());
    }
    Ok(())
}

/// A bar that shows how many of `length` steps are done; none where standard error is no terminal.
pub fn progress(length: usize) -> ProgressBar {
    if is_quiet() { ProgressBar::hidden() } else { ProgressBar::new(length as u64) }
}

/// Says why a command failed, quiet or not.
pub fn say_error(error: &anyhow::Error) {
    let _ = writeln!(stderr(), "error: {}", message(error));
}
