//! The classical Runge–Kutta method, order 4, with x' = v, v' = a(t, x, v):
//!
//! ```text
//! k₁ = f(t, y)   k₂ = f(t + h/2, y + h k₁/2)   k₃ = f(t + h/2, y + h k₂/2)   k₄ = f(t + h, y + h k₃)
//! y₁ = y₀ + h (k₁ + 2 k₂ + 2 k₃ + k₄)/6
//! ```

use super::{OneStep, Point};
use crate::equations::Equations;
use nalgebra::Vector2;

/// RK4.
pub struct RungeKutta4;

impl OneStep for RungeKutta4 {
    fn step(&self, equations: &dyn Equations, tau: f64, from: &Point, h: f64) -> Point {
        let Point { position: x, velocity: v, .. } = *from;
        let slope = |c: f64, (dx, dv): (Vector2<f64>, Vector2<f64>)| {
            let v = v + c * h * dv;
            (v, equations.acceleration(tau + c * h, x + c * h * dx, v))
        };
        let k1 = (v, equations.acceleration(tau, x, v));
        let k2 = slope(0.5, k1);
        let k3 = slope(0.5, k2);
        let k4 = slope(1.0, k3);
        Point {
            position: x + h / 6.0 * (k1.0 + 2.0 * (k2.0 + k3.0) + k4.0),
            velocity: v + h / 6.0 * (k1.1 + 2.0 * (k2.1 + k3.1) + k4.1),
            acceleration: None,
        }
    }
}
