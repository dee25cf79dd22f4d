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
//! towards the side away from the push. An impact leaves r θ̇ about the other pivot, however squat the structure is. At other levels
//! the momentum rule ends the rocking of a squat structure, but with u = 0 that rule would depend on the shape alone.
//!
//! # Zeno
//!
//! With r < 1 the structure comes to rest by infinitely many impacts in finite time. The engine brings it to rest at the first
//! impact after which |θ̇| ≤ ε p_l tan α_cg, where ε is the error that a step may have. Later impacts amplify the error of this rest
//! like the error of a step. The kinetic energy that is left out, ½ J_P θ̇², is at most the part ε² of ½ m g H tan² α_cg, the energy
//! for overturning at small angles.

use crate::levels::first_uplift::Liftable;
use crate::levels::level::{Level, Now, Rates, Subject};
use crate::levels::rules::{ChatterLimit, MAX_RIGID_TRANSITIONS_PER_PERIOD};
use crate::levels::ties::TieSeries;
use crate::mechanics::impact::restitution;
use crate::mechanics::instant::Second;
use crate::mechanics::lateral::Coordinates;
use crate::mechanics::restraint::{Angles, Restraint};
use crate::series::taylor::{Arc, LONGEST_SPAN, Start, Truncation, ZERO, product};
use crate::structure::Base;
use crate::{Phase, Side, State, Structure};

/// P and Q at `theta`.
fn shape(structure: &Structure, side: Side, theta: f64) -> [f64; 2] {
    let (sin, cos) = libm::sincos(theta);
    let slenderness = side.sign() * structure.tan_alpha_cg;
    [sin - slenderness * cos, cos + slenderness * sin]
}

/// Phase and state just after an impact of a rigid structure that ends rocking about `side` in the state `before`, in steps of this
/// `local_error`.
pub(crate) fn after_impact<Q: Coordinates>(
    structure: &Q::Structure,
    local_error: f64,
    side: Side,
    before: &State<Q>,
) -> (Phase, State<Q>) {
    let &Base { p_l, tan_alpha_cg, .. } = Q::base(structure);
    let r = restitution(structure, side, before);
    if r * before.theta_dot.abs() <= local_error * p_l * tan_alpha_cg {
        return (Phase::FullContact, State { theta: 0.0, theta_dot: 0.0, ..*before });
    }
    (Phase::Rocking(side.opposite()), State { theta: 0.0, theta_dot: r * before.theta_dot, ..*before })
}

/// The most transitions that may happen within a period.
pub(crate) fn chatter_limit(base: &Base) -> ChatterLimit {
    ChatterLimit { period: 1.0 / base.p_l, transitions: MAX_RIGID_TRANSITIONS_PER_PERIOD }
}

/// The rigid limit as a level of detail.
#[derive(Clone, Debug)]
pub(crate) struct Rigid {
    subject: Subject,
    base: Base,
    /// The coefficients of P and Q in T about the right pivot.
    force_by_shape: [f64; 2],
}

impl Rigid {
    pub(crate) fn new(subject: Subject) -> Rigid {
        let &crate::Parameters { H, B, .. } = subject.structure.parameters();
        let (slenderness, aspect) = (subject.structure.tan_alpha_cg, B / H);
        let parts = [aspect - slenderness, 1.0 + aspect * slenderness];
        let base = Base { S_res: subject.structure.parameters().m * H, ..subject.structure.base };
        Rigid { subject, base, force_by_shape: parts.map(|part| part / (1.0 + slenderness * slenderness)) }
    }

    /// The coefficients of P and Q in T.
    fn force_by_shape(&self, side: Side) -> [f64; 2] {
        let [of_p, of_q] = self.force_by_shape;
        [side.sign() * of_p, of_q]
    }

    /// Writes the motion while rocking from `start` about `side` into `arc`.
    fn rocking<const TIED: bool>(&self, side: Side, start: &Start, arc: &mut Arc) {
        let structure = &self.subject.structure;
        let &Start { state, a_g, a_top, a_v, interval, local_error, dissipators } = start;
        let &Structure { p_l, tan_alpha_cg, J_P, .. } = structure;
        let g = structure.parameters().g;
        let tie = TIED.then(|| Restraint::about(structure, side, dissipators).moments());
        let mut ties = tie.map(|tie| TieSeries::new(tie, Angles::Any, state.theta));
        let fastest = tie.map_or(p_l, |tie| (p_l * p_l + tie.stiffness / J_P).sqrt().max(tie.damping / J_P));
        let span = interval.min(LONGEST_SPAN / fastest.max(state.theta_dot.abs()));
        let stiffness = p_l * p_l;
        let (push, push_slope) = (a_g.value / g, a_g.slope * span / g);
        let (pull, pull_slope) = ((a_g.value - a_top.value) / g, (a_g.slope - a_top.slope) * span / g);
        let [of_p, of_q] = self.force_by_shape(side);
        // θ̈ is p_l² times the sum of these times P and Q, and of the slopes times P and Q of the order before
        let (p_now, q_now) = (1.0 + pull * of_p + a_v.value / g, pull * of_q - push);
        let (p_slope, q_slope) = (pull_slope * of_p + a_v.slope * span / g, pull_slope * of_q - push_slope);
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
            if TIED && let Some(ties) = &mut ties {
                theta_ddot -= ties.next(&arc.theta_dot, k - 1, per) / J_P;
            }
            let theta_dot = theta_ddot * per;
            (p_before, q_before) = (p[k - 1], q[k - 1]);
            p[k] = product(&q, &arc.theta_dot, k - 1) * per;
            q[k] = -product(&p, &arc.theta_dot, k - 1) * per;
            (0.0, theta_dot)
        });
    }
}

impl Level for Rigid {
    #[inline(always)]
    fn subject(&self) -> &Subject {
        &self.subject
    }

    fn leap(&self, _phase: Phase, _start: &Start) -> Option<State> {
        None
    }

    fn rates(&self, _phase: Phase, _start: &Start, _end: &State) -> Rates {
        Rates::NONE
    }

    /// The series; rest on the ground in full contact.
    fn series(&self, phase: Phase, start: &Start, arc: &mut Arc) {
        match phase {
            Phase::Rocking(side) if self.subject.is_tied => self.rocking::<true>(side, start, arc),
            Phase::Rocking(side) => self.rocking::<false>(side, start, arc),
            Phase::FullContact | Phase::Overturned(_) => {
                let nothing = Truncation { u_dot: 0.0, theta_dot: 0.0 };
                arc.expand(&State::default(), start.interval, nothing, |_, _, _| (0.0, 0.0));
            }
        }
    }

    fn liftable(&self) -> Option<Liftable<'_>> {
        let &crate::Parameters { m, H, .. } = self.subject.structure.parameters();
        Some(Liftable { base: &self.base, modes: &[], rigid: Some([m, H]), lean: 1.0, has_constant_inertia: true })
    }

    fn after_impact(&self, side: Side, before: &State) -> (Phase, State) {
        after_impact(self.structure(), self.subject.local_error, side, before)
    }

    fn chatter_limit(&self) -> ChatterLimit {
        chatter_limit(&self.structure().base)
    }

    fn admissible(&self, phase: Phase, state: State) -> State {
        match phase {
            Phase::FullContact => State::default(),
            Phase::Rocking(_) | Phase::Overturned(_) => State { u: 0.0, u_dot: 0.0, ..state },
        }
    }

    /// Nothing moves relative to the ground in full contact.
    fn accelerations(&self, phase: Phase, now: &Now) -> Second<f64> {
        let &Subject { ref structure, is_tied, .. } = &self.subject;
        let (&crate::Parameters { m, g, .. }, Structure { p_l, .. }) = (structure.parameters(), structure);
        let (Phase::Rocking(side), &Now { state, load, dissipators }) = (phase, now) else {
            return [0.0; 2].into();
        };
        let [p, q] = shape(structure, side, state.theta);
        let [of_p, of_q] = self.force_by_shape(side);
        let free = p_l.powi(2) * (p - load.a_g / g * q + load.F_t / (m * g) * (of_p * p + of_q * q));
        if !is_tied {
            return [0.0, free].into();
        }
        let chord = Angles::Any.chord(state.theta, state.theta_dot);
        let held = Restraint::about(structure, side, dissipators).moment(&chord);
        [0.0, free - (held / structure.J_P - p_l.powi(2) * load.a_v / g * p)].into()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Parameters;

    /// The orders of a step follow the velocity that the loads bring within 1/p_l.
    #[test]
    fn the_order_follows_the_forcing() {
        let structure =
            Structure::new(Parameters { m0: 0.0, J0: 0.0, H: 0.02, B: 0.005, ..Parameters::EVISON }).unwrap();
        let rigid = Rigid::new(Subject { structure, local_error: 1e-9, is_tied: false, angles: Angles::Any });
        let (state, mut arc) = (State { theta: 0.01, ..State::default() }, Arc::default());
        for tenths in 10..25 {
            let interval = 0.1 * f64::from(tenths) / structure.p_l;
            let start = Start { state, interval, local_error: 1e-4, ..Start::default() };
            rigid.series(Phase::Rocking(Side::Right), &start, &mut arc);
            let most = 1e-4 * structure.p_l * (structure.tan_alpha_cg + 0.01) * (1.0 + 1e-12);
            let [last, before] = [arc.order, arc.order - 1].map(|k| arc.theta_dot[k].abs());
            assert!(arc.reach == 1.0 && last <= most && before <= most, "{tenths}: {last:e} {before:e} {most:e}");
        }
    }
}
