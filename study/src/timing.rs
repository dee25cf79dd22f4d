//! What things cost, in units of the least that a step of a linear structure can cost.

use crate::scene::Scene;
use nalgebra::{SMatrix, SVector};
use std::hint::black_box;
use std::time::{Duration, Instant};

/// Runs are repeated until they have taken this long, and the fastest counts.
const LEAST: Duration = Duration::from_millis(30);

/// And at most so often.
const MOST_REPEATS: usize = 1000;

/// What `run` yields, and the shortest time that it took, s.
pub fn fastest<T>(mut run: impl FnMut() -> T) -> (T, f64) {
    let began = Instant::now();
    let mut best = f64::INFINITY;
    for repeat in 1.. {
        let start = Instant::now();
        let result = run();
        best = best.min(start.elapsed().as_secs_f64());
        if began.elapsed() >= LEAST || repeat == MOST_REPEATS {
            return (result, best);
        }
    }
    unreachable!("the repeats end")
}

/// Time per sample, s, of one 4×6 matrix-vector product: the recurrence x ← [Φ Γ](x, a₀, a₁) of a linear structure
/// under the ground acceleration of `scene`. Nothing that steps from sample to sample is faster.
pub fn floor(scene: &Scene) -> f64 {
    let decay = SMatrix::<f64, 4, 6>::from_fn(|i, j| if i == j { 0.9 } else { 0.01 * (i as f64 - j as f64) });
    let (_, time) = fastest(|| {
        let decay = black_box(decay);
        let mut state = SVector::<f64, 4>::repeat(0.01);
        for pair in scene.ground.acceleration().windows(2) {
            state = decay * SVector::<f64, 6>::from([state[0], state[1], state[2], state[3], pair[0], pair[1]]);
        }
        black_box(state)
    });
    time / scene.intervals() as f64
}
