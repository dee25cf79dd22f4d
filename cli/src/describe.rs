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
    estimates::restoring::{Point, flag},
    structure::{DERIVED, Derived},
};
use serde::Serialize;
use std::f64::consts::FRAC_PI_2;
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
    /// Print the moment that turns the base back instead, while it is turned slowly to this rotation and back
    #[arg(long, value_name = "RAD", value_parser = rotation, conflicts_with = "template")]
    restoring: Option<f64>,
}

/// Steps of each way of the loop.
const STEPS: u32 = 20;

/// A row of the loop, in SI units.
#[derive(Serialize)]
struct OfLoop {
    theta: f64,
    moment: f64,
}

fn rotation(text: &str) -> Result<f64, String> {
    let theta = text.parse().ok().filter(|theta: &f64| *theta > 0.0 && *theta < FRAC_PI_2);
    theta.ok_or_else(|| "a rotation between 0 and pi/2 rad is needed, such as 0.05".into())
}

/// Prints the parameters as they were given and the derived quantities with the equations that define them.
pub fn run(args: &DescribeArgs) -> anyhow::Result<()> {
    let structure = args.structure.load()?;
    if args.template {
        let mut out = String::new();
        template::write(&mut out, &structure)?;
        return print(&out);
    }
    if let Some(theta) = args.restoring {
        return print_loop(args.results.format, &structure, theta);
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

/// The moment that turns the base back on the way to `theta` (rad) and back.
fn print_loop(format: Format, structure: &Structure, theta: f64) -> anyhow::Result<()> {
    let rows: Vec<_> =
        flag(structure, theta, STEPS).into_iter().map(|Point { theta, moment }| OfLoop { theta, moment }).collect();
    if format != Format::Text {
        return print_rows(format, &rows);
    }
    let mut out = format!("{:>12} {:>14} {:>14}\n", "theta (rad)", "there (N.m)", "back (N.m)");
    let (there, back) = rows.split_at(STEPS as usize + 1);
    // the way back begins where the way there ends
    let back = back.iter().rev().chain(there.last());
    for (there, back) in there.iter().zip(back) {
        let [theta, there, back] = [there.theta, there.moment, back.moment].map(significant);
        writeln!(out, "{theta:>12} {there:>14} {back:>14}")?;
    }
    print(&out)
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
