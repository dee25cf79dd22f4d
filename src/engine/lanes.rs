//! An engine among others that step together.

use super::{Advance, AdvanceError, Engine, Loop, MAX_STEPS_PER_ADVANCE, Progress, Settings, is_at_its_end, leapt};
use crate::engine::motion::Motion;
use crate::engine::phases;
use crate::engine::piece::{Piece, Watch, magnitudes};
use crate::levels::detail::Elastic;
use crate::levels::level::{Level, most_of_swings};
use crate::levels::nonlinear::NonlinearRocking;
use crate::levels::nonlinear::lanes::{RockingStep, Stepped};
use crate::mechanics::reach::Magnitudes;
use crate::series::taylor::{Arc, Start};
use crate::{LinearLoad, Phase, State, Structure};

/// A step that an engine is about to take, of which only the end and bounds are known.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Bounded<'a> {
    engine: &'a Engine,
    /// s.
    pub duration: f64,
    pub load: LinearLoad,
    pub end: State,
    /// Bounds of the magnitudes of the state.
    pub most: State,
}

impl Bounded<'_> {
    /// The structure, and bounds of the magnitudes.
    #[inline]
    pub(crate) fn bounds(&self) -> (&Structure, Magnitudes<'static, f64>) {
        let Engine { level, motion, .. } = self.engine;
        let loads = [0.0, self.duration].map(|tau| self.load.at(tau));
        (level.structure(), magnitudes(level.structure(), motion.phase, loads, self.most))
    }

    /// Instants (s) and ground accelerations of the ends.
    #[inline]
    pub(crate) fn ends(&self) -> [(f64, f64); 2] {
        let start = self.engine.motion.time;
        [0.0, self.duration].map(|tau| (start + tau, self.load.at(tau).a_g))
    }
}

/// A watch of a motion whose steps are taken among others.
pub(crate) trait Passes: Watch {
    /// Passes `step` if the step certainly changes nothing that the watch looks for. Otherwise the piece is to be shown.
    fn passes(&mut self, step: &Bounded) -> bool;
}

const STEPS_ALONE: &str = "another level steps alone";

/// The `level` by its type, if it is Eqs 5 and 6.
#[inline(always)]
fn by_equations_5_and_6(level: &dyn Level) -> Option<&Elastic<NonlinearRocking>> {
    level.as_any()?.downcast_ref()
}

impl Engine {
    /// Whether the structure rocks by Eqs 5 and 6 without ties, so that its steps of rocking can be taken among others.
    pub(crate) fn is_for_lanes(&self) -> bool {
        by_equations_5_and_6(&*self.level).is_some() && !self.level.subject().is_tied
    }

    /// Takes such a structure over `interval` (s) under `load`, all but the clock, if one leap in full contact is all of it.
    #[inline(always)]
    pub(crate) fn leaps<W: Passes>(&mut self, interval: f64, load: LinearLoad, watch: &mut W) -> bool {
        let Some(level) = by_equations_5_and_6(&*self.level) else { return false };
        let motion = &self.motion;
        let is_free = motion.phase == Phase::FullContact && motion.held() <= 0.0;
        if !is_free || self.check(interval, &load).is_err() {
            return false;
        }
        let start = level.subject().start(motion.state, &motion.dissipators, load, interval);
        let Some((end, swings)) = level.bounded_leap(&start) else { return false };
        if !end.is_finite() {
            return false;
        }
        let most = most_of_swings(level.structure(), &start, &end, &swings);
        if watch.passes(&Bounded { engine: self, duration: interval, load, end, most }) {
            leapt((&*self.level, &self.room), &mut self.motion, interval, load, end, &mut ()).is_ok()
        } else {
            leapt((&*self.level, &self.room), &mut self.motion, interval, load, end, watch).is_ok()
        }
    }

    /// Begins an advance by `interval` (s) under `load`, which is no such leap.
    #[inline(always)]
    pub(crate) fn begin(&self, interval: f64, load: LinearLoad) -> Result<Advance<f64>, AdvanceError> {
        self.check(interval, &load)?;
        let last_step = self.motion.work.steps + MAX_STEPS_PER_ADVANCE;
        Ok(Advance::new(self.structure(), self.motion.time, interval, load, last_step))
    }

    /// Goes on with `advance` to its end, or to a step of rocking, which `step` becomes; without a `step` to its end. The engine has
    /// the next series already if the series `is_expanded`.
    #[inline(always)]
    pub(crate) fn go_on(
        &mut self,
        advance: &mut Advance<f64>,
        mut is_expanded: bool,
        mut step: Option<&mut RockingStep>,
        watch: &mut dyn Watch,
    ) -> Result<Option<Progress>, AdvanceError> {
        let Engine { level, motion, arc, room, settings: Settings { stops, .. } } = self;
        let any = &**level;
        let level = by_equations_5_and_6(any).expect(STEPS_ALONE);
        if let Phase::Rocking(side) = motion.phase
            && !is_expanded
            && let Some(step) = &mut step
            && advance.elapsed < advance.end
        {
            **step = level.rocking().step(side, &advance.start(level.subject(), motion));
            return Ok(None);
        }
        let expand = |phase: Phase, start: &Start, arc: &mut Arc| {
            match (phase, &mut step) {
                _ if std::mem::take(&mut is_expanded) => {}
                (Phase::Rocking(side), Some(step)) => {
                    **step = level.rocking().step(side, start);
                    return false;
                }
                _ => level.series(phase, start, arc),
            }
            true
        };
        let phases = |motion: &Motion| phases::of::<f64>(level.structure(), motion);
        Loop { level: any, phases, expand, arc, room, stops: *stops }.go(motion, &mut None, advance, watch)
    }

    /// Takes the step of `advance` that was `stepped` among others, whose series `write` gives, and goes on like [`Engine::go_on`].
    #[inline]
    pub(crate) fn take<W: Passes>(
        &mut self,
        stepped: &Stepped,
        write: impl FnOnce(&mut Arc),
        advance: &mut Advance<f64>,
        step: &mut RockingStep,
        watch: &mut W,
    ) -> Result<Option<Progress>, AdvanceError> {
        let level = by_equations_5_and_6(&*self.level).expect(STEPS_ALONE);
        let &Stepped { order, duration, stays, end, most } = stepped;
        let is_whole = duration == advance.end - advance.elapsed;
        let is_last = !is_whole && is_at_its_end(level, &self.motion, duration, None);
        if !stays || is_last || self.motion.work.steps == advance.last_step {
            write(&mut self.arc);
            return self.go_on(advance, true, Some(step), watch);
        }
        let load = advance.load.from(advance.elapsed);
        if !watch.passes(&Bounded { engine: self, duration, load, end, most }) {
            write(&mut self.arc);
            let Engine { level, motion, arc, room, .. } = &*self;
            watch.piece(&Piece { before: motion, duration, load, end, level: &**level, arc: Some(arc), room });
        }
        let motion = &mut self.motion;
        motion.work.steps += 1;
        motion.work.evaluations += order as u64;
        motion.state = end;
        motion.chatter.pass(duration);
        motion.time = advance.pass(duration);
        if advance.elapsed >= advance.interval {
            return Ok(Some(Progress::Complete));
        }
        self.go_on(advance, false, Some(step), watch)
    }
}
