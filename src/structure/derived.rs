//! The numbers that follow from a structure and are shown: of one mass (before Eq 11, after 4, 8 and 13, before 18), of any
//! structure, and of each mode.

use crate::structure::ROUNDING;
use crate::structure::parameters::TIES;
use crate::{Mode, OneMass, Structure};
use std::f64::consts::TAU;

/// A derived quantity of a `T`, for `describe` and the FMU.
#[derive(Debug)]
pub struct Derived<T = OneMass> {
    /// Symbol.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Description.
    pub description: &'static str,
    /// Equation of the paper that defines the quantity.
    pub equation: &'static str,
    /// Value for a structure.
    pub value: fn(&T) -> f64,
}

macro_rules! derived {
    ($name:literal [$unit:literal] $description:literal, $equation:literal, $value:expr) => {
        Derived { name: $name, unit: $unit, description: $description, equation: $equation, value: $value }
    };
}

/// The derived quantities of one mass that are shown, in the order of the paper.
pub const DERIVED: [Derived; 16] = [
    derived!("gamma" ["1"] "mass ratio (m + m0)/m", "before Eq 1", |s| s.gamma),
    derived!("omega_fc" ["rad/s"] "circular frequency in full contact", "Eq 1", |s| s.omega_fc),
    derived!("k" ["N/m"] "stiffness of the strut", "Eq 1", |s| s.k),
    derived!("c_fc" ["N.s/m"] "viscous damping in full contact", "after Eq 1", |s| s.c_fc),
    derived!("u_cr" ["m"] "critical displacement at uplift", "after Eq 4", |s| s.u_cr),
    derived!("c_u" ["N.s/m"] "viscous damping while rocking", "after Eq 6", |s| s.c_u),
    derived!("J_P" ["kg.m2"] "inertia about a pivot", "after Eq 8", |s| s.base().J_P),
    derived!("p_l" ["rad/s"] "frequency parameter", "before Eq 11", |s| s.base().p_l),
    derived!("alpha_cg" ["rad"] "slenderness of the centre of gravity", "before Eq 11", |s| libm::atan(s.base().tan_alpha_cg)),
    derived!("chi" ["1"] "modal participation of rocking", "after Eq 13", |s| s.chi),
    derived!("f_u" ["Hz"] "frequency of the vibration mode while rocking", "before Eq 18", |s| s.omega_u / TAU),
    derived!("zeta_u" ["1"] "damping ratio of the vibration mode while rocking", "before Eq 18", |s| s.zeta_u),
    derived!("period_fc" ["s"] "natural period in full contact", "before Eq 4", |s| s.parameters().f_fc.recip()),
    derived!("weight" ["N"] "weight of the top mass, m g", "Eq 5", |s| s.parameters().m * s.parameters().g),
    derived!("weight0" ["N"] "weight of the foundation, m0 g", "Eq 6", |s| s.parameters().m0 * s.parameters().g),
    derived!("width" ["m"] "width of the base, 2 B", "Eq 25", |s| 2.0 * s.parameters().B),
];

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
    derived!("zeta" ["1"] "damping ratio in full contact", "", |of| of.mode.zeta()),
    derived!("mass" ["kg"] "effective mass", "", |of| of.mode.gamma * of.mode.share),
    derived!("share" ["1"] "effective mass as a fraction of m_s", "", |of| of.mode.gamma * of.mode.share / of.m_s),
    derived!("height" ["m"] "effective height; 0 if the mode has no effective mass", "", |of| {
        let is_of_none = of.mode.gamma * of.mode.share <= ROUNDING * of.m_s;
        if is_of_none { 0.0 } else { of.mode.height / of.mode.share }
    }),
    derived!("chi" ["1"] "participation in rocking", "", |of| of.mode.mass * of.mode.height * of.mode.height / of.J_P),
    derived!("f_u" ["Hz"] "frequency while rocking", "", |of| of.omega_u / TAU),
];

/// The numbers of any structure, without its ties.
static OF_STRUCTURE: [Derived<Structure>; 9] = [
    derived!("m_s" ["kg"] "mass above the base", "", |of| of.body().m_s),
    derived!("m_t" ["kg"] "mass of the whole structure", "", |of| of.base().m_t),
    derived!("S_1" ["kg.m"] "first moment of the mass above the base", "", |of| of.body().S_1),
    derived!("B" ["m"] "half-width of the base", "", |of| of.base().B),
    derived!("J_P" ["kg.m2"] "inertia about a pivot", "", |of| of.base().J_P),
    derived!("p_l" ["rad/s"] "frequency parameter", "", |of| of.base().p_l),
    derived!("alpha_cg" ["rad"] "slenderness of the centre of gravity", "", |of| libm::atan(of.base().tan_alpha_cg)),
    derived!("r" ["1"] "coefficient of restitution without displacement", "", |of| of.base().restitution(|| [0.0; 2])),
    derived!("g" ["m/s2"] "acceleration of gravity", "", |of| of.base().g),
];

/// The numbers of ground that gives, of a structure that stands there.
static OF_GROUND: [Derived<Structure>; 6] = [
    derived!("k_v" ["N/m"] "vertical stiffness of the ground (Winkler springs)", "", |of| of.ground().sum(0)),
    derived!("k_r" ["N.m/rad"] "rotational stiffness of the ground", "", |of| of.ground().sum(2)),
    derived!("f_v" ["Hz"] "frequency of the bounce on the ground", "", |of| of.ground().omega_v(of.base()) / TAU),
    derived!("zeta_v" ["1"] "damping ratio of the bounce on the ground", "", |of| of.ground().zeta_v(of.base())),
    derived!("f_g" ["Hz"] "lowest frequency on the ground with all points pressed", "", |of| {
        of.frequencies_on_ground()[0] / TAU
    }),
    derived!("y_s" ["m"] "height of the base at rest above the unloaded ground", "", |of| of.ground().y_s),
];

/// The numbers of a base that may slide, and of ground that yields.
static OF_STRENGTH: [Derived<Structure>; 2] = [
    derived!("mu_c" ["1"] "coefficient of friction of the base", "", |of| of.ground().mu_c.unwrap_or(f64::NAN)),
    derived!("fs" ["1"] "least capacity of a contact point over its load at rest", "", |of| of.ground().reserve()),
];

impl Structure {
    /// Name, unit, description and value of the numbers that are shown, apart from the numbers of the modes; on ground that gives, the
    /// numbers of the ground last.
    pub fn derived(&self) -> impl Iterator<Item = ([&'static str; 3], f64)> {
        let of = |of: &Derived<Structure>| ([of.name, of.unit, of.description], (of.value)(self));
        let ties = TIES.iter().map(|of| ([of.name, of.unit, of.description], (of.get)(&self.base().ties)));
        let of_ground = OF_GROUND.iter().filter(|_| self.foundation().is_some());
        let of_strength = OF_STRENGTH.iter().filter(|_| self.foundation().is_some()).map(of);
        let of_strength = of_strength.filter(|(_, value)| value.is_finite());
        OF_STRUCTURE.iter().map(of).chain(ties).chain(of_ground.map(of)).chain(of_strength)
    }

    /// The numbers of each mode, lowest frequency first.
    pub fn mode_table(&self) -> impl Iterator<Item = ModeOf> {
        let (J_P, m_s) = (self.base().J_P, self.body().m_s);
        let modes = self.modes().iter().zip(self.rocking_frequencies());
        modes.map(move |(&mode, omega_u)| ModeOf { mode, J_P, m_s, omega_u })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Parameters;
    use approx::assert_relative_eq;

    /// Tables 1 and 2, in the digits to which their own values determine them.
    #[test]
    fn the_specimens_have_the_papers_derived_quantities() {
        // J_P, p_l, alpha_cg, chi, f_u, u_cr
        let tables = [
            (Parameters::EVISON, [152.488, 2.9151, 0.35122, 0.90954, 36.574, 0.752467e-3]),
            (Parameters::MCMANUS, [467.046, 2.24234, 0.22868, 0.94309, 20.959, 2.313480e-3]),
        ];
        for (parameters, expected) in tables {
            let structure = OneMass::new(parameters).unwrap();
            for (name, expected) in ["J_P", "p_l", "alpha_cg", "chi", "f_u", "u_cr"].into_iter().zip(expected) {
                let derived = DERIVED.iter().find(|derived| derived.name == name).unwrap();
                assert_relative_eq!((derived.value)(&structure), expected, max_relative = 2e-5);
            }
        }
    }
}
