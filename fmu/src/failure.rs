//! Why a call is not done: every message of that kind, in one place. What to call instead, the C interface adds.

use crate::ground::GroundError;
use crate::logger::Status;
use crate::resources::ResourceError;
use crate::state_machine::Stage;
use crate::variables::{Causality, DataType, Enumeration, VARIABLES, Variable};
use rocking::engine::AdvanceError;
use rocking::mechanics::state::InitialStateError;
use rocking::structure::parameters::ParameterError;
use rocking::structure::quantity::{OutOfRange, with_unit};

/// Why a call is not done. But for [`Failure::Overturned`] and [`AdvanceError::Singular`], nothing has
/// changed.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// The function may not be called in this stage.
    #[error("not allowed in the state \"{stage}\"; allowed in: {allowed_in}")]
    WrongStage { stage: Stage, allowed_in: String },
    /// A pointer that is null or not aligned.
    #[error("{0} must be a valid pointer; it is null or misaligned")]
    BadPointer(&'static str),
    /// More values than one call may pass.
    #[error("{length} values are too many for one call: at most {limit}")]
    TooLong { length: usize, limit: usize },
    /// A string without an end, or not in UTF-8.
    #[error("{name} is not UTF-8 text of at most {limit} bytes")]
    BadText { name: &'static str, limit: usize },
    /// A number that stands for none of the choices.
    #[error("{name} = {value} is not one of {accepted}")]
    BadChoice { name: &'static str, value: i32, accepted: &'static str },
    /// An interface of the standard that this unit does not have.
    #[error("this FMU is for model exchange and co-simulation: see modelDescription.xml")]
    NotThisInterface,
    /// Event mode, which the host did not ask for at instantiation.
    #[error("there is no event mode: the instance was made with eventModeUsed = false")]
    NoEventMode,
    /// An empty name.
    #[error("instanceName must not be empty")]
    NoName,
    /// A model description of another FMU.
    #[error(
        "{name} = {given:?} is not {needed}: modelDescription.xml, the library and resources/parameters.toml are not of \
         one FMU; export it again, and unpack every FMU into a folder of its own"
    )]
    WrongGuid { name: &'static str, given: String, needed: String },
    /// The archive's resources cannot be read.
    #[error(transparent)]
    Resource(#[from] ResourceError),
    /// No such log category.
    #[error("log category {0:?} does not exist; see LogCategories in modelDescription.xml")]
    UnknownCategory(String),
    /// No such variable.
    #[error("value reference {0} does not exist; they run from 0 to {last}", last = VARIABLES.len() - 1)]
    UnknownReference(u32),
    /// A variable of another type.
    #[error("{} is {}", .0.name, type_name(.0))]
    WrongType(&'static Variable),
    /// A variable that is not set by the host.
    #[error("{} cannot be set: it is {}, computed by the FMU", .0.name, causality_name(.0))]
    NotSettable(&'static Variable),
    /// A number that stands for no item of an enumeration.
    #[error("{} = {value} is out of range: {}", variable.name, items(variable))]
    NoSuchItem { variable: &'static Variable, value: i64 },
    /// No such record.
    #[error(transparent)]
    Ground(#[from] GroundError),
    /// The record is out of the range of an input.
    #[error("the record, as it is scaled: {0}")]
    StrongRecord(OutOfRange),
    /// The record has changed since a state was kept.
    #[error(
        "record = {record:?}{} has other samples now than when the FMU state was kept",
        if record_v.is_empty() { String::new() } else { format!(" or record_v = {record_v:?}") }
    )]
    OtherRecord { record: String, record_v: String },
    /// A fixed parameter, too late.
    #[error("{} is fixed once the simulation has started", .0.name)]
    Fixed(&'static Variable),
    /// A value out of range.
    #[error(transparent)]
    OutOfRange(#[from] OutOfRange),
    /// The input runs out of its range.
    #[error("at the end of the step, {0}")]
    InputRunsOut(OutOfRange),
    /// Parameters that contradict each other.
    #[error(transparent)]
    Parameters(#[from] ParameterError),
    /// Initial values that contradict each other.
    #[error(transparent)]
    InitialState(#[from] InitialStateError),
    /// A tolerance, a start or a stop time out of range.
    #[error("{name} = {} is out of range: it must be {limit}", with_unit(*value, "1"))]
    Experiment { name: &'static str, value: f64, limit: String },
    /// A derivative of another order than the first.
    #[error("order = {order} for {} is out of range: only derivatives of order 1 exist", variable.name)]
    WrongOrder { variable: &'static Variable, order: i32 },
    /// A slope of what is no input.
    #[error("{} has no derivative that can be set: only the inputs have", .0.name)]
    NoInput(&'static Variable),
    /// A variable that no directional derivative can be taken by.
    #[error(
        "{} cannot be a known of a directional derivative: only the inputs can and, once the simulation has started, u, \
         u_dot, theta, theta_dot and time",
        .0.name
    )]
    NoKnown(&'static Variable),
    /// A slope or a part of a direction that is not a number.
    #[error("the derivative of {}, {value}, is out of range: it must be finite", variable.name)]
    BadSlope { variable: &'static Variable, value: f64 },
    /// A derivative of what is no continuous output.
    #[error("{} has no derivative: only continuous real outputs have", .0.name)]
    NoOutput(&'static Variable),
    /// The equations of motion are singular here, and with them the reactions.
    #[error(
        "{} does not exist at t = {time} s: the top mass is above the pivot of a foundation without inertia (m0, J0 too \
         small)",
        variable.name
    )]
    NoReaction { variable: &'static Variable, time: f64 },
    /// The equations of motion are singular here.
    #[error("the derivative of {} does not exist at t = {time} s", variable.name)]
    NoRate { variable: &'static Variable, time: f64 },
    /// A step from the wrong time.
    #[error("currentCommunicationPoint = {} is not where the FMU is, t = {time} s", with_unit(*given, "s"))]
    WrongPoint { given: f64, time: f64 },
    /// A step of no length, or of no number.
    #[error(
        "communicationStepSize = {step} s is out of range: it must be positive, finite, and large enough to move t = {time} s"
    )]
    BadStep { step: f64, time: f64 },
    /// A step past the end.
    #[error("the step would end at t = {until} s, past stopTime = {stop} s")]
    PastStop { until: f64, stop: f64 },
    /// The solver's own.
    #[error(transparent)]
    Advance(#[from] AdvanceError),
    /// The structure has overturned within the step.
    #[error(
        "the structure overturned at t = {time} s{}; the simulation ends there",
        fall.map_or(String::new(), |fall| format!(", falling since t = {fall} s, before which its peaks are"))
    )]
    Overturned { time: f64, fall: Option<f64> },
    /// A time that is not finite.
    #[error("time = {} is out of range: time and time - startTime must be finite", with_unit(*.0, "s"))]
    BadTime(f64),
    /// A step of the host's integrator that ends before it starts.
    #[error(
        "the integrator's step from t = {from} s ends at t = {to} s: time must not fall below the last event or complete step"
    )]
    StepBack { from: f64, to: f64 },
    /// A trial state that is far from any motion.
    #[error("{name} = {value} is out of range: at most 1e12 in SI units; take a shorter step")]
    FarState { name: &'static str, value: f64 },
    /// The equations of motion have no solution at a trial state.
    #[error(
        "the derivatives of the states do not exist at t = {time} s (u = {u} m, theta = {theta} rad): take a shorter step"
    )]
    NoStateRates { time: f64, u: f64, theta: f64 },
    /// Another number of values, states or indicators.
    #[error("{name} = {given} is not {needed}")]
    WrongCount { name: &'static str, given: usize, needed: usize },
    /// A state kept by an instance of another interface.
    #[error(
        "the FMU state was kept by an instance for the other interface, or with another eventModeUsed or earlyReturnAllowed"
    )]
    OtherInterface,
    /// A status that this FMU does not have.
    #[error("{0} has no answer here")]
    NoAnswer(&'static str),
    /// Not one of the instance's FMU states.
    #[error(
        "FMUstate {0:#x} is not one that this instance has handed out and not freed; pass a pointer to NULL for a new one"
    )]
    UnknownSnapshot(usize),
    /// A buffer of the wrong size.
    #[error("size = {given} does not fit: the serialized FMU state takes {needed} bytes")]
    WrongSize { given: usize, needed: usize },
    /// Bytes that are no FMU state of this library.
    #[error("serializedState is not a serialized state of this FMU: {0}")]
    BadBytes(&'static str),
    /// A caught panic.
    #[error("internal failure, please report it: {0}; the instance can only be freed")]
    Panicked(String),
}

impl Failure {
    /// What the call returns.
    pub fn status(&self) -> Status {
        match self {
            Failure::Overturned { .. } | Failure::NoAnswer(_) => Status::Discard,
            Failure::FarState { .. } | Failure::NoStateRates { .. } => Status::Discard,
            Failure::Panicked(_) => Status::Fatal,
            _ => Status::Error,
        }
    }
}

/// What the numbers of an enumeration stand for.
fn items(variable: &Variable) -> String {
    let DataType::Enumeration(Enumeration { items, .. }) = variable.data_type else { return String::new() };
    (1..).zip(items.iter()).map(|(number, item): (u32, _)| format!("{number} = {item}")).collect::<Vec<_>>().join(", ")
}

fn type_name(variable: &Variable) -> &'static str {
    match variable.data_type {
        DataType::Real { .. } => "a real number",
        DataType::Integer => "an integer",
        DataType::Boolean => "a Boolean",
        DataType::String => "a string",
        DataType::Enumeration(_) => "an enumeration",
    }
}

fn causality_name(variable: &Variable) -> &'static str {
    match variable.causality {
        Causality::CalculatedParameter => "a calculated parameter",
        Causality::Local => "a local variable",
        Causality::Independent => "the independent variable",
        _ => "an output",
    }
}
