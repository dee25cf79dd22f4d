//! Where an instance stands: everything that its future depends on.

use crate::failure::Failure;
use crate::ground::{Digest, GroundRecord};
use crate::inputs::Inputs;
use crate::resources::Archive;
use crate::setup::Setup;
use crate::state_machine::Stage;
use crate::variables::{DataType, VARIABLES, Variable};
use rocking::Motion;
use rocking::engine::{AdvanceError, Progress};
use rocking::mechanics::load::LOADS;
use rocking::run::ground_motion::Elapsed;
use rocking::run::outside_step::Known;
use rocking::run::peaks::{PEAKS, Peaks};
use rocking::run::validity::{Found, Limits, Validity, Worst};
use rocking::{Detail, Engine, Impulse, LinearLoad, Load, Phase, State, Watch};
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

/// Largest |θ| of a structure in motion, rad: that of overturning and its rounding.
const MAX_ANGLE: f64 = FRAC_PI_2 + 1e-9;

/// More than any other number of the motion (SI units) but its time can be, and small enough to be squared.
const BOUND: f64 = 1e100;

/// More than anything that is counted can come to.
const MAX_COUNT: u64 = 1 << 60;

/// Part of the time, or of 1/p_l if that is more, that rounding can shift a transition by.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// How the host of a co-simulation meets transitions.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Stepping {
    /// It handles events, between steps.
    pub event_mode: bool,
    /// It takes a step that ends early.
    pub early_return: bool,
}

impl Stepping {
    /// Whether a step ends at a transition, which is handed over: the host must be able to do both.
    pub fn hands_over(self) -> bool {
        self.event_mode && self.early_return
    }
}

/// The largest state (SI units) that is taken from a host.
pub(crate) const FARTHEST: f64 = 1e12;

/// A few dozen numbers from which an instance goes on to the same bits: what an FMU state holds.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Condition {
    /// Who integrates.
    pub interface: Interface,
    /// State of FMI's state machine.
    pub stage: Stage,
    /// What was set before the start.
    pub setup: Setup,
    /// What acts from the present time on.
    pub inputs: Inputs,
    /// How far the simulation has come, once it has started: until then all follows from the setup.
    pub course: Option<Course>,
}

/// Who integrates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Interface {
    /// The FMU.
    CoSimulation(Stepping),
    /// The host.
    ModelExchange,
}

impl Interface {
    /// The stage in which a simulation starts.
    pub const fn first_stage(self) -> Stage {
        match self {
            Interface::CoSimulation(Stepping { event_mode: false, .. }) => Stage::StepComplete,
            Interface::CoSimulation(Stepping { event_mode: true, .. }) | Interface::ModelExchange => Stage::EventMode,
        }
    }

    /// How the host meets transitions that the FMU comes across.
    pub fn stepping(self) -> Stepping {
        match self {
            Interface::CoSimulation(stepping) => stepping,
            Interface::ModelExchange => Stepping::default(),
        }
    }

    const fn has(self, stage: Stage) -> bool {
        match stage {
            Stage::StepComplete | Stage::StepFailed => matches!(self, Interface::CoSimulation(_)),
            Stage::EventMode => matches!(self.first_stage(), Stage::EventMode),
            Stage::ContinuousTimeMode => matches!(self, Interface::ModelExchange),
            Stage::IntermediateUpdateMode | Stage::IntermediateOutputs => false, // no state is kept within a step
            Stage::Instantiated | Stage::InitializationMode | Stage::Terminated | Stage::Error => true,
        }
    }
}

/// What an instance knows beside the present of a motion that the host integrates.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Outside {
    /// Where the motion was last known.
    pub known: Known,
    /// The inputs when event mode was entered: what is set there has not acted before.
    pub arrived: Load,
    /// When event mode was entered last: where the record jumps later, it does so once event mode is entered there.
    pub event: Elapsed,
}

/// How far a simulation has come.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Course {
    /// The motion; the host's, if the host integrates.
    pub motion: Motion,
    /// If the host integrates.
    pub outside: Option<Outside>,
    /// Time since the start, on ground that follows a record.
    pub elapsed: Elapsed,
    /// Peaks so far, if they are watched.
    pub peaks: Peaks,
    /// What the motion has gone beyond so far, if it is watched.
    pub validity: Found,
    /// Of the record that the ground follows.
    pub record: Option<Digest>,
}

/// A condition with what it is the condition of.
pub(crate) struct Present {
    pub interface: Interface,
    pub stage: Stage,
    pub setup: Setup,
    pub inputs: Inputs,
    /// Until initialization ends it is built when an output is asked for, and dropped when what it was built from is
    /// set anew.
    pub model: Option<Model>,
    /// The record that was followed last, which is not read anew for another run.
    pub record: Option<Arc<GroundRecord>>,
}

/// The structure on its ground.
pub(crate) struct Model {
    pub engine: Engine,
    pub ground: Option<Arc<GroundRecord>>,
    /// Time since the start, on ground that follows a record.
    pub elapsed: Elapsed,
    /// If the host integrates: the engine is then where the host is.
    pub outside: Option<Outside>,
    pub peaks: Peaks,
    pub validity: Found,
}

impl Model {
    /// At the start that `setup` describes, on ground that follows `ground`.
    pub fn new(setup: &Setup, ground: Option<Arc<GroundRecord>>) -> Result<Model, Failure> {
        let engine = setup.engine()?;
        ground.as_deref().map_or(Ok(()), |ground| setup.check_ground(ground))?;
        let peaks = Peaks::since(setup.start_time, engine.structure());
        let validity = Found::since(setup.start_time);
        Ok(Model { engine, ground, elapsed: Elapsed::default(), outside: None, peaks, validity })
    }

    /// The same on ground that follows the setup's record in `archive`, or on disk, which becomes `record`.
    #[cold]
    fn with_record(setup: &Setup, archive: &Archive, record: &mut Option<Arc<GroundRecord>>) -> Result<Model, Failure> {
        *record = archive.record(&setup.record)?;
        Model::new(setup, record.clone())
    }

    /// What acts now: `inputs` and the record.
    #[inline]
    pub fn load(&self, setup: &Setup, inputs: LinearLoad) -> LinearLoad {
        let Some(ground) = &self.ground else { return inputs };
        let (ground, elapsed) = (setup.ground_motion(ground), self.elapsed);
        inputs.on_ground(match &self.outside {
            Some(outside) => ground.since(outside.event, elapsed),
            None => ground.at(elapsed),
        })
    }

    /// Whether there has been no step, and the structure is in motion or at rest as it stands: contact that ends at once under
    /// `load` is neither.
    fn starts_as_it_stands(&self, load: Load) -> bool {
        self.engine.motion().work.steps == 0 && self.engine.uplift_due(load).is_none()
    }

    /// The peaks since the start; before the first step, the values under `load`.
    pub fn peaks(&self, setup: &Setup, load: Load) -> Peaks {
        let mut peaks = self.peaks;
        if self.starts_as_it_stands(load) {
            peaks.see_instant(setup.start_time, &self.engine.outputs(load));
        }
        peaks
    }

    /// What the motion has gone beyond since the start; before the first step, what the reactions under `load` are.
    pub fn validity(&self, setup: &Setup, load: Load) -> Found {
        let mut validity = self.watch_validity();
        if self.starts_as_it_stands(load) {
            validity.see_instant(setup.start_time, self.engine.motion().phase, &self.engine.reactions(load));
        }
        *validity.found()
    }

    /// Goes on from what has been found so far.
    fn watch_validity(&self) -> Validity {
        Validity::new(self.engine.structure(), Limits::default(), self.validity)
    }

    /// From the first to the last sample of the record, s; 0 without one.
    pub fn record_duration(&self, setup: &Setup) -> f64 {
        self.ground.as_ref().map_or(0.0, |ground| setup.ground_motion(ground).duration())
    }

    /// Whether the structure has overturned, which ends the simulation.
    pub fn has_overturned(&self) -> bool {
        matches!(self.engine.motion().phase, Phase::Overturned(_))
    }

    /// Applies the transition that is due, if there is one, and the uplift that is due at once then, or since the inputs `load`
    /// have jumped.
    pub fn transit<W: Watch>(&mut self, setup: &Setup, load: Load, watch: &mut W) {
        let acting = self.load(setup, load.into()).value;
        if !setup.validity {
            self.engine.transit(watch);
            return self.engine.lift_off_if_due(acting, watch);
        }
        let mut validity = self.watch_validity();
        let watch = &mut (&mut validity, watch);
        self.engine.transit(watch);
        self.engine.lift_off_if_due(acting, watch);
        self.validity = *validity.found();
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

    /// Advances by `step` (s) under `inputs` and the record. If it fails, nothing has changed.
    #[inline]
    pub fn advance<W: Watch>(
        &mut self,
        setup: &Setup,
        step: f64,
        inputs: LinearLoad,
        watch: &mut W,
    ) -> Result<Progress, AdvanceError> {
        if !setup.validity && !setup.peaks {
            return self.follow(setup, step, inputs, watch);
        }
        let mut peaks = self.peaks;
        if !setup.validity {
            let progress = self.follow(setup, step, inputs, &mut (&mut peaks.watch(), watch))?;
            self.peaks = peaks;
            return Ok(progress);
        }
        let mut validity = self.watch_validity();
        let watch = &mut (&mut validity, watch);
        let progress = if setup.peaks {
            self.follow(setup, step, inputs, &mut (&mut peaks.watch(), watch))
        } else {
            self.follow(setup, step, inputs, watch)
        }?;
        (self.peaks, self.validity) = (peaks, *validity.found());
        Ok(progress)
    }

    /// The same for a host that transitions are handed over to. One that rounding alone keeps from the end of the step is met
    /// there: a host that goes back and steps to the instant that it was told meets it again. What is due at the very start,
    /// since an input has just jumped, is applied: no step is over where it began.
    #[inline(never)]
    pub fn advance_to_transition<W: Watch>(
        &mut self,
        setup: &Setup,
        step: f64,
        inputs: LinearLoad,
        watch: &mut W,
    ) -> Result<Progress, AdvanceError> {
        let (from, elapsed) = (self.engine.motion().time, self.elapsed);
        let until = from + step;
        let mut progress = self.advance(setup, step, inputs, watch)?;
        while progress == Progress::Transition && self.engine.motion().time <= from {
            progress = self.advance(setup, step, inputs, watch)?;
        }
        let rounding = ROUNDING * until.abs().max(self.engine.structure().p_l.recip());
        if progress == Progress::Complete {
            if self.goes_on_for(setup, rounding) {
                return Ok(progress);
            }
            let motion = *self.engine.motion();
            progress = self.follow(setup, rounding, inputs.from(step), watch).unwrap_or(Progress::Complete);
            if progress == Progress::Complete {
                self.engine.set_motion(motion);
            }
        }
        if until - self.engine.motion().time <= rounding {
            self.engine.set_time(until);
            self.elapsed = elapsed.and(step);
        }
        Ok(progress)
    }

    /// Whether no transition can come within `ahead` (s), which is next to nothing.
    fn goes_on_for(&self, setup: &Setup, ahead: f64) -> bool {
        let &Motion { phase, state: State { u, u_dot, theta, theta_dot }, .. } = self.engine.motion();
        let way = |rate: f64| ahead * (rate.abs() + 1.0); // at most, whatever accelerates it
        match phase {
            // without u the load alone decides
            Phase::FullContact if setup.detail == Detail::Rigid => false,
            Phase::FullContact => u.abs() + way(u_dot) < self.engine.structure().u_cr,
            Phase::Rocking(_) => (way(theta_dot)..FRAC_PI_2 - way(theta_dot)).contains(&theta.abs()),
            Phase::Overturned(_) => true,
        }
    }

    fn follow<W: Watch>(
        &mut self,
        setup: &Setup,
        step: f64,
        inputs: LinearLoad,
        watch: &mut W,
    ) -> Result<Progress, AdvanceError> {
        let Model { engine, ground, elapsed, .. } = self;
        let Some(ground) = ground else { return engine.advance(step, inputs, watch) };
        let start = engine.motion().time;
        let progress = setup.ground_motion(ground).advance(engine, *elapsed, step, inputs, watch)?;
        *elapsed = elapsed.and(if progress == Progress::Complete { step } else { engine.motion().time - start });
        Ok(progress)
    }
}

impl Condition {
    /// Whether calls can lead here. What is read from bytes need not have come about by calls.
    pub fn is_possible(&self) -> bool {
        let fits = |variable: &Variable| match (variable.data_type, variable.source.setting(&self.setup)) {
            (DataType::Real { range: Some((min, max)), .. }, Some(value)) => (min..=max).contains(&value),
            _ => true,
        };
        VARIABLES.iter().all(fits)
            && self.inputs.are_possible()
            && self.setup.check_experiment().is_ok()
            && self.interface.has(self.stage)
            && self.course.is_some() == self.stage.has_started()
            && self
                .course
                .as_ref()
                .is_none_or(|course| course.outside.is_some() == (self.interface == Interface::ModelExchange))
            && self.course.as_ref().is_none_or(|course| course.is_possible(&self.setup))
    }
}

impl Course {
    fn is_possible(&self, setup: &Setup) -> bool {
        let Course { motion, outside, elapsed, peaks, validity, record } = self;
        let farthest = if outside.is_some() { FARTHEST } else { MAX_ANGLE };
        is_possible(motion, farthest)
            && elapsed.seconds().is_finite()
            && outside.as_ref().is_none_or(|Outside { known, arrived, event }| {
                is_possible(&known.motion, MAX_ANGLE)
                    && [known.elapsed, *event].iter().all(|elapsed| elapsed.seconds().is_finite())
                    && [known.load, *arrived]
                        .iter()
                        .all(|load| LOADS.iter().all(|input| input.check((input.get)(load)).is_ok()))
            })
            && PEAKS
                .iter()
                .map(|peaking| (peaking.of)(peaks))
                .all(|peak| peak.magnitude <= BOUND && peak.time.is_finite())
            && validity.worst.iter().all(|&Worst { value, time, first_beyond, beyond }| {
                // friction may be infinite
                value >= -BOUND && [time, first_beyond.unwrap_or(0.0), beyond].iter().all(|x| x.is_finite())
            })
            && [validity.held, validity.duration].iter().all(|x| x.is_finite())
            && [validity.gains, validity.impacts, validity.settlings, validity.evaluations]
                .iter()
                .all(|count| *count < MAX_COUNT)
            && peaks.evaluations() < MAX_COUNT
            && record.is_none() == setup.record.is_empty()
            && setup.engine().is_ok_and(|engine| peaks.are_of(engine.structure()))
    }
}

/// Whether calls can lead to `motion`, with |θ| no more than `farthest` (rad).
fn is_possible(motion: &Motion, farthest: f64) -> bool {
    let &Motion { time, state: State { u, u_dot, theta, theta_dot }, impulse, transitions, work, .. } = motion;
    let Impulse { I_h, I_v, I_m } = impulse;
    [u, u_dot, theta_dot, I_h, I_v, I_m].iter().all(|x| x.abs() <= BOUND)
        && theta.abs() <= farthest
        && [transitions, work.steps, work.evaluations].iter().all(|count| *count < MAX_COUNT)
        && time.is_finite()
        && motion.is_possible()
}

impl Present {
    /// As instantiated from `archive`.
    pub fn new(archive: &Archive, interface: Interface) -> Present {
        let setup = Setup::new(&archive.contents);
        Present { interface, stage: Stage::Instantiated, setup, inputs: Inputs::default(), model: None, record: None }
    }

    /// The structure in motion, or at its start with what has been set so far; its record is in `archive`, or on disk.
    pub fn model(&mut self, archive: &Archive) -> Result<&mut Model, Failure> {
        self.parts(archive).map(|(model, ..)| model)
    }

    /// The same with what else there is.
    #[inline]
    pub fn parts(&mut self, archive: &Archive) -> Result<(&mut Model, &Setup, &mut Inputs, &mut Stage), Failure> {
        let Present { stage, setup, inputs, model, record, .. } = self;
        let model = match model {
            Some(model) => model,
            none => none.insert(Model::with_record(setup, archive, record)?),
        };
        Ok((model, setup, inputs, stage))
    }

    /// Its condition.
    pub fn condition(&self) -> Condition {
        let Present { interface, stage, setup, inputs, model, .. } = self;
        let course = model.as_ref().filter(|_| stage.has_started()).map(|model| Course {
            motion: *model.engine.motion(),
            outside: model.outside,
            elapsed: model.elapsed,
            peaks: model.peaks,
            validity: model.validity,
            record: model.digest(),
        });
        Condition { interface: *interface, stage: *stage, setup: setup.clone(), inputs: *inputs, course }
    }

    /// Goes to `condition`. The model is built anew only for another setup.
    pub fn go_to(&mut self, condition: &Condition, archive: &Archive) -> Result<(), Failure> {
        let Condition { interface, stage, setup, inputs, course } = condition;
        if *interface != self.interface {
            return Err(Failure::OtherInterface);
        }
        let mut model = None;
        if let Some(course) = course {
            let is_the_same = |model: &mut Model| self.setup == *setup && model.digest() == course.record;
            let kept = self.model.take_if(is_the_same);
            let mut found = kept.map_or_else(|| Model::new(setup, archive.record(&setup.record)?), Ok)?;
            if found.digest() != course.record {
                return Err(Failure::OtherRecord(setup.record.to_string()));
            }
            found.engine.set_motion(course.motion);
            (found.elapsed, found.outside) = (course.elapsed, course.outside);
            (found.peaks, found.validity) = (course.peaks, course.validity);
            model = Some(found);
        }
        let ground = model.as_ref().and_then(|model| model.ground.clone());
        let record = ground.or_else(|| self.record.take());
        *self = Present { interface: *interface, stage: *stage, setup: setup.clone(), inputs: *inputs, model, record };
        Ok(())
    }
}

impl Model {
    /// Of the record that the ground follows.
    fn digest(&self) -> Option<Digest> {
        self.ground.as_ref().map(|ground| ground.digest)
    }
}
