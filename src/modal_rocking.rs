//! Rocking about side s = ±1 by two uncoupled modes (Eqs 11, 16, 18).
//!
//! ```text
//! q̈_r − p_l² q_r = −p_l² a_g/g − s p_l² tan α_cg                                                           (11)
//! ü + 2 ζ_u ω_u u̇ + ω_u² u = −a_g + s (β/(1−β)) g tan α_cg                                                 (18)
//! θ = q_r + q_u,      q_u = −(p_l²/g) u                                                                    (16)
//! ```
//!
//! A force F_t on the top mass makes a_g − F_t/m of a_g. Both have closed forms under loads that are linear in time;
//! series serve the steps on which a transition may happen, from the same equations written for θ = q_r − (p_l²/g) u.

use crate::linear_system::{LinearSystem, Row};
use crate::oscillator::{Driven, Kept, Oscillator};
use crate::taylor::Start;
use crate::{Side, State, Structure};
use nalgebra::Matrix2;
use std::f64::consts::FRAC_PI_2;

/// Propagation by the closed forms of Eqs 11 and 18.
#[derive(Clone, Debug)]
pub struct ModalRocking {
    pub(crate) system: LinearSystem,
    vibration: Oscillator,
    /// (β/(1−β)) g tan α_cg, m/s².
    gravity_forcing: f64,
    tan_alpha_cg: f64,
    g: f64,
    p_l: f64,
    /// Flows of the vibration mode, and cosh and sinh of p_l h.
    flows: Kept<(Matrix2<f64>, f64, f64)>,
}

impl ModalRocking {
    /// For `structure`.
    pub fn new(structure: &Structure) -> ModalRocking {
        let &Structure { p_l, omega_u, zeta_u, tan_alpha_cg, beta, one_minus_beta, .. } = structure;
        let g = structure.parameters().g;
        let gravity_forcing = beta / one_minus_beta * g * tan_alpha_cg;
        let u_ddot = Row {
            u: -omega_u * omega_u,
            u_dot: -2.0 * zeta_u * omega_u,
            theta: 0.0,
            a_top: -1.0,
            side: gravity_forcing,
        };
        let shape = p_l * p_l / g; // −q_u/u
        let theta_ddot = Row {
            u: shape * (p_l * p_l - u_ddot.u),
            u_dot: -shape * u_ddot.u_dot,
            theta: p_l * p_l,
            a_top: 0.0,
            side: -p_l * p_l * tan_alpha_cg - shape * gravity_forcing,
        };
        ModalRocking {
            system: LinearSystem { u_ddot, theta_ddot },
            vibration: Oscillator { omega: omega_u, zeta: zeta_u },
            gravity_forcing,
            tan_alpha_cg,
            g,
            p_l,
            flows: Kept::new((Matrix2::identity(), 1.0, 0.0)),
        }
    }

    /// The state after the interval of `start` if rocking about `side` certainly goes on until then.
    ///
    /// q_r leaves the line that follows the load by a hyperbolic arc, which is farthest from it at an end and bounds
    /// |q̈_r|; u stays within its amplitude of the line that it follows.
    #[inline]
    pub fn leap(&mut self, side: Side, start: &Start) -> Option<State> {
        let &Start { state: State { u, u_dot, theta, theta_dot }, a_top, interval, .. } = start;
        let &mut ModalRocking { vibration, p_l, g, tan_alpha_cg, gravity_forcing, .. } = self;
        if !vibration.can_leap(interval) {
            return None;
        }
        let s = side.sign();
        let (flow, cosh, sinh) =
            self.flows.over(interval, || (vibration.flow(interval), (p_l * interval).cosh(), (p_l * interval).sinh()));
        let load = a_top.value - s * gravity_forcing;
        let Driven { end, following, amplitude } = vibration.driven(flow, [u, u_dot], load, a_top.slope, interval);

        let shape = p_l * p_l / g;
        let line = |tau: f64| a_top.at(tau) / g + s * tan_alpha_cg;
        let line_rate = a_top.slope / g;
        let off = theta + shape * u - line(0.0);
        let off_rate = theta_dot + shape * u_dot - line_rate;
        let off_end = cosh * off + sinh * off_rate / p_l;
        let off_rate_end = p_l * sinh * off + cosh * off_rate;
        let end_of = |q_r: f64, u: f64| q_r - shape * u;
        let (q_r, q_r_dot) = (line(interval) + off_end, line_rate + off_rate_end);

        let off_chord = off.abs().max(off_end.abs()) * (p_l * interval).powi(2) / 8.0 + shape * amplitude;
        let first = s * (theta + shape * (u - following[0]));
        let last = s * end_of(q_r, following[1]);
        let goes_on = first.min(last) > off_chord && first.max(last) + off_chord < FRAC_PI_2;
        goes_on.then(|| State {
            u: end[0],
            u_dot: end[1],
            theta: end_of(q_r, end[0]),
            theta_dot: end_of(q_r_dot, end[1]),
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Parameters;
    use crate::load::GroundAcceleration;
    use crate::taylor::Arc;
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    /// The accelerations are those of Eqs 11, 16 and 18 as they stand.
    #[test]
    fn the_accelerations_satisfy_equations_11_and_18() {
        let structure = Structure::new(Parameters::EVISON).unwrap();
        let &Structure { p_l, omega_u, zeta_u, tan_alpha_cg, beta, .. } = &structure;
        let g = structure.parameters().g;
        let state = State { u: 8e-4, u_dot: -0.03, theta: 0.02, theta_dot: 0.3 };
        let (s, a_g) = (1.0, -2.5);
        let [u_ddot, theta_ddot] = ModalRocking::new(&structure).system.accelerations(Side::Right, &state, a_g);
        let forcing = -a_g + s * beta / (1.0 - beta) * g * tan_alpha_cg;
        let left = u_ddot + 2.0 * zeta_u * omega_u * state.u_dot + omega_u * omega_u * state.u;
        assert_relative_eq!(left, forcing, max_relative = 1e-12);
        let (q_r, q_r_ddot) = (state.theta + p_l * p_l / g * state.u, theta_ddot + p_l * p_l / g * u_ddot);
        let forcing = -p_l * p_l * a_g / g - s * p_l * p_l * tan_alpha_cg;
        assert_relative_eq!(q_r_ddot - p_l * p_l * q_r, forcing, max_relative = 1e-10);
    }

    proptest! {
        /// A leap ends where the series does, and is refused wherever the series comes back to the ground.
        #[test]
        fn a_leap_agrees_with_the_series_and_never_passes_an_impact(
            u in -4e-3..4e-3f64, u_dot in -0.4..0.4f64, theta in -0.05..-1e-4f64, theta_dot in -1.0..1.0f64,
            value in -5.0..5.0f64, slope in -300.0..300.0f64, interval in 1e-3..0.02f64,
        ) {
            let structure = Structure::new(Parameters::MCMANUS).unwrap();
            let state = State { u, u_dot, theta, theta_dot };
            let a_g = GroundAcceleration { value, slope };
            let start = Start { state, a_g, a_top: a_g, interval, local_error: 1e-15 };
            let mut rocking = ModalRocking::new(&structure);
            let mut arc = Arc::default();
            rocking.system.series(&structure, Side::Left, &start, &mut arc);
            prop_assert_eq!(arc.reach, 1.0);
            let highest = (0..=1000).map(|i| arc.at(i as f64 / 1000.0).theta).fold(-1.0, f64::max);
            if let Some(end) = rocking.leap(Side::Left, &start) {
                prop_assert!(highest < 0.0);
                let expected = arc.end();
                prop_assert!((end.theta - expected.theta).abs() < 1e-14);
                prop_assert!((end.theta_dot - expected.theta_dot).abs() < 1e-12);
                prop_assert!((end.u - expected.u).abs() < 1e-14);
                prop_assert!((end.u_dot - expected.u_dot).abs() < 1e-12);
            } else {
                prop_assert!(highest > -0.03);
            }
        }
    }
}
