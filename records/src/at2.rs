//! AT2, the acceleration records of PEER.

use super::parsed::{Parsed, Times};
use super::sampling::Sampling;
use super::text::{numbered, quote};
use super::unit::Stated;
use super::{BadLine, Format, Reading, Unit, bad, source::decide};

/// Whether `text` is one of these files.
pub(super) fn is_its(text: &str) -> bool {
    text.lines().nth(2).is_some_and(|line| check_unit(line).is_ok()) && text.lines().nth(3).is_some_and(is_counts)
}

fn is_counts(line: &str) -> bool {
    line.to_uppercase().contains("NPTS")
}

/// A title on line 2, the unit on line 3, NPTS and DT on line 4, then NPTS accelerations.
pub(super) fn parse(text: &str, how: &Reading) -> Result<Parsed, BadLine> {
    const HEADER_LINES: usize = 4;
    let header: Vec<_> = text.lines().take(HEADER_LINES).collect();
    let &[_, title, unit, counts] = header.as_slice() else {
        return Err(bad(header.len().max(1), "the file ends within the four header lines of an AT2 file"));
    };
    check_unit(unit).map_err(|problem| bad(3, problem))?;
    let (unit, unit_from) = decide(&Stated::Unit(Unit::G), how.unit, 3)?;
    let Sampling { npts: Some(npts), dt: Some(dt) } = Sampling::of(4, counts)? else {
        let expected = "`NPTS= 4172, DT= .0100 SEC` or `4172 0.0100 NPTS, DT`";
        return Err(bad(4, format!("found {} where an AT2 file states {expected}", quote(counts))));
    };

    let mut parsed = Parsed::new(Format::At2, title.trim(), unit, unit_from, Times::Every(dt));
    parsed.read(numbered(text).skip(HEADER_LINES), None)?;
    parsed.check_count("NPTS", npts, how)?;
    Ok(parsed)
}

/// `ACCELERATION TIME SERIES IN UNITS OF G` or `ACCELERATION TIME HISTORY IN UNITS OF G. FILTER ...`.
fn check_unit(line: &str) -> Result<(), String> {
    let upper = line.to_uppercase();
    let unit = upper.split_once("UNITS OF").and_then(|(_, rest)| rest.split_whitespace().next());
    if upper.contains("ACCELERATION") && unit.is_some_and(|unit| unit.trim_end_matches(['.', ',', ';']) == "G") {
        Ok(())
    } else {
        Err(format!("found {} where an AT2 file states ACCELERATION ... IN UNITS OF G", quote(line)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Record;

    const PACOIMA: &str = "PEER NGA STRONG MOTION DATABASE RECORD\n\
        San Fernando, 2/9/1971, Pacoima Dam (upper left abut), 164\n\
        ACCELERATION TIME SERIES IN UNITS OF G\n";

    /// The counts of every header variant, and what they say.
    const COUNTS: [(&str, usize, f64); 9] = [
        ("NPTS=   3, DT=   .0100 SEC,                    ", 3, 0.01),
        ("NPTS=     3  DT=  0.0050 SEC,", 3, 0.005),
        ("NPTS= 3 DT= 0.0050000", 3, 0.005),
        ("NPTS=3,DT=.02SEC", 3, 0.02),
        ("  3    0.0100    NPTS, DT", 3, 0.01),
        ("3, .5 NPTS, DT", 3, 0.5),
        ("npts=   3, dt=   5.0e-3 sec", 3, 0.005),
        ("\tNPTS =\t3 ,\tDT =\t1D-2\tSEC", 3, 0.01),
        ("NPTS= 3, DT= .01 SEC, UNITS=G", 3, 0.01),
    ];

    fn read(text: &str, how: &Reading) -> Result<Record, BadLine> {
        Ok(parse(text, how)?.record(how)?.0)
    }

    fn at2(counts: &str, values: &str) -> Result<Record, BadLine> {
        read(&format!("{PACOIMA}{counts}\n{values}"), &Reading::default())
    }

    fn at2_problem(counts: &str, values: &str) -> String {
        let BadLine { line, problem, .. } = at2(counts, values).unwrap_err();
        format!("{line}: {problem}")
    }

    #[test]
    fn every_header_variant_gives_the_same_samples() {
        for (counts, npts, dt) in COUNTS {
            let record = at2(counts, " .1297983E-02\t-.4E-03\n1.2d-03  \n\n \n").unwrap();
            assert_eq!(record.title(), "San Fernando, 2/9/1971, Pacoima Dam (upper left abut), 164");
            assert_eq!(record.times(), (0..npts).map(|i| i as f64 * dt).collect::<Vec<_>>(), "{counts}");
            assert_eq!(record.acceleration(), [0.1297983e-2, -0.4e-3, 1.2e-3], "{counts}");
        }
    }

    #[test]
    fn the_unit_line_must_state_acceleration_in_g() {
        assert_eq!(check_unit("ACCELERATION TIME HISTORY IN UNITS OF G. FILTER POINTS: HP=0.1 Hz LP=30.0 Hz"), Ok(()));
        for refused in ["VELOCITY TIME SERIES IN UNITS OF CM/S", "ACCELERATION TIME SERIES IN UNITS OF GAL", ""] {
            assert!(check_unit(refused).is_err(), "{refused}");
        }
    }

    #[test]
    fn a_refused_at2_file_says_what_was_found_on_which_line() {
        const THREE: &str = "NPTS= 3, DT= .01 SEC";
        assert_eq!(read("", &Reading::default()).unwrap_err().line, 1);
        let ends = "the file ends within the four header lines of an AT2 file";
        assert_eq!(read(PACOIMA, &Reading::default()), Err(bad(3, ends)));
        assert_eq!(at2_problem(THREE, ".1 .2\n\n"), "5: NPTS states 3 samples, and the file has 2");
        assert_eq!(at2_problem(THREE, ""), "1: NPTS states 3 samples, and the file has 0");
        assert_eq!(at2_problem(THREE, ".1\n.2\n.3 .4\n"), "7: NPTS states 3 samples, and the file has 4");
        for not_a_number in ["x", "1.2.3", "********", "nan", "-inf", "1e999", ".1-.2", "1E-", "1e308", "ÿ"] {
            assert_eq!(
                at2_problem(THREE, &format!(".1\n {not_a_number}\n.3\n")),
                format!("6: the acceleration {not_a_number:?} is not a number")
            );
        }
        assert_eq!(at2_problem("NPTS= 1, DT= .01 SEC", ".1"), "4: NPTS = \"1\" must be a whole number, 2 to 10000000");
        assert_eq!(at2_problem("3.5 .01 NPTS, DT", ".1"), "4: NPTS = \"3.5\" must be a whole number, 2 to 10000000");
        for dt in ["0.0", "-.01", "1E308", "0X"] {
            assert_eq!(
                at2_problem(&format!("NPTS= 3, DT= {dt} SEC"), ".1 .2 .3"),
                format!("4: DT = \"{dt} SEC\" must be a number of seconds greater than 0")
            );
        }
        assert_eq!(
            at2_problem("NPTS= 3, DT= X", ".1 .2 .3"),
            "4: found \"NPTS= 3, DT= X\" where an AT2 file states \
             `NPTS= 4172, DT= .0100 SEC` or `4172 0.0100 NPTS, DT`"
        );
        assert_eq!(
            at2_problem(THREE, &"9".repeat(400)),
            format!("5: the acceleration \"{}\"... is not a number", "9".repeat(40))
        );
    }
}
