//! How a line of text is cut into fields: what separates them, and what stands before decimals.

use super::text::{number, quote};
use super::unit::{Stated, TimeUnit};
use super::{Column, Reading};
use std::borrow::Cow;

/// How the fields of a line are told apart, and what stands before the digits after the point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Layout {
    /// None for blanks and tabs.
    separator: Option<char>,
    pub decimal_comma: bool,
}

/// The fields of `line`, however they are separated, without empty ones.
pub(super) fn words(line: &str) -> Vec<&str> {
    let fields = split(line, |letter| letter.is_whitespace() || matches!(letter, ',' | ';'));
    fields.into_iter().map(unquoted).filter(|field| !field.is_empty()).collect()
}

pub(super) fn is_number(word: &str) -> bool {
    number(&word.replace(',', ".")).is_some()
}

/// Whether `line` has numbers and nothing else.
pub(super) fn is_numbers(line: &str) -> bool {
    let words = words(line);
    !words.is_empty() && words.into_iter().all(is_number)
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
pub(super) fn headings<'a>(line: &'a str, count: usize) -> Option<Vec<&'a str>> {
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
    pub fn of<'a, L: Iterator<Item = &'a str>>(
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
        let is_part = |field: &str| field.len() > 1 && field.starts_with('0') && field.parse::<u64>().is_ok();
        let has_parts = |line: &str| commas(line) > 1 && line.split(',').any(|field| is_part(field.trim()));
        if !has('.') && lines().any(has_parts) && !lines().any(|line| line.trim().contains(char::is_whitespace)) {
            return Err("commas stand between numbers and before decimals: write a semicolon between columns".into());
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
        Ok(if is_one_column { Layout { separator: None, decimal_comma: true } } else { separated(',') })
    }

    pub fn fields<'a>(&self, line: &'a str) -> Vec<&'a str> {
        let fields = match self.separator {
            Some(separator) => {
                split(line.trim_end().trim_end_matches([separator, ' ', '\t']), |letter| letter == separator)
            }
            None => split(line.trim(), char::is_whitespace).into_iter().filter(|field| !field.is_empty()).collect(),
        };
        fields.into_iter().map(unquoted).collect()
    }

    /// A number as Rust writes it. With decimal commas a point is none before decimals.
    pub fn plain<'a>(&self, field: &'a str) -> Cow<'a, str> {
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
/// whole numbers. A heading or the option says so, or a field that is no whole number, as `-0` and `05`; else an error.
fn is_one_column<'a, L: Iterator<Item = &'a str>>(
    lines: impl Fn() -> L,
    before: &[&str],
    how: &Reading,
) -> Result<bool, String> {
    let has_quantity = |cell: &str| TimeUnit::of(cell).is_some() || matches!(Stated::of(cell), Stated::Unit(_));
    let has_two = before.iter().filter_map(|line| headings(line, 2)).flatten().any(has_quantity);
    if has_two || matches!(how.column, Some(Column::Number(2..))) {
        return Ok(false);
    }
    let is_no_pair = |line: &str| match line.trim().split_once(',') {
        Some((before, after)) => before == "-0" || (after.len() > 1 && after.starts_with('0')),
        None => true,
    };
    if lines().any(is_no_pair) {
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
