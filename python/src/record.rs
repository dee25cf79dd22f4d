//! `Record`: a ground motion from arrays, a file or a formula.

use crate::arguments::{argument, number, numbers, one_of, refused, reject, warn};
use crate::interruptible::interruptible;
use crate::structure::PyStructure;
use anyhow::ensure;
use numpy::PyArray1;
use pyo3::exceptions::PyTypeError;
use pyo3::prelude::*;
use rocking::Parameters;
use rocking::estimates::intensity::peak_velocity;
use rocking::estimates::response_spectrum;
use rocking::run::record::{Record, SamplesError};
use rocking_records::{Column, Reading, TITLE, Unit, csv_in, doubt_of_peak, doubts, each_in_m_s2};
use rocking_report::output_files::OutputFiles;
use rocking_report::record::{Understood, understand};
use rocking_report::run::Watcher;
use rocking_sweep::pulse::{DEFAULT_ERROR, Pulse, Shape, units_of};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::PathBuf;
use std::sync::Arc;

/// The g in the attributes of a record, m/s²; the g of a structure that is shaken is its own.
pub const G: f64 = Parameters::EVISON.g;

/// A ground motion: the acceleration of the ground at two instants or more, linear between them.
///
/// Record(time, a_g): arrays of one shape (n,), n >= 2, time in s, strictly increasing; a_g, horizontal, in `unit`.
/// Record(dt, a_g): samples every dt seconds from 0 on.
/// Record(time, a_g, a_v): with the vertical component, positive upwards, of the same shape and unit.
/// Record(series): a pandas Series, whose index is the time in s.
/// Record(trace, unit="m/s2"): the samples of an ObsPy Trace, or of a Stream of one, once they are accelerations.
/// Record.read(file): a file as the archives publish it.
///
/// unit: "m/s2" (the default for arrays), "g", "cm/s2", "gal", "mm/s2", "in/s2", "ft/s2", "mg", "%g". A record keeps its unit: "g" means the
/// g of the structure that the record shakes. The attributes of the record are in m/s2, with 9.81 m/s2 for g. time_scale
/// multiplies the times and scale the accelerations. Tables call the record by its title. The samples are copied. A Python
/// warning names a likely fault. Raises ValueError for other shapes, NaN and infinity, and times that do not increase.
#[pyclass(frozen, eq, name = "Record", module = "flexible_rocking")]
pub struct PyRecord {
    /// Without the force.
    given: Record,
    /// Times (s) and sizes (N) of the force on the top floor.
    force: Option<[Vec<f64>; 2]>,
    /// Of what was given: m/s², or a unit of g.
    unit: Unit,
    /// Multiplies the accelerations once they are in m/s².
    pub scale: f64,
    /// In m/s², under [`G`].
    usual: Arc<Record>,
}

fn unit(value: &Bound<'_, PyAny>) -> PyResult<Unit> {
    one_of("unit", value, Unit::NAMES)
}

/// The `samples` in m/s², or as they are if the g of a structure decides how large the `units` of their components are.
fn fixed(samples: Record, units: [Unit; 2]) -> PyResult<(Record, Unit)> {
    let [unit, vertical] = units;
    let is_of_g = |unit| matches!(unit, Unit::G | Unit::MilliG | Unit::PercentG);
    if is_of_g(unit) && unit == vertical {
        return Ok((samples, unit));
    }
    if units.into_iter().any(is_of_g) {
        let needed = "one unit is needed; say unit, or scale one of the files";
        reject!("record_v is in {vertical} and file in {unit}: {needed}");
    }
    Ok((each_in_m_s2(samples, units, G).map_err(refused)?, Unit::MetrePerSecondSquared))
}

/// What is `given` in this `unit`, in m/s² under `g` (m/s²), with the `force`.
fn unscaled(given: &Record, force: Option<&[Vec<f64>; 2]>, unit: Unit, g: f64) -> Result<Record, SamplesError> {
    let ground = given.clone().multiplied(unit.in_m_s2(g));
    match force {
        Some([times, F_t]) => ground.with_force(times, F_t),
        None => Ok(ground),
    }
}

/// Two records are equal if their files are.
impl PartialEq for PyRecord {
    fn eq(&self, other: &PyRecord) -> bool {
        self.unit == other.unit && self.force == other.force && self.multiplied() == other.multiplied()
    }
}

impl PyRecord {
    fn new(given: Record, force: Option<[Vec<f64>; 2]>, unit: Unit, scale: f64) -> PyResult<PyRecord> {
        let usual = Arc::new(unscaled(&given, force.as_ref(), unit, G).map_err(refused)?.multiplied(scale));
        Ok(PyRecord { given, force: force.filter(|_| usual.force().is_some()), unit, scale, usual })
    }

    /// Of `samples` in m/s².
    pub fn in_si(samples: Record) -> PyResult<PyRecord> {
        PyRecord::new(samples, None, Unit::MetrePerSecondSquared, 1.0)
    }

    /// The record in m/s² as it shakes a structure under `g` (m/s²).
    pub fn under(&self, g: f64) -> Arc<Record> {
        if g == G || !self.is_in_g() {
            return Arc::clone(&self.usual);
        }
        Arc::new(self.unscaled(g).expect("the force begins with the record under every g").multiplied(self.scale))
    }

    /// The record in m/s² under `g` (m/s²) with its force, before `scale` multiplies the accelerations.
    pub fn unscaled(&self, g: f64) -> Result<Record, SamplesError> {
        unscaled(&self.given, self.force.as_ref(), self.unit, g)
    }

    /// The accelerations in its unit, as a file has them.
    fn multiplied(&self) -> Record {
        self.given.clone().multiplied(self.scale)
    }

    /// Whether the g of a structure decides how strong it is.
    pub fn is_in_g(&self) -> bool {
        self.unit != Unit::MetrePerSecondSquared
    }

    /// An array of a component, with 0 for each time after its last sample.
    fn at_all_times<'py>(&self, py: Python<'py>, samples: &[f64]) -> Bound<'py, PyArray1<f64>> {
        let sample = |i| samples.get(i).copied().unwrap_or_default();
        PyArray1::from_vec(py, (0..self.usual.times().len()).map(sample).collect())
    }

    /// Its components, the horizontal one first, as tables that are read without options.
    pub fn tables(&self) -> anyhow::Result<Vec<String>> {
        ensure!(
            self.usual.force().is_none(),
            "a file or an FMU cannot hold the record's force: write the record without with_force, and set the input F_t of the FMU"
        );
        let (table, vertical) = csv_in(&self.multiplied(), [self.unit; 2]);
        Ok([table].into_iter().chain(vertical).collect())
    }
}

/// The step (s), the samples, their unit and the title of an ObsPy Trace, or of a Stream of one.
fn of_trace<'py>(
    given: &Bound<'py, PyAny>,
    unit: Option<Unit>,
) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyAny>, Unit, String)> {
    let trace = match given.getattr("traces") {
        Ok(traces) if traces.len()? == 1 => traces.get_item(0)?,
        Ok(traces) => {
            let needed = "a Record has one: give one of them, such as Record(stream[0], unit=...)";
            reject!("the stream has {} traces, {}, and {needed}", traces.len()?, ids(&traces)?);
        }
        Err(_) => given.clone(),
    };
    let (Ok(data), Ok(stats)) = (trace.getattr("data"), trace.getattr("stats")) else {
        reject!("a_g is needed beside time = {given:?}, unless that is a Trace or a Stream of ObsPy");
    };
    let title = trace.getattr("id")?.str()?.to_string();
    let Some(unit) = unit else {
        let needed = "say unit=, such as unit=\"m/s2\" after trace.remove_response(output=\"ACC\")";
        reject!("the trace {title} does not state the unit of its samples: {needed}");
    };
    Ok((stats.getattr("delta")?, data, unit, title))
}

fn ids(traces: &Bound<'_, PyAny>) -> PyResult<String> {
    let id = |trace: PyResult<Bound<'_, PyAny>>| Ok(trace?.getattr("id")?.str()?.to_string());
    Ok(traces.try_iter()?.map(id).collect::<PyResult<Vec<_>>>()?.join(", "))
}

/// A Record that is asked for, as `record`, or the path of its file.
pub struct RecordArgument(pub Py<PyRecord>);

pub fn no_record(value: &Bound<'_, PyAny>) -> PyErr {
    let needed = "is no Record and no path of a file: Record(time, a_g) makes one";
    PyTypeError::new_err(format!("record = {value:?} {needed}"))
}

impl<'a, 'py> FromPyObject<'a, 'py> for RecordArgument {
    type Error = PyErr;

    fn extract(value: Borrowed<'a, 'py, PyAny>) -> PyResult<RecordArgument> {
        if let Ok(of) = value.cast::<PyRecord>() {
            return Ok(RecordArgument(of.to_owned().unbind()));
        }
        let (py, path) = (value.py(), value.extract().map_err(|_| no_record(&value))?);
        Ok(RecordArgument(Py::new(py, PyRecord::read(py, path, None, None, None, None, None, false, 1.0, 1.0)?)?))
    }
}

#[pymethods]
impl PyRecord {
    /// The layouts of files that read() reads.
    #[classattr]
    const LAYOUTS: &str = rocking_records::LAYOUTS;

    #[new]
    #[pyo3(signature = (time, a_g=None, a_v=None, *, unit=None, time_scale=1.0, scale=1.0, title=None))]
    fn of_arrays(
        py: Python<'_>,
        time: &Bound<'_, PyAny>,
        a_g: Option<&Bound<'_, PyAny>>,
        a_v: Option<&Bound<'_, PyAny>>,
        unit: Option<&Bound<'_, PyAny>>,
        #[pyo3(from_py_with = argument::time_scale)] time_scale: f64,
        #[pyo3(from_py_with = argument::scale)] scale: f64,
        title: Option<&str>,
    ) -> PyResult<PyRecord> {
        let unit = unit.map(self::unit).transpose()?;
        let (time, a_g, unit, name) = match a_g {
            Some(a_g) => (time.clone(), a_g.clone(), unit.unwrap_or(Unit::MetrePerSecondSquared), "record".into()),
            None if time.hasattr("index")? && time.hasattr("to_numpy")? => {
                let name = time.getattr("name")?;
                let name = if name.is_none() { "record".to_owned() } else { name.str()?.to_string() };
                (time.getattr("index")?, time.clone(), unit.unwrap_or(Unit::MetrePerSecondSquared), name)
            }
            None => of_trace(time, unit)?,
        };
        let title = title.unwrap_or(&name);
        let a_v = a_v.map(|a_v| (time.clone(), a_v.clone()));
        let record = PyRecord::_of(&time, &a_g, a_v, unit, scale, title, None)?.scaled(1.0, time_scale)?;
        warn(py, doubts(&record.usual, G).into_iter().map(|doubt| format!("{title}: {doubt}")), 1)?;
        Ok(record)
    }

    /// Makes a record from a pickle, without warnings. a_v comes with its own times: one component may end before the other.
    #[staticmethod]
    fn _of(
        time: &Bound<'_, PyAny>,
        a_g: &Bound<'_, PyAny>,
        a_v: Option<(Bound<'_, PyAny>, Bound<'_, PyAny>)>,
        #[pyo3(from_py_with = unit)] unit: Unit,
        scale: f64,
        title: &str,
        force: Option<[Vec<f64>; 2]>,
    ) -> PyResult<PyRecord> {
        let component = |time: &Bound<'_, PyAny>, name, samples: &Bound<'_, PyAny>| {
            let samples = numbers(name, samples)?;
            let times: Vec<f64> = match number("dt", time) {
                Ok(dt) if dt > 0.0 && dt.is_finite() => (0..samples.len()).map(|i| i as f64 * dt).collect(),
                Ok(dt) => reject!("dt = {dt} is out of range: a finite number greater than 0 is needed"),
                Err(_) => numbers("time", time)?,
            };
            Record::from_samples(title, times, samples).map_err(refused)
        };
        let mut samples = component(time, "a_g", a_g)?;
        if let Some((time, a_v)) = a_v {
            samples = samples.with_vertical(&component(&time, "a_v", &a_v)?).map_err(refused)?;
        }
        let (given, unit) = fixed(samples, [unit; 2])?;
        PyRecord::new(given, force, unit, 1.0)?.scaled(scale, 1.0)
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<(Bound<'py, PyAny>, RecordParts<'py>)> {
        let (of, array) = (slf.get(), |of: &[f64]| PyArray1::from_slice(slf.py(), of));
        let timed = |component: &[f64]| (array(&of.given.times()[..component.len()]), array(component));
        let (unit, title) = (of.unit.to_string(), of.title().to_owned());
        let ((times, a_g), a_v) = (timed(of.given.acceleration()), of.given.vertical().map(timed));
        Ok((slf.getattr("_of")?, (times, a_g, a_v, unit, of.scale, title, of.force.clone())))
    }

    /// Reads the record in `file`, in one of the layouts Record.LAYOUTS, known by its content.
    ///
    /// The options replace statements that the file lacks: unit (of the accelerations), dt (s between samples), column (a
    /// number from 1, a heading, or "all"). unit overrides a heading. ignore_npts reads all samples, even if the file states
    /// another number. record_v: the file of the vertical component, read by the same options, column_v: its column,
    /// in `file` without record_v. time_scale and scale multiply. A Python warning names an
    /// assumption about the file, or a likely fault. Raises ValueError with the line and what would help.
    #[staticmethod]
    #[pyo3(signature = (file, *, record_v=None, unit=None, dt=None, column=None, column_v=None, ignore_npts=false, time_scale=1.0, scale=1.0))]
    fn read(
        py: Python<'_>,
        file: PathBuf,
        record_v: Option<PathBuf>,
        unit: Option<&Bound<'_, PyAny>>,
        dt: Option<&Bound<'_, PyAny>>,
        column: Option<Bound<'_, PyAny>>,
        column_v: Option<Bound<'_, PyAny>>,
        ignore_npts: bool,
        #[pyo3(from_py_with = argument::time_scale)] time_scale: f64,
        #[pyo3(from_py_with = argument::scale)] scale: f64,
    ) -> PyResult<PyRecord> {
        let unit = unit.map(self::unit).transpose()?;
        let dt = dt.map(|dt| number("dt", dt)).transpose()?;
        let named = |column: Bound<'_, PyAny>| -> PyResult<_> { Ok(Column::from(column.str()?.to_str()?)) };
        let [column, column_v] = [column, column_v].map(|column| column.map(named).transpose());
        let (column, column_v) = (column?, column_v?);
        let record_v = record_v.or_else(|| column_v.is_some().then(|| file.clone()));
        let read = |file: PathBuf, column: Option<Column>| -> PyResult<Understood> {
            let how = Reading { unit, dt, column, ignores_count: ignore_npts };
            let understood =
                interruptible(py, move |_| understand(&file, &how, [time_scale, scale], G, str::to_owned))?;
            warn(py, understood.sentences[1..].iter().cloned(), 1)?;
            Ok(understood)
        };
        let mut understood = read(file, column.clone())?;
        if let Some(record_v) = record_v {
            let up = read(record_v, column_v.or(column))?;
            understood = understood.with_vertical(up, G, "column_v").map_err(refused)?;
        }
        let (given, unit) = fixed(understood.in_file_unit, understood.units)?;
        PyRecord::new(given, None, unit, 1.0)?.scaled(scale, time_scale)
    }

    /// Times of the samples, s: an array (n,), a copy.
    #[getter]
    fn time<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, self.usual.times())
    }

    /// Horizontal ground accelerations of the samples, m/s2: an array (n,), a copy.
    #[getter]
    fn a_g<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.at_all_times(py, self.usual.acceleration())
    }

    /// Vertical ground accelerations of the samples, m/s2, positive upwards: an array (n,), a copy; None without them.
    #[getter]
    fn a_v<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        self.usual.vertical().map(|a_v| self.at_all_times(py, a_v))
    }

    /// Horizontal forces on the top floor at the samples, N, to the right: an array (n,), a copy; None without them.
    #[getter]
    fn F_t<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        self.usual.force().map(|F_t| self.at_all_times(py, F_t))
    }

    /// Title of the record.
    #[getter]
    pub fn title(&self) -> &str {
        self.usual.title()
    }

    /// Peak ground acceleration, m/s2.
    #[getter]
    fn pga(&self) -> f64 {
        self.usual.pga()
    }

    /// Peak ground velocity, m/s.
    #[getter]
    fn pgv(&self) -> f64 {
        peak_velocity(&self.usual)
    }

    /// Time from the first sample to the last, s.
    #[getter]
    fn duration(&self) -> f64 {
        self.usual.end() - self.usual.start()
    }

    /// This ground motion with the horizontal force F_t (N, to the right) on the top floor at `time` (s): arrays of one shape (n,),
    /// n >= 2, from the start of the record on; linear between them, and 0 after the last one.
    ///
    /// The samples are then at the times of both. A sweep and `scaled` multiply accelerations, not the force. Raises ValueError for other
    /// shapes, NaN and infinity, times that do not increase, and another start. A structure without floors cannot be pushed.
    fn with_force(&self, time: &Bound<'_, PyAny>, F_t: &Bound<'_, PyAny>) -> PyResult<PyRecord> {
        let force = [numbers("time", time)?, numbers("F_t", F_t)?];
        PyRecord::new(self.given.clone(), Some(force), self.unit, self.scale)
    }

    /// This ground motion with its times multiplied by time_scale, its accelerations by scale.
    #[pyo3(signature = (scale=1.0, *, time_scale=1.0))]
    fn scaled(
        &self,
        #[pyo3(from_py_with = argument::scale)] scale: f64,
        #[pyo3(from_py_with = argument::time_scale)] time_scale: f64,
    ) -> PyResult<PyRecord> {
        Record::clone(&self.usual).scaled(time_scale, scale).map_err(refused)?;
        let given = self.given.clone().scaled(time_scale, 1.0).map_err(refused)?;
        let later = |[times, F_t]: &[Vec<f64>; 2]| [times.iter().map(|time| time * time_scale).collect(), F_t.clone()];
        PyRecord::new(given, self.force.as_ref().map(later), self.unit, self.scale * scale)
    }

    /// Absolute spectral accelerations S_a, m/s2, at `periods` (s), with the damping ratio zeta: a number, or of an array (n,) an
    /// array (n,).
    #[pyo3(signature = (periods, zeta=0.05))]
    fn spectrum<'py>(
        &self,
        py: Python<'py>,
        periods: &Bound<'py, PyAny>,
        #[pyo3(from_py_with = argument::zeta)] zeta: f64,
    ) -> PyResult<Bound<'py, PyAny>> {
        let is_one = number("periods", periods).is_ok();
        let (record, periods) = (Arc::clone(&self.usual), numbers("periods", periods)?);
        let spectrum = interruptible(py, move |abandoned| {
            response_spectrum::spectrum(&record, periods.into_iter().inspect(|_| abandoned.check()).map(|T| (T, zeta)))
        })?;
        Ok(if is_one { spectrum[0].into_pyobject(py)?.into_any() } else { PyArray1::from_vec(py, spectrum).into_any() })
    }

    /// Draws the accelerations over time with matplotlib, in g, and returns the figure.
    fn plot<'py>(slf: Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("flexible_rocking._results")?.call_method1("plot_record", (&slf,))
    }

    /// Writes the record to `file` as a table that is read without options: the title, time[s], a_g in its unit, all digits; likewise the
    /// vertical component, if there is one, to the file `record_v`. `read` makes it again to the same bits.
    #[pyo3(signature = (file, *, record_v=None))]
    fn write(&self, file: PathBuf, record_v: Option<PathBuf>) -> PyResult<()> {
        let write = || -> anyhow::Result<()> {
            let (paths, mut tables) = ([Some(&file), record_v.as_ref()].into_iter().flatten(), self.tables()?);
            ensure!(
                paths.clone().count() >= tables.len(),
                "the record has a vertical component: give its file as record_v"
            );
            ensure!(paths.clone().count() <= tables.len(), "the record has no vertical component: leave record_v out");
            tables[0].insert_str(0, &format!("{TITLE}{}\n", self.title().replace(['\r', '\n'], " ")));
            let mut files = OutputFiles::default();
            let files = paths.map(|path| files.create(path)).collect::<Result<Vec<_>, _>>()?;
            files.into_iter().zip(tables).try_for_each(|(file, table)| file.write(table.as_bytes()))
        };
        write().map_err(refused)
    }

    fn __len__(&self) -> usize {
        self.usual.times().len()
    }

    fn __repr__(&self) -> String {
        let (samples, pga) = (self.usual.times().len(), self.usual.pga());
        format!("<Record {:?}: {samples} samples, {} s, peak {pga:.4} m/s2>", self.title(), self.duration())
    }

    pub fn __hash__(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        (self.title(), self.usual.times().len(), (self.given.pga() * self.scale).to_bits()).hash(&mut hasher);
        hasher.finish()
    }
}

type RecordParts<'py> =
    (Array<'py>, Array<'py>, Option<(Array<'py>, Array<'py>)>, String, f64, String, Option<[Vec<f64>; 2]>);
type Array<'py> = Bound<'py, PyArray1<f64>>;

/// The pulse of this shape as a Record: "half_sine", "sine", "cosine", "ricker", "antisymmetric_ricker",
/// "mavroeidis_papageorgiou".
///
/// amplitude a_p in g, frequency in Hz. With a structure, amplitude is in g tan(alpha_cg), and frequency is the circular one
/// in p_l. cycles: periods of a sine or cosine (1), gamma of mavroeidis_papageorgiou (2). phase in rad, g in m/s2. error: the
/// largest distance of the straight lines from the curve, as a fraction of the amplitude. A peak above 5 g
/// warns. Raises ValueError for a pulse that cannot be.
#[pyfunction]
#[pyo3(signature = (shape, *, amplitude, frequency, cycles=None, phase=0.0, error=DEFAULT_ERROR, structure=None, g=G))]
#[pyo3(
    text_signature = "(shape, *, amplitude, frequency, cycles=None, phase=0.0, error=0.0001, structure=None, g=9.81)"
)]
pub fn pulse(
    py: Python<'_>,
    shape: &Bound<'_, PyAny>,
    #[pyo3(from_py_with = argument::amplitude)] amplitude: f64,
    #[pyo3(from_py_with = argument::frequency)] frequency: f64,
    cycles: Option<&Bound<'_, PyAny>>,
    #[pyo3(from_py_with = argument::phase)] phase: f64,
    #[pyo3(from_py_with = argument::error)] error: f64,
    structure: Option<&PyStructure>,
    #[pyo3(from_py_with = argument::g)] g: f64,
) -> PyResult<PyRecord> {
    let shape = one_of("shape", shape, Shape::ALL.map(|of| (of.name(), of)))?;
    let (of_amplitude, of_frequency) = match structure {
        Some(structure) => units_of(structure.of.base()),
        None => (g, 1.0),
    };
    let pulse = Pulse::new(shape, amplitude * of_amplitude, frequency * of_frequency);
    let cycles = cycles.map_or(Ok(pulse.cycles), |cycles| number("cycles", cycles))?;
    let pulse = Pulse { cycles, phase, error, ..pulse };
    let record = pulse.record().map_err(refused)?;
    let g = structure.map_or(g, |structure| structure.of.base().g);
    warn(py, doubt_of_peak(&record, g).map(|doubt| format!("{}: {doubt}", record.title())), 1)?;
    PyRecord::in_si(record)
}
