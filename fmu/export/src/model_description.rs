//! `modelDescription.xml`, from the table of variables: of FMI 2.0, and in [`fmi3`] of FMI 3.0.

pub mod fmi3;

use crate::units;
use FlexibleRocking::logger;
use FlexibleRocking::resources::Contents;
use FlexibleRocking::variables::{Causality, DETAILS, DataType, Enumeration, PHASES, VARIABLES, Value, Variable};
use model_description as fmi;
use rocking::Structure;
use rocking::mechanics::state::COMPONENTS;
use rocking::run::outside_step::INDICATORS;

/// What the model is, in one line.
pub const DESCRIPTION: &str = "A flexible structure that rocks freely on rigid ground under earthquake ground motion";

/// The description of the FMU `name` of `structure` with these `contents`.
pub fn model_description(
    name: &str,
    structure: &Structure,
    contents: &Contents,
    default_experiment: fmi::DefaultExperiment,
) -> fmi::FmiModelDescription {
    fmi::FmiModelDescription {
        fmi_version: "2.0",
        model_name: name.into(),
        guid: FlexibleRocking::guid(contents),
        description: DESCRIPTION.into(),
        version: env!("CARGO_PKG_VERSION").into(),
        license: env!("CARGO_PKG_LICENSE").into(),
        generation_tool: concat!("rocking-fmu ", env!("CARGO_PKG_VERSION")).into(),
        variable_naming_convention: fmi::FLAT,
        number_of_event_indicators: INDICATORS,
        model_exchange: fmi::ModelExchange { model_identifier: name.into(), capabilities: capabilities() },
        co_simulation: fmi::CoSimulation {
            model_identifier: name.into(),
            can_handle_variable_communication_step_size: true,
            can_interpolate_inputs: true,
            max_output_derivative_order: 1,
            capabilities: capabilities(),
        },
        unit_definitions: fmi::List { items: units::definitions(structure) },
        type_definitions: fmi::List { items: [&PHASES, &DETAILS].map(enumeration_type).into() },
        log_categories: fmi::List { items: logger::Category::ALL.map(log_category).into() },
        default_experiment,
        model_variables: fmi::ModelVariables {
            scalar_variables: (0..)
                .zip(&*VARIABLES)
                .filter(|(_, variable)| variable.causality != Causality::Independent) // the standard's own
                .map(|(at, variable)| fmi::ScalarVariable {
                    attributes: attributes(at, variable),
                    variable_type: variable_type(variable, structure, contents, index),
                })
                .collect(),
        },
        model_structure: model_structure(),
    }
}

fn capabilities() -> fmi::Capabilities {
    fmi::Capabilities {
        can_not_use_memory_management_functions: true,
        can_get_and_set_fmu_state: true,
        can_serialize_fmu_state: true,
        provides_directional_derivative: true,
    }
}

fn enumeration_type(enumeration: &Enumeration) -> fmi::SimpleType {
    fmi::SimpleType {
        name: enumeration.name.into(),
        description: enumeration.description.into(),
        enumeration: fmi::List { items: items(enumeration) },
    }
}

fn items(enumeration: &Enumeration) -> Vec<fmi::Item> {
    (1..).zip(enumeration.items).map(|(value, &name)| fmi::Item { name: name.into(), value }).collect()
}

fn log_category(category: logger::Category) -> fmi::Category {
    let name = category.name().to_string_lossy().into_owned();
    fmi::Category { name, description: category.description().into() }
}

/// What the variable at position `at` of the table, which is its value reference, has whatever its type.
fn attributes(at: u32, variable: &Variable) -> fmi::Attributes {
    fmi::Attributes {
        name: variable.name.into(),
        value_reference: at,
        description: variable.description.into(),
        causality: causality(variable),
        variability: variability(variable),
        initial: initial(variable),
    }
}

/// The type of `variable`; `place` is how a version points at the state that it is the derivative of.
fn variable_type(
    variable: &Variable,
    structure: &Structure,
    contents: &Contents,
    place: fn(&str) -> u32,
) -> fmi::VariableType {
    let start = variable.start(contents);
    match variable.data_type {
        DataType::Real { unit, range } => fmi::VariableType::Real(fmi::Real {
            unit: (unit != "1").then(|| unit.into()),
            display_unit: units::display_unit(variable, structure).map(Into::into),
            min: range.map(|(min, _)| min),
            max: range.map(|(_, max)| max),
            nominal: units::nominal(variable, structure),
            start: start.and_then(|value| if let Value::Real(value) = value { Some(value) } else { None }),
            derivative: variable.as_state_rate().map(|which| place(COMPONENTS[which])),
            reinit: variable.as_state().map(|_| true),
        }),
        DataType::Integer => fmi::VariableType::Integer(fmi::Integer { min: Some(0) }),
        DataType::Boolean => fmi::VariableType::Boolean(fmi::Boolean {
            start: start.and_then(|value| if let Value::Boolean(value) = value { Some(value) } else { None }),
        }),
        DataType::String => fmi::VariableType::String(fmi::Text {
            start: start.and_then(|value| if let Value::String(value) = value { Some(value) } else { None }),
        }),
        DataType::Enumeration(enumeration) => fmi::VariableType::Enumeration(fmi::Enumeration {
            declared_type: enumeration.name.into(),
            start: start.and_then(|value| if let Value::Item(value) = value { Some(value) } else { None }),
        }),
    }
}

fn causality(variable: &Variable) -> fmi::Causality {
    match variable.causality {
        Causality::Parameter => fmi::Causality::Parameter,
        Causality::CalculatedParameter => fmi::Causality::CalculatedParameter,
        Causality::Input => fmi::Causality::Input,
        Causality::Output => fmi::Causality::Output,
        Causality::Local => fmi::Causality::Local,
        Causality::Independent => fmi::Causality::Independent,
    }
}

fn variability(variable: &Variable) -> fmi::Variability {
    match variable.causality {
        Causality::Parameter | Causality::CalculatedParameter => fmi::Variability::Fixed,
        _ if variable.is_continuous() => fmi::Variability::Continuous,
        Causality::Input | Causality::Output | Causality::Local | Causality::Independent => fmi::Variability::Discrete,
    }
}

fn initial(variable: &Variable) -> Option<fmi::Initial> {
    match variable.causality {
        Causality::Parameter => Some(fmi::Initial::Exact),
        Causality::CalculatedParameter | Causality::Output | Causality::Local => Some(fmi::Initial::Calculated),
        Causality::Input | Causality::Independent => None,
    }
}

/// At any time the outputs and the derivatives of the states depend on states and on their feedthrough; at initialization they
/// and the states on their feedthrough and on what else the table says, as calculated parameters do. Other local variables are in
/// no list.
fn model_structure() -> fmi::ModelStructure {
    let unknowns = |is_one: fn(&Variable) -> bool, dependencies: fn(&Variable) -> Vec<u32>| {
        let calculated = (1..).zip(&*VARIABLES).filter(|(_, variable)| is_one(variable));
        calculated.map(|(index, variable)| unknown(index, dependencies(variable))).collect()
    };
    let at_any_time: fn(&Variable) -> Vec<u32> = |v| v.feedthrough.iter().chain(v.states).map(|v| index(v)).collect();
    fmi::ModelStructure {
        outputs: fmi::List { items: unknowns(|v| v.causality == Causality::Output, at_any_time) },
        derivatives: fmi::List { items: unknowns(|v| v.as_state_rate().is_some(), at_any_time) },
        initial_unknowns: fmi::List {
            items: unknowns(is_initial_unknown, |v| {
                v.feedthrough.iter().chain(v.initial_dependencies).map(|name| index(name)).collect()
            }),
        },
    }
}

/// Whether initialization calculates it for others: outputs, calculated parameters, states and their derivatives.
fn is_initial_unknown(variable: &Variable) -> bool {
    matches!(variable.causality, Causality::Output | Causality::CalculatedParameter)
        || variable.as_state().or(variable.as_state_rate()).is_some()
}

fn unknown(index: u32, dependencies: Vec<u32>) -> fmi::Unknown {
    let dependencies_kind = vec![fmi::DEPENDENT; dependencies.len()];
    fmi::Unknown { index, dependencies, dependencies_kind }
}

/// Index of the variable called `name`; the first is 1.
fn index(name: &str) -> u32 {
    let known = (1..).zip(&*VARIABLES).find(|(_, variable)| variable.name == name);
    known.map_or_else(|| panic!("no variable is called {name}"), |(index, _)| index)
}

#[cfg(test)]
mod tests {
    use super::*;
    use FlexibleRocking::resources::PackedRecord;
    use rocking::Parameters;

    fn described(contents: &Contents) -> fmi::FmiModelDescription {
        let structure = Structure::new(contents.parameters).unwrap();
        let experiment = fmi::DefaultExperiment { start_time: 0.0, stop_time: 4.0, tolerance: 1e-9, step_size: 0.005 };
        model_description("Pier", &structure, contents, experiment)
    }

    /// What the table says of a few variables is what the description points at.
    #[test]
    fn the_structure_points_at_what_the_table_names() {
        let description = described(&Parameters::MCMANUS.into());
        let variables = &description.model_variables.scalar_variables;
        let name = |index: &u32| variables[*index as usize - 1].attributes.name.as_str();
        let fmi::ModelStructure { outputs, derivatives, initial_unknowns } = &description.model_structure;
        let dependencies = |unknowns: &fmi::List<fmi::Unknown>, of: &str| {
            let unknown = unknowns.items.iter().find(|unknown| name(&unknown.index) == of).unwrap();
            unknown.dependencies.iter().map(name).collect::<Vec<_>>().join(" ")
        };
        assert_eq!(dependencies(outputs, "a_t"), "a_g F_t a_v u u_dot theta theta_dot");
        assert_eq!(dependencies(outputs, "delta_t"), "u theta");
        assert_eq!(dependencies(outputs, "I_v"), "");
        assert_eq!(dependencies(derivatives, "der(u)"), "u_dot");
        assert_eq!(dependencies(initial_unknowns, "p_l"), "m m0 H B J0 g");
        let of = |unknown: &fmi::Unknown| match &variables[unknown.index as usize - 1].variable_type {
            fmi::VariableType::Real(real) => name(&real.derivative.unwrap()).to_owned(),
            other => panic!("{other:?}"),
        };
        assert_eq!(derivatives.items.iter().map(of).collect::<Vec<_>>(), COMPONENTS);
    }

    #[test]
    fn start_values_are_those_of_the_structure() {
        let record = PackedRecord { file: "pulse & rest.csv".into(), digest: "any".into() };
        let contents = Contents { parameters: Parameters::EVISON, records: vec![record], vertical: None };
        let xml = described(&contents).to_xml().unwrap();
        for element in [
            r#"name="a_g" valueReference="0" description="horizontal ground acceleration, positive to the right" causality="input" variability="continuous">
      <Real unit="m/s2" displayUnit="g" min="-10000.0" max="10000.0" nominal="3.59" start="0.0"/>"#,
            r#"description="natural frequency in full contact (fixed base)" causality="parameter" variability="fixed" initial="exact">
      <Real unit="Hz" min="0.001" max="10000.0" start="11.0"/>"#,
            r#"description="damping ratio in full contact" causality="parameter" variability="fixed" initial="exact">
      <Real min="0.0" max="10.0" start="0.015"/>"#,
            r#"description="modal participation of rocking" causality="calculatedParameter" variability="fixed" initial="calculated">
      <Real/>"#,
            r#"description="what holds of the base" causality="local" variability="discrete" initial="calculated">
      <Enumeration declaredType="Phase"/>"#,
            r#"<Item name="rocking left" value="2"/>"#,
            r#"<String start="pulse &amp; rest.csv"/>"#,
            r#"description="whether the largest magnitudes theta_max, u_max, ... are watched for" causality="parameter" variability="fixed" initial="exact">
      <Boolean start="false"/>"#,
            r#"exact: within steps, too; if the structure overturns, before its fall; NaN unless peaks is true" causality="local" variability="continuous" initial="calculated">
      <Real unit="rad" displayUnit="deg" nominal="0.351"/>"#,
            r#"<BaseUnit kg="1" m="1" s="-2"/>"#,
            r#"modelName="Pier" guid"#,
            r#"<CoSimulation modelIdentifier="Pier" "#,
            r#"<DefaultExperiment startTime="0.0" stopTime="4.0" tolerance="1e-9" stepSize="0.005"/>"#,
        ] {
            assert!(xml.contains(element), "{element}\n{xml}");
        }
    }
}
