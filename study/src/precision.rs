//! Work-precision diagrams: error against cost, one curve per method.

mod curves;
mod figures;
mod page;

use crate::engine;
use crate::response::{Errors, Failure, Response};
use crate::scene::Scene;
use crate::timing;
use anyhow::Result;
use curves::Method;
use indicatif::ProgressBar;
use std::path::Path;

/// The input is scaled by 1 + this for the conditioning floor.
pub const PERTURBATION: f64 = 1e-12;

/// One method over its settings.
#[derive(Debug)]
pub struct Curve {
    /// Name on charts.
    pub name: String,
    /// What it belongs to.
    pub family: Family,
    /// What its setting is, with unit.
    pub setting: &'static str,
    /// From coarse to fine.
    pub points: Vec<Point>,
}

/// Where a curve belongs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    /// This project's engine as it is by default.
    Ours,
    /// One of its other levels of detail.
    Level,
    /// Textbook method, transitions located.
    Located,
    /// Textbook method, transitions at step ends.
    AtStepEnds,
    /// Another library's solver.
    Library,
    /// The FMU.
    Fmu,
}

/// One run.
#[derive(Debug)]
pub struct Point {
    /// Step in s, or tolerance.
    pub setting: f64,
    /// Time per sample over that of the floor.
    pub cost: f64,
    /// Right-hand-side evaluations per sample.
    pub evaluations: f64,
    /// Uplifts, impacts and landings.
    pub transitions: u64,
    /// Against the reference, or why there are none.
    pub errors: Result<Errors, Failure>,
}

/// All curves on one scene.
#[derive(Debug)]
pub struct Diagram {
    /// The scene's name in file names.
    pub key: &'static str,
    /// The scene's name on charts.
    pub title: &'static str,
    /// Time per sample of the floor, s.
    pub floor: f64,
    /// How far the response moves when the input is scaled by 1 + [`PERTURBATION`].
    pub conditioning: Errors,
    /// Transitions of the reference.
    pub transitions: u64,
    /// Time between samples, s.
    pub dt: f64,
    /// One per method.
    pub curves: Vec<Curve>,
}

/// How far a sweep goes.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    /// No finer setting after a run of this many seconds.
    pub run: f64,
    /// No fewer points than these on a curve.
    pub points: usize,
}

/// What a curve of the full study is made of.
pub const FULL: Limits = Limits { run: 0.25, points: 5 };

/// Every curve on `scene`. Runs are timed: nothing else may run meanwhile.
pub fn measure(scene: &Scene, limits: Limits, progress: &ProgressBar) -> Result<Diagram> {
    let exact = engine::reference(scene);
    let moved = engine::reference(&scene.scaled(1.0 + PERTURBATION));
    let conditioning = Errors::of(&moved, &exact)?;
    let floor = timing::floor(scene);
    let methods = curves::methods(scene)?;
    progress.inc_length(methods.len() as u64);
    let curves = methods
        .into_iter()
        .map(|method| {
            progress.set_message(format!("{}: {}", scene.title, method.name));
            let points = sweep(&method, scene, &exact, floor, conditioning.theta, limits);
            progress.inc(1);
            Curve { name: method.name, family: method.family, setting: method.setting, points }
        })
        .collect();
    let (&Scene { key, title, .. }, dt) = (scene, scene.dt());
    Ok(Diagram { key, title, floor, conditioning, transitions: exact.transitions, dt, curves })
}

/// One method from coarse to fine, until its error in θ is below what conditioning allows or a run takes too long.
fn sweep(
    method: &Method,
    scene: &Scene,
    exact: &Response,
    floor: f64,
    conditioning: f64,
    limits: Limits,
) -> Vec<Point> {
    let mut points = Vec::new();
    for setting in &method.settings {
        let (response, time) = timing::fastest(|| (setting.run)());
        let errors = Errors::of(&response, exact);
        let is_exact = errors.as_ref().is_ok_and(|errors| errors.theta <= conditioning);
        let samples = response.samples.len().max(1) as f64;
        let evaluations = setting.evaluations.as_ref().map_or(response.evaluations, |count| count());
        points.push(Point {
            setting: setting.value,
            cost: time / samples / floor,
            evaluations: evaluations as f64 / samples,
            transitions: response.transitions,
            errors,
        });
        // A run that fails ends early: what a whole one would take decides.
        let whole = time * scene.intervals() as f64 / samples;
        if points.len() >= limits.points && (is_exact || whole > limits.run) {
            break;
        }
    }
    points
}

/// Measures all `scenes` and writes `docs/accuracy.md` with its pictures and numbers.
pub fn write(scenes: &[Scene], limits: Limits, docs: &Path, progress: &ProgressBar) -> Result<()> {
    let diagrams = scenes.iter().map(|scene| measure(scene, limits, progress)).collect::<Result<Vec<_>>>()?;
    for diagram in &diagrams {
        figures::save(diagram, docs)?;
    }
    page::write(&diagrams, docs)
}
