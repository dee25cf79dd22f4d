//! The description in FMI 3.0.

use super::{DESCRIPTION, causality, index, initial, is_initial_unknown, items, log_category, variability};
use crate::experiment::Experiment;
use crate::units;
use FlexibleRocking::logger;
use FlexibleRocking::resources::Contents;
use FlexibleRocking::variables::{Causality, DETAILS, DataType, Enumeration, PHASES, VARIABLES, Value, Variable};
use model_description as fmi;
use model_description::fmi3;
use rocking::Structure;
use rocking::mechanics::state::{COMPONENTS, INITIAL_VALUES};

/// The description of the FMU `name` of `structure` with these `contents`.
pub fn model_description(
    name: &str,
    structure: &Structure,
    contents: &Contents,
    experiment: Experiment,
) -> fmi3::FmiModelDescription {
    fmi3::FmiModelDescription {
        fmi_version: fmi3::FmiVersion::V3_0,
        model_name: name.into(),
        instantiation_token: FlexibleRocking::guid(contents),
        description: DESCRIPTION.into(),
        version: env!("CARGO_PKG_VERSION").into(),
        license: env!("CARGO_PKG_LICENSE").into(),
        generation_tool: concat!("rocking-fmu ", env!("CARGO_PKG_VERSION")).into(),
        variable_naming_convention: fmi::VariableNamingConvention::Flat,
        model_exchange: fmi3::ModelExchange {
            model_identifier: name.into(),
            can_be_instantiated_only_once_per_process: false,
            can_get_and_set_fmu_state: true,
            can_serialize_fmu_state: true,
            provides_directional_derivatives: true,
            provides_adjoint_derivatives: true,
            needs_completed_integrator_step: true,
        },
        co_simulation: fmi3::CoSimulation {
            model_identifier: name.into(),
            can_be_instantiated_only_once_per_process: false,
            can_get_and_set_fmu_state: true,
            can_serialize_fmu_state: true,
            provides_directional_derivatives: true,
            provides_adjoint_derivatives: true,
            can_handle_variable_communication_step_size: true,
            max_output_derivative_order: 1,
            provides_intermediate_update: true,
            might_return_early_from_do_step: true,
            can_return_early_after_intermediate_update: false,
            has_event_mode: true,
        },
        unit_definitions: fmi::UnitDefinitions { units: units::definitions(structure) },
        type_definitions: fmi3::TypeDefinitions { enumeration_types: [&PHASES, &DETAILS].map(enumeration_type).into() },
        log_categories: fmi::LogCategories { categories: logger::Category::ALL.map(log_category).into() },
        default_experiment: experiment.description(),
        model_variables: fmi3::ModelVariables {
            variables: (0..)
                .zip(&*VARIABLES)
                .map(|(at, variable)| of_type(at, variable, structure, contents))
                .collect(),
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

/// The variable at position `at` of the table, which is its value reference.
fn of_type(at: u32, variable: &Variable, structure: &Structure, contents: &Contents) -> fmi3::Variable {
    let start = variable.start(contents);
    let common = fmi3::Common {
        name: variable.name.into(),
        value_reference: at,
        description: variable.description.into(),
        causality: causality(variable),
        variability: variability(variable),
        initial: initial(variable),
    };
    match variable.data_type {
        DataType::Real { unit, range } => fmi3::Variable::Float64(fmi3::Float64 {
            common,
            intermediate_update: (variable.is_continuous() && variable.causality != Causality::Independent)
                .then_some(true),
            unit: (unit != "1").then(|| unit.into()),
            display_unit: units::display_unit(variable, structure).map(Into::into),
            min: range.map(|(min, _)| min),
            max: range.map(|(_, max)| max),
            nominal: units::nominal(variable, structure),
            start: start.and_then(|value| if let Value::Real(value) = value { Some(value) } else { None }),
            derivative: variable.as_state_rate().map(|which| reference(COMPONENTS[which])),
            reinit: variable.as_state().map(|_| true),
        }),
        DataType::Integer => fmi3::Variable::Int32(fmi3::Int32 { common, min: Some(0) }),
        DataType::Boolean => fmi3::Variable::Boolean(fmi3::Boolean {
            common,
            start: start.and_then(|value| if let Value::Boolean(value) = value { Some(value) } else { None }),
        }),
        DataType::String => fmi3::Variable::String(fmi3::Text {
            common,
            start: start.and_then(|value| match value {
                Value::String(value) => Some(fmi3::Start { value }),
                _ => None,
            }),
        }),
        DataType::Enumeration(enumeration) => fmi3::Variable::Enumeration(fmi3::Enumeration {
            common,
            declared_type: enumeration.name.into(),
            start: start.and_then(|value| if let Value::Item(value) = value { Some(value) } else { None }),
        }),
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
    let dependencies_kind = vec![fmi::DependenciesKind::Dependent; dependencies.len()];
    fmi3::Unknown { value_reference, dependencies, dependencies_kind }
}

/// The value reference of the variable called `name`, its position in the table.
fn reference(name: &str) -> u32 {
    u32::try_from(index(name) - 1).expect("the table is short")
}

#[cfg(test)]
mod tests {
    use super::*;
    use rocking::Parameters;

    /// Both versions say the same of every variable, but for time.
    #[test]
    fn both_versions_describe_one_table() {
        let contents = Contents::from(Parameters::MCMANUS);
        let structure = Structure::new(Parameters::MCMANUS).unwrap();
        let experiment = Experiment { stop_time: 4.0, step_size: 0.005 };
        let three = model_description("Pier", &structure, &contents, experiment);
        let two = super::super::model_description("Pier", &structure, &contents, experiment);
        let common = three.model_variables.variables.iter().map(|variable| match variable {
            fmi3::Variable::Float64(of) => &of.common,
            fmi3::Variable::Int32(of) => &of.common,
            fmi3::Variable::Boolean(of) => &of.common,
            fmi3::Variable::String(of) => &of.common,
            fmi3::Variable::Enumeration(of) => &of.common,
        });
        let (time, common): (Vec<_>, Vec<_>) = common.partition(|of| of.causality == fmi::Causality::Independent);
        assert_eq!(time.iter().map(|of| of.name.as_str()).collect::<Vec<_>>(), ["time"]);
        let told = |(name, reference, description, causality, variability, initial)| {
            format!("{name} {reference} {description} {causality:?} {variability:?} {initial:?}")
        };
        let of_three = common.iter().map(|of| {
            (of.name.clone(), of.value_reference, of.description.clone(), of.causality, of.variability, of.initial)
        });
        let of_two = two.model_variables.scalar_variables.iter().map(|of| {
            (of.name.clone(), of.value_reference, of.description.clone(), of.causality, of.variability, of.initial)
        });
        assert_eq!(of_three.map(told).collect::<Vec<_>>(), of_two.map(told).collect::<Vec<_>>());
        assert_eq!(three.instantiation_token, two.guid);
        let outputs = three.model_structure.outputs.iter().map(|unknown| unknown.value_reference as usize + 1);
        assert!(outputs.eq(two.model_structure.outputs.unknowns.iter().map(|unknown| unknown.index)));
    }

    /// Knowns at any time are inputs, states, parameters, though not those that the states began from, and time.
    #[test]
    fn the_structure_points_at_states_and_indicators_in_their_order() {
        let contents = Contents::from(Parameters::MCMANUS);
        let structure = Structure::new(Parameters::MCMANUS).unwrap();
        let experiment = Experiment { stop_time: 4.0, step_size: 0.005 };
        let description = model_description("Pier", &structure, &contents, experiment);
        let float = |reference: u32| match &description.model_variables.variables[reference as usize] {
            fmi3::Variable::Float64(float) => float,
            other => panic!("{other:?}"),
        };
        let name = |reference: u32| float(reference).common.name.as_str();
        let fmi3::ModelStructure { outputs, continuous_state_derivatives, initial_unknowns, event_indicators } =
            &description.model_structure;
        let states = continuous_state_derivatives.iter().map(|rate| float(rate.value_reference).derivative.unwrap());
        let states: Vec<_> = states.collect();
        assert_eq!(states.iter().map(|state| name(*state)).collect::<Vec<_>>(), COMPONENTS);
        assert!(states.iter().all(|state| float(*state).reinit == Some(true)));
        let of = |unknowns: &[fmi3::Unknown]| unknowns.iter().map(|of| of.value_reference).collect::<Vec<_>>();
        let indicators = of(event_indicators);
        assert_eq!(
            indicators.iter().map(|of| name(*of)).collect::<Vec<_>>(),
            ["phase_indicator", "overturning_indicator"]
        );
        let initial = of(initial_unknowns);
        assert!(states.iter().chain(&of(continuous_state_derivatives)).all(|state| initial.contains(state)));
        assert!(!indicators.iter().any(|indicator| initial.contains(indicator)));

        let dependencies = |unknowns: &[fmi3::Unknown], of: &str| {
            let unknown = unknowns.iter().find(|unknown| name(unknown.value_reference) == of).unwrap();
            let names =
                unknown.dependencies.iter().map(|at| match &description.model_variables.variables[*at as usize] {
                    fmi3::Variable::Float64(of) => &of.common.name,
                    fmi3::Variable::String(of) => &of.common.name,
                    fmi3::Variable::Enumeration(of) => &of.common.name,
                    other => panic!("{other:?}"),
                });
            names.map(String::as_str).collect::<Vec<_>>().join(" ")
        };
        assert_eq!(dependencies(outputs, "theta"), "theta");
        assert_eq!(dependencies(outputs, "delta_t"), "u theta H B");
        assert_eq!(dependencies(outputs, "I_v"), "");
        assert_eq!(
            dependencies(continuous_state_derivatives, "der(u_dot)"),
            "a_g F_t a_v u u_dot theta theta_dot m m0 H B J0 f_fc zeta_fc c_ratio g detail P_0 k_t xi_d c_d k_d F_y record \
             record_v record_scale record_time_scale record_start time"
        );
        assert_eq!(dependencies(continuous_state_derivatives, "der(u)"), "u_dot");
        assert_eq!(dependencies(event_indicators, "overturning_indicator"), "theta theta_dot B xi_d k_d F_y");
        assert_eq!(dependencies(initial_unknowns, "delta_t"), "H B theta_0 u_0");
    }

    #[test]
    fn start_values_are_those_of_the_structure() {
        let contents = Contents::from(Parameters::EVISON);
        let structure = Structure::new(Parameters::EVISON).unwrap();
        let experiment = Experiment { stop_time: 4.0, step_size: 0.005 };
        let xml = model_description("Pier", &structure, &contents, experiment).to_xml().unwrap();
        for element in [
            r#"causality="input" variability="continuous" intermediateUpdate="true" unit="m/s2" displayUnit="g" min="-10000.0" max="10000.0" nominal="3.59" start="0.0"/>"#,
            r#"causality="output" variability="continuous" initial="calculated" intermediateUpdate="true" unit="rad""#,
            r#"causality="output" variability="discrete" initial="calculated" unit="N.s""#,
            r#"causality="parameter" variability="fixed" initial="exact" unit="Hz" min="0.001" max="10000.0" start="11.0"/>"#,
            r#"description="what holds of the base" causality="local" variability="discrete" initial="calculated" declaredType="Phase"/>"#,
            r#"causality="parameter" variability="fixed" initial="exact" declaredType="Detail" start="1"/>"#,
            r#"      <Start value=""/>"#,
            r#"name="time" "#,
        ] {
            assert!(xml.contains(element), "{element}\n{xml}");
        }
    }
}
