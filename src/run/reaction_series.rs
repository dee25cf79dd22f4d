//! The reactions over a polynomial of the motion: as power series, and as bounds that spare most polynomials the series.
//!
//! The series tell the instant at which a reaction is largest; its value there comes from the state.

use crate::levels::detail::Model;
use crate::levels::shown::{courses, leaf, over, time};
use crate::mechanics::instant::Second;
use crate::mechanics::load::LinearLoad;
use crate::mechanics::reactions::{forces, moment};
use crate::mechanics::restraint::{Sum, ties};
use crate::numbers::Number;
use crate::numbers::linear::Linear;
use crate::series::extremes::{self, Range};
use crate::series::taylor::Arc;
use crate::series::terms::Terms;
use crate::{Dissipators, Phase, Reactions};

/// The reactions of the edges over `arc`, a motion in `phase` under `load`, which is given from its start on. The moment is given
/// in full contact only; while rocking it is sB R_v.
pub(crate) fn series(
    model: &Model,
    phase: Phase,
    dissipators: &Dissipators,
    load: LinearLoad,
    arc: &Arc,
) -> Reactions<Terms> {
    let x = model.terms(phase, load, arc);
    let second = Second { u_ddot: x.u_dot.slope(arc.span), theta_ddot: x.theta_dot.slope(arc.span) };
    let [R_h, R_v] = forces(&x, &second);
    let R_m = if phase == Phase::FullContact { moment(&x, &second) } else { Terms::constant(0.0) };
    let reactions = Reactions { R_h, R_v, R_m };
    let Some(angles) = model.level.ties() else { return reactions };
    let ties = ties(&model.structure, phase.side(), dissipators);
    let [up, right] = crate::levels::tie_series::TieSeries::over(Sum::of_pulls(&ties), angles, arc).pulls(arc);
    let moment = ties.iter().map(|tie| tie.force * (x.pivot() - tie.lever)).sum::<f64>();
    reactions.of_edges(Terms::of(&up, arc.order), Terms::of(&right, arc.order), Terms::constant(moment))
}

/// Bounds of a reaction over a polynomial.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Extent {
    pub least: f64,
    pub largest: f64,
}

impl Extent {
    fn of(course: &Range, reaction: &Linear<LEAVES>) -> Extent {
        let off = course.off_chord + reaction.rest;
        Extent { least: course.start.min(course.end) - off, largest: course.start.max(course.end) + off }
    }

    /// Bound of the magnitude.
    pub(crate) fn magnitude(&self) -> f64 {
        self.largest.max(-self.least)
    }
}

/// Leaves of the reactions: θ, u, u̇, θ̇, ü, θ̈, time.
const LEAVES: usize = 7;

/// Bounds of the reactions over `arc`, a motion in `phase` under `load`. The moment is given in full contact only.
pub(crate) fn extents(model: &Model, phase: Phase, load: LinearLoad, arc: &Arc) -> Reactions<Extent> {
    let row = |k: usize| {
        let [u_ddot, theta_ddot] = [&arc.u_dot, &arc.theta_dot].map(|rate| arc.slope(rate, k));
        [arc.theta[k], arc.u[k], arc.u_dot[k], arc.theta_dot[k], u_ddot, theta_ddot]
    };
    let [theta, u, u_dot, theta_dot, u_ddot, theta_ddot] = extremes::ranges(row, arc.order, arc.reach).map(leaf);
    let x = crate::mechanics::instant::Instant {
        u: Linear::leaf(1, 1.0, u),
        u_dot: Linear::leaf(2, 1.0, u_dot),
        theta_dot: Linear::leaf(3, 1.0, theta_dot),
        ..over::<LEAVES>(&model.structure, phase, load, arc, theta)
    };
    let second = Second { u_ddot: Linear::leaf(4, 1.0, u_ddot), theta_ddot: Linear::leaf(5, 1.0, theta_ddot) };
    let [R_h, R_v] = forces(&x, &second);
    let leaves = |k: usize| {
        let [theta, u, u_dot, theta_dot, u_ddot, theta_ddot] = row(k);
        [theta, u, u_dot, theta_dot, u_ddot, theta_ddot, time(k)]
    };
    if phase == Phase::FullContact {
        let reactions = [R_h, R_v, moment(&x, &second)];
        let courses = courses(&reactions, leaves, arc);
        let [R_h, R_v, R_m] = std::array::from_fn(|i| Extent::of(&courses[i], &reactions[i]));
        return Reactions { R_h, R_v, R_m };
    }
    let courses = courses(&[R_h, R_v], leaves, arc);
    let [R_h, R_v] = [Extent::of(&courses[0], &R_h), Extent::of(&courses[1], &R_v)];
    Reactions { R_h, R_v, R_m: Extent { least: 0.0, largest: 0.0 } }
}
