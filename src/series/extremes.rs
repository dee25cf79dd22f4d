//! The largest magnitude of a polynomial: bounds over a step, and all of its stationary points.

use crate::series::first_crossing::{Crossing, Gap, first_time_closed_from};
use crate::series::taylor::{Series, ZERO, each_order, evaluate, weighed_sum};

/// max (σ − σᵏ) over 0 ≤ σ ≤ 1 of the first k, rounded up.
const OFF_FIRST: [f64; 16] =
    [0.0, 0.0, 0.25, 0.385, 0.473, 0.535, 0.583, 0.62, 0.651, 0.676, 0.697, 0.716, 0.732, 0.746, 0.758, 0.77];

/// The same for each k.
pub(crate) const OFF_CHORD: Series = each_order!(k from 0: if k < OFF_FIRST.len() { OFF_FIRST[k] } else { 1.0 });

/// How far Σ c_k σᵏ can leave the chord between its ends up to σ = `reach`.
#[inline(always)]
pub fn off_chord(coefficients: &[f64], reach: f64) -> f64 {
    let (weights, higher) = (&OFF_CHORD[2..], coefficients.get(2..).unwrap_or_default());
    if reach < 1.0 {
        let powers = std::iter::successors(Some(reach * reach), |power| Some(power * reach));
        return weights.iter().zip(higher).zip(powers).map(|((weight, c), power)| weight * power * c.abs()).sum();
    }
    weighed_sum(weights, higher)
}

/// Bound of |Σ c_k σᵏ| up to σ = `reach`. The cubic with the values and slopes at both ends has a largest magnitude,
/// and the terms of higher order leave the cubic by a bounded amount.
pub fn bound(coefficients: &[f64], reach: f64) -> f64 {
    let (mut end, mut slope_end, mut off_cubic, mut power) = (0.0, 0.0, 0.0, 1.0);
    for (k, c) in coefficients.iter().enumerate() {
        let term = c * power;
        power *= reach;
        end += term;
        slope_end += k as f64 * term;
        if k > 3 {
            off_cubic += OFF_CUBIC * k as f64 * term.abs();
        }
    }
    let slope_start = coefficients.get(1).map_or(0.0, |c| c * reach);
    largest_of_cubic([coefficients[0], end], [slope_start, slope_end]) + off_cubic
}

/// max |σᵏ − its cubic| over 0 ≤ σ ≤ 1 is at most this times k.
pub(crate) const OFF_CUBIC: f64 = 0.1295;

/// The largest magnitude over 0 ≤ σ ≤ 1 of the cubic with these values and slopes at the ends.
fn largest_of_cubic([start, end]: [f64; 2], [from, to]: [f64; 2]) -> f64 {
    let rise = end - start;
    // the slope is from + b σ + a σ²
    let (a, b) = (3.0 * (from + to - 2.0 * rise), 2.0 * (3.0 * rise - 2.0 * from - to));
    let q = -0.5 * (b + (b * b - 4.0 * a * from).max(0.0).sqrt().copysign(b));
    let at = |sigma: f64| (start + sigma * (from + sigma * (b / 2.0 + sigma * a / 3.0))).abs();
    let turns = [q / a, from / q].into_iter().filter(|sigma| (0.0..=1.0).contains(sigma));
    turns.map(at).fold(start.abs().max(end.abs()), f64::max)
}

/// Shows every σ in (0, `reach`) at which Σ c_k σᵏ is stationary, in their order: between them it rises or falls
/// throughout.
pub fn stationary_points(coefficients: &[f64], reach: f64, mut show: impl FnMut(f64)) {
    let mut slope = ZERO;
    let mut orders = coefficients.len().saturating_sub(1);
    for k in 1..=orders {
        slope[k - 1] = k as f64 * coefficients[k];
    }
    let mut sigma = 0.0;
    // each turn divides a root out of the slope, or gets on
    while orders > 1 {
        let rises = evaluate(&slope[..orders], sigma);
        let (at, is_root) = match rises.is_normal() {
            false => (sigma, true),
            true => match first_time_closed_from(Gap::new(&slope[..orders], rises.signum(), 0.0), sigma, reach) {
                Crossing::None => return,
                Crossing::At(at) => (at, true),
                // no further without a root that cannot be told from where this is
                Crossing::NoneUntil(at) => (at, at - sigma <= f64::EPSILON),
            },
        };
        sigma = at;
        if is_root {
            show(sigma);
            divide_out(&mut slope[..orders], sigma);
            orders -= 1;
        }
    }
}

/// Divides a polynomial by (σ − `root`); what is left over, which is rounding, is dropped. The last coefficient is then
/// of no meaning.
fn divide_out(coefficients: &mut [f64], root: f64) {
    let mut quotient = 0.0;
    for c in coefficients.iter_mut().rev() {
        (*c, quotient) = (quotient, *c + root * quotient);
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
            prop_assert!(bound(&coefficients, reach) >= value * (1.0 - 1e-14));
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
}
