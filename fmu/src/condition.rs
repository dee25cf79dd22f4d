//! Everything that the future of an instance depends on: how it is taken, gone back to, and told from what cannot have
//! come about by calls.

use crate::failure::Failure;
use crate::ground::Digest;
use crate::inputs::Inputs;
use crate::interface::Interface;
use crate::model::{Model, Outside};
use crate::present::Present;
use crate::setup::Setup;
use crate::state_machine::Stage;
use crate::variables::{DataType, VARIABLES, Variable};
use rocking::mechanics::restraint::Dissipators;
use rocking::run::ground_motion::Elapsed;
use rocking::run::peaks::{PEAKS, Peaks};
use rocking::run::validity::{Found, Worst};
use rocking::{Impulse, Motion, State};
use serde::{Deserialize, Serialize};
use std::f64::consts::FRAC_PI_2;

/// Largest |θ| of a structure in motion, rad: that of overturning and its rounding.
const MAX_ANGLE: f64 = FRAC_PI_2 + 1e-9;

/// More than any other number of the motion (SI units) but its time can be, and small enough to be squared.
const BOUND: f64 = 1e100;

/// More than anything that is counted can come to.
const MAX_COUNT: u64 = 1 << 60;

/// The largest state (SI units) that is taken from a host.
pub(crate) const FARTHEST: f64 = 1e12;

/// A few dozen numbers from which an instance goes on to the same bits: what an FMU state holds.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Condition {
    /// Who integrates.
    pub interface: Interface,
    /// State of FMI's state machine.
    pub stage: Stage,
    /// What was set before the start.
    pub setup: Setup,
    /// What acts from the present time on.
    pub inputs: Inputs,
    /// How far the simulation has come, once it has started: until then all follows from the setup.
    pub course: Option<Course>,
}

/// How far a simulation has come.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub struct Course {
    /// The motion; the host's, if the host integrates.
    pub motion: Motion,
    /// What is known beside the motion, if the host integrates.
    pub outside: Option<Outside>,
    /// Time since the start, on ground that follows a record.
    pub elapsed: Elapsed,
    /// Peaks so far, if they are watched.
    pub peaks: Peaks,
    /// Which limits of the model have been passed so far, if they are watched.
    pub validity: Found,
    /// Names the record that the ground follows.
    pub record: Option<Digest>,
}

impl Condition {
    /// Whether calls can lead here. What is read from bytes need not have come about by calls.
    pub fn is_possible(&self) -> bool {
        let fits = |variable: &Variable| match (variable.data_type, variable.source.setting(&self.setup)) {
            (DataType::Real { range: Some((min, max)), .. }, Some(value)) => (min..=max).contains(&value),
            _ => true,
        };
        VARIABLES.iter().all(fits)
            && self.inputs.are_possible()
            && self.setup.check_experiment().is_ok()
            && self.interface.keeps_states_in(self.stage)
            && self.course.is_some() == self.stage.has_started()
            && self.course.as_ref().is_none_or(|course| {
                course.outside.is_some() == (self.interface == Interface::ModelExchange)
                    && course.is_possible(&self.setup)
            })
    }
}

impl Course {
    fn is_possible(&self, setup: &Setup) -> bool {
        let Course { motion, outside, elapsed, peaks, validity, record } = self;
        let farthest = if outside.is_some() { FARTHEST } else { MAX_ANGLE };
        is_possible(motion, farthest)
            && elapsed.seconds().is_finite()
            && outside.as_ref().is_none_or(|Outside { known, arrived, event }| {
                is_possible(&known.motion, MAX_ANGLE)
                    && [known.elapsed, *event].iter().all(|elapsed| elapsed.seconds().is_finite())
                    && [known.load, *arrived].iter().all(|load| load.check().is_ok())
            })
            && PEAKS
                .iter()
                .map(|peaking| (peaking.of)(peaks))
                .all(|peak| peak.magnitude <= BOUND && peak.time.is_finite())
            && validity.worst.iter().chain([&validity.weight]).all(|&Worst { value, time, first_beyond, beyond }| {
                // friction may be infinite
                value >= -BOUND && [time, first_beyond.unwrap_or(0.0), beyond].iter().all(|x| x.is_finite())
            })
            && [validity.held, validity.duration].iter().all(|x| x.is_finite())
            && [validity.gains, validity.impacts, validity.settlings, validity.evaluations]
                .iter()
                .all(|count| *count < MAX_COUNT)
            && peaks.evaluations() < MAX_COUNT
            && record.is_none() == (setup.record.is_empty() && setup.record_v.is_empty())
            && setup.engine().is_ok_and(|engine| peaks.are_of(engine.structure()))
    }
}

/// Whether calls can lead to `motion`, with |θ| no more than `farthest` (rad).
fn is_possible(motion: &Motion, farthest: f64) -> bool {
    let &Motion { time, state: State { u, u_dot, theta, theta_dot }, impulse, dissipators, transitions, work, .. } =
        motion;
    let Dissipators { plastic, yields, viscous, hysteretic } = dissipators;
    let Impulse { I_h, I_v, I_m } = impulse;
    [u, u_dot, theta_dot, I_h, I_v, I_m, plastic[0], plastic[1], viscous, hysteretic].iter().all(|x| x.abs() <= BOUND)
        && yields.iter().all(|way| (-1..=1).contains(way))
        && theta.abs() <= farthest
        && [transitions, work.steps, work.evaluations].iter().all(|count| *count < MAX_COUNT)
        && time.is_finite()
        && motion.is_possible()
}

impl Present {
    /// The present condition.
    pub fn condition(&self) -> Condition {
        let Present { interface, stage, setup, inputs, model, .. } = self;
        let course = model.as_ref().filter(|_| stage.has_started()).map(|model| Course {
            motion: *model.engine.motion(),
            outside: model.outside,
            elapsed: model.elapsed,
            peaks: model.peaks,
            validity: model.validity,
            record: model.digest(),
        });
        Condition { interface: *interface, stage: *stage, setup: setup.clone(), inputs: *inputs, course }
    }

    /// Goes to `condition`. The model is built anew only for another setup.
    pub fn go_to(&mut self, condition: &Condition) -> Result<(), Failure> {
        let Condition { interface, stage, setup, inputs, course } = condition;
        if *interface != self.interface {
            return Err(Failure::OtherInterface);
        }
        let mut model = None;
        if let Some(course) = course {
            let is_the_same = |model: &mut Model| self.setup == *setup && model.digest() == course.record;
            let kept = self.model.take_if(is_the_same);
            let mut found = kept.map_or_else(|| Model::new(setup, setup.ground(&self.archive)?), Ok)?;
            if found.digest() != course.record {
                return Err(Failure::OtherRecord {
                    record: setup.record.to_string(),
                    record_v: setup.record_v.to_string(),
                });
            }
            found.engine.set_motion(course.motion);
            (found.elapsed, found.outside) = (course.elapsed, course.outside);
            (found.peaks, found.validity) = (course.peaks, course.validity);
            self.record = found.ground.clone().or_else(|| self.record.take());
            model = Some(found);
        }
        (self.stage, self.setup, self.inputs, self.model) = (*stage, setup.clone(), *inputs, model);
        Ok(())
    }
}
