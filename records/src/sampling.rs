//! NPTS and DT, as lines before the samples state them.

use super::text::{number, quote};
use super::unit::TimeUnit;
use super::{BadLine, MAX_SAMPLES, bad};

/// Number of samples and step, as far as a line states them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Sampling {
    /// NPTS, the number of samples.
    pub npts: Option<usize>,
    /// DT, the time between samples, s.
    pub dt: Option<f64>,
}

impl Sampling {
    /// Reads the line of this `number`: `NPTS=  4172, DT=   .0100 SEC, UNITS=G`, one of the two, or `4164    0.0100    NPTS,
    /// DT`.
    pub fn of(number: usize, line: &str) -> Result<Sampling, BadLine> {
        let upper = line.to_ascii_uppercase().replace([',', ';'], " , ");
        let words = upper.split(|letter: char| letter.is_whitespace() || "=:\"#%!".contains(letter));
        let words: Vec<_> = words.filter(|word| !word.is_empty()).collect();
        let after = |name: &str| {
            let ([",", after @ ..] | after) = &words[words.iter().position(|word| *word == name)? + 1..];
            let is_value = |letter: char| letter.is_ascii_digit() || "+-.".contains(letter);
            after.first()?.starts_with(is_value).then_some(after)
        };
        let without_commas: Vec<_> = words.iter().copied().filter(|word| *word != ",").collect();
        let (npts, dt) = match without_commas.as_slice() {
            [npts, dt, "NPTS", "DT", ..] => (Some(*npts), Some(std::slice::from_ref(dt))),
            _ => (after("NPTS").map(|words| words[0]), after("DT")),
        };
        let stated = npts.map(count).transpose().and_then(|npts| Ok((npts, dt.map(step).transpose()?)));
        let (npts, dt) = stated.map_err(|problem| bad(number, problem))?;
        Ok(Sampling { npts, dt })
    }
}

fn count(word: &str) -> Result<usize, String> {
    match word.parse() {
        Ok(npts) if (2..=MAX_SAMPLES).contains(&npts) => Ok(npts),
        _ => Err(format!("NPTS = {} must be a whole number, 2 to {MAX_SAMPLES}", quote(word))),
    }
}

/// The step (s) that `words` begin with: `.0100`, `0.01s`, `10 MSEC`. A word after it is its unit, unless a comma is between.
fn step(words: &[&str]) -> Result<f64, String> {
    let (word, next) = (words[0], words.get(1).filter(|next| !matches!(**next, "," | "NPTS")));
    let stated = next.map_or(word.to_owned(), |next| format!("{word} {next}"));
    let digits = word.trim_end_matches(char::is_alphabetic);
    let unit = match stated[digits.len()..].trim_matches(|letter: char| !letter.is_alphabetic()) {
        "" => Some(TimeUnit::Second),
        unit => TimeUnit::named(&unit.to_lowercase()),
    };
    let dt = number(digits).zip(unit).map(|(dt, unit)| dt * unit.in_seconds()).filter(|dt| *dt > 0.0);
    dt.ok_or_else(|| format!("DT = {} must be a number of seconds greater than 0", quote(&stated)))
}
