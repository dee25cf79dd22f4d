//! McManus under a whole record, at each level of detail: time per run beside the right-hand-side evaluations that it
//! takes. `make bench` runs it on El Centro 1940; otherwise RECORD names an AT2 file.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use nalgebra::{SMatrix, Vector4, Vector6};
use rocking::record::{Record, Segment, Unit};
use rocking::{Detail, Engine, Motion, Parameters, State, Structure};
use std::{env, hint::black_box, path::Path};

/// Length of the scene, s.
const DURATION: f64 = 15.0;

fn run(structure: Structure, segments: &[Segment], detail: Detail, tolerance: f64) -> Motion {
    let mut engine = Engine::with_detail(structure, State::default(), segments[0].start, tolerance, detail).unwrap();
    for segment in segments {
        engine.advance(segment.end - segment.start, segment.a_g, &mut ()).unwrap();
    }
    *engine.motion()
}

/// One 4×6 matrix-vector product per sample, each on the result of the last: what no propagation goes below.
fn floor(flow: &SMatrix<f64, 4, 6>, segments: &[Segment]) -> Vector4<f64> {
    segments.iter().fold(Vector4::zeros(), |x, segment| {
        flow * Vector6::new(x[0], x[1], x[2], x[3], segment.a_g.value, segment.a_g.slope)
    })
}

fn record(criterion: &mut Criterion) {
    let file = env::var("RECORD").expect("RECORD must name an AT2 file; `make bench` takes El Centro 1940");
    let record = Record::read(Path::new(&file), Unit::G, 9.81).expect("the record is readable");
    let segments: Vec<Segment> = record.segments_until(DURATION).collect();
    let structure = Structure::new(Parameters::MCMANUS).unwrap();

    let mut group = criterion.benchmark_group("record");
    group.throughput(Throughput::Elements(segments.len() as u64));
    let flow = black_box(SMatrix::<f64, 4, 6>::from_fn(|i, j| if i == j { 0.99 } else { 1e-3 * (i + 2 * j) as f64 }));
    group.bench_function("floor", |bencher| bencher.iter(|| floor(&flow, black_box(&segments))));
    for detail in Detail::ALL {
        for tolerance in [1e-3, 1e-6, 1e-9] {
            let Motion { transitions, work, .. } = run(structure, &segments, detail, tolerance);
            let name = format!("{} {tolerance:e}", detail.name());
            println!(
                "{name}: {} samples, {transitions} transitions, {} steps, {} right-hand-side evaluations",
                segments.len(),
                work.steps,
                work.evaluations
            );
            group.bench_function(name, |bencher| {
                bencher.iter(|| run(structure, black_box(&segments), detail, tolerance))
            });
        }
    }
}

criterion_group!(benches, record);
criterion_main!(benches);
