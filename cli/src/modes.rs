//! `modes`: a response split into rocking and vibration mode (Eqs 12, 16, 19).
mod picture;

use crate::{
    input, output_files::OutputFiles, picture::PictureFile, structure_args::StructureArgs, tables::Table, talk::say,
};
use anyhow::{Context, ensure};
use csv::{Position, StringRecord};
use rocking::estimates::modal_split::{ModalAccelerations, Modes};
use rocking::{Outputs, Parameters, Phase, Side, State};
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

/// The columns of a response that the split needs: numbers and the phase.
const NUMBERS: [&str; 6] = ["time[s]", "a_g[m/s2]", "theta[rad]", "u[m]", "theta_dot[rad/s]", "u_dot[m/s]"];
/// Columns that follow from the state and the structure: where they are there, they tell whose response it is.
const SHOWN: [&str; 4] = ["uplift[m]", "delta_t[m]", "M_t[N.m]", "R_v[N]"];
const PHASE: &str = "phase";

/// Phases that a response has.
const PHASES: [Phase; 4] = [
    Phase::FullContact,
    Phase::Rocking(Side::Left),
    Phase::Rocking(Side::Right),
    Phase::Overturned(Side::Right), // to the left it has the same name
];

/// Where the columns are.
struct Columns {
    numbers: [usize; NUMBERS.len()],
    shown: [Option<usize>; SHOWN.len()],
    phase: usize,
}

const HEADINGS: [&str; 6] = ["time[s]", "q_r[rad]", "q_u[rad]", "a_r[m/s2]", "a_u[m/s2]", "a_t[m/s2]"];

/// Writes the modes at the instants of the response at which the structure rocks.
pub fn run(args: &ModesArgs) -> anyhow::Result<()> {
    let structure = args.structure.load()?;
    ensure!(
        !structure.is_restrained(),
        "P_0, k_t, c_d, k_d: Eqs 11 and 18 split the motion of a structure that its weight alone turns back"
    );
    let named = || input::name(&args.response);
    let response = input::read(&args.response).with_context(named)?;
    let mut response = csv::Reader::from_reader(response.as_slice());
    let inputs = args.structure.input().into_iter().chain([args.response.as_path()]);
    let mut files = OutputFiles::of_inputs(inputs);
    let headings = response.headers().with_context(named)?.clone();
    let columns = Columns::find(&headings).with_context(named)?;
    let mut check = Check::default();
    let mut table = Table::create(&mut files, &args.output)?;
    let picture = args.picture.as_ref().map(|picture| picture.create(&mut files)).transpose()?;
    table.write(HEADINGS)?;
    let (mut instants, mut rocking) = (0, 0);
    let (mut stretches, mut rocks_about) = (Vec::new(), None);
    let mut before = f64::NEG_INFINITY;
    for line in response.records() {
        let line = line.with_context(named)?;
        let ([time, a_g, theta, u, theta_dot, u_dot], phase) = columns.read(&line, before).with_context(named)?;
        let shown = columns.shown(&line);
        before = time;
        instants += 1;
        let Phase::Rocking(side) = phase else {
            if phase == Phase::FullContact {
                let &Parameters { m, m0, g, .. } = structure.parameters();
                check.see(3, shown[3], (m + m0) * g);
            }
            rocks_about = None;
            continue;
        };
        rocking += 1;
        if rocks_about.replace(side) != Some(side) {
            stretches.push(Vec::new());
        }
        let state = State { u, u_dot, theta, theta_dot };
        if (u, u_dot) != (0.0, 0.0) {
            // one without deformation may be of the level `rigid`, whose moment is no strut's
            let Outputs { uplift, delta_t, M_t, .. } = Outputs::of(&structure, phase, &state, 0.0);
            [uplift, delta_t, M_t].into_iter().enumerate().for_each(|(i, expected)| check.see(i, shown[i], expected));
        }
        let modes @ Modes { q_r, q_u, .. } = Modes::of(&structure, &state);
        let accelerations = ModalAccelerations::of(&structure, side, &state, a_g);
        table.write((time, q_r, q_u, accelerations.a_r, accelerations.a_u, accelerations.a_t()))?;
        stretches.last_mut().context("it has just begun")?.push((time, modes, accelerations));
    }
    check.refuse_another_structure().with_context(named)?;
    table.finish("modes")?;
    say!("it rocks at {rocking} of {instants} instants");
    match picture {
        Some(picture) => picture::draw(picture, structure.parameters().g, &stretches, &named()),
        None => Ok(()),
    }
}

impl Columns {
    /// Refuses what is no response.
    fn find(headings: &StringRecord) -> anyhow::Result<Columns> {
        let position = |name: &str| headings.iter().position(|heading| heading == name);
        let find = |name: &str| {
            position(name).with_context(|| format!("it has no column {name}, as a response of `simulate` has"))
        };
        let mut numbers = [0; NUMBERS.len()];
        for (column, name) in numbers.iter_mut().zip(NUMBERS) {
            *column = find(name)?;
        }
        Ok(Columns { numbers, shown: SHOWN.map(position), phase: find(PHASE)? })
    }

    /// What a line has of [`SHOWN`]; not a number where it has none.
    fn shown(&self, line: &StringRecord) -> [f64; SHOWN.len()] {
        self.shown.map(|column| column.and_then(|column| line[column].parse().ok()).unwrap_or(f64::NAN))
    }

    /// The numbers and the phase of a line that comes after the time `before` (s).
    fn read(&self, line: &StringRecord, before: f64) -> anyhow::Result<([f64; NUMBERS.len()], Phase)> {
        let at = |column: usize, name: &str| {
            let number = line.position().map_or(0, Position::line);
            format!("line {number}, column {}, {name}: {:?}", column + 1, &line[column])
        };
        let mut numbers = [0.0; NUMBERS.len()];
        for ((value, &column), name) in numbers.iter_mut().zip(&self.numbers).zip(NUMBERS) {
            let number = line[column].parse().ok().filter(|value: &f64| value.is_finite());
            *value = number.with_context(|| format!("{} is not a finite number", at(column, name)))?;
        }
        ensure!(numbers[0] > before, "{} does not come after {before:?} s", at(self.numbers[0], NUMBERS[0]));
        let phase = PHASES.into_iter().find(|phase| phase.name() == &line[self.phase]);
        let known = || PHASES.map(Phase::name).join(", ");
        let phase = phase.with_context(|| format!("{} is not one of {}", at(self.phase, PHASE), known()))?;
        Ok((numbers, phase))
    }
}

/// How far a response may be from what follows from its state, in parts of the largest value: tables have few digits.
const ROUNDING: f64 = 1e-3;

/// Whether a response is that of the structure: the largest of each of [`SHOWN`] that was found, and how far the farthest is
/// from what it should be.
#[derive(Default)]
struct Check {
    largest: [f64; SHOWN.len()],
    off: [f64; SHOWN.len()],
}

impl Check {
    /// Looks at what is `found` in column `i` of [`SHOWN`], and `expected` there.
    fn see(&mut self, i: usize, found: f64, expected: f64) {
        self.largest[i] = self.largest[i].max(found.abs());
        self.off[i] = self.off[i].max((found - expected).abs());
    }

    fn refuse_another_structure(&self) -> anyhow::Result<()> {
        for ((name, off), largest) in SHOWN.iter().zip(self.off).zip(self.largest) {
            ensure!(
                off <= ROUNDING * largest,
                "{name} does not follow from the state and the structure: it is the response of another structure; see --preset, --parameters"
            );
        }
        Ok(())
    }
}
