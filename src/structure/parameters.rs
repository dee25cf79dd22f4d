//! The numbers that a user gives: one structure's parameters, their ranges, and the paper's two specimens.

use crate::digits::short;
use crate::names::unknown;
use crate::structure::quantity::{Quantity, Refused, ensure, ensure_in, quantity};
use serde::{Deserialize, Serialize};

/// Declares [`Parameters`] and their table [`PARAMETERS`]: name, unit, range, description, and `default` if a file may leave it out.
macro_rules! parameters {
    ($($name:ident [$unit:literal] $min:expr, $max:expr, $description:literal $($default:ident)?;)*) => {
        /// Parameters of a flexible rocking structure (Fig 2 of the paper). SI units.
        #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
        pub struct Parameters {
            $(
                #[doc = concat!($description, ", ", $unit, ".")]
                $(#[serde($default)])?
                pub $name: f64,
            )*
        }

        /// Every parameter with its unit and range, in the order of the file and of the FMU.
        pub const PARAMETERS: [Quantity<Parameters>; 16] = [$(quantity!($name [$unit] $min, $max, $description)),*];
    };
}

parameters! {
    m ["kg"] 1e-6, 1e12, "top mass";
    m0 ["kg"] 0.0, 1e12, "foundation mass";
    H ["m"] 1e-3, 1e4, "height of the top mass above the base";
    B ["m"] 1e-3, 1e4, "half-width of the base";
    J0 ["kg.m2"] 0.0, 1e20, "rotational inertia of the foundation about the middle of the base";
    f_fc ["Hz"] 1e-3, 1e4, "natural frequency in full contact (fixed base)";
    zeta_fc ["1"] 0.0, MAX_DAMPING, "damping ratio in full contact";
    c_ratio ["1"] 0.0, 100.0, "ratio c_u/c_fc of the viscous damping while rocking to the viscous damping in full contact";
    r ["1"] 1e-3, 1.0, "coefficient of restitution on the angular velocity at impact";
    g ["m/s2"] 1e-3, 1e3, "acceleration of gravity";
    P_0 ["N"] 0.0, 1e15, "prestress of the tendon with the base down" default;
    k_t ["N/m"] 0.0, 1e15, "stiffness of the tendon" default;
    xi_d ["m"] 0.0, 1e4, "distance of each dissipator from the middle of the base" default;
    c_d ["N.s/m"] 0.0, 1e15, "damping of each viscous dissipator" default;
    k_d ["N/m"] 0.0, 1e15, "elastic stiffness of each elastoplastic dissipator" default;
    F_y ["N"] 0.0, 1e15, "force at which an elastoplastic dissipator yields" default;
}

/// The specimens of the paper by name: a bridge pier (Table 2) and a shear wall (Table 1).
pub const PRESETS: [(&str, Parameters); 2] = [("mcmanus", Parameters::MCMANUS), ("evison", Parameters::EVISON)];

/// The largest damping ratio in full contact. A larger number is probably in per cent.
pub const MAX_DAMPING: f64 = 0.99;

/// The slenderest structure accepted: H/B beyond it leaves 1 − χ (after Eq 13) without significant digits.
pub const MAX_SLENDERNESS: f64 = 1e3;

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
    pub fn preset(name: &str) -> Result<Parameters, Refused> {
        let found = PRESETS.iter().find(|(known, _)| *known == name).map(|(_, parameters)| *parameters);
        let is_unknown = || unknown(format_args!("preset = {name:?} is unknown"), name, &PRESETS.map(|of| of.0));
        found.ok_or_else(|| Refused::by(is_unknown()))
    }

    /// Checks every parameter against [`PARAMETERS`] and the slenderness against [`MAX_SLENDERNESS`].
    pub fn check(&self) -> Result<(), Refused> {
        for quantity in &PARAMETERS {
            quantity.check((quantity.get)(self))?;
        }
        let slenderness = self.H / self.B;
        ensure(slenderness <= MAX_SLENDERNESS, || {
            let slenderness = short(slenderness);
            format!("H/B = {slenderness} is out of range: H must not exceed {MAX_SLENDERNESS} B; lower H or raise B")
        })?;
        let &Parameters { k_d, F_y, .. } = self;
        ensure_in((k_d > 0.0) == (F_y > 0.0), |units| {
            let [k_d, F_y] =
                [(k_d, "N/m"), (F_y, "N")].map(|(of, unit)| units.show_by(|of| format!("{of:?}"), of, unit));
            format!("k_d = {k_d} and F_y = {F_y} are no dissipator: set both above 0, or both to 0")
        })
    }
}
