//! `pushover`: lateral force and moment against displacement (Fig 1).

use crate::cause::Cause;
use crate::results::{FormatArgs, Traced, csv};
use crate::structure_args::StructureArgs;
use crate::talk::write_as;
use rocking::estimates::pushover::Pushover;
use rocking_report::output_files::OutputFiles;
use rocking_report::pushover::{Corner, HEADINGS, corners, line};
use std::path::PathBuf;

#[derive(clap::Args)]
pub struct PushoverArgs {
    #[command(flatten)]
    structure: StructureArgs,
    /// Points on each of the two branches, full contact and rocking
    #[arg(long, value_name = "N", default_value_t = 100)]
    points: u32,
    /// Curve as CSV, `-` for standard output
    #[arg(short, long, value_name = "FILE.csv")]
    output: Option<PathBuf>,
    #[command(flatten)]
    results: FormatArgs,
}

pub fn run(args: &PushoverArgs) -> anyhow::Result<()> {
    args.results.check_beside(args.output.as_deref())?;
    let structure = args.structure.load_any()?;
    let create = |path: &PathBuf| OutputFiles::of_inputs(args.structure.input()).create(path);
    let file = args.output.as_ref().map(create).transpose()?;
    let pushed = Pushover::new(&structure)?;
    let curve = pushed.curve(args.points)?;
    if let Some(file) = file {
        write_as(file, "curve", &csv(HEADINGS, curve.iter().map(line))?)?;
    }
    let rows = corners(&pushed)?;
    let text = || Ok(rows.iter().map(Corner::line).collect());
    let traced = Traced { cause: &Cause::new(structure.clone()), rows: &rows };
    args.results.print_beside(args.output.as_deref(), text, &traced)
}
