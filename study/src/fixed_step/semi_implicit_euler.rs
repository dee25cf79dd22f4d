//! Semi-implicit (symplectic) Euler, order 1:
//!
//! ```text
//! v₁ = v₀ + h a(t₀, x₀, v₀)
//! x₁ = x₀ + h v₁
//! ```

use super::{OneStep, Point};
use crate::equations::Equations;

/// Semi-implicit Euler.
pub struct SemiImplicitEuler;

impl OneStep for SemiImplicitEuler {
    fn step(&self, equations: &dyn Equations, tau: f64, from: &Point, h: f64) -> Point {
        let velocity = from.velocity + h * equations.acceleration(tau, from.position, from.velocity);
        Point { position: from.position + h * velocity, velocity, acceleration: None }
    }
}
