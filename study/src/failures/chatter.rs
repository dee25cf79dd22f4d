//! Chatter after a landing with |u| > u_cr.

use super::history::{every, exact};
use super::{Exhibit, RIGHT, WRONG};
use crate::chart::{Axis, Entry, Panel, Style, colour};
use crate::fixed_step::runge_kutta_4::RungeKutta4;
use crate::guards::{displacement_excess, uplift_excess};
use crate::hybrid::{self, Grid, Transitions};
use crate::scene::Scene;
use anyhow::{Context, Result};
use minijinja::context;
use rocking::{Detail, Motion, TransitionKind};

/// Steps of RK4 to a sample.
const STEPS: f64 = 64.0;

/// Instants of the close view, s from the landing.
const CLOSE: f64 = 1e-5;

/// The uplift rule |u| ≥ u_cr alone, against the complete one.
pub fn show(scene: &Scene) -> Result<Exhibit> {
    let grid = Grid { method: &RungeKutta4, h: scene.dt() / STEPS };
    let mut times = Vec::new();
    let naive = hybrid::run(scene, &grid, Transitions::Located, displacement_excess, &mut |time, _| times.push(time));
    naive.failure.context("the incomplete rule gets through")?;
    let stuck = times[times.len() - 1];
    let before = times.iter().filter(|time| **time < stuck - 1e-9).count();

    let right = exact(scene, Detail::Nonlinear, [])?;
    let landing = right
        .transitions
        .iter()
        .find(|transition| transition.kind == TransitionKind::Landing && (transition.time - stuck).abs() < 0.01);
    let landing = landing.context("the exact response lands where the incomplete rule gets stuck")?;
    let uplift = right
        .transitions
        .iter()
        .find(|transition| transition.time >= landing.time && matches!(transition.kind, TransitionKind::Uplift(_)));
    let held = uplift.map(|uplift| 1e3 * (uplift.time - landing.time)).context("it lifts off again")?;

    let count = |times: &[f64]| times.iter().enumerate().map(|(k, t)| (*t, (k + 1) as f64)).collect::<Vec<_>>();
    let all: Vec<_> = right.transitions.iter().map(|transition| transition.time).collect();
    let duration = scene.ground.end();
    let counts = Panel::new(
        "transitions so far",
        Axis::linear("time, s", 0.0, duration),
        Axis::logarithmic("number", 1.0, 2000.0),
    )
    .with("|u| ≥ u_cr alone", count(&times), WRONG)
    .with("this project", count(&all), RIGHT)
    .label((stuck, 1500.0), format!("no end at t = {stuck:.3} s"), colour::VERMILLION);

    // From the landing to twice the time at which |u| falls below u_cr.
    let structure = &scene.structure;
    let [mut displacement, mut moment] = [Vec::new(), Vec::new()];
    let mut below = None;
    for Motion { time, state, .. } in exact(scene, Detail::Nonlinear, every(CLOSE).map(|t| landing.time + t))?.motions {
        let microseconds = 1e6 * (time - landing.time);
        let excess = displacement_excess(structure, &state);
        if excess < 0.0 && below.is_none() {
            below = Some(microseconds);
        }
        if below.is_some_and(|below| microseconds > 2.0 * below) {
            break;
        }
        displacement.push((microseconds, excess));
        moment.push((microseconds, uplift_excess(structure, &state)));
    }
    let end = 2.0 * below.context("|u| falls below u_cr")?;
    let lowest = moment.iter().map(|(_, y)| *y).fold(0.0, f64::min);
    let dashed = Style::dashed(colour::GREY, 1);
    let conditions = Panel::new(
        "after that landing: both must be ≥ 0 to lift off",
        Axis::linear("time from the landing, µs", 0.0, end),
        Axis::linear("condition", 1.2 * lowest, -0.4 * lowest),
    )
    .with("zero", [(0.0, 0.0), (end, 0.0)], dashed)
    .with("|u|/u_cr − 1", displacement, Style::line(colour::BLUE, 2))
    .with("s θ̈ H/g", moment, Style::line(colour::ORANGE, 2));
    Ok(Exhibit {
        key: "chatter",
        title: "Chatter after a landing with |u| > u_cr",
        values: context! {
            all => all.len(),
            before,
            duration => format!("{duration:.0}"),
            held => format!("{held:.0}"),
            stuck => format!("{stuck:.3}"),
        },
        panels: vec![counts, conditions],
        legend_columns: 2,
        legend: vec![
            Entry::new("this project: both conditions", RIGHT),
            Entry::new("|u| ≥ u_cr alone", WRONG),
            Entry::new("|u|/u_cr − 1", Style::line(colour::BLUE, 2)),
            Entry::new("s θ̈ H/g, from Eqs 5 and 6", Style::line(colour::ORANGE, 2)),
        ],
    })
}
