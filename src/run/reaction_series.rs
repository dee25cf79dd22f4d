//! The reactions over a polynomial of the motion: as power series, and as bounds that spare most polynomials the series.
//!
//! The series tell the instant at which a reaction is largest; its value there comes from the state.

use crate::engine::piece::Expansion;
use crate::levels::level::edges;
use crate::mechanics::lateral::Coordinates;
use crate::mechanics::load::Load;
use crate::numbers::Number;
use crate::series::extremes;
use crate::series::taylor::{ORDERS, Series, ZERO, evaluate};
use crate::series::terms::Terms;
use crate::{Base, Motion, Reactions};

/// The reactions of the edges over a polynomial. The moment is given in full contact only; while rocking it is sB R_v.
pub(crate) fn over<Q: Coordinates>(expansion: &Expansion<Q>) -> Reactions<Terms> {
    let &Expansion { piece, from, arc } = expansion;
    let (structure, load, over) = (piece.level.structure(), piece.load.from(from), expansion.over(true));
    let &Motion { phase, ref dissipators, .. } = piece.before;
    let (base, gauges) = (structure.base(), structure.gauges());
    let ramp = |of: &dyn Fn(&Load<Q>) -> f64| Terms::ramp(of(&load.value), of(&load.slope) * arc.span);
    let sum = |of: &Series<Q>| Terms::from_fn(arc.order, |k| of[k].weighed(&gauges.V_t.shape));
    let (offset, mut weight) = (sum(&arc.u), ramp(&|load| load.a_v) + Terms::constant(base.g));
    if let Some(lift) = expansion.lift() {
        weight = weight + lift;
    }
    let along = sum(&arc.u_dot) + over.theta_dot * structure.body().S_1;
    let across = (Terms::constant(over.pivot() * base.m_t) - offset) * over.theta_dot;
    let mut push = ramp(&|load| structure.pushes(load)[0] - base.m_t * load.a_g);
    if let Some(drive) = expansion.drive() {
        push = push - drive * base.m_t;
    }
    let (right, up) = (along * over.turn.cos + across * over.turn.sin, across * over.turn.cos - along * over.turn.sin);
    let R_h = push - right.slope(arc.span);
    let R_v = weight * base.m_t + up.slope(arc.span);
    let R_m = match phase.properties().is_down {
        true => ramp(&|load| structure.pushes(load)[1]) - gauges.M_t.at(&over) + weight * offset,
        false => Terms::constant(0.0),
    };
    edges(&over, piece.level.subject(), dissipators, Reactions { R_h, R_v, R_m })
}

/// Bounds of the reactions over a polynomial of rocking without ties, which cost little beside their series.
///
/// The terms that are linear in ü and θ̈ are added up, turned as the base is at the start, before they are bounded. The others are at
/// most `rest`: those in θ̇, in u θ̈, and what the base turns on by.
pub(crate) fn bounds<Q: Coordinates>(expansion: &Expansion<Q>) -> Option<Reactions<Extent>> {
    let &Expansion { piece, from, arc } = expansion;
    let (level, phase, load) = (piece.level.subject(), piece.before.phase, piece.load.from(from));
    let structure = &level.structure;
    if phase.properties().is_down || level.is_tied || structure.foundation().is_some() {
        return None;
    }
    let most = expansion.most();
    let (&Base { m_t, B, g, .. }, S_1) = (structure.base(), structure.body().S_1);
    let (sin, cos) = libm::sincos(arc.theta[0]);
    let [mut turning, mut along, mut across, mut right, mut down] = [ZERO; 5];
    for k in 0..arc.order {
        let rate = ORDERS[k + 1] / arc.span;
        turning[k] = rate * arc.theta_dot[k + 1];
        along[k] = rate * arc.u_dot[k + 1].weighed(&structure.gauges().V_t.shape) + S_1 * turning[k];
        across[k] = phase.side().sign() * B * m_t * turning[k];
        (right[k], down[k]) = (-along[k] * cos - across[k] * sin, across[k] * cos - along[k] * sin);
    }
    for (k, load, g, scale) in [(0, &load.value, g, 1.0), (1, &load.slope, 0.0, arc.span)] {
        right[k] += scale * (structure.pushes(load)[0] - m_t * load.a_g);
        down[k] += scale * m_t * (g + load.a_v);
    }
    let used = |of: &Series| f64::most(arc.used(of), &evaluate(arc.used(of), arc.reach), arc.reach);
    let moved = |of: &Q| Q::sum(structure, |j, mode| mode.gamma.abs() * of.of(j));
    let (theta_ddot, square) = (used(&turning), most.theta_dot * most.theta_dot);
    let rest = square * (m_t * B + moved(&most.u) + S_1.abs())
        + moved(&most.u) * theta_ddot
        + 2.0 * moved(&most.u_dot) * most.theta_dot;
    let theta = arc.used(&arc.theta);
    let turned = (evaluate(theta, arc.reach) - theta[0]).abs() + extremes::off_chord(theta, arc.reach);
    let off = rest + (used(&along) + used(&across) + rest) * turned;
    let [R_h, R_v] = [right, down].map(|of| {
        let used = arc.used(&of);
        Extent::between(used[0], evaluate(used, arc.reach), extremes::off_chord(used, arc.reach) + off)
    });
    Some(Reactions { R_h, R_v, R_m: Extent::ANY })
}

/// Bounds of a reaction over a polynomial: it stays within `half` of `middle`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Extent {
    pub middle: f64,
    pub half: f64,
}

impl Extent {
    /// The extent of a reaction without bounds.
    pub(crate) const ANY: Extent = Extent { middle: 0.0, half: f64::INFINITY };

    /// The extent of a reaction that leaves the chord between `first` and `last` by at most `off`.
    #[inline(always)]
    pub(crate) fn between(first: f64, last: f64, off: f64) -> Extent {
        Extent { middle: 0.5 * (first + last), half: 0.5 * (last - first).abs() + off }
    }

    /// The extents of `reactions` up to σ = `reach`.
    pub(crate) fn of_all(&Reactions { R_h, R_v, R_m }: &Reactions<Terms>, reach: f64) -> Reactions<Extent> {
        let [R_h, R_v, R_m] = [R_h, R_v, R_m].map(|terms| {
            let used = terms.used();
            Extent::between(used[0], evaluate(used, reach), extremes::off_chord(used, reach))
        });
        Reactions { R_h, R_v, R_m }
    }

    #[inline(always)]
    pub(crate) fn least(&self) -> f64 {
        self.middle - self.half
    }

    #[inline(always)]
    pub(crate) fn largest(&self) -> f64 {
        self.middle + self.half
    }

    /// Bound of the magnitude.
    #[inline(always)]
    pub(crate) fn most(&self) -> f64 {
        self.middle.abs() + self.half
    }
}
