//! The numbers that a user gives: one structure's parameters, their ranges, and the paper's two specimens.

use crate::digits::short;
use crate::structure::quantity::{OutOfRange, Quantity, quantity};
use serde::{Deserialize, Serialize};

/// Parameters of a flexible rocking structure (Fig 2 of the paper). SI units.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Parameters {
    /// Top mass, kg.
    pub m: f64,
    /// Foundation mass, kg.
    pub m0: f64,
    /// Height of the top mass above the base, m.
    pub H: f64,
    /// Half-width of the base, m.
    pub B: f64,
    /// Rotational inertia of the foundation about the middle of the base, kg·m².
    pub J0: f64,
    /// Natural frequency in full contact (fixed base), Hz.
    pub f_fc: f64,
    /// Damping ratio in full contact.
    pub zeta_fc: f64,
    /// Ratio c_u/c_fc of the viscous damping while rocking to the viscous damping in full contact.
    pub c_ratio: f64,
    /// Coefficient of restitution on the angular velocity at impact.
    pub r: f64,
    /// Acceleration of gravity, m/s².
    pub g: f64,
    /// Prestress of the tendon with the base down, N.
    #[serde(default)]
    pub P_0: f64,
    /// Stiffness of the tendon, N/m.
    #[serde(default)]
    pub k_t: f64,
    /// Distance of both dissipators from the middle of the base, m.
    #[serde(default)]
    pub xi_d: f64,
    /// Damping of each viscous dissipator, N·s/m.
    #[serde(default)]
    pub c_d: f64,
    /// Elastic stiffness of each elastoplastic dissipator, N/m.
    #[serde(default)]
    pub k_d: f64,
    /// Force at which an elastoplastic dissipator yields, N.
    #[serde(default)]
    pub F_y: f64,
}

/// Every parameter with its unit and range, in the order of the file and of the FMU.
pub const PARAMETERS: [Quantity<Parameters>; 16] = [
    quantity!(m ["kg"] 1e-6, 1e12, "top mass"),
    quantity!(m0 ["kg"] 0.0, 1e12, "foundation mass"),
    quantity!(H ["m"] 1e-3, 1e4, "height of the top mass above the base"),
    quantity!(B ["m"] 1e-3, 1e4, "half-width of the base"),
    quantity!(J0 ["kg.m2"] 0.0, 1e20, "rotational inertia of the foundation about the middle of the base"),
    quantity!(f_fc ["Hz"] 1e-3, 1e4, "natural frequency in full contact (fixed base)"),
    quantity!(zeta_fc ["1"] 0.0, MAX_DAMPING, "damping ratio in full contact"),
    quantity!(c_ratio ["1"] 0.0, 100.0, "ratio c_u/c_fc of the viscous damping while rocking to the viscous damping in full contact"),
    quantity!(r ["1"] 1e-3, 1.0, "coefficient of restitution on the angular velocity at impact"),
    quantity!(g ["m/s2"] 1e-3, 1e3, "acceleration of gravity"),
    quantity!(P_0 ["N"] 0.0, 1e15, "prestress of the tendon with the base down"),
    quantity!(k_t ["N/m"] 0.0, 1e15, "stiffness of the tendon"),
    quantity!(xi_d ["m"] 0.0, 1e4, "distance of each dissipator from the middle of the base"),
    quantity!(c_d ["N.s/m"] 0.0, 1e15, "damping of each viscous dissipator"),
    quantity!(k_d ["N/m"] 0.0, 1e15, "elastic stiffness of each elastoplastic dissipator"),
    quantity!(F_y ["N"] 0.0, 1e15, "force at which an elastoplastic dissipator yields"),
];

/// The specimens of the paper by name: a bridge pier (Table 2) and a shear wall (Table 1).
pub const PRESETS: [(&str, Parameters); 2] = [("mcmanus", Parameters::MCMANUS), ("evison", Parameters::EVISON)];

/// The largest damping ratio in full contact. A larger number is probably in per cent.
pub const MAX_DAMPING: f64 = 0.99;

/// A name that is none of [`PRESETS`].
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("preset = {0:?} is unknown; these are known: {known}", known = PRESETS.map(|of| of.0).join(", "))]
pub struct UnknownPreset(String);

/// The slenderest structure accepted: H/B beyond it leaves 1 − χ (after Eq 13) without significant digits.
pub const MAX_SLENDERNESS: f64 = 1e3;

/// Why a set of parameters is rejected.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum ParameterError {
    /// One parameter is outside its own range.
    #[error(transparent)]
    OutOfRange(#[from] OutOfRange),
    /// Height and half-width do not fit together.
    #[error("H/B = {} is out of range: H must not exceed {MAX_SLENDERNESS} B; lower H or raise B", short(*.0))]
    TooSlender(f64),
    /// An elastoplastic dissipator takes both a stiffness and a force at which it yields.
    #[error("k_d = {k_d:?} N/m and F_y = {F_y:?} N are no dissipator: set both above 0, or both to 0")]
    #[allow(missing_docs)] // the message names the fields
    HalfDissipator { k_d: f64, F_y: f64 },
}

impl Parameters {
    /// Evison's shear wall specimen (Table 1).
    pub const EVISON: Parameters = Parameters {
        m: 125.8,
        m0: 44.02,
        H: 1.05,
        B: 0.285,
        J0: 0.0,
        f_fc: 11.0,
        zeta_fc: 0.015,
        c_ratio: 1.0,
        r: 0.96,
        g: 9.81,
        P_0: 0.0,
        k_t: 0.0,
        xi_d: 0.0,
        c_d: 0.0,
        k_d: 0.0,
        F_y: 0.0,
    };

    /// McManus's bridge pier specimen (Table 2).
    pub const MCMANUS: Parameters = Parameters {
        m: 130.1,
        m0: 65.4,
        H: 1.84,
        B: 0.285,
        J0: 10.7,
        f_fc: 5.0,
        zeta_fc: 0.02,
        c_ratio: 1.0,
        r: 0.99,
        ..Parameters::EVISON // as free to rock, under the same g
    };

    /// The specimen of this name, one of [`PRESETS`].
    pub fn preset(name: &str) -> Result<Parameters, UnknownPreset> {
        let found = PRESETS.iter().find(|(known, _)| *known == name);
        found.map(|(_, parameters)| *parameters).ok_or_else(|| UnknownPreset(name.to_owned()))
    }

    /// Checks every parameter against [`PARAMETERS`] and the slenderness against [`MAX_SLENDERNESS`].
    pub fn check(&self) -> Result<(), ParameterError> {
        for quantity in &PARAMETERS {
            quantity.check((quantity.get)(self))?;
        }
        let slenderness = self.H / self.B;
        if slenderness > MAX_SLENDERNESS {
            return Err(ParameterError::TooSlender(slenderness));
        }
        let &Parameters { k_d, F_y, .. } = self;
        if (k_d > 0.0) != (F_y > 0.0) {
            return Err(ParameterError::HalfDissipator { k_d, F_y });
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_refusal_names_the_parameter_its_value_and_the_limit() {
        let refused = |change: fn(&mut Parameters)| {
            let mut parameters = Parameters::EVISON;
            change(&mut parameters);
            parameters.check().unwrap_err().to_string()
        };
        assert!(refused(|p| p.r = 0.0).starts_with("r = 0 is out of range: it must lie between 0.001 and 1 ("));
        assert!(refused(|p| p.B = -0.3).starts_with("B = -0.3 m is out of range: it must lie between 0.001"));
        assert!(refused(|p| p.m = f64::NAN).starts_with("m = NaN kg"));
        assert!(refused(|p| p.H = f64::INFINITY).starts_with("H = inf m"));
        assert!(
            refused(|p| p.zeta_fc = 5.0).starts_with("zeta_fc = 5 is out of range: it must lie between 0 and 0.99 (")
        );
        assert!(refused(|p| p.H = 300.0).starts_with("H/B = 1052.6"));
        assert!(refused(|p| p.k_d = 2e6).starts_with("k_d = 2000000.0 N/m and F_y = 0.0 N are no dissipator"));
    }

    #[test]
    fn the_table_reads_and_writes_the_field_it_names() {
        for quantity in &PARAMETERS {
            let mut parameters = Parameters::MCMANUS;
            (quantity.set)(&mut parameters, 0.125);
            assert_eq!((quantity.get)(&parameters), 0.125);
            let changed: Vec<_> =
                PARAMETERS.iter().filter(|q| (q.get)(&parameters) != (q.get)(&Parameters::MCMANUS)).collect();
            assert_eq!(changed.len(), 1, "{}", quantity.name);
        }
    }
}
