//! The numbers that a structure is described by, in SI units.

use crate::structure::ground::Ground;
use crate::structure::mode::OF_FLOOR;
use crate::structure::parameters::{MAX_DAMPING, OF_ONE_MASS, PARAMETERS, Parameters};
use crate::structure::quantity::Quantity;
use serde::{Deserialize, Serialize};

/// The floor at `h` (m) with the mass `m` (kg), on a storey of the stiffness `k` (N/m).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs)]
pub struct Storey {
    pub m: f64,
    pub h: f64,
    pub k: f64,
}

/// The floor at the height `h` (m) with the mass `m` (kg).
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
#[allow(missing_docs)]
pub struct FloorAt {
    pub m: f64,
    pub h: f64,
}

/// A mode in full contact as a finite element program prints it.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct FoundMode {
    /// Frequency, Hz; or else the period.
    pub f: Option<f64>,
    /// Period, s.
    pub period: Option<f64>,
    /// Effective mass, kg.
    pub mass: f64,
    /// Effective height, m; or else the moment.
    pub height: Option<f64>,
    /// Moment at the base for a unit of acceleration, effective mass × effective height, kg·m.
    pub moment: Option<f64>,
    /// Displacements of the floors in any scale; none if the floors are not known.
    #[serde(default)]
    pub shape: Vec<f64>,
}

/// All mass above the base, which the modes must not exceed.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Total {
    /// Mass m_s, kg.
    pub m_s: f64,
    /// First moment S_1 = Σ m h, kg·m.
    pub S_1: f64,
    /// Second moment I_2 = Σ m h², kg·m²; or else J_P.
    pub I_2: Option<f64>,
    /// Inertia of the whole structure about a pivot, J_P = J0 + m_t B² + I_2, kg·m².
    pub J_P: Option<f64>,
}

/// Damping in full contact.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum Damping {
    /// The same ratio in all modes.
    All(f64),
    /// A ratio for each mode, lowest frequency first.
    Each(Vec<f64>),
    /// Rayleigh damping, which has the ratio `zeta` at both frequencies `f` (Hz).
    #[allow(missing_docs)]
    Rayleigh { f: [f64; 2], zeta: f64 },
}

/// [`Damping`] as a file has it.
#[derive(Deserialize)]
#[serde(
    untagged,
    remote = "Damping",
    expecting = "zeta is one number, a list with a number for each mode, or {f = [Hz, Hz], zeta = number} for Rayleigh damping"
)]
pub(super) enum DampingOfFile {
    All(f64),
    Each(Vec<f64>),
    Rayleigh { f: [f64; 2], zeta: f64 },
}

/// The numbers that a structure was made of, in SI units.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Description {
    /// The parameters of one mass; of many masses those of the base count. r is NaN if momentum gives it.
    pub parameters: Parameters,
    /// Storeys, floors or modes; none of one mass.
    pub many: Option<ManyMasses>,
    /// Ground that gives; without it rigid ground.
    pub ground: Option<Ground>,
}

/// The numbers of a structure of many masses in SI units, as [`Described`] has them.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[allow(missing_docs)]
pub struct ManyMasses {
    pub zeta: Damping,
    pub storeys: Vec<Storey>,
    pub p_delta: bool,
    pub floors: Vec<FloorAt>,
    pub K: Vec<Vec<f64>>,
    pub modes: Vec<FoundMode>,
    pub total: Option<Total>,
    pub keep: Option<i64>,
}

/// A number of a [`Description`].
#[derive(Clone, Debug)]
#[allow(missing_docs)] // as in [`Quantity`]
pub struct DescribedNumber {
    pub name: String,
    pub unit: &'static str,
    pub description: String,
    pub min: f64,
    pub max: f64,
    pub value: f64,
}

pub(super) const STOREY: Quantity<f64> =
    Quantity::limit("k", "N/m", [1e-6, 1e18], "stiffness of the storey below the floor");
pub(super) const ZETA: Quantity<f64> =
    Quantity::limit("zeta", "1", [0.0, MAX_DAMPING], "damping ratio in full contact");

impl Description {
    /// The parameters that it has: of many masses those of the base, and r unless momentum gives it.
    pub fn own_parameters(&self) -> impl Iterator<Item = (&'static Quantity<Parameters>, f64)> + use<> {
        let (parameters, is_many) = (self.parameters, self.many.is_some());
        let own = PARAMETERS.iter().filter(move |of| !(is_many && OF_ONE_MASS.contains(&of.name)));
        own.map(move |of| (of, (of.get)(&parameters))).filter(|(_, value)| !value.is_nan())
    }

    /// Shows each number that can have another value, and takes the value that is left there. The storeys' number, the modes that another
    /// program found, and lists of contact points stay as they are.
    fn each(&mut self, mut see: impl FnMut(DescribedNumber, &mut f64)) {
        for (of, mut value) in self.own_parameters() {
            see(DescribedNumber::new(of, value), &mut value);
            (of.set)(&mut self.parameters, value);
        }
        let Description { many, ground, .. } = self;
        if let Some(ManyMasses { zeta, storeys, .. }) = many.as_mut().filter(|many| !many.storeys.is_empty()) {
            for (i, Storey { m, h, k }) in (1..).zip(storeys) {
                let mut see_of = |of: DescribedNumber, value: &mut f64| {
                    let description = of.description.replace("the floor", &format!("floor {i}"));
                    see(DescribedNumber { name: format!("{}[{i}]", of.name), description, ..of }, value);
                };
                see_of(DescribedNumber::new(&OF_FLOOR[0], *m), m);
                see_of(DescribedNumber::new(&OF_FLOOR[1], *h), h);
                see_of(DescribedNumber::new(&STOREY, *k), k);
            }
            match zeta {
                Damping::All(zeta) | Damping::Rayleigh { zeta, .. } => {
                    see(DescribedNumber::new(&ZETA, *zeta), zeta);
                }
                Damping::Each(_) => (),
            }
        }
        if let Some(ground) = ground {
            ground.each(|of, value| see(DescribedNumber::new(of, *value), value));
        }
    }

    /// Each number that can have another value.
    pub fn numbers(&self) -> Vec<DescribedNumber> {
        let mut all = Vec::new();
        self.clone().each(|number, _| all.push(number));
        all
    }

    /// The same with these values of its [`Description::numbers`].
    pub fn with(&self, values: &[f64]) -> Description {
        let (mut changed, mut values) = (self.clone(), values.iter());
        changed.each(|_, value| values.next().into_iter().for_each(|new| *value = *new));
        changed
    }
}

impl DescribedNumber {
    fn new<T>(&Quantity { name, unit, description, min, max, .. }: &Quantity<T>, value: f64) -> DescribedNumber {
        DescribedNumber { name: name.into(), unit, description: description.into(), min, max, value }
    }
}
