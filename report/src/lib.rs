//! Reports on a structure and its runs: words for people, rows for programs. Every door reads records, writes files and shows
//! results through this crate.
#![allow(non_snake_case)] // H, V_t, M_t: the paper's own letters

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
    with_nearest(message)
}

/// The `message`, with the known name that is nearest to the unknown one, if the message lists the known names.
pub fn with_nearest(message: String) -> String {
    let of_library = message.split_once("these are known: ").and_then(|(before, known)| {
        Some((before.rsplit('"').nth(1)?, known.split(['\n', ';']).next()?.split(", ").collect::<Vec<_>>()))
    });
    let of_serde = || {
        let mut quoted = message.rsplit_once("unknown ")?.1.split('`').skip(1).step_by(2);
        Some((quoted.next()?, quoted.collect()))
    };
    let Some((name, known)) = of_library.or_else(of_serde) else { return message };
    let [plain, lower] = [|name: &str| name.to_lowercase().replace('_', ""), |name: &str| name.to_lowercase()];
    let likeness = |known: &&str| match plain(known) == plain(name) {
        true => 1.0,
        false => strsim::jaro(&lower(known), &lower(name)),
    };
    match known.into_iter().max_by(|a, b| likeness(a).total_cmp(&likeness(b))).filter(|best| likeness(best) > ALIKE) {
        Some(nearest) => format!("{}; did you mean {nearest}?", message.trim_end()),
        None => message,
    }
}

/// Similarity of Jaro, from 0 to 1, from which on one name may be meant by another.
const ALIKE: f64 = 0.75;
