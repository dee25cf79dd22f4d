//! A number of several runs side by side, in one register of the processor.

use crate::levels::nonlinear::{Expanded, add_each_product};
use crate::numbers::Real;
use crate::series::taylor::MAX_ORDER;
use pulp::Simd;
use pulp::bytemuck::cast_slice;
use std::array::from_ref;
use std::ops::{Add, BitAnd, BitOr, Div, Mul, Neg, Sub};

/// The most runs that lie side by side.
pub(crate) const MOST: usize = 8;

/// One number of each run. In what begins with a line of the processor's memory, 64 bytes, none of them lies in two lines.
#[derive(Clone, Copy, Debug)]
#[repr(align(32))]
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

    #[inline(always)]
    pub(crate) fn load(simd: S, numbers: &[f64; MOST]) -> Lanes<S> {
        Lanes { simd, of: S::as_simd_f64s(numbers).0[0] }
    }

    #[inline(always)]
    pub(crate) fn store(self, numbers: &mut [f64; MOST]) {
        S::as_mut_simd_f64s(numbers).0[0] = self.of;
    }

    /// The number of the run in `lane`.
    #[inline]
    pub(crate) fn of(&self, lane: usize) -> f64 {
        cast_slice(from_ref(&self.of))[lane]
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

impl<S: Simd> Real for Lanes<S> {
    #[inline(always)]
    fn like(self, value: f64) -> Lanes<S> {
        Lanes::splat(self.simd, value)
    }

    #[inline(always)]
    fn abs(self) -> Lanes<S> {
        let magnitude = self.simd.splat_f64s(f64::from_bits(i64::MAX as u64));
        Lanes { of: self.simd.and_f64s(self.of, magnitude), ..self }
    }

    #[inline(always)]
    fn max(self, other: Lanes<S>) -> Lanes<S> {
        Lanes { of: self.simd.max_f64s(self.of, other.of), ..self }
    }

    #[inline(always)]
    fn min(self, other: Lanes<S>) -> Lanes<S> {
        Lanes { of: self.simd.min_f64s(self.of, other.of), ..self }
    }

    #[inline(always)]
    fn sqrt(self) -> Lanes<S> {
        Lanes { of: self.simd.sqrt_f64s(self.of), ..self }
    }
}

impl<S: Simd> Answers<S> {
    /// `yes` where the answer is so, otherwise `no`.
    #[inline(always)]
    pub(crate) fn choose(self, yes: Lanes<S>, no: Lanes<S>) -> Lanes<S> {
        Lanes { simd: self.simd, of: self.simd.select_f64s(self.of, yes.of, no.of) }
    }

    /// Whether all say yes.
    #[inline(always)]
    pub(crate) fn all(self) -> bool {
        let [zero, one] = [0.0, 1.0].map(|value| Lanes::splat(self.simd, value));
        self.simd.reduce_sum_f64s(self.choose(zero, one).of) == 0.0
    }
}

/// Implements an operator lane by lane.
macro_rules! operator {
    ($of:ident, $trait:ident, $name:ident, $operation:ident) => {
        impl<S: Simd> $trait for $of<S> {
            type Output = Self;

            #[inline(always)]
            fn $name(self, other: Self) -> Self {
                $of { of: self.simd.$operation(self.of, other.of), ..self }
            }
        }
    };
}

operator!(Lanes, Add, add, add_f64s);
operator!(Lanes, Sub, sub, sub_f64s);
operator!(Lanes, Mul, mul, mul_f64s);
operator!(Lanes, Div, div, div_f64s);
operator!(Answers, BitAnd, bitand, and_m64s);
operator!(Answers, BitOr, bitor, or_m64s);

impl<S: Simd> Neg for Lanes<S> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Lanes { of: self.simd.xor_f64s(self.of, self.simd.splat_f64s(-0.0)), ..self }
    }
}

impl<S: Simd> Expanded for Lanes<S> {
    /// θ̇, w θ̇, w.
    type Left = [Lanes<S>; 3];
    /// cos θ, sin θ, w, θ̇, G.
    type Right = [Lanes<S>; 5];

    #[inline(always)]
    fn left(turning: Self, lever_turning: Self, lever: Self) -> Self::Left {
        [turning, lever_turning, lever]
    }

    #[inline(always)]
    fn right(cos: Self, sin: Self, next_lever: Self, turning: Self, weight: Self) -> Self::Right {
        [cos, sin, next_lever, turning, weight]
    }

    #[inline(always)]
    fn products(
        left: &[Self::Left; MAX_ORDER + 1],
        right: &[Self::Right; MAX_ORDER + 1],
        newest: (&Self::Left, &Self::Right),
        n: usize,
    ) -> [Self; 6] {
        let mut sum = [newest.0[0].like(0.0); 6];
        add_each_product!(add_products, &mut sum, left, right, newest, n);
        sum
    }
}

#[inline(always)]
fn add_products<S: Simd>(sum: &mut [Lanes<S>; 6], left: &[Lanes<S>; 3], right: &[Lanes<S>; 5]) {
    let &[turning, lever_turning, lever] = left;
    let &[cos, sin, next_lever, right_turning, weight] = right;
    sum[0] = sum[0] + turning * cos;
    sum[1] = sum[1] + turning * sin;
    sum[2] = sum[2] + turning * next_lever;
    sum[3] = sum[3] + lever_turning * next_lever;
    sum[4] = sum[4] + lever_turning * right_turning;
    sum[5] = sum[5] + lever * weight;
}
