//! A bound of a magnitude.

use super::{Angle, Number, Turn, operators};

/// The largest magnitude that a quantity can have over a piece.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Most(pub f64);

impl Most {
    #[inline]
    fn plus(&self, other: &Self) -> Self {
        Most(self.0 + other.0)
    }

    #[inline]
    fn times(&self, other: &Self) -> Self {
        Most(self.0 * other.0)
    }

    #[inline]
    fn map(&self, linear: impl Fn(f64) -> f64) -> Self {
        Most(linear(self.0).abs())
    }
}

operators!([] Most);

impl Number for Most {
    #[inline]
    fn constant(value: f64) -> Self {
        Most(value.abs())
    }
}

/// Uses |sin θ| ≤ |θ|, |cos θ| ≤ 1 and 1 − cos θ ≤ θ²/2.
impl Angle for Most {
    #[inline]
    fn turn(self) -> Turn<Most> {
        Turn { sin: self, cos: Most(1.0), versine: Most(self.0 * self.0 / 2.0) }
    }
}
