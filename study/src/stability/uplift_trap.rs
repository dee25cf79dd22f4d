//! A step that is stable while the base is down goes unstable at the instant of uplift.

use crate::chart::{Axis, Entry, Figure, Panel, Style, colour};
use crate::engine;
use crate::fixed_step::TEXTBOOK;
use crate::guards::uplift_excess;
use crate::hybrid::{self, Grid, Transitions};
use crate::response::Response;
use crate::scene::{Scene, ground};
use anyhow::{Context, Result};
use minijinja::{Value, context};
use rocking::{Detail, Parameters, State, Structure, Transition, TransitionKind};
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
pub fn scene() -> Result<Scene> {
    let structure = Structure::new(Parameters::EVISON)?;
    let samples = (DURATION / STEP) as usize;
    let a_g = (0..=samples).map(|k| k as f64 * STEP).map(|t| RAMP * t * 9.81 * (TAU * FREQUENCY * t).sin());
    Ok(Scene {
        key: "uplift-trap",
        title: "Evison's specimen, ground that sways more and more",
        structure,
        initial: State::default(),
        ground: ground(STEP, a_g.collect()),
    })
}

/// The response of the textbook method number `method` with the step [`STEP`].
pub fn response(scene: &Scene, method: usize) -> Response {
    let grid = Grid { method: TEXTBOOK[method].method, h: STEP };
    hybrid::run(scene, &grid, Transitions::Located, uplift_excess, &mut |_, _| ())
}

/// Writes picture and numbers, and tells the page what it shows.
pub fn save(docs: &Path) -> Result<Value> {
    const CENTRAL_DIFFERENCE: usize = 2;
    const NEWMARK: usize = 4;
    let scene = scene()?;
    let mut transitions = Vec::new();
    let exact = engine::run(&scene, Detail::Nonlinear, 1e-12, &mut |t: &Transition| transitions.push(*t));
    let uplift = transitions.iter().find(|transition| matches!(transition.kind, TransitionKind::Uplift(_)));
    let uplift = uplift.context("the structure lifts off")?.time;
    let unstable = response(&scene, CENTRAL_DIFFERENCE);
    let stable = response(&scene, NEWMARK);
    let failure = unstable.failure.clone().context("the central difference gets through")?;

    let right = Style::line(colour::BLACK, 3);
    let wrong = Style::line(colour::VERMILLION, 2);
    let coarse = Style::dashed(colour::BLUE, 2);
    let mark = Style::dashed(colour::GREY, 1);
    let over_time = |response: &Response, get: fn(&crate::response::Sample) -> f64| -> Vec<_> {
        response.samples.iter().enumerate().map(|(k, sample)| ((k + 1) as f64 * STEP, 1e3 * get(sample))).collect()
    };
    let panel = |title: &str, label: &str, bound: f64, get: fn(&crate::response::Sample) -> f64| {
        Panel::new(title, Axis::linear("time, s", 0.0, DURATION), Axis::linear(label, -bound, bound))
            .with("first uplift", [(uplift, -bound), (uplift, bound)], mark)
            .with("Newmark", over_time(&stable, get), coarse)
            .with("exact", over_time(&exact, get), right)
            .with("central difference", over_time(&unstable, get), wrong)
    };
    let elastic = panel("elastic displacement", "u, mm", 4.0, |sample| sample.u).label(
        (uplift, 3.4),
        "first uplift",
        colour::GREY,
    );
    let rotation = panel("rotation", "θ, mrad", 40.0, |sample| sample.theta);
    let figure = Figure {
        title: format!("One step of {:.0} ms, stable down and unstable up", 1e3 * STEP),
        panel: (600, 400),
        columns: 2,
        panels: vec![elastic, rotation],
        legend_columns: 3,
        legend: vec![
            Entry::new("exact", right),
            Entry::new("central difference, 12 ms", wrong),
            Entry::new("Newmark average acceleration, 12 ms", coarse),
        ],
    };
    figure.save(&docs.join("stability-uplift.svg"))?;
    figure.save_numbers(&docs.join("stability-uplift.csv"))?;
    Ok(context! {
        step => format!("{:.0}", 1e3 * STEP),
        down => format!("{:.2}", scene.structure.omega_fc * STEP),
        up => format!("{:.2}", scene.structure.omega_u * STEP),
        uplift => format!("{uplift:.2}"),
        failure => failure.to_string(),
    })
}
