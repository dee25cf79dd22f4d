//! Falling through the floor.

use super::history::{every, exact, window};
use super::{Exhibit, RIGHT, WRONG};
use crate::chart::{Axis, Entry, Panel, Style, colour};
use crate::equations::PhaseEquations;
use crate::fixed_step::runge_kutta_4::RungeKutta4;
use crate::fixed_step::{OneStep, Point};
use crate::guards::uplift_excess;
use crate::hybrid::{self, Transitions};
use crate::libraries::diffsol::{Diffsol, Method};
use crate::scene::Scene;
use anyhow::{Context, Result};
use minijinja::context;
use rocking::{Detail, Phase, Transition, TransitionKind};
use std::cell::Cell;

/// Results between two samples of the record of the library's run, which starts anew at each.
const CUTS: usize = 20;

/// Time between results of the exact one, s.
const CLOSE: f64 = 5e-6;

/// The library's run: ESDIRK34 with its own root finding.
const LIBRARY: Diffsol = Diffsol { method: Method::Esdirk34, tolerance: 1e-6 };

/// θ (rad) over time (s) from just after `impact` by Eqs 5 and 6 alone, for `duration` (s).
fn continued(scene: &Scene, impact: &Transition, duration: f64) -> Vec<(f64, f64)> {
    const STEPS: usize = 200;
    let TransitionKind::Impact(side) = impact.kind else { return Vec::new() };
    let interval = (impact.time / scene.dt()).floor();
    let evaluations = Cell::new(0);
    let equations = PhaseEquations {
        structure: &scene.structure,
        phase: Phase::Rocking(side),
        a_g: scene.ramp(interval as usize),
        evaluations: &evaluations,
    };
    let h = duration / STEPS as f64;
    let mut point = Point::start(&impact.after);
    let mut path = vec![(impact.time, impact.after.theta)];
    for k in 0..STEPS {
        let elapsed = k as f64 * h;
        point = RungeKutta4.step(&equations, impact.time - interval * scene.dt() + elapsed, &point, h);
        path.push((impact.time + elapsed + h, point.position[1]));
    }
    path
}

/// Under Pacoima Dam there is an impact after which θ is positive for 45 µs only.
pub fn show(scene: &Scene) -> Result<Exhibit> {
    let transitions = exact(scene, Detail::Nonlinear, [])?.transitions;
    let hop = transitions.windows(2).min_by(|a, b| {
        let length = |pair: &[Transition]| match (pair[0].kind, pair[1].kind) {
            (TransitionKind::Impact(_), TransitionKind::Landing) => pair[1].time - pair[0].time,
            _ => f64::INFINITY,
        };
        length(a).total_cmp(&length(b))
    });
    let hop = hop.context("the exact response has transitions")?;
    let (start, length) = (hop[0].time, hop[1].time - hop[0].time);

    let fine = scene.resampled(CUTS);
    let wrong = hybrid::run(&fine, &LIBRARY, Transitions::AtStepEnds, uplift_excess, &mut |_, _| ());
    let failure = wrong.failure.context("the library gets through")?;
    let fall: Vec<_> =
        wrong.samples.iter().enumerate().map(|(k, sample)| ((k + 1) as f64 * fine.dt(), sample.theta)).collect();

    const MS: f64 = 1e-3;
    const MRAD: f64 = 1e-3;
    const NRAD: f64 = 1e-9;
    let missed = continued(scene, &hop[0], 2.5 * length);
    let floor = Style::dashed(colour::GREY, 1);
    let panel = |title: &str, (from, to): (f64, f64), theta: Axis| {
        let x = Axis::linear("time from the impact, ms", from, to);
        Panel::new(title, x, theta).with("floor", [(from, 0.0), (to, 0.0)], floor)
    };
    let around = (start - 4.0 * MS, start + 8.0 * MS);
    let right = exact(scene, Detail::Nonlinear, every(CLOSE).map(|t| around.0 + t))?.theta();
    let wide = panel("the fall", (-4.0, 8.0), Axis::linear("θ, mrad", -1.2, 0.4))
        .with("diffsol ESDIRK34", window(&fall, around, (start, MS, MRAD)), WRONG)
        .with("this project", window(&right, around, (start, MS, MRAD)), RIGHT);
    // The same until the return, contact from there on.
    let hops = missed.iter().copied().take_while(|(t, _)| *t < start + length);
    let exact: Vec<_> = hops.chain([(start + length, 0.0), (start + 2.5 * length, 0.0)]).collect();
    let (from, to) = (-0.5 * length / MS, 2.5 * length / MS);
    let close = panel("the return that is missed", (from, to), Axis::linear("θ, nrad", -60.0, 40.0))
        .with("the equations beyond it", window(&missed, (start, start + length * 2.5), (start, MS, NRAD)), WRONG)
        .with("this project", window(&exact, (start, start + length * 2.5), (start, MS, NRAD)), RIGHT)
        .note((1.05 * length / MS, 5.0), format!("back at {:.0} µs", 1e6 * length), colour::BLACK);
    Ok(Exhibit {
        key: "fall",
        title: "Falling through the floor",
        values: context! {
            failure => failure.to_string(),
            length => format!("{:.0}", 1e6 * length),
            start => format!("{start:.4}"),
        },
        panels: vec![wide, close],
        legend_columns: 3,
        legend: vec![
            Entry::new("this project", RIGHT),
            Entry::new("diffsol ESDIRK34, its root finding", WRONG),
            Entry::new("floor", floor),
        ],
    })
}
