//! Estimates without a time history, and measures of the ground motion alone.

pub mod demand;
pub mod effective_frequency;
pub mod intensity;
pub mod modal_split;
pub mod pushover;
pub mod response_spectrum;
pub mod restoring;
