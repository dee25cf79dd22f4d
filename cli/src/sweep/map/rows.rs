//! The rows of maps: what a point is, and what became of the structure there.
//!
//! A point's key stands for the structure and its name, the pulse, the level of detail, the tolerance, whether its condition is found, and
//! the build of the program: not for its place, so that another grid through the same point has it.
use crate::cause::{heading, version};
use crate::sweep::{
    row_file::{FIRST_HEADINGS, Row, RowFile, fixed, key, key_of, records},
    say_other_rows,
};
use anyhow::{Context, bail};
use rocking_sweep::map::{Map, Place, Point};
use rocking_sweep::plan::AXES;
use rocking_sweep::pulse::units_of;
use std::{collections::HashMap, path::Path};
use uuid::Uuid;

/// Columns before what became of the structure: the key, the name and the program's version; the structure; the pulse; detail and tolerance;
/// refinement, frequency and amplitude, alone and in units of the structure.
const BEFORE: usize = FIRST_HEADINGS.len() + 1 + AXES.len() + 4 + 2 + 5;
/// Columns of that, with the reason.
const OF_POINT: usize = 7;

/// The rows of a file that have not been asked for.
pub struct Rows {
    points: HashMap<Uuid, Point>,
    repeated: usize,
}

impl Rows {
    /// Opens the file at `path`, or begins it, and reads its rows.
    pub fn open(path: &Path) -> anyhow::Result<(RowFile, Rows)> {
        RowFile::open(path, &headings(), read)
    }

    /// The point that has `key`, if there is a row of it.
    pub fn take(&mut self, key: &Uuid) -> Option<Point> {
        self.points.remove(key)
    }

    /// Says how many rows nobody has asked for, and how many are there again.
    pub fn say_others(&self, path: &Path) {
        let others = "of points that are not in these maps (other inputs, or another build of the program): kept";
        say_other_rows(path, (self.points.len(), others), self.repeated);
    }
}

/// The key of a point of the map of the structure called `name`.
pub fn key_at(name: &str, map: &Map, place: Place) -> Uuid {
    let of_map = (map.detail(), map.tolerance(), map.finds_condition());
    key(&(name, map.structure().parameters(), map.pulse(place), of_map.0, of_map.1, of_map.2))
}

fn headings() -> Vec<String> {
    [
        fixed(&FIRST_HEADINGS),
        fixed(&["version"]),
        AXES.map(|axis| heading(axis.name, axis.unit)).into(),
        fixed(&["shape", "cycles", "phase[rad]", "error", "detail", "tolerance"]),
        fixed(&["refinement", "frequency[Hz]", "amplitude[m/s2]", "omega/p_l", "a_p/(g tan alpha_cg)"]),
        fixed(&["fate", "impacts", "theta_max/alpha_cg", "transitions", "end[s]", "condition", "reason", "checksum"]),
    ]
    .concat()
}

/// The row of a point, which the refinement of this level has asked for; 0 is the grid.
pub fn row(key: &Uuid, name: &str, map: &Map, (level, place): (u32, Place), point: &Point) -> anyhow::Result<Row> {
    let pulse = map.pulse(place);
    let (of_amplitude, of_frequency) = units_of(map.structure());
    let of_structure = AXES.map(|axis| (axis.get)(map.structure().parameters()));
    let of_map = (pulse.shape.name(), pulse.cycles, pulse.phase, pulse.error, map.detail().name(), map.tolerance());
    let ratios = (pulse.frequency / of_frequency, pulse.amplitude / of_amplitude);
    let of_program = (key.to_string(), name, version());
    Row::new(&(of_program, of_structure, of_map, level, pulse.frequency, pulse.amplitude, ratios, point))
}

fn read(rows: &[u8]) -> anyhow::Result<Rows> {
    let mut found = Rows { points: HashMap::new(), repeated: 0 };
    for (line, row) in records(rows) {
        let row = row?;
        let parse = || -> anyhow::Result<(Uuid, Point)> {
            let point: csv::StringRecord = row.iter().skip(BEFORE).take(OF_POINT).collect();
            Ok((key_of(&row)?, point.deserialize(None)?))
        };
        let (key, point) = parse().with_context(|| format!("line {line} cannot be read"))?;
        match found.points.get(&key) {
            None => drop(found.points.insert(key, point)),
            Some(known) if *known == point => found.repeated += 1,
            Some(_) => bail!("line {line} contradicts another row of run {key}: remove one of them"),
        }
    }
    Ok(found)
}
