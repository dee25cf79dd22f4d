//! `Structure`: parameters and what follows from them, by the names in the library's tables.

use crate::arguments::{number, numbers, one_of, refused};
use crate::interruptible::interruptible;
use numpy::PyArray1;
use pyo3::exceptions::{PyAttributeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rocking::estimates::effective_frequency::effective_frequency;
use rocking::estimates::modal_split::{ModalAccelerations, Modes};
use rocking::estimates::pushover::{self, Equilibrium};
use rocking::structure::natural_quantities::Given;
use rocking::structure::parameters::{PARAMETERS, PRESETS};
use rocking::structure::{DERIVED, Derived};
use rocking::{Parameters, Side, State};
use rocking_report::describe;

/// A flexible structure on a base that may lift off (Fig 2 of the paper).
///
/// Structure(m=4e5, m0=1e5, H=9, B=1.5, J0=1e5, f_fc=2.5, zeta_fc=0.03, r=0.95)
/// Structure(preset="mcmanus", f_fc=8)
///
/// Every number is a keyword and an attribute, in SI units. Parameters: m, m0 (kg), H, B (m), J0 (kg.m2, 0), f_fc (Hz),
/// zeta_fc, c_ratio (1), r, g (m/s2, 9.81); the numbers in brackets are defaults. These replace parameters: period_fc (s) for
/// f_fc, weight and weight0 (kN) for m and m0, width (m) for B. p_l (rad/s) replaces J0. alpha_cg (rad) replaces H, or B if H
/// is given. Tendon: P_0 (N), k_t (N/m). Pair of dissipators: distance xi_d (m) from the middle, viscous c_d (N.s/m), or
/// elastoplastic k_d (N/m) and F_y (N). With preset, "mcmanus" or "evison", the specimen of the paper with these numbers in
/// the place of its own.
///
/// Derived quantities are attributes, too: alpha_cg, p_l, chi, u_cr, f_u, ... `parameters` and `derived` have all of them,
/// and print(structure) shows them with units and equation numbers. A structure cannot be changed; `replace` makes another.
///
/// Raises ValueError where a number is unknown, missing, given twice in different ways or out of its range.
#[pyclass(frozen, eq, module = "flexible_rocking")]
#[derive(PartialEq)]
pub struct Structure(pub rocking::Structure);

fn given(numbers: Option<&Bound<'_, PyDict>>) -> PyResult<Given> {
    let mut given = Given::default();
    for (name, value) in numbers.into_iter().flatten() {
        let name: String = name.extract()?;
        given.give(&name, number(&name, &value)?).map_err(refused)?;
    }
    Ok(given)
}

impl Structure {
    fn of(parameters: Parameters) -> PyResult<Structure> {
        rocking::Structure::new(parameters).map(Structure).map_err(refused)
    }

    /// Its parameters by name.
    fn named(&self) -> impl Iterator<Item = (&'static str, f64)> {
        PARAMETERS.iter().map(|of| (of.name, (of.get)(self.0.parameters())))
    }
}

#[pymethods]
impl Structure {
    #[new]
    #[pyo3(signature = (*, preset=None, **numbers))]
    fn new(preset: Option<&Bound<'_, PyAny>>, numbers: Option<&Bound<'_, PyDict>>) -> PyResult<Structure> {
        let given = given(numbers)?;
        let parameters = match preset {
            None => given.parameters(),
            Some(preset) => given.over(&one_of("preset", preset, PRESETS)?),
        };
        Structure::of(parameters.map_err(refused)?)
    }

    /// This structure with other numbers in the place of its own, by the same names as in Structure(...).
    #[pyo3(signature = (**numbers))]
    fn replace(&self, numbers: Option<&Bound<'_, PyDict>>) -> PyResult<Structure> {
        Structure::of(given(numbers)?.over(self.0.parameters()).map_err(refused)?)
    }

    /// The parameters by name, in SI units.
    #[getter]
    fn parameters<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        self.named().try_for_each(|(name, value)| all.set_item(name, value))?;
        Ok(all)
    }

    /// The derived quantities by name: gamma, omega_fc (rad/s), k (N/m), u_cr (m), J_P (kg.m2), p_l (rad/s), alpha_cg (rad),
    /// chi, f_u (Hz), weight (kN), ...
    #[getter]
    fn derived<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        DERIVED.iter().try_for_each(|Derived { name, value, .. }| all.set_item(name, value(&self.0)))?;
        Ok(all)
    }

    /// The effective frequency of rocking with the amplitude theta (rad), Hz (Eq 14); 0 from tan(alpha_cg) on.
    ///
    /// Raises ValueError for a structure with a tendon or dissipators.
    fn effective_frequency(&self, theta: f64) -> PyResult<f64> {
        effective_frequency(&self.0, theta).map_err(refused)
    }

    /// The static pushover of Fig 1 to the right, from rest to overturning (Eqs 5 and 6 without inertia). Returns a dict of
    /// arrays (2 points,): theta (rad), u, delta_t (m), P (N), M (N.m). `points` of them are in full contact, and as many
    /// rock.
    ///
    /// Raises ValueError where the strut is too soft to hold the structure, and for other than 2 to 1,000,000 points.
    #[pyo3(signature = (points=100))]
    fn pushover<'py>(&self, py: Python<'py>, points: u32) -> PyResult<Bound<'py, PyDict>> {
        let structure = self.0;
        let curve = interruptible(py, move |_| pushover::curve(&structure, points))?;
        let column = |of: fn(&Equilibrium) -> f64| PyArray1::from_iter(py, curve.iter().map(of));
        let named = PyDict::new(py);
        named.set_item("theta", column(|at| at.theta))?;
        named.set_item("u", column(|at| at.u))?;
        named.set_item("delta_t", column(|at| at.delta_t))?;
        named.set_item("P", column(|at| at.force))?;
        named.set_item("M", column(|at| at.moment))?;
        Ok(named)
    }

    /// Splits the `response` of Run.at into the rocking and the vibration mode. Returns a dict of arrays (n,): q_r, q_u (rad,
    /// Eq 16), a_r, a_u (m/s2, Eqs 12, 19), NaN unless the structure rocks.
    ///
    /// Raises ValueError for a structure with a tendon or dissipators.
    fn modes<'py>(&self, response: &Bound<'py, PyDict>) -> PyResult<Bound<'py, PyDict>> {
        let of = |name: &str| -> PyResult<Bound<'py, PyAny>> {
            response.get_item(name)?.ok_or_else(|| PyValueError::new_err(format!("response has no {name:?}")))
        };
        let [theta, u, u_dot, a_g] = ["theta", "u", "u_dot", "a_g"].map(|name| numbers(name, &of(name)?));
        let motion = theta?.into_iter().zip(u?).zip(u_dot?).zip(a_g?);
        let mut modes = [const { Vec::new() }; 4];
        for (phase, (((theta, u), u_dot), a_g)) in of("phase")?.try_iter()?.zip(motion) {
            response.py().check_signals()?;
            let state = State { u, u_dot, theta, theta_dot: 0.0 }; // whose rate the split does not need
            let of = Modes::of(&self.0, &state).map_err(refused)?;
            let split = |side| {
                let accelerations = ModalAccelerations::of(&self.0, side, &state, a_g).map_err(refused)?;
                PyResult::Ok([of.q_r, of.q_u, accelerations.a_r, accelerations.a_u])
            };
            let split = match phase?.extract()? {
                "rocking left" => split(Side::Left)?,
                "rocking right" => split(Side::Right)?,
                _ => [f64::NAN; 4],
            };
            modes.iter_mut().zip(split).for_each(|(column, number)| column.push(number));
        }
        let named = PyDict::new(response.py());
        let mut columns = ["q_r", "q_u", "a_r", "a_u"].into_iter().zip(modes);
        columns.try_for_each(|(name, column)| named.set_item(name, PyArray1::from_vec(response.py(), column)))?;
        Ok(named)
    }

    fn __getattr__(&self, name: &str) -> PyResult<f64> {
        let derived = || DERIVED.iter().find(|of| of.name == name).map(|of| (of.value)(&self.0));
        let value = self.named().find_map(|(known, value)| (known == name).then_some(value)).or_else(derived);
        value.ok_or_else(|| PyAttributeError::new_err(format!("a Structure has no {name:?}")))
    }

    fn __dir__(slf: Bound<'_, Self>) -> PyResult<Vec<String>> {
        let own: Vec<String> =
            slf.py().import("builtins")?.getattr("object")?.call_method1("__dir__", (&slf,))?.extract()?;
        let numbers = PARAMETERS.iter().map(|of| of.name).chain(DERIVED.iter().map(|of| of.name));
        Ok(own.into_iter().chain(numbers.map(str::to_owned)).collect())
    }

    fn __repr__(&self) -> String {
        let numbers: Vec<_> = self.named().map(|(name, value)| format!("{name}={value:?}")).collect();
        format!("Structure({})", numbers.join(", "))
    }

    fn __str__(&self) -> PyResult<String> {
        describe::text(&self.0).map_err(refused)
    }

    pub fn __hash__(&self) -> u64 {
        let bits = |value: f64| (value + 0.0).to_bits(); // of -0 as of 0, which it equals
        self.named().fold(0, |hash, (_, value)| hash.rotate_left(7).wrapping_mul(31) ^ bits(value))
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<((), Bound<'py, PyDict>)> {
        Ok(((), self.parameters(py)?))
    }
}
