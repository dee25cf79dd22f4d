//! The TOML file of a sweep: every record at every scale factor on every structure, or pulses of every frequency
//! and amplitude.
use crate::record_args::{RecordOptions, with_force};
use crate::scene_args::InitialArgs;
use crate::talk::{few, warning};
use anyhow::{Context, anyhow, bail, ensure};
use rocking::estimates::intensity::IntensityMeasure;
use rocking::run::record::Record;
use rocking::structure::natural_quantities::Numbers;
use rocking::{Detail, Parameters, Structure, engine::DEFAULT_TOLERANCE};
use rocking_records::{Column, Unit};
use rocking_report::{input, output_files::OutputFiles, structure_file};
use rocking_sweep::design::{Design, Goal};
use rocking_sweep::map::{Axis, MAX_REFINEMENTS, Map};
use rocking_sweep::outcome::{Limit, Measure};
use rocking_sweep::plan::{Conditions, MAX_RUNS, NamedRecord, Plan, Population, measure};
use rocking_sweep::pulse::{Pulse, Shape};
use serde::Deserialize;
use std::collections::BTreeMap;
use std::path::{MAIN_SEPARATOR, Path, PathBuf};
use std::slice::from_ref;

pub struct RecordSweep {
    pub plan: Plan,
    /// Limits to count beside overturning.
    pub limits: Vec<Limit>,
    pub measure: IntensityMeasure,
    /// Findings and assumptions of each record, in a line.
    pub records: Vec<String>,
}

/// Maps by the names of their structures, and how often their grids are refined along boundaries.
pub type MapSweep = (Vec<(String, Map)>, u32);

pub enum SweepContent {
    Records(Box<RecordSweep>),
    Pulses(MapSweep),
    /// A value of a number that is sought, and a line for each record.
    Design(Box<Design>, Vec<String>),
}

/// The file with `records`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct SweepFile {
    records: Vec<RecordEntry>,
    /// Unit of records that do not state theirs.
    unit: Option<Unit>,
    time_scale: Option<f64>,
    /// Without it, 1.
    scale: Option<Values>,
    structures: Vec<StructureGrid>,
    #[serde(default)]
    detail: Detail,
    tolerance: Option<f64>,
    /// From a record's first sample to the end of a run, s.
    duration: Option<f64>,
    #[serde(default)]
    condition: bool,
    #[serde(default)]
    initial: InitialArgs,
    intensity: Option<String>,
    /// Oscillators on floors, by the names of their S_a.
    #[serde(default)]
    contents: Vec<String>,
    /// One or several by the name of a measure, in its own unit or with a usual one.
    #[serde(default)]
    limits: toml::Table,
    design: Option<Goal>,
}

/// The file with `pulses`.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct MapFile {
    pulses: PulseGrid,
    structures: Vec<StructureGrid>,
    #[serde(default)]
    detail: Detail,
    tolerance: Option<f64>,
    /// Times that the grid's steps are halved along the boundaries.
    #[serde(default)]
    refine: u32,
    #[serde(default)]
    condition: bool,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct PulseGrid {
    shape: Shape,
    cycles: Option<f64>,
    #[serde(default)]
    phase: f64,
    error: Option<f64>,
    /// In Hz, or over p_l.
    frequency: Values,
    /// In g, or over g tan(alpha_cg).
    amplitude: Values,
    #[serde(default)]
    dimensionless: bool,
}

/// Records: a path or a pattern such as `records/*.AT2`, from the folder of the file, or a table with it.
#[derive(Deserialize)]
#[serde(untagged, expecting = "expected a path or pattern, or { file = ..., scale = ... }")]
enum RecordEntry {
    AsTheyAre(String),
    As(RecordTable),
}

#[derive(Deserialize, Default)]
struct RecordTable {
    file: String,
    /// Path of the vertical component of the one file.
    record_v: Option<String>,
    column_v: Option<Column>,
    /// Path of the force on the top floor.
    force: Option<String>,
    /// Options for reading each file.
    #[serde(flatten)]
    options: toml::Table,
}

/// Structures that count as one population: each has its own fragility curve.
#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
struct StructureGrid {
    name: String,
    preset: Option<String>,
    parameters: Option<Numbers>,
    /// Of any structure, from the folder of the TOML file.
    file: Option<PathBuf>,
    /// By the name of a parameter, or `slenderness`; every combination is run.
    #[serde(default)]
    vary: BTreeMap<String, Values>,
}

#[derive(Deserialize)]
#[serde(untagged, expecting = "expected a list of numbers, or { from = ..., to = ..., count = ... }")]
enum Values {
    List(Vec<f64>),
    Even {
        from: f64,
        to: f64,
        count: usize,
        /// Evenly in their logarithms.
        #[serde(default)]
        log: bool,
    },
}

/// Reads the sweep in the TOML file at `path`, and its records, each of which is an input of `files`.
pub fn read(path: &Path, files: &mut OutputFiles) -> anyhow::Result<SweepContent> {
    let mut read = || -> anyhow::Result<_> {
        let (text, folder) = (input::text(path)?, path.parent().unwrap_or(Path::new("")));
        let table: toml::Table = toml::from_str(&text)?;
        if table.keys().any(|key| key.starts_with("pulse")) {
            return Ok(SweepContent::Pulses(toml::from_str::<MapFile>(&text)?.sweep(folder, files)?));
        }
        let file: SweepFile = toml::from_str(&text)?;
        let (unit, time_scale) = (file.unit, file.time_scale);
        let scales = file.scale.as_ref().map_or(Ok(vec![1.0]), Values::list).context("scale")?;
        let measure = file.intensity.as_deref().map_or(Ok(IntensityMeasure::default()), measure)?;
        let (grids, mut bases) = (&file.structures, Vec::new());
        grids.iter().try_for_each(|grid| grid.base(folder, files).map(|base| bases.push(base)))?;
        let (g, base) = (gravity(&bases)?, bases[0].clone());
        let populations =
            grids.iter().zip(bases).map(|(grid, base)| grid.population(base)).collect::<Result<_, _>>()?;
        let (mut records, mut warnings) = (Vec::new(), Vec::new());
        let mut understand = |path: &Path, options: &RecordOptions| {
            files.add_input(path);
            let (unit, time_scale) = (options.unit.or(unit), options.time_scale.or(time_scale));
            let options = RecordOptions { unit, time_scale, scale: None, ..options.clone() };
            let understood = options.understand(path, g, str::to_owned)?;
            warnings.extend_from_slice(&understood.sentences[1..]);
            records.push(understood.sentences[0].clone());
            Ok::<_, anyhow::Error>(understood)
        };
        let table = |entry| match entry {
            RecordEntry::AsTheyAre(file) => RecordTable { file, ..RecordTable::default() },
            RecordEntry::As(table) => table,
        };
        let tables: Vec<_> = file.records.into_iter().map(table).collect();
        let motions = motions(&tables, folder, |path, vertical, force, options| {
            let mut understood = understand(path, options)?;
            if let Some((vertical, of_vertical)) = vertical {
                understood = understood.with_vertical(understand(vertical, of_vertical)?, g, "column_v")?;
            }
            with_force(understood, force, g)
        });
        tables.iter().filter_map(|of| of.force.as_ref()).for_each(|force| files.add_input(&folder.join(force)));
        let all_warn = |warnings| few(warnings, "warnings").iter().for_each(|warning| warning!("{warning}"));
        all_warn(warnings);
        let (tolerance, duration) = (file.tolerance.unwrap_or(DEFAULT_TOLERANCE), file.duration);
        let (initial, detail, finds_condition) = (file.initial.state(), file.detail, file.condition);
        let conditions = Conditions { initial, detail, tolerance, duration, finds_condition };
        if let Some(sought) = file.design {
            let is_alone = grids.len() == 1 && grids[0].vary.is_empty() && file.limits.is_empty();
            ensure!(!finds_condition, "condition = true is for `rocking-fmu sweep`");
            ensure!(is_alone, "design needs one of [[structures]], without vary and limits: they stand in [design]");
            let design = Design { sought, structure: base, motions: motions?, scales, conditions };
            return Ok(SweepContent::Design(Box::new(design), records));
        }
        let plan = Plan::new(populations, motions?, scales, conditions)?.with_contents(&file.contents)?;
        all_warn(plan.doubts.clone());
        let limits = limits(&file.limits, &plan.measures).context("limits")?;
        limits.iter().try_for_each(|limit| limit.check(plan.widest)).context("limits")?;
        Ok(SweepContent::Records(Box::new(RecordSweep { plan, limits, measure, records })))
    };
    read().with_context(|| format!("sweep in {}", path.display()))
}

impl MapFile {
    fn sweep(&self, folder: &Path, files: &mut OutputFiles) -> anyhow::Result<MapSweep> {
        let refine = self.refine;
        ensure!(refine <= MAX_REFINEMENTS, "refine = {refine} is out of range: 0 to {MAX_REFINEMENTS} are possible");
        ensure!(!self.structures.is_empty(), "structures is empty: name one or more");
        let mut maps: Vec<(String, Map)> = Vec::new();
        for grid in &self.structures {
            let name = &grid.name;
            ensure!(maps.iter().all(|(other, _)| other != name), "two structures have the name {name:?}: rename one");
            let base = grid.base(folder, files)?;
            let map = self.map(grid, &base).with_context(|| format!("structures {name:?}"))?;
            maps.push((name.into(), map));
        }
        Ok((maps, refine))
    }

    fn map(&self, grid: &StructureGrid, structure: &Structure) -> anyhow::Result<Map> {
        ensure!(grid.vary.is_empty(), "vary is not possible with pulses: list each structure under [[structures]]");
        let &PulseGrid { shape, cycles, phase, error, ref frequency, ref amplitude, dimensionless } = &self.pulses;
        let unit = if dimensionless { 1.0 } else { structure.base().g };
        let frequency = frequency.axis(1.0).context("frequency")?;
        let amplitude = amplitude.axis(unit).context("amplitude")?;
        let pulse = Pulse::new(shape, amplitude.values[0], frequency.values[0]);
        let (cycles, error) = (cycles.unwrap_or(pulse.cycles), error.unwrap_or(pulse.error));
        let pulse = Pulse { cycles, phase, error, ..pulse };
        let map = Map::new(structure.clone(), pulse, [frequency, amplitude], dimensionless).context("pulses")?;
        Ok(map.computed_by(self.detail, self.tolerance.unwrap_or(DEFAULT_TOLERANCE), self.condition)?)
    }
}

fn limits(asked: &toml::Table, measures: &[Measure]) -> anyhow::Result<Vec<Limit>> {
    let mut limits = Vec::new();
    for (name, given) in asked {
        let values = given.as_array().map_or(from_ref(given), Vec::as_slice);
        ensure!(!values.is_empty(), "{name} is empty: give one or more");
        for value in values {
            let value = value.as_str().map_or_else(|| value.to_string(), str::to_owned);
            limits.push(Limit::read(&format!("{name} >= {value}"), measures)?);
        }
    }
    Ok(limits)
}

/// The one acceleration of gravity of all structures, m/s²: that in which the records are given.
fn gravity(structures: &[Structure]) -> anyhow::Result<f64> {
    let first = structures.first().context("structures is empty: name one or more")?.base().g;
    for g in structures.iter().map(|structure| structure.base().g) {
        ensure!(g == first, "g = {g} m/s2 and g = {first} m/s2: a sweep has one g, in which its records are given");
    }
    Ok(first)
}

impl Values {
    fn list(&self) -> anyhow::Result<Vec<f64>> {
        match *self {
            Values::List(ref values) => Ok(values.clone()),
            Values::Even { from, to, count, log } => {
                ensure!(
                    (2..=MAX_RUNS).contains(&count),
                    "count = {count} is out of range: 2 to {MAX_RUNS} values are possible from {from} to {to}"
                );
                ensure!(!log || from > 0.0 && to > 0.0, "from = {from} to = {to} have no logarithms");
                let last = (count - 1) as f64;
                let at = |i: usize| match i {
                    i if !log => (from * (last - i as f64) + to * i as f64) / last,
                    0 => from,
                    i if i == count - 1 => to,
                    i => from * (i as f64 / last * (to / from).ln()).exp(),
                };
                Ok((0..count).map(at).collect())
            }
        }
    }

    fn axis(&self, unit: f64) -> anyhow::Result<Axis> {
        let is_log = matches!(self, Values::Even { log: true, .. });
        let values: Vec<_> = self.list()?.into_iter().map(|value| value * unit).collect();
        ensure!(!values.is_empty(), "it is empty: give two or more");
        Ok(Axis { values, is_log })
    }
}

impl StructureGrid {
    fn base(&self, folder: &Path, files: &mut OutputFiles) -> anyhow::Result<Structure> {
        let mut base = || match (&self.preset, &self.parameters, &self.file) {
            (Some(preset), None, None) => Ok(Structure::new(Parameters::preset(preset)?)?),
            (None, Some(given), None) => Ok(given.structure(None)?),
            (None, None, Some(file)) => {
                let path = folder.join(file);
                files.add_input(&path);
                input::text(&path)
                    .and_then(|text| structure_file::read(&text))
                    .with_context(|| path.display().to_string())
            }
            _ => bail!("give one of preset, parameters and file"),
        };
        base().with_context(|| format!("structures {:?}", self.name))
    }

    fn population(&self, base: Structure) -> anyhow::Result<Population> {
        let vary = |population: Population, (name, values): (&String, &Values)| -> anyhow::Result<_> {
            ensure!(name != "g", "g cannot vary: a sweep has one g");
            Ok(population.vary(name, values.list().context(name.clone())?)?)
        };
        let population = self.vary.iter().try_fold(Population::new(&self.name, base), vary);
        population.with_context(|| format!("structures {:?}", self.name))
    }
}

/// The records that `sources` name, under their paths from `folder`.
fn motions(
    sources: &[RecordTable],
    folder: &Path,
    mut read: impl FnMut(&Path, Option<(&Path, &RecordOptions)>, Option<&Path>, &RecordOptions) -> anyhow::Result<Record>,
) -> anyhow::Result<Vec<NamedRecord>> {
    let (mut motions, mut bad) = (Vec::new(), Vec::<anyhow::Error>::new());
    for RecordTable { file: pattern, record_v, column_v, force, options } in sources {
        let options = RecordOptions::deserialize(options.clone()).with_context(|| format!("records {pattern:?}"))?;
        let of_vertical = options.with_column(column_v);
        let has_vertical = record_v.is_some() || column_v.is_some();
        let vertical = record_v.as_ref().filter(|up| *up != pattern);
        let column = |options: &RecordOptions| {
            options.column.as_ref().map_or(String::new(), |column| format!(" column {}", column.as_asked()))
        };
        let of_other_column = if of_vertical.column == options.column { String::new() } else { column(&of_vertical) };
        let up = vertical.map_or(String::new(), |up| format!(" {up}"));
        let up = if has_vertical { format!(" with{up}{of_other_column}") } else { String::new() };
        let with = column(&options) + &up + &force.as_ref().map_or(String::new(), |of| format!(" with {of}"));
        let in_folder = Path::new(&glob::Pattern::escape(&folder.to_string_lossy())).join(pattern);
        let paths = glob::glob(&in_folder.to_string_lossy()).with_context(|| format!("records {pattern:?}"))?;
        let mut paths = paths.peekable();
        if paths.peek().is_none() {
            bad.push(anyhow!("records: there is no file {}", folder.join(pattern).display()));
        }
        for (i, path) in paths.enumerate() {
            let path = path?;
            ensure!(
                i == 0 || vertical.is_none(),
                "records {pattern:?}: record_v goes with one file, and there are more"
            );
            // The same on every system, so that a sweep can go on on another.
            let name = path.strip_prefix(folder).unwrap_or(&path).to_string_lossy().replace(MAIN_SEPARATOR, "/");
            let up = vertical.map_or_else(|| path.clone(), |up| folder.join(up));
            let force = force.as_ref().map(|of| folder.join(of));
            let record = read(&path, has_vertical.then_some((&*up, &of_vertical)), force.as_deref(), &options);
            let named = |record| Ok(NamedRecord::new(name + &with, record, options.scale.unwrap_or(1.0))?);
            match record.and_then(named) {
                Ok(motion) => motions.push(motion),
                Err(error) => bad.push(error),
            }
        }
    }
    match bad.len() {
        0 => Ok(motions),
        1 => Err(bad.remove(0)),
        count => {
            let each: String = bad.iter().map(|error| format!("\n  {error:#}")).collect();
            bail!("{count} of {} records cannot be taken:{each}", count + motions.len());
        }
    }
}
