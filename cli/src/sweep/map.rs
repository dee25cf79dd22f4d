//! A sweep of pulses: an overturning spectrum of every structure.
//!
//! The key of a point stands for the structure and its name, the pulse, the level of detail and the tolerance. The key
//! also stands for the build of the program, and for whether the condition is found. The place in the grid is no part of
//! the key, so another grid through the same point has the same key.
mod picture;

use super::file::MapSweep;
use crate::picture::Picture;
use crate::results::FormatArgs;
use crate::talk::{progress, say, warning};
use FlexibleRocking::BUILD;
use anyhow::bail;
use csv::StringRecord;
use picture::PulseSpectrum;
use rayon::{ThreadPool, prelude::*};
use rocking::digits::short;
use rocking::run::{LONGEST_REST, validity};
use rocking_sweep::map::{CLASSES, Class, Fate, GridPlace, HEADINGS, Map, MapPoint};
use rocking_sweep::outcome::Measure;
use rocking_sweep::plan::{AXES, numbers_of, values_of};
use rocking_sweep::row_file::{self, Digest, Known, Program, RowFile, fixed};
use rocking_sweep::rows::of_numbers;
use serde::Serialize;
use std::{collections::HashMap, fmt::Write, path::Path, sync::Mutex};
use uuid::Uuid;

/// How many points of a map's grid are of a class.
#[derive(Serialize)]
struct Count<'a> {
    structure: &'a str,
    class: String,
    points: usize,
    part: f64,
}

/// Does the runs that are not in the file at `output` yet, then prints and draws the maps.
pub fn run(
    (maps, refinements): MapSweep,
    results: FormatArgs,
    pool: &ThreadPool,
    output: &Path,
    picture: Picture,
) -> anyhow::Result<()> {
    let numbers = numbers_of(maps.iter().map(|(_, map)| &map.structure));
    let (file, mut known) = open(output, &numbers)?;
    for (name, map) in &maps {
        let structure = &map.structure;
        let warnings = structure.doubts().into_iter().chain(validity::of_structure(structure, map.detail));
        warnings.for_each(|warning| warning!("{name}: {warning}"));
    }
    let mut spectra = Vec::new();
    for (name, map) in maps {
        let mut points = HashMap::new();
        map.complete(refinements, &mut points, |level, lacking, points| {
            pool.install(|| do_points((&name, &map, points), level, lacking, &mut known, (&file, &numbers)))
        })?;
        spectra.push(PulseSpectrum { name, map, points });
    }
    row_file::others(known.len(), output, "points that are not in these maps").iter().for_each(|line| say!("{line}"));
    let counts: Vec<_> = spectra.iter().flat_map(count).collect();
    results.print(|| text(&spectra, &counts), &counts)?;
    say!("rows           {}", output.display());
    picture::draw(picture, &spectra, refinements)?;
    report_failures(&spectra)
}

/// Finds `places` of a map among the points that are `known`, or runs the structure there and adds the row.
fn do_points(
    (name, map, points): (&str, &Map, &mut HashMap<GridPlace, MapPoint>),
    level: u32,
    places: Vec<GridPlace>,
    known: &mut Known<MapPoint>,
    (file, numbers): (&RowFile, &[Measure]),
) -> anyhow::Result<()> {
    let keys: Vec<_> = places.par_iter().map(|place| key_at(name, map, *place)).collect();
    let mut lacking = Vec::new();
    for (place, key) in places.into_iter().zip(keys) {
        match known.remove(&key) {
            Some(point) => drop(points.insert(place, point)),
            None => lacking.push((place, key)),
        }
    }
    let run = |lacking: &[(GridPlace, Uuid)], done: &mut dyn FnMut(_, &[u8]) -> bool| {
        let places: Vec<_> = lacking.iter().map(|(place, _)| *place).collect();
        map.run_each(&places, |at, point| {
            let row = row((&lacking[at].1, name, numbers), map, (level, places[at]), &point);
            done((places[at], point), &row)
        });
    };
    let (bar, points) = (progress(lacking.len(), "points")?, Mutex::new(points));
    row_file::do_runs(&lacking, Some(file), run, |(place, point)| {
        points.lock().expect("no thread panics with the points in hand").insert(place, point);
        bar.inc(1);
        Ok(())
    })?;
    bar.finish_and_clear();
    Ok(())
}

/// Opens the file at `path`, or begins it, and reads the points of its rows.
fn open(path: &Path, numbers: &[Measure]) -> anyhow::Result<(RowFile, Known<MapPoint>)> {
    let headings = headings(numbers);
    let fate = headings.iter().position(|heading| heading == "fate").expect("it is one of them");
    RowFile::open(path, &headings, |row| Ok(row.iter().skip(fate).collect::<StringRecord>().deserialize(None)?))
}

fn key_at(name: &str, map: &Map, place: GridPlace) -> Uuid {
    let of_map = (map.detail, map.tolerance, map.finds_condition);
    Digest::new(&Program::of(BUILD).build).and(&(name, map.structure.numbers(), map.pulse(place), of_map)).uuid()
}

fn headings(numbers: &[Measure]) -> Vec<String> {
    [
        fixed(&["run", "structures", "version"]),
        of_numbers(numbers),
        fixed(&["shape", "cycles", "phase[rad]", "error", "detail", "tolerance"]),
        fixed(&HEADINGS),
    ]
    .concat()
}

/// The row of a point, which the refinement of this level has asked for; 0 is the grid.
fn row(
    (key, name, numbers): (&Uuid, &str, &[Measure]),
    map: &Map,
    (level, place): (u32, GridPlace),
    point: &MapPoint,
) -> Vec<u8> {
    let pulse = map.pulse(place);
    let of_axes = AXES.map(|axis| (axis.get)(&map.structure.parameters()));
    let of_structure = (of_axes, values_of(&map.structure, numbers));
    let of_map = (pulse.shape.name(), pulse.cycles, pulse.phase, pulse.error, map.detail.name(), map.tolerance);
    let of_program = (key.to_string(), name, Program::of(BUILD).version);
    row_file::line(&(of_program, of_structure, of_map, map.row(level, place, point)))
}

/// How many points of the grid there are of each class that there are any of.
fn count(spectrum: &PulseSpectrum) -> Vec<Count<'_>> {
    let PulseSpectrum { name, map, points } = spectrum;
    let total = map.grid().count();
    let of = |(class, what): (Class, &'static str)| {
        let points = map.grid().filter(|place| points[place].class() == class).count();
        let (class, part) = (map.named(what), points as f64 / total as f64);
        (points > 0).then_some(Count { structure: name, class, points, part })
    };
    CLASSES.into_iter().filter_map(of).collect()
}

/// The counts for people, with what the maps are of.
fn text(spectra: &[PulseSpectrum], counts: &[Count]) -> anyhow::Result<String> {
    let mut out = String::new();
    for PulseSpectrum { name, map, points } in spectra {
        let [frequency, amplitude] = picture::shown(map).map(|axis| {
            let range = picture::range(&axis);
            format!("{} from {} to {}", axis.values.len(), short(range.start), short(range.end))
        });
        let [x, y] = picture::axis_names(map);
        let refined = points.len() - map.grid().count();
        writeln!(out, "{name}: {}; {}", map.pulse.name(), map.detail.name())?;
        writeln!(out, "  {x}: {frequency}\n  {y}: {amplitude}")?;
        for Count { class, points, part, .. } in counts.iter().filter(|count| count.structure == name) {
            writeln!(out, "  {class:<28} {points:>9} {:>7.3} %", 100.0 * part)?;
        }
        if refined > 0 {
            writeln!(out, "  {:<28} {refined:>9}", "more along the boundaries")?;
        }
        if map.finds_condition {
            let changes = points.values().filter(|point| point.condition == Some(f64::INFINITY)).count();
            writeln!(out, "  {:<28} {changes:>9}", "change class under 1e-12")?;
        }
        if points.values().any(|point| point.fate == Fate::StillRocking) {
            writeln!(out, "  still rocking: {LONGEST_REST}/p_l after the pulse it is not decided")?;
        }
        writeln!(out)?;
    }
    Ok(out)
}

fn report_failures(spectra: &[PulseSpectrum]) -> anyhow::Result<()> {
    let failed = || spectra.iter().flat_map(|of| of.points.iter()).filter(|(_, point)| point.fate == Fate::Failed);
    match failed().min_by_key(|(place, _)| **place) {
        Some((_, first)) => bail!("{} point(s) failed; one of them: {}", failed().count(), first.reason),
        None => Ok(()),
    }
}
