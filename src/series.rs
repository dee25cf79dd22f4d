//! Polynomials in time: Taylor series of a motion, the first instant at which one of them crosses a limit, their extremes.

pub mod bisection;
pub(crate) mod extremes;
pub mod first_crossing;
pub mod taylor;
pub(crate) mod terms;
