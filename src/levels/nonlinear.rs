//! Rocking about side s = ±1, in full (Eqs 5, 6).
//!
//! ```text
//! m ü + m H θ̈ = −c_u u̇ − k u − m θ̇² (sB − u) − m a_g cos θ + m g sin θ                            (5)
//!
//! m H ü + [J0 + m H² + m (sB − u)² + m0 B²] θ̈
//!     = 2 m (sB − u) u̇ θ̇ + m g H sin θ + m g u cos θ − s (m + m0) g B cos θ
//!       − a_g [ m H cos θ + (s (m + m0) B − m u) sin θ ]                                            (6)
//! ```
//!
//! A force F_t on the top mass adds F_t cos θ to (5) and F_t [H cos θ + (sB − u) sin θ] to (6).
//!
//! The series are series of momenta instead of velocities, which takes the fewest products. Let y be the momentum along u over m,
//! and L the angular momentum about the pivot over m without the part of y:
//!
//! ```text
//! y = u̇ + H θ̇        L = (i + w²) θ̇        w = sB − u        κ = (c_u u̇ + k u)/m        i = (J0 + m0 B²)/m
//! a = a_g − F_t/m     F = g sin θ − a cos θ     G = g cos θ + a sin θ     G₀ = g cos θ + a_g sin θ
//! ```
//!
//! Eq 5 and (6) − H (5) then read
//!
//! ```text
//! ẏ = F − κ − w θ̇²
//! L̇ = H (κ + w θ̇²) − w G − s(γ−1)B G₀
//! ```
//!
//! Of a restrained structure, or one shaken vertically, g is g + a_v, linear in time, and the moment of the ties
//! ([`restraint`](crate::mechanics::restraint)) over m is taken from L̇.

use crate::levels::level::ElasticRocking;
use crate::levels::start::{Pace, Start};
use crate::mechanics::arc::Arc;
use crate::mechanics::load::Load;
use crate::mechanics::restraint::{Angles, Dissipators, Restraint};
use crate::numbers::Real;
use crate::series::taylor::{MAX_ORDER, add_each_product};
use crate::{OneMass, Side, State};
use nalgebra::{Matrix2, Vector2};
use std::cell::RefCell;
use std::ops::{AddAssign, Mul};
use wide::f64x2;

/// Accelerations (ü, θ̈) in m/s² and rad/s² under `load`, by Eqs 5 and 6 with the ties and these `dissipators`. None if the mass
/// matrix is singular: m0 = J0 = 0 and u = sB, the top mass above the pivot.
pub fn accelerations(
    structure: &OneMass,
    side: Side,
    state: &State,
    load: Load,
    dissipators: &Dissipators,
) -> Option<Vector2<f64>> {
    let back = match structure.base().is_restrained() {
        true => {
            let chord = Angles::Any.chord(state.theta, state.theta_dot);
            Restraint::about(structure.base(), side, dissipators).moment(&chord)
        }
        false => 0.0,
    };
    let Load { a_g, F_t, a_v } = load;
    let &crate::Parameters { m, m0, H, B, J0, g, .. } = structure.parameters();
    let g = g + a_v;
    let &State { u, u_dot, theta, theta_dot } = state;
    let s = side.sign();
    let (sin, cos) = libm::sincos(theta);
    let lever = s * B - u;
    let mass = Matrix2::new(m, m * H, m * H, J0 + m * H * H + m * lever * lever + m0 * B * B);
    let force = Vector2::new(
        -structure.c_u * u_dot - structure.k * u - m * theta_dot * theta_dot * lever - m * a_g * cos
            + m * g * sin
            + F_t * cos,
        2.0 * m * lever * u_dot * theta_dot + m * g * H * sin + m * g * u * cos
            - s * (m + m0) * g * B * cos
            - a_g * (m * H * cos + (s * (m + m0) * B - m * u) * sin)
            + F_t * (H * cos + lever * sin)
            - back,
    );
    Some(mass.try_inverse()? * force)
}

/// The smallest inertia about the pivot, without the height, as a fraction of the inertia at u = 0. Below this limit the solution of
/// (6) − H (5) would take ever shorter steps towards a singularity.
pub(crate) const LEAST_INERTIA: f64 = 1e-6;

/// One order of the factors of six products.
pub(super) type SixRow = [f64x2; 3];

pub(super) const NO_ROW: SixRow = [f64x2::ZERO; 3];

/// Factors of six products, one row per order.
pub(super) type Factors = [SixRow; MAX_ORDER + 1];

#[inline(always)]
pub(super) fn row(columns: [f64; 6]) -> SixRow {
    [f64x2::new([columns[0], columns[1]]), f64x2::new([columns[2], columns[3]]), f64x2::new([columns[4], columns[5]])]
}

#[inline(always)]
pub(super) fn add_product<const FIRST: usize, const ALL: usize, V: Copy + Mul<Output = V> + AddAssign>(
    sum: &mut [V; ALL],
    a: &[V; ALL],
    b: &[V; ALL],
) {
    for lanes in 0..FIRST {
        sum[lanes] += a[lanes] * b[lanes];
    }
}

/// Coefficient `n` of the products in each column of the first `PAIRS` pairs: six Cauchy products at once.
#[inline(always)]
pub(super) fn products<const PAIRS: usize>(a: &Factors, b: &Factors, newest: (&SixRow, &SixRow), n: usize) -> [f64; 6] {
    let mut sum = NO_ROW;
    add_each_product!(add_product::<PAIRS, 3, _>, &mut sum, a, b, newest, n);
    let [first, second, third] = sum.map(f64x2::to_array);
    [first[0], first[1], second[0], second[1], third[0], third[1]]
}

/// A number in which Eqs 5 and 6 are expanded.
pub(crate) trait Expanded: Real {
    /// One order of the left factors of the six products.
    type Left: Copy;
    /// One order of their right factors.
    type Right: Copy;

    fn left(turning: Self, lever_turning: Self, lever: Self) -> Self::Left;

    fn right(cos: Self, sin: Self, next_lever: Self, turning: Self, weight: Self) -> Self::Right;

    /// Coefficient `n` of each product, as [`products`] sums it.
    fn products(
        left: &[Self::Left; MAX_ORDER + 1],
        right: &[Self::Right; MAX_ORDER + 1],
        newest: (&Self::Left, &Self::Right),
        n: usize,
    ) -> [Self; 6];
}

impl Expanded for f64 {
    type Left = SixRow;
    type Right = SixRow;

    #[inline(always)]
    fn left(turning: f64, lever_turning: f64, lever: f64) -> SixRow {
        row([turning, turning, turning, lever_turning, lever_turning, lever])
    }

    #[inline(always)]
    fn right(cos: f64, sin: f64, next_lever: f64, turning: f64, weight: f64) -> SixRow {
        row([cos, sin, next_lever, next_lever, turning, weight])
    }

    #[inline(always)]
    fn products(left: &Factors, right: &Factors, newest: (&SixRow, &SixRow), n: usize) -> [f64; 6] {
        products::<3>(left, right, newest, n)
    }
}

/// The numbers of a structure that rocks about one side, as Eqs 5 and 6 contain them.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Rocker<N> {
    pub H: N,
    /// s B.
    pub pivot: N,
    /// s(γ−1)B.
    pub weight_offset: N,
    /// i.
    pub foundation: N,
    pub stiffness: N,
    pub damping_u: N,
}

/// The numbers in Eqs 5 and 6 over one step. A load is its value at the start and its gain over the span.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Equations<N> {
    pub rocker: Rocker<N>,
    pub u: N,
    pub u_dot: N,
    pub theta_dot: N,
    /// sin θ and cos θ.
    pub turn: [N; 2],
    /// a.
    pub push: [N; 2],
    /// a_g.
    pub ground: [N; 2],
    /// g + a_v. The gain counts for tied structures alone.
    pub gravity: [N; 2],
}

/// The coefficients of the last order, from which those of the next one follow.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Recurrence<N: Expanded> {
    of: Equations<N>,
    /// w at the start.
    lever: N,
    per_inertia: N,
    /// H, s(γ−1)B and w over the inertia, so that few operations stand between one order of θ̇ and the next.
    height: N,
    offset: N,
    lever_start: N,
    sin: N,
    cos: N,
    /// G, G₀, F and κ.
    weight: N,
    weight_below: N,
    along: N,
    elastic: N,
    theta_dot: N,
    newest_left: N::Left,
}

/// The factors of the products. Row i of `left`, and of `right` counted from its end, holds
///
/// ```text
/// left:   θ̇       θ̇      θ̇         w θ̇       w θ̇     w
/// right:  cos θ   sin θ   w, next   w, next   θ̇       G
/// ```
///
/// of order i ("next": of order i + 1). The products of the columns are, in order: the rates of sin θ and −cos θ, the parts of w θ̇
/// and w² θ̇ from the later coefficients of w, w θ̇², and the moment of the top mass's weight.
#[derive(Clone, Debug)]
pub(crate) struct Products<N: Expanded> {
    left: [N::Left; MAX_ORDER + 1],
    right: [N::Right; MAX_ORDER + 1],
}

impl<N: Expanded> Products<N> {
    /// Room for the factors; `zero` is 0.
    #[inline(always)]
    pub(crate) fn new(zero: N) -> Products<N> {
        let (left, right) = (N::left(zero, zero, zero), N::right(zero, zero, zero, zero, zero));
        Products { left: [left; MAX_ORDER + 1], right: [right; MAX_ORDER + 1] }
    }
}

impl<N: Expanded> Recurrence<N> {
    /// The coefficients of order 0.
    #[inline(always)]
    pub(crate) fn new(of: Equations<N>) -> Recurrence<N> {
        let Equations { rocker, u, u_dot, theta_dot, turn: [sin, cos], .. } = of;
        let Rocker { H, pivot, weight_offset, foundation, stiffness, damping_u } = rocker;
        let ([g, _], [a, _], [a_ground, _]) = (of.gravity, of.push, of.ground);
        let lever = pivot - u;
        let per_inertia = g.like(1.0) / (foundation + lever * lever);
        Recurrence {
            of,
            lever,
            per_inertia,
            height: H * per_inertia,
            offset: weight_offset * per_inertia,
            lever_start: lever * per_inertia,
            sin,
            cos,
            weight: g * cos + a * sin,
            weight_below: g * cos + a_ground * sin,
            along: g * sin - a * cos,
            elastic: damping_u * u_dot + stiffness * u,
            theta_dot,
            newest_left: N::left(theta_dot, lever * theta_dot, lever),
        }
    }

    /// Coefficient `k` of (u̇, θ̇), from that of `u`; `per` is the span over k. Of a `TIED` structure `pull` gives the coefficient
    /// before, times `per_inertia`, of the moment of the ties.
    #[inline(always)]
    pub(crate) fn next<const TIED: bool>(
        &mut self,
        Products { left, right }: &mut Products<N>,
        k: usize,
        u: N,
        per: N,
        pull: impl FnOnce(N) -> N,
    ) -> (N, N) {
        let &mut Recurrence {
            of, lever, per_inertia, sin, cos, weight, weight_below, along, elastic, newest_left, ..
        } = self;
        let Rocker { H, stiffness, damping_u, .. } = of.rocker;
        let ([g, lift], [a, slope], [a_ground, slope_ground]) = (of.gravity, of.push, of.ground);
        let before = k - 1;
        let newest_right = N::right(cos, sin, -u, self.theta_dot, weight);
        left[before] = newest_left;
        right[MAX_ORDER - before] = newest_right;
        let [sin_rate, minus_cos_rate, w_turning, w_w_turning, centrifugal, weight_moment] =
            N::products(left, right, (&newest_left, &newest_right), before);
        let y = (along - elastic - centrifugal) * per;
        let mut moment = (self.height * elastic - self.offset * weight_below)
            + (self.height * centrifugal - per_inertia * weight_moment);
        if TIED {
            moment = moment - pull(per_inertia);
        }
        let theta_dot = moment * per - (self.lever_start * w_turning + per_inertia * w_w_turning);
        let u_dot = y - H * theta_dot;

        (self.sin, self.cos) = (sin_rate * per, -minus_cos_rate * per);
        let lever_turning = lever * theta_dot + w_turning;
        self.weight = g * self.cos + a * self.sin + slope * sin;
        self.weight_below = g * self.cos + a_ground * self.sin + slope_ground * sin;
        self.along = g * self.sin - a * self.cos - slope * cos;
        if TIED {
            self.weight = self.weight + lift * cos;
            self.weight_below = self.weight_below + lift * cos;
            self.along = self.along + lift * sin;
        }
        self.elastic = damping_u * u_dot + stiffness * u;
        self.theta_dot = theta_dot;
        self.newest_left = N::left(theta_dot, lever_turning, -u);
        (u_dot, theta_dot)
    }
}

/// Series of the motion by Eqs 5 and 6.
#[derive(Clone, Debug)]
pub(crate) struct NonlinearRocking {
    one: OneMass,
    is_tied: bool,
    pub pace: Pace,
    products: RefCell<Products<f64>>,
}

impl NonlinearRocking {
    pub(crate) fn new(one: OneMass, is_tied: bool) -> NonlinearRocking {
        NonlinearRocking { one, is_tied, pace: Pace::rocking(&one), products: RefCell::new(Products::new(0.0)) }
    }
}

impl ElasticRocking for NonlinearRocking {
    fn is_singular(&self, side: Side, state: &State) -> bool {
        let structure = &self.one;
        let (foundation, B) = (structure.foundation, structure.parameters().B);
        let lever = side.sign() * B - state.u;
        foundation + lever * lever < LEAST_INERTIA * (foundation + B * B)
    }

    #[inline(always)]
    fn series(&self, side: Side, start: &Start, arc: &mut Arc) {
        if self.is_tied { self.expand::<true>(side, start, arc) } else { self.expand::<false>(side, start, arc) }
    }
}

impl NonlinearRocking {
    /// The numbers of the structure in the equations.
    #[inline(always)]
    pub(crate) fn rocker(&self, side: Side) -> Rocker<f64> {
        let structure = &self.one;
        let &crate::Parameters { H, B, .. } = structure.parameters();
        let &OneMass { stiffness, damping_u, foundation, gamma, .. } = structure;
        let (pivot, weight_offset) = (side.sign() * B, side.sign() * (gamma - 1.0) * B);
        Rocker { H, pivot, weight_offset, foundation, stiffness, damping_u }
    }

    /// The numbers in the equations over a step of `span` s from `start`. The structure is `TIED` or not throughout a step, and most
    /// are not.
    #[inline(always)]
    fn equations<const TIED: bool>(&self, side: Side, start: &Start, span: f64) -> Equations<f64> {
        let &Start { state: State { u, u_dot, theta, theta_dot }, a_g, a_top, a_v, .. } = start;
        let (g, (sin, cos)) = (self.one.parameters().g, libm::sincos(theta));
        Equations {
            rocker: self.rocker(side),
            u,
            u_dot,
            theta_dot,
            turn: [sin, cos],
            push: [a_top.value, a_top.slope * span],
            ground: [a_g.value, a_g.slope * span],
            gravity: if TIED { [g + a_v.value, a_v.slope * span] } else { [g, 0.0] },
        }
    }

    /// Writes the motion into `arc`.
    #[inline(never)] // an order is then compiled in its place, and not called
    fn expand<const TIED: bool>(&self, side: Side, start: &Start, arc: &mut Arc) {
        let structure = &self.one;
        let span = self.pace.span(start.interval);
        let restraint = || Restraint::about(structure.base(), side, start.dissipators);
        let mut ties = TIED.then(|| restraint().series(Angles::Any, start.state.theta));
        let m = structure.parameters().m;
        let products = &mut *self.products.borrow_mut();
        let mut recurrence = Recurrence::new(self.equations::<TIED>(side, start, span));
        arc.expand(&start.state, span, &self.pace.truncation(start, span), |arc, k, per| {
            let ties = |per_inertia: f64| {
                let ties = ties.as_mut().map_or(0.0, |ties| ties.next(&arc.theta_dot, k - 1, per));
                per_inertia / m * ties
            };
            let (u_dot, theta_dot) = recurrence.next::<TIED>(products, k, arc.u[k], per, ties);
            arc.u_dot[k] = u_dot;
            theta_dot
        });
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Parameters;
    use crate::levels::uplift::Liftable;

    #[test]
    fn the_mass_matrix_is_singular_with_the_top_mass_above_the_pivot_of_a_massless_foundation() {
        let structure = OneMass::new(Parameters { m0: 0.0, J0: 0.0, B: 0.25, ..Parameters::EVISON }).unwrap();
        let above_the_pivot = State { u: 0.25, theta: 0.01, ..State::default() };
        let nothing = (Load::default(), &Dissipators::NEW);
        assert_eq!(accelerations(&structure, Side::Right, &above_the_pivot, nothing.0, nothing.1), None);
    }

    /// The ground falls faster than the structure could. By Eqs 5 and 6 the side of the larger s θ̈ is not the side of the larger
    /// moment. The base lifts off about the former.
    #[test]
    fn the_structure_lifts_off_about_the_side_that_turns_faster() {
        let structure = OneMass::new(Parameters { zeta_fc: 0.1, ..Parameters::MCMANUS }).unwrap();
        let Parameters { m, H, g, .. } = *structure.parameters();
        let [by_u, by_rate] = [H * structure.k + m * (g - 60.0), H * structure.c_u];
        let load = Load { a_v: -60.0, ..Load::default() };
        for side in [Side::Right, Side::Left] {
            let s = side.sign();
            let u = s * 2e-3;
            let u_dot = -by_u * u / by_rate - s * 0.005;
            let state = State { u, u_dot, ..State::default() };
            let faster = |side: Side| {
                let theta_ddot = accelerations(&structure, side, &state, load, &Dissipators::NEW).unwrap()[1];
                side.sign() * theta_ddot
            };
            assert!(faster(side) > faster(side.opposite()) && faster(side.opposite()) > 0.0);
            assert!(s * (by_u * u + by_rate * u_dot) < 0.0);
            let liftable = Liftable::of_one(&structure, 1.0, false);
            let (distance, found) = liftable.margin(&state, [0.0, load.a_v], &0.0, &Dissipators::NEW);
            assert!(distance <= 0.0 && found == side, "{distance} {found:?}");
        }
    }
}
