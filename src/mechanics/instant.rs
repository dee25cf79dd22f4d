//! All that a formula reads: the structure at one instant, in numbers of any kind.

use crate::mechanics::load::{LinearLoad, Load};
use crate::numbers::dual::Dual;
use crate::numbers::{Angle, Number, Turn};
use crate::{Phase, State, Structure};

/// The structure at an instant. A structure of many masses has one instant for each floor. There `u` and `u_dot` are the
/// displacement and velocity of the floor, sums over the modes, so that no number grows with the number of modes.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Instant<'a, N> {
    pub structure: &'a Structure,
    /// s: +1 about the right pivot, −1 about the left one.
    pub s: f64,
    pub strut: Strut<N>,
    /// u, m.
    pub u: N,
    /// u̇, m/s.
    pub u_dot: N,
    /// θ, rad.
    pub theta: N,
    /// θ̇, rad/s.
    pub theta_dot: N,
    pub turn: Turn<N>,
    /// Ground acceleration, m/s².
    pub a_g: N,
    /// Force on the top mass, N.
    pub F_t: N,
    /// Vertical ground acceleration, m/s².
    pub a_v: N,
}

/// The part that carries the top mass.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Strut<N> {
    /// An elastic strut with this viscous damping, N·s/m.
    Elastic(f64),
    /// The rigid limit with θ̈ in rad/s²: there u is 0 and says nothing of the forces.
    Rigid(N),
}

/// The accelerations, which the formulas of the reactions read besides.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Second<N> {
    /// ü, m/s².
    pub u_ddot: N,
    /// θ̈, rad/s².
    pub theta_ddot: N,
}

/// The damping in force, N·s/m: c_fc in full contact, c_u otherwise.
#[inline]
pub(crate) fn damping(structure: &Structure, phase: Phase) -> f64 {
    match phase {
        Phase::FullContact => structure.c_fc,
        Phase::Rocking(_) | Phase::Overturned(_) => structure.c_u,
    }
}

impl<'a> Instant<'a, f64> {
    /// The structure in `phase` and `state` under `load`, with an elastic strut.
    #[inline]
    pub(crate) fn of(structure: &'a Structure, phase: Phase, state: &State, load: Load) -> Self {
        let &State { u, u_dot, theta, theta_dot } = state;
        let Load { a_g, F_t, a_v } = load;
        let (s, strut) = (phase.side().sign(), Strut::Elastic(damping(structure, phase)));
        Instant { structure, s, strut, u, u_dot, theta, theta_dot, turn: theta.turn(), a_g, F_t, a_v }
    }
}

impl<'a> Instant<'a, Dual<f64>> {
    /// The structure with its rates, given (ü, θ̈); once it has overturned, all rates are 0.
    #[inline]
    pub(crate) fn moving(
        structure: &'a Structure,
        phase: Phase,
        state: &State,
        [u_ddot, theta_ddot]: [f64; 2],
        load: LinearLoad,
    ) -> Self {
        let Instant { s, u, u_dot, theta, theta_dot, turn, .. } = Instant::of(structure, phase, state, load.value);
        let moves = if let Phase::Overturned(_) = phase { 0.0 } else { 1.0 };
        let dual = |value, rate: f64| Dual { value, rate: moves * rate };
        let LinearLoad { value, slope } = load;
        Instant {
            structure,
            s,
            strut: Strut::Elastic(damping(structure, phase)),
            u: dual(u, u_dot),
            u_dot: dual(u_dot, u_ddot),
            theta: dual(theta, theta_dot),
            theta_dot: dual(theta_dot, theta_ddot),
            turn: turn.at_rate(moves * theta_dot),
            a_g: dual(value.a_g, slope.a_g),
            F_t: dual(value.F_t, slope.F_t),
            a_v: dual(value.a_v, slope.a_v),
        }
    }
}

impl<N: Number> Instant<'_, N> {
    /// w = sB − u, m: the top mass is so far from the plane of the pivot.
    #[inline(always)]
    pub(crate) fn lever(&self) -> N {
        N::constant(self.pivot()) - self.u
    }

    /// Place of the pivot, sB, m.
    #[inline]
    pub(crate) fn pivot(&self) -> f64 {
        self.s * self.structure.parameters().B
    }
}
