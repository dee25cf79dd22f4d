//! The reactions: forces of the structure on the ground, from its momentum balance (d'Alembert).
//!
//! The accelerations relative to the ground are α along u and β across, w = sB − u:
//!
//! ```text
//! top mass     α = ü + H θ̈ + w θ̇²,   β = w θ̈ − H θ̇² − 2 u̇ θ̇
//! foundation   α₀ = sB θ̇²,           β₀ = sB θ̈
//! ```
//!
//! With P = m α + m0 α₀ and Q = m β + m0 β₀ the reactions are
//!
//! ```text
//! R_h = F_t − (m + m0) a_g − P cos θ − Q sin θ              to the right
//! R_v = (m + m0) (g + a_v) + Q cos θ − P sin θ              downwards
//! R_m = y X − x Y + y₀ X₀ − x₀ Y₀ − J0 θ̈
//! ```
//!
//! The top mass is at (x, y) and the middle of the base at (x₀, y₀). Their forces on the ground are (X, Y) and (X₀, Y₀), to the
//! right and upwards. R_m is about the place of the middle of the base in full contact, positive as θ.
//! In full contact R_h = c_fc u̇ + k u − m0 a_g, R_v = (m + m0) g and R_m = H (c_fc u̇ + k u) + m g u. While the structure rocks, the
//! pivot is the only contact, so that R_m = sB R_v by Eqs 5 and 6. The levels with linear equations miss R_m = sB R_v by the
//! terms that they leave out.
//!
//! The edge that the model rocks about stays on the ground: R_v < 0 tells that the real edge would jump. A vertical ground
//! acceleration adds a_v to g. Restraints change none of these formulas: the reactions are all that the ground feels, from the
//! edges and from the ties, which pull upwards.
//!
//! The reactions exclude impacts. Each impact leaves an impulse on the ground, the loss of the structure's momentum:
//!
//! ```text
//! P_h = m ẋ + m0 ẋ₀,   P_v = −m ẏ − m0 ẏ₀,   P_m = m (y ẋ − x ẏ) + m0 (y₀ ẋ₀ − x₀ ẏ₀) + J0 θ̇
//! ```

use crate::mechanics::instant::{Instant, MassPoint, Second};
use crate::mechanics::lateral::{Coordinates, Lateral};
use crate::mechanics::state::Properties;
use crate::numbers::dual::Dual;
use crate::numbers::{Angle, Number, Turn};
use crate::{Base, Mode, Phase, State, Structure};
use serde::{Deserialize, Serialize};

/// Forces on the ground; from [`crate::Engine::rates`], their time derivatives in the same fields.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reactions<N = f64> {
    /// Horizontal, N, positive to the right.
    pub R_h: N,
    /// Vertical, N, positive downwards.
    pub R_v: N,
    /// Moment about the middle of the base, N·m, positive as θ.
    pub R_m: N,
}

/// Impulse of the impacts on the ground.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Impulse {
    /// Horizontal, N·s, positive to the right.
    pub I_h: f64,
    /// Vertical, N·s, positive downwards.
    pub I_v: f64,
    /// About the middle of the base, N·m·s, positive as θ.
    pub I_m: f64,
}

/// Accelerations of a mass relative to the ground, along u and across, m/s².
#[derive(Clone, Copy)]
struct Acceleration<N> {
    along: N,
    across: N,
}

impl<N: Number> Acceleration<N> {
    /// The acceleration of the place that stands for mode `j`.
    #[inline(always)]
    fn of_mode<Q: Lateral<N>>(x: &Instant<N, Q>, second: &Second<N, Q>, j: usize, mode: &Mode) -> Self {
        let theta_ddot = second.theta_ddot;
        let (lever, square) = (x.place(j, mode).lever(x.pivot()), x.theta_dot * x.theta_dot);
        Acceleration {
            along: second.u_ddot.of(j) + theta_ddot * mode.height + lever * square,
            across: lever * theta_ddot - square * mode.height - x.u_dot.of(j) * x.theta_dot * 2.0,
        }
    }

    /// The acceleration of the middle of the base.
    #[inline(always)]
    fn of_base<Q: Lateral<N>>(x: &Instant<N, Q>, second: &Second<N, Q>) -> Self {
        Acceleration { along: x.theta_dot * x.theta_dot * x.pivot(), across: second.theta_ddot * x.pivot() }
    }

    /// The force that a mass leaves for the ground, to the right and downwards, N, given the acceleration of the ground there.
    #[inline(always)]
    fn force(self, turn: &Turn<N>, [a_g, weight]: [N; 2], mass: f64) -> [N; 2] {
        let Acceleration { along, across } = self;
        [-(a_g + along * turn.cos + across * turn.sin) * mass, (weight + across * turn.cos - along * turn.sin) * mass]
    }
}

/// The acceleration of the base, a_g, and of weights, g + a_v, m/s²; on ground that gives the base adds its own, ẍ and ÿ.
#[inline(always)]
fn of_ground<N: Number, Q: Lateral<N>>(x: &Instant<N, Q>, second: &Second<N, Q>) -> [N; 2] {
    let weight = x.a_v + N::constant(x.base().g);
    let Some(ground) = Q::foundation(x.structure) else { return [x.a_g, weight] };
    let slides = second.u_ddot.slide(ground);
    [slides.map_or(x.a_g, |drive| x.a_g + drive), weight + second.u_ddot.footing(ground).y]
}

/// R_h and R_v, N.
#[inline(always)]
pub(crate) fn forces<N: Number, Q: Lateral<N>>(x: &Instant<N, Q>, second: &Second<N, Q>) -> [N; 2] {
    let &Base { m_t, m0, S_res, .. } = x.base();
    let base = Acceleration::of_base(x, second);
    let [a_g, weight] = of_ground(x, second);
    let (mut along, mut across, mut push) = (base.along * m0, base.across * m0, -(a_g * m_t));
    if S_res != 0.0 {
        along = along + second.theta_ddot * S_res;
        across = across - x.theta_dot * x.theta_dot * S_res;
    }
    for (j, mode) in Q::modes(x.structure).iter().enumerate() {
        let acceleration = Acceleration::of_mode(x, second, j, mode);
        along = along + acceleration.along * mode.gamma;
        across = across + acceleration.across * mode.gamma;
        push = push + mode.part(x.F_t.of(j));
    }
    if let Some([force, _]) = x.F_t.rest() {
        push = push + force;
    }
    [push - along * x.turn.cos - across * x.turn.sin, weight * m_t + across * x.turn.cos - along * x.turn.sin]
}

/// R_m, N·m.
#[inline(always)]
pub(crate) fn moment<N: Number, Q: Lateral<N>>(x: &Instant<N, Q>, second: &Second<N, Q>) -> N {
    let &Base { m0, S_res, J0, .. } = x.base();
    let ground = of_ground(x, second);
    let base = Acceleration::of_base(x, second);
    let [right, down] = base.force(&x.turn, ground, m0);
    let mut moment = x.turn.sin * x.pivot() * right + x.turn.versine * x.pivot() * down;
    if S_res != 0.0 {
        // the forces of the base at the height of the rest, and the forces of the rest at the base
        let [right, down] = base.force(&x.turn, ground, S_res);
        let [along, across] = [second.theta_ddot * S_res, x.theta_dot * x.theta_dot * -S_res];
        let [to_right, upwards] = [along * x.turn.cos + across * x.turn.sin, across * x.turn.cos - along * x.turn.sin];
        moment = moment + x.turn.cos * right + x.turn.sin * down;
        moment = moment - x.turn.sin * x.pivot() * to_right + x.turn.versine * x.pivot() * upwards;
    }
    for (j, mode) in Q::modes(x.structure).iter().enumerate() {
        let ground = ground.map(|part| mode.part(part));
        let [right, down] = Acceleration::of_mode(x, second, j, mode).force(&x.turn, ground, mode.mass);
        let place = x.place(j, mode);
        moment =
            moment + (place.up(x.pivot(), &x.turn) * (right + x.F_t.of(j)) + place.right(x.pivot(), &x.turn) * down);
    }
    if let Some([force, height]) = x.F_t.rest() {
        moment = moment + x.turn.sin * x.pivot() * force + x.turn.cos * height;
    }
    moment - second.theta_ddot * J0
}

impl<N: Number> Reactions<N> {
    /// The reactions at the instant `x`.
    #[inline]
    pub(crate) fn at<Q: Lateral<N>>(x: &Instant<N, Q>, second: &Second<N, Q>) -> Reactions<N> {
        let [R_h, R_v] = forces(x, second);
        Reactions { R_h, R_v, R_m: moment(x, second) }
    }
}

impl Impulse {
    /// The impulse of a transition that changes the motion from `before` to `after`.
    pub(crate) fn of<Q: Coordinates>(
        structure: &Structure,
        before: (Phase, &State<Q>),
        after: (Phase, &State<Q>),
    ) -> Impulse {
        let [before, after] = [before, after].map(|(phase, state)| momentum(structure, phase, state));
        Impulse { I_h: before.I_h - after.I_h, I_v: before.I_v - after.I_v, I_m: before.I_m - after.I_m }
    }

    /// The sum of this impulse and the `next`.
    pub(crate) fn and(self, next: Impulse) -> Impulse {
        Impulse { I_h: self.I_h + next.I_h, I_v: self.I_v + next.I_v, I_m: self.I_m + next.I_m }
    }
}

/// Momentum of the structure relative to the ground: to the right, downwards and about the middle of the base. The velocities are
/// the rates of the places.
fn momentum<Q: Coordinates>(structure: &Structure, phase: Phase, state: &State<Q>) -> Impulse {
    let &Base { m0, S_res, B, J0, .. } = structure.base();
    let Properties { pivot, is_over, .. } = phase.properties();
    let pivot = pivot * B;
    let rate = |rate: f64| if is_over { 0.0 } else { rate };
    let turn = state.theta.turn().at_rate(rate(state.theta_dot));
    let about = |right: Dual<f64>, up: Dual<f64>| up.value * right.rate - right.value * up.rate;
    let (right, up) = (turn.versine * pivot, turn.sin * pivot);
    let (mut to_right, mut upwards, mut turning) = (m0 * right.rate, m0 * up.rate, m0 * about(right, up));
    if S_res != 0.0 {
        to_right += S_res * turn.sin.rate;
        upwards += S_res * turn.cos.rate;
        turning += S_res * pivot * turn.sin.value * rate(state.theta_dot);
    }
    for (j, mode) in Q::modes(structure).iter().enumerate() {
        let u = Dual { value: state.u.of(j), rate: rate(state.u_dot.of(j)) };
        let place = MassPoint { share: mode.share, height: mode.height, u };
        let (right, up) = (place.right(pivot, &turn), place.up(pivot, &turn));
        to_right += mode.gamma * right.rate;
        upwards += mode.gamma * up.rate;
        turning += mode.mass * about(right, up);
    }
    Impulse { I_h: to_right, I_v: -upwards, I_m: turning + J0 * state.theta_dot }
}
