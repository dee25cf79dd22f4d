//! `pushover`: lateral force and moment against displacement (Fig 1).

use crate::{
    cause::Cause,
    output_files::OutputFiles,
    quantities::in_readable_unit,
    results::{FormatArgs, Traced},
    significant::significant,
    structure_args::StructureArgs,
    tables::csv,
};
pub use rocking::estimates::pushover::curve;
use rocking::estimates::pushover::{Equilibrium, PushoverError, at_overturning, at_rotation, in_full_contact};
use rocking::mechanics::restraint::{Dissipators, uplift_displacement};
use rocking::{Phase, Side, Structure};
use serde::Serialize;
use std::path::PathBuf;

/// What to push over.
#[derive(clap::Args)]
pub struct PushoverArgs {
    #[command(flatten)]
    structure: StructureArgs,
    /// Points on each of the two branches, full contact and rocking
    #[arg(long, value_name = "N", default_value_t = 100)]
    points: u32,
    /// Curve as CSV, `-` for standard output
    #[arg(short, long, value_name = "FILE.csv")]
    output: Option<PathBuf>,
    #[command(flatten)]
    results: FormatArgs,
}

const HEADINGS: [&str; 6] = ["phase", "theta[rad]", "u[m]", "delta_t[m]", "P[N]", "M[N.m]"];

/// Writes the curve from 0 to overturning, to the right, and prints its corners.
pub fn run(args: &PushoverArgs) -> anyhow::Result<()> {
    args.results.check_beside(args.output.as_deref())?;
    let structure = args.structure.load()?;
    let create = |path: &PathBuf| OutputFiles::of_inputs(args.structure.input()).create(path);
    let file = args.output.as_ref().map(create).transpose()?;
    let curve = curve(&structure, args.points)?;
    if let Some(file) = file {
        file.write_as("curve", &csv(HEADINGS, curve.iter().map(line))?)?;
    }
    let corners = [
        ("uplift", in_full_contact(&structure, u_cr(&structure))),
        ("start of rocking", at_rotation(&structure, 0.0).ok_or(PushoverError::TooSoft)?),
        ("overturning", at_overturning(&structure).ok_or(PushoverError::TooSoft)?),
    ];
    let corner = |(name, corner)| {
        let Equilibrium { theta, delta_t, force: P, moment: M, .. } = corner;
        Corner { name, delta_t, theta, P, M }
    };
    let rows = corners.map(corner);
    let text = || Ok(rows.iter().map(Corner::line).collect());
    let traced = Traced { cause: &Cause::new(&structure), rows: &rows };
    args.results.print_beside(args.output.as_deref(), text, &traced)
}

/// The displacement (m) at which the base lifts off, with what a tendon adds.
fn u_cr(structure: &Structure) -> f64 {
    uplift_displacement(structure, Side::Right, 0.0, &Dissipators::default())
}

/// A corner of the curve, in SI units.
#[derive(Serialize)]
struct Corner {
    name: &'static str,
    delta_t: f64,
    theta: f64,
    P: f64,
    M: f64,
}

impl Corner {
    fn line(&self) -> String {
        let &Corner { name, delta_t, theta, P, M } = self;
        let ([theta, delta_t], [force, moment]) = (
            [theta, 1e3 * delta_t].map(significant),
            [(P, "N"), (M, "N.m")].map(|(of, unit)| in_readable_unit(of, unit, significant)),
        );
        format!("{name:<16} delta_t {delta_t:>8} mm, theta {theta:>8} rad, P {force:>10}, M {moment:>12}\n")
    }
}

fn line(at: &Equilibrium) -> impl Serialize + use<> {
    let &Equilibrium { phase, theta, u, delta_t, force, moment } = at;
    let phase = if phase == Phase::FullContact { "full contact" } else { "rocking right" };
    (phase, theta, u, delta_t, force, moment)
}
