//! The structure under a host that integrates: every complete step is checked, and transitions are applied.
//!
//! The engine stands at the time and state of the host; [`Checkpoint`] keeps the last motion that was right.

use crate::failure::Refusal;
use crate::motion_log::log;
use crate::scene::{HostMotion, Scene, Tell};
use crate::setup::Setup;
use fmi_unit::{Completed, Failure, Logger, Update};
use rocking::run::Runs;
use rocking::run::ground_motion::Elapsed;
use rocking::run::host_step::{Checked, Checkpoint};
use rocking::{GroundMotion, Load, State, Transition};

/// The relative tolerance up to which samples of the record are events.
///
/// A solver of high order that integrates over the kinks at the samples is less exact than its own estimate. For errors below some
/// 1e-5, a new start at each sample is cheaper (docs/evidence/model_exchange.md).
const KINKS_MATTER: f64 = 1e-8;

/// The largest state (SI units) that is taken from a host.
const FARTHEST: f64 = 1e12;

impl<Q: Runs> Scene<Q> {
    /// The record's time at the host's `time` (s). After a late start the last digits of `time` are coarse. An instant that the
    /// unit has announced for a sample therefore counts as the sample.
    fn elapsed_at(&self, setup: &Setup, time: f64) -> Elapsed {
        let elapsed = Elapsed::default().and(time - setup.start_time);
        let resolution = 2.0 * f64::EPSILON * time.abs().max(setup.start_time.abs());
        self.ground.as_ref().map_or(elapsed, |ground| setup.ground_motion(ground).by_clock(elapsed, resolution))
    }

    /// Checks the step from where the motion was last known to where the host is, with the inputs `load` there.
    fn check(
        &mut self,
        setup: &Setup,
        known: &Checkpoint<Q>,
        load: Load<Q>,
        told: &mut Tell<Q>,
    ) -> Result<Checked<Q>, Failure> {
        let (from, to) = (known.motion.time, self.engine.motion().time);
        if to < from && !self.has_overturned() {
            return Err(Failure::StepBack { from, to });
        }
        let ground = self.ground.as_ref().map(|ground| setup.ground_motion(ground));
        Ok(known
            .check(&mut self.engine, ground.as_ref(), self.elapsed, load, &mut &mut *told)
            .map_err(Refusal::from)?)
    }

    /// The next instant at which contact is released or the record jumps or, if that matters, has a kink, s.
    fn next_event(&self, setup: &Setup) -> Option<f64> {
        let motion = self.engine.motion();
        let released = Some(motion.held()).filter(|held| *held > 0.0).map(|held| motion.time + held);
        let next = if setup.tolerance <= KINKS_MATTER { GroundMotion::next_sample } else { GroundMotion::next_jump };
        let of_ground = self.ground.as_ref().and_then(|ground| next(&setup.ground_motion(ground), self.elapsed));
        let of_ground = of_ground.map(|instant| setup.start_time + instant);
        let next = released.into_iter().chain(of_ground).reduce(f64::min)?;
        Some(next).filter(|next| *next > motion.time && next.is_finite())
    }

    pub fn leave_to_host(&mut self, load: Load<Q>) {
        let (motion, elapsed) = (*self.engine.motion(), self.elapsed);
        self.outside = Some(HostMotion { known: Checkpoint { motion, elapsed, load }, arrived: load, event: elapsed });
    }

    /// Goes to the host's `time` (s).
    pub fn go_to(&mut self, setup: &Setup, time: f64, is_at_event: bool) {
        self.elapsed = self.elapsed_at(setup, time);
        self.engine.set_time(time);
        if let (Some(outside), true) = (&mut self.outside, is_at_event) {
            outside.event = self.elapsed;
        }
    }

    /// Goes to the host's `states`, which the table calls `names`.
    pub fn take_states(&mut self, states: &[f64], names: impl Fn(usize) -> String) -> Result<(), Failure> {
        if let Some(far) = states.iter().position(|value| value.abs() > FARTHEST) {
            return Err(Refusal::FarState { name: names(far), value: states[far] }.into());
        }
        let (lateral, settled) = states.split_at(2 * self.lateral);
        let [theta, theta_dot, ref settled @ ..] = *settled else {
            unreachable!("the host gives a number for each state")
        };
        let mut motion = *self.engine.motion();
        if let Some(HostMotion { known, .. }) = &self.outside {
            motion.phase = known.motion.phase; // whether the base slides follows from the state
        }
        if self.engine.structure().foundation().is_some() {
            motion.settled.as_mut()[..settled.len()].copy_from_slice(settled);
        }
        self.engine.set_motion(motion);
        let State { mut u, mut u_dot, .. } = motion.state;
        for (j, at) in (0..self.lateral).filter_map(|j| Some((j, self.place(j)?))) {
            u.set(at, lateral[j]);
            u_dot.set(at, lateral[self.lateral + j]);
        }
        self.engine.set_state(State { u, u_dot, theta, theta_dot });
        Ok(())
    }

    /// Checks the step that the host has made to where it is, with the inputs `load`. If it has passed over a transition,
    /// event mode puts it right.
    pub fn complete_step(&mut self, setup: &Setup, load: Load<Q>) -> Result<Completed, Failure> {
        let Some(mut outside) = self.outside else { return Ok(Completed::default()) };
        let Checked { motion, is_corrected, .. } = self.check(setup, &outside.known, load, &mut |_| ())?;
        if !is_corrected {
            outside.known = Checkpoint { motion, elapsed: self.elapsed, load };
            self.outside = Some(outside);
            self.engine.set_motion(motion);
        }
        Ok(Completed { needs_event_mode: is_corrected, has_ended: self.has_overturned() })
    }

    /// Remembers what acts, the inputs `load`, where the host goes to event mode.
    pub fn arrive(&mut self, load: Load<Q>) {
        if let Some(outside) = &mut self.outside {
            (outside.arrived, outside.event) = (load, self.elapsed);
        }
    }

    /// Applies the transitions up to where the host is, and all that are due there under the inputs `load`.
    pub fn catch_up(&mut self, setup: &Setup, load: Load<Q>, logger: &Logger) -> Result<Update, Failure> {
        let Some(outside) = self.outside else { return Ok(Update::default()) };
        let from = outside.known.motion.time;
        let mut passed: Vec<Transition<Q>> = Vec::new();
        let Checked { motion, was_hidden, .. } =
            self.check(setup, &outside.known, outside.arrived, &mut |transition| passed.push(*transition))?;
        let (host, shows_u) = (*self.engine.motion(), self.shows_u());
        passed.iter().for_each(|transition| log(logger, shows_u, transition));
        if was_hidden {
            logger.event(|| {
                format!(
                    "t = {} s: the integrator's step from t = {from} s shows nothing of {}: the FMU corrects the states",
                    host.time,
                    passed.iter().map(|transition| transition.kind.name()).collect::<Vec<_>>().join(", ")
                )
            });
        }
        self.engine.set_motion(motion);
        let acting = self.acting(setup, load);
        let told: &mut Tell<Q> = &mut |transition| log(logger, shows_u, transition);
        self.engine.transit_at_once(acting, &mut &mut *told);
        let motion = *self.engine.motion();
        let known = Checkpoint { motion, elapsed: self.elapsed, load };
        self.outside = Some(HostMotion { known, arrived: load, event: outside.event });
        self.engine.set_time(host.time);
        Ok(Update {
            has_ended: self.has_overturned(),
            has_new_states: motion.state != host.state,
            next_event: self.next_event(setup),
        })
    }
}
