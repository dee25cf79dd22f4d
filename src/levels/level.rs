//! What a level of detail has to tell of the motion: its equations, its condition of uplift, its rule of impact.

use crate::levels::rules::{ChatterLimit, MAX_TRANSITIONS_PER_PERIOD};
use crate::mechanics::impact;
use crate::mechanics::load::Load;
use crate::mechanics::restraint::{Angles, Dissipators};
use crate::mechanics::uplift::{self, TurningMoment};
use crate::series::first_crossing::Crossing;
use crate::series::taylor::{Arc, Start};
use crate::{Phase, Side, State, Structure};
use std::f64::consts::TAU;

/// A structure at one instant.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Now<'a> {
    pub state: &'a State,
    /// What acts.
    pub load: Load,
    pub dissipators: &'a Dissipators,
}

/// What moves a structure. Where nothing else is said it is as at the levels with an elastic strut.
pub(crate) trait Level {
    /// The state at the end of `start` where it is known exactly and no transition can happen until then.
    fn leap(&self, structure: &Structure, phase: Phase, start: &Start) -> Option<State>;

    /// Bounds of what changes on such a leap from `start` to `end`.
    fn rates(&self, phase: Phase, start: &Start, end: &State) -> Rates;

    /// Writes the motion from `start` in `phase` into `arc`; there is none once overturned.
    fn series(&self, structure: &Structure, phase: Phase, start: &Start, arc: &mut Arc);

    /// Whether the equations of rocking are about to have no solution.
    fn is_singular(&self, _structure: &Structure, _phase: Phase, _state: &State) -> bool {
        false
    }

    /// How the ties of a restrained structure elongate; none where nothing restrains it.
    fn ties(&self) -> Option<Angles> {
        None
    }

    /// The first instant of `arc`, a motion in full contact from `start`, at which uplift is due, and about which side.
    fn first_uplift(&self, structure: &Structure, start: &Start, arc: &Arc) -> (Crossing, Side);

    /// The |u| (m) below which the base stays down over the interval of `start`, whatever pushes the top mass.
    fn least_displacement(&self, structure: &Structure, start: &Start) -> f64;

    /// Whether a structure in full contact in `state` stays there while nothing acts on it.
    fn stays_down(&self, structure: &Structure, state: &State, dissipators: &Dissipators) -> bool {
        let at_rest = Start { dissipators, ..Start::default() };
        uplift::farthest(structure, state) < self.least_displacement(structure, &at_rest)
    }

    /// How far a structure in full contact is from uplift, in parts of what uplift takes, and about which side that would be:
    /// continuous, positive while the base stays down, due where it is not.
    fn uplift_margin(&self, structure: &Structure, now: &Now) -> (f64, Side);

    /// Phase and state just after an impact that ends rocking about `side` in the state `before`.
    fn after_impact(&self, structure: &Structure, side: Side, before: &State) -> (Phase, State) {
        impact::resolve(structure, side, before)
    }

    /// How many transitions may happen how fast.
    fn chatter_limit(&self, structure: &Structure) -> ChatterLimit {
        ChatterLimit { period: TAU / structure.omega_u, transitions: MAX_TRANSITIONS_PER_PERIOD }
    }

    /// `state` with what does not move in `phase` at rest in its place.
    fn admissible(&self, phase: Phase, state: State) -> State {
        match phase {
            Phase::FullContact => State { theta: 0.0, theta_dot: 0.0, ..state },
            Phase::Rocking(_) | Phase::Overturned(_) => state,
        }
    }

    /// (ü, θ̈) in `phase`, m/s² and rad/s²; not a number where the equations have no solution.
    fn accelerations(&self, structure: &Structure, phase: Phase, now: &Now) -> [f64; 2];
}

/// Equations of rocking with an elastic strut.
pub(crate) trait ElasticRocking {
    fn leap(&self, _side: Side, _start: &Start) -> Option<State> {
        None
    }

    fn rates(&self, _side: Side, _start: &Start, _end: &State) -> Rates {
        Rates::NONE
    }

    fn series(&self, structure: &Structure, side: Side, start: &Start, arc: &mut Arc);

    fn is_singular(&self, _structure: &Structure, _side: Side, _state: &State) -> bool {
        false
    }

    /// As [`Level::ties`].
    fn ties(&self) -> Option<Angles> {
        None
    }

    /// What decides the sign of θ̈ at the start of rocking.
    fn turning_moment(&self, structure: &Structure) -> TurningMoment;

    fn accelerations(&self, structure: &Structure, side: Side, now: &Now) -> [f64; 2];
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
