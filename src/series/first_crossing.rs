//! The first instant at which gaps close, found without ever stepping over it.
//!
//! A gap is open while its polynomial g is positive. From σ on, with |g''| ≤ M over the step, g stays positive at
//! least for δ, the positive root of g(σ) + g'(σ) δ − M δ²/2 = 0. Marching by δ cannot pass a root, however close two
//! of them are, and converges to a simple one quadratically, from the left. Where a gap has only just opened its
//! first terms are so small that marching would hardly move; their signs then say how far it is open.

use crate::series::taylor::{Series, ZERO, sum_of_magnitudes};
use std::ops::Add;
use wide::f64x2;

/// A gap over one step: the polynomial `offset + sign·Σ c_k σ^k`.
#[derive(Clone, Copy, Debug)]
pub struct Gap<'a> {
    coefficients: &'a [f64],
    sign: f64,
    offset: f64,
}

/// The result of a search over one step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Crossing {
    /// The gaps do not close over the step.
    None,
    /// They close at this σ.
    At(f64),
    /// They do not close up to this σ, where the search gave up: a fresh expansion from there has tighter bounds.
    NoneUntil(f64),
}

impl Crossing {
    /// The σ at which it cuts the step; ∞ for none.
    pub fn sigma(self) -> f64 {
        match self {
            Crossing::None => f64::INFINITY,
            Crossing::At(sigma) | Crossing::NoneUntil(sigma) => sigma,
        }
    }
}

/// Evaluations after which a march ends where it is.
const MAX_EVALUATIONS: usize = 100;

/// Part of its way that a march clears, or it goes on over a quarter of that way, for which M is smaller.
const LEAST_CLEARED: f64 = 1.0 / 16.0;

impl<'a> Gap<'a> {
    /// The gap `offset + sign·Σ c_k σ^k`, of no more coefficients than a [`Series`] has.
    pub fn new(coefficients: &'a [f64], sign: f64, offset: f64) -> Gap<'a> {
        Gap { coefficients, sign, offset }
    }

    /// Whether the magnitudes of its terms prove it positive up to σ = `reach` ≤ 1.
    #[inline]
    pub fn is_open_throughout(&self, reach: f64) -> bool {
        self.offset + self.sign * self.coefficients[0] > sum_of_magnitudes(&self.coefficients[1..]) * reach
    }

    /// The σ up to which (but no further than 1) the signs of its first terms prove it positive: while no term up to
    /// order j is negative, they outweigh the others up to c_j/Σ_{k>j} |c_k|.
    fn open_by_signs(&self) -> f64 {
        let term = |k: usize| self.sign * self.coefficients[k] + if k == 0 { self.offset } else { 0.0 };
        let orders = self.coefficients.len();
        if term(0) <= 0.0 {
            return 0.0;
        }
        let first_negative = (1..orders).find(|k| term(*k) < 0.0).unwrap_or(orders);
        let mut others = (first_negative..orders).fold(0.0, |sum, k| sum + term(k).abs());
        let mut open: f64 = 0.0;
        for k in (0..first_negative).rev() {
            open = open.max(term(k) / others);
            others += term(k);
        }
        open
    }

    /// Bound M of its second derivative up to σ = `reach`.
    fn curvature(&self, reach: f64) -> f64 {
        /// k (k − 1) of each k.
        const FACTORS: Series = {
            let mut factors = ZERO;
            let mut k = 2;
            while k < factors.len() {
                factors[k] = (k * (k - 1)) as f64;
                k += 1;
            }
            factors
        };
        let terms = self.coefficients.get(2..).unwrap_or_default();
        let factors = &FACTORS[2..][..terms.len()];
        let terms = terms.iter().zip(factors).rev().map(|(c, factor)| factor * c.abs());
        if reach == 1.0 { terms.fold(0.0, Add::add) } else { terms.fold(0.0, |sum, term| sum * reach + term) }
    }

    /// For how long after `sigma` it certainly stays positive; 0 where it is not.
    fn open_for(&self, sigma: f64, curvature: f64) -> f64 {
        let (value, slope) = value_and_slope(self.coefficients, sigma);
        let (value, slope) = (self.offset + self.sign * value, self.sign * slope);
        if value <= 0.0 {
            return 0.0;
        }
        let root = (slope * slope + 2.0 * curvature * value).sqrt();
        match slope {
            ..0.0 => 2.0 * value / (root - slope),
            _ if slope + root >= 2.0 * curvature => f64::INFINITY, // beyond σ = 1; the curvature may be 0
            _ => (slope + root) / curvature,
        }
    }
}

/// The polynomial's value and slope at `sigma`, as polynomials in σ² of its even and odd terms: shorter chains.
fn value_and_slope(coefficients: &[f64], sigma: f64) -> (f64, f64) {
    if sigma == 0.0 {
        return (coefficients[0], coefficients.get(1).copied().unwrap_or(0.0));
    }
    let square = f64x2::splat(sigma * sigma);
    let (pairs, last) = coefficients.as_chunks::<2>();
    let mut values = f64x2::new([last.first().copied().unwrap_or(0.0), 0.0]);
    let mut slopes = f64x2::ZERO;
    for pair in pairs.iter().rev() {
        slopes = slopes * square + values;
        values = values * square + f64x2::new(*pair);
    }
    let ([even, odd], [even_slope, odd_slope]) = (values.to_array(), slopes.to_array());
    (even + sigma * odd, 2.0 * sigma * (even_slope + sigma * odd_slope) + odd)
}

/// The first σ in [0, `reach`] at which all `gaps` are closed at once (≤ 0, to rounding).
pub fn first_time_all_closed<const N: usize>(gaps: [Gap; N], reach: f64) -> Crossing {
    if gaps.iter().any(|gap| gap.is_open_throughout(reach)) {
        return Crossing::None;
    }
    match march(&gaps, 0.0, reach) {
        Crossing::NoneUntil(cleared) => {
            let open = gaps.iter().map(Gap::open_by_signs).fold(cleared, f64::max);
            march_over_parts(&gaps, open, reach)
        }
        crossing => crossing,
    }
}

/// The first σ from `sigma` to `reach` at which `gap` is closed.
pub fn first_time_closed_from(gap: Gap, sigma: f64, reach: f64) -> Crossing {
    match march(&[gap], sigma, reach) {
        Crossing::NoneUntil(cleared) => march_over_parts(&[gap], cleared, reach),
        crossing => crossing,
    }
}

/// The first σ in [`sigma`, `reach`] at which all `gaps` are closed at once, over as much of the way as can be cleared.
fn march_over_parts<const N: usize>(gaps: &[Gap; N], mut sigma: f64, reach: f64) -> Crossing {
    let mut end = reach;
    loop {
        match march(gaps, sigma, end) {
            Crossing::NoneUntil(cleared) if cleared < LEAST_CLEARED * end => (sigma, end) = (cleared, 0.25 * end),
            Crossing::None if end < reach => return Crossing::NoneUntil(end),
            crossing => return crossing,
        }
    }
}

/// The first such σ from `sigma` on, up to where the gaps are known not to close at once.
fn march<const N: usize>(gaps: &[Gap; N], mut sigma: f64, reach: f64) -> Crossing {
    if sigma > reach {
        return Crossing::None;
    }
    let curvatures = gaps.map(|gap| gap.curvature(reach));
    for _ in 0..MAX_EVALUATIONS {
        let still_open = gaps.iter().zip(curvatures).map(|(gap, curvature)| gap.open_for(sigma, curvature));
        let next = sigma + still_open.fold(0.0, f64::max);
        if next > reach {
            return Crossing::None;
        }
        if next == sigma {
            return Crossing::At(sigma);
        }
        sigma = next;
    }
    Crossing::NoneUntil(sigma)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::series::taylor::evaluate;
    use approx::assert_abs_diff_eq;
    use proptest::prelude::*;

    fn first(coefficients: &[f64], reach: f64) -> Crossing {
        first_time_all_closed([Gap::new(coefficients, 1.0, 0.0)], reach)
    }

    fn from_roots(roots: &[f64], lead: f64) -> Vec<f64> {
        let mut coefficients = vec![lead];
        for root in roots {
            let mut product = vec![0.0; coefficients.len() + 1];
            for (k, c) in coefficients.iter().enumerate() {
                product[k + 1] += c;
                product[k] -= c * root;
            }
            coefficients = product;
        }
        coefficients
    }

    #[test]
    fn two_roots_a_billionth_apart_are_not_missed() {
        let Crossing::At(sigma) = first(&from_roots(&[0.5, 0.5 + 1e-9], 1.0), 1.0) else { panic!("missed") };
        assert_abs_diff_eq!(sigma, 0.5, epsilon = 2e-8); // where the rounding of a double root puts it
    }

    #[test]
    fn a_clear_graze_is_no_crossing() {
        let mut graze = from_roots(&[0.5, 0.5], 1.0);
        graze[0] += 1e-12;
        assert_eq!(first(&graze, 1.0), Crossing::None);
    }

    #[test]
    fn a_root_at_the_very_end_is_found_and_one_beyond_is_not() {
        assert_eq!(first(&[1.0, -1.0], 1.0), Crossing::At(1.0));
        assert_eq!(first(&[1.0, -1.0], 1.0 - 1e-12), Crossing::None);
    }

    /// As just after an uplift: a triple root at the start, but for terms that are next to nothing.
    #[test]
    fn a_gap_that_has_just_opened_is_not_searched_in_vain() {
        assert_eq!(first(&[4e-46, 3e-34, 7e-23, 1e-15, -2e-16], 1.0), Crossing::None);
        let Crossing::At(sigma) = first(&[4e-46, 3e-34, 7e-23, 1e-15, -2e-15], 1.0) else { panic!("missed") };
        assert_abs_diff_eq!(sigma, 0.5, epsilon = 1e-7);
        assert_eq!(first(&[4e-46, 3e-34, 7e-23, 1e-15], 1.0), Crossing::None);
    }

    #[test]
    fn a_gap_without_a_slope_stays_open() {
        assert_eq!(first_time_closed_from(Gap::new(&[1.0], 1.0, 0.0), 0.2, 1.0), Crossing::None);
    }

    #[test]
    fn a_gap_closed_from_the_start_closes_at_once() {
        assert_eq!(first(&[-1.0, 5.0], 1.0), Crossing::At(0.0));
    }

    #[test]
    fn all_gaps_must_be_closed_at_once() {
        let (one, two) = ([0.2, -1.0], [0.5, -1.0]); // closed from 0.2 on, from 0.5 on
        let both = |reach| first_time_all_closed([Gap::new(&one, 1.0, 0.0), Gap::new(&two, 1.0, 0.0)], reach);
        assert_eq!(both(1.0), Crossing::At(0.5));
        assert_eq!(both(0.4), Crossing::None);
        let closed_before = [-0.1, 1.0]; // closed until 0.1
        let never = first_time_all_closed([Gap::new(&closed_before, 1.0, 0.0), Gap::new(&two, 1.0, 0.0)], 1.0);
        assert_eq!(never, Crossing::None);
    }

    proptest! {
        #[test]
        fn the_first_of_random_roots_is_found(mut roots in prop::collection::vec(0.01..2.0f64, 1..7)) {
            roots.sort_by(f64::total_cmp);
            let lead = if roots.len() % 2 == 0 { 1.0 } else { -1.0 };
            let coefficients = from_roots(&roots, lead);
            let found = match first(&coefficients, 1.0) {
                Crossing::At(sigma) => sigma,
                Crossing::None => f64::INFINITY,
                Crossing::NoneUntil(sigma) => {
                    let rounding = 1e-14 * coefficients.iter().map(|c| c.abs()).sum::<f64>();
                    prop_assert!(sigma <= roots[0] || evaluate(&coefficients, sigma).abs() < rounding);
                    return Ok(());
                }
            };
            // where rounding alone can make the polynomial vanish, its root is anybody's
            let magnitude: f64 = coefficients.iter().map(|c| c.abs()).sum();
            let value_there = evaluate(&coefficients, found.min(1.0));
            if roots[0] <= 1.0 {
                prop_assert!(found <= roots[0] + 1e-9 || value_there.abs() < 1e-14 * magnitude);
                prop_assert!(value_there.abs() <= 1e-14 * magnitude);
            } else {
                prop_assert!(found.is_infinite() || value_there.abs() < 1e-14 * magnitude);
            }
        }
    }
}
