//! `describe`: a structure's parameters and what follows from them.

mod template;

use crate::{
    quantities::NamedValue,
    results::{Format, FormatArgs, print, print_rows},
    significant::{short, significant},
    structure_args::StructureArgs,
};
use rocking::structure::parameters::PARAMETERS;
use rocking::structure::quantity::Quantity;
use rocking::{
    Structure,
    structure::{DERIVED, Derived},
};
use std::fmt::{self, Write};

/// What to describe.
#[derive(clap::Args)]
pub struct DescribeArgs {
    #[command(flatten)]
    structure: StructureArgs,
    #[command(flatten)]
    results: FormatArgs,
    /// Print a commented file for --parameters instead: every parameter of this structure, with unit and range
    #[arg(long, conflicts_with = "format")]
    template: bool,
}

/// Prints the parameters as they were given and the derived quantities with the equations that define them.
pub fn run(args: &DescribeArgs) -> anyhow::Result<()> {
    let structure = args.structure.load()?;
    if args.template {
        let mut out = String::new();
        template::write(&mut out, &structure)?;
        return print(&out);
    }
    if args.results.format == Format::Text {
        return print(&text(&structure)?);
    }
    let given = PARAMETERS.iter().map(|Quantity { name, unit, description, get, .. }| {
        NamedValue::new(name, get(structure.parameters()), unit, "", description)
    });
    let derived = DERIVED.iter().map(|Derived { name, unit, description, equation, value }| {
        NamedValue::new(name, value(&structure), unit, equation, description)
    });
    let lines: Vec<_> = given.chain(derived).collect();
    print_rows(args.results.format, &lines)
}

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
