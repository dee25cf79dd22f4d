//! `describe`: a structure's parameters and what follows from them.

mod template;

use crate::{
    results::{FormatArgs, print},
    structure_args::StructureArgs,
};
use anyhow::ensure;
use rocking::digits::significant;
use rocking::estimates::restoring::{FlagPoint, flag};
use rocking_report::describe;
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
    let structure = args.structure.load_any()?;
    if args.template {
        let mut out = String::new();
        template::write(&mut out, structure.one_mass("--template")?)?;
        return print(&out);
    }
    if let Some(theta) = args.restoring {
        let is_in_range = theta > 0.0 && theta < FRAC_PI_2;
        ensure!(is_in_range, "restoring = {theta} rad is out of range: a rotation above 0 and below pi/2 is needed");
        let rows = flag(structure.base(), theta, STEPS);
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
