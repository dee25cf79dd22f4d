//! Derivatives of outputs: by time, and by what the host sets.

use crate::inputs::Inputs;
use crate::rocking_model::RockingModel;
use crate::shown::Shown;
use crate::source::Source;
use fmi_unit::{Failure, Model, sensitivity};
use rocking::run::Runs;
use rocking::{LinearLoad, Load, Reactions};

impl<Q: Runs> RockingModel<Q> {
    /// Rates of outputs by the equations of motion, under the present inputs and their slopes: those set for the next
    /// step, or else those that the last step followed.
    pub(crate) fn output_rates(&mut self, references: &[u32], rates: &mut [f64]) -> Result<(), Failure> {
        let sources = self.sources_of(references);
        let found: Vec<_> = {
            let (scene, setup, inputs) = self.parts()?;
            let load = scene.load(setup, inputs.now(scene.engine.structure()));
            let rates = scene.engine.rates(load);
            let reactions = rates.reactions();
            let rate = |source| match source {
                Source::Output(of) => Some(rates.of(of)),
                Source::Coordinate(which) => {
                    let sample = scene.engine.sample(load.value);
                    scene.components(sample.state_rates(), &sample.settling()).nth(which)
                }
                Source::Reaction(of) => Some(of(&reactions)),
                Source::Restraint(of) => Some(of(&scene.engine.restraint_rates(load.value))),
                Source::Ground(true) => Some(load.slope.a_v),
                Source::Ground(false) => Some(load.slope.a_g),
                _ => None,
            };
            sources.into_iter().map(rate).collect()
        };
        for ((found, reference), rate) in found.into_iter().zip(references).zip(rates) {
            *rate = found.ok_or_else(|| Failure::NoOutput { name: self.name(*reference) })?;
        }
        Ok(())
    }

    /// Derivatives of outputs and of derivatives of states.
    ///
    /// Derivatives by inputs and by time, with which the record changes, are exact, because the unknowns are affine in the loads.
    /// Each is a difference over a load of the size of the reactions, which keeps the digits. Derivatives by states and parameters
    /// are limits of differences.
    pub(crate) fn directional_derivatives(
        &mut self,
        of: &[u32],
        along: &[(u32, f64)],
        has_started: bool,
    ) -> Result<Vec<f64>, Failure> {
        let unknowns = self.sources_of(of);
        // impulses change at events alone, and numbers that are calculated never
        let is_one = |source: &Source| {
            use Source::{
                Coordinate, Derived, Dissipator, Ground, Impulse, Known, Output, Reaction, Restraint, StateRate,
            };
            matches!(source, Output(_) | Coordinate(_) | StateRate(_) | Reaction(_) | Restraint(_) | Dissipator(_))
                || matches!(source, Ground(_) | Impulse(_) | Derived(_) | Known(_) | Source::RecordDuration)
        };
        if let Some(at) = unknowns.iter().position(|source| !is_one(source)) {
            return Err(Failure::NoOutput { name: self.name(of[at]) });
        }
        let (mut direction, mut others, mut of_time) = (Vec::new(), Vec::new(), 0.0);
        for &(reference, change) in along {
            match self.table.sources[reference as usize] {
                Source::Input(which) if !self.inputs.acts_at_once(which) => (),
                Source::Input(which) => direction.push((which, change)),
                Source::Time if has_started => of_time += change,
                _ => others.push((reference, change)),
            }
        }
        let mut found = vec![0.0; of.len()];
        if !others.is_empty() {
            let mut before = Vec::new();
            self.state(&mut before);
            let by_others = sensitivity::along(self, of, &others, has_started);
            self.restore(&before, has_started)?;
            found = by_others?;
        }
        let (scene, setup, inputs) = self.parts()?;
        let (mut unit_load, vertical) = (Inputs::new(scene.engine.structure()), inputs.vertical());
        let at_rest: LinearLoad<Q> = unit_load.values(scene.engine.structure()).into();
        let Load { a_g, a_v, .. } = scene.load(setup, at_rest).slope;
        direction.extend([(0, of_time * a_g), (vertical, of_time * a_v)]);
        direction.retain(|(_, change)| *change != 0.0);
        let is_vertical = direction.iter().any(|(which, _)| *which == vertical);
        let is_admitted_for_this = is_vertical && !setup.may_move_vertically(scene.ground.as_ref());
        if is_admitted_for_this {
            scene.set(|settings| settings.vertical = true)?;
        }
        let shown = |load| Shown::new(scene, setup, load);
        let before = shown(at_rest.value);
        let (Reactions { R_h, R_v, .. }, base) =
            (scene.engine.sample(at_rest.value).reactions(), scene.engine.structure().base());
        let acceleration = |(which, change): &(usize, f64)| {
            change.abs() / if *which == 0 || *which == vertical { 1.0 } else { base.m_t }
        };
        let size =
            direction.iter().map(acceleration).fold(0.0, f64::max) / base.g.max((R_h.abs() + R_v.abs()) / base.m_t);
        for (which, change) in direction {
            unit_load.set(which, unit_load.shown(which) + change / size);
        }
        let after = shown(unit_load.values(scene.engine.structure()));
        for (found, of) in found.iter_mut().zip(&unknowns) {
            let change = after.value(*of).zip(before.value(*of)).map_or(0.0, |(after, before)| after - before);
            *found += size * change;
        }
        if is_admitted_for_this {
            scene.set(|settings| settings.vertical = false)?;
        }
        Ok(found)
    }
}
