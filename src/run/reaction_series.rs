//! The reactions over a polynomial of the motion: as power series, and as bounds that spare most polynomials the series.
//!
//! The series tell the instant at which a reaction is largest; its value there comes from the state.

use super::profile::Over;
use crate::engine::piece::Expansion;
use crate::levels::detail::AnyLevel;
use crate::levels::level::Subject;
use crate::levels::shown::{linear_parts, over, turning};
use crate::mechanics::floors::MotionOfFloors;
use crate::mechanics::instant::{Instant, Second};
use crate::mechanics::lateral::Coordinates;
use crate::mechanics::load::{LinearLoad, Load};
use crate::mechanics::reactions::{forces, forces_by_momentum, less_momentum};
use crate::mechanics::restraint::Restraint;
use crate::numbers::linear::{Leaf, Linear};
use crate::numbers::{Number, Turn};
use crate::series::extremes::{self, Range};
use crate::series::taylor::{Arc, ORDERS, Series, ZERO, evaluate};
use crate::series::terms::Terms;
use crate::{Dissipators, Modes, Motion, Phase, Reactions, Structure};

/// The reactions of the edges over `arc`, a motion in `phase` under `load`, which is given from its start on. The moment is given
/// in full contact only; while rocking it is sB R_v.
pub(crate) fn of_one(&Expansion { piece, from, arc }: &Expansion) -> Reactions<Terms> {
    let (level, load) = (piece.level, piece.load.from(from));
    let &Motion { phase, ref dissipators, .. } = piece.before;
    let reactions = if phase == Phase::FullContact {
        in_full_contact(level, load, arc)
    } else {
        let x = level.terms(phase, load, arc);
        let [R_h, R_v] = forces_by_momentum(&x, |momentum| momentum.slope(arc.span));
        Reactions { R_h, R_v, R_m: Terms::constant(0.0) }
    };
    of_edges(level.subject(), phase, dissipators, arc, reactions)
}

/// The part of `reactions` that the edges carry.
fn of_edges<Q: Coordinates>(
    &Subject { ref structure, is_tied, angles, .. }: &Subject,
    phase: Phase,
    dissipators: &Dissipators,
    arc: &Arc<Q>,
    reactions: Reactions<Terms>,
) -> Reactions<Terms> {
    if !is_tied {
        return reactions;
    }
    let restraint = Restraint::about(structure.base(), phase.side(), dissipators);
    let [up, right, moment] = match phase {
        Phase::FullContact => restraint.pulls(&angles.chord(0.0, 0.0)).map(Terms::constant),
        _ => {
            let [theta, theta_dot] = [&arc.theta, &arc.theta_dot].map(|series| Terms::of(series, arc.order));
            restraint.pulls(&angles.chord(theta, theta_dot))
        }
    };
    reactions.of_edges(up, right, moment)
}

/// The reactions of the edges of a structure of many masses over a polynomial, like [`of_one`].
pub(crate) fn of_modes(expansion: &Expansion<Modes>) -> Reactions<Terms> {
    let &Expansion { piece, from, arc } = expansion;
    let (frame, load, over) = (piece.level.structure(), piece.load.from(from), Over::new(*expansion));
    let &Motion { phase, ref dissipators, .. } = piece.before;
    let gauges = frame.gauges();
    let ramp = |of: &dyn Fn(&Load<Modes>) -> f64| Terms::ramp(of(&load.value), of(&load.slope) * arc.span);
    let sum = |of: &Series<Modes>| Terms::from_fn(arc.order, |k| gauges.V_t.displacement(&of[k]));
    let (offset, weight) = (sum(&arc.u), ramp(&|load| load.a_v) + Terms::constant(frame.base().g));
    let along = sum(&arc.u_dot) + over.theta_dot() * frame.body().S_1;
    let across = (Terms::constant(over.pivot() * frame.base().m_t) - offset) * over.theta_dot();
    let push = ramp(&|load| frame.pushes(load)[0] - frame.base().m_t * load.a_g);
    let forces = [push, weight * frame.base().m_t];
    let [R_h, R_v] = less_momentum(forces, [along, across], &over.turn(), |momentum| momentum.slope(arc.span));
    let R_m = match phase {
        Phase::FullContact => ramp(&|load| frame.pushes(load)[1]) - over.gauge(&gauges.M_t) + weight * offset,
        _ => Terms::constant(0.0),
    };
    of_edges(piece.level.subject(), phase, dissipators, arc, Reactions { R_h, R_v, R_m })
}

/// The reactions in full contact. There they are linear in u, ü and time, so that their slopes give the series, unless the
/// ground moves vertically.
fn in_full_contact(level: &AnyLevel, load: LinearLoad, arc: &Arc) -> Reactions<Terms> {
    let Reactions { R_h, R_v, R_m } = linear_in_full_contact(level.structure(), load, arc);
    if R_m.rest == 0.0 {
        let of = |reaction: Linear<3>| Terms::from_fn(arc.order, |k| reaction.coefficient(k, &contact_leaves(arc, k)));
        return Reactions { R_h: of(R_h), R_v: of(R_v), R_m: of(R_m) };
    }
    let x = level.terms(Phase::FullContact, load, arc);
    Reactions::at(&x, &Second { u_ddot: x.u_dot.slope(arc.span), theta_ddot: Terms::constant(0.0) })
}

/// The reactions in full contact; leaves u, ü, time.
#[inline(always)]
fn linear_in_full_contact(structure: &Structure, load: LinearLoad, arc: &Arc) -> Reactions<Linear<3>> {
    let none = (Linear::constant(0.0), Turn::none());
    let [u, u_ddot] = Leaf::several(arc.order, |k| contact_leaves(arc, k));
    let x = Instant { u: Linear::leaf(0, 1.0, u), ..over(structure, Phase::FullContact, load, arc, none) };
    Reactions::at(&x, &Second { u_ddot: Linear::leaf(1, 1.0 / arc.span, u_ddot), theta_ddot: Linear::constant(0.0) })
}

/// Coefficient `k` of u and ü, the latter per unit of σ.
#[inline(always)]
fn contact_leaves(arc: &Arc, k: usize) -> [f64; 2] {
    [arc.u[k], arc.slope(&arc.u_dot, k)]
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

    /// The extent of a reaction, given the course of its linear part.
    #[inline(always)]
    fn of<const L: usize>(course: &Range, reaction: &Linear<L>) -> Extent {
        Extent::between(course.start, course.end, course.off_chord + reaction.rest)
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

/// Bounds of the reactions over `arc`, a motion in `phase` under `load`. The moment is given in full contact only.
///
/// Leaves while rocking: θ, ü, θ̈, time. The other components enter as a rest, because they change little over a step.
pub(crate) fn extents(structure: &Structure, phase: Phase, load: LinearLoad, arc: &Arc) -> Reactions<Extent> {
    if phase == Phase::FullContact {
        let Reactions { R_h, R_v, R_m } = linear_in_full_contact(structure, load, arc);
        let reactions = [R_h, R_v, R_m];
        let parts = linear_parts(&reactions, |k| contact_leaves(arc, k), arc);
        let [R_h, R_v, R_m] = std::array::from_fn(|i| Extent::of(&parts[i], &reactions[i]));
        return Reactions { R_h, R_v, R_m };
    }
    let [mut u_slope, mut theta_slope] = [ZERO; 2];
    for k in 1..ORDERS.len().min(arc.order + 1) {
        (u_slope[k - 1], theta_slope[k - 1]) = (ORDERS[k] * arc.u_dot[k], ORDERS[k] * arc.theta_dot[k]);
    }
    let coefficients = |k: usize| [arc.u[k], arc.u_dot[k], arc.theta_dot[k], arc.theta[k], u_slope[k], theta_slope[k]];
    let [u, u_dot, theta_dot, theta, u_ddot, theta_ddot] = Leaf::several(arc.order, coefficients);
    let x = Instant {
        u: Linear::loose(u),
        u_dot: Linear::loose(u_dot),
        theta_dot: Linear::loose(theta_dot),
        ..over::<4>(structure, phase, load, arc, turning(theta))
    };
    let per_span = 1.0 / arc.span;
    let second =
        Second { u_ddot: Linear::leaf(1, per_span, u_ddot), theta_ddot: Linear::leaf(2, per_span, theta_ddot) };
    let reactions = forces(&x, &second);
    let parts = linear_parts(&reactions, |k| [arc.theta[k], u_slope[k], theta_slope[k]], arc);
    let [R_h, R_v] = std::array::from_fn(|i| Extent::of(&parts[i], &reactions[i]));
    Reactions { R_h, R_v, R_m: Extent::ANY }
}
