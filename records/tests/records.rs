//! Every layout of a record's file, whole and damaged.
//!
//! `FUZZ_RECORDS` says how many mutations of files to read (20,000 without it).

mod layouts;

use layouts::{DT, LayoutCase, all, cosmos, samples};
use proptest::prelude::*;
use rocking_records::{Column, FORMATS, Format, Reading, RecordError, Remedy, Unit, UnitFrom, from_bytes};
use std::env;
use std::path::Path;

#[test]
fn every_layout_gives_its_samples_in_its_unit() {
    for LayoutCase { path, bytes, how, format, unit, expected } in all(403) {
        let text = String::from_utf8_lossy(&bytes[..bytes.len().min(200)]).into_owned();
        let (record, source) = from_bytes(&path, &bytes, &how).unwrap_or_else(|error| panic!("{error}: {text}"));
        assert_eq!((source.format, source.unit), (format, unit), "{text}");
        let from = if how.unit.is_some() { UnitFrom::User } else { UnitFrom::File };
        assert_eq!(source.unit_from, from, "{text}");
        assert_eq!(record.times().len(), expected.len(), "{text}");
        for (i, (found, expected)) in record.acceleration().iter().zip(&expected).enumerate() {
            assert!((found - expected).abs() < 1e-7, "{found} {expected}: sample {i} of {text}");
            assert!((record.times()[i] - i as f64 * DT).abs() < 1e-12, "time {i} of {text}");
        }
    }
}

/// A unit or a step that contradicts the file is refused in every layout that states one; a unit overrides a heading.
#[test]
fn what_contradicts_a_file_is_refused() {
    for LayoutCase { path, bytes, how, format, unit, .. } in
        all(40).into_iter().filter(|layout| layout.how.unit.is_none())
    {
        let read = |how: &Reading| from_bytes(&path, &bytes, how);
        assert!(read(&Reading { unit: Some(unit), ..how.clone() }).is_ok());
        match read(&Reading { unit: Some(Unit::MillimetrePerSecondSquared), ..how.clone() }) {
            Ok((_, source)) => {
                assert_eq!((source.format, source.unit_from), ("table", UnitFrom::Overridden(unit)));
                let warning = format!("the heading states {unit}, and the given unit is mm/s2");
                assert_eq!(source.assumption(""), Some(warning));
            }
            Err(refused) => {
                let expected = format!("the file states accelerations in {unit}, but the given unit is mm/s2");
                assert!(format != "table" && refused.to_string().ends_with(&expected), "{refused}");
            }
        }
        if how.dt.is_none() {
            let refused = read(&Reading { dt: Some(2.0 * DT), ..how.clone() }).unwrap_err();
            let expected = format!("a sample every {DT} s, but the given step is {} s", 2.0 * DT);
            assert!(refused.to_string().ends_with(&expected), "{refused}");
        }
    }
}

/// The page shows every row of the table of layouts.
#[test]
fn the_page_lists_every_layout() {
    let page = include_str!("../../docs/howto/records.md");
    for Format { name, unit, step, .. } in FORMATS {
        assert!(page.contains(&format!("\n| {name} | {unit} | {step} |\n")), "{name}");
    }
}

#[test]
fn long_text_before_the_data_is_refused_in_every_layout() {
    for LayoutCase { path, bytes, how, .. } in all(40) {
        let long = ["# no data\n".repeat(500).into_bytes(), bytes].concat();
        let refused = from_bytes(&path, &long, &how).unwrap_err().to_string();
        assert!(refused.ends_with(", line 501: no data after 500 lines: shorten the text before"), "{refused}");
    }
}

/// Of SAC, in the numbers that it does not use.
#[test]
fn the_package_that_reads_a_file_is_named() {
    let sac = "-12345.00 -12345.00 -12345.00 -12345.00 -12345.00\n".repeat(14);
    let refused = from_bytes(Path::new("a.sac"), sac.as_bytes(), &Reading::default()).unwrap_err();
    assert!(matches!(line_of(&refused), (14, Some(Remedy::Python("obspy", _)))), "{refused}");
}

fn line_of(error: &RecordError) -> (usize, Option<Remedy>) {
    match error {
        RecordError::Malformed { line, remedy, .. } => (*line, *remedy),
        other => panic!("{other}"),
    }
}

/// One sample less, or a blank line in the middle, is noticed wherever a file states how many there are, or where they are.
#[test]
fn what_is_missing_is_noticed() {
    for LayoutCase { path, bytes, how, format, .. } in all(80) {
        let text = String::from_utf8(bytes).unwrap().replace("\r\n", "\n");
        let lines: Vec<_> = text.lines().collect();
        let end = lines.iter().position(|line| line.contains("velocity") || line.contains("veloc data"));
        let end = end.unwrap_or(lines.iter().position(|line| line.starts_with("End-of")).unwrap_or(lines.len()));
        let middle = end - 3;
        let read = |lines: &[&str], how: &Reading| from_bytes(&path, lines.join("\n").as_bytes(), how);

        let blank = read(&[&lines[..middle], &["  "], &lines[middle..]].concat(), &how).unwrap_err();
        assert_eq!(line_of(&blank).0, middle + 1, "{format}: {blank}");

        if format == "table" {
            continue;
        }
        let shorter = [&lines[..middle], &lines[middle + 1..]].concat();
        let missing = read(&shorter, &how).unwrap_err();
        assert_eq!(line_of(&missing).1, Some(Remedy::IgnoreCount), "{format}: {missing}");
        let found = read(&shorter, &Reading { ignores_count: true, ..how }).unwrap();
        let remark = found.1.remarks.iter().find(|remark| remark.contains("80 samples")).unwrap();
        assert!(remark.ends_with(&found.0.times().len().to_string()), "{remark}");
    }
}

#[test]
fn a_channel_of_several_is_chosen() {
    let [first, second] = [1.0, -2.0].map(|scale| samples(50).iter().map(|value| scale * value).collect::<Vec<_>>());
    let [north, up] = [&first, &second].map(|values| cosmos("Corrected acceleration", values, true));
    let text = north + &up.replace("Sta Chan  1: 360 deg", "Sta Chan  2: Up     ");
    let how = |column| Reading { column, ..Reading::default() };
    let read = |column| from_bytes(Path::new("two.V2c"), text.as_bytes(), &how(column));
    assert_eq!(line_of(&read(None).unwrap_err()).1, Some(Remedy::Column));
    for (column, number, name, expected) in [
        (Column::Number(1), 1, "360 deg", &first),
        (Column::Number(2), 2, "Up", &second),
        (Column::Heading("360 Deg".into()), 1, "360 deg", &first),
        (Column::Heading("up".into()), 2, "Up", &second),
    ] {
        let (record, source) = read(Some(column)).unwrap();
        let errors = record.acceleration().iter().zip(expected).map(|(found, expected)| (found - expected).abs());
        assert!(errors.fold(0.0, f64::max) < 1e-5, "channel {number}");
        assert_eq!(source.remarks, [format!("channel {number} of 2, {name:?}")]);
    }
    let refused = read(Some(Column::Number(3))).unwrap_err().to_string();
    assert!(refused.ends_with("2 channel(s) (\"360 deg\", \"Up\"), not one 3"), "{refused}");
}

#[test]
fn the_line_before_the_data_of_csmip_may_end_early() {
    let layout = all(50).remove(6);
    let text = String::from_utf8(layout.bytes).unwrap();
    let read = |text: &str| from_bytes(&layout.path, text.as_bytes(), &Reading::default());
    let one = read(&text).unwrap().0;
    let announced = text.lines().find(|line| line.contains("points of accel")).unwrap();
    let other = "50 POINTS OF ACCEL DATA EQUALLY SPACED AT .005 SEC. (UNITS: CM/SEC/SEC)";
    for line in [other, announced.split(" (").next().unwrap()] {
        let (record, source) = read(&text.replace(announced, line)).unwrap();
        assert_eq!((&record, source.unit), (&one, Unit::CentimetrePerSecondSquared), "{line}");
    }
}

/// Counts of the recorder are no accelerations.
#[test]
fn what_is_no_acceleration_is_refused() {
    let raw = cosmos("Raw acceleration counts", &samples(50), false).replace("units=cm/sec2(04)", "units=counts (50)");
    let velocity = String::from_utf8(all(50).remove(2).bytes).unwrap();
    let velocity = velocity.replace("DATA_TYPE: ACCELERATION", "DATA_TYPE: VELOCITY").replace("cm/s^2", "cm/s");
    let cut = "-.10 .11 .20\n.33 .2".to_owned();
    let units = "g, m/s2, cm/s2, gal, mm/s2, in/s2, ft/s2, mg, %g";
    for (text, expected) in [
        (raw, &*format!("the accelerations are in \"counts\", which is none of {units}")),
        (velocity, "DATA_TYPE is \"VELOCITY\", and accelerations are needed"),
        (cut, "ends within the number .2: it was cut, or end the line if the number is whole"),
    ] {
        let refused = from_bytes(Path::new("record"), text.as_bytes(), &Reading::default()).unwrap_err();
        assert!(refused.to_string().ends_with(expected), "{refused}");
    }
}

/// The memory that the file `bytes` may take.
fn bound(bytes: &[u8]) -> u64 {
    const LEAST: u64 = 1 << 16;
    const PER_BYTE: u64 = 64;
    LEAST + PER_BYTE * bytes.len() as u64
}

/// Parts of files and hostile parts, separated by bars.
const WORDS: &str = "\n|\r|\r\n|\n\n| |\t|,|;|\"|'|#|(|[g]|(cm/s2)|)|e|E+999|-|nan|inf|1e308|-1e-320|99999999999999999999|1,5|\
    NPTS= 2, DT= 1e-300 SEC|/s2|_|\u{b2}|\0|\u{2212}|units=| pts acc units=g,(8F0.3)\n|\
    100 Real-header values follow (1F0.0)\n";

/// Bytes that replace some bytes of a file.
fn inserted() -> impl Strategy<Value = Vec<u8>> {
    let words: Vec<_> = WORDS.split('|').collect();
    prop_oneof![
        4 => prop::sample::select(words.clone()).prop_map(|word| word.as_bytes().to_vec()),
        1 => (prop::sample::select(words), 1..100_usize).prop_map(|(word, times)| word.repeat(times).into_bytes()),
        3 => prop::collection::vec(any::<u8>(), 0..3),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: env::var("FUZZ_RECORDS").map_or(20_000, |count| count.parse().expect("FUZZ_RECORDS is a number")),
        ..ProptestConfig::default()
    })]

    /// No panic; what is read is a record; memory is bounded by the file's size.
    #[test]
    fn no_mutation_does_harm(
        layout in prop::sample::select(all(37)),
        changes in prop::collection::vec((any::<prop::sample::Index>(), 0..60_usize, inserted()), 1..6),
        unit in prop::option::weighted(0.1, prop::sample::select(&Unit::NAMES[..])),
        column in prop::option::weighted(0.1, prop::sample::select(&[Column::All, Column::Number(1), Column::Number(3)][..])),
        has_step in prop::bool::weighted(0.1),
        ignores_count in prop::bool::weighted(0.1),
        is_named in prop::bool::weighted(0.9),
    ) {
        let LayoutCase { path, mut bytes, how, .. } = layout;
        for (at, removed, inserted) in changes {
            let at = at.index(bytes.len() + 1);
            bytes.splice(at..bytes.len().min(at + removed), inserted);
        }
        let how = Reading {
            unit: unit.map(|(_, unit)| unit).or(how.unit),
            dt: has_step.then_some(DT).or(how.dt),
            column: column.or(how.column),
            ignores_count,
        };
        let path = if is_named { path } else { "any.csv".into() };
        let mut result = None;
        let counted = allocation_counter::measure(|| result = Some(from_bytes(&path, &bytes, &how)));
        prop_assert!(counted.bytes_max <= bound(&bytes), "{} bytes of memory", counted.bytes_max);
        if let Some(Ok((record, _))) = result {
            let (times, acceleration) = (record.times(), record.acceleration());
            prop_assert!(times.len() >= 2 && times.len() == acceleration.len() && times.len() <= bytes.len());
            prop_assert!(times.windows(2).all(|pair| pair[1] > pair[0]) && times[times.len() - 1].is_finite());
            prop_assert!(acceleration.iter().all(|value| value.is_finite()));
        }
    }
}

/// The reader never reads the whole again for each part: memory and time stay in bounds.
#[test]
fn a_large_file_of_anything_stays_in_bounds() {
    const SIZE: usize = 1 << 18;
    for LayoutCase { path, bytes, how, .. } in all(10) {
        for word in WORDS.split('|') {
            let hostile = [&bytes[..bytes.len() * 2 / 3], word.repeat(SIZE / word.len()).as_bytes()].concat();
            let counted = allocation_counter::measure(|| drop(from_bytes(&path, &hostile, &how)));
            assert!(counted.bytes_max <= bound(&hostile), "{}, {word:?}: {}", path.display(), counted.bytes_max);
        }
    }
}
