//! Structures of many masses from the numbers that engineers have: storeys, matrices, or the modes that another program found.
//!
//! Each way ends in a [`Structure`]. A mode with the shape φ, of the modal mass φᵀMφ = 1, has
//!
//! ```text
//! ω² = φᵀKφ,   effective mass Γ² with Γ = φᵀM1,   effective height κ/Γ with κ = φᵀMh
//! ```

use crate::digits::short;
pub use crate::structure::described::{
    Damping, DescribedNumber, Description, FloorAt, FoundMode, ManyMasses, Storey, Total,
};
use crate::structure::described::{DampingOfFile, STOREY, ZETA};
use crate::structure::ground::Ground;
use crate::structure::mode::{MOST_MODES, Modes, OF_FLOOR};
use crate::structure::natural_quantities::{self, Numbers};
use crate::structure::parameters::MAX_SLENDERNESS;
use crate::structure::quantity::{Quantity, Refused, Units, ensure, ensure_in};
use crate::structure::{check_count, of_number};
use crate::{Body, Floor, Mode, Parameters, Structure};
use nalgebra::{DMatrix, DVector};
use serde::Deserialize;
use std::f64::consts::TAU;

/// A structure of many masses as a file has it, in one of three ways.
#[derive(Clone, Debug, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Described {
    /// Units of masses and forces.
    #[serde(default)]
    pub units: Units,
    /// The base: m0, B, J0, r, g, c_ratio, the tendon and the dissipators.
    #[serde(deserialize_with = "natural_quantities::base")]
    pub base: Numbers,
    /// Damping in full contact.
    #[serde(with = "DampingOfFile")]
    pub zeta: Damping,
    /// The storeys from the base up.
    #[serde(default)]
    pub storeys: Vec<Storey>,
    /// Whether the weights above soften each storey ([`with_p_delta`]).
    #[serde(default)]
    pub p_delta: bool,
    /// The floors from the base up, with the matrix K or with modes.
    #[serde(default)]
    pub floors: Vec<FloorAt>,
    /// Stiffness matrix by rows, N/m.
    #[serde(default)]
    pub K: Vec<Vec<f64>>,
    /// The modes, lowest frequency first.
    #[serde(default)]
    pub modes: Vec<FoundMode>,
    /// All mass above the base, with modes; without it the floors have all mass.
    pub total: Option<Total>,
    /// Ground that gives; without it rigid ground.
    pub ground: Option<Ground>,
    /// Number of modes that are kept, lowest frequency first; without it all. The rest of the mass turns rigidly with the base.
    pub keep: Option<i64>,
}

const ENTRY: Quantity<f64> = Quantity::limit("K", "N/m", [-1e18, 1e18], "stiffness");
const RAYLEIGH: Quantity<f64> =
    Quantity::limit("zeta", "1", [0.0, 10.0], "damping ratio of a mode by Rayleigh damping");
const F: Quantity<f64> = Quantity::limit("f", "Hz", [1e-3, 1e4], "frequency in full contact");
const PERIOD: Quantity<f64> = Quantity::limit("period", "s", [1e-4, 1e3], "period in full contact");
const MASS: Quantity<f64> =
    Quantity::limit("mass", "kg", [1e-6, 1e12], "effective mass along the record; leave out a mode without such mass");
const HEIGHT: Quantity<f64> = Quantity::limit("height", "m", [-1e4, 1e4], "effective height");
const MOMENT: Quantity<f64> = Quantity::limit("moment", "kg.m", [-1e16, 1e16], "effective mass times effective height");
const SHAPE: Quantity<f64> = Quantity::limit("shape", "1", [-1e12, 1e12], "displacement of a floor");

/// The most floors of a structure, whose modes take a time that grows with the cube of the number.
const MOST_FLOORS: usize = 500;

/// Part of a first moment by which the modes may miss what is possible, as their numbers are rounded.
const ROUNDING: f64 = 1e-3;

/// Part of a shape's effective mass that may differ from the mode's, because floors stand for distributed mass.
const SHAPE_TOLERANCE: f64 = 0.1;

/// Part of its largest floor's height by which a shape's effective height may differ from the mode's.
const HEIGHT_TOLERANCE: f64 = 0.1;

/// Least part of m_s that modes must carry. A mast on a heavy block carries little; tonnes in the place of kg are less.
const LEAST_SHARE: f64 = 0.01;

/// Part of its diagonal by which K may differ from its transpose.
const ASYMMETRY: f64 = 1e-6;

/// Mass, first and second moment of the masses of `floors`.
fn moments(floors: &[FloorAt]) -> [f64; 3] {
    let add =
        |[mass, first, second]: [f64; 3], &FloorAt { m, h }: &FloorAt| [mass + m, first + m * h, second + m * h * h];
    floors.iter().fold([0.0; 3], add)
}

impl Described {
    /// The structure that is described. Messages name the numbers in their own units.
    pub fn structure(self) -> Result<Structure, Refused> {
        let units = self.units;
        let structure = self.in_si().and_then(|description| description.structure());
        Ok(structure.map_err(|error| error.in_units(units))?.measured_in(units))
    }

    fn in_si(self) -> Result<Description, Refused> {
        let Described {
            units,
            base,
            zeta,
            mut storeys,
            p_delta,
            mut floors,
            mut K,
            mut modes,
            mut total,
            ground,
            keep,
        } = self;
        let to_si = |of: &Quantity<f64>, value: &mut f64| *value = units.in_si(*value, of.unit);
        for Storey { m, k, .. } in &mut storeys {
            to_si(&MASS, m);
            to_si(&STOREY, k);
        }
        floors.iter_mut().for_each(|floor| to_si(&MASS, &mut floor.m));
        K.iter_mut().flatten().for_each(|entry| to_si(&ENTRY, entry));
        for FoundMode { mass, moment, .. } in &mut modes {
            to_si(&MASS, mass);
            moment.iter_mut().for_each(|moment| to_si(&MOMENT, moment));
        }
        if let Some(Total { m_s, S_1, I_2, J_P }) = &mut total {
            to_si(&MASS, m_s);
            to_si(&MOMENT, S_1);
            [I_2, J_P].into_iter().flatten().for_each(|second| *second = units.in_si(*second, "kg.m2"));
        }
        let many = ManyMasses { zeta, storeys, p_delta, floors, K, modes, total, keep };
        let ground = ground.map(|ground| ground.in_si(units));
        Ok(Description { ground, ..Description::of_many(&base.measured_in(units), many)? })
    }
}

impl Description {
    /// Many masses on the `base` on rigid ground.
    fn of_many(base: &Numbers, many: ManyMasses) -> Result<Description, Refused> {
        let (parameters, r) = base.base().map_err(|error| error.of("base"))?;
        let parameters = Parameters { r: r.unwrap_or(f64::NAN), ..parameters };
        Ok(Description { parameters, many: Some(many), ground: None })
    }

    /// The structure of these numbers.
    pub fn structure(&self) -> Result<Structure, Refused> {
        let Some(many) = &self.many else {
            let by_momentum = self.parameters.r.is_nan();
            let r = if by_momentum { 1.0 } else { self.parameters.r };
            let one = Structure::new(Parameters { r, ..self.parameters })?;
            let body = Body { r: None, ..*one.body() };
            let one = if by_momentum { Structure::of_body(body, one.modes(), one.floors())? } else { one };
            return Ok(one.on(&self.ground)?.described_as(self.clone()));
        };
        let ManyMasses { zeta, storeys, p_delta, floors, K, modes, total, keep } = many;
        let base = &self.parameters;
        let whole = match [storeys.is_empty(), K.is_empty(), modes.is_empty()] {
            [false, true, true] if floors.is_empty() && total.is_none() => match p_delta {
                true => of_storeys(base, zeta, &with_p_delta(base, storeys)?),
                false => of_storeys(base, zeta, storeys),
            },
            _ if *p_delta => Err(Refused::by(
                "p_delta = true needs storeys: subtract the geometric stiffness from K, or give modes that contain it",
            )),
            [true, false, true] if total.is_none() => of_matrices(base, zeta, floors, K),
            [true, true, false] => of_modes(base, zeta, modes, *total, floors),
            ways => {
                let given = if ways == [true; 3] { "none of these" } else { "more than one" };
                let ways = "storeys (m, h, k), floors (m, h) with the matrix K, or modes";
                Err(Refused::by(format!("give the structure in one way: {ways}; not {given}")))
            }
        }?;
        let whole = whole.on(&self.ground)?;
        let described = |whole: Structure| whole.described_as(self.clone());
        let (Some(count), modes) = (*keep, whole.modes().len()) else { return Ok(described(whole)) };
        ensure((1..=modes as i64).contains(&count), || {
            let instead = if count == 0 { ", or use detail = rigid" } else { "" };
            format!("keep = {count} is out of range: keep 1 to {modes} modes{instead}")
        })?;
        whole.keeping(count as usize).map(described)
    }
}

/// The `storeys` under their weight. The geometric stiffness of the weight P_i of the floors from i on, over the height of storey i
/// (Wilson, Three-Dimensional Static and Dynamic Analysis of Structures, Eq 11.3 with T = −P; read),
///
/// ```text
/// k_i − P_i/(h_i − h_{i−1}),   P_i = g Σ_{j ≥ i} m_j     (N/m)
/// ```
///
/// is linear in the drift, and P_i is the weight at rest. An error names a storey whose k does not exceed P_i/(h_i − h_{i−1}).
pub fn with_p_delta(base: &Parameters, storeys: &[Storey]) -> Result<Vec<Storey>, Refused> {
    let (floors, g) = (checked_storeys(storeys)?, base.g);
    let soften = |(i, &Storey { m, h, k }): (usize, &Storey)| {
        let weight: f64 = floors[i..].iter().map(|floor| g * floor.m).sum();
        let least = weight / (h - if i == 0 { 0.0 } else { floors[i - 1].h });
        ensure_in(k > least, |units| {
            let [given, least] = [k, least].map(|k| units.show(k, STOREY.unit));
            format!(
                "storey {}: k = {given} does not exceed P/h = {least}, at which the weight P above buckles the storey of height h: \
                 raise k, or leave p_delta out",
                i + 1
            )
        })?;
        Ok(Storey { m, h, k: k - least })
    };
    storeys.iter().enumerate().map(soften).collect()
}

/// The floors of the `storeys`, whose numbers and order are checked.
fn checked_storeys(storeys: &[Storey]) -> Result<Vec<FloorAt>, Refused> {
    for (number, storey) in (1..).zip(storeys) {
        STOREY.check(storey.k).map_err(|cause| of_number("storey", number, cause))?;
    }
    let floors: Vec<_> = storeys.iter().map(|&Storey { m, h, .. }| FloorAt { m, h }).collect();
    check_floors(&floors, 1)?;
    (1..floors.len()).try_for_each(|i| check_order(i + 1, floors[i].h, floors[i - 1].h, false))?;
    Ok(floors)
}

/// Refuses floor `number` at the height `h` (m) below the one before at `below`, and unless `may_be_same` at its height.
fn check_order(number: usize, h: f64, below: f64, may_be_same: bool) -> Result<(), Refused> {
    ensure(h > below || may_be_same && h == below, || {
        format!(
            "floor {number} is at h = {h} m and the floor below it at {below} m: h is the height above the base, from the lowest floor up"
        )
    })
}

impl Structure {
    /// A shear building of these `storeys` on rigid ground.
    pub fn from_storeys(base: &Numbers, zeta: &Damping, storeys: &[Storey]) -> Result<Structure, Refused> {
        let (zeta, storeys) = (zeta.clone(), storeys.to_vec());
        let many = ManyMasses {
            zeta,
            storeys,
            p_delta: false,
            floors: vec![],
            K: vec![],
            modes: vec![],
            total: None,
            keep: None,
        };
        Description::of_many(base, many)?.structure()
    }
}

/// A shear building, whose storeys resist the drift between its floors.
fn of_storeys(base: &Parameters, damping: &Damping, storeys: &[Storey]) -> Result<Structure, Refused> {
    let floors = checked_storeys(storeys)?;
    let mut K = vec![vec![0.0; storeys.len()]; storeys.len()];
    for (i, &Storey { k, .. }) in storeys.iter().enumerate() {
        K[i][i] += k;
        if let Some(below) = i.checked_sub(1) {
            K[below][below] += k;
            K[below][i] -= k;
            K[i][below] -= k;
        }
    }
    of_matrices(base, damping, &floors, &K)
}

/// Floors that the stiffness matrix `K` (N/m) of a fixed base connects.
fn of_matrices(base: &Parameters, damping: &Damping, floors: &[FloorAt], K: &[Vec<f64>]) -> Result<Structure, Refused> {
    check_floors(floors, 1)?;
    let n = floors.len();
    length("K", K.len(), n, "floor")?;
    for (i, row) in K.iter().enumerate() {
        length(&format!("K[{}]", i + 1), row.len(), n, "floor")?;
        let checked = row.iter().try_for_each(|entry| ENTRY.check(*entry));
        checked.map_err(|cause| of_number("row", i + 1, cause))?;
    }
    for (i, j) in (0..n).flat_map(|i| (0..i).map(move |j| (i, j))) {
        let (value, mirrored) = (K[i][j], K[j][i]);
        let (off, row, column) = ((value - mirrored).abs(), i + 1, j + 1);
        ensure_in(off <= ASYMMETRY * (K[i][i] * K[j][j]).abs().sqrt(), |units| {
            let [value, mirrored] = [value, mirrored].map(|k| units.show_by(|k| k.to_string(), k, ENTRY.unit));
            format!("K[{row}][{column}] = {value} and K[{column}][{row}] = {mirrored}: K must be symmetric")
        })?;
    }
    let root = |i: usize| floors[i].m.sqrt();
    let eigen = DMatrix::from_fn(n, n, |i, j| 0.5 * (K[i][j] + K[j][i]) / (root(i) * root(j))).symmetric_eigen();
    let mut squares: Vec<_> = eigen.eigenvalues.iter().copied().enumerate().collect();
    squares.sort_by(|a, b| a.1.total_cmp(&b.1));
    let shape = |column: usize| DVector::from_fn(n, |i, _| eigen.eigenvectors[(i, column)] / root(i));
    let (lowest, omega_2) = squares[0];
    ensure(omega_2 > n as f64 * f64::EPSILON * squares[n - 1].1, || {
        let floor = shape(lowest).icamax() + 1;
        format!(
            "K is not positive definite: a mode has omega^2 = {omega_2:.3e} 1/s2, in which floor {floor} moves most; K must hold \
                 each floor to a base that cannot move"
        )
    })?;
    squares.truncate(MOST_MODES);
    let omegas: Vec<_> = squares.iter().map(|(_, square)| square.sqrt()).collect();
    let shapes: Vec<_> = squares.iter().map(|(column, _)| shape(*column)).collect();
    let part = |shape: &DVector<f64>, with: fn(&FloorAt) -> f64| -> f64 {
        shape.iter().zip(floors).map(|(phi, floor)| phi * with(floor)).sum()
    };
    let participation = |shape| (part(shape, |floor| floor.m), part(shape, |floor| floor.m * floor.h));
    let modes = modes(&omegas, damping, &shapes.iter().map(participation).collect::<Vec<_>>())?;
    checked(Structure::of_body(body(base, moments(floors))?, &modes, &shown(floors, &shapes))?)
}

/// The modes of a fixed base that another program found. Without a `total`, the floors have all mass.
fn of_modes(
    base: &Parameters,
    damping: &Damping,
    modes_found: &[FoundMode],
    total: Option<Total>,
    floors: &[FloorAt],
) -> Result<Structure, Refused> {
    check_floors(floors, 0)?;
    let (mut omegas, mut participations) = (Vec::new(), Vec::new());
    for (number, found) in (1..).zip(modes_found) {
        let at = |cause| of_number("mode", number, cause);
        let either = |one: &str, other: &str, unit: &str| {
            Refused::shown(|units| {
                let unit = units.name(unit);
                format!("mode {number} needs {one} or {other} ({unit}), and not both")
            })
        };
        MASS.check(found.mass).map_err(at)?;
        let f = match (found.f, found.period) {
            (Some(f), None) => Ok(f),
            (None, Some(period)) => PERIOD.check(period).map(|()| period.recip()),
            _ => return Err(either("f (Hz)", "period", "s")),
        };
        let height = match (found.height, found.moment) {
            (Some(height), None) => HEIGHT.check(height).map(|()| height),
            (None, Some(moment)) => MOMENT.check(moment).map(|()| moment / found.mass),
            _ => return Err(either("height (m)", "moment", MOMENT.unit)),
        };
        let (omega, root) = (TAU * f.map_err(at)?, found.mass.sqrt());
        let before: f64 = omegas.last().copied().unwrap_or(0.0);
        ensure(before <= omega, || {
            let [f, before] = [omega, before].map(|omega| short(omega / TAU));
            format!("mode {number} has f = {f} Hz and the mode before it {before} Hz: give the lowest mode first")
        })?;
        let height = height.map_err(at)?;
        omegas.push(omega);
        participations.push((root, root * height));
    }
    let modes = modes(&omegas, damping, &participations)?;
    let body = body(base, whole(base, total, floors)?)?;
    let (of_modes, m_s) = (modes_found.iter().map(|mode| mode.mass).sum::<f64>(), body.m_s);
    ensure_in(of_modes >= LEAST_SHARE * m_s, |units| {
        format!(
            "the modes carry {:.2} % of m_s = {} above the foundation, and {} % are needed: check the units of the masses, \
                 and that the modes vibrate along the record",
            1e2 * of_modes / m_s,
            units.show(m_s, "kg"),
            1e2 * LEAST_SHARE
        )
    })?;
    let floors = if modes_found.iter().all(|mode| mode.shape.is_empty()) { &[] } else { floors };
    let heights = participations.iter().map(|(gamma, kappa)| kappa / gamma);
    let shapes = (1..).zip(modes_found.iter().zip(heights));
    let shapes = shapes.map(|(number, (found, height))| shape(number, found, height, floors));
    let shapes = shapes.collect::<Result<Vec<_>, _>>()?;
    let frame = Structure::of_body(body, &modes, &shown(floors, &shapes))?;
    // no mass has a first moment beyond the root of the product of its mass and its second moment
    let [mass, rest, second] = frame.rest();
    let limit = (mass * second).max(0.0).sqrt() + ROUNDING * (body.m_s * body.I_2).sqrt();
    ensure_in(rest.abs() <= limit, |units| {
        let S_1 = units.show_by(|of| of.to_string(), body.S_1, MOMENT.unit);
        let [rest, limit] = [rest, limit].map(|of| units.show_by(|of| format!("{of:.3e}"), of, MOMENT.unit));
        format!(
            "S_1 = {S_1} does not fit m_s and I_2: the mass that the modes leave over would have the first moment {rest}, \
                 beyond {limit}; check the units of h and the sum of m h"
        )
    })?;
    checked(frame)
}

/// The `frame` unless it is too slender.
fn checked(frame: Structure) -> Result<Structure, Refused> {
    let &Body { m_s, S_1, B, .. } = frame.body();
    let slenderness = S_1 / (m_s * B);
    ensure(slenderness <= MAX_SLENDERNESS, || {
        format!(
            "the centre of the mass above the base is {slenderness:.1} B high: it must not exceed {MAX_SLENDERNESS} B; raise B"
        )
    })?;
    Ok(frame)
}

/// The base with these `parameters` under mass of these moments m_s, S_1 and I_2.
fn body(parameters: &Parameters, moments: [f64; 3]) -> Result<Body, Refused> {
    let r = Some(parameters.r).filter(|r| !r.is_nan());
    let checked = Parameters { r: r.unwrap_or(1.0), ..*parameters }.check();
    checked.map_err(|error| error.of("base"))?;
    Ok(Body::of(parameters, r, moments))
}

/// The modes of the frequencies `omegas` (rad/s) with these Γ and κ.
fn modes(omegas: &[f64], damping: &Damping, participations: &[(f64, f64)]) -> Result<Vec<Mode>, Refused> {
    check_count(omegas.len())?;
    for (number, omega) in (1..).zip(omegas) {
        F.check(omega / TAU).map_err(|cause| of_number("mode", number, cause))?;
    }
    let modes = omegas.iter().zip(damping.ratios(omegas)?).zip(participations);
    Ok(modes.map(|((omega, zeta), (gamma, kappa))| Mode::new(*omega, zeta, *gamma, *kappa)).collect())
}

/// The `floors` with a shape of each mode.
fn shown(floors: &[FloorAt], shapes: &[DVector<f64>]) -> Vec<Floor> {
    let of_floor = |i: usize| Modes::new(&shapes.iter().map(|shape| shape[i]).collect::<Vec<_>>());
    floors.iter().enumerate().map(|(i, &FloorAt { m, h })| Floor { mass: m, height: h, shape: of_floor(i) }).collect()
}

/// Checks that there are `least` floors or more, their numbers and their order.
fn check_floors(floors: &[FloorAt], least: usize) -> Result<(), Refused> {
    let given = floors.len();
    ensure((least..=MOST_FLOORS).contains(&given), || {
        format!("{given} floors are given: a structure has 1 to {MOST_FLOORS}")
    })?;
    let mut below = 0.0;
    for (number, &FloorAt { m, h }) in (1..).zip(floors) {
        let fits = OF_FLOOR[0].check(m).and_then(|()| OF_FLOOR[1].check(h));
        fits.map_err(|cause| of_number("floor", number, cause))?;
        check_order(number, h, below, true)?;
        below = h;
    }
    Ok(())
}

fn length(what: &str, count: usize, needed: usize, of: &str) -> Result<(), Refused> {
    ensure(count == needed, || format!("{what} has {count} numbers and must have {needed}, one for each {of}"))
}

impl Damping {
    /// The ratio of each mode of the frequencies `omegas` (rad/s).
    fn ratios(&self, omegas: &[f64]) -> Result<Vec<f64>, Refused> {
        let (ratios, limit) = match self {
            Damping::All(zeta) => (vec![*zeta; omegas.len()], ZETA),
            Damping::Each(zetas) => {
                length("zeta", zetas.len(), omegas.len(), "mode")?;
                (zetas.clone(), ZETA)
            }
            Damping::Rayleigh { f: [a, b], zeta } => {
                [a, b].into_iter().try_for_each(|f| F.check(*f))?;
                ZETA.check(*zeta)?;
                let ratio = |omega: &f64| zeta * (TAU * a * b / omega + omega / TAU) / (a + b);
                (omegas.iter().map(ratio).collect(), RAYLEIGH)
            }
        };
        ratios.iter().try_for_each(|zeta| limit.check(*zeta))?;
        Ok(ratios)
    }
}

/// The moments m_s, S_1 and I_2 of all mass above the base.
fn whole(base: &Parameters, total: Option<Total>, floors: &[FloorAt]) -> Result<[f64; 3], Refused> {
    let Some(Total { m_s, S_1, I_2, J_P }) = total else {
        ensure_in(!floors.is_empty(), |units| {
            let [kg, kg_m, kg_m2] = ["kg", "kg.m", "kg.m2"].map(|unit| units.name(unit));
            format!(
                "modes need the total m_s ({kg}), S_1 ({kg_m}) and I_2 ({kg_m2}) of the mass above the base, or the floors that have it"
            )
        })?;
        return Ok(moments(floors));
    };
    let I_2 = match (I_2, J_P) {
        (Some(I_2), None) => I_2,
        (None, Some(J_P)) => {
            let &Parameters { m0, J0, B, .. } = base;
            J_P - J0 - (m0 + m_s) * B * B
        }
        _ => {
            return Err(Refused::shown(|units| {
                let unit = units.name("kg.m2");
                format!("I_2 ({unit}) or J_P ({unit}) is needed, and not both")
            }));
        }
    };
    Ok([m_s, S_1, I_2])
}

/// The shape of a mode at the `floors`, for the modal mass 1.
fn shape(number: usize, found: &FoundMode, height: f64, floors: &[FloorAt]) -> Result<DVector<f64>, Refused> {
    length(&format!("the shape of mode {number}"), found.shape.len(), floors.len(), "floor")?;
    let checked = found.shape.iter().try_for_each(|phi| SHAPE.check(*phi));
    checked.map_err(|cause| of_number("mode", number, cause))?;
    let sum = |term: fn(f64, &FloorAt) -> f64| {
        found.shape.iter().zip(floors).map(|(phi, floor)| floor.m * term(*phi, floor)).sum::<f64>()
    };
    let (gamma, modal_mass) = (sum(|phi, _| phi), sum(|phi, _| phi * phi));
    let effective = if modal_mass > 0.0 { gamma * gamma / modal_mass } else { 0.0 };
    let given = found.mass;
    ensure_in(floors.is_empty() || (effective - given).abs() <= SHAPE_TOLERANCE * given, |units| {
        let [effective, given] = [effective, given].map(|m| units.show_by(|m| format!("{m:.5e}"), m, MASS.unit));
        format!(
            "the shape of mode {number} has the effective mass {effective} with the masses of the floors, but mass = {given}: \
             check the order of the floors and of the modes"
        )
    })?;
    let (of_shape, top) = (sum(|phi, floor| phi * floor.h) / gamma, floors.last().map_or(0.0, |floor| floor.h));
    ensure(floors.is_empty() || (of_shape - height).abs() <= HEIGHT_TOLERANCE * top, || {
        format!(
            "the shape of mode {number} has the effective height {of_shape:.5} m with the floors, but the mode has {height:.5} m: \
             check the order of the floors in the shape"
        )
    })?;
    let scale = modal_mass.sqrt().copysign(gamma);
    Ok(DVector::from_iterator(floors.len(), found.shape.iter().map(|phi| phi / scale)))
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    pub(crate) fn usual() -> Numbers {
        Numbers::of(&[("m0", 20e3), ("J0", 3e4), ("B", 1.5), ("r", 0.93)]).unwrap()
    }

    pub(crate) const STOREYS: [Storey; 3] = [
        Storey { m: 40e3, h: 3.5, k: 60e6 },
        Storey { m: 40e3, h: 7.0, k: 50e6 },
        Storey { m: 30e3, h: 10.5, k: 40e6 },
    ];

    /// Three storeys whose response is known.
    pub(crate) fn three_storeys() -> Structure {
        Structure::from_storeys(&usual(), &Damping::All(0.02), &STOREYS).unwrap()
    }

    #[test]
    fn a_structure_whose_base_was_changed_can_be_made_of_its_numbers() {
        let frame = three_storeys();
        let wide = frame.with(Parameters { B: 2.0, ..frame.parameters() }).unwrap();
        assert!(wide.description().unwrap().structure().unwrap() == wide);
    }

    /// C = α M + β K through the ratios of its modes.
    #[test]
    fn rayleigh_damping_has_its_ratio_at_both_frequencies() {
        let f = [2.0, 9.0];
        let ratios = Damping::Rayleigh { f, zeta: 0.05 }.ratios(&[TAU * 2.0, TAU * 4.0, TAU * 9.0]).unwrap();
        assert_relative_eq!(ratios[0], 0.05, max_relative = 1e-14);
        assert_relative_eq!(ratios[1], 0.05 * (2.0 * 9.0 / 4.0 + 4.0) / 11.0, max_relative = 1e-14);
        assert_relative_eq!(ratios[2], 0.05, max_relative = 1e-14);
    }

    proptest! {
        /// Up to 24 storeys the modes carry all mass; of more, the rest is a possible mass.
        #[test]
        fn the_modes_and_the_rest_have_all_mass_of_the_storeys(
            storeys in prop::collection::vec((1e3..1e6f64, 2.0..6.0f64, 1e6..1e9f64), 1..=30),
        ) {
            let mut h = 0.0;
            let storey = |(m, rise, k)| {
                h += rise;
                Storey { m, h, k }
            };
            let storeys: Vec<_> = storeys.into_iter().map(storey).collect();
            let frame = Structure::from_storeys(&usual(), &Damping::All(0.02), &storeys).unwrap();
            prop_assert!(frame.modes().is_sorted_by(|a, b| a.stiffness <= b.stiffness));
            let ([mass, first, second], Body { m_s, I_2, .. }) = (frame.rest(), frame.body());
            if storeys.len() <= MOST_MODES {
                prop_assert_eq!([mass, first, second], [0.0; 3]);
            } else {
                prop_assert!(mass >= 0.0 && second >= 0.0, "{mass}, {second}");
                let limit = (mass * second).sqrt() + 1e-6 * (m_s * I_2).sqrt();
                prop_assert!(first.abs() <= limit, "{mass} {first} {second} of {m_s} and {I_2}");
            }
        }
    }
}
