//! Exact histories for the pictures.

use super::*;
use crate::engine::REFERENCE_TOLERANCE;
use rocking::run::RunError;
use rocking::run::record::Record;

/// A response over time, and its transitions.
pub struct ReferenceHistory {
    pub motions: Vec<Motion>,         // at the instants asked for, and at the end
    pub transitions: Vec<Transition>, // all of them, in order
}

impl ReferenceHistory {
    /// (t, θ), s and rad.
    pub fn theta(&self) -> Vec<(f64, f64)> {
        self.motions.iter().map(|motion| (motion.time, motion.state.theta)).collect()
    }
}

/// A structure on ground at rest for `duration` (s).
pub fn at_rest(parameters: Parameters, initial: State, duration: f64) -> StudyScene {
    StudyScene::new("at-rest", "ground at rest", parameters, initial, Record::at_rest(duration))
}

/// Instants `interval` s apart.
pub fn every(interval: f64) -> impl Iterator<Item = f64> {
    (1..).map(move |k| f64::from(k) * interval)
}

/// The exact response at the level `detail`, seen at `times` (s), to its end.
pub fn exact(
    scene: &StudyScene,
    detail: Detail,
    times: impl IntoIterator<Item = f64>,
) -> Result<ReferenceHistory, RunError> {
    let (mut motions, mut transitions) = (Vec::new(), Vec::new());
    let show = |sample: &rocking::Sample| motions.push(sample.motion);
    let watch = &mut |transition: &Transition| transitions.push(*transition);
    scene.run(detail, REFERENCE_TOLERANCE).sample(times, show, watch)?;
    Ok(ReferenceHistory { motions, transitions })
}

/// `points` with x in milliseconds from `origin` and y in thousandths.
pub fn milli(points: &[(f64, f64)], origin: f64) -> impl Iterator<Item = (f64, f64)> {
    points.iter().map(move |(t, y)| (1e3 * (t - origin), 1e3 * y))
}

/// Whether a transition is an impact with which rocking goes on.
pub fn is_impact(transition: &Transition) -> bool {
    matches!(transition.kind, TransitionKind::Impact(_))
}
