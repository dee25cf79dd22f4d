//! The functions of FMI 3.0 by their arguments.

use crate::host::fmi3::call_what_is_not_provided;
use crate::{C, Call, Looking, Told, Version, host};
use FlexibleRocking::fmi3::*;
use FlexibleRocking::interface::{Interface, Stepping};
use FlexibleRocking::state_machine::Stage;
use fastrand::Rng;
use host::{ERROR, OK};
use libc::{c_char, c_int, c_void};
use std::path::Path;
use std::ptr::null_mut;

pub struct Fmi3;

impl Version for Fmi3 {
    type Function = Function;

    const LOOKING: Looking = Looking {
        free: fmi3FreeInstance,
        get_state: fmi3GetFMUState,
        free_state: fmi3FreeFMUState,
        size: fmi3SerializedFMUStateSize,
        serialize: fmi3SerializeFMUState,
        event_indicators: fmi3GetEventIndicators,
    };

    fn call(function: Function) -> Call {
        macro_rules! not_provided {
            ($($function:ident)*) => {
                match function {
                    $(Function::$function => {
                        return Call::Plain(|c| unsafe { call_what_is_not_provided(c, Function::$function) });
                    })*
                    _ => (),
                }
            };
        }
        not_provided! {
            GetFloat32 GetInt8 GetUInt8 GetInt16 GetUInt16 GetUInt32 GetUInt64 GetBinary GetClock
            SetFloat32 SetInt8 SetUInt8 SetInt16 SetUInt16 SetUInt32 SetUInt64 SetBinary SetClock
            GetNumberOfVariableDependencies GetVariableDependencies EnterConfigurationMode ExitConfigurationMode
            GetIntervalDecimal GetIntervalFraction GetShiftDecimal GetShiftFraction
            SetIntervalDecimal SetIntervalFraction SetShiftDecimal SetShiftFraction ActivateModelPartition
        }
        match function {
            Function::SetDebugLogging => {
                Call::SetDebugLogging(|c, on, n, names| unsafe { fmi3SetDebugLogging(c, on as u8, n, names) })
            }
            Function::EnterInitializationMode => {
                Call::SetUp(|c, has_tolerance, tolerance, start, has_stop, stop| unsafe {
                    fmi3EnterInitializationMode(c, has_tolerance as u8, tolerance, start, has_stop as u8, stop)
                })
            }
            Function::ExitInitializationMode => Call::Plain(|c| unsafe { fmi3ExitInitializationMode(c) }),
            Function::EnterEventMode => Call::Plain(|c| unsafe { fmi3EnterEventMode(c) }),
            Function::Terminate => Call::Plain(|c| unsafe { fmi3Terminate(c) }),
            Function::Reset => Call::Plain(|c| unsafe { fmi3Reset(c) }),
            Function::GetFloat64 => {
                Call::GetReals(|c, vr, nvr, values, n| unsafe { fmi3GetFloat64(c, vr, nvr, values, n) })
            }
            Function::GetInt32 => {
                Call::GetDiscrete(4, |c, vr, nvr, values, n| unsafe { fmi3GetInt32(c, vr, nvr, values.cast(), n) })
            }
            Function::GetInt64 => {
                Call::GetDiscrete(8, |c, vr, nvr, values, n| unsafe { fmi3GetInt64(c, vr, nvr, values.cast(), n) })
            }
            Function::GetBoolean => {
                Call::GetDiscrete(1, |c, vr, nvr, values, n| unsafe { fmi3GetBoolean(c, vr, nvr, values.cast(), n) })
            }
            Function::GetString => {
                Call::GetStrings(|c, vr, nvr, values, n| unsafe { fmi3GetString(c, vr, nvr, values, n) })
            }
            Function::SetFloat64 => {
                Call::SetReals(|c, vr, nvr, values, n| unsafe { fmi3SetFloat64(c, vr, nvr, values, n) })
            }
            Function::SetInt32 => Call::SetDiscrete(&["transitions"], 4, |c, vr, nvr, values, n| unsafe {
                fmi3SetInt32(c, vr, nvr, values.cast(), n)
            }),
            Function::SetInt64 => Call::SetDiscrete(&["detail"], 8, |c, vr, nvr, values, n| unsafe {
                fmi3SetInt64(c, vr, nvr, values.cast(), n)
            }),
            Function::SetBoolean => Call::SetDiscrete(
                &["a_g_late", "F_t_extrapolated", "peaks", "validity"],
                1,
                |c, vr, nvr, values, n| unsafe { fmi3SetBoolean(c, vr, nvr, values.cast(), n) },
            ),
            Function::SetString => {
                Call::SetStrings(|c, vr, nvr, values, n| unsafe { fmi3SetString(c, vr, nvr, values, n) })
            }
            Function::GetFMUState => Call::GetState(fmi3GetFMUState),
            Function::SetFMUState => Call::SetState(fmi3SetFMUState),
            Function::FreeFMUState => Call::FreeState(fmi3FreeFMUState),
            Function::SerializedFMUStateSize => Call::StateSize(fmi3SerializedFMUStateSize),
            Function::SerializeFMUState => Call::Serialize(fmi3SerializeFMUState),
            Function::DeserializeFMUState => Call::Deserialize(fmi3DeserializeFMUState),
            Function::GetDirectionalDerivative => Call::Directional(|c, [of, by], [n, m], seed, values| unsafe {
                fmi3GetDirectionalDerivative(c, of, n, by, m, seed, m, values, n)
            }),
            Function::GetAdjointDerivative => Call::Adjoint(|c, [of, by], [n, m], seed, values| unsafe {
                fmi3GetAdjointDerivative(c, of, n, by, m, seed, n, values, m)
            }),
            Function::EvaluateDiscreteStates => Call::Plain(|c| unsafe { fmi3EvaluateDiscreteStates(c) }),
            Function::UpdateDiscreteStates => Call::Update(|c, spoilt| {
                let (mut flags, mut next) = ([0; 5], 0.0);
                let mut places = flags.each_mut().map(|flag| &raw mut *flag);
                let next = if spoilt == Some(5) { null_mut() } else { &raw mut next };
                if let Some(spoilt) = spoilt.filter(|spoilt| *spoilt < 5) {
                    places[spoilt] = null_mut();
                }
                let [needed, end, nominals, values, is_foreseen] = places;
                unsafe { fmi3UpdateDiscreteStates(c, needed, end, nominals, values, is_foreseen, next) }
            }),
            Function::EnterStepMode => Call::Plain(|c| unsafe { fmi3EnterStepMode(c) }),
            Function::GetOutputDerivatives => Call::GetRates(|c, vr, nvr, orders, values, n| unsafe {
                fmi3GetOutputDerivatives(c, vr, nvr, orders, values, n)
            }),
            Function::DoStep => Call::DoStep(|c, point, step, flag, [event, end, early], reached| unsafe {
                fmi3DoStep(c, point, step, flag as u8, event, end, early, reached)
            }),
            Function::EnterContinuousTimeMode => Call::Plain(|c| unsafe { fmi3EnterContinuousTimeMode(c) }),
            Function::CompletedIntegratorStep => Call::CompleteStep(1, |c, flag, event, end| unsafe {
                fmi3CompletedIntegratorStep(c, flag as u8, event.cast(), end.cast())
            }),
            Function::SetTime => Call::SetTime(fmi3SetTime),
            Function::SetContinuousStates => Call::SetStates(fmi3SetContinuousStates),
            Function::GetContinuousStateDerivatives => Call::GetNumbers(4, fmi3GetContinuousStateDerivatives),
            Function::GetEventIndicators => Call::GetNumbers(2, fmi3GetEventIndicators),
            Function::GetContinuousStates => Call::GetNumbers(4, fmi3GetContinuousStates),
            Function::GetNominalsOfContinuousStates => Call::GetNumbers(4, fmi3GetNominalsOfContinuousStates),
            Function::GetNumberOfEventIndicators => Call::Count(2, fmi3GetNumberOfEventIndicators),
            Function::GetNumberOfContinuousStates => Call::Count(4, fmi3GetNumberOfContinuousStates),
            other => panic!("{other:?} is neither here nor not provided"),
        }
    }

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
