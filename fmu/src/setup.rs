//! What is set before a simulation starts.

use crate::failure::Failure;
use crate::ground::GroundRecord;
use crate::resources::Contents;
use rocking::engine::DEFAULT_TOLERANCE;
use rocking::ground_motion::Placement;
use rocking::load::LOADS;
use rocking::record::Unit;
use rocking::{Detail, Engine, GroundMotion, Parameters, State, Structure};
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
            peaks: true,
        }
    }

    /// The structure at the start time.
    pub(crate) fn engine(&self) -> Result<Engine, Failure> {
        let structure = Structure::new(self.parameters)?;
        Ok(Engine::with_detail(structure, self.initial, self.start_time, self.tolerance, self.detail)?)
    }

    /// `record` as it acts.
    pub(crate) fn ground_motion<'a>(&self, record: &'a GroundRecord) -> GroundMotion<'a> {
        let unit = match record.unit {
            Unit::G => self.parameters.g,
            Unit::MetrePerSecondSquared => 1.0,
        };
        GroundMotion { record: &record.record, unit, placement: self.placement }
    }

    /// Whether `record` can act, as it is scaled.
    pub(crate) fn check_ground(&self, record: &GroundRecord) -> Result<(), Failure> {
        let ground = self.ground_motion(record);
        let [a_g, _] = const { &LOADS };
        a_g.check(ground.pga()).map_err(Failure::StrongRecord)?;
        if ground.duration().is_finite() {
            return Ok(());
        }
        let (name, limit) = ("record_duration", "finite: lower record_time_scale".to_owned());
        Err(Failure::Experiment { name, value: ground.duration(), limit })
    }

    /// Whether tolerance, start and stop time can be.
    pub(crate) fn check_experiment(&self) -> Result<(), Failure> {
        let &Setup { tolerance, start_time, stop_time, .. } = self;
        let refuse = |name, value, limit: &str| Failure::Experiment { name, value, limit: limit.to_owned() };
        if !(tolerance > 0.0 && tolerance < 1.0) {
            return Err(refuse("tolerance", tolerance, "between 0 and 1, such as 1e-9"));
        }
        if !start_time.is_finite() {
            return Err(refuse("startTime", start_time, "finite"));
        }
        match stop_time.filter(|stop_time| !(*stop_time >= start_time && stop_time.is_finite())) {
            Some(stop_time) => {
                Err(refuse("stopTime", stop_time, &format!("finite and not before startTime = {start_time} s")))
            }
            None => Ok(()),
        }
    }
}
