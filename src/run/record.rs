//! Ground motion records: samples in memory, and files as the world's archives publish them.
//!
//! A record is a list of samples; between two samples the ground acceleration is linear. What a file is, its content tells:
//! PEER AT2, ESM and ITACA, K-NET, COSMOS, CSMIP, or columns of text.

mod at2;
mod cosmos;
mod esm;
mod fields;
mod knet;
mod parsed;
mod sampling;
mod source;
mod table;
mod text;
mod unit;

use parsed::{Parsed, usual_step};
pub use source::{Column, Format, Reading, Source, UnitFrom};
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use text::nine_digits;
pub use unit::Unit;

/// Largest file that is read, bytes: 256 MiB.
pub const MAX_FILE: u64 = 1 << 28;

/// Most samples that are read from a file.
pub const MAX_SAMPLES: usize = 10_000_000;

/// A peak above this, in g, is rather one in another unit.
const LARGEST_USUAL_PEAK: f64 = 5.0;

/// A mean above this, in g, with a velocity at the end above that, in m/s, is of no earthquake.
const LARGEST_USUAL_MEAN: f64 = 0.05;
const LARGEST_USUAL_VELOCITY: f64 = 2.0;

/// Steps of recorders, s.
const USUAL_STEPS: std::ops::RangeInclusive<f64> = 1e-4..=0.1;

/// Most usual steps between two samples.
const LONGEST_GAP: f64 = 5.0;

/// Longest duration of a record, s: an hour.
const LONGEST_USUAL: f64 = 3600.0;

/// A ground motion: at least two samples, finite, at strictly increasing times.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    title: String,
    times: Vec<f64>,
    acceleration: Vec<f64>,
}

/// Why a file, or samples in memory, are refused.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// The file cannot be opened or read.
    #[error("the record {} cannot be read", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: io::Error,
    },
    /// A folder, a device or a pipe: nothing is read of these.
    #[error("{} is not a file", path.display())]
    NotAFile {
        /// What is no file.
        path: PathBuf,
    },
    /// The file is larger than any record.
    #[error("{} has {size} bytes; a record may have {MAX_FILE}", path.display())]
    TooLarge {
        /// The file.
        path: PathBuf,
        /// Its size.
        size: u64,
    },
    /// A line is not what the format asks for.
    #[error("{}, line {line}: {problem}", path.display())]
    Malformed {
        /// The file.
        path: PathBuf,
        /// The line, counted from 1.
        line: usize,
        /// What was found there and what belongs there.
        problem: String,
        /// What would make it readable.
        remedy: Option<Remedy>,
    },
    /// Scales that leave no ground motion.
    #[error(
        "time_scale = {time_scale:?} and scale = {scale:?} leave no ground motion of {title:?}: a finite time_scale greater \
         than 0 is needed, and finite accelerations and slopes"
    )]
    BadScales {
        /// What the record is called.
        title: String,
        /// What was to multiply its times.
        time_scale: f64,
        /// What was to multiply its accelerations.
        scale: f64,
    },
    /// Samples in memory are no ground motion.
    #[error("{title:?}: {problem}")]
    BadSamples {
        /// What the record was to be called.
        title: String,
        /// What was found, at which index, counted from 0.
        problem: String,
    },
}

/// What [`Reading`] must say to make a file readable.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Remedy {
    /// That the number of samples does not matter.
    IgnoreCount,
    /// The time between samples.
    Step,
    /// The column.
    Column,
    /// The column, or that every number is a sample.
    ColumnOrAll,
    /// The channel, which has no name but its number.
    Channel,
    /// The unit.
    Unit,
    /// Nothing: the line itself must begin with `#`, if it is one of text.
    Comment,
}

/// A line that is not what the format asks for, before the file's name is known.
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

impl Record {
    /// The record called `title` whose ground acceleration is `acceleration[i]` (m/s²) at `times[i]` (s): two or more
    /// samples, finite, at strictly increasing times.
    pub fn from_samples(
        title: impl Into<String>,
        times: Vec<f64>,
        acceleration: Vec<f64>,
    ) -> Result<Record, RecordError> {
        let title = title.into();
        match check_samples(&times, &acceleration) {
            Ok(()) => Ok(Record { title, times, acceleration }),
            Err(problem) => Err(RecordError::BadSamples { title, problem }),
        }
    }

    /// Reads the record in the file at `path` as `how` says, with accelerations in m/s²; `g` (m/s²) is what a record's g
    /// stands for.
    pub fn read(path: &Path, how: &Reading, g: f64) -> Result<(Record, Source), RecordError> {
        let (record, source) = Record::read_raw(path, how)?;
        Ok(record.in_m_s2(source, g))
    }

    /// The same with its accelerations as the file gives them; their unit is the source's.
    pub fn read_raw(path: &Path, how: &Reading) -> Result<(Record, Source), RecordError> {
        Record::from_bytes(path, &read_file(path)?, how)
    }

    /// The same of `bytes`, which are the content of the file at `path`.
    pub fn from_bytes(path: &Path, bytes: &[u8], how: &Reading) -> Result<(Record, Source), RecordError> {
        let malformed =
            |BadLine { line, problem, remedy }| RecordError::Malformed { path: path.into(), line, problem, remedy };
        let text = text::decode(bytes).map_err(malformed)?;
        let (mut record, source) =
            parse(&text, format(path, &text), how).and_then(|parsed| parsed.record(how)).map_err(malformed)?;
        if record.title.is_empty() {
            record.title = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        }
        Ok((record, source))
    }

    /// The record as its file gives it, with its accelerations in m/s²; `g` (m/s²) is what a record's g stands for. What no
    /// earthquake has is among the warnings of the `source`.
    pub fn in_m_s2(self, mut source: Source, g: f64) -> (Record, Source) {
        let record = self.multiplied(source.unit.in_m_s2(g));
        source.warnings.extend(record.doubts(g));
        (record, source)
    }

    /// What no record of an earthquake has, and one that is read wrongly has; `g` in m/s².
    fn doubts(&self, g: f64) -> Vec<String> {
        let duration = self.end() - self.start();
        let last = self.velocities_and_displacements().last();
        let step = nine_digits(usual_step(&self.times).unwrap_or_default());
        let longest = nine_digits(self.times.windows(2).map(|pair| pair[1] - pair[0]).fold(0.0, f64::max));
        let velocity = last.unwrap_or_default()[0];
        let (peak, mean) = (self.pga() / g, velocity / duration / g);
        let is_drift = mean.abs() > LARGEST_USUAL_MEAN && velocity.abs() > LARGEST_USUAL_VELOCITY;
        let is_usual = USUAL_STEPS.contains(&step);
        let doubts = [
            (peak > LARGEST_USUAL_PEAK).then(|| format!("a peak of {peak:.0} g: is the unit right?")),
            (!is_usual).then(|| format!("a step of {step} s: is the time in another unit?")),
            (longest > LONGEST_GAP * step)
                .then(|| format!("a step of {longest} s, where most are {step} s: is something missing?")),
            (duration > LONGEST_USUAL)
                .then(|| format!("a duration of {:.1} hours: is the time in another unit?", duration / 3600.0)),
            is_drift.then(|| {
                format!(
                    "a mean acceleration of {mean:.2} g, after which the ground moves on at {velocity:.0} m/s: is it \
                     the right column?"
                )
            }),
        ];
        doubts.into_iter().flatten().collect()
    }

    /// Ground at rest for `duration` (s), greater than 0: free vibration.
    pub fn at_rest(duration: f64) -> Record {
        Record { title: "free vibration".into(), times: vec![0.0, duration], acceleration: vec![0.0, 0.0] }
    }

    /// The same ground motion with every time multiplied by `time_scale`, greater than 0, and every acceleration by
    /// `scale`; an error where that leaves no motion whose accelerations and slopes are finite.
    pub fn scaled(mut self, time_scale: f64, scale: f64) -> Result<Record, RecordError> {
        self.times.iter_mut().for_each(|time| *time *= time_scale);
        let record = self.multiplied(scale);
        let samples = record.times.windows(2).zip(record.acceleration.windows(2));
        let is_motion = |(t, a): (&[f64], &[f64])| t[1] > t[0] && ((a[1] - a[0]) / (t[1] - t[0])).is_finite();
        match samples.into_iter().all(is_motion) && record.end().is_finite() {
            true => Ok(record),
            false => Err(RecordError::BadScales { title: record.title, time_scale, scale }),
        }
    }

    /// The same with every acceleration multiplied by a finite `scale`.
    pub fn multiplied(mut self, scale: f64) -> Record {
        self.acceleration.iter_mut().for_each(|acceleration| *acceleration *= scale);
        self
    }

    /// What the record is called, where its file does not say the file's name.
    pub fn title(&self) -> &str {
        &self.title
    }

    /// Times of the samples, s.
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// Ground accelerations of the samples, m/s².
    pub fn acceleration(&self) -> &[f64] {
        &self.acceleration
    }

    /// Instant of the first sample, s.
    pub fn start(&self) -> f64 {
        self.times[0]
    }

    /// Instant of the last sample, s.
    pub fn end(&self) -> f64 {
        self.times[self.times.len() - 1]
    }

    /// Peak ground acceleration, m/s²: exact, for a straight line is largest at one of its ends.
    pub fn pga(&self) -> f64 {
        self.acceleration.iter().fold(0.0, |peak, a_g| peak.max(a_g.abs()))
    }

    /// Velocity (m/s) and displacement (m) of the ground at each sample, at rest before the first one: exact, as the
    /// acceleration is linear between samples.
    pub fn velocities_and_displacements(&self) -> impl Iterator<Item = [f64; 2]> {
        let steps = self.times.windows(2).zip(self.acceleration.windows(2));
        let after = |[velocity, displacement]: &mut [f64; 2], (times, a): (&[f64], &[f64])| {
            let step = times[1] - times[0];
            *displacement += step * (*velocity + step * (2.0 * a[0] + a[1]) / 6.0);
            *velocity += 0.5 * step * (a[0] + a[1]);
            Some([*velocity, *displacement])
        };
        [[0.0; 2]].into_iter().chain(steps.scan([0.0; 2], after))
    }
}

/// The layout of `text`, the content of the file at `path`: what it shows itself. A damaged AT2 file is known by its
/// extension.
fn format(path: &Path, text: &str) -> Format {
    let is_at2 = || path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("at2"));
    match () {
        () if esm::is_its(text) => Format::Esm,
        () if knet::is_its(text) => Format::KNet,
        () => cosmos::format(text).unwrap_or(if is_at2() || at2::is_its(text) { Format::At2 } else { Format::Table }),
    }
}

fn parse(text: &str, format: Format, how: &Reading) -> Result<Parsed, BadLine> {
    match format {
        Format::At2 => at2::parse(text, how),
        Format::Esm => esm::parse(text, how),
        Format::KNet => knet::parse(text, how),
        Format::Cosmos | Format::Csmip => cosmos::parse(text, format, how),
        Format::Table => table::parse(text, how),
    }
}

/// The bytes of the file of a record. Whether `path` is one is asked before it is opened, for opening a pipe may last for ever.
pub fn read_file(path: &Path) -> Result<Vec<u8>, RecordError> {
    let unreadable = |source| RecordError::Unreadable { path: path.into(), source };
    let told = fs::metadata(path).map_err(unreadable)?;
    if !told.is_file() {
        return Err(RecordError::NotAFile { path: path.into() });
    }
    if told.len() > MAX_FILE {
        return Err(RecordError::TooLarge { path: path.into(), size: told.len() });
    }
    let mut bytes = Vec::with_capacity(told.len() as usize);
    File::open(path).and_then(|file| file.take(MAX_FILE).read_to_end(&mut bytes)).map_err(unreadable)?;
    Ok(bytes)
}

fn check_samples(times: &[f64], acceleration: &[f64]) -> Result<(), String> {
    let counts = (times.len(), acceleration.len());
    if counts.0 != counts.1 || counts.0 < 2 {
        return Err(format!(
            "{} time(s) and {} acceleration(s) instead of as many of each, two or more",
            counts.0, counts.1
        ));
    }
    for (name, unit, values) in [("times", "s", times), ("acceleration", "m/s²", acceleration)] {
        if let Some(i) = values.iter().position(|value| !value.is_finite()) {
            return Err(format!("{name}[{i}] = {} {unit} is not finite", values[i]));
        }
    }
    match times.windows(2).position(|pair| pair[1] <= pair[0]) {
        Some(i) => {
            Err(format!("times[{}] = {} s does not come after times[{i}] = {} s", i + 1, times[i + 1], times[i]))
        }
        None => Ok(()),
    }
}

fn bad(line: usize, problem: impl Into<String>) -> BadLine {
    BadLine { line, problem: problem.into(), remedy: None }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_named_and_need_not_be_utf8() {
        let folder = std::env::temp_dir().join(format!("rocking-record-{}", std::process::id()));
        fs::create_dir_all(&folder).unwrap();
        let write = |name: &str, text: &[u8]| {
            let path = folder.join(name);
            fs::write(&path, text).unwrap();
            path
        };
        let read = |path: &Path| Record::read(path, &Reading::default(), 9.81).map(|(record, _)| record);

        let latin =
            write("latin.At2", b"x\r\nN\xfa\xf1oz, 90\r\nacceleration in units of g\r\n2 .5 npts, dt\r\n1 2\r\n");
        let record = read(&latin).unwrap();
        assert_eq!(record.title(), "N\u{fa}\u{f1}oz, 90");
        assert_eq!((record.times(), record.acceleration()), (&[0.0, 0.5][..], &[9.81, 19.62][..]));
        assert_eq!(read(&write("pulse.TXT", b"0,1\n.5,0\n")).unwrap().title(), "pulse");

        let broken = write("broken.csv", b"0,1\n1,?\n");
        let expected = format!("{}, line 2: the acceleration \"?\" is not a number", broken.display());
        assert_eq!(read(&broken).unwrap_err().to_string(), expected);
        let peer = b"PEER\nNu\nVELOCITY TIME SERIES IN UNITS OF CM/S\nNPTS= 2, DT= .01 SEC\n1 2\n";
        let refused = read(&write("a.VT2", peer)).unwrap_err().to_string();
        assert!(
            refused.ends_with("SERIES IN UNITS OF CM/S\" is before the data, and accelerations are needed"),
            "{refused}"
        );
        assert!(matches!(read(&folder.join("absent.at2")), Err(RecordError::Unreadable { .. })));
        fs::remove_dir_all(folder).unwrap();
    }

    /// Nothing is read of what is no file, or too large for a record: neither hangs.
    #[test]
    #[cfg(unix)]
    fn what_is_no_file_is_refused_unread() {
        let folder = std::env::temp_dir().join(format!("rocking-no-record-{}", std::process::id()));
        fs::create_dir_all(folder.join("folder.csv")).unwrap();
        let [zero, pipe, large] = ["zero.csv", "pipe.csv", "large.csv"].map(|name| folder.join(name));
        std::os::unix::fs::symlink("/dev/zero", &zero).unwrap();
        assert!(std::process::Command::new("mkfifo").arg(&pipe).status().unwrap().success());
        let refusal = |path: &Path| Record::read(path, &Reading::default(), 9.81).unwrap_err().to_string();
        for path in [&folder.join("folder.csv"), &zero, &pipe] {
            assert_eq!(refusal(path), format!("{} is not a file", path.display()));
        }
        File::create(&large).unwrap().set_len(MAX_FILE + 1).unwrap();
        let expected = format!("{} has 268435457 bytes; a record may have 268435456", large.display());
        assert_eq!(refusal(&large), expected);
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn samples_in_memory_are_a_record() {
        let record = Record::from_samples("pulse", vec![-1.0, 0.0, 0.5], vec![2.0, -3.0, 0.0]).unwrap();
        assert_eq!(record.title(), "pulse");
        assert_eq!((record.times(), record.acceleration()), (&[-1.0, 0.0, 0.5][..], &[2.0, -3.0, 0.0][..]));
        assert_eq!((record.start(), record.end(), record.pga()), (-1.0, 0.5, 3.0));
        assert_eq!(Record::at_rest(2.0).pga(), 0.0);
    }

    /// Of a_g = 6 t over 1 s: t² · 3 and t³; then of 6 - 12 (t - 1), by hand.
    #[test]
    fn integrals_are_exact() {
        let record = Record::from_samples("", vec![2.0, 3.0, 4.0], vec![0.0, 6.0, -6.0]).unwrap();
        let integrals: Vec<_> = record.velocities_and_displacements().collect();
        assert_eq!(integrals, [[0.0, 0.0], [3.0, 1.0], [3.0, 5.0]]);
    }

    #[test]
    fn refused_samples_are_named_by_index_and_value() {
        let refused = |times: &[f64], acceleration: &[f64], problem: &str| {
            let error = Record::from_samples("pulse", times.into(), acceleration.into()).unwrap_err();
            assert_eq!(error.to_string(), format!("\"pulse\": {problem}"));
        };
        refused(&[], &[], "0 time(s) and 0 acceleration(s) instead of as many of each, two or more");
        refused(&[0.0], &[1.0], "1 time(s) and 1 acceleration(s) instead of as many of each, two or more");
        refused(&[0.0, 1.0], &[1.0; 3], "2 time(s) and 3 acceleration(s) instead of as many of each, two or more");
        refused(&[0.0, f64::NAN], &[1.0; 2], "times[1] = NaN s is not finite");
        refused(&[0.0, 1.0], &[f64::NEG_INFINITY, 1.0], "acceleration[0] = -inf m/s² is not finite");
        refused(&[0.0, 0.5, 0.5], &[1.0; 3], "times[2] = 0.5 s does not come after times[1] = 0.5 s");
        refused(&[0.0, -0.5, 1.0], &[1.0; 3], "times[1] = -0.5 s does not come after times[0] = 0 s");
    }

    #[test]
    fn scales_that_leave_no_ground_motion_are_refused() {
        let record = || Record::from_samples("pulse", vec![1.0, 2.0, 4.0], vec![2.0, 4.0, 0.0]).unwrap();
        for (time_scale, scale) in [
            (0.0, 1.0),
            (-1.0, 1.0),
            (f64::NAN, 1.0),
            (f64::INFINITY, 1.0),
            (1e-320, 1.0),
            (1.0, f64::NAN),
            (1.0, 1e308),
        ] {
            let refused = record().scaled(time_scale, scale).unwrap_err().to_string();
            let expected = format!("time_scale = {time_scale:?} and scale = {scale:?} leave no ground motion");
            assert!(refused.starts_with(&expected), "{refused}");
        }
        assert_eq!(record().scaled(2.0, -1.0).unwrap().acceleration(), [-2.0, -4.0, 0.0]);
    }

    /// Each has one fault, and is right otherwise.
    #[test]
    fn what_no_earthquake_has_is_told() {
        let doubts = |count: usize, step: f64, offset: f64, amplitude: f64| {
            let times: Vec<f64> = (0..count).map(|i| i as f64 * step).collect();
            let a = times.iter().map(|t| offset + amplitude * (6.0 * t).sin()).collect();
            Record::from_samples("", times, a).unwrap().doubts(9.81)
        };
        assert!(doubts(4000, 0.01, 0.0, 3.0).is_empty());
        assert_eq!(doubts(4000, 0.5, 0.0, 3.0), ["a step of 0.5 s: is the time in another unit?"]);
        assert_eq!(doubts(4000, 5e-5, 0.0, 3.0), ["a step of 0.00005 s: is the time in another unit?"]);
        assert_eq!(doubts(40_000, 0.1, 0.0, 3.0), ["a duration of 1.1 hours: is the time in another unit?"]);
        assert_eq!(doubts(4000, 0.01, 0.0, 59.0), ["a peak of 6 g: is the unit right?"]);
        let gap = Record::from_samples("", vec![0.0, 0.01, 0.02, 0.03, 0.24, 0.25], vec![0.0; 6]).unwrap().doubts(9.81);
        assert_eq!(gap, ["a step of 0.21 s, where most are 0.01 s: is something missing?"]);
        let drift =
            "a mean acceleration of 0.29 g, after which the ground moves on at 114 m/s: is it the right column?";
        assert_eq!(doubts(4000, 0.01, 0.29 * 9.81, 3.0), [drift]);
    }
}
