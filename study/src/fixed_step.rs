//! Textbook methods of fixed step.
//!
//! ```text
//! explicit Euler            x₁ = x₀ + h v₀                v₁ = v₀ + h a(t₀, x₀, v₀)
//! semi-implicit Euler       x₁ = x₀ + h v₁                v₁ = v₀ + h a(t₀, x₀, v₀)
//!
//! RK4, y = (x, v)           k₁ = f(t, y)   k₂ = f(t + h/2, y + h k₁/2)   k₃ = f(t + h/2, y + h k₂/2)   k₄ = f(t + h, y + h k₃)
//!                           y₁ = y₀ + h (k₁ + 2 k₂ + 2 k₃ + k₄)/6
//!
//! Newmark's family          x₁ = x₀ + h v₀ + h² [(1/2 − β) a₀ + β a₁]
//!                           v₁ = v₀ + h [(1 − γ) a₀ + γ a₁]      a₁ = (1 + α) a(t₁, x₁, v₁) − α a(t₀, x₀, v₀)
//!   central difference      α = 0, β = 0, γ = 1/2
//!   average acceleration    α = 0, β = 1/4, γ = 1/2 (the trapezoidal rule)
//!   HHT-α                   β = (1 − α)²/4, γ = 1/2 − α (Hilber, Hughes, Taylor); numerical damping: α = 0 none, −1/3 most
//! ```
//!
//! The central difference takes x_{n+1} from the past alone; its velocity is implicit where forces depend on it. With α the
//! method has an acceleration of its own, which it carries from step to step and which starts anew after a transition.

use crate::equations::{LateralEquations, state};
use nalgebra::{Matrix2, Vector2};
use rocking::State;

/// Positions (u, θ), velocities, and what a method carries over from step to step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MovingPoint {
    pub position: Vector2<f64>, // (u, θ), m and rad
    pub velocity: Vector2<f64>, // (u̇, θ̇), m/s and rad/s
    /// The method's own acceleration; none after a transition.
    pub acceleration: Option<Vector2<f64>>,
}

impl MovingPoint {
    /// Start of a phase in `state`.
    pub fn start(state: &State) -> MovingPoint {
        MovingPoint {
            position: Vector2::new(state.u, state.theta),
            velocity: Vector2::new(state.u_dot, state.theta_dot),
            acceleration: None,
        }
    }

    pub fn state(&self) -> State {
        state(self.position, self.velocity)
    }

    pub fn is_finite(&self) -> bool {
        self.position.iter().chain(self.velocity.iter()).all(|x| x.is_finite())
    }
}

/// A method that takes one step of any length.
#[derive(Clone, Copy, Debug)]
pub enum FixedStep {
    ExplicitEuler,
    SemiImplicitEuler,
    RungeKutta4,
    Newmark { alpha: f64, beta: f64, gamma: f64 },
}

/// A method as the study knows it.
pub struct Textbook {
    pub name: &'static str, // name on charts
    pub order: u32,         // order of its global error
    pub method: FixedStep,
}

/// The α of HHT-α.
const ALPHA: f64 = -0.1;

pub static TEXTBOOK: [Textbook; 6] = [
    Textbook { name: "explicit Euler", order: 1, method: FixedStep::ExplicitEuler },
    Textbook { name: "semi-implicit Euler", order: 1, method: FixedStep::SemiImplicitEuler },
    Textbook { name: "central difference", order: 2, method: FixedStep::Newmark { alpha: 0.0, beta: 0.0, gamma: 0.5 } },
    Textbook { name: "RK4", order: 4, method: FixedStep::RungeKutta4 },
    Textbook {
        name: "Newmark average acceleration",
        order: 2,
        method: FixedStep::Newmark { alpha: 0.0, beta: 0.25, gamma: 0.5 },
    },
    Textbook {
        name: "HHT-α",
        order: 2,
        method: FixedStep::Newmark { alpha: ALPHA, beta: (1.0 - ALPHA) * (1.0 - ALPHA) / 4.0, gamma: 0.5 - ALPHA },
    },
];

impl FixedStep {
    /// From `from`, `tau` s into the interval, over `h` s.
    pub fn step(self, equations: &dyn LateralEquations, tau: f64, from: &MovingPoint, h: f64) -> MovingPoint {
        let MovingPoint { position: x, velocity: v, acceleration } = *from;
        let a = |tau, x, v| equations.acceleration(tau, x, v);
        match self {
            FixedStep::ExplicitEuler => {
                MovingPoint { position: x + h * v, velocity: v + h * a(tau, x, v), acceleration: None }
            }
            FixedStep::SemiImplicitEuler => {
                let velocity = v + h * a(tau, x, v);
                MovingPoint { position: x + h * velocity, velocity, acceleration: None }
            }
            FixedStep::RungeKutta4 => {
                let slope = |c: f64, (dx, dv): (Vector2<f64>, Vector2<f64>)| {
                    let v = v + c * h * dv;
                    (v, a(tau + c * h, x + c * h * dx, v))
                };
                let k1 = (v, a(tau, x, v));
                let k2 = slope(0.5, k1);
                let k3 = slope(0.5, k2);
                let k4 = slope(1.0, k3);
                MovingPoint {
                    position: x + h / 6.0 * (k1.0 + 2.0 * (k2.0 + k3.0) + k4.0),
                    velocity: v + h / 6.0 * (k1.1 + 2.0 * (k2.1 + k3.1) + k4.1),
                    acceleration: None,
                }
            }
            FixedStep::Newmark { alpha, beta, gamma } => {
                // Without α the carried acceleration is that of the equations.
                let there = acceleration.filter(|_| alpha == 0.0).unwrap_or_else(|| a(tau, x, v));
                let start = acceleration.unwrap_or(there);
                let position = |end| x + h * v + h * h * ((0.5 - beta) * start + beta * end);
                let velocity = |end| v + h * ((1.0 - gamma) * start + gamma * end);
                let end = solve(start, |end| (1.0 + alpha) * a(tau + h, position(end), velocity(end)) - alpha * there);
                MovingPoint { position: position(end), velocity: velocity(end), acceleration: Some(end) }
            }
        }
    }
}

/// The a for which a = `next`(a), from the guess `start`, by Newton's method with the Jacobian at the start, from
/// differences. Not a number where the iteration does not converge.
fn solve(start: Vector2<f64>, next: impl Fn(Vector2<f64>) -> Vector2<f64>) -> Vector2<f64> {
    const CONVERGED: f64 = 1e-13; // the last correction, relative to the acceleration
    const DIFFERENCE: f64 = 1e-4; // relative to the acceleration: the equations are all but linear over a step
    const MAX_ITERATIONS: usize = 30; // more than any step that can still be trusted needs
    let mut acceleration = start;
    let mut image = next(acceleration);
    let scale = (image.norm() + start.norm()).max(1.0);
    let delta = DIFFERENCE * scale;
    let column = |k: usize| {
        let mut moved = start;
        moved[k] += delta;
        (next(moved) - image) / delta
    };
    let Some(inverse) = (Matrix2::identity() - Matrix2::from_columns(&[column(0), column(1)])).try_inverse() else {
        return Vector2::repeat(f64::NAN);
    };
    for _ in 0..MAX_ITERATIONS {
        let correction = inverse * (image - acceleration);
        acceleration += correction;
        if correction.norm() <= CONVERGED * scale {
            return acceleration;
        }
        image = next(acceleration);
    }
    Vector2::repeat(f64::NAN)
}
