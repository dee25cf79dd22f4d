//! Messages of a command, on standard error: a program that reads the results does not see them.

use indicatif::{ProgressBar, ProgressStyle};
use rocking_report::{input, output_files::OutputFile};
use std::fmt;
use std::io::{Write, stderr};
use std::sync::atomic::{AtomicBool, Ordering};

/// Says a line on standard error, unless the user wants quiet.
macro_rules! say {
    ($($text:tt)*) => {
        if !$crate::talk::IS_QUIET.load(std::sync::atomic::Ordering::Relaxed) {
            $crate::talk::write_line(format_args!($($text)*));
        }
    };
}
/// Writes a warning on standard error, quiet or not: what is assumed or doubtful is not talk.
macro_rules! warning {
    ($($text:tt)*) => {
        $crate::talk::write_line(format_args!("warning: {}", format_args!($($text)*)))
    };
}
pub(crate) use {say, warning};

/// Writes a line on standard error, whole: several programs may write there. A closed standard error is no failure.
pub fn write_line(line: fmt::Arguments) {
    let _ = stderr().write_all(format!("{line}\n").as_bytes());
}

/// More lines of one kind than this are not read.
const FEW: usize = 5;

/// The `lines` to show of one kind of things, which are called `what`: of many the first.
pub fn few(mut lines: Vec<String>, what: &str) -> Vec<String> {
    if lines.len() > FEW + 1 {
        let more = format!("... and {} more {what}", lines.len() - FEW);
        lines.splice(FEW.., [more]);
    }
    lines
}

/// Whether nothing is to be said but warnings and errors.
pub static IS_QUIET: AtomicBool = AtomicBool::new(false);

/// A bar for the progress of many runs, which are called `what`; none where standard error is no terminal.
pub fn progress(runs: usize, what: &str) -> anyhow::Result<ProgressBar> {
    let template = format!("{{elapsed_precise}} {{bar:40}} {{pos}}/{{len}} {what}, {{per_sec}}, {{eta}} left");
    let bar = if IS_QUIET.load(Ordering::Relaxed) { ProgressBar::hidden() } else { ProgressBar::new(runs as u64) };
    Ok(bar.with_style(ProgressStyle::with_template(&template)?))
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
