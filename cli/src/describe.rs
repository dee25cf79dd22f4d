//! `describe`: a structure's parameters and what follows from them.

use crate::results::{FormatArgs, print};
use crate::structure_args::StructureArgs;
use rocking::digits::significant;
use rocking::estimates::restoring::FlagPoint;
use rocking_report::{describe, structure_file};

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
        return print(&structure_file::write(&structure)?);
    }
    if let Some(theta) = args.restoring {
        let rows = describe::restoring(&structure, theta)?;
        let line = |of: &FlagPoint| format!("{:>12} {:>14}\n", significant(of.theta), significant(of.moment));
        let lines = || rows.iter().map(line).collect::<String>();
        let text = || Ok(format!("{:>12} {:>14}\n{}", "theta (rad)", "moment (N.m)", lines()));
        return args.results.print(text, &rows);
    }
    args.results.print(|| Ok(describe::text(&structure)?), &describe::numbers(&structure))
}
