use crate::shortest;
use serde::Serialize;

/// All variables; the first has index 1.
#[derive(Clone, Debug, Serialize)]
pub struct ModelVariables {
    /// The variables.
    #[serde(rename = "ScalarVariable")]
    pub scalar_variables: Vec<ScalarVariable>,
}

/// A variable.
#[derive(Clone, Debug, Serialize)]
pub struct ScalarVariable {
    /// What all variables have.
    #[serde(flatten)]
    pub attributes: Attributes,
    /// Its type.
    #[serde(rename = "$value")]
    pub variable_type: VariableType,
}

/// What all variables have.
#[derive(Clone, Debug, Serialize)]
pub struct Attributes {
    /// Unique name.
    #[serde(rename = "@name")]
    pub name: String,
    /// Handle by which the interface's functions know it.
    #[serde(rename = "@valueReference")]
    pub value_reference: u32,
    /// What it is, in one line.
    #[serde(rename = "@description")]
    pub description: String,
    /// Who sets it.
    #[serde(rename = "@causality")]
    pub causality: Causality,
    /// When it changes.
    #[serde(rename = "@variability")]
    pub variability: Variability,
    /// How it gets its first value; none for an input.
    #[serde(rename = "@initial", skip_serializing_if = "Option::is_none")]
    pub initial: Option<Initial>,
}

/// Who sets a variable.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "camelCase")]
pub enum Causality {
    /// The user, before the simulation.
    Parameter,
    /// The model, from its parameters.
    CalculatedParameter,
    /// The environment, during the simulation.
    Input,
    /// The model, for the environment.
    Output,
    /// The model, for display.
    Local,
    /// Time, on which all others depend.
    Independent,
}

/// When a variable changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "camelCase")]
pub enum Variability {
    /// Not after initialization.
    Fixed,
    /// At events only.
    Discrete,
    /// At any time.
    Continuous,
}

/// How a variable gets its first value.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "camelCase")]
pub enum Initial {
    /// It is the start value.
    Exact,
    /// The model calculates it.
    Calculated,
}

/// Type of a variable, by the element that holds its attributes.
#[derive(Clone, Debug, Serialize)]
pub enum VariableType {
    /// A real number.
    Real(Real),
    /// An integer.
    Integer(Integer),
    /// True or false.
    Boolean(Boolean),
    /// Text.
    String(Text),
    /// A literal of a declared enumeration.
    Enumeration(Enumeration),
}

/// Attributes of a real variable.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Real {
    /// Name of its unit; none for a ratio.
    #[serde(rename = "@unit", skip_serializing_if = "Option::is_none")]
    pub unit: Option<String>,
    /// Name of the unit that it is best shown in, where that is another.
    #[serde(rename = "@displayUnit", skip_serializing_if = "Option::is_none")]
    pub display_unit: Option<String>,
    /// Smallest value.
    #[serde(rename = "@min", skip_serializing_if = "Option::is_none", serialize_with = "shortest")]
    pub min: Option<f64>,
    /// Largest value.
    #[serde(rename = "@max", skip_serializing_if = "Option::is_none", serialize_with = "shortest")]
    pub max: Option<f64>,
    /// Magnitude that is usual for it.
    #[serde(rename = "@nominal", skip_serializing_if = "Option::is_none", serialize_with = "shortest")]
    pub nominal: Option<f64>,
    /// Value unless the environment sets another.
    #[serde(rename = "@start", skip_serializing_if = "Option::is_none", serialize_with = "shortest")]
    pub start: Option<f64>,
    /// The state whose derivative it is: its index, in FMI 3.0 its value reference.
    #[serde(rename = "@derivative", skip_serializing_if = "Option::is_none")]
    pub derivative: Option<u32>,
    /// Whether an event may change it, of a continuous state.
    #[serde(rename = "@reinit", skip_serializing_if = "Option::is_none")]
    pub reinit: Option<bool>,
}

/// Attributes of an integer variable.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Integer {
    /// Smallest value.
    #[serde(rename = "@min", skip_serializing_if = "Option::is_none")]
    pub min: Option<i32>,
}

/// Attributes of a Boolean variable.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Boolean {
    /// Value unless the environment sets another.
    #[serde(rename = "@start", skip_serializing_if = "Option::is_none")]
    pub start: Option<bool>,
}

/// Attributes of a string variable.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Text {
    /// Value unless the environment sets another.
    #[serde(rename = "@start", skip_serializing_if = "Option::is_none")]
    pub start: Option<String>,
}

/// Attributes of an enumeration variable.
#[derive(Clone, Debug, Serialize)]
pub struct Enumeration {
    /// Name of the type that lists its literals.
    #[serde(rename = "@declaredType")]
    pub declared_type: String,
    /// Number of the literal that it has unless the environment sets another.
    #[serde(rename = "@start", skip_serializing_if = "Option::is_none")]
    pub start: Option<i32>,
}
