//! The rows of maps: each point, and the fate of the structure there.
//!
//! The key of a point stands for the structure and its name, the pulse, the level of detail and the tolerance. The key
//! also stands for the build of the program, and for whether the condition is found. The place in the grid is no part of
//! the key, so another grid through the same point has the same key.
use csv::StringRecord;
use rocking_report::program::{program, version};
use rocking_sweep::map::{Map, Place, Point};
use rocking_sweep::plan::AXES;
use rocking_sweep::pulse::units_of;
use rocking_sweep::row_file::{Known, RowFile, fixed, heading, line};
use std::path::Path;
use uuid::Uuid;

/// Opens the file at `path`, or begins it, and reads the points of its rows.
pub fn open(path: &Path) -> anyhow::Result<(RowFile, Known<Point>)> {
    let headings = headings();
    let fate = headings.iter().position(|heading| heading == "fate").expect("it is one of them");
    RowFile::open(path, &headings, |row| Ok(row.iter().skip(fate).collect::<StringRecord>().deserialize(None)?))
}

/// The key of a point of the map of the structure called `name`.
pub fn key_at(name: &str, map: &Map, place: Place) -> Uuid {
    let of_map = (map.detail, map.tolerance, map.finds_condition);
    program().key(&(name, map.structure.parameters(), map.pulse(place), of_map.0, of_map.1, of_map.2))
}

fn headings() -> Vec<String> {
    [
        fixed(&["run", "structures", "version"]),
        AXES.map(|axis| heading(axis.name, axis.unit)).into(),
        fixed(&["shape", "cycles", "phase[rad]", "error", "detail", "tolerance"]),
        fixed(&["refinement", "frequency[Hz]", "amplitude[m/s2]", "omega/p_l", "a_p/(g tan alpha_cg)"]),
        fixed(&["fate", "impacts", "theta_max/alpha_cg", "transitions", "end[s]", "condition", "reason"]),
    ]
    .concat()
}

/// The row of a point, which the refinement of this level has asked for; 0 is the grid.
pub fn row(key: &Uuid, name: &str, map: &Map, (level, place): (u32, Place), point: &Point) -> anyhow::Result<Vec<u8>> {
    let pulse = map.pulse(place);
    let (of_amplitude, of_frequency) = units_of(map.structure.base());
    let of_structure = AXES.map(|axis| (axis.get)(map.structure.parameters()));
    let of_map = (pulse.shape.name(), pulse.cycles, pulse.phase, pulse.error, map.detail.name(), map.tolerance);
    let ratios = (pulse.frequency / of_frequency, pulse.amplitude / of_amplitude);
    let of_program = (key.to_string(), name, version());
    line(&(of_program, of_structure, of_map, level, pulse.frequency, pulse.amplitude, ratios, point))
}
