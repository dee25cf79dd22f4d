//! The model description of a unit for model exchange and co-simulation, from its table of variables, and the archive.
//!
//! [`ModelDescription::to_xml`] writes `modelDescription.xml` for a [`Version`] of the standard.
#![warn(missing_docs)]

pub mod archive;
mod description;
mod element;

pub use description::ModelDescription;

/// A version of the standard.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Version {
    /// FMI 2.0
    #[default]
    Fmi2,
    /// FMI 3.0
    Fmi3,
}

/// Settings of a simulation for which the user sets nothing else.
#[derive(Clone, Copy, Debug)]
pub struct DefaultExperiment {
    /// Start time, s.
    pub start_time: f64,
    /// Stop time, s.
    pub stop_time: f64,
    /// Relative tolerance.
    pub tolerance: f64,
    /// Communication step, s.
    pub step_size: f64,
}

impl Default for DefaultExperiment {
    fn default() -> DefaultExperiment {
        DefaultExperiment { start_time: 0.0, stop_time: 3.0, tolerance: 1e-9, step_size: 0.01 }
    }
}
