//! Processor time.

use cpu_time::ThreadTime;
use std::time::Duration;

/// Runs are repeated until they have taken this long, and the fastest counts.
const LEAST: Duration = Duration::from_millis(30);

/// And at most so often.
const MOST_REPEATS: usize = 1000;

/// The result of `run`, and the shortest processor time, s.
pub fn fastest<T>(mut run: impl FnMut() -> T) -> (T, f64) {
    let began = ThreadTime::now();
    let mut best = f64::INFINITY;
    for repeat in 1.. {
        let start = ThreadTime::now();
        let result = run();
        best = best.min(start.elapsed().as_secs_f64());
        if began.elapsed() >= LEAST || repeat == MOST_REPEATS {
            return (result, best);
        }
    }
    unreachable!("the repeats end")
}
