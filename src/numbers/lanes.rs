//! A number of several runs side by side, in one register of the processor.

use pulp::Simd;
use pulp::bytemuck::cast_slice;
use std::array::from_ref;
use std::ops::{Add, Div, Mul, Neg, Sub};

/// The most runs that lie side by side.
pub(crate) const MOST: usize = 8;

/// One number of each run.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lanes<S: Simd> {
    simd: S,
    of: S::f64s,
}

/// Answers of each run to a question.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Answers<S: Simd> {
    simd: S,
    of: S::m64s,
}

impl<S: Simd> Lanes<S> {
    #[inline(always)]
    pub(crate) fn splat(simd: S, value: f64) -> Lanes<S> {
        Lanes { simd, of: simd.splat_f64s(value) }
    }

    /// The number `value`, of as many runs as this one.
    #[inline(always)]
    pub(crate) fn like(self, value: f64) -> Lanes<S> {
        Lanes::splat(self.simd, value)
    }

    #[inline(always)]
    pub(crate) fn load(simd: S, numbers: &[f64; MOST]) -> Lanes<S> {
        Lanes { simd, of: S::as_simd_f64s(numbers).0[0] }
    }

    /// The number of the run in `lane`.
    #[inline]
    pub(crate) fn of(&self, lane: usize) -> f64 {
        cast_slice(from_ref(&self.of))[lane]
    }

    #[inline(always)]
    pub(crate) fn abs(self) -> Lanes<S> {
        let magnitude = self.simd.splat_f64s(f64::from_bits(i64::MAX as u64));
        Lanes { of: self.simd.and_f64s(self.of, magnitude), ..self }
    }

    /// The larger one; not for numbers that may be NaN.
    #[inline(always)]
    pub(crate) fn max(self, other: Lanes<S>) -> Lanes<S> {
        Lanes { of: self.simd.max_f64s(self.of, other.of), ..self }
    }

    #[inline(always)]
    pub(crate) fn is_at_most(self, other: Lanes<S>) -> Answers<S> {
        Answers { simd: self.simd, of: self.simd.less_than_or_equal_f64s(self.of, other.of) }
    }

    #[inline(always)]
    pub(crate) fn is_less(self, other: Lanes<S>) -> Answers<S> {
        Answers { simd: self.simd, of: self.simd.less_than_f64s(self.of, other.of) }
    }
}

impl<S: Simd> Answers<S> {
    #[inline(always)]
    pub(crate) fn and(self, other: Answers<S>) -> Answers<S> {
        Answers { of: self.simd.and_m64s(self.of, other.of), ..self }
    }

    #[inline(always)]
    pub(crate) fn or(self, other: Answers<S>) -> Answers<S> {
        Answers { of: self.simd.or_m64s(self.of, other.of), ..self }
    }

    /// `yes` where the answer is so, otherwise `no`.
    #[inline(always)]
    pub(crate) fn choose(self, yes: Lanes<S>, no: Lanes<S>) -> Lanes<S> {
        Lanes { simd: self.simd, of: self.simd.select_f64s(self.of, yes.of, no.of) }
    }

    /// Whether all say yes.
    #[inline(always)]
    pub(crate) fn all(self) -> bool {
        let [zero, one] = [0.0, 1.0].map(|value| Lanes::splat(self.simd, value));
        self.simd.reduce_min_f64s(self.choose(one, zero).of) > 0.0
    }
}

/// Implements an operator lane by lane.
macro_rules! operator {
    ($trait:ident, $name:ident, $operation:ident) => {
        impl<S: Simd> $trait for Lanes<S> {
            type Output = Self;

            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                Lanes { of: self.simd.$operation(self.of, other.of), ..self }
            }
        }
    };
}

operator!(Add, add, add_f64s);
operator!(Sub, sub, sub_f64s);
operator!(Mul, mul, mul_f64s);
operator!(Div, div, div_f64s);

impl<S: Simd> Neg for Lanes<S> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Lanes { of: self.simd.xor_f64s(self.of, self.simd.splat_f64s(-0.0)), ..self }
    }
}
