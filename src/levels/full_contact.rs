//! Full contact (Eq 1): a damped oscillator on the ground.
//!
//! ```text
//! ü + 2 ζ_fc ω_fc u̇ + ω_fc² u = −a_g + F_t/m,      θ = θ̇ = 0                                    (1)
//! ```

use crate::levels::oscillator::{Flow, FlowCache, Oscillator};
use crate::levels::start::{Pace, Start};
use crate::mechanics::arc::Arc;
use crate::mechanics::lateral::Coordinates;
use crate::mechanics::load::Load;
use crate::{OneMass, State, Structure};
use std::cell::RefMut;

/// Elastic acceleration ü (m/s²) under the `load` by Eq 1.
pub fn acceleration(structure: &OneMass, state: &State, load: Load) -> f64 {
    -(load.a_g - load.F_t / structure.parameters().m)
        - structure.damping_fc * state.u_dot
        - structure.stiffness * state.u
}

/// Writes the motion from `start` into `arc`.
pub(crate) fn series(structure: &OneMass, start: &Start, arc: &mut Arc) {
    let (&Start { state, a_top, interval, .. }, pace) = (start, Pace::down(structure));
    let &OneMass { stiffness, damping_fc, .. } = structure;
    let span = pace.span(interval);
    let (mut u_dot, mut forces) = (state.u_dot, [a_top.value, a_top.slope * span]);
    arc.expand(&state, span, &pace.truncation(start, span), |arc, k, per| {
        let u_ddot = -forces[0] - damping_fc * u_dot - stiffness * arc.u[k - 1];
        (u_dot, forces) = (u_ddot * per, [forces[1], 0.0]);
        arc.u_dot[k] = u_dot;
        0.0
    });
}

/// A mode with its exact flow, while the base stays down.
#[derive(Clone, Debug)]
pub(crate) struct ExactContact {
    pub oscillator: Oscillator,
    flows: FlowCache<Flow>,
}

impl ExactContact {
    pub(crate) fn new(oscillator: Oscillator) -> ExactContact {
        ExactContact { oscillator, flows: FlowCache::new(Flow::default()) }
    }

    /// The flow over `duration` (s).
    #[inline(always)]
    pub(crate) fn flow(&self, duration: f64) -> RefMut<'_, Flow> {
        self.flows.over(duration, || self.oscillator.flow(duration))
    }
}

/// The state after the interval of `start` by the exact flows of these `modes`, if the moment of their springs certainly stays below
/// `hold` until then. A mode has this `moment` for a unit of its coordinate.
#[inline(always)]
pub(crate) fn leap<Q: Coordinates>(
    modes: &[ExactContact],
    start: &Start<Q>,
    hold: f64,
    moment: impl Fn(usize) -> f64,
) -> Option<State<Q>> {
    let &Start { ref state, ref a_top, interval, .. } = start;
    let mut end = State { theta: 0.0, theta_dot: 0.0, ..*state };
    let (mut farthest, mut bend, mut springs) = (0.0, 0.0, [0.0; 2]);
    for (j, exact) in modes.iter().enumerate() {
        let (from, value, slope) = ([state.u.of(j), state.u_dot.of(j)], a_top.value.of(j), a_top.slope.of(j));
        let (moment, to) = (moment(j), exact.flow(interval).driven(from, value, slope));
        let swing = exact.oscillator.swing(from, value, slope, interval);
        farthest += moment.abs() * swing.farthest();
        bend += moment.abs() * exact.oscillator.swings(&swing)[2];
        springs = [springs[0] + moment * from[0], springs[1] + moment * to[0]];
        end.u.set(j, to[0]);
        end.u_dot.set(j, to[1]);
    }
    let near = springs[0].abs().max(springs[1].abs()) + bend * interval * interval / 8.0;
    (farthest < hold || near < hold).then_some(end)
}

/// Bounds of |u|, |u̇|, |ü| and |u⃛| of the vibration of these `modes` over the interval of `start`.
#[inline(always)]
pub(crate) fn swings<Q: Coordinates>(structure: &Structure, modes: &[ExactContact], start: &Start<Q>) -> [Q; 4] {
    let &Start { ref state, ref a_top, interval, .. } = start;
    let mut bounds = [Q::parts(structure, 0.0); 4];
    for (j, ExactContact { oscillator, .. }) in modes.iter().enumerate() {
        let from = [state.u.of(j), state.u_dot.of(j)];
        let swing = oscillator.swing(from, a_top.value.of(j), a_top.slope.of(j), interval);
        bounds.iter_mut().zip(oscillator.swings(&swing)).for_each(|(of, most)| of.set(j, most));
    }
    bounds
}
