//! A quantity over a step: its part that is linear in the components of the motion, and bounds of the rest.
//!
//! The leaves are `L` functions of time, such as θ, u and time itself. The linear part is exact: its slopes weigh the
//! coefficients of the leaves, so that g sin θ and k u/m cancel as far as they do.

use super::{Number, Turn, operators};
use crate::series::taylor::{ORDERS, sum_of_magnitudes, weighed_sum};

/// start + Σ slope_i (leaf_i − its start) + a rest.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Linear<const L: usize> {
    /// Value at the start of the step.
    start: f64,
    /// Slope in each leaf.
    slopes: [f64; L],
    /// Bound of the change of the linear part over the step.
    change: f64,
    /// Bound of the rate of the linear part, per step.
    rate: f64,
    /// Bound of the rest, which is 0 at the start.
    pub rest: f64,
    /// Bound of the rate of the rest, per step.
    pub rest_rate: f64,
}

/// A leaf: its value at the start, and bounds over the step.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Leaf {
    pub start: f64,
    /// Bound of the change from the start.
    pub change: f64,
    /// Bound of the rate, per step; infinite if nobody asks for it.
    pub rate: f64,
}

impl Leaf {
    /// A leaf with these coefficients, of which no power of σ exceeds 1.
    #[inline(always)]
    pub(crate) fn of(coefficients: &[f64]) -> Leaf {
        let (start, changing) = coefficients.split_first().unwrap_or((&0.0, &[]));
        Leaf { start: *start, change: sum_of_magnitudes(changing), rate: weighed_sum(&ORDERS[1..], changing) }
    }

    /// Leaves without their rates, for bounds that do not ask whether a quantity turns round; `row` gives their coefficients of each
    /// order up to `order`.
    #[inline(always)]
    pub(crate) fn several<const N: usize>(order: usize, row: impl Fn(usize) -> [f64; N]) -> [Leaf; N] {
        let mut leaves = row(0).map(|start| Leaf { start, change: 0.0, rate: f64::INFINITY });
        for k in 1..ORDERS.len().min(order + 1) {
            for (leaf, c) in leaves.iter_mut().zip(row(k)) {
                leaf.change += c.abs();
            }
        }
        leaves
    }

    /// The slope of such a leaf per unit of σ, without its rate.
    #[inline(always)]
    pub(crate) fn of_slope(coefficients: &[f64]) -> Leaf {
        let (start, higher) = (coefficients.get(1).unwrap_or(&0.0), coefficients.get(2..).unwrap_or_default());
        Leaf { start: *start, change: weighed_sum(&ORDERS[2..], higher), rate: f64::INFINITY }
    }
}

impl<const L: usize> Linear<L> {
    #[inline(always)]
    fn plus(&self, other: &Self) -> Self {
        Linear {
            start: self.start + other.start,
            slopes: std::array::from_fn(|i| self.slopes[i] + other.slopes[i]),
            change: self.change + other.change,
            rate: self.rate + other.rate,
            rest: self.rest + other.rest,
            rest_rate: self.rest_rate + other.rest_rate,
        }
    }

    /// x y = x₀ y₀ + (x₀ l_y + y₀ l_x) + x₀ r_y + y₀ r_x + (l_x + r_x)(l_y + r_y), l the linear parts less their start.
    #[inline(always)]
    fn times(&self, other: &Self) -> Self {
        let (x, y) = (self.start.abs(), other.start.abs());
        let [(x_change, x_rate), (y_change, y_rate)] =
            [self, other].map(|of| (of.change + of.rest, of.rate + of.rest_rate));
        Linear {
            start: self.start * other.start,
            slopes: std::array::from_fn(|i| self.start * other.slopes[i] + other.start * self.slopes[i]),
            change: x * other.change + y * self.change,
            rate: x * other.rate + y * self.rate,
            rest: x * other.rest + y * self.rest + x_change * y_change,
            rest_rate: x * other.rest_rate + y * self.rest_rate + x_change * y_rate + y_change * x_rate,
        }
    }

    #[inline(always)]
    fn map(&self, linear: impl Fn(f64) -> f64) -> Self {
        let of = |part: f64| linear(part).abs();
        Linear {
            start: linear(self.start),
            slopes: self.slopes.map(&linear),
            change: of(self.change),
            rate: of(self.rate),
            rest: of(self.rest),
            rest_rate: of(self.rest_rate),
        }
    }

    /// Coefficient `k` of the linear part, given the coefficients of the `leaves` but the last, which is time.
    #[inline(always)]
    pub(crate) fn coefficient<const M: usize>(&self, k: usize, leaves: &[f64; M]) -> f64 {
        const { assert!(M + 1 == L) };
        if k == 0 {
            return self.start;
        }
        let of_time = if k == 1 { self.slopes[M] } else { 0.0 };
        (0..M).fold(of_time, |sum, leaf| sum + self.slopes[leaf] * leaves[leaf])
    }

    /// The leaf at place `which`, times `slope`.
    #[inline(always)]
    pub(crate) fn leaf(which: usize, slope: f64, Leaf { start, change, rate }: Leaf) -> Self {
        let mut slopes = [0.0; L];
        slopes[which] = slope;
        let size = slope.abs();
        Linear { start: slope * start, slopes, change: size * change, rate: size * rate, rest: 0.0, rest_rate: 0.0 }
    }

    /// A quantity that is no leaf: all of its change is a rest.
    #[inline(always)]
    pub(crate) fn loose(Leaf { start, change, rate }: Leaf) -> Self {
        Linear { rest: change, rest_rate: rate, ..Linear::constant(start) }
    }

    /// The turn by the rotation θ, which is the leaf at place `which`, with (sin θ₀, cos θ₀) at the start.
    #[inline(always)]
    pub(crate) fn turn(which: usize, Leaf { change, rate, .. }: Leaf, (sin, cos): (f64, f64)) -> Turn<Self> {
        let about = |start: f64, slope: f64| Linear {
            start,
            rest: (slope.abs() * change / 3.0 + start.abs()) * change * change / 2.0,
            rest_rate: (slope.abs() * change / 2.0 + start.abs()) * change * rate,
            ..Linear::leaf(which, slope, Leaf { start: 0.0, change, rate })
        };
        let cosine = about(cos, -sin);
        Turn { sin: about(sin, cos), cos: cosine, versine: Linear::constant(1.0) - cosine }
    }
}

operators!([const L: usize] Linear<L>);

impl<const L: usize> Number for Linear<L> {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        Linear { start: value, slopes: [0.0; L], change: 0.0, rate: 0.0, rest: 0.0, rest_rate: 0.0 }
    }
}
