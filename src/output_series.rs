//! The outputs over a step of the solver, as series in time like the motion itself.
//!
//! θ and u are series already; sin θ and cos θ follow from that of θ by their own derivatives, and δ_t (Eq 26) and a_t
//! (Eq 27) are sums and products of these. They tell *where* an output is largest; what it is there is evaluated from
//! the state.

use crate::extremes::bound;
use crate::load::LinearLoad;
use crate::outputs::damping;
use crate::taylor::{Arc, MAX_ORDER, Series, ZERO};
use crate::{Phase, Structure};

/// sin θ and cos θ.
#[derive(Clone, Debug)]
pub(crate) struct Turn {
    pub sin: Series,
    pub cos: Series,
}

impl Turn {
    /// Of `arc`.
    pub(crate) fn of(arc: &Arc) -> Turn {
        let mut turn = Turn { sin: ZERO, cos: ZERO };
        (turn.sin[0], turn.cos[0]) = arc.theta[0].sin_cos();
        for k in 1..=MAX_ORDER {
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

/// δ_t over `arc` (Eq 26).
pub(crate) fn delta_t(structure: &Structure, phase: Phase, arc: &Arc, turn: &Turn) -> Series {
    let &crate::Parameters { H, B, .. } = structure.parameters();
    let offset = phase.side().sign() * B;
    std::array::from_fn(|k| {
        let elastic: f64 = (0..=k.min(arc.order)).map(|i| arc.u[i] * turn.cos[k - i]).sum();
        let one = if k == 0 { 1.0 } else { 0.0 };
        offset * (one - turn.cos[k]) + elastic + H * turn.sin[k]
    })
}

/// Bound of |δ_t| over `arc`, `theta` and `u` being those of |θ| and |u|: u + Hθ and what is of second order.
pub(crate) fn delta_t_bound(structure: &Structure, arc: &Arc, theta: f64, u: f64) -> f64 {
    let &crate::Parameters { H, B, .. } = structure.parameters();
    let sum = arc.used(&arc.u).iter().zip(arc.used(&arc.theta)).map(|(u, theta)| u + H * theta);
    bound(sum, arc.reach) + theta * theta * ((B + u) / 2.0 + H * theta / 6.0)
}

/// a_t over `arc` under `load`, by Eq 5: g sin θ − (c u̇ + k u)/m + (F_t/m) cos θ.
pub(crate) fn a_t(structure: &Structure, phase: Phase, load: LinearLoad, arc: &Arc, turn: &Turn) -> Series {
    let &crate::Parameters { m, g, .. } = structure.parameters();
    let damping = damping(structure, phase) / m;
    let (push, push_slope) = (load.value.F_t / m, load.slope.F_t / m * arc.span);
    std::array::from_fn(|k| {
        let elastic = if k <= arc.order { damping * arc.u_dot[k] + structure.stiffness * arc.u[k] } else { 0.0 };
        let pushed = push * turn.cos[k] + if k > 0 { push_slope * turn.cos[k - 1] } else { 0.0 };
        g * turn.sin[k] - elastic + pushed
    })
}

/// Bound of |a_t| over `arc`, `theta` being that of |θ|: its linear part and what is of second order.
pub(crate) fn a_t_bound(structure: &Structure, phase: Phase, load: LinearLoad, arc: &Arc, theta: f64) -> f64 {
    let &crate::Parameters { m, g, .. } = structure.parameters();
    let damping = damping(structure, phase) / m;
    let push = [load.value.F_t / m, load.slope.F_t / m * arc.span];
    let linear = (0..=arc.order).map(|k| {
        g * arc.theta[k] - damping * arc.u_dot[k] - structure.stiffness * arc.u[k] + push.get(k).unwrap_or(&0.0)
    });
    let most_push = push[0].abs() + push[1].abs();
    bound(linear, arc.reach) + theta * theta * (g * theta / 6.0 + most_push / 2.0)
}
