//! Levels of detail: which equations move the structure, and what they make of it.

pub mod detail;
pub(crate) mod first_uplift;
pub mod full_contact;
pub(crate) mod level;
mod linear;
pub(crate) mod modes;
pub mod nonlinear;
pub(crate) mod on_ground;
pub(crate) mod oscillator;
pub mod rules;
pub(crate) mod start;
pub(crate) mod ties;
