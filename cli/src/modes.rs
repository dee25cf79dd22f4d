//! `modes`: a response split into rocking and vibration mode (Eqs 12, 16, 19).
use crate::{output_files::OutputFiles, structure_args::StructureArgs, tables::Table};
use anyhow::Context;
use rocking::{
    Side, State,
    modal_split::{ModalAccelerations, Modes},
};
use serde::Deserialize;
use std::path::PathBuf;

/// What to split.
#[derive(clap::Args)]
pub struct ModesArgs {
    #[command(flatten)]
    structure: StructureArgs,
    /// Response as CSV with the headings that `simulate` writes
    #[arg(long, value_name = "FILE.csv")]
    response: PathBuf,
    /// Modes as CSV, `-` for standard output
    #[arg(short, long, value_name = "FILE.csv", default_value = "modes.csv")]
    output: PathBuf,
}

/// The columns of a response that the split needs.
#[derive(Deserialize)]
struct Instant {
    #[serde(rename = "time[s]")]
    time: f64,
    #[serde(rename = "a_g[m/s2]")]
    a_g: f64,
    #[serde(rename = "theta[rad]")]
    theta: f64,
    #[serde(rename = "u[m]")]
    u: f64,
    #[serde(rename = "theta_dot[rad/s]")]
    theta_dot: f64,
    #[serde(rename = "u_dot[m/s]")]
    u_dot: f64,
    phase: String,
}

const HEADINGS: [&str; 6] = ["time[s]", "q_r[rad]", "q_u[rad]", "a_r[m/s2]", "a_u[m/s2]", "a_t[m/s2]"];

/// Writes the modes at the instants of the response at which the structure rocks.
pub fn run(args: &ModesArgs) -> anyhow::Result<()> {
    let structure = args.structure.load()?;
    let named = || args.response.display().to_string();
    let mut response = csv::Reader::from_path(&args.response).with_context(named)?;
    let inputs = args.structure.input().into_iter().chain([args.response.as_path()]);
    let mut table = Table::create(&mut OutputFiles::of_inputs(inputs), &args.output, &HEADINGS)?;
    for instant in response.deserialize() {
        let Instant { time, a_g, theta, u, theta_dot, u_dot, phase } = instant.with_context(named)?;
        let side = match phase.as_str() {
            "rocking left" => Side::Left,
            "rocking right" => Side::Right,
            _ => continue,
        };
        let state = State { u, u_dot, theta, theta_dot };
        let Modes { q_r, q_u, .. } = Modes::of(&structure, &state);
        let accelerations = ModalAccelerations::of(&structure, side, &state, a_g);
        table.write((time, q_r, q_u, accelerations.a_r, accelerations.a_u, accelerations.a_t()))?;
    }
    table.finish()
}
