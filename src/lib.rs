//! A flexible structure that rocks on its foundation under earthquake ground motion.
//!
//! A top mass `m` at height `H` on an axially rigid, laterally elastic strut stands on a foundation of mass `m0`
//! whose rigid base, 2`B` wide, may lift off rigid ground about either of its edges. Equation numbers are those of
//! the source paper (see the README). SI units throughout, angles in rad.
//!
//! | read | for |
//! |---|---|
//! | [`parameters`] | the structure's numbers, their ranges, the two specimens |
//! | [`natural_quantities`] | parameters from period, weights, width, slenderness, frequency parameter |
//! | [`structure`] | everything derived from them (before Eq 11, after 13, before 18) |
//! | [`full_contact`] | Eq 1 |
//! | [`nonlinear_rocking`] | Eqs 5, 6 |
//! | `linear_rocking`, `modal_rocking`, `rigid_rocking` | Eqs 7–9; 11, 16, 18; 6 with u = 0 |
//! | [`detail`] | levels of detail: which of these equations move the structure |
//! | [`uplift`], [`impact`], [`transition`] | the transitions' guards and resets, and what follows from each |
//! | [`outputs`] | Eqs 2, 3, 23–27 |
//! | [`load`] | ground acceleration and the force on the top mass |
//! | [`reactions`] | what the structure exerts on the ground |
//! | [`energy`] | the energy that is conserved between impacts |
//! | [`taylor`], [`first_crossing`], [`engine`], [`motion`] | the solver: series, guards, hybrid engine, what changes with time |
//! | [`outside_step`] | the equations for another integrator, and a check of its steps |
//! | [`piece`] | what the engine shows to whoever watches |
//! | [`modal_split`] | Eqs 10–20: rocking and vibration mode |
//! | [`effective_frequency`] | Eq 14 |
//! | [`demand`], [`response_spectrum`] | Eqs 21–24: demands without a time history |
//! | [`intensity`] | PGA, PGV, S_a: how strong a ground motion is |
//! | [`pushover`] | Fig 1: equilibrium under a lateral force |
//! | [`record`] | ground motion records: samples in memory, and files as archives publish them |
//! | [`ground_motion`] | a record scaled, placed in time and followed whatever the steps |
//! | [`run`] | a structure under a ground motion: exact peaks, curves to draw, levels compared, plans of many runs, their outcomes and exceedances, maps of pulses |
//! | [`fragility`] | fragility curve of many runs, and how sure it is |
//!
//! In short, `examples/first_run.rs`:
//!
//! ```
#![doc = include_str!("../examples/first_run.rs")]
//! ```
#![allow(non_snake_case)] // H, B, J0: the paper's own letters

mod bisection;
pub mod demand;
pub mod detail;
pub mod effective_frequency;
pub mod energy;
pub mod engine;
mod extremes;
pub mod first_crossing;
pub mod fragility;
pub mod full_contact;
pub mod ground_motion;
pub mod impact;
pub mod intensity;
mod kinematics;
mod level;
mod linear_rocking;
mod linear_system;
pub mod load;
mod modal_rocking;
pub mod modal_split;
pub mod motion;
pub mod natural_quantities;
pub mod nonlinear_rocking;
mod oscillator;
mod output_series;
pub mod outputs;
pub mod outside_step;
pub mod parameters;
pub mod piece;
pub mod pushover;
pub mod quantity;
mod reaction_series;
pub mod reactions;
pub mod record;
pub mod response_spectrum;
mod rigid_rocking;
pub mod run;
pub mod state;
pub mod structure;
pub mod taylor;
pub mod transition;
pub mod uplift;

pub use detail::Detail;
pub use engine::{Engine, Progress};
pub use ground_motion::GroundMotion;
pub use load::{LinearLoad, Load, Ramp};
pub use motion::Motion;
pub use outputs::Outputs;
pub use parameters::Parameters;
pub use piece::{Equations, Piece, Watch};
pub use quantity::{OutOfRange, Quantity};
pub use reactions::{Impulse, Reactions};
pub use run::Run;
pub use state::{Phase, Side, State};
pub use structure::Structure;
pub use transition::{Transition, TransitionKind};
