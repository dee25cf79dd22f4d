//! `simulate`: the response to a ground motion record, or free vibration, with the same engine as the FMU's.
use crate::{
    output_files::OutputFiles,
    record_args::positive,
    scene_args::{GroundArgs, InitialArgs},
    structure_args::StructureArgs,
    summary::Summary,
    tables::{self, Table},
    talk::{self, say},
};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use fmu_export::significant::significant;
use rocking::{
    Detail, Transition,
    engine::DEFAULT_TOLERANCE,
    record::Record,
    run::{End, Run, peaks::Peaks},
};
use std::path::{Path, PathBuf};

/// What to simulate.
#[derive(clap::Args)]
pub struct SimulateArgs {
    #[command(flatten)]
    structure: StructureArgs,
    #[command(flatten)]
    ground: GroundArgs,
    #[command(flatten)]
    initial: InitialArgs,
    #[command(flatten)]
    results: ResultArgs,
}

#[derive(clap::Args)]
#[command(next_help_heading = "Results")]
struct ResultArgs {
    /// Level of detail: the equations that move the structure
    #[arg(long, value_name = "LEVEL", default_value = Detail::default().name(), value_parser = detail_parser())]
    detail: Detail,
    /// Relative tolerance
    #[arg(long, default_value = format!("{DEFAULT_TOLERANCE:e}"), value_parser = tolerance)]
    tolerance: f64,
    /// Output interval [default: the record's samples; 0.001 in free vibration]
    #[arg(long, value_name = "SECONDS", value_parser = positive)]
    dt: Option<f64>,
    /// Response as CSV, `-` for standard output [default: the record's name and _response.csv, in this folder]
    #[arg(short, long, value_name = "FILE.csv")]
    output: Option<PathBuf>,
    /// Transitions as CSV: instant, kind, state before and after
    #[arg(long, value_name = "FILE.csv")]
    events: Option<PathBuf>,
}

fn detail_parser() -> impl TypedValueParser<Value = Detail> {
    PossibleValuesParser::new(Detail::ALL.map(Detail::name)).map(|name| {
        let is_named = |detail: &Detail| detail.name() == name;
        Detail::ALL.into_iter().find(is_named).expect("clap accepts these names alone")
    })
}

fn tolerance(text: &str) -> Result<f64, String> {
    positive(text).and_then(|tolerance| match tolerance {
        ..1.0 => Ok(tolerance),
        _ => Err("a number less than 1 is needed, such as 1e-9".into()),
    })
}

impl SimulateArgs {
    /// The instants of the output (s), the end left out: the samples and as often after them, or every interval.
    fn output_times(&self, ground: &Record, end: End) -> impl Iterator<Item = f64> {
        let samples = ground.times();
        let last = samples.len() - 1;
        let (samples, interval) = match self.results.dt.or(self.ground.free_vibration_interval()) {
            Some(dt) => (&samples[..1], dt),
            None => (samples, samples[last] - samples[last - 1]),
        };
        let from = samples[samples.len() - 1];
        // an instant that misses the end by rounding is the end
        let before = if let End::At(end) = end { end - 1e-6 * interval } else { f64::INFINITY };
        samples
            .iter()
            .copied()
            .chain((1_u64..).map(move |i| from + i as f64 * interval))
            .take_while(move |time| *time < before)
    }

    fn output_path(&self) -> PathBuf {
        match (&self.results.output, self.ground.record.record.as_deref().and_then(Path::file_stem)) {
            (Some(path), _) => path.clone(),
            (None, Some(record)) => format!("{}_response.csv", record.to_string_lossy()).into(),
            (None, None) => "free_vibration.csv".into(),
        }
    }
}

/// Writes the response and prints its summary.
pub fn run(args: &SimulateArgs) -> anyhow::Result<()> {
    let structure = args.structure.load()?;
    let ground = args.ground.load(structure.parameters().g)?;
    let ResultArgs { tolerance, detail, .. } = args.results;
    let (initial, end) = (args.initial.state(), args.ground.end(&ground));
    let run = Run { initial, detail, tolerance, end, ..Run::new(structure, &ground) };

    let output = args.output_path();
    let inputs = args.structure.input().into_iter().chain(args.ground.record.record.as_deref());
    let mut files = OutputFiles::of_inputs(inputs);
    let mut response = Table::create(&mut files, &output, &tables::RESPONSE)?;
    let events = args.results.events.as_deref();
    let mut events = events.map(|path| Table::create(&mut files, path, &tables::EVENTS)).transpose()?;
    let progress = talk::progress(ground.times().len());
    let (mut peaks, mut summary, mut written) =
        (Peaks::since(ground.start(), &structure), Summary::new(&structure), Ok(()));
    let mut transition = |transition: &Transition| {
        if let (Some(events), Ok(())) = (&mut events, &written) {
            written = events.write(tables::event_line(transition));
        }
    };
    let mut rows = Ok(());
    let finish = run.sample(
        args.output_times(&ground, end),
        |sample| {
            progress.inc(1);
            if rows.is_ok() {
                rows = response.write(tables::response_line(sample));
            }
        },
        &mut (&mut peaks.watch(), &mut (&mut summary, &mut transition)),
    );
    progress.finish_and_clear();
    let finish = finish?;
    rows.and(written)?;
    response.finish()?;
    events.map_or(Ok(()), Table::finish)?;
    say!("{}, {} to {} s", ground.title(), significant(ground.start()), significant(finish.motion.time));
    summary.print(&peaks, &finish);
    if output != Path::new("-") {
        say!("response       {}", output.display());
    }
    Ok(())
}
