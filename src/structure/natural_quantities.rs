//! Parameters from the numbers that engineers have at hand, each of which stands for one parameter.
//!
//! | given | stands for | by |
//! |---|---|---|
//! | `period_fc` | f_fc | f_fc = 1/period_fc |
//! | `weight`, `weight0` | m, m0 | m = weight/g, m0 = weight0/g |
//! | `width` | B | B = width/2 |
//! | `alpha_cg` | H, or B if H is given | tan α_cg = γ B/H, γ = (m + m0)/m (before Eq 11) |
//! | `p_l` | J0 | J_P = m g H/p_l² = J0 + m (H² + B²) + m0 B² (before Eq 11, after Eq 8) |
//!
//! A natural quantity and the parameter that it stands for cannot be given together, because they may contradict each other.

use crate::Structure;
use crate::digits::with_unit;
use crate::names::{did_you_mean, unknown};
use crate::structure::derived::{DERIVED, Derived};
use crate::structure::described::Description;
use crate::structure::ground::Ground;
use crate::structure::parameters::{OF_ONE_MASS, PARAMETERS, Parameters};
use crate::structure::quantity::{OutOfRange, Quantity, Refused, Units, ensure, ensure_in};
use serde::de::value::MapAccessDeserializer;
use serde::de::{self, Error, IntoDeserializer, MapAccess, Unexpected, Visitor};
use serde::{Deserialize, Deserializer};
use std::collections::BTreeMap;
use std::fmt;

/// A derived quantity that may be given in the place of a parameter.
#[derive(Debug)]
pub struct Natural {
    /// Name among the [`DERIVED`] quantities.
    pub name: &'static str,
    /// Smallest value accepted, in the unit of the quantity.
    pub min: f64,
    /// Largest value accepted.
    pub max: f64,
    /// The parameter that the quantity stands for.
    pub stands_for: &'static str,
    /// The parameter in the words of messages.
    pub in_place_of: &'static str,
}

/// All natural quantities. The parameter that follows from a value is checked as well.
pub const NATURAL: [Natural; 6] = [
    Natural { name: "period_fc", min: 1e-4, max: 1e3, stands_for: "f_fc", in_place_of: "f_fc" },
    Natural { name: "weight", min: 1e-6, max: 1e15, stands_for: "m", in_place_of: "m" },
    Natural { name: "weight0", min: 0.0, max: 1e15, stands_for: "m0", in_place_of: "m0" },
    Natural { name: "width", min: 2e-3, max: 2e4, stands_for: "B", in_place_of: "B" },
    Natural { name: "alpha_cg", min: 1e-3, max: 1.57, stands_for: "H", in_place_of: "H, or B if H is given" },
    Natural { name: "p_l", min: 1e-4, max: 1e3, stands_for: "J0", in_place_of: "J0" },
];

/// Numbers that are given for a structure, by name: parameters and natural quantities.
///
/// As a file: `name = value`, and perhaps `units`; an unknown name is an error.
#[derive(Clone, Debug, Default, PartialEq, Deserialize)]
#[serde(try_from = "BTreeMap<String, InputEntry>")]
pub struct Numbers {
    /// In SI units.
    numbers: Vec<(&'static str, f64)>,
    /// The units of the numbers in messages.
    units: Units,
    /// Ground that gives.
    ground: Option<Ground>,
}

enum InputEntry {
    Number(f64),
    Units(Units),
    Ground(Box<Ground>),
}

impl<'de> Deserialize<'de> for InputEntry {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<InputEntry, D::Error> {
        deserializer.deserialize_any(OfEntry)
    }
}

/// Reads an entry by its type, so that an error in `[ground]` names the number there.
struct OfEntry;

impl<'de> Visitor<'de> for OfEntry {
    type Value = InputEntry;

    fn expecting(&self, out: &mut fmt::Formatter) -> fmt::Result {
        out.write_str("a number, units = \"N, m, kg\" or \"kN, m, t\", or [ground] with its numbers")
    }

    fn visit_f64<E: de::Error>(self, number: f64) -> Result<InputEntry, E> {
        Ok(InputEntry::Number(number))
    }

    fn visit_i64<E: de::Error>(self, number: i64) -> Result<InputEntry, E> {
        Ok(InputEntry::Number(number as f64))
    }

    fn visit_str<E: de::Error>(self, text: &str) -> Result<InputEntry, E> {
        let units = Units::deserialize(text.into_deserializer()).map(InputEntry::Units);
        units.map_err(|_: E| E::invalid_value(Unexpected::Str(text), &self))
    }

    fn visit_map<A: MapAccess<'de>>(self, map: A) -> Result<InputEntry, A::Error> {
        Ground::deserialize(MapAccessDeserializer::new(map)).map(|ground| InputEntry::Ground(Box::new(ground)))
    }
}

/// Whether a structure of many masses does not have the number called `name`.
fn is_of_one_mass(name: &str) -> bool {
    let stands_for = NATURAL.iter().find(|natural| natural.name == name).map_or(name, |natural| natural.stands_for);
    name == "p_l" || OF_ONE_MASS.contains(&stands_for)
}

/// Names of the numbers of a base.
pub fn names_of_base() -> impl Iterator<Item = &'static str> {
    names().filter(|name| !is_of_one_mass(name))
}

/// Reads the base of a structure of many masses.
pub(crate) fn base<'de, D: Deserializer<'de>>(file: D) -> Result<Numbers, D::Error> {
    let numbers = BTreeMap::<String, f64>::deserialize(file)?;
    if let Some(name) = numbers.keys().find(|name| !names().any(|known| known == *name)) {
        let known = Vec::from_iter(names_of_base());
        return Err(D::Error::custom(format!(
            "{name:?} is no number of the base; these are known: {}; other numbers of the structure stand above [base]{}",
            known.join(", "),
            did_you_mean(name, &known)
        )));
    }
    let entries = numbers.into_iter().map(|(name, number)| (name, InputEntry::Number(number)));
    Numbers::try_from(BTreeMap::from_iter(entries)).map_err(D::Error::custom)
}

/// Names of all numbers that may be given.
pub fn names() -> impl Iterator<Item = &'static str> {
    names_and_units().map(|(name, _)| name)
}

fn names_and_units() -> impl Iterator<Item = (&'static str, &'static str)> {
    let natural = NATURAL.iter().map(|natural| (natural.name, natural.derived().unit));
    PARAMETERS.iter().map(|parameter| (parameter.name, parameter.unit)).chain(natural)
}

impl Natural {
    /// The derived quantity of this name.
    pub fn derived(&self) -> &'static Derived {
        const { &DERIVED }.iter().find(|derived| derived.name == self.name).expect("it is one of them")
    }
}

impl Numbers {
    /// These numbers by their names.
    pub fn of(numbers: &[(&str, f64)]) -> Result<Numbers, Refused> {
        let mut given = Numbers::default();
        numbers.iter().try_for_each(|(name, value)| given.give(name, *value)).map(|()| given)
    }

    /// Adds the number called `name`.
    pub fn give(&mut self, name: &str, value: f64) -> Result<(), Refused> {
        let name = names().find(|known| *known == name).ok_or_else(|| is_unknown(name))?;
        ensure(self.get(name).is_none(), || format!("{name} is given twice"))?;
        self.numbers.push((name, value));
        Ok(())
    }

    /// These numbers, which were given in `units`.
    pub fn measured_in(mut self, units: Units) -> Numbers {
        let unit_of = |name| names_and_units().find_map(|(known, unit)| (known == name).then_some(unit));
        self.numbers.iter_mut().for_each(|(name, value)| *value = units.in_si(*value, unit_of(*name).unwrap_or("1")));
        let ground = self.ground.map(|ground| ground.in_si(units));
        Numbers { units, ground, ..self }
    }

    /// The structure of one mass of these numbers, or of `base` changed by them. Without r, and on ground that gives without an r of these
    /// numbers, momentum gives a coefficient for each impact. Messages name the numbers as they were given.
    pub fn structure(&self, base: Option<&Parameters>) -> Result<Structure, Refused> {
        let gives = self.ground.as_ref().is_some_and(|ground| !ground.is_rigid());
        let r = self.get("r").or(base.filter(|_| !gives).map(|base| base.r)).unwrap_or(f64::NAN);
        let solved = self.over(&Parameters { r: 1.0, ..*base.unwrap_or(&Parameters::DEFAULTS) });
        let structure = solved.and_then(|parameters| {
            let parameters = Parameters { r, ..parameters };
            Description { parameters, many: None, ground: self.ground.clone() }.structure()
        });
        Ok(structure.map_err(|error| error.in_units(self.units))?.measured_in(self.units))
    }

    /// These numbers on `ground` that gives, or on rigid ground.
    pub fn on(self, ground: impl Into<Option<Ground>>) -> Numbers {
        Numbers { ground: ground.into(), ..self }
    }

    /// The parameters that these numbers determine on rigid ground, with default values for the rest; r is 1 without one. If some are
    /// missing, each number to give has the name by which it is `called` in the input.
    pub fn parameters(&self, called: impl Fn(&str) -> String) -> Result<Parameters, Refused> {
        self.solve(&called, &Parameters { r: 1.0, ..Parameters::DEFAULTS })
    }

    /// The parameters `base` changed by these numbers. α_cg changes H, or B if H is given.
    pub fn over(&self, base: &Parameters) -> Result<Parameters, Refused> {
        self.solve(&str::to_owned, base)
    }

    /// Parameters with the base that these numbers determine, and r if it is given. The numbers of the one mass mean nothing.
    pub(crate) fn base(&self) -> Result<(Parameters, Option<f64>), Refused> {
        if let Some(name) = self.names().find(|name| is_of_one_mass(name)) {
            let remedy = "leave it out beside storeys, floors and modes";
            return Err(Refused::by(format!("{name} is a number of a structure of one mass: {remedy}")));
        }
        let of_mass = Parameters { m: 0.5, H: 0.5, f_fc: 0.5, zeta_fc: 0.5, r: 0.5, ..Parameters::DEFAULTS };
        Ok((self.solve(&str::to_owned, &of_mass)?, self.get("r")))
    }

    /// Names of the numbers that are given.
    pub fn names(&self) -> impl Iterator<Item = &'static str> {
        self.numbers.iter().map(|(name, _)| *name)
    }

    /// Whether no number is given.
    pub fn is_empty(&self) -> bool {
        self.numbers.is_empty()
    }

    /// Whether these numbers determine the parameter called `name`, directly or by a natural quantity.
    fn determine(&self, name: &str) -> bool {
        let stands_in = |natural: &Natural| match natural.name {
            "alpha_cg" => name == if self.get("H").is_some() { "B" } else { "H" },
            _ => natural.stands_for == name,
        };
        let is_given = |name| self.get(name).is_some();
        is_given(name) || NATURAL.iter().any(|natural| stands_in(natural) && is_given(natural.name))
    }

    fn get(&self, name: &str) -> Option<f64> {
        self.numbers.iter().find(|(given, _)| *given == name).map(|(_, value)| *value)
    }

    /// The parameters, those of `otherwise` for the numbers that are not given; NaN there is none. Messages about missing numbers name them
    /// as they are `called`.
    fn solve(&self, called: &dyn Fn(&str) -> String, otherwise: &Parameters) -> Result<Parameters, Refused> {
        self.check()?;
        let is_missing = |of: &&Quantity<Parameters>| !self.determine(of.name) && (of.get)(otherwise).is_nan();
        ensure_in(!PARAMETERS.iter().any(|of| is_missing(&of)), |units| {
            Vec::from_iter(PARAMETERS.iter().filter(is_missing).map(|of| missing(of, called, units))).join("; ")
        })?;
        let mut own = *otherwise;
        let given = PARAMETERS.iter().filter_map(|of| Some((of, self.get(of.name)?)));
        given.for_each(|(of, value)| (of.set)(&mut own, value));
        let or = |own, name, natural, from: &dyn Fn(f64) -> f64| match self.get(natural) {
            Some(value) => parameter_for(natural, value, name, from(value)),
            None => Ok(own),
        };
        let g = own.g;
        let m = or(own.m, "m", "weight", &|weight| weight / g)?;
        let m0 = or(own.m0, "m0", "weight0", &|weight0| weight0 / g)?;
        let f_fc = or(own.f_fc, "f_fc", "period_fc", &|period_fc| period_fc.recip())?;
        let B = || or(own.B, "B", "width", &|width| width / 2.0);
        let gamma = (m + m0) / m;
        let (H, B) = match (self.get("alpha_cg"), self.get("H")) {
            (Some(alpha_cg), Some(H)) => {
                (H, parameter_for("alpha_cg", alpha_cg, "B", H * libm::tan(alpha_cg) / gamma)?)
            }
            (Some(alpha_cg), None) => {
                let B = B()?;
                (parameter_for("alpha_cg", alpha_cg, "H", gamma * B / libm::tan(alpha_cg))?, B)
            }
            (None, _) => (own.H, B()?),
        };
        let J0 = match self.get("p_l") {
            Some(p_l) => inertia(p_l, m * g * H, m * H * H + (m + m0) * B * B)?,
            None => own.J0,
        };
        Ok(Parameters { m, m0, H, B, J0, f_fc, ..own })
    }

    /// Checks that every natural quantity is in its range and that its parameter is not given as well.
    fn check(&self) -> Result<(), Refused> {
        for natural in &NATURAL {
            let Some(value) = self.get(natural.name) else { continue };
            let &Natural { name, min, max, stands_for, .. } = natural;
            let &Derived { unit, description, .. } = natural.derived();
            Quantity::limit(name, unit, [min, max], description).check(value)?;
            let given = |name: &&'static str| self.get(name).is_some();
            let with: Vec<_> = match name {
                "alpha_cg" => {
                    let width = ["B", "width"].into_iter().find(given);
                    Some("H").filter(given).zip(width).map_or(Vec::new(), |(H, width)| vec![H, width])
                }
                _ => Some(stands_for).filter(given).into_iter().collect(),
            };
            let determined = if name == "alpha_cg" { "the ratio of the two" } else { stands_for };
            ensure_in(with.is_empty(), |units| {
                let (given, with) = (units.show(value, unit), with.join(" and "));
                format!(
                    "{name} = {given} is given beside {with}: {name} determines {determined}, leave one of them out"
                )
            })?;
        }
        Ok(())
    }
}

/// `value` as the parameter called `name`, which `natural` determines.
fn parameter_for(natural: &'static str, given: f64, name: &'static str, value: f64) -> Result<f64, Refused> {
    let parameter = PARAMETERS.iter().find(|parameter| parameter.name == name).expect("it is one of them");
    let impossible = |cause: OutOfRange| {
        let natural = NATURAL.iter().find(|known| known.name == natural).expect("it is one of them");
        Refused::shown(|units| {
            let given = units.show(given, natural.derived().unit);
            format!("{} = {given} does not fit: {}", natural.name, cause.shown(units))
        })
    };
    parameter.check(value).map_err(impossible)?;
    Ok(value)
}

/// J0 = m g H/p_l² − J_P(J0 = 0) for the frequency parameter `p_l`, kg·m². A result that is negative by rounding is 0.
fn inertia(p_l: f64, m_g_H: f64, without_J0: f64) -> Result<f64, Refused> {
    const ROUNDING: f64 = 1e-14;
    let J_P = m_g_H / (p_l * p_l);
    let J0 = J_P - without_J0;
    if J0.abs() <= ROUNDING * J_P {
        return Ok(0.0);
    }
    ensure(J0 >= 0.0, || {
        let [p_l, largest] = [p_l, (m_g_H / without_J0).sqrt()].map(|rate| with_unit(rate, "rad/s"));
        format!(
            "p_l = {p_l} does not fit: it would take a negative J0; with these masses, H and B it is {largest} at most"
        )
    })?;
    parameter_for("p_l", p_l, "J0", J0)
}

fn is_unknown(name: &str) -> Refused {
    let known = Vec::from_iter(names().chain(["units", "ground"]));
    Refused::by(unknown(format_args!("{name:?} is unknown"), name, &known))
}

/// The sentence about a missing parameter, with the numbers to give for it.
fn missing(of: &Quantity<Parameters>, called: &dyn Fn(&str) -> String, units: Units) -> String {
    let &Quantity { name, unit, description, .. } = of;
    let stand_ins = NATURAL.iter().filter(|natural| natural.stands_for == name).map(Natural::derived);
    let ways = [(name, unit)].into_iter().chain(stand_ins.map(|derived| (derived.name, derived.unit)));
    let way =
        |(name, unit)| if unit == "1" { called(name) } else { format!("{} ({})", called(name), units.name(unit)) };
    let ways = ways.map(way).collect::<Vec<_>>().join(" or ");
    format!("{name} ({description}) is missing: give {ways}")
}

impl TryFrom<BTreeMap<String, InputEntry>> for Numbers {
    type Error = Refused;

    fn try_from(entries: BTreeMap<String, InputEntry>) -> Result<Numbers, Refused> {
        let (mut given, mut units) = (Numbers::default(), Units::default());
        for (name, entry) in entries {
            match entry {
                InputEntry::Number(_) if name == "units" => {
                    return Err(Refused::by("units: \"N, m, kg\" or \"kN, m, t\" is needed"));
                }
                InputEntry::Number(number) => given.give(&name, number)?,
                InputEntry::Units(of_numbers) if name == "units" => units = of_numbers,
                InputEntry::Ground(ground) if name == "ground" => given.ground = Some(*ground),
                InputEntry::Ground(_) if !names().chain(["units"]).any(|known| known == name) => {
                    return Err(is_unknown(&name));
                }
                InputEntry::Units(_) | InputEntry::Ground(_) => {
                    return Err(Refused::by(format!("{name}: a number is needed")));
                }
            }
        }
        Ok(given.measured_in(units))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::OneMass;
    use proptest::prelude::*;

    fn given(numbers: &[(&str, f64)]) -> Numbers {
        Numbers::of(numbers).unwrap()
    }

    fn derived(parameters: Parameters, name: &str) -> f64 {
        let derived = DERIVED.iter().find(|derived| derived.name == name).unwrap();
        (derived.value)(&OneMass::new(parameters).unwrap())
    }

    #[test]
    fn over_a_base_the_slenderness_moves_the_height_unless_that_is_given() {
        let base = &Parameters::MCMANUS;
        let tan = 0.2_f64.tan();
        let gamma = (base.m + base.m0) / base.m;
        let moved = given(&[("alpha_cg", 0.2)]).over(base).unwrap();
        assert_eq!(moved, Parameters { H: gamma * base.B / tan, ..*base });
        let narrowed = given(&[("alpha_cg", 0.2), ("H", 2.0)]).over(base).unwrap();
        assert_eq!(narrowed, Parameters { H: 2.0, B: 2.0 * tan / gamma, ..*base });
        let widened = given(&[("alpha_cg", 0.2), ("width", 0.8)]).over(base).unwrap();
        assert_eq!(widened, Parameters { H: gamma * 0.4 / tan, B: 0.4, ..*base });
        assert_eq!(given(&[("r", 0.9), ("f_fc", 8.0)]).over(base).unwrap(), Parameters { r: 0.9, f_fc: 8.0, ..*base });
        assert_eq!(given(&[]).over(base).unwrap(), *base);
    }

    proptest! {
        /// The natural quantities of a structure give its parameters back. The ranges leave out slendernesses near a right angle,
        /// whose tangent has few digits.
        #[test]
        fn natural_quantities_give_the_structure_back(
            m in 1.0..1e6f64, mass_ratio in 0.0..10.0f64, H in 1.0..30.0f64, B in 0.2..10.0f64, J0 in 0.0..1e7f64, f_fc in 0.1..30.0f64,
        ) {
            let original = Parameters { m, m0: mass_ratio * m, H, B, J0, f_fc, ..Parameters::MCMANUS };
            let natural = NATURAL.iter().map(|natural| (natural.name, derived(original, natural.name)));
            let every: Vec<_> = natural.chain([("zeta_fc", original.zeta_fc), ("r", original.r)]).collect();
            let found = given(&every).parameters(str::to_owned).unwrap();
            let J_P = derived(original, "J_P");
            for parameter in PARAMETERS {
                let (found, expected) = ((parameter.get)(&found), (parameter.get)(&original));
                let size = if parameter.name == "J0" { J_P } else { expected };
                prop_assert!((found - expected).abs() <= 1e-13 * size, "{}: {found}, {expected}", parameter.name);
            }
        }
    }
}
