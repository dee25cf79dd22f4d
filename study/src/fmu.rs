//! The FMU, driven through its C interface as a host drives it.
#![allow(unsafe_code)] // calls of the C interface

use crate::scene::Scene;
use FlexibleRocking::fmi2::{self, CallbackFunctions};
use FlexibleRocking::resources::PARAMETERS_FILE;
use FlexibleRocking::variables::VARIABLES;
use anyhow::{Result, ensure};
use std::ffi::{CString, c_int, c_uint, c_void};
use std::ptr;
use tempfile::TempDir;

/// An instance for the structure of a scene, at the default tolerance.
pub struct Fmu<'a> {
    scene: &'a Scene,
    component: *mut c_void,
    _resources: TempDir,
}

fn reference(name: &str) -> c_uint {
    let position = VARIABLES.iter().position(|variable| variable.name == name);
    position.unwrap_or_else(|| panic!("the FMU has no variable {name}")) as c_uint
}

impl<'a> Fmu<'a> {
    pub fn new(scene: &'a Scene) -> Result<Fmu<'a>> {
        let resources = tempfile::tempdir()?;
        std::fs::write(resources.path().join(PARAMETERS_FILE), toml::to_string(scene.structure.parameters())?)?;
        let location = CString::new(format!("file://{}", resources.path().display()))?;
        let guid = CString::new(FlexibleRocking::guid(&(*scene.structure.parameters()).into()))?;
        let callbacks = CallbackFunctions {
            logger: None,
            allocate_memory: ptr::null(),
            free_memory: ptr::null(),
            step_finished: ptr::null(),
            component_environment: ptr::null_mut(),
        };
        const CO_SIMULATION: c_int = 1;
        let (name, guid, location) = (c"scene".as_ptr(), guid.as_ptr(), location.as_ptr());
        let component = unsafe { fmi2::fmi2Instantiate(name, CO_SIMULATION, guid, location, &callbacks, 0, 0) };
        ensure!(!component.is_null(), "fmi2Instantiate returns no instance");
        Ok(Fmu { scene, component, _resources: resources })
    }

    /// Steps from rest through the scene, sample by sample: the ground acceleration and its slope are set, then θ, u and
    /// a_t read.
    pub fn run(&self) -> Result<()> {
        let (component, dt) = (self.component, self.scene.dt());
        let a_g = reference("a_g");
        let outputs = ["theta", "u", "a_t"].map(reference);
        let (first_order, mut values): (c_int, _) = (1, [0.0; 3]);
        let start = unsafe {
            fmi2::fmi2Reset(component)
                + fmi2::fmi2SetupExperiment(component, 0, 0.0, 0.0, 0, 0.0)
                + fmi2::fmi2EnterInitializationMode(component)
                + fmi2::fmi2ExitInitializationMode(component)
        };
        ensure!(start == 0, "the FMU does not start");
        for k in 0..self.scene.intervals() {
            let ramp = self.scene.ramp(k);
            let step = unsafe {
                fmi2::fmi2SetReal(component, &a_g, 1, &ramp.value)
                    + fmi2::fmi2SetRealInputDerivatives(component, &a_g, 1, &first_order, &ramp.slope)
                    + fmi2::fmi2DoStep(component, k as f64 * dt, dt, 1)
                    + fmi2::fmi2GetReal(component, outputs.as_ptr(), outputs.len(), values.as_mut_ptr())
            };
            ensure!(step == 0, "the FMU gives up at t = {} s", k as f64 * dt);
        }
        Ok(())
    }
}

impl Drop for Fmu<'_> {
    fn drop(&mut self) {
        unsafe { fmi2::fmi2FreeInstance(self.component) };
    }
}
