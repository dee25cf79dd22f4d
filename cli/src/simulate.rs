//! `simulate`: the response to a ground motion record, or free vibration, with the same engine as the FMU's.
mod picture;

use crate::{
    output_files::OutputFiles,
    picture::PictureFile,
    record_args::positive,
    results::{Format, FormatArgs, print},
    scene_args::MotionArgs,
    significant::short,
    summary::{self, Summary, instant},
    tables::{self, Table},
    talk::{self, say},
    validity::{self, LimitArgs},
};
use anyhow::ensure;
use rocking::{
    Transition,
    record::Record,
    run::{
        End,
        peaks::Peaks,
        validity::{Found, Validity},
    },
};
use std::path::{Path, PathBuf};

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
    /// Output interval [default: the record's samples; 0.001 in free vibration]
    #[arg(long, value_name = "SECONDS", value_parser = positive, allow_negative_numbers = true)]
    interval: Option<f64>,
    /// Response as CSV, `-` for standard output [default: the record's name and _response.csv, or free_vibration.csv, in
    /// this folder]
    #[arg(short, long, value_name = "FILE.csv")]
    output: Option<PathBuf>,
    /// Transitions as CSV: instant, kind, state before and after
    #[arg(long, value_name = "FILE.csv")]
    events: Option<PathBuf>,
    #[command(flatten)]
    format: FormatArgs,
    /// Draw ground acceleration, uplift, acceleration and base shear over time, with marks at transitions
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

    /// Refuses an interval at which the table would have no end.
    fn check_rows(&self, ground: &Record) -> anyhow::Result<()> {
        const MOST_ROWS: f64 = 1e7;
        let (samples, interval) = self.samples_and_interval(ground);
        let end = if let End::At(end) = self.motion.ground.end(ground) { end } else { ground.end() };
        let rows = samples.len() as f64 + (end - samples[samples.len() - 1]) / interval;
        ensure!(
            rows <= MOST_ROWS,
            "an interval of {} s over {} s makes {rows:.0e} rows: {MOST_ROWS:.0e} are possible; see --interval",
            short(interval),
            short(end - ground.start())
        );
        Ok(())
    }

    fn output_path(&self) -> PathBuf {
        match (&self.results.output, self.motion.ground.record.record.as_deref().and_then(Path::file_stem)) {
            (Some(path), _) => path.clone(),
            (None, Some(record)) => format!("{}_response.csv", record.to_string_lossy()).into(),
            (None, None) => "free_vibration.csv".into(),
        }
    }
}

/// Writes the response and prints its summary.
pub fn run(args: &SimulateArgs) -> anyhow::Result<()> {
    let (structure, ground) = args.motion.load()?;
    let run = args.motion.run(structure, &ground);

    args.check_rows(&ground)?;
    let output = args.output_path();
    let mut files = OutputFiles::of_inputs(args.motion.inputs());
    if args.results.output.is_none() {
        tables::refuse_other_than_response(&output)?;
    }
    args.results.format.reserve(&mut files);
    let mut response = Table::create(&mut files, &output)?;
    let events = args.results.events.as_deref();
    let mut events = events.map(|path| Table::create(&mut files, path)).transpose()?;
    let picture = args.results.picture.as_ref().map(|picture| picture.create(&mut files)).transpose()?;
    response.write(tables::response_headings(&structure, ground.title()))?;
    if let Some(events) = &mut events {
        events.write(tables::EVENTS)?;
    }
    let progress = talk::progress(ground.times().len());
    let (mut peaks, mut summary, mut written) =
        (Peaks::since(ground.start(), &structure), Summary::new(&structure), Ok(()));
    let mut transition = |transition: &Transition| {
        if let (Some(events), Ok(())) = (&mut events, &written) {
            written = events.write(tables::event_line(transition));
        }
    };
    let limits = args.limits.limits();
    let mut validity = Validity::new(&structure, limits, Found::since(ground.start()));
    let (samples, interval) = args.samples_and_interval(&ground);
    let from = samples[samples.len() - 1];
    let times = samples.iter().copied().chain((1_u64..).map(|i| from + i as f64 * interval));
    let (mut rows, mut last) = (Ok(()), None);
    let finish = run.sample(
        times,
        |sample| {
            progress.inc(1);
            let next = (sample.motion.time, tables::response_line(sample));
            // an instant that misses the end by rounding is the end
            if let Some((time, line)) = last.replace(next)
                && time < sample.motion.time - 1e-6 * interval
                && rows.is_ok()
            {
                rows = response.write(line);
            }
        },
        &mut (&mut peaks.watch(), &mut (&mut validity, &mut (&mut summary, &mut transition))),
    );
    progress.finish_and_clear();
    let finish = finish?;
    rows.and(written)?;
    last.map_or(Ok(()), |(_, line)| response.write(line))?;
    response.finish()?;
    events.map_or(Ok(()), Table::finish)?;
    let (start, end) = (instant(ground.start()), instant(finish.motion.time));
    if args.results.format.format == Format::Text {
        let mut text = format!("{}, {start} to {end} s\n{}", ground.title(), summary.text(&peaks, &finish)?);
        for line in validity::section(&structure, run.detail, validity.found(), &limits) {
            text = text + &line + "\n";
        }
        // What goes to standard output stays one table.
        if output == Path::new("-") { say!("{}", text.trim_end()) } else { print(&text)? }
    } else {
        let validity = validity::rows(validity.found(), &limits);
        summary.print(args.results.format.format, &peaks, validity, ground.title(), ground.start(), &finish)?;
    }
    if summary::shows_no_motion(&peaks) {
        say!("nothing moves: the ground is at rest and the structure stands; see --record, --theta-0, --u-0");
    }
    if output != Path::new("-") {
        say!("response       {}", output.display());
    }
    if let Some(events) = &args.results.events {
        say!("transitions    {}", events.display());
    }
    match picture {
        Some(picture) => picture::draw(picture, &run),
        None => Ok(()),
    }
}
