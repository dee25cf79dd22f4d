//! Refusals for reasons of the structure, its ground and their motion.

use crate::ground::GroundError;
use crate::resources::ResourceError;
use fmi_unit::Failure;
use rocking::engine::AdvanceError;
use rocking::run::record::SamplesError;
use rocking::{OutOfRange, Refused};

#[derive(Debug, thiserror::Error)]
pub enum Refusal {
    #[error(transparent)]
    Resource(#[from] ResourceError),
    #[error(transparent)]
    Ground(#[from] GroundError),
    #[error("the record, as it is scaled: {0}")]
    StrongRecord(OutOfRange),
    #[error("the record, as it is scaled: {0}")]
    BadScales(#[from] SamplesError),
    #[error(
        "the samples of record = {record:?}{} changed after the FMU state was saved",
        if record_v.is_empty() { String::new() } else { format!(" or record_v = {record_v:?}") }
    )]
    OtherRecord { record: String, record_v: String },
    #[error("at the end of the step, {0}")]
    InputRunsOut(Failure),
    /// Parameters or initial values that contradict each other.
    #[error(transparent)]
    Numbers(#[from] Refused),
    /// The equations of motion are singular here, and with them the reactions.
    #[error(
        "{name} does not exist at t = {time} s: the top mass is above the pivot of a foundation without inertia (m0, J0 too \
         small)"
    )]
    NoReaction { name: String, time: f64 },
    #[error(transparent)]
    Advance(#[from] AdvanceError),
    #[error("{name} = {value} is out of range: at most 1e12 in SI units; take a shorter step")]
    FarState { name: String, value: f64 },
    #[error(
        "the derivatives of the states do not exist at t = {time} s (u = {u} m, theta = {theta} rad): take a shorter step"
    )]
    NoStateRates { time: f64, u: f64, theta: f64 },
}

impl From<Refusal> for Failure {
    fn from(refusal: Refusal) -> Failure {
        let message = refusal.to_string();
        match refusal {
            Refusal::Advance(AdvanceError::Singular { .. }) => Failure::Stuck(message),
            Refusal::FarState { .. } | Refusal::NoStateRates { .. } => Failure::Discarded(message),
            _ => Failure::Refused(message),
        }
    }
}
