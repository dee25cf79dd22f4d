use serde::Serialize;

/// What depends on what.
#[derive(Clone, Debug, Serialize)]
pub struct ModelStructure {
    /// Every output, with what it depends on at a communication point.
    #[serde(rename = "Outputs")]
    pub outputs: Outputs,
    /// The derivative of every continuous state, with what it depends on at any time.
    #[serde(rename = "Derivatives")]
    pub derivatives: Derivatives,
    /// Every variable that initialization calculates, with what it depends on there.
    #[serde(rename = "InitialUnknowns")]
    pub initial_unknowns: InitialUnknowns,
}

/// Every output, with what it depends on at a communication point.
#[derive(Clone, Debug, Serialize)]
pub struct Outputs {
    /// The outputs.
    #[serde(rename = "Unknown")]
    pub unknowns: Vec<Unknown>,
}

/// The derivative of every continuous state, with what it depends on at any time. Their order is that of the states.
#[derive(Clone, Debug, Serialize)]
pub struct Derivatives {
    /// The derivatives.
    #[serde(rename = "Unknown")]
    pub unknowns: Vec<Unknown>,
}

/// Every variable that initialization calculates, with what it depends on there, by rising index.
#[derive(Clone, Debug, Serialize)]
pub struct InitialUnknowns {
    /// The calculated variables.
    #[serde(rename = "Unknown")]
    pub unknowns: Vec<Unknown>,
}

/// A calculated variable and what it depends on.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct Unknown {
    /// Index of the variable in the list of all variables; the first is 1.
    #[serde(rename = "@index")]
    pub index: usize,
    /// Indices of the variables that it depends on; an empty list says that there are none.
    #[serde(rename = "@dependencies")]
    pub dependencies: Vec<usize>,
    /// How it depends on each of them.
    #[serde(rename = "@dependenciesKind")]
    pub dependencies_kind: Vec<DependenciesKind>,
}

/// How a calculated variable depends on a known one.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "camelCase")]
pub enum DependenciesKind {
    /// In any way.
    Dependent,
}
