//! The structure: its parameters and the constants that follow from them (before Eq 11, after 4, 8 and 13, before 18).

pub mod any;
pub mod description;
pub mod doubts;
pub mod frame;
pub mod natural_quantities;
pub mod parameters;
pub mod quantity;

use parameters::{ParameterError, Parameters};
use std::f64::consts::TAU;

/// A structure: checked parameters and the constants that the equations use.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Structure {
    parameters: Parameters,
    /// Mass ratio γ = (m + m0)/m (text before Eq 1).
    pub gamma: f64,
    /// Circular frequency in full contact ω_fc = 2π f_fc, rad/s.
    pub omega_fc: f64,
    /// Stiffness of the strut k = m ω_fc², N/m.
    pub k: f64,
    /// Viscous damping in full contact c_fc = 2 ζ_fc √(k m), N·s/m.
    pub c_fc: f64,
    /// Viscous damping while rocking c_u, N·s/m.
    pub c_u: f64,
    /// Inertia about a pivot J_P = J0 + m (H² + B²) + m0 B², kg·m² (after Eq 8).
    pub J_P: f64,
    /// Frequency parameter p_l = √(m g H/J_P), rad/s (before Eq 11).
    pub p_l: f64,
    /// Slenderness of the centre of gravity: tan α_cg = γ B/H (before Eq 11).
    pub tan_alpha_cg: f64,
    /// Modal participation χ = H p_l²/g (after Eq 13).
    pub chi: f64,
    /// 1 − χ = (J_P − m H²)/J_P, free of cancellation.
    pub one_minus_chi: f64,
    /// Critical displacement u_cr = (g tan α_cg + P_0 B/(m H))/ω_fc², m (after Eq 4): uplift of a base at rest. With −∞ the
    /// moment that turns the base (s θ̈ > 0) decides alone, of a structure without ties in a run to a given end.
    pub u_cr: f64,
    /// Circular frequency of the vibration mode while rocking ω_u = ω_fc/√(1−χ), rad/s (before Eq 18).
    pub omega_u: f64,
    /// Bound of the rates of rocking, 1/s: ω_u and p_l, with the stiffness and the damping that the ties add to them.
    pub(crate) rocking_rate: f64,
    is_restrained: bool,
    pub(crate) base: Base,
    pub(crate) mode: Mode,
    /// ω_fc² = k/m, 1/s².
    pub(crate) stiffness: f64,
    /// c_fc/m, 1/s.
    pub(crate) damping_fc: f64,
    /// c_u/m, 1/s.
    pub(crate) damping_u: f64,
    /// (J0 + m0 B²)/m, m².
    pub(crate) foundation: f64,
    /// Damping ratio of the vibration mode ζ_u = c_u/(2√(k m (1−χ))) (before Eq 18).
    pub zeta_u: f64,
}

/// The rigid base of a structure, with all mass that no mode carries.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Base {
    /// Mass of the whole structure m_t, kg.
    pub m_t: f64,
    /// Mass that no mode carries, m_t − Σ Γ²/μ, kg; of one mass, the mass of the foundation.
    pub m0: f64,
    /// First moment of this mass about the height of the pivots, kg·m; of one mass, 0.
    pub S_res: f64,
    /// Half-width B, m.
    pub B: f64,
    /// Inertia of the mass that no mode carries, about the middle of the base, kg·m².
    pub J0: f64,
    /// Inertia of the whole structure about a pivot J_P, kg·m².
    pub J_P: f64,
    /// Coefficient of restitution; without one, momentum with the shape frozen gives a coefficient for each impact.
    pub r: Option<f64>,
    /// Acceleration of gravity, m/s².
    pub g: f64,
    /// Viscous damping while rocking as a fraction of the damping in full contact.
    pub c_ratio: f64,
    /// Frequency parameter √(g S_1/J_P), rad/s.
    pub p_l: f64,
    /// Slenderness of the centre of gravity m_t B/S_1.
    pub tan_alpha_cg: f64,
    /// What restrains the base.
    pub ties: Ties,
}

/// The tendon and the dissipators between the base and the ground, by their parameters.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Ties {
    /// Prestress of the tendon with the base down, N.
    pub P_0: f64,
    /// Stiffness of the tendon, N/m.
    pub k_t: f64,
    /// Distance of both dissipators from the middle of the base, m.
    pub xi_d: f64,
    /// Damping of each viscous dissipator, N·s/m.
    pub c_d: f64,
    /// Elastic stiffness of each elastoplastic dissipator, N/m.
    pub k_d: f64,
    /// Force at which it yields, N.
    pub F_y: f64,
}

impl AsRef<Base> for Structure {
    #[inline(always)]
    fn as_ref(&self) -> &Base {
        &self.base
    }
}

impl Base {
    /// Whether a tendon or dissipators restrain the structure.
    #[inline]
    pub fn is_restrained(&self) -> bool {
        let &Ties { P_0, k_t, c_d, k_d, .. } = &self.ties;
        [P_0, k_t, c_d, k_d].iter().any(|restraint| *restraint > 0.0)
    }
}

/// A mode of vibration in full contact: an oscillator on the base. One mass is one mode with the shape 1.
#[derive(Clone, Copy, Debug, PartialEq)]
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

/// A derived quantity of a `T`, for `describe` and the FMU.
#[derive(Debug)]
pub struct Derived<T = Structure> {
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

use derived;

/// The derived quantities that are shown, in the order of the paper.
pub const DERIVED: [Derived; 16] = [
    derived!("gamma" ["1"] "mass ratio (m + m0)/m", "before Eq 1", |s| s.gamma),
    derived!("omega_fc" ["rad/s"] "circular frequency in full contact", "Eq 1", |s| s.omega_fc),
    derived!("k" ["N/m"] "stiffness of the strut", "Eq 1", |s| s.k),
    derived!("c_fc" ["N.s/m"] "viscous damping in full contact", "after Eq 1", |s| s.c_fc),
    derived!("u_cr" ["m"] "critical displacement at uplift", "after Eq 4", |s| s.u_cr),
    derived!("c_u" ["N.s/m"] "viscous damping while rocking", "after Eq 6", |s| s.c_u),
    derived!("J_P" ["kg.m2"] "inertia about a pivot", "after Eq 8", |s| s.J_P),
    derived!("p_l" ["rad/s"] "frequency parameter", "before Eq 11", |s| s.p_l),
    derived!("alpha_cg" ["rad"] "slenderness of the centre of gravity", "before Eq 11", |s| libm::atan(s.tan_alpha_cg)),
    derived!("chi" ["1"] "modal participation of rocking", "after Eq 13", |s| s.chi),
    derived!("f_u" ["Hz"] "frequency of the vibration mode while rocking", "before Eq 18", |s| s.omega_u / TAU),
    derived!("zeta_u" ["1"] "damping ratio of the vibration mode while rocking", "before Eq 18", |s| s.zeta_u),
    derived!("period_fc" ["s"] "natural period in full contact", "before Eq 4", |s| s.parameters.f_fc.recip()),
    derived!("weight" ["N"] "weight of the top mass, m g", "Eq 5", |s| s.parameters.m * s.parameters.g),
    derived!("weight0" ["N"] "weight of the foundation, m0 g", "Eq 6", |s| s.parameters.m0 * s.parameters.g),
    derived!("width" ["m"] "width of the base, 2 B", "Eq 25", |s| 2.0 * s.parameters.B),
];

impl Structure {
    /// Derives a structure from its parameters, or returns the first parameter that is out of range.
    pub fn new(parameters: Parameters) -> Result<Structure, ParameterError> {
        parameters.check()?;
        let Parameters { m, m0, H, B, J0, f_fc, zeta_fc, c_ratio, r, g, P_0, k_t, xi_d, c_d, k_d, F_y } = parameters;
        let gamma = (m + m0) / m;
        let omega_fc = TAU * f_fc;
        let k = m * omega_fc * omega_fc;
        let c_fc = 2.0 * zeta_fc * m * omega_fc;
        let c_u = c_ratio * c_fc;
        let foundation_and_offset = J0 + (m + m0) * B * B;
        let J_P = foundation_and_offset + m * H * H;
        let chi = m * H * H / J_P;
        let one_minus_chi = foundation_and_offset / J_P;
        let tan_alpha_cg = gamma * B / H;
        let (p_l, omega_u) = ((m * g * H / J_P).sqrt(), omega_fc / one_minus_chi.sqrt());
        let foundation = (J0 + m0 * B * B) / m;
        let (inertia, pair) = (m * (foundation + B * B), 2.0 * (B * B + xi_d * xi_d));
        let held = k_t * B * B + k_d * pair;
        let ties = Ties { P_0, k_t, xi_d, c_d, k_d, F_y };
        let rocking_rate = (omega_u * omega_u + held / inertia).sqrt().max(p_l).max(c_d * pair / inertia);
        Ok(Structure {
            parameters,
            is_restrained: [P_0, k_t, c_d, k_d].iter().any(|restraint| *restraint > 0.0),
            base: Base { m_t: m + m0, m0, S_res: 0.0, B, J0, J_P, r: Some(r), g, c_ratio, p_l, tan_alpha_cg, ties },
            mode: Mode { mass: m, gamma: m, share: 1.0, height: H, stiffness: k, damping: c_fc },
            gamma,
            omega_fc,
            k,
            c_fc,
            c_u,
            J_P,
            p_l,
            tan_alpha_cg,
            chi,
            one_minus_chi,
            u_cr: (g * tan_alpha_cg + P_0 * B / (m * H)) / (omega_fc * omega_fc),
            omega_u,
            rocking_rate,
            stiffness: omega_fc * omega_fc,
            damping_fc: c_fc / m,
            damping_u: c_u / m,
            foundation,
            zeta_u: c_u / (2.0 * (k * m * one_minus_chi).sqrt()),
        })
    }

    /// The rigid base.
    pub fn base(&self) -> &Base {
        &self.base
    }

    /// Whether a tendon or dissipators restrain the structure.
    pub fn is_restrained(&self) -> bool {
        self.is_restrained
    }

    /// The parameters that this structure was derived from.
    pub fn parameters(&self) -> &Parameters {
        &self.parameters
    }
}

#[cfg(test)]
mod tests {
    use super::*;
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
            let structure = Structure::new(parameters).unwrap();
            for (name, expected) in ["J_P", "p_l", "alpha_cg", "chi", "f_u", "u_cr"].into_iter().zip(expected) {
                let derived = DERIVED.iter().find(|derived| derived.name == name).unwrap();
                assert_relative_eq!((derived.value)(&structure), expected, max_relative = 2e-5);
            }
        }
    }

    #[test]
    fn every_number_is_in_si_units() {
        let known = ["1", "kg", "m", "s", "N", "rad", "Hz", "m2", "s2"];
        let units = parameters::PARAMETERS.iter().map(|of| of.unit).chain(DERIVED.iter().map(|of| of.unit));
        let units = units.chain(any::OF_FRAME.iter().map(|of| of.unit)).chain(any::OF_MODE.iter().map(|of| of.unit));
        let strange: Vec<_> = units.filter(|unit| !unit.split(['/', '.']).all(|part| known.contains(&part))).collect();
        assert!(strange.is_empty(), "{strange:?}");
    }
}
