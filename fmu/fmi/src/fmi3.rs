//! The C interface of FMI 3.0: what its functions are called, and what they pass. See [`c_abi`] for what holds of all
//! of them.
//!
//! In co-simulation, where the host handles events and takes an early return, a step ends at the first transition on
//! it: state and phase are those before it until `fmi3UpdateDiscreteStates` applies it. A host that can be called back
//! gives the inputs at the end of every step before it is computed, and they are straight lines over the step; else
//! they are held. After the step is computed it can read all variables.
#![allow(unsafe_code, clippy::missing_safety_doc)] // as in `c_abi`

mod stages;

use crate::c_abi::{
    self, Words, call, call_back, call_on, check_count, check_pointer, complete_step, escaped, fill, free_state,
    functions, keep_state, named_categories, read_all, read_state, room, text, values, write, write_all, write_state,
    write_state_size,
};
use crate::failure::Failure;
use crate::instance::Instance;
pub use crate::interface::IntermediateUpdateCallback;
use crate::interface::{Interface, IntermediateUpdate, Stepping};
use crate::logger::{Category, Logger, Sink};
use crate::model::{Experiment, Model, Progress, Update};
use crate::state_machine::{Stage, Table};
use crate::variables::{Causality, DataType, Role, find};
use libc::{c_char, c_int, c_uint, c_void, size_t};
use std::path::Path;

/// `fmi3LogMessageCallback`
pub type LogMessageCallback = unsafe extern "C" fn(*mut c_void, c_int, *const c_char, *const c_char);

const MAGIC: u64 = 0x466d_6955_6e69_7433;

/// An instance of the `interface` that `function` makes; null, with the reason in the log, if there is none.
unsafe fn create<M: Model>(
    function: &str,
    [name, token, folder]: [*const c_char; 3],
    (environment, log, logging_on): (*mut c_void, Option<LogMessageCallback>, u8),
    interface: impl FnOnce(&M) -> Result<(Interface, &'static Table, Option<IntermediateUpdate>), Failure>,
) -> *mut c_void {
    c_abi::instantiate::<Function, M>(|| {
        let mut logger = Logger::new(sink(log, environment));
        let found = || {
            let name = unsafe { text("instanceName", name) }?;
            let token = unsafe { text("instantiationToken", token) }?;
            let folder = unsafe { text("resourcePath", folder) }?;
            let on = boolean("loggingOn", logging_on)?;
            if name.trim().is_empty() {
                return Err(Failure::NoName);
            }
            let model = c_abi::open::<M>("instantiationToken", token, Path::new(folder))?;
            Ok((interface(&model)?, model, on))
        };
        match found() {
            Ok(((interface, allowed_in, called_back), model, on)) => {
                logger.switch(&Category::ALL, on);
                Some((Instance::new(model, FIRST, interface, logger, called_back), allowed_in))
            }
            Err(failure) => {
                logger.failure(failure.status(), &format!("{function}: {failure}"));
                None
            }
        }
    })
}

fn sink(log: Option<LogMessageCallback>, environment: *mut c_void) -> Sink {
    let Some(log) = log else { return Box::new(|_, _, _| ()) };
    // # marks variables
    Box::new(move |status, category, message| unsafe {
        log(environment, status as c_int, category.as_ptr(), escaped(message, &['#']).as_ptr());
    })
}

impl IntermediateUpdate {
    /// Asks for the inputs at `time` (s), the end of a step: what the step leads to there is not known yet, which is
    /// what a tentative update says.
    fn ask_for_inputs(self, time: f64) {
        let (set_requested, get_allowed, step_finished) = (1, 0, 0);
        self.call(time, set_requested, get_allowed, step_finished);
    }

    /// Has the host read what a step has led to at `time` (s).
    fn show_outputs(self, time: f64) {
        let (set_requested, get_allowed, step_finished) = (0, 1, 1);
        self.call(time, set_requested, get_allowed, step_finished);
    }

    /// A request to return early is ignored.
    fn call(self, time: f64, set_requested: u8, get_allowed: u8, step_finished: u8) {
        let IntermediateUpdate { update, environment, .. } = self;
        let (mut requested, mut at, can_return_early) = (0, 0.0, 0);
        let (requested, at) = (&raw mut requested, &raw mut at);
        unsafe {
            update(environment, time, set_requested, get_allowed, step_finished, can_return_early, requested, at)
        };
    }
}

/// The truth that the `fmi3Boolean` `value`, given as `name`, stands for.
fn boolean(name: &str, value: u8) -> Result<bool, Failure> {
    match value {
        0 => Ok(false),
        1 => Ok(true),
        _ => {
            Err(Failure::BadChoice { name: name.into(), value: value.into(), accepted: "0 (fmi3False), 1 (fmi3True)" })
        }
    }
}

/// The value reference of the first variable: OMSimulator reads value references in lists of dependencies as FMI 2.0's indices,
/// which count from 1.
const FIRST: u32 = 1;

/// The position of the variable that the host refers to; [`Instance`] refuses those that do not exist.
fn position(reference: &u32) -> u32 {
    reference.wrapping_sub(FIRST)
}

/// Has `call` done with the positions of the variables, all of which are scalars, that as many values are for. The instance
/// keeps the room for them.
unsafe fn with_positions<M: Model>(
    instance: &mut Instance<M>,
    valueReferences: *const c_uint,
    [nValueReferences, nValues]: [size_t; 2],
    call: impl FnOnce(&mut Instance<M>, &[u32]) -> Result<(), Failure>,
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

/// Refuses all `count` variables of a type that no variable has.
fn none_of_type(count: size_t) -> Result<(), Failure> {
    if count == 0 { Ok(()) } else { Err(Failure::NoneOfType) }
}

const WORDS: Words = Words {
    real: "fmi3GetFloat64 or fmi3SetFloat64",
    integer: "fmi3GetInt32",
    enumeration: "fmi3GetInt64 or fmi3SetInt64",
    boolean: "fmi3GetBoolean or fmi3SetBoolean",
    string: "fmi3GetString or fmi3SetString",
    fixing: "fmi3ExitInitializationMode",
    reset: "fmi3Reset",
    set_state: "fmi3SetFMUState",
    set_up: "fmi3EnterInitializationMode",
    state_size: "fmi3SerializedFMUStateSize",
    status: "", // none is ever asked for
};

functions! {
    export_fmi3

    { fmi3GetVersion() -> *const c_char { c"3.0".as_ptr() } }

    {
        #[allow(clippy::too_many_arguments)] // the standard's
        fmi3InstantiateCoSimulation(
        instanceName: *const c_char, instantiationToken: *const c_char, resourcePath: *const c_char, _visible: u8,
        loggingOn: u8, eventModeUsed: u8, earlyReturnAllowed: u8, requiredIntermediateVariables: *const c_uint,
        nRequiredIntermediateVariables: size_t, environment: *mut c_void, logMessage: Option<LogMessageCallback>,
        intermediateUpdate: Option<IntermediateUpdateCallback>,
    ) -> *mut c_void {
        let interface = |model: &M| {
            let event_mode = boolean("eventModeUsed", eventModeUsed)?;
            let early_return = boolean("earlyReturnAllowed", earlyReturnAllowed)?;
            let (name, length) = ("requiredIntermediateVariables", nRequiredIntermediateVariables);
            let required = unsafe { values(name, requiredIntermediateVariables, length) }?;
            let variables = model.variables();
            let (mut sets_inputs, mut gets_outputs) = (false, false);
            for reference in required {
                let is_input = find(&variables, position(reference), FIRST)?.causality == Causality::Input;
                (sets_inputs, gets_outputs) = (sets_inputs || is_input, gets_outputs || !is_input);
            }
            let host =
                intermediateUpdate.map(|update| IntermediateUpdate { update, environment, sets_inputs, gets_outputs });
            let allowed_in: &Table = &stages::CO_SIMULATION;
            Ok((Interface::CoSimulation(Stepping { event_mode, early_return }), allowed_in, host))
        };
        let (texts, log) = ([instanceName, instantiationToken, resourcePath], (environment, logMessage, loggingOn));
        unsafe { create("fmi3InstantiateCoSimulation", texts, log, interface) }
    } }

    { fmi3InstantiateModelExchange(
        instanceName: *const c_char, instantiationToken: *const c_char, resourcePath: *const c_char, _visible: u8,
        loggingOn: u8, environment: *mut c_void, logMessage: Option<LogMessageCallback>,
    ) -> *mut c_void {
        let allowed_in: &Table = &stages::MODEL_EXCHANGE;
        let interface = |_: &M| Ok((Interface::ModelExchange, allowed_in, None));
        let (texts, log) = ([instanceName, instantiationToken, resourcePath], (environment, logMessage, loggingOn));
        unsafe { create("fmi3InstantiateModelExchange", texts, log, interface) }
    } }

    {
        /// There is nothing to schedule. Three more arguments are not read, and not declared: the caller removes them.
        fmi3InstantiateScheduledExecution(
        instanceName: *const c_char, instantiationToken: *const c_char, resourcePath: *const c_char, _visible: u8,
        loggingOn: u8, environment: *mut c_void, logMessage: Option<LogMessageCallback>,
    ) -> *mut c_void {
        let interface = |_: &M| Err(Failure::NotThisInterface);
        let (texts, log) = ([instanceName, instantiationToken, resourcePath], (environment, logMessage, loggingOn));
        unsafe { create("fmi3InstantiateScheduledExecution", texts, log, interface) }
    } }

    {
        /// Ignored for null, and while a call is under way, as from within a callback.
        fmi3FreeInstance(instance: *mut c_void) { unsafe { c_abi::free::<Function, M>(instance) } }
    }

    [
        /// `noSetFMUStatePriorToCurrentPoint` is ignored: FMU states are kept until the host frees them. Between the parts of
        /// this function the host is called back, and may call the instance.
        #[allow(clippy::too_many_arguments)] // the standard's
        fmi3DoStep = DoStep(
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
        let mut compute = |instance: &mut Instance<M>| unsafe {
            let progress = instance.do_step(point, step)?;
            let (time, may_return_early) = (instance.model.time()?, instance.may_return_early());
            if let (Progress::Ended, Some(ending)) = (progress, instance.ending()?) {
                instance.logger.warning(&format!("fmi3DoStep: {ending}"));
            }
            write("eventHandlingNeeded", eventHandlingNeeded, u8::from(progress == Progress::Event))?;
            write("terminateSimulation", terminateSimulation, u8::from(progress == Progress::Ended))?;
            let is_early = may_return_early && progress != Progress::Complete && time < point + step;
            write("earlyReturn", earlyReturn, is_early.into())?;
            write("lastSuccessfulTime", lastSuccessfulTime, time)?;
            told = instance.show_step().map(|host| (host, time));
            Ok(())
        };
        let begin = |instance: &mut Instance<M>| {
            check()?;
            asked = instance.begin_step(point, step)?;
            if asked.is_none() { compute(instance) } else { Ok(()) }
        };
        let mut status = unsafe { call(c, Function::DoStep, begin) };
        if let Some(host) = asked {
            unsafe { call_back::<Function, M>(c, || host.ask_for_inputs(point + step)) };
            status = unsafe { call_on(c, Function::DoStep, compute) };
        }
        if let Some((host, time)) = told {
            unsafe { call_back::<Function, M>(c, || host.show_outputs(time)) };
            let end = |instance: &mut Instance<M>| {
                instance.end_step();
                Ok(())
            };
            status = unsafe { call_on(c, Function::DoStep, end) };
        }
        status
    } ]

    fmi3SetDebugLogging = SetDebugLogging(
        loggingOn: u8, nCategories: size_t, categories: *const *const c_char,
    ) |instance| {
        instance.logger.switch(&named_categories(nCategories, categories)?, boolean("loggingOn", loggingOn)?);
        Ok(())
    }

    fmi3EnterInitializationMode = EnterInitializationMode(
        toleranceDefined: u8, tolerance: f64, startTime: f64, stopTimeDefined: u8, stopTime: f64,
    ) |instance| {
        let tolerance = boolean("toleranceDefined", toleranceDefined)?.then_some(tolerance);
        let stop_time = boolean("stopTimeDefined", stopTimeDefined)?.then_some(stopTime);
        instance.set_up(Experiment { tolerance, start_time: startTime, stop_time })?;
        instance.enter(Stage::InitializationMode)
    }

    fmi3ExitInitializationMode = ExitInitializationMode() |instance| { instance.exit_initialization_mode() }

    fmi3EnterEventMode = EnterEventMode() |instance| { instance.enter_event_mode() }

    fmi3Terminate = Terminate() |instance| { instance.terminate() }

    fmi3Reset = Reset() |instance| { instance.reset() }

    fmi3GetFloat64 = GetFloat64(
        valueReferences: *const c_uint, nValueReferences: size_t, value: *mut f64, nValues: size_t,
    ) |instance| {
        with_positions(instance, valueReferences, [nValueReferences, nValues], |instance, positions| {
            let places = room("values", value, nValues)?;
            fill(places, instance.get_real(positions)?);
            Ok(())
        })
    }

    fmi3GetInt32 = GetInt32(
        valueReferences: *const c_uint, nValueReferences: size_t, value: *mut i32, nValues: size_t,
    ) |instance| {
        with_positions(instance, valueReferences, [nValueReferences, nValues], |instance, positions| {
            let is_of_type = |data_type: &DataType| matches!(data_type, DataType::Integer);
            instance.get_numbers(positions, room("values", value, nValues)?, is_of_type)
        })
    }

    fmi3GetInt64 = GetInt64(
        valueReferences: *const c_uint, nValueReferences: size_t, value: *mut i64, nValues: size_t,
    ) |instance| {
        with_positions(instance, valueReferences, [nValueReferences, nValues], |instance, positions| {
            let is_of_type = |data_type: &DataType| matches!(data_type, DataType::Enumeration(_));
            instance.get_numbers(positions, room("values", value, nValues)?, is_of_type)
        })
    }

    fmi3GetBoolean = GetBoolean(
        valueReferences: *const c_uint, nValueReferences: size_t, value: *mut u8, nValues: size_t,
    ) |instance| {
        with_positions(instance, valueReferences, [nValueReferences, nValues], |instance, positions| {
            instance.get_boolean(positions, room("values", value, nValues)?)
        })
    }

    fmi3GetString = GetString(
        valueReferences: *const c_uint, nValueReferences: size_t, value: *mut *const c_char, nValues: size_t,
    ) |instance| {
        with_positions(instance, valueReferences, [nValueReferences, nValues], |instance, positions| {
            instance.get_string(positions, room("values", value, nValues)?)
        })
    }

    fmi3SetFloat64 = SetFloat64(
        valueReferences: *const c_uint, nValueReferences: size_t, value: *const f64, nValues: size_t,
    ) |instance| {
        with_positions(instance, valueReferences, [nValueReferences, nValues], |instance, positions| {
            instance.set_real(positions, values("values", value, nValues)?)
        })
    }

    /// Refuses all, because a model has no integers to set.
    fmi3SetInt32 = SetInt32(
        valueReferences: *const c_uint, nValueReferences: size_t, _values: *const i32, nValues: size_t,
    ) |instance| {
        with_positions(instance, valueReferences, [nValueReferences, nValues], |instance, positions| instance.set_no_integer(positions))
    }

    fmi3SetInt64 = SetInt64(
        valueReferences: *const c_uint, nValueReferences: size_t, value: *const i64, nValues: size_t,
    ) |instance| {
        with_positions(instance, valueReferences, [nValueReferences, nValues], |instance, positions| {
            instance.set_integer(positions, values("values", value, nValues)?)
        })
    }

    fmi3SetBoolean = SetBoolean(
        valueReferences: *const c_uint, nValueReferences: size_t, value: *const u8, nValues: size_t,
    ) |instance| {
        with_positions(instance, valueReferences, [nValueReferences, nValues], |instance, positions| {
            instance.set_boolean(positions, values("values", value, nValues)?, boolean)
        })
    }

    fmi3SetString = SetString(
        valueReferences: *const c_uint, nValueReferences: size_t, value: *const *const c_char, nValues: size_t,
    ) |instance| {
        with_positions(instance, valueReferences, [nValueReferences, nValues], |instance, positions| {
            let given = values("values", value, nValues)?;
            let texts = given.iter().map(|value| text("values", *value)).collect::<Result<Vec<_>, _>>()?;
            instance.set_string(positions, &texts)
        })
    }

    fmi3GetFMUState = GetFMUState(FMUState: *mut *mut c_void) |instance| { keep_state(instance, "FMUState", FMUState) }

    fmi3SetFMUState = SetFMUState(FMUState: *mut c_void) |instance| { instance.set_fmu_state(FMUState.addr()) }

    /// Ignored for null.
    fmi3FreeFMUState = FreeFMUState(FMUState: *mut *mut c_void) |instance| { free_state(instance, "FMUState", FMUState) }

    fmi3SerializedFMUStateSize = SerializedFMUStateSize(FMUState: *mut c_void, size: *mut size_t) |instance| {
        write_state_size(instance, FMUState, size)
    }

    fmi3SerializeFMUState = SerializeFMUState(
        FMUState: *mut c_void, serializedState: *mut u8, size: size_t,
    ) |instance| {
        write_state(instance, FMUState, serializedState, size)
    }

    fmi3DeserializeFMUState = DeserializeFMUState(
        serializedState: *const u8, size: size_t, FMUState: *mut *mut c_void,
    ) |instance| {
        read_state(instance, serializedState, size, "FMUState", FMUState)
    }

    fmi3GetDirectionalDerivative = GetDirectionalDerivative(
        unknowns: *const c_uint, nUnknowns: size_t, knowns: *const c_uint, nKnowns: size_t, seed: *const f64,
        nSeed: size_t, sensitivity: *mut f64, nSensitivity: size_t,
    ) |instance| {
        check_count("nSeed", nSeed, nKnowns)?;
        check_count("nSensitivity", nSensitivity, nUnknowns)?;
        let unknowns: Vec<_> = values("unknowns", unknowns, nUnknowns)?.iter().map(position).collect();
        let knowns: Vec<_> = values("knowns", knowns, nKnowns)?.iter().map(position).collect();
        let (seed, sensitivity) = (values("seed", seed, nSeed)?, room("sensitivity", sensitivity, nSensitivity)?);
        instance.get_directional_derivative(&unknowns, &knowns, seed, sensitivity)
    }

    /// Does nothing: `fmi3UpdateDiscreteStates` evaluates.
    fmi3EvaluateDiscreteStates = EvaluateDiscreteStates() |_instance| { Ok(()) }

    fmi3UpdateDiscreteStates = UpdateDiscreteStates(
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

    fmi3EnterStepMode = EnterStepMode() |instance| { instance.enter(Stage::StepComplete) }

    fmi3GetOutputDerivatives = GetOutputDerivatives(
        valueReferences: *const c_uint, nValueReferences: size_t, orders: *const i32, value: *mut f64,
        nValues: size_t,
    ) |instance| {
        with_positions(instance, valueReferences, [nValueReferences, nValues], |instance, positions| {
            let (orders, rates) = (values("orders", orders, nValueReferences)?, room("values", value, nValues)?);
            instance.get_real_output_derivatives(positions, orders, rates)
        })
    }

    fmi3EnterContinuousTimeMode = EnterContinuousTimeMode() |instance| { instance.enter(Stage::ContinuousTimeMode) }

    /// `noSetFMUStatePriorToCurrentPoint` is ignored: FMU states are kept until the host frees them.
    fmi3CompletedIntegratorStep = CompletedIntegratorStep(
        _noSetFMUStatePriorToCurrentPoint: u8, enterEventMode: *mut u8, terminateSimulation: *mut u8,
    ) |instance| {
        complete_step(instance, enterEventMode, terminateSimulation)
    }

    fmi3SetTime = SetTime(time: f64) |instance| { instance.set_time(time) }

    fmi3SetContinuousStates = SetContinuousStates(continuousStates: *const f64, nContinuousStates: size_t) |instance| {
        let count = ("nContinuousStates", nContinuousStates);
        let needed = instance.count(|role| *role == Role::State);
        instance.set_continuous_states(read_all("continuousStates", continuousStates, count, needed)?)
    }

    fmi3GetContinuousStateDerivatives = GetContinuousStateDerivatives(
        derivatives: *mut f64, nContinuousStates: size_t,
    ) |instance| {
        write_all("derivatives", derivatives, ("nContinuousStates", nContinuousStates), instance.model.state_rates()?)
    }

    fmi3GetEventIndicators = GetEventIndicators(eventIndicators: *mut f64, nEventIndicators: size_t) |instance| {
        write_all("eventIndicators", eventIndicators, ("nEventIndicators", nEventIndicators), instance.model.indicators()?)
    }

    fmi3GetContinuousStates = GetContinuousStates(continuousStates: *mut f64, nContinuousStates: size_t) |instance| {
        let count = ("nContinuousStates", nContinuousStates);
        write_all("continuousStates", continuousStates, count, instance.model.states()?)
    }

    fmi3GetNominalsOfContinuousStates = GetNominalsOfContinuousStates(
        nominals: *mut f64, nContinuousStates: size_t,
    ) |instance| {
        write_all("nominals", nominals, ("nContinuousStates", nContinuousStates), instance.model.nominals()?)
    }

    fmi3GetNumberOfEventIndicators = GetNumberOfEventIndicators(nEventIndicators: *mut size_t) |instance| {
        write("nEventIndicators", nEventIndicators, instance.count(|role| *role == Role::Indicator))
    }

    fmi3GetNumberOfContinuousStates = GetNumberOfContinuousStates(nContinuousStates: *mut size_t) |instance| {
        write("nContinuousStates", nContinuousStates, instance.count(|role| *role == Role::State))
    }

    // Types that no variable has, and then functions that this unit does not have, which are never allowed. Arguments that are not read are
    // not declared: on all platforms that there are libraries for, the caller removes them.
    fmi3GetFloat32 = GetFloat32(_of: *const c_uint, count: size_t) |_instance| { none_of_type(count) }
    fmi3GetInt8 = GetInt8(_of: *const c_uint, count: size_t) |_instance| { none_of_type(count) }
    fmi3GetUInt8 = GetUInt8(_of: *const c_uint, count: size_t) |_instance| { none_of_type(count) }
    fmi3GetInt16 = GetInt16(_of: *const c_uint, count: size_t) |_instance| { none_of_type(count) }
    fmi3GetUInt16 = GetUInt16(_of: *const c_uint, count: size_t) |_instance| { none_of_type(count) }
    fmi3GetUInt32 = GetUInt32(_of: *const c_uint, count: size_t) |_instance| { none_of_type(count) }
    fmi3GetUInt64 = GetUInt64(_of: *const c_uint, count: size_t) |_instance| { none_of_type(count) }
    fmi3GetBinary = GetBinary(_of: *const c_uint, count: size_t) |_instance| { none_of_type(count) }
    fmi3GetClock = GetClock(_of: *const c_uint, count: size_t) |_instance| { none_of_type(count) }
    fmi3SetFloat32 = SetFloat32(_of: *const c_uint, count: size_t) |_instance| { none_of_type(count) }
    fmi3SetInt8 = SetInt8(_of: *const c_uint, count: size_t) |_instance| { none_of_type(count) }
    fmi3SetUInt8 = SetUInt8(_of: *const c_uint, count: size_t) |_instance| { none_of_type(count) }
    fmi3SetInt16 = SetInt16(_of: *const c_uint, count: size_t) |_instance| { none_of_type(count) }
    fmi3SetUInt16 = SetUInt16(_of: *const c_uint, count: size_t) |_instance| { none_of_type(count) }
    fmi3SetUInt32 = SetUInt32(_of: *const c_uint, count: size_t) |_instance| { none_of_type(count) }
    fmi3SetUInt64 = SetUInt64(_of: *const c_uint, count: size_t) |_instance| { none_of_type(count) }
    fmi3SetBinary = SetBinary(_of: *const c_uint, count: size_t) |_instance| { none_of_type(count) }
    fmi3SetClock = SetClock(_of: *const c_uint, count: size_t) |_instance| { none_of_type(count) }
    fmi3GetNumberOfVariableDependencies = GetNumberOfVariableDependencies()
    fmi3GetVariableDependencies = GetVariableDependencies()
    fmi3GetAdjointDerivative = GetAdjointDerivative()
    fmi3EnterConfigurationMode = EnterConfigurationMode()
    fmi3ExitConfigurationMode = ExitConfigurationMode()
    fmi3GetIntervalDecimal = GetIntervalDecimal()
    fmi3GetIntervalFraction = GetIntervalFraction()
    fmi3GetShiftDecimal = GetShiftDecimal()
    fmi3GetShiftFraction = GetShiftFraction()
    fmi3SetIntervalDecimal = SetIntervalDecimal()
    fmi3SetIntervalFraction = SetIntervalFraction()
    fmi3SetShiftDecimal = SetShiftDecimal()
    fmi3SetShiftFraction = SetShiftFraction()
    fmi3ActivateModelPartition = ActivateModelPartition()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::logger::Status;
    use crate::touchy::{DROPPED, PANICS, Touchy, token};
    use std::ptr;

    /// The callback reads a variable whose value panics, and tries to free the instance.
    unsafe extern "C" fn update(c: *mut c_void, _: f64, _: u8, _: u8, _: u8, _: u8, _: *mut u8, _: *mut f64) {
        unsafe {
            let c = *c.cast::<*mut c_void>();
            assert_eq!(fmi3GetFloat64::<Touchy>(c, &(PANICS + 1), 1, &mut 0.0, 1), Status::Fatal as c_int);
            fmi3FreeInstance::<Touchy>(c);
            assert_eq!(DROPPED.get(), 0);
        }
    }

    #[test]
    fn an_instance_that_broke_within_a_step_is_freed_after_it() {
        let mut c: *mut c_void = ptr::null_mut();
        let (token, environment) = (token(), (&raw mut c).cast());
        DROPPED.set(0);
        unsafe {
            let [name, token, folder] = [c"a".as_ptr(), token.as_ptr(), c"/".as_ptr()];
            let instantiate = fmi3InstantiateCoSimulation::<Touchy>;
            c = instantiate(name, token, folder, 0, 0, 0, 0, &(PANICS + 1), 1, environment, None, Some(update));
            assert_eq!(
                (
                    fmi3EnterInitializationMode::<Touchy>(c, 0, 0.0, 0.0, 0, 0.0),
                    fmi3ExitInitializationMode::<Touchy>(c)
                ),
                (0, 0)
            );
            let (mut flags, mut time) = ([0; 3], 0.0);
            let [event, end, early] = &mut flags;
            assert_eq!(fmi3DoStep::<Touchy>(c, 0.0, 0.1, 0, event, end, early, &mut time), Status::Fatal as c_int);
            fmi3FreeInstance::<Touchy>(c);
        }
        assert_eq!(DROPPED.get(), 1);
    }
}
