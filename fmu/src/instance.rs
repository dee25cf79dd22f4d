//! One instance of the FMU: what each function does, in safe code.

use crate::failure::Failure;
use crate::guid;
use crate::logger::{Category, Logger, Status};
use crate::resources;
use crate::snapshot::{self, Snapshots};
use crate::state_machine::{Function, Stage};
use crate::variables::{self, Causality, INPUTS, Source, VARIABLES, Variable};
use rocking::engine::{AdvanceError, DEFAULT_TOLERANCE, Motion, Progress, TransitionKind};
use rocking::impact::gaining_restitution;
use rocking::{
    Detail, Engine, Impulse, LinearLoad, Load, Parameters, Phase, Reactions, Side, State, Structure, Transition,
};
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_PI_2;
use std::mem::MaybeUninit;

/// How close two times (s) are that mean the same: relative to the time, or to the step if that is longer.
const SAME_TIME: f64 = 1e-9;

/// Largest |θ| of a structure in motion, rad: that of overturning and its rounding.
const MAX_ANGLE: f64 = FRAC_PI_2 + 1e-9;

/// More than any other number of the motion (SI units) but its time can be, and small enough to be squared.
const BOUND: f64 = 1e100;

/// One instance.
pub struct Instance {
    logger: Logger,
    events_at_start: bool,
    shipped: Parameters,
    now: Condition,
    snapshots: Snapshots,
}

/// Everything that the future of an instance depends on: what an FMU state holds.
#[derive(Clone, Debug)]
pub struct Condition {
    /// State of FMI's state machine.
    pub stage: Stage,
    /// What was set before the start.
    pub setup: Setup,
    /// The inputs, from the present time on. After a step the slopes are 0: the values are held.
    pub input: LinearLoad,
    /// The structure in motion. Until initialization ends it is built when an output is asked for, and dropped when
    /// what it was built from is set anew.
    pub engine: Option<Engine>,
}

/// What is set before a simulation starts.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Setup {
    parameters: Parameters,
    initial: State,
    detail: Detail,
    tolerance: f64,
    start_time: f64,
    stop_time: Option<f64>,
}

impl Setup {
    /// The structure at the start time.
    pub fn start(&self) -> Result<Engine, Failure> {
        let structure = Structure::new(self.parameters)?;
        Ok(Engine::with_detail(structure, self.initial, self.start_time, self.tolerance, self.detail)?)
    }
}

impl Condition {
    /// As instantiated, with the parameters that the archive carries.
    fn new(parameters: Parameters) -> Condition {
        Condition {
            stage: Stage::Instantiated,
            setup: Setup {
                parameters,
                initial: State::default(),
                detail: Detail::default(),
                tolerance: DEFAULT_TOLERANCE,
                start_time: 0.0,
                stop_time: None,
            },
            input: LinearLoad::default(),
            engine: None,
        }
    }

    /// Whether calls can lead here. What is read from bytes need not have come about by calls.
    pub fn is_possible(&self) -> bool {
        let Setup { parameters, initial, tolerance, start_time, stop_time, .. } = &self.setup;
        let fits = |variable: &Variable| match variable.source {
            Source::Input(quantity) => {
                let (value, slope) = ((quantity.get)(&self.input.value), (quantity.get)(&self.input.slope));
                quantity.check(value).is_ok() && slope.is_finite()
            }
            Source::Parameter(quantity) => quantity.check((quantity.get)(parameters)).is_ok(),
            Source::InitialValue(quantity) => quantity.check((quantity.get)(initial)).is_ok(),
            _ => true,
        };
        let moves = self.engine.as_ref().map(|engine| {
            let &Motion { time, a_g, state: State { u, u_dot, theta, theta_dot }, impulse, .. } = engine.motion();
            let Impulse { I_h, I_v, I_m } = impulse;
            let is_bounded = [a_g, u, u_dot, theta_dot, I_h, I_v, I_m].iter().all(|x| x.abs() <= BOUND);
            is_bounded && time.is_finite() && time >= *start_time && theta.abs() <= MAX_ANGLE
        });
        VARIABLES.iter().all(fits)
            && check_experiment(*tolerance, *start_time, *stop_time).is_ok()
            && moves.map_or(!self.has_started(), |is_possible| is_possible && self.has_started())
    }

    /// The structure in motion, or at its start with what has been set so far.
    fn engine(&mut self) -> Result<&mut Engine, Failure> {
        match &mut self.engine {
            Some(engine) => Ok(engine),
            none => Ok(none.insert(self.setup.start()?)),
        }
    }

    fn has_started(&self) -> bool {
        !matches!(self.stage, Stage::Instantiated | Stage::InitializationMode)
    }

    /// The motion, once it has started: until then it follows from the setup.
    pub fn motion(&self) -> Option<&Motion> {
        self.engine.as_ref().filter(|_| self.has_started()).map(Engine::motion)
    }
}

/// What the host says of a new instance.
pub struct Arguments<'a> {
    /// Its name.
    pub name: &'a str,
    /// The GUID of the model description that the host has read.
    pub guid: &'a str,
    /// URI of the archive's folder `resources`.
    pub resource_location: &'a str,
    /// Whether events are logged.
    pub logging_on: bool,
}

impl Instance {
    /// `fmi2Instantiate`: an instance, or a message in the log.
    pub fn new(arguments: Result<Arguments, Failure>, mut logger: Logger) -> Option<Instance> {
        let parameters = |arguments: &Arguments| {
            if arguments.name.is_empty() {
                return Err(Failure::NoName);
            }
            let parameters = resources::parameters(arguments.resource_location)?;
            let needed = guid(&parameters);
            if arguments.guid != needed {
                return Err(Failure::WrongGuid { given: arguments.guid.to_owned(), needed });
            }
            Ok(parameters)
        };
        match arguments.and_then(|arguments| Ok((parameters(&arguments)?, arguments.logging_on))) {
            Ok((shipped, events_at_start)) => {
                logger.set_events(events_at_start);
                let now = Condition::new(shipped);
                Some(Instance { logger, events_at_start, shipped, now, snapshots: Snapshots::default() })
            }
            Err(failure) => {
                logger.failure(failure.status(), &format!("fmi2Instantiate: {failure}"));
                None
            }
        }
    }

    /// Calls `body` if `function` is allowed now. A failure is logged under the function's name.
    pub fn call(&mut self, function: Function, body: impl FnOnce(&mut Instance) -> Result<(), Failure>) -> Status {
        let stage = self.now.stage;
        let result =
            if function.is_allowed_in(stage) { body(self) } else { Err(Failure::WrongStage { function, stage }) };
        match result {
            Ok(()) => Status::Ok,
            Err(failure) => self.report(function, &failure),
        }
    }

    /// Logs `failure` of `function` and returns its status.
    pub fn report(&self, function: Function, failure: &Failure) -> Status {
        self.logger.failure(failure.status(), &format!("{}: {failure}", function.name()));
        failure.status()
    }

    /// `fmi2SetDebugLogging`: no category means all of them.
    pub fn set_debug_logging(&mut self, on: bool, categories: &[&str]) -> Result<(), Failure> {
        for name in categories {
            if !Category::ALL.iter().any(|category| category.name().to_str() == Ok(name)) {
                return Err(Failure::UnknownCategory((*name).to_owned()));
            }
        }
        let events = Category::Events.name().to_str();
        self.logger.set_events(on && (categories.is_empty() || categories.iter().any(|name| events == Ok(name))));
        Ok(())
    }

    /// `fmi2SetupExperiment`
    pub fn setup_experiment(
        &mut self,
        tolerance: Option<f64>,
        start_time: f64,
        stop_time: Option<f64>,
    ) -> Result<(), Failure> {
        let tolerance = tolerance.unwrap_or(DEFAULT_TOLERANCE);
        check_experiment(tolerance, start_time, stop_time)?;
        self.now.setup = Setup { tolerance, start_time, stop_time, ..self.now.setup };
        Ok(())
    }

    /// `fmi2EnterInitializationMode`
    pub fn enter_initialization_mode(&mut self) -> Result<(), Failure> {
        self.now.stage = Stage::InitializationMode;
        Ok(())
    }

    /// `fmi2ExitInitializationMode`: from here on parameters and initial values are fixed, and fit together.
    pub fn exit_initialization_mode(&mut self) -> Result<(), Failure> {
        let structure = self.now.engine()?.structure();
        let (r, gaining) = (structure.parameters().r, gaining_restitution(structure));
        if r < gaining {
            self.logger.warning(&format!(
                "r = {r} is below 1 - 4 (m + m0) B^2/J_P = {gaining}: impacts of this structure can raise its energy; \
                 raise r, or lower H/B"
            ));
        }
        self.now.stage = Stage::StepComplete;
        Ok(())
    }

    /// `fmi2Terminate`
    pub fn terminate(&mut self) -> Result<(), Failure> {
        self.now.stage = Stage::Terminated;
        Ok(())
    }

    /// `fmi2Reset`: as instantiated. FMU states stay the host's until it frees them.
    pub fn reset(&mut self) -> Result<(), Failure> {
        self.now = Condition::new(self.shipped);
        self.logger.set_events(self.events_at_start);
        Ok(())
    }

    /// `fmi2GetReal`: all of the values, or none if one is refused.
    pub fn get_real(&mut self, references: &[u32], values: &mut [MaybeUninit<f64>]) -> Result<(), Failure> {
        let mut is_computed = false;
        let mut reaction = None;
        for reference in references {
            let variable = find(*reference)?;
            if let Source::Reaction(_) = variable.source {
                reaction = Some(variable);
            }
            match variable.source {
                Source::Input(_) | Source::Parameter(_) | Source::InitialValue(_) => (),
                Source::Output(_) | Source::Reaction(_) | Source::Impulse(_) | Source::Derived(_) => is_computed = true,
                Source::Integer(_) | Source::Boolean(_) | Source::Detail => return Err(Failure::WrongType(variable)),
            }
        }
        let load = self.now.input.value;
        let (mut outputs, mut reactions) = (None, None);
        if is_computed {
            let engine = self.now.engine()?;
            if let Some(variable) = reaction {
                let Reactions { R_h, R_v, R_m } = *reactions.insert(engine.reactions(load));
                if !(R_h + R_v + R_m).is_finite() {
                    return Err(Failure::NoReaction { variable, time: engine.motion().time });
                }
            }
        }
        for (reference, value) in references.iter().zip(values) {
            let variable = find(*reference)?;
            value.write(match variable.source {
                Source::Input(quantity) => (quantity.get)(&load),
                Source::Parameter(quantity) => (quantity.get)(&self.now.setup.parameters),
                Source::InitialValue(quantity) => (quantity.get)(&self.now.setup.initial),
                Source::Derived(derived) => (derived.value)(self.now.engine()?.structure()),
                Source::Output(of) => {
                    let engine = self.now.engine()?;
                    of(outputs.get_or_insert_with(|| engine.outputs(load.F_t)))
                }
                Source::Reaction(of) => reactions.as_ref().map_or(f64::NAN, of), // there is one if it is asked for
                Source::Impulse(of) => of(&self.now.engine()?.motion().impulse),
                Source::Integer(_) | Source::Boolean(_) | Source::Detail => return Err(Failure::WrongType(variable)),
            });
        }
        Ok(())
    }

    /// `fmi2GetInteger`: integers and enumerations.
    pub fn get_integer(&mut self, references: &[u32], values: &mut [MaybeUninit<i32>]) -> Result<(), Failure> {
        self.get_discrete(references, values, |source| matches!(source, Source::Integer(_) | Source::Detail))
    }

    /// `fmi2GetBoolean`: 0 or 1.
    pub fn get_boolean(&mut self, references: &[u32], values: &mut [MaybeUninit<i32>]) -> Result<(), Failure> {
        self.get_discrete(references, values, |source| matches!(source, Source::Boolean(_)))
    }

    /// All of the values, or none if one is refused. `is_of_type` tells the sources of one type.
    fn get_discrete(
        &mut self,
        references: &[u32],
        values: &mut [MaybeUninit<i32>],
        is_of_type: fn(&Source) -> bool,
    ) -> Result<(), Failure> {
        let mut is_computed = false;
        for reference in references {
            let variable = find(*reference)?;
            if !is_of_type(&variable.source) {
                return Err(Failure::WrongType(variable));
            }
            is_computed |= !matches!(variable.source, Source::Detail);
        }
        if is_computed {
            self.now.engine()?;
        }
        for (reference, value) in references.iter().zip(values) {
            value.write(match find(*reference)?.source {
                Source::Integer(of) | Source::Boolean(of) => of(self.now.engine()?.motion()),
                _ => variables::detail_number(self.now.setup.detail),
            });
        }
        Ok(())
    }

    /// `fmi2GetString`: there are no strings.
    pub fn get_string(&self, references: &[u32]) -> Result<(), Failure> {
        references.first().map_or(Ok(()), |reference| Err(Failure::NoStrings(*reference)))
    }

    /// `fmi2SetReal`: all of the values, or none if one is refused.
    pub fn set_real(&mut self, references: &[u32], values: &[f64]) -> Result<(), Failure> {
        for (reference, &value) in references.iter().zip(values) {
            let variable = find(*reference)?;
            match variable.source {
                Source::Input(quantity) => quantity.check(value)?,
                Source::Parameter(_) | Source::InitialValue(_) if self.now.stage == Stage::StepComplete => {
                    return Err(Failure::Fixed(variable));
                }
                Source::Parameter(quantity) => quantity.check(value)?,
                Source::InitialValue(quantity) => quantity.check(value)?,
                _ => return Err(Failure::NotSettable(variable)),
            }
        }
        let now = &mut self.now;
        for (reference, &value) in references.iter().zip(values) {
            match find(*reference)?.source {
                Source::Input(quantity) => (quantity.set)(&mut now.input.value, value),
                Source::Parameter(quantity) => {
                    (quantity.set)(&mut now.setup.parameters, value);
                    now.engine = None;
                }
                Source::InitialValue(quantity) => {
                    (quantity.set)(&mut now.setup.initial, value);
                    now.engine = None;
                }
                _ => (),
            }
        }
        Ok(())
    }

    /// `fmi2SetInteger`: all of the values, or none if one is refused. Of enumerations alone, the parameter `detail`
    /// can be set.
    pub fn set_integer(&mut self, references: &[u32], values: &[i32]) -> Result<(), Failure> {
        let mut detail = self.now.setup.detail;
        for (reference, &value) in references.iter().zip(values) {
            let variable = find(*reference)?;
            match variable.source {
                Source::Detail if self.now.stage == Stage::StepComplete => return Err(Failure::Fixed(variable)),
                Source::Detail => detail = variables::detail(value).ok_or(Failure::NoSuchItem { variable, value })?,
                _ => self.set_boolean(std::slice::from_ref(reference))?,
            }
        }
        if detail != self.now.setup.detail {
            self.now.setup.detail = detail;
            self.now.engine = None;
        }
        Ok(())
    }

    /// `fmi2SetBoolean`: no Boolean can be set.
    pub fn set_boolean(&self, references: &[u32]) -> Result<(), Failure> {
        let Some(reference) = references.first() else { return Ok(()) };
        let variable = find(*reference)?;
        Err(match variable.causality {
            Causality::Output | Causality::CalculatedParameter => Failure::NotSettable(variable),
            Causality::Input | Causality::Parameter => Failure::WrongType(variable),
        })
    }

    /// `fmi2SetString`: there are no strings.
    pub fn set_string(&self, references: &[u32]) -> Result<(), Failure> {
        self.get_string(references)
    }

    /// `fmi2SetRealInputDerivatives`: slopes of the inputs over the next step.
    pub fn set_real_input_derivatives(
        &mut self,
        references: &[u32],
        orders: &[i32],
        values: &[f64],
    ) -> Result<(), Failure> {
        let mut input = self.now.input;
        for ((reference, &order), &value) in references.iter().zip(orders).zip(values) {
            let variable = find(*reference)?;
            let Source::Input(quantity) = variable.source else { return Err(Failure::NoInput(variable)) };
            if order != 1 {
                return Err(Failure::WrongOrder { variable, order });
            }
            if !value.is_finite() {
                return Err(Failure::BadSlope { variable, value });
            }
            (quantity.set)(&mut input.slope, value);
        }
        self.now.input = input;
        Ok(())
    }

    /// `fmi2GetRealOutputDerivatives`: from the equations of motion, under the present values of the inputs.
    pub fn get_real_output_derivatives(
        &mut self,
        references: &[u32],
        orders: &[i32],
        values: &mut [MaybeUninit<f64>],
    ) -> Result<(), Failure> {
        let load = self.now.input;
        let engine = self.now.engine()?;
        let time = engine.motion().time;
        let (outputs, reactions) = engine.rates(load);
        let rate = |reference: &u32, order: i32| {
            let variable = find(*reference)?;
            let rate = match variable.source {
                Source::Output(of) => of(&outputs),
                Source::Reaction(of) => of(&reactions),
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

    /// `fmi2GetDirectionalDerivative`: of outputs by inputs. The outputs are affine in the inputs, so that a difference
    /// is the derivative; it is taken over a change of the size of gravity and the strut's force, which keeps its
    /// digits.
    pub fn get_directional_derivative(
        &mut self,
        unknowns: &[u32],
        knowns: &[u32],
        seed: &[f64],
        values: &mut [MaybeUninit<f64>],
    ) -> Result<(), Failure> {
        let mut direction = Load::default();
        for (reference, &value) in knowns.iter().zip(seed) {
            let variable = find(*reference)?;
            let Source::Input(quantity) = variable.source else { return Err(Failure::NoKnown(variable)) };
            if !value.is_finite() {
                return Err(Failure::BadSlope { variable, value });
            }
            let sum = (quantity.get)(&direction) + value;
            (quantity.set)(&mut direction, sum);
        }
        let engine = self.now.engine()?;
        let time = engine.motion().time;
        let &Parameters { m, g, .. } = engine.structure().parameters();
        let outputs_before = engine.outputs(0.0);
        let size = direction.a_g.abs().max(direction.F_t.abs() / m) / (g + outputs_before.a_t.abs());
        let of_size_one = |part: f64| if size > 0.0 { part / size } else { 0.0 };
        let change = Load { a_g: of_size_one(direction.a_g), F_t: of_size_one(direction.F_t) };
        let outputs = engine.outputs(change.F_t);
        let [reactions, reactions_before] = [change, Load::default()].map(|load| engine.reactions(load));
        let derivative = |reference: &u32| {
            let variable = find(*reference)?;
            let difference = match variable.source {
                Source::Output(of) => of(&outputs) - of(&outputs_before),
                Source::Reaction(of) => of(&reactions) - of(&reactions_before),
                _ => return Err(Failure::NoOutput(variable)),
            };
            Some(size * difference).filter(|value| value.is_finite()).ok_or(Failure::NoRate { variable, time })
        };
        for reference in unknowns {
            derivative(reference)?;
        }
        for (reference, value) in unknowns.iter().zip(values) {
            value.write(derivative(reference)?);
        }
        Ok(())
    }

    /// `fmi2DoStep`: from `point` (s), which is where the instance is, over `step` (s).
    pub fn do_step(&mut self, point: f64, step: f64) -> Result<(), Failure> {
        let logger = &self.logger;
        let Condition { input, setup: Setup { stop_time, .. }, .. } = self.now;
        let engine = self.now.engine()?;
        let time = engine.motion().time;
        let until = point + step;
        if !(step > 0.0 && step.is_finite()) {
            return Err(Failure::BadStep { step, time });
        }
        if !is_same_time(point, time, step) {
            return Err(Failure::WrongPoint { given: point, time });
        }
        if until <= time {
            return Err(Failure::BadStep { step, time });
        }
        if let Some(stop) = stop_time
            && until > stop
            && !is_same_time(until, stop, step)
        {
            return Err(Failure::PastStop { until, stop });
        }
        let last = input.at(until - time);
        for quantity in &INPUTS {
            quantity.check((quantity.get)(&last)).map_err(Failure::InputRunsOut)?;
        }

        let progress = engine.advance(until, input, &mut |transition| log(logger, transition));
        let end = engine.motion().time;
        match progress {
            Ok(Progress::Complete) => {
                self.now.input = held(input, end - time);
                Ok(())
            }
            Ok(Progress::Overturned) => {
                self.now.input = held(input, end - time);
                self.now.stage = Stage::StepFailed;
                Err(Failure::Overturned { time: end })
            }
            Err(error) => {
                if matches!(error, AdvanceError::Singular { .. }) {
                    self.now.stage = Stage::Error;
                }
                Err(error.into())
            }
        }
    }

    /// `fmi2GetRealStatus`
    pub fn real_status(&mut self, kind: StatusKind) -> Result<f64, Failure> {
        match kind {
            StatusKind::LastSuccessfulTime => Ok(self.now.engine()?.motion().time),
            _ => Err(Failure::NoAnswer(kind)),
        }
    }

    /// `fmi2GetBooleanStatus`
    pub fn boolean_status(&mut self, kind: StatusKind) -> Result<bool, Failure> {
        match kind {
            StatusKind::Terminated => Ok(matches!(self.now.engine()?.motion().phase, Phase::Overturned(_))),
            _ => Err(Failure::NoAnswer(kind)),
        }
    }

    /// `fmi2GetFMUstate`: into the state `handle`, or into a new one for 0.
    pub fn get_fmu_state(&mut self, handle: usize) -> Result<usize, Failure> {
        self.snapshots.keep(handle, self.now.clone())
    }

    /// `fmi2SetFMUstate`
    pub fn set_fmu_state(&mut self, handle: usize) -> Result<(), Failure> {
        self.now = self.snapshots.find(handle)?.clone();
        Ok(())
    }

    /// `fmi2FreeFMUstate`
    pub fn free_fmu_state(&mut self, handle: usize) -> Result<(), Failure> {
        self.snapshots.free(handle)
    }

    /// `fmi2SerializeFMUstate`; the length is what `fmi2SerializedFMUstateSize` returns.
    pub fn serialize_fmu_state(&self, handle: usize) -> Result<Vec<u8>, Failure> {
        Ok(snapshot::serialize(self.snapshots.find(handle)?))
    }

    /// `fmi2DeSerializeFMUstate`: into the state `handle`, or into a new one for 0.
    pub fn deserialize_fmu_state(&mut self, bytes: &[u8], handle: usize) -> Result<usize, Failure> {
        self.snapshots.keep(handle, snapshot::deserialize(bytes)?)
    }
}

/// What a host may ask about a step: `fmi2StatusKind`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum StatusKind {
    /// Result of a pending step.
    DoStepStatus,
    /// How a pending step is doing.
    PendingStatus,
    /// How far the last step came.
    LastSuccessfulTime,
    /// Whether the FMU ends the simulation.
    Terminated,
}

impl StatusKind {
    /// The kind that `number` stands for in the C interface.
    pub fn from_number(number: i32) -> Option<StatusKind> {
        use StatusKind::*;
        [DoStepStatus, PendingStatus, LastSuccessfulTime, Terminated].get(usize::try_from(number).ok()?).copied()
    }
}

/// What `fmi2SetupExperiment` may say.
fn check_experiment(tolerance: f64, start_time: f64, stop_time: Option<f64>) -> Result<(), Failure> {
    let refuse = |name, value, limit: &str| Failure::Experiment { name, value, limit: limit.to_owned() };
    if !(tolerance > 0.0 && tolerance < 1.0) {
        return Err(refuse("tolerance", tolerance, "between 0 and 1, such as 1e-9"));
    }
    if !start_time.is_finite() {
        return Err(refuse("startTime", start_time, "finite"));
    }
    if let Some(stop_time) = stop_time
        && !(stop_time > start_time && stop_time.is_finite())
    {
        return Err(refuse("stopTime", stop_time, &format!("finite and later than startTime = {start_time} s")));
    }
    Ok(())
}

fn find(reference: u32) -> Result<&'static Variable, Failure> {
    let Some(variable) = VARIABLES.get(reference as usize) else { return Err(Failure::UnknownReference(reference)) };
    Ok(variable)
}

/// The inputs at the end of a step of `duration` (s), held from there on until they are set anew.
fn held(input: LinearLoad, duration: f64) -> LinearLoad {
    LinearLoad { value: input.at(duration), slope: Load::default() }
}

/// Hosts add up steps or multiply them: their times (s) differ in the last digits.
fn is_same_time(a: f64, b: f64, step: f64) -> bool {
    (a - b).abs() <= SAME_TIME * b.abs().max(step)
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
        let text = c"t = 2.5 s: landing in full contact; u = 0.001 m, u_dot = -0.75 m/s (before: 0.25), theta_dot = 0 \
                     rad/s (before: -0.5); too many transitions within one vibration period: contact is held for the \
                     rest of it";
        assert_eq!(*sent.borrow(), [(Status::Warning, c"logStatusWarning".to_owned(), text.to_owned())]);
    }
}
