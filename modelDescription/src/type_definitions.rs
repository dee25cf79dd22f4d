use serde::Serialize;

/// Types that variables declare.
#[derive(Clone, Debug, Serialize)]
pub struct TypeDefinitions {
    /// The types.
    #[serde(rename = "SimpleType")]
    pub simple_types: Vec<SimpleType>,
}

/// A type that variables declare.
#[derive(Clone, Debug, Serialize)]
pub struct SimpleType {
    /// Name by which variables refer to it; no variable may have the same.
    #[serde(rename = "@name")]
    pub name: String,
    /// What it is.
    #[serde(rename = "@description")]
    pub description: String,
    /// Its attributes.
    #[serde(rename = "$value")]
    pub attributes: TypeAttributes,
}

/// Attributes of a type, by the element that holds them.
#[derive(Clone, Debug, Serialize)]
pub enum TypeAttributes {
    /// An enumeration.
    Enumeration(EnumerationType),
}

/// The literals of an enumeration.
#[derive(Clone, Debug, Serialize)]
pub struct EnumerationType {
    /// The literals.
    #[serde(rename = "Item")]
    pub items: Vec<Item>,
}

/// A literal of an enumeration.
#[derive(Clone, Debug, Serialize)]
pub struct Item {
    /// Its name.
    #[serde(rename = "@name")]
    pub name: String,
    /// The integer that stands for it.
    #[serde(rename = "@value")]
    pub value: i32,
}
