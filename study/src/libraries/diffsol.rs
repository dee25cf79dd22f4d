//! The crate diffsol: BDF of variable order and ESDIRK of order 3(4), implicit methods for stiff equations,
//! with the crate's own root finding.

use super::{ABSOLUTE, numbers, point, rates};
use crate::equations::PhaseEquations;
use crate::guards::PhaseEnd;
use crate::hybrid::{Integrator, SmoothPart, Span};
use diffsol::{NalgebraLU, NalgebraMat, OdeBuilder, OdeEquationsImplicit, OdeSolverMethod, OdeSolverStopReason};

#[derive(Clone, Copy, Debug)]
pub enum DiffsolMethod {
    Bdf,      // backward differences of variable order
    Esdirk34, // an ESDIRK pair of orders 3(4)
}

/// A solver of diffsol with a relative tolerance.
pub struct Diffsol {
    pub method: DiffsolMethod,
    pub tolerance: f64,
}

type M = NalgebraMat<f64>;
type Lu = NalgebraLU<f64>;

/// The derivative of the right-hand side along `v`, from a difference quotient.
fn derivative(equations: &PhaseEquations, tau: f64, y: &[f64], v: &[f64], jv: &mut [f64]) {
    const DIFFERENCE: f64 = 1e-7;
    let length = v.iter().map(|v| v * v).sum::<f64>().sqrt();
    if length == 0.0 {
        return jv.fill(0.0);
    }
    let step = DIFFERENCE / length;
    let moved: Vec<f64> = y.iter().zip(v).map(|(y, v)| y + step * v).collect();
    let (here, there) = (rates(equations, tau, y), rates(equations, tau, &moved));
    jv.iter_mut().zip(there.iter().zip(here)).for_each(|(jv, (there, here))| *jv = (there - here) / step);
}

impl Integrator for Diffsol {
    fn advance(&self, span: &Span, end: Option<&PhaseEnd>) -> Result<SmoothPart, String> {
        let &Span { equations, tau, ref from, until } = span;
        let start = numbers(from);
        let problem = OdeBuilder::<M>::new()
            .t0(tau)
            .h0(until - tau)
            .rtol(self.tolerance)
            .atol([ABSOLUTE * self.tolerance])
            .rhs_implicit(
                |y: &[f64], _: &[f64], tau, dy: &mut [f64]| dy.copy_from_slice(&rates(equations, tau, y)),
                |y: &[f64], _: &[f64], tau, v: &[f64], jv: &mut [f64]| derivative(equations, tau, y, v, jv),
            )
            .init(|_: &[f64], _, y: &mut [f64]| y.copy_from_slice(&start), 4)
            .root(
                |y: &[f64], _: &[f64], _, g: &mut [f64]| g[0] = end.map_or(1.0, |end| end.guard(&point(y).state())),
                1,
            )
            .build()
            .map_err(|error| error.to_string())?;
        let stretch = match self.method {
            DiffsolMethod::Bdf => steps(&mut problem.bdf::<Lu>().map_err(|error| error.to_string())?, until),
            DiffsolMethod::Esdirk34 => steps(&mut problem.esdirk34::<Lu>().map_err(|error| error.to_string())?, until),
        };
        stretch.map_err(|error| error.to_string())
    }
}

/// Steps to `until` or to the end of the phase.
fn steps<'a, E>(
    solver: &mut impl OdeSolverMethod<'a, E>,
    until: f64,
) -> Result<SmoothPart, diffsol::error::DiffsolError>
where
    E: OdeEquationsImplicit<T = f64, V = diffsol::NalgebraVec<f64>> + 'a,
{
    solver.set_stop_time(until)?;
    loop {
        let (start, from) = (solver.state().t, point(solver.state().y.batch_as_slice(0)));
        let reason = solver.step()?;
        let to = point(solver.state().y.batch_as_slice(0));
        let stretch = |end, to, is_over| SmoothPart { start, end, from, to, is_over };
        match reason {
            OdeSolverStopReason::RootFound(root, _) => {
                let there = solver.interpolate(root)?;
                return Ok(stretch(root, point(there.batch_as_slice(0)), true));
            }
            OdeSolverStopReason::TstopReached => return Ok(stretch(until, to, false)),
            _ => (),
        }
    }
}
