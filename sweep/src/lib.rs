//! Many runs: plans of cases, maps over pulses, what became of each run, how often limits are exceeded.

pub mod condition;
pub mod design;
pub mod exceedances;
pub mod fragility;
pub mod map;
pub mod outcome;
pub mod plan;
pub mod pulse;
pub mod row_file;
pub mod rows;
pub mod synthetic;

use rayon::{ThreadPool, ThreadPoolBuilder};
pub use rocking::Refused;
use rocking::structure::quantity::ensure;

const MOST_THREADS: i64 = 1024;

/// The threads that do `threads` runs at a time; 0 is one per core.
pub fn thread_pool(threads: i64) -> Result<ThreadPool, Refused> {
    ensure((0..=MOST_THREADS).contains(&threads), || {
        format!("threads = {threads} is out of range: 0, which is one per core, to {MOST_THREADS} are possible")
    })?;
    ThreadPoolBuilder::new().num_threads(threads as usize).build().map_err(Refused::by)
}
