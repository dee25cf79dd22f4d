//! Newmark's method with average acceleration (β = 1/4, γ = 1/2: the trapezoidal rule), order 2:
//!
//! ```text
//! x₁ = x₀ + h v₀ + h² (a₀ + a₁)/4
//! v₁ = v₀ + h (a₀ + a₁)/2             a₁ = a(t₁, x₁, v₁)
//! ```

use super::{OneStep, Point, implicit};
use crate::equations::Equations;

/// Newmark with average acceleration.
pub struct AverageAcceleration;

impl OneStep for AverageAcceleration {
    fn step(&self, equations: &dyn Equations, tau: f64, from: &Point, h: f64) -> Point {
        let start = from.acceleration(equations, tau);
        let position = |end| from.position + h * from.velocity + 0.25 * h * h * (start + end);
        let velocity = |end| from.velocity + 0.5 * h * (start + end);
        let end = implicit::solve(start, |a| equations.acceleration(tau + h, position(a), velocity(a)));
        Point { position: position(end), velocity: velocity(end), acceleration: Some(end) }
    }
}
