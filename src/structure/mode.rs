//! The modes of vibration of a structure in full contact, and the floors that show their motion.

use crate::numbers::Number;
use crate::structure::quantity::{Quantity, quantity};
use serde::{Deserialize, Serialize};

/// A mode of vibration in full contact: an oscillator on the base. One mass is one mode with the shape 1.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Mode {
    /// Modal mass μ = φᵀMφ, kg.
    pub mass: f64,
    /// Γ = φᵀM1, kg.
    pub gamma: f64,
    /// Γ/μ: part that the mode takes in a translation of the base.
    pub share: f64,
    /// κ/μ, m, with κ = φᵀMh: part that the mode takes in a rotation of the base.
    pub height: f64,
    /// Modal stiffness μ ω², N/m.
    pub stiffness: f64,
    /// Modal damping in full contact 2 ζ ω μ, N·s/m.
    pub damping: f64,
}

/// Circular frequencies of vibration, rad/s.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vibration {
    /// The lowest in full contact.
    pub contact: f64,
    /// The lowest and the highest while rocking.
    pub rocking: [f64; 2],
}

/// A floor, whose motion is shown.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Floor {
    /// Mass, kg.
    pub mass: f64,
    /// Height above the pivots, m.
    pub height: f64,
    /// Displacement of the floor per coordinate of each mode.
    pub shape: Modes,
}

/// Limits of a floor, by the names that files have.
pub(crate) const OF_FLOOR: [Quantity<Floor>; 2] = [
    quantity!("m", mass ["kg"] 1e-6, 1e12, "mass of the floor"),
    quantity!("h", height ["m"] 1e-3, 1e4, "height of the floor above the base"),
];

impl Mode {
    /// The mode of circular frequency `omega` (rad/s) and damping ratio `zeta`, of modal mass 1: Γ² is its effective mass (kg), and
    /// κ/Γ its effective height (m).
    pub fn new(omega: f64, zeta: f64, gamma: f64, kappa: f64) -> Mode {
        let damping = 2.0 * zeta * omega;
        Mode { mass: 1.0, gamma, share: gamma, height: kappa, stiffness: omega * omega, damping }
    }

    /// Circular frequency in full contact, rad/s.
    pub fn omega(&self) -> f64 {
        (self.stiffness / self.mass).sqrt()
    }

    /// Damping ratio in full contact.
    pub fn zeta(&self) -> f64 {
        self.damping / (2.0 * (self.stiffness * self.mass).sqrt())
    }

    /// The part that the mode takes in a translation of the base.
    #[inline(always)]
    pub(crate) fn part<N: Number>(&self, translation: N) -> N {
        if self.share == 1.0 { translation } else { translation * self.share } // one mass spares the product
    }
}

/// The most modes of a structure.
pub const MOST_MODES: usize = 24;

/// A coordinate for each mode of a structure of many masses; or a force on each mode, beside the force on mass that no mode carries.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Modes {
    /// Numbers that were given; a structure refuses another count than that of its modes.
    pub(crate) count: usize,
    pub(crate) of: [f64; MOST_MODES],
    /// Of forces, the force on mass that no mode carries, and its moment; otherwise 0.
    pub(crate) rest: [f64; 2],
}

impl Modes {
    /// One number for each mode. Numbers beyond `MOST_MODES` fit no structure and are not kept.
    #[inline]
    pub fn new(numbers: &[f64]) -> Modes {
        let mut modes = Modes { count: numbers.len(), ..Modes::default() };
        modes.of.iter_mut().zip(numbers).for_each(|(of, number)| *of = *number);
        modes
    }

    /// One number for each mode.
    #[inline]
    pub fn numbers(&self) -> &[f64] {
        &self.of[..self.count.min(MOST_MODES)]
    }

    /// Combines each number with the one of `other`.
    #[inline(always)]
    pub(crate) fn with(mut self, other: &Modes, combine: impl Fn(f64, f64) -> f64) -> Modes {
        self.count = self.count.max(other.count);
        for (own, other) in self.of.iter_mut().zip(&other.of).take(self.count) {
            *own = combine(*own, *other);
        }
        self.rest = [0, 1].map(|i| combine(self.rest[i], other.rest[i]));
        self
    }

    /// The numbers in fours, with 0 for modes that are none.
    #[inline(always)]
    pub(crate) fn fours(&self) -> impl Iterator<Item = &[f64; 4]> {
        self.of.as_chunks().0.iter().take(self.count.div_ceil(4))
    }

    #[inline(always)]
    pub(crate) fn fours_mut(&mut self) -> impl Iterator<Item = &mut [f64; 4]> {
        self.of.as_chunks_mut().0.iter_mut().take(self.count.div_ceil(4))
    }
}
