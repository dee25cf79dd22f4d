//! A piece: what the engine has just proved about a stretch of time, shown once to whoever watches.
//!
//! Within a piece there is no transition. Where the engine expanded the motion into a polynomial, that is what a watcher
//! sees; where it leapt by an exact flow, there are bounds, and polynomials only for a watcher that asks for them.

use crate::engine::motion::Motion;
use crate::engine::transition::Transition;
use crate::levels::level::{Level, Rates};
use crate::levels::output_series::{self, Turn};
use crate::mechanics::load::{LinearLoad, Load};
use crate::mechanics::outputs::{self, Measure};
use crate::series::extremes;
use crate::series::extremes::Bound;
use crate::series::taylor::{Arc, Series, Start, evaluate};
use crate::{Outputs, Phase, Reactions, State, Structure};
use std::f64::consts::TAU;

/// Watches a motion go by.
pub trait Watch {
    /// Whether it looks at pieces. If not, none is made for it.
    const SEES_PIECES: bool;

    /// The next piece of it.
    #[inline]
    fn piece(&mut self, _piece: &mut Piece) {}

    /// The transition at the end of the piece shown last.
    #[inline]
    fn transition(&mut self, _transition: &Transition) {}

    /// All that was asked for has been shown: what has been put off is done now.
    #[inline]
    fn done(&mut self, _equations: &mut Equations) {}
}

/// What moves the structure of pieces that have been kept.
#[derive(Debug)]
pub struct Equations<'a> {
    pub(crate) structure: &'a Structure,
    pub(crate) level: &'a mut dyn Level,
}

/// A watch that sees nothing.
impl Watch for () {
    const SEES_PIECES: bool = false;
}

/// A watch of transitions alone.
impl<F: FnMut(&Transition)> Watch for F {
    const SEES_PIECES: bool = false;

    fn transition(&mut self, transition: &Transition) {
        self(transition);
    }
}

/// Two watches at once.
impl<A: Watch, B: Watch> Watch for (&mut A, &mut B) {
    const SEES_PIECES: bool = A::SEES_PIECES || B::SEES_PIECES;

    #[inline]
    fn piece(&mut self, piece: &mut Piece) {
        if A::SEES_PIECES {
            self.0.piece(piece);
        }
        if B::SEES_PIECES {
            piece.rewind();
            self.1.piece(piece);
        }
    }

    fn transition(&mut self, transition: &Transition) {
        self.0.transition(transition);
        self.1.transition(transition);
    }

    fn done(&mut self, equations: &mut Equations) {
        self.0.done(equations);
        self.1.done(equations);
    }
}

/// A motion at one instant; at a transition, just after it.
#[derive(Clone, Copy, Debug)]
pub struct Sample<'a> {
    /// Time, state and phase, transitions and impulses so far.
    pub motion: Motion,
    /// What acts.
    pub load: Load,
    pub(crate) structure: &'a Structure,
    pub(crate) level: &'a dyn Level,
}

impl Sample<'_> {
    /// The outputs; once overturned, those of the instant before.
    pub fn outputs(&self) -> Outputs {
        self.level.outputs(self.structure, self.motion.phase.in_motion(), &self.motion.state, self.load)
    }

    /// The reactions; once overturned, those of the instant before.
    pub fn reactions(&self) -> Reactions {
        let phase = self.motion.phase.in_motion();
        Reactions::of(self.structure, phase, &self.motion.state, self.accelerations(), self.load)
    }

    /// (ü, θ̈), m/s² and rad/s²; once overturned, those of the instant before.
    pub(crate) fn accelerations(&self) -> [f64; 2] {
        self.level.accelerations(self.structure, self.motion.phase.in_motion(), &self.motion.state, self.load)
    }
}

/// A series of an output that is off by less than this part of its terms at its end has converged.
const CONVERGED: f64 = 1e-12;

/// How often an arc is halved before its outputs' series are taken as they are.
const FINEST_PART: u32 = 5;

/// A stretch of time without a transition.
///
/// It is gone through by parts, the first of which is all of it: [`Piece::arc`] is about the part in hand, and
/// [`Piece::skip`] leaves behind of it what the arc covers.
#[derive(Debug)]
pub struct Piece<'a> {
    /// The motion at its start: time, state, and the phase that it is in throughout.
    pub before: &'a Motion,
    /// How long it lasts, s.
    pub duration: f64,
    /// What acts, from its start on.
    pub load: LinearLoad,
    /// State at its end.
    pub end: State,
    pub(crate) structure: &'a Structure,
    pub(crate) level: &'a mut dyn Level,
    pub(crate) arc: &'a mut Arc,
    /// Whether `arc` holds its polynomial: the engine did not leap over it.
    pub(crate) is_expanded: bool,
    pub(crate) local_error: f64,
    pub(crate) part: Part,
    /// Right-hand-side evaluations that watchers have asked for.
    pub(crate) evaluations: u64,
}

/// A piece that is looked at after others have been shown.
#[derive(Clone, Debug)]
pub(crate) struct KeptPiece {
    before: Motion,
    duration: f64,
    load: LinearLoad,
    end: State,
    /// Its polynomial, if it was expanded.
    arc: Option<Arc>,
    local_error: f64,
}

impl KeptPiece {
    /// The motion at its start.
    pub(crate) fn before(&self) -> &Motion {
        &self.before
    }

    /// The piece, whole.
    pub(crate) fn piece<'a>(&'a mut self, equations: &'a mut Equations) -> Piece<'a> {
        let KeptPiece { before, duration, load, end, ref mut arc, local_error } = *self;
        let part = Part { start: (0.0, before.state), end: (duration, end) };
        let Equations { structure, level } = equations;
        Piece {
            before: &self.before,
            duration,
            load,
            end,
            structure,
            level: &mut **level,
            is_expanded: arc.is_some(),
            arc: arc.get_or_insert_default(),
            local_error,
            part,
            evaluations: 0,
        }
    }
}

/// A part of a piece: seconds from the piece's start and states at its own start and end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Part {
    pub start: (f64, State),
    pub end: (f64, State),
}

impl Piece<'_> {
    /// Whether the engine leapt over it by an exact flow: an arc then costs right-hand-side evaluations.
    pub fn is_leap(&self) -> bool {
        !self.is_expanded
    }

    /// Right-hand-side evaluations that its watchers have asked for.
    pub fn evaluations(&self) -> u64 {
        self.evaluations
    }

    /// A copy, to be looked at later.
    pub(crate) fn keep(&self) -> KeptPiece {
        let Piece { before, duration, load, end, local_error, .. } = *self;
        KeptPiece { before: *before, duration, load, end, arc: self.is_expanded.then(|| self.arc.clone()), local_error }
    }

    /// What moves the structure.
    pub(crate) fn equations(&mut self) -> Equations<'_> {
        Equations { structure: self.structure, level: self.level }
    }

    /// Back to its start.
    pub fn rewind(&mut self) {
        self.part = Part { start: (0.0, self.before.state), end: (self.duration, self.end) };
    }

    /// Seconds from its start to that of the part in hand.
    pub fn passed(&self) -> f64 {
        self.part.start.0
    }

    /// The part in hand as a step.
    fn start_of_part(&self) -> Start {
        let Part { start: (passed, state), end: (until, _) } = self.part;
        let load = self.load.from(passed);
        Start {
            state,
            a_g: load.on_foundation(),
            a_top: load.on_top(self.structure),
            interval: until - passed,
            local_error: self.local_error,
        }
    }

    /// The halves of the part in hand, where the state between them is known without expanding the motion.
    pub(crate) fn halves(&mut self) -> Option<[Part; 2]> {
        if self.is_expanded {
            return None;
        }
        let Part { start, end } = self.part;
        let mut half = self.start_of_part();
        half.interval *= 0.5;
        let middle = self.level.leap(self.structure, self.before.phase, &half)?;
        let middle = (start.0 + half.interval, middle);
        Some([Part { start, end: middle }, Part { start: middle, end }])
    }

    /// The motion from the start of the part on, as far as one polynomial reaches.
    pub fn arc(&mut self) -> &Arc {
        if !self.is_expanded {
            self.level.series(self.structure, self.before.phase, &self.start_of_part(), self.arc);
            self.evaluations += self.arc.order as u64;
        }
        self.arc
    }

    /// Leaves behind what the arc covers; false if that is all of the part.
    pub fn skip(&mut self) -> bool {
        let (passed, covered) = (self.passed(), self.arc.duration());
        // an arc may end before the part does although it reaches the end of its span
        let is_left = !self.is_expanded && covered < self.part.end.0 - passed && passed + covered > passed;
        self.part.start = if is_left { (passed + covered, self.arc.end()) } else { self.part.end };
        is_left
    }

    /// Leaves out the middle of what is left of a long leap, which has been looked at from `begin` (s) on.
    ///
    /// In full contact the motion is a line and a decaying vibration about it. The magnitude of the line and that of the
    /// vibration are convex, and with them their sum, which the vibration touches once a period: what is largest is so
    /// within a period of an end. Without vibration (ζ ≥ 1) the line is left once what decays is gone.
    pub(crate) fn skip_middle(&mut self, begin: f64) {
        let &Structure { omega_fc, .. } = self.structure;
        let zeta = self.structure.parameters().zeta_fc;
        let decay = if zeta < 1.0 { 0.0 } else { 80.0 * zeta };
        let (periods, left) = ((2.0 * TAU + decay) / omega_fc, self.part.end.0 - self.passed());
        if self.before.phase != Phase::FullContact || self.passed() - begin < periods || left <= 2.0 * periods {
            return;
        }
        let mut middle = self.start_of_part();
        middle.interval -= periods;
        if let Some(state) = self.level.leap(self.structure, self.before.phase, &middle) {
            self.part.start = (self.part.end.0 - periods, state);
        }
    }

    /// Bounds of the magnitudes of [`Measure::ALL`] over the part in hand.
    pub(crate) fn bounds(&self) -> [Bound; 4] {
        if self.is_expanded {
            self.level.output_bounds(self.structure, self.before.phase, self.load, self.arc)
        } else {
            self.bounds_of_leap()
        }
    }

    /// Bounds of the same that cost less.
    pub(crate) fn crude_bounds(&self) -> [f64; 4] {
        let of_state = if self.is_expanded {
            output_series::crude_bounds_of_state(self.arc, &self.end)
        } else {
            let (start, end) = (self.start_of_part(), &self.part.end.1);
            let rates = self.level.rates(self.before.phase, &start, end);
            let off_chord = start.interval * start.interval / 8.0;
            let bound =
                |most: f64, from: f64, to: f64, bend: f64| most.min(from.abs().max(to.abs()) + bend * off_chord);
            [
                bound(rates.theta, start.state.theta, end.theta, rates.theta_ddot),
                bound(rates.u, start.state.u, end.u, rates.u_ddot),
                bound(rates.u_dot, start.state.u_dot, end.u_dot, rates.u_dddot),
            ]
        };
        let crude = self.level.crude_output_bounds(self.structure, self.before.phase, self.most_force(), of_state);
        if crude[Measure::At as usize] < f64::INFINITY { crude } else { self.bounds().map(|bound| bound.largest()) }
    }

    /// The bound of |θ| alone that costs least.
    #[inline]
    pub(crate) fn crude_bound_of_theta(&self) -> f64 {
        if self.before.phase == Phase::FullContact {
            0.0
        } else if self.is_expanded {
            output_series::crude_bound_of(self.arc, &self.arc.theta, self.end.theta)
        } else {
            self.crude_bounds()[Measure::Theta as usize]
        }
    }

    /// The bound of |θ| alone where there is a polynomial.
    pub(crate) fn bound_of_theta(&self) -> Option<Bound> {
        let arc = &self.arc;
        let [bound] = self.is_expanded.then(|| extremes::bounds(|k| [arc.theta[k]], arc.order, arc.reach))?;
        Some(bound)
    }

    /// The largest |F_t| in the part in hand, N.
    fn most_force(&self) -> f64 {
        let [first, last] = [self.part.start.0, self.part.end.0].map(|tau| self.load.at(tau).F_t.abs());
        first.max(last)
    }

    /// What changes no faster than its second derivative leaves its chord by no more than that over 8/h², and does not turn
    /// round where its rate at an end is more than that times h.
    fn bounds_of_leap(&self) -> [Bound; 4] {
        let step = self.start_of_part();
        let (phase, end, h) = (self.before.phase, &self.part.end.1, step.interval);
        let Rates { u, u_dot, u_ddot, u_dddot, theta, theta_dot, theta_ddot } = self.level.rates(phase, &step, end);
        let &crate::Parameters { m, H, B, g, .. } = self.structure.parameters();
        let (stiffness, damping) = (self.structure.stiffness, outputs::damping(self.structure, phase) / m);
        let loads = [self.part.start.0, self.part.end.0].map(|tau| self.load.at(tau));
        let force = self.most_force();
        let turn = theta_dot * theta_dot + theta * theta_ddot; // bounds |θ̈ sin θ + θ̇² cos θ|
        let sway = theta_ddot + theta * theta_dot * theta_dot; // and |θ̈ cos θ − θ̇² sin θ|
        let delta_t_bend = u_ddot + 2.0 * u_dot * theta_dot * theta + (B + u) * turn + H * sway;
        let push_bend = (force * turn + 2.0 * self.load.slope.F_t.abs() * theta_dot * theta) / m;
        let a_t_bend = g * sway + damping * u_dddot + stiffness * u_ddot + push_bend;
        let bends = [theta_ddot, u_ddot, delta_t_bend, a_t_bend];
        let within = self.level.crude_output_bounds(self.structure, phase, force, [theta, u, u_dot]);

        let [first, last] = [(&step.state, loads[0]), (end, loads[1])]
            .map(|(state, load)| self.level.outputs(self.structure, phase, state, load));
        let load = LinearLoad { value: loads[0], slope: self.load.slope };
        let accelerations = self.level.accelerations(self.structure, phase, &step.state, load.value);
        let rates = Outputs::rates_by(self.structure, phase, &step.state, accelerations, load);
        std::array::from_fn(|i| {
            let of = |outputs: &Outputs| Measure::ALL[i].of(outputs).abs();
            let ends = of(&first).max(of(&last));
            let between = (bends[i] * h * h / 8.0).min((within[i] - ends).max(0.0));
            let rate = of(&rates) * h;
            Bound { ends, between, rate: [rate - bends[i] * h * h, rate + bends[i] * h * h] }
        })
    }

    /// Shows `measure` over the arc as series in σ, each with the σ at which it starts and the arc that it is of: the arc
    /// itself, or, where sin θ and cos θ take more terms than an arc has, parts of it.
    pub(crate) fn series(&self, measure: Measure, show: &mut dyn FnMut(f64, &Arc, &Series)) {
        self.series_over(self.arc, 0.0, measure, FINEST_PART, show);
    }

    /// The same over `arc`, which starts at `from` on the arc of the piece; `halvings` are left.
    fn series_over(
        &self,
        arc: &Arc,
        from: f64,
        measure: Measure,
        halvings: u32,
        show: &mut dyn FnMut(f64, &Arc, &Series),
    ) {
        let (structure, phase) = (self.structure, self.before.phase);
        let until = from + arc.duration() / self.arc.span;
        let series = match measure {
            Measure::Theta => arc.series(|k| arc.theta[k]),
            Measure::U => arc.series(|k| arc.u[k]),
            Measure::DeltaT => output_series::delta_t(structure, phase, arc, &Turn::of(arc)),
            Measure::At => {
                let load = self.load.from(self.passed() + from * self.arc.span);
                self.level.a_t_series(structure, phase, load, arc, &Turn::of(arc))
            }
        };
        if halvings > 0 && matches!(measure, Measure::DeltaT | Measure::At) {
            let off = evaluate(arc.used(&series), arc.reach) - measure.of(&self.outputs(until));
            let terms = arc.used(&series).iter().rev().fold(0.0, |sum, c| sum * arc.reach + c.abs());
            if off.abs() > (100.0 * self.local_error).max(CONVERGED) * terms {
                let middle = 0.5 * arc.reach;
                for [start, end] in [[0.0, middle], [middle, arc.reach]] {
                    let start_on_piece = from + start * arc.span / self.arc.span;
                    self.series_over(&arc.between(start, end), start_on_piece, measure, halvings - 1, show);
                }
                return;
            }
        }
        show(from, arc, &series);
    }

    /// The outputs at its start.
    pub(crate) fn first_outputs(&self) -> Outputs {
        self.level.outputs(self.structure, self.before.phase, &self.before.state, self.load.value)
    }

    /// The outputs at its end.
    pub(crate) fn last_outputs(&self) -> Outputs {
        self.level.outputs(self.structure, self.before.phase, &self.end, self.load.at(self.duration))
    }

    /// The outputs at both ends of the part in hand, with seconds from the start of the piece.
    pub(crate) fn ends(&self) -> [(f64, Outputs); 2] {
        [self.part.start, self.part.end]
            .map(|(tau, state)| (tau, self.level.outputs(self.structure, self.before.phase, &state, self.load.at(tau))))
    }

    /// The outputs at `sigma` on the arc.
    pub fn outputs(&self, sigma: f64) -> Outputs {
        let load = self.load.at(self.passed() + sigma * self.arc.span);
        self.level.outputs(self.structure, self.before.phase, &self.arc.at(sigma), load)
    }

    /// The state `tau` seconds into it.
    fn state_at(&mut self, tau: f64) -> State {
        if tau <= 0.0 {
            return self.before.state;
        }
        if tau >= self.duration {
            return self.end;
        }
        if self.is_leap() {
            let step = Start { interval: tau - self.passed(), ..self.start_of_part() };
            if step.interval > 0.0
                && let Some(state) = self.level.leap(self.structure, self.before.phase, &step)
            {
                return state;
            }
        }
        loop {
            let from = self.passed();
            let arc = self.arc();
            if tau <= from + arc.duration() {
                return arc.at((tau - from) / arc.span);
            }
            if !self.skip() {
                return self.end;
            }
        }
    }

    /// The motion at `time` (s), within it. Nothing may have been left behind that is later.
    pub fn sample(&mut self, time: f64) -> Sample<'_> {
        let end = self.before.time + self.duration;
        // an instant that misses the end by the clock's rounding is the end
        let is_before = time < end - 2.0 * f64::EPSILON * end.abs();
        let tau = if is_before { time - self.before.time } else { self.duration };
        let motion = Motion { time, state: self.state_at(tau), ..*self.before };
        Sample { motion, load: self.load.at(tau), structure: self.structure, level: self.level }
    }
}
