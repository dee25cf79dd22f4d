//! Rocking about side s = ±1 by equations that are linear in u and θ: of one mass without ties on ground that moves horizontally.
//!
//! The level `linear` has Eqs 5 and 6 linearised about θ = u = 0:
//!
//! ```text
//! ü + H θ̈ + (c_u/m) u̇ + ω_fc² u − g θ = −a_g                                                              (7)
//! H ü + (J_P/m) θ̈ − g u − g H θ = −H a_g − s γ g B                                                        (8)
//! ```
//!
//! Solved for the accelerations, with κ = (c_u/m) u̇ + ω_fc² u and i = J_P/m − H² = (J0 + m0 B²)/m + B²:
//!
//! ```text
//! θ̈ = [H κ + g u − s γ g B]/i,      ü = −a_g + g θ − κ − H θ̈
//! ```
//!
//! The level `modal` has two uncoupled modes:
//!
//! ```text
//! q̈_r − p_l² q_r = −p_l² a_g/g − s p_l² tan α_cg                                                           (11)
//! ü + 2 ζ_u ω_u u̇ + ω_u² u = −a_g + s (χ/(1−χ)) g tan α_cg                                                 (18)
//! θ = q_r + q_u,      q_u = −(p_l²/g) u                                                                    (16)
//! ```
//!
//! A force F_t on the top mass makes a_g − F_t/m of a_g. Under loads that are linear in time the exact solution is a
//! matrix exponential, kept for the step lengths used last; series serve the steps on which a transition may happen.

use crate::levels::level::ElasticRocking;
use crate::levels::oscillator::FlowCache;
use crate::levels::start::{Pace, Start};
use crate::mechanics::arc::Arc;
use crate::{Base, OneMass, Side, State, Structure};
use nalgebra::{SMatrix, SVector};
use std::f64::consts::FRAC_PI_2;

/// The longest leap, as Ω h in rad: beyond, the exponential loses digits of its small entries.
const LONGEST_LEAP: f64 = 10.0;

/// The longest time, in 1/Ω, over which so many terms of the exponential are exact but for rounding.
const SHORT: f64 = 0.25;
const TERMS: u8 = 15;

/// Takes (u, u̇, θ, θ̇, a_g, ȧ_g, s) from the start of a step to the change of the state over it, by columns.
type RockingFlow = SMatrix<f64, 4, 7>;

/// Coefficients of u, u̇, θ, a_g − F_t/m and s in one equation.
#[derive(Clone, Copy, Debug)]
struct Coefficients {
    u: f64,
    u_dot: f64,
    theta: f64,
    a_top: f64,
    side: f64,
}

/// Both equations about side s:
///
/// ```text
/// ü = U_u u + U_u̇ u̇ + U_θ θ + U_a (a_g − F_t/m) + s U_s
/// θ̈ = T_u u + T_u̇ u̇ + T_θ θ + T_a (a_g − F_t/m) + s T_s
/// ```
#[derive(Clone, Copy, Debug)]
struct LinearSystem {
    u_ddot: Coefficients,
    theta_ddot: Coefficients,
}

/// Exact propagation by a linear system.
#[derive(Clone, Debug)]
pub(crate) struct LinearRocking {
    pace: Pace,
    system: LinearSystem,
    /// Flows, and the amplification of |θ̈| over the same time.
    flows: FlowCache<(RockingFlow, f64)>,
    /// Circular frequency Ω of u at a constant θ, rad/s.
    omega: f64,
    /// 1/Ω², s².
    compliance: f64,
    /// Bound of what θ̈ has of the speed of the vibration, rad/s² for m/s.
    turning_per_speed: f64,
    /// Factor of the moment that the displaced weight adds at uplift.
    lean: f64,
}

impl LinearRocking {
    /// Eqs 7 and 8.
    pub(crate) fn new(one: &OneMass) -> LinearRocking {
        let &crate::Parameters { H, B, g, .. } = one.parameters();
        let &OneMass { stiffness, damping_u, foundation, gamma, .. } = one;
        let inertia = foundation + B * B;
        let theta_ddot = Coefficients {
            u: (H * stiffness + g) / inertia,
            u_dot: H * damping_u / inertia,
            theta: 0.0,
            a_top: 0.0,
            side: -gamma * g * B / inertia,
        };
        let u_ddot = Coefficients {
            u: -stiffness - H * theta_ddot.u,
            u_dot: -damping_u - H * theta_ddot.u_dot,
            theta: g,
            a_top: -1.0,
            side: -H * theta_ddot.side,
        };
        LinearRocking::of(one, LinearSystem { u_ddot, theta_ddot }, 1.0)
    }

    /// Eqs 11, 16 and 18. The two modes leave χ (1−χ) of the moment g u.
    pub(crate) fn modal(one: &OneMass) -> LinearRocking {
        let &OneMass { omega_u, zeta_u, chi, one_minus_chi, .. } = one;
        let &Base { g, p_l, tan_alpha_cg, .. } = one.base();
        let (side, rocking) = (chi / one_minus_chi * g * tan_alpha_cg, p_l * p_l);
        let [u, u_dot] = [-omega_u * omega_u, -2.0 * zeta_u * omega_u];
        let u_ddot = Coefficients { u, u_dot, theta: 0.0, a_top: -1.0, side };
        let shape = rocking / g; // −q_u/u
        let theta_ddot = Coefficients {
            u: shape * (rocking - u),
            u_dot: -shape * u_dot,
            theta: rocking,
            a_top: 0.0,
            side: -rocking * tan_alpha_cg - shape * side,
        };
        LinearRocking::of(one, LinearSystem { u_ddot, theta_ddot }, chi * one_minus_chi)
    }

    fn of(one: &OneMass, system: LinearSystem, lean: f64) -> LinearRocking {
        let omega = (-system.u_ddot.u).sqrt();
        LinearRocking {
            pace: Pace::rocking(one),
            flows: FlowCache::new((RockingFlow::zeros(), 1.0)),
            omega,
            compliance: 1.0 / (omega * omega),
            turning_per_speed: system.theta_ddot.u / omega + system.theta_ddot.u_dot,
            system,
            lean,
        }
    }

    /// By how much |θ̈|, which comes back on itself through θ and through the vibration, may exceed what it would be without that over
    /// `duration` (s); infinite where no bound is known.
    fn amplification(&self, duration: f64) -> f64 {
        let LinearSystem { u_ddot, theta_ddot } = &self.system;
        let part = (self.turning_per_speed * u_ddot.theta * duration + theta_ddot.theta) / 2.0 * duration * duration;
        if part < 0.5 { 1.0 / (1.0 - part) } else { f64::INFINITY }
    }

    /// Bounds of the speed of the vibration and of |θ̈| over the interval of `start` about `side`, and the displacement that the
    /// vibration is about. The `amplification` over the interval is given. If θ acts too strongly back on u, the bounds
    /// are infinite.
    ///
    /// With f = U_θ θ − a_top + s U_s, the energy of the vibration about f/Ω² grows only by the change of f. The energy bounds the
    /// speed v, and v bounds |θ̈|. The change of f depends in turn on θ̈.
    #[inline(always)]
    fn swing(&self, side: Side, start: &Start, amplification: f64) -> LeapBounds {
        let &Start { state: State { u, u_dot, theta, theta_dot }, a_top, interval: h, .. } = start;
        let LinearSystem { u_ddot, theta_ddot } = &self.system;
        let s = side.sign();
        let following = (u_ddot.theta * theta - a_top.value + s * u_ddot.side) * self.compliance;
        let swing = self.omega * (u - following);
        let speed =
            (u_dot * u_dot + swing * swing).sqrt() + h * h * (a_top.slope.abs() + u_ddot.theta * theta_dot.abs());
        let steady = (theta_ddot.u * following + theta_ddot.theta * theta + s * theta_ddot.side).abs()
            + theta_ddot.theta * h * theta_dot.abs();
        LeapBounds { following, speed, turning: (steady + self.turning_per_speed * speed) * amplification }
    }

    /// How far θ can leave the cubic with its values and slopes at both ends of a leap from `start` that swings so: |θ⁗| h⁴/384.
    #[inline(never)] // few leaps ask
    fn off_cubic(&self, start: &Start, swing: &LeapBounds) -> f64 {
        let (Coefficients { u, u_dot, theta, .. }, (_, [u_ddot, u_dddot, theta_ddot])) =
            (&self.system.theta_ddot, self.bounds_of(start, swing));
        let fourth = u.abs() * u_ddot + u_dot.abs() * u_dddot + theta.abs() * theta_ddot;
        fourth * start.interval.powi(4) / 384.0
    }

    /// Bounds of the magnitudes of the state on a leap from `start` that swings so, and of |ü|, |u⃛| and |θ̈|.
    fn bounds_of(&self, start: &Start, swing: &LeapBounds) -> (State, [f64; 3]) {
        let &Start { state: State { theta, theta_dot, .. }, a_top, interval: h, .. } = start;
        let &LeapBounds { following, speed, turning } = swing;
        let u_ddot = &self.system.u_ddot;
        let speed = speed + u_ddot.theta * h * h * h / 2.0 * turning;
        let theta_dot = theta_dot.abs() + turning * h;
        let force_rate = a_top.slope.abs() + u_ddot.theta * theta_dot;
        let elastic = (self.omega - u_ddot.u_dot) * speed + h * force_rate;
        let jerk = self.omega * self.omega * speed - u_ddot.u_dot * elastic + force_rate;
        let (u, theta) = (following.abs() + speed / self.omega, theta.abs() + theta_dot * h);
        (State { u, u_dot: speed, theta, theta_dot }, [elastic, jerk, turning])
    }
}

/// Bounds of a leap, from [`LinearRocking::swing`].
struct LeapBounds {
    following: f64,
    /// But for what θ̈ adds.
    speed: f64,
    turning: f64,
}

impl ElasticRocking for LinearRocking {
    /// The state after the interval of `start` if rocking about `side` certainly continues until then. Two bounds can prove it: θ
    /// leaves its chord by at most |θ̈| h²/8, and its cubic by at most [`LinearRocking::off_cubic`]. The Bernstein coefficients of
    /// the cubic bound the cubic.
    #[inline(always)]
    fn leap(&self, side: Side, start: &Start) -> Option<State> {
        let &Start { state: State { u, u_dot, theta, theta_dot }, a_top, interval: h, .. } = start;
        if self.omega * h > LONGEST_LEAP {
            return None;
        }
        let system = &self.system;
        let rate = self.omega.max(-system.u_ddot.u_dot);
        let compute = || (flow(system, rate, h), self.amplification(h));
        let &(ref flow, amplification) = &*self.flows.over(h, compute);
        let s = side.sign();
        let change = flow * SVector::from([u, u_dot, theta, theta_dot, a_top.value, a_top.slope, s]);
        let end = SVector::from([u, u_dot, theta, theta_dot]) + change;
        let swing = self.swing(side, start, amplification);
        let off_chord = swing.turning * h * h / 8.0;
        let (first, last) = (s * theta, s * end[2]);
        let third = s * h / 3.0;
        let inner = (first + third * theta_dot).min(last - third * end[3]);
        let lowest = first.min(last);
        let stays_up = lowest > off_chord || lowest.min(inner) > self.off_cubic(start, &swing);
        let goes_on = stays_up && first.max(last) + off_chord < FRAC_PI_2;
        goes_on.then(|| State { u: end[0], u_dot: end[1], theta: end[2], theta_dot: end[3] })
    }

    fn most(&self, _: &Structure, side: Side, start: &Start, end: &State) -> State {
        let swing = self.swing(side, start, self.amplification(start.interval));
        let (most, [u_ddot, u_dddot, theta_ddot]) = self.bounds_of(start, &swing);
        let off_chord = start.interval * start.interval / 8.0;
        let bound = |most: f64, from: f64, to: f64, bend: f64| most.min(from.abs().max(to.abs()) + bend * off_chord);
        State {
            u: bound(most.u, start.state.u, end.u, u_ddot),
            u_dot: bound(most.u_dot, start.state.u_dot, end.u_dot, u_dddot),
            theta: bound(most.theta, start.state.theta, end.theta, theta_ddot),
            theta_dot: most.theta_dot,
        }
    }

    fn series(&self, side: Side, start: &Start, arc: &mut Arc) {
        let (&Start { state, a_top, .. }, LinearRocking { pace, system, .. }) = (start, self);
        let span = pace.span(start.interval);
        let rows = [&system.u_ddot, &system.theta_ddot];
        let load = |a_top: f64, side: f64| rows.map(|row| row.a_top * a_top + row.side * side);
        let (mut forcing, mut next_forcing) = (load(a_top.value, side.sign()), load(a_top.slope * span, 0.0));
        let mut u_dot = state.u_dot;
        arc.expand(&state, span, &pace.truncation(start, span), |arc, k, per| {
            let (u, theta) = (arc.u[k - 1], arc.theta[k - 1]);
            // what the last order of u̇ adds comes last: only that has to be waited for
            let [u_rate, theta_rate] = [0, 1].map(|i| {
                let row = rows[i];
                (row.u * u + row.theta * theta + forcing[i]) * per + row.u_dot * per * u_dot
            });
            (forcing, next_forcing) = (next_forcing, [0.0; 2]);
            (u_dot, arc.u_dot[k]) = (u_rate, u_rate);
            theta_rate
        });
    }

    fn lean(&self) -> f64 {
        self.lean
    }
}

/// The flow of `system`, which is not faster than `rate` (1/s), over `duration` (s): the exponential of the system augmented by its
/// inputs, less the identity. A leap is one such flow many times over, so that no entry may lose digits:
///
/// ```text
/// E(h) = A h (1 + A h/2 (1 + A h/3 (…))),      E(2 h) = 2 E(h) + E(h)²
/// ```
fn flow(system: &LinearSystem, rate: f64, duration: f64) -> RockingFlow {
    let mut rates = SMatrix::<f64, 7, 7>::zeros();
    rates[(0, 1)] = 1.0;
    rates[(2, 3)] = 1.0;
    rates[(4, 5)] = 1.0;
    for (equation, row) in [(1, &system.u_ddot), (3, &system.theta_ddot)] {
        rates[(equation, 0)] = row.u;
        rates[(equation, 1)] = row.u_dot;
        rates[(equation, 2)] = row.theta;
        rates[(equation, 4)] = row.a_top;
        rates[(equation, 6)] = row.side;
    }
    let doublings = (rate * duration / SHORT).log2().ceil().max(0.0) as i32;
    let step = rates * (duration / 2.0_f64.powi(doublings));
    let terms = (2..=TERMS).rev().map(f64::from);
    let sum = terms.fold(SMatrix::identity(), |sum, k| SMatrix::identity() + step * sum / k);
    let flow = (0..doublings).fold(step * sum, |flow, _| flow * 2.0 + flow * flow);
    flow.fixed_rows::<4>(0).into()
}
