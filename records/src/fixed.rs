//! Layouts of FORTRAN: lines of text, of integers and of reals, then numbers in columns whose width the publisher states, not
//! the file. USGS SMC, and volume 1 of CSMIP, in which RENADIC writes, too.

use super::cosmos::{chosen, direction, tenths};
use super::parsed::{Parsed, Times};
use super::text::{columns, no_number, number, numbered};
use super::{BadLine, GMPROCESS, Reading, bad, source::of_file};

/// Whether `text` is of USGS SMC.
pub(super) fn is_smc(text: &str) -> bool {
    let first = text.lines().next().unwrap_or_default().trim().to_lowercase();
    ["1 uncorrected accelerogram", "2 corrected accelerogram"].contains(&first.as_str())
}

/// Whether `text` is of volume 1.
pub(super) fn is_volume_1(text: &str) -> bool {
    let states = |line: usize, mark| text.lines().nth(line).is_some_and(|line| line.to_lowercase().contains(mark));
    states(0, "uncorrected accelerogram data") && !text.to_lowercase().contains("data equally spaced")
        || states(7, "universidad de chile - renadic")
}

/// USGS SMC: 11 lines of text, 48 integers (8I10), 50 reals (5E15.7), comments, then accelerations in cm/s² (8F10).
pub(super) fn smc(text: &str, how: &Reading) -> Result<Parsed, BadLine> {
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
    let (unit, unit_from) = of_file("cm/s2", how.unit, 1)?;
    let title = text.lines().nth(5).unwrap_or_default().split_whitespace().collect::<Vec<_>>().join(" ");
    let mut parsed = Parsed::new(title, unit, unit_from, Times::Every(1.0 / rate));
    parsed.read(numbered(text).skip(reals).skip_while(|(_, line)| line.starts_with('|')), Some(10))?;
    parsed.check_count("integer 17 of the header", count as usize, how)?;
    Ok(parsed)
}

/// Volume 1, for each channel: 13 lines of text, 7 of integers, 7 of reals, times and accelerations in turn (10F7), and a line
/// at the end.
pub(super) fn volume_1(text: &str, how: &Reading) -> Result<Parsed, BadLine> {
    const HEADER: usize = 27;
    let is_number = |line: &&str| !line.contains(|letter: char| letter.is_alphabetic() || letter == '/');
    let (mut channels, mut first, mut rest) = (Vec::new(), 0, text);
    while let (header, Some(after)) = split(rest, HEADER) {
        let rows = after.lines().take_while(is_number).count();
        let (series, after) = split(after, rows);
        channels.push((first, header, series));
        (first, rest) = (first + HEADER + rows + 1, after.and_then(|after| split(after, 1).1).unwrap_or_default());
    }
    let names = channels.iter().map(|(_, header, _)| header.lines().find_map(direction).unwrap_or_default());
    let (first, header, series) = channels[chosen(&names.collect::<Vec<_>>(), how, 1)?];
    let lower = header.to_lowercase();
    let after = |word: &str| {
        let found = numbered(&lower).find_map(|(line, text)| Some((first + line, text.split_once(word)?.1)));
        found.ok_or_else(|| bad(first + 1, format!("no line of the header has {word:?}")))
    };
    let (line, count) = after("points")?;
    let count = count.split(|letter: char| !letter.is_ascii_digit()).find_map(|word| word.parse().ok());
    let count = count.ok_or_else(|| bad(line, "the number of points is not stated"))?;
    let (line, unit) = after("sec and ")?;
    let (unit, factor) = tenths(unit.split([' ', '.', ',']).next().unwrap_or_default());
    let (unit, unit_from) = of_file(unit, how.unit, line)?;
    let title = header.lines().nth(5).unwrap_or_default().trim();
    let mut parsed = Parsed::new(title, unit, unit_from, Times::At(Vec::new()));
    parsed.read(numbered(series).map(|(line, row)| (first + HEADER + line, row)), Some(7))?;
    let (times, values) = parsed.values.chunks_exact(2).map(|pair| (pair[0], factor * pair[1])).unzip();
    (parsed.times, parsed.values) = (Times::At(times), values);
    parsed.check_count("the header", count, how)?;
    Ok(parsed)
}

/// So many lines of `text`, and what follows, if anything does.
fn split(text: &str, lines: usize) -> (&str, Option<&str>) {
    let (before, after) = text.split_at(text.split_inclusive('\n').take(lines).map(str::len).sum());
    (before, Some(after).filter(|after| !after.is_empty()))
}
