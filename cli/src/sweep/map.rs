//! A sweep of pulses: an overturning spectrum of every structure.
mod picture;
mod rows;

use super::{SweepArgs, file::MapSweep, progress};
use crate::{
    picture::Picture,
    talk::{say, warning},
};
use anyhow::{bail, ensure};
use picture::Shown;
use rayon::{ThreadPool, prelude::*};
use rocking::Structure;
use rocking::digits::short;
use rocking::run::{LONGEST_REST, validity};
use rocking_sweep::map::{CLASSES, Class, Fate, Map, Place, Point};
use rocking_sweep::row_file::{Known, RowFile};
use serde::Serialize;
use std::{collections::HashMap, fmt::Write, path::Path};
use uuid::Uuid;

/// A map, and what is known of it.
pub struct Spectrum {
    /// Name of the structure.
    pub name: String,
    /// The map.
    pub map: Map,
    /// Every point that has been run.
    pub points: HashMap<Place, Point>,
}

/// How many points of a map's grid are of a class.
#[derive(Serialize)]
struct Count<'a> {
    structure: &'a str,
    class: &'static str,
    points: usize,
    part: f64,
}

/// Does the runs that are not in the file at `output` yet, then prints and draws the maps.
pub fn run(
    args: &SweepArgs,
    sweep: MapSweep,
    pool: &ThreadPool,
    output: &Path,
    picture: Picture,
) -> anyhow::Result<()> {
    ensure!(!args.validity, "--validity is for records: `simulate` a pulse that `pulse` writes");
    let (file, mut known) = rows::open(output)?;
    for (name, map) in &sweep.maps {
        let structure = Structure::from(map.structure);
        let warnings = structure.doubts().into_iter().chain(validity::of_structure(&structure, map.detail));
        warnings.for_each(|warning| warning!("{name}: {warning}"));
    }
    let mut spectra = Vec::new();
    for (name, map) in sweep.maps {
        let mut spectrum = Spectrum { name, map, points: HashMap::new() };
        for level in 0..=sweep.refinements {
            loop {
                let Spectrum { map, points, .. } = &spectrum;
                let lacking = match level {
                    0 if points.is_empty() => map.grid().collect(),
                    0 => Vec::new(),
                    level => map.refinement(level, points),
                };
                if lacking.is_empty() {
                    break;
                }
                pool.install(|| do_points(&mut spectrum, level, lacking, &mut known, &file))?;
            }
        }
        spectra.push(spectrum);
    }
    known.others(output, "points that are not in these maps").iter().for_each(|line| say!("{line}"));
    let counts: Vec<_> = spectra.iter().flat_map(count).collect();
    args.results.print(|| text(&spectra, &counts), &counts)?;
    say!("rows           {}", output.display());
    picture::draw(picture, &spectra, sweep.refinements)?;
    report_failures(&spectra)
}

/// Finds `places` of a map among the points that are `known`, or runs the structure there and adds the row.
fn do_points(
    spectrum: &mut Spectrum,
    level: u32,
    places: Vec<Place>,
    known: &mut Known<Point>,
    file: &RowFile,
) -> anyhow::Result<()> {
    let Spectrum { name, map, points } = spectrum;
    let keys: Vec<_> = places.par_iter().map(|place| rows::key_at(name, map, *place)).collect();
    let mut lacking = Vec::new();
    for (place, key) in places.into_iter().zip(keys) {
        match known.take(&key) {
            Some(point) => drop(points.insert(place, point)),
            None => lacking.push((place, key)),
        }
    }
    let run = |lacking: &[(Place, Uuid)], done: &mut dyn FnMut(_) -> bool| {
        let places: Vec<_> = lacking.iter().map(|(place, _)| *place).collect();
        map.run_each(&places, |at, point| {
            let (place, key) = &lacking[at];
            done(rows::row(key, name, map, (level, *place), &point).map(|row| (row, (*place, point))))
        });
    };
    let (bar, goes_on) = progress(lacking.len(), "points")?;
    points.extend(file.do_runs(&lacking, run, goes_on)?);
    bar.finish_and_clear();
    Ok(())
}

/// How many points of the grid there are of each class that there are any of.
fn count(spectrum: &Spectrum) -> Vec<Count<'_>> {
    let Spectrum { name, map, points } = spectrum;
    let total = map.grid().count();
    let of = |(class, what): (Class, &'static str)| {
        let count = map.grid().filter(|place| points[place].class() == class).count();
        (count > 0).then_some(Count { structure: name, class: what, points: count, part: count as f64 / total as f64 })
    };
    CLASSES.into_iter().filter_map(of).collect()
}

/// The counts for people, with what the maps are of.
fn text(spectra: &[Spectrum], counts: &[Count]) -> anyhow::Result<String> {
    let mut out = String::new();
    for Spectrum { name, map, points } in spectra {
        let [frequency, amplitude] = Shown::axes(map).map(|axis| {
            let range = axis.range();
            format!("{} from {} to {}", axis.steps() + 1, short(range.start), short(range.end))
        });
        let [x, y] = picture::axis_names(map);
        let refined = points.len() - map.grid().count();
        writeln!(out, "{name}: {}; {}", map.pulse_name(), map.detail.name())?;
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

/// Says how many points failed, and why the first did.
fn report_failures(spectra: &[Spectrum]) -> anyhow::Result<()> {
    let failed = || spectra.iter().flat_map(|of| of.points.iter()).filter(|(_, point)| point.fate == Fate::Failed);
    match failed().min_by_key(|(place, _)| **place) {
        Some((_, first)) => bail!("{} point(s) failed; one of them: {}", failed().count(), first.reason),
        None => Ok(()),
    }
}
