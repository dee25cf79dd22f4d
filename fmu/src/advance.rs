//! How the structure on its ground is taken over one step of a co-simulation.

use crate::scene::Scene;
use crate::setup::Setup;
use rocking::engine::{AdvanceError, Progress};
use rocking::{LinearLoad, Watch};

/// Part of the time, or of 1/p_l if that is more, that rounding can shift a transition by.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

impl Scene {
    /// [`Scene::advance`] up to the first transition. One within rounding of the end of the step counts as at its end: a
    /// host that goes back and steps to the instant that it was told meets it again. One at the very start, where an
    /// input has just jumped, is applied at once: every step takes time.
    #[inline(never)]
    pub fn advance_to_transition<W: Watch>(
        &mut self,
        setup: &Setup,
        step: f64,
        inputs: &LinearLoad,
        watch: &mut W,
    ) -> Result<Progress, AdvanceError> {
        let (from, elapsed) = (self.engine.motion().time, self.elapsed);
        let until = from + step;
        let mut progress = self.advance(setup, step, inputs, watch)?;
        while progress == Progress::Transition && self.engine.motion().time <= from {
            progress = self.advance(setup, step, inputs, watch)?;
        }
        let rounding = ROUNDING * until.abs().max(self.engine.structure().p_l.recip());
        if progress == Progress::Complete {
            let later = inputs.from(step);
            let load = if self.may_move_vertically(setup) { self.load(setup, later) } else { later };
            if self.engine.goes_on_for(rounding, load) {
                return Ok(progress);
            }
            let motion = *self.engine.motion();
            progress = self.follow(setup, rounding, &later, watch).unwrap_or(Progress::Complete);
            if progress == Progress::Complete {
                self.engine.set_motion(motion);
            }
        }
        if until - self.engine.motion().time <= rounding {
            self.engine.set_time(until);
            self.elapsed = elapsed.and(step);
        }
        Ok(progress)
    }

    /// Advances by `step` (s) under `inputs` and the record, with peaks and validity watched as `setup` says. If it
    /// fails, nothing has changed.
    #[inline(always)]
    pub fn advance<W: Watch>(
        &mut self,
        setup: &Setup,
        step: f64,
        inputs: &LinearLoad,
        watch: &mut W,
    ) -> Result<Progress, AdvanceError> {
        if setup.peaks || setup.validity {
            self.advance_watched(setup, step, inputs, watch)
        } else {
            self.follow(setup, step, inputs, watch)
        }
    }

    #[inline(never)]
    fn advance_watched<W: Watch>(
        &mut self,
        setup: &Setup,
        step: f64,
        inputs: &LinearLoad,
        watch: &mut W,
    ) -> Result<Progress, AdvanceError> {
        let (mut peaks, mut validity) = (self.peaks, self.watch_validity());
        let progress = match (setup.peaks, setup.validity) {
            (_, false) => self.follow(setup, step, inputs, &mut (&mut peaks.watch(), watch)),
            (false, true) => self.follow(setup, step, inputs, &mut (&mut validity, watch)),
            (true, true) => self.follow(setup, step, inputs, &mut (&mut peaks.watch(), &mut (&mut validity, watch))),
        }?;
        (self.peaks, self.validity) = (peaks, *validity.found());
        Ok(progress)
    }

    #[inline(always)]
    fn follow<W: Watch>(
        &mut self,
        setup: &Setup,
        step: f64,
        inputs: &LinearLoad,
        watch: &mut W,
    ) -> Result<Progress, AdvanceError> {
        let Scene { engine, ground, elapsed, .. } = self;
        let Some(ground) = ground else { return engine.advance(step, *inputs, watch) };
        setup.ground_motion(ground).advance(engine, elapsed, step, *inputs, watch)
    }
}
