//! The method of Hilber, Hughes and Taylor with α = −0.1 and their β = (1 − α)²/4, γ = 1/2 − α, order 2:
//!
//! ```text
//! x₁ = x₀ + h v₀ + h² [(1/2 − β) a₀ + β a₁]
//! v₁ = v₀ + h [(1 − γ) a₀ + γ a₁]           a₁ = (1 + α) a(t₁, x₁, v₁) − α a(t₀, x₀, v₀)
//! ```
//!
//! Internal and external forces alike are weighted by 1 + α at the end and −α at the start of the step. The method's a
//! is not that of the equations; it is carried from step to step and starts anew after a transition.

use super::{OneStep, Point, implicit};
use crate::equations::Equations;

/// Numerical damping: 0 none, −1/3 most.
pub const ALPHA: f64 = -0.1;

const BETA: f64 = (1.0 - ALPHA) * (1.0 - ALPHA) / 4.0;
const GAMMA: f64 = 0.5 - ALPHA;

/// HHT-α.
pub struct HhtAlpha;

impl OneStep for HhtAlpha {
    fn step(&self, equations: &dyn Equations, tau: f64, from: &Point, h: f64) -> Point {
        let there = equations.acceleration(tau, from.position, from.velocity);
        let start = from.acceleration.unwrap_or(there);
        let position = |end| from.position + h * from.velocity + h * h * ((0.5 - BETA) * start + BETA * end);
        let velocity = |end| from.velocity + h * ((1.0 - GAMMA) * start + GAMMA * end);
        let end = implicit::solve(start, |a| {
            (1.0 + ALPHA) * equations.acceleration(tau + h, position(a), velocity(a)) - ALPHA * there
        });
        Point { position: position(end), velocity: velocity(end), acceleration: Some(end) }
    }
}
