//! Numbers for people to read: tables have six significant digits, sentences as few as possible.

/// `value` with six significant digits.
pub fn significant(value: f64) -> String {
    const DIGITS: i32 = 6;
    let scientific = format!("{value:.*e}", DIGITS as usize - 1);
    match scientific.split_once('e').and_then(|(_, exponent)| exponent.parse().ok()) {
        Some(exponent @ -4..DIGITS) => format!("{value:.*}", (DIGITS - 1 - exponent) as usize),
        _ => scientific,
    }
}

/// `value` for a sentence: as it is with up to nine digits, which a user may have typed, otherwise rounded to six.
pub fn short(value: f64) -> String {
    let rounded = |decimals: usize| format!("{value:.decimals$e}").parse::<f64>().unwrap_or(value);
    let rounded = if rounded(8) == value { value } else { rounded(5) };
    let digits = if rounded.abs() < 1e7 { format!("{rounded:?}") } else { format!("{rounded:e}") };
    digits.trim_end_matches(".0").to_owned()
}

/// `value` with its `unit`, as [`short`] as possible; a ratio has no unit.
pub fn with_unit(value: f64, unit: &str) -> String {
    let digits = short(value);
    if unit == "1" { digits } else { format!("{digits} {unit}") }
}

#[cfg(test)]
mod tests {
    use super::{short, significant};

    #[test]
    fn six_digits_whatever_the_magnitude() {
        let shown =
            [0.0, 2.3134801, -36.5744449, 128403.4, 999999.5, 0.0007524671, 7.5e-5, f64::INFINITY].map(significant);
        let expected = ["0.00000", "2.31348", "-36.5744", "128403", "1.00000e6", "0.000752467", "7.50000e-5", "inf"];
        assert_eq!(shown, expected);
    }

    #[test]
    fn numbers_of_sentences_are_short() {
        let shown = [0.005, 0.01 + 1e-12, 1.0, 12.5, 131.775_107_589_381_32, 0.990_000_1, -4000.0, 1e120, f64::NAN];
        let expected = ["0.005", "0.01", "1", "12.5", "131.775", "0.9900001", "-4000", "1e120", "NaN"];
        assert_eq!(shown.map(short), expected);
    }
}
