//! What is set before a simulation starts.

use crate::ground::GroundRecord;
use crate::resources::Contents;
use rocking::engine::DEFAULT_TOLERANCE;
use rocking::ground_motion::Placement;
use rocking::{Detail, GroundMotion, Parameters, State};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// What is set before a simulation starts.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Setup {
    pub(crate) parameters: Parameters,
    pub(crate) initial: State,
    pub(crate) detail: Detail,
    pub(crate) tolerance: f64,
    pub(crate) start_time: f64,
    pub(crate) stop_time: Option<f64>,
    /// Which record the ground follows; none if empty.
    pub(crate) record: Arc<str>,
    pub(crate) placement: Placement,
    /// Whether an input of which only the value is set goes on with the slope of its last two.
    pub(crate) extrapolate: bool,
    /// Whether peaks are watched.
    pub(crate) peaks: bool,
    /// Whether it is watched what the motion goes beyond.
    pub(crate) validity: bool,
}

impl Setup {
    /// That of an instance of an archive with these contents.
    pub(crate) fn new(contents: &Contents) -> Setup {
        Setup {
            parameters: contents.parameters,
            initial: State::default(),
            detail: Detail::default(),
            tolerance: DEFAULT_TOLERANCE,
            start_time: 0.0,
            stop_time: None,
            record: contents.default_record().into(),
            placement: Placement::default(),
            extrapolate: false,
            peaks: false,
            validity: false,
        }
    }

    /// `record` as it acts.
    pub(crate) fn ground_motion<'a>(&self, record: &'a GroundRecord) -> GroundMotion<'a> {
        let unit = record.unit.in_m_s2(self.parameters.g);
        GroundMotion { record: &record.record, unit, placement: self.placement }
    }
}
