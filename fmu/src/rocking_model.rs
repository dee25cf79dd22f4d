//! The structure on its ground as a model for FMI: how values are read and set, and how a simulation goes.

use crate::failure::Refusal;
use crate::ground::{CachedRecord, RecordDigest};
use crate::inputs::Inputs;
use crate::motion_log::{log, warn, warn_of_stairs};
use crate::resources::{Archive, Contents};
use crate::scene::{HostMotion, Scene, Tell};
use crate::setup::Setup;
use crate::shown::Shown;
use crate::source::Source;
use crate::variables::VariableTable;
use crate::{BUILD, guid};
use fmi_unit::snapshot::{read_state, write_state};
use fmi_unit::variables::state_references;
use fmi_unit::{
    Completed, Experiment, Failure, Interface, Logger, Model, StepEnd, StepRequest, Update, Value, Variable,
};
use rocking::engine::DEFAULT_TOLERANCE;
use rocking::run::Runs;
use rocking::run::fall::FallNumbers;
use rocking::run::ground_motion::Elapsed;
use rocking::run::validity::{Findings, of_structure};
use rocking::structure::ground::MOST_POINTS;
use rocking::{Modes, Motion, OutOfRange, State};
use serde::{Deserialize, Serialize};
use std::path::Path;
use std::sync::Arc;

/// An instance between two calls, whose structure has the lateral coordinates `Q`.
pub struct RockingModel<Q: Runs = f64> {
    pub(crate) table: VariableTable,
    archive: Archive,
    pub(crate) setup: Setup,
    pub(crate) inputs: Inputs,
    /// Until the start it is built when an output is asked for, and dropped when what it was built from is set anew.
    scene: Option<Scene<Q>>,
    has_started: bool,
    /// The record that was followed last, which is not parsed anew for another run.
    kept: Option<CachedRecord>,
    /// Whether the host has been warned that it holds a ground acceleration from sample to sample.
    told_of_stairs: bool,
}

/// An instance's part of an FMU state: the settings before the start, the inputs from the present time on, and the course of a
/// simulation that has started. An instance continues from it to the same bits.
pub type Condition<Q> = (Setup, Inputs, Option<Course<Q>>);

/// How far a simulation has come.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Course<Q: Runs = f64> {
    /// The motion; the host's, if the host integrates.
    pub motion: Motion<Q>,
    /// The knowledge beside the motion, if the host integrates.
    pub outside: Option<HostMotion<Q>>,
    /// Time since the start, on ground that follows a record.
    pub elapsed: Elapsed,
    /// Peaks so far, if they are watched.
    pub peaks: FallNumbers,
    /// Which limits of the model have been passed so far, if they are watched.
    pub validity: Findings,
    pub record: Option<RecordDigest>,
}

impl<Q: Runs> RockingModel<Q> {
    pub fn new(archive: Archive) -> RockingModel<Q> {
        let (table, setup) = (VariableTable::new(&archive.contents), Setup::new(&archive.contents));
        let inputs = Inputs::new(&archive.contents.structure);
        RockingModel {
            table,
            archive,
            setup,
            inputs,
            scene: None,
            has_started: false,
            kept: None,
            told_of_stairs: false,
        }
    }

    /// The structure in motion, or at its start with what has been set so far; its record is in the archive, or on disk.
    pub(crate) fn scene(&mut self) -> Result<&mut Scene<Q>, Refusal> {
        self.parts().map(|(scene, ..)| scene)
    }

    /// The structure with the setup and the inputs.
    #[inline]
    pub(crate) fn parts(&mut self) -> Result<(&mut Scene<Q>, &Setup, &mut Inputs), Refusal> {
        if self.scene.is_none() {
            self.build()?;
        }
        let RockingModel { setup, inputs, scene, .. } = self;
        Ok((scene.as_mut().expect("it is built"), setup, inputs))
    }

    #[cold]
    fn build(&mut self) -> Result<(), Refusal> {
        self.scene = Some(Scene::new(&self.setup, &self.archive, &mut self.kept)?);
        Ok(())
    }

    pub(crate) fn sources_of(&self, references: &[u32]) -> Vec<Source> {
        references.iter().map(|reference| self.table.sources[*reference as usize]).collect()
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

    /// The refusal of a step at whose end an input is out of its range.
    #[cold]
    fn runs_out(&self, which: usize, &OutOfRange { value, unit, min, max, .. }: &OutOfRange) -> Failure {
        let Variable { name, description, .. } = &self.table.variables[which];
        let (name, description) = (name.to_string(), description.to_string());
        Refusal::InputRunsOut(Failure::OutOfRange { name, value, unit, min, max, description }).into()
    }

    /// Lets the ground move vertically from now on if one of `values` is not 0 and moves it so.
    #[inline]
    fn admit(&mut self, references: &[u32], values: &[f64]) -> Result<(), Failure> {
        let moves = |(reference, value): (&u32, &f64)| *value != 0.0 && self.inputs.is_vertical(*reference as usize);
        if references.iter().zip(values).any(moves) { self.admit_vertical() } else { Ok(()) }
    }
}

/// A count as FMI has it.
fn integer(count: u64) -> Value {
    Value::Integer(i32::try_from(count).unwrap_or(i32::MAX))
}

/// The value of a real number that is no output: one that is `shown`, or set.
#[cold]
#[inline(never)]
fn other<Q: Runs>(shown: &Shown<Q>, inputs: &Inputs, source: Source) -> f64 {
    shown.value(source).unwrap_or_else(|| setting(shown.setup, inputs, source))
}

/// The value of a real number that the host sets.
fn setting(setup: &Setup, inputs: &Inputs, source: Source) -> f64 {
    match source {
        Source::Input(which) => inputs.shown(which),
        source => source.setting(setup).expect("a real number that is not computed is set"),
    }
}

impl<Q: Runs> Model for RockingModel<Q> {
    fn open(resources: &Path) -> Result<Box<dyn Model>, Failure> {
        let archive = Archive::open(resources.to_owned()).map_err(Refusal::from)?;
        Ok(match archive.contents.structure.one() {
            Some(_) => Box::new(RockingModel::<f64>::new(archive)),
            None => Box::new(RockingModel::<Modes>::new(archive)),
        })
    }

    fn token(&self) -> String {
        guid(&self.archive.contents)
    }

    /// States of one mass have all its parameters; those of many masses have not.
    fn build(&self) -> String {
        let structure = &self.archive.contents.structure;
        if structure.one().is_some() { BUILD.to_owned() } else { guid(&Contents::from(structure.clone())) }
    }

    fn variables(&self) -> Arc<[Variable]> {
        Arc::clone(&self.table.variables)
    }

    fn get(&mut self, reference: u32) -> Result<Value, Failure> {
        let source = self.table.sources[reference as usize];
        Ok(match source {
            Source::Phase => {
                let motion = self.scene()?.engine.motion();
                Value::Integer(1 + motion.phase.shown(motion.state.theta).number() as i32)
            }
            Source::Transitions => integer(self.scene()?.engine.motion().transitions),
            Source::Overturned => Value::Boolean(self.scene()?.has_overturned()),
            Source::Gains => integer(self.scene()?.validity.gains),
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
            let sources = self.sources_of(references);
            if sources.iter().all(|source| source.is_set()) {
                let settings = sources.into_iter().map(|source| setting(&self.setup, &self.inputs, source));
                values.iter_mut().zip(settings).for_each(|(value, setting)| *value = setting);
                return Ok(());
            }
            self.build()?;
        }
        let RockingModel { table: VariableTable { sources, .. }, setup, inputs, scene: Some(scene), .. } = self else {
            unreachable!("it is built")
        };
        let load = scene.load(setup, inputs.values::<Q>(scene.engine.structure()).into()).value;
        let (outputs, mut shown, sources): (_, _, &[Source]) = (scene.engine.outputs(load), None, sources);
        for (reference, value) in references.iter().zip(values) {
            *value = match &sources[*reference as usize] {
                Source::Output(of) => outputs(*of),
                source => other(shown.get_or_insert_with(|| Shown::new(scene, setup, load)), inputs, *source),
            };
        }
        drop(outputs);
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
        self.admit(references, values)?;
        references.iter().zip(values).for_each(|(reference, value)| self.inputs.set(*reference as usize, *value));
        Ok(())
    }

    #[inline(always)]
    fn set_slopes(&mut self, references: &[u32], slopes: &[f64]) -> Result<(), Failure> {
        self.admit(references, slopes)?;
        references.iter().zip(slopes).for_each(|(reference, slope)| self.inputs.set_slope(*reference as usize, *slope));
        Ok(())
    }

    fn lead(&mut self, reference: u32, value: f64, step: f64) -> Result<(), Failure> {
        self.admit(&[reference], &[value])?;
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
            assumed.iter().for_each(|assumed| logger.warning(|| assumed.clone()));
        }
        let g = scene.engine.structure().base().g;
        for doubt in scene.ground.iter().flat_map(|ground| rocking_records::doubts(ground, g)) {
            logger.warning(|| format!("the record: {doubt}"));
        }
        let structure = scene.engine.structure();
        let doubts = [structure.doubts(), of_structure(structure, setup.detail)].concat();
        doubts.into_iter().for_each(|doubt| logger.warning(|| doubt));
        match interface {
            Interface::CoSimulation(_) => {
                inputs.start(setup.between());
                scene.rehearse(inputs.now(scene.engine.structure()));
            }
            Interface::ModelExchange => {
                let watched = [("peaks", setup.peaks), ("validity", setup.validity)];
                for (name, _) in watched.into_iter().filter(|(_, is_watched)| *is_watched) {
                    logger.warning(|| {
                        format!(
                            "{name} = true has no effect in model exchange, where the host integrates: the values are \
                             NaN; use co-simulation"
                        )
                    });
                }
                scene.leave_to_host(inputs.values(scene.engine.structure()));
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
    fn advance(&mut self, step: StepRequest, logger: &Logger) -> Result<StepEnd, Failure> {
        let StepRequest { start: point, duration: step, stops_at_events: stops } = step;
        let (scene, setup, inputs) = self.parts()?;
        let load = match inputs.over(step, scene.engine.structure()) {
            Ok(load) => load,
            Err((which, of)) => return Err(self.runs_out(which, &of)),
        };
        let time = scene.engine.motion().time;
        scene.engine.set_time(point);
        scene.engine.set_stops(stops);
        let known = setup.validity.then_some(scene.validity);
        let shows_u = scene.shows_u();
        let told: &mut Tell<Q> = &mut |transition| log(logger, shows_u, transition);
        let result = if stops {
            scene.advance_to_transition(setup, step, &load, told)
        } else {
            scene.advance(setup, step, &load, told)
        };
        let progress = result.map_err(|error| {
            scene.engine.set_time(time);
            Refusal::from(error)
        })?;
        let reached = scene.engine.motion().time;
        let ended_early = reached < point + step;
        if !ended_early {
            inputs.pass(step, false);
        } else if reached > point {
            inputs.pass(reached - point, true);
        }
        known.iter().for_each(|known| warn(logger, known, &scene.validity));
        if inputs.makes_stairs() && !self.told_of_stairs {
            self.told_of_stairs = true;
            warn_of_stairs(logger, reached);
        }
        Ok(match progress {
            rocking::Progress::Complete => StepEnd::Complete,
            rocking::Progress::Transition => StepEnd::Event,
            rocking::Progress::Overturned => StepEnd::Ended,
        })
    }

    fn update(&mut self, logger: &Logger) -> Result<Update, Failure> {
        let (scene, setup, inputs) = self.parts()?;
        if scene.outside.is_some() {
            return scene.catch_up(setup, inputs.values(scene.engine.structure()), logger);
        }
        let known = setup.validity.then_some(scene.validity);
        let load = inputs.values(scene.engine.structure());
        let shows_u = scene.shows_u();
        scene.transit(setup, load, &mut |transition| log(logger, shows_u, transition));
        known.iter().for_each(|known| warn(logger, known, &scene.validity));
        Ok(Update::default())
    }

    fn ending(&mut self) -> Result<Option<String>, Failure> {
        let scene = self.scene()?;
        let (time, fall) = (scene.engine.motion().time, scene.peaks.fall());
        let fall =
            fall.map_or(String::new(), |fall| format!("; its fall began at t = {fall} s; peaks are those before"));
        Ok(scene.has_overturned().then(|| format!("the structure overturned at t = {time} s{fall}")))
    }

    fn state(&self, bytes: &mut Vec<u8>) {
        let RockingModel { setup, inputs, scene, has_started, .. } = self;
        let course = scene.as_ref().filter(|_| *has_started).map(|scene| Course {
            motion: *scene.engine.motion(),
            outside: scene.outside,
            elapsed: scene.elapsed,
            peaks: scene.peaks.numbers(),
            validity: scene.validity,
            record: scene.digest(),
        });
        write_state(&(setup, inputs, course), bytes);
    }

    /// The scene is built anew only for another setup.
    fn restore(&mut self, bytes: &[u8], has_started: bool) -> Result<(), Failure> {
        let (setup, inputs, course): Condition<Q> = read_state(bytes)?;
        let other = || Failure::BadBytes("it is of another structure");
        let sizes = |of: &Setup| (of.numbers.len(), of.initial.u.len(), of.initial.u_dot.len());
        let is_its = course.is_some() == has_started && sizes(&setup) == sizes(&self.setup);
        let inputs = inputs.in_place_of(&self.inputs).filter(|_| is_its).ok_or_else(other)?;
        let mut scene = None;
        if let Some(course) = course {
            let is_the_same = |scene: &&mut Scene<Q>| self.setup == setup && scene.digest() == course.record;
            let found = match self.scene.as_mut().filter(is_the_same) {
                Some(scene) => scene,
                None => scene.insert(Scene::new(&setup, &self.archive, &mut self.kept)?),
            };
            if found.digest() != course.record {
                let [record, record_v] = [&setup.record, &setup.record_v].map(|text| text.to_string());
                return Err(Refusal::OtherRecord { record, record_v }.into());
            }
            let known = course.outside.map(|outside| outside.known.motion);
            let is_its = known.iter().chain([&course.motion]).all(|motion| found.engine.admits(motion));
            found.peaks = found.peaks.with_numbers(course.peaks).filter(|_| is_its).ok_or_else(other)?;
            found.engine.set_motion(course.motion);
            (found.elapsed, found.outside, found.validity) = (course.elapsed, course.outside, course.validity);
            scene = scene.or_else(|| self.scene.take());
        }
        self.has_started = has_started;
        self.told_of_stairs &= has_started;
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
        let RockingModel { setup, scene: Some(scene), .. } = self else { return };
        scene.go_to(setup, time, is_at_event);
    }

    fn states(&mut self) -> Result<Vec<f64>, Failure> {
        Ok(self.scene()?.states().collect())
    }

    fn set_states(&mut self, states: &[f64]) -> Result<(), Failure> {
        let variables = self.variables();
        let name = |which| {
            variables[state_references(&variables).nth(which).expect("it is a state") as usize].name.to_string()
        };
        self.scene()?.take_states(states, name)
    }

    fn nominals(&mut self) -> Result<Vec<f64>, Failure> {
        let scene = self.scene()?;
        let structure = scene.engine.structure();
        let settled = [structure.foundation().map_or(0.0, |ground| ground.y_s.abs()); MOST_POINTS];
        let usual = scene.components(structure.usual(), &settled);
        Ok(usual.map(|of| if of > 0.0 { of } else { 1.0 }).collect()) // 1 of what does not move at this level
    }

    fn state_rates(&mut self) -> Result<Vec<f64>, Failure> {
        let (scene, setup, inputs) = self.parts()?;
        let sample = scene.engine.sample(scene.acting(setup, inputs.values(scene.engine.structure())));
        let rates = sample.state_rates();
        if !rates.is_finite() {
            let &Motion { time, state: State { u, theta, .. }, .. } = scene.engine.motion();
            return Err(Refusal::NoStateRates { time, u: u.total(), theta }.into());
        }
        Ok(scene.components(rates, &sample.settling()).collect())
    }

    fn indicators(&mut self) -> Result<Vec<f64>, Failure> {
        let (scene, setup, inputs) = self.parts()?;
        Ok(scene.engine.event_indicators(scene.acting(setup, inputs.values(scene.engine.structure()))).into())
    }

    fn complete_step(&mut self, _log: &Logger) -> Result<Completed, Failure> {
        let (scene, setup, inputs) = self.parts()?;
        scene.complete_step(setup, inputs.values(scene.engine.structure()))
    }

    fn arrive_at_event(&mut self) -> Result<(), Failure> {
        let (scene, _, inputs) = self.parts()?;
        scene.arrive(inputs.values(scene.engine.structure()));
        Ok(())
    }
}
