//! `Record`: a ground motion from arrays, a file or a formula.

use crate::arguments::{number, numbers, one_of, refused};
use crate::structure::Structure;
use numpy::PyArray1;
use pyo3::exceptions::{PyUserWarning, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyFloat, PyInt};
use rocking::estimates::intensity::peak_velocity;
use rocking::estimates::response_spectrum::spectrum;
use rocking_cli::output_files::OutputFiles;
use rocking_cli::record_args::RecordOptions;
use rocking_records::{Column, Unit, csv};
use rocking_sweep::pulse::{DEFAULT_ERROR, Pulse, Shape, units_of};
use std::ffi::CString;
use std::path::PathBuf;

/// A ground motion: the acceleration of the ground at two instants or more, linear between them.
///
/// Record(time, a_g): arrays of one shape (n,), n >= 2, time in s, strictly increasing; a_g, horizontal, in `unit`.
/// Record(dt, a_g): samples every dt seconds from 0 on.
/// Record(time, a_g, a_v): with the vertical component, positive upwards, of the same shape and unit.
/// Record.read(file): a file as the archives publish it.
///
/// unit: "m/s2" (default), "g", "cm/s2", "gal", "mm/s2", "in/s2", "ft/s2", "mg", "%g"; g (m/s2) is what a unit of g
/// stands for. time_scale multiplies the times, scale the accelerations; title is what it is called in tables. The
/// samples are copied once, into the record. Raises ValueError for other shapes, NaN and infinity, and times that do
/// not increase.
#[pyclass(frozen, module = "flexible_rocking")]
pub struct Record(pub rocking::run::record::Record);

fn unit(name: &str) -> PyResult<Unit> {
    one_of("unit", name, Unit::NAMES)
}

#[pymethods]
impl Record {
    #[new]
    #[pyo3(signature = (time, a_g, a_v=None, *, unit="m/s2", g=9.81, time_scale=1.0, scale=1.0, title="record"))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn new(
        time: &Bound<'_, PyAny>,
        a_g: &Bound<'_, PyAny>,
        a_v: Option<&Bound<'_, PyAny>>,
        unit: &str,
        g: f64,
        time_scale: f64,
        scale: f64,
        title: &str,
    ) -> PyResult<Record> {
        let a_g = numbers("a_g", a_g)?;
        let times: Vec<f64> = if time.is_instance_of::<PyFloat>() || time.is_instance_of::<PyInt>() {
            let dt = number("dt", time)?;
            if !(dt > 0.0 && dt.is_finite()) {
                let needed = "a finite number greater than 0 is needed";
                return Err(PyValueError::new_err(format!("dt = {dt} is out of range: {needed}")));
            }
            (0..a_g.len()).map(|i| i as f64 * dt).collect()
        } else {
            numbers("time", time)?
        };
        let per_unit = self::unit(unit)?.in_m_s2(g);
        let component =
            |samples| rocking::run::record::Record::from_samples(title, times.clone(), samples).map_err(refused);
        let mut record = component(a_g)?;
        if let Some(a_v) = a_v {
            record = record.with_vertical(&component(numbers("a_v", a_v)?)?).map_err(refused)?;
        }
        record.multiplied(per_unit).scaled(time_scale, scale).map(Record).map_err(refused)
    }

    /// Reads the record in `file`: PEER .AT2, ESM and ITACA, K-NET, COSMOS, CSMIP, or a table of text, known by its
    /// content.
    ///
    /// What the file does not state is said by unit (of its accelerations), dt (s between samples), column (a number
    /// from 1, a heading, or "all"), ignore_npts (take the samples that are there). vertical is the file of the vertical
    /// component, read by the same options. time_scale and scale multiply; g (m/s2) is what a record's g stands for. What is
    /// likely wrong with it is a warning. Raises ValueError with the line and what would help.
    #[staticmethod]
    #[pyo3(signature = (file, *, vertical=None, unit=None, dt=None, column=None, ignore_npts=false, time_scale=1.0, scale=1.0, g=9.81))]
    #[expect(clippy::too_many_arguments, reason = "keywords of Python")]
    fn read(
        py: Python<'_>,
        file: PathBuf,
        vertical: Option<PathBuf>,
        unit: Option<&str>,
        dt: Option<f64>,
        column: Option<Bound<'_, PyAny>>,
        ignore_npts: bool,
        time_scale: f64,
        scale: f64,
        g: f64,
    ) -> PyResult<Record> {
        let unit = unit.map(self::unit).transpose()?;
        let column = column.map(|column| -> PyResult<_> { Ok(Column::from(column.str()?.to_str()?)) }).transpose()?;
        let (time_scale, scale) = (Some(time_scale), Some(scale));
        let options = RecordOptions { unit, dt, column, ignore_npts, time_scale, scale };
        let read = |file: PathBuf| -> PyResult<rocking::run::record::Record> {
            let understood = py.detach(|| options.understand(&file, g)).map_err(refused)?;
            for warning in &understood.sentences[1..] {
                PyErr::warn(py, &py.get_type::<PyUserWarning>(), &CString::new(warning.as_str())?, 2)?;
            }
            Ok(understood.record)
        };
        let record = read(file)?;
        let Some(vertical) = vertical else { return Ok(Record(record)) };
        record.with_vertical(&read(vertical)?).map(Record).map_err(refused)
    }

    /// Times of the samples, s: an array (n,), a copy.
    #[getter]
    fn time<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, self.0.times())
    }

    /// Horizontal ground accelerations of the samples, m/s2: an array (n,), a copy.
    #[getter]
    fn a_g<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        PyArray1::from_slice(py, self.0.acceleration())
    }

    /// Vertical ground accelerations of the samples, m/s2, positive upwards: an array (n,), a copy; None without them.
    #[getter]
    fn a_v<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyArray1<f64>>> {
        self.0.vertical().map(|a_v| PyArray1::from_slice(py, a_v))
    }

    /// What it is called.
    #[getter]
    fn title(&self) -> &str {
        self.0.title()
    }

    /// Peak ground acceleration, m/s2.
    #[getter]
    fn pga(&self) -> f64 {
        self.0.pga()
    }

    /// Peak ground velocity, m/s.
    #[getter]
    fn pgv(&self) -> f64 {
        peak_velocity(&self.0)
    }

    /// Time from the first sample to the last, s.
    #[getter]
    fn duration(&self) -> f64 {
        self.0.end() - self.0.start()
    }

    /// This ground motion with its times multiplied by time_scale, its accelerations by scale.
    #[pyo3(signature = (scale=1.0, *, time_scale=1.0))]
    fn scaled(&self, scale: f64, time_scale: f64) -> PyResult<Record> {
        self.0.clone().scaled(time_scale, scale).map(Record).map_err(refused)
    }

    /// Absolute spectral accelerations S_a, m/s2, at `periods` (s), an array (n,), with the damping ratio zeta: an
    /// array (n,).
    #[pyo3(signature = (periods, zeta=0.05))]
    fn spectrum<'py>(
        &self,
        py: Python<'py>,
        periods: &Bound<'py, PyAny>,
        zeta: f64,
    ) -> PyResult<Bound<'py, PyArray1<f64>>> {
        let periods = numbers("periods", periods)?;
        let spectrum = py.detach(|| spectrum(&self.0, &periods, zeta)).map_err(refused)?;
        Ok(PyArray1::from_vec(py, spectrum))
    }

    /// Writes the horizontal component to `file` as a table that is read without options: time[s], a_g[m/s2], all digits.
    fn write(&self, file: PathBuf) -> PyResult<()> {
        OutputFiles::default().create(&file).and_then(|file| file.write(csv(&self.0).as_bytes())).map_err(refused)
    }

    fn __len__(&self) -> usize {
        self.0.times().len()
    }

    fn __repr__(&self) -> String {
        let (samples, pga) = (self.0.times().len(), self.0.pga());
        format!("<Record {:?}: {samples} samples, {} s, peak {pga:.4} m/s2>", self.0.title(), self.duration())
    }

    fn __eq__(&self, other: &Record) -> bool {
        self.0 == other.0
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<(Samples<'py>, Bound<'py, PyDict>)> {
        let title = PyDict::new(py);
        title.set_item("title", self.0.title())?;
        Ok(((self.time(py), self.a_g(py), self.a_v(py)), title))
    }
}

/// Times and accelerations, horizontal and vertical.
type Samples<'py> = (Bound<'py, PyArray1<f64>>, Bound<'py, PyArray1<f64>>, Option<Bound<'py, PyArray1<f64>>>);

/// The pulse of this shape as a Record: "half_sine", "sine", "cosine", "ricker", "antisymmetric_ricker",
/// "mavroeidis_papageorgiou".
///
/// amplitude a_p in g, frequency in Hz; with a structure both are in its units instead: amplitude in g tan(alpha_cg),
/// frequency in p_l, of which it is the circular one. cycles: periods of a sine or cosine (1), gamma of
/// mavroeidis_papageorgiou (2); phase in rad; error, how far its straight lines may be off the curve over the amplitude.
/// g in m/s2. Raises ValueError for a pulse that cannot be.
#[pyfunction]
#[pyo3(signature = (shape, *, amplitude, frequency, cycles=None, phase=0.0, error=DEFAULT_ERROR, structure=None, g=9.81))]
#[expect(clippy::too_many_arguments, reason = "keywords of Python")]
pub fn pulse(
    shape: &str,
    amplitude: f64,
    frequency: f64,
    cycles: Option<f64>,
    phase: f64,
    error: f64,
    structure: Option<&Structure>,
    g: f64,
) -> PyResult<Record> {
    let shape = one_of("shape", shape, Shape::ALL.map(|of| (of.name(), of)))?;
    let (of_amplitude, of_frequency) = structure.map_or((g, 1.0), |structure| units_of(&structure.0));
    let pulse = Pulse::new(shape, amplitude * of_amplitude, frequency * of_frequency);
    let pulse = Pulse { cycles: cycles.unwrap_or(pulse.cycles), phase, error, ..pulse };
    pulse.record().map(Record).map_err(refused)
}
