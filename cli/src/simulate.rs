//! `simulate`: the response to a ground motion record, or free vibration, with the same engine as the FMU's.
mod picture;

use crate::{
    cause::Cause,
    limit_args::LimitArgs,
    picture::Picture,
    results::{FormatArgs, csv},
    scene_args::MotionArgs,
    significant::{short, significant},
    talk::{say, write_as},
};
use anyhow::ensure;
use rocking::run::record::Record;
use rocking::{
    Run, Structure, Transition,
    mechanics::restraint::centring_moments,
    run::validity::{Findings, Validity},
};
use rocking_report::{
    output_files::{OutputFile, OutputFiles},
    quantities::in_readable_unit,
    summary::{Summary, instant},
    tables::{EVENTS, RESPONSE, event_line, response_line},
    validity,
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
    #[arg(long, value_name = "SECONDS", requires = "output", allow_negative_numbers = true)]
    interval: Option<f64>,
    /// Response as CSV, `-` for standard output
    #[arg(short, long, value_name = "FILE.csv")]
    output: Option<PathBuf>,
    /// Transitions as CSV: instant, kind, state before and after
    #[arg(long, value_name = "FILE.csv")]
    events: Option<PathBuf>,
    #[command(flatten)]
    format: FormatArgs,
    /// Draw ground acceleration, rotation, displacements and acceleration over time, with marks at transitions
    #[arg(long, value_name = "FILE.svg|png")]
    picture: Option<PathBuf>,
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
        let (samples, interval) = self.samples_and_interval(run.ground);
        let (start, from) = (samples[0], samples[samples.len() - 1]);
        let times = samples.iter().copied().chain((1_u64..).map(|i| from + i as f64 * interval));
        let mut rows = Vec::new();
        run.sample(times, |sample| rows.push((sample.motion.time, response_line(sample))), &mut ())?;
        // an instant that misses the end by rounding is the end
        if let [.., (before, _), (end, _)] = rows[..]
            && before >= end - 1e-6 * interval.min(end - start)
        {
            rows.remove(rows.len() - 2);
        }
        write_as(file, "response", &csv(RESPONSE, rows.iter().map(|(_, line)| line))?)
    }
}

/// Whether a `structure` with elastoplastic dissipators centres itself, in a line.
fn centring(structure: &Structure) -> Option<String> {
    let [restoring, residual] = centring_moments(structure);
    let [turned_back, held] = [restoring, residual].map(|moment| in_readable_unit(moment, "N.m", significant));
    let verdict =
        if restoring > residual { "the structure centres itself" } else { "it may stay open: see theta at the end" };
    (residual > 0.0).then(|| {
        format!("weight and tendon turn the base back with {turned_back}, yielded dissipators hold it with up to {held}: {verdict}")
    })
}

/// Prints the summary of the response, and writes what is asked for.
pub fn run(args: &SimulateArgs) -> anyhow::Result<()> {
    let limits = args.limits.limits()?;
    args.results.format.check_beside(args.results.output.as_deref())?;
    let (structure, ground, conditions) = args.motion.load()?;
    let run = conditions.run(structure, &ground);
    if let Some(line) = centring(&structure) {
        say!("centring       {line}");
    }

    let output = args.results.output.as_deref();
    let ResultArgs { picture, events, .. } = &args.results;
    let mut files = OutputFiles::of_inputs(args.motion.inputs());
    let response = output.map(|path| files.create(path)).transpose()?;
    let events = events.as_deref().map(|path| files.create(path)).transpose()?;
    let picture = picture.as_deref().map(|path| Picture::create(path, &mut files)).transpose()?;
    let mut validity = Validity::new(&structure, limits, Findings::since(ground.start()));
    let mut transitions = Vec::new();
    let mut see = |transition: &Transition| transitions.push(*transition);
    let found = run.found(&mut (&mut validity, &mut see))?;
    if let Some(file) = events {
        write_as(file, "transitions", &csv(EVENTS, transitions.iter().map(event_line))?)?;
    }
    if let Some(file) = response {
        args.check_rows(&ground, found.finish.motion.time)?;
        args.write_response(&run, file)?;
    }
    let summary = Summary::new(&structure, &transitions);
    let text = || {
        let (start, end) = (instant(found.start), instant(found.finish.motion.time));
        let section = validity::section(&structure, run.detail, validity.found(), &limits).join("\n");
        Ok(format!("{}, {start} to {end} s\n{}{section}\n", ground.title(), summary.text(&found)?))
    };
    let cause = Cause::new(&structure).under(&args.motion.ground.record, &ground).computed(&conditions);
    let whole = summary.whole(&cause, &found, validity::rows(validity.found(), &limits));
    args.results.format.print_beside(output, text, &whole)?;
    match picture {
        Some(picture) => picture::draw(picture, &run),
        None => Ok(()),
    }
}
