//! A flexible structure that rocks on its foundation under earthquake ground motion.
//!
//! A top mass `m` at height `H` on an axially rigid, laterally elastic strut stands on a foundation of mass `m0`
//! whose rigid base, 2`B` wide, may lift off rigid ground about either of its edges. Equation numbers are those of
//! the source paper (see the README). SI units throughout, angles in rad.
//!
//! | room | what is in it |
//! |---|---|
//! | [`digits`] | how numbers are rounded for tables and sentences |
//! | [`names`] | what an unknown name may mean |
//! | numbers | value, rate and bounds: the numbers in which each formula is evaluated |
//! | [`series`] | Taylor series in time, first crossings, extremes |
//! | [`structure`] | the structure's numbers, their ranges, the two specimens; what follows from them (before Eq 11, after 13, before 18) |
//! | [`mechanics`] | state, loads, impact, outputs (Eqs 2, 3, 23–27), reactions, energy |
//! | [`levels`] | full contact (Eq 1), uplift, nonlinear (5, 6), linear (7–9), modal (11, 16, 18), rigid (6 with u = 0) |
//! | [`engine`] | the hybrid engine: steps, transitions, what it shows to whoever watches; several runs side by side |
//! | [`run`] | a ground motion followed: exact peaks, validity, histories, levels compared |
//! | [`estimates`] | demands without a time history (Eqs 14, 21–24), rocking and vibration mode (10–20), pushover (Fig 1), intensity |
//!
//! Each room uses those above it, and none below. No two files use each other. A test reads the imports (`tests/engine/rooms.rs`).
//!
//! Sines, exponentials and the like are those of the crate `libm`: each system's own round their last bit differently, and a run has
//! the same bits on all of them.
//!
//! In short, `examples/first_run.rs`:
//!
//! ```
#![doc = include_str!("../examples/first_run.rs")]
//! ```
#![warn(missing_docs)]

pub mod digits;
pub mod engine;
pub mod estimates;
pub mod levels;
pub mod mechanics;
pub mod names;
mod numbers;
pub mod run;
pub mod series;
pub mod structure;

pub use engine::motion::Motion;
pub use engine::piece::{Piece, Watch};
pub use engine::sample::Sample;
pub use engine::transition::{Transition, TransitionKind};
pub use engine::{Engine, Progress};
pub use levels::detail::Detail;
pub use mechanics::load::{LinearLoad, Load, Ramp};
pub use mechanics::outputs::Output;
pub use mechanics::reactions::{Impulse, Reactions};
pub use mechanics::restraint::{Dissipators, Restraint, Restraints};
pub use mechanics::state::{Friction, Phase, PressedPoints, Side, State};
pub use run::course::Run;
pub use run::ground_motion::GroundMotion;
pub use structure::Structure;
pub use structure::base::{Base, Body};
pub use structure::gauge::{Gauge, Gauges};
pub use structure::ground::{Foundation, Ground};
pub use structure::mode::{Floor, Mode, Modes};
pub use structure::one_mass::OneMass;
pub use structure::parameters::{Parameters, Ties};
pub use structure::quantity::{OutOfRange, Quantity, Refused};
