//! Tables of text: a sample on each line, with a comma, a semicolon or blanks between its numbers, or the samples alone, one
//! after the other, as many on a line as there are; after any lines of text.
//!
//! What a column has follows from its heading, or from what its numbers cannot be. Whole numbers without a unit of time
//! count the samples, or are milliseconds: the file does not tell, so that the time between samples is to be given.

use super::at2::npts_and_dt;
use super::parsed::{Parsed, Times, usual_step};
use super::text::{nine_digits, number, numbered, quote, without_blanks};
use super::unit::{Stated, TimeUnit, mentions_unit};
use super::{BadLine, Column, Format, Reading, Remedy, bad, source::decide};
use std::borrow::Cow;

const LONGEST_HEADER: usize = 1000;

/// Parts of a step within which times as they are written may be off.
const SAME_STEP: f64 = 0.1;

/// How the fields of a line are told apart, and what stands before the digits after the point.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Layout {
    /// None for blanks and tabs.
    separator: Option<char>,
    decimal_comma: bool,
}

/// The numbers of a file, and what is said before them.
struct Table<'a> {
    text: &'a str,
    /// The lines of text before the numbers, and their cells where they have as many as there are columns.
    before: Vec<(&'a str, Option<Vec<&'a str>>)>,
    /// Number of samples and time between them (s), where a line before the samples states both.
    stated: Option<(usize, f64)>,
    /// The first line of samples.
    first: usize,
    last: usize,
    layout: Layout,
    /// How many numbers the first line has.
    count: usize,
    /// Those of all lines.
    numbers: Vec<f64>,
    /// The line that has fewer, which must be the last unless `stated` tells how many there are.
    short: Option<BadLine>,
}

/// Where the samples are in a table.
enum Samples {
    /// All numbers are samples, one after the other.
    All,
    /// The column of times, with their unit in s, or none if the column that is there counts the samples; that of
    /// accelerations.
    Columns { time: Option<(usize, f64)>, value: usize },
}

/// The samples of a table as `how` says; `#` begins a comment line.
pub(super) fn parse(text: &str, how: &Reading) -> Result<Parsed, BadLine> {
    let table = Table::read(text, how)?;
    let samples = table.samples(how)?;
    let value = match samples {
        Samples::Columns { value, .. } if table.count > 1 => Some(value),
        _ => None,
    };
    let stated = table.stated_unit(value)?;
    let contradiction = |problem| BadLine { remedy: stated.remedy(), ..bad(table.first, problem) };
    let (unit, unit_from) = decide(&stated, how.unit).map_err(contradiction)?;
    let times = match (&samples, table.stated, how.dt) {
        (Samples::Columns { time: Some((time, second)), .. }, ..) => {
            Times::At(table.column(*time).map(|time| time * second).collect())
        }
        (_, Some((_, dt)), _) => Times::Every(dt),
        (_, None, Some(dt)) => Times::Asked(dt),
        (_, None, None) => return Err(table.without_times()),
    };
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
    let mut add = |a: f64| parsed.add(Ok(a), table.last);
    match value {
        Some(value) => table.column(value).try_for_each(&mut add)?,
        None => table.numbers.iter().copied().try_for_each(&mut add)?,
    }
    if let Times::At(times) = &parsed.times {
        if let Some(row) = times.windows(2).position(|pair| pair[1] <= pair[0]) {
            let (before, at) = (times[row], times[row + 1]);
            let problem = format!("the time {at:?} s does not come after the one before it, {before:?} s");
            return Err(bad(table.line(row + 1), problem));
        }
        if let Some((row, step, usual)) = gap(times) {
            let ([step, usual], line) = ([step, usual].map(nine_digits), table.line(row));
            parsed.warn(format!("line {line}: {step} s after the sample before it, where most steps are {usual} s"));
        }
    }
    if let Some((npts, _)) = table.stated {
        parsed.check_count("NPTS", npts, how)?;
    }
    Ok(parsed)
}

/// The first sample that comes more than five usual steps after the one before it: its index, that step, and the usual
/// one (s).
fn gap(times: &[f64]) -> Option<(usize, f64, f64)> {
    const MOST: f64 = 5.0;
    let usual = usual_step(times)?;
    let index = times.windows(2).position(|pair| pair[1] - pair[0] > MOST * usual)?;
    Some((index + 1, times[index + 1] - times[index], usual))
}

impl<'a> Table<'a> {
    fn read(text: &'a str, how: &Reading) -> Result<Table<'a>, BadLine> {
        let mut beginning = numbered(text).take(LONGEST_HEADER);
        let Some((mut first, sample)) = beginning.find(|(_, line)| !is_comment(line) && is_numbers(line)) else {
            let last = text.lines().take(LONGEST_HEADER).count().max(1);
            let problem =
                "no line of numbers alone up to here; two or more samples are needed, without columns of text";
            return Err(bad(last, problem));
        };
        let before: Vec<_> = text.lines().take(first - 1).filter(|line| !line.trim().is_empty()).collect();
        let after = |line: usize| numbered(text).skip(line).filter(|(_, line)| !is_comment(line));
        let lines = |line: usize| after(line).map(|(_, line)| line).filter(|line| !line.trim().is_empty());
        let mut stated = before.iter().find_map(|line| npts_and_dt(line).ok());
        if stated.is_none() {
            stated = bare_npts_and_dt(sample, || lines(first));
            if stated.is_some() {
                first = after(first).find(|(_, line)| !line.trim().is_empty()).map_or(first, |(line, _)| line);
            } else if let Some(line) = before.last().filter(|line| !is_comment(line) && is_damaged(line, sample)) {
                let problem = format!("{} is neither a line of numbers nor one of text", quote(line));
                return Err(bad(first - 1, problem).remedied_by(Remedy::Comment));
            }
        }
        let layout = Layout::of(|| lines(first - 1), &before, how).map_err(|problem| bad(first, problem))?;
        let count = layout.fields(lines(first - 1).next().unwrap_or_default()).len();
        let cells = |line: &'a str| (line, headings(line, count).filter(|_| count > 1));
        let before = before.into_iter().map(cells).collect();
        let mut table =
            Table { text, before, stated, first, last: first, layout, count, numbers: Vec::new(), short: None };
        for line in without_blanks(after(first - 1)) {
            let (line, sample) = line?;
            let fields = layout.fields(sample);
            let found = fields.len();
            table.last = line;
            if stated.is_none()
                && let Some(short) = table.short.take()
            {
                return Err(short);
            }
            if found != count {
                let problem = format!("{found} column(s) instead of {count} as on line {first}");
                let problem = bad(line, problem).remedied_by(Remedy::Comment);
                if found > count && stated.is_none() {
                    return Err(problem);
                }
                table.short.get_or_insert(problem);
            }
            for (column, field) in fields.into_iter().enumerate() {
                let number = number(&layout.plain(field));
                table.numbers.push(number.ok_or_else(|| bad(line, table.no_number(column, field)))?);
            }
        }
        Ok(table)
    }

    fn no_number(&self, column: usize, field: &str) -> String {
        let time = self.headed_time().map_or(0, |(time, _)| time);
        let what = match self.count {
            2 if column == time => "the time".to_owned(),
            1 | 2 => "the acceleration".to_owned(),
            _ => format!("in column {},", column + 1),
        };
        let has_both = self.layout.decimal_comma && field.contains('.');
        let is = if has_both { "has a point, and others have decimal commas" } else { "is not a number" };
        format!("{what} {} {is}", quote(field))
    }

    /// The numbers of the column, where all lines have as many.
    fn column(&self, column: usize) -> impl Iterator<Item = f64> + Clone {
        self.numbers.iter().skip(column).step_by(self.count).copied()
    }

    /// The line that has the sample of this index.
    fn line(&self, row: usize) -> usize {
        let samples = numbered(self.text).skip(self.first - 1);
        samples.filter(|(_, line)| !is_comment(line)).nth(row).map_or(self.first, |(line, _)| line)
    }

    /// The rows of headings, each with as many cells as there are columns.
    fn headings(&self) -> impl Iterator<Item = &[&'a str]> {
        self.before.iter().filter_map(|(_, cells)| cells.as_deref())
    }

    fn has_headings(&self) -> bool {
        self.headings().next().is_some()
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
        let rows = self.numbers.len() / count;
        let headed = self.headed_time();
        let is_acceleration =
            |column| self.headings_of(column).any(|heading| matches!(Stated::of(heading), Stated::Unit(_)));
        let may_be_times = count == 2
            || how
                .dt
                .is_none_or(|dt| counts(self.column(0)) || has_step(self.column(0), [dt, dt * (count - 1) as f64]));
        let begins_with_times = count > 1 && rises(self.column(0)) && !is_acceleration(0) && may_be_times;
        let are_all = match self.stated {
            Some((npts, _)) => npts != rows && (npts == self.numbers.len() || !begins_with_times),
            None => !begins_with_times && (self.short.is_some() || !self.has_headings() && self.is_smooth()),
        };
        if let (1, None, [npts, after @ ..]) = (count, self.stated, self.numbers.as_slice())
            && *npts > 1.0
            && [after.len(), after.len().saturating_sub(1)].contains(&(*npts as usize))
            && npts.fract() == 0.0
        {
            let problem = format!("{npts} is the number of the samples after it");
            return Err(bad(first, problem).remedied_by(Remedy::Comment));
        }
        if count == 1 || headed.is_none() && how.column.is_none() && are_all {
            return Ok(Samples::All);
        }
        let time = headed.or(begins_with_times.then_some((0, TimeUnit::Unstated)));
        if let Some(short) = &self.short {
            return Err(short.clone());
        }
        let is_count = |column: usize| counts(self.column(column));
        let counted = time.as_ref().filter(|(column, unit)| *unit == TimeUnit::Unstated && is_count(*column));
        let counted = counted.map(|(column, _)| *column);
        let time = match time.filter(|(column, _)| Some(*column) != counted) {
            Some((column, unit)) => Some((column, unit.in_seconds().map_err(|problem| bad(first, problem))?)),
            None => None,
        };
        let has_times = |column: usize| Some(column) == counted || time.is_some_and(|(time, _)| time == column);
        let mut left: Vec<_> = (0..count).filter(|column| !has_times(*column)).collect();
        if left.len() > 1 && left[0] == 0 && rises(self.column(0)) && is_count(0) && !is_acceleration(0) {
            left.remove(0); // it counts the samples
        }
        let value = self.value(&left, how)?;
        if has_times(value) {
            let problem = format!("column {} has the times, and cannot have the accelerations", value + 1);
            return Err(bad(first, problem));
        }
        if let Some(heading) = self.headings_of(value).find(|heading| is_no_acceleration(heading)) {
            let problem = format!("column {} is {}, and accelerations are needed", value + 1, quote(heading));
            return Err(bad(first, problem));
        }
        if let Some(counted) = counted {
            self.check_steps(counted)?;
        }
        Ok(Samples::Columns { time, value })
    }

    /// The column of accelerations: the one that is asked for, or the only one that is `left`.
    fn value(&self, left: &[usize], how: &Reading) -> Result<usize, BadLine> {
        let &Table { count, first, .. } = self;
        match &how.column {
            Some(Column::Number(number)) if (1..=count).contains(number) => Ok(number - 1),
            Some(Column::Number(number)) => {
                Err(bad(first, format!("column {number} is asked for, and there are {count}")))
            }
            Some(Column::Heading(asked)) => self.with_heading(asked).map_err(|problem| bad(first, problem)),
            None if left.len() == 1 => Ok(left[0]),
            None if left.len() == count && how.dt.is_none() && self.stated.is_none() => Err(self.without_times()),
            None => {
                let names = self.headings().next().map_or(String::new(), |names| format!(" ({})", listed(names)));
                let problem = format!("{count} columns{names}: which has the accelerations is not known");
                Err(bad(first, problem).remedied_by(Remedy::Column))
            }
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
            ([], Some(names)) => Err(format!("column {asked} is asked for, and the headings are {}", listed(names))),
            _ => Err(format!("column {asked} is asked for, and {} columns have that heading", found.len())),
        }
    }

    /// Why there are no times.
    fn without_times(&self) -> BadLine {
        let times = || self.column(0);
        let fall = times().zip(times().skip(1)).enumerate().find(|(_, (before, after))| after <= before);
        let (line, why) = match (self.count, fall) {
            (1, _) => (self.first, "one column".to_owned()),
            (_, Some((row, (before, after)))) => {
                (self.line(row + 1), format!("column 1 has {after:?} after {before:?}, which are no times"))
            }
            (_, None) => {
                let why = "column 1 has whole numbers, which count the samples or are milliseconds, for no heading has \
                           a unit, as time (ms) does";
                (self.first, why.to_owned())
            }
        };
        bad(line, format!("{why}: the time between samples is not known")).remedied_by(Remedy::Step)
    }

    /// Refuses a column that counts the samples and leaves some out.
    fn check_steps(&self, counted: usize) -> Result<(), BadLine> {
        let steps = || self.column(counted).zip(self.column(counted).skip(1)).map(|(before, after)| after - before);
        let usual = steps().next().unwrap_or(1.0);
        match steps().position(|step| step != usual) {
            Some(row) => {
                let step = steps().nth(row).unwrap_or(usual);
                let problem = format!(
                    "column {} counts on by {step}, and by {usual} before: something may be missing there",
                    counted + 1
                );
                Err(bad(self.line(row + 1), problem))
            }
            None => Ok(()),
        }
    }

    /// Whether the numbers may follow one another line by line: they do not if they change much less down the columns, as
    /// those of several instruments do.
    fn is_smooth(&self) -> bool {
        const MUCH: f64 = 2.0;
        let change = |apart: usize| {
            let pairs = self.numbers.iter().zip(&self.numbers[apart.min(self.numbers.len())..]);
            pairs.map(|(one, other)| (one - other).abs()).sum::<f64>()
        };
        self.numbers.len() == self.count || change(1) <= MUCH * change(self.count)
    }

    /// What is said before the data of the unit of the column `value`, or of all numbers.
    fn stated_unit(&self, value: Option<usize>) -> Result<Stated, BadLine> {
        let (mut found, mut mentioned) = (Stated::Nothing, Stated::Nothing);
        for (line, cells) in &self.before {
            let stated = match value {
                Some(value) => cells.as_ref().map_or(Stated::Nothing, |cells| Stated::of(cells[value])),
                None if is_no_acceleration(line) && !line.to_lowercase().contains("acc") => {
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
                _ if mentions_unit(line) => mentioned = Stated::Mentioned((*line).to_owned()),
                _ => {}
            }
        }
        Ok(if found == Stated::Nothing { mentioned } else { found })
    }
}

/// NPTS and DT (s) where `line` has nothing but them: the line after it has other numbers than two, or there are as many
/// samples as it says.
fn bare_npts_and_dt<'a, L: Iterator<Item = &'a str>>(line: &str, after: impl Fn() -> L) -> Option<(usize, f64)> {
    const LONGEST_STEP: f64 = 1.0;
    let [npts, dt] = words(line).try_into().ok()?;
    let npts: usize = npts.parse().ok().filter(|npts| *npts > 1)?;
    let dt = number(dt).filter(|dt| *dt > 0.0 && *dt < LONGEST_STEP)?;
    let next = words(after().next()?);
    let is_stated = || {
        let (lines, next) = (after().count(), number(next[0]));
        (lines == npts || lines == npts.div_ceil(2)) && next.is_some_and(|next| next < npts as f64)
    };
    (next.len() != 2 || is_stated()).then_some((npts, dt))
}

/// Whether `numbers` rise from each to the next.
fn rises(numbers: impl Iterator<Item = f64> + Clone) -> bool {
    numbers.clone().zip(numbers.skip(1)).all(|(before, after)| after > before)
}

/// Whether `numbers` are whole ones, and more than one.
fn counts(mut numbers: impl Iterator<Item = f64>) -> bool {
    let is_whole = |number: f64| number.fract() == 0.0;
    numbers.next().is_some_and(is_whole) && numbers.next().is_some_and(is_whole) && numbers.all(is_whole)
}

/// Whether times that rise from each to the next do so by one of the `steps`: of the samples, or of lines that begin with
/// the time and have several.
fn has_step(times: impl Iterator<Item = f64>, steps: [f64; 2]) -> bool {
    let usual = usual_step(&times.collect::<Vec<_>>());
    usual.is_some_and(|usual| steps.into_iter().any(|step| (usual - step).abs() < SAME_STEP * step))
}

/// Whether a heading is of velocities or displacements.
fn is_no_acceleration(heading: &str) -> bool {
    let heading = heading.to_lowercase();
    heading
        .split(|letter: char| !letter.is_alphabetic())
        .any(|word| matches!(word, "vel" | "velocity" | "disp" | "displ" | "displacement"))
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

/// The fields of `line`, however they are separated, without empty ones.
fn words(line: &str) -> Vec<&str> {
    let fields = split(line, |letter| letter.is_whitespace() || matches!(letter, ',' | ';'));
    fields.into_iter().map(unquoted).filter(|field| !field.is_empty()).collect()
}

fn is_number(word: &str) -> bool {
    number(&word.replace(',', ".")).is_some()
}

/// Whether `line` has numbers and nothing else.
fn is_numbers(line: &str) -> bool {
    let words = words(line);
    !words.is_empty() && words.into_iter().all(is_number)
}

/// Whether `line` may be a sample that is damaged, like `sample` otherwise.
fn is_damaged(line: &str, sample: &str) -> bool {
    let words_of_line = words(line);
    words_of_line.len() == words(sample).len() && is_number(words_of_line[0])
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

/// The `count` cells of a line of headings, which may be a comment: however it is divided, and without numbers among them.
/// Single blanks divide headings of one word each, of which one has times.
fn headings<'a>(line: &'a str, count: usize) -> Option<Vec<&'a str>> {
    let line = line.trim_start_matches([' ', '\t', '#', '%', '!', '/']).trim_end_matches([' ', '\t', ',', ';']);
    let is_time = |word: &&str| TimeUnit::of(word).is_some();
    let divided: [&dyn Fn() -> Vec<&'a str>; 6] = [
        &|| split(line, |letter| letter == ';'),
        &|| split(line, |letter| letter == ','),
        &|| not_blank(split(line, |letter| letter == '\t')),
        &|| not_blank(line.split_inclusive([')', ']', '}'])),
        &|| not_blank(line.split("  ")),
        &|| Some(words(line)).filter(|words| words.iter().any(is_time)).unwrap_or_default(),
    ];
    let cells = divided.into_iter().map(|cells| cells()).find(|cells| cells.len() == count)?;
    let cells: Vec<_> = cells.into_iter().map(unquoted).collect();
    (!cells.iter().any(|cell| is_number(cell))).then_some(cells)
}

fn not_blank<'a>(cells: impl IntoIterator<Item = &'a str>) -> Vec<&'a str> {
    cells.into_iter().filter(|cell| !cell.trim().is_empty()).collect()
}

impl Layout {
    /// That of lines of numbers. A semicolon separates wherever there is one, and so does a comma, unless each is between
    /// digits and blanks separate, or there is no more than one on a line that has no point.
    fn of<'a, L: Iterator<Item = &'a str>>(
        lines: impl Fn() -> L,
        before: &[&str],
        how: &Reading,
    ) -> Result<Layout, String> {
        let has = |letter: char| lines().any(|line| line.contains(letter));
        let separated = |separator| Layout { separator: Some(separator), decimal_comma: false };
        if has(';') {
            return Ok(Layout { decimal_comma: has(','), ..separated(';') });
        }
        let commas = |line: &str| split(line, |letter| letter == ',').len() - 1;
        if lines().all(|line| commas(line) == 0) {
            // a comma that stands in quotes alone is one before decimals
            return Ok(Layout { separator: None, decimal_comma: has(',') });
        }
        let is_decimal = |pair: &[&str]| {
            pair[0].ends_with(|letter: char| letter.is_ascii_digit())
                && pair[1].starts_with(|letter: char| letter.is_ascii_digit())
        };
        if !lines().all(|line| split(line, |letter| letter == ',').windows(2).all(is_decimal)) {
            return Ok(Layout { decimal_comma: has('"') && lines().any(has_comma_in_quotes), ..separated(',') });
        }
        if lines().any(|line| line.trim().contains(char::is_whitespace)) {
            return Ok(Layout { separator: None, decimal_comma: true });
        }
        if has('.') || lines().any(|line| line.contains('"')) {
            return Ok(Layout { decimal_comma: lines().any(has_comma_in_quotes), ..separated(',') });
        }
        let is_one_column = lines().all(|line| commas(line) < 2) && is_one_column(&lines, before, how)?;
        let is_part = |field: &str| field.len() > 1 && field.starts_with('0');
        if !is_one_column && lines().any(|line| line.split(',').any(is_part)) {
            return Err("commas stand between numbers and before decimals: write a semicolon between columns".into());
        }
        Ok(if is_one_column { Layout { separator: None, decimal_comma: true } } else { separated(',') })
    }

    fn fields<'a>(&self, line: &'a str) -> Vec<&'a str> {
        let fields = match self.separator {
            Some(separator) => {
                split(line.trim_end().trim_end_matches([separator, ' ', '\t']), |letter| letter == separator)
            }
            None => split(line.trim(), char::is_whitespace).into_iter().filter(|field| !field.is_empty()).collect(),
        };
        fields.into_iter().map(unquoted).collect()
    }

    /// A number as Rust writes it. With decimal commas a point is none before decimals.
    fn plain<'a>(&self, field: &'a str) -> Cow<'a, str> {
        match self.decimal_comma {
            true if field.contains('.') => Cow::Borrowed("."),
            true => Cow::Owned(field.replacen(',', ".", 1)),
            false => Cow::Borrowed(field),
        }
    }
}

fn has_comma_in_quotes(line: &str) -> bool {
    split(line, |letter| letter == ',').iter().any(|field| field.contains(','))
}

/// Whether lines with a comma each, between digits and without a point, are one column with decimal commas, and not two of
/// whole numbers; an error if both may be.
fn is_one_column<'a, L: Iterator<Item = &'a str>>(
    lines: impl Fn() -> L,
    before: &[&str],
    how: &Reading,
) -> Result<bool, String> {
    let has_times =
        before.iter().filter_map(|line| headings(line, 2)).flatten().any(|cell| TimeUnit::of(cell).is_some());
    if has_times || matches!(how.column, Some(Column::Number(2..))) {
        return Ok(false);
    }
    let parts: Vec<_> = lines().map(|line| line.trim().split_once(',')).collect();
    let is_no_pair = |part: &Option<(&str, &str)>| match part {
        Some((before, after)) => *before == "-0" || (after.len() > 1 && after.starts_with('0')),
        None => true,
    };
    let wholes: Vec<f64> = parts.iter().flatten().filter_map(|(before, _)| number(before)).collect();
    if parts.iter().any(is_no_pair) || !rises(wholes.into_iter()) {
        return Ok(true);
    }
    Err(format!(
        "{} may be two whole numbers or one with a decimal comma: write a point before decimals, or a semicolon between \
         columns",
        quote(lines().next().unwrap_or_default())
    ))
}

impl std::fmt::Display for Layout {
    fn fmt(&self, out: &mut std::fmt::Formatter) -> std::fmt::Result {
        let separator = match self.separator {
            Some(';') => "semicolons",
            Some(_) => "commas",
            None => "blanks",
        };
        let comma = if self.decimal_comma { ", decimal comma" } else { "" };
        write!(out, "separated by {separator}{comma}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::run::record::{Record, Source, Unit, UnitFrom};
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
            ("t/s,a/gal\n", cm),
            ("# peak in g: 0.3\nt,a (gal)\n", cm),
            ("time,a_g[g]\n", Unit::G),
            ("time,acc\ns,mm/s2\n", Unit::MillimetrePerSecondSquared),
            ("Time (s) Acceleration (m/s^2)\n", Unit::MetrePerSecondSquared),
        ] {
            let text = format!("{before}0,1\n.5,2\n");
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
        assert_eq!(read("t,a\n0,1\n.5,2\n", &asked).unwrap().1.unit_from, UnitFrom::User);
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
        for text in [
            "acc (g)\n1\n-2,\n3\n",
            "a\n1,0\n-2,0\n3,0\n",
            "1.0\n-2.0\n3\n",
            "  1\n -2\n  3\n",
            "1 -2 3\n",
            "0,1\n1,-2\n2,3\n",
            "n;t;a\n5;0;1\n10;500;-2\n15;1000;3\n".replace("n;t;a", "n;t (ms);a").as_str(),
        ] {
            let (record, _) = read(text, &step).unwrap();
            assert_eq!(
                (record.times(), record.acceleration()),
                (&[0.0, 0.5, 1.0][..], &[1.0, -2.0, 3.0][..]),
                "{text}"
            );
        }
        for text in ["1\n2\n", "0,1\n1,-2\n2,3\n", "t,a\n0,1\n5,-2\n10,3\n", "3 2 1\n1 2 3\n"] {
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
        let lines = "0.1 1 2\n1.1 3 2\n2.1 1 0\n";
        assert_eq!(read(lines, &step).unwrap_err().remedy, Some(Remedy::Column), "a time and two samples a line");
        let array = "1 50\n2 60\n1 70\n0 60\n";
        assert_eq!(read(array, &step).unwrap_err().remedy, Some(Remedy::Column), "the columns of two instruments");
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

    #[test]
    fn a_step_must_be_that_of_the_times() {
        let with = |dt, column: Option<usize>| Reading { dt: Some(dt), column: column.map(Column::Number), ..AS_IT_IS };
        for text in ["time,acc\n0.00,1\n0.01,2\n0.02,-3\n", "0.00 1\n0.01 2\n0.02 -3\n"] {
            for column in [None, Some(2)] {
                let (record, _) = read(text, &with(0.01, column)).unwrap();
                assert_eq!((record.times(), record.acceleration()), (&[0.0, 0.01, 0.02][..], &[1.0, 2.0, -3.0][..]));
                let refused = problem(text, &with(0.02, column));
                assert!(refused.ends_with("every 0.01 s, and 0.02 s is asked for"), "{refused}");
            }
        }
        assert!(problem("time,acc\n0,1\n.5,2\n", &with(1.0, Some(1))).contains("column 1 has the times"));
        for (text, times) in [("time_ms,acc\n0,1\n10,2\n", [0.0, 0.01]), ("t_s,acc\n0,1\n10,2\n", [0.0, 10.0])] {
            assert_eq!(read(text, &AS_IT_IS).unwrap().0.times(), times);
        }
    }

    #[test]
    fn velocities_are_no_accelerations() {
        for name in ["velocity", "Displacement", "vel", "disp (cm)", "vel_x"] {
            let expected = format!("2: column 2 is {name:?}, and accelerations are needed");
            assert_eq!(problem(&format!("time,{name}\n0,1\n.5,2\n"), &AS_IT_IS), expected);
        }
    }

    #[test]
    fn a_comma_is_decimal_or_a_separator_or_the_table_is_refused() {
        let with = |column: Option<usize>| Reading { dt: Some(0.1), column: column.map(Column::Number), ..AS_IT_IS };
        for one in ["0,12\n-0,35\n0,5\n1,25\n", "1,25\n-2,5\n3,75\n", "a\n1,0\n-2,0\n3,0\n"] {
            let expected: Vec<f64> = one.lines().filter_map(|line| line.replace(',', ".").parse().ok()).collect();
            for column in [None, Some(1)] {
                assert_eq!(read(one, &with(column)).unwrap().0.acceleration, expected, "{one}");
            }
            assert_eq!(read(one, &AS_IT_IS).unwrap_err().remedy, Some(Remedy::Step));
        }
        let two = "0,1\n1,2\n2,3\n3,5\n";
        for how in [AS_IT_IS, with(None)] {
            assert!(problem(two, &how).contains("may be two whole numbers or one with a decimal comma"));
        }
        assert_eq!(read(two, &with(Some(2))).unwrap().0.acceleration, [1.0, 2.0, 3.0, 5.0]);
        assert_eq!(read(&format!("t (ms),a\n{two}"), &AS_IT_IS).unwrap().0.times, [0.0, 0.001, 0.002, 0.003]);
        assert!(
            problem("0,01,0,12\n0,02,0,15\n", &with(None)).contains("commas stand between numbers and before decimals")
        );
        assert_eq!(
            problem("0,5;0.1\n1;1,234.5\n", &AS_IT_IS),
            "1: the acceleration \"0.1\" has a point, and others have decimal commas"
        );
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
            assert_eq!(record.acceleration, samples, "{text}");
            assert_eq!(record.times, [0.0, 0.01, 0.02, 0.03, 0.04], "{text}");
            let fewer = &text[..text.trim_end().rfind(['\n', ' ']).unwrap()];
            assert!(read(fewer, &AS_IT_IS).is_err(), "{fewer}");
        }
    }

    #[test]
    fn text_is_no_data_and_damaged_data_are_no_text() {
        for title in ["Kocaeli 1999 08 17", "17 March, run 4", "(1) 2 3"] {
            let (record, _) = read(&format!("{title}\n0.0 0.1\n0.5 0.2\n"), &AS_IT_IS).unwrap();
            assert_eq!((record.times, record.acceleration), (vec![0.0, 0.5], vec![0.1, 0.2]), "{title}");
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
    fn a_gap_is_said_with_its_line() {
        let warnings = |text: &str| read(text, &AS_IT_IS).unwrap().1.warnings;
        let gap = "t a\n0 1\n0.01 2\n0.02 3\n# pause\n0.23 4\n0.24 5\n";
        assert_eq!(warnings(gap), ["line 6: 0.21 s after the sample before it, where most steps are 0.01 s"]);
        assert!(warnings("t a\n0 1\n0.01 2\n0.02 3\n0.07 4\n").is_empty());
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
            ("", "1: no line of numbers alone up to here; two or more samples are needed, without columns of text"),
            ("t,a\n\n0,1\n", "3: the file ends after 1 sample(s); two or more are needed"),
            ("# c\n0.1,1\nx,2\n", "3: the time \"x\" is not a number"),
            ("0,1\ninf,2\n", "2: the time \"inf\" is not a number"),
            (
                "t,a\nt,a\n",
                "2: no line of numbers alone up to here; two or more samples are needed, without columns of text",
            ),
            ("0,1\n1,NaN\n", "2: the acceleration \"NaN\" is not a number"),
            ("0,1\n1,\n", "2: 1 column(s) instead of 2 as on line 1"),
            ("0,1,2\n1,,2\n", "2: in column 2, \"\" is not a number"),
            ("t,a\n0,1\n.5,2\n0.5,3\n", "4: the time 0.5 s does not come after the one before it, 0.5 s"),
            (
                "0,1\n.5,2\n0.5,3\n",
                "3: column 1 has 0.5 after 0.5, which are no times: the time between samples is not known",
            ),
            ("0,.1\n1,.2\n\n2,.3\n", "3: a blank line amid the data: something may be missing there"),
            ("0 1\n1 2 3\n", "2: 3 column(s) instead of 2 as on line 1"),
            ("0;1\n0,5;1.234,5\n", "2: the acceleration \"1.234,5\" has a point, and others have decimal commas"),
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
