//! `design`: the value of a number of a structure at which limits hold in a share of the runs, and the curve over its range.

use super::ThreadArgs;
use super::file::{self, SweepContent};
use crate::picture::{Picture, axes, chart, colour, dashed, line, px, titled};
use crate::results::{FormatArgs, csv};
use crate::talk::{few, progress, say, write_as};
use anyhow::bail;
use plotters::prelude::*;
use rocking::digits::significant;
use rocking_report::output_files::OutputFiles;
use rocking_sweep::design::{Design, DesignPoint, Designed};
use rocking_sweep::row_file::heading;
use std::path::PathBuf;

#[derive(clap::Args)]
pub struct DesignArgs {
    /// Records, a structure and what is sought
    #[arg(value_name = "FILE.toml")]
    file: PathBuf,
    /// Curve as CSV, `-` for standard output
    #[arg(short, long, value_name = "FILE.csv")]
    output: Option<PathBuf>,
    /// Picture of the curve, SVG
    #[arg(long, value_name = "FILE.svg")]
    picture: Option<PathBuf>,
    #[command(flatten)]
    threads: ThreadArgs,
    #[command(flatten)]
    results: FormatArgs,
}

pub fn run(args: &DesignArgs) -> anyhow::Result<()> {
    let output = args.output.as_deref();
    args.results.check_beside(output)?;
    let (pool, mut files) = (args.threads.pool()?, OutputFiles::of_inputs([args.file.as_path()]));
    let SweepContent::Design(design, records) = file::read(&args.file, &mut files)? else {
        bail!("[design] is missing: `rocking-fmu design --help` ends with such a file");
    };
    let curve = output.map(|path| files.create(path)).transpose()?;
    let picture = args.picture.as_ref().map(|path| Picture::create(path, &mut files)).transpose()?;
    few(records, "records").iter().for_each(|line| say!("{line}"));
    let bar = progress(0, "runs")?;
    let points = pool.install(|| {
        design.complete(|done, all| {
            bar.set_length(all as u64);
            bar.set_position(done as u64);
        })
    })?;
    bar.finish_and_clear();
    let (found, limits) = (design.found(&points), &design.sought.limit);
    let name = heading(&design.sought.vary, design.unit());
    let headings = [&name, "holds", "within", "unknown"].into_iter().map(str::to_owned);
    let headings: Vec<_> = headings.chain(limits.iter().cloned()).collect();
    if let Some(curve) = curve {
        let rows = points.iter().map(|of| (of.value, of.holds, of.within, of.unknown, &of.demands));
        write_as(curve, "curve", &csv(headings, rows)?)?;
    }
    let text = || {
        let mut out = format!("{}\n\n{name:>14}   within", found.sentence);
        limits.iter().for_each(|limit| out += &format!("  {limit:>16}"));
        for DesignPoint { value, within, demands, .. } in &points {
            out += &format!("\n{:>14} {:>6.1} %", significant(*value), 100.0 * within);
            let of_limit = |(limit, of): (&String, &f64)| format!("  {of:>0$.4}", limit.len().max(16));
            out.extend(limits.iter().zip(demands).map(of_limit));
        }
        let share = 100.0 * design.sought.share;
        Ok(out + &format!("\nwithin: all limits; below a limit, the demand in {share} % of the runs over it\n"))
    };
    args.results.print_beside(output, text, &found)?;
    picture.map_or(Ok(()), |picture| draw(picture, &name, &design, &points, &found))
}

/// The part of the runs that is within all limits over the number, and the share.
fn draw(picture: Picture, name: &str, design: &Design, points: &[DesignPoint], found: &Designed) -> anyhow::Result<()> {
    let (low, high, share) = (points[0].value, points[points.len() - 1].value, design.sought.share);
    picture.draw((860, 460), |area| {
        let rest = titled(area, &format!("Design: {name}"), &found.sentence)?;
        let mut plot = chart(&rest, 46.0).build_cartesian_2d(low..high, 0.0..1.02)?;
        axes(&mut plot, [name, "part of the runs within all limits; dashed: needed"], [8, 6])?;
        let curve = Vec::from_iter(points.iter().map(|of| (of.value, of.within)));
        plot.draw_series([PathElement::new(curve, line(colour::GREY))])?;
        dashed(&mut plot, &[(low, share), (high, share)], colour::INK)?;
        let dot = |of: &DesignPoint| {
            let colour = if of.holds { colour::GREEN } else { colour::VERMILLION };
            Circle::new((of.value, of.within), px(3.5), colour.filled())
        };
        plot.draw_series(points.iter().map(dot))?;
        Ok(())
    })
}
