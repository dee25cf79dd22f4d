//! The description in FMI 3.0.

use super::{DESCRIPTION, attributes, index, is_initial_unknown, items, log_category, variable_type};
use crate::units;
use FlexibleRocking::logger;
use FlexibleRocking::resources::Contents;
use FlexibleRocking::variables::{Causality, DETAILS, Enumeration, PHASES, VARIABLES, Variable};
use model_description as fmi;
use model_description::fmi3;
use rocking::Structure;
use rocking::mechanics::state::INITIAL_VALUES;

/// The description of the FMU `name` of `structure` with these `contents`.
pub fn model_description(
    name: &str,
    structure: &Structure,
    contents: &Contents,
    default_experiment: fmi::DefaultExperiment,
) -> fmi3::FmiModelDescription {
    fmi3::FmiModelDescription {
        fmi_version: "3.0",
        model_name: name.into(),
        instantiation_token: FlexibleRocking::guid(contents),
        description: DESCRIPTION.into(),
        version: env!("CARGO_PKG_VERSION").into(),
        license: env!("CARGO_PKG_LICENSE").into(),
        generation_tool: concat!("rocking-fmu ", env!("CARGO_PKG_VERSION")).into(),
        variable_naming_convention: fmi::FLAT,
        model_exchange: fmi3::ModelExchange { capabilities: capabilities(name), needs_completed_integrator_step: true },
        co_simulation: fmi3::CoSimulation {
            capabilities: capabilities(name),
            can_handle_variable_communication_step_size: true,
            max_output_derivative_order: 1,
            provides_intermediate_update: true,
            might_return_early_from_do_step: true,
            has_event_mode: true,
        },
        unit_definitions: fmi::List { items: units::definitions(structure) },
        type_definitions: fmi::List { items: [&PHASES, &DETAILS].map(enumeration_type).into() },
        log_categories: fmi::List { items: logger::Category::ALL.map(log_category).into() },
        default_experiment,
        model_variables: fmi::List {
            items: (0..).zip(&*VARIABLES).map(|(at, variable)| of_type(at, variable, structure, contents)).collect(),
        },
        model_structure: model_structure(),
    }
}

fn enumeration_type(enumeration: &Enumeration) -> fmi3::EnumerationType {
    fmi3::EnumerationType {
        name: enumeration.name.into(),
        description: enumeration.description.into(),
        items: items(enumeration),
    }
}

fn capabilities(name: &str) -> fmi3::Capabilities {
    fmi3::Capabilities {
        model_identifier: name.into(),
        can_get_and_set_fmu_state: true,
        can_serialize_fmu_state: true,
        provides_directional_derivatives: true,
    }
}

/// The variable at position `at` of the table, which is its value reference.
fn of_type(at: u32, variable: &Variable, structure: &Structure, contents: &Contents) -> fmi3::Variable {
    let is_given_within_steps = variable.is_continuous() && variable.causality != Causality::Independent;
    let (attributes, intermediate_update) = (attributes(at, variable), is_given_within_steps.then_some(true));
    match variable_type(variable, structure, contents, reference) {
        fmi::VariableType::Real(own) => fmi3::Variable::Float64(fmi3::Of { attributes, intermediate_update, own }),
        fmi::VariableType::Integer(own) => fmi3::Variable::Int32(fmi3::Of { attributes, intermediate_update, own }),
        fmi::VariableType::Boolean(own) => fmi3::Variable::Boolean(fmi3::Of { attributes, intermediate_update, own }),
        fmi::VariableType::String(text) => {
            let own = fmi3::Text { start: text.start.map(|value| fmi3::Start { value }) };
            fmi3::Variable::String(fmi3::Of { attributes, intermediate_update, own })
        }
        fmi::VariableType::Enumeration(own) => {
            fmi3::Variable::Enumeration(fmi3::Of { attributes, intermediate_update, own })
        }
    }
}

/// At any time the outputs, the derivatives of the states and the event indicators depend on their feedthrough, on the
/// states, which the initial values have led to, on parameters, and on time where a record acts; at initialization on their
/// feedthrough and on what the table says as well, as calculated parameters do. Other local variables are in no list.
fn model_structure() -> fmi3::ModelStructure {
    let unknowns = |is_one: fn(&Variable) -> bool, dependencies: fn(&Variable) -> Vec<u32>| {
        let calculated = (0..).zip(&*VARIABLES).filter(|(_, variable)| is_one(variable));
        calculated.map(|(reference, variable)| unknown(reference, dependencies(variable))).collect()
    };
    let at_any_time: fn(&Variable) -> Vec<u32> = |v| {
        let is_parameter = |name: &&&str| INITIAL_VALUES.iter().all(|initial| initial.name != **name);
        let parameters = v.initial_dependencies.iter().filter(is_parameter);
        let time = v.initial_dependencies.contains(&"record").then_some(&"time");
        v.feedthrough.iter().chain(v.states).chain(parameters).chain(time).map(|name| reference(name)).collect()
    };
    fmi3::ModelStructure {
        outputs: unknowns(|v| v.causality == Causality::Output, at_any_time),
        continuous_state_derivatives: unknowns(|v| v.as_state_rate().is_some(), at_any_time),
        initial_unknowns: unknowns(is_initial_unknown, |v| {
            v.feedthrough.iter().chain(v.initial_dependencies).map(|name| reference(name)).collect()
        }),
        event_indicators: unknowns(|v| v.as_indicator().is_some(), at_any_time),
    }
}

fn unknown(value_reference: u32, dependencies: Vec<u32>) -> fmi3::Unknown {
    let dependencies_kind = vec![fmi::DEPENDENT; dependencies.len()];
    fmi3::Unknown { value_reference, dependencies, dependencies_kind }
}

/// The value reference of the variable called `name`, its position in the table.
fn reference(name: &str) -> u32 {
    index(name) - 1
}

#[cfg(test)]
mod tests {
    use super::*;
    use rocking::Parameters;

    /// Knowns at any time are inputs, states, parameters, though not those that the states began from, and time.
    #[test]
    fn the_structure_points_at_what_the_table_names() {
        let contents = Contents::from(Parameters::MCMANUS);
        let structure = Structure::new(Parameters::MCMANUS).unwrap();
        let experiment = crate::experiment::default_experiment(&structure, None);
        let description = model_description("Pier", &structure, &contents, experiment);
        let fmi3::ModelStructure { outputs, continuous_state_derivatives, initial_unknowns, event_indicators } =
            &description.model_structure;
        let dependencies = |unknowns: &[fmi3::Unknown], of: &str| {
            let unknown = unknowns.iter().find(|unknown| unknown.value_reference == reference(of)).unwrap();
            let names = unknown.dependencies.iter().map(|at| VARIABLES[*at as usize].name);
            names.collect::<Vec<_>>().join(" ")
        };
        assert_eq!(dependencies(outputs, "delta_t"), "u theta H B");
        assert_eq!(
            dependencies(continuous_state_derivatives, "der(u_dot)"),
            "a_g F_t a_v u u_dot theta theta_dot m m0 H B J0 f_fc zeta_fc c_ratio g detail P_0 k_t xi_d c_d k_d F_y record \
             record_v record_scale record_time_scale record_start time"
        );
        assert_eq!(dependencies(event_indicators, "overturning_indicator"), "theta theta_dot B xi_d k_d F_y");
        assert_eq!(dependencies(initial_unknowns, "delta_t"), "H B theta_0 u_0");
        let xml = description.to_xml().unwrap();
        for element in [
            r#"causality="input" variability="continuous" intermediateUpdate="true" unit="m/s2" displayUnit="g" min="-10000.0" max="10000.0""#,
            r#"causality="output" variability="discrete" initial="calculated" unit="N.s""#,
            r#"causality="parameter" variability="fixed" initial="exact" declaredType="Detail" start="1"/>"#,
            r#"      <Start value=""/>"#,
            r#"derivative="3"/>"#,
        ] {
            assert!(xml.contains(element), "{element}\n{xml}");
        }
    }
}
