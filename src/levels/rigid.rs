//! The rigid limit u ≡ 0: Housner's block with the paper's impact rule.
//!
//! Eq 6 with u = 0, over J_P:
//!
//! ```text
//! θ̈ = p_l² [P − (a_g/g) Q],      P = sin θ − s tan α_cg cos θ,   Q = cos θ + s tan α_cg sin θ
//! ```
//!
//! P' = Q θ̇ and Q' = −P θ̇, so that its series take two products. A force F_t on the top mass adds p_l² (F_t/(m g)) T
//! to θ̈, T = cos θ + s (B/H) sin θ, a combination of P and Q. The base lifts off when |a_g − F_t/m| ≥ g tan α_cg,
//! towards the side away from the push; an impact leaves r θ̇ about the other pivot, also of a structure so squat that
//! the momentum rule of the other levels would end rocking: with u = 0 that rule speaks of the shape alone.
//!
//! # Zeno
//!
//! With r < 1 the structure comes to rest by infinitely many impacts in finite time. It is brought to rest at the first
//! impact after which |θ̇| ≤ ε p_l tan α_cg, ε the error that a step may have: what is left out, while the ground may still
//! move, is an error that later impacts amplify like a step's. The kinetic energy left behind, ½ J_P θ̇², is at most ε² of
//! ½ m g H tan² α_cg, which overturning takes at small angles.

use crate::levels::level::{Level, Now, Rates};
use crate::levels::rules::{ChatterLimit, MAX_RIGID_TRANSITIONS_PER_PERIOD};
use crate::levels::tie_series::TieSeries;
use crate::mechanics::load::Load;
use crate::mechanics::restraint::{Angles, Dissipators, Restraint};
use crate::mechanics::uplift::least_push;
use crate::series::first_crossing::{Crossing, Guard, first_time_all_closed};
use crate::series::taylor::{Arc, LONGEST_SPAN, Start, Truncation, ZERO, product};
use crate::{Phase, Side, State, Structure};

/// P and Q at `theta`.
fn shape(structure: &Structure, side: Side, theta: f64) -> [f64; 2] {
    let (sin, cos) = libm::sincos(theta);
    let slenderness = side.sign() * structure.tan_alpha_cg;
    [sin - slenderness * cos, cos + slenderness * sin]
}

/// The coefficients of P and Q in T.
fn force_by_shape(structure: &Structure, side: Side) -> [f64; 2] {
    let &crate::Parameters { H, B, .. } = structure.parameters();
    let [slenderness, aspect] = [structure.tan_alpha_cg, B / H].map(|tangent| side.sign() * tangent);
    [aspect - slenderness, 1.0 + aspect * slenderness].map(|part| part / (1.0 + slenderness * slenderness))
}

/// Writes the motion from `start` about `side` into `arc`.
fn series<const RESTRAINED: bool>(structure: &Structure, side: Side, start: &Start, arc: &mut Arc) {
    let &Start { state, a_g, a_top, a_v, interval, local_error, dissipators } = start;
    let &Structure { p_l, tan_alpha_cg, J_P, .. } = structure;
    let g = structure.parameters().g;
    let ties = Restraint::about(structure, side, dissipators).moments();
    let mut held = RESTRAINED.then(|| TieSeries::new(ties, Angles::Any, state.theta));
    let fastest = if RESTRAINED { (p_l * p_l + ties.stiffness / J_P).sqrt().max(ties.damping / J_P) } else { p_l };
    let span = interval.min(LONGEST_SPAN / fastest.max(state.theta_dot.abs()));
    let stiffness = p_l * p_l;
    let (push, push_slope) = (a_g.value / g, a_g.slope * span / g);
    let (pull, pull_slope) = ((a_g.value - a_top.value) / g, (a_g.slope - a_top.slope) * span / g);
    let [of_p, of_q] = force_by_shape(structure, side);
    // θ̈ is p_l² of these times P, Q and, for the slopes, times what P and Q were one order before
    let (mut p_now, q_now) = (1.0 + pull * of_p, pull * of_q - push);
    let (mut p_slope, q_slope) = (pull_slope * of_p, pull_slope * of_q - push_slope);
    if RESTRAINED {
        (p_now, p_slope) = (p_now + a_v.value / g, p_slope + a_v.slope * span / g);
    }
    let loads = [push, push_slope, pull, pull_slope].map(f64::abs).iter().sum::<f64>();
    let forcing = stiffness * (tan_alpha_cg + loads + state.theta.abs());
    let theta_dot = state.theta_dot.abs() + span.min(1.0 / p_l) * forcing;
    let (mut p, mut q) = (ZERO, ZERO);
    [p[0], q[0]] = shape(structure, side, state.theta);
    let (mut p_before, mut q_before) = (0.0, 0.0);
    let truncation = Truncation { u_dot: 0.0, theta_dot: local_error * theta_dot };
    arc.expand(&State { u: 0.0, u_dot: 0.0, ..state }, span, truncation, |arc, k, per| {
        let shaped = p_now * p[k - 1] + q_now * q[k - 1] + q_slope * q_before + p_slope * p_before;
        let mut theta_ddot = stiffness * shaped;
        if RESTRAINED && let Some(held) = &mut held {
            theta_ddot -= held.next(&arc.theta_dot, k - 1, per) / J_P;
        }
        let theta_dot = theta_ddot * per;
        (p_before, q_before) = (p[k - 1], q[k - 1]);
        p[k] = product(&q, &arc.theta_dot, k - 1) * per;
        q[k] = -product(&p, &arc.theta_dot, k - 1) * per;
        (0.0, theta_dot)
    });
}

/// The rigid limit as a level of detail.
#[derive(Clone, Debug)]
pub(crate) struct Rigid<const RESTRAINED: bool> {
    /// Error ε that a step may have.
    pub local_error: f64,
}

impl<const RESTRAINED: bool> Rigid<RESTRAINED> {
    /// By how much (m/s²) the push that lifts the base off about `side` is more than that of the weight alone.
    fn more_push(structure: &Structure, side: Side, a_v: f64, dissipators: &Dissipators) -> f64 {
        if !RESTRAINED {
            return 0.0;
        }
        Restraint::about(structure, side, dissipators).hold(a_v).moment / structure.parameters().H
    }
}

impl<const RESTRAINED: bool> Level for Rigid<RESTRAINED> {
    fn ties(&self) -> Option<Angles> {
        RESTRAINED.then_some(Angles::Any)
    }

    fn leap(&self, _structure: &Structure, _phase: Phase, _start: &Start) -> Option<State> {
        None
    }

    fn rates(&self, _phase: Phase, _start: &Start, _end: &State) -> Rates {
        Rates::NONE
    }

    /// Rest on the ground in full contact.
    fn series(&self, structure: &Structure, phase: Phase, start: &Start, arc: &mut Arc) {
        match phase {
            Phase::Rocking(side) => series::<RESTRAINED>(structure, side, start, arc),
            Phase::FullContact | Phase::Overturned(_) => {
                let nothing = Truncation { u_dot: 0.0, theta_dot: 0.0 };
                arc.expand(&State::default(), start.interval, nothing, |_, _, _| (0.0, 0.0));
            }
        }
    }

    /// |a_top|, a_top = a_g − F_t/m, exceeds g tan α_cg; of a restrained structure −s a_top exceeds what holds side s.
    fn first_uplift(&self, structure: &Structure, start: &Start, arc: &Arc) -> (Crossing, Side) {
        let limit = least_push(structure);
        let push = [start.a_top.value, start.a_top.slope * arc.span];
        let first = |side: Side| {
            let mut push = push;
            if RESTRAINED {
                let more = |a_v| side.sign() * Self::more_push(structure, side, a_v, start.dissipators);
                let held = more(start.a_v.value);
                push = [push[0] + held, push[1] + (more(start.a_v.at(arc.span)) - held)];
            }
            first_time_all_closed([Guard::new(&push, side.sign(), limit)], 1.0)
        };
        let (right, left) = (first(Side::Right), first(Side::Left));
        if RESTRAINED && right.sigma() == left.sigma() && right.sigma() < f64::INFINITY {
            let at = right.sigma() * arc.span;
            let load = Load { a_g: start.a_top.at(at), F_t: 0.0, a_v: start.a_v.at(at) };
            let now = Now { state: &start.state, load, dissipators: start.dissipators };
            let (_, side) = self.uplift_margin(structure, &now);
            return (right, side);
        }
        if right.sigma() <= left.sigma() { (right, Side::Right) } else { (left, Side::Left) }
    }

    /// Without u the load alone decides.
    fn least_displacement(&self, _structure: &Structure, _start: &Start) -> f64 {
        0.0
    }

    fn stays_down(&self, structure: &Structure, state: &State, dissipators: &Dissipators) -> bool {
        self.uplift_margin(structure, &Now { state, load: Load::default(), dissipators }).0 > 0.0
    }

    fn uplift_margin(&self, structure: &Structure, &Now { load, dissipators, .. }: &Now) -> (f64, Side) {
        let push = load.on_top(structure) / least_push(structure);
        let more = |side| Self::more_push(structure, side, load.a_v, dissipators) / least_push(structure);
        let (right, left) = (1.0 + push + more(Side::Right), 1.0 - push + more(Side::Left));
        if right <= left { (right, Side::Right) } else { (left, Side::Left) }
    }

    fn after_impact(&self, structure: &Structure, side: Side, before: &State) -> (Phase, State) {
        let theta_dot = structure.parameters().r * before.theta_dot;
        if theta_dot.abs() <= self.local_error * structure.p_l * structure.tan_alpha_cg {
            return (Phase::FullContact, State::default());
        }
        (Phase::Rocking(side.opposite()), State { theta_dot, ..State::default() })
    }

    fn chatter_limit(&self, structure: &Structure) -> ChatterLimit {
        ChatterLimit { period: 1.0 / structure.p_l, transitions: MAX_RIGID_TRANSITIONS_PER_PERIOD }
    }

    fn admissible(&self, phase: Phase, state: State) -> State {
        match phase {
            Phase::FullContact => State::default(),
            Phase::Rocking(_) | Phase::Overturned(_) => State { u: 0.0, u_dot: 0.0, ..state },
        }
    }

    /// Nothing moves relative to the ground in full contact.
    fn accelerations(&self, structure: &Structure, phase: Phase, now: &Now) -> [f64; 2] {
        let (&crate::Parameters { m, g, .. }, Structure { p_l, .. }) = (structure.parameters(), structure);
        let (Phase::Rocking(side), &Now { state, load, dissipators }) = (phase, now) else { return [0.0; 2] };
        let [p, q] = shape(structure, side, state.theta);
        let [of_p, of_q] = force_by_shape(structure, side);
        let free = p_l.powi(2) * (p - load.a_g / g * q + load.F_t / (m * g) * (of_p * p + of_q * q));
        if !RESTRAINED {
            return [0.0, free];
        }
        let chord = Angles::Any.chord(state.theta, state.theta_dot);
        let held = Restraint::about(structure, side, dissipators).moment(&chord);
        [0.0, free - (held / structure.J_P - p_l.powi(2) * load.a_v / g * p)]
    }
}
