//! Derivatives of outputs: by time, and by what the host sets.

use crate::inputs::InputsOf;
use crate::masses::Masses;
use crate::scene::Scene;
use crate::setup::Setup;
use crate::shown::Shown;
use crate::unit::Unit;
use crate::variables::Source;
use fmi_unit::sensitivity::{by_differences, no_known};
use fmi_unit::variables::state_references;
use fmi_unit::{Failure, Model};
use rocking::mechanics::state::COMPONENTS;
use rocking::{LinearLoad, Load, Parameters, State};

impl<Q: Masses> Unit<Q> {
    /// Rates of outputs by the equations of motion, under the present inputs and their slopes: those set for the next
    /// step, or else those that the last step followed.
    pub(crate) fn output_rates(&mut self, references: &[u32], rates: &mut [f64]) -> Result<(), Failure> {
        let sources = self.sources_of(references);
        let found: Vec<_> = {
            let (scene, setup, inputs) = self.parts()?;
            let load = scene.load(setup, inputs.now(&scene.engine));
            let (output, reactions) = Q::rates(&scene.engine, load);
            let rate = |source| match source {
                Source::Reaction(of) => Some(of(&reactions)),
                Source::Restraint(of) => Some(of(&scene.engine.restraint_rates(load.value))),
                Source::Ground(true) => Some(load.slope.a_v),
                Source::Ground(false) => Some(load.slope.a_g),
                source => output(source),
            };
            sources.into_iter().map(rate).collect()
        };
        for ((found, reference), rate) in found.into_iter().zip(references).zip(rates) {
            *rate = found.ok_or_else(|| Failure::NoOutput { name: self.name(*reference) })?;
        }
        Ok(())
    }
}

impl Unit {
    /// Derivatives of outputs and of derivatives of states: by inputs; once the simulation has started by states, and by
    /// time, with which the record changes. The outputs are affine in the inputs: the derivative is a difference, taken over
    /// a change of the size of gravity and the strut's force, which keeps its digits.
    pub(crate) fn directional_derivatives(
        &mut self,
        of: &[u32],
        along: &[(u32, f64)],
        has_started: bool,
    ) -> Result<Vec<f64>, Failure> {
        let mut direction = Load::default();
        let (mut of_state, mut of_time) = ([0.0; COMPONENTS.len()], 0.0);
        for &(reference, change) in along {
            match self.table.sources[reference as usize] {
                Source::Input(which) if !self.inputs.acts_at_once(which) => (),
                Source::Input(which) => direction[which] += change,
                Source::Time if has_started => of_time += change,
                _ => match state_references(&self.table.variables).position(|state| state == reference) {
                    Some(which) if has_started => of_state[which] += change,
                    _ => return Err(no_known(&self.table.variables, reference)),
                },
            }
        }
        let unknowns = self.sources_of(of);
        // impulses change at events alone
        let is_one = |source: &Source| {
            matches!(source, Source::Output(_) | Source::Reaction(_) | Source::StateRate(_) | Source::Ground(_))
                || matches!(source, Source::Restraint(_) | Source::Impulse(_))
        };
        if let Some(at) = unknowns.iter().position(|source| !is_one(source)) {
            return Err(Failure::NoOutput { name: self.name(of[at]) });
        }
        let (scene, setup, inputs) = self.parts()?;
        let inputs = inputs.values(&scene.engine).into();
        let mut by_states = vec![Some(0.0); unknowns.len()];
        for (which, seed) in of_state.into_iter().enumerate().filter(|(_, seed)| *seed != 0.0) {
            let found = by_state(scene, setup, inputs, &unknowns, which);
            let found = found.unwrap_or_else(|| vec![None; unknowns.len()]);
            by_states.iter_mut().zip(found).for_each(|(sum, by)| *sum = sum.zip(by).map(|(sum, by)| sum + seed * by));
        }
        if of_time != 0.0 {
            let Load { a_g, a_v, .. } = scene.load(setup, LinearLoad::default()).slope;
            (direction.a_g, direction.a_v) = (direction.a_g + of_time * a_g, direction.a_v + of_time * a_v);
        }
        let is_admitted_for_this = direction.a_v != 0.0 && !scene.may_move_vertically(setup);
        if is_admitted_for_this {
            scene.set(|settings| settings.vertical = true)?;
        }
        let &Parameters { m, g, .. } = scene.engine.structure().parameters();
        let at_rest = scene.engine.outputs(Load::default());
        let before = Shown::new(scene, setup, Load::default(), at_rest);
        let acceleration = direction.a_g.abs().max(direction.F_t.abs() / m).max(direction.a_v.abs());
        let size = acceleration / (g + at_rest.a_t.abs());
        let of_size_one = |part: f64| if size > 0.0 { part / size } else { 0.0 };
        let Load { a_g, F_t, a_v } = direction;
        let load = Load { a_g: of_size_one(a_g), F_t: of_size_one(F_t), a_v: of_size_one(a_v) };
        let outputs = scene.engine.outputs(load);
        let after = Shown::new(scene, setup, load, outputs);
        let change = |of: Source| after.value(of).zip(before.value(of)).map_or(0.0, |(a, b)| a - b);
        let found = unknowns.iter().zip(by_states);
        let found: Vec<_> = found.map(|(of, by)| by.map_or(f64::NAN, |by| size * change(*of) + by)).collect();
        if is_admitted_for_this {
            scene.set(|settings| settings.vertical = false)?;
        }
        Ok(found)
    }
}

/// The derivatives of `unknowns` by the state `which` in the present phase under `inputs`. In a phase nothing has a kink, not
/// even at θ = 0.
fn by_state(
    scene: &mut Scene,
    setup: &Setup,
    inputs: LinearLoad,
    unknowns: &[Source],
    which: usize,
) -> Option<Vec<Option<f64>>> {
    let motion = *scene.engine.motion();
    let components = motion.state.components();
    let scale = components[which].abs().max(State::usual(scene.engine.structure()).components()[which]);
    let load = scene.load(setup, inputs).value;
    let found = by_differences(components[which], scale, |value| {
        let mut components = components;
        components[which] = value;
        scene.engine.set_state(State::of(components));
        let outputs = scene.engine.outputs(load);
        let shown = Shown::new(scene, setup, load, outputs);
        let values: Vec<_> = unknowns.iter().map(|source| shown.value(*source).unwrap_or_default()).collect();
        Some(values).filter(|values| values.iter().all(|value| value.is_finite()))
    });
    scene.engine.set_motion(motion);
    found
}
