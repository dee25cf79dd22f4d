//! All that a formula reads: the structure at one instant, in numbers of any kind.

use crate::mechanics::lateral::{Coordinates, Duals, Lateral};
use crate::mechanics::load::{LinearLoad, Load};
use crate::numbers::dual::Dual;
use crate::numbers::{Angle, Number, Turn};
use crate::structure::ground::{Footing, NONE_SETTLED, Settlements};
use crate::{Base, Foundation, Mode, Phase, PressedPoints, State, Structure};

/// The structure at an instant, with lateral coordinates `Q`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Instant<'a, N: Number, Q: Lateral<N> = N> {
    pub structure: &'a Structure,
    /// s: +1 about the right pivot, −1 about the left one; 0 on ground that gives. It shares a word with the contact, since instants are copied.
    pub s: f32,
    /// The pressed contact points of the ground.
    pub contact: PressedPoints,
    /// The settlements of the contact points for good, which forces of points read.
    pub settled: &'a Settlements,
    /// Viscous damping as a fraction of the damping in full contact.
    pub damping: f64,
    /// u, m.
    pub u: Q,
    /// u̇, m/s.
    pub u_dot: Q,
    /// θ, rad.
    pub theta: N,
    /// θ̇, rad/s.
    pub theta_dot: N,
    /// θ̈, rad/s², which gauges of mass that no mode carries read; otherwise any number.
    pub theta_ddot: N,
    pub turn: Turn<N>,
    /// Ground acceleration, m/s².
    pub a_g: N,
    /// Force on the top mass, N.
    pub F_t: Q,
    /// Vertical ground acceleration, m/s².
    pub a_v: N,
}

/// The accelerations, which the formulas of the reactions read besides.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Second<N, Q = N> {
    /// ü, m/s².
    pub u_ddot: Q,
    /// θ̈, rad/s².
    pub theta_ddot: N,
}

/// A place on the structure: a mass, or what stands for it in a sum over the modes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MassPoint<N> {
    /// Part that the place takes in a translation of the base; 1 of a mass.
    pub share: f64,
    /// Height above the base, m.
    pub height: f64,
    /// Elastic displacement, m.
    pub u: N,
}

impl Base {
    /// The damping in `phase` as a fraction of the damping in full contact.
    #[inline]
    pub(crate) fn damping(&self, phase: Phase) -> f64 {
        if phase.properties().rotates { self.c_ratio } else { 1.0 }
    }
}

impl<'a, Q: Coordinates> Instant<'a, f64, Q> {
    /// The structure in `phase` and `state` under `load`; θ̈ is left at 0, and points have not settled.
    #[inline]
    pub(crate) fn of(structure: &'a Structure, phase: Phase, state: &State<Q>, load: Load<Q>) -> Self {
        let &State { u, u_dot, theta, theta_dot } = state;
        let Load { a_g, F_t, a_v } = load;
        let (s, damping, turn) = (phase.properties().pivot as f32, structure.base().damping(phase), theta.turn());
        let contact = if Q::IS_ONE { PressedPoints::default() } else { phase.contact() };
        let (settled, theta_ddot) = (&NONE_SETTLED, 0.0);
        Instant { structure, s, contact, settled, damping, u, u_dot, theta, theta_dot, theta_ddot, turn, a_g, F_t, a_v }
    }
}

impl<'a, Q: Coordinates> Instant<'a, Dual<f64>, Duals<Q>> {
    /// The structure with its rates, given (ü, θ̈), and without the rate of θ̈; once it has overturned, all rates are 0.
    #[inline]
    pub(crate) fn moving(
        structure: &'a Structure,
        phase: Phase,
        state: &State<Q>,
        &Second { u_ddot, theta_ddot }: &Second<f64, Q>,
        load: LinearLoad<Q>,
    ) -> Self {
        let Instant { s, settled, u, u_dot, theta, theta_dot, turn, .. } =
            Instant::<f64, Q>::of(structure, phase, state, load.value);
        let moves = if phase.properties().is_over { 0.0 } else { 1.0 };
        let dual = |value, rate: f64| Dual { value, rate: moves * rate };
        let lateral = |value: Q, rate: Q| Duals { value, rate: rate.times(moves) };
        let LinearLoad { value, slope } = load;
        Instant {
            structure,
            s,
            contact: phase.contact(),
            settled,
            damping: structure.base().damping(phase),
            u: lateral(u, u_dot),
            u_dot: lateral(u_dot, u_ddot),
            theta: dual(theta, theta_dot),
            theta_dot: dual(theta_dot, theta_ddot),
            theta_ddot: Dual { value: theta_ddot, rate: 0.0 },
            turn: turn.at_rate(moves * theta_dot),
            a_g: dual(value.a_g, slope.a_g),
            F_t: lateral(value.F_t, slope.F_t),
            a_v: dual(value.a_v, slope.a_v),
        }
    }
}

impl<N: Number, Q: Lateral<N>> Instant<'_, N, Q> {
    /// The base.
    #[inline(always)]
    pub(crate) fn base(&self) -> &Base {
        self.structure.base()
    }

    /// Place of the pivot, sB, m.
    #[inline(always)]
    pub(crate) fn pivot(&self) -> f64 {
        f64::from(self.s) * self.base().B
    }

    /// The same with the accelerations `second`, of the base on ground that gives too.
    #[inline(always)]
    pub(crate) fn accelerated(self, second: &Second<N, Q>) -> Self {
        let x = Instant { theta_ddot: second.theta_ddot, ..self };
        let Some(ground) = Q::foundation(x.structure) else { return x };
        let slides = second.u_ddot.slide(ground);
        Instant { a_g: slides.map_or(x.a_g, |drive| x.a_g + drive), a_v: x.a_v + second.u_ddot.footing(ground).y, ..x }
    }

    /// The coordinates of the base on this `ground`, and their rates.
    #[inline(always)]
    pub(crate) fn footing(&self, ground: &Foundation) -> [Footing<N>; 2] {
        [self.u.footing(ground), self.u_dot.footing(ground)]
    }

    /// The place that stands for mode `j`.
    #[inline(always)]
    pub(crate) fn place(&self, j: usize, mode: &Mode) -> MassPoint<N> {
        MassPoint { share: mode.share, height: mode.height, u: self.u.of(j) }
    }
}

impl<N: Number> MassPoint<N> {
    /// w = sB − u, m: distance from the plane of the pivot, which is at sB.
    #[inline(always)]
    pub(crate) fn lever(&self, pivot: f64) -> N {
        N::constant(pivot * self.share) - self.u
    }

    /// Height above the ground, (sB − u) sin θ + h cos θ, m.
    #[inline(always)]
    pub(crate) fn up(&self, pivot: f64, turn: &Turn<N>) -> N {
        self.lever(pivot) * turn.sin + turn.cos * self.height
    }

    /// Displacement to the right, sB (1 − cos θ) + u cos θ + h sin θ, m (Eq 26).
    #[inline(always)]
    pub(crate) fn right(&self, pivot: f64, turn: &Turn<N>) -> N {
        turn.versine * (pivot * self.share) + self.u * turn.cos + turn.sin * self.height
    }

    /// Velocity to the right, u̇ cos θ + [(sB − u) sin θ + h cos θ] θ̇, m/s.
    #[inline(always)]
    pub(crate) fn rate_of_right(&self, pivot: f64, turn: &Turn<N>, [u_dot, theta_dot]: [N; 2]) -> N {
        u_dot * turn.cos + self.up(pivot, turn) * theta_dot
    }
}

/// Uplift of the free edge of the base 2 B sin|θ|, m (Eq 25).
#[inline(always)]
pub(crate) fn uplift<N: Number>(pivot: f64, turn: &Turn<N>) -> N {
    turn.sin * (2.0 * pivot)
}
