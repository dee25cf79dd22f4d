//! `simulate`: the response to a ground motion record, or free vibration, with the same engine as the FMU's.
mod picture;

use crate::{
    cause::Cause,
    picture::PictureFile,
    quantities::in_readable_unit,
    record_args::positive,
    results::{Format, FormatArgs, print_beside},
    scene_args::MotionArgs,
    significant::{short, significant},
    summary::{Summary, instant},
    tables::{self, Table},
    talk::{self, say},
    validity::{self, LimitArgs},
};
use anyhow::ensure;
use rocking::run::record::Record;
use rocking::{
    Run, Structure, Transition,
    mechanics::restraint::centring_moments,
    run::{
        End,
        validity::{Found as Beyond, Validity},
    },
};
use std::path::PathBuf;

/// What to simulate.
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
    #[arg(long, value_name = "SECONDS", value_parser = positive, requires = "output", allow_negative_numbers = true)]
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
    picture: Option<PictureFile>,
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
            rows <= MOST_ROWS,
            "an interval of {} s over {} s makes {rows:.0e} rows: {MOST_ROWS:.0e} are possible; see --interval",
            short(interval),
            short(end - ground.start())
        );
        Ok(())
    }

    /// Writes the response of `run` at the instants asked for.
    fn write_response(&self, run: &Run, mut response: Table) -> anyhow::Result<()> {
        let progress = talk::progress(run.ground.times().len());
        let (samples, interval) = self.samples_and_interval(run.ground);
        let (start, from) = (samples[0], samples[samples.len() - 1]);
        let times = samples.iter().copied().chain((1_u64..).map(|i| from + i as f64 * interval));
        let (mut rows, mut last) = (response.write(tables::RESPONSE), None);
        run.sample(
            times,
            |sample| {
                progress.inc(1);
                let next = (sample.motion.time, tables::response_line(sample));
                // an instant that misses the end by rounding is the end
                let rounding = 1e-6 * interval.min(sample.motion.time - start);
                if let Some((time, line)) = last.replace(next)
                    && time < sample.motion.time - rounding
                    && rows.is_ok()
                {
                    rows = response.write(line);
                }
            },
            &mut (),
        )?;
        progress.finish_and_clear();
        rows?;
        last.map_or(Ok(()), |(_, line)| response.write(line))?;
        response.finish("response")
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
    let (structure, ground) = args.motion.load()?;
    let run = args.motion.run(structure, &ground);
    if let Some(line) = centring(&structure) {
        say!("centring       {line}");
    }

    let output = args.results.output.as_deref();
    if let (Some(_), End::At(end)) = (output, run.end) {
        args.check_rows(&ground, end)?;
    }
    let ResultArgs { format, picture, events, .. } = &args.results;
    let mut files = format.files(args.motion.inputs());
    let response = output.map(|path| Table::create(&mut files, path)).transpose()?;
    let mut events = events.as_deref().map(|path| Table::create(&mut files, path)).transpose()?;
    let picture = picture.as_ref().map(|picture| picture.create(&mut files)).transpose()?;
    if let Some(events) = &mut events {
        events.write(tables::EVENTS)?;
    }
    let (mut summary, mut written) = (Summary::new(&structure), Ok(()));
    let mut transition = |transition: &Transition| {
        if let (Some(events), Ok(())) = (&mut events, &written) {
            written = events.write(tables::event_line(transition));
        }
    };
    let limits = args.limits.limits();
    let mut validity = Validity::new(&structure, limits, Beyond::since(ground.start()));
    let found = run.found(&mut (&mut validity, &mut (&mut summary, &mut transition)))?;
    written?;
    events.map_or(Ok(()), |events| events.finish("transitions"))?;
    if let Some(response) = response {
        args.check_rows(&ground, found.finish.motion.time)?;
        args.write_response(&run, response)?;
    }
    let (start, end) = (instant(found.start), instant(found.finish.motion.time));
    if args.results.format.format == Format::Text {
        let mut text = format!("{}, {start} to {end} s\n{}", ground.title(), summary.text(&found)?);
        for line in validity::section(&structure, run.detail, validity.found(), &limits) {
            text = text + &line + "\n";
        }
        print_beside(output, &text)?;
    } else {
        let validity = validity::rows(validity.found(), &limits);
        let cause = Cause::new(&structure).under(&args.motion.ground.record, &ground);
        let cause = cause.computed(Some((run.detail, run.tolerance)), run.initial);
        summary.print(args.results.format.format, &cause, &found, validity)?;
    }
    match picture {
        Some(picture) => picture::draw(picture, &run),
        None => Ok(()),
    }
}
