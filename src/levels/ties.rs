//! The moment of the ties as a series in time: cos(θ/2) and sin(θ/2) have derivatives that follow from the derivative of θ.

use crate::mechanics::restraint::{Angles, Tie};
use crate::series::taylor::{Series, ZERO, product};

/// The force of a [`Tie`] times cos(θ/2) over a step, order by order.
#[derive(Clone, Debug)]
pub(crate) struct TieSeries {
    tie: Tie,
    /// cos(θ/2), sin(θ/2) and 2 sin(θ/2); for small angles 1, 0 and θ.
    cos: Series,
    sin: Series,
    chord: Series,
    /// The force along the tie.
    force: Series,
    angles: Angles,
}

impl TieSeries {
    /// The series of `tie` from the rotation `theta` (rad) on.
    pub(crate) fn new(tie: Tie, angles: Angles, theta: f64) -> TieSeries {
        let [mut cos, mut sin, mut chord] = [ZERO; 3];
        (sin[0], cos[0]) = if angles == Angles::Any { libm::sincos(theta / 2.0) } else { (0.0, 1.0) };
        chord[0] = angles.chord(theta, 0.0).length;
        TieSeries { tie, cos, sin, chord, force: ZERO, angles }
    }

    /// Coefficient `n` of the series, from θ̇ to that order and the orders before; `per` is the span over n + 1.
    pub(crate) fn next(&mut self, theta_dot: &Series, n: usize, per: f64) -> f64 {
        let TieSeries { tie, cos, sin, chord, force, angles } = self;
        let rate = product(cos, theta_dot, n);
        force[n] = tie.force(chord[n], rate);
        tie.force = 0.0; // a constant has only the order 0
        chord[n + 1] = rate * per;
        if *angles == Angles::Any {
            sin[n + 1] = 0.5 * chord[n + 1];
            cos[n + 1] = -0.5 * product(sin, theta_dot, n) * per;
        }
        product(cos, force, n)
    }
}
