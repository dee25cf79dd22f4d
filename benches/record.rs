//! McManus under a whole record, at each level of detail: time per run beside the right-hand-side evaluations that it
//! takes, and what it costs to watch its peaks. `make bench` runs it on El Centro 1940; otherwise RECORD names an AT2
//! file.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use nalgebra::{SMatrix, Vector4, Vector6};
use rocking::engine::DEFAULT_TOLERANCE;
use rocking::run::End;
use rocking::run::ground_motion::Segment;
use rocking::run::record::Record;
use rocking::{Detail, Motion, Parameters, Run, Structure};
use rocking_records::Reading;
use std::{env, hint::black_box, path::Path, time::Instant};

/// Length of the scene, s.
const DURATION: f64 = 15.0;

/// Runs with and without a watcher, in turn; the fastest of each are compared.
const TURNS: usize = 200;

fn record() -> Record {
    let file = env::var("RECORD").expect("RECORD must name an AT2 file; `make bench` takes El Centro 1940");
    rocking_records::read(Path::new(&file), &Reading::default(), 9.81).expect("the record is readable").0
}

fn run(ground: &Record, detail: Detail, tolerance: f64) -> Run<'_> {
    let structure = Structure::new(Parameters::MCMANUS).unwrap();
    Run { detail, tolerance, end: End::At(DURATION), ..Run::new(structure, ground) }
}

/// One 4×6 matrix-vector product per sample, each on the result of the last: what no propagation goes below.
fn floor(flow: &SMatrix<f64, 4, 6>, segments: &[Segment]) -> Vector4<f64> {
    segments.iter().fold(Vector4::zeros(), |x, segment| {
        flow * Vector6::new(x[0], x[1], x[2], x[3], segment.ground.value.a_g, segment.ground.slope.a_g)
    })
}

fn levels(criterion: &mut Criterion) {
    let ground = record();
    let segments: Vec<Segment> = ground.segments_until(DURATION).collect();
    let mut group = criterion.benchmark_group("record");
    group.throughput(Throughput::Elements(segments.len() as u64));
    let flow = black_box(SMatrix::<f64, 4, 6>::from_fn(|i, j| if i == j { 0.99 } else { 1e-3 * (i + 2 * j) as f64 }));
    group.bench_function("floor", |bencher| bencher.iter(|| floor(&flow, black_box(&segments))));
    for detail in Detail::ALL {
        for tolerance in [1e-3, 1e-6, 1e-9] {
            let run = run(&ground, detail, tolerance);
            let Motion { transitions, work, .. } = run.follow(&mut ()).unwrap().motion;
            let name = format!("{} {tolerance:e}", detail.name());
            println!(
                "{name}: {} samples, {transitions} transitions, {} steps, {} right-hand-side evaluations",
                segments.len(),
                work.steps,
                work.evaluations
            );
            group.bench_function(name, |bencher| bencher.iter(|| black_box(&run).follow(&mut ()).unwrap()));
        }
    }
}

fn peaks(criterion: &mut Criterion) {
    let ground = record();
    let mut group = criterion.benchmark_group("peaks");
    for detail in Detail::ALL {
        let run = run(&ground, detail, DEFAULT_TOLERANCE);
        let mut fastest = [f64::INFINITY; 2];
        for turn in 0..2 * TURNS {
            let start = Instant::now();
            match turn % 2 {
                0 => drop(black_box(black_box(&run).follow(&mut ()))),
                _ => drop(black_box(black_box(&run).peaks())),
            }
            fastest[turn % 2] = fastest[turn % 2].min(start.elapsed().as_secs_f64());
        }
        let (peaks, finish) = run.peaks().unwrap();
        println!(
            "{}: watching peaks takes {:.1} % more time, {} right-hand-side evaluations more than {}",
            detail.name(),
            100.0 * (fastest[1] / fastest[0] - 1.0),
            peaks.evaluations(),
            finish.motion.work.evaluations
        );
        group.bench_function(detail.name(), |bencher| bencher.iter(|| black_box(&run).peaks().unwrap()));
    }
}

criterion_group!(benches, levels, peaks);
criterion_main!(benches);
