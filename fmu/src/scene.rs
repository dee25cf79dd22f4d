//! The structure on its ground: how a simulation starts from its setup, and what acts on the structure and has been
//! found out about it since.

use crate::failure::Refusal;
use crate::floor_variables::{lateral_states, numbers, settlements};
use crate::ground::{CachedRecord, GroundRecord, RecordDigest};
use crate::resources::Archive;
use crate::setup::Setup;
use rocking::engine::Settings;
use rocking::mechanics::load::{LOADS, VERTICAL};
use rocking::run::Runs;
use rocking::run::fall::{FallPeaks, FallWatch};
use rocking::run::ground_motion::{Elapsed, Placement};
use rocking::run::host_step::Checkpoint;
use rocking::run::record::Record;
use rocking::run::validity::{Findings, Limits, Validity};
use rocking::{Engine, LinearLoad, Load, Piece, State, Structure, Transition, Watch};
use serde::{Deserialize, Serialize};
use std::borrow::Cow;
use std::cell::OnceCell;
use std::sync::Arc;

pub struct Scene<Q: Runs = f64> {
    pub engine: Engine<Q>,
    /// The record that the ground follows, as its files give it.
    pub source: Option<Arc<GroundRecord>>,
    /// The record in m/s² and as the setup scales it.
    pub ground: Option<Record>,
    /// Time since the start, on ground that follows a record.
    pub elapsed: Elapsed,
    /// If the host integrates: the engine is then where the host is, and the motion between its steps is not the engine's to watch.
    pub outside: Option<HostMotion<Q>>,
    pub peaks: FallPeaks,
    pub validity: Findings,
    /// How many lateral coordinates the table has.
    pub lateral: usize,
    /// How many settlements for good it has.
    pub settlements: usize,
    /// The structure at full detail.
    structure: Structure,
    /// The numbers that follow from its own, once they are asked for.
    known: OnceCell<Vec<f64>>,
}

/// The knowledge of an instance beside the present of a motion that the host integrates.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct HostMotion<Q: Runs = f64> {
    /// The last motion that was known.
    pub known: Checkpoint<Q>,
    /// The inputs when event mode was entered: what is set there has not acted before.
    pub arrived: Load<Q>,
    /// When event mode was entered last: where the record jumps later, it does so once event mode is entered there.
    pub event: Elapsed,
}

/// Hears of transitions. One type for all listeners keeps the library small.
pub type Tell<'a, Q> = dyn FnMut(&Transition<Q>) + 'a;

/// Watches peaks and limits, if they are asked for. One type for all cases keeps the library small.
pub struct Watching<'a, 'b, Q: Runs> {
    pub peaks: Option<FallWatch<Q>>,
    pub validity: Option<&'a mut Validity>,
    pub told: &'a mut Tell<'b, Q>,
}

impl<Q: Runs> Watch<Q> for Watching<'_, '_, Q> {
    fn piece(&mut self, piece: &Piece<Q>) {
        self.peaks.iter_mut().for_each(|peaks| peaks.piece(piece));
        self.validity.iter_mut().for_each(|validity| validity.piece(piece));
    }

    fn transition(&mut self, transition: &Transition<Q>) {
        self.peaks.iter_mut().for_each(|peaks| peaks.transition(transition));
        self.validity.iter_mut().for_each(|validity| validity.transition(transition));
        (self.told)(transition);
    }
}

impl Setup {
    /// Whether ground that follows `ground` may move vertically.
    pub fn may_move_vertically(&self, ground: Option<&Record>) -> bool {
        self.vertical || ground.is_some_and(|record| record.vertical().is_some())
    }

    /// `structure` at the start time, on ground that may move vertically if `vertical`.
    fn engine<Q: Runs>(&self, structure: Structure, vertical: bool) -> Result<Engine<Q>, Refusal> {
        let &Setup { detail, tolerance, start_time, .. } = self;
        let settings = Settings { detail, tolerance, vertical, stops: false };
        let initial = self.initial.on(&structure)?;
        Ok(Q::START(structure, initial, start_time, settings)?)
    }

    /// The record of `source` in m/s² and scaled. Refuses scales that leave no ground motion in the range of the inputs.
    fn scaled(&self, source: &GroundRecord, g: f64) -> Result<Record, Refusal> {
        let (record, Placement { scale, time_scale, .. }) = (source.in_m_s2(g), self.placement);
        for (load, peak) in [(0, record.pga()), (VERTICAL, record.vertical_peak())] {
            LOADS[load].check(peak * scale.abs()).map_err(Refusal::StrongRecord)?;
        }
        Ok(record.scaled(time_scale, scale)?)
    }
}

impl<Q: Runs> Scene<Q> {
    /// At the start that `setup` describes, of the `archive`. The record is not parsed if it is `kept`.
    pub fn new(setup: &Setup, archive: &Archive, kept: &mut Option<CachedRecord>) -> Result<Scene<Q>, Refusal> {
        let (contents, g) = (&archive.contents, setup.g(&archive.contents));
        let source = archive.ground(&setup.record, &setup.record_v, g, kept)?;
        let ground = source.as_deref().map(|source| setup.scaled(source, g)).transpose()?;
        let structure = contents.with(&setup.numbers)?;
        let engine = setup.engine::<Q>(structure.clone(), setup.may_move_vertically(ground.as_ref()))?;
        let peaks = FallPeaks::since(setup.start_time, engine.structure(), setup.detail);
        let validity = Findings::since(setup.start_time);
        let [lateral, settlements] = [lateral_states, settlements].map(|count| count(&contents.structure));
        let (elapsed, outside, known) = (Elapsed::default(), None, OnceCell::new());
        Ok(Scene { engine, source, ground, elapsed, outside, peaks, validity, lateral, settlements, structure, known })
    }

    /// Lets the engine do what `change` makes of its settings.
    pub fn set(&mut self, change: impl FnOnce(&mut Settings)) -> Result<(), Refusal> {
        let mut settings = self.engine.settings();
        change(&mut settings);
        if settings != self.engine.settings() {
            self.engine = self.engine.remade(settings)?;
        }
        Ok(())
    }

    /// Whether messages show u: that of one mass which has a mode.
    pub fn shows_u(&self) -> bool {
        let structure = self.engine.structure();
        structure.is_one_mass() && !structure.modes().is_empty()
    }

    /// The numbers that follow from those of the structure.
    pub fn known(&self) -> &[f64] {
        self.known.get_or_init(|| numbers(&self.structure).into_iter().map(|(_, value)| value).collect())
    }

    /// The numbers of a `state` and of settlements for good, or of their rates, in the order of the table.
    pub fn components<'a>(&'a self, state: State<Q>, settled: &'a [f64]) -> impl Iterator<Item = f64> + 'a {
        let of = |coordinates: Q| (0..self.lateral).map(move |j| self.place(j).map_or(0.0, |at| coordinates.of(at)));
        let settled = settled.iter().take(self.settlements).copied();
        of(state.u).chain(of(state.u_dot)).chain([state.theta, state.theta_dot]).chain(settled)
    }

    /// The place in the engine of lateral coordinate `j` of the table, whose last on ground that gives are y, and x of a base that may
    /// slide; none of what does not move.
    pub fn place(&self, j: usize) -> Option<usize> {
        let (structure, modes) = (self.engine.structure(), self.engine.structure().modes().len());
        let Some(ground) = structure.foundation() else { return (j < modes).then_some(j) };
        match (self.lateral - j, ground.slide()) {
            (1, Some(slide)) => Some(slide),
            (2, Some(_)) | (1, None) => Some(modes),
            _ => (j < modes).then_some(j),
        }
    }

    pub fn states(&self) -> impl Iterator<Item = f64> {
        let motion = self.engine.motion();
        self.components(motion.state, motion.settled.as_ref())
    }

    /// The load that acts now: `inputs` and the record.
    #[inline]
    pub fn load(&self, setup: &Setup, inputs: LinearLoad<Q>) -> LinearLoad<Q> {
        let Some(ground) = &self.ground else { return inputs };
        let (ground, elapsed) = (setup.ground_motion(ground), self.elapsed);
        inputs.on_ground(match &self.outside {
            Some(outside) => ground.since(outside.event, elapsed),
            None => ground.at(elapsed),
        })
    }

    /// The load that acts now under the inputs `load`.
    pub fn acting(&self, setup: &Setup, load: Load<Q>) -> Load<Q> {
        self.load(setup, load.into()).value
    }

    /// Whether no step has been made, and the first phase lasts: under `load` no transition is due at once.
    pub fn is_at_start(&self, load: Load<Q>) -> bool {
        self.engine.motion().work.steps == 0 && !self.engine.is_due(load)
    }

    /// From the first to the last sample of the record, s; 0 without one.
    pub fn record_duration(&self) -> f64 {
        self.ground.as_ref().map_or(0.0, |record| record.end() - record.start())
    }

    pub fn digest(&self) -> Option<RecordDigest> {
        self.source.as_ref().map(|source| source.digest)
    }

    /// Whether the structure has overturned, which ends the simulation.
    pub fn has_overturned(&self) -> bool {
        self.engine.motion().phase.properties().is_over
    }

    /// The instant of overturning, s.
    pub fn overturned_at(&self) -> Option<f64> {
        let motion = self.outside.as_ref().map_or(self.engine.motion(), |outside| &outside.known.motion);
        self.has_overturned().then_some(motion.time)
    }

    /// The limits that the motion has passed since the start; before the first step by the reactions under `load`.
    pub fn validity(&self, load: Load<Q>) -> Findings {
        let mut validity = self.watch_validity();
        if self.is_at_start(load) {
            validity.see_instant(&self.engine.sample(load));
        }
        *validity.found()
    }

    /// Goes on from what has been found so far.
    pub fn watch_validity(&self) -> Validity {
        Validity::new(self.engine.structure(), Limits::default(), self.validity)
    }

    /// Applies the transition that is due, if there is one, and all that are due at once then, or since the inputs `load` have
    /// jumped.
    pub fn transit(&mut self, setup: &Setup, load: Load<Q>, told: &mut Tell<Q>) {
        let acting = self.acting(setup, load);
        let mut validity = self.watch_validity();
        let mut watch = Watching { peaks: None, validity: setup.validity.then_some(&mut validity), told };
        self.engine.transit(&mut watch);
        self.engine.transit_at_once(acting, &mut watch);
        drop(watch);
        self.validity = *validity.found();
    }

    /// The peaks since the start, of a structure that has overturned those before it fell; before the first step, the
    /// values under `load`.
    pub fn peaks(&self, load: Load<Q>) -> Cow<'_, FallPeaks> {
        let mut peaks = Cow::Borrowed(&self.peaks);
        if self.is_at_start(load) {
            peaks.to_mut().see_instant(&self.engine.sample(load));
        }
        peaks
    }
}
