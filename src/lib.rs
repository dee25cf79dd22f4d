//! A flexible structure that rocks on its foundation under earthquake ground motion.
//!
//! A top mass `m` at height `H` on an axially rigid, laterally elastic strut stands on a foundation of mass `m0`
//! whose rigid base, 2`B` wide, may lift off rigid ground about either of its edges. Equation numbers are those of
//! the source paper (see the README). SI units throughout, angles in rad.
//!
//! | read | for |
//! |---|---|
//! | [`parameters`] | the structure's numbers, their ranges, the two specimens |
//! | [`structure`] | everything derived from them (before Eq 11, after 13, before 18) |
//! | [`full_contact`] | Eq 1 |
//! | [`nonlinear_rocking`] | Eqs 5, 6 |
//! | [`uplift`], [`impact`] | the transitions' guards and resets |
//! | [`outputs`] | Eqs 2, 3, 23–27 |
//! | [`energy`] | the energy that is conserved between impacts |
//! | [`taylor`], [`first_crossing`], [`engine`] | the solver: series, guards, hybrid engine |
//! | [`record`] | ground motion records: PEER AT2, CSV |
#![allow(non_snake_case)] // H, B, J0: the paper's own letters

pub mod energy;
pub mod engine;
pub mod first_crossing;
pub mod full_contact;
pub mod impact;
pub mod nonlinear_rocking;
pub mod outputs;
pub mod parameters;
pub mod quantity;
pub mod record;
pub mod state;
pub mod structure;
pub mod taylor;
pub mod uplift;

pub use engine::{Engine, GroundAcceleration, Motion, Progress, Transition, TransitionKind};
pub use outputs::Outputs;
pub use parameters::Parameters;
pub use quantity::{OutOfRange, Quantity};
pub use state::{Phase, Side, State};
pub use structure::Structure;
