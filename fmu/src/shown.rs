//! The values of all Reals that are computed, at an instant.

use crate::scene::Scene;
use crate::setup::Setup;
use crate::variables::Source;
use rocking::{Load, Outputs, Reactions, State};
use std::cell::OnceCell;

/// The values of a scene under a load.
pub(crate) struct Shown<'a> {
    scene: &'a Scene,
    pub setup: &'a Setup,
    load: Load,
    /// The outputs.
    outputs: Outputs,
    /// Computed when they are first asked for, as the next.
    reactions: OnceCell<Reactions>,
    /// Derivatives of the states.
    rates: OnceCell<State>,
}

impl<'a> Shown<'a> {
    /// The values of `scene`, which follows `setup` and has these `outputs`, under `load`.
    pub fn new(scene: &'a Scene, setup: &'a Setup, load: Load, outputs: Outputs) -> Shown<'a> {
        let (reactions, rates) = Default::default();
        Shown { scene, setup, load, outputs, reactions, rates }
    }

    /// The reactions.
    pub fn reactions(&self) -> &Reactions {
        self.reactions.get_or_init(|| self.scene.engine.reactions(self.load))
    }

    /// The last of the reactions, then of the rates, that are among `references` if the equations have no solution for them.
    pub fn unsolved(&self, references: &[u32], sources: &[Source]) -> Option<u32> {
        let last = |is_one: fn(Source) -> bool| {
            references.iter().copied().rfind(|reference| is_one(sources[*reference as usize]))
        };
        let is_finite = |reactions: &Reactions| (reactions.R_h + reactions.R_v + reactions.R_m).is_finite();
        let reactions = self.reactions.get().filter(|reactions| !is_finite(reactions));
        let reaction = reactions.and_then(|_| last(|source| matches!(source, Source::Reaction(_))));
        let rates = self.rates.get().filter(|rates| !rates.is_finite());
        reaction.or_else(|| rates.and_then(|_| last(|source| matches!(source, Source::StateRate(_)))))
    }

    /// Derivatives of the states.
    pub fn state_rates(&self) -> &State {
        self.rates.get_or_init(|| self.scene.engine.sample(self.load).state_rates())
    }

    /// The value of a Real from `source`, if it is one that is computed.
    pub fn value(&self, source: Source) -> Option<f64> {
        let Shown { scene, setup, load, .. } = *self;
        Some(match source {
            Source::Output(of) => of(&self.outputs),
            Source::Reaction(of) => of(self.reactions()),
            Source::StateRate(which) => self.state_rates().components()[which],
            Source::Indicator(which) => scene.engine.sample(load).event_indicators()[which],
            Source::Peak(_) if !setup.peaks || scene.is_integrated_outside() => f64::NAN,
            Source::Peak(of) => of(scene.peaks(setup, load).peaks()),
            Source::Worst(_) | Source::WorstInstant(_) if !setup.validity || scene.is_integrated_outside() => f64::NAN,
            Source::Worst(which) => scene.validity(load).worst[which].value,
            Source::WorstInstant(which) => scene.validity(load).worst[which].time,
            Source::Restraint(of) => of(&scene.engine.restraints()),
            Source::Dissipator(of) => of(&scene.engine.motion().dissipators),
            Source::Impulse(of) => of(&scene.engine.motion().impulse),
            Source::Derived(derived) => (derived.value)(scene.engine.structure()),
            Source::Ground(which) => load[which],
            Source::Overturning => scene.overturned_at().unwrap_or(setup.start_time),
            Source::Time => scene.engine.motion().time,
            Source::RecordDuration => scene.record_duration(),
            _ => return None,
        })
    }
}
