//! The scene that a command simulates: a ground motion record or free vibration, and the initial values.
use crate::record_args::{RecordArgs, one_of};
use crate::structure_args::StructureArgs;
use clap::ArgGroup;
use rocking::digits::short;
use rocking::run::record::Record;
use rocking::{Detail, State, engine::DEFAULT_TOLERANCE};
use rocking_report::run::Run;
use rocking_sweep::plan::Conditions;
use std::path::Path;
use std::sync::Arc;

/// A motion to follow: of which structure, under which ground motion, from where, and how it is computed.
#[derive(clap::Args)]
pub struct MotionArgs {
    #[command(flatten)]
    pub structure: StructureArgs,
    #[command(flatten)]
    pub ground: GroundArgs,
    #[command(flatten)]
    initial: InitialArgs,
    #[command(flatten)]
    level: LevelArgs,
}

/// The run of a structure under a ground motion. Conditions that no run of the structure can have are an error before the record is
/// read.
pub fn load(structure: &StructureArgs, ground: &GroundArgs, conditions: Conditions) -> anyhow::Result<Run> {
    let structure = structure.load_any()?;
    conditions.check(&structure)?;
    let ground = Arc::new(ground.load(structure.base().g)?);
    Ok(Run { structure, ground, conditions })
}

impl MotionArgs {
    /// The run.
    pub fn load(&self) -> anyhow::Result<Run> {
        let LevelArgs { tolerance, detail } = self.level;
        let (initial, duration) = (self.initial.state(), self.ground.duration());
        load(&self.structure, &self.ground, Conditions { initial, detail, tolerance, duration })
    }

    /// The files that are read.
    pub fn inputs(&self) -> impl Iterator<Item = &Path> {
        self.structure.input().into_iter().chain(self.ground.record.inputs())
    }
}

/// The ground motion, and how long it is followed.
#[derive(clap::Args)]
#[command(next_help_heading = "Ground motion")]
#[command(group(ArgGroup::new("ground motion").args(["record", "free"]).required(true)))]
pub struct GroundArgs {
    #[command(flatten)]
    pub record: RecordArgs,
    /// Simulated time; the ground is at rest after the record's end [default: until the base is down for good or the structure overturns, at the latest 100/p_l after the record]
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true)]
    duration: Option<f64>,
    /// Free vibration over this time instead of a record
    #[arg(
        long,
        value_name = "SECONDS",
        allow_hyphen_values = true,
        conflicts_with_all = ["record_v", "unit", "dt", "column", "ignore_npts", "time_scale", "scale", "duration"]
    )]
    pub free: Option<f64>,
}

/// The state at the start.
#[derive(clap::Args, Default, serde::Deserialize)]
#[serde(deny_unknown_fields, default)]
#[command(next_help_heading = "Initial values")]
pub struct InitialArgs {
    /// Initial rotation of the base; 0 is full contact
    #[arg(long, value_name = "RAD", default_value_t = 0.0, allow_hyphen_values = true)]
    theta_0: f64,
    /// Initial angular velocity of the base
    #[arg(long, value_name = "RAD/S", default_value_t = 0.0, allow_hyphen_values = true)]
    theta_dot_0: f64,
    /// Initial elastic displacement of the top mass
    #[arg(long, value_name = "M", default_value_t = 0.0, allow_hyphen_values = true)]
    u_0: f64,
    /// Initial elastic velocity of the top mass
    #[arg(long, value_name = "M/S", default_value_t = 0.0, allow_hyphen_values = true)]
    u_dot_0: f64,
}

/// How the motion is computed.
#[derive(clap::Args)]
#[command(next_help_heading = "Equations")]
struct LevelArgs {
    /// Level of detail: the equations that move the structure
    #[arg(long, value_name = "LEVEL", default_value = Detail::default().name(), value_parser = one_of(Detail::ALL.map(|of| (of.name(), of))))]
    detail: Detail,
    /// Relative tolerance
    #[arg(long, default_value = format!("{DEFAULT_TOLERANCE:e}"))]
    tolerance: f64,
}

impl GroundArgs {
    /// The ground motion; a record's g means `g` (m/s²).
    pub fn load(&self, g: f64) -> anyhow::Result<Record> {
        let record = self.record.load(g)?;
        Ok(record.unwrap_or_else(|| Record::at_rest(self.free.expect("clap asks for --record or --free"))))
    }

    /// From the start to the end of the run, s, where that is asked for.
    pub fn duration(&self) -> Option<f64> {
        self.duration.or(self.free)
    }

    /// The ground motion in a line.
    pub fn title(&self, ground: &Record) -> String {
        match self.free {
            Some(duration) => format!("none, free vibration over {} s", short(duration)),
            None => format!("{}, {} samples", ground.title(), ground.times().len()),
        }
    }
}

impl InitialArgs {
    /// The initial state.
    pub fn state(&self) -> State {
        let &InitialArgs { theta_0: theta, theta_dot_0: theta_dot, u_0: u, u_dot_0: u_dot } = self;
        State { u, u_dot, theta, theta_dot }
    }
}
