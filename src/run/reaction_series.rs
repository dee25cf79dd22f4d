//! The reactions over a step of the solver, as series in time like the motion itself.
//!
//! With x = u − sB and the accelerations along and across the turning strut, m0's included,
//!
//! ```text
//! P = m (ü + H θ̈ − x θ̇²) + m0 sB θ̇²,      Q = −m (x θ̈ + H θ̇² + 2 u̇ θ̇) + m0 sB θ̈
//! ```
//!
//! the forces of [`reactions`](crate::mechanics::reactions) are
//!
//! ```text
//! R_h = F_t − (m + m0) a_g − P cos θ − Q sin θ,      R_v = (m + m0) (g + a_v) + Q cos θ − P sin θ
//! ```
//!
//! ü and θ̈ are the slopes of u̇ and θ̇: so this holds at every level. The series tell *where* a reaction is largest; what
//! it is there is evaluated from the state. Most arcs need none: [`off_chord`] bounds how far the reactions leave the
//! chords between their ends.

use crate::levels::output_series::Turn;
use crate::levels::tie_series::TieSeries;
use crate::mechanics::load::{LinearLoad, Ramp};
use crate::mechanics::restraint::{Angles, Sum, Tie};
use crate::series::extremes;
use crate::series::taylor::{self, Arc, Series, ZERO};
use crate::{Phase, Side, Structure};

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

    /// What of these the edges of the base carry where `ties` pull, as
    /// [`Reactions::of_edges`](crate::Reactions::of_edges).
    pub(crate) fn of_edges(
        mut self,
        structure: &Structure,
        side: Side,
        angles: Angles,
        ties: &[Tie; 3],
        arc: &Arc,
    ) -> Self {
        let [up, right] = TieSeries::over(Sum::of_pulls(ties), angles, arc).pulls(arc);
        for k in 0..=arc.order {
            self.R_v[k] += up[k];
            self.R_h[k] -= right[k];
        }
        // in full contact they are what they are
        let middle = side.sign() * structure.parameters().B;
        self.R_m[0] += ties.iter().map(|tie| tie.force * (middle - tie.lever)).sum::<f64>();
        self
    }
}

/// The slope (per second) of `series` over `arc`.
fn slope(series: &Series, arc: &Arc) -> Series {
    arc.series(|k| if k < arc.order { (k + 1) as f64 * series[k + 1] / arc.span } else { 0.0 })
}

fn product(a: &Series, b: &Series, arc: &Arc) -> Series {
    arc.series(|k| taylor::product(a, b, k))
}

fn in_full_contact(structure: &Structure, load: LinearLoad, arc: &Arc) -> ReactionSeries {
    let &crate::Parameters { m, m0, H, g, .. } = structure.parameters();
    let u_ddot = slope(&arc.u_dot, arc);
    let LinearLoad { value, slope } = load;
    let linear = |value: f64, slope: f64, k: usize| Ramp { value, slope }.coefficient(k, arc.span);
    let strut = arc.series(|k| linear(value.F_t - m * value.a_g, slope.F_t - m * slope.a_g, k) - m * u_ddot[k]);
    let weight = |mass: f64, k: usize| linear(mass * (g + value.a_v), mass * slope.a_v, k);
    ReactionSeries {
        R_h: arc.series(|k| strut[k] - m0 * linear(value.a_g, slope.a_g, k)),
        R_v: arc.series(|k| weight(m + m0, k)),
        R_m: arc.series(|k| {
            let before = if k > 0 { weight(m, 1) * arc.u[k - 1] } else { 0.0 };
            H * strut[k] + weight(m, 0) * arc.u[k] + before
        }),
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
    let total = m + m0;
    let pushed = Ramp { value: value.F_t - total * value.a_g, slope: slope.F_t - total * slope.a_g };
    let weight = Ramp { value: total * (g + value.a_v), slope: total * slope.a_v };
    ReactionSeries {
        R_h: arc.series(|k| pushed.coefficient(k, arc.span) - along_cos[k] - across_sin[k]),
        R_v: arc.series(|k| weight.coefficient(k, arc.span) + across_cos[k] - along_sin[k]),
        R_m: ZERO,
    }
}

/// Accelerations (ü, θ̈) at both ends of `arc`, by its slopes.
pub(crate) fn accelerations_at_ends(arc: &Arc) -> [[f64; 2]; 2] {
    [0.0, arc.reach].map(|sigma| {
        [&arc.u_dot, &arc.theta_dot].map(|rate| {
            let terms = arc.used(rate).iter().enumerate().skip(1).rev();
            terms.fold(0.0, |sum, (k, c)| sum * sigma + k as f64 * c) / arc.span
        })
    })
}

/// The first term of a series and by how much the others may change it.
#[derive(Clone, Copy)]
struct Change {
    start: f64,
    by: f64,
}

impl Change {
    fn of(series: &Series, arc: &Arc) -> Change {
        let by = arc.used(series)[1..].iter().rev().fold(0.0, |sum, c| (sum + c.abs()) * arc.reach);
        Change { start: series[0].abs(), by }
    }

    fn times(self, other: Change) -> Change {
        let by = self.start * other.by + self.by * (other.start + other.by);
        Change { start: self.start * other.start, by }
    }

    fn times_number(self, factor: f64) -> Change {
        Change { start: factor * self.start, by: factor * self.by }
    }

    fn and(self, other: Change) -> Change {
        Change { start: self.start + other.start, by: self.by + other.by }
    }

    fn largest(self) -> f64 {
        self.start + self.by
    }
}

/// How far R_h, R_v and, in full contact, R_m can leave the chords between their ends over `arc`, a motion in `phase`
/// under a linear load: what is linear in ü and θ̈ by its terms of higher order, the rest by twice its change.
pub(crate) fn off_chord(structure: &Structure, phase: Phase, arc: &Arc) -> [f64; 3] {
    let &crate::Parameters { m, m0, H, B, g, .. } = structure.parameters();
    let [u_ddot, theta_ddot] = [&arc.u_dot, &arc.theta_dot].map(|rate| slope(rate, arc));
    if phase == Phase::FullContact {
        let [u, u_ddot] = [&arc.u, &u_ddot].map(|series| extremes::off_chord(arc.used(series), arc.reach));
        return [m * u_ddot, 0.0, H * m * u_ddot + m * g * u];
    }
    let pivot = phase.side().sign() * B;
    let (sin, cos) = libm::sincos(arc.theta[0]);
    let lever = m0 * pivot - m * (arc.u[0] - pivot);
    let along = arc.series(|k| m * (u_ddot[k] + H * theta_ddot[k]));
    let horizontal = arc.series(|k| cos * along[k] + sin * lever * theta_ddot[k]);
    let vertical = arc.series(|k| cos * lever * theta_ddot[k] - sin * along[k]);
    let [horizontal, vertical] = [horizontal, vertical].map(|series| extremes::off_chord(arc.used(&series), arc.reach));

    let [u, u_dot, theta, theta_dot] =
        [&arc.u, &arc.u_dot, &arc.theta, &arc.theta_dot].map(|series| Change::of(series, arc));
    let [along, turning] = [&along, &theta_ddot].map(|series| Change::of(series, arc));
    let square = theta_dot.times(theta_dot);
    let x = Change { start: (arc.u[0] - pivot).abs(), ..u };
    let along_rest = square.times(x).times_number(m).and(square.times_number(m0 * B));
    let sway = Change { start: 0.0, ..u }.times(turning).times_number(m);
    let across_rest = sway.and(square.times_number(m * H)).and(theta_dot.times(u_dot).times_number(2.0 * m));
    let turned = along.largest() + lever.abs() * turning.largest() + along_rest.start + across_rest.start;
    let rest = 2.0 * (along_rest.by + across_rest.by + theta.by * turned);
    [horizontal + rest, vertical + rest, 0.0]
}
