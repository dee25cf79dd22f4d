//! `simulate` and `Run`: one structure under one ground motion.

use crate::arguments::{argument, conditions, numbers, refused, result};
use crate::interruptible::{Abandoned, interruptible};
use crate::record::{Ground, Record};
use crate::structure::Structure;
use numpy::PyArray1;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rocking::engine::DEFAULT_TOLERANCE;
use rocking::engine::piece::Sample;
use rocking::mechanics::state::{COMPONENTS, INITIAL_VALUES};
use rocking::run::fall::Found;
use rocking::run::peaks::{self, Peak};
use rocking::run::validity::{ASSUMPTIONS, Limits, Worst};
use rocking::run::{End, Ending, RunError};
use rocking::{Detail, Phase, Side, State, Transition};
use rocking_report::summary::Summary;
use rocking_report::tables::{RESPONSE, response_numbers};
use rocking_report::validity;
use rocking_sweep::plan::Conditions;
use std::sync::Arc;

fn state<'py>(py: Python<'py>, of: &State) -> PyResult<Bound<'py, PyDict>> {
    let state = PyDict::new(py);
    COMPONENTS.iter().zip(of.components()).try_for_each(|(name, value)| state.set_item(name, value))?;
    Ok(state)
}

/// A structure that has been followed through a ground motion: what `simulate` returns.
///
/// print(run) shows all of it; in a notebook a run is its animated view. A run stores its inputs and results, but not the
/// motion. `at`, `plot`, `page` and `validity` compute the motion again, to the same bits, in about a millisecond. A pickle
/// has the structure and the record, and runs again. Two runs with the same inputs are equal.
#[pyclass(frozen, module = "flexible_rocking")]
pub struct Run {
    structure: Py<Structure>,
    record: Py<Record>,
    /// The record as it shakes the structure.
    ground: Arc<rocking::run::record::Record>,
    conditions: Conditions,
    found: Found,
    transitions: Vec<rocking::Transition>,
}

impl Run {
    /// The structure that was followed.
    fn followed(&self) -> rocking::Structure {
        self.structure.get().one("a run").expect("simulate asks for one mass")
    }

    /// The run of the library.
    fn run(&self) -> rocking::Run<'_> {
        self.conditions.run(self.followed(), &self.ground)
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

    /// The exact largest magnitudes by name, each a Peak (a float with unit and time). Names: a_g (m/s2), theta (rad), u (m),
    /// delta_t (m, Eq 26), uplift (m, Eq 25), a_t (m/s2, Eq 27), V_t (N, Eqs 2, 23), M_t (N.m, Eqs 3, 24). A tendon adds P_t
    /// (N). Of a structure that overturns those before it falls.
    #[getter]
    fn peaks<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let named = PyDict::new(py);
        let peak = |Peak { magnitude, time }, unit| result(py, "Peak", (magnitude, time, unit));
        named.set_item("a_g", peak(self.found.ground, "m/s2")?)?;
        for of in peaks::of(&self.followed()) {
            named.set_item(of.name, peak(of.of(&self.found.peaks), of.unit)?)?;
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

    /// Every transition in the order of time, each a Transition: a list, with to_pandas().
    #[getter]
    fn transitions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        let transition = |of: &Transition| {
            let [before, after] = [&of.before, &of.after].map(|of| state(py, of));
            result(py, "Transition", (of.time, of.kind.name(), before?, after?))
        };
        result(py, "Transitions", (self.transitions.iter().map(transition).collect::<PyResult<Vec<_>>>()?,))
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

    /// How far the run exceeds the assumptions of the model, exact, each a Worst, within the usual limits. Names:
    /// tension_max, R_v_min, mu_required, mu_impact, tension_impact, energy_gain_max, weight_min.
    #[getter]
    fn validity(slf: Py<Self>, py: Python<'_>) -> PyResult<Bound<'_, PyDict>> {
        Run::validity_within(slf, py, None, None, None, None)
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
        let (found, _) = interruptible(py, move |_| slf.get().run().validity(limits))?;
        let named = PyDict::new(py);
        for (assumption, worst) in ASSUMPTIONS.iter().zip(&found.worst) {
            let Worst { value, time, first_beyond, beyond } = *worst;
            let parts = (value, time, (assumption.limit)(&limits), first_beyond, beyond);
            named.set_item(assumption.name, result(py, "Worst", parts)?)?;
        }
        Ok(named)
    }

    /// The motion at `times` (s), a number or an array (n,) in any order: a Response. A Response is a dict of arrays (n,) by
    /// the names of the FMU's outputs: time, a_g, theta, u, a_t, V_t, M_t, ..., phase, transitions. to_pandas() makes it a
    /// table.
    ///
    /// Exact: the engine's own polynomials and flows are evaluated, nothing is interpolated. The values at a transition are
    /// the values just after it. After the end of the run the motion goes on over ground at rest; once overturned there is
    /// none, and it is NaN. Raises ValueError for times before the start of the run, and NaN.
    fn at<'py>(slf: Py<Self>, py: Python<'py>, times: &Bound<'py, PyAny>) -> PyResult<Bound<'py, PyAny>> {
        let times = numbers("times", times)?;
        let start = slf.get().found.start;
        if let Some(i) = times.iter().position(|time| !(*time >= start && time.is_finite())) {
            let needed = format!("a finite time from the start of the run on, {start} s, is needed");
            return Err(PyValueError::new_err(format!("times[{i}] = {} s is out of range: {needed}", times[i])));
        }
        let Samples { columns, phases, transitions } =
            interruptible(py, move |abandoned| slf.get().sample(&times, abandoned))?;
        let response = PyDict::new(py);
        let units = PyDict::new(py);
        let headings = RESPONSE.map(|heading| heading.trim_end_matches(']').split_once('[').unwrap_or((heading, "1")));
        for ((name, unit), column) in headings.into_iter().zip(columns) {
            response.set_item(name, PyArray1::from_vec(py, column))?;
            units.set_item(name, unit)?;
        }
        let names = py.import("numpy")?.call_method1("array", (PHASES.map(Phase::name).to_vec(),))?;
        response.set_item("phase", names.get_item(PyArray1::from_vec(py, phases))?)?;
        response.set_item("transitions", PyArray1::from_vec(py, transitions))?;
        result(py, "Response", (response, units))
    }

    /// Draws a_g, theta, u and a_t over time with matplotlib, with marks at transitions; returns the figure.
    fn plot<'py>(slf: Bound<'py, Self>) -> PyResult<Bound<'py, PyAny>> {
        slf.py().import("flexible_rocking._results")?.call_method1("plot_run", (&slf,))
    }

    /// The page that shows the structure in motion over its histories, HTML for any browser.
    fn page(slf: Py<Self>, py: Python<'_>) -> PyResult<String> {
        interruptible(py, move |_| rocking_view::page(&slf.get().run()))
    }

    fn _repr_html_(slf: Py<Self>, py: Python<'_>) -> PyResult<String> {
        let page = Run::page(slf, py)?.replace('&', "&amp;").replace('"', "&quot;");
        Ok(format!("<iframe srcdoc=\"{page}\" style=\"width: 100%; height: 640px; border: 0\"></iframe>"))
    }

    fn __repr__(&self) -> String {
        let (title, end, transitions) = (self.record.get().title(), self.end(), self.transitions.len());
        format!("<Run under {title:?}: {} at {end} s, {transitions} transitions>", self.ending())
    }

    fn __str__(slf: Py<Self>, py: Python<'_>) -> PyResult<String> {
        interruptible(py, move |_| -> anyhow::Result<_> {
            let (of, limits) = (slf.get(), Limits::default());
            let run = of.run();
            let summary = Summary::new(&run.structure, &of.transitions);
            let (beyond, _) = run.validity(limits)?;
            let lines = validity::section(&run.structure, run.detail, &beyond, &limits);
            Ok(format!("{}\n{}{}", run.ground.title(), summary.text(&of.found)?, lines.join("\n")))
        })
    }

    /// Whether both have the same inputs, and therefore the same results.
    fn __eq__(&self, other: &Run) -> bool {
        let are_same = self.structure.get() == other.structure.get() && self.record.get() == other.record.get();
        are_same && self.conditions == other.conditions
    }

    fn __hash__(&self) -> u64 {
        self.structure.get().__hash__() ^ self.record.get().__hash__()
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

/// The phases by their numbers among the [`Samples`].
const PHASES: [Phase; 4] =
    [Phase::Overturned(Side::Left), Phase::FullContact, Phase::Rocking(Side::Left), Phase::Rocking(Side::Right)];

/// A motion at instants.
struct Samples {
    /// Of numbers.
    columns: Vec<Vec<f64>>,
    /// Positions in [`PHASES`].
    phases: Vec<u8>,
    /// How many there have been.
    transitions: Vec<u64>,
}

impl Run {
    /// The motion at `times` (s), none of which is before the start, unless it is `abandoned`.
    fn sample(&self, times: &[f64], abandoned: &mut Abandoned) -> Result<Samples, RunError> {
        let mut order: Vec<usize> = (0..times.len()).collect();
        order.sort_by(|a, b| times[*a].total_cmp(&times[*b]));
        let last = order.last().map_or(self.found.start, |last| times[*last]);
        let run = match self.found.finish.ending {
            Ending::Overturned => self.run(),
            _ if last <= self.end() => self.run(),
            _ => rocking::Run { end: End::At(last), ..self.run() },
        };
        let column = |_| {
            abandoned.check();
            vec![f64::NAN; times.len()]
        };
        let mut columns: Vec<_> = (2..RESPONSE.len()).map(column).collect();
        let (mut phases, mut transitions) = (vec![0; times.len()], vec![0; times.len()]);
        let mut next = 0;
        let mut show = |at: usize, sample: &Sample| {
            let numbers = response_numbers(sample);
            columns.iter_mut().zip(numbers).for_each(|(column, number)| column[at] = number);
            let phase = PHASES.iter().position(|phase| *phase == sample.motion.phase);
            (phases[at], transitions[at]) = (phase.unwrap_or(0) as u8, sample.motion.transitions);
        };
        let watching = abandoned.clone();
        let see = |sample: &Sample| {
            // the last that is shown is the end, for which there may be several times, or none
            while next < order.len() && times[order[next]] <= sample.motion.time {
                watching.check();
                show(order[next], sample);
                next += 1;
            }
        };
        run.sample(order.iter().map(|index| times[*index]), see, abandoned)?;
        columns[0].copy_from_slice(times);
        for index in &order[next..] {
            transitions[*index] = self.transitions.len() as u64;
        }
        Ok(Samples { columns, phases, transitions })
    }
}

/// Follows a structure through a ground motion, or in free vibration, exactly, and returns the Run.
///
/// record: a Record; without one the ground is at rest for `duration`. The structure starts at rest in full contact unless
/// initial values are given: theta_0 (rad), theta_dot_0 (rad/s), u_0 (m), u_dot_0 (m/s). duration (s): the length of the run.
/// Without a duration, the run ends when the base is down for good or the structure overturns, at the latest 100/p_l after
/// the record. detail: "auto", "nonlinear" (Eqs 1, 5, 6), "linear" (Eqs 1, 7, 8), "modal" (Eqs 1, 11, 18), "rigid" (Eq 6 with
/// u = 0), "fixed_base" (Eq 1). tolerance: relative, of the results.
///
/// Overturning is a result, not an error. Raises ValueError where the run cannot begin, or not go on. Other threads of
/// Python go on meanwhile; the same inputs give the same bits.
#[pyfunction]
#[pyo3(signature = (structure, record=None, *, duration=None, detail=Detail::Auto, tolerance=DEFAULT_TOLERANCE, **initial))]
#[pyo3(text_signature = "(structure, record=None, *, duration=None, detail='auto', tolerance=1e-09, **initial)")]
pub fn simulate(
    py: Python<'_>,
    structure: Py<Structure>,
    record: Option<Ground>,
    duration: Option<&Bound<'_, PyAny>>,
    #[pyo3(from_py_with = argument::detail)] detail: Detail,
    #[pyo3(from_py_with = argument::tolerance)] tolerance: f64,
    initial: Option<&Bound<'_, PyDict>>,
) -> PyResult<Run> {
    let conditions = conditions(detail, tolerance, duration, initial)?;
    let followed = structure.get().one("simulate")?;
    conditions.check(&followed).map_err(refused)?;
    let record = match (record, conditions.duration) {
        (Some(Ground(record)), _) => record,
        (None, Some(duration)) => Py::new(py, Record::in_si(rocking::run::record::Record::at_rest(duration)))?,
        (None, None) => {
            return Err(PyValueError::new_err("record and duration are missing: free vibration needs a duration"));
        }
    };
    let ground = record.get().under(followed.parameters().g);
    let shaking = Arc::clone(&ground);
    let (found, transitions) = interruptible(py, move |abandoned| {
        let mut transitions = Vec::new();
        let mut see = |transition: &Transition| transitions.push(*transition);
        let found = conditions.run(followed, &shaking).found(&mut (abandoned, &mut see))?;
        Ok::<_, RunError>((found, transitions))
    })?;
    Ok(Run { structure, record, ground, conditions, found, transitions })
}
