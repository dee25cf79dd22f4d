//! Derivatives of outputs: by time, and by what the host sets.

use super::Instance;
use crate::failure::Failure;
use crate::present::find;
use crate::sensitivity::by_state;
use crate::shown::Shown;
use crate::variables::{Source, Variable};
use rocking::mechanics::state::COMPONENTS;
use rocking::{LinearLoad, Load, Parameters};
use std::mem::MaybeUninit;

impl Instance {
    /// Rates of outputs by the equations of motion, under the present inputs and their slopes: those set for the next
    /// step, or else those that the last step followed.
    pub fn get_real_output_derivatives(
        &mut self,
        references: &[u32],
        orders: &[i32],
        values: &mut [MaybeUninit<f64>],
    ) -> Result<(), Failure> {
        let variables = self.now.variables;
        let (model, setup, inputs, _) = self.now.parts()?;
        let load = model.load(setup, inputs.now());
        let time = model.engine.motion().time;
        let (outputs, reactions) = model.engine.rates(load);
        let rate = |reference: &u32, order: i32| {
            let variable = find(variables, *reference)?;
            let rate = match variable.source {
                Source::Output(of) => of(&outputs),
                Source::Reaction(of) => of(&reactions),
                Source::Restraint(of) => of(&model.engine.restraint_rates(load.value)),
                Source::Ground(which) => load.slope[which],
                _ => return Err(Failure::NoOutput(variable)),
            };
            if order != 1 {
                return Err(Failure::WrongOrder { variable, order });
            }
            Some(rate).filter(|rate| rate.is_finite()).ok_or(Failure::NoRate { variable, time })
        };
        for (reference, order) in references.iter().zip(orders) {
            rate(reference, *order)?;
        }
        for ((reference, order), value) in references.iter().zip(orders).zip(values) {
            value.write(rate(reference, *order)?);
        }
        Ok(())
    }

    /// Derivatives of outputs and of derivatives of states: by inputs; once the simulation has started by states
    /// ([`sensitivity`](crate::sensitivity)), and by time, with which the record changes. The outputs are affine in the
    /// inputs: the derivative is a difference, taken over a change of the size of gravity and the strut's force, which
    /// keeps its digits.
    pub fn get_directional_derivative(
        &mut self,
        unknowns: &[u32],
        knowns: &[u32],
        seed: &[f64],
        values: &mut [MaybeUninit<f64>],
    ) -> Result<(), Failure> {
        let variables = self.now.variables;
        let mut direction = Load::default();
        let has_started = self.now.stage.has_started();
        let (mut of_state, mut of_time) = ([0.0; COMPONENTS.len()], 0.0);
        for (reference, &value) in knowns.iter().zip(seed) {
            let variable = find(variables, *reference)?;
            if !value.is_finite() {
                return Err(Failure::BadSlope { variable, value });
            }
            match variable.source {
                Source::Input(which) if !self.now.inputs.acts_at_once(which) => (),
                Source::Input(which) => direction[which] += value,
                Source::Time if has_started => of_time += value,
                _ => match variable.as_state().filter(|_| has_started) {
                    Some(which) => of_state[which] += value,
                    None => return Err(Failure::NoKnown(variable)),
                },
            }
        }
        let unknown = |reference: &u32| {
            let variable = find(variables, *reference)?;
            match variable.source {
                Source::Output(_) | Source::Reaction(_) | Source::StateRate(_) | Source::Ground(_) => Ok(variable),
                Source::Restraint(_) => Ok(variable),
                Source::Impulse(_) => Ok(variable), // which events alone change
                _ => Err(Failure::NoOutput(variable)),
            }
        };
        let unknowns = unknowns.iter().map(unknown).collect::<Result<Vec<_>, _>>()?;

        let (model, setup, inputs, _) = self.now.parts()?;
        let inputs = inputs.values().into();
        let mut by_states = vec![0.0; unknowns.len()];
        for (which, seed) in of_state.into_iter().enumerate().filter(|(_, seed)| *seed != 0.0) {
            let by = by_state(model, setup, inputs, &unknowns, which)?;
            by_states.iter_mut().zip(by).for_each(|(sum, by)| *sum += seed * by);
        }
        if of_time != 0.0 {
            let Load { a_g, a_v, .. } = model.load(setup, LinearLoad::default()).slope;
            (direction.a_g, direction.a_v) = (direction.a_g + of_time * a_g, direction.a_v + of_time * a_v);
        }
        let is_admitted_for_this = direction.a_v != 0.0 && !model.may_move_vertically(setup);
        if is_admitted_for_this {
            model.engine.admit_vertical(true)?;
        }
        let time = model.engine.motion().time;
        let &Parameters { m, g, .. } = model.engine.structure().parameters();
        let before = Shown::new(model, setup, Load::default());
        let acceleration = direction.a_g.abs().max(direction.F_t.abs() / m).max(direction.a_v.abs());
        let size = acceleration / (g + before.outputs.a_t.abs());
        let of_size_one = |part: f64| if size > 0.0 { part / size } else { 0.0 };
        let after = Shown::new(
            model,
            setup,
            Load { a_g: of_size_one(direction.a_g), F_t: of_size_one(direction.F_t), a_v: of_size_one(direction.a_v) },
        );
        let change = |of: &&Variable| after.value(of.source).zip(before.value(of.source)).map_or(0.0, |(a, b)| a - b);
        let found: Vec<_> = unknowns.iter().zip(by_states).map(|(of, by)| size * change(of) + by).collect();
        if is_admitted_for_this {
            model.engine.admit_vertical(false)?;
        }
        if let Some(at) = found.iter().position(|derivative| !derivative.is_finite()) {
            return Err(Failure::NoRate { variable: unknowns[at], time });
        }
        values.iter_mut().zip(found).for_each(|(value, derivative)| _ = value.write(derivative));
        Ok(())
    }
}
