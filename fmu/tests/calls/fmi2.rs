//! The functions of FMI 2.0 by their arguments.

use super::{Call, Looking, Version};
use FlexibleRocking::fmi2::*;

pub struct Fmi2;

impl Version for Fmi2 {
    type Function = Function;

    const PREFIX: &'static str = "fmi2";

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
}
