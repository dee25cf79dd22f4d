use crate::{List, SeError, document};
use serde::Serialize;

/// Root of `terminalsAndIcons.xml`.
#[derive(Clone, Debug, Serialize)]
#[serde(rename = "fmiTerminalsAndIcons")]
pub struct FmiTerminalsAndIcons {
    /// Version of the standard.
    #[serde(rename = "@fmiVersion")]
    pub fmi_version: &'static str,
    /// The terminals.
    #[serde(rename = "Terminals")]
    pub terminals: List<Terminal>,
}

impl FmiTerminalsAndIcons {
    /// The text of `terminalsAndIcons.xml`.
    pub fn to_xml(&self) -> Result<String, SeError> {
        document(self)
    }
}

/// Variables that are connected together.
#[derive(Clone, Debug, Serialize)]
pub struct Terminal {
    /// Its name.
    #[serde(rename = "@name")]
    pub name: String,
    /// Which variables of two terminals are connected.
    #[serde(rename = "@matchingRule")]
    pub matching_rule: &'static str,
    /// What it is.
    #[serde(rename = "@description")]
    pub description: String,
    /// Its variables.
    #[serde(rename = "TerminalMemberVariable")]
    pub members: Vec<TerminalMemberVariable>,
}

/// Variables of one name are connected; each side may have others.
pub const BUS: &str = "bus";

/// A variable of a terminal.
#[derive(Clone, Debug, Serialize)]
pub struct TerminalMemberVariable {
    /// Name of the variable.
    #[serde(rename = "@variableName")]
    pub variable_name: String,
    /// Its name within the terminal.
    #[serde(rename = "@memberName")]
    pub member_name: String,
    /// What a connection of it means.
    #[serde(rename = "@variableKind")]
    pub variable_kind: &'static str,
}

/// A connection is from output to input.
pub const SIGNAL: &str = "signal";
