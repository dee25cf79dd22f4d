//! What a level of detail has to tell: its equations, its condition of uplift, its outputs.

use crate::levels::output_series::{self, Turn};
use crate::levels::rules::Rules;
use crate::mechanics::load::{LinearLoad, Load};
use crate::mechanics::state::InitialStateError;
use crate::mechanics::uplift::TurningMoment;
use crate::series::extremes::Bound;
use crate::series::first_crossing::Crossing;
use crate::series::taylor::{Arc, Series, Start};
use crate::{Outputs, Phase, Side, State, Structure};
use std::fmt::Debug;

/// Everything that depends on the level of detail. Where nothing else is said it is as at the levels with an elastic
/// strut.
pub(crate) trait Level: Rules + Debug + Send {
    /// Whether a motion may start from `initial`.
    fn check_start(&self, _initial: &State) -> Result<(), InitialStateError> {
        Ok(())
    }

    /// The state at the end of `start` where it is known exactly and no transition can happen until then.
    fn leap(&mut self, structure: &Structure, phase: Phase, start: &Start) -> Option<State>;

    /// Bounds of what changes on such a leap from `start` to `end`.
    fn rates(&self, phase: Phase, start: &Start, end: &State) -> Rates;

    /// Writes the motion from `start` in `phase` into `arc`; there is none once overturned.
    fn series(&mut self, structure: &Structure, phase: Phase, start: &Start, arc: &mut Arc);

    /// Whether the equations of rocking are about to have no solution.
    fn is_singular(&self, _structure: &Structure, _phase: Phase, _state: &State) -> bool {
        false
    }

    /// The first instant of `arc`, a motion in full contact from `start`, at which uplift is due, and about which side.
    fn first_uplift(&self, structure: &Structure, start: &Start, arc: &Arc) -> (Crossing, Side);

    /// Whether a structure in full contact in `state` stays there while nothing acts on it.
    fn stays_down(&self, structure: &Structure, state: &State) -> bool {
        state.u.hypot(state.u_dot / structure.omega_fc) < structure.u_cr
    }

    /// How far a structure in full contact in `state` under `load` is from uplift, in parts of what uplift takes, and about
    /// which side that would be: continuous, positive while the base stays down, due where it is not.
    fn uplift_margin(&self, structure: &Structure, state: &State, load: Load) -> (f64, Side);

    /// `state` with what does not move in `phase` at rest in its place.
    fn admissible(&self, phase: Phase, state: State) -> State {
        match phase {
            Phase::FullContact => State { theta: 0.0, theta_dot: 0.0, ..state },
            Phase::Rocking(_) | Phase::Overturned(_) => state,
        }
    }

    /// (ü, θ̈) in `phase` under `load`, m/s² and rad/s²; not a number where the equations have no solution.
    fn accelerations(&self, structure: &Structure, phase: Phase, state: &State, load: Load) -> [f64; 2];

    /// The outputs in `phase` and `state` under `load`.
    fn outputs(&self, structure: &Structure, phase: Phase, state: &State, load: Load) -> Outputs {
        Outputs::of(structure, phase, state, load.F_t)
    }

    /// Time derivatives of the outputs under `load`, given (ü, θ̈) and (u⃛, θ⃛).
    fn output_rates(
        &self,
        structure: &Structure,
        phase: Phase,
        state: &State,
        [accelerations, _]: [[f64; 2]; 2],
        load: LinearLoad,
    ) -> Outputs {
        Outputs::rates_by(structure, phase, state, accelerations, load)
    }

    /// a_t over `arc` under `load`, which is given from its start on, as a series in σ.
    fn a_t_series(&self, structure: &Structure, phase: Phase, load: LinearLoad, arc: &Arc, turn: &Turn) -> Series {
        output_series::a_t(structure, phase, load, arc, turn)
    }

    /// Bounds of |θ|, |u|, |δ_t| and |a_t| that follow from those of |θ|, |u| and |u̇|; `F_t` is that of |F_t|.
    fn crude_output_bounds(&self, structure: &Structure, phase: Phase, F_t: f64, of_state: [f64; 3]) -> [f64; 4] {
        output_series::crude_bounds(structure, phase, F_t, of_state)
    }

    /// Bounds of |θ|, |u|, |δ_t| and |a_t| over `arc` under `load`, which is given from its start on.
    fn output_bounds(&self, structure: &Structure, phase: Phase, load: LinearLoad, arc: &Arc) -> [Bound; 4] {
        output_series::bounds(structure, phase, load, arc)
    }
}

/// Equations of rocking with an elastic strut.
pub(crate) trait ElasticRocking: Debug + Send {
    fn leap(&mut self, _side: Side, _start: &Start) -> Option<State> {
        None
    }

    fn rates(&self, side: Side, start: &Start, end: &State) -> Rates;

    fn series(&mut self, structure: &Structure, side: Side, start: &Start, arc: &mut Arc);

    fn is_singular(&self, _structure: &Structure, _side: Side, _state: &State) -> bool {
        false
    }

    /// What decides the sign of θ̈ at the start of rocking.
    fn turning_moment(&self, structure: &Structure) -> TurningMoment;

    fn accelerations(&self, structure: &Structure, side: Side, state: &State, load: Load) -> [f64; 2];
}

/// Bounds of |u|, |θ| and their derivatives over an exact leap.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Rates {
    pub u: f64,
    pub u_dot: f64,
    pub u_ddot: f64,
    pub u_dddot: f64,
    pub theta: f64,
    pub theta_dot: f64,
    pub theta_ddot: f64,
}

impl Rates {
    /// Nothing is known.
    pub(crate) const NONE: Rates = {
        const ANY: f64 = f64::INFINITY;
        Rates { u: ANY, u_dot: ANY, u_ddot: ANY, u_dddot: ANY, theta: ANY, theta_dot: ANY, theta_ddot: ANY }
    };
}
