//! NPTS and DT, as lines before the samples state them.

use super::text::{is_number, number, quote};
use super::unit::{TimeUnit, is_known};
use super::{BadLine, MAX_SAMPLES, Reading, Remedy, bad};

/// Number of samples and step, as far as a line states them.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Sampling {
    pub npts: Option<usize>,
    pub dt: Option<f64>,
}

/// The words that state the step, or a rate, which is its reciprocal.
const STEPS: &str = "DT|SPACED INTERVALS OF|SPACED INTERVAL OF|SPACED AT|TIME STEP|TIME INTERVAL|SAMPLE INTERVAL|SAMPLING INTERVAL|SAMPLING PERIOD|INTERVALO DE MUESTREO|INTERVALO DE MUESTREO , C1-C6|\
    SAMPLING_INTERVAL_S|SAMPLERATE|SAMPLE RATE|SAMPLING RATE|SAMPLING FREQ|SAMPLING FREQUENCY";

const COUNTS: [&str; 5] = ["NPTS", "NDATA", "NUMBER OF SAMPLES", "NUMBER OF DATA", "NUMBER OF POINTS"];

impl Sampling {
    /// Reads the line of this `number`: `NPTS=  4172, DT=   .0100 SEC, UNITS=G`, one of the two, `4164    0.0100    NPTS, DT`,
    /// `SAMPLING INTERVAL (sec) : 0.01` or `Sampling rate: 100 Hz`. A statement that is not clear does not matter if `how` has a step.
    pub fn of(number: usize, line: &str, how: &Reading) -> Result<Sampling, BadLine> {
        let upper = line.to_ascii_uppercase().split_whitespace().map(with_commas_apart).collect::<Vec<_>>().join(" ");
        let words = upper.split(|letter: char| letter.is_whitespace() || "=:\"#%!()[]".contains(letter));
        // `/.005/.005/.005` has a step for each channel
        let words =
            words.map(|word| word.strip_prefix('/').map_or(word, |word| word.split('/').next().unwrap_or(word)));
        let words = words.map(|word| if matches!(word, "NO" | "NO.") { "NUMBER" } else { word });
        let words: Vec<_> = words.filter(|word| !word.is_empty()).collect();
        let after = |name: &str, place: usize| {
            let name: Vec<_> = name.split(' ').collect();
            let start = place + name.len();
            if words.get(place..start)? != name {
                return None;
            }
            let (unit, after) = match &words[start..] {
                [unit, after @ ..] if is_unit(unit) => (*unit, after),
                after => ("", after),
            };
            let ([",", after @ ..] | after) = after;
            let is_value = |letter: char| letter.is_ascii_digit() || "+-.".contains(letter);
            after.first()?.starts_with(is_value).then_some((unit, after))
        };
        let without_commas: Vec<_> = words.iter().copied().filter(|word| *word != ",").collect();
        let (npts, steps): (_, Result<Vec<_>, _>) = match without_commas.as_slice() {
            [npts, dt, "NPTS", "DT", ..] => {
                (Some(("NPTS", *npts)), step("DT", "", std::slice::from_ref(dt)).map(|dt| vec![dt]))
            }
            _ => {
                let places = || 0..words.len();
                let of_name = |name| places().filter_map(move |place| Some((name, after(name, place)?)));
                let steps = STEPS.split('|').flat_map(of_name).map(|(name, (unit, words))| step(name, unit, words));
                let count = |name: &&'static str| Some((*name, places().find_map(|place| after(name, place))?.1[0]));
                (COUNTS.iter().find_map(count), steps.collect())
            }
        };
        let npts = npts.map(|(name, word)| count(name, word)).transpose();
        let npts = npts.map_err(|problem| bad(number, problem).remedied_by(Remedy::IgnoreCount));
        let dt =
            steps.and_then(|steps| match steps.iter().find(|step| !is_same([Some(**step), steps.first().copied()])) {
                Some(other) => Err(format!("two steps are stated, {} s and {other} s: correct one of them", steps[0])),
                None => Ok(steps.first().copied()),
            });
        let dt = dt.map_err(|problem| bad(number, problem).remedied_by(Remedy::Step));
        let npts = if how.ignores_count { npts.unwrap_or_default() } else { npts? };
        Ok(Sampling { npts, dt: if how.dt.is_some() { dt.unwrap_or_default() } else { dt? } })
    }

    /// The statements of two lines, which must not contradict each other.
    pub fn and(self, other: Sampling, line: usize) -> Result<Sampling, BadLine> {
        if is_same([self, other].map(|of| of.dt)) && is_same([self, other].map(|of| of.npts.map(|npts| npts as f64))) {
            return Ok(Sampling { npts: self.npts.or(other.npts), dt: self.dt.or(other.dt) });
        }
        Err(bad(line, "another line before it states another step or number of samples: correct one of them"))
    }
}

/// `word` with blanks beside each comma and semicolon, except for the comma before decimals: `DT=0,01`.
fn with_commas_apart(word: &str) -> String {
    let value = word.trim_end_matches([',', ';']).rsplit(['=', ':']).next().unwrap_or_default();
    let is_decimal = !value.contains('.') && is_number(value.trim_end_matches(char::is_alphabetic));
    let (before, after) = word.rsplit_once(value).filter(|_| is_decimal).unwrap_or((word, ""));
    let [before, after] = [before, after].map(|part| part.replace([',', ';'], " , "));
    if is_decimal { before + value + &after } else { before }
}

/// Whether two numbers, if there are two, are the same but for a few digits.
fn is_same([a, b]: [Option<f64>; 2]) -> bool {
    a.zip(b).is_none_or(|(a, b)| (a - b).abs() <= 1e-6 * a)
}

fn is_unit(word: &str) -> bool {
    matches!(word, "HZ" | "SPS") || TimeUnit::named(&word.to_lowercase()).is_some()
}

/// The number of samples that `word` after `name` is.
pub(super) fn count(name: &str, word: &str) -> Result<usize, String> {
    match word.parse() {
        Ok(npts) if (2..=MAX_SAMPLES).contains(&npts) => Ok(npts),
        _ => Err(format!("{name} = {} must be a whole number, 2 to {MAX_SAMPLES}", quote(word))),
    }
}

/// The step (s) that `words` after `name` begin with: `.0100`, `0.01s`, `10 MSEC`, `100 Hz`. A word after it is its unit, unless a
/// comma is between; else its unit is the `unit` before it; else seconds, or Hz of a rate of 1 or more.
pub(super) fn step(name: &str, unit: &str, words: &[&str]) -> Result<f64, String> {
    let is_rate = name.contains("RATE") || name.contains("FREQ");
    let is_word = |next: &str| matches!(next, "," | "NPTS") || next.len() > 1 && is_known(&next.to_lowercase());
    let is_own = |next: &&&str| is_unit(next) || name == "DT" && !is_word(next);
    let (word, next) = (words[0], words.get(1).filter(is_own));
    let stated = next.map_or(word.to_owned(), |next| format!("{word} {next}"));
    let digits = word.trim_end_matches(char::is_alphabetic);
    let own = stated[digits.len()..].trim_matches(|letter: char| !letter.is_alphabetic());
    let is_clear = digits.split_once(',').is_none_or(|(whole, part)| whole == "0" || part.len() != 3); // not 1,000 Hz
    let value = number(&digits.replace(',', ".")).filter(|_| is_clear);
    let dt = value.and_then(|value| match if own.is_empty() { unit } else { own } {
        "" if !is_rate => Some(value),
        "HZ" | "SPS" => Some(1.0 / value),
        "" if value >= 1.0 => Some(1.0 / value),
        unit => TimeUnit::named(&unit.to_lowercase()).map(|unit| value * unit.in_seconds()),
    });
    let needed = if is_rate { "a rate in Hz" } else { "a number of seconds greater than 0" };
    dt.filter(|dt| *dt > 0.0 && dt.is_finite()).ok_or_else(|| format!("{name} = {} must be {needed}", quote(&stated)))
}
