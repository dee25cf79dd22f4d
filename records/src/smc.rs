//! USGS SMC: 11 lines of text, 48 integers (8I10), 50 reals (5E15.7), comments, then accelerations in cm/s² (8F10).

use super::parsed::{Parsed, published};
use super::text::{columns, no_number, number, numbered};
use super::{BadLine, GMPROCESS, Reading, bad};

pub(super) fn is_its(text: &str) -> bool {
    let first = text.lines().next().unwrap_or_default().trim().to_lowercase();
    ["1 uncorrected accelerogram", "2 corrected accelerogram"].contains(&first.as_str())
}

/// The step from the sampling rate, real 2, and the number of samples from integer 17.
pub(super) fn parse(text: &str, how: &Reading) -> Result<Parsed, BadLine> {
    let [words, integers, reals] = [11, 17, 27];
    let mut about = Vec::new();
    for (line, content) in numbered(text).take(reals).skip(words) {
        for word in columns(content, Some(if line <= integers { 10 } else { 15 })) {
            about.push(number(word).ok_or_else(|| bad(line, no_number(word)))?);
        }
    }
    let (count, rate) = (about.get(16).copied().unwrap_or(0.0), about.get(48 + 1).copied().unwrap_or(0.0));
    if !(1.0..1e5).contains(&rate) {
        let problem = format!("the header states a sampling rate of {rate:e} Hz; 1 to 100000 Hz are needed");
        return Err(bad(integers + 1, problem).remedied_by(GMPROCESS));
    }
    let title = text.lines().nth(5).unwrap_or_default().split_whitespace().collect::<Vec<_>>().join(" ");
    let lines = numbered(text).skip(reals).skip_while(|(_, line)| line.starts_with('|'));
    published(title, ("cm/s2", 1), 1.0 / rate, ("integer 17 of the header", count as usize), (lines, Some(10)), how)
}
