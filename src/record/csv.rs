//! CSV: lines of time and acceleration.

use super::{BadLine, MAX_SAMPLES, Record, Unit, bad, in_m_s2, number, numbered, quote};

/// Time (s) and acceleration on each line, after at most one line of headings; `#` begins a comment line.
pub(super) fn parse(text: &str, unit: Unit, g: f64) -> Result<Record, BadLine> {
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
            return Err(bad(line, format!("{found} column(s) instead of {expected}")));
        };
        let time = number(time).ok_or_else(|| bad(line, format!("the time {} is not a number", quote(time))))?;
        if let Some(before) = times.last().filter(|before| time <= **before) {
            return Err(bad(line, format!("the time {time} s does not come after the one before it, {before} s")));
        }
        if times.len() == MAX_SAMPLES {
            return Err(bad(line, format!("more than {MAX_SAMPLES} samples")));
        }
        times.push(time);
        acceleration.push(in_m_s2(value, unit_in_m_s2).map_err(|problem| bad(line, problem))?);
    }
    if times.len() < 2 {
        return Err(bad(last_line, format!("the file ends after {} sample(s); two or more are needed", times.len())));
    }
    Ok(Record { title: String::new(), times, acceleration })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn csv(text: &str) -> Result<Record, BadLine> {
        parse(text, Unit::MetrePerSecondSquared, 10.0)
    }

    fn csv_problem(text: &str) -> String {
        let BadLine { line, problem } = csv(text).unwrap_err();
        format!("{line}: {problem}")
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
        let in_g = parse("0,0.25\n1,-1\n", Unit::G, 9.81).unwrap();
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
            "2: 3 column(s) instead of time and acceleration with a comma, semicolon or tab between them"
        );
        assert!(csv_problem("0 1\n1 2\n2 3\n").starts_with("2: 1 column(s) instead"));
    }

    proptest! {
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

        #[test]
        fn no_bytes_panic(bytes in prop::collection::vec(any::<u8>(), 0..200), values in "[0-9eEdD+. ,;\n-]{0,80}") {
            let _ = parse(&String::from_utf8_lossy(&bytes), Unit::G, 9.81);
            let _ = parse(&values, Unit::G, 9.81);
        }
    }
}
