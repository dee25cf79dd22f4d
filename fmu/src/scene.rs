//! The structure on its ground: how a simulation starts from its setup, and what acts on the structure and has been
//! found out about it since.

use crate::failure::Refusal;
use crate::ground::{Digest, GroundRecord};
use crate::setup::Setup;
use rocking::mechanics::load::{LOADS, VERTICAL};
use rocking::run::fall::FallingPeaks;
use rocking::run::ground_motion::Elapsed;
use rocking::run::outside_step::Known;
use rocking::run::validity::{Found, Limits, Validity};
use rocking::{Engine, LinearLoad, Load, Phase, Structure, Watch};
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// The structure on its ground.
pub(crate) struct Scene {
    pub engine: Engine,
    pub ground: Option<Arc<GroundRecord>>,
    /// Time since the start, on ground that follows a record.
    pub elapsed: Elapsed,
    /// If the host integrates: the engine is then where the host is.
    pub outside: Option<Outside>,
    pub peaks: FallingPeaks,
    pub validity: Found,
}

/// The knowledge of an instance beside the present of a motion that the host integrates.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Outside {
    /// The last motion that was known.
    pub known: Known,
    /// The inputs when event mode was entered: what is set there has not acted before.
    pub arrived: Load,
    /// When event mode was entered last: where the record jumps later, it does so once event mode is entered there.
    pub event: Elapsed,
}

impl Setup {
    /// The structure at the start time.
    pub(crate) fn engine(&self) -> Result<Engine, Refusal> {
        let structure = Structure::new(self.parameters)?;
        Ok(Engine::with_detail(structure, self.initial, self.start_time, self.tolerance, self.detail)?)
    }

    /// Refuses a `record` that cannot act as it is scaled.
    fn check_ground(&self, record: &GroundRecord) -> Result<(), Refusal> {
        let ground = self.ground_motion(record);
        LOADS[0].check(ground.pga()).map_err(Refusal::StrongRecord)?;
        LOADS[VERTICAL].check(ground.vertical_peak()).map_err(Refusal::StrongRecord)?;
        if ground.duration().is_finite() {
            return Ok(());
        }
        Err(Refusal::LongRecord(ground.duration()))
    }
}

/// Whether what follows `ground` may move vertically.
fn may_move_vertically(setup: &Setup, ground: Option<&GroundRecord>) -> bool {
    setup.vertical || ground.is_some_and(|ground| ground.record.vertical().is_some())
}

impl Scene {
    /// At the start that `setup` describes, on ground that follows `ground`.
    pub fn new(setup: &Setup, ground: Option<Arc<GroundRecord>>) -> Result<Scene, Refusal> {
        let mut engine = setup.engine()?;
        if may_move_vertically(setup, ground.as_deref()) {
            engine.admit_vertical(true)?;
        }
        ground.as_deref().map_or(Ok(()), |ground| setup.check_ground(ground))?;
        let peaks = FallingPeaks::since(setup.start_time, engine.structure(), setup.detail);
        let validity = Found::since(setup.start_time);
        Ok(Scene { engine, ground, elapsed: Elapsed::default(), outside: None, peaks, validity })
    }

    /// Whether the ground may move vertically.
    pub fn may_move_vertically(&self, setup: &Setup) -> bool {
        may_move_vertically(setup, self.ground.as_deref())
    }

    /// The load that acts now: `inputs` and the record.
    #[inline]
    pub fn load(&self, setup: &Setup, inputs: LinearLoad) -> LinearLoad {
        let Some(ground) = &self.ground else { return inputs };
        let (ground, elapsed) = (setup.ground_motion(ground), self.elapsed);
        inputs.on_ground(match &self.outside {
            Some(outside) => ground.since(outside.event, elapsed),
            None => ground.at(elapsed),
        })
    }

    /// Whether no step has been made, and the first phase lasts: under `load` the structure does not uplift at once.
    fn is_at_start(&self, load: Load) -> bool {
        self.engine.motion().work.steps == 0 && self.engine.uplift_due(load).is_none()
    }

    /// The peaks since the start, of a structure that has overturned those before it fell; before the first step, the
    /// values under `load`.
    pub fn peaks(&self, setup: &Setup, load: Load) -> FallingPeaks {
        let mut peaks = self.peaks;
        if self.is_at_start(load) {
            peaks.see_instant(setup.start_time, &self.engine.outputs(load));
        }
        peaks
    }

    /// The limits that the motion has passed since the start; before the first step by the reactions under `load`.
    pub fn validity(&self, setup: &Setup, load: Load) -> Found {
        let mut validity = self.watch_validity();
        if self.is_at_start(load) {
            validity.see_instant(setup.start_time, self.engine.motion().phase, &self.engine.edges(load));
        }
        *validity.found()
    }

    /// Goes on from what has been found so far.
    pub fn watch_validity(&self) -> Validity {
        Validity::new(self.engine.structure(), Limits::default(), self.validity)
    }

    /// From the first to the last sample of the record, s; 0 without one.
    pub fn record_duration(&self, setup: &Setup) -> f64 {
        self.ground.as_ref().map_or(0.0, |ground| setup.ground_motion(ground).duration())
    }

    /// Names the record that the ground follows.
    pub fn digest(&self) -> Option<Digest> {
        self.ground.as_ref().map(|ground| ground.digest)
    }

    /// Whether the structure has overturned, which ends the simulation.
    pub fn has_overturned(&self) -> bool {
        matches!(self.engine.motion().phase, Phase::Overturned(_))
    }

    /// The instant of overturning, s.
    pub fn overturned_at(&self) -> Option<f64> {
        let motion = self.outside.as_ref().map_or(self.engine.motion(), |outside| &outside.known.motion);
        self.has_overturned().then_some(motion.time)
    }

    /// Whether the host integrates: the motion between its steps is then not the engine's to watch.
    pub fn is_integrated_outside(&self) -> bool {
        self.outside.is_some()
    }

    /// Applies the transition that is due, if there is one, and the uplift that is due at once then, or since the
    /// inputs `load` have jumped.
    pub fn transit<W: Watch>(&mut self, setup: &Setup, load: Load, watch: &mut W) {
        let acting = self.load(setup, load.into()).value;
        let mut validity = self.watch_validity();
        let watch = &mut (&mut validity, watch);
        self.engine.transit(watch);
        self.engine.lift_off_if_due(acting, watch);
        if setup.validity {
            self.validity = *validity.found();
        }
    }
}
