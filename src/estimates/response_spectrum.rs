//! Response spectrum of a ground motion: S_a(T, ζ), the largest absolute acceleration of an oscillator on it.
//!
//! ```text
//! ü + 2 ζ ω u̇ + ω² u = −a_g,        S_a = max |ü + a_g| = max |2 ζ ω u̇ + ω² u|,        ω = 2π/T
//! ```
//!
//! S_a is the absolute acceleration, not the pseudo-acceleration ω² max|u|. Eqs 2 and 20 contain ü + a_g, which includes the force
//! of the damper, and S_a bounds it in Eqs 4 and 22. Both accelerations are close at small damping, but
//! ζ_u = ζ_fc c_ratio/√(1−χ) of a slender structure need not be small.
//!
//! The ground acceleration is a + b τ between two samples. The motion that follows the ground without swinging has
//! ü + a_g = a + b τ and u̇ = −b/ω². The rest of (u̇, ü + a_g) is free vibration (w, ẇ), exact for any step and damping
//! (`levels::oscillator`). The peak between samples is exact, too. |ü + a_g| is largest at a sample or at a zero of its rate b + ẅ. The
//! zeros of the slope of this rate have a closed form, and between two of them the rate passes 0 at most once.

use crate::engine::piece::Watch;
use crate::engine::sample::Sample;
use crate::levels::oscillator::Oscillator;
use crate::run::ground_motion::Segment;
use crate::run::record::Record;
use crate::run::{End, Run, RunError, Runs};
use crate::series::bisection::last_where;
use crate::structure::quantity::{Quantity, Refused};
use nalgebra::{Matrix2, Vector2};
use std::f64::consts::{PI, TAU};

/// Ranges of an oscillator: those of a structure's f_fc and zeta_fc.
pub(crate) const PERIOD: Quantity<f64> = Quantity::limit("period", "s", [1e-4, 1e3], "period of an oscillator");
pub(crate) const ZETA: Quantity<f64> = Quantity::limit("zeta", "1", [0.0, 10.0], "damping ratio of an oscillator");

/// The largest change of a value of a floor spectrum, as a fraction of the value, when the step is halved for the last time.
const SAME: f64 = 1e-3;

/// The most samples of a floor spectrum.
const MOST_SAMPLES: usize = 1 << 22;

/// The spectrum of an `acceleration` on the structure of `run`, from the start of the run until `end` (s), as [`spectrum`] of a record.
///
/// The acceleration is sampled and linear between samples. The step is at first the mean step of the ground motion. It is halved until
/// no S_a changes by more than 1e-3 of itself, which estimates the error and does not bound it.
pub fn floor_spectrum<Q: Runs>(
    run: &Run<Q>,
    end: f64,
    acceleration: impl Fn(&Sample<Q>) -> f64,
    periods: &[f64],
    zeta: f64,
    watch: &mut dyn Watch<Q>,
) -> Result<Vec<f64>, RunError> {
    let (start, ground) = (run.ground.start(), run.ground);
    let run = Run { end: End::At(end), ..run.clone() };
    let mut of = |count: usize| {
        let (mut times, mut samples) = (Vec::with_capacity(count + 1), Vec::with_capacity(count + 1));
        let show = |sample: &Sample<Q>| {
            times.push(sample.motion.time);
            samples.push(acceleration(sample));
        };
        let instants = (0..count).map(|i| start + (end - start) * (i as f64 / count as f64));
        run.sample(instants, show, watch)?;
        let record = Record::from_samples("", times, samples).map_err(Refused::by)?;
        Ok::<_, RunError>(spectrum(&record, periods.iter().copied(), zeta)?)
    };
    let step = (ground.end() - start) / (ground.times().len() - 1) as f64;
    let mut count = ((end - start) / step).ceil().min(MOST_SAMPLES as f64 / 4.0) as usize;
    let mut before = of(count)?;
    while count <= MOST_SAMPLES / 2 {
        count *= 2;
        let now = of(count)?;
        if now.iter().zip(&before).all(|(now, before)| (now - before).abs() <= SAME * now) {
            return Ok(now);
        }
        before = now;
    }
    let remedy = "give the run a shorter duration, or raise zeta";
    Err(Refused::by(format!("the spectrum still changes at {MOST_SAMPLES} samples of the floor: {remedy}")).into())
}

/// The spectrum of `record`: S_a at each of `periods` (s) and the damping ratio `zeta`, m/s².
pub fn spectrum(record: &Record, periods: impl IntoIterator<Item = f64>, zeta: f64) -> Result<Vec<f64>, Refused> {
    ZETA.check(zeta)?;
    let at = |T| Ok(PERIOD.check(T).map(|()| spectral_acceleration(record, T, zeta))?);
    periods.into_iter().map(at).collect()
}

/// S_a of `record` at the period `T` (s) and the damping ratio `zeta` of a structure, m/s². The oscillator starts at rest. The
/// search ends one period after the record, because the largest swing comes within a quarter of a period.
pub fn spectral_acceleration(record: &Record, T: f64, zeta: f64) -> f64 {
    Oscillator { omega: TAU / T, zeta }.peak(record.segments(record.end() - record.start() + T))
}

impl Oscillator {
    /// Largest |ü + a_g| over `segments`, from rest, m/s².
    fn peak(&self, segments: impl Iterator<Item = Segment>) -> f64 {
        let mut flow_over = (f64::NAN, Matrix2::identity()); // of the last step length, which few records change
        let mut motion = Vector2::zeros(); // (u̇, ü + a_g)
        let mut peak: f64 = 0.0;
        for Segment { duration: step, ground, .. } in segments {
            let a_g = ground.on_foundation();
            if step != flow_over.0 {
                flow_over = (step, self.free(step));
            }
            let follow_ground = |a_g_now: f64| Vector2::new(-a_g.slope / self.omega.powi(2), a_g_now);
            let free = motion - follow_ground(a_g.value);
            let swing = libm::hypot(free[1], self.rate(free)[1] / self.omega); // bounds |ẇ| from here on
            if a_g.value.abs().max(a_g.at(step).abs()) + swing > peak {
                let acceleration = |tau: f64| a_g.at(tau) + (self.free(tau) * free)[1];
                peak = self.extremes(free, a_g.slope, step).map(|tau| acceleration(tau).abs()).fold(peak, f64::max);
            }
            motion = follow_ground(a_g.at(step)) + flow_over.1 * free;
        }
        peak
    }

    /// (ẇ, ẅ) of free vibration (w, ẇ).
    fn rate(&self, free: Vector2<f64>) -> Vector2<f64> {
        Vector2::new(free[1], -2.0 * self.zeta * self.omega * free[1] - self.omega * self.omega * free[0])
    }

    /// The instants in (0, `step`] that hold the extremes of b τ + ẇ with b = `slope`: its stationary points, and the
    /// end.
    fn extremes(&self, free: Vector2<f64>, slope: f64, step: f64) -> impl Iterator<Item = f64> {
        let swing = self.rate(self.rate(free)); // (ẅ, its rate)
        let turns = self.zeros(self.rate(swing), step).chain([step]);
        let rises = move |tau: f64| slope + (self.free(tau) * swing)[0] > 0.0;
        let stationary = turns.scan(0.0, move |from, to| {
            let low = std::mem::replace(from, to);
            let rises_at_first = rises(low);
            Some((rises(to) != rises_at_first).then(|| last_where(low, to, |tau| rises(tau) == rises_at_first)))
        });
        stationary.flatten().chain([step])
    }

    /// The instants in (0, `end`) at which free vibration (w, ẇ) passes w = 0.
    fn zeros(&self, free: Vector2<f64>, end: f64) -> impl Iterator<Item = f64> {
        let d = self.d();
        let slope = free[1] + self.zeta * self.omega * free[0];
        let (first, spacing) = if self.zeta < 1.0 {
            (libm::atan2(d * free[0], -slope).rem_euclid(PI) / d, PI / d)
        } else if d > 0.0 {
            (libm::atanh(-d * free[0] / slope) / d, f64::INFINITY)
        } else {
            (-free[0] / slope, f64::INFINITY)
        };
        let first = if first > 0.0 { first } else { spacing };
        std::iter::successors(Some(first), move |tau| Some(tau + spacing)).take_while(move |tau| *tau < end)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Detail, OneMass, Output, Parameters};
    use approx::assert_relative_eq;
    use proptest::prelude::*;

    fn oscillator(T: f64, zeta: f64) -> Oscillator {
        Oscillator { omega: TAU / T, zeta }
    }

    /// The ground acceleration is 1 from the start. The peak is 1 + exp(−ζ (π − 2 asin ζ)/√(1−ζ²)) for ζ < 1, and 1 + e^{−2}
    /// for ζ = 1.
    #[test]
    fn a_step_has_its_closed_form_however_it_is_cut() {
        for zeta in [0.0, 0.02, 0.5, 0.9, 1.0] {
            let exact = if zeta < 1.0 {
                let quality = f64::sqrt(1.0 - zeta * zeta);
                1.0 + libm::exp(-zeta * (PI - 2.0 * libm::asin(zeta)) / quality)
            } else {
                1.0 + libm::exp(-2.0)
            };
            for cuts in [1, 7, 1000] {
                let times: Vec<_> = (0..=cuts).map(|i| 3.0 * f64::from(i) / f64::from(cuts)).collect();
                let ground = Record::from_samples("", times.clone(), vec![1.0; times.len()]).unwrap();
                let peak = oscillator(1.3, zeta).peak(ground.segments(3.0));
                assert_relative_eq!(peak, exact, max_relative = 1e-13);
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(64))]

        /// Against series of a structure with this oscillator (Eq 1), whose base is too wide to lift off.
        #[test]
        fn the_peak_is_that_of_a_structure_in_full_contact(
            a_g in prop::collection::vec(-10.0..10.0f64, 3..12),
            steps in prop::collection::vec(1e-3..0.3f64, 12),
            f_fc in 0.3..40.0f64,
            zeta_fc in 0.0..0.99f64,
        ) {
            let structure = OneMass::new(Parameters { f_fc, zeta_fc, B: 1e4, ..Parameters::EVISON }).unwrap();
            let times: Vec<f64> = (0..a_g.len()).map(|i| steps[..i].iter().sum()).collect();
            let record = Record::from_samples("", times, a_g).unwrap();
            let (detail, end) = (Detail::Nonlinear, End::At(record.end() + f_fc.recip()));
            let run = Run { detail, tolerance: 1e-12, end, ..Run::new(structure, &record) };
            let (peaks, finish) = run.peaks().unwrap();
            let (found, expected) = (spectral_acceleration(&record, f_fc.recip(), zeta_fc), peaks.of(Output::a_t(0)).unwrap());
            prop_assert!((found - expected.magnitude).abs() <= 1e-11 * found, "{found} {expected:?}");
            prop_assert_eq!(finish.motion.transitions, 0);
        }
    }
}
