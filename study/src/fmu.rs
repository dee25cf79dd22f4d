//! The FMU, driven through its C interface as a host drives it.
#![allow(unsafe_code)] // calls of the C interface

use crate::response::{Failure, Response, Sample};
use crate::scene::{Input, Scene};
use FlexibleRocking::fmi2::{self, CallbackFunctions};
use FlexibleRocking::resources::PARAMETERS_FILE;
use FlexibleRocking::variables::VARIABLES;
use anyhow::{Result, ensure};
use std::ffi::{CString, c_int, c_uint, c_void};
use std::ptr;
use tempfile::TempDir;

/// An instance, and the scene that it is to go through.
pub struct Fmu<'a> {
    scene: &'a Scene,
    tolerance: f64,
    component: *mut c_void,
    _resources: TempDir,
}

/// The scene's ground motion, in the FMU's resources.
const RECORD: &str = "ground.csv";

fn reference(name: &str) -> c_uint {
    let position = VARIABLES.iter().position(|variable| variable.name == name);
    position.unwrap_or_else(|| panic!("the FMU has no variable {name}")) as c_uint
}

/// Says which call has failed.
fn check(function: &str, status: c_int) -> Result<(), String> {
    if status == 0 { Ok(()) } else { Err(format!("{function} returns {status}")) }
}

impl<'a> Fmu<'a> {
    /// An instance for the structure of `scene`, to `tolerance`.
    pub fn new(scene: &'a Scene, tolerance: f64) -> Result<Fmu<'a>> {
        let resources = tempfile::tempdir()?;
        std::fs::write(resources.path().join(PARAMETERS_FILE), toml::to_string(scene.structure.parameters())?)?;
        let samples = scene.ground.times().iter().zip(scene.ground.acceleration());
        let lines: String = samples.map(|(time, a_g)| format!("{time:e},{a_g:e}\n")).collect();
        std::fs::write(resources.path().join(RECORD), lines)?;
        let location = CString::new(format!("file://{}", resources.path().display()))?;
        let (name, guid) =
            (CString::new(scene.key)?, CString::new(FlexibleRocking::guid(&(*scene.structure.parameters()).into()))?);
        let callbacks = CallbackFunctions {
            logger: None,
            allocate_memory: ptr::null(),
            free_memory: ptr::null(),
            step_finished: ptr::null(),
            component_environment: ptr::null_mut(),
        };
        const CO_SIMULATION: c_int = 1;
        let (name, guid, location) = (name.as_ptr(), guid.as_ptr(), location.as_ptr());
        let component = unsafe { fmi2::fmi2Instantiate(name, CO_SIMULATION, guid, location, &callbacks, 0, 0) };
        ensure!(!component.is_null(), "fmi2Instantiate returns no instance");
        Ok(Fmu { scene, tolerance, component, _resources: resources })
    }

    /// The response, with the ground acceleration given as `input` in communication steps of 1/`cuts` of the time
    /// between samples. The FMU counts no evaluations.
    pub fn run(&self, input: Input, cuts: usize) -> Response {
        let mut samples = Vec::with_capacity(self.scene.intervals());
        let failure = self.simulate(input, cuts, &mut samples).err();
        Response { samples, evaluations: 0, transitions: 0, failure }
    }

    fn simulate(&self, input: Input, cuts: usize, samples: &mut Vec<Sample>) -> Result<(), Failure> {
        self.initialize(input).map_err(|message| Failure::GaveUp { time: 0.0, message })?;
        let a_g = reference("a_g");
        let outputs = [reference("theta"), reference("u"), reference("a_t")];
        for step in self.scene.steps(input, cuts) {
            let failure = |message| Failure::GaveUp { time: step.start, message };
            if input != Input::Inside {
                self.set_real(a_g, step.a_g.value).map_err(failure)?;
            }
            if input == Input::Linear {
                self.set_slope(a_g, step.a_g.slope).map_err(failure)?;
            }
            self.do_step(step.start, step.end - step.start).map_err(failure)?;
            if step.ends_interval {
                let [theta, u, a_t] = self.get_real(&outputs).map_err(failure)?;
                samples.push(Sample { theta, u, a_t });
            }
        }
        Ok(())
    }

    /// As instantiated, then set up and initialized: ready for the first step.
    fn initialize(&self, input: Input) -> Result<(), String> {
        let component = self.component;
        unsafe {
            check("fmi2Reset", fmi2::fmi2Reset(component))?;
            check("fmi2SetupExperiment", fmi2::fmi2SetupExperiment(component, 1, self.tolerance, 0.0, 0, 0.0))?;
            check("fmi2EnterInitializationMode", fmi2::fmi2EnterInitializationMode(component))?;
        }
        let rocking::State { u, u_dot, theta, theta_dot } = self.scene.initial;
        for (name, value) in [("u_0", u), ("u_dot_0", u_dot), ("theta_0", theta), ("theta_dot_0", theta_dot)] {
            self.set_real(reference(name), value)?;
        }
        if input == Input::Inside {
            let text = CString::new(RECORD).expect("a name without NUL");
            let status = unsafe { fmi2::fmi2SetString(component, &reference("record"), 1, &text.as_ptr()) };
            check("fmi2SetString", status)?;
        }
        check("fmi2ExitInitializationMode", unsafe { fmi2::fmi2ExitInitializationMode(component) })
    }

    fn set_real(&self, reference: c_uint, value: f64) -> Result<(), String> {
        check("fmi2SetReal", unsafe { fmi2::fmi2SetReal(self.component, &reference, 1, &value) })
    }

    fn set_slope(&self, reference: c_uint, slope: f64) -> Result<(), String> {
        let order: c_int = 1;
        let status = unsafe { fmi2::fmi2SetRealInputDerivatives(self.component, &reference, 1, &order, &slope) };
        check("fmi2SetRealInputDerivatives", status)
    }

    fn do_step(&self, time: f64, step: f64) -> Result<(), String> {
        check("fmi2DoStep", unsafe { fmi2::fmi2DoStep(self.component, time, step, 1) })
    }

    fn get_real<const N: usize>(&self, references: &[c_uint; N]) -> Result<[f64; N], String> {
        let mut values = [0.0; N];
        let status = unsafe { fmi2::fmi2GetReal(self.component, references.as_ptr(), N, values.as_mut_ptr()) };
        check("fmi2GetReal", status).map(|()| values)
    }
}

impl Drop for Fmu<'_> {
    fn drop(&mut self) {
        unsafe { fmi2::fmi2FreeInstance(self.component) };
    }
}
