//! The functions of FMI 3.0 by their arguments.

use super::{Call, Looking, Version};
use FlexibleRocking::fmi3::*;
use std::ptr::{null, null_mut};

pub struct Fmi3;

impl Version for Fmi3 {
    type Function = Function;

    const PREFIX: &'static str = "fmi3";

    const LOOKING: Looking = Looking {
        free: fmi3FreeInstance,
        get_state: fmi3GetFMUState,
        free_state: fmi3FreeFMUState,
        size: fmi3SerializedFMUStateSize,
        serialize: fmi3SerializeFMUState,
        event_indicators: fmi3GetEventIndicators,
    };

    fn call(function: Function) -> Call {
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
            // what this unit has none of: variables of other types, clocks, partitions
            Function::GetFloat32 => Call::Plain(|c| unsafe { fmi3GetFloat32(c, null(), 0, null_mut(), 0) }),
            Function::GetInt8 => Call::Plain(|c| unsafe { fmi3GetInt8(c, null(), 0, null_mut(), 0) }),
            Function::GetUInt8 => Call::Plain(|c| unsafe { fmi3GetUInt8(c, null(), 0, null_mut(), 0) }),
            Function::GetInt16 => Call::Plain(|c| unsafe { fmi3GetInt16(c, null(), 0, null_mut(), 0) }),
            Function::GetUInt16 => Call::Plain(|c| unsafe { fmi3GetUInt16(c, null(), 0, null_mut(), 0) }),
            Function::GetUInt32 => Call::Plain(|c| unsafe { fmi3GetUInt32(c, null(), 0, null_mut(), 0) }),
            Function::GetUInt64 => Call::Plain(|c| unsafe { fmi3GetUInt64(c, null(), 0, null_mut(), 0) }),
            Function::GetBinary => Call::Plain(|c| unsafe { fmi3GetBinary(c, null(), 0, null_mut(), null_mut(), 0) }),
            Function::GetClock => Call::Plain(|c| unsafe { fmi3GetClock(c, null(), 0, null_mut()) }),
            Function::SetFloat32 => Call::Plain(|c| unsafe { fmi3SetFloat32(c, null(), 0, null(), 0) }),
            Function::SetInt8 => Call::Plain(|c| unsafe { fmi3SetInt8(c, null(), 0, null(), 0) }),
            Function::SetUInt8 => Call::Plain(|c| unsafe { fmi3SetUInt8(c, null(), 0, null(), 0) }),
            Function::SetInt16 => Call::Plain(|c| unsafe { fmi3SetInt16(c, null(), 0, null(), 0) }),
            Function::SetUInt16 => Call::Plain(|c| unsafe { fmi3SetUInt16(c, null(), 0, null(), 0) }),
            Function::SetUInt32 => Call::Plain(|c| unsafe { fmi3SetUInt32(c, null(), 0, null(), 0) }),
            Function::SetUInt64 => Call::Plain(|c| unsafe { fmi3SetUInt64(c, null(), 0, null(), 0) }),
            Function::SetBinary => Call::Plain(|c| unsafe { fmi3SetBinary(c, null(), 0, null(), null(), 0) }),
            Function::SetClock => Call::Plain(|c| unsafe { fmi3SetClock(c, null(), 0, null()) }),
            Function::GetNumberOfVariableDependencies => {
                Call::Plain(|c| unsafe { fmi3GetNumberOfVariableDependencies(c, 0, null_mut()) })
            }
            Function::GetVariableDependencies => Call::Plain(|c| unsafe {
                fmi3GetVariableDependencies(c, 0, null_mut(), null_mut(), null_mut(), null_mut(), 0)
            }),
            Function::EnterConfigurationMode => Call::Plain(|c| unsafe { fmi3EnterConfigurationMode(c) }),
            Function::ExitConfigurationMode => Call::Plain(|c| unsafe { fmi3ExitConfigurationMode(c) }),
            Function::GetIntervalDecimal => {
                Call::Plain(|c| unsafe { fmi3GetIntervalDecimal(c, null(), 0, null_mut(), null_mut()) })
            }
            Function::GetIntervalFraction => {
                Call::Plain(|c| unsafe { fmi3GetIntervalFraction(c, null(), 0, null_mut(), null_mut(), null_mut()) })
            }
            Function::GetShiftDecimal => Call::Plain(|c| unsafe { fmi3GetShiftDecimal(c, null(), 0, null_mut()) }),
            Function::GetShiftFraction => {
                Call::Plain(|c| unsafe { fmi3GetShiftFraction(c, null(), 0, null_mut(), null_mut()) })
            }
            Function::SetIntervalDecimal => Call::Plain(|c| unsafe { fmi3SetIntervalDecimal(c, null(), 0, null()) }),
            Function::SetIntervalFraction => {
                Call::Plain(|c| unsafe { fmi3SetIntervalFraction(c, null(), 0, null(), null()) })
            }
            Function::SetShiftDecimal => Call::Plain(|c| unsafe { fmi3SetShiftDecimal(c, null(), 0, null()) }),
            Function::SetShiftFraction => {
                Call::Plain(|c| unsafe { fmi3SetShiftFraction(c, null(), 0, null(), null()) })
            }
            Function::ActivateModelPartition => Call::Plain(|c| unsafe { fmi3ActivateModelPartition(c, 0, 0.0) }),
        }
    }
}
