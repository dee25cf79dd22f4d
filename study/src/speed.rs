//! The speed table: cost per record sample over the floor, of McManus's specimen under El Centro 1940.

use crate::engine;
use crate::fmu::Fmu;
use crate::precision::{self, Family};
use crate::response::Errors;
use crate::scene::{Input, Scene};
use crate::timing;
use anyhow::Result;
use indicatif::ProgressBar;
use rocking::Detail;
use rocking::engine::DEFAULT_TOLERANCE;
use std::fmt::Write;
use std::path::Path;

/// One row: what, its target in floors, and what it came to.
#[derive(Debug)]
pub struct Row {
    /// What is measured.
    pub engine: String,
    /// The target.
    pub target: String,
    /// What was measured.
    pub measured: String,
    /// Whether the target is met.
    pub is_met: bool,
}

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
pub fn measure(scene: &Scene, limits: precision::Limits, progress: &ProgressBar) -> Result<Vec<Row>> {
    let floor = timing::floor(scene);
    let mut rows = Vec::new();
    let mut in_floors = |engine: String, target: f64, time: f64| {
        rows.push(Row {
            engine,
            target: format!("≤ {target} × floor"),
            measured: format!("{:.1} × floor ({:.0} ns)", time / floor, time * 1e9),
            is_met: time <= target * floor,
        });
    };
    in_floors("`linear`, tolerance 1e-9".into(), 12.0, engine_time(scene, Detail::Linear, DEFAULT_TOLERANCE));
    let mut ours = Vec::new();
    for (error, target) in [(1e-6, 32.0), (1e-9, 45.0)] {
        let (time, tolerance) = auto_time(scene, error);
        in_floors(format!("`auto` at error {error:.0e} (tolerance {tolerance:.0e})"), target, time);
        ours.push((error, time / floor));
    }
    let fmu = Fmu::new(scene, DEFAULT_TOLERANCE)?;
    let (_, with_fmi) = timing::fastest(|| fmu.run(Input::Linear, 1));
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
        rows.push(Row {
            engine: format!("`auto` against the best other library at error {error:.0e}"),
            target: "≥ 5 × faster".into(),
            measured: match best {
                Some((cost, name)) => format!("{:.1} × faster ({name}: {cost:.0} × floor)", cost / our_cost),
                None => "no other library gets there".into(),
            },
            is_met: best.is_none_or(|(cost, _)| cost >= 5.0 * our_cost),
        });
    }
    Ok(rows)
}

/// Measures and writes `docs/speed.md`.
pub fn write(scene: &Scene, limits: precision::Limits, docs: &Path, progress: &ProgressBar) -> Result<()> {
    let rows = measure(scene, limits, progress)?;
    let mut page = String::from(HEAD);
    for Row { engine, target, measured, is_met } in &rows {
        writeln!(page, "| {engine} | {target} | {measured} | {} |", if *is_met { "yes" } else { "no" })?;
    }
    page.push_str(TAIL);
    Ok(std::fs::write(docs.join("speed.md"), page)?)
}

const HEAD: &str = "# Speed

McManus's specimen under El Centro 1940 (180), 0.01 s between samples, 15 s: cost per record sample. `cargo run --release
--manifest-path study/Cargo.toml -- speed` writes this page; all numbers are of one run on one machine. The floor is one 4×6 matrix-vector
product per sample, each on the result of the last: the least that a linear structure can cost. Errors are
max |Δθ|/max |θ| against the engine at a tolerance of 1e-14.

| engine | target | measured | met |
|---|---|---|---|
";

const TAIL: &str = "
What stands in the way where a target is missed:

- `linear`: most of the time goes into the samples that hold one of the 134 transitions: a quarter of all into the search for the
  instant, six evaluations of a polynomial of some 13 orders one after the other, a seventh into series, of which there are 245,
  two for a transition where no sample holds more than one. All other samples are leapt over, in some 330 instructions each.
  By the count of their operations modes in closed form would not make the search cheaper (not tried): an exponential for each
  of the two real rates, one with a sine and a cosine for the vibration take as long as the polynomial, and right after an
  uplift, where θ grows as t³, they lose its digits.
- `auto`: four fifths of the time go into series while rocking: 1,107 of them, 17 orders each at a tolerance of 1e-6, which
  makes some 160 rows of six products a series. A looser tolerance takes as many: the error of one step is bounded for the
  sake of scenes that amplify it by 1e8, and this scene is not one of them. With 10 orders, which leave it an error of 1e-6,
  it took 42 floors. Tried and measured on the same scene before this form was chosen: velocities instead of momenta (eight
  products instead of six) 1.3 × the time; product by product 1.25 ×; the six products as plain arrays 1.25 ×. Tried since: a
  recurrence that is linear in the newest terms, with a third of the operations between one order and the next, gains 3 %;
  rows padded by zeros to fours lose 20 %; AVX encodings of the same vectors gain up to 7 %,
  rows of four and two with AVX2 5 to 11 %, on maps 5 %: too little for code that is chosen at run time. To prove by the chord of
  θ that nothing happens, before a march that finds it, saves half of the marches and no time.
";
