//! McManus under a whole record, at each level of detail: time per run beside the right-hand-side evaluations that it
//! takes, and what it costs to watch its peaks. `make measure WHAT=record` runs it on El Centro 1940; otherwise RECORD names
//! an AT2 file.

use criterion::{Criterion, Throughput, criterion_group, criterion_main};
use rocking::engine::DEFAULT_TOLERANCE;
use rocking::estimates::response_spectrum::{FloorContents, floor_spectra};
use rocking::run::End;
use rocking::run::record::Record;
use rocking::{Detail, Motion, OneMass, Parameters, Run};
use rocking_records::Reading;
use std::{array, env, hint::black_box, path::Path, time::Instant};

/// Length of the scene, s.
const DURATION: f64 = 15.0;

fn record() -> Record {
    let file =
        env::var("RECORD").expect("RECORD must name an AT2 file; `make measure WHAT=record` takes El Centro 1940");
    rocking_records::read(Path::new(&file), &Reading::default(), 9.81).expect("the record is readable").0
}

fn run(ground: &Record, detail: Detail, tolerance: f64) -> Run<'_> {
    let structure = OneMass::new(Parameters::MCMANUS).unwrap();
    Run { detail, tolerance, end: End::At(DURATION), ..Run::new(structure, ground) }
}

fn levels(criterion: &mut Criterion) {
    let ground = record();
    let samples = ground.segments(DURATION).count();
    let mut group = criterion.benchmark_group("record");
    group.throughput(Throughput::Elements(samples as u64));
    for detail in Detail::ALL {
        for tolerance in [1e-3, 1e-6, 1e-9] {
            let run = run(&ground, detail, tolerance);
            let Motion { transitions, work, .. } = run.follow(&mut ()).unwrap().motion;
            let name = format!("{} {tolerance:e}", detail.name());
            println!(
                "{name}: {samples} samples, {transitions} transitions, {} steps, {} right-hand-side evaluations",
                work.steps, work.evaluations
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
        let (peaks, finish) = run.peaks().unwrap();
        println!(
            "{}: watching peaks takes {} right-hand-side evaluations more than {}",
            detail.name(),
            peaks.evaluations(),
            finish.motion.work.evaluations
        );
        group.bench_function(detail.name(), |bencher| bencher.iter(|| black_box(&run).peaks().unwrap()));
    }
}

/// The spectrum of the floor at 100 periods from 0.02 to 4 s, which may take fifteen times as long as the run with its peaks.
fn spectrum(criterion: &mut Criterion) {
    let ground = record();
    let mut group = criterion.benchmark_group("spectrum");
    let run = run(&ground, Detail::Auto, DEFAULT_TOLERANCE);
    let contents: [_; 100] =
        array::from_fn(|i| FloorContents { floor: 0, T: 0.02 * f64::powf(200.0, i as f64 / 99.0), zeta: 0.05 });
    let spectrum = || floor_spectra(black_box(&run), DURATION, &contents, &mut ()).unwrap();
    let fastest = |work: &dyn Fn()| {
        let time = |_| {
            let start = Instant::now();
            work();
            start.elapsed().as_secs_f64()
        };
        (0..20).map(time).fold(f64::INFINITY, f64::min)
    };
    let ratio = fastest(&|| drop(black_box(spectrum()))) / fastest(&|| drop(black_box(run.peaks().unwrap())));
    println!("the spectrum takes {ratio:.1} times as long as the run with its peaks");
    group.bench_function("100 periods", |bencher| bencher.iter(spectrum));
}

criterion_group!(benches, levels, peaks, spectrum);
criterion_main!(benches);
