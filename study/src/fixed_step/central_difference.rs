//! Central differences, order 2, in the form that starts from one point and takes damping and velocity-dependent forces
//! into account at the sample:
//!
//! ```text
//! a_n = a(t_n, x_n, v_n),   a_n = (x_{n+1} − 2 x_n + x_{n−1})/h²,   v_n = (x_{n+1} − x_{n−1})/2h
//!
//! v_{n+½} = v_n + h a_n/2      x_{n+1} = x_n + h v_{n+½}      v_{n+1} = v_{n+½} + h a_{n+1}/2
//! ```
//!
//! x_{n+1} is explicit; v_{n+1} is not where forces depend on the velocity, and is iterated.

use super::{OneStep, Point, implicit};
use crate::equations::Equations;

/// Central differences.
pub struct CentralDifference;

impl OneStep for CentralDifference {
    fn step(&self, equations: &dyn Equations, tau: f64, from: &Point, h: f64) -> Point {
        let acceleration = from.acceleration(equations, tau);
        let middle = from.velocity + 0.5 * h * acceleration;
        let position = from.position + h * middle;
        let end = implicit::solve(acceleration, |a| equations.acceleration(tau + h, position, middle + 0.5 * h * a));
        Point { position, velocity: middle + 0.5 * h * end, acceleration: Some(end) }
    }
}
