//! A piece: what the engine has just proved about a stretch of time, shown once to whoever watches.
//!
//! Within a piece there is no transition. Where the engine expanded the motion into a polynomial, that is what a watcher
//! sees; where it leapt by an exact flow, there are bounds, and polynomials only for a watcher that asks for them.

use crate::detail::Level;
use crate::engine::Motion;
use crate::load::{LinearLoad, Load};
use crate::output_series::{self, Turn};
use crate::taylor::{Arc, Series, Start};
use crate::transition::Transition;
use crate::{Outputs, Phase, Reactions, State, Structure, extremes, outputs};

/// Watches a motion go by.
pub trait Watch {
    /// Whether it looks at pieces: who does not does not pay for them.
    const SEES_PIECES: bool;

    /// The next piece of it.
    #[inline]
    fn piece(&mut self, _piece: &mut Piece) {}

    /// The transition at the end of the piece shown last.
    #[inline]
    fn transition(&mut self, _transition: &Transition) {}
}

/// Nobody.
impl Watch for () {
    const SEES_PIECES: bool = false;
}

/// Whoever wants the transitions alone.
impl<F: FnMut(&Transition)> Watch for F {
    const SEES_PIECES: bool = false;

    fn transition(&mut self, transition: &Transition) {
        self(transition);
    }
}

/// Two at once.
impl<A: Watch, B: Watch> Watch for (&mut A, &mut B) {
    const SEES_PIECES: bool = A::SEES_PIECES || B::SEES_PIECES;

    #[inline]
    fn piece(&mut self, piece: &mut Piece) {
        self.0.piece(piece);
        piece.rewind();
        self.1.piece(piece);
    }

    fn transition(&mut self, transition: &Transition) {
        self.0.transition(transition);
        self.1.transition(transition);
    }
}

/// Bounds of |u|, |θ| and their derivatives over an exact leap.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Bounds {
    pub u: f64,
    pub u_dot: f64,
    pub u_ddot: f64,
    pub u_dddot: f64,
    pub theta: f64,
    pub theta_dot: f64,
    pub theta_ddot: f64,
}

impl Bounds {
    /// Nothing is known.
    pub(crate) const NONE: Bounds = {
        const ANY: f64 = f64::INFINITY;
        Bounds { u: ANY, u_dot: ANY, u_ddot: ANY, u_dddot: ANY, theta: ANY, theta_dot: ANY, theta_ddot: ANY }
    };
}

/// What a piece is looked at for: the outputs that others follow from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Measure {
    /// θ, and with it the uplift (Eq 25).
    Theta,
    /// u.
    U,
    /// δ_t (Eq 26).
    DeltaT,
    /// a_t (Eq 27), and with it V_t and M_t.
    At,
}

impl Measure {
    /// All of them.
    pub const ALL: [Measure; 4] = [Measure::Theta, Measure::U, Measure::DeltaT, Measure::At];

    /// Its value among `outputs`.
    pub fn of(self, outputs: &Outputs) -> f64 {
        match self {
            Measure::Theta => outputs.theta,
            Measure::U => outputs.u,
            Measure::DeltaT => outputs.delta_t,
            Measure::At => outputs.a_t,
        }
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
        self.level.outputs(self.structure, self.moving_phase(), &self.motion.state, self.load)
    }

    /// The reactions; once overturned, those of the instant before.
    pub fn reactions(&self) -> Reactions {
        let (phase, state) = (self.moving_phase(), &self.motion.state);
        let accelerations = self.level.accelerations(self.structure, phase, state, self.load);
        Reactions::of(self.structure, phase, state, accelerations, self.load)
    }

    /// The phase, or that in which the structure overturned.
    fn moving_phase(&self) -> Phase {
        match self.motion.phase {
            Phase::Overturned(side) => Phase::Rocking(side),
            phase => phase,
        }
    }
}

/// A stretch of time without a transition.
///
/// It is gone through from its start: [`Piece::bounds`] and [`Piece::arc`] are about the rest of it, and
/// [`Piece::skip`] leaves behind what the arc covers.
#[derive(Debug)]
pub struct Piece<'a> {
    /// The motion at its start: time, state, and the phase that it is in throughout.
    pub before: Motion,
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
    /// How much of it is left behind, s, and the state there.
    pub(crate) passed: (f64, State),
    /// Right-hand-side evaluations that watchers have asked for.
    pub(crate) evaluations: u64,
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

    /// Back to its start.
    pub fn rewind(&mut self) {
        self.passed = (0.0, self.before.state);
    }

    /// Seconds from its start to that of the arc.
    pub fn passed(&self) -> f64 {
        self.passed.0
    }

    fn rest(&self) -> Start {
        let (passed, state) = self.passed;
        let load = self.load.from(passed);
        Start {
            state,
            a_g: load.on_foundation(),
            a_top: load.on_top(self.structure),
            interval: self.duration - passed,
            local_error: self.local_error,
        }
    }

    /// What acts, from the start of the rest on.
    fn rest_load(&self) -> LinearLoad {
        self.load.from(self.passed.0)
    }

    /// The motion from the start of the rest on, as far as one polynomial reaches.
    pub fn arc(&mut self) -> &Arc {
        if !self.is_expanded {
            self.level.series(self.structure, self.before.phase, &self.rest(), self.arc);
            self.evaluations += self.arc.order as u64;
        }
        self.arc
    }

    /// Leaves the arc behind; false if nothing is left.
    pub fn skip(&mut self) -> bool {
        let passed = self.passed.0 + self.arc.duration();
        if self.is_expanded || passed >= self.duration || self.arc.reach == 1.0 {
            self.passed = (self.duration, self.end);
            return false;
        }
        self.passed = (passed, self.arc.end());
        true
    }

    /// Bounds of the magnitudes of [`Measure::ALL`] over the rest.
    pub fn bounds(&self) -> [f64; 4] {
        if self.is_expanded { self.bounds_of_arc() } else { self.bounds_of_leap() }
    }

    fn bounds_of_arc(&self) -> [f64; 4] {
        let (structure, arc) = (self.structure, &*self.arc);
        let [theta, u] = [&arc.theta, &arc.u].map(|of| extremes::bound(arc.used(of).iter().copied(), arc.reach));
        let delta_t = output_series::delta_t_bound(structure, arc, theta, u);
        [theta, u, delta_t, self.level.a_t_bound(structure, self.before.phase, self.load, arc, theta)]
    }

    /// What changes no faster than its second derivative leaves its chord by no more than that over 8/h².
    fn bounds_of_leap(&self) -> [f64; 4] {
        let rest = self.rest();
        let Bounds { u, u_dot, u_ddot, u_dddot, theta, theta_dot, theta_ddot } =
            self.level.bounds(self.before.phase, &rest, &self.end);
        let &crate::Parameters { m, H, B, g, .. } = self.structure.parameters();
        let (stiffness, damping) = (self.structure.stiffness, outputs::damping(self.structure, self.before.phase) / m);
        let [load, last] = [self.rest_load().value, self.load.at(self.duration)];
        let push = load.F_t.abs().max(last.F_t.abs()) / m;
        let bend = rest.interval * rest.interval / 8.0;
        let turn = theta_dot * theta_dot + theta * theta_ddot; // bounds |θ̈ sin θ + θ̇² cos θ|

        let ends = [(&rest.state, load), (&self.end, last)]
            .map(|(state, load)| self.level.outputs(self.structure, self.before.phase, state, load));
        let chord = |measure: Measure| ends.each_ref().map(|end| measure.of(end).abs()).into_iter().fold(0.0, f64::max);
        let delta_t_bend = u_ddot
            + 2.0 * u_dot * theta_dot * theta
            + (B + u) * turn
            + H * (theta_ddot + theta * theta_dot * theta_dot);
        let push_bend = push * turn + 2.0 * self.load.slope.F_t.abs() / m * theta_dot * theta;
        let a_t_bend =
            g * (theta_ddot + theta * theta_dot * theta_dot) + damping * u_dddot + stiffness * u_ddot + push_bend;
        let within =
            [theta, u, u + H * theta + B * theta * theta / 2.0, g * theta + damping * u_dot + stiffness * u + push];
        let bends = [theta_ddot, u_ddot, delta_t_bend, a_t_bend];
        std::array::from_fn(|i| f64::min(within[i], chord(Measure::ALL[i]) + bends[i] * bend))
    }

    /// `measure` over the arc, as a series in σ.
    pub fn series(&self, measure: Measure) -> Series {
        let turn = || Turn::of(self.arc);
        match measure {
            Measure::Theta => used(self.arc, &self.arc.theta),
            Measure::U => used(self.arc, &self.arc.u),
            Measure::DeltaT => output_series::delta_t(self.structure, self.before.phase, self.arc, &turn()),
            Measure::At => {
                self.level.a_t_series(self.structure, self.before.phase, self.rest_load(), self.arc, &turn())
            }
        }
    }

    /// The outputs at `sigma` on the arc.
    pub fn outputs(&self, sigma: f64) -> Outputs {
        let load = self.load.at(self.passed.0 + sigma * self.arc.span);
        self.level.outputs(self.structure, self.before.phase, &self.arc.at(sigma), load)
    }

    /// The state `tau` seconds into it.
    fn state_at(&mut self, tau: f64) -> State {
        if tau <= 0.0 {
            return self.before.state;
        }
        loop {
            let from = self.passed.0;
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
        let tau = time - self.before.time;
        let motion = Motion { time, state: self.state_at(tau), ..self.before };
        Sample { motion, load: self.load.at(tau), structure: self.structure, level: self.level }
    }
}

/// `series` of `arc` with zeros for the orders that are not in use.
fn used(arc: &Arc, series: &Series) -> Series {
    let mut of = *series;
    of[arc.order + 1..].fill(0.0);
    of
}
