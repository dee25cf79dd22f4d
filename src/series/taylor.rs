//! Truncated Taylor series in time: the solver's representation of a motion over one step.
//!
//! The equations of every phase are analytic, so their solution over a step is expanded to as high an order as the
//! tolerance asks. The expansion is its own dense output: a transition is a root of one of its polynomials.
//!
//! Time within a step is σ = τ/span, 0 at its start and 1 at the end of the span that was asked for; the coefficients
//! are then the terms themselves at the end, which can be compared with the tolerance and summed as they are.

/// Highest order of an expansion. At a local error of 1e-16 it carries ω·h of more than 3 rad per step.
pub const MAX_ORDER: usize = 28;

/// The longest span, as ω·h in rad, that an expansion is tried over: more than [`MAX_ORDER`] ever reaches.
pub const LONGEST_SPAN: f64 = 8.0;

/// Part of the motion at uplift below which a motion in full contact is as good as none: squares underflow below it. A structure that
/// comes to rest must not require terms that underflow. Smaller peaks are rounding.
pub(crate) const NEGLIGIBLE: f64 = 1e-150;

/// Coefficients c_k of Σ c_k σ^k.
pub type Series<Q = f64> = [Q; MAX_ORDER + 2];

/// A series of zeros.
pub const ZERO: Series = [0.0; MAX_ORDER + 2];

/// The series with these `coefficients`, and zeros after them.
pub(crate) fn series(coefficients: &[f64]) -> Series {
    let mut series = ZERO;
    series[..coefficients.len()].copy_from_slice(coefficients);
    series
}

/// Coefficient `n` of the product of two series.
pub(crate) fn product(a: &Series, b: &Series, n: usize) -> f64 {
    a[..=n].iter().zip(b[..=n].iter().rev()).map(|(a, b)| a * b).sum()
}

/// Adds to `$sum` the products of `$left` and `$right` factors whose orders sum to `$n`. The right ones are kept backwards, so that
/// both are read in one direction. The `$newest`, of order n, come last and not from memory: the processor can sum the others before
/// it knows them. A macro, because a closure called in wide registers would not be compiled for them.
macro_rules! add_each_product {
    ($add:expr, $sum:expr, $left:expr, $right:expr, $newest:expr, $n:expr) => {
        if $n > 0 {
            let (lefts, last_lefts) = $left[1..$n].as_chunks::<4>();
            let (rights, last_rights) = $right[MAX_ORDER - $n + 1..MAX_ORDER].as_chunks::<4>();
            for (left, right) in lefts.iter().zip(rights) {
                for i in 0..4 {
                    $add($sum, &left[i], &right[i]);
                }
            }
            for (left, right) in last_lefts.iter().zip(last_rights) {
                $add($sum, left, right);
            }
            $add($sum, $newest.0, &$right[MAX_ORDER]);
        }
        $add($sum, &$left[0], $newest.1);
    };
}
pub(crate) use add_each_product;

/// Value at `sigma` of the polynomial with these coefficients.
#[inline]
pub fn evaluate(coefficients: &[f64], sigma: f64) -> f64 {
    if sigma == 1.0 {
        return coefficients.iter().rev().sum();
    }
    coefficients.iter().rev().fold(0.0, |sum, c| sum * sigma + c)
}

/// Σ w_k |c_k|, in four sums side by side: a sum waits for the one before it.
#[inline(always)]
pub(crate) fn weighed_sum(weights: &[f64], coefficients: &[f64]) -> f64 {
    let (fours, rest) = coefficients.as_chunks::<4>();
    let mut sums = [0.0; 4];
    for (weights, four) in weights.as_chunks::<4>().0.iter().zip(fours) {
        for i in 0..4 {
            sums[i] += weights[i] * four[i].abs();
        }
    }
    let of_rest = weights[4 * fours.len()..].iter().zip(rest).map(|(weight, c)| weight * c.abs()).sum::<f64>();
    sums.iter().sum::<f64>() + of_rest
}

/// Σ |c_k|.
#[inline]
pub(crate) fn sum_of_magnitudes(coefficients: &[f64]) -> f64 {
    weighed_sum(&[1.0; MAX_ORDER + 2], coefficients)
}

/// A series whose coefficient of each order `$k` from `$from` on is this, and 0 before.
macro_rules! each_order {
    ($k:ident from $from:literal: $coefficient:expr) => {{
        let mut series = $crate::series::taylor::ZERO;
        let mut $k = $from;
        while $k < series.len() {
            series[$k] = $coefficient;
            $k += 1;
        }
        series
    }};
}
pub(crate) use each_order;

/// The orders, as weights of [`weighed_sum`].
pub(crate) const ORDERS: Series = each_order!(k from 0: k as f64);

/// 1/k, looked up.
#[inline]
pub(crate) fn reciprocal(k: usize) -> f64 {
    const RECIPROCAL: Series = each_order!(k from 1: 1.0 / k as f64);
    RECIPROCAL[k]
}
