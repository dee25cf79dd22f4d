//! Two crossings within one step.

use super::history::{at_rest, every, exact, window};
use super::{Exhibit, RIGHT, WRONG};
use crate::chart::{Axis, Entry, Marker, Panel, Style, colour};
use crate::equations::PhaseEquations;
use crate::fixed_step::runge_kutta_4::RungeKutta4;
use crate::fixed_step::{OneStep, Point};
use crate::guards::{PhaseEnd, uplift_excess};
use crate::hybrid::{self, Integrator, Span, Stretch, Transitions};
use anyhow::{Context, Result};
use minijinja::context;
use rocking::{Detail, Parameters, State};
use std::cell::RefCell;

/// A state from which θ dips below 0 for some milliseconds.
const START: State = State { theta: 0.6e-3, theta_dot: -0.043, u: -6.5e-3, u_dot: 0.98 };

/// How long it is followed, s.
const DURATION: f64 = 1.6;

/// Integrates as exactly as one likes, but looks at guards only at the end of steps of this length, s.
const LOOK: f64 = 0.02;

/// Inner steps of [`LOOK`].
const INNER: usize = 50;

/// The solver that looks too rarely, and the path it takes.
#[derive(Default)]
struct Blind {
    path: RefCell<Vec<(f64, f64)>>,
}

impl Integrator for Blind {
    fn advance(&self, span: &Span, end: Option<&PhaseEnd>) -> Result<Stretch, String> {
        let &Span { equations, tau, ref from, until } = span;
        let next = (((tau / LOOK + 1e-9).floor() + 1.0) * LOOK).min(until);
        let h = (next - tau) / INNER as f64;
        let mut to = *from;
        let mut path = Vec::new();
        for k in 0..INNER {
            to = RungeKutta4.step(equations, tau + k as f64 * h, &to, h);
            path.push((tau + (k + 1) as f64 * h, to.position[1]));
        }
        let is_over = end.is_some_and(|end| end.is_over(&to.state()));
        if is_over {
            // What follows the crossing that is noticed is taken back.
            let stays = path.iter().rposition(|(_, theta)| theta * to.position[1] <= 0.0).map_or(0, |last| last + 1);
            path.truncate(stays);
        }
        self.path.borrow_mut().extend(path);
        Ok(Stretch { start: tau, end: next, from: *from, to, is_over })
    }

    fn flow(&self, equations: &PhaseEquations, tau: f64, from: &Point, h: f64) -> Result<Point, String> {
        let inner = h / INNER as f64;
        Ok((0..INNER).fold(*from, |to, k| RungeKutta4.step(equations, tau + k as f64 * inner, &to, inner)))
    }
}

/// A dip that begins and ends between two looks.
pub fn show() -> Result<Exhibit> {
    let scene = at_rest(Parameters::MCMANUS, START, DURATION);
    let right = exact(&scene, Detail::Nonlinear, every(1e-3))?;
    let first = right.transitions.first().context("the exact response has transitions")?.time;
    let blind = Blind::default();
    hybrid::run(&scene, &blind, Transitions::Located, uplift_excess, &mut |_, _| ());
    let path = blind.path.take();
    let dip: Vec<f64> = path.iter().filter(|(t, theta)| *t < LOOK && *theta < 0.0).map(|(t, _)| *t).collect();
    let (begins, ends) = (dip[0], dip[dip.len() - 1]);
    let looks: Vec<_> = path.iter().filter(|(t, _)| ((t / LOOK).round() * LOOK - t).abs() < 1e-9).copied().collect();

    let look = Style { width: 0, ..Style::marked(colour::VERMILLION, 0, Marker::Circle) };
    let floor = Style::dashed(colour::GREY, 1);
    let units = (0.0, 1e-3, 1e-3);
    let panel = |title: &str, duration: f64, (low, high): (f64, f64)| {
        let x = Axis::linear("time, ms", 0.0, 1e3 * duration);
        Panel::new(title, x, Axis::linear("θ, mrad", low, high))
            .with("floor", [(0.0, 0.0), (1e3 * duration, 0.0)], floor)
            .with("sign looked at every 20 ms", window(&path, (0.0, duration), units), WRONG)
            .with("this project", window(&right.theta(), (0.0, duration), units), RIGHT)
    };
    let close = panel("the crossings", 0.03, (-2.0, 6.0)).with("looks", window(&looks, (0.0, 0.03), units), look);
    let whole = panel("what becomes of it", DURATION, (-90.0, 110.0));
    Ok(Exhibit {
        key: "double-crossing",
        title: "Two crossings within one step",
        values: context! {
            first => format!("{:.1}", 1e3 * first),
            begins => format!("{:.1}", 1e3 * begins),
            ends => format!("{:.1}", 1e3 * ends),
        },
        panels: vec![close, whole],
        legend_columns: 2,
        legend: vec![
            Entry::new("this project", RIGHT),
            Entry::new("floor", floor),
            Entry::new("exact integration, sign looked at every 20 ms", WRONG),
            Entry::new("where it looks", look),
        ],
    })
}
