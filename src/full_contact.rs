//! Full contact (Eq 1): a damped oscillator on the ground.
//!
//! ```text
//! ü + 2 ζ_fc ω_fc u̇ + ω_fc² u = −a_g,      θ = θ̇ = 0                                            (1)
//! ```

use crate::engine::GroundAcceleration;
use crate::taylor::{Arc, LONGEST_SPAN, Start, Truncation};
use crate::{State, Structure};

/// Elastic acceleration ü (m/s²) under the ground acceleration `a_g` (m/s²) by Eq 1.
pub fn acceleration(structure: &Structure, state: &State, a_g: f64) -> f64 {
    -a_g - structure.damping_fc * state.u_dot - structure.stiffness * state.u
}

/// Writes the motion from `start` into `arc`.
pub fn series(structure: &Structure, start: &Start, arc: &mut Arc) {
    let &Start { state, a_g, interval, local_error } = start;
    let &Structure { stiffness, damping_fc, omega_fc, .. } = structure;
    let span = interval.min(LONGEST_SPAN / omega_fc);
    let forcing = a_g.value.abs() + a_g.slope.abs() * span;
    let response_time = span.min(1.0 / omega_fc);
    let u_dot = state.u_dot.abs() + response_time * (stiffness * state.u.abs() + forcing);
    let truncation = Truncation { u_dot: local_error * u_dot, theta_dot: 0.0 };
    arc.expand(&state, span, truncation, |arc, k, per| {
        let u_ddot = -a_g.coefficient(k - 1, span) - damping_fc * arc.u_dot[k - 1] - stiffness * arc.u[k - 1];
        (u_ddot * per, 0.0)
    });
}

/// The exact flow over one length of time.
///
/// About the motion u_p = −(a_g(τ) − 2 ζ ȧ_g/ω)/ω², which follows a linear ground acceleration, the rest decays freely:
///
/// ```text
/// ⎡d⎤        −ζωh ⎡ C + ζω S      S    ⎤ ⎡d⎤
/// ⎣ḋ⎦(h) =  e     ⎣  −ω² S     C − ζω S⎦ ⎣ḋ⎦(0),    C = cos ω_d h,  S = sin ω_d h/ω_d,  ω_d = ω √(1−ζ²)
/// ```
#[derive(Clone, Copy, Debug)]
struct Flow {
    duration: f64,
    u_from: [f64; 2],
    u_dot_from: [f64; 2],
}

/// Flows kept at once. Records sampled at t = i·dt have a handful of lengths that differ in their last bits.
const FLOWS: usize = 16;

/// Exact propagation over whole intervals during which the base certainly stays down, with the flows used last.
#[derive(Clone, Debug)]
pub struct ExactContact {
    flows: [Flow; FLOWS],
    omega_d: f64,
}

impl ExactContact {
    /// Nothing kept yet.
    pub fn new(structure: &Structure) -> ExactContact {
        let zeta = structure.parameters().zeta_fc;
        // NaN from critical damping on, which makes every comparison below fail: the series serves those.
        let omega_d = structure.omega_fc * (1.0 - zeta * zeta).sqrt();
        ExactContact { flows: [Flow { duration: 0.0, u_from: [0.0; 2], u_dot_from: [0.0; 2] }; FLOWS], omega_d }
    }

    /// The state after `interval` (s) if |u| certainly stays below `limit` (m) until then.
    #[inline]
    pub fn leap(
        &mut self,
        structure: &Structure,
        state: &State,
        a_g: GroundAcceleration,
        interval: f64,
        limit: f64,
    ) -> Option<State> {
        let stiffness = structure.stiffness;
        let following = |tau: f64| (structure.damping_fc * a_g.slope / stiffness - a_g.at(tau)) / stiffness;
        let following_dot = -a_g.slope / stiffness;
        let (before, after) = (following(0.0), following(interval));
        let (rest, rest_dot) = (state.u - before, state.u_dot - following_dot);
        let quadrature = (rest_dot + 0.5 * structure.damping_fc * rest) / self.omega_d;
        let amplitude = (rest * rest + quadrature * quadrature).sqrt();
        let stays_below = before.abs().max(after.abs()) + amplitude < limit;
        if !stays_below {
            return None;
        }
        let Flow { u_from, u_dot_from, .. } = self.flow(structure, interval);
        Some(State {
            u: after + u_from[0] * rest + u_from[1] * rest_dot,
            u_dot: following_dot + u_dot_from[0] * rest + u_dot_from[1] * rest_dot,
            theta: 0.0,
            theta_dot: 0.0,
        })
    }

    #[inline]
    fn flow(&mut self, structure: &Structure, duration: f64) -> Flow {
        // the top bits of a multiplicative hash: lengths that differ in their last bits go to different places
        let slot = (duration.to_bits().wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 60) as usize;
        if self.flows[slot].duration != duration {
            let decay_rate = 0.5 * structure.damping_fc;
            let decay = (-decay_rate * duration).exp();
            let (sin, cos) = (self.omega_d * duration).sin_cos();
            let (cos, sin) = (decay * cos, decay * sin / self.omega_d);
            self.flows[slot] = Flow {
                duration,
                u_from: [cos + decay_rate * sin, sin],
                u_dot_from: [-structure.stiffness * sin, cos - decay_rate * sin],
            };
        }
        self.flows[slot]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Parameters;
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    /// Closed form from rest: free decay plus the particular solution of a linear ramp.
    fn ramp_from_rest(structure: &Structure, a_g: GroundAcceleration, t: f64) -> f64 {
        let (w, z) = (structure.omega_fc, structure.parameters().zeta_fc);
        let wd = w * (1.0 - z * z).sqrt();
        let offset = -a_g.value / (w * w) + 2.0 * z * a_g.slope / w.powi(3);
        let rate = -a_g.slope / (w * w);
        let (a, b) = (-offset, (-rate - z * w * offset) / wd);
        offset + rate * t + (-z * w * t).exp() * (a * (wd * t).cos() + b * (wd * t).sin())
    }

    const RAMP: GroundAcceleration = GroundAcceleration { value: 0.7, slope: -30.0 };

    #[test]
    fn the_series_follows_the_closed_form() {
        let structure = Structure::new(Parameters::EVISON).unwrap();
        let mut state = State::default();
        let mut time = 0.0;
        let mut arc = Arc::default();
        while time < 0.3 {
            let a_g = GroundAcceleration { value: RAMP.at(time), ..RAMP };
            series(&structure, &Start { state, a_g, interval: 0.3 - time, local_error: 1e-15 }, &mut arc);
            state = arc.end();
            time += arc.duration();
        }
        assert_relative_eq!(state.u, ramp_from_rest(&structure, RAMP, time), max_relative = 1e-13);
    }

    #[test]
    fn the_exact_flow_follows_the_closed_form() {
        let structure = Structure::new(Parameters::EVISON).unwrap();
        let mut contact = ExactContact::new(&structure);
        let end = contact.leap(&structure, &State::default(), RAMP, 0.3, f64::INFINITY).unwrap();
        assert_relative_eq!(end.u, ramp_from_rest(&structure, RAMP, 0.3), max_relative = 1e-13);
    }

    proptest! {
        /// A leap ends where the series does, and is refused wherever the series reaches the limit on its way.
        #[test]
        fn a_leap_agrees_with_the_series_and_never_passes_the_limit(
            u in -1e-3..1e-3f64, u_dot in -0.1..0.1f64, value in -3.0..3.0f64, slope in -300.0..300.0f64,
            zeta_fc in 0.0..1.2f64, interval in 1e-4..0.02f64,
        ) {
            let structure = Structure::new(Parameters { zeta_fc, ..Parameters::EVISON }).unwrap();
            let state = State { u, u_dot, ..State::default() };
            let a_g = GroundAcceleration { value, slope };
            let mut arc = Arc::default();
            series(&structure, &Start { state, a_g, interval, local_error: 1e-15 }, &mut arc);
            prop_assert_eq!(arc.reach, 1.0);
            let highest = (0..=1000).map(|i| arc.at(i as f64 / 1000.0).u.abs()).fold(0.0, f64::max);
            let mut contact = ExactContact::new(&structure);
            if let Some(end) = contact.leap(&structure, &state, a_g, interval, structure.u_cr) {
                prop_assert!(highest < structure.u_cr);
                prop_assert!((end.u - arc.end().u).abs() < 1e-16 + 1e-13 * highest);
                prop_assert!((end.u_dot - arc.end().u_dot).abs() < structure.omega_fc * (1e-16 + 1e-13 * highest));
            }
        }
    }
}
