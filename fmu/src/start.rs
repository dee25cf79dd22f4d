//! Whether a simulation can start as it is set up, and the structure at its start.

use crate::failure::Failure;
use crate::ground::GroundRecord;
use crate::setup::Setup;
use rocking::mechanics::load::LOADS;
use rocking::{Engine, Structure};

impl Setup {
    /// The structure at the start time.
    pub(crate) fn engine(&self) -> Result<Engine, Failure> {
        let structure = Structure::new(self.parameters)?;
        Ok(Engine::with_detail(structure, self.initial, self.start_time, self.tolerance, self.detail)?)
    }

    /// Whether `record` can act, as it is scaled.
    pub(crate) fn check_ground(&self, record: &GroundRecord) -> Result<(), Failure> {
        let ground = self.ground_motion(record);
        let [a_g, _] = &LOADS;
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
