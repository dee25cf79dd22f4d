//! The damped oscillator and its exact flow, which full contact, the vibration mode and response spectra share.
//!
//! ```text
//! ẅ + 2 ζ ω ẇ + ω² w = 0
//! w(τ) = (C + ζω S) w₀ + S ẇ₀,   ẇ(τ) = −ω² S w₀ + (C − ζω S) ẇ₀,   C = e^{−ζωτ} cos dτ,  S = e^{−ζωτ} sin(dτ)/d
//! ```
//!
//! with d = ω √(1 − ζ²), hyperbolic functions for ζ > 1 and S = τ e^{−ωτ} for ζ = 1.

use nalgebra::Matrix2;

/// An oscillator of circular frequency ω (rad/s) and damping ratio ζ.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Oscillator {
    pub omega: f64,
    pub zeta: f64,
}

impl Oscillator {
    /// The matrix that takes free vibration (w, ẇ) `tau` seconds ahead.
    pub(crate) fn flow(&self, tau: f64) -> Matrix2<f64> {
        let &Oscillator { omega, zeta } = self;
        let d = self.d();
        let (C, S) = if zeta < 1.0 {
            let (sin, cos) = (d * tau).sin_cos();
            let decay = (-zeta * omega * tau).exp();
            (decay * cos, decay * sin / d)
        } else {
            // e^{(d − ζω)τ} alone is not small; the other exponential is e^{−2dτ} of it
            let slow = (-omega / (zeta + d / omega) * tau).exp();
            let lost = -(-2.0 * d * tau).exp_m1();
            (slow * (1.0 - 0.5 * lost), slow * if d > 0.0 { 0.5 * lost / d } else { tau })
        };
        let damping = zeta * omega * S;
        Matrix2::new(C + damping, S, -omega * omega * S, C - damping)
    }

    /// d = ω √|1 − ζ²|, rad/s.
    pub(crate) fn d(&self) -> f64 {
        self.omega * ((1.0 - self.zeta) * (1.0 + self.zeta)).abs().sqrt()
    }

    /// Whether [`Oscillator::driven`] keeps its digits over `interval` (s): what follows the load is larger than what
    /// moves by 1/(ωh)², or ζ/(ωh)³ for a slope, and is lost to rounding over too short an interval.
    #[inline]
    pub(crate) fn can_leap(&self, interval: f64) -> bool {
        self.omega * interval > 0.03 * (1.0 + self.zeta)
    }

    /// Where it is after `tau` (s) of a load a + b τ that pushes against w, over its mass: `value` = a in m/s², `slope`
    /// = b in m/s³; `flow` is its flow over `tau`. About the motion that follows such a load, w = −(a + b (τ −
    /// 2ζ/ω))/ω², the rest vibrates freely.
    #[inline]
    pub(crate) fn driven(&self, flow: &Matrix2<f64>, start: [f64; 2], value: f64, slope: f64, tau: f64) -> Driven {
        let per_stiffness = 1.0 / (self.omega * self.omega);
        let lag = 2.0 * self.zeta / self.omega;
        let following = |tau: f64| -(value + slope * (tau - lag)) * per_stiffness;
        let following_dot = -slope * per_stiffness;
        let (rest, rest_dot) = (start[0] - following(0.0), start[1] - following_dot);
        Driven {
            end: [
                following(tau) + flow.m11 * rest + flow.m12 * rest_dot,
                following_dot + flow.m21 * rest + flow.m22 * rest_dot,
            ],
            following: [following(0.0), following(tau)],
            amplitude: (rest * rest + rest_dot * rest_dot * per_stiffness).sqrt(),
        }
    }
}

/// Motion of an oscillator under a linear load.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Driven {
    /// (w, ẇ) at the end.
    pub end: [f64; 2],
    /// Position that follows the load, at the start and at the end; linear in between.
    pub following: [f64; 2],
    /// Bound of the distance from it: the energy of free vibration does not grow.
    pub amplitude: f64,
}

/// Flows kept at once. Records sampled at t = i·dt have a handful of step lengths, which differ in their last bits.
const KEPT: usize = 16;

/// The flows used last, by the exact length of time; what is not kept is computed anew, so that results do not depend
/// on what is.
#[derive(Clone, Debug)]
pub(crate) struct Kept<Flow> {
    flows: [(f64, Flow); KEPT],
}

impl<Flow: Copy> Kept<Flow> {
    /// Nothing kept yet; `unused` fills the places.
    pub(crate) fn new(unused: Flow) -> Kept<Flow> {
        Kept { flows: [(f64::NAN, unused); KEPT] }
    }

    /// The flow over `duration` (s), by `compute` where it is not kept.
    #[inline]
    pub(crate) fn over(&mut self, duration: f64, compute: impl FnOnce() -> Flow) -> &Flow {
        // the top bits of a multiplicative hash: lengths that differ in their last bits go to different places
        let place = (duration.to_bits().wrapping_mul(0x9E37_79B9_7F4A_7C15) >> 60) as usize;
        let kept = &mut self.flows[place];
        if kept.0 != duration {
            *kept = (duration, compute());
        }
        &kept.1
    }
}
