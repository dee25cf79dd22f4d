//! How the structure on its ground is taken over one step of a co-simulation.

use crate::scene::Scene;
use crate::setup::Setup;
use rocking::engine::{AdvanceError, Progress};
use rocking::{Detail, LinearLoad, Motion, Phase, State, Watch};
use std::f64::consts::FRAC_PI_2;

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
            if self.goes_on_for(setup, rounding) {
                return Ok(progress);
            }
            let motion = *self.engine.motion();
            progress = self.follow(setup, rounding, &inputs.from(step), watch).unwrap_or(Progress::Complete);
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

    /// Whether no transition can come within `ahead` (s), a tiny time.
    fn goes_on_for(&self, setup: &Setup, ahead: f64) -> bool {
        let &Motion { phase, state: State { u, u_dot, theta, theta_dot }, .. } = self.engine.motion();
        let way = |rate: f64| ahead * (rate.abs() + 1.0); // at most, whatever accelerates it
        match phase {
            // without u the load alone decides
            Phase::FullContact if setup.detail == Detail::Rigid => false,
            Phase::FullContact => u.abs() + way(u_dot) < self.engine.structure().u_cr,
            Phase::Rocking(_) => (way(theta_dot)..FRAC_PI_2 - way(theta_dot)).contains(&theta.abs()),
            Phase::Overturned(_) => true,
        }
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
        let start = engine.motion().time;
        let progress = setup.ground_motion(ground).advance(engine, *elapsed, step, *inputs, watch)?;
        *elapsed = elapsed.and(if progress == Progress::Complete { step } else { engine.motion().time - start });
        Ok(progress)
    }
}
