//! `accuracy-*.csv`: the curves of a scene as numbers. The page is made from these files.

use super::{Curve, Family, Point, curves};
use crate::response::{Errors, Failure};
use crate::scene::Scene;
use anyhow::{Context, Result};
use serde::Deserialize;
use std::path::Path;

/// One run.
#[derive(Deserialize)]
struct Row {
    method: String,
    setting: String,
    value: f64,
    microseconds_per_sample: f64,
    evaluations_per_sample: f64,
    transitions: u64,
    error_theta: Option<f64>,
    error_u: Option<f64>,
    error_a_t: Option<f64>,
    failure: String,
}

/// Writes `curves` to `path`.
pub fn save(curves: &[Curve], path: &Path) -> Result<()> {
    let mut csv = csv::Writer::from_path(path)?;
    csv.write_record([
        "method",
        "setting",
        "value",
        "microseconds_per_sample",
        "evaluations_per_sample",
        "transitions",
        "error_theta",
        "error_u",
        "error_a_t",
        "failure",
    ])?;
    for (curve, point) in curves.iter().flat_map(|curve| curve.points.iter().map(move |point| (curve, point))) {
        let error =
            |get: fn(&Errors) -> f64| point.errors.as_ref().map_or(String::new(), |e| format!("{:.3e}", get(e)));
        csv.write_record([
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
        ])?;
    }
    Ok(csv.flush()?)
}

/// The curves on `scene` that [`save`] wrote to `path`.
pub fn read(scene: &Scene, path: &Path) -> Result<Vec<Curve>> {
    let mut csv = csv::Reader::from_path(path).with_context(|| path.display().to_string())?;
    let rows = csv.deserialize().collect::<Result<Vec<Row>, _>>().with_context(|| path.display().to_string())?;
    let methods = curves::methods(scene);
    let curve = |rows: &[Row]| {
        let Row { method, setting, .. } = &rows[0];
        // what is not a method of this program is a peer, which Python drives
        let family = methods.iter().find(|other| other.name == *method).map_or(Family::Library, |method| method.family);
        Curve { name: method.clone(), family, setting: setting.clone(), points: rows.iter().map(point).collect() }
    };
    Ok(rows.chunk_by(|a, b| a.method == b.method).map(curve).collect())
}

fn point(row: &Row) -> Point {
    let errors = row.error_theta.zip(row.error_u).zip(row.error_a_t).map(|((theta, u), a_t)| Errors { theta, u, a_t });
    Point {
        setting: row.value,
        cost: 1e-6 * row.microseconds_per_sample,
        evaluations: row.evaluations_per_sample,
        transitions: row.transitions,
        errors: errors.ok_or_else(|| Failure::AsWritten(row.failure.clone())),
    }
}
