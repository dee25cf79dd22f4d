//! `modelDescription.xml` from a table of variables.

use crate::element::{Element, digits};
use crate::{DefaultExperiment, Version};
use fmi_unit::logger::Category;
use fmi_unit::variables::{dependencies, position};
use fmi_unit::{Causality, DataType, Enumeration, Role, Value, Variable};

/// The content of a model description.
#[derive(Clone, Debug, Default)]
pub struct ModelDescription<'a> {
    /// Name of the model, and of its libraries' files.
    pub name: &'a str,
    /// The model's GUID.
    pub token: String,
    /// The model in one line.
    pub description: &'a str,
    /// Version of the model.
    pub version: &'a str,
    /// License of the model.
    pub license: &'a str,
    /// Name of the tool that writes the FMU.
    pub generation_tool: &'a str,
    /// The content of the log category of events, in one line.
    pub events: &'a str,
    /// Whether inputs have slopes and outputs have rates in co-simulation.
    pub has_slopes: bool,
    /// Units, what hosts may show in the place of each, and the factor of a value then.
    pub display_units: Vec<(&'static str, &'static str, f64)>,
    /// The variables; a value reference is a position, in FMI 3.0 counted from 1.
    pub variables: &'a [Variable],
    /// Settings of a simulation for which the user sets nothing else.
    pub default_experiment: DefaultExperiment,
}

impl ModelDescription<'_> {
    /// The text of `modelDescription.xml` for hosts of `version`.
    pub fn to_xml(&self, version: Version) -> String {
        let (number, token, indicators) = match version {
            Version::Fmi2 => {
                ("2.0", "guid", Some(self.variables.iter().filter(|of| of.role == Role::Indicator).count()))
            }
            Version::Fmi3 => ("3.0", "instantiationToken", None),
        };
        let has_numbers = self.variables.iter().any(|variable| variable.name.contains('['));
        let unit = |of: &DataType| if let DataType::Real { unit, .. } = *of { Some(unit) } else { None };
        let item = |of: &DataType| if let DataType::Enumeration(of) = *of { Some(of) } else { None };
        let units = self.each(unit).filter(|name| *name != "1").map(|name| self.unit(name));
        let types = self.each(item).map(|of| enumeration(version, of));
        let variables = (0..).zip(self.variables);
        let is_row = |variable: &Variable| version == Version::Fmi3 || variable.causality != Causality::Independent;
        let rows = variables.filter(|(_, variable)| is_row(variable));
        let rows = rows.map(|(at, variable)| self.variable(version, at, variable));
        Element::new("fmiModelDescription")
            .with("fmiVersion", number)
            .with("modelName", self.name)
            .with(token, &self.token)
            .with("description", self.description)
            .with("version", self.version)
            .with("license", self.license)
            .with("generationTool", self.generation_tool)
            .with("variableNamingConvention", if has_numbers { "structured" } else { "flat" })
            .with_any("numberOfEventIndicators", indicators)
            .holding(self.interfaces(version))
            .holding(Element::new("UnitDefinitions").holding(units).unless_empty())
            .holding(Element::new("TypeDefinitions").holding(types).unless_empty())
            .holding([self.log_categories(), self.default_experiment()])
            .holding([Element::new("ModelVariables").holding(rows), self.structure(version)])
            .document()
    }

    /// The capabilities of both interfaces.
    fn interfaces(&self, version: Version) -> [Element; 2] {
        let [model_exchange, co_simulation] =
            ["ModelExchange", "CoSimulation"].map(|name| Element::new(name).with("modelIdentifier", self.name));
        let order = u8::from(self.has_slopes);
        match version {
            Version::Fmi2 => {
                let common = [
                    "canNotUseMemoryManagementFunctions",
                    "canGetAndSetFMUstate",
                    "canSerializeFMUstate",
                    "providesDirectionalDerivative",
                ];
                let co_simulation = co_simulation
                    .with("canHandleVariableCommunicationStepSize", true)
                    .with("canInterpolateInputs", self.has_slopes)
                    .with("maxOutputDerivativeOrder", order);
                [model_exchange.with_true(&common), co_simulation.with_true(&common)]
            }
            Version::Fmi3 => {
                let common = ["canGetAndSetFMUState", "canSerializeFMUState", "providesDirectionalDerivatives"];
                let own = ["providesIntermediateUpdate", "mightReturnEarlyFromDoStep", "hasEventMode"];
                let co_simulation = co_simulation
                    .with_true(&common)
                    .with("canHandleVariableCommunicationStepSize", true)
                    .with("maxOutputDerivativeOrder", order)
                    .with_true(&own);
                [model_exchange.with_true(&common).with_true(&["needsCompletedIntegratorStep"]), co_simulation]
            }
        }
    }

    /// What the types of variables have, each once.
    fn each<T: PartialEq>(&self, of: impl Fn(&DataType) -> Option<T>) -> impl Iterator<Item = T> {
        let mut found = Vec::new();
        for one in self.variables.iter().filter_map(|variable| of(&variable.data_type)) {
            found.extend((!found.contains(&one)).then_some(one));
        }
        found.into_iter()
    }

    /// The definition of a unit, of which nothing but the name may be known.
    fn unit(&self, name: &'static str) -> Element {
        let base = exponents(name).map(|exponents| {
            let exponents = ["kg", "m", "s", "rad"].into_iter().zip(exponents);
            exponents.fold(Element::new("BaseUnit"), |base, (of, exponent)| {
                base.with_any(of, (exponent != 0).then_some(exponent))
            })
        });
        let display = self.display_units.iter().find(|(of, ..)| *of == name);
        let display = display
            .map(|(_, name, factor)| Element::new("DisplayUnit").with("name", name).with("factor", digits(*factor)));
        Element::new("Unit").with("name", name).holding(base).holding(display)
    }

    fn log_categories(&self) -> Element {
        let category = |category: Category| {
            let description = if category == Category::Events { self.events } else { category.description() };
            let name = category.name().to_string_lossy();
            Element::new("Category").with("name", name).with("description", description)
        };
        Element::new("LogCategories").holding(Category::ALL.map(category))
    }

    fn default_experiment(&self) -> Element {
        let DefaultExperiment { start_time, stop_time, tolerance, step_size } = self.default_experiment;
        Element::new("DefaultExperiment")
            .with("startTime", digits(start_time))
            .with("stopTime", digits(stop_time))
            .with("tolerance", digits(tolerance))
            .with("stepSize", digits(step_size))
    }

    /// The variable at position `at`. Its type is an element of its own in FMI 2.0, and a text to start from in FMI 3.0.
    fn variable(&self, version: Version, at: usize, variable: &Variable) -> Element {
        let text = if variable.data_type == DataType::String { start(variable) } else { None };
        let typed = typed(version, variable);
        if version == Version::Fmi2 {
            let of_type = self.of_type(typed, variable).with_any("start", text);
            return common(Element::new("ScalarVariable"), at, variable).holding([of_type]);
        }
        let is_given_within_steps =
            variability(variable) == "continuous" && variable.causality != Causality::Independent;
        let element =
            common(typed, index(at), variable).with_any("intermediateUpdate", is_given_within_steps.then_some(true));
        self.of_type(element, variable).holding(text.map(|text| Element::new("Start").with("value", text)))
    }

    /// `element` with the attributes that belong to the type of `variable`.
    fn of_type(&self, element: Element, variable: &Variable) -> Element {
        match variable.data_type {
            DataType::Real { unit, range } => {
                let derivative_of = match &variable.role {
                    Role::RateOf(state) => Some(index(position(self.variables, state))),
                    _ => None,
                };
                element
                    .with_any("unit", (unit != "1").then_some(unit))
                    .with_any("displayUnit", variable.display_unit.as_deref())
                    .with_any("min", range.map(|(min, _)| digits(min)))
                    .with_any("max", range.map(|(_, max)| digits(max)))
                    .with_any("nominal", variable.nominal.map(digits))
                    .with_any("start", start(variable))
                    .with_any("derivative", derivative_of)
                    .with_any("reinit", (variable.role == Role::State).then_some(true))
            }
            DataType::Integer => element.with("min", 0),
            DataType::Boolean => element.with_any("start", start(variable)),
            DataType::Enumeration(of) => element.with("declaredType", of.name).with_any("start", start(variable)),
            DataType::String => element, // the versions differ
        }
    }

    /// The dependencies: in FMI 2.0 after the start on inputs and states alone, in FMI 3.0 on parameters and time, too.
    fn structure(&self, version: Version) -> Element {
        type IsListed = fn(&Variable) -> bool;
        let lists: [(_, _, IsListed, _); 4] = [
            ("Outputs", "Output", |of| of.causality == Causality::Output, false),
            ("Derivatives", "ContinuousStateDerivative", |of| matches!(of.role, Role::RateOf(_)), false),
            ("InitialUnknowns", "InitialUnknown", Variable::is_initial_unknown, true),
            ("", "EventIndicator", |of| of.role == Role::Indicator, false),
        ];
        let is_input_or_state = |at: &usize| {
            let variable = &self.variables[*at];
            variable.causality == Causality::Input || variable.role == Role::State
        };
        let listed = lists.into_iter().flat_map(|(list, of_3, is_one, at_start)| {
            let found = (0..self.variables.len()).filter(move |at| is_one(&self.variables[*at]));
            let unknowns = found.map(move |at| (at, dependencies(self.variables, at, at_start)));
            match version {
                Version::Fmi2 if list.is_empty() => Vec::new(),
                Version::Fmi2 => {
                    let unknowns = unknowns.map(|(at, mut known)| {
                        known.retain(|known| at_start || is_input_or_state(known));
                        unknown(Element::new("Unknown").with("index", index(at)), known)
                    });
                    vec![Element::new(list).holding(unknowns)]
                }
                Version::Fmi3 => unknowns
                    .map(|(at, known)| unknown(Element::new(of_3).with("valueReference", index(at)), known))
                    .collect(),
            }
        });
        Element::new("ModelStructure").holding(listed)
    }
}

/// The index in FMI 2.0 and the value reference in FMI 3.0 of the variable at a position.
fn index(at: usize) -> usize {
    at + 1
}

/// The exponents of kg, m, s and rad of a unit of SI, such as `N.s/m`.
fn exponents(unit: &str) -> Option<[i32; 4]> {
    let mut sum = [0; 4];
    for (part, sign) in unit.split('/').zip([1, -1]) {
        for factor in part.split('.') {
            let symbol = factor.trim_end_matches(|c: char| c.is_ascii_digit());
            let power = sign * factor[symbol.len()..].parse().unwrap_or(1);
            let of = match symbol {
                "kg" => [1, 0, 0, 0],
                "m" => [0, 1, 0, 0],
                "s" => [0, 0, 1, 0],
                "rad" => [0, 0, 0, 1],
                "Hz" => [0, 0, -1, 0],
                "N" => [1, 1, -2, 0],
                "J" => [1, 2, -2, 0],
                _ => return None,
            };
            sum.iter_mut().zip(of).for_each(|(sum, of)| *sum += power * of);
        }
    }
    Some(sum)
}

fn enumeration(version: Version, of: &Enumeration) -> Element {
    let items = (1..).zip(of.items);
    let items = items.map(|(value, name): (u32, _)| Element::new("Item").with("name", name).with("value", value));
    match version {
        Version::Fmi2 => Element::new("SimpleType")
            .with("name", of.name)
            .with("description", of.description)
            .holding([Element::new("Enumeration").holding(items)]),
        // fmpy up to 0.3.23 rejects a description here
        Version::Fmi3 => Element::new("EnumerationType").with("name", of.name).holding(items),
    }
}

/// The element of the type of `variable`.
fn typed(version: Version, variable: &Variable) -> Element {
    Element::new(match (variable.data_type, version) {
        (DataType::Real { .. }, Version::Fmi2) => "Real",
        (DataType::Real { .. }, Version::Fmi3) => "Float64",
        (DataType::Integer, Version::Fmi2) => "Integer",
        (DataType::Integer, Version::Fmi3) => "Int32",
        (DataType::Boolean, _) => "Boolean",
        (DataType::String, _) => "String",
        (DataType::Enumeration(_), _) => "Enumeration",
    })
}

/// `element` with the attributes that `variable` has whatever its type.
fn common(element: Element, reference: usize, variable: &Variable) -> Element {
    let causality = match variable.causality {
        Causality::Parameter => "parameter",
        Causality::CalculatedParameter => "calculatedParameter",
        Causality::Input => "input",
        Causality::Output => "output",
        Causality::Local => "local",
        Causality::Independent => "independent",
    };
    let initial = match variable.causality {
        Causality::Parameter => Some("exact"),
        Causality::Output | Causality::Local if variable.start.is_some() => Some("exact"),
        Causality::CalculatedParameter | Causality::Output | Causality::Local => Some("calculated"),
        Causality::Input | Causality::Independent => None,
    };
    element
        .with("name", &variable.name)
        .with("valueReference", reference)
        .with("description", &variable.description)
        .with("causality", causality)
        .with("variability", variability(variable))
        .with_any("initial", initial)
}

fn variability(variable: &Variable) -> &'static str {
    match variable.causality {
        Causality::Parameter | Causality::CalculatedParameter => "fixed",
        _ if variable.is_continuous => "continuous",
        _ => "discrete",
    }
}

/// The start value of `variable` as text.
fn start(variable: &Variable) -> Option<String> {
    variable.start.clone().map(|value| match value {
        Value::Real(value) => digits(value),
        Value::Integer(value) => value.to_string(),
        Value::Boolean(value) => value.to_string(),
        Value::String(value) => value,
    })
}

/// `element` with what it depends on, by position; an empty list says that there is nothing.
fn unknown(element: Element, known: Vec<usize>) -> Element {
    let places: Vec<_> = known.into_iter().map(|at| index(at).to_string()).collect();
    let kinds = vec!["dependent"; places.len()].join(" ");
    element.with("dependencies", places.join(" ")).with("dependenciesKind", kinds)
}
