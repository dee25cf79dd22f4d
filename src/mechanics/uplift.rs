//! Uplift: full contact → rocking.
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
//! With modes, both conditions compare moments. The first has the moment of the springs (M3), the second
//! the moment of all that turns the base (M2). Both have the moment that holds the base down on the right side:
//!
//! ```text
//! springs = Σ h k u + R,      turning = springs + Σ [h c_u u̇ + Γ (g + a_v) u],      hold = [m_t (g + a_v) + P_0] B + s Σ F l
//! s springs ≥ hold      and      s turning > hold
//! ```
//!
//! R is the moment of mass that turns rigidly with the base, and F are the residual forces of the dissipators. The first condition is
//! s u ≥ u_cr for one mass. Each moment is a function over a number: a value gives the margin, a power series the first instant.
//!
//! The second condition always holds while |u| of one mass grows through u_cr. After a landing with |u| > u_cr it may not hold.
//! Without this condition contact would open and shut without end.
//!
//! If hold is not above 0, the second condition decides alone. If both conditions hold on both sides, the structure lifts off about
//! the side with the larger s θ̈. "> hold" means more than 1e-12 of the hold at rest, which is far above rounding.

use crate::mechanics::restraint::{Dissipators, Restraint};
use crate::numbers::Number;
use crate::{Base, Mode, OneMass, Ramp, Side, State};

/// Smallest excess of the turning moment over the hold, as a fraction of the hold at rest. It is far above rounding. After uplift
/// the base therefore moves away from the ground.
const LEAST_EXCESS: f64 = 1e-12;

/// The moment that holds the base down about `side` under the vertical acceleration `a_v`, N·m.
pub(crate) fn hold<N: Number>(base: &Base, side: Side, a_v: N, dissipators: &Dissipators) -> N {
    let residual = Restraint::about(base, side, dissipators).residual();
    a_v * (base.m_t * base.B) + N::constant(base.hold_at_rest() + side.sign() * residual)
}

/// The smaller hold of both sides over `interval` (s) of a vertical acceleration `a_v`, N·m.
pub(crate) fn least_hold(base: &Base, a_v: Ramp, interval: f64, dissipators: &Dissipators) -> f64 {
    let least = a_v.value.min(a_v.at(interval));
    hold(base, Side::Right, least, dissipators).min(hold(base, Side::Left, least, dissipators))
}

/// Inertia D = J0 + m0 B² + Σ μ w² (kg·m²) about the pivot of `side`, w = sB Γ/μ − u, given u of each mode.
pub(crate) fn inertia(base: &Base, modes: &[Mode], side: Side, u: impl Fn(usize) -> f64) -> f64 {
    let square = |(j, mode): (usize, &Mode)| {
        let lever = side.sign() * base.B * mode.share - u(j);
        mode.mass * lever * lever
    };
    base.J0 + base.m0 * base.B * base.B + modes.iter().enumerate().map(square).sum::<f64>()
}

/// The moments that lift the base of a structure in full contact, to the right, N·m.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lift<N> {
    /// Of the springs and of the mass that turns rigidly.
    springs: N,
    /// Of all that gives θ̈ at θ = θ̇ = 0, but for what holds the base down.
    turning: N,
}

impl<N: Number> Lift<N> {
    /// The moments, given (u, u̇) of each mode, the moment of the mass that turns `rigid`ly and the vertical acceleration. The moment of
    /// the displaced weights counts by the factor `lean`, which is 1 in the equations of rocking.
    #[inline(always)]
    pub(crate) fn new(
        base: &Base,
        modes: &[Mode],
        lean: f64,
        [rigid, a_v]: [N; 2],
        motion: impl Fn(usize) -> [N; 2],
    ) -> Lift<N> {
        let weight = a_v + N::constant(base.g);
        let (mut springs, mut others) = (rigid, N::constant(0.0));
        for (j, mode) in modes.iter().enumerate() {
            let [u, u_dot] = motion(j);
            springs = springs + u * (mode.height * mode.stiffness);
            others = others + weight * u * (mode.gamma * lean) + u_dot * (mode.height * (base.c_ratio * mode.damping));
        }
        Lift { springs, turning: springs + others }
    }

    /// The moments that miss of both conditions of uplift about `side` with this `hold`; not above 0 once there.
    #[inline(always)]
    pub(crate) fn missing(&self, base: &Base, side: Side, hold: N) -> [N; 2] {
        let (s, excess) = (side.sign(), N::constant(LEAST_EXCESS * base.hold_at_rest()));
        [hold - self.springs * s, hold + excess - self.turning * s]
    }
}

/// Distance of a structure in full contact from uplift, and the side of the smaller distance. The distance is the larger of what both
/// conditions miss, as a fraction of the hold at rest. Uplift is due if the distance is not positive. If uplift is due about both sides,
/// the side is the one with the larger s θ̈, by the `inertia` about each side.
pub(crate) fn margin(
    base: &Base,
    lift: &Lift<f64>,
    a_v: f64,
    dissipators: &Dissipators,
    inertia: impl Fn(Side) -> f64,
) -> (f64, Side) {
    let about = |side: Side| {
        let hold = hold(base, side, a_v, dissipators);
        let [rule, turns] = lift.missing(base, side, hold);
        (rule.min(hold).max(turns) / base.hold_at_rest(), turns / inertia(side))
    };
    let (right, left) = (about(Side::Right), about(Side::Left));
    let is_right = if right.0 <= 0.0 && left.0 <= 0.0 { right.1 <= left.1 } else { right.0 <= left.0 };
    if is_right { (right.0, Side::Right) } else { (left.0, Side::Left) }
}

/// Distance from uplift of a structure in full contact in `state`, without restraints and vertical motion: positive until uplift
/// is due. Integrators without an engine use it.
pub fn distance(one: &OneMass, state: &State) -> f64 {
    let modes = std::slice::from_ref(one.mode());
    let lift = Lift::new(one.base(), modes, 1.0, [0.0; 2], |_| [state.u, state.u_dot]);
    margin(one.base(), &lift, 0.0, &Dissipators::NEW, |_| 1.0).0
}

/// The |a_top| (m/s²) from which on the base of a rigid structure lifts off: g tan α_cg + P_0 B/S_1, where S_1 = m_t B/tan α_cg.
pub fn least_push(base: &Base) -> f64 {
    (1.0 + LEAST_EXCESS) * base.hold_at_rest() * base.tan_alpha_cg / (base.m_t * base.B)
}
