#![allow(non_snake_case)]
use rocking::record::Record;
use rocking::run::{End, Run};
use rocking::{Detail, Parameters, State, Structure};

fn noise(seed: u64) -> impl FnMut() -> f64 {
    let mut x = seed;
    move || {
        x = x.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (x >> 11) as f64 / (1u64 << 52) as f64 - 1.0
    }
}

/// Times asked for and times shown.
#[test]
fn samples_shown() {
    let structure = Structure::new(Parameters::MCMANUS).unwrap();
    for (name, at) in [
        ("i*dt", (|i: usize| i as f64 * 0.01) as fn(usize) -> f64),
        ("i/100", |i| i as f64 / 100.0),
        ("from -5", |i| -5.0 + i as f64 * 0.01),
    ] {
        for (name2, out) in [
            ("i*dt", (|i: usize| i as f64 * 0.01) as fn(usize) -> f64),
            ("i/100", |i| i as f64 / 100.0),
            ("i*.002", |i| i as f64 * 0.002),
            ("i/500", |i| i as f64 / 500.0),
            ("i*0.001", |i| i as f64 * 0.001),
        ] {
            let mut n = noise(3);
            let times: Vec<_> = (0..2000).map(at).collect();
            let a: Vec<_> = (0..2000)
                .map(|i| {
                    let t = i as f64 * 0.01;
                    2.6 * (15.0 * t).sin() * (-0.05 * t).exp() + 0.5 * n()
                })
                .collect();
            let ground = Record::from_samples("x", times, a).unwrap();
            for end in [ground.end(), 19.99] {
                let run = Run { end: End::At(end), ..Run::new(structure, &ground) };
                let asked: Vec<f64> =
                    (0..20000).map(out).map(|t| t + ground.start()).take_while(|t| *t <= end).collect();
                let mut shown: Vec<f64> = Vec::new();
                let finish = run.sample(asked.iter().copied(), |s| shown.push(s.motion.time), &mut ()).unwrap();
                let mut expected: Vec<f64> = asked.iter().copied().filter(|t| *t < finish.motion.time).collect();
                expected.push(finish.motion.time);
                let missing: Vec<_> = expected.iter().filter(|t| !shown.contains(t)).collect();
                let twice = shown.windows(2).filter(|p| p[0] >= p[1]).count();
                println!(
                    "record {name} out {name2} end {end}: asked {} shown {} expected {} missing {:?} not rising {twice} transitions {} end {:?}",
                    asked.len(),
                    shown.len(),
                    expected.len(),
                    missing,
                    finish.motion.transitions,
                    finish.ending
                );
            }
        }
    }
}

/// A fine record blinds the comparison of histories.
#[test]
fn fine_records() {
    for parts in [1, 10, 100, 1000] {
        let structure = Structure::new(Parameters { f_fc: 1.0, ..Parameters::MCMANUS }).unwrap();
        let dt = 0.01 / parts as f64;
        let times: Vec<_> = (0..=300 * parts).map(|i| i as f64 * dt).collect();
        let coarse = |i: usize| {
            let t = i as f64 * 0.01;
            if t > 1.5 { 0.0 } else { 4.0 * (9.0 * t).sin() }
        };
        let a: Vec<_> = (0..=300 * parts)
            .map(|i| {
                let (k, f) = (i / parts, (i % parts) as f64 / parts as f64);
                coarse(k) * (1.0 - f) + coarse(k + 1) * f
            })
            .collect();
        let ground = Record::from_samples("x", times, a).unwrap();
        let run = Run { end: End::At(3.0), ..Run::new(structure, &ground) };
        let comparison = rocking::run::levels::compare(&run).unwrap();
        println!("dt {dt} T_u {}", std::f64::consts::TAU / structure.omega_u);
        assert!(
            comparison.verdicts[0].errors[3] > 0.99,
            "fixed base: history of theta {}",
            comparison.verdicts[0].errors[3]
        );
        for v in &comparison.verdicts {
            println!(
                "  {:10} {:?} trans {} of {}",
                v.response.detail.name(),
                v.errors,
                v.response.transitions,
                comparison.reference.transitions
            );
        }
    }
}

#[test]
fn edges() {
    let structure = Structure::new(Parameters::MCMANUS).unwrap();
    let ground = Record::from_samples("x", vec![2.0, 3.0, 4.0], vec![5.0, -3.0, 1.0]).unwrap();
    for end in [End::At(1.0), End::At(2.0), End::At(2.5), End::At(f64::NAN), End::At(f64::INFINITY), End::AtRest] {
        for detail in [Detail::Rigid, Detail::Auto, Detail::FixedBase] {
            let run = Run { end, detail, ..Run::new(structure, &ground) };
            let mut shown = Vec::new();
            let finish = run.sample(
                [1.0, 2.0, 2.2, 4.0, 5.0],
                |s| shown.push((s.motion.time, s.load.a_g, s.outputs().a_t)),
                &mut (),
            );
            println!("{end:?} {detail:?}: {:?} {shown:?}", finish.map(|f| (f.ending, f.motion.time)));
        }
    }
    // 1e-12 noise on an undamped structure; r = 1
    for (z, r) in [(0.0, 1.0), (0.0, 0.9), (0.02, 0.9), (1e-4, 0.5), (10.0, 0.9)] {
        let structure = Structure::new(Parameters { zeta_fc: z, r, ..Parameters::MCMANUS }).unwrap();
        let run = Run { initial: State { theta: 0.05, ..State::default() }, ..Run::new(structure, &ground) };
        let t = std::time::Instant::now();
        println!(
            "zeta {z} r {r}: {:?} in {:?}",
            run.peaks().map(|(p, f)| (f.ending, f.motion.time, f.motion.transitions, p.theta().magnitude)),
            t.elapsed()
        );
    }
}

/// same bits whatever the start time
#[test]
fn start_times() {
    let structure = Structure::new(Parameters::MCMANUS).unwrap();
    for detail in Detail::ALL {
        let mut all = Vec::new();
        for start in [0.0, -1000.0, 1e6, 1.7e9, 1e12] {
            let mut engine = rocking::Engine::with_detail(structure, State::default(), start, 1e-9, detail).unwrap();
            let mut n = noise(5);
            let mut before = 0.0;
            for _ in 0..3000 {
                let a = 6.0 * n();
                engine.advance(0.01, rocking::Ramp { value: before, slope: (a - before) / 0.01 }, &mut ()).unwrap();
                before = a;
            }
            all.push((engine.motion().state, engine.motion().transitions));
        }
        println!("{detail:?} {} {:?}", all.iter().all(|s| *s == all[0]), all[0].1);
    }
}

/// Samples read from a long leap are those of many short advances.
#[test]
fn samples_of_long_leaps() {
    let structure = Structure::new(Parameters { f_fc: 28.0, zeta_fc: 1.0, ..Parameters::MCMANUS }).unwrap();
    let ground = Record::from_samples("slow", vec![0.0, 10.0, 20.0], vec![0.0, 0.0, 1.0]).unwrap();
    let run = Run { detail: Detail::FixedBase, end: End::At(20.0), ..Run::new(structure, &ground) };
    run.sample([15.0], |s| println!("t {} a_t {} a_g {}", s.motion.time, s.outputs().a_t, s.load.a_g), &mut ())
        .unwrap();
    let mut a_t = Vec::new();
    run.sample([15.0], |s| a_t.push(s.outputs().a_t), &mut ()).unwrap();
    assert!((a_t[0] - 0.5).abs() < 2e-3, "a_t {} beside a_g 0.5", a_t[0]);
}
