//! Full contact (Eq 1): a damped oscillator on the ground.
//!
//! ```text
//! ü + 2 ζ_fc ω_fc u̇ + ω_fc² u = −a_g + F_t/m,      θ = θ̇ = 0                                    (1)
//! ```

use crate::levels::oscillator::{Flow, Kept, Oscillator, Swing};
use crate::levels::start::{Start, Truncation};
use crate::mechanics::arc::Arc;
use crate::mechanics::load::Load;
use crate::series::taylor::{LONGEST_SPAN, NEGLIGIBLE};
use crate::{OneMass, State};
use std::cell::RefMut;

/// Elastic acceleration ü (m/s²) under the `load` by Eq 1.
pub fn acceleration(structure: &OneMass, state: &State, load: Load) -> f64 {
    -(load.a_g - load.F_t / structure.parameters().m)
        - structure.damping_fc * state.u_dot
        - structure.stiffness * state.u
}

/// Writes the motion from `start` into `arc`.
pub(crate) fn series(structure: &OneMass, start: &Start, arc: &mut Arc) {
    let &Start { state, a_top, interval, local_error, .. } = start;
    let &OneMass { stiffness, damping_fc, omega_fc, .. } = structure;
    let span = interval.min(LONGEST_SPAN / omega_fc);
    let forcing = a_top.value.abs() + a_top.slope.abs() * span;
    let response_time = span.min(1.0 / omega_fc);
    let u_dot = state.u_dot.abs() + response_time * (stiffness * state.u.abs() + forcing);
    let u_dot = u_dot.max(NEGLIGIBLE * omega_fc * structure.u_cr);
    let truncation = Truncation { u_dot: local_error * u_dot, theta_dot: 0.0 };
    let (mut u_dot, mut forces) = (state.u_dot, [a_top.value, a_top.slope * span]);
    arc.expand(&state, span, &truncation, |arc, k, per| {
        let u_ddot = -forces[0] - damping_fc * u_dot - stiffness * arc.u[k - 1];
        (u_dot, forces) = (u_ddot * per, [forces[1], 0.0]);
        arc.u_dot[k] = u_dot;
        0.0
    });
}

/// Exact propagation over intervals during which the base certainly stays down.
#[derive(Clone, Debug)]
pub(crate) struct ExactContact {
    pub oscillator: Oscillator,
    flows: Kept<Flow>,
}

impl ExactContact {
    pub(crate) fn new(oscillator: Oscillator) -> ExactContact {
        ExactContact { oscillator, flows: Kept::new(Flow::NONE) }
    }

    /// The state after the interval of `start` if |u| certainly stays below `limit` (m) until then.
    #[inline]
    pub(crate) fn leap(&self, start: &Start, limit: f64) -> Option<State> {
        let &Start { state, a_top, interval, .. } = start;
        let [u, u_dot] = self.flow(interval).driven([state.u, state.u_dot], a_top.value, a_top.slope);
        let is_low = limit == f64::INFINITY || {
            let swing = self.swing(start);
            let about_chord = || self.oscillator.about_chord(&swing, [state.u, u], a_top.slope, interval);
            swing.farthest() < limit || about_chord() < limit
        };
        is_low.then_some(State { u, u_dot, theta: 0.0, theta_dot: 0.0 })
    }

    /// The flow over `duration` (s).
    #[inline(always)]
    pub(crate) fn flow(&self, duration: f64) -> RefMut<'_, Flow> {
        self.flows.over(duration, || self.oscillator.flow(duration))
    }

    #[inline(always)]
    fn swing(&self, start: &Start) -> Swing {
        let &Start { state: State { u, u_dot, .. }, a_top, interval, .. } = start;
        self.oscillator.swing([u, u_dot], a_top.value, a_top.slope, interval)
    }

    /// Bounds of |u|, |u̇|, |ü| and |u⃛| of the vibration over the interval of `start`.
    #[inline(always)]
    pub(crate) fn swings(&self, start: &Start) -> [f64; 4] {
        self.oscillator.swings(&self.swing(start))
    }
}
