//! [Uplift](crate::mechanics::uplift) of a structure in full contact: its first instant, and the distance from it.

use crate::levels::start::Start;
use crate::mechanics::arc::Arc;
use crate::mechanics::lateral::Coordinates;
use crate::mechanics::restraint::Dissipators;
use crate::mechanics::state::way;
use crate::mechanics::uplift::{self, Lift, hold, inertia, least_hold};
use crate::numbers::Number;
use crate::series::first_crossing::{Crossing, Gap, first_time_all_closed};
use crate::series::taylor::ZERO;
use crate::series::terms::Terms;
use crate::{Base, Mode, Ramp, Side, State};

/// The structure whose base can lift off, as a level of detail sees it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Liftable<'a> {
    pub base: &'a Base,
    pub modes: &'a [Mode],
    /// Mass (kg) and height (m) of a top mass that turns rigidly with the base.
    pub rigid: Option<[f64; 2]>,
    /// Factor of the moment that the displaced weights add.
    pub lean: f64,
    /// Whether the inertia about a pivot is the inertia of linear equations, which does not change with u.
    pub has_constant_inertia: bool,
}

impl Liftable<'_> {
    /// The force (N) on mass that no mode carries, and its moment about the height of the pivots (N·m). The base feels `a_g` (m/s²)
    /// and the modes feel `a_top`.
    #[inline(always)]
    pub(crate) fn rest<Q: Coordinates>(&self, a_g: f64, a_top: &Q) -> [f64; 2] {
        match self.rigid {
            Some([mass, height]) => {
                let force = mass * (a_g - a_top.of(0));
                [force, height * force]
            }
            None => a_top.rest().unwrap_or_default(),
        }
    }

    /// Moment on the base to the right, N·m, of the mass that turns rigidly.
    pub(crate) fn moment_of_rest<Q: Coordinates>(&self, a_g: f64, a_top: &Q) -> f64 {
        self.rest(a_g, a_top)[1] - self.base.S_res * a_g
    }

    /// This moment over the step from `start`.
    fn moment_of_rest_over<Q: Coordinates>(&self, &Start { a_g, ref a_top, .. }: &Start<Q>) -> Ramp {
        let [value, slope] =
            [(a_g.value, &a_top.value), (a_g.slope, &a_top.slope)].map(|(a_g, a_top)| self.moment_of_rest(a_g, a_top));
        Ramp { value, slope }
    }

    /// The moments that lift the base, given the moment of the mass that turns rigidly and the vertical acceleration, and (u, u̇) of each
    /// mode.
    #[inline(always)]
    fn lift<N: Number>(&self, rigid_and_a_v: [N; 2], motion: impl Fn(usize) -> [N; 2]) -> Lift<N> {
        Lift::new(self.base, self.modes, self.lean, rigid_and_a_v, motion)
    }

    /// A bound of the moment of the springs, N·m, given a bound of each displacement.
    fn most_springs(&self, most: impl Fn(usize, &Mode) -> f64) -> f64 {
        let modes = self.modes.iter().enumerate();
        modes.map(|(j, mode)| (mode.height * mode.stiffness).abs() * most(j, mode)).sum()
    }

    /// The least moment that holds the base down over the interval of `start`, less the most that mass that turns rigidly takes of it.
    pub(crate) fn least_hold<Q: Coordinates>(&self, start: &Start<Q>) -> f64 {
        let &Start { a_v, dissipators, interval, .. } = start;
        let rest = self.moment_of_rest_over(start);
        let taken = rest.value.abs().max(rest.at(interval).abs());
        least_hold(self.base, a_v, interval, dissipators) - taken
    }

    /// Distance of the structure from uplift, and its side, as in [`uplift::margin`].
    pub(crate) fn margin<Q: Coordinates>(
        &self,
        state: &State<Q>,
        [a_g, a_v]: [f64; 2],
        a_top: &Q,
        dissipators: &Dissipators,
    ) -> (f64, Side) {
        let motion = |j| [state.u.of(j), state.u_dot.of(j)];
        let lift = self.lift([self.moment_of_rest(a_g, a_top), a_v], motion);
        uplift::margin(self.base, &lift, a_v, dissipators, |side| match self.has_constant_inertia {
            true => 1.0,
            false => inertia(self.base, self.modes, side, |j| state.u.of(j)),
        })
    }

    /// Whether a structure in full contact in `state` stays there while nothing acts on it.
    pub(crate) fn stays_down<Q: Coordinates>(&self, state: &State<Q>, dissipators: &Dissipators) -> bool {
        let farthest = |j: usize, mode: &Mode| libm::hypot(state.u.of(j), state.u_dot.of(j) / mode.omega());
        self.most_springs(farthest) < least_hold(self.base, Ramp::default(), 0.0, dissipators)
    }

    /// Whether the base certainly stays down for the interval of `start`, a tiny time, whatever accelerates the modes. Mass that turns
    /// rigidly may lift the base at once.
    pub(crate) fn stays_for<Q: Coordinates>(&self, start: &Start<Q>) -> bool {
        let Start { state, interval, .. } = start;
        let most = |j: usize| state.u.of(j).abs() + way(*interval, state.u_dot.of(j));
        self.base.S_res == 0.0 && self.most_springs(|j, _| most(j)) < self.least_hold(start)
    }

    /// The first instant of `arc`, a motion in full contact from `start`, at which uplift is due, and the side about which the
    /// structure rocks from there.
    pub(crate) fn first<Q: Coordinates>(&self, start: &Start<Q>, arc: &Arc<Q>) -> (Crossing, Side) {
        let farthest = |j: usize| {
            let terms: f64 = arc.u[1..=arc.order].iter().map(|u| u.of(j).abs()).sum();
            arc.u[0].of(j).abs() + terms * arc.reach
        };
        let hold_at_least = self.least_hold(start);
        if self.most_springs(|j, _| farthest(j)) < hold_at_least {
            return (Crossing::None, Side::Right);
        }
        let &Start { a_g, a_top, a_v, dissipators, .. } = start;
        let mut springs = ZERO;
        for (springs, u) in springs.iter_mut().zip(arc.used(&arc.u)) {
            *springs = self.modes.iter().enumerate().map(|(j, mode)| mode.height * mode.stiffness * u.of(j)).sum();
        }
        let rest = self.moment_of_rest_over(start);
        springs[0] += rest.value;
        springs[1] += rest.slope * arc.span;
        // when the springs are due to lift the base, the moment that turns it mostly is, too; none if it is not
        let by_springs = |side: Side| {
            let hold = hold(self.base, side, a_v.value, dissipators);
            let crossing = first_time_all_closed([Gap::new(arc.used(&springs), -side.sign(), hold)], arc.reach);
            let is_due = match crossing {
                Crossing::At(sigma) => {
                    let (State { u, u_dot, .. }, tau) = (arc.at(sigma), sigma * arc.span);
                    let lift = self.lift([rest.at(tau), a_v.value], |j| [u.of(j), u_dot.of(j)]);
                    lift.missing(self.base, side, hold)[1] <= 0.0
                }
                crossing => crossing == Crossing::None,
            };
            is_due.then_some(crossing)
        };
        let is_held = hold_at_least > 0.0 && a_v.slope == 0.0;
        let about = |side: Side| {
            if is_held && let Some(crossing) = by_springs(side) {
                return crossing;
            }
            let a_v_terms = Terms::ramp(a_v.value, a_v.slope * arc.span);
            let rest = Terms::ramp(rest.value, rest.slope * arc.span);
            let lift = self.lift([rest, a_v_terms], |j| {
                [&arc.u, &arc.u_dot].map(|series| Terms::from_fn(arc.order, |k| series[k].of(j)))
            });
            let hold = hold(self.base, side, a_v_terms, dissipators);
            let [rule, turns] = lift.missing(self.base, side, hold);
            let [rule, turns, hold] = [&rule, &turns, &hold].map(|gap| Gap::new(gap.used(), 1.0, 0.0));
            // where nothing holds the base, the moment that turns it decides alone
            let far = first_time_all_closed([rule, turns], arc.reach);
            let loose = first_time_all_closed([hold, turns], arc.reach);
            if far.sigma() <= loose.sigma() { far } else { loose }
        };
        let (right, left) = (about(Side::Right), about(Side::Left));
        let side = match right.sigma().partial_cmp(&left.sigma()) {
            Some(std::cmp::Ordering::Equal) if right.sigma() < f64::INFINITY => {
                let (sigma, at) = (right.sigma(), right.sigma() * arc.span);
                self.margin(&arc.at(sigma), [a_g.at(at), a_v.at(at)], &a_top.at(at), dissipators).1
            }
            Some(std::cmp::Ordering::Greater) => Side::Left,
            _ => Side::Right,
        };
        (if side == Side::Right { right } else { left }, side)
    }
}
