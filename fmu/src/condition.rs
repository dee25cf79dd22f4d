//! Everything that the future of an instance depends on: how it is taken and gone back to.

use crate::failure::Failure;
use crate::ground::Digest;
use crate::inputs::Inputs;
use crate::interface::Interface;
use crate::model::{Model, Outside};
use crate::present::Present;
use crate::setup::Setup;
use crate::state_machine::Stage;
use rocking::Motion;
use rocking::run::fall::FallingPeaks;
use rocking::run::ground_motion::Elapsed;
use rocking::run::validity::Found;
use serde::{Deserialize, Serialize};

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
    pub peaks: FallingPeaks,
    /// Which limits of the model have been passed so far, if they are watched.
    pub validity: Found,
    /// Names the record that the ground follows.
    pub record: Option<Digest>,
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
            let mut found = match self.model.take_if(is_the_same) {
                Some(model) => model,
                None => Model::new(setup, self.archive.ground(&setup.record, &setup.record_v, &mut self.kept)?)?,
            };
            if found.digest() != course.record {
                return Err(Failure::OtherRecord {
                    record: setup.record.to_string(),
                    record_v: setup.record_v.to_string(),
                });
            }
            found.engine.set_motion(course.motion);
            (found.elapsed, found.outside) = (course.elapsed, course.outside);
            (found.peaks, found.validity) = (course.peaks, course.validity);
            model = Some(found);
        }
        (self.stage, self.setup, self.inputs, self.model) = (*stage, setup.clone(), *inputs, model);
        Ok(())
    }
}
