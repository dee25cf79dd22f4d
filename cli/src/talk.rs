//! What a command says beside its results: on standard error, where it disturbs no program that reads the results.

use indicatif::ProgressBar;
use std::io::{Write, stderr};
use std::sync::atomic::{AtomicBool, Ordering};

static QUIET: AtomicBool = AtomicBool::new(false);

/// From now on nothing is said but errors.
pub fn be_quiet() {
    QUIET.store(true, Ordering::Relaxed);
}

/// Whether nothing is to be said but errors.
pub fn is_quiet() -> bool {
    QUIET.load(Ordering::Relaxed)
}

/// A bar that shows how many of `length` steps are done; none where nobody would see it.
pub fn progress(length: usize) -> ProgressBar {
    if is_quiet() { ProgressBar::hidden() } else { ProgressBar::new(length as u64) }
}

/// Says why a command failed, quiet or not: each cause once, though some repeat what caused them.
pub fn say_error(error: &anyhow::Error) {
    let mut message = String::new();
    for cause in error.chain().map(ToString::to_string) {
        if message.is_empty() {
            message = cause;
        } else if !message.ends_with(&cause) {
            message = format!("{message}: {cause}");
        }
    }
    let _ = writeln!(stderr(), "error: {message}");
}

/// Says a line on standard error, unless the user wants quiet; that nobody listens is no failure.
macro_rules! say {
    ($($text:tt)*) => {
        if !$crate::talk::is_quiet() {
            use std::io::Write as _;
            let _ = writeln!(std::io::stderr(), $($text)*);
        }
    };
}
pub(crate) use say;
