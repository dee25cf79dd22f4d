//! What a sweep runs, from a TOML file: every record at every scale factor on every structure.
use crate::{output_files::OutputFiles, structure_args::Preset, talk::say};
use anyhow::{Context, bail, ensure};
use rocking::{
    Parameters,
    record::{Record, Unit},
    run::outcome::Limit,
    run::plan::{MAX_RUNS, NamedRecord, Plan, Population},
};
use serde::Deserialize;
use std::{collections::BTreeMap, collections::HashSet, path::Path};

/// The file.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SweepFile {
    /// Paths or patterns such as `records/*.AT2`, from the folder of the file.
    records: Vec<String>,
    /// Unit of .csv and .txt records.
    #[serde(default = "si", with = "UnitName")]
    unit: Unit,
    /// Multiplies the records' times.
    #[serde(default = "one")]
    time_scale: f64,
    /// Multiply the records' accelerations.
    scale: Values,
    structures: Vec<StructureGrid>,
    /// By the name of a measure.
    #[serde(default)]
    limits: BTreeMap<String, Vec<f64>>,
}

#[derive(Deserialize)]
#[serde(remote = "Unit")]
enum UnitName {
    #[serde(rename = "g")]
    G,
    #[serde(rename = "m/s2")]
    MetrePerSecondSquared,
}

fn si() -> Unit {
    Unit::MetrePerSecondSquared
}

fn one() -> f64 {
    1.0
}

/// Structures that count as one population: each has its own fragility curve.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct StructureGrid {
    name: String,
    preset: Option<Preset>,
    parameters: Option<Parameters>,
    /// By the name of a parameter, or `slenderness`; every combination is run.
    #[serde(default)]
    vary: BTreeMap<String, Values>,
}

#[derive(Deserialize)]
#[serde(untagged, expecting = "expected a list of numbers, or { from = ..., to = ..., count = ... }")]
enum Values {
    List(Vec<f64>),
    Even { from: f64, to: f64, count: usize },
}

/// Reads the sweep in the TOML file at `path`, and its records: what to run, and the limits whose exceedance is counted
/// beside overturning. Every record is an input of `files`.
pub fn read(path: &Path, files: &mut OutputFiles) -> anyhow::Result<(Plan, Vec<Limit>)> {
    let mut read = || {
        let SweepFile { records, unit, time_scale, scale, structures, limits } =
            toml::from_str(&std::fs::read_to_string(path)?)?;
        ensure!(
            time_scale > 0.0 && time_scale.is_finite(),
            "time_scale = {time_scale} is out of range: a finite number greater than 0 is needed"
        );
        let scales = scale.list().context("scale")?;
        let limits = limits.iter().flat_map(|(name, values)| values.iter().map(|value| Limit::peak(name, *value)));
        let limits = limits.collect::<Result<_, _>>().context("limits")?;
        let g = gravity(&structures)?;
        let populations = structures.iter().map(StructureGrid::population).collect::<Result<_, _>>()?;
        let read = |path: &Path| {
            files.add_input(path);
            Ok(Record::read(path, unit, g)?.scaled(time_scale, 1.0))
        };
        let motions = motions(&records, path.parent().unwrap_or(Path::new("")), read)?;
        Ok((Plan::new(populations, motions, scales)?, limits))
    };
    read().with_context(|| format!("sweep in {}", path.display()))
}

/// The one acceleration of gravity of all structures, m/s²: that in which the records are given.
fn gravity(structures: &[StructureGrid]) -> anyhow::Result<f64> {
    let mut found = None;
    for grid in structures {
        ensure!(!grid.vary.contains_key("g"), "structures {:?}: g cannot vary: a sweep has one g", grid.name);
        let g = grid.base()?.g;
        let first = *found.get_or_insert(g);
        ensure!(g == first, "g = {g} m/s2 and g = {first} m/s2: a sweep has one g, in which its records are given");
    }
    found.context("structures is empty: name one or more")
}

impl Values {
    fn list(&self) -> anyhow::Result<Vec<f64>> {
        match *self {
            Values::List(ref values) => Ok(values.clone()),
            Values::Even { from, to, count } => {
                ensure!(
                    (2..=MAX_RUNS).contains(&count),
                    "count = {count} is out of range: 2 to {MAX_RUNS} values are possible from {from} to {to}"
                );
                let last = (count - 1) as f64;
                Ok((0..count).map(|i| (from * (last - i as f64) + to * i as f64) / last).collect())
            }
        }
    }
}

impl StructureGrid {
    fn base(&self) -> anyhow::Result<Parameters> {
        match (&self.preset, &self.parameters) {
            (Some(preset), None) => Ok(preset.parameters()),
            (None, Some(parameters)) => Ok(*parameters),
            _ => bail!("structures {:?}: give either preset or parameters", self.name),
        }
    }

    fn population(&self) -> anyhow::Result<Population> {
        let vary = |population: Population, (name, values): (&String, &Values)| -> anyhow::Result<_> {
            Ok(population.vary(name, values.list().context(name.clone())?)?)
        };
        let population = Population::new(is_one_line(&self.name)?, self.base()?);
        self.vary.iter().try_fold(population, vary).with_context(|| format!("structures {:?}", self.name))
    }
}

/// The records that `patterns` name, each of them once.
fn motions(
    patterns: &[String],
    folder: &Path,
    mut read: impl FnMut(&Path) -> anyhow::Result<Record>,
) -> anyhow::Result<Vec<NamedRecord>> {
    let (mut motions, mut files) = (Vec::new(), HashSet::new());
    for pattern in patterns {
        let in_folder = Path::new(&glob::Pattern::escape(&folder.to_string_lossy())).join(pattern);
        let mut paths = glob::glob(&in_folder.to_string_lossy()).with_context(|| format!("records {pattern:?}"))?;
        let mut paths = paths.by_ref().peekable();
        ensure!(paths.peek().is_some(), "records: there is no file {}", folder.join(pattern).display());
        for path in paths {
            let path = path?;
            if !files.insert(path.canonicalize()?) {
                say!("{} is named twice in records: it counts once", path.display());
                continue;
            }
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let motion = NamedRecord::new(is_one_line(&name)?, read(&path)?);
            motions.push(motion.with_context(|| path.display().to_string())?);
        }
    }
    Ok(motions)
}

/// A name that is written into rows.
fn is_one_line(name: &str) -> anyhow::Result<&str> {
    ensure!(!name.contains(char::is_control), "the name {name:?} must be a line of text, for it is written into rows");
    Ok(name)
}
