//! The crate differential-equations: Dormand and Prince's pair of orders 8(5, 3), with the crate's own events.

use super::{ABSOLUTE, numbers, point, rates};
use crate::equations::PhaseEquations;
use crate::guards::PhaseEnd;
use crate::hybrid::{Integrator, SmoothPart, Span};
use differential_equations::methods::ExplicitRungeKutta;
use differential_equations::prelude::*;
use differential_equations::status::Status;

/// DOP853 to a relative tolerance, with or without the crate's events.
pub struct DifferentialEquations {
    pub tolerance: f64,
    /// Whether its own events end a phase; otherwise the phase is over where a step ends beyond its end.
    pub own_events: bool,
}

struct RatesOfPhase<'a, 'b>(&'a PhaseEquations<'b>);

type Y = [f64; 4];

impl ODE<f64, Y> for RatesOfPhase<'_, '_> {
    fn diff(&self, tau: f64, y: &Y, dydt: &mut Y) {
        *dydt = rates(self.0, tau, y);
    }
}

struct PhaseGuard<'a, 'b>(&'a PhaseEnd<'b>);

impl Event<f64, Y> for PhaseGuard<'_, '_> {
    fn config(&self) -> EventConfig {
        EventConfig::new(CrossingDirection::Negative, Some(1))
    }

    fn event(&self, _: f64, y: &Y) -> f64 {
        self.0.guard(&point(y).state())
    }
}

/// Keeps every step, and ends after one that ends beyond the end of the phase.
struct StopBeyond<'a, 'b>(Option<&'a PhaseEnd<'b>>);

impl Solout<f64, Y> for StopBeyond<'_, '_> {
    fn solout<I>(
        &mut self,
        tau: f64,
        _: f64,
        y: &Y,
        _: &Y,
        _: &mut I,
        solution: &mut Solution<f64, Y>,
    ) -> ControlFlag<f64, Y>
    where
        I: Interpolation<f64, Y> + ?Sized,
    {
        solution.push(tau, *y);
        let is_over = self.0.is_some_and(|end| end.is_over(&point(y).state()));
        if is_over { ControlFlag::Terminate } else { ControlFlag::Continue }
    }
}

impl Integrator for DifferentialEquations {
    fn advance(&self, span: &Span, end: Option<&PhaseEnd>) -> Result<SmoothPart, String> {
        let &Span { equations, tau, ref from, until } = span;
        let motion = RatesOfPhase(equations);
        let problem = IVP::ode(&motion, tau, until, numbers(from));
        let method = ExplicitRungeKutta::dop853().rtol(self.tolerance).atol(ABSOLUTE * self.tolerance);
        let solution = match end {
            Some(end) if self.own_events => problem.event(&PhaseGuard(end)).method(method).solve(),
            _ => problem.solout(StopBeyond(end)).method(method).solve(),
        };
        let solution = solution.map_err(|error| format!("{error:?}"))?;
        let last = solution.t.len() - 1;
        let is_over = matches!(solution.status, Status::Interrupted);
        let before = last.saturating_sub(1);
        Ok(SmoothPart {
            start: solution.t[before],
            end: if is_over { solution.t[last] } else { until },
            from: point(&solution.y[before]),
            to: point(&solution.y[last]),
            is_over,
        })
    }
}
