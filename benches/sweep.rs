//! The cost of a sweep beside the engine: 300,000 trivial runs, three samples each, in which the structure stays in contact.
//! The least of some rounds, in which all ways take turns, on one thread, in µs per run.

use rocking::Parameters;
use rocking::estimates::intensity::IntensityMeasure;
use rocking::run::record::Record;
use rocking_sweep::outcome::Outcome;
use rocking_sweep::plan::{NamedRecord, Plan, Population};
use rocking_sweep::row_file::Program;
use rocking_sweep::rows::Sweep;
use rocking_sweep::thread_pool;
use std::path::Path;
use std::time::Instant;
use std::{env, fs, hint::black_box};

const ROUNDS: usize = 5;
const RUNS: u32 = 300_000;

fn main() {
    let ground = Record::from_samples("", vec![0.0, 0.1, 0.2], vec![0.0, 0.01, 0.0]).unwrap();
    let motion = NamedRecord::new("ramps", ground.clone(), 1.0).unwrap();
    let scales = (1..=RUNS).map(|i| 1.0 + f64::from(i) / f64::from(RUNS)).collect();
    let plan = Plan::new(vec![Population::new("piers", Parameters::MCMANUS)], vec![motion], scales).unwrap();
    let program = Program { build: Default::default(), version: "0".into() };
    let (pool, rows) = (thread_pool(1).unwrap(), env::temp_dir().join(format!("sweep-{}.csv", std::process::id())));
    let sweep = |path: Option<&Path>| {
        let sweep = Sweep::open(&plan, false, &program, path).unwrap();
        pool.install(|| sweep.finish(|| true)).unwrap();
        black_box(sweep.table(IntensityMeasure::Pga));
    };
    let ways: [(&str, &dyn Fn()); 3] = [
        ("engine", &|| {
            let case = plan.case(0);
            let run = case.conditions.run(case.structure, &ground);
            (0..RUNS).for_each(|_| drop(black_box(Outcome::of(black_box(&run), &mut ()))));
        }),
        ("sweep in memory", &|| sweep(None)),
        ("sweep with a file", &|| {
            sweep(Some(&rows));
            fs::remove_file(&rows).unwrap();
        }),
    ];
    let mut least = [f64::INFINITY; 3];
    for _ in 0..ROUNDS {
        for ((_, way), least) in ways.iter().zip(&mut least) {
            let start = Instant::now();
            way();
            *least = least.min(start.elapsed().as_secs_f64() * 1e6 / f64::from(RUNS));
        }
    }
    for ((name, _), taken) in ways.iter().zip(least) {
        println!("{name}: {taken:.2} us per run, {:.2} us beside the engine", taken - least[0]);
    }
}
