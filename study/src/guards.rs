//! When a phase ends, and what follows: the model's rules as a fixed-step code applies them, state by state.

use rocking::levels::nonlinear;
use rocking::mechanics::impact;
use rocking::{Dissipators, Load, Phase, Side, State, Structure};
use std::f64::consts::FRAC_PI_2;

/// Excess of |u| over u_cr, and of s θ̈ over 0 in units of g/H, that count as uplift. What rounding alone can bring
/// about is not enough: the base would touch down again at once.
const LEAST_EXCESS: f64 = 1e-12;

/// How far uplift about the side of u is away, negative before it is due: the lesser of |u|/u_cr − 1 and s θ̈ H/g.
pub fn uplift_excess(structure: &Structure, state: &State) -> f64 {
    let side = Side::of(state.u);
    // What turns the base at θ = θ̇ = 0 does not depend on a_g.
    let theta_ddot = match nonlinear::accelerations(structure, side, state, Load::default(), &Dissipators::NEW) {
        Some(accelerations) => side.sign() * accelerations[1],
        None => f64::NAN,
    };
    let &rocking::Parameters { H, g, .. } = structure.parameters();
    displacement_excess(structure, state).min(theta_ddot * H / g - LEAST_EXCESS)
}

/// How far uplift is away by the displacement alone, as it is often coded: |u|/u_cr − 1.
pub fn displacement_excess(structure: &Structure, state: &State) -> f64 {
    state.u.abs() / structure.u_cr - 1.0
}

/// A rule for uplift: negative before it is due.
pub type UpliftRule = fn(&Structure, &State) -> f64;

/// The end of a phase.
pub struct PhaseEnd<'a> {
    pub structure: &'a Structure,
    pub uplift: UpliftRule,
    pub phase: Phase,
}

impl PhaseEnd<'_> {
    /// Positive as long as the phase goes on: s θ while rocking, what uplift lacks in full contact.
    pub fn guard(&self, state: &State) -> f64 {
        match self.phase {
            Phase::FullContact => -(self.uplift)(self.structure, state),
            Phase::Rocking(side) | Phase::Overturned(side) => side.sign() * state.theta,
        }
    }

    /// Whether the phase is over in `state`.
    pub fn is_over(&self, state: &State) -> bool {
        match self.phase {
            // The displacement first: the moment costs as much as the equations.
            Phase::FullContact => displacement_excess(self.structure, state) >= 0.0 && self.guard(state) <= 0.0,
            Phase::Rocking(side) => {
                let (angle, rate) = (side.sign() * state.theta, side.sign() * state.theta_dot);
                angle < 0.0 || (angle == 0.0 && rate < 0.0) || angle >= FRAC_PI_2
            }
            Phase::Overturned(_) => false,
        }
    }

    /// Phase and state after the phase has ended in the state `before`.
    pub fn next(&self, before: State) -> (Phase, State) {
        match self.phase {
            Phase::FullContact => (Phase::Rocking(Side::of(before.u)), before),
            Phase::Rocking(side) if side.sign() * before.theta >= FRAC_PI_2 => (Phase::Overturned(side), before),
            Phase::Rocking(side) => impact::resolve(self.structure, side, &before),
            Phase::Overturned(_) => (self.phase, before),
        }
    }
}
