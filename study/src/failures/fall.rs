//! Falling through the ground.

use super::*;
use crate::libraries::diffsol::{Diffsol, DiffsolMethod};

/// Results between two samples of the record of the library's run, which starts anew at each.
const CUTS: usize = 20;

/// Time between results of the exact one, s.
const CLOSE: f64 = 2e-5;

/// The library's run: ESDIRK34 with its own root finding.
const LIBRARY: Diffsol = Diffsol { method: DiffsolMethod::Esdirk34, tolerance: 1e-6 };

/// Under Pacoima Dam there is an impact after which θ is positive for 45 µs only.
pub fn show(scene: &StudyScene) -> Result<Exhibit> {
    let transitions = exact(scene, Detail::Nonlinear, [])?.transitions;
    let length = |pair: &&[Transition]| match (pair[0].kind, pair[1].kind) {
        (TransitionKind::Impact(_), TransitionKind::Landing) => pair[1].time - pair[0].time,
        _ => f64::INFINITY,
    };
    let hop = transitions.windows(2).min_by(|a, b| length(a).total_cmp(&length(b)));
    let hop = hop.context("the exact response has transitions")?;
    let start = hop[0].time;

    let fine = scene.resampled(CUTS);
    let wrong = hybrid::run(&fine, &LIBRARY, Transitions::AtStepEnds, uplift_excess, &mut |_, _| ());
    let failure = wrong.failure.context("the library gets through")?;
    let fall = wrong.samples.iter().enumerate().map(|(k, sample)| ((k + 1) as f64 * fine.dt(), sample.theta));
    let fall = fall.filter(|(t, _)| (t - start).abs() < 8e-3);
    let right = exact(scene, Detail::Nonlinear, every(CLOSE).map(|t| start - 4e-3 + t).take(600))?;
    Ok(Exhibit {
        key: "fall",
        values: values([("failure", &failure), ("length", &(1e6 * length(&hop))), ("start", &start)]),
        series: vec![
            series("this engine", milli(&right.theta(), start)),
            series("diffsol ESDIRK34, its root finding", milli(&fall.collect::<Vec<_>>(), start)),
        ],
    })
}
