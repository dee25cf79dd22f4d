//! `modelDescription.xml`, from the table of variables: of FMI 2.0, and in [`fmi3`] of FMI 3.0.

pub mod fmi3;

use crate::experiment::Experiment;
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
    experiment: Experiment,
) -> fmi::FmiModelDescription {
    fmi::FmiModelDescription {
        fmi_version: fmi::FmiVersion::V2_0,
        model_name: name.into(),
        guid: FlexibleRocking::guid(contents),
        description: DESCRIPTION.into(),
        version: env!("CARGO_PKG_VERSION").into(),
        license: env!("CARGO_PKG_LICENSE").into(),
        generation_tool: concat!("rocking-fmu ", env!("CARGO_PKG_VERSION")).into(),
        variable_naming_convention: fmi::VariableNamingConvention::Flat,
        number_of_event_indicators: INDICATORS,
        model_exchange: fmi::ModelExchange {
            model_identifier: name.into(),
            completed_integrator_step_not_needed: false,
            can_be_instantiated_only_once_per_process: false,
            can_not_use_memory_management_functions: true,
            can_get_and_set_fmu_state: true,
            can_serialize_fmu_state: true,
            provides_directional_derivative: true,
        },
        co_simulation: fmi::CoSimulation {
            model_identifier: name.into(),
            can_handle_variable_communication_step_size: true,
            can_interpolate_inputs: true,
            max_output_derivative_order: 1,
            can_be_instantiated_only_once_per_process: false,
            can_not_use_memory_management_functions: true,
            can_get_and_set_fmu_state: true,
            can_serialize_fmu_state: true,
            provides_directional_derivative: true,
        },
        unit_definitions: fmi::UnitDefinitions { units: units::definitions(structure) },
        type_definitions: fmi::TypeDefinitions { simple_types: [&PHASES, &DETAILS].map(enumeration_type).into() },
        log_categories: fmi::LogCategories { categories: logger::Category::ALL.map(log_category).into() },
        default_experiment: experiment.description(),
        model_variables: fmi::ModelVariables {
            scalar_variables: (0..)
                .zip(&*VARIABLES)
                .filter(|(_, variable)| variable.causality != Causality::Independent) // the standard's own
                .map(|(at, variable)| scalar_variable(at, variable, structure, contents))
                .collect(),
        },
        model_structure: model_structure(),
    }
}

fn enumeration_type(enumeration: &Enumeration) -> fmi::SimpleType {
    fmi::SimpleType {
        name: enumeration.name.into(),
        description: enumeration.description.into(),
        attributes: fmi::TypeAttributes::Enumeration(fmi::EnumerationType { items: items(enumeration) }),
    }
}

fn items(enumeration: &Enumeration) -> Vec<fmi::Item> {
    (1..).zip(enumeration.items).map(|(value, &name)| fmi::Item { name: name.into(), value }).collect()
}

fn log_category(category: logger::Category) -> fmi::Category {
    let name = category.name().to_string_lossy().into_owned();
    fmi::Category { name, description: category.description().into() }
}

/// The variable at position `at` of the table, which is its value reference.
fn scalar_variable(at: u32, variable: &Variable, structure: &Structure, contents: &Contents) -> fmi::ScalarVariable {
    let start = variable.start(contents);
    fmi::ScalarVariable {
        name: variable.name.into(),
        value_reference: at,
        description: variable.description.into(),
        causality: causality(variable),
        variability: variability(variable),
        initial: initial(variable),
        variable_type: match (variable.data_type, start) {
            (DataType::Real { unit, range }, start) => fmi::VariableType::Real(fmi::Real {
                unit: (unit != "1").then(|| unit.into()),
                display_unit: units::display_unit(variable, structure).map(Into::into),
                min: range.map(|(min, _)| min),
                max: range.map(|(_, max)| max),
                nominal: units::nominal(variable, structure),
                start: start.and_then(|value| if let Value::Real(value) = value { Some(value) } else { None }),
                derivative: variable.as_state_rate().map(|which| index(COMPONENTS[which])),
                reinit: variable.as_state().map(|_| true),
            }),
            (DataType::Integer, _) => fmi::VariableType::Integer(fmi::Integer { min: Some(0) }),
            (DataType::Boolean, start) => fmi::VariableType::Boolean(fmi::Boolean {
                start: start.and_then(|value| if let Value::Boolean(value) = value { Some(value) } else { None }),
            }),
            (DataType::String, start) => fmi::VariableType::String(fmi::Text {
                start: start.and_then(|value| if let Value::String(value) = value { Some(value) } else { None }),
            }),
            (DataType::Enumeration(enumeration), start) => fmi::VariableType::Enumeration(fmi::Enumeration {
                declared_type: enumeration.name.into(),
                start: start.and_then(|value| if let Value::Item(value) = value { Some(value) } else { None }),
            }),
        },
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
    let unknowns = |is_one: fn(&Variable) -> bool, dependencies: fn(&Variable) -> Vec<usize>| {
        let calculated = (1..).zip(&*VARIABLES).filter(|(_, variable)| is_one(variable));
        calculated.map(|(index, variable)| unknown(index, dependencies(variable))).collect()
    };
    let at_any_time: fn(&Variable) -> Vec<usize> = |v| v.feedthrough.iter().chain(v.states).map(|v| index(v)).collect();
    fmi::ModelStructure {
        outputs: fmi::Outputs { unknowns: unknowns(|v| v.causality == Causality::Output, at_any_time) },
        derivatives: fmi::Derivatives { unknowns: unknowns(|v| v.as_state_rate().is_some(), at_any_time) },
        initial_unknowns: fmi::InitialUnknowns {
            unknowns: unknowns(is_initial_unknown, |v| {
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

fn unknown(index: usize, dependencies: Vec<usize>) -> fmi::Unknown {
    let dependencies_kind = vec![fmi::DependenciesKind::Dependent; dependencies.len()];
    fmi::Unknown { index, dependencies, dependencies_kind }
}

/// Index of the variable called `name`; the first is 1.
fn index(name: &str) -> usize {
    let at = VARIABLES.iter().position(|variable| variable.name == name);
    1 + at.unwrap_or_else(|| panic!("no variable is called {name}"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use FlexibleRocking::resources::PackedRecord;
    use rocking::Parameters;
    use std::collections::BTreeSet;

    fn described(contents: &Contents) -> fmi::FmiModelDescription {
        let structure = Structure::new(contents.parameters).unwrap();
        model_description("Pier", &structure, contents, Experiment { stop_time: 4.0, step_size: 0.005 })
    }

    #[test]
    fn every_variable_is_there_once_in_the_order_of_the_table() {
        let written = described(&Parameters::MCMANUS.into()).model_variables.scalar_variables;
        let names: Vec<_> = written.iter().map(|variable| variable.name.as_str()).collect();
        let but_time = VARIABLES.iter().filter(|variable| variable.causality != Causality::Independent);
        assert_eq!(names, but_time.map(|variable| variable.name).collect::<Vec<_>>());
        assert_eq!(names.iter().collect::<BTreeSet<_>>().len(), names.len());
        let references: Vec<_> = written.iter().map(|variable| variable.value_reference).collect();
        assert_eq!(references, (0..names.len() as u32).collect::<Vec<_>>());
    }

    #[test]
    fn the_structure_points_at_the_outputs_and_at_what_initialization_calculates() {
        let description = described(&Parameters::MCMANUS.into());
        let variables = &description.model_variables.scalar_variables;
        let name = |index: &usize| variables[index - 1].name.as_str();
        let names = |unknowns: &[fmi::Unknown]| unknowns.iter().map(|u| name(&u.index).to_owned()).collect::<Vec<_>>();

        let outputs = "theta u a_t V_t M_t uplift delta_t v_t R_h R_v R_m P_t F_d1 F_d2 I_h I_v I_m";
        let calculated_parameters = "alpha_cg p_l chi u_cr f_u record_duration";
        let structure = &description.model_structure;
        assert_eq!(names(&structure.outputs.unknowns).join(" "), outputs);
        for unknown in &structure.outputs.unknowns {
            let dependencies = unknown.dependencies.iter().map(name).collect::<Vec<_>>();
            let expected = match name(&unknown.index) {
                "a_t" | "V_t" | "M_t" | "R_h" | "R_v" | "R_m" => "a_g F_t a_v u u_dot theta theta_dot",
                "v_t" => "u u_dot theta theta_dot",
                "delta_t" => "u theta",
                "theta" | "uplift" | "P_t" => "theta",
                "F_d1" | "F_d2" => "theta theta_dot",
                "u" => "u",
                _ => "",
            };
            assert_eq!(dependencies.join(" "), expected, "{}", name(&unknown.index));
        }
        let rates = "der(u) der(u_dot) der(theta) der(theta_dot)";
        assert_eq!(names(&structure.derivatives.unknowns).join(" "), rates);
        let of = |unknown: &fmi::Unknown| match &variables[unknown.index - 1].variable_type {
            fmi::VariableType::Real(real) => name(&real.derivative.unwrap()).to_owned(),
            other => panic!("{other:?}"),
        };
        assert_eq!(structure.derivatives.unknowns.iter().map(of).collect::<Vec<_>>(), COMPONENTS);
        let is_set_by_events = |variable: &&fmi::ScalarVariable| matches!(&variable.variable_type, fmi::VariableType::Real(real) if real.reinit == Some(true));
        let set_by_events: BTreeSet<_> = variables.iter().filter(is_set_by_events).map(|v| v.name.as_str()).collect();
        assert_eq!(set_by_events, COMPONENTS.into());
        let initial = &structure.initial_unknowns.unknowns;
        assert_eq!(names(initial).join(" "), format!("{outputs} theta_dot u_dot {rates} {calculated_parameters}"));

        let p_l = initial.iter().find(|unknown| name(&unknown.index) == "p_l").unwrap();
        assert_eq!(p_l.dependencies.iter().map(name).collect::<Vec<_>>(), ["m", "m0", "H", "B", "J0", "g"]);
        for unknown in initial {
            assert_eq!(unknown.dependencies.len(), unknown.dependencies_kind.len());
            for known in &unknown.dependencies {
                let known = &variables[known - 1];
                assert!(
                    known.initial == Some(fmi::Initial::Exact) || known.causality == fmi::Causality::Input,
                    "{}",
                    known.name
                );
            }
        }
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
            r#"exact: within steps, too, and during a fall to overturning; NaN unless peaks is true" causality="local" variability="continuous" initial="calculated">
      <Real unit="rad" displayUnit="deg" nominal="0.351"/>"#,
            r#"modelName="Pier" guid"#,
            r#"<CoSimulation modelIdentifier="Pier" "#,
            r#"<DefaultExperiment startTime="0.0" stopTime="4.0" tolerance="1e-9" stepSize="0.005"/>"#,
        ] {
            assert!(xml.contains(element), "{element}\n{xml}");
        }
    }
}
