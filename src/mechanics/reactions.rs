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

use crate::mechanics::instant::{Instant, Second};
use crate::mechanics::load::{LinearLoad, Load};
use crate::mechanics::outputs::{Measure, height};
use crate::numbers::Number;
use crate::numbers::dual::Dual;
use crate::{Parameters, Phase, State, Structure};
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

/// Accelerations of the top mass and of the foundation.
#[inline(always)]
fn accelerations<N: Number>(x: &Instant<N>, second: &Second<N>) -> [Acceleration<N>; 2] {
    let H = x.structure.parameters().H;
    let &Second { u_ddot, theta_ddot } = second;
    let (lever, square) = (x.lever(), x.theta_dot * x.theta_dot);
    let top = Acceleration {
        along: u_ddot + theta_ddot * H + lever * square,
        across: lever * theta_ddot - square * H - x.u_dot * x.theta_dot * 2.0,
    };
    [top, Acceleration { along: square * x.pivot(), across: theta_ddot * x.pivot() }]
}

/// R_h and R_v, N.
#[inline(always)]
pub(crate) fn forces<N: Number>(x: &Instant<N>, second: &Second<N>) -> [N; 2] {
    let &Parameters { m, m0, g, .. } = x.structure.parameters();
    let [top, base] = accelerations(x, second);
    let along = top.along * m + base.along * m0;
    let across = top.across * m + base.across * m0;
    [
        x.F_t - x.a_g * (m + m0) - along * x.turn.cos - across * x.turn.sin,
        (x.a_v + N::constant(g)) * (m + m0) + across * x.turn.cos - along * x.turn.sin,
    ]
}

/// R_m, N·m.
#[inline(always)]
pub(crate) fn moment<N: Number>(x: &Instant<N>, second: &Second<N>) -> N {
    let &Parameters { m, m0, J0, .. } = x.structure.parameters();
    let [top, base] = accelerations(x, second);
    let [right, down] = force(x, top, m);
    let [base_right, base_down] = force(x, base, m0);
    let of_top = height(x) * (right + x.F_t) + Measure::delta_t.at(x) * down;
    let of_base = x.turn.sin * x.pivot() * base_right + x.turn.versine * x.pivot() * base_down;
    of_top + of_base - second.theta_ddot * J0
}

/// The force that a mass leaves for the ground, to the right and downwards, N.
#[inline(always)]
fn force<N: Number>(x: &Instant<N>, Acceleration { along, across }: Acceleration<N>, mass: f64) -> [N; 2] {
    let weight = x.a_v + N::constant(x.structure.parameters().g);
    [
        -(x.a_g + along * x.turn.cos + across * x.turn.sin) * mass,
        (weight + across * x.turn.cos - along * x.turn.sin) * mass,
    ]
}

impl<N: Number> Reactions<N> {
    /// The reactions at the instant `x`.
    #[inline]
    pub(crate) fn at(x: &Instant<N>, second: &Second<N>) -> Reactions<N> {
        let [R_h, R_v] = forces(x, second);
        Reactions { R_h, R_v, R_m: moment(x, second) }
    }

    /// The reactions that the edges of the base carry if ties pull by `up` and `right` (N). The ties turn the base by `moment`
    /// (N·m) about its middle.
    #[inline]
    pub(crate) fn of_edges(self, up: N, right: N, moment: N) -> Reactions<N> {
        Reactions { R_h: self.R_h - right, R_v: self.R_v + up, R_m: self.R_m + moment }
    }
}

impl Reactions {
    /// The reactions in `phase` and `state`, given (ü, θ̈) under `load`.
    pub(crate) fn of(
        structure: &Structure,
        phase: Phase,
        state: &State,
        [u_ddot, theta_ddot]: [f64; 2],
        load: Load,
    ) -> Reactions {
        Reactions::at(&Instant::of(structure, phase, state, load), &Second { u_ddot, theta_ddot })
    }

    /// Time derivatives under `load`, given (ü, θ̈) and (u⃛, θ⃛); 0 once overturned.
    pub(crate) fn rates(
        structure: &Structure,
        phase: Phase,
        state: &State,
        [accelerations, jerks]: [[f64; 2]; 2],
        load: LinearLoad,
    ) -> Reactions {
        if let Phase::Overturned(_) = phase {
            return Reactions { R_h: 0.0, R_v: 0.0, R_m: 0.0 };
        }
        let x = Instant::moving(structure, phase, state, accelerations, load);
        let [u_ddot, theta_ddot] = [0, 1].map(|i| Dual { value: accelerations[i], rate: jerks[i] });
        let Reactions { R_h, R_v, R_m } = Reactions::at(&x, &Second { u_ddot, theta_ddot });
        Reactions { R_h: R_h.rate, R_v: R_v.rate, R_m: R_m.rate }
    }
}

impl Impulse {
    /// The impulse of a transition that changes the motion from `before` to `after`.
    pub(crate) fn of(structure: &Structure, before: (Phase, &State), after: (Phase, &State)) -> Impulse {
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
fn momentum(structure: &Structure, phase: Phase, state: &State) -> Impulse {
    let &Parameters { m, m0, J0, .. } = structure.parameters();
    let x = Instant::moving(structure, phase, state, [0.0; 2], LinearLoad::default());
    let top = (Measure::delta_t.at(&x), height(&x));
    let base = (x.turn.versine * x.pivot(), x.turn.sin * x.pivot());
    let about = |(right, up): (Dual<f64>, Dual<f64>)| up.value * right.rate - right.value * up.rate;
    Impulse {
        I_h: m * top.0.rate + m0 * base.0.rate,
        I_v: -(m * top.1.rate + m0 * base.1.rate),
        I_m: m * about(top) + m0 * about(base) + J0 * state.theta_dot,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Side;
    use crate::numbers::Angle;
    use approx::assert_relative_eq;

    /// The accelerations in the formulas are second derivatives of the places: δ_t and the height, differentiated twice.
    #[test]
    fn the_reactions_are_the_loads_less_the_second_derivatives_of_the_places() {
        let structure = Structure::new(Parameters::MCMANUS).unwrap();
        let &Parameters { m, m0, J0, g, .. } = structure.parameters();
        let state = State { u: 3e-3, u_dot: 0.2, theta: -0.3, theta_dot: 0.8 };
        let (u_ddot, theta_ddot, load) = (-5.0, 2.0, Load { a_g: 3.0, F_t: 250.0, a_v: -1.5 });
        let phase = Phase::Rocking(Side::Left);
        let twice =
            |value, rate, second| Dual { value: Dual { value, rate }, rate: Dual { value: rate, rate: second } };
        let theta_dot = Dual { value: state.theta_dot, rate: theta_ddot };
        let plain = Instant::of(&structure, phase, &state, load);
        let none = || Dual::constant(0.0);
        let x = Instant {
            structure: &structure,
            s: -1.0,
            strut: crate::mechanics::instant::Strut::Elastic(0.0),
            u: twice(state.u, state.u_dot, u_ddot),
            u_dot: none(),
            theta: none(),
            theta_dot: none(),
            turn: state.theta.turn().at_rate(state.theta_dot).at_rate(theta_dot),
            a_g: none(),
            F_t: none(),
            a_v: none(),
        };
        let places = [(Measure::delta_t.at(&x), height(&x)), (x.turn.versine * x.pivot(), x.turn.sin * x.pivot())];
        let (mut right, mut down, mut about) = (0.0, 0.0, -J0 * theta_ddot);
        for ((to_right, up), mass, push) in [(places[0], m, load.F_t), (places[1], m0, 0.0)] {
            let force = push - mass * (to_right.rate.rate + load.a_g);
            let weight = mass * (up.rate.rate + g + load.a_v);
            right += force;
            down += weight;
            about += up.value.value * force + to_right.value.value * weight;
        }
        let Reactions { R_h, R_v, R_m } = Reactions::at(&plain, &Second { u_ddot, theta_ddot });
        assert_relative_eq!(R_h, right, max_relative = 1e-14);
        assert_relative_eq!(R_v, down, max_relative = 1e-14);
        assert_relative_eq!(R_m, about, max_relative = 1e-14);
    }
}
