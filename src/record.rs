//! Ground motion records: samples in memory, files of PEER AT2 and CSV.
//!
//! A record is a list of samples; between two samples the ground acceleration is linear.

mod at2;
mod csv;

use crate::{GroundMotion, Ramp};
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};

/// Largest file that is read, bytes: 256 MiB.
pub const MAX_FILE: u64 = 1 << 28;

/// Most samples that are read from a file.
pub const MAX_SAMPLES: usize = 10_000_000;

/// A ground motion: at least two samples, finite, at strictly increasing times.
#[derive(Clone, Debug, PartialEq)]
pub struct Record {
    title: String,
    times: Vec<f64>,
    acceleration: Vec<f64>,
}

/// The part of a ground motion between two samples.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// First instant, s.
    pub start: f64,
    /// Last instant, s.
    pub end: f64,
    /// Ground acceleration from `start` on.
    pub a_g: Ramp,
}

/// Unit of the accelerations in a CSV file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// Multiples of the acceleration of gravity, as an AT2 file always has them.
    G,
    /// m/s².
    MetrePerSecondSquared,
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
    /// The extension names no known format.
    #[error(
        "{}: the extension tells a record's format: .AT2 for an acceleration record of PEER, \
         .csv or .txt for lines of time and acceleration; rename the file or convert it",
        path.display()
    )]
    UnknownFormat {
        /// The file.
        path: PathBuf,
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

/// A line that is not what the format asks for, before the file's name is known.
#[derive(Debug, PartialEq)]
struct BadLine {
    line: usize,
    problem: String,
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

    /// Reads a record in the format that its extension tells. An acceleration in g is multiplied by `g` (m/s²);
    /// `csv_unit` is the unit of a CSV file, where an AT2 file states its own.
    pub fn read(path: &Path, csv_unit: Unit, g: f64) -> Result<Record, RecordError> {
        let format = Format::of(path)?;
        let bytes = read_file(path)?;
        let text = String::from_utf8_lossy(&bytes);
        let parsed = match format {
            Format::At2 => at2::parse(&text, g),
            Format::Csv => csv::parse(&text, csv_unit, g),
        };
        let mut record =
            parsed.map_err(|BadLine { line, problem }| RecordError::Malformed { path: path.into(), line, problem })?;
        if record.title.is_empty() {
            record.title = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        }
        Ok(record)
    }

    /// The same with its accelerations as the file gives them, and their unit.
    pub fn read_raw(path: &Path, csv_unit: Unit) -> Result<(Record, Unit), RecordError> {
        let unit = match Format::of(path)? {
            Format::At2 => Unit::G,
            Format::Csv => csv_unit,
        };
        Ok((Record::read(path, csv_unit, 1.0)?, unit))
    }

    /// Ground at rest for `duration` (s), greater than 0: free vibration.
    pub fn at_rest(duration: f64) -> Record {
        Record { title: "free vibration".into(), times: vec![0.0, duration], acceleration: vec![0.0, 0.0] }
    }

    /// The same ground motion with every time multiplied by `time_scale`, greater than 0, and every acceleration by
    /// `scale`.
    pub fn scaled(mut self, time_scale: f64, scale: f64) -> Record {
        self.times.iter_mut().for_each(|time| *time *= time_scale);
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

    /// The ground motion from its first sample until `end` (s); after its last sample the ground is at rest.
    pub fn segments_until(&self, end: f64) -> impl Iterator<Item = Segment> {
        let ground = GroundMotion::from(self);
        let linear = (1..self.times.len()).map(move |next| Segment {
            start: self.times[next - 1],
            end: self.times[next],
            a_g: ground.ramp(next),
        });
        let at_rest = Segment { start: self.end(), end: f64::INFINITY, a_g: Ramp::default() };
        linear
            .chain([at_rest])
            .take_while(move |segment| segment.start < end)
            .map(move |segment| Segment { end: segment.end.min(end), ..segment })
    }
}

impl Segment {
    /// The ground acceleration as it is given from `time` (s) on.
    pub fn from(&self, time: f64) -> Ramp {
        self.a_g.from(time - self.start)
    }
}

/// A format of files.
enum Format {
    At2,
    Csv,
}

impl Format {
    /// What the extension of `path` tells.
    fn of(path: &Path) -> Result<Format, RecordError> {
        let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
        match extension.as_deref() {
            Some("at2") => Ok(Format::At2),
            Some("csv" | "txt") => Ok(Format::Csv),
            _ => Err(RecordError::UnknownFormat { path: path.into() }),
        }
    }
}

/// The bytes of a file. Whether `path` is one is asked before it is opened, for opening a pipe may last for ever.
fn read_file(path: &Path) -> Result<Vec<u8>, RecordError> {
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
    BadLine { line, problem: problem.into() }
}

fn numbered(text: &str) -> impl Iterator<Item = (usize, &str)> {
    (1..).zip(text.lines())
}

/// A finite number; the exponent may be Fortran's, `1.2D-03`.
fn number(word: &str) -> Option<f64> {
    word.replace(['d', 'D'], "E").parse().ok().filter(|number: &f64| number.is_finite())
}

/// The acceleration that `word` gives in a unit of `unit` m/s².
fn in_m_s2(word: &str, unit: f64) -> Result<f64, String> {
    let acceleration = number(word).map(|value| value * unit).filter(|acceleration| acceleration.is_finite());
    acceleration.ok_or_else(|| format!("the acceleration {} is not a number", quote(word)))
}

/// What was found, short enough for a message, which shows a field of a file and no more of it.
fn quote(found: &str) -> String {
    const SHOWN: usize = 40;
    let found = found.trim();
    match found.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{:?}...", &found[..end]),
        None => format!("{found:?}"),
    }
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
        let read = |path: &Path| Record::read(path, Unit::G, 9.81);

        let latin =
            write("latin.At2", b"x\r\nN\xfa\xf1oz, 90\r\nacceleration in units of g\r\n2 .5 npts, dt\r\n1 2\r\n");
        let record = read(&latin).unwrap();
        assert_eq!(record.title(), "N\u{fffd}\u{fffd}oz, 90");
        assert_eq!((record.times(), record.acceleration()), (&[0.0, 0.5][..], &[9.81, 19.62][..]));
        assert_eq!(read(&write("pulse.TXT", b"0,1\n1,0\n")).unwrap().title(), "pulse");

        let broken = write("broken.csv", b"0,1\n1,?\n");
        let expected = format!("{}, line 2: the acceleration \"?\" is not a number", broken.display());
        assert_eq!(read(&broken).unwrap_err().to_string(), expected);
        assert!(matches!(read(&folder.join("a.VT2")), Err(RecordError::UnknownFormat { .. })));
        assert!(matches!(read(&folder.join("absent.at2")), Err(RecordError::Unreadable { .. })));
        assert_eq!(Record::read_raw(&latin, Unit::MetrePerSecondSquared).unwrap().1, Unit::G);
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
        let refusal = |path: &Path| Record::read(path, Unit::G, 9.81).unwrap_err().to_string();
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
    fn segments_are_linear_between_samples_and_at_rest_after_them() {
        let record = Record::from_samples("", vec![1.0, 2.0, 4.0], vec![2.0, 4.0, 0.0]).unwrap().scaled(0.5, 10.0);
        assert_eq!(record.times(), [0.5, 1.0, 2.0]);
        let segment = |start, end, value, slope| Segment { start, end, a_g: Ramp { value, slope } };
        let first = segment(0.5, 1.0, 20.0, 40.0);
        let until = |end| record.segments_until(end).collect::<Vec<_>>();
        assert_eq!(until(0.5), []);
        assert_eq!(until(1.0), [first]);
        assert_eq!(until(1.5), [first, segment(1.0, 1.5, 40.0, -40.0)]);
        assert_eq!(until(3.0), [first, segment(1.0, 2.0, 40.0, -40.0), segment(2.0, 3.0, 0.0, 0.0)]);
        assert_eq!(first.from(0.75), Ramp { value: 30.0, slope: 40.0 });
    }
}
