//! Full contact (Eq 1): a damped oscillator on the ground.
//!
//! ```text
//! ü + 2 ζ_fc ω_fc u̇ + ω_fc² u = −a_g,      θ = θ̇ = 0                                            (1)
//! ```

use crate::engine::GroundAcceleration;
use crate::taylor::{Arc, Truncation, expand};
use crate::{State, Structure};

/// Elastic acceleration ü (m/s²) under the ground acceleration `a_g` (m/s²) by Eq 1.
pub fn acceleration(structure: &Structure, state: &State, a_g: f64) -> f64 {
    -a_g - (structure.c_fc * state.u_dot + structure.k * state.u) / structure.parameters().m
}

/// The motion from `state` over at most `interval` (s) under `a_g`, as a series whose truncation error in u̇ is
/// `local_error` times the largest velocity that the step can bring.
pub fn motion(structure: &Structure, state: &State, a_g: GroundAcceleration, interval: f64, local_error: f64) -> Arc {
    let stiffness = structure.omega_fc * structure.omega_fc;
    let damping = structure.c_fc / structure.parameters().m;
    let forcing = a_g.value.abs() + a_g.slope.abs() * interval;
    let response_time = interval.min(1.0 / structure.omega_fc);
    let u_dot = state.u_dot.abs() + response_time * (stiffness * state.u.abs() + forcing);
    let truncation = Truncation { u_dot: local_error * u_dot, theta_dot: 0.0 };
    expand(state, interval, truncation, |arc| {
        let k = arc.order;
        let u_ddot = -a_g.coefficient(k) - damping * arc.u_dot[k] - stiffness * arc.u[k];
        (u_ddot, 0.0)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Parameters;
    use approx::assert_relative_eq;

    /// Closed form: free decay plus the particular solution of a linear ramp.
    #[test]
    fn a_ramp_from_rest_follows_the_closed_form() {
        let structure = Structure::new(Parameters::EVISON).unwrap();
        let (w, z) = (structure.omega_fc, structure.parameters().zeta_fc);
        let (value, slope) = (0.7, -30.0);
        let wd = w * (1.0 - z * z).sqrt();
        let exact = |t: f64| {
            // particular: −(value + slope t)/ω² + 2ζ slope/ω³; free part from rest
            let offset = -value / (w * w) + 2.0 * z * slope / w.powi(3);
            let rate = -slope / (w * w);
            let (a, b) = (-offset, (-rate - z * w * offset) / wd);
            offset + rate * t + (-z * w * t).exp() * (a * (wd * t).cos() + b * (wd * t).sin())
        };
        let mut state = State::default();
        let mut time = 0.0;
        while time < 0.3 {
            let a_g = GroundAcceleration { value: value + slope * time, slope };
            let arc = motion(&structure, &state, a_g, 0.3 - time, 1e-15);
            state = arc.at(arc.duration);
            time += arc.duration;
        }
        assert_relative_eq!(state.u, exact(time), max_relative = 1e-13);
    }
}
