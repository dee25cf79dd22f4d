//! One instance of the FMU, in safe code that knows no version of the standard: it goes from stage to stage, checks what a
//! call asks of the model, and keeps FMU states.

use crate::failure::Failure;
use crate::interface::{Interface, IntermediateUpdate, Stepping};
use crate::logger::Logger;
use crate::model::{Completed, Experiment, Model, StepEnd, StepRequest, Update};
use crate::snapshot::{Snapshot, Snapshots};
use crate::state_machine::{Stage, Stages};
use crate::variables::{Causality, DataType, Role, Value, Variable, state_references};
use std::ffi::{CString, c_char};
use std::sync::Arc;

/// How far apart rounding leaves two times that are the same, as a part of the step, or in units in the last place.
const ROUNDING: (f64, f64) = (1e-9, 8.0);

/// How far the host's time may be from the FMU's, as a part of the step, or of the time, which many hosts keep as a float32.
const SAME_TIME: (f64, f64) = (1e-3, 2.0 * f32::EPSILON as f64);

/// Times that a host sets without completing a step, before it is warned. No solver tries as many within one step.
const MANY_TRIALS: u32 = 1000;
const TRIALS: &str = "the host integrates without completing steps: call CompletedIntegratorStep after every step";

/// One instance.
pub struct Instance {
    /// The model, for what needs no check but that of the stage.
    pub(crate) model: Box<dyn Model>,
    variables: Arc<[Variable]>,
    /// The value reference that the host has for the variable at position 0.
    first: u32,
    are_real: Vec<bool>,
    /// The range of each real input; no number is in that of other variables.
    ranges: Vec<(f64, f64)>,
    pub(crate) interface: Interface,
    pub(crate) stage: Stage,
    experiment: Experiment,
    pub(crate) logger: Logger,
    /// The log categories that were on when the instance was made.
    on_at_start: [bool; 2],
    handling: EventHandling,
    /// The model's state, as it was made.
    at_start: Vec<u8>,
    pub(crate) snapshots: Snapshots,
    /// Values on their way between the host and the model.
    reals: Vec<f64>,
    /// The positions of variables whose value references the host gives.
    pub(crate) positions: Vec<u32>,
    /// The texts that the host was given last, which it may read until the next call.
    shown: Vec<CString>,
    /// The host that is called back within steps, if there is one.
    host: Option<IntermediateUpdate>,
    /// While the host is asked for inputs: the duration of the step, s.
    asked: Option<f64>,
    /// While the host reads outputs: the stage that the step has led to.
    led_to: Option<Stage>,
}

/// How a host that integrates has handled events since the start.
#[derive(Default)]
struct EventHandling {
    /// Whether a completed step has requested event mode, which the host has not entered since.
    awaits_event: bool,
    /// How often the host has set time since the last completed step or event.
    trials: u32,
    /// Whether the host has completed a step or entered event mode.
    has_begun: bool,
    is_warned: bool,
}

/// The variable at the `position`, if the value reference of the variable at position 0 is `first`.
#[inline]
pub(crate) fn find(variables: &[Variable], position: u32, first: u32) -> Result<&Variable, Failure> {
    let last = variables.len() - 1 + first as usize;
    let reference = position.wrapping_add(first);
    variables.get(position as usize).ok_or(Failure::UnknownReference { reference, first, last })
}

fn range(variable: &Variable) -> (f64, f64) {
    let of_input = variable.data_type.limits().filter(|_| variable.causality == Causality::Input);
    of_input.unwrap_or((f64::INFINITY, f64::NEG_INFINITY))
}

impl Instance {
    /// What makes an instance of `model`, just instantiated, of its logger, without calling the model. Its value references are
    /// `first` and more.
    pub(crate) fn of(
        model: Box<dyn Model>,
        first: u32,
        interface: Interface,
        host: Option<IntermediateUpdate>,
    ) -> impl FnOnce(Logger) -> Instance {
        let variables = model.variables();
        let mut at_start = Vec::new();
        model.state(&mut at_start);
        move |logger| Instance {
            model,
            first,
            are_real: variables.iter().map(|variable| variable.data_type.limits().is_some()).collect(),
            ranges: variables.iter().map(range).collect(),
            interface,
            stage: Stage::Instantiated,
            experiment: Experiment::default(),
            on_at_start: logger.on,
            logger,
            handling: EventHandling::default(),
            at_start,
            snapshots: Snapshots::default(),
            reals: vec![0.0; variables.len()],
            positions: Vec::with_capacity(variables.len()),
            shown: Vec::new(),
            host,
            asked: None,
            led_to: None,
            variables,
        }
    }

    #[inline]
    fn find(&self, reference: u32) -> Result<&Variable, Failure> {
        find(&self.variables, reference, self.first)
    }

    /// How many variables play a role.
    pub(crate) fn count(&self, is_one: fn(&Role) -> bool) -> usize {
        self.variables.iter().filter(|variable| is_one(&variable.role)).count()
    }

    pub(crate) fn set_up(&mut self, experiment: Experiment) -> Result<(), Failure> {
        let Experiment { tolerance, start_time, stop_time } = experiment;
        let refuse = |name, value, limit: &str| Err(Failure::Experiment { name, value, limit: limit.to_owned() });
        if let Some(tolerance) = tolerance.filter(|tolerance| !(*tolerance > 0.0 && *tolerance < 1.0)) {
            return refuse("tolerance", tolerance, "between 0 and 1, such as 1e-9");
        }
        if !start_time.is_finite() {
            return refuse("startTime", start_time, "finite");
        }
        if let Some(stop) = stop_time.filter(|stop| !(*stop >= start_time && stop.is_finite())) {
            return refuse("stopTime", stop, &format!("finite and not before startTime = {start_time} s"));
        }
        self.model.set_up(&experiment);
        self.experiment = experiment;
        Ok(())
    }

    /// Goes to `stage`, at which nothing else is to be done.
    pub(crate) fn enter(&mut self, stage: Stage) -> Result<(), Failure> {
        self.stage = stage;
        Ok(())
    }

    /// Starts the simulation: parameters and initial values are checked together, and fixed.
    pub(crate) fn exit_initialization_mode(&mut self) -> Result<(), Failure> {
        self.model.start(self.interface, &self.logger)?;
        self.enter(self.interface.first_stage())
    }

    /// Goes to event mode, at the end of a step or where the host's integrator is.
    pub(crate) fn enter_event_mode(&mut self) -> Result<(), Failure> {
        match self.interface {
            Interface::CoSimulation(Stepping { event_mode: false, .. }) => return Err(Failure::NoEventMode),
            Interface::ModelExchange if self.stage == Stage::ContinuousTimeMode => self.model.arrive_at_event()?,
            _ => (),
        }
        self.handling =
            EventHandling { has_begun: true, is_warned: self.handling.is_warned, ..EventHandling::default() };
        self.enter(Stage::EventMode)
    }

    pub(crate) fn terminate(&mut self) -> Result<(), Failure> {
        let is_outside = self.stage == Stage::ContinuousTimeMode && !self.handling.has_begun;
        if is_outside && self.model.time()? > self.experiment.start_time {
            self.warn_of_events(TRIALS)?;
        }
        self.enter(Stage::Terminated)
    }

    /// Applies what the event brings.
    pub(crate) fn update_discrete_states(&mut self) -> Result<Update, Failure> {
        let update = self.model.update(&self.logger);
        self.stop_if_stuck(update)
    }

    /// Makes the instance as it was instantiated. FMU states stay the host's until it frees them.
    pub(crate) fn reset(&mut self) -> Result<(), Failure> {
        self.model.restore(&self.at_start, false)?;
        (self.experiment, self.handling) = Default::default();
        self.logger.on = self.on_at_start;
        self.enter(Stage::Instantiated)
    }

    /// Why the simulation is over, if it is.
    pub(crate) fn ending(&mut self) -> Result<Option<Failure>, Failure> {
        Ok(self.model.ending()?.map(Failure::Ended))
    }

    /// Keeps the present state as the FMU state `handle`, or as a new one for 0; returns the handle.
    pub(crate) fn get_fmu_state(&mut self, handle: usize) -> Result<usize, Failure> {
        let Instance { interface, stage, experiment, .. } = *self;
        let mut model = if handle == 0 { Vec::new() } else { self.snapshots.take_bytes(handle)? };
        model.clear();
        self.model.state(&mut model);
        self.snapshots.keep(handle, Snapshot { interface, stage, experiment, model })
    }

    /// Goes back to the FMU state `handle`, of one of the stages that such an instance keeps states `in_stages`.
    pub(crate) fn set_fmu_state(&mut self, handle: usize, in_stages: Stages) -> Result<(), Failure> {
        let Snapshot { interface, stage, experiment, model } = self.snapshots.find(handle)?;
        if *interface != self.interface || stage.bit() & in_stages == 0 {
            return Err(Failure::OtherInterface);
        }
        self.model.restore(model, stage.has_started())?;
        (self.stage, self.experiment) = (*stage, *experiment);
        (self.handling.awaits_event, self.handling.trials) = (false, 0);
        Ok(())
    }

    pub(crate) fn serialize_fmu_state(&self, handle: usize) -> Result<Vec<u8>, Failure> {
        Ok(self.snapshots.find(handle)?.serialize(&self.model.build()))
    }

    /// Keeps the state that `bytes` hold as the FMU state `handle`, or as a new one for 0; returns the handle.
    pub(crate) fn deserialize_fmu_state(&mut self, bytes: &[u8], handle: usize) -> Result<usize, Failure> {
        self.snapshots.keep(handle, Snapshot::deserialize(&self.model.build(), bytes)?)
    }

    /// Goes to the stage of errors if the model cannot go on.
    fn stop_if_stuck<T>(&mut self, result: Result<T, Failure>) -> Result<T, Failure> {
        result.inspect_err(|failure| {
            if let Failure::Stuck(_) = failure {
                self.stage = Stage::Error;
            }
        })
    }
}

/// How values are read and set: all of a call, or none if one is refused.
impl Instance {
    #[inline(always)]
    pub(crate) fn get_real(&mut self, references: &[u32]) -> Result<&[f64], Failure> {
        let is_real = |reference: &u32| self.are_real.get(*reference as usize) == Some(&true);
        if let Some(wrong) = references.iter().find(|reference| !is_real(reference)) {
            return Err(self.not_real(*wrong));
        }
        if self.reals.len() < references.len() {
            self.reals.resize(references.len(), 0.0);
        }
        let reals = &mut self.reals[..references.len()];
        self.model.get_reals(references, reals)?;
        Ok(reals)
    }

    #[cold]
    fn not_real(&self, reference: u32) -> Failure {
        self.find(reference).map_or_else(|failure| failure, Failure::wrong_type)
    }

    /// Reads what is no real number, of the types that are `of_type`.
    fn get_others<T>(
        &mut self,
        references: &[u32],
        of_type: fn(&DataType) -> bool,
        read: fn(Value) -> T,
    ) -> Result<Vec<T>, Failure> {
        for reference in references {
            let variable = self.find(*reference)?;
            if !of_type(&variable.data_type) {
                return Err(Failure::wrong_type(variable));
            }
        }
        references.iter().map(|reference| self.model.get(*reference).map(read)).collect()
    }

    /// Reads integers, numbers of enumerations, or both: what `of_type` says.
    pub(crate) fn get_numbers(&mut self, of: &[u32], of_type: fn(&DataType) -> bool) -> Result<Vec<i32>, Failure> {
        self.get_others(of, of_type, |value| if let Value::Integer(number) = value { number } else { 0 })
    }

    pub(crate) fn get_booleans(&mut self, of: &[u32]) -> Result<Vec<bool>, Failure> {
        self.get_others(of, |data_type| *data_type == DataType::Boolean, |value| value == Value::Boolean(true))
    }

    /// Reads texts, which the host may use until the next call.
    pub(crate) fn get_texts(&mut self, of: &[u32]) -> Result<Vec<*const c_char>, Failure> {
        self.shown = self.get_others(
            of,
            |data_type| *data_type == DataType::String,
            |value| if let Value::String(text) = value { CString::new(text).unwrap_or_default() } else { c"".into() },
        )?;
        Ok(self.shown.iter().map(|text| text.as_ptr()).collect())
    }

    /// Sets real numbers. While the host integrates, it can set the states, too.
    #[inline(always)]
    pub(crate) fn set_real(&mut self, references: &[u32], values: &[f64]) -> Result<(), Failure> {
        let is_fit = |(reference, value): (&u32, &f64)| {
            self.ranges.get(*reference as usize).is_some_and(|(min, max)| value >= min && value <= max)
        };
        if self.asked.is_none() && references.iter().zip(values).all(is_fit) {
            return self.model.set_inputs(references, values);
        }
        self.set_real_slowly(references, values)
    }

    #[cold]
    #[inline(never)]
    fn set_real_slowly(&mut self, references: &[u32], values: &[f64]) -> Result<(), Failure> {
        let mut states: Option<Vec<f64>> = None;
        let variables = Arc::clone(&self.variables);
        for (reference, &value) in references.iter().zip(values) {
            let variable = find(&variables, *reference, self.first)?;
            let data_type = variable.data_type;
            let (DataType::Real { unit, .. }, Some((min, max))) = (data_type, data_type.limits()) else {
                return Err(refused(variable));
            };
            if variable.role == Role::State && self.stage == Stage::ContinuousTimeMode {
                let which = state_references(&variables).position(|state| state == *reference);
                let states = states.get_or_insert(self.model.states()?);
                states[which.expect("it is a state")] = value;
                continue;
            }
            let (name, description) = (variable.name.to_string(), variable.description.to_string());
            match variable.causality {
                Causality::Input => (),
                _ if variable.start.is_none() => return Err(refused(variable)),
                _ if !self.stage.has_started() => (),
                Causality::Parameter if self.model.get(*reference)? == Value::Real(value) => (),
                _ => return Err(Failure::Fixed { name }),
            }
            if !data_type.accepts(value) {
                return Err(Failure::OutOfRange { name, value, unit, min, max, description });
            }
        }
        // one value is set or not; several could be set in part
        let mut before = Vec::new();
        if references.len() > 1 {
            self.model.state(&mut before);
        }
        let result = self.apply(references, values, states);
        if result.is_err() && !before.is_empty() {
            self.model.restore(&before, self.stage.has_started())?;
        }
        result
    }

    /// Sets real numbers that may be set, and `states`; those of the numbers that are states are among them.
    fn apply(&mut self, references: &[u32], values: &[f64], states: Option<Vec<f64>>) -> Result<(), Failure> {
        if let Some(states) = &states {
            self.set_continuous_states(states)?;
        }
        let (mut inputs, mut of_inputs) = (Vec::new(), Vec::new());
        for (reference, &value) in references.iter().zip(values) {
            match (self.variables[*reference as usize].causality, self.asked) {
                (Causality::Input, Some(step)) => self.model.lead(*reference, value, step)?,
                (Causality::Input, None) => {
                    inputs.push(*reference);
                    of_inputs.push(value);
                }
                _ if states.is_none() || self.variables[*reference as usize].role != Role::State => {
                    self.model.set(*reference, Value::Real(value))
                }
                _ => (), // set with all states
            }
        }
        self.model.set_inputs(&inputs, &of_inputs)
    }

    /// Sets parameters that are no real numbers, to the values that `value_of` gives for their types.
    fn set_others<T: Copy>(
        &mut self,
        references: &[u32],
        values: &[T],
        value_of: impl Fn(&Variable, T) -> Result<Value, Failure>,
    ) -> Result<(), Failure> {
        let variables = Arc::clone(&self.variables);
        let checked = references.iter().zip(values).map(|(reference, value)| {
            let variable = find(&variables, *reference, self.first)?;
            match variable.causality {
                Causality::Input | Causality::Parameter => (),
                _ => return Err(refused(variable)),
            }
            let value = value_of(variable, *value)?;
            let is_fixed = variable.causality != Causality::Input && self.stage.has_started();
            if is_fixed && self.model.get(*reference)? != value {
                return Err(Failure::Fixed { name: variable.name.to_string() });
            }
            Ok(value)
        });
        let checked = checked.collect::<Result<Vec<_>, Failure>>()?;
        references.iter().zip(checked).for_each(|(reference, value)| self.model.set(*reference, value));
        Ok(())
    }

    pub(crate) fn set_integer<T: Copy + Into<i64>>(&mut self, references: &[u32], values: &[T]) -> Result<(), Failure> {
        self.set_others(references, values, |variable, value| {
            let DataType::Enumeration(enumeration) = variable.data_type else { return Err(refused(variable)) };
            let (value, name, data_type) = (value.into(), variable.name.to_string(), variable.data_type);
            let is_item = (1..=enumeration.items.len() as i64).contains(&value);
            if is_item { Ok(Value::Integer(value as i32)) } else { Err(Failure::NoSuchItem { name, value, data_type }) }
        })
    }

    /// Refuses all integers, where enumerations have a function of their own.
    pub(crate) fn set_no_integer(&mut self, references: &[u32]) -> Result<(), Failure> {
        references.first().map_or(Ok(()), |first| Err(refused(self.find(*first)?)))
    }

    /// Sets Booleans; `truth` says what the value of a name stands for.
    pub(crate) fn set_boolean<T: Copy>(
        &mut self,
        references: &[u32],
        values: &[T],
        truth: fn(&str, T) -> Result<bool, Failure>,
    ) -> Result<(), Failure> {
        self.set_others(references, values, |variable, value| {
            let is_one = variable.data_type == DataType::Boolean;
            if is_one { truth(&variable.name, value).map(Value::Boolean) } else { Err(refused(variable)) }
        })
    }

    pub(crate) fn set_string(&mut self, references: &[u32], values: &[&str]) -> Result<(), Failure> {
        self.set_others(references, values, |variable, value| {
            let is_one = variable.data_type == DataType::String;
            if is_one { Ok(Value::String(value.to_owned())) } else { Err(refused(variable)) }
        })
    }

    /// Sets slopes of the inputs over the next step.
    #[inline(always)]
    pub(crate) fn set_real_input_derivatives(
        &mut self,
        references: &[u32],
        orders: &[i32],
        values: &[f64],
    ) -> Result<(), Failure> {
        for ((reference, &order), &value) in references.iter().zip(orders).zip(values) {
            let is_input = self.ranges.get(*reference as usize).is_some_and(|(min, max)| min <= max);
            if !(is_input && order == 1 && value.abs() <= f64::MAX) {
                return self.no_slope(*reference, order, value);
            }
        }
        self.model.set_slopes(references, values)
    }

    #[cold]
    fn no_slope(&self, reference: u32, order: i32, value: f64) -> Result<(), Failure> {
        let variable = self.find(reference)?;
        let name = variable.name.to_string();
        Err(match variable.causality {
            Causality::Input if order != 1 => Failure::WrongOrder { name, order },
            Causality::Input => Failure::BadSlope { name, value },
            _ => Failure::NoInput { name },
        })
    }

    /// Rates of outputs by time.
    pub(crate) fn get_real_output_derivatives(
        &mut self,
        references: &[u32],
        orders: &[i32],
    ) -> Result<Vec<f64>, Failure> {
        for (reference, &order) in references.iter().zip(orders) {
            let variable = self.find(*reference)?;
            if order != 1 {
                return Err(Failure::WrongOrder { name: variable.name.to_string(), order });
            }
        }
        let mut rates = vec![0.0; references.len()];
        if !references.is_empty() {
            self.model.rates(references, &mut rates)?;
        }
        self.all_finite(references, rates)
    }

    /// The derivatives `found` of the variables, if all are finite.
    fn all_finite(&mut self, of: &[u32], found: Vec<f64>) -> Result<Vec<f64>, Failure> {
        match found.iter().position(|derivative| !derivative.is_finite()) {
            Some(at) => Err(Failure::NoRate { name: self.model.name(of[at]), time: self.model.time()? }),
            None => Ok(found),
        }
    }

    /// Derivatives of `unknowns` where each of `knowns` changes by its part of the `seed`.
    pub(crate) fn get_directional_derivative(
        &mut self,
        unknowns: &[u32],
        knowns: &[u32],
        seed: &[f64],
    ) -> Result<Vec<f64>, Failure> {
        for (reference, &value) in knowns.iter().zip(seed) {
            let variable = self.find(*reference)?;
            if !value.is_finite() {
                return Err(Failure::BadSlope { name: variable.name.to_string(), value });
            }
        }
        for reference in unknowns {
            let variable = self.find(*reference)?;
            if !matches!(variable.data_type, DataType::Real { .. }) {
                return Err(Failure::NoOutput { name: variable.name.to_string() });
            }
        }
        let direction: Vec<_> = knowns.iter().copied().zip(seed.iter().copied()).collect();
        let found = self.model.derivatives(unknowns, &direction, self.stage.has_started())?;
        self.all_finite(unknowns, found)
    }
}

/// Why a function of another type cannot set `variable`.
fn refused(variable: &Variable) -> Failure {
    match variable.causality {
        Causality::Input | Causality::Parameter => Failure::wrong_type(variable),
        causality => Failure::NotSettable { name: variable.name.to_string(), causality },
    }
}

/// Steps of a co-simulation.
impl Instance {
    /// Begins a step over `step` (s) from `point` (s). If the host sets inputs within steps, returns how to call it back,
    /// which comes before [`Instance::do_step`].
    pub(crate) fn begin_step(&mut self, point: f64, step: f64) -> Result<Option<IntermediateUpdate>, Failure> {
        let asked = self.host.filter(|host| host.sets_inputs);
        if asked.is_some() {
            self.check_step(point, step)?;
            self.asked = Some(step);
            self.stage = Stage::IntermediateUpdateMode;
        }
        Ok(asked)
    }

    /// Steps to `point` + `step` (s), or to the first event if that is handed over. If `point` differs from the instance's time by
    /// rounding alone, the instance takes over the host's clock, and `step` is the duration.
    #[inline(always)]
    pub(crate) fn do_step(&mut self, point: f64, step: f64) -> Result<StepEnd, Failure> {
        if self.asked.is_some() {
            self.asked = None;
            self.stage = Stage::StepComplete;
        }
        let time = self.check_step(point, step)?;
        let Stepping { event_mode, early_return } = self.interface.stepping();
        let (start, duration) =
            if is_rounding(point, time, step) { (point, step) } else { (time, point + step - time) };
        // an event that a step ends at is handed over: the host must be able to do both
        let step = StepRequest { start, duration, stops_at_events: event_mode && early_return };
        let progress = self.model.advance(step, &self.logger);
        let progress = self.stop_if_stuck(progress)?;
        if progress == StepEnd::Ended {
            self.stage = Stage::StepFailed;
        }
        Ok(progress)
    }

    /// If the host reads outputs within steps, returns how to call it back, which comes before [`Instance::end_step`].
    pub(crate) fn show_step(&mut self) -> Option<IntermediateUpdate> {
        let told = self.host.filter(|host| host.gets_outputs);
        if told.is_some() {
            self.led_to = Some(std::mem::replace(&mut self.stage, Stage::IntermediateOutputs));
        }
        told
    }

    /// Ends the step, once the host has read.
    pub(crate) fn end_step(&mut self) {
        self.stage = self.led_to.take().unwrap_or(self.stage);
    }

    /// The model's time, s. Refuses a step that cannot be made from `point` (s) over `step` (s).
    #[inline(always)]
    fn check_step(&mut self, point: f64, step: f64) -> Result<f64, Failure> {
        let time = self.model.time()?;
        let until = point + step;
        if step.is_nan() || step <= 0.0 {
            return Err(Failure::BadStep { step, time });
        }
        if !is_same_time(point, time, step) {
            return Err(Failure::WrongPoint { given: point, time });
        }
        if !(until > point && until <= f64::MAX) {
            return Err(Failure::BadStep { step, time });
        }
        match self.experiment.stop_time {
            Some(stop) if until > stop && !is_same_time(until, stop, step) => Err(Failure::PastStop { until, stop }),
            _ => Ok(time),
        }
    }
}

/// Whether a host that adds up steps or multiplies them may mean `b` (s) by `a`.
#[inline]
fn is_rounding(a: f64, b: f64, step: f64) -> bool {
    let (of_step, places) = ROUNDING;
    let apart = (a - b).abs();
    apart <= of_step * step || apart <= places * (b.abs().next_up() - b.abs())
}

/// Whether a host may mean `b` (s) by `a`, by the clock that it keeps. The two are never so far apart that a step could be missed.
#[inline]
fn is_same_time(a: f64, b: f64, step: f64) -> bool {
    let (of_step, of_time) = SAME_TIME;
    let apart = (a - b).abs();
    apart <= of_step * step || apart <= 0.5 * step && (apart <= of_time * b.abs() || is_rounding(a, b, step))
}

/// The service of an instance to a host that integrates.
impl Instance {
    pub(crate) fn set_time(&mut self, time: f64) -> Result<(), Failure> {
        if !(time.is_finite() && (time - self.experiment.start_time).is_finite()) {
            return Err(Failure::BadTime(time));
        }
        self.model.time()?;
        self.model.set_time(time, self.stage == Stage::EventMode);
        let is_trial = self.stage == Stage::ContinuousTimeMode;
        self.handling.trials = self.handling.trials.saturating_add(is_trial.into());
        if self.handling.trials >= MANY_TRIALS { self.warn_of_events(TRIALS) } else { Ok(()) }
    }

    pub(crate) fn set_continuous_states(&mut self, states: &[f64]) -> Result<(), Failure> {
        let mut named = state_references(&self.variables).zip(states);
        if let Some((reference, &value)) = named.find(|(_, value)| !value.is_finite()) {
            return Err(Failure::BadState { name: self.model.name(reference), value });
        }
        self.model.set_states(states)
    }

    /// Tells the model that the host has completed a step to where it is.
    pub(crate) fn completed_integrator_step(&mut self) -> Result<Completed, Failure> {
        let completed = self.model.complete_step(&self.logger);
        let completed = self.stop_if_stuck(completed)?;
        if self.handling.awaits_event {
            self.warn_of_events(
                "the host completes steps but does not enter event mode, which a completed step requested: enter event mode \
                 when enterEventMode is true",
            )?;
        }
        (self.handling.awaits_event, self.handling.trials) = (completed.needs_event_mode, 0);
        self.handling.has_begun = true;
        Ok(completed)
    }

    /// Warns once that the host keeps events from being applied.
    #[cold]
    fn warn_of_events(&mut self, how: &str) -> Result<(), Failure> {
        if !std::mem::replace(&mut self.handling.is_warned, true) {
            let time = self.model.time()?;
            self.logger.warning(|| {
                format!("t = {time} s: {how}. Without it the FMU applies no event, and its results are wrong")
            });
        }
        Ok(())
    }
}
