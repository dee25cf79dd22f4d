//! A row of the table of variables: where the value of a variable is, and how it is set.

use crate::setup::Setup;
use fmi_unit::{Enumeration, Value, Variable};
use rocking::mechanics::restraint::{Dissipators, Restraints};
use rocking::run::ground_motion::Placement;
use rocking::structure::derived::Derived;
use rocking::structure::quantity::Quantity;
use rocking::{Detail, Impulse, Output, Phase, Reactions};
use std::sync::Arc;

#[derive(Clone, Copy, Debug)]
pub enum Source {
    /// By its place among the inputs.
    Input(usize),
    Output(Output),
    Reaction(fn(&Reactions) -> f64),
    /// A state of many masses, by its place.
    Coordinate(usize),
    /// The derivative of a state, by its place.
    StateRate(usize),
    /// An event indicator, by its place.
    Indicator(usize),
    Impulse(fn(&Impulse) -> f64),
    Restraint(fn(&Restraints) -> f64),
    Dissipator(fn(&Dissipators) -> f64),
    Phase,
    Transitions,
    Overturned,
    /// A number of the structure, by its place among [`Setup::numbers`].
    Parameter(usize),
    /// An initial value by its place among [`INITIAL_VALUES`], and the floor that has it.
    InitialValue(usize, usize),
    Derived(&'static Derived),
    /// A number that follows from those of the structure, by its place among [`Scene::known`](crate::scene::Scene::known).
    Known(usize),
    Detail,
    /// A ground acceleration, the input and the record; whether it is the vertical one.
    Ground(bool),
    Peak(Output),
    PeakInstant(Output),
    /// The worst value of one of [`ASSUMPTIONS`].
    Worst(usize),
    /// The instant of the worst value of one of [`ASSUMPTIONS`].
    WorstInstant(usize),
    /// Impacts that raise the energy.
    Gains,
    Overturning,
    /// A parameter that is text: which record.
    Text(fn(&mut Setup) -> &mut Arc<str>),
    RecordDuration,
    Time,
    Placement(&'static Quantity<Placement>),
    /// A Boolean parameter.
    Switch(fn(&mut Setup) -> &mut bool),
}

impl Source {
    /// Whether the host sets the value, a real number.
    pub fn is_set(self) -> bool {
        use Source::{InitialValue, Input, Parameter, Placement};
        matches!(self, Input(_) | Parameter(_) | InitialValue(..) | Placement(_))
    }

    /// The value of a Real parameter or an initial value.
    pub fn setting(&self, setup: &Setup) -> Option<f64> {
        match self {
            Source::Parameter(which) => setup.numbers.get(*which).copied(),
            Source::InitialValue(which, floor) => Some(setup.initial.numbers()[*which][*floor]),
            Source::Placement(quantity) => Some((quantity.get)(&setup.placement)),
            _ => None,
        }
    }

    /// The value of what is set: of a parameter or an input.
    pub fn set_value(&self, setup: &Setup) -> Option<Value> {
        match self {
            Source::Input(_) => Some(Value::Real(0.0)),
            Source::Detail => Some(Value::Integer(setup.detail as i32 + 1)),
            Source::Text(of) => Some(Value::String(of(&mut setup.clone()).to_string())),
            Source::Switch(of) => Some(Value::Boolean(*of(&mut setup.clone()))),
            _ => self.setting(setup).map(Value::Real),
        }
    }

    pub fn set_to(&self, setup: &mut Setup, value: Value) {
        match (self, value) {
            (Source::Detail, Value::Integer(number)) => setup.detail = Detail::ALL[number as usize - 1],
            (Source::Text(of), Value::String(value)) => *of(setup) = value.into(),
            (Source::Switch(of), Value::Boolean(on)) => *of(setup) = on,
            (Source::Parameter(which), Value::Real(value)) => setup.numbers[*which] = value,
            (Source::InitialValue(which, floor), Value::Real(value)) => {
                setup.initial.numbers_mut()[*which][*floor] = value;
            }
            (Source::Placement(quantity), Value::Real(value)) => (quantity.set)(&mut setup.placement, value),
            _ => (),
        }
    }
}

/// The names of `all`, in their order.
macro_rules! names {
    ($all:expr) => {
        &{
            let (all, mut names, mut i) = ($all, [""; $all.len()], 0);
            while i < names.len() {
                names[i] = all[i].name();
                i += 1;
            }
            names
        }
    };
}

/// The phases, in the order of [`Phase::SHOWN`].
pub static PHASES: Enumeration =
    Enumeration { name: "Phase", description: "phase of the motion", items: names!(Phase::SHOWN) };

/// The levels of detail, in the order of [`Detail::ALL`].
pub static DETAILS: Enumeration = Enumeration {
    name: "Detail",
    description: "level of detail: the equations that move the structure",
    items: names!(Detail::ALL),
};

pub(crate) type VariableRow = (Variable, Source);
