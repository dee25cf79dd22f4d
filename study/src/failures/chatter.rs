//! Chatter after a landing with |u| > u_cr.

use super::*;

/// Steps of RK4 to a sample.
const STEPS: f64 = 64.0;

/// The uplift rule |u| ≥ u_cr alone, against the complete one.
pub fn show(scene: &StudyScene) -> Result<Exhibit> {
    let grid = Grid { method: FixedStep::RungeKutta4, h: scene.dt() / STEPS };
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
    Ok(Exhibit {
        key: "chatter",
        values: values([
            ("all", &all.len()),
            ("before", &before),
            ("duration", &scene.ground.end()),
            ("held", &held),
            ("stuck", &stuck),
        ]),
        series: vec![series("this engine: both conditions", count(&all)), series("|u| ≥ u_cr alone", count(&times))],
    })
}
