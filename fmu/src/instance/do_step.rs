//! One step of a co-simulation: whether it can be made, what the host is called back for, and where it leads.

use super::Instance;
use crate::failure::Failure;
use crate::interface::IntermediateUpdate;
use crate::logger::Logger;
use crate::model::Model;
use crate::motion_log::{log, warn};
use crate::setup::Setup;
use crate::state_machine::Stage;
use rocking::Transition;
use rocking::engine::{AdvanceError, Progress};

/// How close two times that mean the same are, in parts of the step, or in units in the last place if that is more.
const SAME_TIME: (f64, f64) = (1e-4, 8.0);

impl Instance {
    /// Begins a step over `step` (s) from `point` (s). If the host sets inputs within steps, returns how to call it back,
    /// which comes before [`Instance::do_step`].
    pub(crate) fn begin_step(&mut self, point: f64, step: f64) -> Result<Option<IntermediateUpdate>, Failure> {
        let (model, setup, _, stage) = self.now.parts()?;
        check_step(model, setup, point, step)?;
        let asked = self.host.filter(|host| host.sets_inputs);
        if asked.is_some() {
            self.asked = Some(step);
            *stage = Stage::IntermediateUpdateMode;
        }
        Ok(asked)
    }

    /// Steps from `point` (s), where the instance is but for rounding, over `step` (s), or to the first transition if
    /// that is handed over. The instance takes over the host's clock.
    #[inline(always)]
    pub fn do_step(&mut self, point: f64, step: f64) -> Result<Progress, Failure> {
        if self.asked.take().is_some() {
            self.now.stage = Stage::StepComplete;
        }
        let (logger, stops) = (&self.logger, self.now.interface.stepping().hands_over());
        let (model, setup, inputs, stage) = self.now.parts()?;
        check_step(model, setup, point, step)?;
        let load = inputs.over(step);
        load.at(step).check().map_err(Failure::InputRunsOut)?;

        let time = model.engine.motion().time;
        model.engine.set_time(point);
        model.engine.stop_at_transitions(stops);
        let known = setup.validity.then_some(model.validity);
        let mut watch = |transition: &Transition| log(logger, transition);
        let result = if stops {
            model.advance_to_transition(setup, step, &load, &mut watch)
        } else {
            model.advance(setup, step, &load, &mut watch)
        };
        match result {
            Ok(progress) => {
                let reached = model.engine.motion().time;
                let passed = if reached == point + step { step } else { reached - point };
                if passed > 0.0 {
                    inputs.pass(load, passed, reached < point + step);
                }
                if inputs.makes_stairs() && !self.told_of_stairs {
                    self.told_of_stairs = true;
                    warn_of_stairs(logger, reached);
                }
                known.iter().for_each(|known| warn(logger, known, &model.validity));
                if progress == Progress::Overturned {
                    *stage = Stage::StepFailed;
                }
                Ok(progress)
            }
            Err(error) => {
                model.engine.set_time(time);
                if matches!(error, AdvanceError::Singular { .. }) {
                    *stage = Stage::Error;
                }
                Err(error.into())
            }
        }
    }

    /// If the host reads outputs within steps, returns how to call it back, which comes before [`Instance::end_step`].
    pub(crate) fn show_step(&mut self) -> Option<IntermediateUpdate> {
        let told = self.host.filter(|host| host.gets_outputs);
        if told.is_some() {
            self.led_to = Some(std::mem::replace(&mut self.now.stage, Stage::IntermediateOutputs));
        }
        told
    }

    /// Ends the step, once the host has read.
    pub(crate) fn end_step(&mut self) {
        self.now.stage = self.led_to.take().unwrap_or(self.now.stage);
    }

    /// Whether the host takes a step that ends early.
    pub fn may_return_early(&self) -> bool {
        self.now.interface.stepping().early_return
    }
}

/// Warns that a ground acceleration, of which values alone are set, is held over each step up to `time` (s).
#[cold]
fn warn_of_stairs(logger: &Logger, time: f64) {
    logger.warning(&format!(
        "t = {time} s: the host sets new values of the ground acceleration (a_g, a_v) at every step without their slopes, \
         and each value is held over its step: the peaks of such a stepped motion can be tens of per cent off. Give the \
         ground motion as the parameter record, or set a_g_late = true, or set the slope (the time derivative) with each \
         value"
    ));
}

/// Refuses a step that `model` cannot make from `point` (s) over `step` (s).
#[inline]
fn check_step(model: &Model, setup: &Setup, point: f64, step: f64) -> Result<(), Failure> {
    let time = model.engine.motion().time;
    let until = point + step;
    if !(step > 0.0 && step <= f64::MAX) {
        return Err(Failure::BadStep { step, time });
    }
    if !is_same_time(point, time, step) {
        return Err(Failure::WrongPoint { given: point, time });
    }
    if until <= point {
        return Err(Failure::BadStep { step, time });
    }
    match setup.stop_time {
        Some(stop) if until > stop && !is_same_time(until, stop, step) => Err(Failure::PastStop { until, stop }),
        _ => Ok(()),
    }
}

/// Hosts add up steps or multiply them: their times (s) differ in the last digits, but never so far that a step could
/// be missed.
#[inline]
fn is_same_time(a: f64, b: f64, step: f64) -> bool {
    let (part, places) = SAME_TIME;
    let apart = (a - b).abs();
    apart <= part * step || apart <= 0.5 * step && apart <= places * (b.abs().next_up() - b.abs())
}
