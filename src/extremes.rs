//! Where a polynomial is largest: a bound over a step, and its stationary points, none of which is passed over.

use crate::first_crossing::{Crossing, Guard, first_time_all_closed};
use crate::taylor::{Series, ZERO, evaluate};

/// max (σ − σᵏ) over 0 ≤ σ ≤ 1 for k = 2 … 6, rounded up; below 1 for all k.
const OFF_CHORD: [f64; 5] = [0.25, 0.385, 0.473, 0.536, 0.583];

/// Bound of |Σ c_k σᵏ| up to σ = `reach`: its ends, and how far its terms can leave the chord between them.
pub fn bound(coefficients: impl IntoIterator<Item = f64>, reach: f64) -> f64 {
    let (mut start, mut end, mut off_chord, mut power) = (0.0, 0.0, 0.0, 1.0);
    for (k, c) in coefficients.into_iter().enumerate() {
        let term = c * power;
        power *= reach;
        end += term;
        match k {
            0 => start = term,
            1 => (),
            _ => off_chord += term.abs() * OFF_CHORD.get(k - 2).unwrap_or(&1.0),
        }
    }
    f64::max(f64::abs(start), f64::abs(end)) + off_chord
}

/// Shows every σ in (0, `reach`) at which Σ c_k σᵏ is stationary, in their order: between them it rises or falls
/// throughout.
pub fn stationary_points(coefficients: &[f64], reach: f64, mut show: impl FnMut(f64)) {
    let mut slope = ZERO;
    let mut degree = coefficients.len().saturating_sub(1);
    for k in 1..=degree {
        slope[k - 1] = k as f64 * coefficients[k];
    }
    let mut sigma = 0.0;
    // each turn divides a root out of the slope, or gets on
    while degree > 0 {
        if !slope[0].is_normal() {
            if sigma > 0.0 {
                show(sigma);
            }
            divide_by_sigma(&mut slope, &mut degree);
            continue;
        }
        let guard = Guard::new(&slope[..degree], slope[0].signum(), 0.0);
        let (on, is_root) = match first_time_all_closed([guard], reach - sigma) {
            Crossing::None => return,
            Crossing::At(on) => (on, true),
            // no further without a root that cannot be told from where this is
            Crossing::NoneUntil(on) => (on, on <= f64::EPSILON),
        };
        shift(&mut slope[..degree], on);
        sigma += on;
        if is_root {
            show(sigma);
            divide_by_sigma(&mut slope, &mut degree);
        }
    }
}

fn divide_by_sigma(slope: &mut Series, degree: &mut usize) {
    slope.copy_within(1..*degree, 0);
    *degree -= 1;
}

/// Coefficients of the same polynomial about `by`.
pub fn shift(coefficients: &mut [f64], by: f64) {
    let last = coefficients.len().saturating_sub(1);
    for start in 0..last {
        for k in (start..last).rev() {
            coefficients[k] += by * coefficients[k + 1];
        }
    }
}

/// The largest |Σ c_k σᵏ| up to σ = `reach`.
pub fn largest(coefficients: &[f64], reach: f64) -> f64 {
    let at = |sigma: f64| evaluate(coefficients, sigma).abs();
    let mut largest = at(0.0).max(at(reach));
    stationary_points(coefficients, reach, |sigma| largest = largest.max(at(sigma)));
    largest
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;
    use proptest::prelude::*;

    proptest! {
        /// Never below any sample, never above what the samples' spacing explains, within the bound.
        #[test]
        fn the_largest_magnitude_is_that_of_the_samples(
            coefficients in proptest::collection::vec(-1.0..1.0f64, 1..12), reach in 0.1..1.0f64,
        ) {
            let value = largest(&coefficients, reach);
            const SAMPLES: usize = 20_000;
            let at = |i: usize| evaluate(&coefficients, reach * i as f64 / SAMPLES as f64).abs();
            let sampled = (0..=SAMPLES).map(at).fold(0.0, f64::max);
            let curvature: f64 = coefficients.iter().enumerate().map(|(k, c)| (k * k) as f64 * c.abs()).sum();
            let unseen = curvature * (reach / SAMPLES as f64).powi(2) / 8.0;
            prop_assert!(value >= sampled * (1.0 - 1e-14) && value <= sampled + unseen + 1e-14, "{value} {sampled}");
            prop_assert!(bound(coefficients.iter().copied(), reach) >= value);
        }
    }

    #[test]
    fn every_stationary_point_is_found() {
        // derivative (σ − 0.1)(σ − 0.1000001)(σ − 0.7)
        let (a, b, c) = (0.1, 0.1000001, 0.7);
        let slope = [-a * b * c, a * b + a * c + b * c, -(a + b + c), 1.0];
        let polynomial: Vec<_> = std::iter::once(0.3).chain((1..).zip(slope).map(|(k, c)| c / f64::from(k))).collect();
        let mut found = Vec::new();
        stationary_points(&polynomial, 1.0, |sigma| found.push(sigma));
        assert_eq!(found.len(), 3, "{found:?}");
        for (found, expected) in found.into_iter().zip([a, b, c]) {
            assert_abs_diff_eq!(found, expected, epsilon = 2e-8); // where rounding puts roots 1e-7 apart
        }
    }

    #[test]
    fn a_shift_moves_the_origin() {
        let mut coefficients = [1.0, -2.0, 3.0, 0.5];
        let expected = evaluate(&coefficients, 0.9);
        shift(&mut coefficients, 0.4);
        assert_abs_diff_eq!(evaluate(&coefficients, 0.5), expected, epsilon = 1e-15);
    }
}
