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

#[cfg(test)]
mod tests {
    use super::significant;

    #[test]
    fn six_digits_whatever_the_magnitude() {
        let shown =
            [0.0, 2.3134801, -36.5744449, 128403.4, 999999.5, 0.0007524671, 7.5e-5, f64::INFINITY].map(significant);
        let expected = ["0.00000", "2.31348", "-36.5744", "128403", "1.00000e6", "0.000752467", "7.50000e-5", "inf"];
        assert_eq!(shown, expected);
    }
}
