//! The functions of FMI 2.0 by their arguments.

use crate::{C, Call, Looking, Told, Version, host};
use FlexibleRocking::fmi2::*;
use FlexibleRocking::interface::Interface;
use FlexibleRocking::state_machine::Stage;
use fastrand::Rng;
use host::ERROR;
use libc::{c_char, c_int, c_void};
use std::path::Path;
use std::ptr::null;

pub struct Fmi2;

impl Version for Fmi2 {
    type Function = Function;

    const LOOKING: Looking = Looking {
        free: fmi2FreeInstance,
        get_state: fmi2GetFMUstate,
        free_state: fmi2FreeFMUstate,
        size: fmi2SerializedFMUstateSize,
        serialize: fmi2SerializeFMUstate,
        event_indicators: fmi2GetEventIndicators,
    };

    fn call(function: Function) -> Call {
        match function {
            Function::SetDebugLogging => {
                Call::SetDebugLogging(|c, on, n, names| unsafe { fmi2SetDebugLogging(c, on, n, names) })
            }
            Function::SetupExperiment => Call::SetUp(|c, has_tolerance, tolerance, start, has_stop, stop| unsafe {
                fmi2SetupExperiment(c, has_tolerance, tolerance, start, has_stop, stop)
            }),
            Function::EnterInitializationMode => Call::Plain(|c| unsafe { fmi2EnterInitializationMode(c) }),
            Function::ExitInitializationMode => Call::Plain(|c| unsafe { fmi2ExitInitializationMode(c) }),
            Function::Terminate => Call::Plain(|c| unsafe { fmi2Terminate(c) }),
            Function::Reset => Call::Plain(|c| unsafe { fmi2Reset(c) }),
            Function::GetReal => Call::GetReals(|c, vr, nvr, value, _| unsafe { fmi2GetReal(c, vr, nvr, value) }),
            Function::GetInteger => {
                Call::GetDiscrete(4, |c, vr, nvr, value, _| unsafe { fmi2GetInteger(c, vr, nvr, value.cast()) })
            }
            Function::GetBoolean => {
                Call::GetDiscrete(4, |c, vr, nvr, value, _| unsafe { fmi2GetBoolean(c, vr, nvr, value.cast()) })
            }
            Function::GetString => Call::GetStrings(|c, vr, nvr, value, _| unsafe { fmi2GetString(c, vr, nvr, value) }),
            Function::SetReal => Call::SetReals(|c, vr, nvr, value, _| unsafe { fmi2SetReal(c, vr, nvr, value) }),
            Function::SetInteger => Call::SetDiscrete(&["detail"], 4, |c, vr, nvr, value, _| unsafe {
                fmi2SetInteger(c, vr, nvr, value.cast())
            }),
            Function::SetBoolean => Call::SetDiscrete(
                &["a_g_late", "F_t_extrapolated", "peaks", "validity"],
                4,
                |c, vr, nvr, value, _| unsafe { fmi2SetBoolean(c, vr, nvr, value.cast()) },
            ),
            Function::SetString => Call::SetStrings(|c, vr, nvr, value, _| unsafe { fmi2SetString(c, vr, nvr, value) }),
            Function::GetFMUstate => Call::GetState(fmi2GetFMUstate),
            Function::SetFMUstate => Call::SetState(fmi2SetFMUstate),
            Function::FreeFMUstate => Call::FreeState(fmi2FreeFMUstate),
            Function::SerializedFMUstateSize => Call::StateSize(fmi2SerializedFMUstateSize),
            Function::SerializeFMUstate => Call::Serialize(fmi2SerializeFMUstate),
            Function::DeSerializeFMUstate => Call::Deserialize(fmi2DeSerializeFMUstate),
            Function::GetDirectionalDerivative => {
                Call::Directional(|c, [unknowns, knowns], [n_unknowns, n_knowns], seed, value| unsafe {
                    fmi2GetDirectionalDerivative(c, unknowns, n_unknowns, knowns, n_knowns, seed, value)
                })
            }
            Function::SetRealInputDerivatives => Call::SetSlopes(|c, vr, nvr, order, value| unsafe {
                fmi2SetRealInputDerivatives(c, vr, nvr, order, value)
            }),
            Function::GetRealOutputDerivatives => Call::GetRates(|c, vr, nvr, order, value, _| unsafe {
                fmi2GetRealOutputDerivatives(c, vr, nvr, order, value)
            }),
            Function::DoStep => Call::DoStep(|c, point, step, flag, _, _| unsafe { fmi2DoStep(c, point, step, flag) }),
            Function::CancelStep => Call::Plain(|c| unsafe { fmi2CancelStep(c) }),
            Function::GetStatus => Call::Status(|c, kind, value| unsafe { fmi2GetStatus(c, kind, value.cast()) }),
            Function::GetRealStatus => {
                Call::Status(|c, kind, value| unsafe { fmi2GetRealStatus(c, kind, value.cast()) })
            }
            Function::GetIntegerStatus => {
                Call::Status(|c, kind, value| unsafe { fmi2GetIntegerStatus(c, kind, value.cast()) })
            }
            Function::GetBooleanStatus => {
                Call::Status(|c, kind, value| unsafe { fmi2GetBooleanStatus(c, kind, value.cast()) })
            }
            Function::GetStringStatus => {
                Call::Status(|c, kind, value| unsafe { fmi2GetStringStatus(c, kind, value.cast()) })
            }
            Function::EnterEventMode => Call::Plain(|c| unsafe { fmi2EnterEventMode(c) }),
            Function::NewDiscreteStates => Call::Update(|c, spoilt| {
                let mut info: EventInfo = unsafe { std::mem::zeroed() };
                let place = match spoilt {
                    None => &raw mut info,
                    Some(0..3) => std::ptr::null_mut(),
                    Some(_) => (&raw mut info).wrapping_byte_add(1),
                };
                unsafe { fmi2NewDiscreteStates(c, place) }
            }),
            Function::EnterContinuousTimeMode => Call::Plain(|c| unsafe { fmi2EnterContinuousTimeMode(c) }),
            Function::CompletedIntegratorStep => Call::CompleteStep(4, |c, flag, event, end| unsafe {
                fmi2CompletedIntegratorStep(c, flag, event.cast(), end.cast())
            }),
            Function::SetTime => Call::SetTime(fmi2SetTime),
            Function::SetContinuousStates => Call::SetStates(fmi2SetContinuousStates),
            Function::GetDerivatives => Call::GetNumbers(4, fmi2GetDerivatives),
            Function::GetEventIndicators => Call::GetNumbers(2, fmi2GetEventIndicators),
            Function::GetContinuousStates => Call::GetNumbers(4, fmi2GetContinuousStates),
            Function::GetNominalsOfContinuousStates => Call::GetNumbers(4, fmi2GetNominalsOfContinuousStates),
        }
    }

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
