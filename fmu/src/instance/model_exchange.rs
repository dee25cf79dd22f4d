//! What an instance does for a host that integrates: it gives derivatives and event indicators at any time and state,
//! checks every complete step, and applies transitions.
//!
//! The engine stands where the host is; [`Known`] is where the motion was last known to be right.

use super::{Instance, Updated};
use crate::failure::Failure;
use crate::model::{Model, Outside};
use crate::motion_log::log;
use crate::setup::Setup;
use crate::state_machine::Stage;
use rocking::engine::AdvanceError;
use rocking::mechanics::state::COMPONENTS;
use rocking::run::ground_motion::Elapsed;
use rocking::run::outside_step::{Checked, INDICATORS, Known};
use rocking::{Load, Motion, State, Transition, Watch};

/// The relative tolerance up to which samples of the record are events. A solver of high order that integrates over the
/// kinks there is not as exact as it believes; below an error of some 1e-5 to start anew at each is the cheaper way
/// (docs/evidence/model_exchange.md).
const KINKS_MATTER: f64 = 1e-8;

/// The largest state (SI units) that is taken from a host.
const FARTHEST: f64 = 1e12;

/// What came of a complete step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Completed {
    /// Whether there is an event to be dealt with.
    pub needs_event_mode: bool,
    /// Whether the structure has overturned, which ends the simulation.
    pub has_ended: bool,
}

impl Model {
    /// The record's time at the host's `time` (s). Where the start is late the last digits of that are coarse: the instant
    /// that was announced for a sample is that sample's.
    fn elapsed_at(&self, setup: &Setup, time: f64) -> Elapsed {
        let elapsed = Elapsed::default().and(time - setup.start_time);
        let resolution = 2.0 * f64::EPSILON * time.abs().max(setup.start_time.abs());
        self.ground.as_ref().map_or(elapsed, |ground| setup.ground_motion(ground).by_clock(elapsed, resolution))
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
        let released = Some(motion.held()).filter(|held| *held > 0.0).map(|held| motion.time + held);
        let ground = self.ground.as_ref().map(|ground| setup.ground_motion(ground));
        let of_ground = ground.and_then(|ground| {
            if setup.tolerance <= KINKS_MATTER {
                ground.next_sample(self.elapsed)
            } else {
                ground.next_jump(self.elapsed)
            }
        });
        let of_ground = of_ground.map(|instant| setup.start_time + instant);
        let next = released.into_iter().chain(of_ground).reduce(f64::min)?;
        Some(next).filter(|next| *next > motion.time && next.is_finite())
    }
}

impl Instance {
    /// Leaves the motion to the host's integrator.
    pub(super) fn start_outside(&mut self) -> Result<(), Failure> {
        let (model, _, inputs, _) = self.now.parts()?;
        let (motion, elapsed, load) = (*model.engine.motion(), model.elapsed, inputs.values());
        model.outside = Some(Outside { known: Known { motion, elapsed, load }, arrived: load, event: elapsed });
        Ok(())
    }

    /// Goes to the host's `time` (s).
    pub fn set_time(&mut self, time: f64) -> Result<(), Failure> {
        let (model, setup, _, stage) = self.now.parts()?;
        if !(time.is_finite() && (time - setup.start_time).is_finite()) {
            return Err(Failure::BadTime(time));
        }
        let elapsed = model.elapsed_at(setup, time);
        model.engine.set_time(time);
        model.elapsed = elapsed;
        if let (Some(outside), Stage::EventMode) = (&mut model.outside, stage) {
            outside.event = elapsed;
        }
        Ok(())
    }

    /// Goes to the host's state u, u̇, θ, θ̇.
    pub fn set_continuous_states(&mut self, states: [f64; COMPONENTS.len()]) -> Result<(), Failure> {
        (0..).zip(states).try_for_each(|(which, value)| check_state(which, value))?;
        self.now.model()?.engine.set_state(State::of(states));
        Ok(())
    }

    /// Goes to the host's `value` of the state at place `which`.
    pub(super) fn set_continuous_state(&mut self, which: usize, value: f64) -> Result<(), Failure> {
        let mut states = self.continuous_states()?;
        states[which] = value;
        self.set_continuous_states(states)
    }

    /// The state at which the host is, or from which it is to start.
    pub fn continuous_states(&mut self) -> Result<[f64; COMPONENTS.len()], Failure> {
        Ok(self.now.model()?.engine.motion().state.components())
    }

    /// The magnitudes of the states.
    pub fn nominals(&mut self) -> Result<[f64; COMPONENTS.len()], Failure> {
        Ok(State::usual(self.now.model()?.engine.structure()).components())
    }

    /// Derivatives of the states.
    pub fn derivatives(&mut self) -> Result<[f64; COMPONENTS.len()], Failure> {
        let (model, setup, inputs, _) = self.now.parts()?;
        let rates = model.engine.sample(model.acting(setup, inputs.values())).state_rates();
        if !rates.is_finite() {
            let &Motion { time, state: State { u, theta, .. }, .. } = model.engine.motion();
            return Err(Failure::NoStateRates { time, u, theta });
        }
        Ok(rates.components())
    }

    /// The event indicators.
    pub fn event_indicators(&mut self) -> Result<[f64; INDICATORS], Failure> {
        let (model, setup, inputs, _) = self.now.parts()?;
        Ok(model.engine.sample(model.acting(setup, inputs.values())).event_indicators())
    }

    /// Checks the step that the host has made to where it is. If it has passed over a transition, event mode puts it
    /// right.
    pub fn completed_integrator_step(&mut self) -> Result<Completed, Failure> {
        let (model, setup, inputs, stage) = self.now.parts()?;
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

    /// Remembers what acts where the host goes to event mode.
    pub(super) fn arrive_at_event(&mut self) -> Result<(), Failure> {
        let (model, _, inputs, stage) = self.now.parts()?;
        if let Some(outside) = &mut model.outside
            && *stage == Stage::ContinuousTimeMode
        {
            (outside.arrived, outside.event) = (inputs.values(), model.elapsed);
        }
        Ok(())
    }

    /// Applies the transitions up to where the host is, and the uplift that is due there.
    pub(super) fn catch_up(&mut self) -> Result<Updated, Failure> {
        let logger = &self.logger;
        let (model, setup, inputs, stage) = self.now.parts()?;
        let Some(outside) = model.outside else {
            return Ok(Updated::default());
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
        model.outside = Some(Outside { known, arrived: load, event: outside.event });
        model.engine.set_time(host.time);
        Ok(Updated {
            has_ended: model.has_overturned(),
            has_new_states: motion.state != host.state,
            next_event: model.next_event(setup),
        })
    }
}

/// Goes to the stage of errors where the equations are singular.
fn stop_if_singular(stage: &mut Stage, failure: &Failure) {
    if let Failure::Advance(AdvanceError::Singular { .. }) = failure {
        *stage = Stage::Error;
    }
}

/// Refuses a `value` of the state at place `which` that is far from any motion.
pub(super) fn check_state(which: usize, value: f64) -> Result<(), Failure> {
    let is_near = value.abs() <= FARTHEST;
    if is_near { Ok(()) } else { Err(Failure::FarState { name: COMPONENTS[which], value }) }
}
