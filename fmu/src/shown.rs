//! The values of all Reals that are computed, at an instant.

use crate::failure::Failure;
use crate::model::Model;
use crate::setup::Setup;
use crate::variables::{Source, VARIABLES};
use rocking::{Load, Outputs, Reactions, State};
use std::cell::OnceCell;

/// What a model shows under a load.
pub(crate) struct Shown<'a> {
    model: &'a Model,
    setup: &'a Setup,
    load: Load,
    /// The outputs.
    pub outputs: Outputs,
    /// Computed when they are first asked for.
    reactions: OnceCell<Reactions>,
}

impl<'a> Shown<'a> {
    /// That of `model`, which follows `setup`, under `load`.
    #[inline]
    pub fn new(model: &'a Model, setup: &'a Setup, load: Load) -> Shown<'a> {
        Shown { model, setup, load, outputs: model.engine.outputs(load), reactions: OnceCell::new() }
    }

    /// The reactions.
    pub fn reactions(&self) -> &Reactions {
        self.reactions.get_or_init(|| self.model.engine.reactions(self.load))
    }

    /// Refuses the reactions, then the rates, that are among `references` where the equations have no solution.
    #[cold]
    pub fn check_solution(&self, references: &[u32]) -> Result<(), Failure> {
        let time = self.model.engine.motion().time;
        let last = |is_one: fn(Source) -> bool| {
            let variables = references.iter().rev().map(|reference| &VARIABLES[*reference as usize]);
            variables.into_iter().find(|variable| is_one(variable.source))
        };
        let Reactions { R_h, R_v, R_m } = self.reactions();
        let reaction = last(|source| matches!(source, Source::Reaction(_))).filter(|_| !(R_h + R_v + R_m).is_finite());
        let rate = last(|source| matches!(source, Source::StateRate(_))).filter(|_| !self.state_rates().is_finite());
        reaction.or(rate).map_or(Ok(()), |variable| Err(Failure::NoReaction { variable, time }))
    }

    /// Derivatives of the states.
    pub fn state_rates(&self) -> State {
        self.model.engine.sample(self.load).state_rates()
    }

    /// The value of a Real from `source`, if it is one that is computed.
    #[inline(never)]
    pub fn value(&self, source: Source) -> Option<f64> {
        let Shown { model, setup, load, .. } = *self;
        Some(match source {
            Source::Output(of) => of(&self.outputs),
            Source::Reaction(of) => of(self.reactions()),
            Source::StateRate(which) => self.state_rates().components()[which],
            Source::Indicator(which) => model.engine.sample(load).event_indicators()[which],
            Source::Peak(_) if !setup.peaks || model.is_integrated_outside() => f64::NAN,
            Source::Peak(of) => of(model.peaks(setup, load).peaks()),
            Source::Worst(_) | Source::WorstInstant(_) if !setup.validity || model.is_integrated_outside() => f64::NAN,
            Source::Worst(which) => model.validity(setup, load).worst[which].value,
            Source::WorstInstant(which) => model.validity(setup, load).worst[which].time,
            Source::Restraint(of) => of(&model.engine.restraints()),
            Source::Dissipator(of) => of(&model.engine.motion().dissipators),
            Source::Impulse(of) => of(&model.engine.motion().impulse),
            Source::Derived(derived) => (derived.value)(model.engine.structure()),
            Source::Ground(which) => load[which],
            Source::Overturning => model.overturned_at().unwrap_or(setup.start_time),
            Source::Time => model.engine.motion().time,
            Source::RecordDuration => model.record_duration(setup),
            _ => return None,
        })
    }
}
