//! One instance of the FMU, in safe code that knows no version of the standard: how it is made, goes from stage to
//! stage, and keeps FMU states.

use crate::failure::Failure;
use crate::interface::{Interface, IntermediateUpdate, Stepping};
use crate::logger::{Logger, Status};
use crate::motion_log::{log, warn};
use crate::present::Present;
use crate::resources::Archive;
use crate::setup::Setup;
use crate::snapshot::{self, Snapshots};
use crate::state_machine::Stage;
use rocking::Transition;
use rocking::engine::DEFAULT_TOLERANCE;
use rocking::run::validity;
use std::ffi::CString;
use std::path::PathBuf;

mod derivatives;
mod do_step;
mod get_values;
pub mod model_exchange;
mod set_values;

/// One instance.
pub struct Instance {
    logger: Logger,
    events_at_start: bool,
    now: Present,
    snapshots: Snapshots,
    /// The texts that the host was given last, which it may read until the next call.
    shown: Vec<CString>,
    /// The host that is called back within steps, if there is one.
    host: Option<IntermediateUpdate>,
    /// While the host is asked for inputs: the duration of the step, s.
    asked: Option<f64>,
    /// While the host reads outputs: the stage that the step has led to.
    led_to: Option<Stage>,
    /// Whether the host has been warned that it holds a ground acceleration from sample to sample.
    told_of_stairs: bool,
}

/// What came of an event.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Updated {
    /// Whether the structure has overturned, which ends the simulation.
    pub has_ended: bool,
    /// Whether the states differ from those that the host set.
    pub has_new_states: bool,
    /// The instant of the next event that can be foreseen, s.
    pub next_event: Option<f64>,
}

/// Opens the archive in the folder `resources`, and compares its GUID with `guid`, the argument `name`.
pub fn open(name: &'static str, guid: &str, resources: PathBuf) -> Result<Archive, Failure> {
    let archive = Archive::open(resources)?;
    let needed = crate::guid(&archive.contents);
    if guid != needed {
        return Err(Failure::WrongGuid { name, given: guid.to_owned(), needed });
    }
    Ok(archive)
}

impl Instance {
    /// An instance just instantiated from `archive`; `events` says whether events are logged.
    pub fn new(archive: Archive, interface: Interface, events: bool, mut logger: Logger) -> Instance {
        logger.set_events(events);
        let now = Present::new(archive, interface);
        let (snapshots, shown, host, asked, led_to, told_of_stairs) = Default::default();
        Instance { logger, events_at_start: events, now, snapshots, shown, host, asked, led_to, told_of_stairs }
    }

    /// The instance with a `host` that it calls back within steps.
    pub(crate) fn calling_back(self, host: Option<IntermediateUpdate>) -> Instance {
        Instance { host, ..self }
    }

    /// State of FMI's state machine.
    pub fn stage(&self) -> Stage {
        self.now.stage
    }

    /// Logs why a call returns `status`.
    pub fn report(&self, status: Status, message: &str) {
        self.logger.failure(status, message);
    }

    /// Switches the log of events on or off.
    pub fn log_events(&mut self, on: bool) {
        self.logger.set_events(on);
    }

    /// Sends a warning.
    pub fn warn(&self, message: &str) {
        self.logger.warning(message);
    }

    /// Sets tolerance and times; no tolerance means the default.
    pub fn setup_experiment(
        &mut self,
        tolerance: Option<f64>,
        start_time: f64,
        stop_time: Option<f64>,
    ) -> Result<(), Failure> {
        let tolerance = tolerance.unwrap_or(DEFAULT_TOLERANCE);
        let setup = Setup { tolerance, start_time, stop_time, ..self.now.setup.clone() };
        setup.check_experiment()?;
        self.now.setup = setup;
        Ok(())
    }

    /// Goes to `stage`, at which nothing else is to be done.
    pub fn enter(&mut self, stage: Stage) -> Result<(), Failure> {
        self.now.stage = stage;
        Ok(())
    }

    /// Starts the simulation: parameters and initial values are checked together, and fixed.
    pub fn exit_initialization_mode(&mut self) -> Result<(), Failure> {
        let (model, setup, ..) = self.now.parts()?;
        for warning in validity::of_parameters(model.engine.structure(), setup.detail) {
            self.logger.warning(&warning);
        }
        match self.now.interface {
            Interface::CoSimulation(_) => self.now.inputs.start(self.now.setup.between()),
            Interface::ModelExchange => {
                let watched = [("peaks", self.now.setup.peaks), ("validity", self.now.setup.validity)];
                for (name, _) in watched.into_iter().filter(|(_, is_watched)| *is_watched) {
                    self.logger.warning(&format!(
                        "{name} = true has no effect in model exchange, where the host integrates: the values are NaN; use \
                         co-simulation"
                    ));
                }
                self.start_outside()?;
            }
        }
        self.now.stage = self.now.interface.first_stage();
        Ok(())
    }

    /// Goes to event mode, at the end of a step or where the host's integrator is.
    pub fn enter_event_mode(&mut self) -> Result<(), Failure> {
        match self.now.interface {
            Interface::CoSimulation(Stepping { event_mode: false, .. }) => return Err(Failure::NoEventMode),
            Interface::CoSimulation(_) => (),
            Interface::ModelExchange => self.arrive_at_event()?,
        }
        self.now.stage = Stage::EventMode;
        Ok(())
    }

    /// Applies the transitions that are due.
    pub fn update_discrete_states(&mut self) -> Result<Updated, Failure> {
        match self.now.interface {
            Interface::CoSimulation(_) => self.transit().map(|()| Updated::default()),
            Interface::ModelExchange => self.catch_up(),
        }
    }

    /// Applies the transition that a step has ended at, if there is one, and the uplift that is due then.
    fn transit(&mut self) -> Result<(), Failure> {
        let logger = &self.logger;
        let (model, setup, inputs, _) = self.now.parts()?;
        let known = model.validity;
        model.transit(setup, inputs.values(), &mut |transition: &Transition| log(logger, transition));
        if setup.validity {
            warn(logger, &known, &model.validity);
        }
        Ok(())
    }

    /// Makes the instance as it was instantiated. FMU states stay the host's until it frees them.
    pub fn reset(&mut self) -> Result<(), Failure> {
        self.now.reset();
        self.logger.set_events(self.events_at_start);
        self.told_of_stairs = false;
        Ok(())
    }

    /// Where the simulation is, s.
    pub fn time(&mut self) -> Result<f64, Failure> {
        Ok(self.now.model()?.engine.motion().time)
    }

    /// What ends the simulation: the structure has overturned.
    pub fn overturned(&mut self) -> Result<Failure, Failure> {
        let model = self.now.model()?;
        Ok(Failure::Overturned { time: model.engine.motion().time, fall: model.peaks.fall() })
    }

    /// Whether the structure has overturned, which ends the simulation.
    pub fn has_overturned(&mut self) -> Result<bool, Failure> {
        Ok(self.now.model()?.has_overturned())
    }

    /// Keeps the condition in the FMU state `handle`, or in a new one for 0; returns the handle.
    pub fn get_fmu_state(&mut self, handle: usize) -> Result<usize, Failure> {
        self.snapshots.keep(handle, self.now.condition())
    }

    /// Goes back to the FMU state `handle`.
    pub fn set_fmu_state(&mut self, handle: usize) -> Result<(), Failure> {
        self.now.go_to(self.snapshots.find(handle)?)
    }

    /// Forgets the FMU state `handle`.
    pub fn free_fmu_state(&mut self, handle: usize) -> Result<(), Failure> {
        self.snapshots.free(handle)
    }

    /// The FMU state `handle` as bytes.
    pub fn serialize_fmu_state(&self, handle: usize) -> Result<Vec<u8>, Failure> {
        Ok(snapshot::serialize(self.snapshots.find(handle)?))
    }

    /// Keeps the condition that `bytes` hold in the FMU state `handle`, or in a new one for 0; returns the handle.
    pub fn deserialize_fmu_state(&mut self, bytes: &[u8], handle: usize) -> Result<usize, Failure> {
        self.snapshots.keep(handle, snapshot::deserialize(bytes)?)
    }
}
