//! The first instant at which gaps close, found without ever stepping over it.
//!
//! A gap is open while its polynomial g is positive. From σ on, with |g''| ≤ M over the step, g stays positive at
//! least for δ, the positive root of g(σ) + g'(σ) δ − M δ²/2 = 0. Marching by δ cannot pass a root, however close two
//! of them are, and converges to a simple one quadratically, from the left. Once g' < 0 and 4 M g ≤ g'², the gap falls throughout
//! up to σ − 2 g/g' and closes there. A method of fourth order then finds that root in fewer evaluations. Where a gap has only just
//! opened its first terms are so small that marching would hardly move; their signs then say how far it is open.

use crate::series::taylor::{Series, each_order, sum_of_magnitudes, weighed_sum};
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
        const FACTORS: Series = each_order!(k from 2: (k * (k - 1)) as f64);
        let terms = self.coefficients.get(2..).unwrap_or_default();
        if reach == 1.0 {
            return weighed_sum(&FACTORS[2..], terms);
        }
        terms.iter().zip(&FACTORS[2..]).rev().fold(0.0, |sum, (c, factor)| sum * reach + factor * c.abs())
    }

    /// The value and its first three derivatives at `sigma`, from polynomials in σ² of its even and odd terms: shorter chains.
    fn derivatives(&self, sigma: f64) -> [f64; 4] {
        let used = if sigma == 0.0 { self.coefficients.len().min(4) } else { self.coefficients.len() };
        let (square, (pairs, last)) = (f64x2::splat(sigma * sigma), self.coefficients[..used].as_chunks::<2>());
        // the k-th derivatives by σ², over k!
        let mut sums = [f64x2::ZERO; 4];
        sums[0] = f64x2::new([last.first().copied().unwrap_or(0.0), 0.0]);
        for pair in pairs.iter().rev() {
            for k in (1..4).rev() {
                sums[k] = sums[k] * square + sums[k - 1];
            }
            sums[0] = sums[0] * square + f64x2::new(*pair);
        }
        let [[a, b], [a1, b1], [a2, b2], [a3, b3]] = sums.map(|sum| (sum * f64x2::splat(self.sign)).to_array());
        let twice = 2.0 * sigma;
        [
            self.offset + a + sigma * b,
            twice * (a1 + sigma * b1) + b,
            2.0 * (a1 + 3.0 * sigma * b1 + twice * twice * (a2 + sigma * b2)),
            6.0 * (b1 + twice * (2.0 * (a2 + twice * b2) + twice * twice * (a3 + sigma * b3))),
        ]
    }

    /// The root between `sigma`, where the derivatives are these, and `end`, to rounding; none if the method leads elsewhere.
    #[inline(never)]
    fn root(&self, mut sigma: f64, mut derivatives: [f64; 4], end: f64) -> Option<f64> {
        let (from, mut last) = (sigma, 0.0);
        for _ in 0..MAX_EVALUATIONS {
            let [value, slope, bend, jerk] = derivatives;
            let (newton, bend) = (-value / slope, 0.5 * bend / slope);
            let step = newton * (1.0 - newton * (bend - newton * (2.0 * bend * bend - jerk / (6.0 * slope))));
            sigma += step;
            // each step is in proportion to the fourth power of the one before
            if step.abs().powi(5) <= f64::EPSILON * sigma * f64::powi(last, 4) {
                return Some(sigma).filter(|root| (from..=end).contains(root));
            }
            (last, derivatives) = (step, self.derivatives(sigma));
        }
        None
    }
}

/// The first σ in [0, `reach`] at which all `gaps` are closed at once (≤ 0, to rounding).
pub fn first_time_all_closed<const N: usize>(gaps: [Gap; N], reach: f64) -> Crossing {
    if gaps.iter().any(|gap| gap.is_open_throughout(reach)) {
        return Crossing::None;
    }
    // as long as a gap is open the others need not be looked at
    let (mut sigma, mut closed) = (0.0, 0);
    for gap in gaps.iter().cycle().take(N * MAX_EVALUATIONS) {
        match first_time_closed_from(*gap, sigma, reach) {
            Crossing::At(at) if at > sigma => (sigma, closed) = (at, 1),
            Crossing::At(_) => closed += 1,
            crossing => return crossing,
        }
        if closed == N {
            return Crossing::At(sigma);
        }
    }
    Crossing::NoneUntil(sigma)
}

/// The first σ from `sigma` to `reach` at which `gap` is closed.
pub fn first_time_closed_from(gap: Gap, sigma: f64, reach: f64) -> Crossing {
    let (mut sigma, mut end) = match march(&gap, sigma, reach) {
        Crossing::NoneUntil(cleared) if sigma == 0.0 => (gap.open_by_signs().max(cleared), reach),
        Crossing::NoneUntil(cleared) => (cleared, reach),
        crossing => return crossing,
    };
    // over as much of the way as can be cleared
    loop {
        match march(&gap, sigma, end) {
            Crossing::NoneUntil(cleared) if cleared < LEAST_CLEARED * end => (sigma, end) = (cleared, 0.25 * end),
            Crossing::None if end < reach => return Crossing::NoneUntil(end),
            crossing => return crossing,
        }
    }
}

/// The first such σ from `sigma` on, up to where the gap is known not to close.
fn march(gap: &Gap, mut sigma: f64, reach: f64) -> Crossing {
    if sigma > reach {
        return Crossing::None;
    }
    let curvature = gap.curvature(reach);
    for _ in 0..MAX_EVALUATIONS {
        let derivatives @ [value, slope, ..] = gap.derivatives(sigma);
        if value <= 0.0 {
            return Crossing::At(sigma);
        }
        if slope < 0.0 && 4.0 * curvature * value <= slope * slope {
            let falls_until = sigma - 2.0 * value / slope;
            if falls_until <= reach
                && let Some(root) = gap.root(sigma, derivatives, falls_until)
            {
                return Crossing::At(root);
            }
        }
        let root = (slope * slope + 2.0 * curvature * value).sqrt();
        let open: f64 = match slope {
            ..0.0 => 2.0 * value / (root - slope),
            _ if slope + root >= 2.0 * curvature => f64::INFINITY, // beyond σ = 1; the curvature may be 0
            _ => (slope + root) / curvature,
        };
        let next = sigma + open.max(0.0);
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
