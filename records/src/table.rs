//! Tables of text: a sample on each line, with a comma, a semicolon or blanks between the numbers. If the file or the user
//! says so, the lines have any number of samples instead. Lines of text can stand before the numbers.
//!
//! The headings say which column has what. Without headings the first column has the times. Whole numbers without a unit of
//! time could be counts or milliseconds: then the user must give the time between samples.

use super::fields::{Layout, cells, is_numbers};
use super::parsed::{Parsed, Times};
use super::sampling::Sampling;
use super::text::{is_comment, is_number, no_number, number, numbered, quote, without_blanks};
use super::unit::{HeadingUnit, TimeUnit, is_prose, mentions_unit};
use super::{BadLine, Column, Reading, Remedy, bad, source::of_heading};

/// The numbers of a file, and the text before them.
struct NumberTable<'a> {
    text: &'a str,
    /// The lines of text before the numbers, with their numbers.
    before: Vec<(usize, &'a str)>,
    /// The cells of the lines of text that have one for each column, with the numbers of these lines.
    headings: Vec<(usize, Vec<&'a str>)>,
    /// Number of samples and step that a line before the samples states.
    stated: Sampling,
    /// The first line of samples.
    first: usize,
    last: usize,
    layout: Layout,
    /// Number of columns of the first line; 2 if each line has several times, each with its sample.
    count: usize,
    /// Times on the first line, if the lines have nothing but times, each with its sample.
    pairs: Option<usize>,
    numbers: Vec<f64>,
    /// The first line with another number of columns.
    uneven: Option<BadLine>,
}

/// A column of times, and their unit.
type TimeColumn = (usize, TimeUnit);

/// The samples of a table as `how` says; `#`, `%`, `!`, `$` or `/&` begins a comment line.
pub(super) fn parse(text: &str, how: &Reading) -> Result<Parsed, BadLine> {
    let table = NumberTable::read(text, how)?;
    let (time, value) = table.samples(how)?;
    let (stated, line) = table.stated_unit(value, how)?;
    let (unit, unit_from) = of_heading(stated, how.unit, line)?;
    let mut times = table.times(time, how)?;
    if let Some(dt) = table.stated.dt {
        let says =
            |found| format!("DT states a sample every {dt:?} s, and the times have {found}: correct one of them");
        times = times.with_step(dt).map_err(|(row, found)| table.bad(row, says(found)))?;
    }
    if let (Times::At(_), Some(dt)) = (&times, how.dt) {
        let says = |found| format!("the times have {found}, but the given step is {dt:?} s");
        times = times.with_step(dt).map_err(|(row, found)| table.bad(row, says(found)))?;
    }
    let mut parsed = Parsed::new("", unit, unit_from, times);
    parsed.remark(table.layout.to_string());
    match value {
        Some(_) if table.pairs > Some(1) => {
            parsed.remark(format!("{} times a line, each with its sample", table.pairs.unwrap_or_default()));
        }
        Some(value) => {
            let name = table.headings_of(value).next().map_or(String::new(), |(_, name)| format!(" {}", quote(name)));
            parsed.remark(format!("column {}{name}", value + 1));
        }
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

impl<'a> NumberTable<'a> {
    /// The table in `text`, whose first line of numbers may state the number of samples and the step instead.
    fn read(text: &'a str, how: &Reading) -> Result<NumberTable<'a>, BadLine> {
        let mut table = NumberTable::after(text, None, how)?;
        if let Some(counts) = table.counts() {
            table = NumberTable::after(text, Some((table.first, counts)), how)?;
        }
        table.pairs = table.pairs();
        if table.pairs.is_some() {
            (table.count, table.uneven) = (2, None);
        }
        Ok(table)
    }

    /// The table after the line `counts`, if any, which is counted from 1.
    fn after(text: &'a str, counts: Option<(usize, Sampling)>, how: &Reading) -> Result<NumberTable<'a>, BadLine> {
        let start = counts.map_or(0, |(line, _)| line);
        let is_sample = |(line, text): &(usize, &str)| *line > start && !is_comment(text) && is_numbers(text);
        let Some((first, sample)) = numbered(text).find(is_sample) else {
            return Err(without_samples(text));
        };
        let samples = || numbered(text).skip(first - 1).filter(|(_, line)| !is_comment(line));
        let layout = Layout::of(|| samples().map(|(_, line)| line));
        let count = layout.fields(sample).len();
        let (mut before, mut headings) = (Vec::new(), Vec::new());
        let mut stated = counts.map_or(Sampling::default(), |(_, counts)| counts);
        let is_damaged = |line: &str| {
            let fields = layout.fields(line);
            !is_comment(line) && fields.len() == count && is_number(fields[0])
        };
        for (line, text) in numbered(text).take(first - 1).filter(|(_, line)| !line.trim().is_empty()) {
            before.push((line, text));
            match if line == start { stated } else { Sampling::of(line, text, how)? } {
                Sampling { npts: None, dt: None } if is_damaged(text) => {
                    let problem =
                        format!("{} is neither numbers nor text: correct it, or write # before it", quote(text));
                    return Err(bad(line, problem));
                }
                Sampling { npts: None, dt: None } if count > 1 => {
                    headings.extend(cells(text, count).map(|cells| (line, cells)))
                }
                of_line => stated = stated.and(of_line, line)?,
            }
        }
        let (last, numbers, pairs, uneven) = (first, Vec::new(), None, None);
        let mut table =
            NumberTable { text, before, headings, stated, first, last, layout, count, pairs, numbers, uneven };
        for line in without_blanks(samples()) {
            let (line, sample) = line?;
            let fields = layout.fields(sample);
            table.last = line;
            if fields.len() != count {
                let problem = format!("{} column(s) instead of {count} as on line {first}", fields.len());
                table.uneven.get_or_insert(bad(line, problem).remedied_by(Remedy::All));
            }
            for (column, field) in fields.into_iter().enumerate() {
                let number = number(&layout.plain(field));
                let no_number = || {
                    let is_text = column == 0 && !field.starts_with(|c: char| c.is_numeric() || "+-.".contains(c));
                    let remedy = if is_text { ": write # before a line of text" } else { "" };
                    bad(line, table.no_number(column, field) + remedy)
                };
                table.numbers.push(number.ok_or_else(no_number)?);
            }
        }
        Ok(table)
    }

    /// Number of samples, step or both that the first line states: they agree with the lines after it, and are no sample.
    fn counts(&self) -> Option<Sampling> {
        let (first, after) = self.numbers.split_at(self.count);
        let width = if self.uneven.is_some() { self.layout.fields(self.line(1)?.1).len() } else { self.count };
        let is_count = |npts: f64| {
            let is_all = |columns: usize| npts * columns as f64 == after.len() as f64;
            npts > 1.0 && (is_all(1) || is_all(width))
        };
        let is_step = |dt: f64| width > 1 && after.get(width).is_some_and(|next| is_near(next - after[0], dt));
        let is_rising = || self.uneven.is_none() && rises(self.column(0)) && !is_step(first[1]);
        match *first {
            [npts] if self.uneven.is_some() && is_count(npts) => Some(Sampling { npts: Some(npts as usize), dt: None }),
            [dt] if self.uneven.is_some() && is_step(dt) => Some(Sampling { npts: None, dt: Some(dt) }),
            [npts, dt, ref more @ ..]
                if dt > 0.0 && is_count(npts) && !is_rising() && (more.is_empty() || self.uneven.is_some()) =>
            {
                Some(Sampling { npts: Some(npts as usize), dt: Some(dt) })
            }
            _ => None,
        }
    }

    /// How many times the first line has, if every other number is a time: they rise, by even steps if they are few.
    fn pairs(&self) -> Option<usize> {
        const MANY: usize = 20;
        let times = || self.numbers.iter().step_by(2).copied();
        let is_short = |uneven: &BadLine| uneven.line == self.last && self.numbers.len().is_multiple_of(2);
        let is_time = |column| self.headings_of(column).all(|(_, heading)| TimeUnit::of(heading).is_some());
        let is_known = self.count.is_multiple_of(2)
            && self.uneven.as_ref().is_none_or(is_short)
            && (0..self.count).step_by(2).all(is_time)
            && rises(times());
        let count = times().count();
        (is_known && count > 3 && (count > MANY || is_even(times()))).then_some(self.count / 2)
    }

    /// The line of samples after so many others.
    fn line(&self, after: usize) -> Option<(usize, &'a str)> {
        numbered(self.text).skip(self.first - 1).filter(|(_, line)| !is_comment(line)).nth(after)
    }

    /// A `problem` on the line of the sample `row`.
    fn bad(&self, row: usize, problem: String) -> BadLine {
        let line = self.line(row / self.pairs.unwrap_or(1));
        bad(line.map_or(self.last, |(line, _)| line), problem)
    }

    fn no_number(&self, column: usize, field: &str) -> String {
        let time = self.headed_time().map_or(0, |(time, _)| time);
        let what = match self.count {
            2 if column == time => "the time".to_owned(),
            1 | 2 => "the acceleration".to_owned(),
            _ => format!("in column {},", column + 1),
        };
        format!("{what} {}", no_number(field))
    }

    /// The numbers of the column, where all lines have as many.
    fn column(&self, column: usize) -> impl Iterator<Item = f64> + Clone {
        self.numbers.iter().skip(column).step_by(self.count).copied()
    }

    /// Refuses a column whose numbers do not grow, or not by `even` steps.
    fn check_steps(&self, column: usize, even: Option<f64>) -> Result<(), BadLine> {
        let what = if even.is_some() { "count the samples" } else { "have the times" };
        let is_right = |step: f64| step > 0.0 && even.is_none_or(|even| step == even);
        let mut steps = self.column(column).zip(self.column(column).skip(1));
        let Some(row) = steps.position(|(before, at)| !is_right(at - before)) else { return Ok(()) };
        let [before, at] = [row, row + 1].map(|row| self.numbers[row * self.count + column]);
        Err(self.bad(row + 1, format!("column {} cannot {what}: {at:?} comes after {before:?}", column + 1)))
    }

    /// Refuses a first column that has no times: its heading says something else, or they do not grow. Whole numbers may
    /// count the samples, whatever their heading. Steps of many lengths are those of the periods of a spectrum, which is refused
    /// whatever the options.
    fn check_first(&self) -> Result<(), BadLine> {
        const UNLESS: &str = ", unless you head column 1 time (s)";
        let steps = self.column(0).zip(self.column(0).skip(1)).map(|(before, at)| at - before);
        let least = steps.clone().fold(f64::INFINITY, f64::min);
        let is_uneven = least > 0.0 && steps.fold(0.0, f64::max) > 2.1 * least;
        let is_period = |name: &str| ["period", "freq", "hz"].iter().any(|word| name.to_lowercase().contains(word));
        match self.headings_of(0).next() {
            Some((line, name)) if is_uneven || is_period(name) => {
                let problem = format!("column 1 is {}, which is no time: this is no record of a_g(t)", quote(name));
                Err(bad(line, problem + UNLESS))
            }
            None if is_uneven && self.is_positive() => {
                let problem = "uneven steps and no number below 0: this is a spectrum, no record of a_g(t)".to_owned();
                Err(bad(self.first, problem + UNLESS))
            }
            Some((line, name)) if !self.is_whole(0) => {
                let problem = format!("column 1 is {}, which is no time in s or ms", quote(name));
                Err(bad(line, problem).remedied_by(Remedy::StepOrHeading))
            }
            _ => self.check_steps(0, None).map_err(|no_times| no_times.remedied_by(Remedy::Column)),
        }
    }

    /// Refuses a spectrum: many rows of which none has a number below 0, from a period above 0 on. A heading says time and no text
    /// says spectrum, where it is a record.
    fn check_signs(&self) -> Result<(), BadLine> {
        const MANY: usize = 10;
        let first = |name: &'a str| name.split(|letter: char| !letter.is_alphabetic()).next().unwrap_or_default();
        let is_time = |word: &str| word == "t" || ["time", "times", "zeit"].contains(&&*word.to_lowercase());
        let says_time = self.headings_of(0).any(|(_, name)| is_time(first(name)));
        let says_spectrum = self.before.iter().any(|(_, text)| text.to_lowercase().contains("spectr"));
        let is_spectrum = (says_spectrum || !says_time) && self.is_positive() && !self.is_whole(0);
        if is_spectrum && self.numbers.len() >= MANY * self.count {
            let problem = "no number below 0, and the first line is not at 0: this is a spectrum, no record of a_g(t)";
            let remedy = "unless you head column 1 time (s) without a line on spectra";
            return Err(bad(self.first, format!("{problem}, {remedy}")));
        }
        Ok(())
    }

    /// Whether no number is below 0, from a first one above 0 on, as in a spectrum.
    fn is_positive(&self) -> bool {
        self.numbers[0] > 0.0 && self.numbers.iter().all(|number| *number >= 0.0)
    }

    fn is_whole(&self, column: usize) -> bool {
        self.column(column).all(|number| number.fract() == 0.0)
    }

    /// All headings of the column, with the numbers of their lines.
    fn headings_of(&self, column: usize) -> impl Iterator<Item = (usize, &'a str)> {
        self.headings.iter().map(move |(line, cells)| (*line, cells[column])).filter(|(_, cell)| !cell.is_empty())
    }

    /// The column of times, if a heading says so, and their unit.
    fn headed_time(&self) -> Option<TimeColumn> {
        let unit = |column| self.headings_of(column).filter_map(|(_, heading)| TimeUnit::of(heading)).max();
        (0..self.count).find_map(|column| Some((column, unit(column)?)))
    }

    /// The column of times with their unit, and the column of accelerations; without one, all numbers are samples, one after the other.
    fn samples(&self, how: &Reading) -> Result<(Option<TimeColumn>, Option<usize>), BadLine> {
        self.check_headings(how)?;
        let are_all = match &how.column {
            Some(column) => *column == Column::All,
            None => self.stated.npts == Some(self.numbers.len()),
        };
        let are_all = are_all && self.headed_time().is_none() && self.pairs.is_none();
        if are_all || self.count == 1 && self.uneven.is_none() {
            return Ok((None, None));
        }
        if let Some(uneven) = &self.uneven {
            return Err(uneven.clone());
        }
        self.check_signs()?;
        let time = match self.headed_time() {
            None => match self.check_first() {
                Ok(()) => Some((0, TimeUnit::Unstated)),
                Err(no_times) if no_times.remedy.is_some() && how.dt.or(self.stated.dt).is_some() => None,
                Err(no_times) => return Err(no_times),
            },
            headed => headed,
        };
        let is_time = |column: usize| time.is_some_and(|(time, _)| column == time);
        let left: Vec<_> = (0..self.count).filter(|column| !is_time(*column)).collect();
        let value = match (self.asked(how)?, left.as_slice()) {
            (Some(asked), _) if is_time(asked) => {
                let problem = format!("column {} has the times, and cannot have the accelerations", asked + 1);
                return Err(bad(self.first, problem));
            }
            (Some(asked), _) => asked,
            (None, [one]) => *one,
            (None, _) => {
                let names = self.headings.first().map_or(String::new(), |(_, names)| format!(" ({})", listed(names)));
                let problem = format!("cannot tell which of {} columns{names} has the accelerations", self.count);
                let unit =
                    self.stated_unit(Some(left[0]), how).and_then(|(unit, line)| of_heading(unit, how.unit, line));
                let remedy = if unit.is_err() { Remedy::ColumnAndUnit } else { Remedy::Column };
                return Err(bad(self.first, problem).remedied_by(remedy));
            }
        };
        Ok((time, Some(value)))
    }

    /// Refuses headings of numbers alone on the first lines: times begin after them, or they have the number of samples, the
    /// given step or its rate. One of these that comes again is a sample, but not on the first line.
    fn check_headings(&self, how: &Reading) -> Result<(), BadLine> {
        const MOST: usize = 5;
        if self.stated.npts.is_some() || self.headed_time().is_some() || self.pairs.is_some() {
            return Ok(());
        }
        let (mut start, all) = (0, self.numbers.len());
        for (line, of_line) in (0..MOST).map_while(|after| self.line(after)) {
            let of_line = self.layout.fields(of_line).len();
            let (numbers, after) = self.numbers[start..].split_at(of_line);
            let times = || self.numbers[start..].iter().step_by(of_line).copied();
            let are_rows = of_line > 1 && after.len().is_multiple_of(of_line) && after.len() > of_line;
            if are_rows && start == 0 && rises(times()) {
                return Ok(());
            } else if are_rows && start > 0 && is_even(times()) {
                return Err(bad(line, "column 1 has even times from here on: write # before the numbers above"));
            }
            let (is_alone, count) = (start + of_line == 1, after.len() as f64);
            let counts = [count, count - 1.0, count / self.count as f64];
            for number in numbers {
                let is_large = *number > if is_alone { 1.0 } else { 10.0 };
                let is_rare = || is_alone || !after.contains(number);
                let what = match how.dt {
                    _ if is_large && counts.contains(number) => "number of samples after it",
                    Some(dt) if *number == dt && is_rare() => "given step",
                    Some(dt) if is_large && *number * dt == 1.0 && is_rare() => "rate of the given step",
                    _ => continue,
                };
                let remedy = format!("write # before it and the numbers above, or NPTS= {all} if it is a sample");
                return Err(bad(line, format!("{number} is the {what}: {remedy}")));
            }
            start += of_line;
        }
        Ok(())
    }

    /// The instants of the samples, which are in the column `time`, if any.
    fn times(&self, time: Option<TimeColumn>, how: &Reading) -> Result<Times, BadLine> {
        let step = self.stated.dt.or(how.dt).map(Times::Every);
        match time {
            Some((time, TimeUnit::Unstated)) if self.is_whole(time) => {
                let problem = format!("column {} has whole numbers, which may be counts or milliseconds", time + 1);
                let step = step.ok_or_else(|| bad(self.first, problem).remedied_by(Remedy::StepOrHeading))?;
                let even = self.column(time).nth(1).unwrap_or_default() - self.numbers[time];
                self.check_steps(time, Some(even))?;
                Ok(step)
            }
            Some((time, unit)) => {
                self.check_steps(time, None)?;
                Ok(Times::At(self.column(time).map(|time| time * unit.in_seconds()).collect()))
            }
            None => {
                let problem = "no column has times: the time between samples is unknown";
                step.ok_or_else(|| bad(self.first, problem).remedied_by(Remedy::Step))
            }
        }
    }

    fn asked(&self, how: &Reading) -> Result<Option<usize>, BadLine> {
        let refused =
            |asked: &Column, why: String| Err(bad(self.first, format!("the given column is {asked}, but {why}")));
        match &how.column {
            Some(Column::Number(number)) if (1..=self.count).contains(number) => Ok(Some(number - 1)),
            Some(asked @ Column::Number(_)) => refused(asked, format!("there are {}", self.count)),
            Some(asked @ Column::Heading(heading)) => match (self.with_heading(heading), self.headings.first()) {
                (Some(one), _) => Ok(Some(one)),
                (None, None) => refused(asked, "there are no headings".into()),
                (None, Some((_, names))) => refused(asked, format!("the headings are {}", listed(names))),
            },
            Some(asked @ Column::All) => refused(asked, "one has times".into()),
            None => Ok(None),
        }
    }

    /// The one column whose heading is `asked`, or is `asked` without what is in brackets.
    fn with_heading(&self, asked: &str) -> Option<usize> {
        let same = |heading: &str| heading.trim().eq_ignore_ascii_case(asked.trim());
        let name = |heading: &'a str| heading.split(['(', '[', '{']).next().unwrap_or_default();
        let is_it = |column: &usize| self.headings_of(*column).any(|(_, of)| same(of) || same(name(of)));
        let mut found = (0..self.count).filter(is_it);
        found.next().filter(|_| found.next().is_none())
    }

    /// The unit that text before the data states for the column `value`, or for all numbers, and the number of its line. Refuses
    /// a unit in another place unless `how` has the unit: it may be the unit of a peak.
    fn stated_unit(&self, value: Option<usize>, how: &Reading) -> Result<(HeadingUnit, usize), BadLine> {
        let texts: Vec<_> = match value {
            Some(value) => {
                // `#AmplitudeUnit: gal` holds for all columns, and so does `RAW PGA VALUES (gal) : (N-S) 314`.
                let of_all = |&(line, text): &(usize, &'a str)| {
                    let lower = text.to_lowercase();
                    let text = if lower.contains("pga values") { text.split(':').next()? } else { text };
                    let states = lower.contains("uni") || lower.contains("pga values");
                    (states && matches!(HeadingUnit::of(text), HeadingUnit::Unit(_))).then_some((line, text))
                };
                self.headings_of(value).chain(self.before.iter().filter_map(of_all)).collect()
            }
            None => self.before.iter().filter(|(_, text)| !is_numbers(text)).flat_map(statements).collect(),
        };
        if let Some((line, other)) = texts.iter().find(|(_, text)| is_no_acceleration(text)) {
            let place = value.map_or("a line before the data".into(), |value| format!("column {}", value + 1));
            return Err(bad(*line, format!("{place} is {}: accelerations are needed", quote(other))));
        }
        // A line with times or with an acceleration and brackets heads columns. Other lines may be titles.
        let has_times = |(_, cells): &&(usize, Vec<&str>)| cells.iter().any(|cell| TimeUnit::of(cell).is_some());
        let with_times: Vec<_> = self.headings.iter().filter(has_times).map(|(line, _)| *line).collect();
        let heads = |line: usize, text: &str| {
            let mut words = text.split(|letter: char| !letter.is_alphabetic());
            with_times.contains(&line)
                || text.contains(['(', '[']) && words.any(|word| word.to_lowercase().starts_with("acc"))
        };
        let stated = |(line, text): (usize, &'a str)| match HeadingUnit::of(text) {
            HeadingUnit::Unclear(_) if !heads(line, text) && is_prose(text) => None,
            HeadingUnit::Nothing => None,
            stated => Some((stated, line, text)),
        };
        let mut stated: Vec<_> = texts.into_iter().filter_map(stated).collect();
        // An unclear one, or one that contradicts the first, or the first.
        let unclear = stated.iter().position(|(unit, ..)| matches!(unit, HeadingUnit::Unclear(_)));
        let other = unclear.or(stated.iter().position(|(unit, ..)| *unit != stated[0].0));
        if let Some((unit, _, text)) = other.map(|at| &mut stated[at]) {
            *unit = HeadingUnit::Unclear((*text).to_owned());
        }
        let stated = stated.into_iter().nth(other.unwrap_or_default()).map(|(unit, line, _)| (unit, line));
        let other = self.before.iter().find(|(_, text)| is_no_acceleration(text)).filter(|_| how.unit.is_none());
        let refused = |(line, text): &(usize, &str), why: &str| {
            Err(bad(*line, format!("{} {why}", quote(text))).remedied_by(Remedy::Unit))
        };
        match (stated, self.before.iter().find(|(_, text)| mentions_unit(text))) {
            (None, _) if let Some(other) = other => refused(other, "is said, and no unit of accelerations"),
            (None, Some(unit)) if how.unit.is_none() => {
                refused(unit, "has a unit, and no heading says that it is the unit of the accelerations")
            }
            (stated, _) => Ok(stated.unwrap_or((HeadingUnit::Nothing, self.first))),
        }
    }
}

/// The statements of a line before samples alone, after their numbers: `NPTS= 3, DT= .01 SEC, UNITS=G` has three.
fn statements<'a>(&(line, text): &(usize, &'a str)) -> impl Iterator<Item = (usize, &'a str)> + use<'a> {
    let has_several = Sampling::of(line, text, &Reading::default()).is_ok_and(|stated| stated != Sampling::default());
    text.split(move |letter| has_several && matches!(letter, ',' | ';')).map(move |statement| {
        let last = statement.rsplit([' ', '=', ':', '\t']).find(|word| has_several && is_number(word));
        (line, last.and_then(|last| statement.rsplit_once(last)).map_or(statement, |(_, after)| after))
    })
}

fn without_samples(text: &str) -> BadLine {
    let lines = text.lines().count();
    if text.trim().is_empty() {
        return bad(lines.max(1), "the file is empty");
    }
    let remedy = "lines of numbers alone are needed, without columns of text";
    bad(lines, format!("{lines} line(s) of text and no samples: {remedy}"))
}

/// Whether `text` says velocity or displacement, as the other files of PEER do, or spectral, and not acceleration.
fn is_no_acceleration(text: &str) -> bool {
    let lower = text.to_lowercase().replace("s_a", "sa");
    let mut words = lower.split(|letter: char| !letter.is_alphabetic());
    words.any(|word| matches!(word, "vel" | "velocity" | "disp" | "displacement" | "sa" | "psa"))
        && !lower.contains("acc")
        || lower.contains("spectral acc")
}

fn rises(numbers: impl Iterator<Item = f64> + Clone) -> bool {
    numbers.clone().zip(numbers.skip(1)).all(|(before, at)| at > before)
}

/// Whether numbers grow by even steps, but for rounding.
fn is_even(numbers: impl Iterator<Item = f64> + Clone) -> bool {
    let mut steps = numbers.clone().zip(numbers.skip(1)).map(|(before, at)| at - before);
    let first = steps.next().unwrap_or_default();
    first > 0.0 && steps.all(|step| is_near(step, first))
}

/// Whether a step of times, which may have few digits, is `step`.
fn is_near(found: f64, step: f64) -> bool {
    const ROUNDED: f64 = 0.1;
    (found - step).abs() < ROUNDED * step
}

/// The first of `headings`, as many as a message can show.
fn listed(headings: &[&str]) -> String {
    const SHOWN: usize = 8;
    let names: Vec<_> = headings.iter().take(SHOWN).map(|heading| quote(heading)).collect();
    names.join(", ") + if headings.len() > SHOWN { ", ..." } else { "" }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Origin, Record, Unit, UnitFrom};

    fn read(text: &str, how: &Reading) -> Result<(Record, Origin), BadLine> {
        parse(&crate::text::decode(text.as_bytes())?, how)?.record(how, "table")
    }

    fn problem(text: &str, how: &Reading) -> String {
        let BadLine { line, problem, .. } = read(text, how).unwrap_err();
        format!("{line}: {problem}")
    }

    /// The times and the accelerations in a file of `text`.
    fn samples(text: &str, how: &Reading) -> [Vec<f64>; 2] {
        let (record, _) = read(text, how).unwrap_or_else(|error| panic!("{text}: {error:?}"));
        [record.times().to_vec(), record.acceleration().to_vec()]
    }

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
            "Kocaeli 1999 08 17\n17 March, run 4, north\n4 5 6 (gauges)\n0 0.25\n0.02 -0.001\n0.05 3\n",
            "0.0E-02+2.5E-01\n2.0E-02-1.0E-03\n5.0E-02+3.0E-00\n! end\n",
            "0 2.5E-01\r\r\n.02 \u{2212}1.0E-03\r\r\n.05 3\r\r\n/&\r\r\n",
            "\"0,0\",\"0,25\"\n\"0,02\",\"-1,0E-03\"\n\"0,05\",\"3,0E+00\"\n",
            "acc,time (s)\n0.25,0\n-0.001,0.02\n3,0.05\n",
            "time (ms),a\n0,0.25\n20,-0.001\n50,3\n",
            "0, 0.25,\n0.02, -0.001,\n0.05, 3.0,\n",
            "% MATLAB\n% t a\n0 0.25\n0.02 -0.001\n0.05 3\n",
            "a;t\nm/s2;ms\n0,25;0\n-0,001;20\n3;50\n",
        ] {
            assert_eq!(samples(text, &AS_IT_IS), [[0.0, 0.02, 0.05], [0.25, -1e-3, 3.0]], "{text}");
            let source = read(text, &AS_IT_IS).unwrap().1;
            let from = if text.contains("m/s2") { UnitFrom::File } else { UnitFrom::Assumed };
            assert_eq!((source.unit, source.unit_from), (Unit::MetrePerSecondSquared, from), "{text}");
        }
    }

    #[test]
    fn one_column_needs_a_step_and_several_a_choice() {
        let step = Reading { dt: Some(0.5), ..AS_IT_IS };
        for text in ["acc (g)\n1\n-2,\n3\n", "1.0\n-2.0\n3\n", "  1\n -2\n  3\n", "0,1\n1,-2\n2,3\n"] {
            assert_eq!(samples(text, &step), [[0.0, 0.5, 1.0], [1.0, -2.0, 3.0]], "{text}");
        }
        assert_eq!(read("1\n2\n", &AS_IT_IS).unwrap_err().remedy, Some(Remedy::Step));

        let three = "time (s),N-S (gal),E-W (g)\n0,1,5\n1,2,6\n";
        let unclear = read(three, &AS_IT_IS).unwrap_err();
        assert_eq!(unclear.remedy, Some(Remedy::Column));
        let chosen = |column, dt| read(three, &Reading { column: Some(column), dt, ..AS_IT_IS });
        let heading = |name: &str| Column::Heading(name.into());
        for column in [Column::Number(3), heading("e-w"), heading("E-W (g)")] {
            let (record, source) = chosen(column, None).unwrap();
            assert_eq!((record.acceleration(), source.unit), (&[5.0, 6.0][..], Unit::G));
        }
        let (record, source) = chosen(Column::Number(2), Some(1.0)).unwrap();
        assert_eq!((record.times(), source.unit), (&[0.0, 1.0][..], Unit::CentimetrePerSecondSquared));
        let of_times = chosen(Column::Number(1), None).unwrap_err().problem;
        assert_eq!(of_times, "column 1 has the times, and cannot have the accelerations");
    }

    /// The reader does not guess whether numbers are the samples of one instrument, of two, or times and samples.
    #[test]
    fn several_samples_a_line_are_read_if_it_is_said() {
        let step = Reading { dt: Some(0.5), ..AS_IT_IS };
        let all = Reading { column: Some(Column::All), ..step.clone() };
        for text in ["1 -2 3\n", "3 2 1\n1 2 3\n", "1 -1\n-1 1\n1 -1\n", "0.1 1 2\n1.1 3 2\n2.1 1 0\n", "1 2\n3 4 5\n"]
        {
            let remedy = if text == "1 2\n3 4 5\n" { Remedy::All } else { Remedy::Column };
            assert_eq!(read(text, &step).unwrap_err().remedy, Some(remedy), "{text}");
            let expected: Vec<f64> = text.split_whitespace().map(|word| word.parse().unwrap()).collect();
            assert_eq!(read(text, &all).unwrap().0.acceleration(), expected, "{text}");
            let stated = format!("NPTS={} DT=0.5\n{text}", expected.len());
            assert_eq!(read(&stated, &AS_IT_IS).unwrap().0.acceleration(), expected, "{text}");
        }
        let cut = "NPTS=8 DT=.5\n3 2 1\n1 2 3\n";
        assert_eq!(problem(cut, &AS_IT_IS), "2: cannot tell which of 3 columns has the accelerations");
        assert_eq!(read(cut, &all).unwrap_err().remedy, Some(Remedy::IgnoreCount));
    }

    /// Each heading states the step, and the number of samples or nothing.
    #[test]
    fn a_first_line_of_numbers_may_state_count_and_step() {
        for (text, column) in [
            ("4 .01\n0 .1\n.01 .2\n.02 .3\n.03 .4\n", Column::Number(2)),
            (".01\n0 .1\n.01 .2\n.02 .3\n.03 .4\n", Column::Number(2)),
            ("4\n0 .1\n.01 .2\n.02 .3\n.03 .4\n", Column::Number(2)),
            ("4 .01\n5 .1\n6 .2\n2 .3\n1 .4\n", Column::Number(2)),
            ("4 .01\n.1 .2 .3\n.4\n", Column::All),
            ("4 .01\n.1\n.2\n.3\n.4\n", Column::All),
            ("4 .01 656\n.1 .2\n.3 .4\n", Column::All),
            ("0 .1 .01 .2\n.02 .3 .03 .4\n", Column::Number(2)),
            ("t a t a t a\n0 .1 .01 .2 .02 .3\n.03 .4\n", Column::Number(2)),
        ] {
            let how = Reading { column: Some(column), dt: Some(0.01), ..AS_IT_IS };
            assert_eq!(samples(text, &how), [[0.0, 0.01, 0.02, 0.03], [0.1, 0.2, 0.3, 0.4]], "{text}");
        }
        assert_eq!(read("4 .01\n5 .1\n6 .2\n7 .3\n8.5 .4\n", &AS_IT_IS).unwrap().0.times().len(), 5);
    }

    /// The times are 2.5 ms apart, printed to 1 ms, or 10 ms but for one line.
    #[test]
    fn times_beside_even_ones_are_doubted_and_a_missing_line_is_named() {
        let rows = |time: fn(usize) -> f64| (0..40).map(|i| format!("{},{}\n", time(i), i % 2)).collect::<String>();
        let rounded = rows(|i| (2.5 * i as f64).round() / 1e3);
        let missing = rows(|i| i as f64 / 100.0).replace("0.2,0\n", "");
        for (text, dt, doubt, found) in [
            (
                &rounded,
                0.003,
                "steps of 0.002 to 0.003 s beside even times: are the times rounded? Give the right step",
                "1: the times have a sample every 0.00251282051 s",
            ),
            (
                &missing,
                0.01,
                "steps of 0.01 to 0.02 s beside even times: is a sample missing after t = 0.19 s, or are the times rounded? \
                 Complete the file, or give the right step",
                "21: the times have no sample between 0.19 and 0.21 s",
            ),
        ] {
            assert_eq!(crate::doubts(&read(text, &AS_IT_IS).unwrap().0, 9.81), [doubt]);
            let how = Reading { dt: Some(dt), ..AS_IT_IS };
            assert_eq!(problem(text, &how), format!("{found}, but the given step is {dt} s"));
        }
        for (text, dt) in [(rounded.clone(), Some(0.0025)), ("DT=0.0025\n".to_owned() + &rounded, None)] {
            let (even, _) = read(&text, &Reading { dt, ..AS_IT_IS }).unwrap();
            assert_eq!(even.times()[39], 39.0 * 0.0025);
            assert!(crate::doubts(&even, 9.81).is_empty());
        }
    }

    #[test]
    fn a_stated_step_is_read_whatever_follows_it() {
        for line in [
            "DT=0.01 s",
            "NPTS= 3, DT= .01 SEC, UNITS=G",
            "NPTS=3,DT=.01SEC",
            "3, .01 NPTS, DT",
            "\tnpts =\t3 ,\tdt =\t1D-2\tsec",
            "dt = 0.01s, npts = 3 (of 3)",
            "NPTS= 3, DT= 10 MSEC.",
            "SAMPLING INTERVAL (sec) : 0.01",
            "Sampling rate: 100 Hz",
            "#SampleRate(Hz): 100",
            "Sampling interval 10 ms, raw",
        ] {
            let text = format!("{line}\n1\n2\n4\n");
            assert_eq!(read(&text, &AS_IT_IS).unwrap().0.times(), [0.0, 0.01, 0.02], "{line}");
            let refused = problem(&text, &Reading { dt: Some(0.02), ..AS_IT_IS });
            assert!(refused.ends_with("a sample every 0.01 s, but the given step is 0.02 s"), "{refused}");
        }
    }

    /// The unit can be of a peak; a factor can be in any heading of the column; a unit can stand before another word, after a number,
    /// or beside another unit.
    #[test]
    fn the_user_decides_where_a_unit_is_not_clear() {
        for before in [
            "time acc cm/s2",
            "Acceleration in cm/s2",
            "# peak in g: 0.3",
            "peak 0.3 g",
            "PGA=0.3g",
            "t (s);Accel m/s^2 NS",
            "t (s);acceleration (9.81 m/s2)",
            "t (s);acc (gal, not g)",
            "t (s);a (10^-3 g)",
            "t (s);a*1000\ns;g",
            "t (s);a (gal)\ns;g",
            "t (s);g\n;x 1000",
            "t (s);a (g/1000)",
        ] {
            let text = format!("{before}\n0;1\n.5;2\n");
            assert_eq!(read(&text, &AS_IT_IS).unwrap_err().remedy, Some(Remedy::Unit), "{before}");
            let source = read(&text, &Reading { unit: Some(Unit::MilliG), ..AS_IT_IS }).unwrap().1;
            assert_eq!((source.unit, source.unit_from), (Unit::MilliG, UnitFrom::User), "{before}");
        }
        let one = |line: &str| read(&format!("{line}\n1\n2\n"), &Reading { dt: Some(0.1), ..AS_IT_IS });
        for line in ["Acceleration in cm/s2", "# Accelerations in units of cm/sec^2.", "unit: gal"] {
            assert_eq!(one(line).unwrap().1.unit, Unit::CentimetrePerSecondSquared, "{line}");
        }
        for line in ["# peak 0.3 g", "acc (cm/seg2)", "acc (kN)", "acceleration [counts]"] {
            assert_eq!(one(line).unwrap_err().remedy, Some(Remedy::Unit), "{line}");
        }
    }

    /// Three components, as NSMN, UNAM and CWB write them: lines before them have the step, and may have a unit for all.
    #[test]
    fn a_refusal_names_every_option_that_is_needed() {
        let gal = Unit::CentimetrePerSecondSquared;
        let step = "SAMPLING INTERVAL (sec) : 0.005";
        for (before, remedy) in [
            (format!("NUMBER OF DATA : 2\n{step}\nPeak (gal) : (N-S) 314\nN-S  E-W  U-D"), Remedy::ColumnAndUnit),
            ("INTERVALO DE MUESTREO, C1-C6 (s) : /.005/.005\nUNIDADES DE LOS DATOS : gal".into(), Remedy::Column),
            ("#SampleRate(Hz): 200\n#AmplitudeUnit:  gal. DCoffset(corr)\n#MAX. U: 4.09~ -4.3".into(), Remedy::Column),
        ] {
            let text = before + "\n .02 .10 .03\n .01 -.2 .02\n";
            assert_eq!(read(&text, &AS_IT_IS).unwrap_err().remedy, Some(remedy), "{text}");
            let unit = (remedy == Remedy::ColumnAndUnit).then_some(gal);
            let (record, source) = read(&text, &Reading { column: Some(Column::Number(2)), unit, ..AS_IT_IS }).unwrap();
            assert_eq!((record.times()[1], record.acceleration()[1], source.unit), (0.005, -0.2, gal), "{text}");
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
        let step = Reading { dt: Some(0.01), ..AS_IT_IS };
        let all = Reading { column: Some(Column::All), ..step.clone() };
        let spectrum = |why| format!("{why} no record of a_g(t), unless you head column 1 time (s)");
        let count =
            |what, npts| format!("{what}: write # before it and the numbers above, or NPTS= {npts} if it is a sample");
        let from = |line| format!("{line}: column 1 has even times from here on: write # before the numbers above");
        let other = |heading| format!("1: column 2 is \"{heading}\": accelerations are needed");
        let no_samples = "lines of numbers alone are needed, without columns of text";
        let as_it_is = [
            ("", "1: the file is empty"),
            ("\n \n", "2: the file is empty"),
            ("t,a\n\n.5,1\n", "3: the file ends after 1 sample(s); two or more are needed"),
            ("# c\n0.1,1\nx,2\n", "3: the time \"x\" is not a number: write # before a line of text"),
            ("0,1\ninf,2\n", "2: the time \"inf\" is not a number: write # before a line of text"),
            ("t,a\n", &format!("1: 1 line(s) of text and no samples: {no_samples}")),
            ("0,1\n1,NaN\n", "2: the acceleration \"NaN\" is not a number"),
            ("0,1\n1,\n", "2: 1 column(s) instead of 2 as on line 1"),
            ("1D-3 2D-3\n3D-3 4D-\n", "2: the acceleration \"4D-\" is not a number: its exponent is cut off"),
            ("0,1,2\n1,,2\n", "2: in column 2, \"\" is not a number"),
            ("t,a\n0,1\n.5,2\n0.5,3\n", "4: column 1 cannot have the times: 0.5 comes after 0.5"),
            ("0,1\n.5,2\n0.4,3\n", "3: column 1 cannot have the times: 0.4 comes after 0.5"),
            ("0,.1\n1,.2\n\n2,.3\n", "3: a blank line amid the data: something may be missing there"),
            ("0 1\n1 2 3\n", "2: 3 column(s) instead of 2 as on line 1"),
            ("0;1\n0,5;1.234,5\n", "2: the acceleration \"1.234,5\" is not a number"),
            ("0,O.1\n.5,1\n1,2\n", "1: \"0,O.1\" is neither numbers nor text: correct it, or write # before it"),
            ("0 1\n1 1.23-4\n", "2: the acceleration \"1.23-4\" is not a number: write 1.23E-4 or 1.23 -4"),
            ("0 1\n1 2\nend data\n", "3: the time \"end\" is not a number: write # before a line of text"),
            ("NPTS= 3.5\n1\n2\n", "1: NPTS = \"3.5\" must be a whole number, 2 to 10000000"),
            ("DT=.01 SEC, DT=.02\n1\n2\n", "1: two steps are stated, 0.01 s and 0.02 s: correct one of them"),
            ("DT=1/100\n1\n2\n", "1: DT = \"1/100\" must be a number of seconds greater than 0"),
            ("Sampling rate: 100/s\n1\n2\n", "1: SAMPLING RATE = \"100/S\" must be a rate in Hz"),
            ("Sampling rate: 0 Hz\n1\n2\n", "1: SAMPLING RATE = \"0 HZ\" must be a rate in Hz"),
            ("DT=0.005 min\n1\n2\n", "1: DT = \"0.005 MIN\" must be a number of seconds greater than 0"),
            (
                "DT=0.02\nt,a\n0,1\n.01,2\n.02,3\n",
                "3: DT states a sample every 0.02 s, and the times have a sample every 0.01 s: correct one of them",
            ),
            ("NPTS=4\nt,a\n0,1\n.5,2\n", "4: NPTS states 4 samples, and the file has 2"),
            ("t (min),a (g)\n0,1\n.5,2\n", "1: column 1 is \"t (min)\", which is no time in s or ms"),
            ("time,velocity\n0,1\n.5,2\n", &other("velocity")),
            ("time,Displacement\n0,1\n.5,2\n", &other("Displacement")),
            ("time,disp (cm)\n0,1\n.5,2\n", &other("disp (cm)")),
            ("time,vel_x\n0,1\n.5,2\n", &other("vel_x")),
            ("time,Sa (g)\n0,1\n.5,2\n", &other("Sa (g)")),
        ];
        let of_all = [
            ("4\n1\n2\n3\n2\n", &*count("1: 4 is the number of samples after it", 5)),
            (".01\n1\n2\n", &count("1: 0.01 is the given step", 3)),
            ("t,a\n0,1\n.5,2\n", "2: the given column is all, but one has times"),
            ("0 .1\n.01 .2\n.02 .3\n.03 .1\n", "1: the given column is all, but one has times"),
        ];
        let steps = [
            ("n,a\n1,.1\n2,.2\n4,.3\n", "4: column 1 cannot count the samples: 4.0 comes after 2.0"),
            (
                "Period (sec)    Response Acceleration (g)\n.02 .3\n.04 .4\n.06 .3\n",
                &spectrum("1: column 1 is \"Period (sec)\", which is no time: this is"),
            ),
            (".02 .3\n.04 .4\n.1 .3\n", &spectrum("1: uneven steps and no number below 0: this is a spectrum,")),
            (
                &format!("Periyot (s),Ivme (g)\n{}", ".1,.2\n.2,.3\n".repeat(5)),
                &(spectrum("2: no number below 0, and the first line is not at 0: this is a spectrum,")
                    + " without a line on spectra"),
            ),
            ("# displacement in m\n0 .1\n.02 .2\n", "1: \"# displacement in m\" is said, and no unit of accelerations"),
            ("400 0\n0 .1\n.01 .2\n.02 .3\n", &from(2)),
            ("*DEFINE_CURVE\n$# lcid sidr\n1 0 1.0 0\n$# a1 o1\n0 .1\n.01 .2\n.02 .3\n*END\n", &from(5)),
            ("9.81\n0.01\n.1\n.2\n-.3\n", &count("2: 0.01 is the given step", 5)),
        ];
        for (how, cases) in [(AS_IT_IS, &as_it_is[..]), (all, &of_all), (step.clone(), &steps)] {
            for (text, expected) in cases {
                assert_eq!(problem(text, &how), *expected, "{text}");
            }
        }
        assert_eq!(read("DT=1/100\n1\n2\n", &step).unwrap().0.times()[1], 0.01);
    }
}
