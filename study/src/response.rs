//! What a run yields: the response at the samples, what it cost, or why there is none.

use rocking::Outputs;

/// The response of a scene, as far as it goes.
#[derive(Clone, Debug, PartialEq)]
pub struct Response {
    /// At the end of each interval between samples.
    pub samples: Vec<Sample>,
    /// Right-hand-side evaluations.
    pub evaluations: u64,
    /// Uplifts, impacts and landings.
    pub transitions: u64,
    /// Why it ends before the scene does.
    pub failure: Option<Failure>,
}

/// The response at one instant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sample {
    /// Rotation of the base, rad.
    pub theta: f64,
    /// Elastic displacement, m.
    pub u: f64,
    /// Acceleration of the top mass, m/s².
    pub a_t: f64,
}

impl Sample {
    /// What the study looks at of the outputs.
    pub fn of(&Outputs { theta, u, a_t, .. }: &Outputs) -> Sample {
        Sample { theta, u, a_t }
    }
}

/// Why a response ends early.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum Failure {
    /// The numbers grew without bound.
    #[error("diverges at t = {time:.3} s")]
    Diverged {
        /// s.
        time: f64,
    },
    /// θ went on beyond 0, to the wrong side of its pivot.
    #[error("falls through the floor at t = {time:.3} s")]
    ThroughTheFloor {
        /// s.
        time: f64,
    },
    /// |θ| reached π/2, where the exact response does not.
    #[error("overturns at t = {time:.3} s")]
    Overturned {
        /// s.
        time: f64,
    },
    /// More transitions within one interval than can be.
    #[error("opens and shuts contact without end at t = {time:.3} s")]
    Chatter {
        /// s.
        time: f64,
    },
    /// The solver gave up.
    #[error("gives up at t = {time:.3} s: {message}")]
    GaveUp {
        /// s.
        time: f64,
        /// In its own words.
        message: String,
    },
}

/// The errors of a response, each the largest difference over the samples relative to the largest exact value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Errors {
    /// max |Δθ| / max |θ|.
    pub theta: f64,
    /// max |Δu| / max |u|.
    pub u: f64,
    /// max |Δa_t| / max |a_t|.
    pub a_t: f64,
}

impl Errors {
    /// Of `response` against `exact`, or why it has none.
    pub fn of(response: &Response, exact: &Response) -> Result<Errors, Failure> {
        if let Some(failure) = &response.failure {
            return Err(failure.clone());
        }
        let error = |get: fn(&Sample) -> f64| {
            let largest = |values: &mut dyn Iterator<Item = f64>| values.map(f64::abs).fold(0.0, f64::max);
            let pairs = response.samples.iter().zip(&exact.samples);
            largest(&mut pairs.map(|(a, b)| get(a) - get(b))) / largest(&mut exact.samples.iter().map(get))
        };
        Ok(Errors { theta: error(|s| s.theta), u: error(|s| s.u), a_t: error(|s| s.a_t) })
    }
}
