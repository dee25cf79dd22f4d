//! How values are read.

use super::Instance;
use crate::failure::Failure;
use crate::inputs::Inputs;
use crate::present::find;
use crate::setup::Setup;
use crate::shown::Shown;
use crate::variables::{self, DataType, Source, Text, Variable};
use std::ffi::{CString, c_char};
use std::mem::MaybeUninit;

impl Instance {
    /// Reads Reals: all of them, or none if one is refused.
    #[inline(always)]
    pub fn get_real(&mut self, references: &[u32], values: &mut [MaybeUninit<f64>]) -> Result<(), Failure> {
        let variables = self.now.variables;
        let needed = references
            .iter()
            .fold(0, |needed, reference| needed | variables.get(*reference as usize).map_or(NO_REAL, needs));
        if needed & NO_REAL != 0 {
            return Err(self.no_real(references));
        }
        if needed & MODEL == 0 {
            for (reference, place) in references.iter().zip(values) {
                place.write(setting(&self.now.setup, &self.now.inputs, variables[*reference as usize].source));
            }
            return Ok(());
        }
        let (model, setup, inputs, _) = self.now.parts()?;
        let shown = Shown::new(model, setup, model.load(setup, inputs.values().into()).value);
        if needed & SOLUTION != 0 {
            shown.check_solution(references)?;
        }
        for (reference, place) in references.iter().zip(values) {
            place.write(match variables[*reference as usize].source {
                Source::Output(of) => of(&shown.outputs),
                source => shown.value(source).unwrap_or_else(|| setting(setup, inputs, source)),
            });
        }
        Ok(())
    }

    /// Why the first of `references` that cannot be read as a Real cannot.
    #[cold]
    fn no_real(&self, references: &[u32]) -> Failure {
        let wrong = references.iter().find_map(|reference| match find(self.now.variables, *reference) {
            Ok(variable) if needs(variable) & NO_REAL == 0 => None,
            found => Some(found.map_or_else(|failure| failure, Failure::WrongType)),
        });
        wrong.expect("one of them is none")
    }

    /// Reads integers, numbers of enumerations, or both: what `is_of_type`.
    pub fn get_numbers<T: From<i32>>(
        &mut self,
        references: &[u32],
        values: &mut [MaybeUninit<T>],
        is_of_type: fn(&DataType) -> bool,
    ) -> Result<(), Failure> {
        self.get_discrete(references, values, is_of_type, T::from)
    }

    /// Reads Booleans.
    pub fn get_boolean<T: From<bool>>(
        &mut self,
        references: &[u32],
        values: &mut [MaybeUninit<T>],
    ) -> Result<(), Failure> {
        let is_boolean = |data_type: &DataType| matches!(data_type, DataType::Boolean);
        self.get_discrete(references, values, is_boolean, |number| T::from(number != 0))
    }

    /// Reads what is no Real: all of them, or none if one is refused.
    fn get_discrete<T>(
        &mut self,
        references: &[u32],
        values: &mut [MaybeUninit<T>],
        is_of_type: fn(&DataType) -> bool,
        value_of: impl Fn(i32) -> T,
    ) -> Result<(), Failure> {
        let mut is_computed = false;
        for reference in references {
            let variable = find(self.now.variables, *reference)?;
            if !is_of_type(&variable.data_type) {
                return Err(Failure::WrongType(variable));
            }
            is_computed |= !matches!(variable.source, Source::Detail | Source::Switch(_));
        }
        if is_computed {
            self.now.model()?;
        }
        for (reference, value) in references.iter().zip(values) {
            value.write(value_of(match find(self.now.variables, *reference)?.source {
                Source::Integer(of) | Source::Boolean(of) => of(self.now.model()?.engine.motion()),
                Source::Switch(switch) => (switch.get)(&self.now.setup).into(),
                Source::Gains => i32::try_from(self.now.model()?.validity.gains).unwrap_or(i32::MAX),
                _ => variables::detail_number(self.now.setup.detail),
            }));
        }
        Ok(())
    }

    /// Reads texts, which the host may use until the next call.
    pub fn get_string(&mut self, references: &[u32], values: &mut [MaybeUninit<*const c_char>]) -> Result<(), Failure> {
        let shown = |reference: &u32| {
            let text = (text(find(self.now.variables, *reference)?)?.get)(&self.now.setup);
            Ok(CString::new(text).unwrap_or_default()) // it came without NUL
        };
        self.shown = references.iter().map(shown).collect::<Result<_, Failure>>()?;
        values.iter_mut().zip(&self.shown).for_each(|(value, text)| _ = value.write(text.as_ptr()));
        Ok(())
    }
}

/// The text that `variable` is.
pub(super) fn text(variable: &'static Variable) -> Result<&'static Text, Failure> {
    if let Source::Text(text) = variable.source { Ok(text) } else { Err(Failure::WrongType(variable)) }
}

/// Cannot be read as a Real: the variable is of another type, or does not exist.
const NO_REAL: u8 = 1;

/// Needs the structure in motion.
const MODEL: u8 = 2;

/// Needs a solution of the equations of motion.
const SOLUTION: u8 = 4;

/// What has to be there for `variable` to be read as a Real.
fn needs(variable: &Variable) -> u8 {
    match variable.source {
        Source::Input(_) | Source::Parameter(_) | Source::InitialValue(_) | Source::Placement(_) => 0,
        Source::Integer(_) | Source::Gains | Source::Boolean(_) => NO_REAL,
        Source::Detail | Source::Text(_) | Source::Switch(_) => NO_REAL,
        Source::Reaction(_) | Source::StateRate(_) => MODEL | SOLUTION,
        _ => MODEL,
    }
}

/// The value of a Real that the host sets.
fn setting(setup: &Setup, inputs: &Inputs, source: Source) -> f64 {
    match source {
        Source::Input(which) => inputs.shown()[which],
        source => source.setting(setup).expect("a Real that is not computed is set"),
    }
}
