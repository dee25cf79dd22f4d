//! The largest stable step, measured.

use super::vibration::FreeVibration;
use crate::fixed_step::FixedStep;

const STEPS: usize = 8192;

/// The energy grows if its maximum over the last quarter of a trial exceeds the maximum over the second by this part.
const GROWTH: f64 = 1e-3;

/// Steps tried, as ω_u h: a method stable at the largest is taken to be so at all; one unstable at the smallest, never.
const RANGE: (f64, f64) = (3e-3, 1e3);

/// Relative width at which the bisection ends.
const RESOLUTION: f64 = 1e-4;

/// Whether the energy grows over a trial with the step `h`, in units of 1/ω_u.
fn grows(method: FixedStep, vibration: &FreeVibration, h: f64) -> bool {
    const QUARTER: usize = STEPS / 4;
    let mut point = vibration.start();
    let start = vibration.energy(&point);
    let mut largest = [0.0f64; 4];
    for step in 0..STEPS {
        point = method.step(vibration, 0.0, &point, h);
        let energy = vibration.energy(&point);
        if energy.is_nan() || energy > 1e12 * start {
            return true;
        }
        largest[step / QUARTER] = largest[step / QUARTER].max(energy);
    }
    largest[3] > (1.0 + GROWTH) * largest[1] && largest[1] > f64::MIN_POSITIVE
}

/// The largest stable ω_u h, by bisection: 0 if none is stable, infinite if all are.
pub fn measure(method: FixedStep, vibration: &FreeVibration) -> f64 {
    let (mut low, mut high) = RANGE;
    if !grows(method, vibration, high) {
        return f64::INFINITY;
    }
    if grows(method, vibration, low) {
        return 0.0;
    }
    while high > (1.0 + RESOLUTION) * low {
        let middle = (low * high).sqrt();
        *(if grows(method, vibration, middle) { &mut high } else { &mut low }) = middle;
    }
    low
}
