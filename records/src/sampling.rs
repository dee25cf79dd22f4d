//! NPTS and DT, as lines before the samples state them.

use super::text::{number, quote};
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
        let words = upper.split(|letter: char| letter.is_whitespace() || ",;=:\"#%!".contains(letter));
        let words: Vec<_> = words.filter(|word| !word.is_empty()).collect();
        let after = |name: &str| {
            let after = *words.get(words.iter().position(|word| *word == name)? + 1)?;
            after.starts_with(|letter: char| letter.is_ascii_digit() || "+-.".contains(letter)).then_some(after)
        };
        let (npts, dt) = match words.as_slice() {
            [npts, dt, "NPTS", "DT", ..] => (Some(*npts), Some(*dt)),
            _ => (after("NPTS"), after("DT")),
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

/// The step (s): `.0100`, `0.01s`.
fn step(word: &str) -> Result<f64, String> {
    let dt = number(word.trim_end_matches(char::is_alphabetic)).filter(|dt| *dt > 0.0);
    dt.ok_or_else(|| format!("DT = {} must be a number of seconds greater than 0", quote(word)))
}
