//! Exact histories for the pictures.

use crate::engine;
use crate::scene::{Input, Scene};
use anyhow::{Result, ensure};
use rocking::{Detail, Parameters, State, Structure, Transition, TransitionKind};

/// A response over time, and its transitions.
pub struct History {
    /// (t, θ), s and rad.
    pub theta: Vec<(f64, f64)>,
    /// (t, u), s and m.
    pub u: Vec<(f64, f64)>,
    /// All of them, in order.
    pub transitions: Vec<Transition>,
}

/// A structure of parameters that are known to be in range.
pub fn structure(parameters: Parameters) -> Structure {
    Structure::new(parameters).expect("the study's own parameters are in range")
}

/// A structure on ground at rest, with `samples` results over `duration` (s).
pub fn at_rest(parameters: Parameters, initial: State, duration: f64, samples: usize) -> Scene {
    Scene {
        key: "at-rest",
        title: "ground at rest",
        structure: structure(parameters),
        initial,
        dt: duration / samples as f64,
        a_g: vec![0.0; samples + 1],
    }
}

/// The exact response at the level `detail`, to its end.
pub fn exact(scene: &Scene, detail: Detail) -> Result<History> {
    let mut transitions = Vec::new();
    let response = engine::run(scene, detail, engine::REFERENCE_TOLERANCE, (Input::Linear, 1), &mut |transition| {
        transitions.push(*transition);
    });
    let ends = |k: usize| (k + 1) as f64 * scene.dt;
    let over_time = |get: fn(&crate::response::Sample) -> f64| {
        response.samples.iter().enumerate().map(|(k, sample)| (ends(k), get(sample))).collect()
    };
    ensure!(response.failure.is_none(), "the exact response fails: {:?}", response.failure);
    Ok(History { theta: over_time(|s| s.theta), u: over_time(|s| s.u), transitions })
}

/// What is visible of `points` between two instants, with the axes' units: x − `origin` in units of `x_unit`, y in
/// units of `y_unit`.
pub fn window(
    points: &[(f64, f64)],
    (from, to): (f64, f64),
    (origin, x_unit, y_unit): (f64, f64, f64),
) -> Vec<(f64, f64)> {
    let visible = points.iter().filter(|(t, _)| (from..=to).contains(t));
    visible.map(|(t, y)| ((t - origin) / x_unit, y / y_unit)).collect()
}

/// Whether a transition is an impact with which rocking goes on.
pub fn is_impact(transition: &Transition) -> bool {
    matches!(transition.kind, TransitionKind::Impact(_))
}
