//! Reports on a structure and its runs: words for people, rows for programs. Every door reads records, writes files and shows
//! results through this crate.
#![allow(non_snake_case)] // H, V_t, M_t: the paper's own letters

pub mod advice;
pub mod describe;
pub mod estimate;
pub mod input;
pub mod output_files;
pub mod page;
pub mod program;
pub mod pushover;
pub mod quantities;
pub mod record;
pub mod run;
pub mod summary;
pub mod tables;
pub mod validity;

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
    message
}
