//! Rocking about side s = ±1 by two uncoupled modes (Eqs 11, 16, 18).
//!
//! ```text
//! q̈_r − p_l² q_r = −p_l² a_g/g − s p_l² tan α_cg                                                           (11)
//! ü + 2 ζ_u ω_u u̇ + ω_u² u = −a_g + s (χ/(1−χ)) g tan α_cg                                                 (18)
//! θ = q_r + q_u,      q_u = −(p_l²/g) u                                                                    (16)
//! ```
//!
//! A force F_t on the top mass replaces a_g by a_g − F_t/m. Both equations have closed forms under loads that are linear in time.
//! Steps on which a transition may happen use series instead, of the same equations written for θ = q_r − (p_l²/g) u.

use crate::levels::level::{ElasticRocking, Now, Pace, Rates, Subject};
use crate::levels::linear_system::{LinearSystem, Row};
use crate::levels::oscillator::{Flow, Kept, Oscillator, Swing};
use crate::mechanics::instant::Second;
use crate::numbers::bend::Bend;
use crate::series::taylor::{Arc, Start, reciprocal};
use crate::{Side, State, Structure};
use std::f64::consts::FRAC_PI_2;

/// Propagation by the closed forms of Eqs 11 and 18.
#[derive(Clone, Debug)]
pub(crate) struct ModalRocking {
    subject: Subject,
    pace: Pace,
    pub(crate) system: LinearSystem,
    vibration: Oscillator,
    /// (χ/(1−χ)) g tan α_cg, m/s².
    gravity_forcing: f64,
    tan_alpha_cg: f64,
    g: f64,
    p_l: f64,
    flows: Kept<(Flow, Growth)>,
}

/// Coefficients of the rocking mode over a time h: q_r grows from q by cosh(p_l h), and the load drives q_r from 0.
#[derive(Clone, Copy, Debug, Default)]
struct Growth {
    sinh: f64,
    /// cosh − 1, the response to a constant load.
    step: f64,
    /// (sinh − p_l h)/p_l, the response to the slope of the load, s.
    ramp: f64,
}

impl Growth {
    fn over(p_l: f64, h: f64) -> Growth {
        let x = p_l * h;
        let sinh = libm::sinh(x);
        // sinh x − x loses its digits where x is small: x³/3! + x⁵/5! + …
        let excess = if x < 1.0 {
            let next = |sum: f64, k: usize| (1.0 + sum) * x * x * reciprocal(2 * k) * reciprocal(2 * k + 1);
            (1..=9).rev().fold(0.0, next) * x
        } else {
            sinh - x
        };
        Growth { sinh, step: 2.0 * libm::sinh(0.5 * x).powi(2), ramp: excess / p_l }
    }
}

impl ModalRocking {
    pub(crate) fn new(subject: Subject) -> ModalRocking {
        let structure = &subject.structure;
        let &Structure { p_l, omega_u, zeta_u, tan_alpha_cg, chi, one_minus_chi, .. } = structure;
        let g = structure.parameters().g;
        let gravity_forcing = chi / one_minus_chi * g * tan_alpha_cg;
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
            subject,
            pace: Pace::new(structure),
            system: LinearSystem { u_ddot, theta_ddot },
            vibration: Oscillator { omega: omega_u, zeta: zeta_u },
            gravity_forcing,
            tan_alpha_cg,
            g,
            p_l,
            flows: Kept::new((Flow::NONE, Growth::default())),
        }
    }
}

impl ElasticRocking for ModalRocking {
    #[inline(always)]
    fn subject(&self) -> &Subject {
        &self.subject
    }

    /// The state after the interval of `start` if rocking about `side` certainly goes on until then.
    ///
    /// q_r leaves the line that follows the load by a hyperbolic arc, which is farthest from it at an end and bounds
    /// |q̈_r|; u stays within its amplitude of the line that it follows.
    #[inline(always)]
    fn leap(&self, side: Side, start: &Start) -> Option<State> {
        let &Start { state: State { u, u_dot, theta, theta_dot }, a_top, interval, .. } = start;
        let &ModalRocking { vibration, p_l, g, tan_alpha_cg, gravity_forcing, .. } = self;
        let s = side.sign();
        let (flow, Growth { sinh, step, ramp }) =
            &*self.flows.over(interval, || (vibration.flow(interval), Growth::over(p_l, interval)));
        let shape = p_l * p_l / g;
        let (line, line_slope) = (a_top.value / g + s * tan_alpha_cg, a_top.slope / g);
        let (q_r, q_r_dot) = (theta + shape * u, theta_dot + shape * u_dot);
        let off = q_r - line;
        let q_r_end = q_r + sinh * q_r_dot / p_l + (step * off - ramp * line_slope);
        let q_r_dot_end = q_r_dot + p_l * sinh * off + step * (q_r_dot - line_slope);
        let off_end = q_r_end - line - line_slope * interval;

        let load = a_top.value - s * gravity_forcing;
        let Swing { following, amplitude } = vibration.swing([u, u_dot], load, a_top.slope, interval);
        let off_chord = off.abs().max(off_end.abs()) * (p_l * interval).powi(2) / 8.0 + shape * amplitude;
        let [first, last] = [q_r - shape * following[0], q_r_end - shape * following[1]].map(|theta| s * theta);
        let goes_on = first.min(last) > off_chord && first.max(last) + off_chord < FRAC_PI_2;
        goes_on.then(|| {
            let [u, u_dot] = flow.driven([u, u_dot], load, a_top.slope);
            State { u, u_dot, theta: q_r_end - shape * u, theta_dot: q_r_dot_end - shape * u_dot }
        })
    }

    /// Bounds of what changes on the way from `start` about `side` to `end`.
    fn rates(&self, side: Side, start: &Start, end: &State) -> Rates {
        let &Start { state, a_top, interval, .. } = start;
        let &ModalRocking { vibration, p_l, g, tan_alpha_cg, gravity_forcing, .. } = self;
        let s = side.sign();
        let load = a_top.value - s * gravity_forcing;
        let swing = vibration.swing([state.u, state.u_dot], load, a_top.slope, interval);
        let [u_dot, u_ddot, u_dddot] = vibration.rates(&swing, a_top.slope);
        let shape = p_l * p_l / g;
        // off the line that q_r follows, and the rate of that, are largest at an end
        let off = |state: &State, a: f64| (state.theta + shape * state.u - a / g - s * tan_alpha_cg).abs();
        let off_rate = |state: &State| (state.theta_dot + shape * state.u_dot - a_top.slope / g).abs();
        let off = off(&state, a_top.value).max(off(end, a_top.at(interval)));
        let q_r = off + a_top.value.abs().max(a_top.at(interval).abs()) / g + tan_alpha_cg;
        let q_r_dot = off_rate(&state).max(off_rate(end)) + a_top.slope.abs() / g;
        Rates {
            u: swing.farthest(),
            u_dot,
            u_ddot,
            u_dddot,
            theta: q_r + shape * swing.farthest(),
            theta_dot: q_r_dot + shape * u_dot,
            theta_ddot: p_l * p_l * off + shape * u_ddot,
        }
    }

    fn second(&self, rates: &Rates) -> Option<Second<Bend>> {
        Some(self.system.second(rates))
    }

    fn series(&self, side: Side, start: &Start, arc: &mut Arc) {
        self.system.series(&self.pace, side, start, arc);
    }

    /// χ (1−χ): what the two modes leave of g u.
    fn lean(&self) -> f64 {
        let &Structure { chi, one_minus_chi, .. } = &self.subject.structure;
        chi * one_minus_chi
    }

    fn accelerations(&self, side: Side, now: &Now) -> [f64; 2] {
        self.system.accelerations(side, now.state, now.load.on_top(&self.subject.structure))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Parameters;
    use crate::mechanics::restraint::Angles;
    use approx::assert_relative_eq;

    /// The accelerations are those of Eqs 11, 16 and 18 as they stand.
    #[test]
    fn the_accelerations_satisfy_equations_11_and_18() {
        let structure = Structure::new(Parameters::EVISON).unwrap();
        let &Structure { p_l, omega_u, zeta_u, tan_alpha_cg, chi, .. } = &structure;
        let g = structure.parameters().g;
        let state = State { u: 8e-4, u_dot: -0.03, theta: 0.02, theta_dot: 0.3 };
        let (s, a_g) = (1.0, -2.5);
        let [u_ddot, theta_ddot] =
            ModalRocking::new(Subject { structure, local_error: 1e-9, is_tied: false, angles: Angles::Any })
                .system
                .accelerations(Side::Right, &state, a_g);
        let forcing = -a_g + s * chi / (1.0 - chi) * g * tan_alpha_cg;
        let left = u_ddot + 2.0 * zeta_u * omega_u * state.u_dot + omega_u * omega_u * state.u;
        assert_relative_eq!(left, forcing, max_relative = 1e-12);
        let (q_r, q_r_ddot) = (state.theta + p_l * p_l / g * state.u, theta_ddot + p_l * p_l / g * u_ddot);
        let forcing = -p_l * p_l * a_g / g - s * p_l * p_l * tan_alpha_cg;
        assert_relative_eq!(q_r_ddot - p_l * p_l * q_r, forcing, max_relative = 1e-10);
    }
}
