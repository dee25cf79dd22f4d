//! How hostile calls of FMI 2.0 make instances and lead on.

use crate::calls::{C, fmi2::Fmi2};
use crate::{Hostile, Told, host};
use FlexibleRocking::fmi2::*;
use FlexibleRocking::interface::Interface;
use FlexibleRocking::state_machine::Stage;
use fastrand::Rng;
use host::ERROR;
use std::ffi::{c_char, c_int, c_void};
use std::path::Path;
use std::ptr::null;

impl Hostile for Fmi2 {
    fn leading_on(stage: Stage) -> &'static [Function] {
        use Function::*;
        match stage {
            Stage::Instantiated => {
                &[SetReal, SetReal, SetInteger, SetBoolean, SetString, SetupExperiment, EnterInitializationMode]
            }
            Stage::InitializationMode => &[SetReal, GetReal, ExitInitializationMode, ExitInitializationMode],
            Stage::StepComplete => {
                &[SetReal, SetRealInputDerivatives, DoStep, DoStep, GetReal, GetRealOutputDerivatives]
            }
            Stage::EventMode => &[SetReal, NewDiscreteStates, NewDiscreteStates, EnterContinuousTimeMode, GetReal],
            Stage::ContinuousTimeMode => &[
                SetTime,
                SetTime,
                SetContinuousStates,
                GetDerivatives,
                CompletedIntegratorStep,
                CompletedIntegratorStep,
                SetReal,
                EnterEventMode,
            ],
            Stage::IntermediateUpdateMode
            | Stage::IntermediateOutputs
            | Stage::StepFailed
            | Stage::Terminated
            | Stage::Error => &[Reset, SetFMUstate, GetReal],
        }
    }

    fn location(folder: &Path) -> String {
        format!("file://{}", folder.display())
    }

    fn instantiate(
        rng: &mut Rng,
        interface: Interface,
        [name, guid, location]: [*const c_char; 3],
        told: Option<&Told>,
    ) -> C {
        let mut functions =
            host::callbacks(told.map_or(std::ptr::null_mut(), |told| (&raw const *told).cast_mut().cast()));
        let logger: unsafe extern "C" fn(_, _, _, _, _) = tell;
        functions.logger = told.map(|_| unsafe { std::mem::transmute(logger as *const ()) });
        let functions = if rng.u8(..20) == 0 { null() } else { &raw const functions };
        let kind = match interface {
            Interface::ModelExchange => host::MODEL_EXCHANGE,
            Interface::CoSimulation(_) => host::CO_SIMULATION,
        };
        let kind = if rng.u8(..40) == 0 { rng.i32(2..) } else { kind };
        let logging_on = if rng.u8(..20) == 0 { rng.i32(..) } else { rng.i32(0..2) };
        unsafe { fmi2Instantiate(name, kind, guid, location, functions, 0, logging_on) }
    }
}

unsafe extern "C" fn tell(
    environment: *mut c_void,
    _: *const c_char,
    status: c_int,
    _: *const c_char,
    text: *const c_char,
) {
    unsafe {
        (*environment.cast::<Told>()).tell(status, text, |c| {
            fmi2FreeInstance(c);
            assert_eq!((fmi2DoStep(c, 0.0, 1.0, 0), fmi2Reset(c)), (ERROR, ERROR));
        });
    }
}
