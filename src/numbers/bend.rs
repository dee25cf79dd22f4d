//! Bounds of a quantity and of its first two derivatives, by the product rule.

use super::{Angle, Number, Turn, operators};

/// The largest magnitudes that a quantity, its rate and its second derivative can have over a piece.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bend {
    pub value: f64,
    pub rate: f64,
    pub bend: f64,
}

impl Bend {
    #[inline(always)]
    fn plus(&self, other: &Self) -> Self {
        Bend { value: self.value + other.value, rate: self.rate + other.rate, bend: self.bend + other.bend }
    }

    #[inline(always)]
    fn times(&self, other: &Self) -> Self {
        Bend {
            value: self.value * other.value,
            rate: self.rate * other.value + self.value * other.rate,
            bend: self.bend * other.value + 2.0 * self.rate * other.rate + self.value * other.bend,
        }
    }

    #[inline(always)]
    fn map(&self, linear: impl Fn(f64) -> f64) -> Self {
        let of = |part: f64| linear(part).abs();
        Bend { value: of(self.value), rate: of(self.rate), bend: of(self.bend) }
    }
}

operators!([] Bend);

impl Number for Bend {
    #[inline(always)]
    fn constant(value: f64) -> Self {
        Bend { value: value.abs(), rate: 0.0, bend: 0.0 }
    }
}

impl Angle for Bend {
    #[inline(always)]
    fn turn(self) -> Turn<Bend> {
        let Bend { value, rate, bend } = self;
        let falling = rate * rate + value * bend; // bounds |θ̈ sin θ + θ̇² cos θ|
        let rising = bend + value * rate * rate; // bounds |θ̈ cos θ − θ̇² sin θ|
        Turn {
            sin: Bend { value, rate, bend: rising },
            cos: Bend { value: 1.0, rate: value * rate, bend: falling },
            versine: Bend { value: value * value / 2.0, rate: value * rate, bend: falling },
        }
    }
}
