//! Calls of FMI 3.0 that more than one file makes.

use FlexibleRocking::fmi3::*;
use libc::{c_int, c_void};
use std::ptr::{null, null_mut};

/// Calls `function`, which is of what this unit has none of: variables of other types, clocks, partitions.
///
/// # Safety
///
/// That of the function: `c` is an instance.
pub unsafe fn call_what_is_not_provided(c: *mut c_void, function: Function) -> c_int {
    unsafe {
        match function {
            Function::GetFloat32 => fmi3GetFloat32(c, null(), 0, null_mut(), 0),
            Function::GetInt8 => fmi3GetInt8(c, null(), 0, null_mut(), 0),
            Function::GetUInt8 => fmi3GetUInt8(c, null(), 0, null_mut(), 0),
            Function::GetInt16 => fmi3GetInt16(c, null(), 0, null_mut(), 0),
            Function::GetUInt16 => fmi3GetUInt16(c, null(), 0, null_mut(), 0),
            Function::GetUInt32 => fmi3GetUInt32(c, null(), 0, null_mut(), 0),
            Function::GetUInt64 => fmi3GetUInt64(c, null(), 0, null_mut(), 0),
            Function::GetBinary => fmi3GetBinary(c, null(), 0, null_mut(), null_mut(), 0),
            Function::GetClock => fmi3GetClock(c, null(), 0, null_mut()),
            Function::SetFloat32 => fmi3SetFloat32(c, null(), 0, null(), 0),
            Function::SetInt8 => fmi3SetInt8(c, null(), 0, null(), 0),
            Function::SetUInt8 => fmi3SetUInt8(c, null(), 0, null(), 0),
            Function::SetInt16 => fmi3SetInt16(c, null(), 0, null(), 0),
            Function::SetUInt16 => fmi3SetUInt16(c, null(), 0, null(), 0),
            Function::SetUInt32 => fmi3SetUInt32(c, null(), 0, null(), 0),
            Function::SetUInt64 => fmi3SetUInt64(c, null(), 0, null(), 0),
            Function::SetBinary => fmi3SetBinary(c, null(), 0, null(), null(), 0),
            Function::SetClock => fmi3SetClock(c, null(), 0, null()),
            Function::GetNumberOfVariableDependencies => fmi3GetNumberOfVariableDependencies(c, 0, null_mut()),
            Function::GetVariableDependencies => {
                fmi3GetVariableDependencies(c, 0, null_mut(), null_mut(), null_mut(), null_mut(), 0)
            }
            Function::EnterConfigurationMode => fmi3EnterConfigurationMode(c),
            Function::ExitConfigurationMode => fmi3ExitConfigurationMode(c),
            Function::GetIntervalDecimal => fmi3GetIntervalDecimal(c, null(), 0, null_mut(), null_mut()),
            Function::GetIntervalFraction => fmi3GetIntervalFraction(c, null(), 0, null_mut(), null_mut(), null_mut()),
            Function::GetShiftDecimal => fmi3GetShiftDecimal(c, null(), 0, null_mut()),
            Function::GetShiftFraction => fmi3GetShiftFraction(c, null(), 0, null_mut(), null_mut()),
            Function::SetIntervalDecimal => fmi3SetIntervalDecimal(c, null(), 0, null()),
            Function::SetIntervalFraction => fmi3SetIntervalFraction(c, null(), 0, null(), null()),
            Function::SetShiftDecimal => fmi3SetShiftDecimal(c, null(), 0, null()),
            Function::SetShiftFraction => fmi3SetShiftFraction(c, null(), 0, null(), null()),
            Function::ActivateModelPartition => fmi3ActivateModelPartition(c, 0, 0.0),
            provided => panic!("{provided:?} is provided"),
        }
    }
}
