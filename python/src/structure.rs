//! `Structure`: parameters and what follows from them, by the names in the library's tables.

use crate::arguments::{matrix, numbers, one_of, refused, reject, response, warn};
use crate::interruptible::interruptible;
use crate::tables::{dict, keywords, known, rows, with_base};
use anyhow::Context;
use numpy::PyArray1;
use pyo3::exceptions::{PyAttributeError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};
use rocking::estimates::effective_frequency::effective_frequency;
use rocking::estimates::modal_split::{ModalAccelerations, ModalRotations};
use rocking::estimates::pushover::{Equilibrium, Pushover};
use rocking::estimates::restoring::FlagPoint;
use rocking::structure::derived::{Derived, OF_MODE};
use rocking::structure::description::Description;
use rocking::structure::natural_quantities::NATURAL;
use rocking::structure::parameters::PRESETS;
use rocking::{OneMass, Phase, State};
use rocking_report::structure_file::{self, OF_MANY, of_table};
use rocking_report::{describe, input};
use rocking_sweep::plan::Population;
use std::collections::HashMap;
use std::path::PathBuf;
use toml::Table;

/// A flexible structure on a base that may lift off (Fig 2 of the paper).
///
/// Structure(m=4e5, m0=1e5, H=9, B=1.5, J0=1e5, f_fc=2.5, zeta_fc=0.03, r=0.95)
/// Structure(preset="mcmanus", f_fc=8)
///
/// Every number is a keyword and an attribute, in SI units. Parameters, with unit and default:
///
#[doc = rocking::parameters_in_lines!()]
/// These replace parameters: period_fc (s) for f_fc, weight (N) for m, weight0 (N) for m0, width (m) for B. p_l (rad/s) replaces J0.
/// alpha_cg (rad) replaces H, or B if H is given. units="kN, m, t": masses in t, forces in kN, J0 in t.m2, k in kN/m. With preset,
/// "mcmanus" or "evison", the specimen of the paper with these numbers in the place of its own.
///
/// Derived quantities are attributes, too: alpha_cg, p_l, chi, u_cr, f_u, ... `parameters` and `derived` have all of them,
/// and print(structure) shows them with units and equation numbers. A structure cannot be changed; `replace` makes another.
///
/// Structure(storeys=[dict(m=4e4, h=3.5, k=6e7), dict(m=3e4, h=7, k=4e7)], zeta=0.02, m0=2e4, J0=3e4, B=1.5)
///
/// A shear building of many masses. Each storey has the stiffness k (N/m), and the mass m (kg) and height h (m) above the base
/// of its floor. zeta: one damping ratio, one for each mode, or dict(f=(Hz, Hz), zeta=...) for Rayleigh damping. The numbers of
/// the base are those above, or base=dict(...). Without r, momentum gives a coefficient for each impact. keep: how many modes are kept; the rest of
/// the mass turns rigidly with the base. p_delta=True subtracts the weight above each storey, over the storey's height, from its k.
/// storeys may be a DataFrame. See also from_matrices, from_modes and read. ground=Ground(f_v=40, zeta_v=0.2) puts either on contact points that push and never pull.
///
/// A Python warning begins with the name of a number that is usual in another unit: warnings.filterwarnings("ignore", "m_t = ")
/// silences it. Raises ValueError where a number is unknown, missing, given twice in
/// different ways or out of its range.
#[pyclass(frozen, eq, name = "Structure", module = "flexible_rocking")]
pub struct PyStructure {
    pub of: rocking::Structure,
}

pub fn argument(value: &Bound<'_, PyAny>) -> PyResult<Py<PyStructure>> {
    let needed = || PyTypeError::new_err(format!("structure = {value:?} is no Structure: Structure(m=...) makes one"));
    Ok(value.cast::<PyStructure>().map_err(|_| needed())?.clone().unbind())
}

/// The numbers of `structure` that can have other values, with unit, value, and least and largest value.
#[pyfunction]
pub fn numbers_of(structure: &PyStructure) -> Vec<(String, &'static str, f64, f64, f64)> {
    let all = structure.of.description().map_or_else(Vec::new, Description::numbers);
    all.into_iter().map(|of| (of.name, of.unit, of.value, of.min, of.max)).collect()
}

/// `structure` with these values of its [`numbers_of`], or of its slenderness, without warnings.
#[pyfunction]
pub fn varied(structure: &PyStructure, values: HashMap<String, f64>) -> PyResult<PyStructure> {
    let vary = |population: Population, (name, value): (String, f64)| population.vary(&name, vec![value]);
    let varied = values.into_iter().try_fold(Population::new("varied", structure.of.clone()), vary);
    Ok(PyStructure { of: varied.and_then(|of| of.structure(0)).map_err(refused)? })
}

impl PartialEq for PyStructure {
    fn eq(&self, other: &PyStructure) -> bool {
        self.of == other.of
    }
}

impl PyStructure {
    /// The structure, with a Python warning for each doubtful number.
    fn of(py: Python<'_>, of: anyhow::Result<rocking::Structure>) -> PyResult<PyStructure> {
        let of = of.map_err(refused)?;
        warn(py, of.doubts(), 1)?;
        Ok(PyStructure { of })
    }

    fn of_many(py: Python<'_>, keywords: Table) -> PyResult<PyStructure> {
        PyStructure::of(py, of_table(with_base(keywords), None))
    }

    /// The structure of one mass, which `task` needs.
    pub fn one(&self, task: &'static str) -> PyResult<OneMass> {
        self.of.one_mass(task).copied().map_err(refused)
    }

    /// Its numbers by name: first the parameters of one mass, then what follows from them.
    fn named(&self) -> [Vec<(String, f64)>; 2] {
        [describe::given(&self.of), describe::derived(&self.of)]
            .map(|all| all.into_iter().map(|of| (of.name, of.value)).collect())
    }
}

#[pymethods]
impl PyStructure {
    #[new]
    #[pyo3(signature = (*, preset=None, **numbers))]
    fn new<'py>(
        py: Python<'py>,
        preset: Option<&Bound<'py, PyAny>>,
        numbers: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<PyStructure> {
        let numbers = numbers.map_or_else(|| PyDict::new(py), Bound::clone);
        let of_many = OF_MANY.iter().find(|name| numbers.contains(name).unwrap_or(false));
        let keywords = keywords(&numbers, of_many.is_some())?;
        match (preset, of_many) {
            (None, Some(_)) => PyStructure::of_many(py, keywords),
            (Some(_), Some(name)) => {
                reject!("preset is a structure of one mass, and {name} makes one of many: leave out one of them");
            }
            (preset, None) => {
                let base = preset.map(|preset| one_of("preset", preset, PRESETS)).transpose()?;
                PyStructure::of(py, of_table(keywords, base.as_ref()))
            }
        }
    }

    /// Every keyword of both kinds of structures, for those who complete it.
    #[classattr]
    fn __signature__(py: Python<'_>) -> PyResult<Bound<'_, PyAny>> {
        let mut names = [vec!["preset".to_owned()], known(false), known(true)].concat();
        names = (0..names.len()).filter(|i| !names[..*i].contains(&names[*i])).map(|i| names[i].clone()).collect();
        let named =
            [("inspect", py.import("inspect")?.into_any()), ("names", names.into_pyobject(py)?)].into_py_dict(py)?;
        let signature = c"inspect.Signature([inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=None) for name in names])";
        py.eval(signature, Some(&named), None)
    }

    /// Reads the structure in `file`, the TOML that `rocking-fmu` reads and writes.
    ///
    /// Raises FileNotFoundError, and ValueError with the line.
    #[staticmethod]
    fn read(py: Python<'_>, file: PathBuf) -> PyResult<PyStructure> {
        let read = input::text(&file).and_then(|text| structure_file::read(&text));
        PyStructure::of(py, read.with_context(|| input::name(&file)))
    }

    /// Writes the structure to `file`: TOML, each number with its unit and its range. `read` makes it again to the same bits.
    fn write(&self, file: PathBuf) -> PyResult<()> {
        let text = structure_file::write(&self.of).map_err(refused)?;
        std::fs::write(&file, text).with_context(|| input::name(&file)).map_err(refused)
    }

    /// The structure of these masses (kg) at these heights (m) above the base, lowest first. K (N/m) is the stiffness matrix on
    /// a fixed base. zeta and the numbers of the base as in Structure.
    #[staticmethod]
    #[pyo3(signature = (masses, heights, K, **numbers), text_signature = "(masses, heights, K, *, zeta, **base)")]
    fn from_matrices<'py>(
        masses: Bound<'py, PyAny>,
        heights: Bound<'py, PyAny>,
        K: Bound<'py, PyAny>,
        numbers: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<PyStructure> {
        let py = masses.py();
        let floors = rows(&[("m", "masses", Some(masses)), ("h", "heights", Some(heights))], "mass")?;
        let mut keywords = keywords(&numbers.map_or_else(|| PyDict::new(py), Bound::clone), true)?;
        let K = toml::Value::try_from(matrix("K", &K)?).map_err(refused)?;
        keywords.extend([("floors".to_owned(), floors.into()), ("K".to_owned(), K)]);
        PyStructure::of_many(py, keywords)
    }

    /// The structure of the modes of a fixed base that another program found, lowest first. Arrays with a number for each mode: f
    /// (Hz) or period (s), mass (effective, kg), height (effective, m) or moment (mass x height, kg.m). All mass above the
    /// base: m_s (kg), S_1 (the sum of m h, kg.m), and I_2 (the sum of m h^2, kg.m2) or J_P (inertia about a pivot, kg.m2).
    /// Floors, if they are to be shown: masses, heights, and shapes (floors, modes) in any scale. Without m_s, S_1 and I_2 the
    /// floors have all mass. zeta and the numbers of the base as in Structure.
    #[staticmethod]
    #[pyo3(signature = (*, mass, **numbers))]
    #[pyo3(
        text_signature = "(*, mass, zeta, f=None, period=None, height=None, moment=None, m_s=None, S_1=None, I_2=None, \
                             J_P=None, masses=None, heights=None, shapes=None, **base)"
    )]
    fn from_modes<'py>(mass: Bound<'py, PyAny>, numbers: Option<&Bound<'py, PyDict>>) -> PyResult<PyStructure> {
        let py = mass.py();
        let left = numbers.map_or_else(|| Ok(PyDict::new(py)), |numbers| numbers.copy())?;
        let take = |name: &'static str| {
            let value = left.get_item(name)?;
            value.iter().try_for_each(|_| left.del_item(name))?;
            PyResult::Ok((name, name, value.filter(|value| !value.is_none())))
        };
        let columns = [("mass", "mass", Some(mass)), take("f")?, take("period")?, take("height")?, take("moment")?];
        let mut modes = rows(&columns, "mode")?;
        let (_, _, shapes) = take("shapes")?;
        for row in shapes.map_or(Ok(Vec::new()), |shapes| matrix("shapes", &shapes))? {
            if row.len() != modes.len() {
                reject!("shapes has {} columns and must have {}, one for each mode", row.len(), modes.len());
            }
            for (mode, phi) in modes.iter_mut().zip(row) {
                let shape = mode.entry("shape").or_insert_with(|| Vec::<f64>::new().into());
                shape.as_array_mut().into_iter().for_each(|shape| shape.push(phi.into()));
            }
        }
        let [(.., masses), (.., heights)] = [take("masses")?, take("heights")?];
        let floors = rows(&[("m", "masses", masses), ("h", "heights", heights)], "mass")?;
        let total = rows(&[take("m_s")?, take("S_1")?, take("I_2")?, take("J_P")?], "structure")?;
        let mut keywords = keywords(&left, true)?;
        keywords.extend([("modes".to_owned(), modes.into()), ("floors".to_owned(), floors.into())]);
        keywords.extend(total.into_iter().map(|total| ("total".to_owned(), total.into())));
        PyStructure::of_many(py, keywords)
    }

    /// This structure with other numbers in the place of its own, by the same names as in Structure(...). None takes a number away:
    /// without r, momentum gives a coefficient; without ground, it is rigid.
    #[pyo3(signature = (**numbers))]
    fn replace<'py>(&self, py: Python<'py>, numbers: Option<&Bound<'py, PyDict>>) -> PyResult<PyStructure> {
        let numbers = numbers.map_or_else(|| PyDict::new(py), Bound::clone);
        let mut own = structure_file::table(&self.of).map_err(refused)?;
        let new = keywords(&numbers, !self.of.is_one_mass())?;
        if self.of.is_one_mass() {
            own.retain(|name, _| name == "ground" && !numbers.contains(name).unwrap_or(false));
            own.extend(new);
            let mut base = self.of.parameters();
            base.r = if numbers.contains("r")? { f64::NAN } else { base.r };
            return PyStructure::of(py, of_table(own, Some(&base)));
        }
        if new.contains_key("units") {
            reject!("units: replace takes SI units, in which the other numbers are");
        }
        own.remove("base").and_then(|base| base.try_into::<Table>().ok()).into_iter().for_each(|base| own.extend(base));
        for name in numbers.keys().extract::<Vec<String>>()? {
            let natural = NATURAL.iter().find(|natural| natural.name == name);
            own.remove(natural.map_or(&*name, |natural| natural.stands_for));
        }
        own.extend(new);
        PyStructure::of_many(py, own)
    }

    /// The numbers that make the structure, Structure(**parameters), in SI units: the tables of its file.
    #[getter]
    fn parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        dict(py, &structure_file::table(&self.of).map_err(refused)?)
    }

    /// The derived quantities by name: gamma, omega_fc (rad/s), k (N/m), u_cr (m), J_P (kg.m2), p_l (rad/s), alpha_cg (rad),
    /// chi, f_u (Hz), weight (N), ... Of many masses: m_s, m_t (kg), S_1 (kg.m), J_P, p_l, alpha_cg, r, ...
    #[getter]
    fn derived<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let [_, derived] = self.named();
        derived.into_py_dict(py)
    }

    /// The modes of many masses, lowest first. A dict of arrays (modes,): f (Hz) and zeta in full contact, mass (effective, kg),
    /// share (of m_s), height (effective, m), chi, and f_u (Hz) while the structure rocks.
    ///
    /// Raises ValueError for a structure of one mass, whose attributes have these numbers.
    #[getter]
    fn mode_table<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let frame = &self.of;
        if frame.one().is_some() {
            reject!("mode_table needs a structure of many masses; see f_fc, zeta_fc, chi, f_u");
        }
        let column =
            |of: &Derived<_>| (of.name, PyArray1::from_iter(py, frame.mode_table().map(|mode| (of.value)(&mode))));
        OF_MODE.iter().map(column).into_py_dict(py)
    }

    /// The effective frequency of rocking with the amplitude theta (rad), Hz (Eq 14); 0 from tan(alpha_cg) on.
    ///
    /// Raises ValueError for a structure with a tendon or dissipators.
    fn effective_frequency(&self, theta: f64) -> PyResult<f64> {
        effective_frequency(&self.one("effective_frequency")?, theta).map_err(refused)
    }

    /// The static pushover of Fig 1 to the right, from rest to overturning (Eqs 5 and 6 without inertia). Returns a Response, a dict
    /// of arrays (2 points,): theta (rad), u, delta_t (m) of the top floor, P (N), M (N.m). `points` of them are in full contact, and
    /// as many rock. Floors take parts of P in proportion to mass times height.
    ///
    /// Raises ValueError where the structure is too soft to be held, and for other than 2 to 1,000,000 points.
    #[pyo3(signature = (points=100))]
    fn pushover<'py>(&self, py: Python<'py>, points: u32) -> PyResult<Bound<'py, PyAny>> {
        let structure = self.of.clone();
        let curve = interruptible(py, move |_| Pushover::new(&structure)?.curve(points))?;
        let column = |name, unit, of: fn(&Equilibrium) -> f64| (name, unit, curve.iter().map(of).collect());
        response(
            py,
            [
                column("theta", "rad", |at| at.theta),
                column("u", "m", |at| at.u),
                column("delta_t", "m", |at| at.delta_t),
                column("P", "N", |at| at.force),
                column("M", "N.m", |at| at.moment),
            ],
        )
    }

    /// The moment that weight, tendon and dissipators turn the base back with, while the base is turned slowly from rest to theta (rad,
    /// above 0 and below pi/2) and back in 20 steps each. Returns a Response, a dict of arrays (41,): theta (rad), moment (N.m).
    fn restoring<'py>(&self, py: Python<'py>, theta: f64) -> PyResult<Bound<'py, PyAny>> {
        let points = describe::restoring(&self.of, theta).map_err(refused)?;
        let column = |of: fn(&FlagPoint) -> f64| points.iter().map(of).collect();
        response(py, [("theta", "rad", column(|at| at.theta)), ("moment", "N.m", column(|at| at.moment))])
    }

    /// Splits the `response` of Run.at into the rocking and the vibration mode. Returns a dict of arrays (n,): q_r, q_u (rad,
    /// Eq 16), a_r, a_u (m/s2, Eqs 12, 19), NaN unless the structure rocks.
    ///
    /// Raises ValueError for a structure with a tendon or dissipators.
    fn modes<'py>(&self, response: &Bound<'py, PyDict>) -> PyResult<Bound<'py, PyDict>> {
        let structure = self.one("modes")?;
        let of = |name: &str| -> PyResult<Bound<'py, PyAny>> {
            response.get_item(name)?.ok_or_else(|| PyValueError::new_err(format!("response has no {name:?}")))
        };
        let [theta, u, u_dot, a_g] = ["theta", "u", "u_dot", "a_g"].map(|name| numbers(name, &of(name)?));
        let motion = theta?.into_iter().zip(u?).zip(u_dot?).zip(a_g?);
        let mut modes = [const { Vec::new() }; 4];
        for (phase, (((theta, u), u_dot), a_g)) in of("phase")?.try_iter()?.zip(motion) {
            response.py().check_signals()?;
            let state = State { u, u_dot, theta, theta_dot: 0.0 }; // whose rate the split does not need
            let of = ModalRotations::of(&structure, &state).map_err(refused)?;
            let split = |side| {
                let accelerations = ModalAccelerations::of(&structure, side, &state, a_g).map_err(refused)?;
                PyResult::Ok([of.q_r, of.q_u, accelerations.a_r, accelerations.a_u])
            };
            let name: String = phase?.extract()?;
            let split = match Phase::SHOWN.into_iter().find(|of| of.name() == name) {
                Some(Phase::Rocking(side)) => split(side)?,
                _ => [f64::NAN; 4],
            };
            modes.iter_mut().zip(split).for_each(|(column, number)| column.push(number));
        }
        let columns = modes.map(|column| PyArray1::from_vec(response.py(), column));
        ["q_r", "q_u", "a_r", "a_u"].into_iter().zip(columns).into_py_dict(response.py())
    }

    fn __getattr__(&self, name: &str) -> PyResult<f64> {
        let value = self.named().concat().into_iter().find_map(|(known, value)| (known == name).then_some(value));
        value.ok_or_else(|| PyAttributeError::new_err(format!("a Structure has no {name:?}")))
    }

    fn __setattr__(&self, name: &str, value: &Bound<'_, PyAny>) -> PyResult<()> {
        Err(PyAttributeError::new_err(format!(
            "{name} is read-only: use replace({name}={value:?}), which makes another structure"
        )))
    }

    fn __dir__(slf: Bound<'_, Self>) -> PyResult<Vec<String>> {
        let own: Vec<String> =
            slf.py().import("builtins")?.getattr("object")?.call_method1("__dir__", (&slf,))?.extract()?;
        let numbers = slf.get().named().concat().into_iter().map(|(name, _)| name);
        Ok(own.into_iter().chain(numbers).collect())
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let numbers: Vec<_> = self.parameters(py)?.iter().map(|(name, value)| format!("{name}={value:?}")).collect();
        Ok(format!("Structure({})", numbers.join(", ")))
    }

    fn __str__(&self) -> PyResult<String> {
        describe::text(&self.of).map_err(refused)
    }

    pub fn __hash__(&self) -> u64 {
        let bits = |value: f64| (value + 0.0).to_bits(); // of -0 as of 0, which it equals
        self.named().concat().into_iter().fold(0, |hash, (_, value)| hash.rotate_left(7).wrapping_mul(31) ^ bits(value))
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<((), Bound<'py, PyDict>)> {
        Ok(((), self.parameters(py)?))
    }
}
