//! A quantity over a step as a power series.

use super::taylor::{MAX_ORDER, Series, reciprocal};
use crate::numbers::{Angle, Number, Turn, operators};
use wide::f64x2;

/// Coefficients in σ, as many as the longest series has, rounded up to whole fours.
const LENGTH: usize = (MAX_ORDER + 2).next_multiple_of(4);

/// A power series. The degree makes a product with a constant or a ramp cheap.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Terms {
    coefficients: [f64; LENGTH],
    /// The highest order that may differ from 0.
    degree: usize,
    /// The order at which products end.
    order: usize,
}

impl Terms {
    /// The first `order` + 1 coefficients of `series`.
    #[inline(never)]
    pub(crate) fn of(series: &Series, order: usize) -> Terms {
        let mut terms = Terms { coefficients: [0.0; LENGTH], degree: order, order };
        terms.coefficients[..=order].copy_from_slice(&series[..=order]);
        terms
    }

    /// The series of this `order` with these coefficients.
    #[inline(always)]
    pub(crate) fn from_fn(order: usize, coefficient: impl Fn(usize) -> f64) -> Terms {
        let mut terms = Terms { coefficients: [0.0; LENGTH], degree: order, order };
        terms.coefficients.iter_mut().enumerate().take(order + 1).for_each(|(k, c)| *c = coefficient(k));
        terms
    }

    /// A value that changes by `rise` over σ = 1.
    #[inline(never)]
    pub(crate) fn ramp(value: f64, rise: f64) -> Terms {
        let mut terms = Terms::constant(value);
        if rise != 0.0 {
            terms.coefficients[1] = rise;
            terms.degree = 1;
        }
        terms
    }

    /// The slope per second of this series, σ = 1 being `span` seconds. The coefficient of the highest order is left at 0.
    #[inline(never)]
    pub(crate) fn slope(&self, span: f64) -> Terms {
        let mut slope = Terms { coefficients: [0.0; LENGTH], degree: self.degree.saturating_sub(1), order: self.order };
        for k in 1..=self.degree {
            slope.coefficients[k - 1] = k as f64 * self.coefficients[k] / span;
        }
        slope
    }

    /// The coefficients up to the degree.
    #[inline]
    pub(crate) fn used(&self) -> &[f64] {
        &self.coefficients[..=self.degree]
    }

    #[inline(never)]
    fn plus(&self, other: &Terms) -> Terms {
        let coefficients = std::array::from_fn(|k| self.coefficients[k] + other.coefficients[k]);
        Terms { coefficients, degree: self.degree.max(other.degree), order: self.order.min(other.order) }
    }

    /// The product row by row, so that the sums of four orders run side by side.
    #[inline(never)]
    fn times(&self, other: &Terms) -> Terms {
        let order = self.order.min(other.order);
        let (short, long) = if self.degree <= other.degree { (self, other) } else { (other, self) };
        let degree = (short.degree + long.degree).min(order);
        let factor = short.coefficients[0];
        let mut product = long.map(|c| factor * c);
        (product.degree, product.order) = (degree, order);
        for i in 1..=short.degree.min(degree) {
            let (factor, fours) = (short.coefficients[i], long.degree.min(degree - i) / 4 + 1);
            let sums = product.coefficients[i..].as_chunks_mut::<4>().0;
            for (sums, four) in sums.iter_mut().zip(long.coefficients.as_chunks::<4>().0).take(fours) {
                for lane in 0..4 {
                    sums[lane] += factor * four[lane];
                }
            }
        }
        product.coefficients[degree + 1..].fill(0.0);
        product
    }

    #[inline(never)]
    fn map(&self, linear: impl Fn(f64) -> f64) -> Terms {
        Terms { coefficients: std::array::from_fn(|k| linear(self.coefficients[k])), ..*self }
    }
}

operators!([] Terms);

impl Number for Terms {
    #[inline(never)]
    fn constant(value: f64) -> Terms {
        let mut coefficients = [0.0; LENGTH];
        coefficients[0] = value;
        Terms { coefficients, degree: 0, order: MAX_ORDER + 1 }
    }
}

impl Angle for Terms {
    /// Each order of sin θ and cos θ follows from the orders before, because (cos θ)' = −θ' sin θ.
    fn turn(self) -> Turn<Terms> {
        let theta = &self.coefficients;
        let mut slope = [0.0; LENGTH];
        let mut both = [f64x2::ZERO; LENGTH];
        // sin θ and −cos θ, whose slopes are θ' times (cos θ, sin θ)
        let (sin, cos) = libm::sincos(theta[0]);
        both[0] = f64x2::new([cos, sin]);
        let mut turn = Turn { sin: self, cos: self, versine: self };
        let mut put = |k: usize, sin: f64, cos: f64, versine: f64| {
            turn.sin.coefficients[k] = sin;
            turn.cos.coefficients[k] = cos;
            turn.versine.coefficients[k] = versine;
        };
        put(0, sin, cos, 1.0 - cos);
        for k in 1..=self.order {
            slope[k] = k as f64 * theta[k];
            let mut sum = f64x2::ZERO;
            for (slope, both) in slope[1..=k].iter().zip(both[..k].iter().rev()) {
                sum += f64x2::splat(*slope) * *both;
            }
            let [sin, minus_cos] = (sum * f64x2::splat(reciprocal(k))).to_array();
            both[k] = f64x2::new([-minus_cos, sin]);
            put(k, sin, -minus_cos, minus_cos);
        }
        turn
    }
}
