//! Elastoplastic dissipators while the base rocks: when they begin and cease to yield, and the energy that they have taken.
//!
//! An elastic dissipator reaches ±F_y at a rotation θ that follows from its e_p. A dissipator ceases to yield when its elongation
//! turns round, at a zero of θ̇. Its force is then still ±F_y, and yielding resumes only after the elongation moves that sign again.
//! The zeros of θ̇ at the start are therefore divided out, like the zeros of θ at an uplift.

use crate::engine::guard::{BAND, Guard};
use crate::engine::motion::Motion;
use crate::engine::sample::Sample;
use crate::engine::step::{Branch, Moved, Step, see};
use crate::engine::transition::TransitionKind;
use crate::levels::level::Level;
use crate::mechanics::lateral::Coordinates;
use crate::mechanics::restraint::{dampers, levers};
use crate::mechanics::state::most_change;
use crate::series::first_crossing::{Crossing, Gap, first_time_all_closed};
use crate::series::taylor::{ZERO, evaluate};
use crate::series::terms::Terms;
use crate::{Base, Side, Ties};

/// The smallest rotation at which a dissipator begins to yield as the base comes down, as a fraction of the rotation from 0 to F_y.
/// Below this rotation the impact comes first. A dissipator that has yielded up to an impact returns to F_y exactly at the next
/// impact, so that rounding alone would decide.
const AT_CONTACT: f64 = 1e-10;

/// A dissipator begins to yield, pulled or pressed by the sign, or ceases to yield if the sign is 0.
pub(crate) struct Yielding;

impl<Q: Coordinates> Guard<Q> for Yielding {
    fn first(&self, &Step { level, side, start, arc, reach, .. }: &Step<Q>) -> (Crossing, Branch) {
        let (base, dissipators) = (level.structure().base(), start.dissipators);
        let Ties { k_d, F_y, .. } = base.ties;
        let mut found = (Crossing::None, Branch::default());
        let theta_dot = arc.used(&arc.theta_dot);
        let Some(zeros) = theta_dot.iter().position(|c| c.is_normal()) else { return found };
        for (j, lever) in moving(base, side) {
            // positive while the elongation moves that sign
            let moves = |sign: f64| Gap::new(&theta_dot[zeros..], (sign * lever).signum(), 0.0);
            match dissipators.yields[j] {
                0 => {
                    for sign in [1_i8, -1] {
                        let elongation = dissipators.plastic[j] + f64::from(sign) * F_y / k_d;
                        let Some(theta) = level.subject().detail.angles().rotation(elongation / lever) else {
                            continue;
                        };
                        let towards = (f64::from(sign) * lever).signum();
                        let is_at_contact = theta.abs() <= AT_CONTACT * (F_y / (k_d * lever)).abs();
                        if is_at_contact && towards != side.sign() {
                            continue;
                        }
                        let is_less = Gap::new(arc.used(&arc.theta), -towards, towards * theta);
                        let moves_back = moves(-f64::from(sign));
                        see(&mut found, first_time_all_closed([is_less, moves_back], reach), j, sign);
                    }
                }
                sign => see(&mut found, first_time_all_closed([moves(f64::from(sign))], reach), j, 0),
            }
        }
        found
    }

    fn apply(&self, _level: &dyn Level<Q>, motion: &mut Motion<Q>, branch: Branch) -> Option<TransitionKind> {
        let which = usize::from(branch.which);
        *motion.dissipators.yields.get_mut(which)? = branch.sign;
        if branch.sign != 0 {
            return Some(TransitionKind::Yielding(which));
        }
        motion.state.theta_dot = 0.0; // the elongation turns round
        Some(TransitionKind::Unloading(which))
    }

    fn stays_open(&self, now: &Sample<Q>, ahead: f64) -> bool {
        let theta_ddot = now.second().theta_ddot;
        let changes = [now.motion.state.theta_dot, 2.0 * theta_ddot].map(|rate| most_change(ahead, rate));
        least_margin(now, changes) > 0.0
    }

    fn indicator(&self, now: &Sample<Q>) -> (usize, f64) {
        (1, least_margin(now, [0.0; 2]) + BAND)
    }
}

/// The dissipators, by number, with their levers about `side`. A dissipator at the pivot is left out: rocking does not elongate it.
fn moving(base: &Base, side: Side) -> impl Iterator<Item = (usize, f64)> {
    levers(base, side).into_iter().enumerate().filter(|(_, lever)| *lever != 0.0)
}

/// The smallest distance of the dissipators from beginning or ceasing to yield, less the most by which `changes` of θ and θ̇ (rad,
/// rad/s) can reduce the distance. The distance from yielding is a fraction of F_y, and from ceasing a fraction of p_l α_cg.
fn least_margin<Q: Coordinates>(now: &Sample<Q>, changes: [f64; 2]) -> f64 {
    let (base, Motion { phase, state, dissipators, .. }) = (now.level.structure().base(), &now.motion);
    let (side, angles) = (phase.side(), now.level.subject().detail.angles());
    let Ties { k_d, F_y, .. } = base.ties;
    let chord = angles.chord(state.theta, 0.0).length;
    let of = |(j, lever): (usize, f64)| match f64::from(dissipators.yields[j]) {
        0.0 => 1.0 - k_d * ((lever * chord - dissipators.plastic[j]).abs() + lever.abs() * changes[0]) / F_y,
        sign => {
            let natural = base.p_l * libm::atan(base.tan_alpha_cg);
            (sign * lever.signum() * state.theta_dot - changes[1]) / natural
        }
    };
    moving(base, side).map(of).fold(1.0, f64::min)
}

/// The dissipators at the reach of a step, if there are any or a tendon.
pub(crate) fn moved<Q: Coordinates>(&Step { level, side, start, arc, reach, .. }: &Step<Q>) -> Moved<Q> {
    let (base, angles) = (level.structure().base(), level.subject().detail.angles());
    if !base.is_restrained() {
        return (None, None);
    }
    let chord = || angles.chord(evaluate(arc.used(&arc.theta), reach), 0.0).length;
    let power = |(c, rate): (f64, Terms)| c * (product_integral(rate.used(), rate.used(), reach) * arc.span);
    let powers = dampers(base, angles, arc).map(power);
    (Some(start.dissipators.stepped(base, |j| levers(base, side)[j] * chord(), powers)), None)
}

/// ∫ (Σ a_k σᵏ) (Σ b_k σᵏ) dσ from 0 to `reach`.
pub(super) fn product_integral(a: &[f64], b: &[f64], reach: f64) -> f64 {
    let terms = |coefficients: &[f64]| {
        let mut terms = ZERO;
        terms.iter_mut().zip(coefficients).fold(1.0, |power, (term, c)| {
            *term = c * power;
            power * reach
        });
        terms
    };
    let [a, b] = [a, b].map(|of| (terms(of), of.len())).map(|(terms, len)| terms.into_iter().take(len));
    let with = |(i, a): (usize, f64)| b.clone().enumerate().map(|(j, b)| a * b / (i + j + 1) as f64).sum::<f64>();
    a.enumerate().map(with).sum::<f64>() * reach
}
