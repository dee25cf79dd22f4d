//! Uplift, full contact → rocking: its first instant, and the distance from it.
//!
//! With s = sign(u), the base lifts off at the first instant at which
//!
//! ```text
//! s u ≥ u_cr      and      s θ̈ > 0,   θ̈ by (5, 6) at θ = θ̇ = 0
//! ```
//!
//! There Eqs 5 and 6 leave, whatever a_g and F_t are,
//!
//! ```text
//! [(J0 + m0 B²)/m + (sB − u)²] θ̈ = H (c_u u̇ + k u)/m + g u − sγ g B
//! ```
//!
//! With modes, both conditions compare moments. The first has the moment of the springs (M3), the second the moment of all that turns
//! the base (M2). Both have the moment that holds the base down on the right side:
//!
//! ```text
//! springs = Σ h k u + R,      turning = springs + Σ [h c_u u̇ + Γ (g + a_v) u],      hold = [m_t (g + a_v) + P_0] B + s Σ F l
//! s springs ≥ hold      and      s turning > hold
//! ```
//!
//! R is the moment of mass that turns rigidly with the base, and F are the residual forces of the dissipators. The first condition is
//! s u ≥ u_cr for one mass. The moments are functions over a number: a value gives the distance from uplift, a power series the first
//! instant.
//!
//! The second condition always holds while |u| of one mass grows through u_cr. After a landing with |u| > u_cr it may not hold.
//! Without this condition contact would open and shut without end.
//!
//! If hold is not above 0, the second condition decides alone. If both conditions hold on both sides, the structure lifts off about
//! the side with the larger s θ̈. "> hold" means more than 1e-12 of the hold at rest, which is far above rounding.

use crate::levels::start::Start;
use crate::mechanics::arc::Arc;
use crate::mechanics::lateral::Coordinates;
use crate::mechanics::restraint::{Dissipators, Restraint};
use crate::mechanics::state::most_change;
use crate::numbers::Number;
use crate::series::first_crossing::{Crossing, Gap, first_time_all_closed};
use crate::series::taylor::ZERO;
use crate::series::terms::Terms;
use crate::{Base, Mode, OneMass, Ramp, Side, State};

/// Smallest excess of the turning moment over the hold, as a fraction of the hold at rest. It is far above rounding. After uplift
/// the base therefore moves away from the ground.
const LEAST_EXCESS: f64 = 1e-12;

/// Inertia D = J0 + m0 B² + Σ μ w² (kg·m²) about the pivot of `side`, w = sB Γ/μ − u, given u of each mode.
pub(crate) fn inertia(base: &Base, modes: &[Mode], side: Side, u: impl Fn(usize) -> f64) -> f64 {
    let square = |(j, mode): (usize, &Mode)| {
        let lever = side.sign() * base.B * mode.share - u(j);
        mode.mass * lever * lever
    };
    base.J0 + base.m0 * base.B * base.B + modes.iter().enumerate().map(square).sum::<f64>()
}

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

impl<'a> Liftable<'a> {
    /// The structure of one mass.
    #[inline(always)]
    pub(crate) fn of_one(one: &'a OneMass, lean: f64, has_constant_inertia: bool) -> Liftable<'a> {
        let modes = std::slice::from_ref(&one.mode);
        Liftable { base: one.base(), modes, rigid: None, lean, has_constant_inertia }
    }

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
    pub(crate) fn moment_of_rest_over<Q: Coordinates>(&self, &Start { a_g, ref a_top, .. }: &Start<Q>) -> Ramp {
        let [value, slope] =
            [(a_g.value, &a_top.value), (a_g.slope, &a_top.slope)].map(|(a_g, a_top)| self.moment_of_rest(a_g, a_top));
        Ramp { value, slope }
    }

    /// The moment that holds the base down about `side` under the vertical acceleration `a_v`, N·m.
    fn hold<N: Number>(&self, side: Side, a_v: N, dissipators: &Dissipators) -> N {
        let residual = Restraint::about(self.base, side, dissipators).residual();
        a_v * (self.base.m_t * self.base.B) + N::constant(self.base.hold_at_rest() + side.sign() * residual)
    }

    /// The smaller hold of both sides under a vertical acceleration of at least `a_v`, N·m.
    fn smaller_hold(&self, a_v: f64, dissipators: &Dissipators) -> f64 {
        self.hold(Side::Right, a_v, dissipators).min(self.hold(Side::Left, a_v, dissipators))
    }

    /// The moments that lift the base to the right, N·m: the springs with the mass that turns rigidly, and all that gives θ̈ at θ = θ̇ = 0
    /// but for what holds the base down. Given are the moment of the mass that turns `rigid`ly, the vertical acceleration, and (u, u̇) of
    /// each mode.
    #[inline(always)]
    fn lift<N: Number>(&self, [rigid, a_v]: [N; 2], motion: impl Fn(usize) -> [N; 2]) -> [N; 2] {
        let weight = a_v + N::constant(self.base.g);
        let (mut springs, mut others) = (rigid, N::constant(0.0));
        for (j, mode) in self.modes.iter().enumerate() {
            let ([u, u_dot], damping) = (motion(j), self.base.c_ratio * mode.damping);
            springs = springs + u * (mode.height * mode.stiffness);
            others = others + weight * u * (mode.gamma * self.lean) + u_dot * (mode.height * damping);
        }
        [springs, springs + others]
    }

    /// The moments that miss of both conditions of uplift about `side` with this `hold`; not above 0 once there.
    #[inline(always)]
    fn missing<N: Number>(&self, [springs, turning]: [N; 2], side: Side, hold: N) -> [N; 2] {
        let (s, excess) = (side.sign(), N::constant(LEAST_EXCESS * self.base.hold_at_rest()));
        [hold - springs * s, hold + excess - turning * s]
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
        self.smaller_hold(a_v.value.min(a_v.at(interval)), dissipators) - taken
    }

    /// Distance of a structure in full contact from uplift, and the side of the smaller distance. The distance is the larger of what both
    /// conditions miss, as a fraction of the hold at rest. Uplift is due if the distance is not positive. If uplift is due about both sides,
    /// the side is the one with the larger s θ̈.
    pub(crate) fn margin<Q: Coordinates>(
        &self,
        state: &State<Q>,
        [a_g, a_v]: [f64; 2],
        a_top: &Q,
        dissipators: &Dissipators,
    ) -> (f64, Side) {
        let lift = self.lift([self.moment_of_rest(a_g, a_top), a_v], |j| [state.u.of(j), state.u_dot.of(j)]);
        let about = |side: Side| {
            let hold = self.hold(side, a_v, dissipators);
            let [rule, turns] = self.missing(lift, side, hold);
            let inertia = match self.has_constant_inertia {
                true => 1.0,
                false => inertia(self.base, self.modes, side, |j| state.u.of(j)),
            };
            (rule.min(hold).max(turns) / self.base.hold_at_rest(), turns / inertia)
        };
        let (right, left) = (about(Side::Right), about(Side::Left));
        let is_right = if right.0 <= 0.0 && left.0 <= 0.0 { right.1 <= left.1 } else { right.0 <= left.0 };
        if is_right { (right.0, Side::Right) } else { (left.0, Side::Left) }
    }

    /// Whether a structure in full contact in `state` stays there while nothing acts on it.
    pub(crate) fn stays_down<Q: Coordinates>(&self, state: &State<Q>, dissipators: &Dissipators) -> bool {
        let farthest = |j: usize, mode: &Mode| libm::hypot(state.u.of(j), state.u_dot.of(j) / mode.omega());
        self.most_springs(farthest) < self.smaller_hold(0.0, dissipators)
    }

    /// Whether the base certainly stays down for the interval of `start`, a tiny time, whatever accelerates the modes. Mass that turns
    /// rigidly may lift the base at once.
    pub(crate) fn stays_for<Q: Coordinates>(&self, start: &Start<Q>) -> bool {
        let Start { state, interval, .. } = start;
        let most = |j: usize| state.u.of(j).abs() + most_change(*interval, state.u_dot.of(j));
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
            let hold = self.hold(side, a_v.value, dissipators);
            let crossing = first_time_all_closed([Gap::new(arc.used(&springs), -side.sign(), hold)], arc.reach);
            let is_due = match crossing {
                Crossing::At(sigma) => {
                    let (State { u, u_dot, .. }, tau) = (arc.at(sigma), sigma * arc.span);
                    let lift = self.lift([rest.at(tau), a_v.value], |j| [u.of(j), u_dot.of(j)]);
                    self.missing(lift, side, hold)[1] <= 0.0
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
            let hold = self.hold(side, a_v_terms, dissipators);
            let [rule, turns] = self.missing(lift, side, hold);
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

/// Distance from uplift of a structure in full contact in `state`, without restraints and vertical motion: positive until uplift
/// is due. Integrators without an engine use it.
pub fn distance(one: &OneMass, state: &State) -> f64 {
    Liftable::of_one(one, 1.0, true).margin(state, [0.0; 2], &0.0, &Dissipators::NEW).0
}

/// The |a_top| (m/s²) from which on the base of a rigid structure lifts off: g tan α_cg + P_0 B/S_1, where S_1 = m_t B/tan α_cg.
pub fn least_push(base: &Base) -> f64 {
    (1.0 + LEAST_EXCESS) * base.hold_at_rest() * base.tan_alpha_cg / (base.m_t * base.B)
}
