//! Work-precision diagrams: error against cost, one curve per method.

mod curves;
mod peers;

use crate::engine;
use crate::response::{MotionSample, Response, RunFailure};
use crate::scene::StudyScene;
use crate::tables;
use anyhow::Result;
use cpu_time::ThreadTime;
use curves::MethodSweep;
use indicatif::ProgressBar;
use std::path::Path;
use std::time::Duration;

/// The input is scaled by 1 + this to find how well the scene is conditioned.
pub const PERTURBATION: f64 = 1e-12;

/// One method over its settings.
#[derive(Debug)]
pub struct MethodCurve {
    pub name: String,                // name on charts
    pub setting: String,             // what its setting is, with unit
    pub points: Vec<PrecisionPoint>, // from coarse to fine
}

#[derive(Debug)]
pub struct PrecisionPoint {
    pub setting: f64,                             // step in s, or tolerance
    pub cost: f64,                                // time per sample, s
    pub evaluations: f64,                         // right-hand-side evaluations per sample
    pub transitions: u64,                         // uplifts, impacts and landings
    pub errors: Result<MotionSample, RunFailure>, // against the reference, or why there are none
}

/// All curves on one scene.
#[derive(Debug)]
pub struct Diagram {
    /// How far the response moves when the input is scaled by 1 + [`PERTURBATION`].
    pub conditioning: MotionSample,
    pub curves: Vec<MethodCurve>,
}

#[derive(Clone, Copy, Debug)]
pub struct StudyLimits {
    pub run: f64,      // no finer setting after a run of this many seconds
    pub points: usize, // no fewer points than these on a curve
}

pub const FULL: StudyLimits = StudyLimits { run: 0.25, points: 5 };

/// Every curve on `scene`, those of Python's libraries by the interpreter `python`. Runs are timed: nothing else may run
/// meanwhile.
pub fn measure(
    scene: &StudyScene,
    limits: StudyLimits,
    python: Option<&Path>,
    progress: &ProgressBar,
) -> Result<Diagram> {
    let exact = engine::reference(scene);
    let conditioning = conditioning(scene, &exact)?;
    let methods = curves::methods(scene);
    progress.inc_length(methods.len() as u64);
    let mut curves = Vec::new();
    for method in methods {
        progress.set_message(format!("{}: {}", scene.title, method.name));
        let points = sweep(&method, scene, &exact, conditioning.theta, limits);
        progress.inc(1);
        curves.push(MethodCurve { name: method.name, setting: method.setting.into(), points });
    }
    if let Some(python) = python {
        curves.extend(peers::curves(scene, &exact, conditioning.theta, limits, python)?);
    }
    Ok(Diagram { conditioning, curves })
}

/// How far the response of `scene`, which is `exact`, moves when the input is scaled by 1 + [`PERTURBATION`].
fn conditioning(scene: &StudyScene, exact: &Response) -> Result<MotionSample, RunFailure> {
    engine::reference(&scene.scaled(1.0 + PERTURBATION)).errors(exact)
}

/// One method from coarse to fine, until its error in θ is as small as the conditioning or a run takes too long.
fn sweep(
    method: &MethodSweep,
    scene: &StudyScene,
    exact: &Response,
    conditioning: f64,
    limits: StudyLimits,
) -> Vec<PrecisionPoint> {
    let mut points = Vec::new();
    for (setting, run) in &method.settings {
        let (response, time) = fastest(run);
        let errors = response.errors(exact);
        let is_exact = errors.as_ref().is_ok_and(|errors| errors.theta <= conditioning);
        let samples = response.samples.len().max(1) as f64;
        points.push(PrecisionPoint {
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

/// Runs are repeated until they have taken this long, and the fastest counts.
const LEAST: Duration = Duration::from_millis(30);

const MOST_REPEATS: usize = 1000;

/// The result of `run`, and the shortest processor time, s.
fn fastest<T>(mut run: impl FnMut() -> T) -> (T, f64) {
    let began = ThreadTime::now();
    let mut best = f64::INFINITY;
    for repeat in 1.. {
        let start = ThreadTime::now();
        let result = run();
        best = best.min(start.elapsed().as_secs_f64());
        if began.elapsed() >= LEAST || repeat == MOST_REPEATS {
            return (result, best);
        }
    }
    unreachable!("the repeats end")
}

/// Measures all `scenes` and writes the runs of each into `folder`.
pub fn write(
    scenes: &[StudyScene],
    limits: StudyLimits,
    python: Option<&Path>,
    folder: &Path,
    progress: &ProgressBar,
) -> Result<()> {
    for scene in scenes {
        save(&measure(scene, limits, python, progress)?.curves, &folder.join(format!("accuracy-{}.csv", scene.key)))?;
    }
    Ok(())
}

/// Writes what the scenes are, how many transitions they have, and how they are conditioned.
pub fn write_scenes(scenes: &[StudyScene], folder: &Path) -> Result<()> {
    let row = |scene: &StudyScene| {
        let exact = engine::reference(scene);
        let MotionSample { theta, u, a_t } = conditioning(scene, &exact)?;
        let numbers = [scene.dt(), exact.transitions as f64, theta, u, a_t].map(|number| number.to_string());
        Ok([scene.key, scene.title].map(str::to_string).into_iter().chain(numbers))
    };
    let columns = "key,title,dt,transitions,theta,u,a_t";
    tables::save(&folder.join("accuracy.csv"), columns, scenes.iter().map(row).collect::<Result<Vec<_>>>()?)
}

fn save(curves: &[MethodCurve], path: &Path) -> Result<()> {
    let columns = "method,setting,value,microseconds_per_sample,evaluations_per_sample,transitions,\
                   error_theta,error_u,error_a_t,failure";
    let row = |(curve, point): (&MethodCurve, &PrecisionPoint)| {
        let error =
            |get: fn(&MotionSample) -> f64| point.errors.as_ref().map_or(String::new(), |e| format!("{:.3e}", get(e)));
        [
            curve.name.clone(),
            curve.setting.clone(),
            format!("{:.6e}", point.setting),
            format!("{:.4}", 1e6 * point.cost),
            format!("{:.3}", point.evaluations),
            point.transitions.to_string(),
            error(|e| e.theta),
            error(|e| e.u),
            error(|e| e.a_t),
            point.errors.as_ref().err().map_or(String::new(), ToString::to_string),
        ]
    };
    tables::save(
        path,
        columns,
        curves.iter().flat_map(|curve| curve.points.iter().map(move |point| row((curve, point)))),
    )
}
