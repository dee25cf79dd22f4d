//! The reactions over a step of the solver, as series in time like the motion itself.
//!
//! With x = u − sB and the accelerations along and across the turning strut, m0's included,
//!
//! ```text
//! P = m (ü + H θ̈ − x θ̇²) + m0 sB θ̇²,      Q = −m (x θ̈ + H θ̇² + 2 u̇ θ̇) + m0 sB θ̈
//! ```
//!
//! the forces of [`reactions`](crate::reactions) are
//!
//! ```text
//! R_h = F_t − (m + m0) a_g − P cos θ − Q sin θ,      R_v = (m + m0) g + Q cos θ − P sin θ
//! ```
//!
//! ü and θ̈ are the slopes of u̇ and θ̇: so this holds at every level. The series tell *where* a reaction is largest; what
//! it is there is evaluated from the state.

use crate::load::LinearLoad;
use crate::output_series::Turn;
use crate::taylor::{Arc, Series, ZERO};
use crate::{Phase, Structure};

/// Reactions over an arc. The moment is that of full contact; while rocking it is sB R_v and left out.
#[derive(Clone, Debug)]
pub(crate) struct ReactionSeries {
    pub R_h: Series,
    pub R_v: Series,
    pub R_m: Series,
}

impl ReactionSeries {
    /// Over `arc`, a motion in `phase` under `load`, which is given from its start on.
    pub(crate) fn of(structure: &Structure, phase: Phase, load: LinearLoad, arc: &Arc) -> ReactionSeries {
        match phase {
            Phase::FullContact => in_full_contact(structure, load, arc),
            Phase::Rocking(_) | Phase::Overturned(_) => while_rocking(structure, phase, load, arc),
        }
    }
}

/// Coefficient `k` of what is `value` at the start and changes by `slope` (per second) over `arc`.
fn linear(value: f64, slope: f64, arc: &Arc, k: usize) -> f64 {
    match k {
        0 => value,
        1 => slope * arc.span,
        _ => 0.0,
    }
}

/// The slope (per second) of `series` over `arc`.
fn slope(series: &Series, arc: &Arc) -> Series {
    arc.series(|k| if k < arc.order { (k + 1) as f64 * series[k + 1] / arc.span } else { 0.0 })
}

fn product(a: &Series, b: &Series, arc: &Arc) -> Series {
    arc.series(|k| a[..=k].iter().zip(b[..=k].iter().rev()).map(|(a, b)| a * b).sum())
}

fn in_full_contact(structure: &Structure, load: LinearLoad, arc: &Arc) -> ReactionSeries {
    let &crate::Parameters { m, m0, H, g, .. } = structure.parameters();
    let u_ddot = slope(&arc.u_dot, arc);
    let LinearLoad { value, slope } = load;
    let strut = arc.series(|k| linear(value.F_t - m * value.a_g, slope.F_t - m * slope.a_g, arc, k) - m * u_ddot[k]);
    let mut R_v = ZERO;
    R_v[0] = (m + m0) * g;
    ReactionSeries {
        R_h: arc.series(|k| strut[k] - m0 * linear(value.a_g, slope.a_g, arc, k)),
        R_v,
        R_m: arc.series(|k| H * strut[k] + m * g * arc.u[k]),
    }
}

fn while_rocking(structure: &Structure, phase: Phase, load: LinearLoad, arc: &Arc) -> ReactionSeries {
    let &crate::Parameters { m, m0, H, B, g, .. } = structure.parameters();
    let pivot = phase.side().sign() * B;
    let Turn { sin, cos } = Turn::of(arc);
    let [u_ddot, theta_ddot] = [&arc.u_dot, &arc.theta_dot].map(|rate| slope(rate, arc));
    let mut x = arc.u;
    x[0] -= pivot;
    let square = product(&arc.theta_dot, &arc.theta_dot, arc);
    let centripetal = product(&square, &x, arc);
    let tangential = product(&theta_ddot, &x, arc);
    let coriolis = product(&arc.theta_dot, &arc.u_dot, arc);
    let along = arc.series(|k| m * (u_ddot[k] + H * theta_ddot[k] - centripetal[k]) + m0 * pivot * square[k]);
    let across = arc.series(|k| -m * (tangential[k] + H * square[k] + 2.0 * coriolis[k]) + m0 * pivot * theta_ddot[k]);
    let [along_cos, along_sin] = [&cos, &sin].map(|turn| product(&along, turn, arc));
    let [across_cos, across_sin] = [&cos, &sin].map(|turn| product(&across, turn, arc));
    let LinearLoad { value, slope } = load;
    let pushed = |k| linear(value.F_t - (m + m0) * value.a_g, slope.F_t - (m + m0) * slope.a_g, arc, k);
    ReactionSeries {
        R_h: arc.series(|k| pushed(k) - along_cos[k] - across_sin[k]),
        R_v: arc.series(|k| linear((m + m0) * g, 0.0, arc, k) + across_cos[k] - along_sin[k]),
        R_m: ZERO,
    }
}
