//! The crate ode_solvers: Dormand and Prince's pairs of orders 5(4) and 8(5, 3). It finds no events: its stop function
//! ends a run after the step on which a guard closes, and the instant is found by integrating afresh from the start of
//! that step.
//!
//! Its version 0.6.2 evaluates the last stage of DOP853 at the time of the first, which is wrong under moving ground.
//! Time is therefore a fifth state, so small that it has no weight in the error control.

use super::{ABSOLUTE, numbers, point, rates};
use crate::equations::PhaseEquations;
use crate::guards::PhaseEnd;
use crate::hybrid::{Integrator, SmoothPart, Span};
use ode_solvers::dop_shared::OutputType;
use ode_solvers::{Dop853, Dopri5, SVector, System};

#[derive(Clone, Copy, Debug)]
pub enum Pair {
    Dopri5, // orders 5(4)
    Dop853, // orders 8(5, 3)
}

/// A solver of ode_solvers with a relative tolerance.
pub struct OdeSolvers {
    pub pair: Pair,
    pub tolerance: f64,
}

/// u, θ, u̇, θ̇ and the time from the start of the run times `clock`.
type Extended = SVector<f64, 5>;

struct ScaledRates<'a, 'b> {
    equations: &'a PhaseEquations<'b>,
    end: Option<&'a PhaseEnd<'b>>,
    start: f64,
    clock: f64,
}

impl System<f64, Extended> for ScaledRates<'_, '_> {
    fn system(&self, _: f64, y: &Extended, dy: &mut Extended) {
        let [a, b, c, d] = rates(self.equations, self.start + y[4] / self.clock, y.as_slice());
        *dy = Extended::from([a, b, c, d, self.clock]);
    }

    fn solout(&mut self, _: f64, y: &Extended, _: &Extended) -> bool {
        self.end.is_some_and(|end| end.is_over(&point(y.as_slice()).state()))
    }
}

impl Integrator for OdeSolvers {
    fn advance(&self, span: &Span, end: Option<&PhaseEnd>) -> Result<SmoothPart, String> {
        let &Span { equations, tau, ref from, until } = span;
        let (relative, absolute) = (self.tolerance, ABSOLUTE * self.tolerance);
        let motion = ScaledRates { equations, end, start: tau, clock: absolute * ABSOLUTE };
        let [a, b, c, d] = numbers(from);
        let y = Extended::from([a, b, c, d, 0.0]);
        macro_rules! last_step {
            ($solver:ident) => {{
                let mut solver = $solver::new(motion, tau, until, 0.0, y, relative, absolute);
                solver.set_output(OutputType::Sparse); // every step, no interpolation
                solver.integrate().map_err(|error| error.to_string())?;
                let (times, states) = solver.results().get();
                [times.len() - 2, times.len() - 1].map(|k| (times[k], point(states[k].as_slice())))
            }};
        }
        let [(start, from), (last, to)] = match self.pair {
            Pair::Dopri5 => last_step!(Dopri5),
            Pair::Dop853 => last_step!(Dop853),
        };
        let is_over = end.is_some_and(|end| end.is_over(&to.state()));
        Ok(SmoothPart { start, end: if is_over { last } else { until }, from, to, is_over })
    }
}
