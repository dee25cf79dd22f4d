//! What is shown of a structure and its runs, whoever shows it: in words for people, and as rows for programs.
#![allow(non_snake_case)] // H, V_t, M_t: the paper's own letters

pub mod advice;
pub mod describe;
pub mod estimate;
pub mod program;
pub mod pushover;
pub mod quantities;
pub mod summary;
pub mod tables;
pub mod validity;

use fmu_export::significant;

/// Why something failed: each cause once, though some repeat what caused them.
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
