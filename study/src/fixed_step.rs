//! Textbook methods of fixed step, each in a file with its formulas on top.

pub mod central_difference;
pub mod explicit_euler;
pub mod hht_alpha;
mod implicit;
pub mod newmark;
pub mod runge_kutta_4;
pub mod semi_implicit_euler;

use crate::equations::{Equations, state};
use nalgebra::Vector2;
use rocking::State;

/// Positions (u, θ), velocities, and what a method carries over from step to step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    pub position: Vector2<f64>, // (u, θ), m and rad
    pub velocity: Vector2<f64>, // (u̇, θ̇), m/s and rad/s
    /// The method's own acceleration; none after a transition.
    pub acceleration: Option<Vector2<f64>>,
}

impl Point {
    /// Where a phase begins in `state`.
    pub fn start(state: &State) -> Point {
        Point {
            position: Vector2::new(state.u, state.theta),
            velocity: Vector2::new(state.u_dot, state.theta_dot),
            acceleration: None,
        }
    }

    /// Its state.
    pub fn state(&self) -> State {
        state(self.position, self.velocity)
    }

    /// Whether all its numbers are finite.
    pub fn is_finite(&self) -> bool {
        self.position.iter().chain(self.velocity.iter()).all(|x| x.is_finite())
    }

    /// The acceleration carried over, or that of the equations.
    fn acceleration(&self, equations: &dyn Equations, tau: f64) -> Vector2<f64> {
        self.acceleration.unwrap_or_else(|| equations.acceleration(tau, self.position, self.velocity))
    }
}

/// A method that takes one step of any length.
pub trait OneStep: Sync {
    /// From `from`, `tau` s into the interval, over `h` s.
    fn step(&self, equations: &dyn Equations, tau: f64, from: &Point, h: f64) -> Point;
}

/// A method as the study knows it.
pub struct Textbook {
    pub name: &'static str, // name on charts
    pub order: u32,         // order of its global error
    pub method: &'static dyn OneStep,
}

/// All of them.
pub static TEXTBOOK: [Textbook; 6] = [
    Textbook { name: "explicit Euler", order: 1, method: &explicit_euler::ExplicitEuler },
    Textbook { name: "semi-implicit Euler", order: 1, method: &semi_implicit_euler::SemiImplicitEuler },
    Textbook { name: "central difference", order: 2, method: &central_difference::CentralDifference },
    Textbook { name: "RK4", order: 4, method: &runge_kutta_4::RungeKutta4 },
    Textbook { name: "Newmark average acceleration", order: 2, method: &newmark::AverageAcceleration },
    Textbook { name: "HHT-α", order: 2, method: &hht_alpha::HhtAlpha },
];
