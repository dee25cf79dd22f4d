//! Which call is allowed when, and what a refused call leaves behind: nothing.
#![allow(unsafe_code)]

mod host;

use FlexibleRocking::c_abi::Function as _;
use FlexibleRocking::fmi2::*;
use FlexibleRocking::state_machine::Stage;
use host::*;
use std::ptr::{null, null_mut};

/// The table of FMI 2.0.4, section 4.2.4, without the columns of a step in progress or canceled, which a slave with
/// synchronous steps never sees: instantiated, initialization mode, step complete, step failed, terminated, error. x:
/// allowed; a number: allowed for some variables only (1 start values, 2 outputs, 3 start values and inputs, 6 inputs),
/// or its values are good for debugging only (7, 8).
const STANDARD: &str = "
    SetDebugLogging           x x x x x x
    SetupExperiment           x - - - - -
    EnterInitializationMode   x - - - - -
    ExitInitializationMode    - x - - - -
    Terminate                 - - x x - -
    Reset                     x x x x x x
    GetReal                   - 2 x 8 x 7
    GetInteger                - 2 x 8 x 7
    GetBoolean                - 2 x 8 x 7
    GetString                 - 2 x 8 x 7
    SetReal                   1 3 6 - - -
    SetInteger                1 3 6 - - -
    SetBoolean                1 3 6 - - -
    SetString                 1 3 6 - - -
    GetFMUstate               x x x 8 x 7
    SetFMUstate               x x x x x x
    FreeFMUstate              x x x x x x
    SerializedFMUstateSize    x x x x x x
    SerializeFMUstate         x x x x x x
    DeSerializeFMUstate       x x x x x x
    GetDirectionalDerivative  - x x 8 x 7
    SetRealInputDerivatives   x x x - - -
    GetRealOutputDerivatives  - - x 8 x 7
    DoStep                    - - x - - -
    CancelStep                - - - - - -
    GetStatus                 - - x x x -
    GetRealStatus             - - x x x -
    GetIntegerStatus          - - x x x -
    GetBooleanStatus          - - x x x -
    GetStringStatus           - - x x x -
";

/// The stages of a slave.
const OF_SLAVE: [Stage; 6] = [
    Stage::Instantiated,
    Stage::InitializationMode,
    Stage::StepComplete,
    Stage::StepFailed,
    Stage::Terminated,
    Stage::Error,
];

/// The table of FMI 2.0.4, section 3.2.3, for a model: instantiated, initialization mode, event mode, continuous-time mode,
/// terminated, error. Marks are as above (4: inputs and parameters that are tunable, 5: inputs and states, 9: since 2.0.1 for models
/// without continuous states alone, before for all).
const STANDARD_OF_MODEL: &str = "
    SetDebugLogging               x x x x x x
    SetupExperiment               x - - - - -
    EnterInitializationMode       x - - - - -
    ExitInitializationMode        - x - - - -
    Terminate                     - - x x - -
    Reset                         x x x x x x
    GetReal                       - 2 x x x 7
    GetInteger                    - 2 x x x 7
    GetBoolean                    - 2 x x x 7
    GetString                     - 2 x x x 7
    SetReal                       1 3 4 5 - -
    SetInteger                    1 3 4 - - -
    SetBoolean                    1 3 4 - - -
    SetString                     1 3 4 - - -
    GetFMUstate                   x x x x x 7
    SetFMUstate                   x x x x x x
    FreeFMUstate                  x x x x x x
    SerializedFMUstateSize        x x x x x x
    SerializeFMUstate             x x x x x x
    DeSerializeFMUstate           x x x x x x
    GetDirectionalDerivative      - x x x x 7
    EnterEventMode                - - x x - -
    NewDiscreteStates             - - x - - -
    EnterContinuousTimeMode       - - x - - -
    CompletedIntegratorStep       - - - x - -
    SetTime                       - - 9 x - -
    SetContinuousStates           - - - x - -
    GetDerivatives                - x x x x 7
    GetEventIndicators            - x x x x 7
    GetContinuousStates           - x x x x 7
    GetNominalsOfContinuousStates x x x x x 7
";

/// Every function with those of `stages` that `table`, which has them as columns, allows it in; what is not in it is of the
/// other interface.
fn standard(table: &str, stages: [Stage; 6]) -> Vec<(Function, Vec<Stage>)> {
    let rows: Vec<_> = table.trim().lines().map(|row| row.split_whitespace().collect::<Vec<_>>()).collect();
    let names: Vec<_> = Function::ALL.iter().map(|function| function.name()).collect();
    assert!(rows.iter().all(|row| names.contains(&&*format!("fmi2{}", row[0]))));
    let allowed = |function: &Function| {
        let row = rows.iter().find(|row| format!("fmi2{}", row[0]) == function.name());
        let marks = row.map_or(&[] as &[&str], |row| &row[1..]);
        stages.into_iter().zip(marks).filter(|(_, mark)| **mark != "-").map(|(stage, _)| stage).collect()
    };
    Function::ALL.iter().map(|function| (*function, allowed(function))).collect()
}

/// A slave in `stage`.
fn slave_in(stage: Stage) -> Host {
    match stage {
        Stage::InitializationMode => Host::initializing(&[]),
        Stage::StepComplete => Host::started(&[]),
        Stage::StepFailed => overturned(),
        Stage::Terminated => {
            let host = Host::started(&[]);
            assert_eq!(host.terminate(), OK);
            host
        }
        Stage::Error => stuck(),
        _ => Host::new(),
    }
}

/// A model in `stage`.
fn model_in(stage: Stage) -> Host {
    match stage {
        Stage::InitializationMode => Host::new_model().initialized(&[]),
        Stage::EventMode => Host::started_model(&[]),
        Stage::ContinuousTimeMode => Host::going_model(&[]),
        Stage::Terminated => {
            let host = Host::started_model(&[]);
            assert_eq!(host.terminate(), OK);
            host
        }
        Stage::Error => {
            let host = Host::going_model(&ABOVE_THE_PIVOT);
            assert_eq!((host.set_time(0.1), host.complete()), (OK, Err(ERROR)));
            host
        }
        _ => Host::new_model(),
    }
}

/// The stage of `host`, which the refusal of a function that is never allowed tells.
fn stage(host: &Host) -> Stage {
    let told = || host.log.borrow().last().unwrap().text.clone();
    assert_eq!(unsafe { fmi2CancelStep(host.component) }, ERROR);
    let refusal = |stage: &Stage| format!("fmi2CancelStep: not allowed in the state \"{stage}\"; allowed in: none");
    Stage::ALL.into_iter().find(|stage| refusal(stage) == told()).unwrap_or_else(|| panic!("{}", told()))
}

/// The top mass above the pivot of a foundation without inertia: the equations of motion are singular.
const ABOVE_THE_PIVOT: [(&str, f64); 4] = [("m0", 0.0), ("J0", 0.0), ("theta_0", 0.1), ("u_0", 0.285)];

fn stuck() -> Host {
    let host = Host::started(&ABOVE_THE_PIVOT);
    assert_eq!(host.step(0.0, 0.1), ERROR);
    host
}

fn overturned() -> Host {
    let host = Host::started(&[("theta_0", 1.5), ("theta_dot_0", 1.0)]);
    assert_eq!(host.step(0.0, 1.0), DISCARD);
    host
}

/// Calls every function with arguments that are of no use, but harmless where it is allowed.
fn call(host: &Host, function: Function) -> i32 {
    let c = host.component;
    unsafe {
        match function {
            Function::SetDebugLogging => fmi2SetDebugLogging(c, 0, 0, null()),
            Function::SetupExperiment => host.setup(None, 0.0, None),
            Function::EnterInitializationMode => host.enter(),
            Function::ExitInitializationMode => host.exit(),
            Function::Terminate => host.terminate(),
            Function::Reset => host.reset(),
            Function::GetReal => fmi2GetReal(c, null(), 0, null_mut()),
            Function::GetInteger => fmi2GetInteger(c, null(), 0, null_mut()),
            Function::GetBoolean => fmi2GetBoolean(c, null(), 0, null_mut()),
            Function::GetString => fmi2GetString(c, null(), 0, null_mut()),
            Function::SetReal => fmi2SetReal(c, null(), 0, null()),
            Function::SetInteger => fmi2SetInteger(c, null(), 0, null()),
            Function::SetBoolean => fmi2SetBoolean(c, null(), 0, null()),
            Function::SetString => fmi2SetString(c, null(), 0, null()),
            Function::GetFMUstate => host.try_keep(null_mut()).map_or_else(|status| status, |_| OK),
            Function::SetFMUstate => host.go_back(host.keep()),
            Function::FreeFMUstate => fmi2FreeFMUstate(c, null_mut()),
            Function::SerializedFMUstateSize => host.size(host.keep()).map_or_else(|status| status, |_| OK),
            Function::SerializeFMUstate => {
                let state = host.keep();
                host.serialize(state, host.size(state).unwrap()).map_or_else(|status| status, |_| OK)
            }
            Function::DeSerializeFMUstate => host.deserialize(&host.bytes()).map_or_else(|status| status, |_| OK),
            Function::GetDirectionalDerivative => {
                fmi2GetDirectionalDerivative(c, null(), 0, null(), 0, null(), null_mut())
            }
            Function::SetRealInputDerivatives => fmi2SetRealInputDerivatives(c, null(), 0, null(), null()),
            Function::GetRealOutputDerivatives => fmi2GetRealOutputDerivatives(c, null(), 0, null(), null_mut()),
            Function::DoStep => host.step(0.0, 1e-3),
            Function::CancelStep => fmi2CancelStep(c),
            Function::GetStatus => fmi2GetStatus(c, 0, null_mut()),
            Function::GetRealStatus => fmi2GetRealStatus(c, 2, &mut 0.0),
            Function::GetIntegerStatus => fmi2GetIntegerStatus(c, 0, null_mut()),
            Function::GetBooleanStatus => fmi2GetBooleanStatus(c, 3, &mut 0),
            Function::GetStringStatus => fmi2GetStringStatus(c, 1, null_mut()),
            Function::EnterEventMode => host.enter_event_mode(),
            Function::NewDiscreteStates => host.update().map_or_else(|status| status, |_| OK),
            Function::EnterContinuousTimeMode => host.go_on(),
            Function::CompletedIntegratorStep => host.complete().map_or_else(|status| status, |_| OK),
            Function::SetTime => host.set_time(0.0),
            Function::SetContinuousStates => host.set_states([0.0; 4]),
            Function::GetDerivatives => host.derivatives().map_or_else(|status| status, |_| OK),
            Function::GetEventIndicators => host.indicators().map_or_else(|status| status, |_| OK),
            Function::GetContinuousStates => host.states().map_or_else(|status| status, |_| OK),
            Function::GetNominalsOfContinuousStates => host.nominals().map_or_else(|status| status, |_| OK),
        }
    }
}

/// What an allowed call of [`call`] returns and where it leads.
fn outcome(function: Function, stage: Stage, first: Stage) -> (i32, Stage) {
    match function {
        // where the equations are singular
        Function::GetDerivatives if stage == Stage::Error => (DISCARD, stage),
        Function::EnterEventMode => (OK, Stage::EventMode),
        Function::EnterContinuousTimeMode => (OK, Stage::ContinuousTimeMode),
        Function::EnterInitializationMode => (OK, Stage::InitializationMode),
        Function::ExitInitializationMode => (OK, first),
        Function::Terminate => (OK, Stage::Terminated),
        Function::Reset => (OK, Stage::Instantiated),
        Function::GetStatus | Function::GetIntegerStatus | Function::GetStringStatus => (DISCARD, stage),
        _ => (OK, stage),
    }
}

/// Every function in every stage, reached directly and by a reset: as the standard allows it.
fn check(table: &str, stages: [Stage; 6], host_in: fn(Stage) -> Host, first: Stage) {
    for (function, allowed) in standard(table, stages) {
        let refusal = |stage: Stage| {
            let names: Vec<_> = allowed.iter().map(Stage::to_string).collect();
            let names = if names.is_empty() { "none".to_owned() } else { names.join(", ") };
            format!("{}: not allowed in the state \"{stage}\"; allowed in: {names}", function.name())
        };
        for from in stages {
            let reset = host_in(from);
            assert_eq!(reset.reset(), OK);
            for (host, now) in [(host_in(from), from), (reset, Stage::Instantiated)] {
                assert_eq!(stage(&host), now);
                if allowed.contains(&now) {
                    host.log.borrow_mut().clear();
                    let status = call(&host, function);
                    let log = host.log.take();
                    assert_eq!(
                        (status, stage(&host)),
                        outcome(function, now, first),
                        "{} in {now}: {log:?}",
                        function.name()
                    );
                    assert_eq!(log.len(), usize::from(status != OK), "{log:?}");
                } else {
                    host.assert_refused(|| call(&host, function), ERROR, &refusal(now));
                }
            }
        }
    }
}

#[test]
fn a_call_of_a_slave_is_allowed_where_the_standard_says_so() {
    check(STANDARD, OF_SLAVE, slave_in, Stage::StepComplete);
}

#[test]
fn a_call_of_a_model_is_allowed_where_the_standard_says_so() {
    check(STANDARD_OF_MODEL, STAGES_OF_MODEL, model_in, Stage::EventMode);
}

/// An instance that cannot go on gives its values, goes back to a state kept before, and can be reset.
#[test]
fn an_error_can_be_looked_at_and_left() {
    let host = Host::started(&[("m0", 0.0), ("J0", 0.0), ("theta_0", 0.1), ("u_0", 0.285)]);
    let state = host.keep();
    let before = host.bytes();
    assert_eq!(host.step(0.0, 0.1), ERROR);
    assert!(host.log.take()[0].text.starts_with("fmi2DoStep: the motion cannot be continued beyond t = 0 s"));
    assert_eq!((host.get("theta"), host.get("u")), (0.1, 0.285));
    assert_eq!(host.go_back(state), OK);
    assert_eq!(host.bytes(), before);
    assert_eq!(host.step(0.0, 0.1), ERROR);
    assert_eq!(host.reset(), OK);
    assert_eq!(host.bytes(), Host::new().bytes());
}

#[test]
fn a_reset_instance_is_a_new_one() {
    let host = Host::started(&[("m", 200.0), ("theta_0", 0.05)]);
    assert_eq!(host.set(&[("a_g", 3.0)]), OK);
    assert_eq!(host.step(0.0, 0.5), OK);
    assert_eq!(host.reset(), OK);
    assert_eq!(host.bytes(), Host::new().bytes());
    assert_eq!(host.enter(), OK);
    assert_eq!(host.try_get(&["m", "theta_0", "a_g", "theta"]).unwrap(), [125.8, 0.0, 0.0, 0.0]);
}
