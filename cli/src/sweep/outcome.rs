//! One run: a structure at rest under a ground motion, to the end of the record or to overturning, and its peaks.
use super::plan::Limit;
use crate::peaks::{PART_OF_PERIOD, Peaks};
use rocking::{
    Engine, Parameters, Phase, State, Structure, Transition,
    engine::{AdvanceError, DEFAULT_TOLERANCE},
    record::Record,
};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// What a run is measured by, with units: the largest magnitudes on the way.
pub const MEASURES: [(&str, &str); 7] = [
    ("theta", "rad"),
    ("theta/alpha_cg", "1"),
    ("uplift", "m"),
    ("u", "m"),
    ("a_t", "m/s2"),
    ("V_t", "N"),
    ("M_t", "N.m"),
];

/// What a run came to.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Outcome {
    pub overturned: bool,
    /// Time of overturning, s.
    overturned_at: Option<f64>,
    /// Of each of [`MEASURES`].
    peaks: [f64; MEASURES.len()],
    transitions: u64,
    steps: u64,
    evaluations: u64,
}

impl Outcome {
    /// Runs `structure` from rest under `ground`.
    pub fn of(structure: &Structure, ground: &Record) -> Result<Outcome, AdvanceError> {
        let interval = PART_OF_PERIOD * TAU / structure.omega_u;
        let mut engine = Engine::new(*structure, State::default(), ground.start(), DEFAULT_TOLERANCE)
            .expect("every structure may start at rest in full contact");
        let mut peaks = Peaks::from(*structure, engine.motion());
        'run: for segment in ground.segments_until(ground.end()) {
            let parts = ((segment.end - segment.start) / interval).ceil().max(1.0);
            for part in 1..=parts as u64 {
                let until = segment.start + (segment.end - segment.start) * (part as f64 / parts);
                let until = if part as f64 == parts { segment.end } else { until };
                let a_g = segment.from(engine.motion().time);
                let mut on_the_way = |at: &Transition| peaks.pass(at, segment.from(at.time).value);
                engine.advance(until, a_g, &mut on_the_way)?;
                let motion = engine.motion();
                if let Phase::Overturned(_) = motion.phase {
                    break 'run;
                }
                peaks.reach(motion.time, motion.phase, &motion.state, segment.from(motion.time).value);
            }
        }
        let motion = engine.motion();
        let overturned = matches!(motion.phase, Phase::Overturned(_));
        Ok(Outcome {
            overturned,
            overturned_at: overturned.then_some(motion.time),
            peaks: measures(structure, peaks.largest()),
            transitions: motion.transitions,
            steps: motion.work.steps,
            evaluations: motion.work.evaluations,
        })
    }

    /// Whether the peak reached `limit`; a structure that overturned has exceeded every limit.
    pub fn exceeds(&self, limit: &Limit) -> bool {
        self.overturned || self.peaks[limit.measure] >= limit.value
    }
}

/// Each of [`MEASURES`] from the largest theta, u and a_t (uplift by Eq 25, V_t and M_t by Eqs 2, 3, 23, 24).
fn measures(structure: &Structure, [theta, u, a_t]: [f64; 3]) -> [f64; MEASURES.len()] {
    let &Parameters { m, H, B, .. } = structure.parameters();
    [theta, theta / structure.tan_alpha_cg.atan(), 2.0 * B * theta.sin(), u, a_t, m * a_t, m * H * a_t]
}
