//! The table of variables of a model: names, types, who sets what, and what depends on what. A value reference is a position
//! in the table, which is made at run time; in FMI 3.0 the first position is 1.

use std::borrow::Cow;
use std::collections::BTreeSet;

/// Text that is fixed when the library is compiled, or made with the table.
pub type Text = Cow<'static, str>;

/// One variable.
#[derive(Clone, Debug)]
pub struct Variable {
    /// Name, as hosts show it.
    pub name: Text,
    /// The variable in one line.
    pub description: Text,
    /// Data type, with what belongs to that type alone.
    pub data_type: DataType,
    /// The side that sets the variable.
    pub causality: Causality,
    /// Whether the value may change at any time, and not at events alone.
    pub is_continuous: bool,
    /// The role of the variable for a host that integrates.
    pub role: Role,
    /// The variables that the value follows from directly, by name; of a state, those that it starts from.
    pub depends_on: Vec<Text>,
    /// Start value of an input, of a parameter, or of what the host may set before the start as it sets a parameter.
    pub start: Option<Value>,
    /// Unit that hosts best show the value in, if that is another than its own.
    pub display_unit: Option<Text>,
    /// Usual magnitude.
    pub nominal: Option<f64>,
}

/// The side that sets a variable. Parameters are given before the simulation, inputs during the simulation; the model computes the rest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Causality {
    /// The user, before the simulation.
    Parameter,
    /// The model, from the parameters.
    CalculatedParameter,
    /// The host, during the simulation.
    Input,
    /// The model, for other models.
    Output,
    /// The model, for display.
    Local,
    /// Time, which all others depend on. A table has one such variable, the last.
    Independent,
}

/// The role of a variable for a host that integrates.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub enum Role {
    /// Any other.
    #[default]
    Other,
    /// A continuous state.
    State,
    /// The derivative of the state of this name. The order of the derivatives is the order of the states.
    RateOf(Text),
    /// An event indicator.
    Indicator,
}

/// Data type of a variable.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum DataType {
    /// A real number.
    Real {
        /// Unit as FMI writes it, `1` for a ratio.
        unit: &'static str,
        /// Smallest and largest value accepted, of what a host sets.
        range: Option<(f64, f64)>,
    },
    /// An integer, not negative.
    Integer,
    /// True or false.
    Boolean,
    /// Text.
    String,
    /// An item of an enumeration, numbered from 1.
    Enumeration(&'static Enumeration),
}

impl DataType {
    /// The least and the largest value of a real number; every finite value is in a range that is not stated.
    pub fn limits(&self) -> Option<(f64, f64)> {
        let DataType::Real { range, .. } = self else { return None };
        Some(range.unwrap_or((f64::MIN, f64::MAX)))
    }

    /// Whether `value` is a real number in the range of the type.
    pub fn accepts(&self, value: f64) -> bool {
        self.limits().is_some_and(|(min, max)| (min..=max).contains(&value))
    }
}

/// An enumeration.
#[derive(Debug, PartialEq)]
pub struct Enumeration {
    /// Name of the type.
    pub name: &'static str,
    /// The enumeration in one line.
    pub description: &'static str,
    /// Its items, numbered from 1.
    pub items: &'static [&'static str],
}

/// A value of any type.
#[derive(Clone, Debug, PartialEq)]
pub enum Value {
    /// A real number.
    Real(f64),
    /// An integer, or the number of an item of an enumeration.
    Integer(i32),
    /// True or false.
    Boolean(bool),
    /// Text.
    String(String),
}

impl Variable {
    /// A continuous real number in `unit`; [`Variable::of_type`] makes what is discrete.
    pub fn real(
        causality: Causality,
        name: impl Into<Text>,
        unit: &'static str,
        description: impl Into<Text>,
    ) -> Variable {
        let data_type = DataType::Real { unit, range: None };
        Variable { is_continuous: true, ..Variable::of_type(data_type, causality, name, description) }
    }

    /// A discrete variable.
    pub fn of_type(
        data_type: DataType,
        causality: Causality,
        name: impl Into<Text>,
        description: impl Into<Text>,
    ) -> Variable {
        Variable {
            name: name.into(),
            description: description.into(),
            data_type,
            causality,
            is_continuous: false,
            role: Role::Other,
            depends_on: Vec::new(),
            start: None,
            display_unit: None,
            nominal: None,
        }
    }

    /// Time, the last variable of a table.
    pub fn time() -> Variable {
        Variable::real(Causality::Independent, "time", "s", "where the simulation is")
    }

    /// The variable that follows from those called `names`, too.
    pub fn from<T: Into<Text>>(mut self, names: impl IntoIterator<Item = T>) -> Variable {
        self.depends_on.extend(names.into_iter().map(Into::into));
        self
    }

    /// The variable as a continuous state.
    pub fn state(self) -> Variable {
        Variable { role: Role::State, ..self }
    }

    /// The variable as an event indicator, positive until the event.
    pub fn indicator(self) -> Variable {
        Variable { role: Role::Indicator, ..self }
    }

    /// The variable as the derivative of the state `name`.
    pub fn rate_of(self, name: impl Into<Text>) -> Variable {
        Variable { role: Role::RateOf(name.into()), ..self }
    }

    /// The variable with a range and a start value, of what a host sets.
    pub fn between(mut self, min: f64, max: f64, start: f64) -> Variable {
        if let DataType::Real { range, .. } = &mut self.data_type {
            *range = Some((min, max));
        }
        Variable { start: Some(Value::Real(start)), ..self }
    }

    /// Whether initialization calculates the variable for others.
    pub fn is_initial_unknown(&self) -> bool {
        self.start.is_none()
            && (matches!(self.causality, Causality::Output | Causality::CalculatedParameter)
                || matches!(self.role, Role::State | Role::RateOf(_)))
    }
}

/// The position of the variable called `name` in `variables`; the table is wrong if there is none.
pub fn position(variables: &[Variable], name: &str) -> usize {
    let found = variables.iter().position(|variable| variable.name == name);
    found.unwrap_or_else(|| panic!("no variable is called {name}"))
}

/// The references of the variables whose role is one, in their order.
pub fn references(variables: &[Variable], is_one: fn(&Role) -> bool) -> Vec<u32> {
    (0..).zip(variables).filter(|(_, variable)| is_one(&variable.role)).map(|(reference, _)| reference).collect()
}

/// The references of the continuous states, in their order.
pub fn state_references(variables: &[Variable]) -> impl Iterator<Item = u32> {
    variables.iter().filter_map(|variable| match &variable.role {
        Role::RateOf(state) => Some(position(variables, state) as u32),
        _ => None,
    })
}

/// The positions of the inputs, states, parameters and time that the variable at position `of` depends on, once the
/// simulation goes on or, `at_start`, during initialization: what it follows from directly, and what that follows from. The
/// states end the search, unless at the start, where they follow from what they start from.
pub fn dependencies(variables: &[Variable], of: usize, at_start: bool) -> Vec<usize> {
    let (mut known, mut passed) = (BTreeSet::new(), BTreeSet::new());
    let mut open = vec![of];
    while let Some(at) = open.pop() {
        let variable = &variables[at];
        let is_known = match variable.causality {
            Causality::Parameter | Causality::Input => true,
            Causality::Independent => !at_start,
            _ if at_start => variable.start.is_some(),
            _ => variable.role == Role::State,
        };
        if is_known {
            known.insert(at);
        } else if passed.insert(at) {
            open.extend(variable.depends_on.iter().map(|name| position(variables, name)));
        }
    }
    known.into_iter().collect()
}
