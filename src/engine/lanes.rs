//! Engines whose steps are taken together: leaps in full contact ([`leaps`]), and steps of rocking by Eqs 5 and 6 ([`rocking`]).
//!
//! A register of the processor has one number of each run. The operations on the numbers of a run are those of the run by itself,
//! in the same order, so that all results have the same bits.

pub(crate) mod leaps;
pub(crate) mod number;
pub(crate) mod rocking;
pub(crate) mod sought;

use super::{Advance, AdvanceError, Engine, Loop, MAX_STEPS_PER_ADVANCE, Progress, Settings};
use crate::engine::motion::Motion;
use crate::engine::piece::{Piece, Watch};
use crate::levels::start::Start;
use crate::mechanics::arc::Arc;
use crate::mechanics::lateral::Coordinates;
use crate::{Detail, LinearLoad, Phase, Transition};
use leaps::leaping;
use pulp::Simd;
use rocking::{RockingLanes, by_equations_5_and_6};
use sought::{MOST_MODES, Passes};

/// Watches a motion after the piece under way, which it `passes` if the watcher need not see it.
struct After<'a, W> {
    watch: &'a mut W,
    passes: bool,
}

impl<Q: Coordinates, W: Passes<Q>> Watch<Q> for After<'_, W> {
    fn piece(&mut self, piece: &Piece<Q>) {
        if std::mem::take(&mut self.passes) { self.watch.pass() } else { self.watch.piece(piece) }
    }

    fn transition(&mut self, transition: &Transition<Q>) {
        self.passes = false; // a step without duration is no piece
        self.watch.transition(transition);
    }
}

impl<Q: Coordinates> Engine<Q> {
    /// Comes to `elapsed` (s) since the start of `advance`.
    pub(crate) fn come_to(&mut self, elapsed: f64, advance: &mut Advance<Q>) {
        (advance.elapsed, self.motion.time) = (elapsed, advance.start + elapsed);
    }

    /// Whether steps of the structure can be taken among others: its leaps in full contact, and if it has one mass its rocking by
    /// Eqs 5 and 6. It has no ties.
    pub(crate) fn is_for_lanes(&self) -> bool {
        let steps = if Q::IS_ONE {
            by_equations_5_and_6(&*self.level).is_some()
        } else {
            self.structure().modes().len() <= MOST_MODES && leaping(&*self.level, &self.motion.dissipators).is_some()
        };
        steps && !self.level.subject().is_tied
    }

    /// Whether such a structure is in full contact from which it may lift off, and leaps there.
    #[inline]
    pub(crate) fn may_leap(&self) -> bool {
        let Motion { phase, chatter, .. } = &self.motion;
        phase.properties().is_down && chatter.held <= 0.0 && self.settings.detail == Detail::Auto
    }

    /// Advances such a structure by `interval` (s) under `load` like [`Engine::go_on`], on `advance` unless one leap is all of it.
    pub(crate) fn begin<W: Passes<Q>>(
        &mut self,
        interval: f64,
        load: LinearLoad<Q>,
        advance: &mut Option<Advance<Q>>,
        watch: &mut W,
    ) -> Result<Option<Progress>, AdvanceError> {
        self.check(interval, &load)?;
        if let Some(leapt) = self.leap(interval, load, watch) {
            return leapt.map(|()| Some(Progress::Complete));
        }
        let (time, last_step) = (self.motion.time, self.motion.work.steps + MAX_STEPS_PER_ADVANCE);
        let advance = advance.insert(Advance::new(self.structure(), time, interval, load, last_step));
        self.go_on(advance, false, true, watch)
    }

    /// Goes on with `advance` to its end, or to a step of rocking, if the engine `stops` before it. The engine has the next series
    /// already if the series `is_expanded`.
    #[inline(always)]
    pub(crate) fn go_on(
        &mut self,
        advance: &mut Advance<Q>,
        mut is_expanded: bool,
        stops: bool,
        watch: &mut dyn Watch<Q>,
    ) -> Result<Option<Progress>, AdvanceError> {
        let Engine { level, motion, arc, room, settings: Settings { stops: at_transitions, .. }, .. } = self;
        let level = &**level;
        let is_next = |phase: Phase| stops && Q::IS_ONE && phase.properties().rotates;
        if !is_expanded && is_next(motion.phase) && advance.elapsed < advance.end {
            return Ok(None);
        }
        let expand = |phase: Phase, start: &Start<Q>, arc: &mut Arc<Q>| {
            match phase {
                _ if std::mem::take(&mut is_expanded) => {}
                _ if is_next(phase) => return false,
                _ => level.series(phase, start, arc),
            }
            true
        };
        Loop { level, expand, arc, room, stops: *at_transitions }.go(motion, &mut None, advance, watch)
    }

    /// Takes the step of `advance` that was taken in `lane` of `steps`, and goes on like [`Engine::go_on`] to the next step of rocking.
    #[inline]
    pub(crate) fn take<S: Simd, W: Passes<Q>>(
        &mut self,
        steps: &RockingLanes<'_, S, Q>,
        lane: usize,
        advance: &mut Advance<Q>,
        watch: &mut W,
    ) -> Result<Option<Progress>, AdvanceError> {
        let passes = steps.write(lane, &mut self.arc);
        self.go_on(advance, true, true, &mut After { watch, passes })
    }
}
