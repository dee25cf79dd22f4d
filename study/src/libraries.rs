//! Other libraries' solvers, restarted at each sample of the ground motion and at each transition.

pub mod differential_equations;
pub mod diffsol;
pub mod ode_solvers;

use crate::equations::{LateralEquations, PhaseEquations, state};
use crate::fixed_step::MovingPoint;
use nalgebra::Vector2;

/// Absolute tolerance over relative tolerance: u and θ are of the order of 0.01 m and 0.01 rad.
const ABSOLUTE: f64 = 1e-3;

/// u, θ, u̇, θ̇.
fn numbers(point: &MovingPoint) -> [f64; 4] {
    [point.position[0], point.position[1], point.velocity[0], point.velocity[1]]
}

fn point(y: &[f64]) -> MovingPoint {
    MovingPoint::start(&state(Vector2::new(y[0], y[1]), Vector2::new(y[2], y[3])))
}

/// Their rates, `tau` s into the interval.
fn rates(equations: &PhaseEquations, tau: f64, y: &[f64]) -> [f64; 4] {
    let acceleration = equations.acceleration(tau, Vector2::new(y[0], y[1]), Vector2::new(y[2], y[3]));
    [y[2], y[3], acceleration[0], acceleration[1]]
}
