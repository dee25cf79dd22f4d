//! Rocking and vibration mode of a rocking state (Eqs 10–20).
//!
//! The linearised equations (7, 8) are uncoupled, but for small geometric stiffness terms, by the shapes (u, θ) = (0, 1) of the
//! rocking mode and (1, −p_l²/g) of the vibration mode. Eqs 11, 16 and 18 of the modes stand in `levels/linear.rs`. The lateral
//! accelerations at the height of the top mass that belong to the modes, and their sum:
//!
//! ```text
//! a_r = H q̈_r = χ g q_r − χ a_g − s χ g tan α_cg                                                       (12)
//! a_u = ü + H q̈_u + a_g = (1−χ) ü + a_g                                                                (19)
//! a_t = a_r + a_u                                                                                      (20)
//! ```
//!
//! The paper's (13) and (20) are these with q_r → 0. The sum χ g q_r − (c_u u̇ + k u)/m does not depend on a_g. It differs from a_t
//! of the full equations by g (θ − χ q_r) to first order.

use crate::estimates::demand::check_is_free;
use crate::{Base, OneMass, Refused, Side, State};

/// The rotation of the base, split into the two modes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModalRotations {
    /// Rotation of the rocking mode, rad.
    pub q_r: f64,
    /// Rotation of the vibration mode, rad.
    pub q_u: f64,
}

impl ModalRotations {
    /// Splits the rotation of `state` (Eq 16) of a structure without ties.
    pub fn of(structure: &OneMass, state: &State) -> Result<ModalRotations, Refused> {
        check_is_free(structure)?;
        let q_u = -structure.base().p_l * structure.base().p_l / structure.parameters().g * state.u;
        Ok(ModalRotations { q_r: state.theta - q_u, q_u })
    }
}

/// The lateral acceleration of the top mass, split into the two modes, m/s².
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ModalAccelerations {
    /// Of the rocking mode, a_r (Eq 12).
    pub a_r: f64,
    /// Of the vibration mode with the ground's part, a_u (Eq 19).
    pub a_u: f64,
}

impl ModalAccelerations {
    /// The modes' accelerations while rocking about `side` under the ground acceleration `a_g` (m/s²).
    pub fn of(structure: &OneMass, side: Side, state: &State, a_g: f64) -> Result<ModalAccelerations, Refused> {
        let &OneMass { chi, one_minus_chi, omega_u, zeta_u, .. } = structure;
        let &Base { g, tan_alpha_cg, .. } = structure.base();
        let step = side.sign() * g * tan_alpha_cg;
        let a_r = chi * (g * ModalRotations::of(structure, state)?.q_r - a_g - step);
        let u_ddot =
            chi / one_minus_chi * step - a_g - 2.0 * zeta_u * omega_u * state.u_dot - omega_u * omega_u * state.u;
        Ok(ModalAccelerations { a_r, a_u: one_minus_chi * u_ddot + a_g })
    }

    /// Of both modes together, a_t (Eq 20).
    pub fn a_t(&self) -> f64 {
        self.a_r + self.a_u
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Parameters;
    use approx::assert_relative_eq;
    use nalgebra::{Matrix2, Vector2};

    const STATE: State = State { u: 2e-4, u_dot: -0.03, theta: 0.02, theta_dot: 0.15 };

    /// The modes solve the linearised equations (7, 8) with the gravity terms that the modes keep: g H q_r in (8) and χ g q_r in
    /// (7). Both have the same moment about the node of the vibration mode.
    #[test]
    fn the_modes_solve_the_linearised_equations() {
        let structure = OneMass::new(Parameters::EVISON).unwrap();
        let &Parameters { m, H, B, g, .. } = structure.parameters();
        for (side, a_g) in [(Side::Right, 2.0), (Side::Left, -15.0)] {
            let q_r = ModalRotations::of(&structure, &STATE).unwrap().q_r;
            let mass = Matrix2::new(1.0, H, H, structure.base().J_P / m);
            let force = Vector2::new(
                structure.chi * g * q_r - (structure.c_u * STATE.u_dot + structure.k * STATE.u) / m - a_g,
                g * H * q_r - H * a_g - side.sign() * structure.gamma * g * B,
            );
            let accelerations = mass.try_inverse().unwrap() * force;
            let modal = ModalAccelerations::of(&structure, side, &STATE, a_g).unwrap();
            let a_t = accelerations[0] + H * accelerations[1] + a_g;
            assert_relative_eq!(modal.a_t(), a_t, max_relative = 1e-12);
            assert_relative_eq!(modal.a_u, structure.one_minus_chi * accelerations[0] + a_g, max_relative = 1e-12);
        }
    }
}
