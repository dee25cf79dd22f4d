//! A synthetic ground motion: noise through the soil of Kanai and Tajimi and the filter of Clough and Penzien.
//!
//! ```text
//! ẍ_g + 2 ζ_g ω_g ẋ_g + ω_g² x_g = −w,        a_1 = 2 ζ_g ω_g ẋ_g + ω_g² x_g
//! ẍ_f + 2 ζ_f ω_f ẋ_f + ω_f² x_f = a_1,       a_g = ẍ_f e(t)
//! ```
//!
//! w is white noise. ω_g = 15.6 rad/s and ζ_g = 0.6 are firm soil. ω_f = ω_g/10 and ζ_f = ζ_g remove periods longer than
//! those of earthquakes (Clough and Penzien 1975). e(t) rises as t² over a sixth of the duration, stays 1 for a third and
//! then decays by e^(−4). The proportions follow Jennings, Housner and Tsai (1968).

use crate::{Refused, ensure};
use rocking::run::record::{MAX_SAMPLES, Record};

/// Time between samples, s.
const STEP: f64 = 0.005;

const OMEGA_G: f64 = 15.6;
const ZETA: f64 = 0.6;
const OMEGA_F: f64 = 0.1 * OMEGA_G;

/// The motion of noise that begins with `seed`, whose peak is `pga` (m/s²), over `duration` (s).
pub fn record(pga: f64, duration: f64, seed: u64) -> Result<Record, Refused> {
    let (samples, longest) = ((duration / STEP).ceil() + 1.0, STEP * (MAX_SAMPLES / 100) as f64);
    ensure(samples >= 3.0 && duration <= longest, || {
        format!("duration = {duration} s is out of range: it must lie between {} and {longest} s", 2.0 * STEP)
    })?;
    let mut random = fastrand::Rng::with_seed(seed);
    let filter = |omega: f64, [x, v]: &mut [f64; 2], a: f64| {
        *v += STEP * (a - 2.0 * ZETA * omega * *v - omega * omega * *x);
        *x += STEP * *v;
        2.0 * ZETA * omega * *v + omega * omega * *x
    };
    let (mut soil, mut high_pass) = ([0.0; 2], [0.0; 2]);
    let times: Vec<f64> = (0..samples as usize).map(|i| i as f64 * STEP).collect();
    let at = |time: f64| {
        // twelve evenly distributed numbers make one that is nearly normal
        let noise = (0..12).map(|_| random.f64()).sum::<f64>() - 6.0;
        let a_1 = filter(OMEGA_G, &mut soil, -noise);
        let a_g = a_1 - filter(OMEGA_F, &mut high_pass, a_1);
        let part = time / duration;
        a_g * if part < 0.5 { (6.0 * part).min(1.0).powi(2) } else { libm::exp(-8.0 * (part - 0.5)) }
    };
    let motion: Vec<f64> = times.iter().copied().map(at).collect();
    let peak = motion.iter().fold(0.0_f64, |most, a| most.max(a.abs()));
    let acceleration = motion.iter().map(|a| pga / peak * a).collect();
    Record::from_samples(format!("synthetic motion {seed}"), times, acceleration).map_err(Refused::by)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_motion_has_the_peak_asked_for_and_leaves_the_ground_nearly_at_rest() {
        for seed in 0..20 {
            let motion = record(4.0, 20.0, seed).unwrap();
            assert!((motion.pga() - 4.0).abs() < 1e-12 && motion.end() == 20.0);
            let [velocity, _] = motion.velocities_and_displacements().last().unwrap();
            let largest = motion.velocities_and_displacements().fold(0.0_f64, |most, [v, _]| most.max(v.abs()));
            assert!(velocity.abs() < 0.5 * largest, "{seed}: {velocity} m/s of {largest} m/s");
            assert_eq!(motion, record(4.0, 20.0, seed).unwrap());
        }
        assert_ne!(record(4.0, 20.0, 1).unwrap(), record(4.0, 20.0, 2).unwrap());
    }
}
