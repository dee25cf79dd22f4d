//! Structures of many masses from the keywords of Python.

use crate::arguments::{integer, matrix, number, numbers, refused};
use anyhow::anyhow;
use pyo3::exceptions::PyValueError;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rocking::names::unknown;
use rocking::structure::description::{Damping, Described, FloorAt, FoundMode, Storey, Total};
use rocking::structure::ground::NAMES;
use rocking::structure::natural_quantities::{Numbers, names, names_of_base};
use rocking::structure::quantity::Units;
use rocking::{Ground, Structure};
use serde::{Deserialize, de::IntoDeserializer};
use std::cell::RefCell;

/// Keywords that only a structure of many masses has.
pub const OF_MANY: [&str; 3] = ["storeys", "K", "mass"];

/// Pairs of keywords of which one stands for the other.
pub const INSTEAD: [[&str; 2]; 5] =
    [["B", "width"], ["m0", "weight0"], ["f", "period"], ["height", "moment"], ["I_2", "J_P"]];

/// Keywords that have not been read yet.
struct Keywords<'py> {
    left: Bound<'py, PyDict>,
    /// Names of all keywords that have been read, given or not.
    known: RefCell<Vec<&'static str>>,
}

impl<'py> Keywords<'py> {
    fn take(&self, name: &'static str) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.known.borrow_mut().push(name);
        let value = self.left.get_item(name)?;
        if value.is_some() {
            self.left.del_item(name)?;
        }
        Ok(value.filter(|value| !value.is_none()))
    }

    fn number(&self, name: &'static str) -> PyResult<Option<f64>> {
        self.take(name)?.map(|value| number(name, &value)).transpose()
    }

    /// The column of this `name`: nothing, or a number for each of the `rows` called `of`.
    fn column(&self, name: &'static str, rows: usize, of: &str) -> PyResult<Vec<Option<f64>>> {
        let Some(value) = self.take(name)? else { return Ok(vec![None; rows]) };
        let column = numbers(name, &value)?;
        if column.len() != rows {
            let needed = format!("{name} has {} numbers and must have {rows}, one for each {of}", column.len());
            return Err(PyValueError::new_err(needed));
        }
        Ok(column.into_iter().map(Some).collect())
    }
}

/// The structure of many masses that `keywords` describe.
pub fn frame(keywords: Bound<'_, PyDict>) -> PyResult<Structure> {
    if !OF_MANY.iter().any(|name| keywords.contains(name).unwrap_or(false)) {
        return given(&keywords)?.structure(None).map_err(refused);
    }
    let keywords = Keywords { left: keywords, known: RefCell::default() };
    let missing = |name: &str| PyValueError::new_err(format!("{name} is missing"));
    let zeta = keywords.take("zeta")?;
    let storeys = match keywords.take("storeys")? {
        Some(table) if table.hasattr("to_dict")? => {
            let message = "storeys is a table: give its rows as dicts, storeys=table.to_dict(\"records\")";
            return Err(PyValueError::new_err(message));
        }
        Some(rows) => rows.try_iter()?.enumerate().map(|(i, row)| storey(i + 1, &row?)).collect::<PyResult<_>>()?,
        None => Vec::new(),
    };
    let masses = keywords.take("masses")?.map(|masses| numbers("masses", &masses)).transpose()?.unwrap_or_default();
    let heights = keywords.column("heights", masses.len(), "mass")?;
    let floor = |(m, h): (f64, Option<f64>)| Ok(FloorAt { m, h: h.ok_or_else(|| missing("heights"))? });
    let floors = masses.into_iter().zip(heights).map(floor).collect::<PyResult<Vec<_>>>()?;
    let K = keywords.take("K")?.map(|K| matrix("K", &K)).transpose()?.unwrap_or_default();
    let modes = modes(&keywords)?;
    let [m_s, S_1, I_2, J_P] = ["m_s", "S_1", "I_2", "J_P"].map(|name| keywords.number(name));
    let total = match (m_s?, S_1?, I_2?, J_P?) {
        (None, None, None, None) => None,
        (m_s, S_1, I_2, J_P) => Some(Total {
            m_s: m_s.ok_or_else(|| missing("m_s (kg)"))?,
            S_1: S_1.ok_or_else(|| missing("S_1 (kg.m)"))?,
            I_2,
            J_P,
        }),
    };
    let ground = keywords.take("ground")?.map(|of| ground(&of)).transpose()?;
    let keep = keywords.take("keep")?.map(|keep| integer("keep", &keep)).transpose()?;
    let truth = |of: Bound<'_, PyAny>| {
        of.extract().map_err(|_| PyValueError::new_err(format!("p_delta = {of:?}: True or False is needed")))
    };
    let p_delta = keywords.take("p_delta")?.map_or(Ok(false), truth)?;
    let units = keywords.take("units")?.map_or(Ok(Units::default()), |of| units(&of))?;
    let is_unknown = |name: &String| name == "zeta_fc" || !names().any(|known| known == name);
    if let Some(name) = keywords.left.keys().extract::<Vec<String>>()?.into_iter().find(is_unknown) {
        let known = [keywords.known.take(), names_of_base().collect()].concat();
        return Err(refused(anyhow!(unknown(format_args!("{name:?} is unknown"), &name, &known))));
    }
    let zeta = damping(&zeta.ok_or_else(|| missing("zeta (damping ratio in full contact)"))?)?;
    let base = given(&keywords.left)?;
    let described = Described { units, zeta, storeys, p_delta, floors, K, modes, total, keep, base, ground };
    described.structure().map_err(refused)
}

/// The numbers of one mass, or of a base, by their names, in the keyword `units`.
pub fn given(keywords: &Bound<'_, PyDict>) -> PyResult<Numbers> {
    let (mut given, mut units) = (Numbers::default(), Units::default());
    for (name, value) in keywords {
        match name.extract::<String>()?.as_str() {
            "units" => units = self::units(&value)?,
            "ground" => given = given.on(ground(&value)?),
            // the message names an unknown keyword, whatever its value is
            name if !names().any(|known| known == name) => given.give(name, f64::NAN).map_err(refused)?,
            name => given.give(name, number(name, &value)?).map_err(refused)?,
        }
    }
    Ok(given.measured_in(units))
}

/// Refuses what is no ground that gives, where it is written.
#[pyfunction]
pub fn check_ground(value: &Bound<'_, PyAny>) -> PyResult<()> {
    ground(value).map(drop)
}

/// Ground that gives, from flexible_rocking.Ground or a dict with its names.
fn ground(value: &Bound<'_, PyAny>) -> PyResult<Ground> {
    let wrong = || PyValueError::new_err(format!("ground = {value:?}: flexible_rocking.Ground(f_v=...) is needed"));
    let mut ground = Ground::default();
    for (name, value) in value.cast::<PyDict>().map_err(|_| wrong())? {
        let name = name.extract::<String>()?;
        let one = || number(&name, &value).map(Some);
        match name.as_str() {
            "f_v" => ground.f_v = one()?,
            "k_v" => ground.k_v = one()?,
            "zeta_v" => ground.zeta_v = one()?,
            "c_v" => ground.c_v = one()?,
            "kr_ratio" => ground.kr_ratio = one()?,
            "k_r" => ground.k_r = one()?,
            "n_points" => ground.n_points = one()?,
            "xi" => ground.xi = numbers(&name, &value)?,
            "k" => ground.k = numbers(&name, &value)?,
            "c" => ground.c = numbers(&name, &value)?,
            _ => {
                return Err(refused(anyhow!(unknown(format_args!("ground: {name:?} is unknown"), &name, &NAMES))));
            }
        }
    }
    Ok(ground)
}

fn units(value: &Bound<'_, PyAny>) -> PyResult<Units> {
    let units = Units::deserialize(value.str()?.to_str()?.into_deserializer());
    units.map_err(|error: serde::de::value::Error| PyValueError::new_err(format!("units: {error}")))
}

fn storey(i: usize, row: &Bound<'_, PyAny>) -> PyResult<Storey> {
    let wrong = || PyValueError::new_err(format!("storey {i} = {row:?}: dict(m=..., h=..., k=...) is needed"));
    let row = row.cast::<PyDict>().map_err(|_| wrong())?;
    let of = |name: &str| number(&format!("storey {i}: {name}"), &row.get_item(name)?.ok_or_else(wrong)?);
    if row.len() == 3 { Ok(Storey { m: of("m")?, h: of("h")?, k: of("k")? }) } else { Err(wrong()) }
}

fn damping(zeta: &Bound<'_, PyAny>) -> PyResult<Damping> {
    if let Ok(rayleigh) = zeta.cast::<PyDict>() {
        let wrong = || PyValueError::new_err(format!("zeta = {zeta:?}: dict(f=(Hz, Hz), zeta=...) is needed"));
        let of = |name: &str| rayleigh.get_item(name)?.ok_or_else(wrong);
        let f = numbers("f", &of("f")?)?.try_into().map_err(|_| wrong())?;
        return Ok(Damping::Rayleigh { f, zeta: number("zeta", &of("zeta")?)? });
    }
    match number("zeta", zeta) {
        Ok(zeta) => Ok(Damping::All(zeta)),
        Err(_) => Ok(Damping::Each(numbers("zeta", zeta)?)),
    }
}

/// The modes by columns; the shapes by a column for each mode.
fn modes(keywords: &Keywords) -> PyResult<Vec<FoundMode>> {
    let Some(mass) = keywords.take("mass")? else { return Ok(Vec::new()) };
    let mass = numbers("mass", &mass)?;
    let [f, period, height, moment] =
        ["f", "period", "height", "moment"].map(|name| keywords.column(name, mass.len(), "mode"));
    let (f, period, height, moment) = (f?, period?, height?, moment?);
    let shapes = keywords.take("shapes")?.map(|shapes| matrix("shapes", &shapes)).transpose()?.unwrap_or_default();
    if let Some(row) = shapes.iter().find(|row| row.len() != mass.len()) {
        let needed = format!("shapes has {} columns and must have {}, one for each mode", row.len(), mass.len());
        return Err(PyValueError::new_err(needed));
    }
    let mode = |(j, mass)| {
        let shape = shapes.iter().map(|floor| floor[j]).collect();
        FoundMode { f: f[j], period: period[j], mass, height: height[j], moment: moment[j], shape }
    };
    Ok(mass.into_iter().enumerate().map(mode).collect())
}
