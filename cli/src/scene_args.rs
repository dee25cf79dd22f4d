//! The scene that a command simulates: a ground motion record or free vibration, and the initial values.
use crate::options::one_of;
use crate::record_args::{RecordArgs, with_force};
use crate::structure_args::StructureArgs;
use clap::ArgGroup;
use rocking::digits::short;
use rocking::run::record::Record;
use rocking::{Detail, State, engine::DEFAULT_TOLERANCE};
use rocking_report::{record::Understood, run::RunSetup};
use rocking_sweep::plan::Conditions;
use serde::{Deserialize, Deserializer, Serialize};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A motion to follow: of which structure, under which ground motion, from where.
#[derive(clap::Args)]
pub struct MotionArgs {
    #[command(flatten)]
    pub structure: StructureArgs,
    #[command(flatten)]
    pub ground: GroundArgs,
    #[command(flatten)]
    initial: InitialArgs,
}

impl MotionArgs {
    /// The run, with equations and tolerance as in `how`. Conditions that no run of the structure can have are an error before the record
    /// is read.
    pub fn load(&self, how: Conditions) -> anyhow::Result<RunSetup> {
        let structure = self.structure.load_any()?;
        let conditions = Conditions { initial: self.initial.state(), duration: self.ground.duration, ..how };
        conditions.check(&structure)?;
        let ground = Arc::new(self.ground.load(structure.base().g)?);
        Ok(RunSetup { structure, ground, conditions })
    }

    pub fn inputs(&self) -> impl Iterator<Item = &Path> {
        self.structure.input().into_iter().chain(self.ground.record.inputs()).chain(self.ground.force.as_deref())
    }
}

#[derive(clap::Args)]
#[command(next_help_heading = "Ground motion")]
#[command(group(ArgGroup::new("ground motion").args(["record", "duration"]).multiple(true).required(true)))]
pub struct GroundArgs {
    #[command(flatten)]
    pub record: RecordArgs,
    /// Simulated time: free vibration without a record; the ground is at rest after the record's end [default: until the base is down for good or the structure overturns, at the latest 100/p_l after the record]
    #[arg(long, value_name = "SECONDS", allow_hyphen_values = true)]
    pub duration: Option<f64>,
    /// Table of a horizontal force on the top floor, with the columns time[s] and F_t[N]. The force is positive to the right and linear between rows; --scale and --time-scale do not change it
    #[arg(long, value_name = "FILE.csv")]
    pub force: Option<PathBuf>,
}

#[derive(clap::Args, Default, Deserialize)]
#[serde(deny_unknown_fields, default)]
#[command(next_help_heading = "Initial values")]
pub struct InitialArgs {
    /// Initial rotation of the base; 0 is full contact
    #[arg(long, value_name = "RAD", default_value_t = 0.0, allow_hyphen_values = true)]
    theta_0: f64,
    /// Initial angular velocity of the base
    #[arg(long, value_name = "RAD/S", default_value_t = 0.0, allow_hyphen_values = true)]
    theta_dot_0: f64,
    /// Initial elastic displacement of the top mass, or of each floor from below, with commas between them
    #[arg(long, value_name = "M", default_value = "0", value_parser = of_floors, allow_hyphen_values = true)]
    #[serde(deserialize_with = "one_or_more")]
    u_0: std::vec::Vec<f64>, // by its full name, a type that clap gives no meaning of its own
    /// Initial elastic velocity of the top mass, or of each floor like --u-0
    #[arg(long, value_name = "M/S", default_value = "0", value_parser = of_floors, allow_hyphen_values = true)]
    #[serde(deserialize_with = "one_or_more")]
    u_dot_0: std::vec::Vec<f64>,
}

fn of_floors(numbers: &str) -> Result<Vec<f64>, String> {
    let number = |(at, text): (usize, &str)| text.trim().parse().map_err(|error| format!("number {}: {error}", at + 1));
    numbers.split(',').enumerate().map(number).collect()
}

/// A number, or one for each floor.
#[derive(Serialize, Deserialize)]
#[serde(untagged, expecting = "expected a number, or a list of one for each floor")]
pub enum OneOrMore {
    One(f64),
    More(Vec<f64>),
}

fn one_or_more<'de, D: Deserializer<'de>>(of: D) -> Result<Vec<f64>, D::Error> {
    Ok(match OneOrMore::deserialize(of)? {
        OneOrMore::One(number) => vec![number],
        OneOrMore::More(numbers) => numbers,
    })
}

#[derive(clap::Args)]
#[command(next_help_heading = "Equations")]
pub struct LevelArgs {
    /// Level of detail: the equations that move the structure
    #[arg(long, value_name = "LEVEL", default_value = Detail::default().name(), value_parser = one_of(Detail::ALL.map(|of| (of.name(), of))))]
    detail: Detail,
    /// Relative tolerance
    #[arg(long, default_value = format!("{DEFAULT_TOLERANCE:e}"))]
    tolerance: f64,
}

impl LevelArgs {
    /// Level of detail and tolerance among usual conditions.
    pub fn conditions(&self) -> Conditions {
        let &LevelArgs { detail, tolerance } = self;
        Conditions { detail, tolerance, ..Conditions::default() }
    }
}

impl GroundArgs {
    /// The ground motion; a record's g means `g` (m/s²).
    pub fn load(&self, g: f64) -> anyhow::Result<Record> {
        let rest = || Record::at_rest(self.free().expect("clap asks for --record or --duration"));
        let understood = self.record.load(g)?.map_or_else(|| Understood::made(rest(), [1.0; 2], g), Ok)?;
        with_force(understood, self.force.as_deref(), g)
    }

    /// Duration of the free vibration, s, if there is no record.
    pub fn free(&self) -> Option<f64> {
        self.duration.filter(|_| self.record.record.is_none())
    }

    pub fn title(&self, ground: &Record) -> String {
        match self.free() {
            Some(duration) => format!("none, free vibration over {} s", short(duration)),
            None => format!("{}, {} samples", ground.title(), ground.times().len()),
        }
    }
}

impl InitialArgs {
    pub fn state(&self) -> State<Vec<f64>> {
        let InitialArgs { theta_0, theta_dot_0, u_0, u_dot_0 } = self;
        State { u: u_0.clone(), u_dot: u_dot_0.clone(), theta: *theta_0, theta_dot: *theta_dot_0 }
    }
}
