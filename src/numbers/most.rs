//! A bound of a magnitude.

use super::{Number, operators};

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
