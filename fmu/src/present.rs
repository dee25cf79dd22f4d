//! What an instance holds between two calls.

use crate::failure::Failure;
use crate::ground::Kept;
use crate::inputs::Inputs;
use crate::interface::Interface;
use crate::model::Model;
use crate::resources::Archive;
use crate::setup::Setup;
use crate::state_machine::Stage;
use crate::variables::{VARIABLES, Variable};

/// What an instance holds between two calls.
pub(crate) struct Present {
    /// All of them: no call waits for the table.
    pub variables: &'static [Variable],
    pub archive: Archive,
    pub interface: Interface,
    pub stage: Stage,
    pub setup: Setup,
    pub inputs: Inputs,
    /// Until initialization ends it is built when an output is asked for, and dropped when what it was built from is
    /// set anew.
    pub model: Option<Model>,
    /// The record that was followed last, which is not parsed anew for another run.
    pub kept: Option<Kept>,
}

impl Present {
    /// As instantiated from `archive`.
    pub fn new(archive: Archive, interface: Interface) -> Present {
        Present {
            variables: VARIABLES.as_slice(),
            interface,
            stage: Stage::Instantiated,
            setup: Setup::new(&archive.contents),
            inputs: Inputs::default(),
            model: None,
            kept: None,
            archive,
        }
    }

    /// As instantiated again.
    pub fn reset(&mut self) {
        (self.stage, self.setup) = (Stage::Instantiated, Setup::new(&self.archive.contents));
        (self.inputs, self.model) = (Inputs::default(), None);
    }

    /// Sets up anew what has not started.
    pub fn set_up(&mut self, setup: Setup) {
        if setup != self.setup {
            (self.setup, self.model) = (setup, None);
        }
    }

    /// The structure in motion, or at its start with what has been set so far; its record is in the archive, or on
    /// disk.
    pub fn model(&mut self) -> Result<&mut Model, Failure> {
        self.parts().map(|(model, ..)| model)
    }

    /// The structure with the setup, the inputs and the stage.
    #[inline]
    pub fn parts(&mut self) -> Result<(&mut Model, &Setup, &mut Inputs, &mut Stage), Failure> {
        if self.model.is_none() {
            self.build()?;
        }
        let Present { stage, setup, inputs, model, .. } = self;
        Ok((model.as_mut().expect("it is built"), setup, inputs, stage))
    }

    #[cold]
    fn build(&mut self) -> Result<(), Failure> {
        let ground = self.archive.ground(&self.setup.record, &self.setup.record_v, &mut self.kept)?;
        self.model = Some(Model::new(&self.setup, ground)?);
        Ok(())
    }
}

/// The variable that `reference` stands for in `variables`, the whole table.
#[inline]
pub(crate) fn find(variables: &'static [Variable], reference: u32) -> Result<&'static Variable, Failure> {
    let Some(variable) = variables.get(reference as usize) else { return Err(Failure::UnknownReference(reference)) };
    Ok(variable)
}
