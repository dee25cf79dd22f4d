//! Two crossings within one step.

use super::*;

/// A state from which θ dips below 0 for some milliseconds.
const START: State = State { theta: 0.6e-3, theta_dot: -0.043, u: -6.5e-3, u_dot: 0.98 };

const LOOK: f64 = 0.02; // steps of a solver that looks at its guards at their ends, s

/// Time between points of its path, s.
const CLOSE: f64 = LOOK / 50.0;

/// A dip that begins and ends between two looks.
pub fn show() -> Result<Exhibit> {
    let scene = at_rest(Parameters::MCMANUS, START, 1.5 * LOOK);
    let right = exact(&scene, Detail::Nonlinear, every(CLOSE))?;
    let first = right.transitions.first().context("the exact response has transitions")?.time;
    let (structure, phase, evaluations) = (&scene.structure, Phase::Rocking(Side::Right), &Cell::new(0));
    let equations = PhaseEquations { structure, phase, a_g: Ramp::default(), evaluations };
    let path = every(CLOSE).take(75).scan(MovingPoint::start(&START), |point, t| {
        *point = FixedStep::RungeKutta4.step(&equations, t - CLOSE, point, CLOSE);
        Some((t, point.position[1]))
    });
    let path: Vec<_> = path.collect();
    let mut dip = path.iter().filter(|(_, theta)| *theta < 0.0).map(|(t, _)| 1e3 * t);
    let (begins, ends) = (dip.next(), dip.next_back());
    let (begins, ends) = begins.zip(ends).context("there is a dip")?;
    let look = path.iter().find(|(t, _)| *t >= LOOK - 0.5 * CLOSE).map(|(t, theta)| (1e3 * t, 1e3 * theta));
    let looks = [Some((0.0, 1e3 * START.theta)), look].into_iter().flatten();
    Ok(Exhibit {
        key: "double-crossing",
        values: values([("first", &(1e3 * first)), ("begins", &begins), ("ends", &ends)]),
        series: vec![
            series("checked here", looks),
            series("this engine", milli(&right.theta(), 0.0)),
            series("exact integration, sign checked every 20 ms", milli(&path, 0.0)),
        ],
    })
}
