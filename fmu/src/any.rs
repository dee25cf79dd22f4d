//! The model: a unit of one mass or of many, as the archive has the structure.

use crate::failure::Refusal;
use crate::resources::Archive;
use crate::unit::Unit;
use fmi_unit::{Completed, Experiment, Failure, Interface, Logger, Model, Progress, Step, Update, Value, Variable};
use rocking::Modes;
use std::path::Path;
use std::sync::Arc;

/// An instance.
#[allow(clippy::large_enum_variant)] // one mass is not behind a pointer
pub enum AnyUnit {
    /// Of one mass.
    One(Unit),
    /// Of many masses.
    Many(Box<Unit<Modes>>),
}

/// Hands calls on to the unit.
macro_rules! hand_on {
    ($($(#[$inline:meta])* fn $name:ident($self:ident: $receiver:ty $(, $argument:ident: $type:ty)*) $(-> $returned:ty)?;)*) => {
        $(
            $(#[$inline])*
            fn $name($self: $receiver $(, $argument: $type)*) $(-> $returned)? {
                match $self {
                    AnyUnit::One(unit) => unit.$name($($argument),*),
                    AnyUnit::Many(unit) => unit.$name($($argument),*),
                }
            }
        )*
    };
}

impl Model for AnyUnit {
    fn open(resources: &Path) -> Result<AnyUnit, Failure> {
        let archive = Archive::open(resources.to_owned()).map_err(Refusal::from)?;
        Ok(match archive.contents.structure.one() {
            Some(_) => AnyUnit::One(Unit::new(archive)),
            None => AnyUnit::Many(Box::new(Unit::new(archive))),
        })
    }

    hand_on! {
        fn token(self: &Self) -> String;
        fn build(self: &Self) -> String;
        fn variables(self: &Self) -> Arc<[Variable]>;
        fn get(self: &mut Self, reference: u32) -> Result<Value, Failure>;
        #[inline(always)]
        fn get_reals(self: &mut Self, references: &[u32], values: &mut [f64]) -> Result<(), Failure>;
        fn set(self: &mut Self, reference: u32, value: Value);
        #[inline(always)]
        fn set_inputs(self: &mut Self, references: &[u32], values: &[f64]) -> Result<(), Failure>;
        #[inline(always)]
        fn set_slopes(self: &mut Self, references: &[u32], slopes: &[f64]) -> Result<(), Failure>;
        fn lead(self: &mut Self, reference: u32, value: f64, step: f64) -> Result<(), Failure>;
        fn set_up(self: &mut Self, experiment: &Experiment);
        fn start(self: &mut Self, interface: Interface, log: &Logger) -> Result<(), Failure>;
        #[inline]
        fn time(self: &mut Self) -> Result<f64, Failure>;
        #[inline(always)]
        fn advance(self: &mut Self, step: Step, log: &Logger) -> Result<Progress, Failure>;
        fn update(self: &mut Self, log: &Logger) -> Result<Update, Failure>;
        fn ending(self: &mut Self) -> Result<Option<String>, Failure>;
        fn state(self: &Self, bytes: &mut Vec<u8>);
        fn restore(self: &mut Self, bytes: &[u8]) -> Result<(), Failure>;
        fn rates(self: &mut Self, references: &[u32], rates: &mut [f64]) -> Result<(), Failure>;
        fn derivatives(self: &mut Self, of: &[u32], direction: &[(u32, f64)], has_started: bool) -> Result<Vec<f64>, Failure>;
        fn set_time(self: &mut Self, time: f64, is_at_event: bool);
        fn states(self: &mut Self) -> Result<Vec<f64>, Failure>;
        fn set_states(self: &mut Self, states: &[f64]) -> Result<(), Failure>;
        fn nominals(self: &mut Self) -> Result<Vec<f64>, Failure>;
        fn state_rates(self: &mut Self) -> Result<Vec<f64>, Failure>;
        fn indicators(self: &mut Self) -> Result<Vec<f64>, Failure>;
        fn complete_step(self: &mut Self, log: &Logger) -> Result<Completed, Failure>;
        fn arrive_at_event(self: &mut Self) -> Result<(), Failure>;
    }
}
