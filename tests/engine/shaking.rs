//! A ground motion for tests.

use rocking::run::record::Record;

/// `count` samples of a sum of sines that grows and fades, `dt` (s) apart, of about `peak` (m/s²).
pub fn shaking(seed: u32, dt: f64, count: usize, peak: f64) -> Record {
    let phase = f64::from(seed);
    let sample = |i: usize| {
        let t = i as f64 * dt;
        let waves = (5.1 * t + phase).sin() + 0.7 * (13.7 * t + 2.0 * phase).sin() + 0.4 * (37.3 * t + phase).cos();
        peak * (t / 0.5).min(1.0) * (-0.15 * t).exp() * waves
    };
    let times = (0..count).map(|i| i as f64 * dt).collect();
    Record::from_samples("shaking", times, (0..count).map(sample).collect()).unwrap()
}
