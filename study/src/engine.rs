//! This project's engine.

use crate::response::{Failure, Response, Sample};
use crate::scene::{Input, Scene};
use rocking::{Detail, Engine, Motion, Progress, State, Transition};

/// The tolerance of reference responses, two orders below the tightest that is charted.
pub const REFERENCE_TOLERANCE: f64 = 1e-14;

/// The response of `scene` at the level `detail`, to `tolerance`, in communication steps of 1/`cuts` of the time
/// between samples; transitions are shown to `observe`.
pub fn run(
    scene: &Scene,
    detail: Detail,
    tolerance: f64,
    (input, cuts): (Input, usize),
    observe: &mut dyn FnMut(&Transition),
) -> Response {
    let mut initial = scene.initial;
    if detail == Detail::Rigid {
        initial = State { u: 0.0, u_dot: 0.0, ..initial };
    }
    let mut engine = match Engine::with_detail(scene.structure, initial, 0.0, tolerance, detail) {
        Ok(engine) => engine,
        Err(error) => return Response::refused(error.to_string()),
    };
    let mut samples = Vec::with_capacity(scene.intervals());
    let mut failure = None;
    for step in scene.steps(input, cuts) {
        match engine.advance(step.end, step.a_g, observe) {
            Err(error) => failure = Some(Failure::GaveUp { time: step.start, message: error.to_string() }),
            Ok(Progress::Overturned) => failure = Some(Failure::Overturned { time: engine.motion().time }),
            Ok(Progress::Complete) => (),
        }
        if failure.is_some() {
            break;
        }
        if step.ends_interval {
            samples.push(Sample::of(&engine.outputs(0.0)));
        }
    }
    let Motion { work, transitions, .. } = *engine.motion();
    Response { samples, evaluations: work.evaluations, transitions, failure }
}

/// The response against which all others are measured.
pub fn reference(scene: &Scene) -> Response {
    run(scene, Detail::Nonlinear, REFERENCE_TOLERANCE, (Input::Linear, 1), &mut |_| ())
}
