//! Peaks, and what motions go beyond, against dense sampling of the same pieces: random structures, states and loads at all
//! levels.
#![allow(non_snake_case)]

use rocking::run::peaks::{PEAKS, Peaks};
use rocking::run::validity::{Found, Limits, Validity};
use rocking::{
    Detail, Engine, LinearLoad, Load, Outputs, Parameters, Phase, Piece, Progress, Reactions, State, Structure, Watch,
};

/// A xorshift generator.
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

/// Samples of each piece.
struct Dense {
    parameters: Parameters,
    largest: [f64; PEAKS.len()],
    /// (|R_m|/B − R_v)/W in full contact, −R_v/W, and |R_h|/R_v while R_v > 0, otherwise ∞.
    worst: [f64; 3],
    /// How long each of them is beyond its limit, s.
    beyond: [f64; 3],
    pieces: usize,
}

/// The magnitudes in the order of [`PEAKS`].
fn magnitudes(o: Outputs) -> [f64; PEAKS.len()] {
    [o.theta, o.u, o.delta_t, o.uplift, o.a_t, o.V_t, o.M_t].map(f64::abs)
}

/// As in [`Dense::worst`].
fn worst(&Parameters { m, m0, B, g, .. }: &Parameters, phase: Phase, r: Reactions) -> [f64; 3] {
    let weight = (m + m0) * g;
    let friction = if r.R_v > 0.0 { r.R_h.abs() / r.R_v } else { f64::INFINITY };
    let tension = if phase == Phase::FullContact { (r.R_m.abs() / B - r.R_v) / weight } else { -1.0 };
    [tension, -r.R_v / weight, friction]
}

/// What lasts for no time is no motion.
impl Watch for Dense {
    const SEES_PIECES: bool = true;

    fn piece(&mut self, piece: &Piece) {
        const SAMPLES: u32 = 400;
        self.pieces += 1;
        let (start, duration, phase) = (piece.before.time, piece.duration, piece.before.phase);
        let Limits { tension, edge_load, friction, .. } = Limits::default();
        for i in (0..=SAMPLES).filter(|_| duration > 0.0) {
            let sample = piece.sample(start + duration * f64::from(i) / f64::from(SAMPLES));
            let values = worst(&self.parameters, phase, sample.reactions());
            for (i, (value, limit)) in values.into_iter().zip([tension, -edge_load, friction]).enumerate() {
                self.worst[i] = value.max(self.worst[i]);
                self.beyond[i] += if value > limit { duration / f64::from(SAMPLES + 1) } else { 0.0 };
            }
            let values = magnitudes(sample.outputs());
            self.largest.iter_mut().zip(values).for_each(|(largest, value)| *largest = value.max(*largest));
        }
    }
}

/// What a motion shows at the instants at which it was found to be largest and worst.
struct There {
    parameters: Parameters,
    peaks: [(f64, f64); PEAKS.len()],
    worst: [(f64, f64); 3],
}

impl Watch for There {
    const SEES_PIECES: bool = true;

    fn piece(&mut self, piece: &Piece) {
        let (start, duration, phase) = (piece.before.time, piece.duration, piece.before.phase);
        // the clock rounds
        let slack = 4.0 * f64::EPSILON * (start.abs() + duration);
        let is_within = |time: f64| duration > 0.0 && time >= start - slack && time <= start + duration + slack;
        let sample = |time: f64| {
            let sample = piece.sample(time.max(start));
            (magnitudes(sample.outputs()), worst(&self.parameters, phase, sample.reactions()))
        };
        for (i, (time, shown)) in self.peaks.iter_mut().enumerate().filter(|(_, (time, _))| is_within(*time)) {
            *shown = shown.max(sample(*time).0[i]);
        }
        for (i, (time, shown)) in self.worst.iter_mut().enumerate().filter(|(_, (time, _))| is_within(*time)) {
            *shown = shown.max(sample(*time).1[i]);
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
        c_ratio: [1.0, 1.0, 0.0, 4.0][r.pick(4)],
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

/// No peak lies below what is sampled, and each is what the motion shows at its instant; nor is what is found of
/// assumptions, but for friction that is infinite from where R_v is 0. COUNT sets how many scenes are tried.
#[test]
fn no_peak_is_missed() {
    let count = std::env::var("COUNT").map_or(600, |count| count.parse().unwrap());
    for seed in 1..=count {
        let (parameters, state, detail, mut r) = scene(seed);
        let structure = Structure::new(parameters).unwrap();
        let tolerance = [1e-12, 1e-9, 1e-6][r.pick(3)];
        let start = || Engine::with_detail(structure, state, 0.0, tolerance, detail).unwrap();
        let mut engine = start();
        let mut peaks = Peaks::new(&structure);
        let mut validity = Validity::new(&structure, Limits::default(), Found::since(0.0));
        let mut dense = Dense {
            parameters,
            largest: [0.0; PEAKS.len()],
            worst: [-1.0, f64::NEG_INFINITY, 0.0],
            beyond: [0.0; 3],
            pieces: 0,
        };
        let weight = 9.81 * structure.tan_alpha_cg;
        let amplitude = weight * [0.0, 0.3, 1.0, 3.0][r.pick(4)];
        let force = parameters.m * weight * [0.0, 0.3, 1.0][r.pick(3)];
        let longest = r.log(1e-4, 3.0) * if r.next() < 0.1 { 30.0 } else { 1.0 };
        let (mut load, mut fastest) = (Load::default(), 0.0_f64);
        if r.next() < 0.3 {
            load.a_g = amplitude * r.sym(); // it begins with a jump
        }
        let mut advances = Vec::new();
        for _ in 0..=r.log(3.0, 60.0) as usize {
            let target = Load { a_g: amplitude * r.sym(), F_t: force * r.sym(), a_v: 0.0 };
            let h = longest * if r.next() < 0.2 { r.next() + 1e-3 } else { 1.0 };
            let slope = Load { a_g: (target.a_g - load.a_g) / h, F_t: (target.F_t - load.F_t) / h, a_v: 0.0 };
            let watch = &mut (&mut dense, &mut (&mut peaks.watch(), &mut validity));
            advances.push((h, LinearLoad { value: load, slope }));
            let progress = engine.advance(h, LinearLoad { value: load, slope }, watch);
            fastest = fastest.max(h * structure.omega_u);
            if progress != Ok(Progress::Complete) || dense.pieces > 4000 {
                break;
            }
            load = target;
        }
        let found = validity.found().worst;
        for (i, sign) in [1.0, -1.0, 1.0].into_iter().enumerate() {
            let (worst, sampled) = (sign * found[i].value, dense.worst[i]);
            let slack = 1e-9 * (1.0 + sampled.abs());
            assert!(
                worst == sampled || worst >= sampled - slack,
                "scene {seed}, {}: {i}: {worst} < {sampled}",
                detail.name()
            );
            let off = (found[i].beyond - dense.beyond[i]).abs();
            let all = validity.found().duration;
            // samples tell how long where they are dense enough to see each vibration
            assert!(
                fastest > 100.0 || off <= 0.01 * all,
                "scene {seed}, {}: {i}: beyond for {off} of {all} s",
                detail.name()
            );
        }
        let mut there = There {
            parameters,
            peaks: PEAKS.each_ref().map(|peaking| ((peaking.of)(&peaks).time, 0.0)),
            worst: [0, 1, 2].map(|i| (found[i].time, f64::NEG_INFINITY)),
        };
        engine = start();
        for (h, load) in advances {
            let _ = engine.advance(h, load, &mut there);
        }
        for ((peaking, sampled), (time, shown)) in PEAKS.iter().zip(dense.largest).zip(there.peaks) {
            let peak = (peaking.of)(&peaks).magnitude;
            let name = format!("scene {seed}, {}: {} = {peak} at {time} s", detail.name(), peaking.name);
            assert!(peak >= sampled * (1.0 - 1e-9), "{name} < {sampled}");
            assert!((peak - shown).abs() <= 1e-9 * peak, "{name}, where it is {shown}");
        }
        for (i, (time, shown)) in there.worst.into_iter().enumerate() {
            let value = if i == 1 { -found[i].value } else { found[i].value };
            let name = format!("scene {seed}, {}: {i}: {value} at {time} s", detail.name());
            if value == f64::INFINITY {
                assert_eq!(Some(time), found[1].first_beyond, "{name}");
            } else if value != [-1.0, f64::NEG_INFINITY, 0.0][i] {
                assert!((value - shown).abs() <= 1e-9 * (1.0 + value.abs()), "{name}, where it is {shown}");
            }
        }
    }
}
