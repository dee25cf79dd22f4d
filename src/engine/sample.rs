//! A motion at one instant.

use crate::engine::motion::Motion;
use crate::levels::level::{Level, edges};
use crate::mechanics::instant::{Instant, Second};
use crate::mechanics::lateral::Coordinates;
use crate::mechanics::load::Load;
use crate::mechanics::restraint::{Kept, Restraints, restraints};
use crate::{Output, Phase, Reactions, State};
use std::cell::OnceCell;

/// A motion at one instant; at a transition, just after it.
#[derive(Clone, Copy, Debug)]
pub struct Sample<'a, Q: Coordinates = f64> {
    /// Time, state and phase, transitions and impulses so far.
    pub motion: Motion<Q>,
    /// Load at the instant.
    pub load: Load<Q>,
    pub(crate) level: &'a dyn Level<Q>,
}

impl<Q: Coordinates> Sample<'_, Q> {
    /// ü and θ̈; once overturned, those of the instant before.
    pub(crate) fn second(&self) -> Second<f64, Q> {
        let Sample { motion, load, level } = self;
        level.accelerations(motion.phase.in_motion(level.structure()), (&motion.state, *load), motion.kept())
    }

    /// The structure at the instant, without θ̈.
    fn instant(&self) -> Instant<'_, f64, Q> {
        let Sample { motion, load, level } = self;
        Instant::of(level.structure(), motion.phase.in_motion(level.structure()), &motion.state, *load)
    }

    /// The reactions; once overturned, those of the instant before.
    pub fn reactions(&self) -> Reactions {
        Reactions::at(&self.instant(), &self.second())
    }

    /// The part of the reactions that the edges of the base carry: all of it, unless the structure is restrained.
    pub fn edges(&self) -> Reactions {
        edges_of(self.level, self.motion.phase, (&self.motion.state, self.load), self.motion.kept())
    }

    /// The forces of the restraints.
    pub fn restraints(&self) -> Restraints {
        restraints(&self.instant(), self.level.subject().detail.angles(), &self.motion.dissipators)
    }

    /// The value of `output`; once overturned, the value of the instant before.
    pub fn output(&self, output: Output) -> f64 {
        self.outputs()(output)
    }

    /// The values of outputs, of which each costs less than by [`Sample::output`].
    pub fn outputs(&self) -> impl Fn(Output) -> f64 {
        let (shown, ties) = (self.shown(), OnceCell::new());
        move |output| {
            let ties = || ties.get_or_init(|| self.restraints());
            match output {
                Output::P_t => ties().P_t,
                Output::F_d1 => ties().F_d1,
                Output::F_d2 => ties().F_d2,
                _ => output.in_motion(&shown, self.motion.kept()),
            }
        }
    }

    pub(crate) fn shown(&self) -> Instant<'_, f64, Q> {
        let Sample { motion, load, level } = self;
        let phase = motion.phase.in_motion(level.structure());
        shown::<Q>(*level, phase, (&motion.state, *load), motion.kept())
    }
}

/// The part of the reactions that the edges of the base of `level` carry, as [`Sample::edges`].
pub(crate) fn edges_of<Q: Coordinates>(
    level: &dyn Level<Q>,
    phase: Phase,
    (state, load): (&State<Q>, Load<Q>),
    kept: Kept,
) -> Reactions {
    let phase = phase.in_motion(level.structure());
    let x = Instant::of(level.structure(), phase, state, load);
    let second = level.accelerations(phase, (state, load), kept);
    edges(&x, level.subject(), kept.0, Reactions::at(&x, &second))
}

/// The structure of `level` as outputs read it, with θ̈ if one of them needs it.
#[inline]
pub(crate) fn shown<'a, Q: Coordinates>(
    level: &'a dyn Level<Q>,
    phase: Phase,
    (state, load): (&State<Q>, Load<Q>),
    kept: Kept<'a>,
) -> Instant<'a, f64, Q> {
    let structure = level.structure();
    let x = Instant { settled: kept.1, ..Instant::of(structure, phase, state, load) };
    if !structure.gauges().has_feedthrough {
        return x;
    }
    x.accelerated(&level.accelerations(phase, (state, load), kept))
}
