//! `Structure`: parameters and what follows from them, by the names in the library's tables.

use crate::arguments::{number, one_of, refused};
use pyo3::exceptions::PyAttributeError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rocking::Parameters;
use rocking::estimates::effective_frequency::effective_frequency;
use rocking::structure::natural_quantities::Given;
use rocking::structure::parameters::PARAMETERS;
use rocking::structure::{DERIVED, Derived};
use rocking_cli::describe;

/// A flexible structure on a base that may lift off (Fig 2 of the paper).
///
/// Structure(m=4e5, m0=1e5, H=9, B=1.5, J0=1e5, f_fc=2.5, zeta_fc=0.03, r=0.95)
/// Structure(preset="mcmanus", f_fc=8)
///
/// Every number is a keyword, and an attribute; SI units. Parameters: m, m0 (kg), H, B (m), J0 (kg.m2, 0), f_fc (Hz),
/// zeta_fc, c_ratio (1), r, g (m/s2, 9.81); the values in brackets are what they are if they are left out. In the place
/// of a parameter: period_fc (s) for f_fc, weight and weight0 (kN) for m and m0, width (m) for B, alpha_cg (rad) for H,
/// or for B where H is given, p_l (rad/s) for J0. With preset, "mcmanus" or "evison", the specimen of the paper with
/// these numbers in the place of its own.
///
/// What follows from them is an attribute, too: alpha_cg, p_l, chi, u_cr, f_u, ...; `parameters` and `derived` have all
/// of them, print(structure) shows them with units and equation numbers. A structure cannot be changed; `replace` makes
/// another.
///
/// Raises ValueError where a number is unknown, missing, given twice in different ways or out of its range.
#[pyclass(frozen, module = "flexible_rocking")]
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
    fn new(preset: Option<&str>, numbers: Option<&Bound<'_, PyDict>>) -> PyResult<Structure> {
        let given = given(numbers)?;
        let parameters = match preset {
            None => given.parameters(),
            Some(preset) => {
                let presets = [("evison", Parameters::EVISON), ("mcmanus", Parameters::MCMANUS)];
                given.over(&one_of("preset", preset, presets)?)
            }
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

    /// What follows from the parameters, by name: gamma, omega_fc (rad/s), k (N/m), u_cr (m), J_P (kg.m2), p_l (rad/s),
    /// alpha_cg (rad), chi, f_u (Hz), weight (kN), ...
    #[getter]
    fn derived<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let all = PyDict::new(py);
        DERIVED.iter().try_for_each(|Derived { name, value, .. }| all.set_item(name, value(&self.0)))?;
        Ok(all)
    }

    /// The effective frequency of rocking with the amplitude theta (rad), Hz (Eq 14); 0 from tan(alpha_cg) on.
    fn effective_frequency(&self, theta: f64) -> f64 {
        effective_frequency(&self.0, theta)
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

    fn __eq__(&self, other: &Structure) -> bool {
        self.0 == other.0
    }

    fn __hash__(&self) -> u64 {
        self.named().fold(0, |hash, (_, value)| hash.rotate_left(7).wrapping_mul(31) ^ value.to_bits())
    }

    fn __getnewargs_ex__<'py>(&self, py: Python<'py>) -> PyResult<((), Bound<'py, PyDict>)> {
        Ok(((), self.parameters(py)?))
    }
}
