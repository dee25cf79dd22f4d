//! The crate ode_solvers: Dormand and Prince's pairs of orders 5(4) and 8(5, 3). It finds no events: its stop function
//! ends a run after the step on which a guard closes, and the instant is found by integrating afresh from the start of
//! that step.
//!
//! Its version 0.6.2 evaluates the last stage of DOP853 at the time of the first, which is wrong under moving ground:
//! time is therefore carried as a fifth state, so small that it weighs nothing in the error control.

use super::ABSOLUTE;
use crate::equations::{Equations, PhaseEquations, state};
use crate::fixed_step::Point;
use crate::guards::PhaseEnd;
use crate::hybrid::{Integrator, Span, Stretch};
use nalgebra::Vector2;
use ode_solvers::dop_shared::OutputType;
use ode_solvers::{Dop853, Dopri5, SVector, System};
use rocking::State;

/// Which pair.
#[derive(Clone, Copy, Debug)]
pub enum Pair {
    Dopri5, // orders 5(4)
    Dop853, // orders 8(5, 3)
}

/// One of the two, to a relative tolerance.
pub struct OdeSolvers {
    pub pair: Pair,
    pub tolerance: f64,
}

/// u, θ, u̇, θ̇ and the time from the start of the run times `clock`.
type Y = SVector<f64, 5>;

/// A time, s, and a state.
type Node = (f64, State);

struct Motion<'a, 'b> {
    equations: &'a PhaseEquations<'b>,
    end: Option<&'a PhaseEnd<'b>>,
    start: f64,
    clock: f64,
}

fn from_vector(y: &Y) -> State {
    state(Vector2::new(y[0], y[1]), Vector2::new(y[2], y[3]))
}

impl System<f64, Y> for Motion<'_, '_> {
    fn system(&self, _: f64, y: &Y, dy: &mut Y) {
        let velocity = Vector2::new(y[2], y[3]);
        let tau = self.start + y[4] / self.clock;
        let acceleration = self.equations.acceleration(tau, Vector2::new(y[0], y[1]), velocity);
        *dy = Y::from([velocity[0], velocity[1], acceleration[0], acceleration[1], self.clock]);
    }

    fn solout(&mut self, _: f64, y: &Y, _: &Y) -> bool {
        self.end.is_some_and(|end| end.is_over(&from_vector(y)))
    }
}

impl OdeSolvers {
    /// Start and end of the last step from `from` to `until` or to the end of the phase.
    fn last_step(&self, span: &Span, end: Option<&PhaseEnd>) -> Result<(Node, Node), String> {
        let &Span { equations, tau, ref from, until } = span;
        let (relative, absolute) = (self.tolerance, ABSOLUTE * self.tolerance);
        let motion = Motion { equations, end, start: tau, clock: absolute * ABSOLUTE };
        let y = Y::from([from.position[0], from.position[1], from.velocity[0], from.velocity[1], 0.0]);
        macro_rules! last_step {
            ($solver:ident) => {{
                let mut solver = $solver::new(motion, tau, until, 0.0, y, relative, absolute);
                solver.set_output(OutputType::Sparse); // every step, no interpolation
                solver.integrate().map_err(|error| error.to_string())?;
                let (times, states) = solver.results().get();
                let node = |k: usize| (times[k], from_vector(&states[k]));
                Ok((node(times.len() - 2), node(times.len() - 1)))
            }};
        }
        match self.pair {
            Pair::Dopri5 => last_step!(Dopri5),
            Pair::Dop853 => last_step!(Dop853),
        }
    }
}

impl Integrator for OdeSolvers {
    fn advance(&self, span: &Span, end: Option<&PhaseEnd>) -> Result<Stretch, String> {
        let (before, last) = self.last_step(span, end)?;
        let is_over = end.is_some_and(|end| end.is_over(&last.1));
        Ok(Stretch {
            start: before.0,
            end: if is_over { last.0 } else { span.until },
            from: Point::start(&before.1),
            to: Point::start(&last.1),
            is_over,
        })
    }
}
