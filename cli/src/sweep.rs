//! `sweep`: records × scale factors × structures, a row of CSV for every run; probabilities of overturning and of
//! exceeding limits, and fragility curves.

mod fragilities;
mod outcome;
mod picture;
mod plan;
mod rows;

use crate::significant::significant;
use anyhow::Context;
use indicatif::{ProgressBar, ProgressStyle};
use outcome::Outcome;
use plan::Plan;
use rayon::{ThreadPoolBuilder, prelude::*};
use rows::Rows;
use std::{io::stdout, num::NonZeroUsize, path::PathBuf, sync::Mutex, time::Instant};

/// What to run.
#[derive(clap::Args)]
pub struct SweepArgs {
    /// Records, scale factors, structures and limits
    #[arg(value_name = "FILE.toml")]
    file: PathBuf,
    /// Rows as CSV; a file that holds some of this sweep's is completed. The picture goes beside it, as SVG
    /// [default: the TOML file's name and .csv, in this folder]
    #[arg(short, long, value_name = "FILE.csv")]
    output: Option<PathBuf>,
    /// Runs at a time [default: one per core]
    #[arg(long, value_name = "N")]
    threads: Option<NonZeroUsize>,
}

/// Does the runs that are not in the file yet, then prints and draws the probabilities.
pub fn run(args: &SweepArgs) -> anyhow::Result<()> {
    let plan = Plan::read(&args.file)?;
    let output = match &args.output {
        Some(path) => path.clone(),
        None => PathBuf::from(args.file.file_stem().unwrap_or_default()).with_extension("csv"),
    };
    let (rows, mut outcomes) = Rows::open(&output, &plan)?;
    let missing: Vec<_> = (0..plan.len()).filter(|index| outcomes[*index].is_none()).collect();
    let done = plan.len() - missing.len();
    eprintln!("{}: {done} of {} runs done, {}", output.display(), plan.len(), plan.describe());

    let pool = ThreadPoolBuilder::new().num_threads(args.threads.map_or(0, NonZeroUsize::get)).build()?;
    let clock = Instant::now();
    for (index, outcome) in pool.install(|| do_runs(&plan, &missing, rows))? {
        outcomes[index] = Some(outcome);
    }
    if !missing.is_empty() {
        let (seconds, threads) = (clock.elapsed().as_secs_f64(), pool.current_num_threads());
        let rate = missing.len() as f64 / seconds;
        let [seconds, rate, per_thread] = [seconds, rate, rate / threads as f64].map(significant);
        eprintln!("{} runs in {seconds} s: {rate} /s, {per_thread} /s on each of {threads} threads", missing.len());
    }

    let outcomes: Vec<_> = outcomes.into_iter().map(|outcome| outcome.expect("every run is done")).collect();
    let populations = fragilities::count(&plan, &outcomes);
    let mut out = stdout().lock();
    populations.iter().try_for_each(|population| population.print(&mut out))?;
    let picture = output.with_extension("svg");
    picture::draw(&picture, &populations).with_context(|| format!("{} cannot be written", picture.display()))?;
    eprintln!("rows {}, picture {}", output.display(), picture.display());
    Ok(())
}

/// Does the runs numbered `missing` and appends them to `rows` as they end.
fn do_runs(plan: &Plan, missing: &[usize], rows: Rows) -> anyhow::Result<Vec<(usize, Outcome)>> {
    let style = ProgressStyle::with_template("{elapsed_precise} {bar:40} {pos}/{len} runs, {per_sec}, {eta} left")?;
    let progress = ProgressBar::new(missing.len() as u64).with_style(style);
    let rows = Mutex::new(rows);
    let outcomes = missing.par_iter().map(|&index| {
        let run = plan.run(index);
        let outcome = Outcome::of(&run.point.structure, &run.ground()).with_context(|| run.describe())?;
        rows.lock().expect("no thread panics with the file in hand").append(&run, &outcome)?;
        progress.inc(1);
        Ok((index, outcome))
    });
    let outcomes = outcomes.collect();
    progress.finish_and_clear();
    outcomes
}
