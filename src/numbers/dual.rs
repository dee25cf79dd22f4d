//! A value with its rate, by the rules of differentiation.

use super::{Angle, Number, Ordered, Turn, operators};

/// A value and its time derivative. The parts may be any number: the rate of a rate is a second derivative.
#[derive(Clone, Copy, Debug)]
pub struct Dual<T> {
    pub value: T,
    pub rate: T,
}

impl<T: Number> Dual<T> {
    #[inline]
    fn plus(&self, other: &Self) -> Self {
        Dual { value: self.value + other.value, rate: self.rate + other.rate }
    }

    #[inline]
    fn times(&self, other: &Self) -> Self {
        Dual { value: self.value * other.value, rate: self.rate * other.value + self.value * other.rate }
    }

    #[inline]
    fn map(&self, linear: impl Fn(T) -> T) -> Self {
        Dual { value: linear(self.value), rate: linear(self.rate) }
    }
}

operators!([T: Number] Dual<T>);

impl<T: Number> Number for Dual<T> {
    fn constant(value: f64) -> Self {
        Dual { value: T::constant(value), rate: T::constant(0.0) }
    }
}

impl<T: Ordered> Ordered for Dual<T> {
    #[inline]
    fn value(&self) -> f64 {
        self.value.value()
    }
}

impl<T: Angle> Angle for Dual<T> {
    #[inline]
    fn turn(self) -> Turn<Self> {
        self.value.turn().at_rate(self.rate)
    }
}

impl<T: Number> Turn<T> {
    /// The turn with its rate, given θ̇.
    #[inline]
    pub(crate) fn at_rate(self, theta_dot: T) -> Turn<Dual<T>> {
        let Turn { sin, cos, versine } = self;
        Turn {
            sin: Dual { value: sin, rate: cos * theta_dot },
            cos: Dual { value: cos, rate: -(sin * theta_dot) },
            versine: Dual { value: versine, rate: sin * theta_dot },
        }
    }
}
