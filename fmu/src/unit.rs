//! The structure on its ground as a model for FMI: how values are read and set, and how a simulation goes.

use crate::failure::Refusal;
use crate::ground::{Digest, Kept};
use crate::inputs::Inputs;
use crate::motion_log::{log, warn, warn_of_stairs};
use crate::resources::Archive;
use crate::scene::{Outside, Scene};
use crate::setup::Setup;
use crate::shown::Shown;
use crate::variables::{Source, Table};
use crate::{BUILD, guid};
use fmi_unit::snapshot::write_state;
use fmi_unit::{Completed, Experiment, Failure, Interface, Logger, Model, Progress, Step, Update, Value, Variable};
use rocking::engine::DEFAULT_TOLERANCE;
use rocking::mechanics::load::VERTICAL;
use rocking::run::fall::FallingPeaks;
use rocking::run::ground_motion::Elapsed;
use rocking::run::validity::{self, Findings};
use rocking::{Motion, State, Transition};
use serde::{Deserialize, Serialize};
use std::path::Path;
use std::sync::Arc;

/// An instance between two calls.
pub struct Unit {
    pub(crate) table: Table,
    archive: Archive,
    pub(crate) setup: Setup,
    pub(crate) inputs: Inputs,
    /// Until the start it is built when an output is asked for, and dropped when what it was built from is set anew.
    scene: Option<Scene>,
    has_started: bool,
    /// The record that was followed last, which is not parsed anew for another run.
    kept: Option<Kept>,
    /// Whether the host has been warned that it holds a ground acceleration from sample to sample.
    told_of_stairs: bool,
}

/// All from which an instance goes on to the same bits: its part of an FMU state.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Condition {
    /// The settings before the start.
    pub setup: Setup,
    /// The inputs from the present time on.
    pub inputs: Inputs,
    /// How far the simulation has come, once it has started: until then all follows from the setup.
    pub course: Option<Course>,
}

/// How far a simulation has come.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Course {
    /// The motion; the host's, if the host integrates.
    pub motion: Motion,
    /// The knowledge beside the motion, if the host integrates.
    pub outside: Option<Outside>,
    /// Time since the start, on ground that follows a record.
    pub elapsed: Elapsed,
    /// Peaks so far, if they are watched.
    pub peaks: FallingPeaks,
    /// Which limits of the model have been passed so far, if they are watched.
    pub validity: Findings,
    /// Names the record that the ground follows.
    pub record: Option<Digest>,
}

impl Unit {
    /// The structure in motion, or at its start with what has been set so far; its record is in the archive, or on disk.
    pub(crate) fn scene(&mut self) -> Result<&mut Scene, Refusal> {
        self.parts().map(|(scene, ..)| scene)
    }

    /// The structure with the setup and the inputs.
    #[inline]
    pub(crate) fn parts(&mut self) -> Result<(&mut Scene, &Setup, &mut Inputs), Refusal> {
        if self.scene.is_none() {
            self.build()?;
        }
        let Unit { setup, inputs, scene, .. } = self;
        Ok((scene.as_mut().expect("it is built"), setup, inputs))
    }

    #[cold]
    fn build(&mut self) -> Result<(), Refusal> {
        let ground =
            self.archive.ground(&self.setup.record, &self.setup.record_v, self.setup.parameters.g, &mut self.kept)?;
        self.scene = Some(Scene::new(&self.setup, ground)?);
        Ok(())
    }

    /// Reads real numbers that the host sets.
    fn settings(&self, references: &[u32], values: &mut [f64]) -> Result<(), Failure> {
        for (reference, value) in references.iter().zip(values) {
            *value = setting(&self.setup, &self.inputs, self.table.sources[*reference as usize]);
        }
        Ok(())
    }

    /// Lets the ground move vertically from now on.
    #[cold]
    #[inline(never)]
    fn admit_vertical(&mut self) -> Result<(), Failure> {
        if let Some(scene) = &mut self.scene {
            scene.set(|settings| settings.vertical = true)?;
        }
        self.setup.vertical = true;
        Ok(())
    }

    /// Whether one of `values` moves the ground vertically.
    #[inline]
    fn is_vertical(&self, references: &[u32], values: &[f64]) -> bool {
        references.iter().zip(values).any(|(reference, value)| *reference == VERTICAL as u32 && *value != 0.0)
    }
}

/// The value of a real number that is no output: one that is `shown`, or set.
#[cold]
#[inline(never)]
fn other(shown: &Shown, inputs: &Inputs, source: Source) -> f64 {
    shown.value(source).unwrap_or_else(|| setting(shown.setup, inputs, source))
}

/// The value of a real number that the host sets.
fn setting(setup: &Setup, inputs: &Inputs, source: Source) -> f64 {
    match source {
        Source::Input(which) => inputs.shown()[which],
        source => source.setting(setup).expect("a real number that is not computed is set"),
    }
}

impl Model for Unit {
    fn open(resources: &Path) -> Result<Unit, Failure> {
        let archive = Archive::open(resources.to_owned()).map_err(Refusal::from)?;
        let (table, setup) = (Table::new(&archive.contents), Setup::new(&archive.contents));
        let (inputs, scene, has_started, kept, told_of_stairs) = Default::default();
        Ok(Unit { table, archive, setup, inputs, scene, has_started, kept, told_of_stairs })
    }

    fn token(&self) -> String {
        guid(&self.archive.contents)
    }

    fn build(&self) -> String {
        BUILD.to_owned()
    }

    fn variables(&self) -> Arc<[Variable]> {
        Arc::clone(&self.table.variables)
    }

    fn get(&mut self, reference: u32) -> Result<Value, Failure> {
        let source = self.table.sources[reference as usize];
        Ok(match source {
            Source::Integer(of) => Value::Integer(of(self.scene()?.engine.motion())),
            Source::Boolean(of) => Value::Boolean(of(self.scene()?.engine.motion()) != 0),
            Source::Gains => Value::Integer(i32::try_from(self.scene()?.validity.gains).unwrap_or(i32::MAX)),
            Source::Switch(_) | Source::Detail | Source::Text(_) => source.set_value(&self.setup).expect("it is set"),
            _ => {
                let mut value = [0.0];
                self.get_reals(&[reference], &mut value)?;
                Value::Real(value[0])
            }
        })
    }

    #[inline(always)]
    fn get_reals(&mut self, references: &[u32], values: &mut [f64]) -> Result<(), Failure> {
        if self.scene.is_none() {
            let is_set = |reference: &u32| self.table.sources[*reference as usize].is_set();
            if references.iter().all(is_set) {
                return self.settings(references, values);
            }
            self.build()?;
        }
        let Unit { table: Table { sources, .. }, setup, inputs, scene: Some(scene), .. } = self else {
            unreachable!("it is built")
        };
        let load = scene.load(setup, inputs.values().into()).value;
        let outputs = scene.engine.outputs(load);
        let (mut shown, sources): (_, &[Source]) = (None, sources);
        for (reference, value) in references.iter().zip(values) {
            *value = match sources[*reference as usize] {
                Source::Output(of) => of(&outputs),
                source => {
                    let shown = shown.get_or_insert_with(|| Shown::new(scene, setup, load, outputs));
                    other(shown, inputs, source)
                }
            };
        }
        let Some(shown) = shown else { return Ok(()) };
        let Some(reference) = shown.unsolved(references, sources) else { return Ok(()) };
        Err(Refusal::NoReaction { name: self.name(reference), time: self.time()? }.into())
    }

    fn set(&mut self, reference: u32, value: Value) {
        let mut setup = self.setup.clone();
        self.table.sources[reference as usize].set_to(&mut setup, value);
        if setup != self.setup {
            (self.setup, self.scene) = (setup, None);
        }
    }

    #[inline(always)]
    fn set_inputs(&mut self, references: &[u32], values: &[f64]) -> Result<(), Failure> {
        if self.is_vertical(references, values) {
            self.admit_vertical()?;
        }
        references.iter().zip(values).for_each(|(reference, value)| self.inputs.set(*reference as usize, *value));
        Ok(())
    }

    #[inline(always)]
    fn set_slopes(&mut self, references: &[u32], slopes: &[f64]) -> Result<(), Failure> {
        if self.is_vertical(references, slopes) {
            self.admit_vertical()?;
        }
        references.iter().zip(slopes).for_each(|(reference, slope)| self.inputs.set_slope(*reference as usize, *slope));
        Ok(())
    }

    fn lead(&mut self, reference: u32, value: f64, step: f64) -> Result<(), Failure> {
        if self.is_vertical(&[reference], &[value]) {
            self.admit_vertical()?;
        }
        self.inputs.lead(reference as usize, value, step);
        Ok(())
    }

    fn set_up(&mut self, &Experiment { tolerance, start_time, .. }: &Experiment) {
        let tolerance = tolerance.unwrap_or(DEFAULT_TOLERANCE);
        self.setup = Setup { tolerance, start_time, ..self.setup.clone() };
        self.scene = None;
    }

    fn start(&mut self, interface: Interface, logger: &Logger) -> Result<(), Failure> {
        let (scene, setup, inputs) = self.parts()?;
        for of_file in scene.source.iter().flat_map(|source| &source.sentences) {
            let (found, assumed) = of_file.split_at(1.min(of_file.len()));
            found.iter().for_each(|found| logger.event(|| found.clone()));
            assumed.iter().for_each(|assumed| logger.warning(assumed));
        }
        for doubt in scene.ground.iter().flat_map(|ground| rocking_records::doubts(ground, setup.parameters.g)) {
            logger.warning(&format!("the record: {doubt}"));
        }
        for warning in validity::of_parameters(scene.engine.structure(), setup.detail) {
            logger.warning(&warning);
        }
        match interface {
            Interface::CoSimulation(_) => inputs.start(setup.between()),
            Interface::ModelExchange => {
                let watched = [("peaks", setup.peaks), ("validity", setup.validity)];
                for (name, _) in watched.into_iter().filter(|(_, is_watched)| *is_watched) {
                    logger.warning(&format!(
                        "{name} = true has no effect in model exchange, where the host integrates: the values are NaN; use \
                         co-simulation"
                    ));
                }
                scene.leave_to_host(inputs.values());
            }
        }
        self.has_started = true;
        Ok(())
    }

    #[inline]
    fn time(&mut self) -> Result<f64, Failure> {
        Ok(self.scene.as_ref().map_or(self.setup.start_time, |scene| scene.engine.motion().time))
    }

    #[inline(always)]
    fn advance(&mut self, step: Step, logger: &Logger) -> Result<Progress, Failure> {
        let Step { start: point, duration: step, stops_at_events: stops } = step;
        let (scene, setup, inputs) = self.parts()?;
        let load = inputs.over(step);
        let end = load.at(step);
        end.check().map_err(Refusal::InputRunsOut)?;

        let time = scene.engine.motion().time;
        scene.engine.set_time(point);
        if scene.engine.settings().stops != stops {
            scene.set(|settings| settings.stops = stops)?;
        }
        let known = setup.validity.then_some(scene.validity);
        let mut watch = |transition: &Transition| log(logger, transition);
        let result = if stops {
            scene.advance_to_transition(setup, step, &load, &mut watch)
        } else {
            scene.advance(setup, step, &load, &mut watch)
        };
        let progress = result.map_err(|error| {
            scene.engine.set_time(time);
            Refusal::from(error)
        })?;
        let reached = scene.engine.motion().time;
        let ended_early = reached < point + step;
        if !ended_early {
            inputs.pass(load, step, end, false);
        } else if reached > point {
            inputs.pass(load, reached - point, load.at(reached - point), true);
        }
        known.iter().for_each(|known| warn(logger, known, &scene.validity));
        if inputs.makes_stairs() && !self.told_of_stairs {
            self.told_of_stairs = true;
            warn_of_stairs(logger, reached);
        }
        Ok(match progress {
            rocking::Progress::Complete => Progress::Complete,
            rocking::Progress::Transition => Progress::Event,
            rocking::Progress::Overturned => Progress::Ended,
        })
    }

    fn update(&mut self, logger: &Logger) -> Result<Update, Failure> {
        let (scene, setup, inputs) = self.parts()?;
        if scene.is_integrated_outside() {
            return scene.catch_up(setup, inputs.values(), logger);
        }
        let known = scene.validity;
        scene.transit(setup, inputs.values(), &mut |transition: &Transition| log(logger, transition));
        if setup.validity {
            warn(logger, &known, &scene.validity);
        }
        Ok(Update::default())
    }

    fn ending(&mut self) -> Result<Option<String>, Failure> {
        let scene = self.scene()?;
        let (time, fall) = (scene.engine.motion().time, scene.peaks.fall());
        let fall =
            fall.map_or(String::new(), |fall| format!(", falling since t = {fall} s, before which its peaks are"));
        Ok(scene.has_overturned().then(|| format!("the structure overturned at t = {time} s{fall}")))
    }

    fn state(&self, bytes: &mut Vec<u8>) {
        let Unit { setup, inputs, scene, has_started, .. } = self;
        let course = scene.as_ref().filter(|_| *has_started).map(|scene| Course {
            motion: *scene.engine.motion(),
            outside: scene.outside,
            elapsed: scene.elapsed,
            peaks: scene.peaks,
            validity: scene.validity,
            record: scene.digest(),
        });
        let condition = Condition { setup: setup.clone(), inputs: *inputs, course };
        write_state(&condition, bytes);
    }

    /// The scene is built anew only for another setup.
    fn restore(&mut self, bytes: &[u8]) -> Result<(), Failure> {
        let read = postcard::from_bytes(bytes);
        let Condition { setup, inputs, course } = read.map_err(|_| Failure::BadBytes("its content cannot be read"))?;
        let mut scene = None;
        if let Some(course) = course {
            let is_the_same = |scene: &mut Scene| self.setup == setup && scene.digest() == course.record;
            let mut found = match self.scene.take_if(is_the_same) {
                Some(scene) => scene,
                None => {
                    let ground =
                        self.archive.ground(&setup.record, &setup.record_v, setup.parameters.g, &mut self.kept);
                    Scene::new(&setup, ground.map_err(Refusal::from)?)?
                }
            };
            if found.digest() != course.record {
                let [record, record_v] = [&setup.record, &setup.record_v].map(|text| text.to_string());
                return Err(Refusal::OtherRecord { record, record_v }.into());
            }
            found.engine.set_motion(course.motion);
            (found.elapsed, found.outside) = (course.elapsed, course.outside);
            (found.peaks, found.validity) = (course.peaks, course.validity);
            scene = Some(found);
        }
        self.has_started = course.is_some();
        self.told_of_stairs &= self.has_started;
        (self.setup, self.inputs, self.scene) = (setup, inputs, scene);
        Ok(())
    }

    fn rates(&mut self, references: &[u32], rates: &mut [f64]) -> Result<(), Failure> {
        self.output_rates(references, rates)
    }

    fn derivatives(&mut self, of: &[u32], direction: &[(u32, f64)], has_started: bool) -> Result<Vec<f64>, Failure> {
        self.directional_derivatives(of, direction, has_started)
    }

    fn set_time(&mut self, time: f64, is_at_event: bool) {
        let Unit { setup, scene: Some(scene), .. } = self else { return };
        scene.go_to(setup, time, is_at_event);
    }

    fn states(&mut self) -> Result<Vec<f64>, Failure> {
        Ok(self.scene()?.engine.motion().state.components().into())
    }

    fn set_states(&mut self, states: &[f64]) -> Result<(), Failure> {
        self.scene()?.take_states(states)
    }

    fn nominals(&mut self) -> Result<Vec<f64>, Failure> {
        Ok(State::usual(self.scene()?.engine.structure()).components().into())
    }

    fn state_rates(&mut self) -> Result<Vec<f64>, Failure> {
        let (scene, setup, inputs) = self.parts()?;
        let rates = scene.engine.sample(scene.acting(setup, inputs.values())).state_rates();
        if !rates.is_finite() {
            let &Motion { time, state: State { u, theta, .. }, .. } = scene.engine.motion();
            return Err(Refusal::NoStateRates { time, u, theta }.into());
        }
        Ok(rates.components().into())
    }

    fn indicators(&mut self) -> Result<Vec<f64>, Failure> {
        let (scene, setup, inputs) = self.parts()?;
        Ok(scene.engine.sample(scene.acting(setup, inputs.values())).event_indicators().into())
    }

    fn complete_step(&mut self, _log: &Logger) -> Result<Completed, Failure> {
        let (scene, setup, inputs) = self.parts()?;
        scene.complete_step(setup, inputs.values())
    }

    fn arrive_at_event(&mut self) -> Result<(), Failure> {
        let (scene, _, inputs) = self.parts()?;
        scene.arrive(inputs.values());
        Ok(())
    }
}
