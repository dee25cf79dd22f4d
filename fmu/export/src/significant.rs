//! Numbers for people to read.

/// `value` with six significant digits.
pub fn significant(value: f64) -> String {
    const DIGITS: i32 = 6;
    let scientific = format!("{value:.*e}", DIGITS as usize - 1);
    match scientific.split_once('e').and_then(|(_, exponent)| exponent.parse().ok()) {
        Some(exponent @ -4..DIGITS) => format!("{value:.*}", (DIGITS - 1 - exponent) as usize),
        _ => scientific,
    }
}

/// Six digits without zeros at their end.
pub fn short(value: f64) -> String {
    let rounded: f64 = format!("{value:.5e}").parse().expect("a number in Rust's own notation");
    format!("{rounded:?}").trim_end_matches(".0").to_owned()
}

/// `value` with all its digits, but without long rows of zeros.
pub fn in_full(value: f64) -> String {
    if value == 0.0 || (1e-3..1e5).contains(&value.abs()) { value.to_string() } else { format!("{value:e}") }
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
    fn numbers_are_short() {
        let shown = [0.005, 0.01 + 1e-12, 1.0, 12.5, 0.348_123_456, 1e-12, 4000.0, 1e120].map(short);
        assert_eq!(shown, ["0.005", "0.01", "1", "12.5", "0.348123", "1e-12", "4000", "1e120"]);
    }
}
