//! One run: a structure at rest under a ground motion, to the end of the record or to overturning, and its peaks.
use super::plan::Limit;
use rocking::run::{Ending, Finish, Run, RunError};
use rocking::{Parameters, Structure, record::Record};
use serde::{Deserialize, Serialize};

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
    pub fn of(structure: &Structure, ground: &Record) -> Result<Outcome, RunError> {
        let (peaks, Finish { ending, motion }) = Run::new(*structure, ground).peaks()?;
        let overturned = ending == Ending::Overturned;
        Ok(Outcome {
            overturned,
            overturned_at: overturned.then_some(motion.time),
            peaks: measures(structure, [peaks.theta(), peaks.u(), peaks.a_t()].map(|peak| peak.magnitude)),
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
