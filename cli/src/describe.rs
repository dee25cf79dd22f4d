//! `describe`: a structure's parameters and what follows from them.

mod template;

use crate::{
    results::{FormatArgs, print},
    structure_args::StructureArgs,
};
use anyhow::{bail, ensure};
use rocking::digits::significant;
use rocking::structure::parameters::PARAMETERS;
use rocking::structure::quantity::Quantity;
use rocking::{
    estimates::restoring::{FlagPoint, flag},
    structure::{DERIVED, Derived, any::AnyStructure},
};
use rocking_report::{describe, quantities::NamedValue};
use std::f64::consts::FRAC_PI_2;

/// Arguments of `describe`.
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

/// Steps of each way of the loop.
const STEPS: u32 = 20;

/// Prints the parameters as they were given and the derived quantities with the equations that define them.
pub fn run(args: &DescribeArgs) -> anyhow::Result<()> {
    let structure = match args.structure.load_any()? {
        AnyStructure::Many(_) if args.template => bail!("--template writes structures of one mass only"),
        AnyStructure::Many(frame) if args.restoring.is_none() => {
            return args.results.print(|| Ok(describe::frame(&frame)?), &describe::numbers(&frame));
        }
        any => any.one("--restoring")?,
    };
    if args.template {
        let mut out = String::new();
        template::write(&mut out, &structure)?;
        return print(&out);
    }
    if let Some(theta) = args.restoring {
        let is_in_range = theta > 0.0 && theta < FRAC_PI_2;
        ensure!(is_in_range, "restoring = {theta} rad is out of range: a rotation above 0 and below pi/2 is needed");
        let rows = flag(&structure, theta, STEPS);
        return args.results.print(|| Ok(text_of_loop(&rows)), &rows);
    }
    let given = PARAMETERS.iter().map(|Quantity { name, unit, description, get, .. }| {
        NamedValue::new(name, get(structure.parameters()), unit, "", description)
    });
    let derived = DERIVED.iter().map(|Derived { name, unit, description, equation, value }| {
        NamedValue::new(name, value(&structure), unit, equation, description)
    });
    let lines: Vec<_> = given.chain(derived).collect();
    args.results.print(|| Ok(describe::text(&structure)?), &lines)
}

/// The moment that turns the base back on the way there and back, for people.
fn text_of_loop(rows: &[FlagPoint]) -> String {
    let line =
        |FlagPoint { theta, moment }: &FlagPoint| format!("{:>12} {:>14}\n", significant(*theta), significant(*moment));
    format!("{:>12} {:>14}\n{}", "theta (rad)", "moment (N.m)", rows.iter().map(line).collect::<String>())
}
