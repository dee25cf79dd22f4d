//! The text of a record's file: its encoding, its lines, the numbers in them.

use super::{BadLine, OBSPY, bad};
use std::borrow::Cow;

/// End mark of DOS, after the last line.
const END_OF_DOS: char = '\x1a';

/// The minus of typesetters.
const MINUS: char = '\u{2212}';

/// The text of a file in UTF-8, UTF-16 or Latin-1, its lines ended by `\n` alone, its minus that of the keyboard. UTF-16 without its mark begins with two
/// letters of ASCII.
pub(super) fn decode(bytes: &[u8]) -> Result<Cow<'_, str>, BadLine> {
    let utf_16 = |order: fn([u8; 2]) -> u16, bytes: &[u8]| {
        let units = bytes.chunks_exact(2).map(|pair| order([pair[0], pair[1]]));
        Cow::Owned(char::decode_utf16(units).map(|letter| letter.unwrap_or(char::REPLACEMENT_CHARACTER)).collect())
    };
    let text: Cow<str> = match bytes {
        [b'P', b'K', 3, 4, ..] | [0x1f, 0x8b, ..] => {
            return Err(bad(1, "the file is packed: unpack it, or save the table as CSV"));
        }
        [0xff, 0xfe, text @ ..] => utf_16(u16::from_le_bytes, text),
        [0xfe, 0xff, text @ ..] => utf_16(u16::from_be_bytes, text),
        [1..=255, 0, 1..=255, 0, ..] => utf_16(u16::from_le_bytes, bytes),
        [0, 1..=255, 0, 1..=255, ..] => utf_16(u16::from_be_bytes, bytes),
        _ => match std::str::from_utf8(bytes) {
            Ok(text) => Cow::Borrowed(text.trim_start_matches('\u{feff}')),
            Err(_) => Cow::Owned(bytes.iter().map(|&byte| char::from(byte)).collect()),
        },
    };
    let text = match text.trim_end().strip_suffix(END_OF_DOS) {
        Some(before) => Cow::Owned(before.to_owned()),
        None => text,
    };
    if let Some(index) = text.find('\0') {
        let line = 1 + text[..index].matches('\n').count();
        let problem = "a byte of 0, which no text has: save it as text in UTF-8";
        return Err(bad(line, problem).remedied_by(OBSPY));
    }
    Ok(match text.contains(['\r', MINUS]) {
        true => Cow::Owned(
            ["\r\r\n", "\r\n", "\r"].iter().fold(text.replace(MINUS, "-"), |text, end| text.replace(end, "\n")),
        ),
        false => text,
    })
}

/// The lines of `text` with their numbers.
pub(super) fn numbered(text: &str) -> impl Iterator<Item = (usize, &str)> {
    (1..).zip(text.lines())
}

/// The value of the first of `lines` that begins with `key`, with a colon between or without, and the number of the line.
pub(super) fn value_of<'a>(lines: impl Iterator<Item = (usize, &'a str)>, key: &str) -> Option<(usize, &'a str)> {
    let mut values = lines.filter_map(|(line, text)| Some((line, text.trim_start().strip_prefix(key)?.trim_start())));
    values.next().map(|(line, value)| (line, value.strip_prefix(':').unwrap_or(value).trim()))
}

/// Whether a mark says that `line` is a comment.
pub(super) fn is_comment(line: &str) -> bool {
    let line = line.trim_start();
    line.starts_with(['#', '%', '!', '$']) || line.starts_with("/&") || line.starts_with("*END")
}

/// The lines of data from `lines` without comments, of which none is blank but at the end, where something may have been lost.
pub(super) fn without_blanks<'a>(
    lines: impl Iterator<Item = (usize, &'a str)>,
) -> impl Iterator<Item = Result<(usize, &'a str), BadLine>> {
    let mut blank = None;
    lines.filter(|(_, line)| !is_comment(line)).filter_map(move |(number, line)| {
        if line.trim().is_empty() {
            blank.get_or_insert(number);
            return None;
        }
        Some(match blank {
            Some(blank) => Err(bad(blank, "a blank line amid the data: something may be missing there")),
            None => Ok((number, line)),
        })
    })
}

/// A number whose multiples by all units are finite; the exponent may be Fortran's, `1.2D-03`.
pub(super) fn number(word: &str) -> Option<f64> {
    const LARGEST_UNIT: f64 = 1e3;
    let parsed = match word.parse() {
        Ok(number) => Some(number),
        Err(_) if word.contains(['d', 'D']) => word.replace(['d', 'D'], "E").parse().ok(),
        Err(_) => None,
    };
    parsed.filter(|number: &f64| (number * LARGEST_UNIT).is_finite())
}

/// The parts of `word` from sign to sign, except for signs of exponents.
fn signed(word: &str) -> Vec<&str> {
    let bytes = word.as_bytes();
    let is_start = |at: &usize| matches!(bytes[*at], b'+' | b'-') && !b"eEdD".contains(&bytes[*at - 1]);
    let ends = (1..bytes.len()).filter(is_start).chain([bytes.len()]);
    ends.scan(0, |start, end| Some(&word[std::mem::replace(start, end)..end])).collect()
}

/// The numbers that `word` has without blanks between them, as a minus fills a column of Fortran; else `word`. Each has a
/// point, unlike an exponent.
pub(super) fn apart(word: &str) -> Vec<&str> {
    Some(signed(word))
        .filter(|parts| parts.iter().all(|part| part.contains('.') && number(part).is_some()))
        .unwrap_or(vec![word])
}

/// That `word` is not a number, and what is wrong or what to type if it may be one.
pub(super) fn no_number(word: &str) -> String {
    let problem = format!("{} is not a number", quote(word));
    let digits = word.trim_end_matches(['+', '-']).strip_suffix(['e', 'E', 'd', 'D']);
    match signed(word)[..] {
        _ if digits.is_some_and(is_number) => format!("{problem}: its exponent is cut off"),
        [digits, power] if [digits, power].iter().all(|part| is_number(part)) => {
            format!("{problem}: write {digits}E{power} or {digits} {power}")
        }
        _ => problem,
    }
}

/// Whether `word` is a number, with a point or a comma before its decimals.
pub(super) fn is_number(word: &str) -> bool {
    number(&word.replace(',', ".")).is_some()
}

/// `value` to nine digits, without the noise of a difference of rounded numbers.
pub(super) fn nine_digits(value: f64) -> f64 {
    format!("{value:.8e}").parse().unwrap_or(value)
}

/// The words of lines of a fixed width: columns of `width` letters, where a number that fills its column leaves no blank
/// before it.
pub(super) fn columns(line: &str, width: Option<usize>) -> Vec<&str> {
    let words: Vec<_> = line.split_whitespace().flat_map(apart).collect();
    match width {
        Some(width) if words.iter().any(|word| word.len() > width || number(word).is_none()) && line.is_ascii() => {
            let starts = (0..line.len()).step_by(width.max(1));
            let cut = starts.map(|start| line[start..line.len().min(start + width.max(1))].trim());
            cut.filter(|word| !word.is_empty()).collect()
        }
        _ => words,
    }
}

/// A quoted field of a file, cut to the length of a message.
pub(super) fn quote(found: &str) -> String {
    const SHOWN: usize = 40;
    let found = found.trim();
    match found.char_indices().nth(SHOWN) {
        Some((end, _)) => format!("{:?}...", &found[..end]),
        None => format!("{found:?}"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_encoding_and_end_of_line_gives_the_same_text() {
        let text = "t [s],a [m/s\u{b2}]\n0,1\n";
        let latin: Vec<u8> = text.chars().map(|letter| letter as u8).collect();
        let little: Vec<u8> = text.encode_utf16().flat_map(u16::to_le_bytes).collect();
        let big: Vec<u8> = text.encode_utf16().flat_map(u16::to_be_bytes).collect();
        let marked = |mark: &[u8], text: &[u8]| [mark, text].concat();
        for bytes in [
            text.as_bytes().to_vec(),
            marked(b"\xef\xbb\xbf", text.as_bytes()),
            latin,
            marked(b"\xff\xfe", &little),
            marked(b"\xfe\xff", &big),
            little,
            big,
            text.replace('\n', "\r\n").into_bytes(),
            text.replace('\n', "\r").into_bytes(),
            marked(text.as_bytes(), b"\x1a\r\n"),
        ] {
            assert_eq!(decode(&bytes).unwrap(), text, "{bytes:?}");
        }
        let binary = bad(2, "a byte of 0, which no text has: save it as text in UTF-8").remedied_by(OBSPY);
        assert_eq!(decode(b"0,1\n\0"), Err(binary));
        for packed in [&b"PK\x03\x04\x14\0"[..], b"\x1f\x8b\x08\0"] {
            assert_eq!(decode(packed), Err(bad(1, "the file is packed: unpack it, or save the table as CSV")));
        }
    }

    #[test]
    fn columns_of_a_fixed_width_come_apart() {
        assert_eq!(columns("  -.001239  -.001228", Some(10)), ["-.001239", "-.001228"]);
        let full = columns("  -999.000000426212.000000  -999.000000", Some(13));
        assert_eq!(full, ["-999.000000", "426212.000000", "-999.000000"]);
        assert_eq!(columns("-123.45678-123.45678   1.00000", Some(10)), ["-123.45678", "-123.45678", "1.00000"]);
        assert_eq!(columns("1 2.5", Some(10)), ["1", "2.5"]);
    }
}
