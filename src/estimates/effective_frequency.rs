//! Effective frequency of rocking (Eq 14).
//!
//! Released at rest from θ_i, the rocking mode (Eq 11 without ground motion) comes down after
//!
//! ```text
//! t = acosh(1/(1 − θ_i/tan α_cg))/p_l,        f_r = 1/(4 t)                                            (14)
//! ```
//!
//! f_r falls from ∞ at θ_i → 0 to 0 at θ_i = tan α_cg, the unstable equilibrium, from which the structure never comes
//! down. A real structure does not exceed f_fc: rocking that small is vibration in full contact.

use crate::estimates::demand::check_is_free;
use crate::{OneMass, Refused};

/// Time from release at rest at the rotation `theta` (rad) to impact, s; ∞ from tan α_cg on.
pub fn time_to_impact(structure: &OneMass, theta: f64) -> Result<f64, Refused> {
    check_is_free(structure)?;
    let part = theta.abs() / structure.base().tan_alpha_cg;
    if part >= 1.0 {
        return Ok(f64::INFINITY);
    }
    let x = part / (1.0 - part); // acosh(1 + x), with every digit of a small x
    Ok(libm::log1p(x + (x * (x + 2.0)).sqrt()) / structure.base().p_l)
}

/// Effective rocking frequency f_r of the amplitude `theta` (rad), Hz (Eq 14), of a structure without ties.
pub fn effective_frequency(structure: &OneMass, theta: f64) -> Result<f64, Refused> {
    Ok(0.25 / time_to_impact(structure, theta)?)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Parameters;
    use approx::assert_relative_eq;

    fn evison() -> OneMass {
        OneMass::new(Parameters::EVISON).unwrap()
    }

    /// Eq 11 with a_g = 0: q_r = tan α_cg − (tan α_cg − θ_i) cosh(p_l t) is 0 at the time found.
    #[test]
    fn the_rocking_mode_is_back_at_zero() {
        let structure = evison();
        for part in [1e-12, 1e-6, 0.1, 0.5, 0.9, 0.999_999] {
            let theta = part * structure.base().tan_alpha_cg;
            let half = 0.5 * structure.base().p_l * time_to_impact(&structure, theta).unwrap();
            // cosh − 1 = 2 sinh²(half argument)
            let dropped = (structure.base().tan_alpha_cg - theta) * 2.0 * half.sinh().powi(2);
            assert_relative_eq!(dropped, theta, max_relative = 1e-13 / (1.0 - part));
        }
    }

    #[test]
    fn the_limits_are_those_of_no_rotation_and_of_the_unstable_equilibrium() {
        let structure = evison();
        assert_eq!(effective_frequency(&structure, 0.0), Ok(f64::INFINITY));
        assert_eq!(effective_frequency(&structure, -structure.base().tan_alpha_cg), Ok(0.0));
        assert_eq!(effective_frequency(&structure, 1.0), Ok(0.0));
    }
}
