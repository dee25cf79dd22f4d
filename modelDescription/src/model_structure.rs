use crate::List;
use serde::Serialize;

/// What depends on what.
#[derive(Clone, Debug, Serialize)]
pub struct ModelStructure {
    /// Every output, with what it depends on at a communication point.
    #[serde(rename = "Outputs")]
    pub outputs: List<Unknown>,
    /// The derivative of every continuous state, in the order of the states, with what it depends on at any time.
    #[serde(rename = "Derivatives")]
    pub derivatives: List<Unknown>,
    /// Every variable that initialization calculates, by rising index, with what it depends on there.
    #[serde(rename = "InitialUnknowns")]
    pub initial_unknowns: List<Unknown>,
}

/// A calculated variable and what it depends on.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Unknown {
    /// Index of the variable in the list of all variables; the first is 1.
    #[serde(rename = "@index")]
    pub index: u32,
    /// Indices of the variables that it depends on; an empty list says that there are none.
    #[serde(rename = "@dependencies")]
    pub dependencies: Vec<u32>,
    /// How it depends on each of them.
    #[serde(rename = "@dependenciesKind")]
    pub dependencies_kind: Vec<&'static str>,
}

/// A variable depends on a known one in any way.
pub const DEPENDENT: &str = "dependent";
