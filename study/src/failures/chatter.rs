//! Chatter after a landing with |u| > u_cr.

use super::history::exact;
use super::{Exhibit, RIGHT, WRONG};
use crate::chart::{Axis, Panel};
use crate::fixed_step::Method;
use crate::guards::displacement_excess;
use crate::hybrid::{self, Grid, Transitions};
use crate::scene::Scene;
use anyhow::{Context, Result};
use minijinja::context;
use rocking::{Detail, TransitionKind};

/// Steps of RK4 to a sample.
const STEPS: f64 = 64.0;

/// The uplift rule |u| ≥ u_cr alone, against the complete one.
pub fn show(scene: &Scene) -> Result<Exhibit> {
    let grid = Grid { method: Method::RungeKutta4, h: scene.dt() / STEPS };
    let mut times = Vec::new();
    let naive = hybrid::run(scene, &grid, Transitions::Located, displacement_excess, &mut |time, _| times.push(time));
    naive.failure.context("the incomplete rule gets through")?;
    let stuck = times[times.len() - 1];
    let before = times.iter().filter(|time| **time < stuck - 1e-9).count();

    let right = exact(scene, Detail::Nonlinear, [])?.transitions;
    let landing = right
        .iter()
        .position(|transition| transition.kind == TransitionKind::Landing && (transition.time - stuck).abs() < 0.01);
    let landing = landing.context("the exact response lands where the incomplete rule gets stuck")?;
    let uplift = right.get(landing + 1).context("it lifts off again")?;
    let held = 1e3 * (uplift.time - right[landing].time);

    let count = |times: &[f64]| times.iter().enumerate().map(|(k, t)| (*t, (k + 1) as f64)).collect::<Vec<_>>();
    let all: Vec<_> = right.iter().map(|transition| transition.time).collect();
    let duration = scene.ground.end();
    let (x, y) = (Axis::linear("time, s", 0.0, duration), Axis::logarithmic("transitions so far", 1.0, 2000.0));
    let panel = Panel::new("Uplift by |u| ≥ u_cr alone never ends", x, y)
        .with("this engine: both conditions", count(&all), RIGHT)
        .named((0.3 * duration, 10.0))
        .with("|u| ≥ u_cr alone", count(&times), WRONG)
        .named((0.55 * stuck, 600.0));
    Ok(Exhibit {
        key: "chatter",
        shows: "Transitions so far over time: with both conditions the motion continues, with one condition they pile up at an instant.",
        values: context! {
            all => all.len(),
            before,
            duration => format!("{duration:.0}"),
            held => format!("{held:.0}"),
            stuck => format!("{stuck:.3}"),
        },
        panel,
    })
}
