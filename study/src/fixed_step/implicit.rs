//! The acceleration at the end of an implicit step, by Newton iteration.

use nalgebra::{Matrix2, Vector2};

/// The residual at which an iteration ends, relative to the acceleration.
const CONVERGED: f64 = 1e-13;

/// More iterations than any step that can still be trusted needs.
const MAX_ITERATIONS: usize = 30;

/// The step of the difference quotients, relative to the acceleration: the equations are all but linear over a step.
const DIFFERENCE: f64 = 1e-4;

/// The a for which a = `next`(a), from the guess `start`; the Jacobian is that at the start, from differences. Not a
/// number where the iteration does not converge.
pub fn solve(start: Vector2<f64>, next: impl Fn(Vector2<f64>) -> Vector2<f64>) -> Vector2<f64> {
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
