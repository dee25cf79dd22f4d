//! FMI 2.0 model description of a unit for model exchange and co-simulation: its types, named as in the standard, and their XML.
//!
//! A [`Description`] makes a [`FmiModelDescription`] of a table of variables; call [`FmiModelDescription::to_xml`]. The fields stand in the order that the
//! standard's schema asks of the elements; an attribute that is `None` is left out. What FMI 3.0 has otherwise is in [`fmi3`].

pub mod archive;
mod description;
pub mod fmi3;
mod model_structure;
mod model_variables;
mod unit_definitions;

pub use description::Description;
pub use model_structure::{DEPENDENT, ModelStructure, Unknown};
pub use model_variables::{
    Attributes, Boolean, Causality, Enumeration, Initial, Integer, ModelVariables, Real, ScalarVariable, Text,
    Variability, VariableType,
};
pub use quick_xml::SeError;
pub use unit_definitions::{BaseUnit, DisplayUnit, Unit};

use quick_xml::se::Serializer as XmlSerializer;
use serde::{Serialize, Serializer};

/// How variable names are to be read: as plain strings.
pub const FLAT: &str = "flat";

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
    #[serde(rename = "@guid")]
    pub guid: String,
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
    /// How many event indicators model exchange has.
    #[serde(rename = "@numberOfEventIndicators")]
    pub number_of_event_indicators: usize,
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
    pub type_definitions: List<SimpleType>,
    /// Log categories that can be switched on.
    #[serde(rename = "LogCategories")]
    pub log_categories: List<Category>,
    /// Settings of a simulation for which nothing else is asked.
    #[serde(rename = "DefaultExperiment")]
    pub default_experiment: DefaultExperiment,
    /// All variables; the first has index 1.
    #[serde(rename = "ModelVariables")]
    pub model_variables: ModelVariables,
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

/// The XML of `root`: declaration, elements indented by two spaces, a final line feed.
fn document(root: &impl Serialize) -> Result<String, SeError> {
    let mut xml = String::from("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n");
    let mut serializer = XmlSerializer::new(&mut xml);
    serializer.indent(' ', 2);
    root.serialize(serializer)?;
    xml.push('\n');
    Ok(xml)
}

/// Elements of one kind, each under the name of its type.
#[derive(Clone, Debug, Serialize)]
pub struct List<T> {
    /// The elements.
    #[serde(rename = "$value")]
    pub items: Vec<T>,
}

impl<T> List<T> {
    fn is_empty(&self) -> bool {
        self.items.is_empty()
    }
}

/// What both interfaces can do. An attribute with the standard's default is left out.
#[derive(Clone, Debug, Serialize)]
pub struct Capabilities {
    /// The host's memory callbacks are not used.
    #[serde(rename = "@canNotUseMemoryManagementFunctions")]
    pub can_not_use_memory_management_functions: bool,
    /// The state can be taken out and put back.
    #[serde(rename = "@canGetAndSetFMUstate")]
    pub can_get_and_set_fmu_state: bool,
    /// The state can be turned into bytes and back.
    #[serde(rename = "@canSerializeFMUstate")]
    pub can_serialize_fmu_state: bool,
    /// Derivatives by inputs, in model exchange by states, too, can be asked for.
    #[serde(rename = "@providesDirectionalDerivative")]
    pub provides_directional_derivative: bool,
}

/// Capabilities of the model exchange interface.
#[derive(Clone, Debug, Serialize)]
pub struct ModelExchange {
    /// File name of the library, without extension.
    #[serde(rename = "@modelIdentifier")]
    pub model_identifier: String,
    /// What both interfaces can do.
    #[serde(flatten)]
    pub capabilities: Capabilities,
}

/// Capabilities of the co-simulation interface.
#[derive(Clone, Debug, Serialize)]
pub struct CoSimulation {
    /// File name of the library, without extension.
    #[serde(rename = "@modelIdentifier")]
    pub model_identifier: String,
    /// Communication steps may differ in size.
    #[serde(rename = "@canHandleVariableCommunicationStepSize")]
    pub can_handle_variable_communication_step_size: bool,
    /// `fmi2SetRealInputDerivatives` is understood.
    #[serde(rename = "@canInterpolateInputs")]
    pub can_interpolate_inputs: bool,
    /// Highest order that `fmi2GetRealOutputDerivatives` gives.
    #[serde(rename = "@maxOutputDerivativeOrder")]
    pub max_output_derivative_order: u32,
    /// What both interfaces can do.
    #[serde(flatten)]
    pub capabilities: Capabilities,
}

/// An enumeration that variables declare.
#[derive(Clone, Debug, Serialize)]
pub struct SimpleType {
    /// Name by which variables refer to it; no variable may have the same.
    #[serde(rename = "@name")]
    pub name: String,
    /// What it is.
    #[serde(rename = "@description")]
    pub description: String,
    /// Its literals.
    #[serde(rename = "Enumeration")]
    pub enumeration: List<Item>,
}

/// A literal of an enumeration.
#[derive(Clone, Debug, Serialize)]
pub struct Item {
    /// Its name.
    #[serde(rename = "@name")]
    pub name: String,
    /// The integer that stands for it.
    #[serde(rename = "@value")]
    pub value: i32,
}

/// A log category.
#[derive(Clone, Debug, Serialize)]
pub struct Category {
    /// Name under which `fmi2SetDebugLogging` knows it.
    #[serde(rename = "@name")]
    pub name: String,
    /// What it logs.
    #[serde(rename = "@description")]
    pub description: String,
}

/// Settings of a simulation for which nothing else is asked.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct DefaultExperiment {
    /// Start time, s.
    #[serde(rename = "@startTime", serialize_with = "shortest")]
    pub start_time: f64,
    /// Stop time, s.
    #[serde(rename = "@stopTime", serialize_with = "shortest")]
    pub stop_time: f64,
    /// Relative tolerance.
    #[serde(rename = "@tolerance", serialize_with = "shortest")]
    pub tolerance: f64,
    /// Communication step, s.
    #[serde(rename = "@stepSize", serialize_with = "shortest")]
    pub step_size: f64,
}

impl Default for DefaultExperiment {
    fn default() -> DefaultExperiment {
        DefaultExperiment { start_time: 0.0, stop_time: 3.0, tolerance: 1e-9, step_size: 0.01 }
    }
}

/// Writes a number with the fewest digits that read back the same: `1e-9`, not `0.000000001`.
fn shortest<S: Serializer>(number: &(impl Copy + Into<Option<f64>>), serializer: S) -> Result<S::Ok, S::Error> {
    match (*number).into() {
        Some(number) => serializer.collect_str(&format_args!("{number:?}")),
        None => serializer.serialize_none(),
    }
}
