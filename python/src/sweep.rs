//! `sweep` and `fragility`: many runs on all cores, and what they say together.

use crate::arguments::{argument, conditions, numbers, one_of, refused, reject};
use crate::interruptible::{FAULT, MOMENT, interruptible};
use crate::record::{G, RecordArgument};
use crate::structure::PyStructure;
use FlexibleRocking::BUILD;
use anyhow::ensure;
use numpy::{PyArray1, PyArray2};
use pyo3::exceptions::PyRuntimeError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyList, PyString};
use rocking::Detail;
use rocking::run::Ending;
use rocking_report::run::Watcher;
use rocking_sweep::design::{Design, Designed, Goal};
use rocking_sweep::exceedances::{self, Bin, Tally};
use rocking_sweep::fragility::{Certainty, FragilityCurve};
use rocking_sweep::map::{Axis, GridPlace, HEADINGS, MAX_REFINEMENTS, Map, MapPoint};
use rocking_sweep::outcome::{Limit, Measure, of_column};
use rocking_sweep::plan::{Conditions, NamedRecord, Plan, Population, measure};
use rocking_sweep::pulse::{Pulse, Shape};
use rocking_sweep::row_file::{Program, do_runs, heading, line, name_and_unit};
use rocking_sweep::rows::{FAILED, RowColumn, Sweep};
use rocking_sweep::thread_pool;
use serde::Deserialize;
use serde::de::IntoDeserializer;
use std::collections::HashMap;
use std::path::PathBuf;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;

/// A table: the keys of its rows, its columns with their headings, and the error that stopped the sweep before its end, if one
/// did.
type Columns<'py> = (Bound<'py, PyList>, Vec<(String, Bound<'py, PyAny>)>, Option<PyErr>);

/// Does every one of the populations of structures under every record at every scale, but for the runs whose rows are in the
/// file at `path`. Returns the rows in that order, with a column of the measure `intensity`. `progress` is called with how
/// many runs of how many are done.
#[pyfunction]
pub fn sweep<'py>(
    py: Python<'py>,
    structures: Vec<(String, Vec<Py<PyStructure>>)>,
    records: Vec<(String, RecordArgument)>,
    scale: &Bound<'_, PyAny>,
    intensity: &str,
    contents: Vec<String>,
    path: Option<PathBuf>,
    #[pyo3(from_py_with = argument::detail)] detail: Detail,
    #[pyo3(from_py_with = argument::tolerance)] tolerance: f64,
    duration: Option<&Bound<'_, PyAny>>,
    condition: bool,
    initial: &Bound<'_, PyDict>,
    validity: bool,
    threads: i64,
    progress: Option<Bound<'_, PyAny>>,
) -> PyResult<Columns<'py>> {
    let scales = numbers("scale", scale)?;
    let intensity = measure(intensity).map_err(refused)?;
    let population = |(name, of): &(String, Vec<Py<PyStructure>>)| {
        Population::of(name, of.iter().map(|structure| structure.get().of.clone()).collect()).map_err(refused)
    };
    let populations = structures.iter().map(population).collect::<PyResult<_>>()?;
    let motions = motions(&records, structures.iter().flat_map(|(_, of)| of).map(|structure| structure.get()))?;
    let conditions =
        Conditions { finds_condition: condition, ..conditions(detail, tolerance, duration, Some(initial))? };
    let plan = py.detach(|| Plan::new(populations, motions, scales, conditions)?.with_contents(&contents));
    let plan = plan.map_err(refused)?;

    let (program, done, stopped) = (Program::of(BUILD), AtomicUsize::new(0), AtomicBool::new(false));
    let sweep = py.detach(|| Sweep::open(&plan, validity, &program, path.as_deref())).map_err(refused)?;
    let all = sweep.missing().len();
    let pool = thread_pool(threads).map_err(refused)?;
    let progress = progress.map(Bound::unbind);
    let say = |py: Python<'_>| match &progress {
        Some(progress) => progress.call1(py, (done.load(Ordering::Relaxed), all)).map(drop),
        None => Ok(()),
    };
    let finished = py.detach(|| {
        thread::scope(|scope| {
            let (over, is_over) = mpsc::channel::<()>();
            let runs = scope.spawn(|| {
                let _over = over; // when it is dropped
                pool.install(|| {
                    sweep.finish(|| {
                        done.fetch_add(1, Ordering::Relaxed);
                        !stopped.load(Ordering::Relaxed)
                    })
                })
            });
            let mut interruption = Ok(());
            while is_over.recv_timeout(MOMENT) == Err(RecvTimeoutError::Timeout) {
                if interruption.is_ok() {
                    interruption = Python::attach(|py| py.check_signals().and_then(|()| say(py)));
                    stopped.store(interruption.is_err(), Ordering::Relaxed);
                }
            }
            let finished = runs.join().map_err(|_| PyRuntimeError::new_err(FAULT))?;
            match interruption {
                Err(interruption) => Ok(Some(interruption)),
                Ok(()) => finished.map(|()| None).map_err(refused),
            }
        })
    });
    let stopped = match finished? {
        None => say(py).err(),
        stopped => stopped,
    };
    let (keys, columns) = py.detach(|| sweep.table(intensity)); // nothing of the sweep is left beside its table
    let columns = columns.into_iter().map(|(heading, column)| Ok((heading, values(py, column)?)));
    let keys = keys.iter().map(|key| PyString::new(py, key.hyphenated().encode_lower(&mut [0; 36])));
    Ok((PyList::new(py, keys)?, columns.collect::<PyResult<_>>()?, stopped))
}

/// The `records` under their names, in the one g of the `structures`.
fn motions<'a>(
    records: &[(String, RecordArgument)],
    structures: impl Iterator<Item = &'a PyStructure>,
) -> PyResult<Vec<NamedRecord>> {
    let mut gs = structures.map(|structure| structure.of.base().g);
    let g = gs.next().unwrap_or(G);
    let other = gs.find(|other| *other != g);
    let motion = |(name, RecordArgument(record)): &(String, RecordArgument)| {
        let record = record.get();
        if let (true, Some(other)) = (record.is_in_g(), other) {
            reject!("g = {other} m/s2 and g = {g} m/s2: a sweep has one g, in which its records are given");
        }
        NamedRecord::new(name, record.unscaled(g).map_err(refused)?, record.scale).map_err(refused)
    };
    records.iter().map(motion).collect()
}

/// What [`Design::found`] says, the unit of the number, and the curve: value, whether the limits hold, part of the runs within them,
/// how many are unknown, and the demand of each limit.
type FoundDesign =
    (Option<f64>, Vec<[f64; 2]>, Vec<[f64; 2]>, String, &'static str, Vec<(f64, bool, f64, usize, Vec<f64>)>);

/// The value of the number `vary` of `structure` at which limits hold in a share of the runs, and the curve over its range.
#[pyfunction]
pub fn design(
    py: Python<'_>,
    structure: &PyStructure,
    records: Vec<(String, RecordArgument)>,
    vary: String,
    between: [f64; 2],
    limit: Vec<String>,
    share: f64,
    count: usize,
    log: bool,
    refine: u32,
    scale: &Bound<'_, PyAny>,
    #[pyo3(from_py_with = argument::detail)] detail: Detail,
    #[pyo3(from_py_with = argument::tolerance)] tolerance: f64,
    duration: Option<&Bound<'_, PyAny>>,
    initial: &Bound<'_, PyDict>,
    threads: i64,
) -> PyResult<FoundDesign> {
    let design = Design {
        sought: Goal { vary, between, limit, share, count, log, refine },
        structure: structure.of.clone(),
        motions: motions(&records, [structure].into_iter())?,
        scales: numbers("scale", scale)?,
        conditions: conditions(detail, tolerance, duration, Some(initial))?,
    };
    let (points, found, unit) = interruptible(py, move |abandoned| -> anyhow::Result<_> {
        let waiting = abandoned.clone();
        let points = thread_pool(threads)?.install(|| design.complete(|_, _| waiting.check()))?;
        Ok((points.clone(), design.found(&points), design.unit()))
    })?;
    let Designed { value, holds, crossings, sentence } = found;
    let rows = points.into_iter().map(|of| (of.value, of.holds, of.within, of.unknown, of.demands));
    Ok((value, holds, crossings, sentence, unit, rows.collect()))
}

/// A map of `structure` under pulses as CSV: a row for each point, those of the grid first.
#[pyfunction]
pub fn overturning_map(
    py: Python<'_>,
    structure: &PyStructure,
    shape: &Bound<'_, PyAny>,
    frequency: &Bound<'_, PyAny>,
    amplitude: &Bound<'_, PyAny>,
    cycles: Option<f64>,
    phase: f64,
    error: f64,
    dimensionless: bool,
    refine: u32,
    condition: bool,
    #[pyo3(from_py_with = argument::detail)] detail: Detail,
    #[pyo3(from_py_with = argument::tolerance)] tolerance: f64,
    threads: i64,
) -> PyResult<String> {
    let shape = one_of("shape", shape, Shape::ALL.map(|of| (of.name(), of)))?;
    let structure = structure.of.clone();
    let g = if dimensionless { 1.0 } else { structure.base().g };
    let axis = |name, values, unit| -> PyResult<Axis> {
        Ok(Axis { values: numbers(name, values)?.into_iter().map(|value| value * unit).collect(), is_log: false })
    };
    let axes = [axis("frequency", frequency, 1.0)?, axis("amplitude", amplitude, g)?];
    let pulse = Pulse::new(shape, 1.0, 1.0);
    let pulse = Pulse { cycles: cycles.unwrap_or(pulse.cycles), phase, error, ..pulse };
    let (map, mut rows) = interruptible(py, move |abandoned| -> anyhow::Result<_> {
        let map = Map::new(structure, pulse, axes, dimensionless)?.computed_by(detail, tolerance, condition)?;
        ensure!(refine <= MAX_REFINEMENTS, "refine = {refine} is out of range: 0 to {MAX_REFINEMENTS} are possible");
        let (pool, rows) = (thread_pool(threads)?, Mutex::new(Vec::new()));
        map.complete(refine, &mut HashMap::new(), |level, lacking, points| {
            let (waiting, points) = (abandoned.clone(), Mutex::new(points));
            let run = |places: &[GridPlace], done: &mut dyn FnMut(_, &[u8]) -> bool| {
                map.run_each(places, |at, point| done((places[at], point), &[]));
            };
            let keep = |(place, point): (GridPlace, MapPoint)| {
                waiting.check();
                points.lock().expect("no thread panics with them").insert(place, point.clone());
                rows.lock().expect("no thread panics with them").push((level, place, point));
                Ok(())
            };
            pool.install(|| do_runs(&lacking, None, run, keep))
        })?;
        Ok((map, rows.into_inner()?))
    })?;
    rows.sort_by_key(|(level, place, _)| (*level, *place));
    let lines = rows.iter().flat_map(|(level, place, point)| line(&map.row(*level, *place, point)));
    String::from_utf8(line(&HEADINGS).into_iter().chain(lines).collect()).map_err(refused)
}

/// An array of the numbers of a column; of texts, each once, and the array of their positions.
fn values(py: Python<'_>, column: RowColumn) -> PyResult<Bound<'_, PyAny>> {
    Ok(match column {
        RowColumn::Numbers(of) => PyArray1::from_vec(py, of).into_any(),
        RowColumn::Counts(of) => PyArray1::from_vec(py, of).into_any(),
        RowColumn::Texts(texts, of) => (texts, PyArray1::from_vec(py, of)).into_pyobject(py)?.into_any(),
    })
}

/// The heading of the column of the `intensity` measure of this name.
#[pyfunction]
pub fn heading_of(intensity: &str) -> PyResult<String> {
    let measure = measure(intensity).map_err(refused)?;
    Ok(heading(&measure.name(), measure.unit()))
}

/// How sure a curve is: a covariance, and a number of standard deviations.
type Sure = ([[f64; 2]; 2], f64);

/// A lognormal fragility curve, and how sure it is.
#[pyclass(frozen, name = "Curve", module = "flexible_rocking")]
pub struct PyCurve(FragilityCurve);

#[pymethods]
impl PyCurve {
    #[new]
    #[pyo3(signature = (median, dispersion, known=None))]
    fn new(median: f64, dispersion: f64, known: Option<Sure>) -> PyCurve {
        let certainty = |(covariance, half_width): Sure| Certainty { covariance: covariance.into(), half_width };
        PyCurve(FragilityCurve { median, dispersion, certainty: known.map(certainty) })
    }

    fn __getnewargs__(&self) -> (f64, f64, Option<Sure>) {
        let FragilityCurve { median, dispersion, certainty } = self.0;
        (median, dispersion, certainty.map(|of| (of.covariance.into(), of.half_width)))
    }

    /// Intensity at which the limit is exceeded with the probability 1/2.
    #[getter]
    fn median(&self) -> f64 {
        self.0.median
    }

    /// Standard deviation of the intensity's logarithm.
    #[getter]
    fn dispersion(&self) -> f64 {
        self.0.dispersion
    }

    /// The 95 % confidence interval of the median, two intensities. None with fewer than 5 records, or, under one record, fewer
    /// than 5 structures.
    #[getter]
    fn median_range(&self) -> Option<(f64, f64)> {
        self.0.median_range()
    }

    /// The probability that the limit is exceeded at each of `intensities`, an array (n,): an array (n,).
    fn probability<'py>(&self, intensities: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let probabilities = numbers("intensities", intensities)?.into_iter().map(|at| self.0.probability(at));
        Ok(PyArray1::from_vec(intensities.py(), probabilities.collect()))
    }

    /// The 95 % confidence interval of the probability at each of `intensities`: an array (n, 2). None if median_range is None.
    fn band<'py>(&self, intensities: &Bound<'py, PyAny>) -> PyResult<Option<Bound<'py, PyArray2<f64>>>> {
        let at = numbers("intensities", intensities)?;
        let band: Option<Vec<_>> = at.into_iter().map(|at| Some(<[f64; 2]>::from(self.0.band(at)?).to_vec())).collect();
        band.map(|band| PyArray2::from_vec2(intensities.py(), &band).map_err(refused)).transpose()
    }
}

/// Runs of about the same intensity: the lowest, mean and highest of these, how many there are, of how many the answer is
/// known, and how many exceed the limit.
type BinRow = (f64, f64, f64, usize, usize, usize);

/// The measures of the peaks, and of what is left at the end, among the columns of a sweep's table, and these columns.
fn measures(columns: Vec<String>) -> (Vec<Measure>, Vec<String>) {
    let measure = |heading: String| {
        let (name, unit) = name_and_unit(of_column(&heading)?);
        Some(((name.to_owned(), unit.to_owned()), heading))
    };
    columns.into_iter().filter_map(measure).unzip()
}

/// Whether each run exceeds `limit`; None where that is unknown. Each run has its ending, the largest peak of [`columns_of`] the
/// limit, and g (m/s²). `half_width` (m) is the largest B of their structures.
#[pyfunction]
pub fn exceeds(
    endings: Vec<String>,
    peaks: Vec<f64>,
    gs: Vec<f64>,
    limit: &str,
    half_width: f64,
    columns: Vec<String>,
) -> PyResult<Vec<Option<bool>>> {
    let limit = Limit::read(limit, &measures(columns).0).map_err(refused)?;
    limit.check(half_width).map_err(refused)?;
    let exceeds = |((ending, peak), g): ((&String, f64), f64)| -> PyResult<Option<bool>> {
        if ending == FAILED {
            return Ok(None);
        }
        let ending: Result<_, serde::de::value::Error> = Ending::deserialize(ending.as_str().into_deserializer());
        Ok(limit.is_exceeded(ending.map_err(refused)?, peak, g))
    };
    endings.iter().zip(peaks).zip(gs).map(exceeds).collect()
}

/// The curve of runs, and the counted runs that are drawn beside the curve. Each run has its group, its intensity, and whether
/// the limit is exceeded, if that is known.
#[pyfunction]
pub fn fragility(
    py: Python<'_>,
    groups: Vec<usize>,
    intensities: Vec<f64>,
    exceeds: Vec<Option<bool>>,
) -> PyResult<(PyCurve, Vec<BinRow>)> {
    let runs = groups.into_iter().zip(intensities).zip(exceeds);
    let runs: Vec<_> = runs.map(|((group, at), exceeds)| (group, at, exceeds)).collect();
    let (curve, bins) = py.detach(|| exceedances::of_runs(runs)).map_err(refused)?;
    let counts = |(of, tally): (Bin, Tally)| (of.lowest, of.mean, of.highest, of.runs, tally.known, tally.exceedances);
    Ok((PyCurve(curve), bins.into_iter().map(counts).collect()))
}

/// The columns of a sweep's table whose largest value `limit` compares; none if the limit is overturning.
#[pyfunction]
pub fn columns_of(limit: &str, columns: Vec<String>) -> PyResult<Vec<String>> {
    let (measures, columns) = measures(columns);
    let limit = Limit::read(limit, &measures).map_err(refused)?;
    Ok(limit.measures().iter().map(|at| columns[*at].clone()).collect())
}
