//! Friction under a base that may slide on ground that gives: it sticks, slides to a side, or flies.
//!
//! A base that sticks slides once the friction that it needs exceeds μ_c N. A base that slides stops where its velocity returns to 0, and
//! sticks, or slides back at once. Points change first, then friction once.

use crate::engine::contacts::{ROUNDING, first, normal, opened};
use crate::engine::guard::{BAND, Guard};
use crate::engine::motion::Motion;
use crate::engine::sample::Sample;
use crate::engine::step::{Branch, Step, see};
use crate::engine::transition::TransitionKind;
use crate::levels::level::Level;
use crate::levels::sliding::mobility;
use crate::levels::start::Start;
use crate::mechanics::arc::Arc;
use crate::mechanics::lateral::Coordinates;
use crate::series::extremes::off_chord;
use crate::series::first_crossing::Crossing;
use crate::series::taylor::{ORDERS, Series, ZERO, evaluate, product, sum_of_magnitudes, weighed_sum};
use crate::{Base, Foundation, Friction, Output, Phase, PressedPoints, Side, State, Structure};

/// The base, which may slide, sticks, slides or flies.
pub(crate) struct Sliding;

/// All frictions.
const FRICTIONS: [Friction; 4] =
    [Friction::Sticks, Friction::Slides(Side::Left), Friction::Slides(Side::Right), Friction::Free];

/// The number of `friction` in a branch.
fn number(friction: Friction) -> i8 {
    match friction {
        Friction::Sticks => 0,
        Friction::Slides(Side::Left) => 1,
        Friction::Slides(Side::Right) => 2,
        Friction::Free => 3,
    }
}

/// The friction that a base needs to stick over a step, N: R_h = m_t a_g − Σ F + (S_1 sin θ + μ cos θ)¨ (S2).
struct Needed {
    /// R_h without the part −[μ (1 − cos θ)]¨.
    linear: Series,
    /// The rate of μ over the step.
    rate: Series,
    /// What counts as 0 of R_h at the start.
    rounding: f64,
}

impl Needed {
    fn new<Q: Coordinates>(structure: &Structure, start: &Start<Q>, arc: &Arc<Q>) -> Needed {
        let (ground, modes) = (structure.ground(), structure.modes());
        let (&Base { m_t, g, .. }, S_1) = (structure.base(), structure.body().S_1);
        let mut needed = Needed { linear: ZERO, rate: ZERO, rounding: 0.0 };
        for (k, u_dot) in arc.used(&arc.u_dot).iter().enumerate() {
            needed.rate[k] = offset(structure, u_dot);
            if k > 0 {
                needed.linear[k - 1] = ORDERS[k] / arc.span * (S_1 * u_dot.of(ground.place + 1) + needed.rate[k]);
            }
        }
        let pushed = |a_g: f64, a_top: &Q| {
            let of_modes = modes.iter().enumerate().map(|(j, mode)| mode.gamma * (mode.share * a_g - a_top.of(j)));
            of_modes.sum::<f64>() + a_top.rest().map_or(0.0, |[force, _]| force)
        };
        for (k, a_g, a_top, scale) in
            [(0, start.a_g.value, &start.a_top.value, 1.0), (1, start.a_g.slope, &start.a_top.slope, arc.span)]
        {
            needed.linear[k] += scale * (m_t * a_g - pushed(a_g, a_top));
        }
        let slopes = modes.iter().enumerate().map(|(j, mode)| mode.gamma * arc.u_dot[1].of(j));
        let forces = slopes.chain([S_1 * arc.u_dot[1].footing(ground).sin]).map(|of| of.abs() / arc.span).sum::<f64>();
        needed.rounding = ROUNDING * (m_t * (g + start.a_g.value.abs()) + forces);
        needed
    }

    /// Whether a base under this `normal` force, with the friction `mu_c`, certainly sticks up to `reach`: far from slipping by the sums of the
    /// terms, otherwise by what both ends have left, less how far either force leaves its chord.
    fn is_there<Q: Coordinates>(
        &self,
        structure: &Structure,
        (mu_c, normal): (f64, &Series),
        arc: &Arc<Q>,
        reach: f64,
    ) -> bool {
        let ([normal, linear], rest) = ([normal, &self.linear].map(|of| arc.used(of)), self.rest(structure, arc));
        if mu_c * (2.0 * normal[0] - sum_of_magnitudes(normal)) > sum_of_magnitudes(linear) + rest {
            return true;
        }
        let left = |normal: f64, linear: f64| mu_c * normal - linear.abs();
        let least = left(normal[0], linear[0]).min(left(evaluate(normal, reach), evaluate(linear, reach)));
        let off = mu_c * off_chord(normal, reach) + off_chord(linear, reach);
        least > off + rest
    }

    /// Bound of the part that is left out.
    fn rest<Q: Coordinates>(&self, structure: &Structure, arc: &Arc<Q>) -> f64 {
        let slope = |of: &Series| weighed_sum(&ORDERS[1..], &of[1..=arc.order]) / arc.span;
        let (bend, second) = (slope(&arc.theta_dot), slope(&self.rate));
        let most = |first: f64, slope: f64| first.abs() + arc.span * slope;
        let (theta_dot, rate) = (most(arc.theta_dot[0], bend), most(self.rate[0], second));
        let (theta, offset) = (most(arc.theta[0], theta_dot), most(offset(structure, &arc.u[0]), rate));
        second * theta * theta / 2.0 + 2.0 * rate * theta_dot * theta + offset * (bend * theta + theta_dot * theta_dot)
    }

    /// R_h over the step.
    fn series<Q: Coordinates>(&self, structure: &Structure, arc: &Arc<Q>) -> Series {
        let [mut sin, mut cos, mut of] = [ZERO; 3];
        for (k, u) in arc.used(&arc.u).iter().enumerate() {
            (sin[k], of[k]) = (u.footing(structure.ground()).sin, offset(structure, u));
        }
        cos[0] = libm::cos(arc.theta[0]);
        (1..=arc.order).for_each(|k| cos[k] = -product(&arc.theta_dot, &sin, k - 1) * arc.span / ORDERS[k]);
        let mut needed = self.linear;
        for k in 2..=arc.order {
            let second = ORDERS[k] * ORDERS[k - 1] / (arc.span * arc.span);
            needed[k - 2] += second * product(&of, &cos, k) - ORDERS[k - 1] / arc.span * self.rate[k - 1];
        }
        needed
    }
}

/// μ of these coordinates, kg·m, or its rate.
#[inline(always)]
fn offset<Q: Coordinates>(structure: &Structure, u: &Q) -> f64 {
    let gammas = &structure.gauges().V_t.shape;
    let rest = (4..gammas.count).step_by(4);
    let four = rest.fold(u.four(0) * gammas.four(0), |sum, j| sum + u.four(j) * gammas.four(j));
    four.to_array().iter().sum()
}

/// How friction goes on where the base stops or is touched in `state`, `tau` seconds after `start`: it sticks unless it needs more than the
/// friction that there is (S4).
fn stopped<Q: Coordinates>(
    level: &dyn Level<Q>,
    contact: PressedPoints,
    (start, tau): (&Start<Q>, f64),
    mut state: State<Q>,
) -> Friction {
    let structure = level.structure();
    let (ground, contact) = (structure.ground(), PressedPoints { friction: Friction::Sticks, ..contact });
    set_rate(ground, &mut state, 0.0);
    let (a_g, a_top, a_v) = (start.a_g.from(tau), start.a_top.from(tau), start.a_v.from(tau));
    let start = Start { state, a_g, a_top, a_v, interval: level.longest_step(), ..*start };
    let mut arc = Arc::default();
    level.series(Phase::OnGround(contact), &start, &mut arc);
    let needed = Needed::new(structure, &start, &arc);
    let (rounding, needed) = (needed.rounding, needed.series(structure, &arc)[0]);
    let most = ground.mu_c.unwrap_or(0.0) * normal(ground, contact, &start, &arc)[0];
    match needed.abs() > most + rounding {
        true => Friction::Slides(Side::of(-needed)),
        false => Friction::Sticks,
    }
}

/// Writes ẋ.
fn set_rate<Q: Coordinates>(ground: &Foundation, state: &mut State<Q>, x_dot: f64) {
    ground.slide().into_iter().for_each(|place| state.u_dot.set(place, x_dot));
}

/// Part of a step by which a change of friction comes later than the change of a point at the same instant.
const AT_ONCE: f64 = 1e-12;

impl<Q: Coordinates> Guard<Q> for Sliding {
    fn first(&self, step: &Step<Q>) -> (Crossing, Branch) {
        let &Step { level, contact, start, arc, reach, is_cut, .. } = step;
        let none = (Crossing::None, Branch::default());
        let (structure, ground) = (level.structure(), level.structure().ground());
        let Some(mu_c) = ground.mu_c else { return none };
        // points come first, then friction once
        let reach = if is_cut { (1.0 - AT_ONCE) * reach - f64::MIN_POSITIVE } else { reach };
        if reach < 0.0 {
            return none;
        }
        let becomes = |crossing, friction| (crossing, Branch { which: 0, sign: number(friction) });
        let (is_free, x_dot) = (contact.pressed == 0, start.state.u_dot.slide(ground).unwrap_or(0.0));
        match contact.friction {
            Friction::Free if is_free => none,
            _ if is_free => becomes(Crossing::At(0.0), Friction::Free),
            Friction::Free if x_dot != 0.0 => becomes(Crossing::At(0.0), Friction::Slides(Side::of(x_dot))),
            Friction::Free => becomes(Crossing::At(0.0), stopped(level, contact, (start, 0.0), start.state)),
            Friction::Sticks => {
                let needed = Needed::new(structure, start, arc);
                let normal = normal(ground, contact, start, arc);
                if needed.is_there(structure, (mu_c, &normal), arc, reach) {
                    return none;
                }
                let (rounding, needed, mut found) = (needed.rounding, needed.series(structure, arc), none);
                let part = arc.span / level.longest_step();
                for (sign, slides) in [(1.0, Side::Left), (-1.0, Side::Right)] {
                    let gap = (std::array::from_fn(|k| mu_c * normal[k] - sign * needed[k]), rounding);
                    // the last two orders of R_h are not known
                    let gap = opened(&gap, 1.0, arc.order.saturating_sub(2), part);
                    let sign = number(Friction::Slides(slides));
                    let crossing = first([gap], found.0.sigma().min(reach));
                    see(&mut found, crossing, usize::from(crossing == Crossing::At(0.0)), sign);
                }
                found
            }
            Friction::Slides(side) => {
                let rate = std::array::from_fn(|k| arc.u_dot[k].slide(ground).unwrap_or(0.0));
                // a slip begins where friction misses what is needed by no more than its rounding on each side
                let off = || 2.0 * Needed::new(structure, start, arc).rounding * mobility(structure, &start.state);
                let gap = (rate, if x_dot == 0.0 { off() * level.longest_step() } else { 0.0 });
                match first([opened(&gap, side.sign(), arc.order, arc.span / level.longest_step())], reach) {
                    Crossing::At(sigma) => {
                        let state = arc.at(sigma);
                        becomes(Crossing::At(sigma), stopped(level, contact, (start, sigma * arc.span), state))
                    }
                    crossing => (crossing, Branch::default()),
                }
            }
        }
    }

    fn apply(&self, level: &dyn Level<Q>, motion: &mut Motion<Q>, branch: Branch) -> Option<TransitionKind> {
        let Phase::OnGround(contact) = &mut motion.phase else { return None };
        let (before, after) = (contact.friction, FRICTIONS.into_iter().find(|of| number(*of) == branch.sign)?);
        contact.friction = after;
        // the friction from the start on is no change of it
        if branch.which == 1 && motion.transitions == 0 && motion.work.steps <= 1 {
            return None;
        }
        if matches!((before, after), (Friction::Slides(_), Friction::Slides(_) | Friction::Sticks)) {
            set_rate(level.structure().ground(), &mut motion.state, 0.0);
        }
        Some(TransitionKind::Friction(after))
    }

    fn indicator(&self, now: &Sample<Q>) -> (usize, f64) {
        let (structure, Motion { phase, state, .. }) = (now.level.structure(), &now.motion);
        let (base, ground, contact) = (structure.base(), structure.ground(), phase.contact());
        let x_dot = state.u_dot.slide(ground).unwrap_or(0.0);
        let margin = match (ground.mu_c, contact.friction) {
            (Some(_), Friction::Slides(side)) => side.sign() * x_dot / (base.g * base.B).sqrt(),
            (Some(mu_c), Friction::Sticks) => {
                let of = now.outputs();
                let N: f64 = (0..ground.points.len()).map(|i| of(Output::N(i))).sum();
                (mu_c * N - now.reactions().R_h.abs()) / (base.m_t * base.g)
            }
            _ => 1.0,
        };
        (1, margin + BAND)
    }
}
