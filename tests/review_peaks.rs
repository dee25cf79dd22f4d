//! Fuzz: peaks against dense sampling of the same pieces.
#![allow(non_snake_case)]
use rocking::run::peaks::{PEAKS, Peaks};
use rocking::{Detail, Engine, LinearLoad, Load, Parameters, Piece, Progress, State, Structure, Watch};

struct Rng(u64);
impl Rng {
    fn next(&mut self) -> f64 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 7;
        self.0 ^= self.0 << 17;
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }
    fn range(&mut self, a: f64, b: f64) -> f64 {
        a + (b - a) * self.next()
    }
    fn log(&mut self, a: f64, b: f64) -> f64 {
        (self.range(a.ln(), b.ln())).exp()
    }
    fn sym(&mut self) -> f64 {
        self.range(-1.0, 1.0)
    }
    fn pick(&mut self, n: usize) -> usize {
        (self.next() * n as f64) as usize
    }
}

#[derive(Default)]
struct Dense {
    largest: [f64; 7],
    n: usize,
    leaps: usize,
    pieces: usize,
    at: [f64; 7],
}
impl Watch for Dense {
    const SEES_PIECES: bool = true;
    fn piece(&mut self, piece: &mut Piece) {
        let (t0, d) = (piece.before.time, piece.duration);
        self.pieces += 1;
        if piece.is_leap() {
            self.leaps += 1;
        }
        let n = self.n;
        for i in 0..=n {
            let t = t0 + d * i as f64 / n as f64;
            let o = piece.sample(t).outputs();
            let v = [o.theta, o.u, o.delta_t, o.uplift, o.a_t, o.V_t, o.M_t];
            for k in 0..7 {
                if v[k].abs() > self.largest[k] {
                    self.largest[k] = v[k].abs();
                    self.at[k] = t;
                }
            }
        }
    }
}

fn scene(seed: u64) -> (Parameters, State, Detail, Rng) {
    let mut r = Rng(seed.wrapping_mul(0x9E3779B97F4A7C15) | 1);
    for _ in 0..5 {
        r.next();
    }
    let detail = Detail::ALL[r.pick(6)];
    let B = r.log(0.05, 5.0);
    let H = B * r.log(0.5, 12.0);
    let m = r.log(1.0, 1e5);
    let zetas = [0.0, 0.02, 0.3, 1.0, 1.7, 0.05];
    let p = Parameters {
        m,
        H,
        B,
        m0: m * r.range(0.0, 1.5),
        J0: if r.next() < 0.5 { 0.0 } else { m * B * B * r.next() },
        f_fc: r.log(0.3, 60.0),
        zeta_fc: zetas[r.pick(6)],
        r: r.range(0.5, 1.0),
        ..Parameters::MCMANUS
    };
    let s = Structure::new(p).unwrap();
    let mut state = State::default();
    if detail != Detail::Rigid {
        state.u = s.u_cr * r.sym() * [0.0, 0.5, 1.0, 2.0][r.pick(4)];
        state.u_dot = s.u_cr * s.omega_fc * r.sym() * [0.0, 0.5, 1.0, 2.0][r.pick(4)];
    }
    if detail != Detail::FixedBase && r.next() < 0.6 {
        state.theta = r.sym() * [1e-4, 0.1, 1.0, 1.5][r.pick(4)];
        state.theta_dot = r.sym() * s.p_l * [0.0, 0.1, 1.0, 1.0][r.pick(4)];
        if state.theta == 0.0 {
            state.theta_dot = 0.0;
        }
    }
    (p, state, detail, r)
}

#[test]
fn fuzz() {
    let from: u64 = std::env::var("FROM").map_or(1, |s| s.parse().unwrap());
    let count: u64 = std::env::var("COUNT").map_or(1300, |s| s.parse().unwrap());
    let mut below = 0;
    let (mut bad, mut leaps, mut pieces, mut errors) = (0, 0, 0, 0);
    let mut t0 = std::time::Instant::now();
    for seed in from..from + count {
        let (p, state, detail, mut r) = scene(seed);
        let Ok(s) = Structure::new(p) else { continue };
        let tolerance = [1e-12, 1e-9, 1e-6][r.pick(3)];
        let mut engine = Engine::with_detail(s, state, 0.0, tolerance, detail).unwrap();
        let mut peaks = Peaks::new(&s);
        let mut dense = Dense { n: 400, ..Default::default() };
        let g = 9.81 * s.tan_alpha_cg;
        let mut load = Load::default();
        let amp = g * [0.0, 0.3, 1.0, 3.0][r.pick(4)];
        let force = [0.0, 0.3, 1.0][r.pick(3)] * p.m * g;
        let h = r.log(1e-4, 3.0) * if r.next() < 0.1 { 30.0 } else { 1.0 };
        let steps = 1 + (r.log(3.0, 60.0)) as usize;
        for _ in 0..steps {
            let target = Load { a_g: amp * r.sym(), F_t: force * r.sym() };
            let h = h * if r.next() < 0.2 { r.next() + 1e-3 } else { 1.0 };
            let slope = Load { a_g: (target.a_g - load.a_g) / h, F_t: (target.F_t - load.F_t) / h };
            match engine.advance(h, LinearLoad { value: load, slope }, &mut (&mut dense, &mut peaks)) {
                Ok(Progress::Complete) => {}
                Ok(Progress::Overturned) => break,
                Err(e) => {
                    errors += 1;
                    let _ = e;
                    break;
                }
            }
            load = target;
            if dense.pieces > 4000 {
                break;
            }
        }
        leaps += dense.leaps;
        pieces += dense.pieces;
        for (k, peaking) in PEAKS.iter().enumerate() {
            let (peak, d) = ((peaking.of)(&peaks), dense.largest[k]);
            let excess = if d == 0.0 && peak.magnitude == 0.0 { 0.0 } else { peak.magnitude / d - 1.0 };
            if !(excess > -1e-9) || !(excess < 2e-2) {
                bad += 1;
                if !(excess > -1e-9) {
                    below += 1
                }
                println!(
                    "seed {seed} {} {}: peak {:e} at {} dense {:e} at {} excess {excess:e} tol {tolerance:e} h {h} trans {} end {:?}",
                    detail.name(),
                    peaking.name,
                    peak.magnitude,
                    peak.time,
                    d,
                    dense.at[k],
                    engine.motion().transitions,
                    engine.motion().phase
                );
            }
        }
        if t0.elapsed().as_secs() > 20 {
            println!("slow: at {seed}");
            t0 = std::time::Instant::now();
        }
    }
    println!("bad {bad}, leaps {leaps} of {pieces} pieces, errors {errors}");
    assert_eq!(below, 0, "peaks below what was sampled");
}
