use crate::shortest;
use serde::Serialize;

/// A unit and what it is in SI base units.
#[derive(Clone, Debug, Serialize)]
pub struct Unit {
    /// Name by which variables refer to it.
    #[serde(rename = "@name")]
    pub name: String,
    /// Its SI base units.
    #[serde(rename = "BaseUnit", skip_serializing_if = "Option::is_none")]
    pub base_unit: Option<BaseUnit>,
    /// Units that hosts may show instead.
    #[serde(rename = "DisplayUnit")]
    pub display_units: Vec<DisplayUnit>,
}

/// A unit to show values in.
#[derive(Clone, Debug, Serialize)]
pub struct DisplayUnit {
    /// Name by which variables refer to it.
    #[serde(rename = "@name")]
    pub name: String,
    /// What a value is multiplied by to be shown.
    #[serde(rename = "@factor", serialize_with = "shortest")]
    pub factor: f64,
}

/// Exponents of the SI base units, and of rad; a zero is left out.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct BaseUnit {
    /// Exponent of the kilogram.
    #[serde(rename = "@kg", skip_serializing_if = "is_zero")]
    pub kg: i32,
    /// Exponent of the metre.
    #[serde(rename = "@m", skip_serializing_if = "is_zero")]
    pub m: i32,
    /// Exponent of the second.
    #[serde(rename = "@s", skip_serializing_if = "is_zero")]
    pub s: i32,
    /// Exponent of the radian.
    #[serde(rename = "@rad", skip_serializing_if = "is_zero")]
    pub rad: i32,
}

fn is_zero(exponent: &i32) -> bool {
    *exponent == 0
}
