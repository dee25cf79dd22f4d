//! `pushover`: lateral force and moment against displacement (Fig 1).

use crate::cause::Cause;
use crate::picture::{Picture, axes, chart, colour, line as stroke, titled};
use crate::results::{FormatArgs, Traced, csv};
use crate::structure_args::StructureArgs;
use crate::talk::write_as;
use plotters::prelude::LineSeries;
use rocking::Structure;
use rocking::estimates::pushover::{Equilibrium, Pushover};
use rocking_report::describe;
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
    /// Picture of the moment against the rotation, SVG
    #[arg(long, value_name = "FILE.svg")]
    picture: Option<PathBuf>,
    #[command(flatten)]
    results: FormatArgs,
}

pub fn run(args: &PushoverArgs) -> anyhow::Result<()> {
    args.results.check_beside(args.output.as_deref())?;
    let structure = args.structure.load_any()?;
    let mut files = OutputFiles::of_inputs(args.structure.input());
    let file = args.output.as_ref().map(|path| files.create(path)).transpose()?;
    let picture = args.picture.as_ref().map(|path| Picture::create(path, &mut files)).transpose()?;
    let pushed = Pushover::new(&structure)?;
    let curve = pushed.curve(args.points)?;
    if let Some(file) = file {
        write_as(file, "curve", &csv(HEADINGS, curve.iter().map(line))?)?;
    }
    picture.map_or(Ok(()), |picture| draw(picture, &structure, &curve))?;
    let rows = corners(&pushed)?;
    let text = || Ok(rows.iter().map(Corner::line).collect());
    let traced = Traced { cause: &Cause::new(structure.clone()), rows: &rows };
    args.results.print_beside(args.output.as_deref(), text, &traced)
}

/// The moment of the force over the rotation of the base.
fn draw(picture: Picture, structure: &Structure, curve: &[Equilibrium]) -> anyhow::Result<()> {
    let points: Vec<_> = curve.iter().map(|at| (at.theta, 1e-3 * at.moment)).collect();
    let [right, top] =
        [|of: &(f64, f64)| of.0, |of: &(f64, f64)| of.1].map(|of| points.iter().map(of).fold(0.0, f64::max));
    picture.draw((640, 420), |area| {
        let rest = titled(area, "pushover: moment of the force about the base", &describe::in_one_line(structure))?;
        let mut plot = chart(&rest, 46.0).build_cartesian_2d(0.0..right, 0.0..1.05 * top)?;
        axes(&mut plot, ["rotation θ (rad)", "M (kN m)"], [6, 6])?;
        plot.draw_series(LineSeries::new(points, stroke(colour::BLUE)))?;
        Ok(())
    })
}
