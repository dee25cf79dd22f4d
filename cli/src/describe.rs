//! `describe`: a structure's parameters and what follows from them.

use crate::results::{FormatArgs, print};
use crate::structure_args::StructureArgs;
use anyhow::Context;
use rocking::digits::{short, significant};
use rocking::estimates::restoring::FlagPoint;
use rocking::structure::derived::Derived;
use rocking::structure::natural_quantities::{NATURAL, Natural};
use rocking::structure::parameters::{PARAMETERS, Parameters};
use rocking::{OneMass, Quantity};
use rocking_report::describe;
use std::fmt::{self, Write};

#[derive(clap::Args)]
pub struct DescribeArgs {
    #[command(flatten)]
    structure: StructureArgs,
    #[command(flatten)]
    results: FormatArgs,
    /// Print a commented file for --parameters instead: every parameter of this structure, with unit and range
    #[arg(long, conflicts_with = "format")]
    template: bool,
    /// Print the restoring moment instead of the table, while the base is rotated slowly to this angle and back
    #[arg(long, value_name = "RAD", conflicts_with = "template")]
    restoring: Option<f64>,
}

pub fn run(args: &DescribeArgs) -> anyhow::Result<()> {
    let structure = args.structure.load_any()?;
    if args.template {
        let one = structure.one().context(
            "--template has the parameters of one mass: copy the file of a building from docs/howto/frames.md",
        )?;
        return print(&template(one)?);
    }
    if let Some(theta) = args.restoring {
        let rows = describe::restoring(&structure, theta)?;
        return args.results.print(|| Ok(text_of_loop(&rows)), &rows);
    }
    args.results.print(|| Ok(describe::text(&structure)?), &describe::numbers(&structure))
}

/// The moment that turns the base back on the way there and back, for people.
fn text_of_loop(rows: &[FlagPoint]) -> String {
    let line =
        |FlagPoint { theta, moment }: &FlagPoint| format!("{:>12} {:>14}\n", significant(*theta), significant(*moment));
    format!("{:>12} {:>14}\n{}", "theta (rad)", "moment (N.m)", rows.iter().map(line).collect::<String>())
}

/// `structure` as a TOML file: every parameter with its unit and range, and what may be given in its place.
fn template(structure: &OneMass) -> Result<String, fmt::Error> {
    let mut out = String::new();
    out += "# A structure, for rocking-fmu ... --parameters FILE.toml. SI units; # begins a comment.\n\
            # A line that begins with # may replace the line above it. You may leave out what has a default.\n";
    for &Quantity { name, unit, description, min, max, get, .. } in PARAMETERS {
        let of = if unit == "1" { String::new() } else { format!(" {unit},") };
        let default = Some(get(&Parameters::DEFAULTS)).filter(|default| !default.is_nan());
        let default = default.map_or(String::new(), |default| format!(", default {}", short(default)));
        writeln!(out, "\n# {description},{of} {} to {}{default}", short(min), short(max))?;
        writeln!(out, "{name} = {}", shortest(get(structure.parameters())))?;
        for natural in NATURAL.iter().filter(|natural| natural.stands_for == name) {
            let &Natural { min, max, in_place_of, .. } = natural;
            let &Derived { name, unit, description, value, .. } = natural.derived();
            let (value, [min, max]) = (shortest(value(structure)), [min, max].map(short));
            writeln!(out, "# {name} = {value} # {description}, {unit}, {min} to {max}: instead of {in_place_of}")?;
        }
    }
    out += "\n# Without their #, these lines put the structure on ground that gives (Winkler springs), which needs J0 and no r.\n# [ground]\n\
            # f_v = 10 # frequency of the bounce on the ground, Hz: or k_v, the vertical stiffness, N/m\n\
            # zeta_v = 0.2 # damping ratio of the bounce\n# n_points = 2 # contact points from edge to edge\n";
    Ok(out)
}

/// `value` without the last rounding of what it was computed from, in as many digits as every decimal number keeps.
fn shortest(value: f64) -> f64 {
    format!("{value:.*e}", f64::DIGITS as usize - 1).parse().expect("a number in Rust's own notation")
}
