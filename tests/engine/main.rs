//! The engine from outside, as one program: linking one takes less time than linking one for each file.

mod common;
mod curves;
mod edges;
mod ground;
mod levels;
mod missed_peaks;
mod modes;
mod outside_steps;
mod peaks;
mod profiles;
mod reactions;
mod restrained;
mod rooms;
mod runs;
mod slipping;
mod spectra;
mod tolerance;
mod top_force;
mod validity;
