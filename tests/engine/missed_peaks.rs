//! Peaks, and what motions go beyond, against dense sampling of the same pieces: random structures, states and loads at all
//! levels.

use crate::common::{between, log_between};
use fastrand::Rng;
use rocking::engine::Settings;
use rocking::run::peaks::Peaks;
use rocking::run::validity::{Findings, Limits, Validity};
use rocking::{
    Detail, Engine, LinearLoad, Load, OneMass, Output, Parameters, Phase, Piece, Progress, Sample, State, Watch,
};

/// From -1 to 1.
fn either_way(rng: &mut Rng) -> f64 {
    between(rng, -1.0, 1.0)
}

/// Samples of each piece.
struct Dense {
    parameters: Parameters,
    largest: [f64; SHOWN],
    /// How long each of the last three is beyond its limit, s, and the first sample that is.
    beyond: [f64; 3],
    first: [Option<f64>; 3],
    pieces: usize,
}

const PEAKS: [Output; Output::PEAKS_OF_ONE.len()] = Output::PEAKS_OF_ONE;
const SHOWN: usize = PEAKS.len() + 3;

/// The shown numbers before any sample.
const NOTHING: [f64; SHOWN] = {
    let mut all = [0.0; SHOWN];
    (all[SHOWN - 3], all[SHOWN - 2]) = (f64::NEG_INFINITY, f64::NEG_INFINITY);
    all
};

/// The magnitudes in the order of [`PEAKS`], then (|R_m|/B − R_v)/W in full contact, −R_v/W, and |R_h|/R_v while R_v > 0,
/// otherwise ∞.
fn shown(&Parameters { m, m0, B, g, .. }: &Parameters, sample: &Sample) -> [f64; SHOWN] {
    let (weight, r) = ((m + m0) * g, sample.reactions());
    let friction = if r.R_v > 0.0 { r.R_h.abs() / r.R_v } else { f64::INFINITY };
    let is_down = sample.motion.phase == Phase::FullContact;
    let tension = if is_down { (r.R_m.abs() / B - r.R_v) / weight } else { f64::NEG_INFINITY };
    let mut shown = [0.0; SHOWN];
    shown[..PEAKS.len()].copy_from_slice(&PEAKS.map(sample.outputs()).map(f64::abs));
    shown[PEAKS.len()..].copy_from_slice(&[tension, -r.R_v / weight, friction]);
    shown
}

/// A piece of no duration is no motion.
impl Watch for Dense {
    fn piece(&mut self, piece: &Piece) {
        const SAMPLES: u32 = 400;
        self.pieces += 1;
        let (start, duration) = (piece.before.time, piece.duration);
        let Limits { tension, edge_load, friction, .. } = Limits::default();
        for i in (0..=SAMPLES).filter(|_| duration > 0.0) {
            let sample = piece.sample(start + duration * f64::from(i) / f64::from(SAMPLES));
            let values = shown(&self.parameters, &sample);
            self.largest.iter_mut().zip(values).for_each(|(largest, value)| *largest = value.max(*largest));
            for (i, limit) in [tension, -edge_load, friction].into_iter().enumerate() {
                if values[PEAKS.len() + i] > limit {
                    self.beyond[i] += duration / f64::from(SAMPLES + 1);
                    self.first[i].get_or_insert(sample.motion.time);
                }
            }
        }
    }
}

/// Values of a motion at the instants of its peaks and worst values.
struct There {
    parameters: Parameters,
    at: [(f64, f64); SHOWN],
}

impl Watch for There {
    fn piece(&mut self, piece: &Piece) {
        let (start, duration) = (piece.before.time, piece.duration);
        // the clock rounds
        let slack = 4.0 * f64::EPSILON * (start.abs() + duration);
        let is_within = |time: f64| duration > 0.0 && time >= start - slack && time <= start + duration + slack;
        for (i, (time, most)) in self.at.iter_mut().enumerate().filter(|(_, (time, _))| is_within(*time)) {
            *most = most.max(shown(&self.parameters, &piece.sample(time.max(start)))[i]);
        }
    }
}

fn scene(rng: &mut Rng) -> (OneMass, State, Detail) {
    let detail = Detail::ALL[rng.usize(0..6)];
    let (m, B) = (log_between(rng, 1.0, 1e5), log_between(rng, 0.05, 5.0));
    let structure = OneMass::new(Parameters {
        m,
        B,
        H: B * log_between(rng, 0.5, 12.0),
        m0: m * between(rng, 0.0, 1.5),
        J0: if rng.bool() { 0.0 } else { m * B * B * rng.f64() },
        f_fc: log_between(rng, 0.3, 60.0),
        zeta_fc: [0.0, 0.02, 0.3, 0.7, 0.99, 0.05][rng.usize(0..6)],
        c_ratio: [1.0, 1.0, 0.0, 4.0][rng.usize(0..4)],
        r: between(rng, 0.5, 1.0),
        ..Parameters::MCMANUS
    })
    .unwrap();
    let mut state = State::default();
    if detail != Detail::Rigid {
        state.u = structure.u_cr * either_way(rng) * [0.0, 0.5, 1.0, 2.0][rng.usize(0..4)];
        state.u_dot = structure.u_cr * structure.omega_fc * either_way(rng) * [0.0, 0.5, 1.0, 2.0][rng.usize(0..4)];
    }
    if detail != Detail::FixedBase && rng.f64() < 0.6 {
        state.theta = either_way(rng) * [1e-4, 0.1, 1.0, 1.5][rng.usize(0..4)];
        state.theta_dot = either_way(rng) * structure.base().p_l * [0.0, 0.1, 1.0, 1.0][rng.usize(0..4)];
    }
    (structure, state, detail)
}

/// No peak and no worst value of an assumption lies below its samples. The motion shows each of them at its instant, but for friction
/// that is infinite from where R_v is 0. COUNT sets how many scenes are tried.
#[test]
fn no_peak_is_missed() {
    let count = std::env::var("COUNT").map_or(600, |count| count.parse().unwrap());
    for seed in 1..=count {
        let rng = &mut Rng::with_seed(seed);
        let (structure, state, detail) = scene(rng);
        let parameters = *structure.parameters();
        let tolerance = [1e-12, 1e-9, 1e-6][rng.usize(0..3)];
        let vertical = detail != Detail::Modal && seed % 4 == 0;
        let settings = Settings { detail, tolerance, vertical, stops: false };
        let start = || Engine::with(structure, state, 0.0, settings).unwrap();
        let mut engine = start();
        let [mut peaks, mut alone] = [(); 2].map(|()| Peaks::since(0.0, &structure.into(), detail));
        let mut validity = Validity::new(&structure.into(), Limits::default(), Findings::since(0.0));
        let mut dense = Dense { parameters, largest: NOTHING, beyond: [0.0; 3], first: [None; 3], pieces: 0 };
        let weight = 9.81 * structure.base().tan_alpha_cg;
        let amplitude = weight * [0.0, 0.3, 1.0, 3.0][rng.usize(0..4)];
        let force = parameters.m * weight * [0.0, 0.3, 1.0][rng.usize(0..3)];
        let longest = log_between(rng, 1e-4, 3.0) * if rng.f64() < 0.1 { 30.0 } else { 1.0 };
        let (mut load, mut fastest) = (Load::default(), 0.0_f64);
        if rng.f64() < 0.3 {
            load.a_g = amplitude * either_way(rng); // it begins with a jump
        }
        let mut advances = Vec::new();
        for _ in 0..=log_between(rng, 3.0, 60.0) as usize {
            let a_v = if vertical { 4.0 * either_way(rng) } else { 0.0 };
            let target = Load { a_g: amplitude * either_way(rng), F_t: force * either_way(rng), a_v };
            let h = longest * if rng.f64() < 0.2 { rng.f64() + 1e-3 } else { 1.0 };
            let per_second = |of: fn(&Load) -> f64| (of(&target) - of(&load)) / h;
            let slope =
                Load { a_g: per_second(|of| of.a_g), F_t: per_second(|of| of.F_t), a_v: per_second(|of| of.a_v) };
            let (mut all, mut theta) = (peaks.watch(), alone.of_theta().watch());
            let watch = &mut (&mut dense, &mut (&mut (&mut all, &mut theta), &mut validity));
            advances.push((h, LinearLoad { value: load, slope }));
            let progress = engine.advance(h, LinearLoad { value: load, slope }, watch);
            (peaks, alone) = (all.end(), theta.end());
            fastest = fastest.max(h * structure.omega_u);
            if progress != Ok(Progress::Complete) || dense.pieces > 4000 {
                break;
            }
            load = target;
        }
        let [alone, theta] = [alone.theta(), peaks.theta()];
        let is_near = |a: f64, b: f64| (a - b).abs() <= 1e-15 * b.abs();
        let is_same = is_near(alone.magnitude, theta.magnitude) && is_near(alone.time, theta.time);
        assert!(is_same, "scene {seed}, theta watched alone: {alone:?} {theta:?}");
        let found = validity.found().worst;
        let scene = format!("scene {seed}, {}", detail.name());
        for (i, sign) in [1.0, -1.0, 1.0].into_iter().enumerate() {
            let (worst, sampled) = (sign * found[i].value, dense.largest[PEAKS.len() + i]);
            let slack = 1e-9 * (1.0 + sampled.abs());
            assert!(worst == sampled || worst >= sampled - slack, "{scene}: {i}: {worst} < {sampled}");
            if let Some(first) = dense.first[i] {
                let found = found[i].first_beyond.unwrap_or(f64::INFINITY);
                assert!(found <= first * (1.0 + 1e-9), "{scene}: {i}: {found} s, not {first} s");
            }
            let off = (found[i].beyond - dense.beyond[i]).abs();
            let all = validity.found().duration;
            // samples tell how long where they are dense enough to see each vibration
            assert!(fastest > 100.0 || off <= 0.01 * all, "{scene}: {i}: beyond for {off} of {all} s");
        }
        let times =
            PEAKS.map(|output| peaks.of(output).unwrap().time).into_iter().chain([0, 1, 2].map(|i| found[i].time));
        let mut at = times.zip(NOTHING);
        let mut there = There { parameters, at: [(); SHOWN].map(|()| at.next().unwrap()) };
        engine = start();
        for (h, load) in advances {
            let _ = engine.advance(h, load, &mut there);
        }
        for ((output, sampled), (time, shown)) in PEAKS.iter().zip(dense.largest).zip(there.at) {
            let peak = peaks.of(*output).unwrap().magnitude;
            let name = format!("{scene}: {} = {peak} at {time} s", output.symbol());
            assert!(peak >= sampled * (1.0 - 1e-9), "{name} < {sampled}");
            assert!((peak - shown).abs() <= 1e-9 * peak, "{name}, where it is {shown}");
        }
        for (i, (time, shown)) in there.at.into_iter().skip(PEAKS.len()).enumerate() {
            let value = if i == 1 { -found[i].value } else { found[i].value };
            let name = format!("{scene}: {i}: {value} at {time} s");
            if value == f64::INFINITY {
                assert_eq!(Some(time), found[1].first_beyond, "{name}");
            } else if value != NOTHING[PEAKS.len() + i] {
                assert!((value - shown).abs() <= 1e-9 * (1.0 + value.abs()), "{name}, where it is {shown}");
            }
        }
    }
}
