//! `simulate`: the response to a ground motion record, or free vibration, with the same engine as the FMU's.
use crate::{
    record_args::{RecordArgs, positive},
    significant::significant,
    structure_args::StructureArgs,
    summary::Summary,
    tables::{self, Table},
};
use clap::ArgGroup;
use indicatif::ProgressBar;
use rocking::{Engine, Outputs, Phase, State, Transition, engine::DEFAULT_TOLERANCE, record::Record};
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
#[command(next_help_heading = "Ground motion")]
#[command(group(ArgGroup::new("ground motion").args(["record", "free"]).required(true)))]
struct GroundArgs {
    #[command(flatten)]
    record: RecordArgs,
    /// Simulated time; the ground is at rest after the record's end [default: to the record's end]
    #[arg(long, value_name = "SECONDS", value_parser = positive)]
    duration: Option<f64>,
    /// Free vibration over this time instead of a record
    #[arg(
        long,
        value_name = "SECONDS",
        value_parser = positive,
        conflicts_with_all = ["unit", "time_scale", "scale", "duration"]
    )]
    free: Option<f64>,
}

#[derive(clap::Args)]
#[command(next_help_heading = "Initial values")]
struct InitialArgs {
    /// Rotation of the base; 0 is full contact
    #[arg(long, value_name = "RAD", default_value_t = 0.0, allow_negative_numbers = true)]
    theta_0: f64,
    /// Angular velocity of the base
    #[arg(long, value_name = "RAD/S", default_value_t = 0.0, allow_negative_numbers = true)]
    theta_dot_0: f64,
    /// Elastic displacement of the top mass
    #[arg(long, value_name = "M", default_value_t = 0.0, allow_negative_numbers = true)]
    u_0: f64,
    /// Elastic velocity of the top mass
    #[arg(long, value_name = "M/S", default_value_t = 0.0, allow_negative_numbers = true)]
    u_dot_0: f64,
}

#[derive(clap::Args)]
#[command(next_help_heading = "Results")]
struct ResultArgs {
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

fn tolerance(text: &str) -> Result<f64, String> {
    positive(text).and_then(|tolerance| match tolerance {
        ..1.0 => Ok(tolerance),
        _ => Err("a number less than 1 is needed, such as 1e-9".into()),
    })
}

impl GroundArgs {
    /// The ground motion; `g` (m/s²) is what a record's g stands for.
    fn load(&self, g: f64) -> anyhow::Result<Record> {
        let record = self.record.load(g)?;
        Ok(record.unwrap_or_else(|| Record::at_rest(self.free.expect("clap asks for --record or --free"))))
    }
}

impl SimulateArgs {
    fn initial_state(&self) -> State {
        let &InitialArgs { theta_0: theta, theta_dot_0: theta_dot, u_0: u, u_dot_0: u_dot } = &self.initial;
        State { u, u_dot, theta, theta_dot }
    }

    /// The instants of the output (s): the start, every interval from there, and `end`.
    fn output_times(&self, ground: &Record, end: f64) -> impl Iterator<Item = f64> {
        const FREE_VIBRATION_INTERVAL: f64 = 1e-3;
        let samples = ground.times();
        let last = samples.len() - 1;
        let (samples, interval) = match self.results.dt.or(self.ground.free.map(|_| FREE_VIBRATION_INTERVAL)) {
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
        let outputs = Outputs::of(engine.structure(), motion.phase, &motion.state);
        self.summary.see_outputs(motion.time, &outputs);
        self.response.write(tables::response_line(motion, a_g, outputs))
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
    let (start, record_end) = (ground.times()[0], ground.times()[ground.times().len() - 1]);
    let end = args.ground.duration.map_or(record_end, |duration| start + duration);
    let mut engine = Engine::new(structure, args.initial_state(), start, args.results.tolerance)?;

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
