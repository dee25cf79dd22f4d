//! `sweep`: records × scale factors × structures, a row of CSV for every run; probabilities of overturning and of
//! exceeding limits, and fragility curves. Of pulses, overturning spectra.

pub mod design;
mod file;
mod map;
mod picture;
mod table;

use crate::picture::Picture;
use crate::results::FormatArgs;
use crate::talk::{few, progress, say};
use FlexibleRocking::BUILD;
use anyhow::{bail, ensure};
use file::{RecordSweep, SweepContent};
use rayon::ThreadPool;
use rocking::digits::with_unit;
use rocking_report::{input, output_files::OutputFiles};
use rocking_sweep::exceedances;
use rocking_sweep::outcome::Outcome;
use rocking_sweep::plan::{Case, Plan};
use rocking_sweep::row_file::{self, Program};
use rocking_sweep::rows::Sweep;
use rocking_sweep::thread_pool;
use std::fmt::Write;
use std::path::{Path, PathBuf};
use uuid::Uuid;

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
    #[arg(long, value_name = "FILE.svg")]
    picture: Option<PathBuf>,
    #[command(flatten)]
    threads: ThreadArgs,
    /// Find, too, how far each run exceeds the model's limits: tension, load of the edge, friction, energy gained at impacts
    #[arg(long)]
    validity: bool,
    #[command(flatten)]
    results: FormatArgs,
}

/// How many runs are done at a time.
#[derive(clap::Args)]
pub struct ThreadArgs {
    /// Runs at a time; 0 is one per core
    #[arg(long, value_name = "N", default_value_t = 0)]
    threads: i64,
}

impl ThreadArgs {
    fn pool(&self) -> anyhow::Result<ThreadPool> {
        Ok(thread_pool(self.threads)?)
    }
}

/// Does the runs that are not in the file yet, then prints and draws the probabilities.
pub fn run(args: &SweepArgs) -> anyhow::Result<()> {
    let pool = args.threads.pool()?;
    let mut files = OutputFiles::of_inputs([args.file.as_path()]);
    let asked = file::read(&args.file, &mut files)?;
    let output = match &args.output {
        Some(path) => path.clone(),
        None if input::is_standard(&args.file) => "sweep.csv".into(),
        None => PathBuf::from(args.file.file_stem().unwrap_or_default()).with_extension("csv"),
    };
    ensure!(!input::is_standard(&output), "rows need a file, which is read again: give it with -o");
    files.create(&output)?;
    let picture = args.picture.clone().unwrap_or(output.with_extension("svg"));
    let picture = Picture::create(&picture, &mut files)?;
    match asked {
        SweepContent::Records(sweep) => run_records(args, *sweep, &pool, &output, picture),
        SweepContent::Pulses(sweep) => {
            ensure!(!args.validity, "--validity is for records: `simulate` a pulse that `pulse` writes");
            map::run(sweep, args.results, &pool, &output, picture)
        }
        SweepContent::Design(..) => bail!("[design] is for `rocking-fmu design`"),
    }
}

fn run_records(
    args: &SweepArgs,
    sweep: RecordSweep,
    pool: &ThreadPool,
    output: &Path,
    picture: Picture,
) -> anyhow::Result<()> {
    let RecordSweep { plan, limits, measure, records } = sweep;
    let program = Program::of(BUILD);
    let runs = Sweep::open(&plan, args.validity, &program, Some(output))?;
    let missing = runs.missing();
    let done = plan.len() - missing.len();
    let (name, [members, motions, scales]) = (output.display(), plan.size());
    say!(
        "{name}: {done} of {} runs done, structures: {members}, records: {motions}, scale factors: {scales}",
        plan.len()
    );
    few(records, "records").iter().for_each(|line| say!("{line}"));
    row_file::others(runs.others, output, "runs that are not in this sweep").iter().for_each(|line| say!("{line}"));

    let bar = progress(missing.len(), "runs")?;
    let count = || {
        bar.inc(1);
        true
    };
    pool.install(|| runs.finish(count))?;
    bar.finish_and_clear();
    let (keys, outcomes) = runs.outcomes();

    let populations = exceedances::count(&plan, measure, &limits, &outcomes);
    let text = || {
        let mut out = String::new();
        populations.iter().try_for_each(|population| table::write(&mut out, population, measure))?;
        let digits = outcomes.iter().filter_map(|of| if let Outcome::Ended(of) = of { of.digits } else { None });
        let digits = Vec::from_iter(digits);
        if !digits.is_empty() {
            let (few, all) = (digits.iter().filter(|digits| **digits < 2).count(), digits.len());
            let part = 100.0 * few as f64 / all as f64;
            writeln!(out, "sure digits    fewer than two in {few} of {all} runs ({part:.3} %)")?;
        }
        Ok(out)
    };
    args.results.print(text, &table::curves(&populations, measure))?;
    say!("rows           {}", output.display());
    picture::draw(picture, &populations, measure)?;
    report_failures(&plan, &keys, &outcomes)
}

fn report_failures(plan: &Plan, keys: &[Uuid], outcomes: &[Outcome]) -> anyhow::Result<()> {
    let failed = || (0..plan.len()).filter(|index| matches!(outcomes[*index], Outcome::Failed { .. }));
    let Some(first) = failed().next() else { return Ok(()) };
    let (count, Case { population, motion, scale, .. }) = (failed().count(), plan.case(first));
    let (name, motion, scale, key) = (&population.name, &motion.name, with_unit(scale, "1"), keys[first]);
    bail!("{count} of {} runs failed; the first: {name}, {motion}, scale {scale}, see row {key}", plan.len())
}
