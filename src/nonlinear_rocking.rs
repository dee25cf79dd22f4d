//! Rocking about side s = ±1, in full (Eqs 5, 6).
//!
//! ```text
//! m ü + m H θ̈ = −c_u u̇ − k u − m θ̇² (sB − u) − m a_g cos θ + m g sin θ                            (5)
//!
//! m H ü + [J0 + m H² + m (sB − u)² + m0 B²] θ̈
//!     = 2 m (sB − u) u̇ θ̇ + m g H sin θ + m g u cos θ − s (m + m0) g B cos θ
//!       − a_g [ m H cos θ + (s (m + m0) B − m u) sin θ ]                                            (6)
//! ```
//!
//! The series need θ̈ alone on one side. (6) − H (5), over m, with w = sB − u and e = sγB − u:
//!
//! ```text
//! [(J0 + m0 B²)/m + w²] θ̈ = w θ̇ (2 u̇ + H θ̇) + H (c_u u̇ + k u)/m − e (g cos θ + a_g sin θ)
//! ```

use crate::engine::GroundAcceleration;
use crate::taylor::{Arc, MAX_ORDER, Series, Truncation, expand, product};
use crate::{Side, State, Structure};
use nalgebra::{Matrix2, Vector2};

/// (ü, θ̈) in m/s² and rad/s² under the ground acceleration `a_g` (m/s²): Eqs 5 and 6 as they stand, solved for the
/// accelerations. `None` where the mass matrix is singular: m0 = J0 = 0 and u = sB, the top mass above the pivot.
pub fn accelerations(structure: &Structure, side: Side, state: &State, a_g: f64) -> Option<Vector2<f64>> {
    let &crate::Parameters { m, m0, H, B, J0, g, .. } = structure.parameters();
    let &State { u, u_dot, theta, theta_dot } = state;
    let s = side.sign();
    let (sin, cos) = theta.sin_cos();
    let lever = s * B - u;
    let mass = Matrix2::new(m, m * H, m * H, J0 + m * H * H + m * lever * lever + m0 * B * B);
    let force = Vector2::new(
        -structure.c_u * u_dot - structure.k * u - m * theta_dot * theta_dot * lever - m * a_g * cos + m * g * sin,
        2.0 * m * lever * u_dot * theta_dot + m * g * H * sin + m * g * u * cos
            - s * (m + m0) * g * B * cos
            - a_g * (m * H * cos + (s * (m + m0) * B - m * u) * sin),
    );
    Some(mass.try_inverse()? * force)
}

/// The motion from `state` about `side` over at most `interval` (s) under `a_g`, as a series whose truncation errors in
/// u̇ and θ̇ are `local_error` times the largest velocities that the step can bring.
pub fn motion(
    structure: &Structure,
    side: Side,
    state: &State,
    a_g: GroundAcceleration,
    interval: f64,
    local_error: f64,
) -> Arc {
    let &crate::Parameters { m, m0, H, B, J0, g, .. } = structure.parameters();
    let s = side.sign();
    let stiffness = structure.omega_fc * structure.omega_fc;
    let damping = structure.c_u / m;
    let foundation = (J0 + m0 * B * B) / m;

    let zero: Series = [0.0; MAX_ORDER + 2];
    let (mut sin, mut cos) = (zero, zero);
    (sin[0], cos[0]) = state.theta.sin_cos();
    let mut lever = zero; // w = sB − u
    let mut gravity_lever = zero; // e = sγB − u
    let mut lever_speed = zero; // w θ̇
    let mut speeds = zero; // 2 u̇ + H θ̇
    let mut weight = zero; // g cos θ + a_g sin θ
    let mut inertia = zero; // (J0 + m0 B²)/m + w²
    let mut theta_ddot = zero;

    let truncation = truncation(structure, state, a_g, interval, local_error);
    expand(state, interval, truncation, |arc| {
        let k = arc.order;
        if k > 0 {
            sin[k] = product(&cos, &arc.theta_dot, k - 1) / k as f64;
            cos[k] = -product(&sin, &arc.theta_dot, k - 1) / k as f64;
        }
        lever[k] = if k == 0 { s * B - arc.u[0] } else { -arc.u[k] };
        gravity_lever[k] = if k == 0 { s * structure.gamma * B - arc.u[0] } else { -arc.u[k] };
        lever_speed[k] = product(&lever, &arc.theta_dot, k);
        speeds[k] = 2.0 * arc.u_dot[k] + H * arc.theta_dot[k];
        weight[k] = g * cos[k] + a_g.times(&sin, k);
        inertia[k] = product(&lever, &lever, k) + if k == 0 { foundation } else { 0.0 };
        let elastic = damping * arc.u_dot[k] + stiffness * arc.u[k];
        let moment = product(&lever_speed, &speeds, k) + H * elastic - product(&gravity_lever, &weight, k);
        theta_ddot[k] = 0.0;
        theta_ddot[k] = (moment - product(&inertia, &theta_ddot, k)) / inertia[0];
        let u_ddot =
            g * sin[k] - a_g.times(&cos, k) - elastic - product(&lever_speed, &arc.theta_dot, k) - H * theta_ddot[k];
        (u_ddot, theta_ddot[k])
    })
}

/// `local_error` times the velocities that a step of at most `interval` can bring from `state`.
fn truncation(
    structure: &Structure,
    state: &State,
    a_g: GroundAcceleration,
    interval: f64,
    local_error: f64,
) -> Truncation {
    let omega = structure.omega_u;
    let response_time = interval.min(1.0 / omega);
    let gravity = structure.parameters().g * structure.tan_alpha_cg;
    let forcing = a_g.value.abs() + a_g.slope.abs() * interval + gravity;
    let u_dot = state.u_dot.abs() + response_time * (omega * omega * state.u.abs() + forcing);
    let theta_dot = state.theta_dot.abs() + u_dot / structure.parameters().H;
    Truncation { u_dot: local_error * u_dot, theta_dot: local_error * theta_dot }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Parameters;
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    proptest! {
        /// The series' first coefficients are the accelerations of Eqs 5 and 6 as they stand, and the second ones
        /// their time derivatives (central differences along the motion).
        #[test]
        fn the_series_satisfies_equations_5_and_6(
            u in -0.05..0.05f64, u_dot in -2.0..2.0f64, theta in -1.2..1.2f64, theta_dot in -3.0..3.0f64,
            value in -20.0..20.0f64, slope in -500.0..500.0f64,
        ) {
            let structure = Structure::new(Parameters::MCMANUS).unwrap();
            let side = Side::of(theta);
            let state = State { u, u_dot, theta, theta_dot };
            let arc = motion(&structure, side, &state, GroundAcceleration { value, slope }, 2e-3, 1e-16);
            for tau in [0.0, 0.4e-3, 1.1e-3, 2e-3] {
                let expected = accelerations(&structure, side, &arc.at(tau), value + slope * tau).unwrap();
                let derivative = |series: &Series| -> f64 {
                    (1..=arc.order).map(|k| k as f64 * series[k] * tau.powi(k as i32 - 1)).sum()
                };
                let size = expected.norm() + 100.0;
                prop_assert!((derivative(&arc.u_dot) - expected[0]).abs() < 1e-10 * size);
                prop_assert!((derivative(&arc.theta_dot) - expected[1]).abs() < 1e-10 * size);
            }
        }
    }

    #[test]
    fn the_mass_matrix_is_singular_with_the_top_mass_above_the_pivot_of_a_massless_foundation() {
        let structure = Structure::new(Parameters { m0: 0.0, J0: 0.0, B: 0.25, ..Parameters::EVISON }).unwrap();
        let above_the_pivot = State { u: 0.25, theta: 0.01, ..State::default() };
        assert_eq!(accelerations(&structure, Side::Right, &above_the_pivot, 0.0), None);
    }

    #[test]
    fn mirrored_states_have_mirrored_accelerations() {
        let structure = Structure::new(Parameters::EVISON).unwrap();
        let state = State { u: 1e-3, u_dot: 0.02, theta: 0.03, theta_dot: -0.1 };
        let mirrored = State { u: -1e-3, u_dot: -0.02, theta: -0.03, theta_dot: 0.1 };
        let right = accelerations(&structure, Side::Right, &state, 1.5).unwrap();
        let left = accelerations(&structure, Side::Left, &mirrored, -1.5).unwrap();
        assert_relative_eq!(right, -left, max_relative = 1e-15);
    }
}
