//! Every layout of a record's file, whole and damaged.
//!
//! `FUZZ_RECORDS` says how many mutations of files to read (`make fuzz`: ten million). What a mutation is follows from its
//! number alone, and a failure names it.

mod layouts;

use fastrand::Rng;
use layouts::{DT, Layout, all, cosmos, samples};
use rocking_records::{Column, Reading, RecordError, Remedy, Unit, UnitFrom};
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};
use std::{env, thread};

#[test]
fn every_layout_gives_its_samples_in_its_unit() {
    for Layout { path, bytes, how, format, unit, expected } in all(403) {
        let text = String::from_utf8_lossy(&bytes[..bytes.len().min(200)]).into_owned();
        let (record, source) =
            rocking_records::from_bytes(&path, &bytes, &how).unwrap_or_else(|error| panic!("{error}: {text}"));
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

/// A unit or a step that contradicts the file is refused in every layout that states one.
#[test]
fn what_contradicts_a_file_is_refused() {
    for Layout { path, bytes, how, unit, .. } in all(40).into_iter().filter(|layout| layout.how.unit.is_none()) {
        let read = |how: &Reading| rocking_records::from_bytes(&path, &bytes, how);
        assert!(read(&Reading { unit: Some(unit), ..how.clone() }).is_ok());
        let refused = read(&Reading { unit: Some(Unit::MillimetrePerSecondSquared), ..how.clone() }).unwrap_err();
        let expected = format!("the file states accelerations in {unit}, and mm/s2 is asked for");
        assert!(refused.to_string().ends_with(&expected), "{refused}");
    }
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
    for Layout { path, bytes, how, format, .. } in all(80) {
        let text = String::from_utf8(bytes).unwrap().replace("\r\n", "\n");
        let lines: Vec<_> = text.lines().collect();
        let end = lines.iter().position(|line| line.contains("velocity") || line.contains("veloc data"));
        let end = end.unwrap_or(lines.iter().position(|line| line.starts_with("End-of")).unwrap_or(lines.len()));
        let middle = end - 3;
        let read = |lines: &[&str], how: &Reading| rocking_records::from_bytes(&path, lines.join("\n").as_bytes(), how);

        let blank = read(&[&lines[..middle], &["  "], &lines[middle..]].concat(), &how).unwrap_err();
        assert_eq!(line_of(&blank).0, middle + 1, "{format}: {blank}");

        let shorter = [&lines[..middle], &lines[middle + 1..]].concat();
        let missing = read(&shorter, &how);
        if matches!(format, rocking_records::Format::Table) {
            continue;
        }
        let missing = missing.unwrap_err();
        assert_eq!(line_of(&missing).1, Some(Remedy::IgnoreCount), "{format}: {missing}");
        let found = read(&shorter, &Reading { ignores_count: true, ..how }).unwrap();
        let remark = found.1.remarks.iter().find(|remark| remark.contains("80 samples")).unwrap();
        assert!(remark.ends_with(&found.0.times().len().to_string()), "{remark}");
    }
}

#[test]
fn a_channel_of_several_is_chosen() {
    let [first, second] = [1.0, -2.0].map(|scale| samples(50).iter().map(|value| scale * value).collect::<Vec<_>>());
    let text = [&first, &second].map(|values| cosmos("Corrected acceleration", values, true)).concat();
    let read = |column| {
        let how = Reading { column, ..Reading::default() };
        rocking_records::from_bytes(Path::new("two.V2c"), text.as_bytes(), &how)
    };
    assert_eq!(line_of(&read(None).unwrap_err()).1, Some(Remedy::Channel));
    for (number, expected) in [(1, &first), (2, &second)] {
        let (record, source) = read(Some(Column::Number(number))).unwrap();
        let errors = record.acceleration().iter().zip(expected).map(|(found, expected)| (found - expected).abs());
        assert!(errors.fold(0.0, f64::max) < 1e-5, "channel {number}");
        assert_eq!(source.remarks, [format!("channel {number} of 2")]);
    }
    assert!(read(Some(Column::Number(3))).is_err());
}

#[test]
fn a_channel_of_csmip_is_chosen_and_its_line_may_end_early() {
    let layout = all(50).remove(6);
    let text = String::from_utf8(layout.bytes).unwrap();
    let read = |text: &str, how: &Reading| rocking_records::from_bytes(&layout.path, text.as_bytes(), how);
    let one = read(&text, &Reading::default()).unwrap().0;
    let three = text.repeat(3);
    assert_eq!(line_of(&read(&three, &Reading::default()).unwrap_err()).1, Some(Remedy::Channel));
    let second = Reading { column: Some(Column::Number(2)), ..Reading::default() };
    assert_eq!(read(&three, &second).unwrap().0.acceleration(), one.acceleration());

    let announced = text.lines().find(|line| line.contains("points of accel")).unwrap();
    let start = "50 POINTS OF ACCEL DATA EQUALLY SPACED AT .005 SEC.";
    let gal = Reading { unit: Some(Unit::CentimetrePerSecondSquared), ..Reading::default() };
    for (line, how) in [
        (format!("{start} (UNITS: CM/SEC/SEC)"), Reading::default()),
        (announced.split(" (").next().unwrap().to_owned(), Reading::default()),
        (start.to_owned(), gal),
    ] {
        let (record, source) = read(&text.replace(announced, &line), &how).unwrap();
        assert_eq!((&record, source.unit), (&one, Unit::CentimetrePerSecondSquared), "{line}");
    }
    let unknown = read(&text.replace(announced, start), &Reading::default()).unwrap_err();
    assert_eq!(line_of(&unknown).1, Some(Remedy::Unit));
}

/// Where the largest count is the stated maximum there is no offset; a maximum that is neither is told.
#[test]
fn the_stated_maximum_tells_whether_there_is_an_offset() {
    let layout = all(50).remove(3);
    let text = String::from_utf8(layout.bytes).unwrap();
    let start = text.find("Memo.").unwrap() + "Memo.             \n".len();
    let read = |maximum: &str| {
        let (before, line) = text[..start].split_once("Max. Acc. (gal)").unwrap();
        let (_, after) = line.split_once('\n').unwrap();
        let header = format!("{before}Max. Acc. (gal)   {maximum}\n{after}").replace("Time(s)  0.25", "Time(s)  0.02");
        let text = header + "     1000     3000     1000     1000\n";
        rocking_records::from_bytes(&layout.path, text.as_bytes(), &layout.how).unwrap()
    };
    let gal = 3920.0 / 6182761.0;
    let counts = |values: [f64; 4]| values.map(|count| count * gal);
    for (maximum, expected, remarks) in [
        ("1.902", counts([1000.0, 3000.0, 1000.0, 1000.0]), 0),
        ("0.951", counts([-500.0, 1500.0, -500.0, -500.0]), 1),
        ("7", counts([-500.0, 1500.0, -500.0, -500.0]), 2),
    ] {
        let (record, source) = read(maximum);
        let errors = record.acceleration().iter().zip(expected).map(|(found, expected)| (found - expected).abs());
        assert!(errors.fold(0.0, f64::max) < 1e-12, "{maximum}: {:?}", record.acceleration());
        assert_eq!(source.remarks.len(), remarks, "{:?}", source.remarks);
    }
}

/// Counts of the recorder are no accelerations.
#[test]
fn what_is_no_acceleration_is_refused() {
    let raw = cosmos("Raw acceleration counts", &samples(50), false).replace("units=cm/sec2(04)", "units=counts (50)");
    let velocity = String::from_utf8(all(50).remove(2).bytes).unwrap();
    let velocity = velocity.replace("DATA_TYPE: ACCELERATION", "DATA_TYPE: VELOCITY").replace("cm/s^2", "cm/s");
    for (name, text, expected) in [
        (
            "raw.V0",
            raw,
            "the accelerations are in \"counts\", which is none of g, m/s2, cm/s2, gal, mm/s2, in/s2, ft/s2, mg, %g",
        ),
        ("vel.ASC", velocity, "DATA_TYPE is \"VELOCITY\", and accelerations are needed"),
    ] {
        let refused = rocking_records::from_bytes(Path::new(name), text.as_bytes(), &Reading::default()).unwrap_err();
        assert!(refused.to_string().ends_with(expected), "{refused}");
    }
}

/// Mutations without `FUZZ_RECORDS`.
const MUTATIONS: u64 = 40_000;

/// No panic; what is read is a record; memory is bounded by the file's size.
#[test]
fn no_mutation_does_harm() {
    let mutations =
        env::var("FUZZ_RECORDS").map_or(MUTATIONS, |count| count.parse().expect("FUZZ_RECORDS is a number"));
    let layouts = all(37);
    let next = AtomicU64::new(0);
    let work = || {
        let mut read = 0;
        loop {
            let number = next.fetch_add(1, Ordering::Relaxed);
            if number >= mutations {
                return read;
            }
            read += u64::from(survives(&layouts, number));
        }
    };
    let cores = thread::available_parallelism().map_or(1, usize::from);
    let read: u64 = thread::scope(|scope| {
        let threads: Vec<_> = (0..cores).map(|_| scope.spawn(work)).collect();
        threads.into_iter().map(|thread| thread.join().expect("the panic is above")).sum()
    });
    println!("{mutations} mutations, {read} of them still records");
    assert!(read > mutations / 50 && read < mutations, "{read} of {mutations} are records");
}

/// The memory that the file `bytes` may take.
fn bound(bytes: &[u8]) -> u64 {
    const LEAST: u64 = 1 << 16;
    const PER_BYTE: u64 = 64;
    LEAST + PER_BYTE * bytes.len() as u64
}

/// Reads the mutation called `number`, and says whether it is a record.
fn survives(layouts: &[Layout], number: u64) -> bool {
    let mut rng = Rng::with_seed(number);
    let layout = rng.choice(layouts).unwrap();
    let (mut bytes, mut how) = (layout.bytes.clone(), layout.how.clone());
    for _ in 0..rng.usize(1..6) {
        mutate(&mut bytes, &mut rng);
    }
    if rng.u8(..4) == 0 {
        how.ignores_count = rng.bool();
        how.unit = rng.choice(Unit::NAMES).map(|(_, unit)| unit).filter(|_| rng.bool());
        how.dt = rng.bool().then_some(DT);
        let column = [Column::All, Column::Number(rng.usize(1..5))];
        how.column = rng.bool().then(|| rng.choice(column)).flatten();
    }
    let path = if rng.u8(..8) == 0 { Path::new("any.csv") } else { &layout.path };
    let mut result = None;
    let counted = allocation_counter::measure(|| result = Some(rocking_records::from_bytes(path, &bytes, &how)));
    assert!(counted.bytes_max <= bound(&bytes), "mutation {number}: {} bytes of memory", counted.bytes_max);
    let Some(Ok((record, _))) = result else { return false };
    let (times, acceleration) = (record.times(), record.acceleration());
    assert!(times.len() >= 2 && times.len() == acceleration.len() && times.len() <= bytes.len(), "mutation {number}");
    assert!(times.windows(2).all(|pair| pair[1] > pair[0]) && times[times.len() - 1].is_finite(), "mutation {number}");
    assert!(acceleration.iter().all(|value| value.is_finite()), "mutation {number}");
    true
}

/// What files have in them, and what is meant to hurt.
const WORDS: [&[u8]; 36] = [
    b"\n",
    b"\r",
    b"\r\n",
    b"\n\n",
    b" ",
    b"\t",
    b",",
    b";",
    b"\"",
    b"'",
    b"#",
    b"(",
    b"[g]",
    b"(cm/s2)",
    b")",
    b"e",
    b"E+999",
    b"-",
    b"nan",
    b"inf",
    b"1e308",
    b"-1e-320",
    b"99999999999999999999",
    b"0",
    b".",
    b"1,5",
    b"NPTS= 2, DT= 1e-300 SEC",
    b"/s2",
    b"_",
    b"\xc2\xb2",
    b"\xff",
    b"\0",
    b"\xe2\x88\x92",
    b"units=",
    b" pts acc units=g,(8F0.3)\n",
    b"100 Real-header values follow (1F0.0)\n",
];

fn mutate(bytes: &mut Vec<u8>, rng: &mut Rng) {
    const LARGEST: usize = 1 << 14;
    if bytes.is_empty() {
        bytes.extend(b"0,1\n1,2\n");
    }
    let at = rng.usize(..bytes.len());
    let range = |rng: &mut Rng, len: usize| at..len.min(at + 1 + rng.usize(..60));
    match rng.u8(..9) {
        0 => bytes[at] = rng.u8(..),
        1 => bytes[at] ^= 1 << rng.u8(..8),
        2 => drop(bytes.drain(range(rng, bytes.len()))),
        3 => bytes.truncate(at),
        4 => {
            let part = bytes[range(rng, bytes.len())].to_vec();
            let to = rng.usize(..bytes.len());
            bytes.splice(to..to, part);
        }
        5 => {
            let word = rng.choice(WORDS).unwrap();
            let times = if rng.u8(..20) == 0 { rng.usize(1..100) } else { 1 };
            bytes.splice(at..at, word.repeat(times));
        }
        6 => {
            let replaced = range(rng, bytes.len());
            bytes.splice(replaced, rng.choice(WORDS).unwrap().iter().copied());
        }
        7 => {
            let mut lines: Vec<_> = bytes.split(|byte| *byte == b'\n').map(<[u8]>::to_vec).collect();
            let (one, other) = (rng.usize(..lines.len()), rng.usize(..lines.len()));
            lines.swap(one, other);
            *bytes = lines.join(&b'\n');
        }
        _ => {
            if let Some(digit) = bytes[at..].iter_mut().find(|byte| byte.is_ascii_digit()) {
                *digit = b'0' + rng.u8(..10);
            }
        }
    }
    bytes.truncate(LARGEST);
}

/// Nothing is read again for each of its parts: memory stays in bounds, and so does time, or this would never end.
#[test]
fn a_large_file_of_anything_stays_in_bounds() {
    const SIZE: usize = 1 << 18;
    for Layout { path, bytes, how, .. } in all(10) {
        for word in WORDS {
            let hostile = [&bytes[..bytes.len() * 2 / 3], &word.repeat(SIZE / word.len())].concat();
            let counted = allocation_counter::measure(|| drop(rocking_records::from_bytes(&path, &hostile, &how)));
            assert!(counted.bytes_max <= bound(&hostile), "{}, {word:?}: {}", path.display(), counted.bytes_max);
        }
    }
}
