//! One level of detail on a scene: its response, its distance from another response, its cost.
use crate::peaks::{PART_OF_PERIOD, Peaks};
use rocking::{
    Engine, Ramp, Phase, Structure, Transition,
    engine::{AdvanceError, Work},
    record::Record,
};
use std::f64::consts::TAU;
use std::time::Instant;

/// A ground motion cut into steps.
pub struct Scene {
    /// One step per sample, as a simulation takes them.
    per_sample: Vec<Step>,
    /// Short enough to see every peak of the vibration.
    fine: Vec<Step>,
}

/// Ground acceleration up to an instant.
struct Step {
    until: f64,
    a_g: Ramp,
}

impl Scene {
    /// Of `ground` up to `end` (s); `sample` (s) is the interval of free vibration, for a record its own holds.
    pub fn new(structure: &Structure, ground: &Record, end: f64, sample: Option<f64>) -> Scene {
        let record_step = ground.times().windows(2).map(|times| times[1] - times[0]).fold(0.0, f64::max);
        let sample = sample.unwrap_or(record_step);
        let fine = sample.min(PART_OF_PERIOD * TAU / structure.omega_u);
        Scene { per_sample: steps(ground, end, sample), fine: steps(ground, end, fine) }
    }

    /// How many samples it has, the first not counted.
    pub fn samples(&self) -> usize {
        self.per_sample.len()
    }

    /// The response of `engine`, which stands at the start.
    pub fn response(&self, mut engine: Engine) -> Result<Response, AdvanceError> {
        let mut peaks = Peaks::from(*engine.structure(), engine.motion());
        let mut a_t = engine.outputs(0.0).a_t.abs();
        let mut theta = vec![engine.motion().state.theta];
        for &Step { until, a_g } in &self.fine {
            let from = engine.motion().time;
            engine.advance(until, a_g, &mut |at: &Transition| peaks.pass(at, a_g.at(at.time - from)))?;
            let motion = engine.motion();
            if let Phase::Overturned(_) = motion.phase {
                break;
            }
            peaks.reach(motion.time, motion.phase, &motion.state, motion.a_g);
            a_t = a_t.max(engine.outputs(0.0).a_t.abs());
            theta.push(motion.state.theta);
        }
        let motion = engine.motion();
        let [theta_peak, u, a_t_by_state] = peaks.largest();
        Ok(Response {
            // where u = 0, no force follows from the state
            peaks: [theta_peak, u, if u == 0.0 { a_t } else { a_t_by_state }],
            theta,
            overturned: matches!(motion.phase, Phase::Overturned(_)),
            transitions: motion.transitions,
        })
    }

    /// Time per sample (s) and work of a run of `engine`, which stands at the start.
    pub fn cost(&self, mut engine: Engine) -> Result<(f64, Work), AdvanceError> {
        let mut samples = 0;
        let clock = Instant::now();
        for &Step { until, a_g } in &self.per_sample {
            engine.advance(until, a_g, &mut |_| ())?;
            samples += 1;
            if let Phase::Overturned(_) = engine.motion().phase {
                break;
            }
        }
        Ok((clock.elapsed().as_secs_f64() / f64::from(samples), engine.motion().work))
    }
}

/// `ground` up to `end` (s) in steps of at most `longest` (s) that end at each of its samples.
fn steps(ground: &Record, end: f64, longest: f64) -> Vec<Step> {
    let mut steps = Vec::new();
    for segment in ground.segments_until(end) {
        let parts = ((segment.end - segment.start) / longest).ceil() as usize;
        let at = |part: usize| segment.start + (segment.end - segment.start) * (part as f64 / parts as f64);
        let until = |part: usize| if part == parts { segment.end } else { at(part) };
        steps.extend((1..=parts).map(|part| Step { until: until(part), a_g: segment.from(at(part - 1)) }));
    }
    steps
}

/// What a level makes of a scene.
pub struct Response {
    /// Peaks of theta (rad), u (m) and a_t (m/s²).
    pub peaks: [f64; 3],
    /// theta (rad) at the start and after every fine step, as long as the structure stands.
    theta: Vec<f64>,
    /// Whether it overturned.
    pub overturned: bool,
    /// How many transitions it has.
    pub transitions: u64,
}

impl Response {
    /// Relative errors of the peaks of theta, u and a_t and of the history of theta while both stand.
    pub fn errors(&self, reference: &Response) -> [f64; 4] {
        let [theta, u, a_t] = [0, 1, 2].map(|i| relative_error(self.peaks[i], reference.peaks[i]));
        let differences = self.theta.iter().zip(&reference.theta).map(|(theta, expected)| (theta - expected).abs());
        let [theta_peak, ..] = reference.peaks;
        let history = relative(differences.fold(0.0, f64::max), theta_peak);
        [theta, u, a_t, history]
    }
}

/// Distance of `value` from `reference` in proportion to it: 0 where both are 0, ∞ where `reference` alone is.
pub fn relative_error(value: f64, reference: f64) -> f64 {
    relative((value - reference).abs(), reference)
}

fn relative(difference: f64, reference: f64) -> f64 {
    if difference == 0.0 { 0.0 } else { difference / reference }
}
