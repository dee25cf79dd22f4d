//! Reports on a structure and its runs: words for people, rows for programs. Every door reads records, writes files and shows
//! results through this crate.

pub mod advice;
pub mod describe;
pub mod estimate;
pub mod input;
pub mod output_files;
pub mod page;
pub mod pushover;
pub mod quantities;
pub mod record;
pub mod run;
pub mod structure_file;
pub mod summary;
pub mod tables;
pub mod validity;

use rocking::names::did_you_mean;

/// Message of `error`: each cause once, even if a cause repeats the next one.
pub fn message(error: &anyhow::Error) -> String {
    let mut message = String::new();
    for cause in error.chain().map(ToString::to_string) {
        if message.is_empty() {
            message = cause;
        } else if !message.ends_with(&cause) {
            message = format!("{message}: {cause}");
        }
    }
    // serde's own words about an unknown key
    let hint = message.rsplit_once("unknown ").and_then(|(_, names)| {
        let mut quoted = names.split('`').skip(1).step_by(2);
        Some(did_you_mean(quoted.next()?, &Vec::from_iter(quoted)))
    });
    match hint.filter(|hint| !hint.is_empty()) {
        Some(hint) => message.trim_end().to_owned() + &hint,
        None => message,
    }
}
