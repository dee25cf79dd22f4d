//! The speed table: cost per record sample over the floor, of McManus's specimen under El Centro 1940.

use crate::engine;
use crate::fmu::Fmu;
use crate::precision::{self, Family};
use crate::response::Errors;
use crate::scene::Scene;
use crate::timing;
use anyhow::Result;
use indicatif::ProgressBar;
use minijinja::{Value, context};
use rocking::Detail;
use rocking::engine::DEFAULT_TOLERANCE;
use std::path::Path;

/// Time per sample, s, of the engine at `detail` to `tolerance`: from sample to sample, nothing else.
fn engine_time(scene: &Scene, detail: Detail, tolerance: f64) -> f64 {
    let run = scene.run(detail, tolerance);
    let (_, time) = timing::fastest(|| run.follow(&mut ()).expect("the scene has an answer"));
    time / scene.intervals() as f64
}

/// The least time per sample, s, at which `auto` has an error in θ of at most `error`, and the tolerance that has it.
fn auto_time(scene: &Scene, error: f64) -> (f64, f64) {
    let exact = engine::reference(scene);
    let tolerances = (12..=26).map(|k| 10f64.powf(-0.5 * f64::from(k))); // looser ones than 1e-6 are as 1e-6
    let good = tolerances.filter(|&tolerance| {
        let response = engine::run(scene, Detail::Auto, tolerance, &mut ());
        Errors::of(&response, &exact).is_ok_and(|errors| errors.theta <= error)
    });
    good.map(|tolerance| (engine_time(scene, Detail::Auto, tolerance), tolerance))
        .min_by(|a, b| a.0.total_cmp(&b.0))
        .expect("the tightest tolerance is good enough")
}

/// All rows on `scene`. Runs are timed: nothing else may run meanwhile.
fn measure(scene: &Scene, limits: precision::Limits, progress: &ProgressBar) -> Result<Vec<Value>> {
    let floor = timing::floor(scene);
    let mut rows = Vec::new();
    let mut row = |engine: String, target: String, measured: String, is_met: bool| {
        rows.push(context! { engine, target, measured, met => if is_met { "yes" } else { "no" } });
    };
    let mut in_floors = |engine: String, target: f64, time: f64| {
        let measured = format!("{:.1} × floor ({:.0} ns)", time / floor, time * 1e9);
        row(engine, format!("≤ {target} × floor"), measured, time <= target * floor);
    };
    in_floors("`linear`, tolerance 1e-9".into(), 12.0, engine_time(scene, Detail::Linear, DEFAULT_TOLERANCE));
    let mut ours = Vec::new();
    for (error, target) in [(1e-6, 32.0), (1e-9, 45.0)] {
        let (time, tolerance) = auto_time(scene, error);
        in_floors(format!("`auto` at error {error:.0e} (tolerance {tolerance:.0e})"), target, time);
        ours.push((error, time / floor));
    }
    let fmu = Fmu::new(scene)?;
    let (done, with_fmi) = timing::fastest(|| fmu.run());
    done?;
    let (_, without) = timing::fastest(|| engine::run(scene, Detail::Auto, DEFAULT_TOLERANCE, &mut ()));
    in_floors("what the FMI layer adds to a step".into(), 10.0, (with_fmi - without) / scene.intervals() as f64);

    let diagram = precision::measure(scene, limits, progress)?;
    for (error, our_cost) in ours {
        let of_libraries = diagram.curves.iter().filter(|curve| curve.family == Family::Library);
        let good = of_libraries.flat_map(|curve| {
            let points = curve.points.iter().filter(|point| point.errors.as_ref().is_ok_and(|e| e.theta <= error));
            points.map(|point| (point.cost, curve.name.as_str()))
        });
        let best = good.min_by(|a, b| a.0.total_cmp(&b.0));
        let measured = match best {
            Some((cost, name)) => format!("{:.1} × faster ({name}: {cost:.0} × floor)", cost / our_cost),
            None => "no other library gets there".into(),
        };
        let engine = format!("`auto` against the best other library at error {error:.0e}");
        row(engine, "≥ 5 × faster".into(), measured, best.is_none_or(|(cost, _)| cost >= 5.0 * our_cost));
    }
    Ok(rows)
}

/// Measures and writes `docs/evidence/speed.md`.
pub fn write(scene: &Scene, limits: precision::Limits, docs: &Path, progress: &ProgressBar) -> Result<()> {
    let rows = measure(scene, limits, progress)?;
    crate::page::write(docs, "speed", include_str!("../pages/speed.md"), context! { rows })
}
