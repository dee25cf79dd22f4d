//! The rules of the model as a fixed-step code applies them, state by state: the end of a phase, and the next phase. Uplift
//! and impact are the engine's own.

use crate::equations::RIGID;
use rocking::levels::uplift;
use rocking::mechanics::impact;
use rocking::{OneMass, Phase, Side, State};
use std::f64::consts::FRAC_PI_2;

/// Excess over the model's condition of uplift: negative before uplift is due.
pub fn uplift_excess(structure: &OneMass, state: &State) -> f64 {
    -uplift::distance(structure, state)
}

/// Excess over an incomplete condition that is often coded: |u|/u_cr − 1.
pub fn displacement_excess(structure: &OneMass, state: &State) -> f64 {
    state.u.abs() / structure.u_cr - 1.0
}

/// A rule for uplift: negative before it is due.
pub type UpliftRule = fn(&OneMass, &State) -> f64;

pub struct PhaseEnd<'a> {
    pub structure: &'a OneMass,
    pub uplift: UpliftRule,
    pub phase: Phase,
}

impl PhaseEnd<'_> {
    /// Positive as long as the phase goes on: s θ while rocking, what uplift lacks in full contact.
    pub fn guard(&self, state: &State) -> f64 {
        match self.phase {
            Phase::FullContact => -(self.uplift)(self.structure, state),
            Phase::Rocking(side) | Phase::Overturned(side) => side.sign() * state.theta,
            _ => unreachable!("{RIGID}"),
        }
    }

    pub fn is_over(&self, state: &State) -> bool {
        match self.phase {
            Phase::FullContact => self.guard(state) <= 0.0,
            Phase::Rocking(side) => {
                let (angle, rate) = (side.sign() * state.theta, side.sign() * state.theta_dot);
                angle < 0.0 || (angle == 0.0 && rate < 0.0) || angle >= FRAC_PI_2
            }
            _ => false,
        }
    }

    /// Phase and state after the phase has ended in the state `before`.
    pub fn next(&self, before: State) -> (Phase, State) {
        match self.phase {
            Phase::FullContact => (Phase::Rocking(Side::of(before.u)), before),
            Phase::Rocking(side) if side.sign() * before.theta >= FRAC_PI_2 => (Phase::Overturned(side), before),
            Phase::Rocking(side) => impact::resolve(&(*self.structure).into(), 0.0, side, &before),
            _ => (self.phase, before),
        }
    }
}
