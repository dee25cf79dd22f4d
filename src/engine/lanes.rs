//! An engine among others that step together.

use super::{AdvanceError, Engine, FAR, Loop, MAX_STEPS_PER_ADVANCE, Progress, Settings};
use crate::engine::motion::Motion;
use crate::engine::phases;
use crate::engine::piece::{Piece, Watch};
use crate::levels::detail::AnyLevel;
use crate::levels::level::Level;
use crate::levels::nonlinear::lanes::{RockingStep, Stepped};
use crate::levels::shown::Searched;
use crate::mechanics::lateral::Coordinates;
use crate::series::taylor::{Arc, Start};
use crate::{LinearLoad, Phase, State};

impl Engine {
    /// The step of `interval` (s) under `load`, if the structure rocks by Eqs 5 and 6 and its series may reach to the end.
    #[inline]
    pub(crate) fn rocking_step(&self, interval: f64, load: LinearLoad) -> Option<RockingStep> {
        let AnyLevel::Nonlinear(level) = &*self.level else { return None };
        let Phase::Rocking(side) = self.motion.phase else { return None };
        let is_one_part = interval <= FAR / f64::vibration(level.structure()).contact;
        if !is_one_part || self.motion.due.is_some() || self.check(interval, &load).is_err() {
            return None;
        }
        let begin = level.subject().start(self.motion.state, &self.motion.dissipators, load, interval);
        let Start { a_g, a_top, a_v, .. } = begin;
        level.rocking().step(side, &Start { a_g: a_g.from(0.0), a_top: a_top.from(0.0), a_v: a_v.from(0.0), ..begin })
    }

    /// State at the end of `interval` (s) under `load`, and bounds of the state until then, if the structure stays in full contact
    /// by an exact flow.
    #[inline(always)]
    pub(crate) fn contact_leap(&self, interval: f64, load: LinearLoad) -> Option<(State, State)> {
        let AnyLevel::Nonlinear(level) = &*self.level else { return None };
        let motion = &self.motion;
        let is_plain = motion.phase == Phase::FullContact && motion.held() <= 0.0 && motion.due.is_none();
        if !is_plain || self.check(interval, &load).is_err() {
            return None;
        }
        let start = level.subject().start(motion.state, &motion.dissipators, load, interval);
        let (end, rates) = level.bounded_leap(&start)?;
        end.is_finite().then(|| (end, rates.most(&start, &end)))
    }

    /// Takes such a leap, which ends at `until` (s).
    #[inline(always)]
    pub(crate) fn leap_to(&mut self, end: State, (interval, until): (f64, f64)) {
        self.motion.state = end;
        self.motion.work.steps += 1;
        self.motion.chatter.pass(interval);
        self.motion.time = until;
    }

    /// Bounds of the magnitudes of the searched outputs over such a step, by bounds of the state.
    #[inline]
    pub(crate) fn bounds(&self, interval: f64, load: LinearLoad, most: &State) -> Searched<f64> {
        self.level.most(self.motion.phase, [0.0, interval].map(|tau| load.at(tau)), most)
    }

    /// Advances by such a step, or by several with transitions between, to `until` (s). The first series is given by `write`.
    pub(crate) fn advance_by<W: Watch>(
        &mut self,
        (interval, until): (f64, f64),
        load: LinearLoad,
        watch: &mut W,
        write: impl FnOnce(&mut Arc),
    ) -> Result<Progress, AdvanceError> {
        let Engine { level, motion, arc, settings: Settings { stops, .. } } = self;
        let any = &**level;
        let AnyLevel::Nonlinear(level) = any else { unreachable!("another level has no such step") };
        write(arc);
        let (mut before, last_step) = (None, motion.work.steps + MAX_STEPS_PER_ADVANCE);
        let phases = |motion: &Motion| phases::of::<f64>(level.structure(), motion);
        let result = Loop { any, level, phases, arc, is_expanded: true, last_step, stops: *stops }.go(
            motion,
            &mut before,
            interval,
            load,
            watch,
        );
        match (&result, before) {
            (Err(_), Some(before)) => self.motion = before,
            (Err(_) | Ok(Progress::Overturned), _) => {}
            _ => self.set_time(until),
        }
        result
    }

    /// Takes such a step, which ends at `until` (s). If `watch` sees pieces, `write` gives the series.
    #[inline]
    pub(crate) fn step_to<W: Watch>(
        &mut self,
        &Stepped { order, end, .. }: &Stepped,
        (interval, until): (f64, f64),
        load: LinearLoad,
        watch: &mut W,
        write: impl FnOnce(&mut Arc),
    ) {
        let Engine { level, motion, arc, .. } = self;
        motion.work.steps += 1;
        motion.work.evaluations += order as u64;
        if W::SEES_PIECES {
            write(arc);
            let load = load.from(0.0);
            watch.piece(&Piece { before: motion, duration: interval, load, end, level, arc: Some(arc) });
        }
        motion.state = end;
        motion.chatter.pass(interval);
        motion.time = until;
    }
}
