//! What the structure shows at an instant: accelerations, forces, displacements (Eqs 2, 3, 23–27) and their rates.
use crate::{Phase, State, Structure};

/// The outputs at one instant; with [`Outputs::rates`], their time derivatives in the same fields.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Outputs {
    /// Rotation of the base θ, rad.
    pub theta: f64,
    /// Elastic displacement u, m.
    pub u: f64,
    /// Acceleration of the top mass a_t, m/s² (Eq 27).
    pub a_t: f64,
    /// Base shear V_t = m a_t, N (Eqs 2, 23).
    pub V_t: f64,
    /// Overturning moment M_t = m H a_t, N·m (Eqs 3, 24).
    pub M_t: f64,
    /// Angular velocity θ̇, rad/s.
    pub theta_dot: f64,
    /// Elastic velocity u̇, m/s.
    pub u_dot: f64,
    /// Uplift of the free edge of the base δ_u = 2 B sin|θ|, m (Eq 25).
    pub uplift: f64,
    /// Lateral displacement of the top mass δ_t, m (Eq 26).
    pub delta_t: f64,
}

impl Outputs {
    /// The outputs of `structure` in `phase` and `state`; they depend on the state alone.
    pub fn of(structure: &Structure, phase: Phase, state: &State) -> Outputs {
        let _ = (structure, phase, state);
        todo!()
    }

    /// Time derivatives of the outputs under the ground acceleration `a_g` (m/s²), exact.
    pub fn rates(structure: &Structure, phase: Phase, state: &State, a_g: f64) -> Outputs {
        let _ = (structure, phase, state, a_g);
        todo!()
    }
}
