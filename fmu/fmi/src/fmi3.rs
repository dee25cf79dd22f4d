//! The C interface of FMI 3.0: what its functions are called, and what they pass. See [`c_abi`] for what holds of all
//! of them.
//!
//! In co-simulation, where the host handles events and takes an early return, a step ends at the first transition on
//! it: state and phase are those before it until `fmi3UpdateDiscreteStates` applies it. A host that can be called back
//! gives the inputs at the end of every step before it is computed, and they are straight lines over the step; else
//! they are held. After the step is computed it can read all variables.
#![allow(unsafe_code, clippy::missing_safety_doc, clippy::too_many_arguments)] // as in `c_abi`; the standard's arguments

mod stages;

use crate::c_abi::{self, *};
use crate::failure::Failure;
use crate::instance::{Instance, find};
pub use crate::interface::IntermediateUpdateCallback;
use crate::interface::{Interface, IntermediateUpdate, Stepping};
use crate::logger::{Category, Sink};
use crate::model::{Completed, Experiment, Model, StepEnd, Update};
use crate::state_machine::Stage;
use crate::variables::{Causality, DataType, Role};
use libc::{c_char, c_int, c_uint, c_void, size_t};
use std::path::Path;
use std::ptr;

/// `fmi3LogMessageCallback`
pub type LogMessageCallback = unsafe extern "C" fn(*mut c_void, c_int, *const c_char, *const c_char);

/// An instance of the `interface` that `function` makes; null, with the reason in the log, if there is none.
unsafe fn create<M: Model>(
    function: &str,
    [name, token, folder]: [*const c_char; 3],
    (environment, log, logging_on): (*mut c_void, Option<LogMessageCallback>, u8),
    interface: impl FnOnce(&dyn Model) -> Result<(Interface, Option<IntermediateUpdate>), Failure>,
) -> *mut c_void {
    c_abi::instantiate::<Function>(function, &Category::ALL, sink(log, environment), || {
        let name = unsafe { text("instanceName", name) }?;
        let token = unsafe { text("instantiationToken", token) }?;
        let folder = unsafe { text("resourcePath", folder) }?;
        let on = boolean("loggingOn", logging_on)?;
        if name.trim().is_empty() {
            return Err(Failure::NoName);
        }
        let model = c_abi::open::<M>("instantiationToken", token, Path::new(folder))?;
        let (interface, host) = interface(&*model)?;
        Ok((model, interface, host, on))
    })
}

fn sink(log: Option<LogMessageCallback>, environment: *mut c_void) -> Sink {
    let log = log?;
    // # marks variables
    Some(Box::new(move |status, category, message| unsafe {
        log(environment, status as c_int, category.as_ptr(), escaped(message, &['#']).as_ptr());
    }))
}

impl IntermediateUpdate {
    /// Calls the host at `time` (s), the end of a step: for the inputs there, before the step is computed, or for reading
    /// its outputs. A request to return early is ignored.
    fn call(self, time: f64, asks_for_inputs: bool) {
        let IntermediateUpdate { update, environment, .. } = self;
        let (set_requested, get_allowed) = (asks_for_inputs.into(), (!asks_for_inputs).into());
        let (step_finished, can_return_early, mut requested, mut at) = (get_allowed, 0, 0, 0.0);
        let (requested, at) = (&raw mut requested, &raw mut at);
        unsafe {
            update(environment, time, set_requested, get_allowed, step_finished, can_return_early, requested, at)
        };
    }
}

/// The truth that the `fmi3Boolean` `value`, given as `name`, stands for.
fn boolean(name: &str, value: u8) -> Result<bool, Failure> {
    truth(name, value.into(), "0 (fmi3False), 1 (fmi3True)")
}

/// The position of the variable that the host refers to; [`Instance`] refuses those that do not exist.
fn position(reference: &u32) -> u32 {
    reference.wrapping_sub(WORDS.first)
}

/// Has `call` done with the positions of the variables, all of which are scalars, that as many values are for. The instance
/// keeps the room for them.
unsafe fn with_positions(
    instance: &mut Instance,
    valueReferences: *const c_uint,
    [nValueReferences, nValues]: [size_t; 2],
    call: impl FnOnce(&mut Instance, &[u32]) -> Result<(), Failure>,
) -> Result<(), Failure> {
    check_count("nValues", nValues, nValueReferences)?;
    let references = unsafe { values("valueReferences", valueReferences, nValueReferences) }?;
    let mut positions = std::mem::take(&mut instance.positions);
    positions.clear();
    positions.extend(references.iter().map(position));
    let result = call(instance, &positions);
    instance.positions = positions;
    result
}

#[cfg(not(any(target_arch = "x86_64", target_arch = "aarch64")))]
compile_error!(
    "functions of FMI 3.0 are declared here without arguments at their end that they do not read. This is right only where the caller \
     removes the arguments, as on x86-64 and 64-bit ARM"
);

const WORDS: Words = Words {
    version: "fmi3",
    magic: 0x466d_6955_6e69_7433,
    first: 1, // OMSimulator reads value references in lists of dependencies as the indices of FMI 2.0
    real: "Float64",
    integer: "Int32",
    enumeration: "Int64",
    state: "FMUState",
    set_up: "EnterInitializationMode",
};

/// Adds to the functions of this version those that take value references with values, those of types that no variable has,
/// and those that are never allowed. Arguments that are not read are not declared.
macro_rules! with_lists {
    (
        values: {$(
            $(#[$doc:meta])*
            $name:ident($type:ty) $([$often:ident])? |$instance:ident, $positions:ident, $values:ident, $count:ident| $body:block
        )*}
        no_variables: [$($none:ident)*]
        never: [$($never:ident)*]
        $($own:tt)*
    ) => {
        shared_functions! {
            $($own)*

            $(
                $(#[$doc])*
                $name(
                    valueReferences: *const c_uint, nValueReferences: size_t, $values: $type, nValues: size_t,
                ) $([$often])? |instance| {
                    let counts = [nValueReferences, nValues];
                    let $count = ("nValues", nValues);
                    with_positions(instance, valueReferences, counts, |$instance, $positions| $body)
                }
            )*

            $($none(_of: *const c_uint, count: size_t) |_instance| {
                if count == 0 { Ok(()) } else { Err(Failure::NoneOfType) }
            })*

            $($never())*
        }
    };
}

with_lists! {
    values: {
        GetFloat64(*mut f64) [often] |instance, positions, value, count| {
            let places = room("values", value, count.1)?;
            fill(places, instance.get_real(positions)?);
            Ok(())
        }

        GetInt32(*mut i32) |instance, positions, value, count| {
            let is_integer = |data_type: &DataType| matches!(data_type, DataType::Integer);
            write_all("values", value, count, instance.get_numbers(positions, is_integer)?)
        }

        GetInt64(*mut i64) |instance, positions, value, count| {
            let is_item = |data_type: &DataType| matches!(data_type, DataType::Enumeration(_));
            write_all("values", value, count, instance.get_numbers(positions, is_item)?)
        }

        GetBoolean(*mut u8) |instance, positions, value, count| {
            write_all("values", value, count, instance.get_booleans(positions)?)
        }

        GetString(*mut *const c_char) |instance, positions, value, count| {
            write_all("values", value, count, instance.get_texts(positions)?)
        }

        SetFloat64(*const f64) [often] |instance, positions, value, count| {
            instance.set_real(positions, values("values", value, count.1)?)
        }

        /// Refuses all, because a model has no integers to set.
        SetInt32(*const i32) |instance, positions, _values, _count| { instance.set_no_integer(positions) }

        SetInt64(*const i64) |instance, positions, value, count| {
            instance.set_integer(positions, values("values", value, count.1)?)
        }

        SetBoolean(*const u8) |instance, positions, value, count| {
            instance.set_boolean(positions, values("values", value, count.1)?, boolean)
        }

        SetString(*const *const c_char) |instance, positions, value, count| {
            let given = values("values", value, count.1)?;
            let texts = given.iter().map(|value| text("values", *value)).collect::<Result<Vec<_>, _>>()?;
            instance.set_string(positions, &texts)
        }
    }

    no_variables: [
        GetFloat32 GetInt8 GetUInt8 GetInt16 GetUInt16 GetUInt32 GetUInt64 GetBinary GetClock
        SetFloat32 SetInt8 SetUInt8 SetInt16 SetUInt16 SetUInt32 SetUInt64 SetBinary SetClock
    ]

    never: [
        GetNumberOfVariableDependencies GetVariableDependencies GetAdjointDerivative
        EnterConfigurationMode ExitConfigurationMode
        GetIntervalDecimal GetIntervalFraction GetShiftDecimal GetShiftFraction
        SetIntervalDecimal SetIntervalFraction SetShiftDecimal SetShiftFraction
        ActivateModelPartition
    ]

    "fmi3" export_fmi3 u8,
    FMUState: [GetFMUState SetFMUState FreeFMUState SerializedFMUStateSize SerializeFMUState DeserializeFMUState],
    continuousStates nContinuousStates nominals nEventIndicators: [GetContinuousStateDerivatives],

    { GetVersion() -> *const c_char { c"3.0".as_ptr() } }

    {
        InstantiateCoSimulation(
        instanceName: *const c_char, instantiationToken: *const c_char, resourcePath: *const c_char, _visible: u8,
        loggingOn: u8, eventModeUsed: u8, earlyReturnAllowed: u8, requiredIntermediateVariables: *const c_uint,
        nRequiredIntermediateVariables: size_t, environment: *mut c_void, logMessage: Option<LogMessageCallback>,
        intermediateUpdate: Option<IntermediateUpdateCallback>,
    ) -> *mut c_void {
        let interface = |model: &dyn Model| {
            let event_mode = boolean("eventModeUsed", eventModeUsed)?;
            let early_return = boolean("earlyReturnAllowed", earlyReturnAllowed)?;
            let (name, length) = ("requiredIntermediateVariables", nRequiredIntermediateVariables);
            let required = unsafe { values(name, requiredIntermediateVariables, length) }?;
            let variables = model.variables();
            let (mut sets_inputs, mut gets_outputs) = (false, false);
            for reference in required {
                let is_input = find(&variables, position(reference), WORDS.first)?.causality == Causality::Input;
                (sets_inputs, gets_outputs) = (sets_inputs || is_input, gets_outputs || !is_input);
            }
            let host =
                intermediateUpdate.map(|update| IntermediateUpdate { update, environment, sets_inputs, gets_outputs });
            Ok((Interface::CoSimulation(Stepping { event_mode, early_return }), host))
        };
        let (texts, log) = ([instanceName, instantiationToken, resourcePath], (environment, logMessage, loggingOn));
        unsafe { create::<M>("InstantiateCoSimulation", texts, log, interface) }
    } }

    { InstantiateModelExchange(
        instanceName: *const c_char, instantiationToken: *const c_char, resourcePath: *const c_char, _visible: u8,
        loggingOn: u8, environment: *mut c_void, logMessage: Option<LogMessageCallback>,
    ) -> *mut c_void {
        let interface = |_: &dyn Model| Ok((Interface::ModelExchange, None));
        let (texts, log) = ([instanceName, instantiationToken, resourcePath], (environment, logMessage, loggingOn));
        unsafe { create::<M>("InstantiateModelExchange", texts, log, interface) }
    } }

    {
        /// There is nothing to schedule. Three more arguments are not read, and not declared: the caller removes them.
        InstantiateScheduledExecution(
        instanceName: *const c_char, instantiationToken: *const c_char, resourcePath: *const c_char, _visible: u8,
        loggingOn: u8, environment: *mut c_void, logMessage: Option<LogMessageCallback>,
    ) -> *mut c_void {
        let interface = |_: &dyn Model| Err(Failure::NotThisInterface);
        let (texts, log) = ([instanceName, instantiationToken, resourcePath], (environment, logMessage, loggingOn));
        unsafe { create::<M>("InstantiateScheduledExecution", texts, log, interface) }
    } }

    {
        /// Ignored for null, and while a call is under way, as from within a callback.
        FreeInstance(instance: *mut c_void) { unsafe { c_abi::free::<Function>(instance) } }
    }

    [
        /// `noSetFMUStatePriorToCurrentPoint` is ignored: FMU states are kept until the host frees them. Between the parts of
        /// this function the host is called back, and may call the instance.
        DoStep(
        c: *mut c_void, currentCommunicationPoint: f64, communicationStepSize: f64,
        _noSetFMUStatePriorToCurrentPoint: u8, eventHandlingNeeded: *mut u8, terminateSimulation: *mut u8,
        earlyReturn: *mut u8, lastSuccessfulTime: *mut f64,
    ) {
        let (point, step) = (currentCommunicationPoint, communicationStepSize);
        let check = || {
            check_pointer("eventHandlingNeeded", eventHandlingNeeded)?;
            check_pointer("terminateSimulation", terminateSimulation)?;
            check_pointer("earlyReturn", earlyReturn)?;
            check_pointer("lastSuccessfulTime", lastSuccessfulTime)
        };
        let (mut asked, mut told) = (None, None);
        let mut compute = |instance: &mut Instance| unsafe {
            let progress = instance.do_step(point, step)?;
            let (time, may_return_early) = (instance.model.time()?, instance.interface.stepping().early_return);
            if let (StepEnd::Ended, Some(ending)) = (progress, instance.ending()?) {
                instance.logger.warning(|| format!("fmi3DoStep: {ending}"));
            }
            write("eventHandlingNeeded", eventHandlingNeeded, u8::from(progress == StepEnd::Event))?;
            write("terminateSimulation", terminateSimulation, u8::from(progress == StepEnd::Ended))?;
            let is_early = may_return_early && progress != StepEnd::Complete && time < point + step;
            write("earlyReturn", earlyReturn, is_early.into())?;
            write("lastSuccessfulTime", lastSuccessfulTime, time)?;
            told = instance.show_step().map(|host| (host, time));
            Ok(())
        };
        let begin = |instance: &mut Instance| {
            check()?;
            asked = instance.begin_step(point, step)?;
            if asked.is_none() { compute(instance) } else { Ok(()) }
        };
        let mut status = unsafe { call(c, Function::DoStep, None, begin) };
        if let Some(host) = asked {
            unsafe { call_back::<Function>(c, || host.call(point + step, true)) };
            status = unsafe { call(c, Function::DoStep, Some(Stage::WITHIN_STEP), compute) };
        }
        if let Some((host, time)) = told {
            unsafe { call_back::<Function>(c, || host.call(time, false)) };
            let end = |instance: &mut Instance| {
                instance.end_step();
                Ok(())
            };
            status = unsafe { call(c, Function::DoStep, Some(Stage::WITHIN_STEP), end) };
        }
        status
    } ]

    SetDebugLogging(
        loggingOn: u8, nCategories: size_t, categories: *const *const c_char,
    ) |instance| {
        instance.logger.switch(&named_categories(nCategories, categories)?, boolean("loggingOn", loggingOn)?);
        Ok(())
    }

    EnterInitializationMode(
        toleranceDefined: u8, tolerance: f64, startTime: f64, stopTimeDefined: u8, stopTime: f64,
    ) |instance| {
        let tolerance = boolean("toleranceDefined", toleranceDefined)?.then_some(tolerance);
        let stop_time = boolean("stopTimeDefined", stopTimeDefined)?.then_some(stopTime);
        instance.set_up(Experiment { tolerance, start_time: startTime, stop_time })?;
        instance.enter(Stage::InitializationMode)
    }

    GetDirectionalDerivative(
        unknowns: *const c_uint, nUnknowns: size_t, knowns: *const c_uint, nKnowns: size_t, seed: *const f64,
        nSeed: size_t, sensitivity: *mut f64, nSensitivity: size_t,
    ) |instance| {
        check_count("nSeed", nSeed, nKnowns)?;
        check_count("nSensitivity", nSensitivity, nUnknowns)?;
        let unknowns: Vec<_> = values("unknowns", unknowns, nUnknowns)?.iter().map(position).collect();
        let knowns: Vec<_> = values("knowns", knowns, nKnowns)?.iter().map(position).collect();
        let found = instance.get_directional_derivative(&unknowns, &knowns, values("seed", seed, nSeed)?)?;
        write_all("sensitivity", sensitivity, ("nSensitivity", nSensitivity), found)
    }

    /// Does nothing: `fmi3UpdateDiscreteStates` evaluates.
    EvaluateDiscreteStates() |_instance| { Ok(()) }

    UpdateDiscreteStates(
        discreteStatesNeedUpdate: *mut u8, terminateSimulation: *mut u8, nominalsOfContinuousStatesChanged: *mut u8,
        valuesOfContinuousStatesChanged: *mut u8, nextEventTimeDefined: *mut u8, nextEventTime: *mut f64,
    ) |instance| {
        let flags = [
            ("discreteStatesNeedUpdate", discreteStatesNeedUpdate),
            ("terminateSimulation", terminateSimulation),
            ("nominalsOfContinuousStatesChanged", nominalsOfContinuousStatesChanged),
            ("valuesOfContinuousStatesChanged", valuesOfContinuousStatesChanged),
            ("nextEventTimeDefined", nextEventTimeDefined),
        ];
        for (name, flag) in flags {
            check_pointer(name, flag)?;
        }
        check_pointer("nextEventTime", nextEventTime)?;
        let Update { has_ended, has_new_states, next_event } = instance.update_discrete_states()?;
        let told = [false, has_ended, false, has_new_states, next_event.is_some()];
        for ((name, flag), told) in flags.into_iter().zip(told) {
            write(name, flag, told.into())?;
        }
        write("nextEventTime", nextEventTime, next_event.unwrap_or_default())
    }

    EnterStepMode() |instance| { instance.enter(Stage::StepComplete) }

    GetOutputDerivatives(
        valueReferences: *const c_uint, nValueReferences: size_t, orders: *const i32, value: *mut f64,
        nValues: size_t,
    ) |instance| {
        with_positions(instance, valueReferences, [nValueReferences, nValues], |instance, positions| {
            let rates = instance.get_real_output_derivatives(positions, values("orders", orders, nValueReferences)?)?;
            write_all("values", value, ("nValues", nValues), rates)
        })
    }

    GetNumberOfEventIndicators(nEventIndicators: *mut size_t) |instance| {
        write("nEventIndicators", nEventIndicators, instance.count(|role| *role == Role::Indicator))
    }

    GetNumberOfContinuousStates(nContinuousStates: *mut size_t) |instance| {
        write("nContinuousStates", nContinuousStates, instance.count(|role| *role == Role::State))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::logger::{Logger, Status};
    use crate::model::StepRequest;
    use crate::variables::{Value, Variable};
    use std::cell::Cell;
    use std::ffi::CString;
    use std::sync::Arc;

    thread_local! {
        /// How many models this thread has dropped.
        static DROPPED: Cell<u32> = const { Cell::new(0) };
    }

    /// A model with a variable whose value panics.
    #[derive(serde::Serialize, serde::Deserialize)]
    struct Touchy;

    impl Drop for Touchy {
        fn drop(&mut self) {
            DROPPED.set(DROPPED.get() + 1);
        }
    }

    impl Model for Touchy {
        fn open(_: &Path) -> Result<Box<dyn Model>, Failure> {
            Ok(Box::new(Touchy))
        }

        fn variables(&self) -> Arc<[Variable]> {
            Arc::new([Variable::real(Causality::Local, "z", "1", "panic"), Variable::time()])
        }

        fn get(&mut self, reference: u32) -> Result<Value, Failure> {
            assert_ne!(reference, 0, "on purpose");
            Ok(Value::Real(0.0))
        }

        fn set(&mut self, _: u32, _: Value) {}

        fn advance(&mut self, _: StepRequest, _: &Logger) -> Result<StepEnd, Failure> {
            Ok(StepEnd::Complete)
        }

        fn update(&mut self, _: &Logger) -> Result<Update, Failure> {
            Ok(Update::default())
        }

        crate::state_by_serde!();
    }

    /// The callback reads a variable whose value panics, and tries to free the instance.
    unsafe extern "C" fn update(c: *mut c_void, _: f64, _: u8, _: u8, _: u8, _: u8, _: *mut u8, _: *mut f64) {
        unsafe {
            let c = *c.cast::<*mut c_void>();
            assert_eq!(GetFloat64(c, &1, 1, &mut 0.0, 1), Status::Fatal as c_int);
            FreeInstance::<Touchy>(c);
            assert_eq!(DROPPED.get(), 0);
        }
    }

    #[test]
    fn an_instance_that_panics_can_only_be_freed_and_not_within_a_step() {
        let mut c: *mut c_void = ptr::null_mut();
        let token = CString::new(Touchy.token()).unwrap();
        let environment = (&raw mut c).cast();
        DROPPED.set(0);
        unsafe {
            let [name, token, folder] = [c"a".as_ptr(), token.as_ptr(), c"/".as_ptr()];
            let instantiate = InstantiateCoSimulation::<Touchy>;
            c = instantiate(name, token, folder, 0, 0, 0, 0, &1, 1, environment, None, Some(update));
            assert_eq!((EnterInitializationMode(c, 0, 0.0, 0.0, 0, 0.0), ExitInitializationMode(c)), (0, 0));
            let (mut flags, mut time) = ([0; 3], 0.0);
            let [event, end, early] = &mut flags;
            assert_eq!(DoStep(c, 0.0, 0.1, 0, event, end, early, &mut time), Status::Fatal as c_int);
            assert_eq!(Reset(c), Status::Fatal as c_int);
            FreeInstance::<Touchy>(c);
        }
        assert_eq!(DROPPED.get(), 1);
    }
}
