//! How the structure on its ground is taken over one step of a co-simulation.

use crate::scene::{Scene, Tell, Watching};
use crate::setup::Setup;
use rocking::engine::{AdvanceError, Progress};
use rocking::run::Runs;
use rocking::{LinearLoad, Watch};

/// Part of the time, or of 1/p_l if that is more, that rounding can shift a transition by.
const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Steps of the engine that are rehearsed at most: some milliseconds.
const REHEARSED_STEPS: u64 = 100;

type Stop = Result<Progress, AdvanceError>;

impl<Q: Runs> Scene<Q> {
    /// Takes a step under `inputs` and goes back, so that the first step of the host finds code and memory at hand. A structure that needs
    /// many steps of the engine is taken a part of the way.
    pub fn rehearse(&mut self, inputs: LinearLoad<Q>) {
        let start = *self.engine.motion();
        let step = self.engine.structure().vibration().rocking[1].recip().min(1e-3);
        let last_step = start.work.steps + REHEARSED_STEPS;
        _ = self.engine.advance_within(last_step, step, inputs, &mut ()); // a failure comes again in the host's own step
        self.engine.set_motion(start);
    }

    /// [`Scene::advance`] up to the first transition. One within rounding of the end of the step counts as at its end: a
    /// host that goes back and steps to the instant that it was told meets it again. One at the very start, where an
    /// input has just jumped, is applied at once: every step takes time.
    #[inline(never)]
    pub fn advance_to_transition(
        &mut self,
        setup: &Setup,
        step: f64,
        inputs: &LinearLoad<Q>,
        told: &mut Tell<Q>,
    ) -> Stop {
        let (from, elapsed) = (self.engine.motion().time, self.elapsed);
        let until = from + step;
        let mut progress = self.advance(setup, step, inputs, told)?;
        while progress == Progress::Transition && self.engine.motion().time <= from {
            progress = self.advance(setup, step, inputs, told)?;
        }
        let rounding = ROUNDING * until.abs().max(self.engine.structure().base().p_l.recip());
        if progress == Progress::Complete {
            let later = inputs.from(step);
            let load = if setup.may_move_vertically(self.ground.as_ref()) { self.load(setup, later) } else { later };
            if self.engine.goes_on_for(rounding, load) {
                return Ok(progress);
            }
            let motion = *self.engine.motion();
            progress = self.follow(setup, rounding, &later, &mut &mut *told).unwrap_or(Progress::Complete);
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
    pub fn advance(&mut self, setup: &Setup, step: f64, inputs: &LinearLoad<Q>, told: &mut Tell<Q>) -> Stop {
        if setup.peaks || setup.validity {
            self.advance_watched(setup, step, inputs, told)
        } else {
            self.follow(setup, step, inputs, &mut &mut *told)
        }
    }

    #[inline(never)]
    fn advance_watched(&mut self, setup: &Setup, step: f64, inputs: &LinearLoad<Q>, told: &mut Tell<Q>) -> Stop {
        let mut validity = self.watch_validity();
        let of_limits = setup.validity.then_some(&mut validity);
        let mut watch = Watching { peaks: setup.peaks.then(|| self.peaks.clone().watch()), validity: of_limits, told };
        let progress = self.follow(setup, step, inputs, &mut watch)?;
        watch.peaks.into_iter().for_each(|peaks| self.peaks = peaks.end());
        self.validity = *validity.found();
        Ok(progress)
    }

    #[inline(always)]
    fn follow<W: Watch<Q>>(&mut self, setup: &Setup, step: f64, inputs: &LinearLoad<Q>, watch: &mut W) -> Stop {
        let Scene { engine, ground, elapsed, .. } = self;
        let Some(ground) = ground else { return engine.advance(step, *inputs, watch) };
        setup.ground_motion(ground).advance(engine, elapsed, step, *inputs, watch)
    }
}
