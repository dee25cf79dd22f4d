//! The numbers that a user gives: one structure's parameters, their ranges, and the paper's two specimens.
//!
//! A parameter is a row here. From its row come the field of [`Parameters`], the name in files, on the command line, in Python and in the
//! FMU, its range, its default and its help; of a tie between base and ground also the field of [`Ties`].

use crate::digits::short;
use crate::names::unknown;
use crate::structure::quantity::{Quantity, Refused, ensure, ensure_in, quantity};
use serde::{Deserialize, Serialize};

/// Declares [`Parameters`] and [`Ties`] and their tables by rows: name, unit, range, description, and perhaps a default; whether a
/// structure of many masses has no such number.
macro_rules! parameters {
    (
        structure {
            $($name:ident [$unit:literal] $min:expr, $max:expr, $description:literal $(= $default:literal)? $(of $one:ident)?;)*
        }
        ties { $($tie:ident [$tie_unit:literal] $most:expr, $meaning:literal;)* }
    ) => {
        /// Parameters of a flexible rocking structure (Fig 2 of the paper). SI units.
        #[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
        pub struct Parameters {
            $(
                #[doc = concat!($description, ", ", $unit, ".")]
                pub $name: f64,
            )*
            $(
                #[doc = concat!($meaning, ", ", $tie_unit, ".")]
                pub $tie: f64,
            )*
        }

        /// The ties between the base and the ground, a tendon and dissipators, by their parameters.
        #[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
        pub struct Ties {
            $(
                #[doc = concat!($meaning, ", ", $tie_unit, ".")]
                pub $tie: f64,
            )*
        }

        /// Every parameter with its unit and range, in the order of the file and of the FMU.
        pub const PARAMETERS: &[Quantity<Parameters>] = &[
            $(quantity!($name [$unit] $min, $max, $description),)*
            $(quantity!($tie [$tie_unit] 0.0, $most, $meaning),)*
        ];

        /// Those of the ties.
        pub const TIES: &[Quantity<Ties>] = &[$(quantity!($tie [$tie_unit] 0.0, $most, $meaning)),*];

        /// Those that a structure of many masses does not have.
        pub const OF_ONE_MASS: &[&str] = &[$($({ let _ = stringify!($one); stringify!($name) },)?)*];

        impl Parameters {
            /// The default of each parameter; NaN of those that must be given.
            pub const DEFAULTS: Parameters = Parameters { $($name: [$($default,)? f64::NAN][0],)* $($tie: 0.0),* };
        }

        impl Ties {
            /// The ties among these parameters.
            pub(crate) fn of(&Parameters { $($tie,)* .. }: &Parameters) -> Ties {
                Ties { $($tie),* }
            }

            /// The parameters of these ties, and `others`.
            pub(crate) fn over(self, others: Parameters) -> Parameters {
                Parameters { $($tie: self.$tie,)* ..others }
            }
        }

        /// A line for each parameter: name, unit and default, meaning.
        #[macro_export]
        macro_rules! parameters_in_lines {
            () => {
                concat!(
                    $("    ", stringify!($name), " (", $unit, $(", ", $default,)? "): ", $description, "\n",)*
                    $("    ", stringify!($tie), " (", $tie_unit, ", 0.0): ", $meaning, "\n",)*
                )
            };
        }
    };
}

parameters! {
    structure {
        m ["kg"] 1e-6, 1e12, "top mass" of one_mass;
        m0 ["kg"] 0.0, 1e12, "foundation mass";
        H ["m"] 1e-3, 1e4, "height of the top mass above the base" of one_mass;
        B ["m"] 1e-3, 1e4, "half-width of the base";
        J0 ["kg.m2"] 0.0, 1e20, "rotational inertia of the foundation about the middle of the base" = 0.0;
        f_fc ["Hz"] 1e-3, 1e4, "natural frequency in full contact (fixed base)" of one_mass;
        zeta_fc ["1"] 0.0, MAX_DAMPING, "damping ratio in full contact" of one_mass;
        c_ratio ["1"] 0.0, 100.0, "ratio c_u/c_fc of the viscous damping while rocking to the viscous damping in full contact" = 1.0;
        r ["1"] 1e-3, 1.0, "coefficient of restitution on the angular velocity at impact";
        g ["m/s2"] 1e-3, 1e3, "acceleration of gravity" = 9.81;
    }
    ties {
        P_0 ["N"] 1e15, "prestress of the tendon with the base down";
        k_t ["N/m"] 1e15, "stiffness of the tendon";
        xi_d ["m"] 1e4, "distance of each dissipator from the middle of the base";
        c_d ["N.s/m"] 1e15, "damping of each viscous dissipator";
        k_d ["N/m"] 1e15, "elastic stiffness of each elastoplastic dissipator";
        F_y ["N"] 1e15, "force at which an elastoplastic dissipator yields";
    }
}

/// The specimens of the paper by name: a bridge pier (Table 2) and a shear wall (Table 1).
pub const PRESETS: [(&str, Parameters); 2] = [("mcmanus", Parameters::MCMANUS), ("evison", Parameters::EVISON)];

/// The largest damping ratio in full contact. A larger number is probably in per cent.
pub const MAX_DAMPING: f64 = 0.99;

/// The slenderest structure accepted: H/B beyond it leaves 1 − χ (after Eq 13) without significant digits.
pub const MAX_SLENDERNESS: f64 = 1e3;

impl Parameters {
    /// Evison's shear wall specimen (Table 1), free to rock.
    pub const EVISON: Parameters = Parameters {
        m: 125.8,
        m0: 44.02,
        H: 1.05,
        B: 0.285,
        f_fc: 11.0,
        zeta_fc: 0.015,
        r: 0.96,
        ..Parameters::DEFAULTS
    };

    /// McManus's bridge pier specimen (Table 2), free to rock.
    pub const MCMANUS: Parameters = Parameters {
        m: 130.1,
        m0: 65.4,
        H: 1.84,
        B: 0.285,
        J0: 10.7,
        f_fc: 5.0,
        zeta_fc: 0.02,
        r: 0.99,
        ..Parameters::DEFAULTS
    };

    /// The specimen of this name, one of [`PRESETS`].
    pub fn preset(name: &str) -> Result<Parameters, Refused> {
        let found = PRESETS.iter().find(|(known, _)| *known == name).map(|(_, parameters)| *parameters);
        let is_unknown = || unknown(format_args!("preset = {name:?} is unknown"), name, &PRESETS.map(|of| of.0));
        found.ok_or_else(|| Refused::by(is_unknown()))
    }

    /// Checks every parameter against [`PARAMETERS`] and the slenderness against [`MAX_SLENDERNESS`].
    pub fn check(&self) -> Result<(), Refused> {
        for quantity in PARAMETERS {
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

impl Ties {
    /// The springs (N·m/rad) and the dampers (N·m·s/rad) that the ties are about a pivot of a base of half-width `B` (m), by the names of
    /// their parameters.
    pub(crate) fn about_pivot(&self, B: f64) -> [(&'static str, [f64; 2]); 3] {
        let &Ties { k_t, c_d, k_d, .. } = self;
        [("k_t", [k_t * B * B, 0.0]), ("k_d", [k_d * self.pair(B), 0.0]), ("c_d", [0.0, c_d * self.pair(B)])]
    }

    /// What a pair of dissipators does about such a pivot over what one does that is elongated by 1 m for each rad, m².
    pub(crate) fn pair(&self, B: f64) -> f64 {
        2.0 * (B * B + self.xi_d * self.xi_d)
    }
}
