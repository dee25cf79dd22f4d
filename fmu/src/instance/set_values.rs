//! How values are set.

use super::Instance;
use super::get_values::text;
use super::model_exchange::check_state;
use crate::failure::Failure;
use crate::present::find;
use crate::state_machine::Stage;
use crate::variables::{self, Causality, Source, Variable};
use rocking::mechanics::load::{LOADS, VERTICAL};

impl Instance {
    /// Sets Reals: all of them, or none if one is refused. While the host integrates it can set the states, too.
    #[inline(always)]
    pub fn set_real(&mut self, references: &[u32], values: &[f64]) -> Result<(), Failure> {
        let mut is_vertical = false;
        for (reference, &value) in references.iter().zip(values) {
            let variable = find(self.now.variables, *reference)?;
            match variable.source {
                Source::Input(which) => {
                    LOADS[which].check(value)?;
                    is_vertical |= which == VERTICAL && value != 0.0;
                }
                _ => self.check_no_input(variable, value)?,
            }
        }
        if is_vertical {
            self.admit_vertical()?;
        }
        for (reference, &value) in references.iter().zip(values) {
            let variable = &self.now.variables[*reference as usize];
            match (variable.source, self.asked) {
                (Source::Input(which), None) => self.now.inputs.set(which, value),
                (Source::Input(which), Some(step)) => self.now.inputs.lead(which, value, step),
                _ => self.set_no_input(variable, value)?,
            }
        }
        Ok(())
    }

    /// Lets the ground move vertically from now on.
    #[cold]
    fn admit_vertical(&mut self) -> Result<(), Failure> {
        if let Some(model) = &mut self.now.model {
            model.engine.admit_vertical(true)?;
        }
        self.now.setup.vertical = true;
        Ok(())
    }

    #[cold]
    fn check_no_input(&self, variable: &'static Variable, value: f64) -> Result<(), Failure> {
        match variable.as_state().filter(|_| self.now.stage == Stage::ContinuousTimeMode) {
            Some(which) => return check_state(which, value),
            None if variable.source.setting(&self.now.setup).is_none() => return Err(refused(variable)),
            None => self.check_not_fixed(variable)?,
        }
        Ok(variable.source.check(value)?)
    }

    #[cold]
    fn set_no_input(&mut self, variable: &Variable, value: f64) -> Result<(), Failure> {
        if let Some(which) = variable.as_state() {
            return self.set_continuous_state(which, value);
        }
        variable.source.set(&mut self.now.setup, value);
        self.now.model = None;
        Ok(())
    }

    /// Refuses a parameter or an initial value once the simulation has started.
    fn check_not_fixed(&self, variable: &'static Variable) -> Result<(), Failure> {
        if self.now.stage.has_started() { Err(Failure::Fixed(variable)) } else { Ok(()) }
    }

    /// Sets numbers of enumerations, of which the parameter `detail` can be set: all of them, or none if one is
    /// refused.
    pub fn set_integer<T: Copy + Into<i64>>(&mut self, references: &[u32], values: &[T]) -> Result<(), Failure> {
        let mut setup = self.now.setup.clone();
        for (reference, &value) in references.iter().zip(values) {
            let variable = find(self.now.variables, *reference)?;
            let Source::Detail = variable.source else { return Err(refused(variable)) };
            self.check_not_fixed(variable)?;
            let value = value.into();
            setup.detail = variables::detail(value).ok_or(Failure::NoSuchItem { variable, value })?;
        }
        self.now.set_up(setup);
        Ok(())
    }

    /// Refuses all integers, where enumerations have a function of their own.
    pub fn set_no_integer(&mut self, references: &[u32]) -> Result<(), Failure> {
        let first = references.first().map(|first| find(self.now.variables, *first));
        first.map_or(Ok(()), |first| Err(refused(first?)))
    }

    /// Sets Booleans: all of them, or none if one is refused; `truth` says what the value of a name stands for.
    pub fn set_boolean<T: Copy>(
        &mut self,
        references: &[u32],
        values: &[T],
        truth: fn(&'static str, T) -> Result<bool, Failure>,
    ) -> Result<(), Failure> {
        let mut setup = self.now.setup.clone();
        for (reference, &value) in references.iter().zip(values) {
            let variable = find(self.now.variables, *reference)?;
            let Source::Switch(switch) = variable.source else { return Err(refused(variable)) };
            self.check_not_fixed(variable)?;
            (switch.set)(&mut setup, truth(variable.name, value)?);
        }
        self.now.set_up(setup);
        Ok(())
    }

    /// Sets texts: all of them, or none if one is refused. A record is looked for when it is needed.
    pub fn set_string(&mut self, references: &[u32], values: &[&str]) -> Result<(), Failure> {
        let mut setup = self.now.setup.clone();
        for (reference, value) in references.iter().zip(values) {
            let variable = find(self.now.variables, *reference)?;
            let text = text(variable)?;
            self.check_not_fixed(variable)?;
            (text.set)(&mut setup, value);
        }
        self.now.set_up(setup);
        Ok(())
    }

    /// Sets slopes of the inputs over the next step: all of them, or none if one is refused.
    #[inline(always)]
    pub fn set_real_input_derivatives(
        &mut self,
        references: &[u32],
        orders: &[i32],
        values: &[f64],
    ) -> Result<(), Failure> {
        let mut is_vertical = false;
        for ((reference, &order), &value) in references.iter().zip(orders).zip(values) {
            let variable = find(self.now.variables, *reference)?;
            let Source::Input(which) = variable.source else { return Err(Failure::NoInput(variable)) };
            if order != 1 {
                return Err(Failure::WrongOrder { variable, order });
            }
            if !value.is_finite() {
                return Err(Failure::BadSlope { variable, value });
            }
            is_vertical |= which == VERTICAL && value != 0.0;
        }
        if is_vertical {
            self.admit_vertical()?;
        }
        for (reference, &slope) in references.iter().zip(values) {
            if let Source::Input(which) = self.now.variables[*reference as usize].source {
                self.now.inputs.set_slope(which, slope);
            }
        }
        Ok(())
    }
}

/// Why a function of another type cannot set `variable`.
fn refused(variable: &'static Variable) -> Failure {
    match variable.causality {
        Causality::Input | Causality::Parameter => Failure::WrongType(variable),
        Causality::Output | Causality::CalculatedParameter | Causality::Local | Causality::Independent => {
            Failure::NotSettable(variable)
        }
    }
}
