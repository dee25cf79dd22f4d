//! A step that is stable while the base is down goes unstable at the instant of uplift.

use crate::engine;
use crate::fixed_step::TEXTBOOK;
use crate::guards::uplift_excess;
use crate::hybrid::{self, Grid, Transitions};
use crate::response::Response;
use crate::scene::{StudyScene, ground};
use crate::tables::{PageValues, save_series, series, values};
use anyhow::{Context, Result};
use rocking::{Detail, Parameters, State, Transition};
use std::f64::consts::TAU;
use std::path::Path;

/// The step, s: for Evison's specimen ω_fc h = 0.83 and ω_u h = 2.76.
pub const STEP: f64 = 0.012;

/// How long the ground shakes, s.
const DURATION: f64 = 4.2;

/// Growth of its amplitude, in g per second, and its frequency, Hz.
const RAMP: f64 = 0.15;
const FREQUENCY: f64 = 1.5;

/// Evison's specimen from rest, on ground that sways more and more.
pub fn scene() -> StudyScene {
    let samples = (DURATION / STEP) as usize;
    let a_g = (0..=samples).map(|k| k as f64 * STEP).map(|t| RAMP * t * 9.81 * (TAU * FREQUENCY * t).sin());
    let title = "Evison's specimen, ground that sways more and more";
    StudyScene::new("uplift-trap", title, Parameters::EVISON, State::default(), ground(STEP, a_g.collect()))
}

/// The response of the textbook method number `method` with the step [`STEP`].
pub fn response(scene: &StudyScene, method: usize) -> Response {
    let grid = Grid { method: TEXTBOOK[method].method, h: STEP };
    hybrid::run(scene, &grid, Transitions::Located, uplift_excess, &mut |_, _| ())
}

/// Writes the responses into `folder`, and returns the values of the page.
pub fn save(folder: &Path) -> Result<PageValues> {
    const CENTRAL_DIFFERENCE: usize = 2;
    const NEWMARK: usize = 4;
    let scene = scene();
    let mut transitions = Vec::new();
    let exact = engine::run(&scene, Detail::Nonlinear, 1e-12, &mut |t: &Transition| transitions.push(*t));
    let uplift = transitions.first().context("the structure lifts off")?.time;
    let unstable = response(&scene, CENTRAL_DIFFERENCE);
    let failure = unstable.failure.clone().context("the central difference gets through")?;
    let u = |response: &Response| -> Vec<_> {
        let samples = response.samples.iter().enumerate();
        samples.map(|(k, sample)| ((k + 1) as f64 * STEP, 1e3 * sample.u)).collect()
    };
    let curves = [
        series("central difference, 12 ms", u(&unstable)),
        series("exact", u(&exact)),
        series("Newmark average acceleration, 12 ms", u(&response(&scene, NEWMARK))),
    ];
    save_series(&folder.join("stability-uplift.csv"), &curves)?;
    let [down, up] = [scene.structure.omega_fc, scene.structure.omega_u].map(|omega| omega * STEP);
    Ok(values([("step", &(1e3 * STEP)), ("down", &down), ("up", &up), ("uplift", &uplift), ("failure", &failure)]))
}
