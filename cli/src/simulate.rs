//! `simulate`: the response to a ground motion record, or free vibration, with the same engine as the FMU's.
mod picture;
mod profile;

use crate::{
    cause::Cause,
    limit_args::LimitArgs,
    picture::Picture,
    results::{FormatArgs, csv},
    scene_args::MotionArgs,
    talk::{say, write_as},
};
use anyhow::ensure;
use rocking::Base;
use rocking::digits::{short, significant};
use rocking::mechanics::restraint::centring_moments;
use rocking::run::record::Record;
use rocking_report::{
    output_files::{OutputFile, OutputFiles},
    quantities::in_readable_unit,
    run::{Line, Run},
    summary::instant,
    tables::event_line,
};
use std::path::PathBuf;

/// Arguments of `simulate`.
#[derive(clap::Args)]
pub struct SimulateArgs {
    #[command(flatten)]
    motion: MotionArgs,
    #[command(flatten)]
    results: ResultArgs,
    #[command(flatten)]
    limits: LimitArgs,
}

#[derive(clap::Args)]
#[command(next_help_heading = "Results")]
struct ResultArgs {
    /// Interval of the response that -o writes [default: the record's samples; 0.001 in free vibration]
    #[arg(long, value_name = "SECONDS", requires = "output", allow_hyphen_values = true)]
    interval: Option<f64>,
    /// Response as CSV, `-` for standard output
    #[arg(short, long, value_name = "FILE.csv")]
    output: Option<PathBuf>,
    /// Transitions as CSV: instant, kind, state before and after
    #[arg(long, value_name = "FILE.csv")]
    events: Option<PathBuf>,
    #[command(flatten)]
    format: FormatArgs,
    /// Draw ground acceleration, rotation, displacements and acceleration over time, with marks at transitions; of many masses those of the top floor
    #[arg(long, value_name = "FILE.svg")]
    picture: Option<PathBuf>,
    /// Draw the largest acceleration, drift, shear and moment of each floor and storey over the height, and those on a fixed base
    #[arg(long, value_name = "FILE.svg")]
    profile: Option<PathBuf>,
}

impl SimulateArgs {
    /// Instants of the output (s), and the interval (s) at which they go on: the samples, or the first alone.
    fn samples_and_interval<'a>(&self, ground: &'a Record) -> (&'a [f64], f64) {
        let samples = ground.times();
        let last = samples.len() - 1;
        match self.results.interval.or(self.motion.ground.free_vibration_interval()) {
            Some(interval) => (&samples[..1], interval),
            None => (samples, samples[last] - samples[last - 1]),
        }
    }

    /// Refuses an interval at which the table of a run until `end` (s) would have no end.
    fn check_rows(&self, ground: &Record, end: f64) -> anyhow::Result<()> {
        const MOST_ROWS: f64 = 1e6; // 200 MB
        let (samples, interval) = self.samples_and_interval(ground);
        let rows = samples.len() as f64 + (end - samples[samples.len() - 1]) / interval;
        ensure!(
            interval > 0.0 && rows <= MOST_ROWS,
            "interval = {} s over {} s: it must be above 0 and make at most {MOST_ROWS:.0e} rows",
            short(interval),
            short(end - ground.start())
        );
        Ok(())
    }

    /// Writes the response of `run` at the instants asked for.
    fn write_response(&self, run: &Run, file: OutputFile) -> anyhow::Result<()> {
        let (samples, interval) = self.samples_and_interval(&run.ground);
        let (start, from) = (samples[0], samples[samples.len() - 1]);
        let times = samples.iter().copied().chain((1_u64..).map(|i| from + i as f64 * interval));
        let mut lines = Vec::new();
        run.sample(times, None, |line| lines.push(line), &mut ())?;
        // an instant that misses the end by rounding is the end
        if let [.., Line(before, ..), Line(end, ..)] = &lines[..]
            && before[0] >= end[0] - 1e-6 * interval.min(end[0] - start)
        {
            lines.remove(lines.len() - 2);
        }
        write_as(file, "response", &csv(run.headings(), lines.iter())?)
    }
}

/// Whether a structure with elastoplastic dissipators on this `base` centres itself, in a line.
fn centring(base: &Base) -> Option<String> {
    let [restoring, residual] = centring_moments(base);
    let [turned_back, held] = [restoring, residual].map(|moment| in_readable_unit(moment, "N.m", significant));
    let verdict =
        if restoring > residual { "the structure centres itself" } else { "it may stay rotated: see theta at end" };
    (residual > 0.0).then(|| {
        format!("weight and tendon turn the base back with {turned_back}, yielded dissipators hold it with up to {held}: {verdict}")
    })
}

/// Prints the summary of the response, and writes what is asked for.
pub fn run(args: &SimulateArgs) -> anyhow::Result<()> {
    let limits = args.limits.limits()?;
    let output = args.results.output.as_deref();
    args.results.format.check_beside(output)?;
    let run = args.motion.load()?;
    let ResultArgs { picture, profile, events, .. } = &args.results;
    let has_floors = !run.structure.floors().is_empty();
    ensure!(profile.is_none() || has_floors, "--profile: the structure has no floors; give masses, heights and shapes");
    if let Some(line) = centring(run.structure.base()) {
        say!("centring       {line}");
    }
    let cause =
        Cause::new(run.structure.clone()).under(&args.motion.ground.record, &run.ground).computed(&run.conditions);
    let mut files = OutputFiles::of_inputs(args.motion.inputs());
    let response = output.map(|path| files.create(path)).transpose()?;
    let events = events.as_deref().map(|path| files.create(path)).transpose()?;
    let picture = picture.as_deref().map(|path| Picture::create(path, &mut files)).transpose()?;
    let profile = profile.as_deref().map(|path| Picture::create(path, &mut files)).transpose()?;
    let found = run.found(Some(limits), &mut ())?;
    if let Some(file) = events {
        write_as(file, "transitions", &csv(run.event_headings(), found.events.iter().map(event_line))?)?;
    }
    if let Some(file) = response {
        args.check_rows(&run.ground, found.end)?;
        args.write_response(&run, file)?;
    }
    let text = || {
        let (title, start, end) = (run.ground.title(), instant(found.start), instant(found.end));
        Ok(format!("{title}, {start} to {end} s\n{}\n", run.text(&found, &limits)?))
    };
    args.results.format.print_beside(output, text, &found.whole(&cause, &limits))?;
    if let Some(picture) = picture {
        picture::draw(picture, &run)?;
    }
    profile.map_or(Ok(()), |picture| profile::draw(picture, &run, &found))
}
