//! Numbers that a formula is evaluated in. An equation stands once, as a function generic over [`Number`]:
//!
//! | number | contents | answers |
//! |---|---|---|
//! | `f64` | a value | the output or reaction at an instant |
//! | [`Dual`](dual::Dual) | value and rate | its time derivative |
//! | [`Most`](most::Most) | bound of the magnitude | whether a piece may hold a peak, in few instructions |
//! | [`Terms`](crate::series::terms::Terms) | coefficients of a power series | the instant of the peak |
//!
//! Write `x * c` with the constant last, and `/ m` instead of `* (1.0 / m)`: then values keep their last bit. A sine or cosine
//! never stands in a formula, because each number has its own rule for it: the formula reads [`Turn`].

pub(crate) mod dual;
pub(crate) mod most;

use std::ops::{Add, Div, Mul, Neg, Sub};

/// A kind of number.
pub trait Number:
    Copy
    + Add<Output = Self>
    + Sub<Output = Self>
    + Mul<Output = Self>
    + Neg<Output = Self>
    + Mul<f64, Output = Self>
    + Div<f64, Output = Self>
{
    /// The number that does not change with time.
    fn constant(value: f64) -> Self;
}

/// A kind of number that has a sign. A bound and a power series have none.
pub trait Ordered: Number {
    /// The value by which numbers are compared.
    fn value(&self) -> f64;

    /// The number, or 0 if it is negative.
    #[inline]
    fn positive(self) -> Self {
        if self.value() > 0.0 { self } else { Self::constant(0.0) }
    }

    /// The larger of two numbers.
    #[inline]
    fn larger(self, other: Self) -> Self {
        if self.value() >= other.value() { self } else { other }
    }
}

impl Number for f64 {
    #[inline]
    fn constant(value: f64) -> f64 {
        value
    }
}

impl Ordered for f64 {
    #[inline]
    fn value(&self) -> f64 {
        *self
    }
}

/// A number of one run, or one number of each of several runs side by side.
pub(crate) trait Real:
    Copy + Add<Output = Self> + Sub<Output = Self> + Mul<Output = Self> + Div<Output = Self> + Neg<Output = Self>
{
    /// The number `value`, of as many runs as this one.
    fn like(self, value: f64) -> Self;

    fn abs(self) -> Self;

    /// The larger one; not for numbers that may be NaN.
    fn max(self, other: Self) -> Self;

    /// The smaller one; not for numbers that may be NaN.
    fn min(self, other: Self) -> Self;

    fn sqrt(self) -> Self;
}

/// Implements methods by those of the same names.
macro_rules! its_own {
    ($($name:ident $(($other:ident))?)*) => {
        $(#[inline(always)]
        fn $name(self $(, $other: f64)?) -> f64 {
            f64::$name(self $(, $other)?)
        })*
    };
}

impl Real for f64 {
    #[inline(always)]
    fn like(self, value: f64) -> f64 {
        value
    }

    its_own! { abs max(other) min(other) sqrt }
}

/// Implements an operator of a number for these operands, and their result.
macro_rules! operator {
    ([$($parameters:tt)*] $number:ty: $trait:ident<$other:ty>, $name:ident, |$own:ident, $with:ident| $result:expr) => {
        impl<$($parameters)*> std::ops::$trait<$other> for $number {
            type Output = Self;

            #[inline(always)]
            fn $name($own, $with: $other) -> Self {
                $result
            }
        }
    };
}

/// Implements the operators of a number by its methods `plus`, `times` and `map`. The method `map` applies a linear function
/// to each part.
macro_rules! operators {
    ([$($parameters:tt)*] $number:ty) => {
        $crate::numbers::operator!([$($parameters)*] $number: Add<Self>, add, |self, other| self.plus(&other));
        $crate::numbers::operator!([$($parameters)*] $number: Sub<Self>, sub, |self, other| self.plus(&-other));
        $crate::numbers::operator!([$($parameters)*] $number: Mul<Self>, mul, |self, other| self.times(&other));
        $crate::numbers::operator!([$($parameters)*] $number: Mul<f64>, mul, |self, factor| self.map(|part| part * factor));
        $crate::numbers::operator!([$($parameters)*] $number: Div<f64>, div, |self, divisor| self.map(|part| part / divisor));

        impl<$($parameters)*> std::ops::Neg for $number {
            type Output = Self;

            #[inline(always)]
            fn neg(self) -> Self {
                self.map(|part| -part)
            }
        }
    };
}
pub(crate) use {operator, operators};

/// Sine, cosine and versine of the rotation.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Turn<N> {
    pub sin: N,
    pub cos: N,
    /// 1 − cos θ.
    pub versine: N,
}

impl<N: Number> Turn<N> {
    /// The turn of a base that stays on the ground.
    pub(crate) fn none() -> Turn<N> {
        Turn { sin: N::constant(0.0), cos: N::constant(1.0), versine: N::constant(0.0) }
    }
}

/// A kind of number that has a rule for the turn by a rotation.
pub(crate) trait Angle: Number {
    /// The turn by this rotation (rad), |θ| ≤ π/2.
    fn turn(self) -> Turn<Self>;
}

impl Angle for f64 {
    #[inline]
    fn turn(self) -> Turn<f64> {
        if self.to_bits() == 0 {
            return Turn::none(); // in full contact
        }
        let (sin, cos) = libm::sincos(self);
        Turn { sin, cos, versine: sin * sin / (1.0 + cos) } // without cancellation: cos θ ≥ 0
    }
}
