//! Columns of text: times and accelerations, or accelerations alone, with a comma, a semicolon, a tab or blanks between
//! them, after any lines of text.

use super::parsed::{Parsed, Times};
use super::text::{acceleration, number, numbered, quote, without_blanks};
use super::unit::{Stated, bracketed, is_like_a_unit, seconds};
use super::{BadLine, Column, Format, Reading, Remedy, Unit, bad, source::decide};
use std::borrow::Cow;

const LONGEST_HEADER: usize = 1000;

/// How the fields of a line are told apart, and what stands before the digits after the point.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Layout {
    /// None for blanks.
    separator: Option<char>,
    decimal_comma: bool,
}

/// Time (s) and acceleration on each line, or as `how` says; `#` begins a comment line.
pub(super) fn parse(text: &str, how: &Reading) -> Result<Parsed, BadLine> {
    let mut beginning = numbered(text).take(LONGEST_HEADER);
    let Some((first, sample)) = beginning.find(|(_, line)| !is_comment(line) && is_sample(line)) else {
        let last = text.lines().take(LONGEST_HEADER).count().max(1);
        return Err(bad(last, "no line of numbers up to here; two or more samples are needed"));
    };
    let layout = Layout::of(numbered(text).skip(first - 1).map(|(_, line)| line).filter(|line| !is_comment(line)), how);
    let fields = layout.fields(sample);
    let count = if fields.len() > 1 && fields.ends_with(&[""]) { fields.len() - 1 } else { fields.len() };
    let before: Vec<&str> = text.lines().take(first - 1).filter(|line| !line.trim().is_empty()).collect();
    let rows: Vec<_> = before.iter().map(|line| layout.headings(line)).filter(|cells| cells.len() == count).collect();
    let headings = rows.iter().rev().find(|cells| !cells.iter().all(|cell| is_unit(cell))).cloned().unwrap_or_default();
    let (time, value) = columns(count, &headings, how).map_err(|problem| problem.at(first))?;
    let stated = stated(&before, &layout, count, value).map_err(|problem| bad(first, problem))?;
    let is_unclear = matches!(&stated, Stated::Other(other) if !is_like_a_unit(other));
    let contradiction = |problem| BadLine { remedy: is_unclear.then_some(Remedy::Unit), ..bad(first, problem) };
    let (unit, unit_from) = decide(&stated, how.unit).map_err(contradiction)?;
    let second =
        time.map_or(Ok(1.0), |time| time_unit(&rows, &headings, time)).map_err(|problem| bad(first, problem))?;

    let times = how.dt.map_or(Times::At(Vec::new()), Times::Asked);
    let mut parsed = Parsed::new(Format::Table, "", unit, unit_from, times);
    parsed.remark(layout.to_string());
    if count > 1 {
        let name = headings.get(value).map_or(String::new(), |name| format!(" {}", quote(name)));
        parsed.remark(format!("column {}{name}", value + 1));
    }
    if !before.is_empty() {
        parsed.remark(format!("{} line(s) of text before the data", before.len()));
    }
    let data = numbered(text).skip(first - 1).filter(|(_, line)| !is_comment(line));
    for line in without_blanks(data) {
        let (line, sample) = line?;
        let fields = layout.fields(sample);
        let is_ended = fields.len() == count + 1 && fields[count].is_empty();
        if fields.len() != count && !is_ended {
            let found = fields.len();
            return Err(bad(line, format!("{found} column(s) instead of {count} as on line {first}")));
        }
        parsed.add(acceleration(&layout.plain(fields[value])), line)?;
        if let (Some(time), Times::At(times)) = (time, &mut parsed.times) {
            let field = fields[time];
            let at = number(&layout.plain(field)).map(|time| time * second);
            let at = at.ok_or_else(|| bad(line, format!("the time {} is not a number", quote(field))))?;
            if let Some(before) = times.last().filter(|before| at <= **before) {
                return Err(bad(
                    line,
                    format!("the time {at:?} s does not come after the one before it, {before:?} s"),
                ));
            }
            times.push(at);
        }
    }
    Ok(parsed)
}

fn is_comment(line: &str) -> bool {
    line.trim_start().starts_with('#')
}

/// Whether `line` is meant as a sample, right or wrong: most of its fields are numbers, however they are separated, or one
/// of two, and it is not a name and a number.
fn is_sample(line: &str) -> bool {
    let fields = split(line, |letter| letter.is_whitespace() || matches!(letter, ',' | ';'));
    let fields: Vec<_> = fields.into_iter().map(unquoted).filter(|field| !field.is_empty()).collect();
    let is_number = |field: &&&str| number(&field.replace(',', ".")).is_some();
    let numbers = fields.iter().filter(is_number).count();
    let is_name_and_number = !fields.first().as_ref().is_some_and(is_number) && !line.contains([',', ';', '\t']);
    2 * numbers > fields.len() || (numbers == 1 && fields.len() == 2 && !is_name_and_number)
}

/// What is between separators that stand in no quotes.
fn split(line: &str, is_separator: impl Fn(char) -> bool) -> Vec<&str> {
    let (mut fields, mut start, mut quoted) = (Vec::new(), 0, false);
    for (index, letter) in line.char_indices() {
        if letter == '"' {
            quoted = !quoted;
        } else if !quoted && is_separator(letter) {
            fields.push(&line[start..index]);
            start = index + letter.len_utf8();
        }
    }
    fields.push(&line[start..]);
    fields
}

fn unquoted(field: &str) -> &str {
    let field = field.trim();
    let within = |quote| field.strip_prefix(quote).and_then(|field| field.strip_suffix(quote));
    within('"').or(within('\'')).unwrap_or(field).trim()
}

impl Layout {
    /// That of lines of numbers. A semicolon or a tab separates wherever there is one; a comma separates unless what it
    /// would separate is no number, or the user says that there is one column and a line has one comma and no point.
    fn of<'a>(lines: impl Iterator<Item = &'a str>, how: &Reading) -> Layout {
        const LOOKED_AT: usize = 1000;
        let lines: Vec<_> = lines.filter(|line| !line.trim().is_empty()).take(LOOKED_AT).collect();
        let separator = [';', '\t'].into_iter().find(|separator| lines[0].contains(*separator));
        let separated = |separator| Layout { separator, decimal_comma: false };
        if let Some(separator) = separator {
            let is_decimal = |line: &&str| line.contains(',') && !line.contains('.');
            return Layout { decimal_comma: lines.iter().any(is_decimal), ..separated(Some(separator)) };
        }
        let outside_quotes = |line: &str| split(line, |letter| letter == ',').len() - 1;
        if lines.iter().all(|line| outside_quotes(line) == 0) {
            // a comma that stands in quotes alone is one before decimals
            return Layout { decimal_comma: lines.iter().any(|line| line.contains(',')), ..separated(None) };
        }
        let between_commas = |line: &&str| {
            split(line, |letter| letter == ',')
                .into_iter()
                .map(unquoted)
                .all(|field| field.is_empty() || !field.contains(char::is_whitespace))
        };
        let is_one_number = |line: &&str| outside_quotes(line) <= 1 && !line.contains(['.', '"']);
        let is_one_column = how.dt.is_some() && how.column.is_none() && lines.iter().all(is_one_number);
        if is_one_column || !lines.iter().all(between_commas) {
            return Layout { separator: None, decimal_comma: true };
        }
        let is_decimal = |line: &&str| split(line, |letter| letter == ',').iter().any(|field| field.contains(','));
        Layout { decimal_comma: lines.iter().any(is_decimal), ..separated(Some(',')) }
    }

    fn fields<'a>(&self, line: &'a str) -> Vec<&'a str> {
        let fields = match self.separator {
            Some(separator) => split(line, |letter| letter == separator),
            None => split(line.trim(), char::is_whitespace).into_iter().filter(|field| !field.is_empty()).collect(),
        };
        fields.into_iter().map(unquoted).collect()
    }

    /// The fields of a line of headings, which may be a comment.
    fn headings(&self, line: &str) -> Vec<String> {
        let line = line.trim_start().trim_start_matches(['#', '%', '!', '/']);
        self.fields(line).into_iter().map(str::to_owned).collect()
    }

    /// A number as Rust writes it.
    fn plain<'a>(&self, field: &'a str) -> Cow<'a, str> {
        if self.decimal_comma { Cow::Owned(field.replacen(',', ".", 1)) } else { Cow::Borrowed(field) }
    }
}

impl std::fmt::Display for Layout {
    fn fmt(&self, out: &mut std::fmt::Formatter) -> std::fmt::Result {
        let separator = match self.separator {
            Some(';') => "semicolons",
            Some('\t') => "tabs",
            Some(_) => "commas",
            None => "blanks",
        };
        let comma = if self.decimal_comma { ", decimal comma" } else { "" };
        write!(out, "separated by {separator}{comma}")
    }
}

/// What keeps the columns from being known.
struct Unclear {
    problem: String,
    remedy: Option<Remedy>,
}

impl Unclear {
    fn at(self, line: usize) -> BadLine {
        BadLine { line, problem: self.problem, remedy: self.remedy }
    }
}

/// The columns of times, if it is needed, and of accelerations, of `count`.
fn columns(count: usize, headings: &[String], how: &Reading) -> Result<(Option<usize>, usize), Unclear> {
    let unclear = |problem: String, remedy| Unclear { problem, remedy };
    let is_time = |heading: &String| {
        let name = heading.to_lowercase();
        name == "t"
            || name.starts_with("time")
            || name.starts_with("t ")
            || name.starts_with("t[")
            || name.starts_with("t(")
    };
    let time = headings.iter().position(is_time).unwrap_or(0);
    let value = match &how.column {
        Some(Column::Number(number)) if (1..=count).contains(number) => number - 1,
        Some(Column::Number(number)) => {
            return Err(unclear(format!("column {number} is asked for, and there are {count}"), None));
        }
        Some(Column::Heading(asked)) => with_heading(asked, headings).map_err(|problem| unclear(problem, None))?,
        None if count == 1 => 0,
        None if count == 2 && how.dt.is_none() => 1 - time.min(1),
        None => {
            let names = headings.iter().map(|heading| quote(heading)).collect::<Vec<_>>().join(", ");
            let names = if names.is_empty() { names } else { format!(" ({names})") };
            return Err(unclear(
                format!("{count} columns{names}: which has the accelerations is not known"),
                Some(Remedy::Column),
            ));
        }
    };
    match how.dt {
        Some(_) => Ok((None, value)),
        None if count == 1 => {
            Err(unclear("one column: the time between its samples is not known".into(), Some(Remedy::Step)))
        }
        None if value == time => {
            let number = value + 1;
            Err(unclear(
                format!("column {number} has the times, and cannot have the accelerations"),
                Some(Remedy::Step),
            ))
        }
        None => Ok((Some(time), value)),
    }
}

/// The column whose heading is `asked`, or is `asked` without what is in brackets.
fn with_heading(asked: &str, headings: &[String]) -> Result<usize, String> {
    let same = |heading: &str| heading.trim().eq_ignore_ascii_case(asked.trim());
    let name = |heading: &'_ str| heading.split(['(', '[', '{']).next().unwrap_or_default().to_owned();
    let found: Vec<_> =
        (0..headings.len()).filter(|index| same(&headings[*index]) || same(&name(&headings[*index]))).collect();
    match found.as_slice() {
        [one] => Ok(*one),
        [] if headings.is_empty() => Err(format!("column {} is asked for, and there are no headings", quote(asked))),
        [] => {
            let names = headings.iter().map(|heading| quote(heading)).collect::<Vec<_>>().join(", ");
            Err(format!("column {} is asked for, and the headings are {names}", quote(asked)))
        }
        _ => Err(format!("column {} is asked for, and {} columns have that heading", quote(asked), found.len())),
    }
}

/// What the lines `before` the data say of the unit of the column `value`: in its heading, or anywhere in a line that is
/// not divided into columns.
fn stated(before: &[&str], layout: &Layout, count: usize, value: usize) -> Result<Stated, String> {
    let mut found = Stated::Nothing;
    for line in before {
        let headings = layout.headings(line);
        let says = match headings.get(value).filter(|_| headings.len() == count) {
            Some(heading) => Stated::of(heading),
            None => in_prose(line)?,
        };
        found = match (found, says) {
            (Stated::Unit(first), Stated::Unit(second)) if first != second => {
                return Err(format!("the file states accelerations in {first} and in {second}"));
            }
            (Stated::Nothing | Stated::Other(_), says @ Stated::Unit(_)) => says,
            (Stated::Nothing, says) => says,
            (found, _) => found,
        };
    }
    Ok(found)
}

/// The one unit of acceleration that a line of text names in brackets, or after `unit` or `units of`.
fn in_prose(line: &str) -> Result<Stated, String> {
    let mut units: Vec<_> = bracketed(line).into_iter().filter_map(Unit::named).collect();
    let lower = line.to_lowercase();
    if let Some((_, after)) = lower.split_once("unit") {
        let words = after.trim_start_matches('s').trim_start_matches([':', '=', ' ']).trim_start_matches("of ");
        let word = words.split([' ', ',', ';']).next().unwrap_or_default().trim_end_matches('.');
        units.extend(Unit::named(word));
    }
    units.dedup();
    match units.as_slice() {
        [] => Ok(Stated::Nothing),
        [unit] => Ok(Stated::Unit(*unit)),
        [first, second, ..] => Err(format!("{} names {first} and {second}", quote(line))),
    }
}

/// The unit of the times in s, as a row of units states it, or their heading among `headings`.
fn time_unit(rows: &[Vec<String>], headings: &[String], time: usize) -> Result<f64, String> {
    if let Some(unit) = rows.iter().find_map(|cells| seconds(bare(&cells[time]))) {
        return Ok(unit);
    }
    let brackets = headings.get(time).map_or(Vec::new(), |heading| bracketed(heading));
    match brackets.into_iter().find(|text| !text.is_empty()) {
        Some(unit) => seconds(unit).ok_or_else(|| format!("the times are in {unit:?}, which is neither s nor ms")),
        None => Ok(1.0),
    }
}

/// Whether a heading is a unit and nothing else.
fn is_unit(heading: &str) -> bool {
    Unit::named(bare(heading)).is_some() || seconds(bare(heading)).is_some()
}

fn bare(heading: &str) -> &str {
    heading.trim_matches(['(', ')', '[', ']', '{', '}'])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::record::{Record, Source, UnitFrom};
    use proptest::prelude::*;

    fn read(text: &str, how: &Reading) -> Result<(Record, Source), BadLine> {
        parse(text, how)?.record(how)
    }

    fn problem(text: &str, how: &Reading) -> String {
        let BadLine { line, problem, .. } = read(text, how).unwrap_err();
        format!("{line}: {problem}")
    }

    /// Nothing but what the file says.
    const AS_IT_IS: Reading = Reading { unit: None, dt: None, column: None, ignores_count: false };

    #[test]
    fn every_way_to_write_times_and_accelerations_is_read_alike() {
        for text in [
            "0,0.25\n0.02,-1e-3\n0.05,3\n",
            "time,acc\n0,.25\n0.02,-1.00E-03\n0.05,3\n",
            "# from a shake table\n\ntime [s]; a_g \n 0 ; 0.25 \n # pause\n0.02;-1d-3\n5e-2;+3\n\n",
            "0.0\t0.25\n0.02\t-0.001\n0.05\t3.0",
            "  0.0   0.25\n 0.02 -0.001\n 0.05    3.0\n",
            "Zeit;Beschleunigung\n0,0;0,25\n0,02;-0,001\n0,05;3,0\n",
            "0,0 0,25\n0,02 -0,001\n0,05 3,0\n",
            "0,0\t0,25\n0,02\t-1,0E-3\n0,05\t3\n",
            "\"t\",\"a\"\n\"0.0\",\"0.25\"\n\"0.02\",\"-0.001\"\n\"0.05\",\"3\"\n",
            "\"t\",\"a\"\n\"0,0\",\"0,25\"\n\"0,02\",\"-0,001\"\n\"0,05\",\"3,0\"\n",
            "Shake table 3\n17 March, run 4\ntime  acceleration\n0 0.25\n0.02 -0.001\n0.05 3\n",
            "acc,time (s)\n0.25,0\n-0.001,0.02\n3,0.05\n",
            "time (ms),a\n0,0.25\n20,-0.001\n50,3\n",
            "0, 0.25,\n0.02, -0.001,\n0.05, 3.0,\n",
            "% MATLAB\n% t a\n0 0.25\n0.02 -0.001\n0.05 3\n",
            "a;t\nm/s2;ms\n0,25;0\n-0,001;20\n3;50\n",
        ] {
            let (record, source) = read(text, &AS_IT_IS).unwrap_or_else(|error| panic!("{text}: {error:?}"));
            assert_eq!(
                (record.times(), record.acceleration()),
                (&[0.0, 0.02, 0.05][..], &[0.25, -1e-3, 3.0][..]),
                "{text}"
            );
            let from = if text.contains("m/s2") { UnitFrom::File } else { UnitFrom::Assumed };
            assert_eq!((source.unit, source.unit_from), (Unit::MetrePerSecondSquared, from), "{text}");
        }
    }

    #[test]
    fn the_heading_decides_the_unit_and_must_not_be_contradicted() {
        let cm = Unit::CentimetrePerSecondSquared;
        for (before, unit) in [
            ("time (s),acc (cm/s2)\n", cm),
            ("t,gal\n", cm),
            ("# Accelerations in units of cm/sec^2.\n", cm),
            ("# El Centro (1940), unit: g\ntime,acc\n", Unit::G),
            ("time,a_g[g]\n", Unit::G),
            ("time,acc\ns,mm/s2\n", Unit::MillimetrePerSecondSquared),
            ("Time (s) Acceleration (m/s^2)\n", Unit::MetrePerSecondSquared),
        ] {
            let text = format!("{before}0,1\n1,2\n");
            let source = read(&text, &AS_IT_IS).unwrap().1;
            assert_eq!((source.unit, source.unit_from), (unit, UnitFrom::File), "{before}");
            let same = Reading { unit: Some(unit), ..AS_IT_IS };
            assert!(read(&text, &same).is_ok(), "{before}");
            let other = if unit == Unit::G { cm } else { Unit::G };
            let contradicted = problem(&text, &Reading { unit: Some(other), ..AS_IT_IS });
            let expected = format!("the file states accelerations in {unit}, and {other} is asked for");
            assert!(contradicted.ends_with(&expected), "{contradicted}");
        }
        let asked = Reading { unit: Some(Unit::G), ..AS_IT_IS };
        assert_eq!(read("t,a\n0,1\n1,2\n", &asked).unwrap().1.unit_from, UnitFrom::User);
        assert_eq!(read("t,a (north)\n0,1\n1,2\n", &asked).unwrap().1.unit, Unit::G);
        let unknown = "t (s),a (ft/s2)\n0,1\n1,2\n";
        let expected = "2: the accelerations are in \"ft/s2\", which is none of g, m/s2, cm/s2, gal, mm/s2";
        assert_eq!(problem(unknown, &AS_IT_IS), expected);
        assert!(problem(unknown, &asked).ends_with("\"ft/s2\", and g is asked for"));
        assert!(problem("t,a (g)\nt,a (gal)\n0,1\n1,2\n", &AS_IT_IS).ends_with("in g and in cm/s2"));
        assert!(problem("# (g) or (gal)\n0,1\n1,2\n", &AS_IT_IS).ends_with("names g and cm/s2"));
        assert_eq!(problem("t (h),a\n0,1\n1,2\n", &AS_IT_IS), "2: the times are in \"h\", which is neither s nor ms");
    }

    #[test]
    fn one_column_needs_a_step_and_several_a_choice() {
        let step = Reading { dt: Some(0.5), ..AS_IT_IS };
        for text in ["acc (g)\n1\n-2,\n3\n", "a\n1,0\n-2,0\n3,0\n", "1.0\n-2.0\n3\n", "  1\n -2\n  3\n"] {
            let (record, _) = read(text, &step).unwrap();
            assert_eq!(
                (record.times(), record.acceleration()),
                (&[0.0, 0.5, 1.0][..], &[1.0, -2.0, 3.0][..]),
                "{text}"
            );
        }
        let unknown = read("1\n2\n", &AS_IT_IS).unwrap_err();
        assert_eq!(unknown.remedy, Some(Remedy::Step));

        let three = "time (s),N-S (gal),E-W (g)\n0,1,5\n1,2,6\n";
        let unclear = read(three, &AS_IT_IS).unwrap_err();
        assert_eq!(unclear.remedy, Some(Remedy::Column));
        assert!(unclear.problem.starts_with("3 columns (\"time (s)\", \"N-S (gal)\", \"E-W (g)\")"), "{unclear:?}");
        let chosen = |column, dt| read(three, &Reading { column: Some(column), dt, ..AS_IT_IS });
        let heading = |name: &str| Column::Heading(name.into());
        for column in [Column::Number(3), heading("e-w"), heading("E-W (g)")] {
            let (record, source) = chosen(column, None).unwrap();
            assert_eq!((record.acceleration(), source.unit), (&[5.0, 6.0][..], Unit::G));
        }
        let (record, source) = chosen(Column::Number(2), Some(0.1)).unwrap();
        assert_eq!((record.times(), source.unit), (&[0.0, 0.1][..], Unit::CentimetrePerSecondSquared));
        for (column, expected) in [
            (Column::Number(4), "column 4 is asked for, and there are 3"),
            (Column::Number(1), "column 1 has the times, and cannot have the accelerations"),
            (
                heading("U-D"),
                "column \"U-D\" is asked for, and the headings are \"time (s)\", \"N-S (gal)\", \"E-W (g)\"",
            ),
        ] {
            assert_eq!(chosen(column, None).unwrap_err().problem, expected);
        }
    }

    #[test]
    fn a_refused_table_says_what_was_found_on_which_line() {
        for (text, expected) in [
            ("", "1: no line of numbers up to here; two or more samples are needed"),
            ("t,a\n\n0,1\n", "3: the file ends after 1 sample(s); two or more are needed"),
            ("# c\n0,1\nx,2\n", "3: the time \"x\" is not a number"),
            ("0,1\ninf,2\n", "2: the time \"inf\" is not a number"),
            ("t,a\nt,a\n", "2: no line of numbers up to here; two or more samples are needed"),
            ("0,1\n1,NaN\n", "2: the acceleration \"NaN\" is not a number"),
            ("0,1\n1,\n", "2: the acceleration \"\" is not a number"),
            ("0,O.1\n1,0\n", "1: the acceleration \"O.1\" is not a number"),
            ("0,1\n.5,2\n0.5,3\n", "3: the time 0.5 s does not come after the one before it, 0.5 s"),
            ("0,1\n1,2\n\n2,3\n", "3: a blank line amid the data: something may be missing there"),
            ("0 1\n1 2 3\n", "2: 3 column(s) instead of 2 as on line 1"),
            ("0;1\n0.5;1.234,5\n", "2: the acceleration \"1.234,5\" is not a number"),
        ] {
            assert_eq!(problem(text, &AS_IT_IS), expected, "{text}");
        }
    }

    proptest! {
        #[test]
        fn a_table_reads_what_was_written(
            samples in prop::collection::vec((1e-9..1e3_f64, -1e300..1e300_f64), 2..40),
            separator in prop::sample::select(&[",", ";", "\t", " , ", "  "][..]),
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
            let (record, _) = read(&text, &AS_IT_IS).unwrap();
            prop_assert_eq!((record.times, record.acceleration), expected);
        }
    }
}
