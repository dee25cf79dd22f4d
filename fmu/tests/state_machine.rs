//! Which call is allowed when, and what a refused call leaves behind: nothing.
#![allow(unsafe_code)]

mod calls;
mod host;

use FlexibleRocking::state_machine::Stage;
use calls::fmi2::Fmi2;
use calls::{C, Messages, check};
use host::*;

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

/// The table of FMI 2.0.4, section 3.2.3, for a model: instantiated, initialization mode, event mode, continuous-time
/// mode, terminated, error. Marks are as above (4: inputs and parameters that are tunable, 5: inputs and states, 9:
/// since 2.0.1 for models without continuous states alone, before for all).
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

fn look(host: &Host) -> (C, Messages) {
    (host.component, host.log.take().into_iter().map(|message| (message.status, message.text)).collect())
}

#[test]
fn a_call_of_a_slave_is_allowed_where_the_standard_says_so() {
    check::<Fmi2, _>(STANDARD, &OF_SLAVE, Stage::StepComplete, slave_in, look);
}

#[test]
fn a_call_of_a_model_is_allowed_where_the_standard_says_so() {
    check::<Fmi2, _>(STANDARD_OF_MODEL, &STAGES_OF_MODEL, Stage::EventMode, model_in, look);
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
