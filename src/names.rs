//! Names for people to give: what an unknown one may mean.

use std::borrow::Borrow;
use std::fmt::Display;

/// Similarity of Jaro, from 0 to 1, from which on one name may be meant by another.
const ALIKE: f64 = 0.75;

/// The message that `is_unknown` says of `name`, with all that are `known`.
pub fn unknown<S: Borrow<str>>(is_unknown: impl Display, name: &str, known: &[S]) -> String {
    format!("{is_unknown}; these are known: {}{}", known.join(", "), did_you_mean(name, known))
}

/// The end of a message about an unknown `name`: the nearest of those that are `known`, if one is near.
pub fn did_you_mean<S: Borrow<str>>(name: &str, known: &[S]) -> String {
    let [plain, lower] = [|name: &str| name.to_lowercase().replace('_', ""), |name: &str| name.to_lowercase()];
    let likeness = |known: &&str| match plain(known) == plain(name) {
        true => 1.0,
        false => strsim::jaro(&lower(known), &lower(name)),
    };
    let nearest = known.iter().map(S::borrow).max_by(|a, b| likeness(a).total_cmp(&likeness(b)));
    nearest.filter(|name| likeness(name) > ALIKE).map_or_else(String::new, |name| format!("; did you mean {name}?"))
}
