//! `modelDescription.xml` from a table of variables.

use crate::{self as fmi, fmi3};
use fmi_unit::logger::Category;
use fmi_unit::variables::{dependencies, position};
use fmi_unit::{Causality, DataType, Enumeration, Role, Value, Variable};

/// What a description says of a model.
#[derive(Clone, Debug, Default)]
pub struct Description<'a> {
    /// Name of the model, and of its libraries' files.
    pub name: &'a str,
    /// The model's GUID.
    pub token: String,
    /// What the model is, in one line.
    pub description: &'a str,
    /// Version of the model.
    pub version: &'a str,
    /// License of the model.
    pub license: &'a str,
    /// Name of the tool that writes the FMU.
    pub generation_tool: &'a str,
    /// What the log category of events tells, in one line.
    pub events: &'a str,
    /// Whether inputs have slopes and outputs have rates in co-simulation.
    pub has_slopes: bool,
    /// Units of the variables.
    pub units: Vec<fmi::Unit>,
    /// The variables; a value reference is a position.
    pub variables: &'a [Variable],
    /// Settings of a simulation for which nothing else is asked.
    pub default_experiment: fmi::DefaultExperiment,
}

/// How a version points at the variable at a position.
type Place = fn(usize) -> u32;

impl Description<'_> {
    /// The description in FMI 2.0, which leaves out time.
    pub fn fmi2(&self) -> fmi::FmiModelDescription {
        let capabilities = fmi::Capabilities {
            can_not_use_memory_management_functions: true,
            can_get_and_set_fmu_state: true,
            can_serialize_fmu_state: true,
            provides_directional_derivative: true,
        };
        let place: Place = |at| at as u32 + 1;
        let is_in = |of: &usize| matches!(self.variables[*of].causality, Causality::Input) || self.is_state(*of);
        let unknowns = |is_one: fn(&Variable) -> bool, at_start: bool| {
            let found = self.unknowns(is_one, at_start).into_iter().map(|(at, mut known)| {
                known.retain(|known| at_start || is_in(known));
                let dependencies_kind = vec![fmi::DEPENDENT; known.len()];
                fmi::Unknown {
                    index: place(at),
                    dependencies: known.into_iter().map(place).collect(),
                    dependencies_kind,
                }
            });
            fmi::List { items: found.collect() }
        };
        let variables = self.variables.iter().enumerate();
        let variables = variables.filter(|(_, variable)| variable.causality != Causality::Independent);
        fmi::FmiModelDescription {
            fmi_version: "2.0",
            model_name: self.name.into(),
            guid: self.token.clone(),
            description: self.description.into(),
            version: self.version.into(),
            license: self.license.into(),
            generation_tool: self.generation_tool.into(),
            variable_naming_convention: fmi::FLAT,
            number_of_event_indicators: self.unknowns(|v| v.role == Role::Indicator, false).len(),
            model_exchange: fmi::ModelExchange {
                model_identifier: self.name.into(),
                capabilities: capabilities.clone(),
            },
            co_simulation: fmi::CoSimulation {
                model_identifier: self.name.into(),
                can_handle_variable_communication_step_size: true,
                can_interpolate_inputs: self.has_slopes,
                max_output_derivative_order: self.has_slopes.into(),
                capabilities,
            },
            unit_definitions: fmi::List { items: self.all_units() },
            type_definitions: fmi::List {
                items: self
                    .enumerations()
                    .map(|enumeration| fmi::SimpleType {
                        name: enumeration.name.into(),
                        description: enumeration.description.into(),
                        enumeration: fmi::List { items: items(enumeration) },
                    })
                    .collect(),
            },
            log_categories: self.log_categories(),
            default_experiment: self.default_experiment,
            model_variables: fmi::ModelVariables {
                scalar_variables: variables
                    .map(|(at, variable)| fmi::ScalarVariable {
                        attributes: attributes(at, variable),
                        variable_type: self.variable_type(variable, place),
                    })
                    .collect(),
            },
            model_structure: fmi::ModelStructure {
                outputs: unknowns(|v| v.causality == Causality::Output, false),
                derivatives: unknowns(is_rate, false),
                initial_unknowns: unknowns(Variable::is_initial_unknown, true),
            },
        }
    }

    /// The description in FMI 3.0, in which unknowns depend on parameters and time, too.
    pub fn fmi3(&self) -> fmi3::FmiModelDescription {
        let capabilities = fmi3::Capabilities {
            model_identifier: self.name.into(),
            can_get_and_set_fmu_state: true,
            can_serialize_fmu_state: true,
            provides_directional_derivatives: true,
        };
        let unknowns = |is_one: fn(&Variable) -> bool, at_start: bool| {
            let found = self.unknowns(is_one, at_start).into_iter().map(|(at, known)| {
                let dependencies_kind = vec![fmi::DEPENDENT; known.len()];
                let dependencies = known.into_iter().map(|at| at as u32).collect();
                fmi3::Unknown { value_reference: at as u32, dependencies, dependencies_kind }
            });
            found.collect()
        };
        fmi3::FmiModelDescription {
            fmi_version: "3.0",
            model_name: self.name.into(),
            instantiation_token: self.token.clone(),
            description: self.description.into(),
            version: self.version.into(),
            license: self.license.into(),
            generation_tool: self.generation_tool.into(),
            variable_naming_convention: fmi::FLAT,
            model_exchange: fmi3::ModelExchange {
                capabilities: capabilities.clone(),
                needs_completed_integrator_step: true,
            },
            co_simulation: fmi3::CoSimulation {
                capabilities,
                can_handle_variable_communication_step_size: true,
                max_output_derivative_order: self.has_slopes.into(),
                provides_intermediate_update: true,
                might_return_early_from_do_step: true,
                has_event_mode: true,
            },
            unit_definitions: fmi::List { items: self.all_units() },
            type_definitions: fmi::List {
                items: self
                    .enumerations()
                    .map(|enumeration| fmi3::EnumerationType {
                        name: enumeration.name.into(),
                        description: enumeration.description.into(),
                        items: items(enumeration),
                    })
                    .collect(),
            },
            log_categories: self.log_categories(),
            default_experiment: self.default_experiment,
            model_variables: fmi::List {
                items: self.variables.iter().enumerate().map(|(at, variable)| self.of_type(at, variable)).collect(),
            },
            model_structure: fmi3::ModelStructure {
                outputs: unknowns(|v| v.causality == Causality::Output, false),
                continuous_state_derivatives: unknowns(is_rate, false),
                initial_unknowns: unknowns(Variable::is_initial_unknown, true),
                event_indicators: unknowns(|v| v.role == Role::Indicator, false),
            },
        }
    }

    fn is_state(&self, at: usize) -> bool {
        self.variables[at].role == Role::State
    }

    /// The positions of the variables that are one, with those of what they depend on.
    fn unknowns(&self, is_one: fn(&Variable) -> bool, at_start: bool) -> Vec<(usize, Vec<usize>)> {
        let found = (0..self.variables.len()).filter(|at| is_one(&self.variables[*at]));
        found.map(|at| (at, dependencies(self.variables, at, at_start))).collect()
    }

    /// The units, and those that variables have beside them, of which nothing but the name is known.
    fn all_units(&self) -> Vec<fmi::Unit> {
        let mut units = self.units.clone();
        for variable in self.variables {
            match variable.data_type {
                DataType::Real { unit, .. } if unit != "1" && units.iter().all(|known| known.name != unit) => {
                    units.push(fmi::Unit { name: unit.into(), base_unit: None, display_units: Vec::new() });
                }
                _ => (),
            }
        }
        units
    }

    /// The enumerations that variables have, each once.
    fn enumerations(&self) -> impl Iterator<Item = &'static Enumeration> {
        let mut found: Vec<&Enumeration> = Vec::new();
        for variable in self.variables {
            match variable.data_type {
                DataType::Enumeration(of) if !found.contains(&of) => found.push(of),
                _ => (),
            }
        }
        found.into_iter()
    }

    fn log_categories(&self) -> fmi::List<fmi::Category> {
        let category = |category: Category| fmi::Category {
            name: category.name().to_string_lossy().into_owned(),
            description: if category == Category::Events { self.events } else { category.description() }.into(),
        };
        fmi::List { items: Category::ALL.map(category).into() }
    }

    /// The type of `variable`; `place` is how a version points at the state that it is the derivative of.
    fn variable_type(&self, variable: &Variable, place: Place) -> fmi::VariableType {
        let start = variable.start.clone();
        match variable.data_type {
            DataType::Real { unit, range } => fmi::VariableType::Real(fmi::Real {
                unit: (unit != "1").then(|| unit.into()),
                display_unit: variable.display_unit.as_deref().map(Into::into),
                min: range.map(|(min, _)| min),
                max: range.map(|(_, max)| max),
                nominal: variable.nominal,
                start: start.and_then(|value| if let Value::Real(value) = value { Some(value) } else { None }),
                derivative: match &variable.role {
                    Role::RateOf(state) => Some(place(position(self.variables, state))),
                    _ => None,
                },
                reinit: (variable.role == Role::State).then_some(true),
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
                start: start.and_then(|value| if let Value::Integer(value) = value { Some(value) } else { None }),
            }),
        }
    }

    /// The variable at position `at` in FMI 3.0.
    fn of_type(&self, at: usize, variable: &Variable) -> fmi3::Variable {
        let is_given_within_steps = variability(variable) == fmi::Variability::Continuous;
        let is_given_within_steps = is_given_within_steps && variable.causality != Causality::Independent;
        let (attributes, intermediate_update) = (attributes(at, variable), is_given_within_steps.then_some(true));
        match self.variable_type(variable, |at| at as u32) {
            fmi::VariableType::Real(own) => fmi3::Variable::Float64(fmi3::Of { attributes, intermediate_update, own }),
            fmi::VariableType::Integer(own) => fmi3::Variable::Int32(fmi3::Of { attributes, intermediate_update, own }),
            fmi::VariableType::Boolean(own) => {
                fmi3::Variable::Boolean(fmi3::Of { attributes, intermediate_update, own })
            }
            fmi::VariableType::String(text) => {
                let own = fmi3::Text { start: text.start.map(|value| fmi3::Start { value }) };
                fmi3::Variable::String(fmi3::Of { attributes, intermediate_update, own })
            }
            fmi::VariableType::Enumeration(own) => {
                fmi3::Variable::Enumeration(fmi3::Of { attributes, intermediate_update, own })
            }
        }
    }
}

fn is_rate(variable: &Variable) -> bool {
    matches!(variable.role, Role::RateOf(_))
}

fn items(enumeration: &Enumeration) -> Vec<fmi::Item> {
    (1..).zip(enumeration.items).map(|(value, &name)| fmi::Item { name: name.into(), value }).collect()
}

/// What the variable at position `at` of the table, which is its value reference, has whatever its type.
fn attributes(at: usize, variable: &Variable) -> fmi::Attributes {
    fmi::Attributes {
        name: variable.name.to_string(),
        value_reference: at as u32,
        description: variable.description.to_string(),
        causality: causality(variable),
        variability: variability(variable),
        initial: initial(variable),
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
        _ if variable.is_continuous => fmi::Variability::Continuous,
        Causality::Input | Causality::Output | Causality::Local | Causality::Independent => fmi::Variability::Discrete,
    }
}

fn initial(variable: &Variable) -> Option<fmi::Initial> {
    match variable.causality {
        Causality::Parameter => Some(fmi::Initial::Exact),
        Causality::Output | Causality::Local if variable.start.is_some() => Some(fmi::Initial::Exact),
        Causality::CalculatedParameter | Causality::Output | Causality::Local => Some(fmi::Initial::Calculated),
        Causality::Input | Causality::Independent => None,
    }
}
