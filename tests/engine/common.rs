//! Shared by several tests: a ground motion, random numbers, transitions of an advance, peaks beside samples, momenta.

use fastrand::Rng;
use rocking::engine::{DEFAULT_TOLERANCE, Settings};
use rocking::run::peaks::{Peak, Peaks};
use rocking::run::record::Record;
use rocking::run::{Run, Runs};
use rocking::{Detail, Engine, LinearLoad, OneMass, Output, Parameters, Phase, Sample, State, Transition};

/// Nodes and weights of Gauss's rule between 0 and 1.
pub const GAUSS: [(f64, f64); 4] = [
    (0.069_431_844_202_973_71, 0.173_927_422_568_726_93),
    (0.330_009_478_207_571_87, 0.326_072_577_431_273_07),
    (0.669_990_521_792_428_1, 0.326_072_577_431_273_07),
    (0.930_568_155_797_026_3, 0.173_927_422_568_726_93),
];

/// `count` samples of `a_g` (m/s²), `dt` (s) apart.
pub fn sampled(count: usize, dt: f64, a_g: impl Fn(f64) -> f64) -> Record {
    let times = Vec::from_iter((0..count).map(|i| i as f64 * dt));
    let a_g = times.iter().map(|t| a_g(*t)).collect();
    Record::from_samples("", times, a_g).unwrap()
}

/// `count` samples of a sum of sines that grows and fades, `dt` (s) apart, of about `peak` (m/s²).
pub fn shaking(seed: u32, dt: f64, count: usize, peak: f64) -> Record {
    let phase = f64::from(seed);
    sampled(count, dt, |t| {
        let waves = (5.1 * t + phase).sin() + 0.7 * (13.7 * t + 2.0 * phase).sin() + 0.4 * (37.3 * t + phase).cos();
        peak * (t / 0.5).min(1.0) * (-0.15 * t).exp() * waves
    })
}

pub fn between(rng: &mut Rng, low: f64, high: f64) -> f64 {
    low + (high - low) * rng.f64()
}

/// Evenly distributed in its logarithm.
pub fn log_between(rng: &mut Rng, low: f64, high: f64) -> f64 {
    between(rng, low.ln(), high.ln()).exp()
}

/// max |a − b|/max |b|
pub fn distance(a: &[f64], b: &[f64]) -> f64 {
    let most = b.iter().fold(f64::MIN_POSITIVE, |most, b| most.max(b.abs()));
    a.iter().zip(b).fold(0.0_f64, |most, (a, b)| most.max((a - b).abs())) / most
}

/// One mass at the default tolerance.
pub fn start(parameters: Parameters, initial: State, detail: Detail) -> Engine {
    engine_of(OneMass::new(parameters).unwrap(), initial, DEFAULT_TOLERANCE, detail)
}

/// One mass from t = 0 on.
pub fn engine_of(structure: OneMass, initial: State, tolerance: f64, detail: Detail) -> Engine {
    Engine::with(structure, initial, 0.0, Settings { detail, tolerance, ..Settings::default() }).unwrap()
}

/// The transitions of an advance over `interval` (s).
pub fn transitions<Q: Runs>(
    engine: &mut Engine<Q>,
    interval: f64,
    load: impl Into<LinearLoad<Q>>,
) -> Vec<Transition<Q>> {
    let mut transitions = Vec::new();
    engine.advance(interval, load, &mut |transition: &Transition<Q>| transitions.push(*transition)).unwrap();
    transitions
}

/// The transitions of a run.
pub fn transitions_of<Q: Runs>(run: &Run<Q>) -> Vec<Transition<Q>> {
    let mut transitions = Vec::new();
    run.follow(&mut |transition: &Transition<Q>| transitions.push(*transition)).unwrap();
    transitions
}

/// The peaks of `run`, which no sample at `times` (s) exceeds; those of the `outputs` are beyond the samples by the part `above`
/// at most. `see` is shown the samples.
pub fn peaks_beside_samples<Q: Runs>(
    run: &Run<Q>,
    times: impl Iterator<Item = f64>,
    outputs: &[Output],
    above: f64,
    mut see: impl FnMut(&Sample<Q>),
) -> Peaks {
    let (peaks, _) = run.peaks().unwrap();
    let mut largest = vec![Peak::default(); outputs.len()];
    let show = |sample: &Sample<Q>| {
        for (largest, of) in largest.iter_mut().zip(outputs) {
            let (magnitude, time) = (sample.output(*of).abs(), sample.motion.time);
            if magnitude > largest.magnitude {
                *largest = Peak { magnitude, time };
            }
        }
        see(sample);
    };
    run.sample(times, show, &mut ()).unwrap();
    for (of, sampled) in outputs.iter().zip(largest) {
        let peak = peaks.of(*of).unwrap();
        let (least, most) = (sampled.magnitude * (1.0 - 1e-12), sampled.magnitude * (1.0 + above));
        assert!((least..=most).contains(&peak.magnitude), "{:?}, {of:?}: {peak:?}, {sampled:?}", run.detail);
    }
    peaks
}

/// One mass as the geometry stands: places of the top mass and of the middle of the base, their momenta to the right and upwards, the
/// angular momentum about the origin, and the kinetic energy.
pub struct Balance {
    pub x: [f64; 2],
    pub y: [f64; 2],
    pub right: f64,
    pub up: f64,
    pub turning: f64,
    pub kinetic: f64,
}

pub fn balance(&Parameters { m, m0, H, B, J0, .. }: &Parameters, phase: Phase, state: &State) -> Balance {
    let &State { u, u_dot, theta, theta_dot } = state;
    let pivot = phase.side().sign() * B;
    let (sin, cos) = theta.sin_cos();
    let x = [pivot * (1.0 - cos) + u * cos + H * sin, pivot * (1.0 - cos)];
    let y = [(pivot - u) * sin + H * cos, pivot * sin];
    let v = [u_dot * cos + y[0] * theta_dot, y[1] * theta_dot];
    let w = [(pivot - x[0]) * theta_dot - u_dot * sin, (pivot - x[1]) * theta_dot];
    let sum = |of: &dyn Fn(usize) -> f64| m * of(0) + m0 * of(1);
    Balance {
        x,
        y,
        right: sum(&|i| v[i]),
        up: sum(&|i| w[i]),
        turning: sum(&|i| y[i] * v[i] - x[i] * w[i]) + J0 * theta_dot,
        kinetic: 0.5 * (sum(&|i| v[i] * v[i] + w[i] * w[i]) + J0 * theta_dot * theta_dot),
    }
}
