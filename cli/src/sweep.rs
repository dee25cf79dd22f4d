//! `sweep`: records × scale factors × structures, a row of CSV for every run; probabilities of overturning and of
//! exceeding limits, and fragility curves. Of pulses, overturning spectra.

mod file;
mod map;
mod picture;
mod table;

use crate::{
    cause::program,
    input,
    output_files::OutputFiles,
    picture::{Picture, PictureFile},
    results::{Format, FormatArgs, print, print_json, print_rows},
    significant::significant,
    talk::{self, say, say_few},
};
use anyhow::{Context, bail};
use clap::value_parser;
use file::{Asked, RecordSweep};
use indicatif::{ProgressBar, ProgressStyle};
use rayon::{ThreadPool, ThreadPoolBuilder};
use rocking::structure::quantity::with_unit;
use rocking_sweep::{
    exceedances,
    outcome::Outcome,
    plan::{Case, Plan},
    rows::Sweep,
};
use std::{
    path::{Path, PathBuf},
    time::Instant,
};
use uuid::Uuid;

/// What to run.
#[derive(clap::Args)]
pub struct SweepArgs {
    /// Records, scale factors, structures and limits; or pulses and structures
    #[arg(value_name = "FILE.toml")]
    file: PathBuf,
    /// Rows as CSV; a file with some of this sweep's rows is completed [default: the TOML file's name and .csv, in this
    /// folder]
    #[arg(short, long, value_name = "FILE.csv")]
    output: Option<PathBuf>,
    /// Picture of the probabilities and fragility curves, or of the maps [default: beside the rows, as SVG]
    #[arg(long, value_name = "FILE.svg|png")]
    picture: Option<PictureFile>,
    /// Runs at a time [default: one per core]
    #[arg(long, value_name = "N", value_parser = value_parser!(u16).range(1..=1024))]
    threads: Option<u16>,
    /// Find, too, how far each run exceeds the model's limits: tension, load of the edge, friction, energy gained at impacts
    #[arg(long)]
    validity: bool,
    #[command(flatten)]
    results: FormatArgs,
}

/// Does the runs that are not in the file yet, then prints and draws the probabilities.
pub fn run(args: &SweepArgs) -> anyhow::Result<()> {
    let mut files = OutputFiles::of_inputs([args.file.as_path()]);
    let asked = file::read(&args.file, &mut files)?;
    let output = match &args.output {
        Some(path) => path.clone(),
        None if input::is_standard(&args.file) => "sweep.csv".into(),
        None => PathBuf::from(args.file.file_stem().unwrap_or_default()).with_extension("csv"),
    };
    let picture = args.picture.clone().unwrap_or(PictureFile::svg(output.with_extension("svg")));
    files.reserve_rows(&output)?;
    let picture = picture.create(&mut files).context("picture of the sweep")?;
    talk::if_stopped(format!(": finished runs are in {}; the same command continues from there", output.display()));
    match asked {
        Asked::Records(sweep) => run_records(args, sweep, &output, picture),
        Asked::Pulses(sweep) => map::run(args, sweep, &output, picture),
    }
}

/// Every record at every scale factor on every structure.
fn run_records(args: &SweepArgs, sweep: RecordSweep, output: &Path, picture: Picture) -> anyhow::Result<()> {
    let RecordSweep { plan, limits, measure, records, structures } = sweep;
    let program = program();
    let runs = Sweep::open(&plan, args.validity, &program, output)?;
    let missing = runs.missing();
    let done = plan.len() - missing.len();
    let (name, [members, motions, scales]) = (output.display(), plan.size());
    say!(
        "{name}: {done} of {} runs done, structures: {members}, records: {motions}, scale factors: {scales}",
        plan.len()
    );
    say_few(&structures, "structures");
    say_few(&records, "records");
    runs.others.others(output, "runs that are not in this sweep").iter().for_each(|line| say!("{line}"));

    let pool = thread_pool(args, missing.len())?;
    let clock = Instant::now();
    let (bar, goes_on) = progress(missing.len(), "runs")?;
    let (keys, outcomes) = pool.install(|| runs.finish(goes_on))?;
    bar.finish_and_clear();
    say_rate(missing.len(), "runs", clock, &pool);

    let populations = exceedances::count(&plan, measure, &limits, &outcomes);
    match args.results.format {
        Format::Text => {
            let mut out = String::new();
            populations.iter().try_for_each(|population| table::write(&mut out, population, measure))?;
            print(&out)?;
        }
        Format::Json => print_json(&table::curves(&populations, measure))?,
        Format::Csv => print_rows(
            Format::Csv,
            &table::curves(&populations, measure).iter().map(|of| &of.curve).collect::<Vec<_>>(),
        )?,
    }
    say!("rows           {}", output.display());
    picture::draw(picture, &populations, measure)?;
    report_failures(&plan, &keys, &outcomes)
}

/// As many threads as are asked for, or one per core, but no more than there are `runs`.
fn thread_pool(args: &SweepArgs, runs: usize) -> anyhow::Result<ThreadPool> {
    let threads = args.threads.map_or(0, |threads| usize::from(threads).min(runs).max(1));
    Ok(ThreadPoolBuilder::new().num_threads(threads).build()?)
}

/// Says how fast the runs that there were to do, which are called `what`, have been done since `clock`.
fn say_rate(done: usize, what: &str, clock: Instant, pool: &ThreadPool) {
    if done > 0 {
        let (seconds, threads) = (clock.elapsed().as_secs_f64(), pool.current_num_threads());
        let rate = done as f64 / seconds;
        let [seconds, rate, per_thread] = [seconds, rate, rate / threads as f64].map(significant);
        say!("{done} {what} in {seconds} s: {rate} /s, {per_thread} /s on each of {threads} threads");
    }
}

/// A bar for the progress of many runs, which are called `what`, and what moves it after each.
fn progress(runs: usize, what: &str) -> anyhow::Result<(ProgressBar, impl Fn() -> bool + Sync)> {
    let template = format!("{{elapsed_precise}} {{bar:40}} {{pos}}/{{len}} {what}, {{per_sec}}, {{eta}} left");
    let bar = talk::progress(runs).with_style(ProgressStyle::with_template(&template)?);
    let moved = bar.clone();
    Ok((bar, move || {
        moved.inc(1);
        true
    }))
}

/// Says how many runs failed, and which the first is.
fn report_failures(plan: &Plan, keys: &[Uuid], outcomes: &[Outcome]) -> anyhow::Result<()> {
    let failed = || (0..plan.len()).filter(|index| matches!(outcomes[*index], Outcome::Failed { .. }));
    let Some(first) = failed().next() else { return Ok(()) };
    let (count, Case { population, motion, scale, .. }) = (failed().count(), plan.case(first));
    let (name, motion, scale, key) = (population.name(), motion.name(), with_unit(scale, "1"), keys[first]);
    bail!("{count} of {} runs failed; the first: {name}, {motion}, scale {scale}, see row {key}", plan.len())
}
