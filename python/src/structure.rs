//! `Structure`: parameters and what follows from them, by the names in the library's tables.

use crate::arguments::{numbers, one_of, refused, warn};
use crate::interruptible::interruptible;
use crate::many_masses::{INSTEAD, OF_MANY, frame, given};
use numpy::PyArray1;
use pyo3::exceptions::{PyAttributeError, PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{IntoPyDict, PyDict};
use rocking::estimates::effective_frequency::effective_frequency;
use rocking::estimates::modal_split::{ModalAccelerations, ModalRotations};
use rocking::estimates::pushover::{Equilibrium, Pushover};
use rocking::estimates::restoring::FlagPoint;
use rocking::structure::derived::{Derived, OF_MODE};
use rocking::structure::parameters::PRESETS;
use rocking::{OneMass, Parameters, Side, State};
use rocking_report::describe;

/// A flexible structure on a base that may lift off (Fig 2 of the paper).
///
/// Structure(m=4e5, m0=1e5, H=9, B=1.5, J0=1e5, f_fc=2.5, zeta_fc=0.03, r=0.95)
/// Structure(preset="mcmanus", f_fc=8)
///
/// Every number is a keyword and an attribute, in SI units. Parameters, with unit and default:
///
#[doc = rocking::parameters_in_lines!()]
/// These replace parameters: period_fc (s) for f_fc, weight and weight0 (N) for m and m0, width (m) for B. p_l (rad/s) replaces J0.
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
/// the base are those above. Without r, momentum gives a coefficient for each impact. keep: how many modes are kept; the rest of
/// the mass turns rigidly with the base. p_delta=True subtracts the weight above each storey, over the storey's height, from its k.
/// See also from_matrices and from_modes. ground=Ground(f_v=40, zeta_v=0.2) puts either on contact points that push and never pull.
///
/// A Python warning begins with the name of a number that is usual in another unit: warnings.filterwarnings("ignore", "m_t = ")
/// silences it. Raises ValueError where a number is unknown, missing, given twice in
/// different ways or out of its range.
#[pyclass(frozen, eq, module = "flexible_rocking")]
pub struct Structure {
    pub of: rocking::Structure,
    /// The keywords that make a structure of many masses.
    keywords: Option<Py<PyDict>>,
}

pub fn argument(value: &Bound<'_, PyAny>) -> PyResult<Py<Structure>> {
    let needed = || PyTypeError::new_err(format!("structure = {value:?} is no Structure: Structure(m=...) makes one"));
    Ok(value.cast::<Structure>().map_err(|_| needed())?.clone().unbind())
}

impl PartialEq for Structure {
    fn eq(&self, other: &Structure) -> bool {
        self.of == other.of
    }
}

/// The keywords and all that they hold, so that nobody else can change them.
fn copied<'py>(keywords: &Bound<'py, PyDict>) -> PyResult<Bound<'py, PyDict>> {
    Ok(keywords.py().import("copy")?.call_method1("deepcopy", (keywords,))?.cast_into()?)
}

impl Structure {
    /// The structure, with a Python warning for each doubtful number.
    fn of(py: Python<'_>, of: rocking::Structure, keywords: Option<Py<PyDict>>) -> PyResult<Structure> {
        warn(py, of.doubts(), 1)?;
        Ok(Structure { of, keywords })
    }

    fn many(keywords: &Bound<'_, PyDict>) -> PyResult<Structure> {
        let kept = copied(keywords)?;
        for (name, _) in keywords.iter().filter(|(_, value)| value.is_none()) {
            kept.del_item(name)?;
        }
        Structure::of(keywords.py(), frame(kept.copy()?)?, Some(kept.unbind()))
    }

    /// One mass of the parameters `base`, changed by `numbers`; on ground that gives, without the r of `base`.
    fn over(base: &Parameters, numbers: &Bound<'_, PyDict>) -> PyResult<Structure> {
        let (on_rigid, py) = (numbers.copy()?, numbers.py());
        let ground = on_rigid.get_item("ground")?;
        ground.iter().try_for_each(|_| on_rigid.del_item("ground"))?;
        let of = given(&on_rigid)?.structure(Some(base)).map_err(refused)?;
        let Some(ground) = ground.filter(|ground| !ground.is_none()) else { return Structure::of(py, of, None) };
        let keywords = Structure { of, keywords: None }.parameters(py)?;
        keywords.set_item("ground", ground)?;
        if !numbers.contains("r")? {
            keywords.del_item("r")?;
        }
        Structure::many(&keywords)
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
impl Structure {
    #[new]
    #[pyo3(signature = (*, preset=None, **numbers))]
    fn new<'py>(
        py: Python<'py>,
        preset: Option<&Bound<'py, PyAny>>,
        numbers: Option<&Bound<'py, PyDict>>,
    ) -> PyResult<Structure> {
        let numbers = numbers.map_or_else(|| PyDict::new(py), Bound::clone);
        let of_many = OF_MANY.iter().find(|name| numbers.contains(name).unwrap_or(false));
        match preset {
            None if of_many.is_some() || numbers.contains("ground")? => Structure::many(&numbers),
            None => Structure::of(py, given(&numbers)?.structure(None).map_err(refused)?, None),
            Some(_) if let Some(name) = of_many => {
                let message =
                    format!("preset is a structure of one mass, and {name} makes one of many: leave out one of them");
                Err(PyValueError::new_err(message))
            }
            Some(preset) => Structure::over(&one_of("preset", preset, PRESETS)?, &numbers),
        }
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
    ) -> PyResult<Structure> {
        let keywords = numbers.map_or_else(|| Ok(PyDict::new(masses.py())), |numbers| numbers.copy())?;
        for (name, value) in [("masses", &masses), ("heights", &heights), ("K", &K)] {
            keywords.set_item(name, value)?;
        }
        Structure::many(&keywords)
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
    fn from_modes<'py>(mass: Bound<'py, PyAny>, numbers: Option<&Bound<'py, PyDict>>) -> PyResult<Structure> {
        let keywords = numbers.map_or_else(|| Ok(PyDict::new(mass.py())), |numbers| numbers.copy())?;
        keywords.set_item("mass", mass)?;
        Structure::many(&keywords)
    }

    /// This structure with other numbers in the place of its own, by the same names as in Structure(...). Of many masses None takes
    /// a number away: without r, momentum gives a coefficient again.
    #[pyo3(signature = (**numbers))]
    fn replace<'py>(&self, py: Python<'py>, numbers: Option<&Bound<'py, PyDict>>) -> PyResult<Structure> {
        let numbers = numbers.map_or_else(|| PyDict::new(py), Bound::clone);
        if let Some(structure) = self.of.one() {
            return Structure::over(structure.parameters(), &numbers);
        }
        let keywords = self.parameters(py)?;
        for [one, other] in INSTEAD {
            for [new, old] in [[one, other], [other, one]] {
                if numbers.contains(new)? && keywords.contains(old)? {
                    keywords.del_item(old)?;
                }
            }
        }
        keywords.update(numbers.as_mapping())?;
        Structure::many(&keywords)
    }

    /// The parameters by name, in SI units; of many masses the keywords that make the structure.
    #[getter]
    fn parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        if let Some(keywords) = &self.keywords {
            return copied(keywords.bind(py));
        }
        let [parameters, _] = self.named();
        parameters.into_py_dict(py)
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
            return Err(PyValueError::new_err(
                "mode_table needs a structure of many masses; see f_fc, zeta_fc, chi, f_u",
            ));
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

    /// The static pushover of Fig 1 to the right, from rest to overturning (Eqs 5 and 6 without inertia). Returns a dict of
    /// arrays (2 points,): theta (rad), u, delta_t (m) of the top floor, P (N), M (N.m). `points` of them are in full contact, and
    /// as many rock. Floors take parts of P in proportion to mass times height.
    ///
    /// Raises ValueError where the structure is too soft to be held, and for other than 2 to 1,000,000 points.
    #[pyo3(signature = (points=100))]
    fn pushover<'py>(&self, py: Python<'py>, points: u32) -> PyResult<Bound<'py, PyDict>> {
        let structure = self.of.clone();
        let curve = interruptible(py, move |_| Pushover::new(&structure)?.curve(points))?;
        let column = |of: fn(&Equilibrium) -> f64| PyArray1::from_iter(py, curve.iter().map(of));
        let named = PyDict::new(py);
        named.set_item("theta", column(|at| at.theta))?;
        named.set_item("u", column(|at| at.u))?;
        named.set_item("delta_t", column(|at| at.delta_t))?;
        named.set_item("P", column(|at| at.force))?;
        named.set_item("M", column(|at| at.moment))?;
        Ok(named)
    }

    /// The moment that weight, tendon and dissipators turn the base back with, while the base is turned slowly from rest to theta (rad,
    /// above 0 and below pi/2) and back in 20 steps each. Returns a dict of arrays (41,): theta (rad), moment (N.m).
    fn restoring<'py>(&self, py: Python<'py>, theta: f64) -> PyResult<Bound<'py, PyDict>> {
        let points = describe::restoring(&self.of, theta).map_err(refused)?;
        let column = |of: fn(&FlagPoint) -> f64| PyArray1::from_iter(py, points.iter().map(of));
        [("theta", column(|at| at.theta)), ("moment", column(|at| at.moment))].into_py_dict(py)
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
            let split = match phase?.extract()? {
                "rocking left" => split(Side::Left)?,
                "rocking right" => split(Side::Right)?,
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
