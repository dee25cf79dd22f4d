//! NPTS and DT, as lines before the samples state them.

use super::text::{number, quote};
use super::unit::TimeUnit;
use super::{BadLine, MAX_SAMPLES, bad};

/// What is stated.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Sampling {
    /// NPTS, the number of samples.
    pub npts: Option<usize>,
    /// DT, the time between samples, s.
    pub dt: Option<f64>,
}

impl Sampling {
    /// What `line` states, which is the one of this `number`: `NPTS=  4172, DT=   .0100 SEC, UNITS=G`, one of the two, or
    /// `4164    0.0100    NPTS, DT`.
    pub fn of(number: usize, line: &str) -> Result<Sampling, BadLine> {
        let upper = line.to_ascii_uppercase();
        let words: Vec<_> =
            upper.split(|letter: char| letter.is_whitespace() || ",;=:\"#%!".contains(letter)).collect();
        let words: Vec<_> = words.into_iter().filter(|word| !word.is_empty()).collect();
        let after = |name: &str| {
            let after = &words[words.iter().position(|word| *word == name)? + 1..];
            after
                .first()?
                .starts_with(|letter: char| letter.is_ascii_digit() || "+-.".contains(letter))
                .then_some(after)
        };
        let (npts, dt) = match words.as_slice() {
            [npts, _, "NPTS", "DT", ..] => (Some(*npts), Some(&words[1..2])),
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

/// The step (s) that `words` begin with: `.0100 SEC`, `0.01s`, `10 ms`, or without a unit.
fn step(words: &[&str]) -> Result<f64, String> {
    let unit = |word: &str| TimeUnit::named(&word.trim_end_matches('.').to_lowercase());
    let digits = words[0].trim_end_matches(char::is_alphabetic);
    let (digits, unit) = match unit(&words[0][digits.len()..]) {
        Some(unit) => (digits, Some(unit)),
        None => (words[0], words.get(1).and_then(|word| unit(word))),
    };
    let second = unit.map_or(Ok(1.0), |unit| unit.in_seconds())?;
    let dt = number(digits).map(|dt| dt * second).filter(|dt| *dt > 0.0);
    dt.ok_or_else(|| format!("DT = {} must be a number of seconds greater than 0", quote(words[0])))
}
