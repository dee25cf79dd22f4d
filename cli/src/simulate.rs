//! `simulate`: the response to a ground motion record, or free vibration, with the same engine as the FMU's.
mod picture;
mod profile;

use self::picture::Pictured;
use crate::{
    cause::Cause,
    limit_args::LimitArgs,
    picture::Picture,
    results::{FormatArgs, csv},
    scene_args::MotionArgs,
    talk::{say, write_as},
};
use anyhow::ensure;
use rocking::digits::{short, significant};
use rocking::run::record::Record;
use rocking::run::validity::Validity;
use rocking::structure::{Base, any::AnyStructure};
use rocking::{Modes, Run, Transition, Watch, mechanics::restraint::centring_moments};
use rocking_report::{
    output_files::{OutputFile, OutputFiles},
    quantities::in_readable_unit,
    shown::Shown,
    summary::{Summary, instant},
    tables::{event_headings, event_line, response_headings, response_line},
    validity,
};
use rocking_sweep::plan::Conditions;
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
    fn write_response<Q: Shown>(&self, run: &Run<Q>, file: OutputFile) -> anyhow::Result<()> {
        let (samples, interval) = self.samples_and_interval(run.ground);
        let (start, from) = (samples[0], samples[samples.len() - 1]);
        let times = samples.iter().copied().chain((1_u64..).map(|i| from + i as f64 * interval));
        let mut rows = Vec::new();
        run.sample(times, |sample| rows.push((sample.motion.time, response_line(&run.structure, sample))), &mut ())?;
        // an instant that misses the end by rounding is the end
        if let [.., (before, _), (end, _)] = rows[..]
            && before >= end - 1e-6 * interval.min(end - start)
        {
            rows.remove(rows.len() - 2);
        }
        write_as(file, "response", &csv(response_headings::<Q>(&run.structure), rows.iter().map(|(_, line)| line))?)
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
    args.limits.limits()?;
    args.results.format.check_beside(args.results.output.as_deref())?;
    let (structure, ground, conditions) = args.motion.load()?;
    if let AnyStructure::Many(frame) = &structure {
        let draws_floors = args.results.profile.is_some() && frame.floors().is_empty();
        ensure!(!draws_floors, "--profile: the structure has no floors; give masses, heights and shapes");
    }
    if let Some(line) = centring(structure.base()) {
        say!("centring       {line}");
    }
    let cause = Cause::of_any(&structure).under(&args.motion.ground.record, &ground).computed(&conditions);
    match &structure {
        AnyStructure::One(one) => follow::<f64>(args, one, &ground, &conditions, &cause),
        AnyStructure::Many(frame) => follow::<Modes>(args, frame, &ground, &conditions, &cause),
    }
}

/// The same for a `structure` of one mass or of many.
fn follow<Q: Pictured>(
    args: &SimulateArgs,
    structure: &Q::Structure,
    ground: &Record,
    conditions: &Conditions,
    cause: &Cause,
) -> anyhow::Result<()>
where
    Validity<Q>: Watch<Q>,
{
    let limits = args.limits.limits()?;
    let run = Q::run(structure, ground, conditions)?;
    let output = args.results.output.as_deref();
    let ResultArgs { picture, profile, events, .. } = &args.results;
    let mut files = OutputFiles::of_inputs(args.motion.inputs());
    let response = output.map(|path| files.create(path)).transpose()?;
    let events = events.as_deref().map(|path| files.create(path)).transpose()?;
    let picture = picture.as_deref().map(|path| Picture::create(path, &mut files)).transpose()?;
    let profile = profile.as_deref().map(|path| Picture::create(path, &mut files)).transpose()?;
    let mut validity = run.validity_watch(limits)?;
    let mut transitions = Vec::new();
    let mut see = |transition: &Transition<Q>| transitions.push(*transition);
    let found = run.found(&mut (&mut validity, &mut see))?;
    if let Some(file) = events {
        write_as(
            file,
            "transitions",
            &csv(event_headings::<Q>(structure), transitions.iter().map(|of| event_line(structure, of)))?,
        )?;
    }
    if let Some(file) = response {
        args.check_rows(ground, found.finish.motion.time)?;
        args.write_response(&run, file)?;
    }
    let (summary, findings) = (Summary::new(structure, &transitions), validity.found());
    let text = || {
        let (start, end) = (instant(found.start), instant(found.finish.motion.time));
        let section = validity::section::<Q>(structure, run.detail, findings, &limits).join("\n");
        Ok(format!("{}, {start} to {end} s\n{}{section}\n", ground.title(), summary.text(&found)?))
    };
    let rows = validity::rows(findings, &limits);
    args.results.format.print_beside(output, text, &summary.whole(cause, &found, rows))?;
    if let Some(picture) = picture {
        Q::draw(picture, &run)?;
    }
    profile.map_or(Ok(()), |picture| profile::draw(picture, &run, &found))
}
