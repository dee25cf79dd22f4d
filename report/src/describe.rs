//! A structure's parameters and what follows from them.

use crate::significant::{short, significant};
use rocking::Structure;
use rocking::structure::parameters::PARAMETERS;
use rocking::structure::quantity::Quantity;
use rocking::structure::{DERIVED, Derived};
use std::fmt::{self, Write};

/// The parameters and the derived quantities, for people.
pub fn text(structure: &Structure) -> Result<String, fmt::Error> {
    let mut out = String::new();
    let unit = |unit| if unit == "1" { "-" } else { unit };
    writeln!(out, "Parameters")?;
    for Quantity { name, unit: of, description, get, .. } in &PARAMETERS {
        let value = short(get(structure.parameters()));
        writeln!(out, "  {name:<10} {value:>12} {:<6} {description}", unit(of))?;
    }
    writeln!(out, "\nDerived quantities")?;
    for Derived { name, unit: of, description, equation, value } in &DERIVED {
        let value = significant(value(structure));
        writeln!(out, "  {name:<10} {value:>12} {:<6} {equation:<13} {description}", unit(of))?;
    }
    Ok(out)
}
