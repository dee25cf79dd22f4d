//! `modes`: a response split into rocking and vibration mode (Eqs 12, 16, 19).
mod picture;

use crate::{output_files::OutputFiles, picture::PictureFile, structure_args::StructureArgs, tables::Table, talk::say};
use anyhow::{Context, ensure};
use csv::{Position, StringRecord};
use rocking::estimates::modal_split::{ModalAccelerations, Modes};
use rocking::{Outputs, Parameters, Phase, Side, State, Structure};
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

/// The columns of a response that the split needs: numbers, and the phase.
const NUMBERS: [&str; 6] = ["time[s]", "a_g[m/s2]", "theta[rad]", "u[m]", "theta_dot[rad/s]", "u_dot[m/s]"];
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
    phase: usize,
}

const HEADINGS: [&str; 6] = ["time[s]", "q_r[rad]", "q_u[rad]", "a_r[m/s2]", "a_u[m/s2]", "a_t[m/s2]"];

/// Writes the modes at the instants of the response at which the structure rocks.
pub fn run(args: &ModesArgs) -> anyhow::Result<()> {
    let structure = args.structure.load()?;
    let named = || args.response.display().to_string();
    let mut response = csv::Reader::from_path(&args.response).with_context(named)?;
    let inputs = args.structure.input().into_iter().chain([args.response.as_path()]);
    let mut files = OutputFiles::of_inputs(inputs);
    let headings = response.headers().with_context(named)?.clone();
    let columns = Columns::find(&headings).with_context(named)?;
    let mut check = Check::new(&headings, &structure);
    let mut table = Table::create(&mut files, &args.output)?;
    let picture = args.picture.as_ref().map(|picture| picture.create(&mut files)).transpose()?;
    table.write(HEADINGS)?;
    let (mut instants, mut rocking) = (0, 0);
    let (mut stretches, mut rocks_about) = (Vec::new(), None);
    let mut before = f64::NEG_INFINITY;
    for line in response.records() {
        let line = line.with_context(named)?;
        let ([time, a_g, theta, u, theta_dot, u_dot], phase) = columns.read(&line, before).with_context(named)?;
        before = time;
        instants += 1;
        let Phase::Rocking(side) = phase else {
            check.see_standing(&line, phase);
            rocks_about = None;
            continue;
        };
        rocking += 1;
        if rocks_about.replace(side) != Some(side) {
            stretches.push(Vec::new());
        }
        let state = State { u, u_dot, theta, theta_dot };
        check.see(&line, &Outputs::of(&structure, phase, &state, 0.0));
        let modes @ Modes { q_r, q_u, .. } = Modes::of(&structure, &state);
        let accelerations = ModalAccelerations::of(&structure, side, &state, a_g);
        table.write((time, q_r, q_u, accelerations.a_r, accelerations.a_u, accelerations.a_t()))?;
        stretches.last_mut().context("it has just begun")?.push((time, modes, accelerations));
    }
    check.refuse_another_structure().with_context(named)?;
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

impl Columns {
    /// Refuses what is no response.
    fn find(headings: &StringRecord) -> anyhow::Result<Columns> {
        let find = |name: &str| {
            let found = headings.iter().position(|heading| heading == name);
            found.with_context(|| format!("it has no column {name}, as a response of `simulate` has"))
        };
        let mut numbers = [0; NUMBERS.len()];
        for (column, name) in numbers.iter_mut().zip(NUMBERS) {
            *column = find(name)?;
        }
        Ok(Columns { numbers, phase: find(PHASE)? })
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

type Of = fn(&Outputs) -> f64;

/// A column of a response that follows from its state and the structure.
struct Shown {
    name: &'static str,
    column: usize,
    /// The largest value found.
    largest: f64,
    /// How far the farthest is from what it should be.
    off: f64,
}

impl Shown {
    fn find(headings: &StringRecord, name: &'static str) -> Option<Shown> {
        let column = headings.iter().position(|heading| heading == name)?;
        Some(Shown { name, column, largest: 0.0, off: 0.0 })
    }

    fn see(&mut self, line: &StringRecord, expected: f64) {
        if let Ok(found) = line[self.column].parse::<f64>() {
            self.largest = self.largest.max(found.abs());
            self.off = self.off.max((found - expected).abs());
        }
    }
}

/// Whether a response is that of the structure. Of the reactions R_v is the weight in full contact; while it rocks they
/// depend on the accelerations, and these on the level of detail, which a response does not tell. R_m in full contact
/// follows from what the other columns show.
struct Check {
    rocking: Vec<(Of, Shown)>,
    R_v: Option<Shown>,
    /// N.
    weight: f64,
}

impl Check {
    fn new(headings: &StringRecord, structure: &Structure) -> Check {
        let columns: [(_, Of); 5] = [
            ("uplift[m]", |outputs| outputs.uplift),
            ("delta_t[m]", |outputs| outputs.delta_t),
            ("a_t[m/s2]", |outputs| outputs.a_t),
            ("V_t[N]", |outputs| outputs.V_t),
            ("M_t[N.m]", |outputs| outputs.M_t),
        ];
        let find = |(name, of)| Some((of, Shown::find(headings, name)?));
        let &Parameters { m, m0, g, .. } = structure.parameters();
        Check {
            rocking: columns.into_iter().filter_map(find).collect(),
            R_v: Shown::find(headings, "R_v[N]"),
            weight: (m + m0) * g,
        }
    }

    /// Looks at a `line` of a `phase` in which it does not rock.
    fn see_standing(&mut self, line: &StringRecord, phase: Phase) {
        if let (Phase::FullContact, Some(R_v)) = (phase, &mut self.R_v) {
            R_v.see(line, self.weight);
        }
    }

    /// Looks at a `line` whose state has these `outputs`. One without deformation may be of the level `rigid`, whose a_t is no
    /// strut's.
    fn see(&mut self, line: &StringRecord, outputs: &Outputs) {
        if (outputs.u, outputs.u_dot) == (0.0, 0.0) {
            return;
        }
        self.rocking.iter_mut().for_each(|(of, shown)| shown.see(line, of(outputs)));
    }

    fn refuse_another_structure(&self) -> anyhow::Result<()> {
        const ROUNDING: f64 = 1e-3; // of tables in few digits
        for Shown { name, largest, off, .. } in self.rocking.iter().map(|(_, shown)| shown).chain(&self.R_v) {
            ensure!(
                *off <= ROUNDING * largest,
                "{name} does not follow from the state and the structure: it is the response of another structure; see --preset, --parameters"
            );
        }
        Ok(())
    }
}
