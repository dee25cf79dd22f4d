//! `simulate` and `Run`: one structure under one ground motion.

use crate::arguments::{argument, conditions, numbers, refused, reject, response, result};
use crate::interruptible::interruptible;
use crate::record::{PyRecord, RecordArgument};
use crate::structure::{self, PyStructure};
use numpy::PyArray1;
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};
use rocking::engine::{DEFAULT_TOLERANCE, motion::Work};
use rocking::mechanics::shown::{Legend, Place, in_pictures};
use rocking::mechanics::state::INITIAL_VALUES;
use rocking::run::validity::Limits;
use rocking::{Detail, Output, Phase};
use rocking_report::quantities::PrintedNumber;
use rocking_report::run::{Event, NamedPeak, OF_FLOOR, RunReport, RunSetup, SampledMotion, SureDigits, usual_periods};
use rocking_report::validity::{Beyond, rows};
use rocking_sweep::plan::Conditions;

/// A structure that has been followed through a ground motion: what `simulate` returns.
///
/// print(run) shows all of it; in a notebook a run is its animated view. A run stores its inputs and results, but not the
/// motion. `at`, `plot`, `page` and `validity` compute the motion again, to the same bits, in about a millisecond. A pickle
/// has the structure and the record, and runs again. Two runs with the same inputs are equal.
#[pyclass(frozen, name = "Run", module = "flexible_rocking")]
pub struct PyRun {
    /// The structure.
    #[pyo3(get)]
    structure: Py<PyStructure>,
    /// The ground motion; of free vibration, ground at rest.
    #[pyo3(get)]
    record: Py<PyRecord>,
    of: RunSetup,
    found: RunReport,
    /// The level of detail.
    #[pyo3(get)]
    detail: &'static str,
    /// Whether the structure overturned (|theta| = pi/2). None if the structure still rocks 100/p_l after the record.
    #[pyo3(get)]
    overturned: Option<bool>,
    /// Ending of the run: "at rest", "overturned", "at time", "still rocking".
    #[pyo3(get)]
    ending: String,
    /// Start of the run, s.
    #[pyo3(get)]
    start: f64,
    /// End of the run, s.
    #[pyo3(get)]
    end: f64,
    /// Start of the fall, s: |theta| passes the angle of no return for the last time. None if the structure does not fall.
    #[pyo3(get)]
    fall: Option<f64>,
    /// Number of steps of the run.
    #[pyo3(get)]
    steps: u64,
    /// Number of right-hand-side evaluations of the run.
    #[pyo3(get)]
    evaluations: u64,
}

#[pymethods]
impl PyRun {
    /// The relative tolerance.
    #[getter]
    fn tolerance(&self) -> f64 {
        self.of.conditions.tolerance
    }

    /// The exact largest magnitudes by name, each a Peak (a float with unit and time): a_g (m/s2) and the outputs that have a peak, such as
    /// theta (rad), V_t (N) and the forces of ties (N); of many masses of each floor or storey from 1 on, such as a_t[1] (m/s2). The page
    /// of variables has them all.
    /// If the structure overturns, the peaks are those before its fall.
    #[getter]
    fn peaks<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let named = PyDict::new(py);
        for NamedPeak { name, magnitude, unit, time, digits } in &self.found.peaks {
            named.set_item(name, result(py, "Peak", (*magnitude, *time, *unit, *digits))?)?;
        }
        Ok(named)
    }

    /// How sure the results are, a Condition; None without condition=True. The sure digits of each peak are its `digits`.
    #[getter]
    fn condition<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        let of = |SureDigits { digits, overturning_digits, overturning_change }| {
            result(py, "Condition", (digits, overturning_digits, overturning_change))
        };
        self.found.sure.map(of).transpose()
    }

    /// What is left at the end on ground that slips and yields, by name. With mu_c: x_end (m), slip_path (m), E_friction (J); with fs or
    /// q_u: theta_res (rad) and settlement_res (m) at rest on the settled ground, tilt (rad), settled (m), E_plastic (J). NaN: no rest.
    #[getter]
    fn residuals<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.found.residuals.iter().map(|of| (&*of.name, of.value)).into_py_dict(py)
    }

    /// Every transition in the order of time, each a Transition: a list, with to_pandas().
    #[getter]
    fn transitions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let units = self.of.components();
        let transition = |Event { time, kind, states }: &Event| {
            let named = |values| units.iter().map(|(name, _)| name).zip(values).into_py_dict(py);
            let [before, after] = states.each_ref().map(named);
            result(py, "Transition", (*time, kind.name(), before?, after?))
        };
        let transitions = self.found.events.iter().map(transition).collect::<PyResult<Vec<_>>>()?;
        result(py, "Transitions", (transitions, units.into_py_dict(py)?))
    }

    /// How far the run exceeds the assumptions of the model, exact, each a Worst, within the usual limits. Names:
    /// tension_max, R_v_min, mu_required, mu_impact, tension_impact, energy_gain_max, weight_min.
    #[getter]
    fn validity(slf: Py<Self>, py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
        PyRun::validity_within(slf, py, None, None, None, None)
    }

    /// The same as `validity` within limits of your own, each at least 0, or None for the usual one. friction: coefficient.
    /// tension and edge_load: as fractions of the weight, at an impact of its impulse. energy_gain: as a fraction of the
    /// kinetic energy before an impact.
    #[pyo3(signature = (*, friction=None, tension=None, edge_load=None, energy_gain=None))]
    fn validity_within(
        slf: Py<Self>,
        py: Python<'_>,
        friction: Option<f64>,
        tension: Option<f64>,
        edge_load: Option<f64>,
        energy_gain: Option<f64>,
    ) -> PyResult<Bound<'_, PyDict>> {
        let usual = Limits::default();
        let limits = Limits {
            friction: friction.unwrap_or(usual.friction),
            tension: tension.unwrap_or(usual.tension),
            edge_load: edge_load.unwrap_or(usual.edge_load),
            energy_gain: energy_gain.unwrap_or(usual.energy_gain),
        };
        limits.check().map_err(refused)?;
        let found = interruptible(py, move |abandoned| slf.get().of.validity(limits, abandoned))?;
        let named = PyDict::new(py);
        for Beyond { name, value: PrintedNumber(value), time, limit, first_beyond, beyond } in rows(&found, &limits) {
            named.set_item(name, result(py, "Worst", (value, time, limit, first_beyond, beyond))?)?;
        }
        Ok(named)
    }

    /// The motion at `times` (s), a number or an array (n,) in any order: a Response. A Response is a dict of arrays (n,) by
    /// the names of the FMU's outputs: time, a_g, theta, u, a_t, V_t, M_t, ..., phase, transitions. Many masses have u[1], a_t[1],
    /// ... of each floor. to_pandas() makes it a table.
    ///
    /// Exact: the engine's own polynomials and flows are evaluated, nothing is interpolated. The values at a transition are
    /// the values just after it. After the end of the run the ground is at rest and the motion continues. After overturning
    /// all values are NaN. Raises ValueError for times before the start of the run, and NaN.
    fn at<'py>(slf: Py<Self>, py: Python<'py>, times: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let times = numbers("times", times)?;
        let start = slf.get().found.start;
        if let Some(i) = times.iter().position(|time| !(*time >= start && time.is_finite())) {
            let needed = format!("a finite time from the start of the run on, {start} s, is needed");
            reject!("times[{i}] = {} s is out of range: {needed}", times[i]);
        }
        let SampledMotion { columns, phases, transitions } = {
            let slf = slf.clone_ref(py);
            interruptible(py, move |abandoned| slf.get().of.at(&slf.get().found, &times, abandoned))?
        };
        let response = PyDict::new(py);
        let units = PyDict::new(py);
        for ((name, unit), column) in slf.get().of.columns().into_iter().zip(columns) {
            response.set_item(&name, PyArray1::from_vec(py, column))?;
            units.set_item(name, unit)?;
        }
        let names = py.import("numpy")?.call_method1("array", (Phase::SHOWN.map(Phase::name).to_vec(),))?;
        response.set_item("phase", names.get_item(PyArray1::from_vec(py, phases))?)?;
        response.set_item("transitions", PyArray1::from_vec(py, transitions))?;
        result(py, "Response", (response, units))
    }

    /// The peaks of each floor, and of the storey below the floor: a Profile, which is a dict of arrays (floors,) from below. Names:
    /// floor (from 1 on), h (m), u, drift, delta_t (m), a_t (m/s2), V (N), M (N.m, at the foot of the storey). One mass is a floor.
    /// to_pandas() makes it a table.
    #[getter]
    fn profile<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let (rows, profile, units) = (self.of.floors(&self.found), PyDict::new(py), PyDict::new(py));
        profile.set_item("floor", PyArray1::from_iter(py, 1..=rows.len() as u64))?;
        units.set_item("floor", "1")?;
        for (i, (name, unit)) in OF_FLOOR.into_iter().enumerate() {
            profile.set_item(name, PyArray1::from_iter(py, rows.iter().map(|row| row[i])))?;
            units.set_item(name, unit)?;
        }
        result(py, "Profile", (profile, units))
    }

    /// The response spectrum of the acceleration a_t of a floor (from 1 on; one mass is floor 1) until the run ends or the
    /// structure falls. Returns a Response, a dict of arrays (n,): period (s) and S_a (m/s2), the largest absolute acceleration of an oscillator
    /// of the damping ratio zeta on the floor. periods: numbers (s), by default 100 from 0.02 to 4 s.
    ///
    /// The peaks are exact: nothing is sampled. Raises ValueError for a floor that the structure does not have.
    #[pyo3(signature = (floor, periods=None, zeta=0.05))]
    fn spectrum<'py>(
        slf: Py<Self>,
        py: Python<'py>,
        #[pyo3(from_py_with = argument::floor)] floor: i64,
        periods: Option<&Bound<'py, PyAny>>,
        #[pyo3(from_py_with = argument::zeta)] zeta: f64,
    ) -> PyResult<Bound<'py, PyAny>> {
        let floors = slf.get().of.floors(&slf.get().found).len();
        let Some(below) =
            floor.checked_sub(1).and_then(|floor| usize::try_from(floor).ok()).filter(|below| *below < floors)
        else {
            let has = match floors {
                0 => "no floors; give masses, heights and shapes".to_owned(),
                1 => "floor 1 alone".to_owned(),
                floors => format!("floors 1 to {floors}"),
            };
            reject!("floor = {floor} is out of range: the structure has {has}");
        };
        let periods = periods.map_or_else(|| Ok(usual_periods()), |periods| numbers("periods", periods))?;
        let period = periods.clone();
        let spectra = interruptible(py, move |abandoned| {
            let PyRun { of, found, .. } = slf.get();
            of.spectra(found, &[below], &periods, zeta, abandoned)
        })?;
        response(py, [("period", "s", period), ("S_a", "m/s2", spectra.concat())])
    }

    /// Draws the run with matplotlib and returns the figure. "history": a_g, theta, u and a_t over time, with marks at
    /// transitions; of many masses u and a_t of the top floor. "profile": the largest acceleration, drift, shear and moment of each
    /// floor and storey over the height, and the same on a fixed base. Accelerations are in g, lengths in mm, forces in kN. Needs matplotlib.
    #[pyo3(signature = (kind="history"))]
    fn plot<'py>(slf: Bound<'py, Self>, kind: &str) -> PyResult<Bound<'py, PyAny>> {
        let of = &slf.get().of;
        let history = |(name, Legend { symbol, .. }, (size, unit)): (String, Legend, (f64, &str))| {
            let symbol = symbol.split_once('_').map_or(symbol.into(), |(of, below)| format!("{of}_{{{below}}}"));
            let label = format!("${symbol}${} ({unit})", &name[name.find('[').unwrap_or(name.len())..]);
            (name, label, size)
        };
        let histories = of.histories(Place::Histories).into_iter().map(history);
        let height = |(output, place): (Output, Place)| {
            let (label, (size, unit)) = (output.legend()?.label, in_pictures(output.unit(), of.structure.base().g));
            Some((format!("{place:?}"), output.symbol(), format!("{label} ({unit})"), size))
        };
        let axes = (Vec::from_iter(histories), Vec::from_iter(Output::over_height().filter_map(height)));
        slf.py().import("flexible_rocking._results")?.call_method1("plot_run", (&slf, kind, axes.0, axes.1))
    }

    /// The page that shows the structure in motion over its histories, HTML for any browser.
    fn page(slf: Py<Self>, py: Python<'_>) -> PyResult<String> {
        interruptible(py, move |_| slf.get().of.page())
    }

    fn _repr_html_(slf: Py<Self>, py: Python<'_>) -> PyResult<String> {
        let page = PyRun::page(slf, py)?.replace('&', "&amp;").replace('"', "&quot;");
        Ok(format!("<iframe srcdoc=\"{page}\" style=\"width: 100%; height: 640px; border: 0\"></iframe>"))
    }

    fn __repr__(&self) -> String {
        let (title, end, transitions) = (self.record.get().title(), self.end, self.found.transitions);
        format!("<Run under {title:?}: {} at {end} s, {transitions} transitions>", self.ending)
    }

    fn __str__(slf: Py<Self>, py: Python<'_>) -> PyResult<String> {
        interruptible(py, move |abandoned| -> anyhow::Result<_> {
            let (PyRun { of, found, .. }, limits) = (slf.get(), Limits::default());
            let mut found = found.clone();
            found.findings = Some(of.validity(limits, abandoned)?);
            Ok(format!("{}\n{}", of.ground.title(), of.text(&found, &limits)?))
        })
    }

    /// Whether both have the same inputs, and therefore the same results.
    fn __eq__(&self, other: &PyRun) -> bool {
        let are_same = self.structure.get() == other.structure.get() && self.of.ground == other.of.ground;
        are_same && self.of.conditions == other.of.conditions
    }

    fn __hash__(&self) -> u64 {
        self.structure.get().__hash__() ^ self.of.ground.pga().to_bits()
    }

    /// A pickle is the call of `simulate`.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, ())> {
        let asked = PyDict::new(py);
        let Conditions { initial, detail, tolerance, duration, finds_condition } = &self.of.conditions;
        asked.set_item("duration", duration)?;
        asked.set_item("detail", detail.name())?;
        asked.set_item("tolerance", tolerance)?;
        asked.set_item("condition", finds_condition)?;
        for (of, numbers) in INITIAL_VALUES.iter().zip(initial.numbers()).filter(|(_, numbers)| !numbers.is_empty()) {
            let is_one = numbers.len() == 1;
            if is_one { asked.set_item(of.name, numbers[0]) } else { asked.set_item(of.name, numbers) }?;
        }
        let simulate = py.import("flexible_rocking")?.getattr("simulate")?;
        let scene = (simulate, &self.structure, &self.record);
        Ok((py.import("functools")?.getattr("partial")?.call(scene, Some(&asked))?, ()))
    }
}

/// Follows a structure through a ground motion, or in free vibration, exactly, and returns the Run.
///
/// record: a Record, whose with_force also pushes the top floor; without one the ground is at rest for `duration`. The structure starts at rest in full contact unless
/// initial values are given: theta_0 (rad), theta_dot_0 (rad/s), u_0 (m), u_dot_0 (m/s). Of many masses u_0 and u_dot_0 have
/// a number for each floor from below, as u[1], u[2], ... and u_dot[1], ... of a Response. duration (s): the length of the run.
/// Without a duration, the run ends when the base is down for good or the structure overturns, at the latest 100/p_l after
/// the record. detail: "auto", "nonlinear" (Eqs 1, 5, 6), "linear" (Eqs 1, 7, 8), "modal" (Eqs 1, 11, 18), "rigid" (Eq 6 with
/// u = 0), "fixed_base" (Eq 1). tolerance: relative, of the results. condition: whether 27 more runs find how many digits are sure. Many masses move at every level
/// but "modal".
///
/// Overturning is a result, not an error. Raises ValueError where the run cannot begin, or not go on. Other threads of
/// Python go on meanwhile; the same inputs give the same bits.
#[pyfunction]
#[pyo3(signature = (structure, record=None, *, duration=None, detail=Detail::Auto, tolerance=DEFAULT_TOLERANCE, condition=false, **initial))]
#[pyo3(
    text_signature = "(structure, record=None, *, duration=None, detail='auto', tolerance=1e-09, condition=False, **initial)"
)]
pub fn simulate(
    py: Python<'_>,
    #[pyo3(from_py_with = structure::argument)] structure: Py<PyStructure>,
    record: Option<RecordArgument>,
    duration: Option<&Bound<'_, PyAny>>,
    #[pyo3(from_py_with = argument::detail)] detail: Detail,
    #[pyo3(from_py_with = argument::tolerance)] tolerance: f64,
    condition: bool,
    initial: Option<&Bound<'_, PyDict>>,
) -> PyResult<PyRun> {
    let conditions = Conditions { finds_condition: condition, ..conditions(detail, tolerance, duration, initial)? };
    conditions.check(&structure.get().of).map_err(refused)?;
    let record = match (record, conditions.duration) {
        (Some(RecordArgument(record)), _) => record,
        (None, Some(duration)) => Py::new(py, PyRecord::in_si(rocking::run::record::Record::at_rest(duration))?)?,
        (None, None) => reject!("record and duration are missing: free vibration needs a duration"),
    };
    let ground = record.get().under(structure.get().of.base().g);
    let of = RunSetup { structure: structure.get().of.clone(), ground, conditions };
    let (of, found) = interruptible(py, move |abandoned| of.found(None, abandoned).map(|found| (of, found)))?;
    let (&RunReport { overturned, start, end, fall, work, .. }, ending) = (&found, found.ending.to_string());
    let (detail, Work { steps, evaluations }) = (detail.name(), work);
    Ok(PyRun { structure, record, of, found, detail, overturned, ending, start, end, fall, steps, evaluations })
}
