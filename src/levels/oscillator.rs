//! The damped oscillator and its exact flow, which full contact, the vibration mode and response spectra share.
//!
//! ```text
//! ẅ + 2 ζ ω ẇ + ω² w = −(a + b τ)
//! w(τ) = (C + ζω S) w₀ + S ẇ₀ − W a − R b,   ẇ(τ) = −ω² S w₀ + (C − ζω S) ẇ₀ − S a − W b
//! C = e^{−ζωτ} cos dτ,   S = e^{−ζωτ} sin(dτ)/d,   W = [1 − (C + ζω S)]/ω²,   R = ∫ W dτ = [τ − S − 2ζω W]/ω²
//! ```
//!
//! with d = ω √(1 − ζ²), hyperbolic functions for ζ > 1 and S = τ e^{−ωτ} for ζ = 1.

use crate::numbers::Real;
use crate::series::taylor::reciprocal;
use nalgebra::Matrix2;
use std::cell::{RefCell, RefMut};

/// An oscillator of circular frequency ω (rad/s) and damping ratio ζ.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Oscillator<N = f64> {
    pub omega: N,
    pub zeta: N,
    /// 1/ω², s². Every leap reads this and the next: divisions would take a fifth of its time.
    per_stiffness: N,
    /// 2ζ/ω, s.
    lag: N,
}

/// Coefficients that advance an oscillator by a given time.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Flow<N = f64> {
    /// The matrix of free vibration, row by row.
    pub free: [N; 4],
    /// W, s².
    pub step: N,
    /// R, s³.
    pub ramp: N,
}

impl<N: Real> Flow<N> {
    /// (w, ẇ) at the end, from `start` under the load a + b τ: `value` = a in m/s², `slope` = b in m/s³.
    #[inline(always)]
    pub(crate) fn driven(&self, start: [N; 2], value: N, slope: N) -> [N; 2] {
        let Flow { free: [m11, m12, m21, m22], step, ramp } = *self;
        [
            m11 * start[0] + m12 * start[1] - (step * value + ramp * slope),
            m21 * start[0] + m22 * start[1] - (m12 * value + step * slope),
        ]
    }
}

impl Oscillator {
    /// The matrix that takes free vibration (w, ẇ) `tau` seconds ahead.
    pub(crate) fn free(&self, tau: f64) -> Matrix2<f64> {
        let &Oscillator { omega, zeta, .. } = self;
        let d = self.d();
        let (C, S) = if zeta < 1.0 {
            let (sin, cos) = libm::sincos(d * tau);
            let decay = libm::exp(-zeta * omega * tau);
            (decay * cos, decay * sin / d)
        } else {
            // e^{(d − ζω)τ} alone is not small; the other exponential is e^{−2dτ} of it
            let slow = libm::exp(-omega / (zeta + d / omega) * tau);
            let lost = -libm::expm1(-2.0 * d * tau);
            (slow * (1.0 - 0.5 * lost), slow * if d > 0.0 { 0.5 * lost / d } else { tau })
        };
        let damping = zeta * omega * S;
        Matrix2::new(C + damping, S, -omega * omega * S, C - damping)
    }

    /// d = ω √|1 − ζ²|, rad/s.
    pub(crate) fn d(&self) -> f64 {
        self.omega * ((1.0 - self.zeta) * (1.0 + self.zeta)).abs().sqrt()
    }

    /// The coefficients that advance the oscillator by `tau` seconds.
    pub(crate) fn flow(&self, tau: f64) -> Flow {
        let &Oscillator { omega, zeta, .. } = self;
        let free = self.free(tau);
        let [step, ramp] = if (1.0 + 2.0 * zeta) * omega * tau < 1.0 {
            self.short_response(tau)
        } else if zeta > 1.5 {
            self.slow_response(tau)
        } else {
            let step = (1.0 - free.m11) / (omega * omega);
            [step, (tau - free.m12 - 2.0 * zeta * omega * step) / (omega * omega)]
        };
        Flow { free: [free.m11, free.m12, free.m21, free.m22], step, ramp }
    }

    /// W and R far beyond critical damping, where 2ζω W all but cancels τ, by the two rates of decay λ, λ':
    /// W = [(1 − e^{−λτ})/λ − (1 − e^{−λ'τ})/λ']/2d, and R is its integral.
    fn slow_response(&self, tau: f64) -> [f64; 2] {
        let d = self.d();
        let fast = self.zeta * self.omega + d;
        let settled = |x: f64| -libm::expm1(-x) / x;
        // (x − 1 + e^{−x})/x² = 1/2! − x/3! + x²/4! − …
        let ramped = |x: f64| {
            if x < 1.0 {
                let next = |sum: f64, k: usize| (1.0 - x * sum) * reciprocal(k);
                0.5 * (3..19).rev().fold(0.0, next).mul_add(-x, 1.0)
            } else {
                (1.0 - settled(x)) / x
            }
        };
        let [slow, fast] = [self.omega * self.omega / fast, fast].map(|rate| rate * tau);
        let per = tau / (2.0 * d);
        [per * (settled(slow) - settled(fast)), per * tau * (ramped(slow) - ramped(fast))]
    }

    /// W and R over a short time, whose differences would be lost to rounding, by their series in τ.
    fn short_response(&self, tau: f64) -> [f64; 2] {
        const TERMS: usize = 20; // of at most 1/k! for (1 + 2ζ) ωτ < 1
        let (x, damping) = (self.omega * tau, 2.0 * self.zeta * self.omega * tau);
        let (mut before, mut term) = (0.0, 0.5); // coefficients of τ^{k−1} and τ^k in W/τ²
        let (mut step, mut ramp) = (term, term / 3.0);
        for k in 2..TERMS {
            let rest = damping * k as f64 * term + x * x * before;
            (before, term) = (term, -rest * reciprocal(k) * reciprocal(k + 1));
            step += term;
            ramp += term * reciprocal(k + 2);
        }
        [step * tau * tau, ramp * tau * tau * tau]
    }
}

impl<N: Real> Oscillator<N> {
    #[inline(always)]
    pub(crate) fn new(omega: N, zeta: N) -> Oscillator<N> {
        let (per_stiffness, lag) = (omega.like(1.0) / (omega * omega), omega.like(2.0) * zeta / omega);
        Oscillator { omega, zeta, per_stiffness, lag }
    }

    /// The region in which the oscillator stays for `tau` seconds from `start`. The motion that follows the load a + b τ is
    /// w = −(a + b (τ − 2ζ/ω))/ω². The rest vibrates freely about that motion, with an energy that does not grow.
    #[inline(always)]
    pub(crate) fn swing(&self, start: [N; 2], value: N, slope: N, tau: N) -> Swing<N> {
        let &Oscillator { per_stiffness, lag, .. } = self;
        let following = |tau: N| -(value + slope * (tau - lag)) * per_stiffness;
        let following = [following(tau.like(0.0)), following(tau)];
        let (rest, rest_dot) = (start[0] - following[0], start[1] + slope * per_stiffness);
        Swing { following, amplitude: (rest * rest + rest_dot * rest_dot * per_stiffness).sqrt() }
    }

    /// Bounds of the vibration of a `swing` about the motion that follows the load, and of its three derivatives.
    #[inline(always)]
    pub(crate) fn swings(&self, swing: &Swing<N>) -> [N; 4] {
        let &Oscillator { omega, zeta, .. } = self;
        let two_zeta = omega.like(2.0) * zeta;
        let velocity = omega * swing.amplitude;
        let acceleration = omega * velocity * (omega.like(1.0) + two_zeta);
        let jerk = omega * (omega * velocity + two_zeta * acceleration);
        [swing.amplitude, velocity, acceleration, jerk]
    }
}

/// The region in which a driven oscillator stays.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Swing<N = f64> {
    /// Position that follows the load, at the start and at the end; linear in between.
    pub following: [N; 2],
    /// Bound of the distance from that position.
    pub amplitude: N,
}

impl<N: Real> Swing<N> {
    /// Bound of |w|.
    #[inline(always)]
    pub(crate) fn farthest(&self) -> N {
        self.following[0].abs().max(self.following[1].abs()) + self.amplitude
    }
}

/// Flows kept at once. Records sampled at t = i·dt have a handful of step lengths, which differ in their last bits.
const KEPT: usize = 16;

/// The flows used last, by the exact length of time. A flow that is not kept is computed again, so that results do not depend on
/// which flows are kept.
#[derive(Clone, Debug)]
pub(crate) struct FlowCache<Flow> {
    flows: RefCell<[(f64, Flow); KEPT]>,
}

impl<Flow: Copy> FlowCache<Flow> {
    /// Nothing kept yet; `unused` fills the places.
    pub(crate) fn new(unused: Flow) -> FlowCache<Flow> {
        FlowCache { flows: RefCell::new([(f64::NAN, unused); KEPT]) }
    }

    /// The flow over `duration` (s), by `compute` where it is not kept.
    #[inline]
    pub(crate) fn over(&self, duration: f64, compute: impl FnOnce() -> Flow) -> RefMut<'_, Flow> {
        // the top bits of a multiplicative hash: lengths that differ in their last bits go to different places
        let place = (duration.to_bits().wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 60) as usize;
        RefMut::map(self.flows.borrow_mut(), |flows| {
            let kept = &mut flows[place];
            if kept.0 != duration {
                *kept = (duration, compute());
            }
            &mut kept.1
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    /// On both sides of the limit between series and closed form, W and R are the same to rounding. For a motion much shorter than
    /// the period, W is τ²/2 and R is τ³/6.
    #[test]
    fn loads_keep_their_digits_over_short_times() {
        for zeta in [0.0, 0.02, 0.7, 1.0, 4.0] {
            let oscillator = Oscillator::new(30.0, zeta);
            let limit = 1.0 / ((1.0 + 2.0 * zeta) * oscillator.omega);
            let [below, above] = [1.0 - 1e-15, 1.0 + 1e-15].map(|part| oscillator.flow(part * limit));
            let rounding = 50.0 * (1.0 + 2.0 * zeta).powi(2) * f64::EPSILON;
            assert_relative_eq!(below.step, above.step, max_relative = rounding);
            assert_relative_eq!(below.ramp, above.ramp, max_relative = rounding);
            let tau = 1e-9 * limit;
            let [step, ramp] = [oscillator.flow(tau).step, oscillator.flow(tau).ramp];
            assert_relative_eq!(step, tau.powi(2) / 2.0, max_relative = 2e-9);
            assert_relative_eq!(ramp, tau.powi(3) / 6.0, max_relative = 2e-9);
        }
    }
}
