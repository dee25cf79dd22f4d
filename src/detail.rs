//! Levels of detail: which equations a structure moves by. Transitions are found and applied by the same code at all of
//! them; the rigid limit, where u decides nothing, has its own condition of uplift and its own end of bouncing, and a
//! fixed base has no uplift.
//!
//! | level | equations | solved by |
//! |---|---|---|
//! | `auto` | 1, 5, 6 | exact flow in full contact, series while rocking |
//! | `nonlinear` | 1, 5, 6 | series throughout, each to the tolerance |
//! | `linear` | 1, 7, 8 | exact flow, series on steps that may hold a transition |
//! | `modal` | 1, 11, 18 | closed forms of two modes, likewise |
//! | `rigid` | 6 with u = 0 | series |
//! | `fixed_base` | 1, no uplift | exact flow |

use crate::linear_rocking::LinearRocking;
use crate::load::Load;
use crate::modal_rocking::ModalRocking;
use crate::nonlinear_rocking::{self, NonlinearRocking};
use crate::taylor::{Arc, Start};
use crate::uplift::TurningMoment;
use crate::{Phase, Side, State, Structure, full_contact, rigid_rocking};
use serde::{Deserialize, Serialize};

/// A level of detail.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Detail {
    /// The answer of `Nonlinear` at the least cost.
    #[default]
    Auto,
    /// Eqs 1, 5, 6, integrated throughout.
    Nonlinear,
    /// Eqs 1, 7, 8: small angles.
    Linear,
    /// Eqs 1, 11, 18: small angles and two uncoupled modes.
    Modal,
    /// Eq 6 with u = 0: no elastic motion.
    Rigid,
    /// Eq 1 alone: no uplift.
    FixedBase,
}

impl Detail {
    /// All of them, in the order of the table.
    pub const ALL: [Detail; 6] =
        [Detail::Auto, Detail::Nonlinear, Detail::Linear, Detail::Modal, Detail::Rigid, Detail::FixedBase];

    /// Its name in files, on the command line and in the FMU.
    pub const fn name(self) -> &'static str {
        match self {
            Detail::Auto => "auto",
            Detail::Nonlinear => "nonlinear",
            Detail::Linear => "linear",
            Detail::Modal => "modal",
            Detail::Rigid => "rigid",
            Detail::FixedBase => "fixed_base",
        }
    }
}

/// The equations by which a level rocks.
#[derive(Clone, Debug)]
pub(crate) enum RockingEquations {
    Nonlinear(Box<NonlinearRocking>),
    Linear(Box<LinearRocking>),
    Modal(Box<ModalRocking>),
    Rigid,
}

impl RockingEquations {
    pub(crate) fn new(detail: Detail, structure: &Structure) -> RockingEquations {
        match detail {
            // a fixed base never rocks; what it does not use must still be something
            Detail::Auto | Detail::Nonlinear | Detail::FixedBase => RockingEquations::Nonlinear(Box::default()),
            Detail::Linear => RockingEquations::Linear(Box::new(LinearRocking::new(structure))),
            Detail::Modal => RockingEquations::Modal(Box::new(ModalRocking::new(structure))),
            Detail::Rigid => RockingEquations::Rigid,
        }
    }

    /// The state after the interval of `start` if it is known exactly and no transition can happen until then.
    #[inline]
    pub(crate) fn leap(&mut self, side: Side, start: &Start) -> Option<State> {
        match self {
            RockingEquations::Linear(linear) => linear.leap(side, start),
            RockingEquations::Modal(modal) => modal.leap(side, start),
            RockingEquations::Nonlinear(_) | RockingEquations::Rigid => None,
        }
    }

    /// Writes the motion from `start` about `side` into `arc`.
    #[inline]
    pub(crate) fn series(&mut self, structure: &Structure, side: Side, start: &Start, arc: &mut Arc) {
        match self {
            RockingEquations::Nonlinear(nonlinear) => nonlinear.series(structure, side, start, arc),
            RockingEquations::Linear(linear) => linear.system.series(structure, side, start, arc),
            RockingEquations::Modal(modal) => modal.system.series(structure, side, start, arc),
            RockingEquations::Rigid => rigid_rocking::series(structure, side, start, arc),
        }
    }

    /// What decides the sign of θ̈ at the start of rocking.
    pub(crate) fn turning_moment(&self, structure: &Structure) -> TurningMoment {
        match self {
            RockingEquations::Linear(linear) => linear.system.turning_moment(),
            RockingEquations::Modal(modal) => modal.system.turning_moment(),
            RockingEquations::Nonlinear(_) | RockingEquations::Rigid => TurningMoment::new(structure),
        }
    }

    /// (ü, θ̈) in `phase`, m/s² and rad/s²; not a number where the equations have no solution.
    pub(crate) fn accelerations(&self, structure: &Structure, phase: Phase, state: &State, load: Load) -> [f64; 2] {
        let a_top = load.on_top(structure);
        match (self, phase) {
            (RockingEquations::Rigid, _) => rigid_rocking::accelerations(structure, phase, state, load),
            (RockingEquations::Linear(linear), Phase::Rocking(side)) => linear.system.accelerations(side, state, a_top),
            (RockingEquations::Modal(modal), Phase::Rocking(side)) => modal.system.accelerations(side, state, a_top),
            _ => full_accelerations(structure, phase, state, load),
        }
    }
}

/// (ü, θ̈) by Eqs 1, 5 and 6 in `phase`, m/s² and rad/s²; not a number where they have no solution.
pub(crate) fn full_accelerations(structure: &Structure, phase: Phase, state: &State, load: Load) -> [f64; 2] {
    match phase {
        Phase::FullContact => [full_contact::acceleration(structure, state, load), 0.0],
        Phase::Rocking(side) => {
            nonlinear_rocking::accelerations(structure, side, state, load).map_or([f64::NAN; 2], Into::into)
        }
        Phase::Overturned(_) => [0.0; 2],
    }
}
