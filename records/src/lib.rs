//! Files of ground motions as the world's archives publish them.
//!
//! The content of a file decides the layout, which is one of [`FORMATS`] or columns of text. [`read`] returns the samples in
//! m/s², and the findings and assumptions about the file. A new layout is a file of this crate and a row of the
//! table, from which help texts and pages list the layouts.

mod at2;
mod cosmos;
mod csv;
mod esm;
mod fields;
mod knet;
mod parsed;
mod sampling;
mod smc;
mod source;
mod table;
mod text;
mod unit;

pub use csv::csv_in;
use parsed::Parsed;
use rocking::run::record::{MAX_SAMPLES, Record};
use rocking::structure::parameters::PARAMETERS;
use rocking::structure::quantity::OutOfRange;
pub use source::{Column, Origin, Reading, UnitFrom, steps};
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use text::nine_digits;
pub use unit::Unit;

/// A layout of published files.
pub struct Format {
    pub name: &'static str,
    /// The statement of the unit.
    pub unit: &'static str,
    /// The statement of the step.
    pub step: &'static str,
    /// Whether a file may have several channels, of which one is chosen as if it were a column.
    pub has_channels: bool,
    /// Whether a text is one of its files.
    is_its: fn(&str) -> bool,
    parse: fn(&str, &Reading) -> Result<Parsed, BadLine>,
}

/// Makes [`FORMATS`] and [`LAYOUTS`].
macro_rules! formats {
    ($($name:literal, $unit:literal, $step:literal, $has_channels:literal, $is_its:path, $parse:path;)*) => {
        /// The layouts that are recognised.
        pub static FORMATS: &[Format] = &[$(Format {
            name: $name, unit: $unit, step: $step, has_channels: $has_channels, is_its: $is_its, parse: $parse,
        }),*];

        /// The names of the layouts that are read, as help texts list them.
        pub const LAYOUTS: &str = concat!($($name, ", ",)* "or a table of text");
    };
}

formats! {
    "PEER AT2", "g", "DT", false, at2::is_its, at2::parse;
    "ESM and ITACA ASCII", "UNITS", "SAMPLING_INTERVAL_S", false, esm::is_its, esm::parse;
    "ESD ASCII", "units", "sampling period", false, esm::is_esd, esm::esd;
    "K-NET and KiK-net ASCII", "gal, by the scale factor; the recorder's offset is taken off", "sampling frequency", false, knet::is_its, knet::parse;
    "COSMOS V1 and V2", "the line before the data", "the real header", true, cosmos::is_its, cosmos::parse;
    "USGS SMC", "cm/s2", "the real header", false, smc::is_its, smc::parse;
    "CSMIP V2", "the line before the data", "the line before the data", true, cosmos::is_csmip, cosmos::parse;
}

/// Layouts that a package for Python reads: their names, what stands on which line, counted from 0, and the package.
const OF_PYTHON: [(&str, usize, &str, Remedy); 4] = [
    ("GeoNet V1A or V2A", 0, "gns science", GMPROCESS),
    ("CSMIP V1", 0, "uncorrected accelerogram data", GMPROCESS),
    ("RENADIC", 7, "universidad de chile - renadic", GMPROCESS),
    ("SAC in letters", 13, "-12345", OBSPY), // of numbers that SAC does not use
];

const GMPROCESS: Remedy =
    Remedy::Python("gmprocess.io.read", "gmprocess.io.read.read_data(FILE)[0][0], unit=\"cm/s2\"");
const OBSPY: Remedy = Remedy::Python("obspy", "obspy.read(FILE)[0], unit=UNIT");

/// Name of the layout of all other files.
const TABLE: &str = "table";

/// Largest file that is read, bytes: 256 MiB.
pub const MAX_FILE: u64 = 1 << 28;

/// A peak above this, in g, is probably in another unit.
const LARGEST_USUAL_PEAK: f64 = 5.0;

/// No ground moves faster after an earthquake, m/s.
const LARGEST_USUAL_VELOCITY: f64 = 2.0;

/// Rounded times have steps that differ by more than this part of their mean, and are this many or more.
const LARGEST_USUAL_ROUNDING: f64 = 0.02;
const FEWEST_ROUNDED: usize = 10;

/// Steps of recorders, s.
const USUAL_STEPS: std::ops::RangeInclusive<f64> = 1e-4..=0.1;

/// Most steps, of their mean, between two samples.
const LONGEST_GAP: f64 = 5.0;

#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// The system cannot open or read the file at this path.
    #[error("the record {} cannot be read", .0.display())]
    Unreadable(PathBuf, #[source] io::Error),
    /// The reason: the path is no file, the file is too large, or an option is out of range.
    #[error("{0}")]
    Refused(String),
    #[error("{}, line {line}: {problem}", path.display())]
    Malformed {
        path: PathBuf,
        /// The line, counted from 1.
        line: usize,
        /// The content that was found, and the content that is needed.
        problem: String,
        remedy: Option<Remedy>,
    },
}

/// The option of [`Reading`] that makes a file readable, which [`Remedy::advice`] says in words.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Remedy {
    IgnoreCount,
    Step,
    StepOrHeading,
    Column,
    All,
    Unit,
    ColumnAndUnit,
    /// This module for Python reads the file, by this call in the place of the arguments of a Record.
    Python(&'static str, &'static str),
}

impl Remedy {
    /// The remedy in words, with the name by which each option is `called` at the door.
    pub fn advice(self, called: impl Fn(&str) -> String) -> String {
        match self {
            Remedy::IgnoreCount => format!("{} reads all samples", called("ignore_npts")),
            Remedy::Step => format!("give it in seconds as {}", called("dt")),
            Remedy::StepOrHeading => {
                let step = called("dt");
                format!("give the step in seconds as {step}, or head the column of times time (s) or time (ms)")
            }
            Remedy::Column => format!("choose one as {}: its number, its heading, or all", called("column")),
            Remedy::All => {
                format!("correct the line, or choose all as {} if every number is a sample", called("column"))
            }
            Remedy::Unit => format!("give the unit of the accelerations as {}", called("unit")),
            Remedy::ColumnAndUnit => {
                let called: &dyn Fn(&str) -> String = &called;
                format!("{}; {}", Remedy::Column.advice(called), Remedy::Unit.advice(called))
            }
            Remedy::Python(module, call) => {
                let package = module.split('.').next().unwrap_or_default();
                let import = format!("import {module}; import flexible_rocking as fr");
                let lines = [&*import, &format!("record = fr.Record({call})"), "record.write(\"record.csv\")"];
                format!("{package} may read it, in Python:\n{}", lines.join("\n"))
            }
        }
    }
}

/// A line that contradicts the format, before the file's name is known.
#[derive(Clone, Debug, PartialEq)]
struct BadLine {
    line: usize,
    problem: String,
    remedy: Option<Remedy>,
}

impl BadLine {
    fn remedied_by(self, remedy: Remedy) -> BadLine {
        BadLine { remedy: Some(remedy), ..self }
    }
}

/// What begins the first line of a table that has a title.
pub const TITLE: &str = "# title: ";

/// Reads the record in the file at `path` as `how` says, with accelerations in m/s². A record's g means `g` (m/s²).
pub fn read(path: &Path, how: &Reading, g: f64) -> Result<(Record, Origin), RecordError> {
    let (record, source) = read_raw(path, how)?;
    let record = in_m_s2(record, source.unit, g).map_err(|error| RecordError::Refused(error.to_string()))?;
    Ok((record, source))
}

/// Reads the record in the file at `path` with its accelerations as the file gives them; their unit is the source's.
pub fn read_raw(path: &Path, how: &Reading) -> Result<(Record, Origin), RecordError> {
    from_bytes(path, &read_file(path)?, how)
}

/// The record in `bytes`, the content of the file at `path`, with its accelerations as the file gives them.
pub fn from_bytes(path: &Path, bytes: &[u8], how: &Reading) -> Result<(Record, Origin), RecordError> {
    let malformed =
        |BadLine { line, problem, remedy }| RecordError::Malformed { path: path.into(), line, problem, remedy };
    if let Some(dt) = how.dt.filter(|dt| !(*dt > 0.0 && dt.is_finite())) {
        let problem = format!("dt = {dt} is out of range: a finite number greater than 0 is needed");
        return Err(RecordError::Refused(problem));
    }
    let text = text::decode(bytes).map_err(malformed)?;
    // the line stays, without its words, so that other lines keep their numbers
    let titled = text.strip_prefix(TITLE).map(|rest| rest.split_at(rest.find(['\r', '\n']).unwrap_or(rest.len())));
    let (title, rest) = titled.map_or((None, &*text), |(title, rest)| (Some(title), rest));
    let (record, source) = parse(rest, how).map_err(malformed)?;
    match (record.title(), title) {
        (_, Some(title)) => Ok((record.titled(title), source)),
        ("", None) => Ok((record.titled(path.file_stem().unwrap_or_default().to_string_lossy()), source)),
        _ => Ok((record, source)),
    }
}

/// Converts the accelerations of `record` from `unit` to m/s². A record's g means `g` (m/s²).
pub fn in_m_s2(record: Record, unit: Unit, g: f64) -> Result<Record, OutOfRange> {
    each_in_m_s2(record, [unit; 2], g)
}

/// Likewise of components of which each has its own unit, the horizontal one first.
pub fn each_in_m_s2(record: Record, units: [Unit; 2], g: f64) -> Result<Record, OutOfRange> {
    PARAMETERS.iter().filter(|quantity| quantity.name == "g").try_for_each(|quantity| quantity.check(g))?;
    let [horizontal, vertical] = units.map(|unit| unit.in_m_s2(g));
    Ok(record.multiplied_each(horizontal, vertical))
}

/// A sentence about the peak of `record` (m/s²) if no ground shakes as much under `g` (m/s²).
pub fn doubt_of_peak(record: &Record, g: f64) -> Option<String> {
    let peak = record.pga().max(record.vertical_peak()) / g;
    (peak > LARGEST_USUAL_PEAK).then(|| format!("a peak of {peak:.0} g: is the unit right?"))
}

/// A sentence for each property that no earthquake has but a wrongly read record often has; `record` and `g` in m/s².
pub fn doubts(record: &Record, g: f64) -> Vec<String> {
    let duration = record.end() - record.start();
    let last = record.velocities_and_displacements().last();
    let step = nine_digits(duration / (record.times().len() - 1) as f64);
    let gaps = record.times().windows(2).map(|pair| (pair[1] - pair[0], pair[0]));
    let (longest, gap) = gaps.fold((0.0, 0.0), |most: (f64, f64), gap| if gap.0 > most.0 { gap } else { most });
    let gap = nine_digits(gap);
    let drift = last.unwrap_or_default()[0];
    let is_usual = record.pga() == 0.0 || USUAL_STEPS.contains(&step);
    let doubts = [
        doubt_of_peak(record, g),
        (!is_usual).then(|| format!("a step of {step} s: is the time in another unit?")),
        (longest > LONGEST_GAP * step).then(|| {
            let longest = nine_digits(longest);
            format!("no sample for {longest} s after t = {gap} s, on average one in {step} s: is something missing?")
        }),
        (drift.abs() > LARGEST_USUAL_VELOCITY).then(|| {
            format!("the ground moves on at {drift:.1} m/s after the record: is an offset left, or the column wrong?")
        }),
        rounded(record.times()).map(|[least, most]| {
            let [least, most] = [least, most].map(nine_digits);
            let steps = format!("steps of {least} to {most} s beside even times");
            if most < 1.9 * least {
                return format!("{steps}: are the times rounded? Give the right step");
            }
            format!("{steps}: is a sample missing after t = {gap} s, or are the times rounded? Complete the file, or give the right step")
        }),
    ];
    doubts.into_iter().flatten().collect()
}

/// The shortest and the longest step between `times`, if they are those of even times that were rounded.
fn rounded(times: &[f64]) -> Option<[f64; 2]> {
    let (start, mean) = (times[0], (times[times.len() - 1] - times[0]) / (times.len() - 1) as f64);
    let steps = || times.windows(2).map(|pair| pair[1] - pair[0]);
    let [least, most] = [steps().fold(f64::INFINITY, f64::min), steps().fold(0.0, f64::max)];
    let is_even = |(i, time): (usize, &f64)| (time - start - i as f64 * mean).abs() < most - least;
    let is_rounded =
        times.len() >= FEWEST_ROUNDED && most - least > LARGEST_USUAL_ROUNDING * mean && most < 2.1 * least;
    (is_rounded && times.iter().enumerate().all(is_even)).then_some([least, most])
}

/// The record in `text`, whose content decides its layout.
fn parse(text: &str, how: &Reading) -> Result<(Record, Origin), BadLine> {
    let states = |line: usize, mark| text.lines().nth(line).is_some_and(|line| line.to_lowercase().contains(mark));
    let foreign = OF_PYTHON.iter().find(|(_, line, mark, _)| states(*line, mark));
    if let Some((name, line, _, by)) = foreign.filter(|_| !text.to_lowercase().contains("accel data equally spaced")) {
        let problem = format!("the file is one of {name}, which is not read here");
        return Err(bad(line + 1, problem).remedied_by(*by));
    }
    check_headings(text)?;
    check_end(text)?;
    let Some(format) = FORMATS.iter().find(|format| (format.is_its)(text)) else {
        return table::parse(text, how)?.record(how, TABLE);
    };
    if let (false, Some(asked)) = (format.has_channels, &how.column) {
        return Err(bad(1, format!("the given column is {asked}, but a file of {} has none", format.name)));
    }
    (format.parse)(text, how)?.record(how, format.name)
}

/// Refuses long text before the second line of numbers, after which all layouts have their data: the first may state a count.
fn check_headings(text: &str) -> Result<(), BadLine> {
    const MOST: usize = 500;
    let mut lines = text::numbered(text).filter(|(_, line)| !line.trim().is_empty());
    let is_data = |(_, line): &(usize, &str)| !text::is_comment(line) && fields::is_numbers(line);
    match (lines.by_ref().take(MOST).filter(is_data).take(2).count(), lines.next()) {
        (0 | 1, Some((line, _))) => Err(bad(line, format!("no data after {MOST} lines: shorten the text before"))),
        _ => Ok(()),
    }
}

/// Refuses a file of numbers with as many decimals that ends within a number: with fewer decimals and no end of line.
fn check_end(text: &str) -> Result<(), BadLine> {
    let decimals = |word: &str| word.find('.').map_or(0, |point| word.len() - point);
    let mut last = text.lines().rev().map(fields::words);
    let (Some(end), Some(before), false) = (last.next(), last.next(), text.ends_with('\n')) else { return Ok(()) };
    let (Some(cut), [first, _, _, ..]) = (end.last(), &before[..]) else { return Ok(()) };
    let are_alike = before.iter().all(|word| decimals(word) == decimals(first));
    if are_alike && decimals(cut) < decimals(first) && fields::is_numbers(cut) {
        let problem =
            format!("the file ends within the number {cut}: it was cut, or end the line if the number is whole");
        return Err(bad(text.lines().count(), problem));
    }
    Ok(())
}

/// The bytes of the file of a record. The function opens regular files only, because opening a pipe can block for ever.
pub fn read_file(path: &Path) -> Result<Vec<u8>, RecordError> {
    let unreadable = |error| RecordError::Unreadable(path.into(), error);
    let told = fs::metadata(path).map_err(unreadable)?;
    if !told.is_file() {
        return Err(RecordError::Refused(format!("{} is not a file", path.display())));
    }
    if told.len() > MAX_FILE {
        let problem = format!("{} has {} bytes; a record may have {MAX_FILE}", path.display(), told.len());
        return Err(RecordError::Refused(problem));
    }
    let mut bytes = Vec::with_capacity(told.len() as usize);
    File::open(path).and_then(|file| file.take(MAX_FILE).read_to_end(&mut bytes)).map_err(unreadable)?;
    Ok(bytes)
}

fn bad(line: usize, problem: impl Into<String>) -> BadLine {
    BadLine { line, problem: problem.into(), remedy: None }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Nothing is read of what is no file, or too large for a record: neither hangs.
    #[test]
    #[cfg(unix)]
    fn what_is_no_file_is_refused_unread() {
        let folder = tempfile::tempdir().unwrap();
        let [zero, pipe, large] = ["zero.csv", "pipe.csv", "large.csv"].map(|name| folder.path().join(name));
        std::os::unix::fs::symlink("/dev/zero", &zero).unwrap();
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        let refusal = |path: &Path| super::read(path, &Reading::default(), 9.81).unwrap_err().to_string();
        for path in [folder.path(), &zero, &pipe] {
            assert_eq!(refusal(path), format!("{} is not a file", path.display()));
        }
        File::create(&large).unwrap().set_len(MAX_FILE + 1).unwrap();
        let expected = format!("{} has 268435457 bytes; a record may have 268435456", large.display());
        assert_eq!(refusal(&large), expected);
    }
}
