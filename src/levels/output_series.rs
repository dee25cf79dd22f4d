//! What the outputs over a step are made of: sin θ and cos θ as series in time, whose derivatives follow from that of θ,
//! and bounds.

use crate::series::extremes;
use crate::series::extremes::Bound;
use crate::series::taylor::{Arc, Series, ZERO};
use crate::{State, Structure};

/// sin θ and cos θ.
#[derive(Clone, Debug)]
pub(crate) struct Turn {
    pub sin: Series,
    pub cos: Series,
}

impl Turn {
    /// Of `arc`, to its order: [`Piece::series`](crate::engine::piece::Piece::series) looks at what that leaves out.
    pub(crate) fn of(arc: &Arc) -> Turn {
        let mut turn = Turn { sin: ZERO, cos: ZERO };
        (turn.sin[0], turn.cos[0]) = libm::sincos(arc.theta[0]);
        for k in 1..=arc.order {
            let (mut sin, mut cos) = (0.0, 0.0);
            for j in 1..=k.min(arc.order) {
                let rate = j as f64 * arc.theta[j];
                sin += rate * turn.cos[k - j];
                cos -= rate * turn.sin[k - j];
            }
            (turn.sin[k], turn.cos[k]) = (sin / k as f64, cos / k as f64);
        }
        turn
    }
}

/// Bound of |δ_t|, from those of |θ|, |u| and |u + H θ|.
#[inline]
pub(crate) fn delta_t_bound(structure: &Structure, theta: Bound, u: Bound, sway: Bound) -> Bound {
    let &crate::Parameters { H, B, .. } = structure.parameters();
    let (most_theta, most_u) = (theta.largest(), u.largest());
    let square = most_theta * most_theta;
    let rest = square * ((B + most_u) / 2.0 + H * most_theta / 6.0);
    let rate = most_theta * theta.rate[1] * (B + most_u + H * most_theta / 2.0) + square * u.rate[1] / 2.0;
    sway.and(rest, rate)
}

/// Bounds of |θ|, |u| and |u̇| over `arc`, which ends in `end`.
#[inline]
pub(crate) fn crude_bounds_of_state(arc: &Arc, end: &State) -> [f64; 3] {
    [(&arc.theta, end.theta), (&arc.u, end.u), (&arc.u_dot, end.u_dot)]
        .map(|(series, end)| crude_bound_of(arc, series, end))
}

/// Bound of the magnitude of a `series` of `arc`, which ends in `end`.
#[inline]
pub(crate) fn crude_bound_of(arc: &Arc, series: &Series, end: f64) -> f64 {
    series[0].abs().max(end.abs()) + extremes::off_chord(arc.used(series), arc.reach)
}
