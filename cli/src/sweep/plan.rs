//! What a sweep runs, from a TOML file: every record at every scale factor on every structure.
use super::outcome::MEASURES;
use crate::structure_args::Preset;
use anyhow::{Context, bail, ensure};
use rocking::{
    Parameters, Structure,
    parameters::{MAX_SLENDERNESS, PARAMETERS},
    quantity::Quantity,
    record::{Record, Unit},
};
use serde::Deserialize;
use std::{collections::BTreeMap, path::Path};
use uuid::Uuid;

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

/// H/B, which varies H at constant B; m, m0, J0 and f_fc stay as they are.
const SLENDERNESS: Quantity<Parameters> = Quantity {
    name: "slenderness",
    unit: "1",
    description: "height of the top mass over half-width of the base, H/B",
    min: 0.0,
    max: MAX_SLENDERNESS,
    get: |parameters| parameters.H / parameters.B,
    set: |parameters, slenderness| parameters.H = slenderness * parameters.B,
};

/// What can vary; slenderness last, so that it applies to the B of the same combination.
fn axes() -> impl Iterator<Item = &'static Quantity<Parameters>> {
    PARAMETERS.iter().chain([&SLENDERNESS])
}

/// The runs of a sweep, numbered from 0.
pub struct Plan {
    /// Names of the populations of structures.
    pub populations: Vec<String>,
    points: Vec<Point>,
    varying: Vec<&'static Quantity<Parameters>>,
    motions: Vec<Motion>,
    /// Scale factors.
    pub scales: Vec<f64>,
    /// Limits whose exceedance is counted.
    pub limits: Vec<Limit>,
}

/// One structure.
pub struct Point {
    /// Its population, as index.
    pub population: usize,
    pub structure: Structure,
    /// What varies over the sweep, in the order of [`Plan::headings`].
    values: Vec<f64>,
}

/// A record, its times scaled.
struct Motion {
    name: String,
    record: Record,
    digest: u64,
    /// Peak ground acceleration, g.
    pga: f64,
}

/// A bound that a peak may reach.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limit {
    /// Which of [`MEASURES`].
    pub measure: usize,
    pub value: f64,
}

/// One run.
pub struct Run<'a> {
    pub index: usize,
    pub population: &'a str,
    pub point: &'a Point,
    motion: &'a Motion,
    /// Position of the scale factor in [`Plan::scales`].
    pub scale_index: usize,
    pub scale: f64,
}

impl Plan {
    /// Reads the sweep in the TOML file at `path`, and its records.
    pub fn read(path: &Path) -> anyhow::Result<Plan> {
        let read = || {
            let file: SweepFile = toml::from_str(&std::fs::read_to_string(path)?)?;
            Plan::of(file, path.parent().unwrap_or(Path::new("")))
        };
        read().with_context(|| format!("sweep in {}", path.display()))
    }

    fn of(file: SweepFile, folder: &Path) -> anyhow::Result<Plan> {
        let SweepFile { records, unit, time_scale, scale, structures, limits } = file;
        ensure!(
            time_scale > 0.0 && time_scale.is_finite(),
            "time_scale = {time_scale} is out of range: a finite number greater than 0 is needed"
        );
        let scales = scale.list().context("scale")?;
        ensure!(!scales.contains(&0.0), "scale = 0 leaves no ground motion: leave it out");
        let varies = |axis: &&Quantity<_>| structures.iter().any(|grid| grid.vary.contains_key(axis.name));
        let varying: Vec<_> = axes().filter(varies).collect();
        let mut points = Vec::new();
        for (population, grid) in structures.iter().enumerate() {
            let of_grid = grid.points(population, &varying).with_context(|| format!("structures {:?}", grid.name))?;
            points.extend(of_grid);
            let is_taken = structures[..population].iter().any(|other| other.name == grid.name);
            ensure!(!is_taken, "two entries of structures have the name {:?}: rename one", grid.name);
        }
        let g = points.first().context("structures is empty: name one or more")?.structure.parameters().g;
        if let Some(other) = points.iter().map(|point| point.structure.parameters().g).find(|other| *other != g) {
            bail!("g = {other} m/s2 and g = {g} m/s2: a sweep has one g, in which its records are given");
        }
        let motions = motions(&records, folder, |path| Ok(Record::read(path, unit, g)?.scaled(time_scale, 1.0)), g)?;
        let populations = structures.into_iter().map(|grid| grid.name).collect();
        Ok(Plan { populations, points, varying, motions, scales, limits: limits_of(&limits)? })
    }

    /// How many runs there are.
    pub fn len(&self) -> usize {
        self.points.len() * self.motions.len() * self.scales.len()
    }

    /// Run `index`: scale factors change first, then records, then structures.
    pub fn run(&self, index: usize) -> Run<'_> {
        let (rest, scale_index) = (index / self.scales.len(), index % self.scales.len());
        let (point, motion) = (&self.points[rest / self.motions.len()], &self.motions[rest % self.motions.len()]);
        let population = &self.populations[point.population];
        Run { index, population, point, motion, scale_index, scale: self.scales[scale_index] }
    }

    /// Every run.
    pub fn runs(&self) -> impl Iterator<Item = Run<'_>> {
        (0..self.len()).map(|index| self.run(index))
    }

    /// Identifies the inputs of all runs, in their order.
    pub fn digest(&self) -> u64 {
        digest(&self.runs().map(|run| run.digest()).collect::<Vec<_>>())
    }

    /// Headings of what varies from structure to structure.
    pub fn headings(&self) -> impl Iterator<Item = String> {
        self.varying.iter().map(|axis| heading(axis.name, axis.unit))
    }

    /// Its size, for people.
    pub fn describe(&self) -> String {
        let [structures, records, scales] = [self.points.len(), self.motions.len(), self.scales.len()];
        format!("structures: {structures}, records: {records}, scale factors: {scales}")
    }
}

impl Run<'_> {
    /// The ground motion.
    pub fn ground(&self) -> Record {
        self.motion.record.clone().scaled(1.0, self.scale)
    }

    /// Peak ground acceleration, g.
    pub fn pga(&self) -> f64 {
        self.motion.pga * self.scale.abs()
    }

    /// The record's file name.
    pub fn record(&self) -> &str {
        &self.motion.name
    }

    /// What varies from structure to structure.
    pub fn values(&self) -> &[f64] {
        &self.point.values
    }

    /// Identifies the run by its names and by all that it depends on: every parameter, every sample, the scale factor.
    pub fn digest(&self) -> u64 {
        let names = (self.population, self.record());
        digest(&(names, self.point.structure.parameters(), self.motion.digest, self.scale))
    }

    /// Which run it is, for people.
    pub fn describe(&self) -> String {
        let Run { index, population, scale, .. } = self;
        format!("run {index} ({population} with {:?}, {}, scale {scale})", self.values(), self.record())
    }
}

impl Values {
    fn list(&self) -> anyhow::Result<Vec<f64>> {
        let values = match self {
            Values::List(values) => values.clone(),
            &Values::Even { from, to, count } => {
                ensure!(count >= 2, "count = {count} is out of range: 2 or more are needed from {from} to {to}");
                let last = (count - 1) as f64;
                (0..count).map(|i| (from * (last - i as f64) + to * i as f64) / last).collect()
            }
        };
        ensure!(!values.is_empty(), "the list is empty: give one or more numbers");
        match values.iter().find(|value| !value.is_finite()) {
            Some(value) => bail!("{value} is not a finite number"),
            None => Ok(values),
        }
    }
}

impl StructureGrid {
    /// Every combination of what varies.
    fn points(&self, population: usize, varying: &[&Quantity<Parameters>]) -> anyhow::Result<Vec<Point>> {
        let base = match (&self.preset, &self.parameters) {
            (Some(preset), None) => preset.parameters(),
            (None, Some(parameters)) => *parameters,
            _ => bail!("give either preset or parameters"),
        };
        let has = |name| self.vary.contains_key(name);
        ensure!(!(has("H") && has("slenderness")), "H and slenderness cannot both vary: slenderness sets H");
        if let Some(unknown) = self.vary.keys().find(|name| axes().all(|axis| axis.name != name.as_str())) {
            let known: Vec<_> = axes().map(|axis| axis.name).collect();
            bail!("{unknown:?} cannot vary: these can: {}", known.join(", "));
        }
        let mut combinations = vec![(base, Vec::new())];
        for axis in varying {
            let given = self.vary.get(axis.name).map(Values::list).transpose().context(axis.name)?;
            let with = |&(parameters, ref values): &(Parameters, Vec<f64>), given: Option<f64>| {
                let (mut parameters, mut values) = (parameters, values.clone());
                given.inspect(|value| (axis.set)(&mut parameters, *value));
                values.push(given.unwrap_or_else(|| (axis.get)(&parameters)));
                (parameters, values)
            };
            combinations = match given {
                None => combinations.iter().map(|so_far| with(so_far, None)).collect(),
                Some(given) => combinations
                    .iter()
                    .flat_map(|so_far| given.iter().map(|value| with(so_far, Some(*value))))
                    .collect(),
            };
        }
        let point = |(parameters, values)| Ok(Point { population, structure: Structure::new(parameters)?, values });
        combinations.into_iter().map(point).collect()
    }
}

/// The records that `patterns` name.
fn motions(
    patterns: &[String],
    folder: &Path,
    read: impl Fn(&Path) -> anyhow::Result<Record>,
    g: f64,
) -> anyhow::Result<Vec<Motion>> {
    let mut motions = Vec::new();
    for pattern in patterns {
        let in_folder = Path::new(&glob::Pattern::escape(&folder.to_string_lossy())).join(pattern);
        let before = motions.len();
        for path in glob::glob(&in_folder.to_string_lossy()).with_context(|| format!("records {pattern:?}"))? {
            let path = path?;
            let record = read(&path)?;
            let pga = record.pga() / g;
            ensure!(pga > 0.0, "{}: the ground acceleration is 0 throughout", path.display());
            let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
            motions.push(Motion { name, digest: digest(&(record.times(), record.acceleration())), record, pga });
        }
        ensure!(motions.len() > before, "records: there is no file {}", folder.join(pattern).display());
    }
    ensure!(!motions.is_empty(), "records is empty: name one or more");
    Ok(motions)
}

fn limits_of(limits: &BTreeMap<String, Vec<f64>>) -> anyhow::Result<Vec<Limit>> {
    let mut found = Vec::new();
    for (name, values) in limits {
        let measure = MEASURES.iter().position(|(measure, _)| measure == name).with_context(|| {
            format!("limits: {name:?} is unknown; these are known: {}", MEASURES.map(|(name, _)| name).join(", "))
        })?;
        for &value in values {
            ensure!(value > 0.0, "limits: {name} = {value} is out of range: a number greater than 0 is needed");
            found.push(Limit { measure, value });
        }
    }
    Ok(found)
}

/// A name with its unit, unless it is a ratio.
pub fn heading(name: &str, unit: &str) -> String {
    if unit == "1" { name.into() } else { format!("{name}[{unit}]") }
}

fn digest(of: &impl serde::Serialize) -> u64 {
    let bytes = postcard::to_allocvec(of).expect("numbers and slices can be serialized");
    Uuid::new_v5(&Uuid::NAMESPACE_OID, &bytes).as_u64_pair().0
}
