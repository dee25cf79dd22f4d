//! `simulate`: the response to a ground motion record, or free vibration, with the same engine as the FMU's.
use crate::{
    record_args::positive,
    scene_args::{GroundArgs, InitialArgs},
    significant::significant,
    structure_args::StructureArgs,
    summary::Summary,
    tables::{self, Table},
};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use indicatif::ProgressBar;
use rocking::{Detail, Engine, Load, Phase, Transition, engine::DEFAULT_TOLERANCE, record::Record};
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
    /// The instants of the output (s): the start, every interval from there, and `end`.
    fn output_times(&self, ground: &Record, end: f64) -> impl Iterator<Item = f64> {
        let samples = ground.times();
        let last = samples.len() - 1;
        let (samples, interval) = match self.results.dt.or(self.ground.free_vibration_interval()) {
            Some(dt) => (&samples[..1], dt),
            None => (samples, samples[last] - samples[last - 1]),
        };
        let from = samples[samples.len() - 1];
        let rounding = 1e-6 * interval;
        samples
            .iter()
            .copied()
            .chain((1_u64..).map(move |i| from + i as f64 * interval))
            .take_while(move |time| *time < end - rounding)
            .chain([end])
    }

    fn output_path(&self) -> PathBuf {
        match (&self.results.output, self.ground.record.record.as_deref().and_then(Path::file_stem)) {
            (Some(path), _) => path.clone(),
            (None, Some(record)) => format!("{}_response.csv", record.to_string_lossy()).into(),
            (None, None) => "free_vibration.csv".into(),
        }
    }
}

/// Where a run's results go.
struct Recorder {
    response: Table,
    events: Option<Table>,
    summary: Summary,
}

impl Recorder {
    fn output(&mut self, engine: &Engine, a_g: f64) -> anyhow::Result<()> {
        let motion = engine.motion();
        let outputs = engine.outputs(0.0);
        self.summary.see_outputs(motion.time, &outputs);
        self.response.write(tables::response_line(motion, a_g, outputs, engine.reactions(Load::ground(a_g))))
    }

    fn transition(&mut self, transition: &Transition) -> anyhow::Result<()> {
        self.summary.see_transition(transition);
        self.events.as_mut().map_or(Ok(()), |events| events.write(tables::event_line(transition)))
    }
}

/// Writes the response and prints its summary.
pub fn run(args: &SimulateArgs) -> anyhow::Result<()> {
    let structure = args.structure.load()?;
    let g = structure.parameters().g;
    let ground = args.ground.load(g)?;
    let (start, end) = args.ground.span(&ground);
    let ResultArgs { tolerance, detail, .. } = args.results;
    let mut engine = Engine::with_detail(structure, args.initial.state(), start, tolerance, detail)?;

    let output = args.output_path();
    let mut recorder = Recorder {
        response: Table::create(&output, &tables::RESPONSE)?,
        events: args.results.events.as_deref().map(|path| Table::create(path, &tables::EVENTS)).transpose()?,
        summary: Summary::new(g),
    };
    follow(&mut engine, &ground, args.output_times(&ground, end), end, &mut recorder)?;
    let Recorder { response, events, summary } = recorder;
    response.finish()?;
    events.map_or(Ok(()), Table::finish)?;
    eprintln!("{}, {} to {} s", ground.title(), significant(start), significant(end));
    summary.print(engine.motion());
    if output != Path::new("-") {
        eprintln!("response       {}", output.display());
    }
    Ok(())
}

/// Follows the ground motion up to `end` (s), or to overturning.
fn follow(
    engine: &mut Engine,
    ground: &Record,
    output_times: impl Iterator<Item = f64>,
    end: f64,
    recorder: &mut Recorder,
) -> anyhow::Result<()> {
    let progress = ProgressBar::new(100);
    let start = engine.motion().time;
    let mut output_times = output_times.peekable();
    let mut transitions = Vec::new();
    'run: for segment in ground.segments_until(end) {
        recorder.summary.see_ground(&segment);
        loop {
            let now = engine.motion().time;
            progress.set_position((100.0 * (now - start) / (end - start)) as u64);
            let a_g = segment.from(now);
            let is_overturned = matches!(engine.motion().phase, Phase::Overturned(_));
            if output_times.next_if_eq(&now).is_some() || is_overturned {
                recorder.output(engine, a_g.value)?;
            }
            if is_overturned {
                break 'run;
            }
            if now == segment.end {
                break;
            }
            let until = output_times.peek().map_or(segment.end, |next| next.min(segment.end));
            engine.advance(until, a_g, &mut |transition| transitions.push(*transition))?;
            for transition in transitions.drain(..) {
                recorder.transition(&transition)?;
            }
        }
    }
    progress.finish_and_clear();
    Ok(())
}
