//! The values of all Reals that are computed, at an instant.

use crate::scene::Scene;
use crate::setup::Setup;
use crate::source::Source;
use rocking::run::Runs;
use rocking::run::peaks::Peak;
use rocking::{Load, Output, Reactions, Sample, State};
use std::cell::OnceCell;

/// The values of a scene under a load.
pub struct Shown<'a, Q: Runs = f64> {
    pub scene: &'a Scene<Q>,
    pub setup: &'a Setup,
    pub load: Load<Q>,
    /// Computed when they are first asked for, as the next.
    reactions: OnceCell<Reactions>,
    rates: OnceCell<State<Q>>,
    sample: OnceCell<Sample<'a, Q>>,
}

impl<'a, Q: Runs> Shown<'a, Q> {
    pub fn new(scene: &'a Scene<Q>, setup: &'a Setup, load: Load<Q>) -> Shown<'a, Q> {
        let (reactions, rates, sample) = Default::default();
        Shown { scene, setup, load, reactions, rates, sample }
    }

    pub fn sample(&self) -> &Sample<'a, Q> {
        self.sample.get_or_init(|| self.scene.engine.sample(self.load))
    }

    fn reactions(&self) -> &Reactions {
        self.reactions.get_or_init(|| self.sample().reactions())
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

    pub fn state_rates(&self) -> &State<Q> {
        self.rates.get_or_init(|| self.sample().state_rates())
    }

    /// The value of a Real from `source`, if it is one that is computed.
    #[inline(never)]
    pub fn value(&self, source: Source) -> Option<f64> {
        let Shown { scene, setup, load, .. } = *self;
        let structure = scene.engine.structure();
        let peak = |of: Output| {
            let is_watched = setup.peaks && scene.outside.is_none();
            let found = is_watched.then(|| scene.peaks(load).peaks().of(of)).flatten();
            found.unwrap_or(Peak { magnitude: f64::NAN, time: f64::NAN })
        };
        Some(match source {
            Source::Reaction(of) => of(self.reactions()),
            Source::Indicator(which) => scene.engine.event_indicators(load)[which],
            Source::Worst(_) | Source::WorstInstant(_) if !setup.validity || scene.outside.is_some() => f64::NAN,
            Source::Worst(which) => scene.validity(load).worst[which].value,
            Source::WorstInstant(which) => scene.validity(load).worst[which].time,
            Source::Restraint(of) => of(&self.sample().restraints()),
            Source::Dissipator(of) => of(&scene.engine.motion().dissipators),
            Source::Impulse(of) => of(&scene.engine.motion().impulse),
            Source::Ground(true) => load.a_v,
            Source::Ground(false) => load.a_g,
            Source::Overturning => scene.overturned_at().unwrap_or(setup.start_time),
            Source::Time => scene.engine.motion().time,
            Source::RecordDuration => scene.record_duration(),
            Source::Output(of) => scene.engine.outputs(load)(of),
            Source::Coordinate(which) => scene.states().nth(which)?,
            Source::StateRate(which) => scene.components(*self.state_rates(), &self.sample().settling()).nth(which)?,
            Source::Peak(of) => peak(of).magnitude,
            Source::PeakInstant(of) => peak(of).time,
            Source::Derived(derived) => (derived.value)(structure.one()?),
            Source::Known(which) => *scene.known().get(which)?,
            _ => return None,
        })
    }
}
