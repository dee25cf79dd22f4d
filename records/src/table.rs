//! Tables of text: a sample on each line, with a comma, a semicolon or blanks between its numbers; or, where the file or the
//! user says so, samples alone, one after the other, as many on a line as there are; after any lines of text.
//!
//! What a column has its heading says; without headings the first has the times. Whole numbers without a unit of time count
//! the samples, or are milliseconds: the file does not tell, so that the time between samples is to be given.

use super::fields::{Layout, headings, is_number, is_numbers, words};
use super::parsed::{Parsed, Times};
use super::sampling::Sampling;
use super::text::{number, numbered, quote, without_blanks};
use super::unit::{Stated, TimeUnit, mentions_unit};
use super::{BadLine, Column, Format, Reading, Remedy, bad, source::decide};

/// The numbers of a file, and what is said before them.
struct Table<'a> {
    text: &'a str,
    /// The lines of text before the numbers, and their cells where they have as many as there are columns.
    before: Vec<(&'a str, Option<Vec<&'a str>>)>,
    /// What a line before the samples states.
    stated: Sampling,
    /// The first line of samples.
    first: usize,
    last: usize,
    layout: Layout,
    /// How many numbers the first line has.
    count: usize,
    /// Those of all lines.
    numbers: Vec<f64>,
    /// The first line that has another number of them.
    uneven: Option<BadLine>,
}

/// Where the samples are in a table.
#[derive(Default)]
struct Samples {
    /// The column of times, with their unit in s.
    time: Option<(usize, f64)>,
    /// The column that counts the samples.
    index: Option<usize>,
    /// That of accelerations; without it all numbers are samples, one after the other.
    value: Option<usize>,
}

/// The samples of a table as `how` says; `#` begins a comment line.
pub(super) fn parse(text: &str, how: &Reading) -> Result<Parsed, BadLine> {
    let table = Table::read(text, how)?;
    let Samples { time, index, value } = table.samples(how)?;
    let (unit, unit_from) = decide(&table.stated_unit(value, how)?, how.unit, table.first)?;
    let times = match (time, table.stated.dt.or(how.dt)) {
        (Some((time, second)), _) => Times::At(table.column(time).map(|time| time * second).collect()),
        (None, Some(dt)) => Times::Every(dt),
        (None, None) => {
            let why = match index {
                Some(index) => format!(
                    "column {} has whole numbers, which count the samples or are milliseconds, for no heading has a unit, as \
                     time (ms) does",
                    index + 1
                ),
                None => "no column has times".into(),
            };
            let problem = why + ": the time between samples is not known";
            return Err(bad(table.first, problem).remedied_by(Remedy::Step));
        }
    };
    if let Some((time, _)) = time
        && let Some((line, before, at)) = table.find_step(time, |before, at| at <= before)
    {
        return Err(bad(line, format!("the time {at:?} does not come after the one before it, {before:?}")));
    }
    if let (Some(dt), Some((found, false))) = (table.stated.dt, table.stated.dt.and_then(|dt| times.have_step(dt))) {
        return Err(bad(table.first, format!("DT states a sample every {dt:?} s, and the times have {found:?} s")));
    }
    let mut parsed = Parsed::new(Format::Table, "", unit, unit_from, times);
    parsed.remark(table.layout.to_string());
    match value {
        Some(value) => parsed.remark(format!("column {}{}", value + 1, table.name(value))),
        None if table.count > 1 => parsed.remark(format!("{} samples a line, one after the other", table.count)),
        None => {}
    }
    if !table.before.is_empty() {
        parsed.remark(format!("{} line(s) of text before the data", table.before.len()));
    }
    let (first, step) = value.map_or((0, 1), |value| (value, table.count));
    for a in table.numbers.iter().skip(first).step_by(step) {
        parsed.add(*a, table.last)?;
    }
    if let Some(npts) = table.stated.npts {
        parsed.check_count("NPTS", npts, how)?;
    }
    Ok(parsed)
}

impl<'a> Table<'a> {
    fn read(text: &'a str, how: &Reading) -> Result<Table<'a>, BadLine> {
        let is_sample = |(_, line): &(usize, &str)| !is_comment(line) && is_numbers(line);
        let Some((mut first, sample)) = numbered(text).find(is_sample) else {
            return Err(without_samples(text));
        };
        let before: Vec<_> = numbered(text).take(first - 1).filter(|(_, line)| !line.trim().is_empty()).collect();
        let after = |line: usize| numbered(text).skip(line).filter(|(_, line)| !is_comment(line));
        let lines = |line: usize| after(line).map(|(_, line)| line).filter(|line| !line.trim().is_empty());
        let of_lines =
            before.iter().map(|(number, line)| Sampling::of(*number, line)).collect::<Result<Vec<_>, _>>()?;
        let mut stated = Sampling {
            npts: of_lines.iter().find_map(|of_line| of_line.npts),
            dt: of_lines.iter().find_map(|of_line| of_line.dt),
        };
        if stated == Sampling::default() {
            if let Some(bare) = bare_npts_and_dt(sample, || lines(first)) {
                stated = bare;
                first = after(first).find(|(_, line)| !line.trim().is_empty()).map_or(first, |(line, _)| line);
            } else if let Some((number, line)) = before.last()
                && !is_comment(line)
                && is_damaged(line, sample)
            {
                let problem = format!("{} is neither a line of numbers nor one of text", quote(line));
                return Err(bad(*number, problem).remedied_by(Remedy::Comment));
            }
        }
        let texts: Vec<_> = before.iter().map(|(_, line)| *line).collect();
        let layout = Layout::of(|| lines(first - 1), &texts, how).map_err(|problem| bad(first, problem))?;
        let count = layout.fields(lines(first - 1).next().unwrap_or_default()).len();
        let is_heading = |of_line: &Sampling| count > 1 && *of_line == Sampling::default();
        let cells = |(line, of_line)| (line, is_heading(of_line).then(|| headings(line, count)).flatten());
        let before = texts.into_iter().zip(&of_lines).map(cells).collect();
        let mut table =
            Table { text, before, stated, first, last: first, layout, count, numbers: Vec::new(), uneven: None };
        for line in without_blanks(after(first - 1)) {
            let (line, sample) = line?;
            let fields = layout.fields(sample);
            table.last = line;
            if fields.len() != count {
                let problem = format!("{} column(s) instead of {count} as on line {first}", fields.len());
                table.uneven.get_or_insert(bad(line, problem).remedied_by(Remedy::ColumnOrAll));
            }
            for (column, field) in fields.into_iter().enumerate() {
                let number = number(&layout.plain(field));
                table.numbers.push(number.ok_or_else(|| bad(line, table.no_number(column, field)))?);
            }
        }
        Ok(table)
    }

    fn no_number(&self, column: usize, field: &str) -> String {
        let has_both = self.layout.decimal_comma && field.contains('.');
        let is = if has_both { "has a point, and others have decimal commas" } else { "is not a number" };
        let time = self.headed_time().map_or(0, |(time, _)| time);
        let what = match self.count {
            2 if column == time => "the time".to_owned(),
            1 | 2 => "the acceleration".to_owned(),
            _ => format!("in column {},", column + 1),
        };
        format!("{what} {} {is}", quote(field))
    }

    /// The numbers of the column, where all lines have as many.
    fn column(&self, column: usize) -> impl Iterator<Item = f64> + Clone {
        self.numbers.iter().skip(column).step_by(self.count).copied()
    }

    /// The first step of the column that `is_it`, by the number before it and that at its end, which is on this line.
    fn find_step(&self, column: usize, is_it: impl Fn(f64, f64) -> bool) -> Option<(usize, f64, f64)> {
        let steps = self.column(column).zip(self.column(column).skip(1));
        let (row, (before, at)) = steps.enumerate().find(|(_, (before, at))| is_it(*before, *at))?;
        let mut samples = numbered(self.text).skip(self.first - 1).filter(|(_, line)| !is_comment(line));
        Some((samples.nth(row + 1)?.0, before, at))
    }

    /// The rows of headings, each with as many cells as there are columns.
    fn headings(&self) -> impl Iterator<Item = &[&'a str]> {
        self.before.iter().filter_map(|(_, cells)| cells.as_deref())
    }

    /// All headings of the column.
    fn headings_of(&self, column: usize) -> impl Iterator<Item = &'a str> {
        self.headings().map(move |cells| cells[column]).filter(|cell| !cell.is_empty())
    }

    /// The heading of the column, as it is said.
    fn name(&self, column: usize) -> String {
        self.headings_of(column).next().map_or(String::new(), |name| format!(" {}", quote(name)))
    }

    /// The column of times, if a heading says so, and their unit.
    fn headed_time(&self) -> Option<(usize, TimeUnit)> {
        let unit = |column| self.headings_of(column).filter_map(TimeUnit::of).max();
        (0..self.count).find_map(|column| Some((column, unit(column)?)))
    }

    fn samples(&self, how: &Reading) -> Result<Samples, BadLine> {
        let &Table { count, first, .. } = self;
        let refused = |problem: String| bad(first, problem);
        let headed = self.headed_time();
        if let (Some(Column::All), Some((time, _))) = (&how.column, &headed) {
            return Err(refused(format!("column {} has the times, and not all are accelerations", time + 1)));
        }
        if let ([npts, after @ ..], 1, None) = (self.numbers.as_slice(), count, self.stated.npts)
            && (*npts == after.len() as f64 || *npts == after.len() as f64 - 1.0)
            && *npts > 1.0
        {
            let problem = format!("{npts} is the number of the samples after it");
            return Err(bad(first, problem).remedied_by(Remedy::Comment));
        }
        if count == 1 && self.uneven.is_none() || headed.is_none() && self.are_all(how) {
            return Ok(Samples::default());
        }
        if let Some(uneven) = &self.uneven {
            return Err(uneven.clone());
        }
        if let (Some(npts), None, None) = (self.stated.npts, &headed, &how.column)
            && npts * count != self.numbers.len()
        {
            let numbers = self.numbers.len();
            let problem =
                format!("NPTS states {npts} samples, and the file has {numbers} numbers, {count} on this line");
            return Err(bad(first, problem).remedied_by(Remedy::ColumnOrAll));
        }
        let asked = self.asked(how)?;
        let time = match headed {
            None if asked == Some(0) || self.is_acceleration(0) => None,
            None => match self.find_step(0, |before, at| at <= before) {
                None => Some((0, TimeUnit::Unstated)),
                Some(_) if how.dt.or(self.stated.dt).is_some() => None,
                Some((line, before, at)) => {
                    let problem = format!("column 1 has {at:?} after {before:?}, which are no times");
                    return Err(bad(line, problem).remedied_by(Remedy::ColumnOrAll));
                }
            },
            headed => headed,
        };
        let time_column = time.as_ref().map(|(column, _)| *column);
        let are_whole = |column| self.column(column).all(|number| number.fract() == 0.0);
        let is_index = time_column.is_some_and(|time| time > 0)
            && !self.is_acceleration(0)
            && are_whole(0)
            && self.find_step(0, |before, at| at <= before).is_none();
        let left: Vec<_> = (usize::from(is_index)..count).filter(|column| Some(*column) != time_column).collect();
        let value = match (asked, left.as_slice()) {
            (Some(asked), _) if Some(asked) == time_column => {
                return Err(refused(format!("column {} has the times, and cannot have the accelerations", asked + 1)));
            }
            (Some(asked), _) => asked,
            (None, [one]) => *one,
            (None, _) => {
                let (names, remedy) = match self.headings().next() {
                    Some(names) => (format!(" ({})", listed(names)), Remedy::Column),
                    None => (String::new(), Remedy::ColumnOrAll),
                };
                let problem = format!("{count} columns{names}: which has the accelerations is not known");
                return Err(bad(first, problem).remedied_by(remedy));
            }
        };
        for (column, words, needed) in [
            (time_column, NO_TIME, "times are needed there"),
            (Some(value), NO_ACCELERATION, "accelerations are needed"),
        ] {
            let Some(column) = column else { continue };
            if let Some(heading) = self.headings_of(column).find(|heading| has_word(heading, words)) {
                return Err(refused(format!("column {} is {}, and {needed}", column + 1, quote(heading))));
            }
        }
        let none = Samples { time: None, index: None, value: Some(value) };
        match time {
            None => Ok(none),
            Some((index, TimeUnit::Unstated)) if are_whole(index) => {
                self.check_steps(index)?;
                Ok(Samples { index: Some(index), ..none })
            }
            Some((time, unit)) => Ok(Samples { time: Some((time, unit.in_seconds().map_err(refused)?)), ..none }),
        }
    }

    /// Whether each number is a sample, as the option says, or NPTS; or a line of text, unless the first column may be times.
    fn are_all(&self, how: &Reading) -> bool {
        let is_series = |(line, _): &(&str, _)| {
            let lower = line.to_lowercase();
            lower.contains("acceleration time") && lower.contains("units of")
        };
        match (&how.column, self.stated.npts) {
            (Some(column), _) => *column == Column::All,
            (None, Some(npts)) => npts == self.numbers.len(),
            (None, None) => self.before.iter().any(is_series) && self.find_step(0, |before, at| at <= before).is_some(),
        }
    }

    /// The column that is asked for.
    fn asked(&self, how: &Reading) -> Result<Option<usize>, BadLine> {
        let &Table { count, first, .. } = self;
        match &how.column {
            Some(Column::Number(number)) if (1..=count).contains(number) => Ok(Some(number - 1)),
            Some(Column::Number(number)) => {
                Err(bad(first, format!("column {number} is asked for, and there are {count}")))
            }
            Some(Column::Heading(asked)) => self.with_heading(asked).map(Some).map_err(|problem| bad(first, problem)),
            Some(Column::All) | None => Ok(None),
        }
    }

    /// The column whose heading is `asked`, or is `asked` without what is in brackets.
    fn with_heading(&self, asked: &str) -> Result<usize, String> {
        let same = |heading: &str| heading.trim().eq_ignore_ascii_case(asked.trim());
        let name = |heading: &'a str| heading.split(['(', '[', '{']).next().unwrap_or_default();
        let is_it = |column: &usize| self.headings_of(*column).any(|heading| same(heading) || same(name(heading)));
        let found: Vec<_> = (0..self.count).filter(is_it).collect();
        let asked = quote(asked);
        match (found.as_slice(), self.headings().next()) {
            ([one], _) => Ok(*one),
            (_, None) => Err(format!("column {asked} is asked for, and there are no headings")),
            (_, Some(names)) => Err(format!("column {asked} is asked for, and the headings are {}", listed(names))),
        }
    }

    /// Whether a heading of the column has a unit of accelerations.
    fn is_acceleration(&self, column: usize) -> bool {
        self.headings_of(column).any(|heading| matches!(Stated::of(heading), Stated::Unit(_)))
    }

    /// Refuses a column that counts the samples and leaves some out.
    fn check_steps(&self, counted: usize) -> Result<(), BadLine> {
        let mut first = self.column(counted);
        let usual = first.next().zip(first.next()).map_or(1.0, |(before, at)| at - before);
        match self.find_step(counted, |before, at| at - before != usual) {
            Some((line, before, at)) => {
                let (column, step) = (counted + 1, at - before);
                let problem = format!(
                    "column {column} counts on by {step}, and by {usual} before: something may be missing there"
                );
                Err(bad(line, problem))
            }
            None => Ok(()),
        }
    }

    /// What is said before the data of the unit of the column `value`, or of all numbers; where `how` does not say it, a unit
    /// that stands elsewhere is refused, for it may be that of a peak.
    fn stated_unit(&self, value: Option<usize>, how: &Reading) -> Result<Stated, BadLine> {
        let (mut found, mut mentioned) = (Stated::Nothing, None);
        for (line, cells) in &self.before {
            let stated = match value {
                Some(value) => cells.as_ref().map_or(Stated::Nothing, |cells| Stated::of(cells[value])),
                None if has_word(line, NO_ACCELERATION) && !line.to_lowercase().contains("acc") => {
                    let problem = format!("{} is before the data, and accelerations are needed", quote(line));
                    return Err(bad(self.first, problem));
                }
                None => Stated::of_line(line),
            };
            match (&found, &stated) {
                (Stated::Unit(first), Stated::Unit(second)) if first != second => {
                    let problem = format!("the file states accelerations in {first} and in {second}");
                    return Err(bad(self.first, problem));
                }
                (_, Stated::Unit(_)) | (Stated::Nothing, Stated::Other(_)) => found = stated,
                _ if mentions_unit(line) => mentioned = Some(line),
                _ => {}
            }
        }
        match (&found, mentioned, how.unit) {
            (Stated::Nothing, Some(line), None) => {
                let line = quote(line);
                let problem = format!("{line} has a unit, and no heading says that it is that of the accelerations");
                Err(bad(self.first, problem).remedied_by(Remedy::Unit))
            }
            _ => Ok(found),
        }
    }
}

/// Why a file has no samples.
fn without_samples(text: &str) -> BadLine {
    let lines = text.lines().count();
    if text.trim().is_empty() {
        return bad(lines.max(1), "the file is empty");
    }
    bad(
        lines,
        format!("{lines} line(s) of text and no samples: lines of numbers alone are needed, without columns of text"),
    )
}

/// NPTS and DT (s) where `line` has nothing but them: the line after it has other numbers than two, or there are as many
/// samples as it says, and the first number after it is no time after its own.
fn bare_npts_and_dt<'a, L: Iterator<Item = &'a str>>(line: &str, after: impl Fn() -> L) -> Option<Sampling> {
    const LONGEST_STEP: f64 = 1.0;
    let [npts, dt] = words(line).try_into().ok()?;
    let npts: usize = npts.parse().ok().filter(|npts| *npts > 1)?;
    let dt = number(dt).filter(|dt| *dt > 0.0 && *dt < LONGEST_STEP)?;
    let next = words(after().next()?);
    let is_stated = || {
        let (lines, next) = (after().count(), number(next[0]));
        (lines == npts || lines == npts.div_ceil(2)) && next.is_some_and(|next| next < npts as f64)
    };
    (next.len() != 2 || is_stated()).then_some(Sampling { npts: Some(npts), dt: Some(dt) })
}

/// Words of headings that have no accelerations.
const NO_ACCELERATION: &[&str] = &["vel", "velocity", "disp", "displ", "displacement"];

/// Words and units of headings that have no times.
const NO_TIME: &[&str] =
    &["hz", "mm", "cm", "m", "km", "frequency", "freq", "period", "distance", "depth", "velocity", "displacement"];

/// Whether one of the `words` stands in `heading`.
fn has_word(heading: &str, words: &[&str]) -> bool {
    heading.to_lowercase().split(|letter: char| !letter.is_alphabetic()).any(|word| words.contains(&word))
}

/// The first of `headings`, as many as a message can show.
fn listed(headings: &[&str]) -> String {
    const SHOWN: usize = 8;
    let mut names = headings.iter().take(SHOWN).map(|heading| quote(heading)).collect::<Vec<_>>().join(", ");
    if headings.len() > SHOWN {
        names += ", ...";
    }
    names
}

fn is_comment(line: &str) -> bool {
    line.trim_start().starts_with('#')
}

/// Whether `line` may be a sample that is damaged, like `sample` otherwise.
fn is_damaged(line: &str, sample: &str) -> bool {
    let words_of_line = words(line);
    words_of_line.len() == words(sample).len() && is_number(words_of_line[0])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Record, Source, Unit, UnitFrom};

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
            "Shake table 3\n17 March, run 4\ntime  acceleration\n0 0.25\n0.02 -0.001\n0.05 3\n",
            "acc,time (s)\n0.25,0\n-0.001,0.02\n3,0.05\n",
            "time (ms),a\n0,0.25\n20,-0.001\n50,3\n",
            "0, 0.25,\n0.02, -0.001,\n0.05, 3.0,\n",
            "% MATLAB\n% t a\n0 0.25\n0.02 -0.001\n0.05 3\n",
            "n;t (ms);a\n5;0;0.25\n10;20;-0.001\n15;50;3\n",
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
            ("# peak in g: 0.3\nt,a (gal)\n", cm),
            ("time,acc\ns,mm/s2\n", Unit::MillimetrePerSecondSquared),
            ("Time (s) Acceleration (m/s^2)\n", Unit::MetrePerSecondSquared),
        ] {
            let text = format!("{before}0,1\n.5,2\n");
            let source = read(&text, &AS_IT_IS).unwrap().1;
            assert_eq!((source.unit, source.unit_from), (unit, UnitFrom::File), "{before}");
        }
        let asked = Reading { unit: Some(Unit::G), ..AS_IT_IS };
        assert_eq!(read("t,a (north)\n0,1\n.5,2\n", &asked).unwrap().1.unit, Unit::G);
        let unknown = "t (s),a (km/s2)\n0,1\n1,2\n";
        let expected =
            "2: the accelerations are in \"km/s2\", which is none of g, m/s2, cm/s2, gal, mm/s2, in/s2, ft/s2, mg, %g";
        assert_eq!(problem(unknown, &AS_IT_IS), expected);
        assert!(problem(unknown, &asked).ends_with("\"km/s2\", and g is asked for"));
        assert!(problem("t,a (g)\nt,a (gal)\n0,1\n.5,2\n", &AS_IT_IS).ends_with("in g and in cm/s2"));
        assert_eq!(problem("t (h),a\n0,1\n1,2\n", &AS_IT_IS), "2: the times are in \"h\", which is neither s nor ms");
    }

    #[test]
    fn one_column_needs_a_step_and_several_a_choice() {
        let step = Reading { dt: Some(0.5), ..AS_IT_IS };
        for text in ["acc (g)\n1\n-2,\n3\n", "1.0\n-2.0\n3\n", "  1\n -2\n  3\n", "0,1\n1,-2\n2,3\n"] {
            let (record, _) = read(text, &step).unwrap();
            assert_eq!(
                (record.times(), record.acceleration()),
                (&[0.0, 0.5, 1.0][..], &[1.0, -2.0, 3.0][..]),
                "{text}"
            );
        }
        for text in ["1\n2\n", "0,1\n1,-2\n2,3\n", "t,a\n0,1\n5,-2\n10,3\n"] {
            assert_eq!(read(text, &AS_IT_IS).unwrap_err().remedy, Some(Remedy::Step), "{text}");
        }

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
        let (record, source) = chosen(Column::Number(2), Some(1.0)).unwrap();
        assert_eq!((record.times(), source.unit), (&[0.0, 1.0][..], Unit::CentimetrePerSecondSquared));
        assert_eq!(
            problem("n,a\n1,0\n2,0\n4,0\n5,-1\n", &step),
            "4: column 1 counts on by 2, and by 1 before: something may be missing there"
        );
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

    /// Numbers that change like those of one instrument, of two, or of times and samples, are none of them until somebody says.
    #[test]
    fn several_samples_a_line_are_read_if_it_is_said() {
        let step = Reading { dt: Some(0.5), ..AS_IT_IS };
        let all = Reading { column: Some(Column::All), ..step.clone() };
        for text in ["1 -2 3\n", "3 2 1\n1 2 3\n", "1 -1\n-1 1\n1 -1\n", "0.1 1 2\n1.1 3 2\n2.1 1 0\n", "1 2\n3 4 5\n"]
        {
            assert_eq!(read(text, &step).unwrap_err().remedy, Some(Remedy::ColumnOrAll), "{text}");
            let expected: Vec<f64> = text.split_whitespace().map(|word| word.parse().unwrap()).collect();
            assert_eq!(read(text, &all).unwrap().0.acceleration(), expected, "{text}");
            let stated = format!("NPTS={} DT=0.5\n{text}", expected.len());
            assert_eq!(read(&stated, &AS_IT_IS).unwrap().0.acceleration(), expected, "{text}");
        }
        let cut = "NPTS=8 DT=.5\n3 2 1\n1 2 3\n";
        let expected = "2: NPTS states 8 samples, and the file has 6 numbers, 3 on this line";
        assert_eq!(problem(cut, &Reading { ignores_count: true, ..AS_IT_IS }), expected);
        assert_eq!(read(cut, &all).unwrap_err().remedy, Some(Remedy::IgnoreCount));
        let series = "ACCELERATION TIME HISTORY IN UNITS OF CM/S**2\n3 2 1\n1 2 3\n";
        assert_eq!(read(series, &step).unwrap().0.acceleration(), [3.0, 2.0, 1.0, 1.0, 2.0, 3.0]);
        assert_eq!(problem("t,a\n0,1\n.5,2\n", &all), "2: column 1 has the times, and not all are accelerations");
    }

    #[test]
    fn a_stated_step_is_read_whatever_follows_it() {
        for line in ["DT=0.01 s", "# DT: 10 ms", "NPTS= 3, DT= .01 SEC, UNITS=G", "dt = 0.01s, npts = 3 (of 3)"] {
            let text = format!("{line}\n1\n2\n4\n");
            assert_eq!(read(&text, &AS_IT_IS).unwrap().0.times(), [0.0, 0.01, 0.02], "{line}");
            let refused = problem(&text, &Reading { dt: Some(0.02), ..AS_IT_IS });
            assert!(refused.ends_with("the file states a sample every 0.01 s, and 0.02 s is asked for"), "{refused}");
        }
        let contradicted = "DT=0.02 s\ntime,acc\n0.00,1\n0.01,2\n0.02,-3\n";
        let expected = "3: DT states a sample every 0.02 s, and the times have 0.01 s";
        assert_eq!(problem(contradicted, &AS_IT_IS), expected);
        assert_eq!(problem("DT=0.01 min\n1\n2\n", &AS_IT_IS), "1: the times are in \"min\", which is neither s nor ms");
    }

    #[test]
    fn a_column_of_something_else_has_neither_times_nor_accelerations() {
        for heading in ["f (Hz)", "x [m]", "drift/mm", "Frequency", "Period (s)", "depth_m"] {
            let expected = format!("2: column 1 is {heading:?}, and times are needed there");
            assert_eq!(problem(&format!("{heading},acc (g)\n1,1.5\n2,2\n"), &AS_IT_IS), expected);
        }
        for heading in ["velocity", "Displacement", "disp (cm)", "vel_x"] {
            let expected = format!("2: column 2 is {heading:?}, and accelerations are needed");
            assert_eq!(problem(&format!("time,{heading}\n0,1\n.5,2\n"), &AS_IT_IS), expected);
        }
    }

    /// Where nobody says so they may be either.
    #[test]
    fn commas_between_whole_numbers_are_refused_unless_something_says_that_they_separate() {
        let second = Reading { column: Some(Column::Number(2)), ..AS_IT_IS };
        let two = "0,1\n1,2\n2,3\n3,5\n";
        for (text, how) in
            [(two, &AS_IT_IS), ("1,25\n-2,5\n3\n", &AS_IT_IS), ("0,05\n1,5\n", &second), ("0,01,-0,12\n", &second)]
        {
            assert!(problem(text, how).contains("may stand between numbers or before decimals"), "{text}");
        }
        let second = Reading { dt: Some(0.1), ..second };
        assert_eq!(read(two, &second).unwrap().0.acceleration(), [1.0, 2.0, 3.0, 5.0]);
        assert_eq!(read(&format!("t (ms),a\n{two}"), &AS_IT_IS).unwrap().0.times(), [0.0, 0.001, 0.002, 0.003]);
    }

    /// It may be that of a peak, or of the accelerations: the user says.
    #[test]
    fn a_unit_in_no_heading_is_not_taken_and_not_passed_over() {
        for line in ["time acc cm/s2", "Acceleration in cm/s2", "# peak in g: 0.3", "peak 0.3 g", "PGA=0.3g"] {
            let text = format!("{line}\n0,1\n.5,2\n");
            let refused = read(&text, &AS_IT_IS).unwrap_err();
            assert_eq!(refused.remedy, Some(Remedy::Unit), "{line}");
            let asked = Reading { unit: Some(Unit::MilliG), ..AS_IT_IS };
            assert_eq!(read(&text, &asked).unwrap().1.unit, Unit::MilliG, "{line}");
        }
        let one = |line: &str| read(&format!("{line}\n1\n2\n"), &Reading { dt: Some(0.1), ..AS_IT_IS });
        for line in ["Acceleration in cm/s2", "# Accelerations in units of cm/sec^2.", "unit: gal"] {
            assert_eq!(one(line).unwrap().1.unit, Unit::CentimetrePerSecondSquared, "{line}");
        }
        assert_eq!(one("# peak 0.3 g").unwrap_err().remedy, Some(Remedy::Unit));
    }

    #[test]
    fn a_line_of_npts_and_dt_is_believed_and_checked() {
        let samples = [0.1, -0.2, 0.3, 0.5, -0.4];
        for text in [
            "5 0.01\n0.1 -0.2 0.3\n0.5 -0.4\n",
            "5, .01\n0.1\n-0.2\n0.3\n0.5\n-0.4\n",
            "Kocaeli 1999 08 17\n 5 1E-2\n 0.1 -0.2 0.3 0.5 -0.4\n",
            "NPTS= 5, DT= .01 SEC\n0.1 -0.2 0.3\n0.5 -0.4\n",
            "5 0.01\n0.1 -0.2\n0.3 0.5\n-0.4\n",
            "5 0.01\n0.00 0.1\n0.01 -0.2\n0.02 0.3\n0.03 0.5\n0.04 -0.4\n",
        ] {
            let (record, _) = read(text, &AS_IT_IS).unwrap_or_else(|error| panic!("{text}: {error:?}"));
            assert_eq!(record.acceleration(), samples, "{text}");
            assert_eq!(record.times(), [0.0, 0.01, 0.02, 0.03, 0.04], "{text}");
            let fewer = &text[..text.trim_end().rfind(['\n', ' ']).unwrap()];
            assert!(read(fewer, &AS_IT_IS).is_err(), "{fewer}");
        }
    }

    #[test]
    fn text_is_no_data_and_damaged_data_are_no_text() {
        for title in ["Kocaeli 1999 08 17", "17 March, run 4", "(1) 2 3"] {
            let (record, _) = read(&format!("{title}\n0.0 0.1\n0.5 0.2\n"), &AS_IT_IS).unwrap();
            assert_eq!((record.times(), record.acceleration()), (&[0.0, 0.5][..], &[0.1, 0.2][..]), "{title}");
        }
        for text in ["3\n0.1\n0.2\n0.3\n", "3\n0.01\n0.1\n0.2\n0.3\n"] {
            let refused = read(text, &Reading { dt: Some(0.01), ..AS_IT_IS }).unwrap_err();
            assert_eq!((refused.line, refused.remedy), (1, Some(Remedy::Comment)), "{text}");
        }
        for line in ["0,O.1", "0.0;1..5", "1999 Kocaeli"] {
            let refused = read(&format!("{line}\n0.01;0.1\n0.02;0.2\n"), &AS_IT_IS).unwrap_err();
            assert_eq!((refused.line, refused.remedy), (1, Some(Remedy::Comment)), "{line}");
        }
    }

    #[test]
    fn a_message_does_not_grow_with_the_table() {
        let row = |cell: &str| vec![cell; 20_001].join(";");
        let text = format!("{}\n{}\n{}\n", row("heading"), row("1"), row("2"));
        let asked = Reading { column: Some(Column::Heading("other".into())), ..AS_IT_IS };
        for how in [AS_IT_IS, asked] {
            assert!(problem(&text, &how).len() < 250);
        }
    }

    #[test]
    fn a_refused_table_says_what_was_found_on_which_line() {
        for (text, expected) in [
            ("", "1: the file is empty"),
            ("\n \n", "2: the file is empty"),
            ("t,a\n\n.5,1\n", "3: the file ends after 1 sample(s); two or more are needed"),
            ("# c\n0.1,1\nx,2\n", "3: the time \"x\" is not a number"),
            ("0,1\ninf,2\n", "2: the time \"inf\" is not a number"),
            (
                "t,a\n",
                "1: 1 line(s) of text and no samples: lines of numbers alone are needed, without columns of text",
            ),
            ("0,1\n1,NaN\n", "2: the acceleration \"NaN\" is not a number"),
            ("0,1\n1,\n", "2: 1 column(s) instead of 2 as on line 1"),
            ("0,1,2\n1,,2\n", "2: in column 2, \"\" is not a number"),
            ("t,a\n0,1\n.5,2\n0.5,3\n", "4: the time 0.5 does not come after the one before it, 0.5"),
            ("t,a\n0,1\n.5,2\n0.4,3\n", "4: the time 0.4 does not come after the one before it, 0.5"),
            ("0,1\n.5,2\n0.4,3\n", "3: column 1 has 0.4 after 0.5, which are no times"),
            ("0,.1\n1,.2\n\n2,.3\n", "3: a blank line amid the data: something may be missing there"),
            ("0 1\n1 2 3\n", "2: 3 column(s) instead of 2 as on line 1"),
            ("0;1\n0,5;1.234,5\n", "2: the acceleration \"1.234,5\" has a point, and others have decimal commas"),
        ] {
            assert_eq!(problem(text, &AS_IT_IS), expected, "{text}");
        }
    }
}
