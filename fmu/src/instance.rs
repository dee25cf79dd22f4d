//! One instance of the FMU: what each function does, in safe code, whatever a version of the standard calls it.

use crate::condition::{Interface, Model, Present, Stepping};
use crate::failure::Failure;
use crate::fmi3::IntermediateUpdate;
use crate::inputs::Inputs;
use crate::logger::{Logger, Status};
use crate::resources::Archive;
use crate::sensitivity::{by_state, sensitivities};
use crate::setup::Setup;
use crate::shown::Shown;
use crate::snapshot::{self, Snapshots};
use crate::state_machine::Stage;
use crate::variables::{self, Causality, DataType, Source, VARIABLES, Variable};
use model_exchange::check_state;
use rocking::engine::{AdvanceError, DEFAULT_TOLERANCE, Progress};
use rocking::mechanics::load::LOADS;
use rocking::mechanics::state::COMPONENTS;
use rocking::run::validity::{self, ASSUMPTIONS, Found, Limits};
use rocking::{LinearLoad, Load, Parameters, Reactions, Side, Transition, TransitionKind};
use std::collections::BTreeMap;
use std::ffi::{CString, c_char};
use std::mem::MaybeUninit;
use std::path::PathBuf;

pub mod model_exchange;

/// How close two times that mean the same are, in units in the last place, or in parts of the step if that is more.
const SAME_TIME: (f64, f64) = (8.0, 1e-4);

/// One instance.
pub struct Instance {
    logger: Logger,
    events_at_start: bool,
    archive: Archive,
    now: Present,
    snapshots: Snapshots,
    /// The text that the host was shown last, which is its until the next call.
    shown: CString,
    /// How the host is called back within a step, if it wants to be.
    host: Option<IntermediateUpdate>,
    /// While it is asked for inputs: the inputs before, and how long the step is to be, s.
    asked: Option<(Inputs, f64)>,
    /// While it reads outputs: where the step has led.
    led_to: Option<Stage>,
}

/// What came of an event.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Updated {
    /// Whether the structure has overturned, which ends the simulation.
    pub has_ended: bool,
    /// Whether the states are not those that the host set.
    pub has_new_states: bool,
    /// When the next event is that can be foreseen, s.
    pub next_event: Option<f64>,
}

/// The archive with the folder `resources`, if `guid`, the argument `name`, is its.
pub fn open(name: &'static str, guid: &str, resources: PathBuf) -> Result<Archive, Failure> {
    let archive = Archive::open(resources)?;
    let needed = crate::guid(&archive.contents);
    if guid != needed {
        return Err(Failure::WrongGuid { name, given: guid.to_owned(), needed });
    }
    Ok(archive)
}

impl Instance {
    /// Just instantiated from `archive`; `events` says whether events are logged.
    pub fn new(archive: Archive, interface: Interface, events: bool, mut logger: Logger) -> Instance {
        logger.set_events(events);
        let now = Present::new(&archive, interface);
        let (snapshots, shown, host, asked, led_to) = Default::default();
        Instance { logger, events_at_start: events, archive, now, snapshots, shown, host, asked, led_to }
    }

    /// The same, which calls its host back within steps.
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

    /// Tolerance and times; no tolerance means the default.
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

    /// From here on values can be read.
    pub fn enter_initialization_mode(&mut self) -> Result<(), Failure> {
        self.now.stage = Stage::InitializationMode;
        Ok(())
    }

    /// From here on parameters and initial values are fixed, and fit together.
    pub fn exit_initialization_mode(&mut self) -> Result<(), Failure> {
        let (model, setup, ..) = self.now.parts(&self.archive)?;
        for warning in validity::of_parameters(model.engine.structure(), setup.detail) {
            self.logger.warning(&warning);
        }
        match self.now.interface {
            Interface::CoSimulation(_) => self.now.inputs.start(self.now.setup.between()),
            Interface::ModelExchange => {
                let watched = [("peaks", self.now.setup.peaks), ("validity", self.now.setup.validity)];
                for (name, _) in watched.into_iter().filter(|(_, is_watched)| *is_watched) {
                    self.logger.warning(&format!(
                        "{name} = true watches nothing in model exchange, where the motion between two points is the host's: what \
                         it stands for is NaN; use co-simulation"
                    ));
                }
                self.start_outside()?;
            }
        }
        self.now.stage = self.now.interface.first_stage();
        Ok(())
    }

    /// From here on events are handled, at the end of a step or where the host's integrator is.
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
        let (model, setup, inputs, _) = self.now.parts(&self.archive)?;
        let known = model.validity;
        model.transit(setup, inputs.values(), &mut |transition: &Transition| log(logger, transition));
        if setup.validity {
            warn(logger, &known, &model.validity);
        }
        Ok(())
    }

    /// From here on the next step can be made.
    pub fn enter_step_mode(&mut self) -> Result<(), Failure> {
        self.now.stage = Stage::StepComplete;
        Ok(())
    }

    /// Ends the simulation; values can still be read.
    pub fn terminate(&mut self) -> Result<(), Failure> {
        self.now.stage = Stage::Terminated;
        Ok(())
    }

    /// As instantiated. FMU states stay the host's until it frees them.
    pub fn reset(&mut self) -> Result<(), Failure> {
        let record = self.now.record.take();
        self.now = Present { record, ..Present::new(&self.archive, self.now.interface) };
        self.logger.set_events(self.events_at_start);
        Ok(())
    }

    /// All of the values, or none if one is refused.
    pub fn get_real(&mut self, references: &[u32], values: &mut [MaybeUninit<f64>]) -> Result<(), Failure> {
        let (mut is_computed, mut reaction, mut rate) = (false, None, None);
        for reference in references {
            let variable = find(*reference)?;
            match variable.source {
                Source::Input(_) | Source::Parameter(_) | Source::InitialValue(_) | Source::Placement(_) => (),
                Source::Integer(_)
                | Source::Gains
                | Source::Boolean(_)
                | Source::Detail
                | Source::Record
                | Source::Switch(_) => {
                    return Err(Failure::WrongType(variable));
                }
                Source::Reaction(_) => (reaction, is_computed) = (Some(variable), true),
                Source::StateRate(_) => (rate, is_computed) = (Some(variable), true),
                _ => is_computed = true,
            }
        }
        if is_computed {
            self.now.model(&self.archive)?;
        }
        let Present { setup, inputs, model, .. } = &self.now;
        let load = inputs.shown();
        let setting = |source: Source| match source {
            Source::Input(which) => Some((LOADS[which].get)(&load)),
            source => source.setting(setup),
        };
        let Some(model) = model.as_ref().filter(|_| is_computed) else {
            return write(references, values, setting);
        };
        let shown = Shown::new(model, setup, model.load(setup, inputs.values().into()).value);
        if let Some(variable) = reaction {
            let Reactions { R_h, R_v, R_m } = shown.reactions();
            if !(R_h + R_v + R_m).is_finite() {
                return Err(Failure::NoReaction { variable, time: model.engine.motion().time });
            }
        }
        if let Some(variable) = rate
            && !shown.state_rates().is_finite()
        {
            return Err(Failure::NoReaction { variable, time: model.engine.motion().time });
        }
        write(references, values, |source| shown.value(source).or_else(|| setting(source)))
    }

    /// Integers, the numbers of enumerations, or both: those that `is_of_type`.
    pub fn get_numbers<T: From<i32>>(
        &mut self,
        references: &[u32],
        values: &mut [MaybeUninit<T>],
        is_of_type: fn(&DataType) -> bool,
    ) -> Result<(), Failure> {
        self.get_discrete(references, values, is_of_type, T::from)
    }

    /// Booleans.
    pub fn get_boolean<T: From<bool>>(
        &mut self,
        references: &[u32],
        values: &mut [MaybeUninit<T>],
    ) -> Result<(), Failure> {
        let is_boolean = |data_type: &DataType| matches!(data_type, DataType::Boolean);
        self.get_discrete(references, values, is_boolean, |number| T::from(number != 0))
    }

    /// All of the values, or none if one is refused.
    fn get_discrete<T>(
        &mut self,
        references: &[u32],
        values: &mut [MaybeUninit<T>],
        is_of_type: fn(&DataType) -> bool,
        value_of: impl Fn(i32) -> T,
    ) -> Result<(), Failure> {
        let mut is_computed = false;
        for reference in references {
            let variable = find(*reference)?;
            if !is_of_type(&variable.data_type) {
                return Err(Failure::WrongType(variable));
            }
            is_computed |= !matches!(variable.source, Source::Detail | Source::Switch(_));
        }
        if is_computed {
            self.now.model(&self.archive)?;
        }
        for (reference, value) in references.iter().zip(values) {
            value.write(value_of(match find(*reference)?.source {
                Source::Integer(of) | Source::Boolean(of) => of(self.now.model(&self.archive)?.engine.motion()),
                Source::Switch(switch) => (switch.get)(&self.now.setup).into(),
                Source::Gains => i32::try_from(self.now.model(&self.archive)?.validity.gains).unwrap_or(i32::MAX),
                _ => variables::detail_number(self.now.setup.detail),
            }));
        }
        Ok(())
    }

    /// Texts, good until the next call.
    pub fn get_string(&mut self, references: &[u32], values: &mut [MaybeUninit<*const c_char>]) -> Result<(), Failure> {
        for reference in references {
            is_text(find(*reference)?)?;
        }
        self.shown = CString::new(self.now.setup.record.as_bytes()).unwrap_or_default(); // it came without NUL
        values.iter_mut().for_each(|value| _ = value.write(self.shown.as_ptr()));
        Ok(())
    }

    /// All of the values, or none if one is refused. While the host integrates it can set the states, too.
    pub fn set_real(&mut self, references: &[u32], values: &[f64]) -> Result<(), Failure> {
        let (has_started, integrates) = (self.now.stage.has_started(), self.now.stage == Stage::ContinuousTimeMode);
        for (reference, &value) in references.iter().zip(values) {
            let variable = find(*reference)?;
            match variable.source {
                Source::Input(which) => LOADS[which].check(value)?,
                Source::Parameter(_) | Source::InitialValue(_) | Source::Placement(_) if has_started => {
                    return Err(Failure::Fixed(variable));
                }
                Source::Parameter(quantity) => quantity.check(value)?,
                Source::InitialValue(quantity) => quantity.check(value)?,
                Source::Placement(quantity) => quantity.check(value)?,
                _ => match variable.as_state().filter(|_| integrates) {
                    Some(which) => check_state(which, value)?,
                    None => return Err(refused(variable)),
                },
            }
        }
        for (reference, &value) in references.iter().zip(values) {
            let variable = find(*reference)?;
            match (variable.source, &self.asked) {
                (Source::Input(which), Some((_, step))) => self.now.inputs.lead(which, value, *step),
                (Source::Input(which), None) => self.now.inputs.set(which, value),
                (source, _) => match variable.as_state() {
                    Some(which) => self.set_continuous_state(which, value)?,
                    None => {
                        source.set(&mut self.now.setup, value);
                        self.now.model = None;
                    }
                },
            }
        }
        Ok(())
    }

    /// Parameters and initial values are fixed once the simulation has started.
    fn check_not_fixed(&self, variable: &'static Variable) -> Result<(), Failure> {
        if self.now.stage.has_started() { Err(Failure::Fixed(variable)) } else { Ok(()) }
    }

    /// All of the values, or none if one is refused. Of integers and enumerations, the parameter `detail` can be set.
    pub fn set_integer<T: Copy + Into<i64>>(&mut self, references: &[u32], values: &[T]) -> Result<(), Failure> {
        let mut setup = self.now.setup.clone();
        for (reference, &value) in references.iter().zip(values) {
            let variable = find(*reference)?;
            let Source::Detail = variable.source else { return Err(refused(variable)) };
            self.check_not_fixed(variable)?;
            let value = value.into();
            setup.detail = variables::detail(value).ok_or(Failure::NoSuchItem { variable, value })?;
        }
        self.set_up(setup);
        Ok(())
    }

    /// All of the values, or none if one is refused; `truth` says what the value of a name stands for.
    pub fn set_boolean<T: Copy>(
        &mut self,
        references: &[u32],
        values: &[T],
        truth: fn(&'static str, T) -> Result<bool, Failure>,
    ) -> Result<(), Failure> {
        let mut setup = self.now.setup.clone();
        for (reference, &value) in references.iter().zip(values) {
            let variable = find(*reference)?;
            let Source::Switch(switch) = variable.source else { return Err(refused(variable)) };
            self.check_not_fixed(variable)?;
            (switch.set)(&mut setup, truth(variable.name, value)?);
        }
        self.set_up(setup);
        Ok(())
    }

    /// All of the values, or none if one is refused. A record is looked for when it is needed.
    pub fn set_string(&mut self, references: &[u32], values: &[&str]) -> Result<(), Failure> {
        for reference in references {
            let variable = find(*reference)?;
            is_text(variable)?;
            self.check_not_fixed(variable)?;
        }
        if let Some(&record) = values.last() {
            self.set_up(Setup { record: record.into(), ..self.now.setup.clone() });
        }
        Ok(())
    }

    fn set_up(&mut self, setup: Setup) {
        if setup != self.now.setup {
            (self.now.setup, self.now.model) = (setup, None);
        }
    }

    /// Slopes of the inputs over the next step.
    pub fn set_real_input_derivatives(
        &mut self,
        references: &[u32],
        orders: &[i32],
        values: &[f64],
    ) -> Result<(), Failure> {
        for ((reference, &order), &value) in references.iter().zip(orders).zip(values) {
            let variable = find(*reference)?;
            let Source::Input(_) = variable.source else { return Err(Failure::NoInput(variable)) };
            if order != 1 {
                return Err(Failure::WrongOrder { variable, order });
            }
            if !value.is_finite() {
                return Err(Failure::BadSlope { variable, value });
            }
        }
        for (reference, &slope) in references.iter().zip(values) {
            if let Source::Input(which) = find(*reference)?.source {
                self.now.inputs.set_slope(which, slope);
            }
        }
        Ok(())
    }

    /// From the equations of motion, under the present inputs and their slopes: those set for the next step, or those
    /// that the last one followed.
    pub fn get_real_output_derivatives(
        &mut self,
        references: &[u32],
        orders: &[i32],
        values: &mut [MaybeUninit<f64>],
    ) -> Result<(), Failure> {
        let (model, setup, inputs, _) = self.now.parts(&self.archive)?;
        let load = model.load(setup, inputs.now());
        let time = model.engine.motion().time;
        let (outputs, reactions) = model.engine.rates(load);
        let rate = |reference: &u32, order: i32| {
            let variable = find(*reference)?;
            let rate = match variable.source {
                Source::Output(of) => of(&outputs),
                Source::Reaction(of) => of(&reactions),
                Source::Ground => load.slope.a_g,
                _ => return Err(Failure::NoOutput(variable)),
            };
            if order != 1 {
                return Err(Failure::WrongOrder { variable, order });
            }
            Some(rate).filter(|rate| rate.is_finite()).ok_or(Failure::NoRate { variable, time })
        };
        for (reference, order) in references.iter().zip(orders) {
            rate(reference, *order)?;
        }
        for ((reference, order), value) in references.iter().zip(orders).zip(values) {
            value.write(rate(reference, *order)?);
        }
        Ok(())
    }

    /// Of outputs and derivatives of states by inputs and, once the simulation has started, by states and by time, at which
    /// the record is another; in initialization mode by parameters and initial values as well, of calculated
    /// parameters, too ([`sensitivity`](crate::sensitivity)). The outputs are affine in the inputs, so that a difference
    /// is the derivative; it is taken over a change of the size of gravity and the strut's force, which keeps its
    /// digits.
    pub fn get_directional_derivative(
        &mut self,
        unknowns: &[u32],
        knowns: &[u32],
        seed: &[f64],
        values: &mut [MaybeUninit<f64>],
    ) -> Result<(), Failure> {
        let found = self.directional_derivative(unknowns, knowns, seed)?;
        values.iter_mut().zip(found).for_each(|(value, derivative)| _ = value.write(derivative));
        Ok(())
    }

    fn directional_derivative(&mut self, unknowns: &[u32], knowns: &[u32], seed: &[f64]) -> Result<Vec<f64>, Failure> {
        let is_initializing = self.now.stage == Stage::InitializationMode;
        let mut direction = Load::default();
        let has_started = self.now.stage.has_started();
        let (mut of_setup, mut of_state) = (BTreeMap::<u32, f64>::new(), [0.0; COMPONENTS.len()]);
        let mut of_time = 0.0;
        for (reference, &value) in knowns.iter().zip(seed) {
            let variable = find(*reference)?;
            if !value.is_finite() {
                return Err(Failure::BadSlope { variable, value });
            }
            match variable.source {
                Source::Input(which) if !self.now.inputs.acts_at_once(which) => (),
                Source::Input(which) => {
                    let sum = (LOADS[which].get)(&direction) + value;
                    (LOADS[which].set)(&mut direction, sum);
                }
                Source::Parameter(_) | Source::InitialValue(_) | Source::Placement(_) if is_initializing => {
                    *of_setup.entry(*reference).or_default() += value;
                }
                Source::Time if has_started => of_time += value,
                _ => match variable.as_state().filter(|_| has_started) {
                    Some(which) => of_state[which] += value,
                    None => return Err(Failure::NoKnown(variable)),
                },
            }
        }
        let unknown = |reference: &u32| {
            let variable = find(*reference)?;
            match variable.source {
                Source::Output(_) | Source::Reaction(_) | Source::StateRate(_) | Source::Ground => Ok(variable),
                Source::Impulse(_) => Ok(variable), // which events alone change
                Source::Derived(_) | Source::RecordDuration if is_initializing => Ok(variable),
                _ => Err(Failure::NoOutput(variable)),
            }
        };
        let unknowns = unknowns.iter().map(unknown).collect::<Result<Vec<_>, _>>()?;

        let (model, setup, inputs, _) = self.now.parts(&self.archive)?;
        let inputs = inputs.values().into();
        let mut by_states = vec![0.0; unknowns.len()];
        for (which, seed) in of_state.into_iter().enumerate().filter(|(_, seed)| *seed != 0.0) {
            let by = by_state(model, setup, inputs, &unknowns, which)?;
            by_states.iter_mut().zip(by).for_each(|(sum, by)| *sum += seed * by);
        }
        let model = &*model;
        let Model { engine, ground, .. } = model;
        if of_time != 0.0 {
            direction.a_g += of_time * model.load(setup, LinearLoad::default()).slope.a_g;
        }
        let time = engine.motion().time;
        let &Parameters { m, g, .. } = engine.structure().parameters();
        let before = Shown::new(model, setup, Load::default());
        let size = direction.a_g.abs().max(direction.F_t.abs() / m) / (g + before.outputs.a_t.abs());
        let of_size_one = |part: f64| if size > 0.0 { part / size } else { 0.0 };
        let after = Shown::new(model, setup, Load { a_g: of_size_one(direction.a_g), F_t: of_size_one(direction.F_t) });
        let change = |of: &&Variable| after.value(of.source).zip(before.value(of.source)).map_or(0.0, |(a, b)| a - b);
        let mut found: Vec<_> = unknowns.iter().zip(by_states).map(|(of, by)| size * change(of) + by).collect();
        for (reference, seed) in of_setup {
            let by = sensitivities(setup, ground, inputs, &unknowns, find(reference)?)?;
            found.iter_mut().zip(by).for_each(|(sum, by)| *sum += seed * by);
        }
        if let Some(at) = found.iter().position(|derivative| !derivative.is_finite()) {
            return Err(Failure::NoRate { variable: unknowns[at], time });
        }
        Ok(found)
    }

    /// Adjoint of the same: of each known the derivatives of the unknowns by it, weighted with `seed` and summed.
    pub fn get_adjoint_derivative(
        &mut self,
        unknowns: &[u32],
        knowns: &[u32],
        seed: &[f64],
        values: &mut [MaybeUninit<f64>],
    ) -> Result<(), Failure> {
        for (unknown, &value) in unknowns.iter().zip(seed) {
            if !value.is_finite() {
                return Err(Failure::BadSlope { variable: find(*unknown)?, value });
            }
        }
        let mut sums = Vec::with_capacity(knowns.len());
        for known in knowns {
            let column = self.directional_derivative(unknowns, &[*known], &[1.0])?;
            sums.push(column.iter().zip(seed).map(|(part, weight)| part * weight).sum());
        }
        values.iter_mut().zip(sums).for_each(|(value, sum)| _ = value.write(sum));
        Ok(())
    }

    /// How a step over `step` (s) from `point` (s) begins: its host is to be asked for the inputs at its end, outside of
    /// any call, where it wants to be. Then [`Instance::do_step`] is the rest.
    pub(crate) fn begin_step(&mut self, point: f64, step: f64) -> Result<Option<IntermediateUpdate>, Failure> {
        let (model, setup, inputs, stage) = self.now.parts(&self.archive)?;
        check_step(model, setup, point, step)?;
        let asked = self.host.filter(|host| host.sets_inputs);
        if asked.is_some() {
            self.asked = Some((*inputs, step));
            *stage = Stage::IntermediateUpdateMode;
        }
        Ok(asked)
    }

    /// How a step ends: its host is to read what it has led to, outside of any call, where it wants to. Then
    /// [`Instance::end_step`] is the rest.
    pub(crate) fn show_step(&mut self) -> Option<IntermediateUpdate> {
        let told = self.host.filter(|host| host.gets_outputs);
        if told.is_some() {
            self.led_to = Some(std::mem::replace(&mut self.now.stage, Stage::IntermediateOutputs));
        }
        told
    }

    /// The host has read.
    pub(crate) fn end_step(&mut self) {
        self.now.stage = self.led_to.take().unwrap_or(self.now.stage);
    }

    /// From `point` (s), which is where the instance is, over `step` (s), or to the first transition if that is to be
    /// handed over. The host's clock is right: its point becomes the instance's.
    pub fn do_step(&mut self, point: f64, step: f64) -> Result<Progress, Failure> {
        let asked = self.asked.take();
        if asked.is_some() {
            self.now.stage = Stage::StepComplete;
        }
        let result = self.advance(point, step);
        if let (Err(_), Some((inputs, _))) = (&result, asked) {
            self.now.inputs = inputs;
        }
        result
    }

    fn advance(&mut self, point: f64, step: f64) -> Result<Progress, Failure> {
        let (logger, stops) = (&self.logger, self.now.interface.stepping().hands_over());
        let (model, setup, inputs, stage) = self.now.parts(&self.archive)?;
        check_step(model, setup, point, step)?;
        let load = inputs.over(step);
        let last = load.at(step);
        for quantity in &LOADS {
            quantity.check((quantity.get)(&last)).map_err(Failure::InputRunsOut)?;
        }

        let time = model.engine.motion().time;
        model.engine.set_time(point);
        model.engine.stop_at_transitions(stops);
        let known = setup.validity.then_some(model.validity);
        let mut watch = |transition: &Transition| log(logger, transition);
        let result = if stops {
            model.advance_to_transition(setup, step, load, &mut watch)
        } else {
            model.advance(setup, step, load, &mut watch)
        };
        match result {
            Ok(progress) => {
                let reached = model.engine.motion().time;
                let passed = if reached == point + step { step } else { reached - point };
                if passed > 0.0 {
                    inputs.pass(load, passed, reached < point + step);
                }
                known.iter().for_each(|known| warn(logger, known, &model.validity));
                if progress == Progress::Overturned {
                    *stage = Stage::StepFailed;
                }
                Ok(progress)
            }
            Err(error) => {
                model.engine.set_time(time);
                if matches!(error, AdvanceError::Singular { .. }) {
                    *stage = Stage::Error;
                }
                Err(error.into())
            }
        }
    }

    /// Whether its host takes a step that ends early.
    pub fn may_return_early(&self) -> bool {
        self.now.interface.stepping().early_return
    }

    /// Where it is, s.
    pub fn time(&mut self) -> Result<f64, Failure> {
        Ok(self.now.model(&self.archive)?.engine.motion().time)
    }

    /// Whether the structure has overturned, which ends the simulation.
    pub fn has_overturned(&mut self) -> Result<bool, Failure> {
        Ok(self.now.model(&self.archive)?.has_overturned())
    }

    /// Keeps the condition: into the state `handle`, or into a new one for 0.
    pub fn get_fmu_state(&mut self, handle: usize) -> Result<usize, Failure> {
        self.snapshots.keep(handle, self.now.condition())
    }

    /// Goes back to the state `handle`.
    pub fn set_fmu_state(&mut self, handle: usize) -> Result<(), Failure> {
        self.now.go_to(self.snapshots.find(handle)?, &self.archive)
    }

    /// Forgets the state `handle`.
    pub fn free_fmu_state(&mut self, handle: usize) -> Result<(), Failure> {
        self.snapshots.free(handle)
    }

    /// The state `handle` as bytes.
    pub fn serialize_fmu_state(&self, handle: usize) -> Result<Vec<u8>, Failure> {
        Ok(snapshot::serialize(self.snapshots.find(handle)?))
    }

    /// Keeps what `bytes` hold: into the state `handle`, or into a new one for 0.
    pub fn deserialize_fmu_state(&mut self, bytes: &[u8], handle: usize) -> Result<usize, Failure> {
        self.snapshots.keep(handle, snapshot::deserialize(bytes)?)
    }
}

pub(crate) fn find(reference: u32) -> Result<&'static Variable, Failure> {
    let Some(variable) = VARIABLES.get(reference as usize) else { return Err(Failure::UnknownReference(reference)) };
    Ok(variable)
}

/// Writes the values of what has been found to have one.
#[inline]
fn write(
    references: &[u32],
    values: &mut [MaybeUninit<f64>],
    value: impl Fn(Source) -> Option<f64>,
) -> Result<(), Failure> {
    for (reference, place) in references.iter().zip(values) {
        place.write(value(find(*reference)?.source).expect("all that is asked for is a Real and has been computed"));
    }
    Ok(())
}

/// Refuses what is no String.
fn is_text(variable: &'static Variable) -> Result<(), Failure> {
    if let Source::Record = variable.source { Ok(()) } else { Err(Failure::WrongType(variable)) }
}

/// Why a function of another type cannot set `variable`.
pub(crate) fn refused(variable: &'static Variable) -> Failure {
    match variable.causality {
        Causality::Input | Causality::Parameter => Failure::WrongType(variable),
        Causality::Output | Causality::CalculatedParameter | Causality::Local | Causality::Independent => {
            Failure::NotSettable(variable)
        }
    }
}

/// Whether `model` can step from `point` (s) over `step` (s).
fn check_step(model: &Model, setup: &Setup, point: f64, step: f64) -> Result<(), Failure> {
    let time = model.engine.motion().time;
    let until = point + step;
    if !(step > 0.0 && step.is_finite()) {
        return Err(Failure::BadStep { step, time });
    }
    if !is_same_time(point, time, step) {
        return Err(Failure::WrongPoint { given: point, time });
    }
    if until <= point {
        return Err(Failure::BadStep { step, time });
    }
    match setup.stop_time {
        Some(stop) if until > stop && !is_same_time(until, stop, step) => Err(Failure::PastStop { until, stop }),
        _ => Ok(()),
    }
}

/// Hosts add up steps or multiply them: their times (s) differ in the last digits.
fn is_same_time(a: f64, b: f64, step: f64) -> bool {
    let (places, part) = SAME_TIME;
    let rounding = places * (b.abs().next_up() - b.abs());
    // never so far that a step could be missed
    (a - b).abs() <= rounding.max(part * step).min(0.5 * step)
}

/// Says which limits have been passed that were not when no more than `known` was found.
fn warn(logger: &Logger, known: &Found, found: &Found) {
    let is_new = |which: &usize| known.worst[*which].first_beyond.is_none();
    (0..ASSUMPTIONS.len())
        .filter(is_new)
        .filter_map(|which| found.warning(which, &Limits::default()))
        .for_each(|warning| logger.warning(&warning));
}

fn log(logger: &Logger, transition: &Transition) {
    match transition.kind {
        TransitionKind::Settling => logger.warning(&format!(
            "{}; too many transitions within one vibration period: contact is held for the rest of it",
            describe(transition)
        )),
        _ => logger.event(|| describe(transition)),
    }
}

fn describe(transition: &Transition) -> String {
    let Transition { time, kind, before, after } = transition;
    let side = |side| if side == Side::Left { "left" } else { "right" };
    let what = match *kind {
        TransitionKind::Uplift(pivot) => format!("uplift, rocking about the {} edge", side(pivot)),
        TransitionKind::Impact(pivot) => format!("impact, rocking on about the {} edge", side(pivot)),
        TransitionKind::Landing | TransitionKind::Settling => "landing in full contact".to_owned(),
        TransitionKind::Overturning(pivot) => format!("overturning about the {} edge", side(pivot)),
    };
    format!(
        "t = {time} s: {what}; u = {} m, u_dot = {} m/s (before: {}), theta_dot = {} rad/s (before: {})",
        after.u, after.u_dot, before.u_dot, after.theta_dot, before.theta_dot
    )
}

#[cfg(test)]
mod tests {
    use super::*;
    use rocking::State;
    use std::cell::RefCell;
    use std::rc::Rc;

    /// A result that is not the model's alone is said to be so, even if no events are asked for.
    #[test]
    fn contact_held_by_force_is_a_warning() {
        let sent = Rc::new(RefCell::new(Vec::new()));
        let logger = Logger::new(Box::new({
            let sent = Rc::clone(&sent);
            move |status, category, text| sent.borrow_mut().push((status, category.to_owned(), text.to_owned()))
        }));
        let before = State { u: 0.001, u_dot: 0.25, theta: 0.0, theta_dot: -0.5 };
        let after = State { u_dot: -0.75, theta_dot: 0.0, ..before };
        log(&logger, &Transition { time: 1.5, kind: TransitionKind::Landing, before, after });
        log(&logger, &Transition { time: 2.5, kind: TransitionKind::Settling, before, after });
        let text = "t = 2.5 s: landing in full contact; u = 0.001 m, u_dot = -0.75 m/s (before: 0.25), theta_dot = 0 \
                     rad/s (before: -0.5); too many transitions within one vibration period: contact is held for the \
                     rest of it";
        assert_eq!(*sent.borrow(), [(Status::Warning, c"logStatusWarning".to_owned(), text.to_owned())]);
    }
}
