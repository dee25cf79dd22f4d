//! `simulate`: the response to a ground motion record, or free vibration, with the same engine as the FMU's.
mod picture;
mod profile;

use crate::cause::Cause;
use crate::limit_args::LimitArgs;
use crate::picture::Picture;
use crate::results::{FormatArgs, csv};
use crate::scene_args::{LevelArgs, MotionArgs};
use crate::talk::{say, write_as};
use anyhow::ensure;
use rocking::digits::{short, significant};
use rocking::mechanics::restraint::centring_moments;
use rocking::run::record::Record;
use rocking::{Base, Output};
use rocking_report::output_files::{OutputFile, OutputFiles};
use rocking_report::quantities::in_readable_unit;
use rocking_report::run::{RunSetup, event_line, usual_periods};
use rocking_report::summary::instant;
use rocking_report::tables::Line;
use rocking_sweep::plan::Conditions;
use std::path::PathBuf;

#[derive(clap::Args)]
pub struct SimulateArgs {
    #[command(flatten)]
    motion: MotionArgs,
    #[command(flatten)]
    level: LevelArgs,
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
    /// Response spectrum S_a of the acceleration of each floor as CSV, at 100 periods from 0.02 to 4 s
    #[arg(long, value_name = "FILE.csv")]
    spectrum: Option<PathBuf>,
    /// Damping ratio of --spectrum
    #[arg(long, value_name = "RATIO", default_value_t = 0.05, requires = "spectrum", allow_hyphen_values = true)]
    spectrum_zeta: f64,
    /// Draw the largest acceleration, drift, shear and moment of each floor and storey over the height, and those on a fixed base
    #[arg(long, value_name = "FILE.svg")]
    profile: Option<PathBuf>,
    /// Find, too, how many digits of each peak and of the outcome are sure, by runs under a changed input
    #[arg(long)]
    condition: bool,
}

impl SimulateArgs {
    /// Instants of the output (s), and the interval (s) at which they go on: the samples, or the first alone.
    fn samples_and_interval<'a>(&self, ground: &'a Record) -> (&'a [f64], f64) {
        let samples = ground.times();
        let last = samples.len() - 1;
        match self.results.interval.or(self.motion.ground.free().map(|_| 1e-3)) {
            Some(interval) => (&samples[..1], interval),
            None => (samples, samples[last] - samples[last - 1]),
        }
    }

    fn write_response(&self, run: &RunSetup, file: OutputFile) -> anyhow::Result<()> {
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

/// Refuses an `interval` (s) at which the table of a run until `end` (s) would have no end. The table has the `samples` (s) first.
fn check_rows(samples: &[f64], interval: f64, end: f64) -> anyhow::Result<()> {
    const MOST_ROWS: f64 = 1e6; // 200 MB
    let (duration, after) = (end - samples[0], end - samples[samples.len() - 1]);
    let rows = (samples.len() - 1) as f64 + after / interval;
    let digit = 10.0_f64.powf((duration / MOST_ROWS).log10().floor() - 1.0);
    let least = digit * (duration / MOST_ROWS / digit - 1e-6).ceil();
    let [shown, over, least] = [interval, duration, least].map(short);
    let is_possible = interval > 0.0 && rows <= (1.0 + 1e-9) * MOST_ROWS;
    ensure!(is_possible, "interval = {shown} s over {over} s: give {least} s or more, for at most {MOST_ROWS:e} rows");
    Ok(())
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

pub fn run(args: &SimulateArgs) -> anyhow::Result<()> {
    let limits = args.limits.limits()?;
    let output = args.results.output.as_deref();
    args.results.format.check_beside(output)?;
    let conditions = Conditions { finds_condition: args.results.condition, ..args.level.conditions() };
    let run = args.motion.load(conditions)?;
    let ResultArgs { picture, profile, events, spectrum, .. } = &args.results;
    let floors = run.structure.floors().len();
    let is_possible = floors > 0 || profile.is_none() && spectrum.is_none();
    ensure!(is_possible, "--profile and --spectrum: the structure has no floors; give masses, heights and shapes");
    if let Some(line) = centring(run.structure.base()) {
        say!("centring       {line}");
    }
    let cause = Cause::of(&args.motion, &run).computed(&run.conditions);
    let mut files = OutputFiles::of_inputs(args.motion.inputs());
    let response = output.map(|path| files.create(path)).transpose()?;
    let events = events.as_deref().map(|path| files.create(path)).transpose()?;
    let spectrum = spectrum.as_deref().map(|path| files.create(path)).transpose()?;
    let picture = picture.as_deref().map(|path| Picture::create(path, &mut files)).transpose()?;
    let profile = profile.as_deref().map(|path| Picture::create(path, &mut files)).transpose()?;
    let found = run.found(Some(limits), &mut ())?;
    if let Some(file) = events {
        write_as(file, "transitions", &csv(run.event_headings(), found.events.iter().map(event_line))?)?;
    }
    if let Some(file) = response {
        let (samples, interval) = args.samples_and_interval(&run.ground);
        check_rows(samples, interval, found.end)?;
        args.write_response(&run, file)?;
    }
    if let Some(file) = spectrum {
        let (periods, zeta) = (usual_periods(), args.results.spectrum_zeta);
        let columns = run.spectra(&found, &Vec::from_iter(0..floors), &periods, zeta, &mut ())?;
        let name = |floor| format!("{}[m/s2]", Output::a_t(floor).name(&run.structure).replacen("a_t", "S_a", 1));
        let headings = ["period[s]".to_owned()].into_iter().chain((0..floors).map(name));
        let row =
            |(i, period): (usize, &f64)| Vec::from_iter([*period].into_iter().chain(columns.iter().map(|of| of[i])));
        write_as(file, "spectrum", &csv(Vec::from_iter(headings), periods.iter().enumerate().map(row))?)?;
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
