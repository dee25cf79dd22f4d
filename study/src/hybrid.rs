//! From phase to phase: any integrator of smooth motion, made to obey the model's transitions.

use crate::equations::{LateralEquations, PhaseEquations};
use crate::fixed_step::{FixedStep, MovingPoint};
use crate::guards::{PhaseEnd, UpliftRule};
use crate::response::{MotionSample, Response, RunFailure};
use crate::scene::StudyScene;
use rocking::{Load, Phase, Structure};
use std::cell::Cell;
use std::f64::consts::FRAC_PI_2;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Transitions {
    Located, // at the instant at which its guard closes; the step ends there
    /// At the end of the step on which its guard closes, unless the integrator itself finds events.
    AtStepEnds,
}

/// The motion to integrate: from `from`, `tau` s into the interval, to `until` (s).
pub struct Span<'a> {
    pub equations: &'a PhaseEquations<'a>,
    pub tau: f64,
    pub from: MovingPoint,
    pub until: f64,
}

/// A part of smooth motion: times are counted from the start of the interval.
pub struct SmoothPart {
    pub start: f64, // its start, s
    pub end: f64,   // its end, s
    pub from: MovingPoint,
    pub to: MovingPoint,
    pub is_over: bool,
}

/// An integrator of the motion between transitions.
pub trait Integrator {
    /// Steps over `span`, or to where `end` says that the phase is over; yields the last step.
    fn advance(&self, span: &Span, end: Option<&PhaseEnd>) -> Result<SmoothPart, String>;

    /// The point `h` s after `from`, which is `tau` s into the interval.
    fn flow(&self, equations: &PhaseEquations, tau: f64, from: &MovingPoint, h: f64) -> Result<MovingPoint, String> {
        Ok(self.advance(&Span { equations, tau, from: *from, until: tau + h }, None)?.to)
    }
}

/// A textbook method on a grid of steps of `h` s from the start of each interval. After a transition the first step ends at
/// the next point of the grid.
pub struct Grid {
    pub method: FixedStep,
    pub h: f64, // the step, s
}

/// A remainder of a step below this part of it is no step of its own.
const SLIVER: f64 = 1e-9;

impl Integrator for Grid {
    fn advance(&self, span: &Span, end: Option<&PhaseEnd>) -> Result<SmoothPart, String> {
        let &Span { equations, tau, ref from, until } = span;
        let next = ((tau / self.h + SLIVER).floor() + 1.0) * self.h;
        let next = if next > until - SLIVER * self.h { until } else { next };
        let to = self.method.step(equations, tau, from, next - tau);
        let is_over = end.is_some_and(|end| end.is_over(&to.state()));
        Ok(SmoothPart { start: tau, end: next, from: *from, to, is_over })
    }

    /// One step, so that nothing is rounded to the grid.
    fn flow(&self, equations: &PhaseEquations, tau: f64, from: &MovingPoint, h: f64) -> Result<MovingPoint, String> {
        Ok(self.method.step(equations, tau, from, h))
    }
}

/// More transitions than these within one interval are chatter.
const MAX_TRANSITIONS_PER_INTERVAL: u64 = 1000;

/// θ on the wrong side of 0 by more than this, rad, has gone through the ground.
const THROUGH_THE_FLOOR: f64 = 1e-3;

/// The response of `scene`; each transition's instant (s) and the phase after it are shown to `observe`.
pub fn run(
    scene: &StudyScene,
    integrator: &dyn Integrator,
    transitions: Transitions,
    uplift: UpliftRule,
    observe: &mut dyn FnMut(f64, Phase),
) -> Response {
    let mut motion = SceneMotion {
        scene,
        uplift,
        phase: scene.initial.initial_phase().expect("the study's own initial states are in range"),
        point: MovingPoint::start(&scene.initial),
        transitions: 0,
        evaluations: Cell::new(0),
    };
    let (mut samples, structure) = (Vec::with_capacity(scene.intervals()), Structure::from(scene.structure));
    let mut failure = None;
    for k in 0..scene.intervals() {
        if let Err(reason) = motion.advance(k, integrator, transitions, observe) {
            failure = Some(reason);
            break;
        }
        let state = motion.point.state();
        samples.push(MotionSample::of(|output| output.at(&structure, motion.phase, &state, Load::default())));
    }
    Response { samples, evaluations: motion.evaluations.get(), transitions: motion.transitions, failure }
}

/// A structure on its way through a scene.
struct SceneMotion<'a> {
    scene: &'a StudyScene,
    uplift: UpliftRule,
    phase: Phase,
    point: MovingPoint,
    transitions: u64,
    evaluations: Cell<u64>,
}

impl SceneMotion<'_> {
    /// Over the interval `k` between samples.
    fn advance(
        &mut self,
        k: usize,
        integrator: &dyn Integrator,
        transitions: Transitions,
        observe: &mut dyn FnMut(f64, Phase),
    ) -> Result<(), RunFailure> {
        let (structure, dt) = (&self.scene.structure, self.scene.dt());
        let start = k as f64 * dt;
        let most = self.transitions + MAX_TRANSITIONS_PER_INTERVAL;
        let a_g = self.scene.ramp(k);
        let mut tau = 0.0;
        while tau < dt {
            let phase = self.phase;
            let equations = PhaseEquations { structure, phase, a_g, evaluations: &self.evaluations };
            let end = PhaseEnd { structure, uplift: self.uplift, phase };
            let gave_up = |message| RunFailure::GaveUp { time: start + tau, message };
            let span = Span { equations: &equations, tau, from: self.point, until: dt };
            let stretch = integrator.advance(&span, Some(&end)).map_err(gave_up)?;
            let is_over = stretch.is_over;
            (tau, self.point) = match transitions {
                Transitions::Located if is_over => locate(&equations, integrator, &end, &stretch).map_err(gave_up)?,
                _ => (stretch.end, stretch.to),
            };
            let time = start + tau;
            if !self.point.is_finite() {
                return Err(RunFailure::Diverged { time });
            }
            if is_over {
                self.enter_next_phases(time, observe)?;
            } else if phase != Phase::FullContact && end.guard(&self.point.state()) < -THROUGH_THE_FLOOR {
                return Err(RunFailure::ThroughTheFloor { time });
            }
            if self.transitions > most {
                return Err(RunFailure::Chatter { time });
            }
        }
        Ok(())
    }

    /// The phase that follows the present one at `time` (s), and the one after that where a landing leaves uplift due.
    fn enter_next_phases(&mut self, time: f64, observe: &mut dyn FnMut(f64, Phase)) -> Result<(), RunFailure> {
        loop {
            let end = PhaseEnd { structure: &self.scene.structure, uplift: self.uplift, phase: self.phase };
            let (phase, state) = end.next(self.point.state());
            (self.phase, self.point) = (phase, MovingPoint::start(&state));
            self.transitions += 1;
            observe(time, phase);
            match phase {
                Phase::Overturned(_) => return Err(RunFailure::Overturned { time }),
                Phase::FullContact if (PhaseEnd { phase, ..end }).is_over(&state) => (),
                _ => return Ok(()),
            }
        }
    }
}

/// Instant (s into the interval) and point at which the guard closes within `stretch`: secants within a bracket.
fn locate(
    equations: &PhaseEquations,
    integrator: &dyn Integrator,
    end: &PhaseEnd,
    stretch: &SmoothPart,
) -> Result<(f64, MovingPoint), String> {
    const CONVERGED: f64 = 1e-12; // the last move, as a part of the stretch: what is left is smaller by orders of magnitude
    const MAX_ITERATIONS: usize = 100; // halvings that reach rounding from anywhere
    let from = stretch.from.state();
    let just_begun = from.theta == 0.0;
    // If rocking has just begun, s θ is divided by the power of time of its zero at the start.
    let (open, zeros) = match equations.phase {
        Phase::Rocking(side) if side.sign() * stretch.to.state().theta >= FRAC_PI_2 => {
            return Ok((stretch.end, stretch.to));
        }
        Phase::Rocking(side) if just_begun && from.theta_dot != 0.0 => (side.sign() * from.theta_dot, 1),
        Phase::Rocking(side) if just_begun => {
            let start = equations.acceleration(stretch.start, stretch.from.position, stretch.from.velocity);
            (0.5 * side.sign() * start[1], 2)
        }
        _ => (end.guard(&from), 0),
    };
    if open <= 0.0 {
        return Ok((stretch.start, stretch.from));
    }
    let guard = |h: f64| {
        let point = integrator.flow(equations, stretch.start, &stretch.from, h)?;
        Ok::<_, String>((end.guard(&point.state()) / h.powi(zeros), point))
    };
    let length = stretch.end - stretch.start;
    let (mut low, mut high) = (0.0, length);
    let (mut last, mut last_value) = (0.0, open);
    let (mut h, (mut value, mut point)) = (length, guard(length)?);
    for _ in 0..MAX_ITERATIONS {
        if value == 0.0 {
            break;
        }
        let mut next = h - value * (h - last) / (value - last_value);
        if !(next > low && next < high) {
            next = low + 0.5 * (high - low);
        }
        (last, last_value) = (h, value);
        h = next;
        (value, point) = guard(h)?;
        if (h - last).abs() <= CONVERGED * length {
            break;
        }
        *(if value > 0.0 { &mut low } else { &mut high }) = h;
    }
    Ok((stretch.start + h, point))
}
