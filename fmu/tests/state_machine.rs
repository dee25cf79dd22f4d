//! Which call is allowed when, and what a refused call leaves behind: nothing.
#![allow(unsafe_code)]

mod host;

use FlexibleRocking::c_abi::*;
use FlexibleRocking::state_machine::{Function, Stage};
use host::*;
use std::ptr::{null, null_mut};

const STAGES: [Stage; 6] = [
    Stage::Instantiated,
    Stage::InitializationMode,
    Stage::StepComplete,
    Stage::StepFailed,
    Stage::Terminated,
    Stage::Error,
];

/// An instance in `stage`.
fn host_in(stage: Stage) -> Host {
    match stage {
        Stage::Instantiated => Host::new(),
        Stage::InitializationMode => Host::initializing(&[]),
        Stage::StepComplete => Host::started(&[]),
        Stage::StepFailed => overturned(),
        Stage::Terminated => {
            let host = Host::started(&[]);
            assert_eq!(host.terminate(), OK);
            host
        }
        Stage::Error => stuck(),
    }
}

/// The top mass above the pivot of a foundation without inertia: the equations of motion are singular.
fn stuck() -> Host {
    let host = Host::started(&[("m0", 0.0), ("J0", 0.0), ("theta_0", 0.1), ("u_0", 0.285)]);
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
        }
    }
}

#[test]
fn a_call_is_refused_exactly_where_the_table_says_so() {
    for stage in STAGES {
        for &function in Function::ALL {
            let host = host_in(stage);
            if function.is_allowed_in(stage) {
                host.log.borrow_mut().clear();
                let status = call(&host, function);
                let messages = host.log.take();
                assert!(messages.iter().all(|m| !m.text.contains("not allowed")), "{stage} {messages:?}");
                let answers = !matches!(
                    function,
                    Function::GetDirectionalDerivative
                        | Function::GetStatus
                        | Function::GetIntegerStatus
                        | Function::GetStringStatus
                );
                assert_eq!(status == OK, answers, "{} in {stage}: {messages:?}", function.name());
            } else {
                let message = format!(
                    "{}: not allowed in the state \"{stage}\"; allowed in: {}",
                    function.name(),
                    function.stages()
                );
                host.assert_refused(|| call(&host, function), ERROR, &message);
            }
        }
    }
}

/// FMI 2.0.4, section 4.2.4: what of the table matters most to hosts.
#[test]
fn the_table_is_the_standards() {
    use Function::*;
    let stages =
        |function: Function| STAGES.iter().filter(|stage| function.is_allowed_in(**stage)).copied().collect::<Vec<_>>();
    for function in [SetupExperiment, EnterInitializationMode] {
        assert_eq!(stages(function), [Stage::Instantiated]);
    }
    assert_eq!(stages(ExitInitializationMode), [Stage::InitializationMode]);
    assert_eq!(stages(DoStep), [Stage::StepComplete]);
    assert_eq!(stages(CancelStep), []);
    assert_eq!(stages(Terminate), [Stage::StepComplete, Stage::StepFailed]);
    for function in [SetReal, SetInteger, SetBoolean, SetString, SetRealInputDerivatives] {
        assert_eq!(stages(function), [Stage::Instantiated, Stage::InitializationMode, Stage::StepComplete]);
    }
    for function in [GetReal, GetInteger, GetBoolean, GetString, GetDirectionalDerivative] {
        assert_eq!(stages(function), STAGES[1..]);
    }
    assert_eq!(stages(GetRealOutputDerivatives), STAGES[2..]);
    for function in [GetStatus, GetRealStatus, GetIntegerStatus, GetBooleanStatus, GetStringStatus] {
        assert_eq!(stages(function), STAGES[2..5]);
    }
    for function in [Reset, SetDebugLogging, GetFMUstate, SetFMUstate, FreeFMUstate, DeSerializeFMUstate] {
        assert_eq!(stages(function), STAGES);
    }
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
