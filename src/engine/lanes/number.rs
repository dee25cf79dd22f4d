//! A number of several runs side by side, in one register of the processor.

use crate::numbers::{Real, operator};
use pulp::Simd;
use pulp::bytemuck::cast_slice;
use std::array::from_ref;
use std::ops::Neg;

/// The most runs that lie side by side.
pub(crate) const MOST: usize = 8;

/// A number of each run.
pub(crate) type PerRun = [f64; MOST];

/// Puts the numbers of the run in `lane` into their rows.
#[inline(always)]
pub(crate) fn put<const K: usize>(rows: &mut [PerRun; K], lane: usize, numbers: [f64; K]) {
    rows.iter_mut().zip(numbers).for_each(|(row, number)| row[lane] = number);
}

/// The rows as numbers of all runs.
#[inline(always)]
pub(crate) fn load<S: Simd, const K: usize>(simd: S, rows: &[PerRun; K]) -> [Lanes<S>; K] {
    let mut numbers = [Lanes::splat(simd, 0.0); K];
    for (number, row) in numbers.iter_mut().zip(rows) {
        *number = Lanes::load(simd, row);
    }
    numbers
}

/// Coefficients of the polynomials of [`libm::sincos`].
#[rustfmt::skip]
const SINE: [f64; 6] = [
    -0.16666666666666632, 0.00833333333332249, -0.0001984126982985795,
    2.7557313707070068e-6, -2.5050760253406863e-8, 1.58969099521155e-10,
];
#[rustfmt::skip]
const COSINE: [f64; 6] = [
    0.0416666666666666, -0.001388888888887411, 2.480158728947673e-5,
    -2.7557314351390663e-7, 2.087572321298175e-9, -1.1359647557788195e-11,
];

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

    /// Sine and cosine, in the operations of [`libm::sincos`] below π/4, which then has the same bits.
    #[inline(always)]
    pub(crate) fn sin_cos(self) -> [Lanes<S>; 2] {
        let (z, zero, one) = (self * self, self.like(0.0), self.like(1.0));
        let (w, half) = (z * z, self.like(0.5) * z);
        let [s1, s2, s3, s4, s5, s6] = SINE;
        let sine = self.like(s2) + z * (self.like(s3) + z * self.like(s4));
        let sine = sine + z * w * (self.like(s5) + z * self.like(s6));
        let sin = self + z * self * (self.like(s1) + z * sine);
        let [c1, c2, c3, c4, c5, c6] = COSINE;
        let cosine = z * (self.like(c1) + z * (self.like(c2) + z * self.like(c3)));
        let cosine = cosine + w * w * (self.like(c4) + z * (self.like(c5) + z * self.like(c6)));
        let near = one - half;
        let cos = near + (one - near - half + z * cosine);
        if self.abs().is_at_most(self.like(0.785)).all() {
            return [z.is_at_most(zero).choose(self, sin), cos];
        }
        let mut turn = [[0.0; MOST]; 2];
        (0..S::F64_LANES).for_each(|lane| (turn[0][lane], turn[1][lane]) = libm::sincos(self.of(lane)));
        [Lanes::load(self.simd, &turn[0]), Lanes::load(self.simd, &turn[1])]
    }

    #[inline(always)]
    pub(crate) fn is_at_most(self, other: Lanes<S>) -> Answers<S> {
        Answers { simd: self.simd, of: self.simd.less_than_or_equal_f64s(self.of, other.of) }
    }

    #[inline(always)]
    pub(crate) fn is_equal(self, other: Lanes<S>) -> Answers<S> {
        Answers { simd: self.simd, of: self.simd.equal_f64s(self.of, other.of) }
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
        let zero = Lanes::splat(self.simd, 0.0);
        let no = self.simd.xor_m64s(self.of, zero.is_at_most(zero).of);
        self.simd.first_true_m64s(no) == S::F64_LANES
    }
}

operator!([S: Simd] Lanes<S>: Add<Self>, add, |self, b| Lanes { of: self.simd.add_f64s(self.of, b.of), ..self });
operator!([S: Simd] Lanes<S>: Sub<Self>, sub, |self, b| Lanes { of: self.simd.sub_f64s(self.of, b.of), ..self });
operator!([S: Simd] Lanes<S>: Mul<Self>, mul, |self, b| Lanes { of: self.simd.mul_f64s(self.of, b.of), ..self });
operator!([S: Simd] Lanes<S>: Div<Self>, div, |self, b| Lanes { of: self.simd.div_f64s(self.of, b.of), ..self });
operator!([S: Simd] Answers<S>: BitAnd<Self>, bitand, |self, b| {
    Answers { of: self.simd.and_m64s(self.of, b.of), ..self }
});
operator!([S: Simd] Answers<S>: BitOr<Self>, bitor, |self, b| {
    Answers { of: self.simd.or_m64s(self.of, b.of), ..self }
});

impl<S: Simd> Neg for Lanes<S> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        Lanes { of: self.simd.xor_f64s(self.of, self.simd.splat_f64s(-0.0)), ..self }
    }
}
