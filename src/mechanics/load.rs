//! What acts on a structure: the ground's acceleration and a force on its top mass.
//!
//! The force F_t does the work F_t δx on the top mass, x = sB (1 − cos θ) + u cos θ + H sin θ. On the right it adds to
//!
//! ```text
//! (1)  F_t/m        (5)  F_t cos θ        (6)  F_t [H cos θ + (sB − u) sin θ]        (7)  F_t/m        (8)  H F_t/m
//! ```
//!
//! which is what −a_g does there, times m, but for the foundation's share in Eq 6. So the top mass feels the ground
//! acceleration a_g − F_t/m, the foundation a_g alone, and with F_t = 0 every equation is what it was, to the last bit.
//! Uplift asks for s u ≥ u_cr and s θ̈ > 0, which neither of them enters; impacts are too short for both.

use crate::Structure;
use crate::structure::quantity::{OutOfRange, Quantity, quantity};
use serde::{Deserialize, Serialize};
use std::ops::{Index, IndexMut};

/// An acceleration over one interval, positive to the right: `value + slope·(t − start of the interval)`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Ramp {
    /// At the start of the interval, m/s².
    pub value: f64,
    /// Its rate, m/s³.
    pub slope: f64,
}

impl Ramp {
    /// Its value `tau` seconds into the interval, m/s².
    pub fn at(self, tau: f64) -> f64 {
        self.value + self.slope * tau
    }

    /// The same, its interval started `tau` seconds later.
    pub fn from(self, tau: f64) -> Ramp {
        Ramp { value: self.at(tau), slope: self.slope }
    }

    /// Coefficient `k` of its series over a step of `span` s.
    #[inline]
    pub(crate) fn coefficient(self, k: usize, span: f64) -> f64 {
        match k {
            0 => self.value,
            1 => self.slope * span,
            _ => 0.0,
        }
    }
}

/// What may act, with units and ranges.
pub static LOADS: [Quantity<Load>; 2] = [
    quantity!(a_g["m/s2"] - 1e4, 1e4, "horizontal ground acceleration, positive to the right"),
    quantity!(F_t["N"] - 1e15, 1e15, "external horizontal force on the top mass, positive to the right"),
];

/// What acts at one instant, or its rate; indexed in the order of [`LOADS`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Load {
    /// Ground acceleration, m/s², positive to the right.
    pub a_g: f64,
    /// External force on the top mass, N, horizontal in the ground's frame, positive to the right.
    pub F_t: f64,
}

impl Load {
    /// The ground acceleration `a_g` (m/s²) alone.
    pub fn ground(a_g: f64) -> Load {
        Load { a_g, F_t: 0.0 }
    }

    /// Whether both are numbers.
    #[inline]
    pub fn is_finite(&self) -> bool {
        // a comparison is one instruction where f64::is_finite takes a dozen, and each sample asks
        self.a_g.abs() <= f64::MAX && self.F_t.abs() <= f64::MAX
    }

    /// Accepts what lies within the ranges of [`LOADS`].
    #[inline]
    pub fn check(&self) -> Result<(), OutOfRange> {
        LOADS[0].check(self.a_g)?;
        LOADS[1].check(self.F_t)
    }

    /// a_g − F_t/m, the ground acceleration that the top mass feels, m/s².
    #[inline]
    pub fn on_top(self, structure: &Structure) -> f64 {
        self.a_g - self.F_t / structure.parameters().m
    }
}

impl Index<usize> for Load {
    type Output = f64;

    #[inline]
    fn index(&self, which: usize) -> &f64 {
        match which {
            0 => &self.a_g,
            1 => &self.F_t,
            _ => panic!("there is no load {which}"),
        }
    }
}

impl IndexMut<usize> for Load {
    #[inline]
    fn index_mut(&mut self, which: usize) -> &mut f64 {
        match which {
            0 => &mut self.a_g,
            1 => &mut self.F_t,
            _ => panic!("there is no load {which}"),
        }
    }
}

/// What acts over one interval: `value + slope·(t − start of the interval)`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct LinearLoad {
    /// At the start of the interval.
    pub value: Load,
    /// Its rate, per second.
    pub slope: Load,
}

impl LinearLoad {
    /// Its value `tau` seconds into the interval.
    pub fn at(self, tau: f64) -> Load {
        Load { a_g: self.value.a_g + self.slope.a_g * tau, F_t: self.value.F_t + self.slope.F_t * tau }
    }

    /// The same, its interval started `tau` seconds later.
    pub fn from(self, tau: f64) -> LinearLoad {
        LinearLoad { value: self.at(tau), ..self }
    }

    /// This load on ground that accelerates by `a_g` more.
    pub fn on_ground(self, a_g: Ramp) -> LinearLoad {
        LinearLoad {
            value: Load { a_g: self.value.a_g + a_g.value, ..self.value },
            slope: Load { a_g: self.slope.a_g + a_g.slope, ..self.slope },
        }
    }

    /// Its ground acceleration.
    pub(crate) fn on_foundation(self) -> Ramp {
        Ramp { value: self.value.a_g, slope: self.slope.a_g }
    }

    /// The ground acceleration that the top mass feels.
    #[inline]
    pub(crate) fn on_top(self, structure: &Structure) -> Ramp {
        if self.value.F_t == 0.0 && self.slope.F_t == 0.0 {
            return self.on_foundation(); // what a division would yield, for less
        }
        Ramp { value: self.value.on_top(structure), slope: self.slope.on_top(structure) }
    }
}

/// Held.
impl From<Load> for LinearLoad {
    fn from(value: Load) -> LinearLoad {
        LinearLoad { value, slope: Load::default() }
    }
}

/// The ground motion alone.
impl From<Ramp> for LinearLoad {
    fn from(a_g: Ramp) -> LinearLoad {
        LinearLoad { value: Load::ground(a_g.value), slope: Load::ground(a_g.slope) }
    }
}
