//! The ties of a restrained structure as series in time: cos(θ/2) and sin(θ/2) have derivatives that follow from that of θ.

use crate::mechanics::restraint::{Angles, Sum};
use crate::series::taylor::{Arc, Series, ZERO, product, reciprocal};

/// A [`Sum`] over a step, order by order.
#[derive(Clone, Debug)]
pub(crate) struct TieSeries {
    sum: Sum,
    /// cos(θ/2), sin(θ/2) and 2 sin(θ/2); for small angles 1, 0 and θ.
    cos: Series,
    sin: Series,
    chord: Series,
    /// The rate of the last, in 1/s.
    pub rate: Series,
    /// The force along the ties.
    force: Series,
    angles: Angles,
}

impl TieSeries {
    /// Of `sum` from the rotation `theta` (rad) on.
    pub(crate) fn new(sum: Sum, angles: Angles, theta: f64) -> TieSeries {
        let [mut cos, mut sin, mut chord] = [ZERO; 3];
        (sin[0], cos[0]) = if angles == Angles::Any { libm::sincos(theta / 2.0) } else { (0.0, 1.0) };
        chord[0] = angles.chord(theta, 0.0).length;
        TieSeries { sum, cos, sin, chord, rate: ZERO, force: ZERO, angles }
    }

    /// Over all of `arc`.
    pub(crate) fn over(sum: Sum, angles: Angles, arc: &Arc) -> TieSeries {
        let mut ties = TieSeries::new(sum, angles, arc.theta[0]);
        (0..=arc.order).for_each(|n| _ = ties.next(&arc.theta_dot, n, arc.span * reciprocal(n + 1)));
        ties
    }

    /// Coefficient `n` of the sum, from θ̇ to that order and what came before; `per` is the span over n + 1.
    pub(crate) fn next(&mut self, theta_dot: &Series, n: usize, per: f64) -> f64 {
        let TieSeries { sum, cos, sin, chord, rate, force, angles } = self;
        rate[n] = product(cos, theta_dot, n);
        force[n] = sum.stiffness * chord[n] + sum.damping * rate[n] + if n == 0 { sum.force } else { 0.0 };
        chord[n + 1] = rate[n] * per;
        if *angles == Angles::Any {
            sin[n + 1] = 0.5 * chord[n + 1];
            cos[n + 1] = -0.5 * product(sin, theta_dot, n) * per;
        }
        product(cos, force, n)
    }

    /// What the ties pull upwards, and to the right, N.
    pub(crate) fn pulls(&self, arc: &Arc) -> [Series; 2] {
        [&self.cos, &self.sin].map(|towards| arc.series(|n| product(towards, &self.force, n)))
    }
}
