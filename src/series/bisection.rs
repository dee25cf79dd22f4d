//! The number at which a condition ends, to rounding.

/// The last number of [`low`, `high`] at which `holds`, which is true from `low` up to some number and false beyond it.
pub fn last_where(mut low: f64, mut high: f64, holds: impl Fn(f64) -> bool) -> f64 {
    loop {
        let middle = low + 0.5 * (high - low);
        if !(low < middle && middle < high) {
            return low; // at rounding, or no number
        }
        *(if holds(middle) { &mut low } else { &mut high }) = middle;
    }
}

#[cfg(test)]
mod tests {
    use super::last_where;

    #[test]
    fn a_root_is_found_to_rounding() {
        let root = last_where(1.0, 2.0, |x| x * x <= 2.0);
        assert!(root * root <= 2.0 && root.next_up() * root.next_up() > 2.0);
        assert_eq!(last_where(-3.0, -1.0, |x| x <= -2.0), -2.0);
    }
}
