//! The rigid base of a structure, and the structure as a rigid body, by their numbers.

use crate::structure::parameters::{Parameters, Ties};
use crate::structure::quantity::Refused;
use serde::{Deserialize, Serialize};

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
    /// The tendon and the dissipators that restrain the base.
    pub ties: Ties,
}

/// A structure as a rigid body: its foundation, and the moments of all mass above the foundation.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Body {
    /// Mass of the foundation m0, at the height of the pivots, kg.
    pub m0: f64,
    /// Inertia of the foundation about the middle of the base J0, kg·m².
    pub J0: f64,
    /// Mass above the foundation m_s, kg.
    pub m_s: f64,
    /// First moment of this mass about the height of the pivots S_1, kg·m.
    pub S_1: f64,
    /// Second moment of this mass about the height of the pivots I_2, kg·m².
    pub I_2: f64,
    /// Half-width of the base B, m.
    pub B: f64,
    /// Coefficient of restitution; without one, momentum with the shape frozen gives a coefficient for each impact (M19).
    pub r: Option<f64>,
    /// Acceleration of gravity, m/s².
    pub g: f64,
    /// Viscous damping while rocking as a fraction of the damping in full contact.
    pub c_ratio: f64,
    /// The tendon and the dissipators between the base and the ground.
    pub ties: Ties,
}

impl Body {
    /// Checks the base, its tendon and its dissipators against the limits of one mass.
    pub(crate) fn check(&self) -> Result<(), Refused> {
        let r = self.r.unwrap_or(1.0);
        Parameters { H: 1.0, r, ..self.over(Parameters::EVISON) }.check()
    }

    /// The base of these `parameters`, with the coefficient of restitution `r`, under mass of these moments m_s, S_1 and I_2.
    pub(crate) fn of(parameters: &Parameters, r: Option<f64>, [m_s, S_1, I_2]: [f64; 3]) -> Body {
        let &Parameters { m0, J0, B, g, c_ratio, .. } = parameters;
        Body { m0, J0, m_s, S_1, I_2, B, r, g, c_ratio, ties: Ties::of(parameters) }
    }

    /// The parameters of the base, and `others`; r is NaN without a coefficient.
    pub(crate) fn over(&self, others: Parameters) -> Parameters {
        let &Body { m0, J0, B, r, g, c_ratio, ties, .. } = self;
        ties.over(Parameters { m0, J0, B, c_ratio, r: r.unwrap_or(f64::NAN), g, ..others })
    }
}

impl Base {
    /// Whether ties restrain the structure.
    #[inline]
    pub fn is_restrained(&self) -> bool {
        self.ties.P_0 > 0.0 || self.ties.about_pivot(1.0).iter().any(|(_, of)| *of != [0.0; 2])
    }

    /// Whether ties take energy out of its motion.
    pub fn takes_energy(&self) -> bool {
        self.ties.F_y > 0.0 || self.ties.about_pivot(1.0).iter().any(|(_, [_, damper])| *damper > 0.0)
    }

    /// Whether the base has a tendon.
    pub fn has_tendon(&self) -> bool {
        self.ties.P_0 > 0.0 || self.ties.k_t > 0.0
    }

    /// Whether the base has dissipators.
    #[inline(always)]
    pub fn has_dissipators(&self) -> bool {
        self.ties.c_d > 0.0 || self.ties.k_d > 0.0
    }

    /// The moment of the weight and of the tendon that holds the base at rest down, N·m.
    pub(crate) fn hold_at_rest(&self) -> f64 {
        (self.m_t * self.g + self.ties.P_0) * self.B
    }

    /// The coefficient of restitution. Without a given one, momentum with the shape frozen gives (M19)
    ///
    /// ```text
    /// r = (J_P − 2 m_t B² + Σ μ u²)/(J_P + 2 sB Σ Γ u + Σ μ u²)
    /// ```
    ///
    /// given Σ μ u² and s Σ Γ u at the impact.
    #[inline]
    pub(crate) fn restitution(&self, sums: impl FnOnce() -> [f64; 2]) -> f64 {
        let &Base { m_t, B, J_P, r, .. } = self;
        r.unwrap_or_else(|| {
            let [square, offset] = sums();
            (J_P - 2.0 * m_t * B * B + square) / (J_P + 2.0 * B * offset + square)
        })
    }
}
