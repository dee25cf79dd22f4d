//! Ground motion records: PEER AT2 and CSV.
//!
//! A record is a list of samples; between two samples the ground acceleration is linear.

use crate::Ramp;
use std::{
    fs,
    path::{Path, PathBuf},
};

/// A ground motion: at least two samples, at strictly increasing times.
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

/// Why a file is refused.
#[derive(Debug, thiserror::Error)]
pub enum RecordError {
    /// The file cannot be opened or read.
    #[error("the record {} cannot be read", path.display())]
    Unreadable {
        /// The file.
        path: PathBuf,
        /// What the system says.
        source: std::io::Error,
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
}

/// A line that is not what the format asks for, before the file's name is known.
#[derive(Debug, PartialEq)]
struct BadLine {
    line: usize,
    problem: String,
}

impl Record {
    /// Reads a record in the format that its extension tells. An acceleration in g is multiplied by `g` (m/s²);
    /// `csv_unit` is the unit of a CSV file, where an AT2 file states its own.
    pub fn read(path: &Path, csv_unit: Unit, g: f64) -> Result<Record, RecordError> {
        let extension = path.extension().map(|extension| extension.to_string_lossy().to_lowercase());
        let parse: fn(&str, Unit, f64) -> Result<Record, BadLine> = match extension.as_deref() {
            Some("at2") => |text, _, g| Record::from_at2(text, g),
            Some("csv" | "txt") => Record::from_csv,
            _ => return Err(RecordError::UnknownFormat { path: path.into() }),
        };
        let bytes = fs::read(path).map_err(|source| RecordError::Unreadable { path: path.into(), source })?;
        let mut record = parse(&String::from_utf8_lossy(&bytes), csv_unit, g)
            .map_err(|BadLine { line, problem }| RecordError::Malformed { path: path.into(), line, problem })?;
        if record.title.is_empty() {
            record.title = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        }
        Ok(record)
    }

    /// Ground at rest for `duration` (s): free vibration.
    pub fn at_rest(duration: f64) -> Record {
        Record { title: "free vibration".into(), times: vec![0.0, duration], acceleration: vec![0.0, 0.0] }
    }

    /// PEER's AT2: a title on line 2, the unit on line 3, NPTS and DT on line 4, then NPTS accelerations.
    fn from_at2(text: &str, g: f64) -> Result<Record, BadLine> {
        const HEADER_LINES: usize = 4;
        let header: Vec<_> = text.lines().take(HEADER_LINES).collect();
        let &[_, title, unit, counts] = header.as_slice() else {
            return Err(bad(header.len().max(1), "the file ends within the four header lines of an AT2 file"));
        };
        check_at2_unit(unit).map_err(|problem| bad(3, problem))?;
        let (npts, dt) = at2_counts(counts).map_err(|problem| bad(4, problem))?;

        let mut acceleration = Vec::new();
        let mut last_line = HEADER_LINES;
        for (line, values) in numbered(text).skip(HEADER_LINES) {
            for value in values.split_whitespace().flat_map(split_run_together) {
                if acceleration.len() == npts {
                    return Err(bad(line, format!("{} follows the last of the {npts} values of NPTS", quote(value))));
                }
                acceleration.push(in_m_s2(value, g).map_err(|problem| bad(line, problem))?);
                last_line = line;
            }
        }
        if acceleration.len() < npts {
            let found = acceleration.len();
            return Err(bad(last_line, format!("the file ends after {found} of the {npts} values of NPTS")));
        }
        let times = (0..npts).map(|i| i as f64 * dt).collect();
        Ok(Record { title: title.trim().into(), times, acceleration })
    }

    /// Lines of time (s) and acceleration, after at most one line of headings; `#` begins a comment line.
    fn from_csv(text: &str, unit: Unit, g: f64) -> Result<Record, BadLine> {
        let unit_in_m_s2 = match unit {
            Unit::G => g,
            Unit::MetrePerSecondSquared => 1.0,
        };
        let (mut times, mut acceleration): (Vec<f64>, Vec<f64>) = Default::default();
        let mut last_line = 1;
        let text = text.trim_start_matches('\u{feff}');
        let is_sample = |&(_, line): &(usize, &str)| !line.trim().is_empty() && !line.trim_start().starts_with('#');
        for (index, (line, sample)) in numbered(text).filter(is_sample).enumerate() {
            last_line = line;
            let columns: Vec<_> = sample.split([',', ';', '\t']).map(str::trim).collect();
            if index == 0 && columns.iter().all(|column| number(column).is_none()) {
                continue;
            }
            let &[time, value] = columns.as_slice() else {
                let found = columns.len();
                let expected = "time and acceleration with a comma, semicolon or tab between them";
                return Err(bad(line, format!("{} has {found} column(s) instead of {expected}", quote(sample))));
            };
            let time = number(time).ok_or_else(|| bad(line, format!("the time {} is not a number", quote(time))))?;
            if let Some(before) = times.last().filter(|before| time <= **before) {
                return Err(bad(line, format!("the time {time} s does not come after the one before it, {before} s")));
            }
            times.push(time);
            acceleration.push(in_m_s2(value, unit_in_m_s2).map_err(|problem| bad(line, problem))?);
        }
        if times.len() < 2 {
            return Err(bad(
                last_line,
                format!("the file ends after {} sample(s); two or more are needed", times.len()),
            ));
        }
        Ok(Record { title: String::new(), times, acceleration })
    }

    /// The same ground motion with every time multiplied by `time_scale` and every acceleration by `scale`.
    pub fn scaled(mut self, time_scale: f64, scale: f64) -> Record {
        self.times.iter_mut().for_each(|time| *time *= time_scale);
        self.acceleration.iter_mut().for_each(|acceleration| *acceleration *= scale);
        self
    }

    /// What the file calls the record, or the file's name.
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

    /// The ground motion from its first sample until `end` (s); after its last sample the ground is at rest.
    pub fn segments_until(&self, end: f64) -> impl Iterator<Item = Segment> {
        let samples = self.times.windows(2).zip(self.acceleration.windows(2));
        let linear = samples.map(|(times, acceleration)| Segment {
            start: times[0],
            end: times[1],
            a_g: Ramp {
                value: acceleration[0],
                slope: (acceleration[1] - acceleration[0]) / (times[1] - times[0]),
            },
        });
        let at_rest =
            Segment { start: self.times[self.times.len() - 1], end: f64::INFINITY, a_g: Ramp::default() };
        linear
            .chain([at_rest])
            .take_while(move |segment| segment.start < end)
            .map(move |segment| Segment { end: segment.end.min(end), ..segment })
    }
}

impl Segment {
    /// The ground acceleration as it is given from `time` (s) on.
    pub fn from(&self, time: f64) -> Ramp {
        Ramp { value: self.a_g.at(time - self.start), slope: self.a_g.slope }
    }
}

fn bad(line: usize, problem: impl Into<String>) -> BadLine {
    BadLine { line, problem: problem.into() }
}

fn numbered(text: &str) -> impl Iterator<Item = (usize, &str)> {
    (1..).zip(text.lines())
}

/// `ACCELERATION TIME SERIES IN UNITS OF G` or `ACCELERATION TIME HISTORY IN UNITS OF G. FILTER ...`.
fn check_at2_unit(line: &str) -> Result<(), String> {
    let upper = line.to_uppercase();
    let unit = upper.split_once("UNITS OF").and_then(|(_, rest)| rest.split_whitespace().next());
    if upper.contains("ACCELERATION") && unit.is_some_and(|unit| unit.trim_end_matches(['.', ',', ';']) == "G") {
        Ok(())
    } else {
        Err(format!("found {} where an AT2 file states ACCELERATION ... IN UNITS OF G", quote(line)))
    }
}

/// NPTS and DT (s) from `NPTS=  4172, DT=   .0100 SEC,` or `4164    0.0100    NPTS, DT`.
fn at2_counts(line: &str) -> Result<(usize, f64), String> {
    let upper = line.to_uppercase();
    let words: Vec<_> = upper.split([' ', '\t', ',', '=']).filter(|word| !word.is_empty()).collect();
    let (npts, dt) = match words.as_slice() {
        ["NPTS", npts, "DT", dt] => (npts, dt.trim_end_matches("SEC")),
        ["NPTS", npts, "DT", dt, unit, ..] if unit.starts_with("SEC") => (npts, *dt),
        [npts, dt, "NPTS", "DT", ..] => (npts, *dt),
        _ => {
            let expected = "`NPTS= 4172, DT= .0100 SEC` or `4172 0.0100 NPTS, DT`";
            return Err(format!("found {} where an AT2 file states {expected}", quote(line)));
        }
    };
    let npts: usize = match npts.parse() {
        Ok(npts) if npts >= 2 => npts,
        _ => return Err(format!("NPTS = {} must be a whole number, 2 or more", quote(npts))),
    };
    match number(dt) {
        Some(dt) if dt > 0.0 && (npts as f64 * dt).is_finite() => Ok((npts, dt)),
        _ => Err(format!("DT = {} must be a number of seconds greater than 0", quote(dt))),
    }
}

/// Full columns of a fixed width leave no blank between numbers: `.1297983E-02-.4E-03`. A sign after the digits of an
/// exponent can only begin the next number.
fn split_run_together(mut word: &str) -> impl Iterator<Item = &str> {
    std::iter::from_fn(move || {
        let exponent = word.find(['e', 'E', 'd', 'D']).unwrap_or(word.len());
        let next = word.char_indices().find(|&(i, c)| i > exponent + 1 && matches!(c, '+' | '-'));
        let (number, rest) = word.split_at(next.map_or(word.len(), |(i, _)| i));
        word = rest;
        (!number.is_empty()).then_some(number)
    })
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

/// What was found, short enough for a message.
fn quote(found: &str) -> String {
    const SHOWN: usize = 60;
    let found = found.trim();
    match found.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{:?}...", &found[..end]),
        None => format!("{found:?}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const PACOIMA: &str = "PEER NGA STRONG MOTION DATABASE RECORD\n\
        San Fernando, 2/9/1971, Pacoima Dam (upper left abut), 164\n\
        ACCELERATION TIME SERIES IN UNITS OF G\n";

    /// The counts of every header variant, and what they say.
    const COUNTS: [(&str, usize, f64); 9] = [
        ("NPTS=   3, DT=   .0100 SEC,                    ", 3, 0.01),
        ("NPTS= 3, DT= 0.01 SEC", 3, 0.01),
        ("NPTS=     3  DT=  0.0050 SEC,", 3, 0.005),
        ("NPTS= 3 DT= 0.0050000", 3, 0.005),
        ("NPTS=3,DT=.02SEC", 3, 0.02),
        ("  3    0.0100    NPTS, DT", 3, 0.01),
        ("3 .0050 npts,dt", 3, 0.005),
        ("npts=   3, dt=   5.0e-3 sec", 3, 0.005),
        ("\tNPTS =\t3 ,\tDT =\t1D-2\tSEC", 3, 0.01),
    ];

    fn at2(counts: &str, values: &str) -> Result<Record, BadLine> {
        Record::from_at2(&format!("{PACOIMA}{counts}\n{values}"), 10.0)
    }

    fn at2_problem(counts: &str, values: &str) -> String {
        let BadLine { line, problem } = at2(counts, values).unwrap_err();
        format!("{line}: {problem}")
    }

    fn csv(text: &str) -> Result<Record, BadLine> {
        Record::from_csv(text, Unit::MetrePerSecondSquared, 10.0)
    }

    fn csv_problem(text: &str) -> String {
        let BadLine { line, problem } = csv(text).unwrap_err();
        format!("{line}: {problem}")
    }

    #[test]
    fn every_header_variant_gives_the_same_samples() {
        for (counts, npts, dt) in COUNTS {
            let record = at2(counts, " .1297983E-02\t-.4E-03\r\n1.2d-03  \r\n\r\n \r\n").unwrap();
            assert_eq!(record.title(), "San Fernando, 2/9/1971, Pacoima Dam (upper left abut), 164");
            assert_eq!(record.times(), (0..npts).map(|i| i as f64 * dt).collect::<Vec<_>>(), "{counts}");
            assert_eq!(record.acceleration(), [0.1297983e-2 * 10.0, -0.4e-3 * 10.0, 1.2e-3 * 10.0], "{counts}");
        }
    }

    #[test]
    fn the_unit_line_must_state_acceleration_in_g() {
        for accepted in [
            "ACCELERATION TIME SERIES IN UNITS OF G",
            "acceleration time history in units of g\r",
            "ACCELERATION TIME HISTORY IN UNITS OF G. FILTER POINTS: HP=0.1 Hz LP=30.0 Hz",
            " ACCELERATION TIME SERIES IN UNITS OF g (9.81)",
        ] {
            assert_eq!(check_at2_unit(accepted), Ok(()));
        }
        for refused in [
            "VELOCITY TIME SERIES IN UNITS OF CM/S",
            "DISPLACEMENT TIME SERIES IN UNITS OF CM",
            "ACCELERATION TIME SERIES IN UNITS OF GAL",
            "ACCELERATION TIME SERIES IN UNITS OF G/10",
            "ACCELERATION TIME SERIES",
            "",
        ] {
            assert!(check_at2_unit(refused).is_err(), "{refused}");
        }
        let velocity = "a\nb\nVELOCITY TIME SERIES IN UNITS OF CM/S\nNPTS= 2, DT= .01 SEC\n1 2\n";
        assert_eq!(
            Record::from_at2(velocity, 10.0),
            Err(bad(
                3,
                "found \"VELOCITY TIME SERIES IN UNITS OF CM/S\" where an AT2 file states \
                 ACCELERATION ... IN UNITS OF G"
            ))
        );
    }

    #[test]
    fn a_refused_at2_file_says_what_was_found_on_which_line() {
        const THREE: &str = "NPTS= 3, DT= .01 SEC";
        assert_eq!(Record::from_at2("", 10.0).unwrap_err().line, 1);
        assert_eq!(
            Record::from_at2(PACOIMA, 10.0),
            Err(bad(3, "the file ends within the four header lines of an AT2 file"))
        );
        assert_eq!(at2_problem(THREE, ".1 .2\n\n"), "5: the file ends after 2 of the 3 values of NPTS");
        assert_eq!(at2_problem(THREE, ""), "4: the file ends after 0 of the 3 values of NPTS");
        assert_eq!(at2_problem(THREE, ".1\n.2\n.3 .4\n"), "7: \".4\" follows the last of the 3 values of NPTS");
        for not_a_number in ["x", "1.2.3", "********", "nan", "-inf", "1e999", ".1-.2", "1E-", "1e308", "ÿ"] {
            assert_eq!(
                at2_problem(THREE, &format!(".1\n {not_a_number}\n.3\n")),
                format!("6: the acceleration {not_a_number:?} is not a number")
            );
        }
        assert_eq!(at2_problem("NPTS= 1, DT= .01 SEC", ".1"), "4: NPTS = \"1\" must be a whole number, 2 or more");
        assert_eq!(at2_problem("3.5 .01 NPTS, DT", ".1"), "4: NPTS = \"3.5\" must be a whole number, 2 or more");
        for dt in ["0.0", "-.01", "NAN", "1E308", "X"] {
            assert_eq!(
                at2_problem(&format!("NPTS= 3, DT= {dt} SEC"), ".1 .2 .3"),
                format!("4: DT = {dt:?} must be a number of seconds greater than 0")
            );
        }
        assert_eq!(
            at2_problem("NPTS= 3, DT= 10 MSEC", ".1 .2 .3"),
            "4: found \"NPTS= 3, DT= 10 MSEC\" where an AT2 file states \
             `NPTS= 4172, DT= .0100 SEC` or `4172 0.0100 NPTS, DT`"
        );
        assert_eq!(
            at2_problem(THREE, &"9".repeat(400)),
            format!("5: the acceleration \"{}\"... is not a number", "9".repeat(60))
        );
    }

    #[test]
    fn full_columns_of_a_fixed_width_come_apart() {
        let together: Vec<_> = split_run_together("-.1297E-02-.4000E-03+1.5D+00.2").collect();
        assert_eq!(together, ["-.1297E-02", "-.4000E-03", "+1.5D+00.2"]);
        assert_eq!(split_run_together("1.5E0-2").collect::<Vec<_>>(), ["1.5E0", "-2"]);
        assert_eq!(split_run_together(".1-.2").collect::<Vec<_>>(), [".1-.2"]);
    }

    #[test]
    fn csv_takes_headings_comments_and_three_separators() {
        let expected =
            Record { title: String::new(), times: vec![0.0, 0.02, 0.05], acceleration: vec![0.25, -1e-3, 3.0] };
        for text in [
            "0,0.25\n0.02,-1e-3\n0.05,3\n",
            "\u{feff}time,acc (g)\r\n0,.25\r\n0.02,-1.00E-03\r\n0.05,3\r\n",
            "# from a shake table\n\ntime [s]; a_g [m/s2]; \n 0 ; 0.25 \n # pause\n0.02;-1d-3\n5e-2;+3\n\n",
            "0.0\t0.25\n0.02\t-0.001\n0.05\t3.0",
        ] {
            assert_eq!(csv(text).unwrap(), expected, "{text}");
        }
        let in_g = Record::from_csv("0,0.25\n1,-1\n", Unit::G, 9.81).unwrap();
        assert_eq!(in_g.acceleration(), [0.25 * 9.81, -9.81]);
    }

    #[test]
    fn a_refused_csv_file_says_what_was_found_on_which_line() {
        assert_eq!(csv_problem(""), "1: the file ends after 0 sample(s); two or more are needed");
        assert_eq!(csv_problem("t,a\n\n0,1\n"), "3: the file ends after 1 sample(s); two or more are needed");
        assert_eq!(csv_problem("# c\n0,1\n\nx,2\n"), "4: the time \"x\" is not a number");
        assert_eq!(csv_problem("0,1\ninf,2\n"), "2: the time \"inf\" is not a number");
        assert_eq!(csv_problem("t,a\nt,a\n"), "2: the time \"t\" is not a number");
        assert_eq!(csv_problem("0,1\n1,NaN\n"), "2: the acceleration \"NaN\" is not a number");
        assert_eq!(csv_problem("0,1\n1,\n"), "2: the acceleration \"\" is not a number");
        assert_eq!(csv_problem("0,O.1\n1,0\n"), "1: the acceleration \"O.1\" is not a number");
        assert_eq!(csv_problem("0,1\n.5,2\n0.5,3\n"), "3: the time 0.5 s does not come after the one before it, 0.5 s");
        assert_eq!(
            csv_problem("0;1\n0,5;2\n"),
            "2: \"0,5;2\" has 3 column(s) instead of time and acceleration with a comma, semicolon or tab between them"
        );
        assert!(csv_problem("0 1\n1 2\n2 3\n").starts_with("2: \"1 2\" has 1 column(s)"));
    }

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
        fs::remove_dir_all(folder).unwrap();
    }

    #[test]
    fn segments_are_linear_between_samples_and_at_rest_after_them() {
        let record = csv("1,2\n2,4\n4,0\n").unwrap().scaled(0.5, 10.0);
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

    /// Any finite value as AT2 files write them: 1.5E-3, -.15D-2, fixed point.
    fn written(value: f64, style: usize) -> String {
        match style {
            0 => format!("{value:e}"),
            1 => format!("{value:E}").replace('E', "D"),
            _ => format!("{value}").replacen("0.", ".", usize::from(value.abs() < 1.0)),
        }
    }

    proptest! {
        #[test]
        fn at2_reads_what_was_written(
            values in prop::collection::vec((-1e3..1e3_f64, 0..3_usize), 2..40),
            columns in 1..9_usize,
            dt in 1e-4..1.0_f64,
            variant in 0..3_usize,
            line_end in prop::sample::select(&["\n", "\r\n"][..]),
        ) {
            let npts = values.len();
            let counts = match variant {
                0 => format!("NPTS= {npts:6}, DT= {dt} SEC,"),
                1 => format!("{npts}    {dt}    NPTS, DT"),
                _ => format!("npts={npts}, dt={dt:e} sec"),
            };
            let words: Vec<_> = values.iter().map(|&(value, style)| written(value, style)).collect();
            let lines: Vec<_> = words.chunks(columns).map(|line| line.join("  ")).collect();
            let text = format!("{PACOIMA}{counts}\n{}\n", lines.join("\n")).replace('\n', line_end);
            let record = Record::from_at2(&text, 1.0).unwrap();
            prop_assert_eq!(record.times(), (0..npts).map(|i| i as f64 * dt).collect::<Vec<_>>());
            prop_assert_eq!(record.acceleration(), values.iter().map(|&(value, _)| value).collect::<Vec<_>>());
        }

        #[test]
        fn csv_reads_what_was_written(
            samples in prop::collection::vec((1e-9..1e3_f64, prop::num::f64::NORMAL), 2..40),
            separator in prop::sample::select(&[",", ";", "\t", " , "][..]),
        ) {
            let mut time = 0.0;
            let mut expected = (Vec::new(), Vec::new());
            let mut text = "time, acceleration\n".to_owned();
            for (step, value) in samples {
                time += step;
                text += &format!("{time}{separator}{value:e}\n");
                expected.0.push(time);
                expected.1.push(value);
            }
            let record = csv(&text).unwrap();
            prop_assert_eq!((record.times, record.acceleration), expected);
        }

        /// A file cut short is refused, unless all that is lost is from its last number on.
        #[test]
        fn a_file_cut_anywhere_is_refused(values in prop::collection::vec(-1.0..1.0_f64, 2..12), cut in 0.0..1.0_f64) {
            let words: Vec<_> = values.iter().map(|value| format!("{value:14.7e}")).collect();
            let text = format!("{PACOIMA}NPTS= {}, DT= .01 SEC\n{}\n", words.len(), words.join("\n"));
            let cut = (cut * text.len() as f64) as usize;
            let record = Record::from_at2(&text[..cut], 9.81);
            prop_assert!(record.is_err() || cut > text.trim_end().rfind('\n').unwrap());
        }

        #[test]
        fn no_bytes_panic(bytes in prop::collection::vec(any::<u8>(), 0..200), values in "[0-9eEdD+. ,;\n-]{0,80}") {
            let text = String::from_utf8_lossy(&bytes);
            let _ = Record::from_csv(&text, Unit::G, 9.81);
            let _ = Record::from_csv(&values, Unit::G, 9.81);
            let _ = Record::from_at2(&text, 9.81);
            let _ = at2("NPTS= 5, DT= .01 SEC", &text);
            let _ = at2("NPTS= 5, DT= .01 SEC", &values);
        }
    }
}
