//! Types of FMI 3.0, where they are not those of FMI 2.0.

use crate::{
    Attributes, Boolean, Category, DefaultExperiment, Enumeration, Integer, Item, List, Real, SeError, Unit, document,
};
use serde::Serialize;

/// Root of `modelDescription.xml`.
#[derive(Clone, Debug, Serialize)]
#[serde(rename = "fmiModelDescription")]
pub struct FmiModelDescription {
    /// Version of the standard.
    #[serde(rename = "@fmiVersion")]
    pub fmi_version: &'static str,
    /// Name of the model.
    #[serde(rename = "@modelName")]
    pub model_name: String,
    /// Fingerprint that binds this description to its library.
    #[serde(rename = "@instantiationToken")]
    pub instantiation_token: String,
    /// What the model is, in one line.
    #[serde(rename = "@description")]
    pub description: String,
    /// Version of the model.
    #[serde(rename = "@version")]
    pub version: String,
    /// License of the model.
    #[serde(rename = "@license")]
    pub license: String,
    /// Name of the tool that wrote this file.
    #[serde(rename = "@generationTool")]
    pub generation_tool: String,
    /// How variable names are to be read.
    #[serde(rename = "@variableNamingConvention")]
    pub variable_naming_convention: &'static str,
    /// Capabilities of the model exchange interface.
    #[serde(rename = "ModelExchange")]
    pub model_exchange: ModelExchange,
    /// Capabilities of the co-simulation interface.
    #[serde(rename = "CoSimulation")]
    pub co_simulation: CoSimulation,
    /// Units of the variables.
    #[serde(rename = "UnitDefinitions", skip_serializing_if = "List::is_empty")]
    pub unit_definitions: List<Unit>,
    /// Types that variables declare.
    #[serde(rename = "TypeDefinitions", skip_serializing_if = "List::is_empty")]
    pub type_definitions: List<EnumerationType>,
    /// Log categories that can be switched on.
    #[serde(rename = "LogCategories")]
    pub log_categories: List<Category>,
    /// Settings of a simulation for which nothing else is asked.
    #[serde(rename = "DefaultExperiment")]
    pub default_experiment: DefaultExperiment,
    /// All variables.
    #[serde(rename = "ModelVariables")]
    pub model_variables: List<Variable>,
    /// What depends on what.
    #[serde(rename = "ModelStructure")]
    pub model_structure: ModelStructure,
}

impl FmiModelDescription {
    /// The text of `modelDescription.xml`.
    pub fn to_xml(&self) -> Result<String, SeError> {
        document(self)
    }
}

/// What both interfaces can do.
#[derive(Clone, Debug, Serialize)]
pub struct Capabilities {
    /// File name of the library, without extension.
    #[serde(rename = "@modelIdentifier")]
    pub model_identifier: String,
    /// The state can be taken out and put back.
    #[serde(rename = "@canGetAndSetFMUState")]
    pub can_get_and_set_fmu_state: bool,
    /// The state can be turned into bytes and back.
    #[serde(rename = "@canSerializeFMUState")]
    pub can_serialize_fmu_state: bool,
    /// Derivatives by inputs, in model exchange by states, too, can be asked for, in a direction.
    #[serde(rename = "@providesDirectionalDerivatives")]
    pub provides_directional_derivatives: bool,
}

/// Capabilities of the model exchange interface.
#[derive(Clone, Debug, Serialize)]
pub struct ModelExchange {
    /// What both interfaces can do.
    #[serde(flatten)]
    pub capabilities: Capabilities,
    /// `fmi3CompletedIntegratorStep` has to be called.
    #[serde(rename = "@needsCompletedIntegratorStep")]
    pub needs_completed_integrator_step: bool,
}

/// Capabilities of the co-simulation interface.
#[derive(Clone, Debug, Serialize)]
pub struct CoSimulation {
    /// What both interfaces can do.
    #[serde(flatten)]
    pub capabilities: Capabilities,
    /// Communication steps may differ in size.
    #[serde(rename = "@canHandleVariableCommunicationStepSize")]
    pub can_handle_variable_communication_step_size: bool,
    /// Highest order that `fmi3GetOutputDerivatives` gives.
    #[serde(rename = "@maxOutputDerivativeOrder")]
    pub max_output_derivative_order: u32,
    /// The host is called back within a step.
    #[serde(rename = "@providesIntermediateUpdate")]
    pub provides_intermediate_update: bool,
    /// A step may end early.
    #[serde(rename = "@mightReturnEarlyFromDoStep")]
    pub might_return_early_from_do_step: bool,
    /// Events can be handed over to the host.
    #[serde(rename = "@hasEventMode")]
    pub has_event_mode: bool,
}

/// The literals of an enumeration.
#[derive(Clone, Debug, Serialize)]
pub struct EnumerationType {
    /// Name by which variables refer to it.
    #[serde(rename = "@name")]
    pub name: String,
    /// What it is.
    #[serde(rename = "@description")]
    pub description: String,
    /// The literals.
    #[serde(rename = "Item")]
    pub items: Vec<Item>,
}

/// A variable, by the element of its type.
#[derive(Clone, Debug, Serialize)]
pub enum Variable {
    /// A real number.
    Float64(Of<Real>),
    /// An integer.
    Int32(Of<Integer>),
    /// True or false.
    Boolean(Of<Boolean>),
    /// Text.
    String(Of<Text>),
    /// A literal of a declared enumeration.
    Enumeration(Of<Enumeration>),
}

/// A variable of a type.
#[derive(Clone, Debug, Serialize)]
pub struct Of<T> {
    /// What all variables have.
    #[serde(flatten)]
    pub attributes: Attributes,
    /// Whether the host may give it within a step; left out where it may not.
    #[serde(rename = "@intermediateUpdate", skip_serializing_if = "Option::is_none")]
    pub intermediate_update: Option<bool>,
    /// What those of its type have.
    #[serde(flatten)]
    pub own: T,
}

/// What a string variable has.
#[derive(Clone, Debug, Serialize)]
pub struct Text {
    /// Value unless the environment sets another.
    #[serde(rename = "Start", skip_serializing_if = "Option::is_none")]
    pub start: Option<Start>,
}

/// Start value of a string variable.
#[derive(Clone, Debug, Serialize)]
pub struct Start {
    /// The text.
    #[serde(rename = "@value")]
    pub value: String,
}

/// What depends on what.
#[derive(Clone, Debug, Serialize)]
pub struct ModelStructure {
    /// Every output, with what it depends on at any time.
    #[serde(rename = "Output")]
    pub outputs: Vec<Unknown>,
    /// The derivative of every continuous state, with the same. Their order is that of the states.
    #[serde(rename = "ContinuousStateDerivative")]
    pub continuous_state_derivatives: Vec<Unknown>,
    /// Every variable that initialization calculates, with what it depends on there.
    #[serde(rename = "InitialUnknown")]
    pub initial_unknowns: Vec<Unknown>,
    /// The event indicators, with what they depend on at any time, in the order in which hosts are told of them.
    #[serde(rename = "EventIndicator")]
    pub event_indicators: Vec<Unknown>,
}

/// A calculated variable and what it depends on, by value references.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Unknown {
    /// The variable.
    #[serde(rename = "@valueReference")]
    pub value_reference: u32,
    /// The variables that it depends on; an empty list says that there are none.
    #[serde(rename = "@dependencies")]
    pub dependencies: Vec<u32>,
    /// How it depends on each of them.
    #[serde(rename = "@dependenciesKind")]
    pub dependencies_kind: Vec<&'static str>,
}
