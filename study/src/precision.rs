//! Work-precision diagrams: error against cost, one curve per method.

mod curves;
mod numbers;
mod page;
mod peers;

use crate::engine;
use crate::response::{Errors, Failure, Response};
use crate::scene::Scene;
use crate::timing;
use anyhow::{Context, Result};
use curves::Method;
use indicatif::ProgressBar;
use std::path::{Path, PathBuf};

/// The input is scaled by 1 + this to find how well the scene is conditioned.
pub const PERTURBATION: f64 = 1e-12;

/// One method over its settings.
#[derive(Debug)]
pub struct Curve {
    pub name: String, // name on charts
    pub family: Family,
    pub setting: String,    // what its setting is, with unit
    pub points: Vec<Point>, // from coarse to fine
}

/// Group of a curve on the charts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Family {
    Ours,
    Level,      // one of its other levels of detail
    Located,    // textbook method, transitions located
    AtStepEnds, // textbook method, transitions at step ends
    Library,
    Host, // this project, with an input that its host holds
}

/// One run.
#[derive(Debug)]
pub struct Point {
    pub setting: f64,                    // step in s, or tolerance
    pub cost: f64,                       // time per sample, s
    pub evaluations: f64,                // right-hand-side evaluations per sample
    pub transitions: u64,                // uplifts, impacts and landings
    pub errors: Result<Errors, Failure>, // against the reference, or why there are none
}

/// All curves on one scene.
#[derive(Debug)]
pub struct Diagram {
    pub key: &'static str,
    pub title: &'static str,
    /// How far the response moves when the input is scaled by 1 + [`PERTURBATION`].
    pub conditioning: Errors,
    pub transitions: u64, // transitions of the reference
    pub dt: f64,          // time between samples, s
    pub curves: Vec<Curve>,
}

impl Diagram {
    fn new(scene: &Scene, conditioning: Errors, transitions: u64, curves: Vec<Curve>) -> Diagram {
        Diagram { key: scene.key, title: scene.title, conditioning, transitions, dt: scene.dt(), curves }
    }
}

/// How far a sweep goes.
#[derive(Clone, Copy, Debug)]
pub struct Limits {
    pub run: f64,      // no finer setting after a run of this many seconds
    pub points: usize, // no fewer points than these on a curve
}

/// Limits of the full study.
pub const FULL: Limits = Limits { run: 0.25, points: 5 };

/// Every curve on `scene`, those of Python's libraries by the interpreter `python`. Runs are timed: nothing else may run
/// meanwhile.
pub fn measure(scene: &Scene, limits: Limits, python: Option<&Path>, progress: &ProgressBar) -> Result<Diagram> {
    let exact = engine::reference(scene);
    let conditioning = conditioning(scene, &exact)?;
    let methods = curves::methods(scene);
    progress.inc_length(methods.len() as u64);
    let curves = methods
        .into_iter()
        .map(|method| {
            progress.set_message(format!("{}: {}", scene.title, method.name));
            let points = sweep(&method, scene, &exact, conditioning.theta, limits);
            progress.inc(1);
            Curve { name: method.name, family: method.family, setting: method.setting.into(), points }
        })
        .collect::<Vec<_>>();
    let peers = python.map(|python| peers::curves(scene, &exact, conditioning.theta, limits, python));
    let curves = curves.into_iter().chain(peers.transpose()?.unwrap_or_default()).collect();
    Ok(Diagram::new(scene, conditioning, exact.transitions, curves))
}

/// How far the response of `scene`, which is `exact`, moves when the input is scaled by 1 + [`PERTURBATION`].
fn conditioning(scene: &Scene, exact: &Response) -> Result<Errors, Failure> {
    Errors::of(&engine::reference(&scene.scaled(1.0 + PERTURBATION)), exact)
}

/// One method from coarse to fine, until its error in θ is as small as the conditioning or a run takes too long.
fn sweep(method: &Method, scene: &Scene, exact: &Response, conditioning: f64, limits: Limits) -> Vec<Point> {
    let mut points = Vec::new();
    for (setting, run) in &method.settings {
        let (response, time) = timing::fastest(run);
        let errors = Errors::of(&response, exact);
        let is_exact = errors.as_ref().is_ok_and(|errors| errors.theta <= conditioning);
        let samples = response.samples.len().max(1) as f64;
        points.push(Point {
            setting: *setting,
            cost: time / samples,
            evaluations: response.evaluations as f64 / samples,
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

/// Measures all `scenes` and writes `accuracy.md`, with its pictures and numbers, into `docs`.
pub fn write(
    scenes: &[Scene],
    limits: Limits,
    python: Option<&Path>,
    docs: &Path,
    progress: &ProgressBar,
) -> Result<()> {
    for scene in scenes {
        numbers::save(&measure(scene, limits, python, progress)?.curves, &file(scene, docs))?;
    }
    report(scenes, docs, &crate::page::made("precision")?)
}

/// Writes the page as [`write`] does, from the numbers that are in `docs`; its last line stays.
pub fn write_again(scenes: &[Scene], docs: &Path) -> Result<()> {
    let page = std::fs::read_to_string(docs.join("accuracy.md"))?;
    report(scenes, docs, page.lines().last().context("accuracy.md is empty")?)
}

fn report(scenes: &[Scene], docs: &Path, made: &str) -> Result<()> {
    let diagram = |scene: &Scene| {
        let exact = engine::reference(scene);
        let curves = numbers::read(scene, &file(scene, docs))?;
        Ok(Diagram::new(scene, conditioning(scene, &exact)?, exact.transitions, curves))
    };
    page::write(&scenes.iter().map(diagram).collect::<Result<Vec<_>>>()?, docs, made)
}

/// The numbers of `scene`.
fn file(scene: &Scene, docs: &Path) -> PathBuf {
    docs.join(format!("accuracy-{}.csv", scene.key))
}
