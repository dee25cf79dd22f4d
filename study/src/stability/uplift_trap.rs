//! A step that is stable while the base is down goes unstable at the instant of uplift.

use crate::chart::{Axis, Figure, Panel, Style, colour};
use crate::engine;
use crate::fixed_step::TEXTBOOK;
use crate::guards::uplift_excess;
use crate::hybrid::{self, Grid, Transitions};
use crate::response::Response;
use crate::scene::{Scene, ground, structure};
use anyhow::{Context, Result};
use minijinja::{Value, context};
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
pub fn scene() -> Scene {
    let samples = (DURATION / STEP) as usize;
    let a_g = (0..=samples).map(|k| k as f64 * STEP).map(|t| RAMP * t * 9.81 * (TAU * FREQUENCY * t).sin());
    Scene {
        key: "uplift-trap",
        title: "Evison's specimen, ground that sways more and more",
        structure: structure(Parameters::EVISON),
        initial: State::default(),
        ground: ground(STEP, a_g.collect()),
    }
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
    let panel = Panel::new("", Axis::linear("time, s", 0.0, DURATION), Axis::linear("u, mm", -2.0, 2.0))
        .with("central difference, 12 ms", u(&unstable), Style::line(colour::VERMILLION, 2))
        .named((1.2, -1.3))
        .with("exact", u(&exact), Style::line(colour::BLACK, 3))
        .named((3.6, -1.2))
        .with("Newmark average acceleration, 12 ms", u(&response(&scene, NEWMARK)), Style::dashed(colour::BLUE, 2))
        .named((0.4, 1.2))
        .with("", [(uplift, -2.0), (uplift, 2.0)], Style::dashed(colour::GREY, 1))
        .note((1.7, 1.75), "first uplift", colour::GREY);
    let title = "Stable with the base down, unstable from uplift on".into();
    let description = "u over time with steps of 12 ms: the central difference diverges after the first uplift.".into();
    let figure = Figure { title, description, columns: 1, panels: vec![panel] };
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
