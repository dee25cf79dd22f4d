//! How a line of text is cut into fields: what separates them, and what stands before decimals.

use super::text::{apart, is_number};
use super::unit::TimeUnit;
use std::borrow::Cow;

/// Separator of the fields of a line, and decimal mark.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Layout {
    /// Separator; blanks and tabs separate without one.
    separator: Option<char>,
    pub decimal_comma: bool,
}

/// The fields of `line`, however they are separated, without empty ones.
pub(super) fn words(line: &str) -> Vec<&str> {
    let fields = split(line, |letter| letter.is_whitespace() || matches!(letter, ',' | ';'));
    fields.into_iter().map(unquoted).flat_map(apart).filter(|field| !field.is_empty()).collect()
}

/// Whether `line` has numbers and nothing else.
pub(super) fn is_numbers(line: &str) -> bool {
    let words = words(line);
    !words.is_empty() && words.into_iter().all(is_number)
}

/// Parts of a line between separators outside of quotes.
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
/// Single blanks divide headings of one word each, of which one has times. `*X-AXIS, Time (sec)` heads one of two columns, `*TITLE, …` none.
pub(super) fn cells<'a>(line: &'a str, count: usize) -> Option<Vec<&'a str>> {
    let line = line.trim_start_matches(|mark| " \t#%!/$*".contains(mark)).trim_end_matches([' ', '\t', ',', ';']);
    match line.split_once([',', ':', '=']).map(|(axis, heading)| (axis.trim().to_lowercase(), heading.trim())) {
        Some((axis, heading)) if count == 2 && axis == "x-axis" => return Some(vec![heading, ""]),
        Some((axis, heading)) if count == 2 && axis == "y-axis" => return Some(vec!["", heading]),
        Some((title, _)) if title == "title" => return None,
        _ => {}
    }
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
    /// Layout of lines of numbers. A semicolon always separates. A comma separates unless it is within quotes, or blanks
    /// separate and each comma is between digits.
    pub fn of<'a, L: Iterator<Item = &'a str>>(lines: impl Fn() -> L) -> Layout {
        let unquoted = || lines().flat_map(|line| line.split('"').step_by(2));
        let is_quoted = lines().any(|line| line.split('"').skip(1).step_by(2).any(|quoted| quoted.contains(',')));
        let has = |letter: char| unquoted().any(|part| part.contains(letter));
        let is_decimal = |line: &str| {
            let fields: Vec<_> = line.trim().split(',').collect();
            fields.windows(2).all(|pair| pair[0].ends_with(is_digit) && pair[1].starts_with(is_digit))
        };
        let has_blanks = lines().any(|line| line.trim().contains(char::is_whitespace));
        let (separator, decimal_comma) = match has(',') {
            has_comma if has(';') => (Some(';'), has_comma || is_quoted),
            true if is_quoted || !has_blanks || !lines().all(is_decimal) => (Some(','), is_quoted),
            has_comma => (None, has_comma || is_quoted),
        };
        Layout { separator, decimal_comma }
    }

    pub fn fields<'a>(&self, line: &'a str) -> Vec<&'a str> {
        let fields = match self.separator {
            Some(separator) => {
                split(line.trim_end().trim_end_matches([separator, ' ', '\t']), |letter| letter == separator)
            }
            None => split(line.trim(), char::is_whitespace).into_iter().filter(|field| !field.is_empty()).collect(),
        };
        fields.into_iter().map(unquoted).flat_map(apart).collect()
    }

    /// A number as Rust writes it.
    pub fn plain<'a>(&self, field: &'a str) -> Cow<'a, str> {
        if self.decimal_comma { Cow::Owned(field.replace(',', ".")) } else { Cow::Borrowed(field) }
    }
}

fn is_digit(letter: char) -> bool {
    letter.is_ascii_digit()
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
