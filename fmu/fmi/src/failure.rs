//! Why a call is not done: every message of that kind, in one place. The C interface adds the function to call instead.

use crate::logger::Status;
use crate::state_machine::Stage;
use crate::variables::{Causality, DataType, Variable};

/// Why a call is not done. Nothing has changed, unless the simulation has ended or is stuck.
#[derive(Debug, thiserror::Error)]
#[allow(missing_docs)] // the messages say it
pub enum Failure {
    /// The model's own reason: the call returns an error.
    #[error("{0}")]
    Refused(String),
    /// The model's own reason, at a trial that may be repeated elsewhere: the call is discarded.
    #[error("{0}")]
    Discarded(String),
    /// The model's own reason, and it cannot go on.
    #[error("{0}")]
    Stuck(String),
    /// The simulation has ended.
    #[error("{0}; the simulation ends there")]
    Ended(String),
    #[error("not allowed in the state \"{stage}\"; allowed in: {allowed_in}")]
    WrongStage { stage: Stage, allowed_in: String },
    #[error("{0} must be a valid pointer; it is null or misaligned")]
    BadPointer(&'static str),
    #[error("{length} values are too many for one call: at most {limit}")]
    TooLong { length: usize, limit: usize },
    #[error("{name} is not UTF-8 text of at most {limit} bytes")]
    BadText { name: &'static str, limit: usize },
    #[error("{name} = {value} is not one of {accepted}")]
    BadChoice { name: String, value: i32, accepted: &'static str },
    #[error("this FMU has no scheduled execution, only model exchange and co-simulation")]
    NotThisInterface,
    #[error("there is no event mode: the instance was made with eventModeUsed = false")]
    NoEventMode,
    #[error("instanceName must not be empty")]
    NoName,
    #[error("fmuResourceLocation = {0:?} is not a file URI of this machine, such as file:///tmp/fmu/resources")]
    NotAFileUri(String),
    #[error(
        "{name} = {given:?} is not {needed}: modelDescription.xml, the library and the folder resources are not of one FMU; \
         export it again, and unpack every FMU into a folder of its own"
    )]
    WrongToken { name: &'static str, given: String, needed: String },
    #[error("log category {0:?} does not exist; see LogCategories in modelDescription.xml")]
    UnknownCategory(String),
    #[error("value reference {reference} does not exist; they run from {first} to {last}")]
    UnknownReference { reference: u32, first: u32, last: usize },
    #[error("{name} is {}", type_name(*data_type))]
    WrongType { name: String, data_type: DataType },
    #[error("this FMU has no variables of this type")]
    NoneOfType,
    #[error("{name} cannot be set: it is {}, computed by the FMU", causality_name(*causality))]
    NotSettable { name: String, causality: Causality },
    #[error("{name} = {value} is out of range: {}", items(*data_type))]
    NoSuchItem { name: String, value: i64, data_type: DataType },
    #[error("{name} is fixed once the simulation has started")]
    Fixed { name: String },
    #[error(
        "{name} = {} is out of range: it must lie between {} and {} ({description})",
        with_unit(*value, unit), with_unit(*min, "1"), with_unit(*max, unit)
    )]
    OutOfRange { name: String, value: f64, unit: &'static str, min: f64, max: f64, description: String },
    #[error("{name} = {} is out of range: it must be {limit}", with_unit(*value, "1"))]
    Experiment { name: &'static str, value: f64, limit: String },
    #[error("order = {order} for {name} is out of range: only derivatives of order 1 exist")]
    WrongOrder { name: String, order: i32 },
    #[error("{name} has no derivative that can be set: only the inputs have")]
    NoInput { name: String },
    #[error(
        "{name} cannot be a known of a directional derivative: only the inputs can, before the simulation starts real parameters \
         and, once it has started, {knowns} and time"
    )]
    NoKnown { name: String, knowns: String },
    #[error("the derivative of {name}, {value}, is out of range: it must be finite")]
    BadSlope { name: String, value: f64 },
    #[error("{name} has no derivative: only continuous real outputs have")]
    NoOutput { name: String },
    #[error("the derivative of {name} does not exist at t = {time} s")]
    NoRate { name: String, time: f64 },
    #[error("currentCommunicationPoint = {} differs from the time of the FMU, t = {time} s", with_unit(*given, "s"))]
    WrongPoint { given: f64, time: f64 },
    #[error(
        "communicationStepSize = {} is out of range: it must be positive, finite, large enough to move t = {}, and end at a \
         finite time",
        with_unit(*step, "s"), with_unit(*time, "s")
    )]
    BadStep { step: f64, time: f64 },
    #[error("the step would end at t = {until} s, past stopTime = {stop} s")]
    PastStop { until: f64, stop: f64 },
    #[error("time = {} is out of range: time and time - startTime must be finite", with_unit(*.0, "s"))]
    BadTime(f64),
    #[error("{name} = {value} is out of range: a state must be finite; take a shorter step")]
    BadState { name: String, value: f64 },
    #[error(
        "the integrator's step from t = {from} s ends at t = {to} s: time must not fall below the last event or complete step"
    )]
    StepBack { from: f64, to: f64 },
    #[error("{name} = {given} is not {needed}")]
    WrongCount { name: &'static str, given: usize, needed: usize },
    #[error(
        "the FMU state was kept by an instance for the other interface, or with another eventModeUsed or earlyReturnAllowed"
    )]
    OtherInterface,
    #[error(
        "{0} has no answer here: fmi2DoStep never returns fmi2Pending, fmi2GetRealStatus knows fmi2LastSuccessfulTime, \
         fmi2GetBooleanStatus knows fmi2Terminated"
    )]
    NoAnswer(&'static str),
    #[error("FMUstate {0:#x} is not one that this instance has handed out and not freed")]
    UnknownSnapshot(usize),
    #[error("size = {given} does not fit: the serialized FMU state takes {needed} bytes")]
    WrongSize { given: usize, needed: usize },
    #[error("serializedState is not a serialized state of this FMU: {0}")]
    BadBytes(&'static str),
    #[error("internal failure, please report it: {0}")]
    Panicked(String),
}

impl Failure {
    /// The status that the call returns.
    pub fn status(&self) -> Status {
        match self {
            Failure::Ended(_) | Failure::Discarded(_) | Failure::BadState { .. } | Failure::NoAnswer(_) => {
                Status::Discard
            }
            Failure::Panicked(_) => Status::Fatal,
            _ => Status::Error,
        }
    }

    /// Refuses to set `variable`, or to set or get it as another type than its own.
    pub(crate) fn wrong_type(variable: &Variable) -> Failure {
        Failure::WrongType { name: variable.name.to_string(), data_type: variable.data_type }
    }
}

/// `value` with its unit, which a ratio has none of, in digits that stay few.
fn with_unit(value: f64, unit: &str) -> String {
    let digits = if value.abs() < 1e7 { format!("{value:?}") } else { format!("{value:e}") };
    let digits = digits.strip_suffix(".0").unwrap_or(&digits);
    if unit == "1" { digits.into() } else { format!("{digits} {unit}") }
}

/// The items of an enumeration with their numbers.
fn items(data_type: DataType) -> String {
    let DataType::Enumeration(enumeration) = data_type else { return String::new() };
    (1..)
        .zip(enumeration.items)
        .map(|(number, item): (u32, _)| format!("{number} = {item}"))
        .collect::<Vec<_>>()
        .join(", ")
}

fn type_name(data_type: DataType) -> &'static str {
    match data_type {
        DataType::Real { .. } => "a real number",
        DataType::Integer => "an integer",
        DataType::Boolean => "a Boolean",
        DataType::String => "a string",
        DataType::Enumeration(_) => "an enumeration",
    }
}

fn causality_name(causality: Causality) -> &'static str {
    match causality {
        Causality::CalculatedParameter => "a calculated parameter",
        Causality::Local => "a local variable",
        Causality::Independent => "the independent variable",
        _ => "an output",
    }
}
