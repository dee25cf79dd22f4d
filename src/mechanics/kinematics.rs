//! Where a point of the structure is in the ground's frame, and how it moves, as complex numbers x + iy.
//!
//! A point that is q = (x_b − sB) + i y_b from the pivot in the frame that turns with the base is at
//!
//! ```text
//! z = sB + q e^{−iθ},      for the top mass q = u − sB + iH,   for the middle of the base q = −sB
//! ```
//!
//! from the place of the middle of the base in full contact, x to the right and y upwards.

use crate::{Side, State, Structure};
use nalgebra::Complex;

/// A point's position (m) and its first three derivatives.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Point {
    pub position: Complex<f64>,
    pub velocity: Complex<f64>,
    pub acceleration: Complex<f64>,
    pub jerk: Complex<f64>,
}

/// The top mass and the middle of the base at `state`, whose (ü, θ̈) and (u⃛, θ⃛) are given; relative to the ground.
#[inline] // who wants positions and velocities alone does not pay for the rest
pub(crate) fn points(
    structure: &Structure,
    side: Side,
    state: &State,
    second: [f64; 2],
    third: [f64; 2],
) -> [Point; 2] {
    let &crate::Parameters { H, B, .. } = structure.parameters();
    let pivot = side.sign() * B;
    let turning = [state.theta, state.theta_dot, second[1], third[1]];
    [
        point(pivot, Complex::new(state.u - pivot, H), [state.u_dot, second[0], third[0]], turning),
        point(pivot, Complex::new(-pivot, 0.0), [0.0; 3], turning),
    ]
}

/// The point `q` from the `pivot`, whose real part has the derivatives (v, a, j); θ and its derivatives are `turning`.
#[inline]
fn point(pivot: f64, q: Complex<f64>, [v, a, j]: [f64; 3], turning: [f64; 4]) -> Point {
    let [theta, w, dw, ddw] = turning;
    let (sin, cos) = libm::sincos(theta);
    let towards = Complex::new(cos, -sin);
    let i = Complex::i();
    Point {
        position: towards * q + pivot,
        velocity: towards * (-i * w * q + v),
        acceleration: towards * ((-i * dw - w * w) * q - i * (2.0 * w * v) + a),
        jerk: towards
            * ((-i * ddw - 3.0 * w * dw + i * (w * w * w)) * q - i * (3.0 * (w * a + dw * v)) - 3.0 * w * w * v + j),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Outputs, Parameters, Phase};
    use approx::assert_relative_eq;

    /// u and θ as cubics of time: each derivative is the slope of the one before, and the position is that of Eq 26.
    #[test]
    fn each_derivative_is_the_slope_of_the_one_before() {
        let structure = Structure::new(Parameters::MCMANUS).unwrap();
        let [u, theta] = [[3e-3, 0.2, -5.0, 40.0], [-0.3, 0.8, 2.0, -9.0]];
        let at = |t: f64| {
            let derivative = |c: [f64; 4], n: usize| -> f64 {
                let falling = |k: usize| (k + 1 - n..=k).map(|f| f as f64).product::<f64>();
                (n..4).map(|k| falling(k) * c[k] * t.powi((k - n) as i32)).sum()
            };
            let [us, thetas] = [u, theta].map(|c| [0, 1, 2, 3].map(|n| derivative(c, n)));
            let state = State { u: us[0], u_dot: us[1], theta: thetas[0], theta_dot: thetas[1] };
            (state, points(&structure, Side::Left, &state, [us[2], thetas[2]], [us[3], thetas[3]]))
        };
        let h = 1e-5;
        let ((state, now), (_, before), (_, after)) = (at(0.01), at(0.01 - h), at(0.01 + h));
        let delta_t = Outputs::of(&structure, Phase::Rocking(Side::Left), &state, 0.0).delta_t;
        assert_relative_eq!(now[0].position.re, delta_t, max_relative = 1e-13);
        for k in 0..2 {
            let close = |value: Complex<f64>, get: fn(&Point) -> Complex<f64>| {
                let slope = (get(&after[k]) - get(&before[k])) / (2.0 * h);
                assert!((value - slope).norm() < 1e-7 * (1.0 + slope.norm()), "{value} {slope}");
            };
            close(now[k].velocity, |p| p.position);
            close(now[k].acceleration, |p| p.velocity);
            close(now[k].jerk, |p| p.acceleration);
        }
    }
}
