//! Other libraries' solvers, restarted at each sample of the ground motion and at each transition.

pub mod differential_equations;
pub mod diffsol;
pub mod ode_solvers;

/// Absolute tolerance over relative tolerance: u and θ are of the order of 0.01 m and 0.01 rad.
const ABSOLUTE: f64 = 1e-3;
