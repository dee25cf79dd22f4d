//! Explicit (forward) Euler, order 1:
//!
//! ```text
//! x₁ = x₀ + h v₀
//! v₁ = v₀ + h a(t₀, x₀, v₀)
//! ```

use super::{OneStep, Point};
use crate::equations::Equations;

/// Explicit Euler.
pub struct ExplicitEuler;

impl OneStep for ExplicitEuler {
    fn step(&self, equations: &dyn Equations, tau: f64, from: &Point, h: f64) -> Point {
        let acceleration = equations.acceleration(tau, from.position, from.velocity);
        Point {
            position: from.position + h * from.velocity,
            velocity: from.velocity + h * acceleration,
            acceleration: None,
        }
    }
}
