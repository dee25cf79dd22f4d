//! The paper's equations, without a solver: state, loads, outputs, reactions, energy, what starts and what follows an impact.

pub(crate) mod arc;
pub mod contact;
pub mod energy;
mod gauge;
pub mod impact;
pub(crate) mod instant;
pub(crate) mod lateral;
pub mod load;
pub mod outputs;
pub(crate) mod reach;
pub mod reactions;
pub mod restraint;
pub mod state;
pub mod uplift;
