//! The peers of `peers.py`: heyoka and scipy, which Python drives.

use super::{MethodCurve, PrecisionPoint, StudyLimits};
use crate::response::{MotionSample, Response, RunFailure};
use crate::scene::StudyScene;
use anyhow::{Context, Result, ensure};
use rocking::Parameters;
use serde::Deserialize;
use serde_json::json;
use std::io::Write;
use std::path::Path;
use std::process::{Command, Stdio};

/// A run of `peers.py`.
#[derive(Deserialize)]
struct PeerRun {
    method: String,
    tolerance: f64,
    seconds: f64,
    evaluations: f64,
    transitions: u64,
    failure: Option<String>,
    samples: Vec<f64>, // theta, u, a_t of each sample
}

/// The curves of the peers on `scene` against the `exact` response, by the interpreter `python`.
pub fn curves(
    scene: &StudyScene,
    exact: &Response,
    conditioning: f64,
    limits: StudyLimits,
    python: &Path,
) -> Result<Vec<MethodCurve>> {
    let &Parameters { m, m0, H, B, J0, f_fc, zeta_fc, r, c_ratio, g, .. } = scene.structure.parameters();
    let structure = json!({
        "m": m, "m0": m0, "H": H, "B": B, "J0": J0, "f_fc": f_fc, "zeta_fc": zeta_fc, "r": r, "c_ratio": c_ratio, "g": g
    });
    let input = json!({
        "structure": structure, "dt": scene.dt(), "a_g": scene.ground.acceleration(), "u": scene.initial.u,
        "theta": scene.initial.theta
    });
    let script = concat!(env!("CARGO_MANIFEST_DIR"), "/peers.py");
    let program = format!("{} {script}: `make measure WHAT=precision` installs what it needs", python.display());
    let mut child = Command::new(python)
        .arg(script)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .with_context(|| program.clone())?;
    child.stdin.take().context("it has an input")?.write_all(input.to_string().as_bytes())?;
    let output = child.wait_with_output()?;
    ensure!(output.status.success(), program);
    let runs: Vec<PeerRun> = serde_json::from_slice(&output.stdout)?;
    let curve = |runs: &[PeerRun]| {
        let mut points = Vec::new();
        for run in runs {
            let sample = |numbers: &[f64]| MotionSample { theta: numbers[0], u: numbers[1], a_t: numbers[2] };
            let samples: Vec<_> = run.samples.chunks(3).map(sample).collect();
            let failure = run.failure.clone().map(RunFailure::AsWritten);
            let (count, transitions) = (scene.intervals() as f64, run.transitions);
            let response = Response { samples, evaluations: 0, transitions, failure };
            let errors = response.errors(exact);
            let is_exact = errors.as_ref().is_ok_and(|errors| errors.theta <= conditioning);
            let (cost, evaluations) = (run.seconds / count, run.evaluations / count);
            points.push(PrecisionPoint { setting: run.tolerance, cost, evaluations, transitions, errors });
            if points.len() >= limits.points && is_exact {
                break;
            }
        }
        MethodCurve { name: runs[0].method.clone(), setting: "tolerance".into(), points }
    };
    Ok(runs.chunk_by(|a, b| a.method == b.method).map(curve).collect())
}
