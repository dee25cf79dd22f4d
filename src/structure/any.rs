//! A structure of one mass or of many: what a user hands over.

use crate::mechanics::impact::restitution;
use crate::mechanics::lateral::Modes;
use crate::structure::frame::{Frame, ROUNDING};
use crate::structure::{Base, Derived, Mode, derived};
use crate::{Side, State, Structure};
use std::f64::consts::TAU;

/// A structure of one mass or of many.
#[derive(Clone, Debug, PartialEq)]
pub enum AnyStructure {
    /// One mass.
    One(Structure),
    /// Many masses.
    Many(Frame),
}

/// A structure of many masses where one mass is needed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "{task} needs a structure of one mass, and this structure has {modes} modes: describe, simulate, view, advise and export take \
     many masses"
)]
pub struct ManyMasses {
    /// Name of the task.
    pub task: &'static str,
    /// Number of modes.
    pub modes: usize,
}

/// A mode in full contact and what becomes of it while the structure rocks.
#[derive(Clone, Copy, Debug)]
pub struct ModeOf {
    mode: Mode,
    J_P: f64,
    m_s: f64,
    omega_u: f64,
}

/// The numbers of a mode that are shown.
pub const OF_MODE: [Derived<ModeOf>; 7] = [
    derived!("f" ["Hz"] "frequency in full contact", "", |of| of.mode.omega() / TAU),
    derived!("zeta" ["1"] "damping ratio in full contact", "", |of| {
        of.mode.damping / (2.0 * (of.mode.stiffness * of.mode.mass).sqrt())
    }),
    derived!("mass" ["kg"] "effective mass", "", |of| of.mode.gamma * of.mode.share),
    derived!("share" ["1"] "effective mass as a fraction of m_s", "", |of| of.mode.gamma * of.mode.share / of.m_s),
    derived!("height" ["m"] "effective height; 0 if the mode has no effective mass", "", |of| {
        let is_of_none = of.mode.gamma * of.mode.share <= ROUNDING * of.m_s;
        if is_of_none { 0.0 } else { of.mode.height / of.mode.share }
    }),
    derived!("chi" ["1"] "participation in rocking", "", |of| of.mode.mass * of.mode.height * of.mode.height / of.J_P),
    derived!("f_u" ["Hz"] "frequency while rocking", "", |of| of.omega_u / TAU),
];

/// The numbers of a structure of many masses that are shown, apart from the numbers of its modes.
pub const OF_FRAME: [Derived<Frame>; 15] = [
    derived!("m_s" ["kg"] "mass above the base", "", |of| of.body().m_s),
    derived!("m_t" ["kg"] "mass of the whole structure", "", |of| of.base.m_t),
    derived!("S_1" ["kg.m"] "first moment of the mass above the base", "", |of| of.body().S_1),
    derived!("B" ["m"] "half-width of the base", "", |of| of.base.B),
    derived!("J_P" ["kg.m2"] "inertia about a pivot", "", |of| of.base.J_P),
    derived!("p_l" ["rad/s"] "frequency parameter", "", |of| of.base.p_l),
    derived!("alpha_cg" ["rad"] "slenderness of the centre of gravity", "", |of| libm::atan(of.base.tan_alpha_cg)),
    derived!("r" ["1"] "coefficient of restitution without displacement", "", |of| {
        let undeformed = State { u: Modes::default(), u_dot: Modes::default(), theta: 0.0, theta_dot: 0.0 };
        restitution(of, Side::Right, &undeformed)
    }),
    derived!("g" ["m/s2"] "acceleration of gravity", "", |of| of.base.g),
    derived!("P_0" ["N"] "prestress of the tendon with the base down", "", |of| of.base.ties.P_0),
    derived!("k_t" ["N/m"] "stiffness of the tendon", "", |of| of.base.ties.k_t),
    derived!("xi_d" ["m"] "distance of each dissipator from the middle of the base", "", |of| of.base.ties.xi_d),
    derived!("c_d" ["N.s/m"] "damping of each viscous dissipator", "", |of| of.base.ties.c_d),
    derived!("k_d" ["N/m"] "elastic stiffness of each elastoplastic dissipator", "", |of| of.base.ties.k_d),
    derived!("F_y" ["N"] "force at which an elastoplastic dissipator yields", "", |of| of.base.ties.F_y),
];

impl From<Structure> for AnyStructure {
    fn from(structure: Structure) -> AnyStructure {
        AnyStructure::One(structure)
    }
}

impl From<Frame> for AnyStructure {
    fn from(frame: Frame) -> AnyStructure {
        AnyStructure::Many(frame)
    }
}

impl AnyStructure {
    /// The structure of one mass, which `task` needs.
    pub fn one(&self, task: &'static str) -> Result<Structure, ManyMasses> {
        match self {
            AnyStructure::One(structure) => Ok(*structure),
            AnyStructure::Many(frame) => Err(ManyMasses { task, modes: frame.modes().len() }),
        }
    }

    /// The structure of many masses, if it is one.
    pub fn frame(&self) -> Option<&Frame> {
        match self {
            AnyStructure::One(_) => None,
            AnyStructure::Many(frame) => Some(frame),
        }
    }

    /// The rigid base.
    pub fn base(&self) -> &Base {
        match self {
            AnyStructure::One(structure) => &structure.base,
            AnyStructure::Many(frame) => &frame.base,
        }
    }
}

impl Frame {
    /// The numbers of each mode, lowest frequency first.
    pub fn mode_table(&self) -> impl Iterator<Item = ModeOf> {
        let (J_P, m_s) = (self.base.J_P, self.body().m_s);
        let modes = self.modes().iter().zip(self.rocking_frequencies());
        modes.map(move |(&mode, omega_u)| ModeOf { mode, J_P, m_s, omega_u })
    }
}
