//! The equations between two transitions, with their evaluations counted.

use nalgebra::Vector2;
use rocking::levels::{full_contact, nonlinear};
use rocking::{Dissipators, Load, OneMass, Phase, Ramp, State};
use std::cell::Cell;

/// Two second-order equations for the positions (u, θ).
pub trait LateralEquations {
    /// (ü, θ̈) at `tau` s after the start of the interval.
    fn acceleration(&self, tau: f64, position: Vector2<f64>, velocity: Vector2<f64>) -> Vector2<f64>;
}

/// The equations of one phase over one interval: Eq 1 in full contact, Eqs 5 and 6 while rocking.
pub struct PhaseEquations<'a> {
    pub structure: &'a OneMass,
    pub phase: Phase,
    pub a_g: Ramp, // ground acceleration from the start of the interval on
    pub evaluations: &'a Cell<u64>,
}

impl LateralEquations for PhaseEquations<'_> {
    fn acceleration(&self, tau: f64, position: Vector2<f64>, velocity: Vector2<f64>) -> Vector2<f64> {
        self.evaluations.set(self.evaluations.get() + 1);
        let state = state(position, velocity);
        match self.phase {
            Phase::FullContact => {
                Vector2::new(full_contact::acceleration(self.structure, &state, Load::ground(self.a_g.at(tau))), 0.0)
            }
            Phase::Rocking(side) | Phase::Overturned(side) => {
                let load = Load::ground(self.a_g.at(tau));
                nonlinear::accelerations(self.structure, side, &state, load, &Dissipators::NEW)
                    .unwrap_or_else(|| Vector2::repeat(f64::NAN))
            }
            _ => unreachable!("{RIGID}"),
        }
    }
}

/// The scenes have no other ground.
pub const RIGID: &str = "the ground of a scene is rigid";

/// Positions (u, θ) and velocities (u̇, θ̇) as a state.
pub fn state(position: Vector2<f64>, velocity: Vector2<f64>) -> State {
    State { u: position[0], u_dot: velocity[0], theta: position[1], theta_dot: velocity[1] }
}
