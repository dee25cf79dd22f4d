//! A piece: what the engine has proved about a stretch of time, shown once to whoever watches.
//!
//! Within a piece there is no transition. If the engine expanded the motion into a polynomial, the piece has that polynomial. If
//! the engine leapt by an exact flow, the piece has bounds, and makes polynomials on request.

use crate::engine::Moves;
use crate::engine::motion::Motion;
use crate::engine::phases::{self, Step};
use crate::engine::transition::Transition;
use crate::levels::level::{Now, Subject};
use crate::levels::shown::Searched;
use crate::mechanics::floors::{FrameOutput, MotionOfFloors};
use crate::mechanics::gauge::{Gauge, Reading};
use crate::mechanics::instant::{Instant, Second, Strut};
use crate::mechanics::lateral::{Lateral, Modes};
use crate::mechanics::load::{LinearLoad, Load};
use crate::mechanics::outputs::Measure;
use crate::mechanics::restraint::{Dissipators, Restraint, Restraints};
use crate::numbers::{Number, Turn};
use crate::series::extremes::Bound;
use crate::series::taylor::{Arc, Start, evaluate};
use crate::series::terms::Terms;
use crate::{Floor, Outputs, Phase, Reactions, State, Structure};
use std::cell::{Cell, RefCell};
use std::f64::consts::TAU;

/// Watches a motion go by.
pub trait Watch<Q: Moves = f64> {
    /// Whether the watcher looks at pieces. If not, the engine makes none for it.
    const SEES_PIECES: bool;

    /// Sees the next piece.
    #[inline]
    fn piece(&mut self, _piece: &Piece<Q>) {}

    /// Sees the transition at the end of the last piece.
    #[inline]
    fn transition(&mut self, _transition: &Transition<Q>) {}
}

/// The watcher that ignores pieces and transitions.
impl<Q: Moves> Watch<Q> for () {
    const SEES_PIECES: bool = false;
}

/// A watcher of transitions only.
impl<Q: Moves, F: FnMut(&Transition<Q>)> Watch<Q> for F {
    const SEES_PIECES: bool = false;

    fn transition(&mut self, transition: &Transition<Q>) {
        self(transition);
    }
}

/// Two watchers of the same motion.
impl<Q: Moves, A: Watch<Q>, B: Watch<Q>> Watch<Q> for (&mut A, &mut B) {
    const SEES_PIECES: bool = A::SEES_PIECES || B::SEES_PIECES;

    #[inline]
    fn piece(&mut self, piece: &Piece<Q>) {
        if A::SEES_PIECES {
            self.0.piece(piece);
        }
        if B::SEES_PIECES {
            self.1.piece(piece);
        }
    }

    fn transition(&mut self, transition: &Transition<Q>) {
        self.0.transition(transition);
        self.1.transition(transition);
    }
}

/// A motion at one instant; at a transition, just after it.
#[derive(Clone, Copy, Debug)]
pub struct Sample<'a, Q: Moves = f64> {
    /// Time, state and phase, transitions and impulses so far.
    pub motion: Motion<Q>,
    /// Load at the instant.
    pub load: Load<Q>,
    pub(crate) level: &'a Q::Level,
}

impl<Q: Moves> Sample<'_, Q> {
    /// ü and θ̈; once overturned, those of the instant before.
    pub(crate) fn second(&self) -> Second<f64, Q> {
        let Sample { motion, load, level } = self;
        level.accelerations(motion.phase.in_motion(), &motion.under(*load))
    }

    fn instant(&self) -> Instant<'_, f64, Q> {
        Instant::of(self.level.structure(), self.motion.phase.in_motion(), &self.motion.state, self.load)
    }

    /// The reactions; once overturned, those of the instant before.
    pub fn reactions(&self) -> Reactions {
        Reactions::at(&self.instant(), &self.second())
    }

    /// The part of the reactions that the edges of the base carry: all of it, unless the structure is restrained.
    pub fn edges(&self) -> Reactions {
        let Sample { motion: Motion { phase, state, dissipators, .. }, level, .. } = self;
        let (&Subject { ref structure, is_tied, .. }, reactions) = (level.subject(), self.reactions());
        if !is_tied {
            return reactions;
        }
        let restraint = Restraint::about(structure.base(), phase.side(), dissipators);
        let [up, right, moment] = restraint.pulls(&level.subject().angles.chord(state.theta, state.theta_dot));
        reactions.of_edges(up, right, moment)
    }

    /// The forces of the restraints.
    pub fn restraints(&self) -> Restraints {
        let Motion { phase, state, dissipators, .. } = &self.motion;
        let chord = self.level.subject().angles.chord(state.theta, state.theta_dot);
        Restraint::about(self.level.structure().base(), phase.side(), dissipators).forces(&chord)
    }
}

impl Sample<'_> {
    /// The outputs; once overturned, those of the instant before.
    pub fn outputs(&self) -> Outputs {
        self.level.outputs(self.motion.phase.in_motion(), &self.motion.under(self.load))
    }
}

impl Sample<'_, Modes> {
    /// The value of `output`; once overturned, the value of the instant before.
    pub fn output(&self, output: FrameOutput) -> f64 {
        output.of(&self.turning(output.has_feedthrough(self.level.structure())))
    }

    /// The values of outputs, of which each costs less than by [`Sample::output`].
    pub fn outputs(&self) -> impl Fn(FrameOutput) -> f64 {
        let turning = self.turning(self.level.structure().gauges().have_feedthrough());
        move |output| output.of(&turning)
    }

    /// The structure at the instant, with θ̈ if an output depends on θ̈.
    fn turning(&self, needs_second: bool) -> Turning<'_, f64, Modes> {
        let theta_ddot = if needs_second { self.second().theta_ddot } else { 0.0 };
        Turning { x: self.instant(), theta_ddot }
    }
}

/// A structure of many masses at an instant, with θ̈.
pub(crate) struct Turning<'a, N: Number, Q: Lateral<N>> {
    pub x: Instant<'a, N, Q>,
    pub theta_ddot: N,
}

impl<N: Number, Q: Lateral<N>> MotionOfFloors<N> for Turning<'_, N, Q> {
    fn frame(&self) -> &Structure {
        self.x.structure
    }

    fn pivot(&self) -> f64 {
        self.x.pivot()
    }

    fn theta(&self) -> N {
        self.x.theta
    }

    fn theta_dot(&self) -> N {
        self.x.theta_dot
    }

    fn turn(&self) -> Turn<N> {
        self.x.turn
    }

    fn u(&self, floor: &Floor) -> N {
        self.x.sum(|j, _| self.x.u.of(j) * floor.shape.of(j))
    }

    fn u_dot(&self, floor: &Floor) -> N {
        self.x.sum(|j, _| self.x.u_dot.of(j) * floor.shape.of(j))
    }

    fn gauge(&self, gauge: &Gauge) -> N {
        let &Turning { ref x, theta_ddot } = self;
        let Strut::Elastic(damping) = x.strut else { unreachable!("the rigid limit has no mode") };
        let (elastic, push) = (gauge.elastic(x.structure, damping, &x.u, &x.u_dot), gauge.push(x.structure, &x.F_t));
        let &Instant { turn, theta_dot, a_g, a_v, .. } = x;
        gauge.value(x.base(), x.s, &Reading { elastic, push, turn, theta_dot, theta_ddot, a_g, a_v })
    }
}

/// A series of an output that is off by less than this part of its terms at its end has converged.
pub(crate) const CONVERGED: f64 = 1e-12;

/// How often an arc is halved before its outputs' series are taken as they are.
const FINEST_PART: u32 = 5;

/// A stretch of time without a transition.
#[derive(Clone, Copy, Debug)]
pub struct Piece<'a, Q: Moves = f64> {
    /// The motion at its start: time, state, and the phase that it is in throughout.
    pub before: &'a Motion<Q>,
    /// Duration of the piece, s.
    pub duration: f64,
    /// Load from the start of the piece on.
    pub load: LinearLoad<Q>,
    /// State at its end.
    pub end: State<Q>,
    pub(crate) level: &'a Q::Level,
    /// Polynomial of the piece; none if the engine leapt over the piece.
    pub(crate) arc: Option<&'a Arc<Q>>,
    pub(crate) room: &'a Room<Q>,
}

/// What watchers use of an engine when they ask for the polynomials of a leap.
#[derive(Debug)]
pub(crate) struct Room<Q> {
    /// Polynomials that they may still ask for.
    pub left: Cell<u64>,
    /// The polynomial that they asked for last.
    arc: RefCell<Option<Box<Arc<Q>>>>,
}

impl<Q> Default for Room<Q> {
    fn default() -> Room<Q> {
        Room { left: Cell::new(0), arc: RefCell::new(None) }
    }
}

impl<Q: Moves> Piece<'_, Q> {
    /// The whole piece as a part.
    #[inline]
    pub(crate) fn whole(&self) -> Part<'_, Q> {
        Part { piece: self, start: (0.0, self.before.state), end: (self.duration, self.end) }
    }

    /// The motion of the piece as polynomials, in order of time.
    pub(crate) fn arcs(&self) -> Arcs<'_, Q> {
        self.whole().arcs()
    }

    /// The motion in `state`, `tau` seconds after the start of the piece, with the dissipators of the start.
    pub(crate) fn in_state(&self, tau: f64, state: State<Q>) -> Sample<'_, Q> {
        let &Piece { before, load, level, .. } = self;
        Sample { motion: Motion { time: before.time + tau, state, ..*before }, load: load.at(tau), level }
    }

    /// The state `tau` seconds after the start of the piece.
    pub(crate) fn state_at(&self, tau: f64) -> State<Q> {
        if tau <= 0.0 {
            return self.before.state;
        }
        if tau >= self.duration {
            return self.end;
        }
        let step = Start { interval: tau, ..self.whole().step() };
        if self.arc.is_none()
            && let Some(state) = self.level.leap(self.before.phase, &step)
        {
            return state;
        }
        let mut arcs = self.arcs();
        while let Some(Expansion { from, arc, .. }) = arcs.next() {
            if tau <= from + arc.duration() {
                return arc.at((tau - from) / arc.span);
            }
        }
        self.end
    }

    /// The dissipators `tau` seconds after the start of the piece.
    fn dissipators_at(&self, tau: f64) -> Dissipators {
        let moved = phases::of::<Q>(self.level.structure(), self.before).zip(self.arc).and_then(|(watched, arc)| {
            let (level, side) = (&**self.level, self.before.phase.side());
            let step = Step { level, side, start: &self.whole().step(), arc, reach: tau / arc.span };
            watched.moved(level.subject(), &step)
        });
        moved.unwrap_or(self.before.dissipators)
    }

    /// The motion at `time` (s), which lies within the piece.
    pub fn sample(&self, time: f64) -> Sample<'_, Q> {
        let end = self.before.time + self.duration;
        // an instant that misses the end by the clock's rounding is the end
        let is_before = time < end - 2.0 * f64::EPSILON * end.abs();
        let tau = if is_before { time - self.before.time } else { self.duration };
        let motion = Motion { time, state: self.state_at(tau), dissipators: self.dissipators_at(tau), ..*self.before };
        Sample { motion, load: self.load.at(tau), level: self.level }
    }
}

impl Piece<'_> {
    /// The outputs in `state`, `tau` seconds after the start of the piece.
    pub(crate) fn outputs(&self, tau: f64, state: &State) -> Outputs {
        let now = Now { state, load: self.load.at(tau), dissipators: &self.before.dissipators };
        self.level.outputs(self.before.phase, &now)
    }
}

/// A part of a piece.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Part<'a, Q: Moves = f64> {
    pub piece: &'a Piece<'a, Q>,
    /// Seconds from the piece's start to its own, and the state there.
    pub start: (f64, State<Q>),
    /// Seconds from the piece's start to its end, and the state there.
    pub end: (f64, State<Q>),
}

impl<'a, Q: Moves> Part<'a, Q> {
    /// The part as a step.
    #[inline]
    pub(crate) fn step(&self) -> Start<'a, Q> {
        let Part { piece, start: (passed, state), end: (until, _) } = *self;
        piece.level.subject().start(state, &piece.before.dissipators, piece.load.from(passed), until - passed)
    }

    /// The motion of the part as polynomials, in order of time.
    pub(crate) fn arcs(&self) -> Arcs<'a, Q> {
        Arcs { begin: self.start.0, left: Some(*self), arc: None, room: self.piece.room, evaluations: 0 }
    }
}

impl<'a> Part<'a> {
    /// The halves of the part, if the state between them is known without expanding the motion.
    pub(crate) fn halves(&self) -> Option<[Part<'a>; 2]> {
        let Part { piece, start, .. } = *self;
        if piece.arc.is_some() {
            return None;
        }
        let mut half = self.step();
        half.interval *= 0.5;
        let middle = piece.level.leap(piece.before.phase, &half)?;
        let middle = (start.0 + half.interval, middle);
        Some([Part { end: middle, ..*self }, Part { start: middle, ..*self }])
    }

    /// The outputs at both ends of the part, with seconds from the start of the piece.
    pub(crate) fn ends(&self) -> [(f64, Outputs); 2] {
        [self.start, self.end].map(|(tau, state)| (tau, self.piece.outputs(tau, &state)))
    }

    /// Bounds of the magnitudes of the searched outputs over this part.
    pub(crate) fn bounds(&self) -> Searched<Bound> {
        let Piece { level, before, load, arc, .. } = self.piece;
        match arc {
            Some(arc) => level.bounds(before.phase, *load, arc),
            None => self.bounds_of_leap(),
        }
    }

    /// Bounds of the same magnitudes that cost less.
    pub(crate) fn crude_bounds(&self) -> Searched<f64> {
        let &Piece { level, before, load, arc, .. } = self.piece;
        if !level.has_strut() {
            return self.bounds().map(|bound| bound.largest());
        }
        let end = &self.end.1;
        let most = if let Some(arc) = arc {
            State {
                u: arc.most(&arc.u, end.u),
                u_dot: arc.most(&arc.u_dot, end.u_dot),
                theta: arc.most(&arc.theta, end.theta),
                theta_dot: arc.most(&arc.theta_dot, end.theta_dot),
            }
        } else {
            let start = self.step();
            level.leap_bounds(before.phase, &start, end).most(&start, end)
        };
        level.most(before.phase, [self.start.0, self.end.0].map(|tau| load.at(tau)), &most)
    }

    /// Bounds over a leap: a quantity whose second derivative is at most M over the time h stays within M h²/8 of its chord. It
    /// does not turn round if its rate at the start exceeds M h.
    fn bounds_of_leap(&self) -> Searched<Bound> {
        let &Piece { level, before: &Motion { phase, .. }, load, .. } = self.piece;
        let (step, end, load) = (self.step(), &self.end.1, load.from(self.start.0));
        let h = step.interval;
        let bends = level.bends(phase, load, h, &level.leap_bounds(phase, &step, end));
        let [(_, first), (_, last)] = self.ends();
        let now = Now { state: &step.state, load: load.value, dissipators: step.dissipators };
        let rates = level.searched_rates(phase, &step.state, &level.accelerations(phase, &now), load);
        std::array::from_fn(|i| {
            let of = |outputs: &Outputs| Measure::SEARCHED[i].of(outputs).abs();
            let ends = of(&first).max(of(&last));
            let bend = bends[i].bend;
            let between = (bend * h * h / 8.0).min((bends[i].value - ends).max(0.0));
            let rate = rates[i].abs() * h;
            Bound { ends, between, rate: [rate - bend * h * h, rate + bend * h * h] }
        })
    }
}

/// Goes through a part of a piece polynomial by polynomial.
#[derive(Debug)]
pub(crate) struct Arcs<'a, Q: Moves = f64> {
    /// Start of the part, s after the start of the piece.
    begin: f64,
    left: Option<Part<'a, Q>>,
    /// Of a leap: the polynomial in hand.
    arc: Option<Box<Arc<Q>>>,
    room: &'a Room<Q>,
    /// Right-hand-side evaluations that the polynomials took.
    pub evaluations: u64,
}

impl<Q: Moves> Arcs<'_, Q> {
    /// The motion from where the last one ends on, as far as one polynomial reaches.
    pub(crate) fn next(&mut self) -> Option<Expansion<'_, Q>> {
        let part = self.left.take()?;
        let Part { piece, start: (from, _), end: (until, _) } = part;
        if let Some(arc) = piece.arc {
            return Some(Expansion { piece, from, arc });
        }
        let Room { left, arc: spare } = piece.room;
        left.set(left.get().checked_sub(1)?);
        let arc = self.arc.get_or_insert_with(|| spare.take().unwrap_or_default());
        piece.level.series(piece.before.phase, &part.step(), arc);
        self.evaluations += arc.order as u64;
        let covered = arc.duration();
        if covered < until - from && from + covered > from {
            self.left = Some(Part { start: (from + covered, arc.end()), ..part });
        }
        Some(Expansion { piece, from, arc })
    }
}

impl<Q: Moves> Drop for Arcs<'_, Q> {
    fn drop(&mut self) {
        if let Some(arc) = self.arc.take() {
            self.room.arc.replace(Some(arc));
        }
    }
}

impl<'a> Arcs<'a, Modes> {
    /// What is left of a leap in full contact, with bounds of |u|, |u̇|, |ü| and |u⃛| of the vibration about the motion that follows
    /// the load.
    pub(crate) fn rest(&self) -> Option<(Part<'a, Modes>, [Modes; 4])> {
        let part = self.left?;
        Some((part, part.piece.level.swings(part.piece.before.phase, &part.step())?))
    }
}

impl Part<'_, Modes> {
    /// The motion at both ends.
    pub(crate) fn samples(&self) -> [Sample<'_, Modes>; 2] {
        [self.start, self.end].map(|(tau, state)| self.piece.in_state(tau, state))
    }
}

impl Arcs<'_> {
    /// Leaves out the middle of what is left of a long leap.
    ///
    /// The motion in full contact is a line and a decaying vibration about the line. The magnitudes of the line and of the
    /// vibration are convex. Their sum is convex too, and the motion touches the sum once a period. The largest magnitude is therefore
    /// within a period of an end.
    pub(crate) fn skip_middle(&mut self) {
        let Some(part) = &mut self.left else { return };
        let &Piece { level, before: &Motion { phase, .. }, .. } = part.piece;
        let periods = 2.0 * TAU / level.structure().vibration().contact;
        let (passed, until) = (part.start.0, part.end.0);
        if phase != Phase::FullContact || passed - self.begin < periods || until - passed <= 2.0 * periods {
            return;
        }
        let mut middle = part.step();
        middle.interval -= periods;
        if let Some(state) = level.leap(phase, &middle) {
            part.start = (until - periods, state);
        }
    }
}

/// A polynomial of the motion of a piece.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Expansion<'a, Q: Moves = f64> {
    pub piece: &'a Piece<'a, Q>,
    /// Start of the polynomial, s after the start of the piece.
    pub from: f64,
    pub arc: &'a Arc<Q>,
}

impl<Q: Moves> Expansion<'_, Q> {
    /// The instant of `sigma`, s.
    pub(crate) fn time(&self, sigma: f64) -> f64 {
        self.piece.before.time + self.from + sigma * self.arc.span
    }

    /// The motion at `sigma`, with the dissipators of the start of the piece.
    pub(crate) fn sample(&self, sigma: f64) -> Sample<'_, Q> {
        let &Piece { before, load, level, .. } = self.piece;
        let motion = Motion { time: self.time(sigma), state: self.arc.at(sigma), ..*before };
        Sample { motion, load: load.at(self.from + sigma * self.arc.span), level }
    }

    /// Whether `series` ends in the value `last`, but for this `part` of its terms or the truncation of the motion.
    pub(crate) fn has_converged(&self, series: &Terms, last: f64, part: f64) -> bool {
        let terms = series.used().iter().rev().fold(0.0, |sum, c| sum * self.arc.reach + c.abs());
        let off = evaluate(series.used(), self.arc.reach) - last;
        // more terms do not turn NaN into a number
        off.is_nan() || off.abs() <= part.max(1e3 * self.piece.level.subject().local_error) * terms
    }

    /// Looks at the polynomial. If `look` says that a series over it has not converged, it looks at both halves instead, and at their
    /// halves. The finest parts, of which it is told, are taken as they are.
    pub(crate) fn in_parts(&self, look: &mut dyn FnMut(&Expansion<Q>, bool) -> bool) {
        self.in_parts_of(FINEST_PART, look);
    }

    fn in_parts_of(&self, halvings: u32, look: &mut dyn FnMut(&Expansion<Q>, bool) -> bool) {
        if look(self, halvings == 0) || halvings == 0 {
            return;
        }
        let &Expansion { piece, from, arc } = self;
        let middle = 0.5 * arc.reach;
        for [start, end] in [[0.0, middle], [middle, arc.reach]] {
            let half = Expansion { piece, from: from + start * arc.span, arc: &arc.between(start, end) };
            half.in_parts_of(halvings - 1, look);
        }
    }
}

impl Expansion<'_> {
    /// The outputs at `sigma`.
    pub(crate) fn outputs(&self, sigma: f64) -> Outputs {
        self.piece.outputs(self.from + sigma * self.arc.span, &self.arc.at(sigma))
    }

    /// Shows `measure` as series in σ, each with the polynomial that it belongs to: this one, or parts of it if sin θ and cos θ need
    /// more terms than it has.
    pub(crate) fn series(&self, measure: Measure, show: &mut dyn FnMut(&Expansion, &Terms)) {
        self.in_parts(&mut |part, is_finest| {
            let &Expansion { piece: &Piece { level, before, load, .. }, from, arc } = part;
            let series = match measure {
                Measure::theta => Terms::of(&arc.theta, arc.order),
                Measure::u => Terms::of(&arc.u, arc.order),
                _ => {
                    let series = measure.at(&level.terms(before.phase, load.from(from), arc));
                    if !is_finest && !part.has_converged(&series, measure.of(&part.outputs(arc.reach)), CONVERGED) {
                        return false;
                    }
                    series
                }
            };
            show(part, &series);
            true
        });
    }
}
