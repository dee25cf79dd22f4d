//! This project's engine.

use crate::response::{MotionSample, Response, RunFailure};
use crate::scene::StudyScene;
use rocking::engine::DEFAULT_TOLERANCE;
use rocking::run::{Ending, Finish};
use rocking::{Detail, Engine, Load, Motion, Ramp, Watch};

/// The tolerance of reference responses, two orders below the tightest that is charted.
pub const REFERENCE_TOLERANCE: f64 = 1e-14;

/// The response of `scene` at the level `detail`, to `tolerance`; pieces and transitions are shown to `watch`.
pub fn run(scene: &StudyScene, detail: Detail, tolerance: f64, watch: &mut impl Watch) -> Response {
    let mut samples = Vec::with_capacity(scene.intervals());
    let times = scene.ground.times()[1..].iter().copied();
    let show = |sample: &rocking::Sample| samples.push(MotionSample::of(sample.outputs()));
    match scene.run(detail, tolerance).sample(times, show, watch) {
        Ok(Finish { ending, motion }) => {
            let failure = (ending == Ending::Overturned).then_some(RunFailure::Overturned { time: motion.time });
            Response { samples, evaluations: motion.work.evaluations, transitions: motion.transitions, failure }
        }
        Err(error) => {
            let failure = RunFailure::GaveUp { time: samples.len() as f64 * scene.dt(), message: error.to_string() };
            Response { samples, evaluations: 0, transitions: 0, failure: Some(failure) }
        }
    }
}

/// The response of `auto` at the default tolerance where a host holds the ground acceleration over communication steps,
/// `cuts` to a sample.
pub fn held(scene: &StudyScene, cuts: usize) -> Response {
    let mut engine = Engine::new(scene.structure, scene.initial, 0.0, DEFAULT_TOLERANCE).expect("the scene can start");
    let h = scene.dt() / cuts as f64;
    let sample = |k: usize| {
        for j in 0..cuts {
            let a_g = Ramp { value: scene.ramp(k).at(j as f64 * h), slope: 0.0 };
            engine.advance(h, a_g, &mut ()).expect("the scene has an answer");
        }
        MotionSample::of(engine.outputs(Load::default()))
    };
    let samples = (0..scene.intervals()).map(sample).collect();
    let &Motion { work, transitions, .. } = engine.motion();
    Response { samples, evaluations: work.evaluations, transitions, failure: None }
}

/// The response against which all others are measured.
pub fn reference(scene: &StudyScene) -> Response {
    run(scene, Detail::Nonlinear, REFERENCE_TOLERANCE, &mut ())
}
