//! `simulate` and `Run`: one structure under one ground motion.

use crate::arguments::{conditions, numbers, refused};
use crate::record::Record;
use crate::structure::Structure;
use numpy::PyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyString};
use rocking::State;
use rocking::engine::DEFAULT_TOLERANCE;
use rocking::engine::piece::Sample;
use rocking::mechanics::state::{COMPONENTS, INITIAL_VALUES};
use rocking::run::fall::Found;
use rocking::run::peaks;
use rocking::run::validity::{ASSUMPTIONS, Limits};
use rocking::run::{End, Ending};
use rocking_report::summary::Summary;
use rocking_report::tables::{RESPONSE, response_numbers};
use rocking_report::validity;
use rocking_sweep::plan::Conditions;

/// The largest magnitude of a quantity in a run, exact between all instants: float(peak) is its value.
#[pyclass(frozen, get_all, module = "flexible_rocking")]
pub struct Peak {
    /// The magnitude, in `unit`.
    value: f64,
    /// The first instant that has it, s.
    time: f64,
    /// Its unit.
    unit: &'static str,
}

#[pymethods]
impl Peak {
    fn __float__(&self) -> f64 {
        self.value
    }

    fn __repr__(&self) -> String {
        let Peak { value, time, unit } = self;
        format!("{value} {unit} at {time} s")
    }
}

/// A transition of a run: uplift, impact, landing, settling, overturning.
#[pyclass(frozen, module = "flexible_rocking")]
pub struct Transition(rocking::Transition);

fn state<'py>(py: Python<'py>, of: &State) -> PyResult<Bound<'py, PyDict>> {
    let state = PyDict::new(py);
    COMPONENTS.iter().zip(of.components()).try_for_each(|(name, value)| state.set_item(name, value))?;
    Ok(state)
}

#[pymethods]
impl Transition {
    /// Its instant, s.
    #[getter]
    fn time(&self) -> f64 {
        self.0.time
    }

    /// "uplift left", "impact right", "landing", "settling", "overturning left", ...
    #[getter]
    fn kind(&self) -> &'static str {
        self.0.kind.name()
    }

    /// u (m), u_dot (m/s), theta (rad), theta_dot (rad/s) just before it.
    #[getter]
    fn before<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        state(py, &self.0.before)
    }

    /// The same just after it.
    #[getter]
    fn after<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        state(py, &self.0.after)
    }

    fn __repr__(&self) -> String {
        format!("{} at {} s", self.0.kind.name(), self.0.time)
    }
}

/// What a run asks for beyond one of the things that the model takes for granted.
#[pyclass(frozen, get_all, module = "flexible_rocking")]
pub struct Worst {
    /// The worst value: the largest, of R_v_min the least.
    value: f64,
    /// Its first instant, s.
    time: f64,
    /// What may be asked for without a word.
    limit: f64,
    /// When the limit was passed first, s; None if it never was.
    first_beyond: Option<f64>,
    /// For how long, s, or at how many impacts it was passed.
    beyond: f64,
}

#[pymethods]
impl Worst {
    fn __repr__(&self) -> String {
        let Worst { value, time, limit, first_beyond, .. } = self;
        let passed = first_beyond.map_or("never passed".into(), |first| format!("passed first at {first} s"));
        format!("{value} at {time} s; limit {limit}, {passed}")
    }
}

/// A structure that has been followed through a ground motion: what `simulate` returns.
///
/// print(run) shows all of it; in a notebook a run is its animated view. It keeps what it was asked for and what was
/// found, and not the motion: what `at`, `plot`, `page` and `validity` show is computed again, to the same bits, in
/// about a millisecond. So does a pickle: it carries the structure and the record.
#[pyclass(frozen, module = "flexible_rocking")]
pub struct Run {
    structure: Py<Structure>,
    record: Py<Record>,
    conditions: Conditions,
    found: Found,
    transitions: Vec<rocking::Transition>,
}

impl Run {
    /// The run of the library.
    fn run(&self) -> rocking::Run<'_> {
        self.conditions.run(self.structure.get().0, &self.record.get().0)
    }
}

#[pymethods]
impl Run {
    /// The structure.
    #[getter]
    fn structure(&self, py: Python<'_>) -> Py<Structure> {
        self.structure.clone_ref(py)
    }

    /// The ground motion; of free vibration, ground at rest.
    #[getter]
    fn record(&self, py: Python<'_>) -> Py<Record> {
        self.record.clone_ref(py)
    }

    /// The level of detail.
    #[getter]
    fn detail(&self) -> &'static str {
        self.conditions.detail.name()
    }

    /// The relative tolerance.
    #[getter]
    fn tolerance(&self) -> f64 {
        self.conditions.tolerance
    }

    /// The exact largest magnitudes by name, each a Peak: a_g (m/s2), theta (rad), u (m), delta_t (m, Eq 26), uplift
    /// (m, Eq 25), a_t (m/s2, Eq 27), V_t (N, Eqs 2, 23), M_t (N.m, Eqs 3, 24), and with a tendon its force P_t (N). Of a
    /// structure that overturns those before it falls.
    #[getter]
    fn peaks<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let named = PyDict::new(py);
        let peak = |peaks::Peak { magnitude: value, time }, unit| Peak { value, time, unit };
        named.set_item("a_g", Py::new(py, peak(self.found.ground, "m/s2"))?)?;
        for of in peaks::of(&self.structure.get().0) {
            named.set_item(of.name, Py::new(py, peak(of.of(&self.found.peaks), of.unit))?)?;
        }
        Ok(named)
    }

    /// Whether it overturned, |theta| = pi/2; None where that is not known, for it still rocks 100/p_l after the
    /// record.
    #[getter]
    fn overturned(&self) -> Option<bool> {
        self.found.finish.ending.overturned()
    }

    /// How it ended: "at rest", "overturned", "at time", "still rocking".
    #[getter]
    fn ending(&self) -> String {
        self.found.finish.ending.to_string()
    }

    /// When it began, s.
    #[getter]
    fn start(&self) -> f64 {
        self.found.start
    }

    /// When it ended, s.
    #[getter]
    fn end(&self) -> f64 {
        self.found.finish.motion.time
    }

    /// Since when it falls, s; None if it does not.
    #[getter]
    fn fall(&self) -> Option<f64> {
        self.found.fall
    }

    /// Every transition in the order of time.
    #[getter]
    fn transitions(&self) -> Vec<Transition> {
        self.transitions.iter().copied().map(Transition).collect()
    }

    /// Steps that it took.
    #[getter]
    fn steps(&self) -> u64 {
        self.found.finish.motion.work.steps
    }

    /// Right-hand-side evaluations that it took.
    #[getter]
    fn evaluations(&self) -> u64 {
        self.found.finish.motion.work.evaluations
    }

    /// What the model leaves out on this run, exact, each a Worst: tension_max, R_v_min, mu_required, mu_impact,
    /// tension_impact, energy_gain_max; within the usual limits.
    #[getter]
    fn validity<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        self.validity_within(py, None, None, None, None)
    }

    /// What the model leaves out as validity has it, within limits of your own, of at least 0, or None for the usual one:
    /// friction (coefficient), tension and edge_load (over the weight; tension at an impact, over its impulse), energy_gain
    /// (over the kinetic energy before an impact).
    #[pyo3(signature = (*, friction=None, tension=None, edge_load=None, energy_gain=None))]
    fn validity_within<'py>(
        &self,
        py: Python<'py>,
        friction: Option<f64>,
        tension: Option<f64>,
        edge_load: Option<f64>,
        energy_gain: Option<f64>,
    ) -> PyResult<Bound<'py, PyDict>> {
        let usual = Limits::default();
        let limits = Limits {
            friction: friction.unwrap_or(usual.friction),
            tension: tension.unwrap_or(usual.tension),
            edge_load: edge_load.unwrap_or(usual.edge_load),
            energy_gain: energy_gain.unwrap_or(usual.energy_gain),
        };
        limits.check().map_err(refused)?;
        let (found, _) = py.detach(|| self.run().validity(limits)).map_err(refused)?;
        let named = PyDict::new(py);
        for (assumption, worst) in ASSUMPTIONS.iter().zip(&found.worst) {
            let rocking::run::validity::Worst { value, time, first_beyond, beyond } = *worst;
            let limit = (assumption.limit)(&limits);
            named.set_item(assumption.name, Py::new(py, Worst { value, time, limit, first_beyond, beyond })?)?;
        }
        Ok(named)
    }

    /// The motion at `times` (s), an array (n,) in any order: a Response, a dict of arrays (n,) by the names of the
    /// FMU's outputs (time, a_g, theta, u, a_t, V_t, M_t, ..., phase, transitions), with to_pandas().
    ///
    /// Exact: the engine's own polynomials and flows are evaluated, nothing is interpolated. At a transition the values
    /// are those just after it. After the end of the run the motion goes on over ground at rest; once overturned there
    /// is none, and it is NaN. Raises ValueError for times before the start of the run, and NaN.
    fn at<'py>(&self, py: Python<'py>, times: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let times = numbers("times", times)?;
        let start = self.found.start;
        if let Some(i) = times.iter().position(|time| !(*time >= start && time.is_finite())) {
            let needed = format!("a finite time from the start of the run on, {start} s, is needed");
            return Err(PyValueError::new_err(format!("times[{i}] = {} s is out of range: {needed}", times[i])));
        }
        let (columns, phases, transitions) = py.detach(|| self.sample(&times)).map_err(refused)?;
        let response = PyDict::new(py);
        let units = PyDict::new(py);
        let headings = RESPONSE.map(|heading| heading.trim_end_matches(']').split_once('[').unwrap_or((heading, "1")));
        for ((name, unit), column) in headings.into_iter().zip(columns) {
            response.set_item(name, PyArray1::from_vec(py, column))?;
            units.set_item(name, unit)?;
        }
        response.set_item("phase", phases.iter().map(|phase| PyString::intern(py, phase)).collect::<Vec<_>>())?;
        response.set_item("transitions", PyArray1::from_vec(py, transitions))?;
        py.import("flexible_rocking._results")?.call_method1("Response", (response, units))
    }

    /// Draws a_g, theta, u and a_t over time with matplotlib, with marks at transitions; returns the figure.
    fn plot<'py>(slf: Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("flexible_rocking._results")?.call_method1("plot_run", (&slf,))
    }

    /// The page that shows the structure in motion over its histories, HTML for any browser.
    fn page(&self, py: Python<'_>) -> PyResult<String> {
        py.detach(|| rocking_view::page(&self.run())).map_err(refused)
    }

    fn _repr_html_(&self, py: Python<'_>) -> PyResult<String> {
        let page = self.page(py)?.replace('&', "&amp;").replace('"', "&quot;");
        Ok(format!("<iframe srcdoc=\"{page}\" style=\"width: 100%; height: 640px; border: 0\"></iframe>"))
    }

    fn __repr__(&self) -> String {
        let (title, end, transitions) = (self.record.get().0.title(), self.end(), self.transitions.len());
        format!("<Run under {title:?}: {} at {end} s, {transitions} transitions>", self.ending())
    }

    fn __str__(&self) -> PyResult<String> {
        let (run, limits) = (self.run(), Limits::default());
        let summary = Summary::new(&run.structure, &self.transitions);
        let (beyond, _) = run.validity(limits).map_err(refused)?;
        let lines = validity::section(&run.structure, run.detail, &beyond, &limits);
        Ok(format!("{}\n{}{}", run.ground.title(), summary.text(&self.found).map_err(refused)?, lines.join("\n")))
    }

    /// A pickle is the call of `simulate`.
    fn __reduce__<'py>(&self, py: Python<'py>) -> PyResult<(Bound<'py, PyAny>, ())> {
        let asked = PyDict::new(py);
        let Conditions { initial, detail, tolerance, duration } = &self.conditions;
        asked.set_item("duration", duration)?;
        asked.set_item("detail", detail.name())?;
        asked.set_item("tolerance", tolerance)?;
        INITIAL_VALUES.iter().try_for_each(|of| asked.set_item(of.name, (of.get)(initial)))?;
        let simulate = py.import("flexible_rocking")?.getattr("simulate")?;
        let scene = (simulate, self.structure(py), self.record(py));
        Ok((py.import("functools")?.getattr("partial")?.call(scene, Some(&asked))?, ()))
    }
}

/// Columns of numbers, phases, numbers of transitions.
type Samples = (Vec<Vec<f64>>, Vec<&'static str>, Vec<u64>);

impl Run {
    /// The motion at `times` (s), none of which is before the start.
    fn sample(&self, times: &[f64]) -> Result<Samples, rocking::run::RunError> {
        let mut order: Vec<usize> = (0..times.len()).collect();
        order.sort_by(|a, b| times[*a].total_cmp(&times[*b]));
        let last = order.last().map_or(self.found.start, |last| times[*last]);
        let run = match self.found.finish.ending {
            Ending::Overturned => self.run(),
            _ if last <= self.end() => self.run(),
            _ => rocking::Run { end: End::At(last), ..self.run() },
        };
        let mut columns = vec![vec![f64::NAN; times.len()]; RESPONSE.len() - 2];
        let (mut phases, mut transitions) = (vec!["overturned"; times.len()], vec![0; times.len()]);
        let mut next = 0;
        let mut show = |at: usize, sample: &Sample| {
            let numbers = response_numbers(sample);
            columns.iter_mut().zip(numbers).for_each(|(column, number)| column[at] = number);
            (phases[at], transitions[at]) = (sample.motion.phase.name(), sample.motion.transitions);
        };
        let see = |sample: &Sample| {
            // the last that is shown is the end, for which there may be several times, or none
            while next < order.len() && times[order[next]] <= sample.motion.time {
                show(order[next], sample);
                next += 1;
            }
        };
        run.sample(order.iter().map(|index| times[*index]), see, &mut ())?;
        columns[0].copy_from_slice(times);
        for index in &order[next..] {
            transitions[*index] = self.transitions.len() as u64;
        }
        Ok((columns, phases, transitions))
    }
}

/// Follows a structure through a ground motion, or in free vibration, exactly, and returns the Run.
///
/// record: a Record; without one the ground is at rest for `duration`. The structure starts at rest in full contact
/// unless initial values are given: theta_0 (rad), theta_dot_0 (rad/s), u_0 (m), u_dot_0 (m/s). duration (s): when it
/// ends; without one, when the structure stands and will, or overturns, or still rocks 100/p_l after the record.
/// detail: "auto", "nonlinear" (Eqs 1, 5, 6), "linear" (Eqs 1, 7, 8), "modal" (Eqs 1, 11, 18), "rigid" (Eq 6 with u =
/// 0), "fixed_base" (Eq 1). tolerance: relative, of the results.
///
/// Overturning is a result, not an error. Raises ValueError where the run cannot begin, or not go on. Other threads of
/// Python go on meanwhile; the same inputs give the same bits.
#[pyfunction]
#[pyo3(signature = (structure, record=None, *, duration=None, detail="auto", tolerance=DEFAULT_TOLERANCE, **initial))]
pub fn simulate(
    py: Python<'_>,
    structure: Py<Structure>,
    record: Option<Py<Record>>,
    duration: Option<f64>,
    detail: &str,
    tolerance: f64,
    initial: Option<&Bound<'_, PyDict>>,
) -> PyResult<Run> {
    let conditions = conditions(detail, tolerance, duration, initial)?;
    conditions.check(&structure.get().0).map_err(refused)?;
    let record = match (record, duration) {
        (Some(record), _) => record,
        (None, Some(duration)) => Py::new(py, Record(rocking::run::record::Record::at_rest(duration)))?,
        (None, None) => {
            return Err(PyValueError::new_err("record and duration are missing: free vibration needs a duration"));
        }
    };
    let (structure_in, ground) = (structure.get(), record.get());
    let (found, transitions) = py.detach(|| {
        let mut transitions = Vec::new();
        let mut see = |transition: &rocking::Transition| transitions.push(*transition);
        let found = conditions.run(structure_in.0, &ground.0).found(&mut see).map_err(refused)?;
        Ok::<_, PyErr>((found, transitions))
    })?;
    Ok(Run { structure, record, conditions, found, transitions })
}
