//! Two crossings within one step.

use super::history::{at_rest, every, exact, milli};
use super::{Exhibit, GUIDE, RIGHT, WRONG};
use crate::chart::{Axis, Marker, Panel, Style, colour};
use crate::equations::PhaseEquations;
use crate::fixed_step::{Method, Point};
use anyhow::{Context, Result};
use minijinja::context;
use rocking::{Detail, Parameters, Phase, Ramp, Side, State};
use std::cell::Cell;

/// A state from which θ dips below 0 for some milliseconds.
const START: State = State { theta: 0.6e-3, theta_dot: -0.043, u: -6.5e-3, u_dot: 0.98 };

/// A solver looks at its guards at the end of steps of this length, s.
const LOOK: f64 = 0.02;

/// Time between points of its path, s.
const CLOSE: f64 = LOOK / 50.0;

/// A dip that begins and ends between two looks.
pub fn show() -> Result<Exhibit> {
    let scene = at_rest(Parameters::MCMANUS, START, 1.5 * LOOK);
    let right = exact(&scene, Detail::Nonlinear, every(CLOSE))?;
    let first = right.transitions.first().context("the exact response has transitions")?.time;
    let equations = PhaseEquations {
        structure: &scene.structure,
        phase: Phase::Rocking(Side::Right),
        a_g: Ramp::default(),
        evaluations: &Cell::new(0),
    };
    let path = every(CLOSE).take(75).scan(Point::start(&START), |point, t| {
        *point = Method::RungeKutta4.step(&equations, t - CLOSE, point, CLOSE);
        Some((t, point.position[1]))
    });
    let path: Vec<_> = path.collect();
    let mut dip = path.iter().filter(|(_, theta)| *theta < 0.0).map(|(t, _)| 1e3 * t);
    let (begins, ends) = (dip.next(), dip.next_back());
    let (begins, ends) = begins.zip(ends).context("there is a dip")?;
    let look = path.iter().find(|(t, _)| *t >= LOOK - 0.5 * CLOSE).map(|(t, theta)| (1e3 * t, 1e3 * theta));
    let looks = [Some((0.0, 1e3 * START.theta)), look].into_iter().flatten();
    let x = Axis::linear("time, ms", 0.0, 1.5e3 * LOOK);
    let panel = Panel::new(
        "A solver that checks θ only every 20 ms misses two crossings",
        x,
        Axis::linear("θ, mrad", -2.0, 6.0),
    )
    .with("checked here", looks, Style::marked(colour::VERMILLION, 0, Marker::Circle))
    .named((1e3 * LOOK, 0.6))
    .with("this engine", milli(&right.theta(), 0.0), RIGHT)
    .named((9.0, 2.2))
    .with("exact integration, sign checked every 20 ms", milli(&path, 0.0), WRONG)
    .named((17.5, -1.0))
    .with("", [(0.0, 0.0), (1.5e3 * LOOK, 0.0)], GUIDE);
    Ok(Exhibit {
        key: "double-crossing",
        shows: "θ over time: it dips below 0 and returns between two checks; the exact response has an impact instead.",
        values: context! {
            first => format!("{:.1}", 1e3 * first),
            begins => format!("{begins:.1}"),
            ends => format!("{ends:.1}"),
        },
        panel,
    })
}
