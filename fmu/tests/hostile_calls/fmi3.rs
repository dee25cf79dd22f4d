//! How hostile calls of FMI 3.0 make instances and lead on.

use crate::calls::{C, fmi3::Fmi3};
use crate::{Hostile, Told, host};
use FlexibleRocking::fmi3::*;
use FlexibleRocking::interface::{Interface, Stepping};
use FlexibleRocking::state_machine::Stage;
use fastrand::Rng;
use host::{ERROR, OK};
use std::ffi::{c_char, c_int, c_void};
use std::path::Path;
use std::ptr::null_mut;

impl Hostile for Fmi3 {
    fn leading_on(stage: Stage) -> &'static [Function] {
        use Function::*;
        match stage {
            Stage::Instantiated => &[SetFloat64, SetFloat64, SetInt64, SetBoolean, SetString, EnterInitializationMode],
            Stage::InitializationMode => &[SetFloat64, GetFloat64, ExitInitializationMode, ExitInitializationMode],
            Stage::StepComplete => {
                &[SetFloat64, DoStep, DoStep, DoStep, GetFloat64, GetOutputDerivatives, EnterEventMode]
            }
            Stage::EventMode => &[
                SetFloat64,
                UpdateDiscreteStates,
                UpdateDiscreteStates,
                EnterContinuousTimeMode,
                EnterStepMode,
                GetFloat64,
            ],
            Stage::ContinuousTimeMode => &[
                SetTime,
                SetTime,
                SetContinuousStates,
                GetContinuousStateDerivatives,
                CompletedIntegratorStep,
                CompletedIntegratorStep,
                SetFloat64,
                EnterEventMode,
            ],
            Stage::IntermediateUpdateMode
            | Stage::IntermediateOutputs
            | Stage::StepFailed
            | Stage::Terminated
            | Stage::Error => &[Reset, SetFMUState, GetFloat64],
        }
    }

    fn location(folder: &Path) -> String {
        format!("{}/", folder.display())
    }

    /// A host of co-simulation may have itself called back in every step for the ground's acceleration.
    fn instantiate(
        rng: &mut Rng,
        interface: Interface,
        [name, token, folder]: [*const c_char; 3],
        told: Option<&Told>,
    ) -> C {
        let logging_on = if rng.u8(..20) == 0 { rng.u8(..) } else { rng.u8(0..2) };
        let environment = told.map_or(null_mut(), |told| (&raw const *told).cast_mut().cast());
        let log = told.map(|_| tell as LogMessageCallback);
        let Interface::CoSimulation(Stepping { event_mode, early_return }) = interface else {
            return unsafe { fmi3InstantiateModelExchange(name, token, folder, 0, logging_on, environment, log) };
        };
        let update = told.filter(|_| rng.bool()).map(|_| update as IntermediateUpdateCallback);
        let [event_mode, early_return] =
            [event_mode, early_return].map(|flag| if rng.u8(..40) == 0 { 2 } else { u8::from(flag) });
        let required = [host::reference("a_g"), rng.u32(..200)];
        let n = if update.is_none() {
            0
        } else if rng.u8(..20) == 0 {
            2
        } else {
            1
        };
        let required = required.as_ptr();
        unsafe {
            fmi3InstantiateCoSimulation(
                name,
                token,
                folder,
                0,
                logging_on,
                event_mode,
                early_return,
                required,
                n,
                environment,
                log,
                update,
            )
        }
    }
}

unsafe extern "C" fn tell(environment: *mut c_void, status: c_int, _: *const c_char, text: *const c_char) {
    unsafe {
        (*environment.cast::<Told>()).tell(status, text, |c| {
            fmi3FreeInstance(c);
            assert_eq!((fmi3Terminate(c), fmi3Reset(c)), (ERROR, ERROR));
        });
    }
}

/// Sets the input, and tries what it must not. What is said to it is not said of the step.
unsafe extern "C" fn update(environment: *mut c_void, _: f64, _: u8, _: u8, _: u8, _: u8, _: *mut u8, _: *mut f64) {
    let told = unsafe { &*environment.cast::<Told>() };
    let ((c, a_g), before) = (told.asked.get(), told.messages.take());
    let (called, reference) = (told.call_back.replace(null_mut()), host::reference("a_g"));
    unsafe {
        fmi3FreeInstance(c);
        assert_eq!((fmi3Terminate(c), fmi3Reset(c), fmi3GetFMUState(c, &mut null_mut())), (ERROR, ERROR, ERROR));
        assert!([OK, ERROR].contains(&fmi3SetFloat64(c, &reference, 1, &a_g, 1)));
    }
    told.messages.replace(before);
    told.call_back.set(called);
}
