//! `modes`: a response split into rocking and vibration mode (Eqs 12, 16, 19).
mod picture;

use crate::{
    output_files::OutputFiles,
    picture::PictureFile,
    structure_args::{StructureArgs, in_one_line},
    tables::{self, Table},
    talk::say,
};
use anyhow::{Context, bail};
use csv::StringRecord;
use rocking::{
    Side, State, Structure,
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
    /// Draw both modes over time
    #[arg(long, value_name = "FILE.svg|png")]
    picture: Option<PictureFile>,
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
    let mut files = OutputFiles::of_inputs(inputs);
    check(response.headers().with_context(named)?, &structure).with_context(named)?;
    let mut table = Table::create(&mut files, &args.output, &HEADINGS)?;
    let picture = args.picture.as_ref().map(|picture| picture.create(&mut files)).transpose()?;
    let (mut instants, mut rocking) = (0, 0);
    let (mut stretches, mut rocks_about) = (Vec::new(), None);
    for instant in response.deserialize() {
        let Instant { time, a_g, theta, u, theta_dot, u_dot, phase } = instant.with_context(named)?;
        instants += 1;
        let side = match phase.as_str() {
            "rocking left" => Side::Left,
            "rocking right" => Side::Right,
            _ => {
                rocks_about = None;
                continue;
            }
        };
        rocking += 1;
        if rocks_about.replace(side) != Some(side) {
            stretches.push(Vec::new());
        }
        let state = State { u, u_dot, theta, theta_dot };
        let modes @ Modes { q_r, q_u, .. } = Modes::of(&structure, &state);
        let accelerations = ModalAccelerations::of(&structure, side, &state, a_g);
        table.write((time, q_r, q_u, accelerations.a_r, accelerations.a_u, accelerations.a_t()))?;
        stretches.last_mut().context("it has just begun")?.push((time, modes, accelerations));
    }
    table.finish()?;
    say!(
        "modes          {}: {rocking} of {instants} instants, those at which the structure rocks",
        args.output.display()
    );
    if rocking == 0 {
        say!("it rocks at none of them: there is nothing to split");
    }
    match picture {
        Some(picture) => picture::draw(picture, structure.parameters().g, &stretches, &named()),
        None => Ok(()),
    }
}

/// Refuses what is no response, and the response of another structure, which its last heading names; a table that names
/// none is taken.
fn check(headings: &StringRecord, structure: &Structure) -> anyhow::Result<()> {
    let needed = ["time[s]", "a_g[m/s2]", "theta[rad]", "u[m]", "theta_dot[rad/s]", "u_dot[m/s]", "phase"];
    if let Some(missing) = needed.into_iter().find(|needed| headings.iter().all(|heading| heading != *needed)) {
        bail!("it has no column {missing}, as a response of `simulate` has");
    }
    let Some(of) = headings.iter().find_map(|heading| heading.strip_prefix(tables::STRUCTURE)) else { return Ok(()) };
    let here = in_one_line(structure);
    let other = of.split("; ").zip(here.split(", ")).find(|(there, here)| there != here);
    if let Some((there, here)) = other {
        bail!("it is the response of another structure: {there} there, and {here} here; see --preset, --parameters");
    }
    Ok(())
}
