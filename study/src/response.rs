//! Result of a run: the response at the samples, its cost, or the reason of a failure.

use rocking::Output;

/// The response of a scene, as far as it goes.
#[derive(Clone, Debug, PartialEq)]
pub struct Response {
    pub samples: Vec<MotionSample>, // at the end of each interval between samples
    pub evaluations: u64,
    pub transitions: u64,            // uplifts, impacts and landings
    pub failure: Option<RunFailure>, // why it ends before the scene does
}

/// The response at one instant; or its errors, each the largest difference over the samples relative to the largest exact value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MotionSample {
    pub theta: f64, // rotation of the base, rad
    pub u: f64,     // elastic displacement, m
    pub a_t: f64,   // acceleration of the top mass, m/s²
}

impl MotionSample {
    /// The outputs that the study compares.
    pub fn of(outputs: impl Fn(Output) -> f64) -> MotionSample {
        let [theta, u, a_t] = [Output::theta, Output::u(0), Output::a_t(0)].map(outputs);
        MotionSample { theta, u, a_t }
    }
}

/// Why a response ends early, at which time (s).
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum RunFailure {
    #[error("diverges at t = {time:.3} s")]
    Diverged { time: f64 },
    /// θ went on beyond 0, to the wrong side of its pivot.
    #[error("falls through the ground at t = {time:.3} s")]
    ThroughTheFloor { time: f64 },
    /// |θ| reached π/2, where the exact response does not.
    #[error("overturns at t = {time:.3} s")]
    Overturned { time: f64 },
    /// More transitions within one interval than can be.
    #[error("opens and shuts contact without end at t = {time:.3} s")]
    Chatter { time: f64 },
    /// The reason in the words of `peers.py`, or of the numbers of an earlier run.
    #[error("{0}")]
    AsWritten(String),
    #[error("gives up at t = {time:.3} s: {message}")]
    GaveUp { time: f64, message: String },
}

impl Response {
    /// The errors of the response against `exact`, or why it has none.
    pub fn errors(&self, exact: &Response) -> Result<MotionSample, RunFailure> {
        if let Some(failure) = &self.failure {
            return Err(failure.clone());
        }
        let error = |get: fn(&MotionSample) -> f64| {
            let largest = |values: &mut dyn Iterator<Item = f64>| values.map(f64::abs).fold(0.0, f64::max);
            let pairs = self.samples.iter().zip(&exact.samples);
            largest(&mut pairs.map(|(a, b)| get(a) - get(b))) / largest(&mut exact.samples.iter().map(get))
        };
        Ok(MotionSample { theta: error(|s| s.theta), u: error(|s| s.u), a_t: error(|s| s.a_t) })
    }
}
