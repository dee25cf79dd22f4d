//! The modes of vibration of a structure in full contact, and the floors that show their motion.

use crate::Modes;
use crate::mechanics::lateral::Coordinates;
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
}

impl Floor {
    /// Elastic displacement of the floor at the coordinates `u`, m.
    pub fn displacement<Q: Coordinates>(&self, u: &Q) -> f64 {
        u.weighed(&self.shape)
    }
}
