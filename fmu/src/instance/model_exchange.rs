//! What an instance does for a host that integrates: it gives derivatives and event indicators at any time and state, checks
//! every complete step, and applies transitions.
//!
//! The engine stands where the host is; [`Known`] is where the motion was last known to be right.

use super::{Instance, log};
use crate::condition::{FARTHEST, Model, Outside};
use crate::failure::Failure;
use crate::setup::Setup;
use crate::state_machine::Stage;
use rocking::engine::AdvanceError;
use rocking::ground_motion::Elapsed;
use rocking::outside_step::{Checked, INDICATORS, Known};
use rocking::state::COMPONENTS;
use rocking::{Load, Motion, State, Transition, Watch};
use std::mem::MaybeUninit;

/// The relative tolerance up to which samples of the record are events. A solver of high order that integrates over the kinks
/// there is not as exact as it believes; below an error of some 1e-5 to start anew at each is the cheaper way
/// (docs/model_exchange.md).
const KINKS_MATTER: f64 = 1e-8;

/// What came of a complete step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Completed {
    /// Whether there is an event to be dealt with.
    pub needs_event_mode: bool,
    /// Whether the structure has overturned, which ends the simulation.
    pub has_ended: bool,
}

/// What came of an event.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Updated {
    /// Whether the structure has overturned, which ends the simulation.
    pub has_ended: bool,
    /// Whether the states are not those that the host set.
    pub has_new_states: bool,
    /// When the next event is that can be foreseen, s.
    pub next_event: Option<f64>,
}

impl Model {
    /// The ground's time at the host's clock.
    fn elapsed_at(setup: &Setup, time: f64) -> Elapsed {
        Elapsed::default().and(time - setup.start_time)
    }

    /// What acts now under the inputs `load`.
    fn acting(&self, setup: &Setup, load: Load) -> Load {
        self.load(setup, load.into()).value
    }

    /// Checks the step from where the motion was last known to where the host is, with the inputs `load` there.
    fn check<W: Watch>(&mut self, setup: &Setup, known: &Known, load: Load, watch: &mut W) -> Result<Checked, Failure> {
        let (from, to) = (known.motion.time, self.engine.motion().time);
        if to < from && !self.has_overturned() {
            return Err(Failure::StepBack { from, to });
        }
        let ground = self.ground.as_ref().map(|ground| setup.ground_motion(ground));
        Ok(known.check(&mut self.engine, ground.as_ref(), self.elapsed, load, watch)?)
    }

    /// The next instant at which contact is released or the record jumps or, if that matters, has a kink, s.
    fn next_event(&self, setup: &Setup) -> Option<f64> {
        let motion = self.engine.motion();
        let held = Some(motion.held()).filter(|held| *held > 0.0);
        let ground = self.ground.as_ref().map(|ground| setup.ground_motion(ground));
        let of_ground = ground.and_then(|ground| {
            if setup.tolerance <= KINKS_MATTER {
                ground.next_sample(self.elapsed)
            } else {
                ground.next_jump(self.elapsed)
            }
        });
        let next = motion.time + held.into_iter().chain(of_ground).reduce(f64::min)?;
        Some(next).filter(|next| *next > motion.time && next.is_finite())
    }
}

impl Instance {
    /// From here on the host integrates.
    pub(super) fn start_outside(&mut self) -> Result<(), Failure> {
        let (model, _, inputs, _) = self.now.parts(&self.archive)?;
        let (motion, elapsed, load) = (*model.engine.motion(), model.elapsed, inputs.values());
        model.outside = Some(Outside { known: Known { motion, elapsed, load }, arrived: load });
        Ok(())
    }

    /// The host is at `time` (s).
    pub fn set_time(&mut self, time: f64) -> Result<(), Failure> {
        let (model, setup, ..) = self.now.parts(&self.archive)?;
        let elapsed = Model::elapsed_at(setup, time);
        if !(time.is_finite() && (time - setup.start_time).is_finite()) {
            return Err(Failure::BadTime(time));
        }
        model.engine.set_time(time);
        model.elapsed = elapsed;
        Ok(())
    }

    /// The host is at the state u, u̇, θ, θ̇.
    pub fn set_continuous_states(&mut self, states: &[f64]) -> Result<(), Failure> {
        let Ok(components) = <[f64; 4]>::try_from(states) else {
            return Err(Failure::WrongCount { name: "nx", given: states.len(), needed: COMPONENTS.len() });
        };
        let far = COMPONENTS.into_iter().zip(components).find(|(_, value)| value.is_nan() || value.abs() > FARTHEST);
        if let Some((name, value)) = far {
            return Err(Failure::FarState { name, value });
        }
        self.now.model(&self.archive)?.engine.set_state(State::of(components));
        Ok(())
    }

    /// Where the host is, or where it is to start from.
    pub fn get_continuous_states(&mut self, values: &mut [MaybeUninit<f64>]) -> Result<(), Failure> {
        let states = self.now.model(&self.archive)?.engine.motion().state;
        fill("nx", values, states.components())
    }

    /// The magnitudes of the states.
    pub fn get_nominals(&mut self, values: &mut [MaybeUninit<f64>]) -> Result<(), Failure> {
        let usual = self.now.model(&self.archive)?.engine.structure().usual_state();
        fill("nx", values, usual.components())
    }

    /// Derivatives of the states.
    pub fn get_derivatives(&mut self, values: &mut [MaybeUninit<f64>]) -> Result<(), Failure> {
        let (model, setup, inputs, _) = self.now.parts(&self.archive)?;
        let rates = model.engine.sample(model.acting(setup, inputs.values())).state_rates();
        if !rates.is_finite() {
            let &Motion { time, state: State { u, theta, .. }, .. } = model.engine.motion();
            return Err(Failure::NoStateRates { time, u, theta });
        }
        fill("nx", values, rates.components())
    }

    /// The event indicators.
    pub fn get_event_indicators(&mut self, values: &mut [MaybeUninit<f64>]) -> Result<(), Failure> {
        let (model, setup, inputs, _) = self.now.parts(&self.archive)?;
        let indicators: [f64; INDICATORS] =
            model.engine.sample(model.acting(setup, inputs.values())).event_indicators();
        fill("ni", values, indicators)
    }

    /// The host has made a step to where it is. Where that has passed a transition over, the step is left as it is until
    /// event mode puts it right.
    pub fn completed_integrator_step(&mut self) -> Result<Completed, Failure> {
        let (model, setup, inputs, stage) = self.now.parts(&self.archive)?;
        let load = inputs.values();
        let Some(mut outside) = model.outside else {
            return Ok(Completed { needs_event_mode: false, has_ended: false });
        };
        let checked = model.check(setup, &outside.known, load, &mut ());
        let checked = checked.inspect_err(|failure| stop_if_singular(stage, failure))?;
        let Checked { motion, is_corrected, .. } = checked;
        if !is_corrected {
            outside.known = Known { motion, elapsed: model.elapsed, load };
            model.outside = Some(outside);
            model.engine.set_motion(motion);
        }
        Ok(Completed { needs_event_mode: is_corrected, has_ended: model.has_overturned() })
    }

    /// There is an event where the host is.
    pub fn enter_event_mode(&mut self) -> Result<(), Failure> {
        let (model, _, inputs, stage) = self.now.parts(&self.archive)?;
        if let Some(outside) = &mut model.outside
            && *stage == Stage::ContinuousTimeMode
        {
            outside.arrived = inputs.values();
        }
        *stage = Stage::EventMode;
        Ok(())
    }

    /// Applies the transitions up to where the host is, and the uplift that is due there.
    pub fn new_discrete_states(&mut self) -> Result<Updated, Failure> {
        let logger = &self.logger;
        let (model, setup, inputs, stage) = self.now.parts(&self.archive)?;
        let Some(outside) = model.outside else {
            return Ok(Updated { has_ended: false, has_new_states: false, next_event: None });
        };
        let from = outside.known.motion.time;
        let mut passed: Vec<Transition> = Vec::new();
        let mut watch = |transition: &Transition| passed.push(*transition);
        let checked = model.check(setup, &outside.known, outside.arrived, &mut watch);
        let checked = checked.inspect_err(|failure| stop_if_singular(stage, failure))?;
        let Checked { motion, was_hidden, .. } = checked;
        let (host, load) = (*model.engine.motion(), inputs.values());
        passed.iter().for_each(|transition| log(logger, transition));
        if was_hidden {
            logger.event(|| {
                format!(
                    "t = {} s: the integrator's step from t = {from} s shows nothing of {}: the states are put right",
                    host.time,
                    passed.iter().map(|transition| transition.kind.name()).collect::<Vec<_>>().join(", ")
                )
            });
        }
        model.engine.set_motion(motion);
        let acting = model.acting(setup, load);
        model.engine.lift_off_if_due(acting, &mut |transition: &Transition| log(logger, transition));
        let motion = *model.engine.motion();
        let known = Known { motion, elapsed: model.elapsed, load };
        model.outside = Some(Outside { known, arrived: load });
        model.engine.set_time(host.time);
        Ok(Updated {
            has_ended: model.has_overturned(),
            has_new_states: motion.state != host.state,
            next_event: model.next_event(setup),
        })
    }

    /// On to the next event.
    pub fn enter_continuous_time_mode(&mut self) -> Result<(), Failure> {
        self.now.stage = Stage::ContinuousTimeMode;
        Ok(())
    }
}

/// Where the motion ends, so does the simulation.
fn stop_if_singular(stage: &mut Stage, failure: &Failure) {
    if let Failure::Advance(AdvanceError::Singular { .. }) = failure {
        *stage = Stage::Error;
    }
}

/// Writes `from` into `values`, which `count` says are as many.
fn fill<const N: usize>(count: &'static str, values: &mut [MaybeUninit<f64>], from: [f64; N]) -> Result<(), Failure> {
    if values.len() != N {
        return Err(Failure::WrongCount { name: count, given: values.len(), needed: N });
    }
    values.iter_mut().zip(from).for_each(|(place, value)| _ = place.write(value));
    Ok(())
}
