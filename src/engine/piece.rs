//! A piece: what the engine has proved about a stretch of time, shown once to whoever watches.
//!
//! Within a piece there is no transition. If the engine expanded the motion into a polynomial, the piece has that polynomial. If
//! the engine leapt by an exact flow, the piece has bounds, and makes polynomials on request.

use crate::engine::motion::Motion;
use crate::engine::phases;
use crate::engine::sample::{Sample, edges_of, shown};
use crate::engine::step::Step;
use crate::engine::transition::Transition;
use crate::levels::level::{Level, off_chord};
use crate::levels::start::Start;
use crate::mechanics::arc::{Arc, Polynomials};
use crate::mechanics::instant::Instant;
use crate::mechanics::lateral::{Coordinates, Lateral};
use crate::mechanics::load::{LinearLoad, Load};
use crate::mechanics::reach::{Magnitudes, OffChord, magnitudes};
use crate::numbers::{Angle, Number, Turn};
use crate::series::taylor::{evaluate, sum_of_magnitudes};
use crate::series::terms::Terms;
use crate::{Friction, Output, Ramp, Reactions, State, Structure};
use std::cell::{Cell, RefCell};
use std::f64::consts::TAU;

/// Watches a motion go by.
pub trait Watch<Q: Coordinates = f64> {
    /// Whether the watcher looks at pieces. If not, the engine makes none for it.
    fn sees_pieces(&self) -> bool {
        true
    }

    /// Sees the next piece.
    #[inline]
    fn piece(&mut self, _piece: &Piece<Q>) {}

    /// Sees the transition at the end of the last piece.
    #[inline]
    fn transition(&mut self, _transition: &Transition<Q>) {}
}

/// The watcher that ignores pieces and transitions.
impl<Q: Coordinates> Watch<Q> for () {
    fn sees_pieces(&self) -> bool {
        false
    }
}

/// A watcher of transitions only.
impl<Q: Coordinates, F: FnMut(&Transition<Q>)> Watch<Q> for F {
    fn sees_pieces(&self) -> bool {
        false
    }

    fn transition(&mut self, transition: &Transition<Q>) {
        self(transition);
    }
}

/// Two watchers of the same motion.
impl<Q: Coordinates, A: Watch<Q> + ?Sized, B: Watch<Q> + ?Sized> Watch<Q> for (&mut A, &mut B) {
    fn sees_pieces(&self) -> bool {
        self.0.sees_pieces() || self.1.sees_pieces()
    }

    fn piece(&mut self, piece: &Piece<Q>) {
        self.0.piece(piece);
        self.1.piece(piece);
    }

    fn transition(&mut self, transition: &Transition<Q>) {
        self.0.transition(transition);
        self.1.transition(transition);
    }
}

/// A series of an output that is off by less than this part of its terms at its end has converged.
pub(crate) const CONVERGED: f64 = 1e-12;

/// How often an arc is halved before its outputs' series are taken as they are.
const FINEST_PART: u32 = 5;

/// A stretch of time without a transition.
#[derive(Clone, Copy, Debug)]
pub struct Piece<'a, Q: Coordinates = f64> {
    /// The motion at its start: time, state, and the phase that it is in throughout.
    pub before: &'a Motion<Q>,
    /// Duration of the piece, s.
    pub duration: f64,
    /// Load from the start of the piece on.
    pub load: LinearLoad<Q>,
    /// State at its end.
    pub end: State<Q>,
    pub(crate) level: &'a dyn Level<Q>,
    /// Polynomial of the piece; none if the engine leapt over the piece.
    pub(crate) arc: Option<&'a Arc<Q>>,
    pub(crate) room: &'a LeapRoom<Q>,
}

/// The part of an engine that watchers use when they ask for the polynomials of a leap.
#[derive(Debug, Default)]
pub(crate) struct LeapRoom<Q> {
    /// Polynomials that they may still ask for.
    pub left: Cell<u64>,
    /// The polynomial that they asked for last.
    arc: RefCell<Option<Box<Arc<Q>>>>,
}

impl<'p, Q: Coordinates> Piece<'p, Q> {
    /// The whole piece as a part.
    #[inline]
    pub(crate) fn whole(&self) -> PiecePart<'_, Q> {
        PiecePart { piece: self, start: (0.0, self.before.state) }
    }

    /// The motion of the piece as polynomials, in order of time.
    pub(crate) fn arcs(&self) -> Arcs<'_, Q> {
        self.whole().arcs()
    }

    /// The structure in `state`, `tau` seconds after the start of the piece, as outputs read it.
    #[inline]
    pub(crate) fn shown(&self, tau: f64, state: &State<Q>) -> Instant<'p, f64, Q> {
        shown::<Q>(self.level, self.before.phase, (state, self.load.at(tau)), self.before.kept())
    }

    /// What the edges of the base carry in `state`, `tau` seconds after the start of the piece.
    pub(crate) fn edges(&self, tau: f64, state: &State<Q>) -> Reactions {
        edges_of(self.level, self.before.phase, (state, self.load.at(tau)), self.before.kept())
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

    /// The motion at `time` (s), which lies within the piece.
    pub fn sample(&self, time: f64) -> Sample<'_, Q> {
        let end = self.before.time + self.duration;
        // an instant that misses the end by the clock's rounding is the end
        let is_before = time < end - 2.0 * f64::EPSILON * end.abs();
        let tau = if is_before { time - self.before.time } else { self.duration };
        let mut motion = Motion { time, state: self.state_at(tau), ..*self.before };
        if let Some((watched, arc)) = phases::of::<Q>(self.level.structure(), self.before).zip(self.arc) {
            let (level, side, contact) = (self.level, self.before.phase.side(), self.before.phase.contact());
            let step =
                Step { level, side, contact, start: &self.whole().step(), arc, reach: tau / arc.span, is_cut: false };
            let (moved, settled) = (watched.moved)(&step);
            motion.dissipators = moved.unwrap_or(motion.dissipators);
            motion.settled = settled.unwrap_or(motion.settled);
        }
        Sample { motion, load: self.load.at(tau), level: self.level }
    }
}

/// A part of a piece.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PiecePart<'a, Q: Coordinates = f64> {
    pub piece: &'a Piece<'a, Q>,
    /// Seconds from the piece's start to its own, and the state there.
    pub start: (f64, State<Q>),
}

impl<'a, Q: Coordinates> PiecePart<'a, Q> {
    /// The part as a step.
    #[inline]
    pub(crate) fn step(&self) -> Start<'a, Q> {
        let PiecePart { piece, start: (passed, state) } = *self;
        piece.level.subject().start(state, piece.before.kept(), piece.load.from(passed), piece.duration - passed)
    }

    /// The motion of the part as polynomials, in order of time.
    pub(crate) fn arcs(&self) -> Arcs<'a, Q> {
        Arcs { begin: self.start.0, left: Some(*self), arc: None, room: self.piece.room, evaluations: 0 }
    }

    /// Bounds of the magnitudes over this part.
    pub(crate) fn most(&self) -> Magnitudes<'a, Q> {
        let loads = [self.start.0, self.piece.duration].map(|tau| self.piece.load.at(tau));
        self.most_under(self.piece.level.structure(), &loads)
    }

    /// Bounds of the magnitudes over this part, with these `loads` at its ends.
    #[inline(always)]
    pub(crate) fn most_under(&self, structure: &Structure, loads: &[Load<Q>; 2]) -> Magnitudes<'a, Q> {
        let &PiecePart { piece, start: (from, _) } = self;
        match piece.arc {
            Some(arc) => Expansion { piece, from, arc }.most_under(structure, loads, &piece.end),
            None => {
                let phase = piece.before.phase;
                magnitudes(structure, phase, loads, piece.level.most(phase, &self.step(), &piece.end))
            }
        }
    }

    /// How far the motion of the part leaves the chords between its ends; none where no bound is known.
    pub(crate) fn off_chord(&self) -> Option<OffChord<Q>> {
        let &PiecePart { piece: &Piece { level, before, arc, ref end, .. }, start: (_, ref start) } = self;
        let thetas = [start.theta, end.theta];
        let Some(arc) = arc else {
            let step = self.step();
            let [u, u_dot, u_ddot, jerk] = level.swings(before.phase, &step)?;
            let per_bend = step.interval * step.interval / 8.0;
            let off =
                |swing: &Q, bend: &Q| Q::each(level.structure(), |j, _| off_chord(swing.of(j), [bend.of(j), per_bend]));
            return Some(OffChord::new(off(&u, &u_ddot), off(&u_dot, &jerk), 0.0, thetas));
        };
        Some(OffChord::of(arc, thetas))
    }
}

/// Goes through a part of a piece polynomial by polynomial.
#[derive(Debug)]
pub(crate) struct Arcs<'a, Q: Coordinates = f64> {
    /// Start of the part, s after the start of the piece.
    begin: f64,
    pub left: Option<PiecePart<'a, Q>>,
    /// Of a leap: the polynomial in hand.
    arc: Option<Box<Arc<Q>>>,
    room: &'a LeapRoom<Q>,
    /// Right-hand-side evaluations that the polynomials took.
    pub evaluations: u64,
}

impl<Q: Coordinates> Arcs<'_, Q> {
    /// The motion from where the last one ends on, as far as one polynomial reaches.
    pub(crate) fn next(&mut self) -> Option<Expansion<'_, Q>> {
        let part = self.left.take()?;
        let PiecePart { piece, start: (from, _) } = part;
        let until = piece.duration;
        if let Some(arc) = piece.arc {
            return Some(Expansion { piece, from, arc });
        }
        let LeapRoom { left, arc: spare } = piece.room;
        left.set(left.get().checked_sub(1)?);
        let arc = self.arc.get_or_insert_with(|| spare.take().unwrap_or_default());
        piece.level.series(piece.before.phase, &part.step(), arc);
        self.evaluations += arc.order as u64;
        let covered = arc.duration();
        if covered < until - from && from + covered > from {
            self.left = Some(PiecePart { piece, start: (from + covered, arc.end()) });
        }
        Some(Expansion { piece, from, arc })
    }
}

impl<Q: Coordinates> Drop for Arcs<'_, Q> {
    fn drop(&mut self) {
        if let Some(arc) = self.arc.take() {
            self.room.arc.replace(Some(arc));
        }
    }
}

impl<'a, Q: Coordinates> Arcs<'a, Q> {
    /// Leaves out the middle of what is left of a long leap of one mode.
    ///
    /// The motion in full contact is a line and a decaying vibration about the line. The magnitudes of the line and of the
    /// vibration are convex. Their sum is convex too, and the motion touches the sum once a period. The largest magnitude is therefore
    /// within a period of an end.
    pub(crate) fn skip_middle(&mut self) {
        let Some(part) = &mut self.left else { return };
        let &Piece { level, before: &Motion { phase, .. }, .. } = part.piece;
        let periods = 2.0 * TAU / level.structure().vibration().contact;
        let (passed, until) = (part.start.0, part.piece.duration);
        if !phase.properties().is_down
            || level.structure().modes().len() != 1
            || passed - self.begin < periods
            || until - passed <= 2.0 * periods
        {
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
pub(crate) struct Expansion<'a, Q: Coordinates = f64> {
    pub piece: &'a Piece<'a, Q>,
    /// Start of the polynomial, s after the start of the piece.
    pub from: f64,
    pub arc: &'a Arc<Q>,
}

impl<Q: Coordinates> Expansion<'_, Q> {
    /// The instant of `sigma`, s.
    pub(crate) fn time(&self, sigma: f64) -> f64 {
        self.piece.before.time + self.from + sigma * self.arc.span
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

impl<'a, Q: Coordinates> Expansion<'a, Q> {
    /// The structure at `sigma` as outputs read it.
    pub(crate) fn shown(&self, sigma: f64) -> Instant<'a, f64, Q> {
        self.piece.shown(self.from + sigma * self.arc.span, &self.arc.at(sigma))
    }

    /// The structure over the polynomial in power series, without sine and cosine unless it `turns`: only components are then known.
    pub(crate) fn over(&self, turns: bool) -> Instant<'a, Terms, Polynomials<'a, Q>> {
        let &Expansion { piece: &Piece { before, level, load, .. }, from, arc } = self;
        let (structure, phase, LinearLoad { value, slope }) = (level.structure(), before.phase, load.from(from));
        let (theta, theta_dot, turn) = if phase.properties().is_down {
            (Terms::constant(0.0), Terms::constant(0.0), Turn::none())
        } else {
            let [theta, theta_dot] = [&arc.theta, &arc.theta_dot].map(|of| Terms::of(of, arc.order));
            (theta, theta_dot, if turns { theta.turn() } else { Turn::none() })
        };
        let [u, u_dot] = [&arc.u, &arc.u_dot].map(|of| Polynomials::Motion(arc.used(of)));
        let a_g = Terms::ramp(value.a_g, slope.a_g * arc.span);
        let a_v = Terms::ramp(value.a_v, slope.a_v * arc.span);
        Instant {
            structure,
            s: phase.properties().pivot as f32,
            contact: phase.contact(),
            settled: Q::settlements(&before.settled),
            damping: structure.base().damping(phase),
            u,
            u_dot,
            theta,
            theta_dot,
            theta_ddot: theta_dot.slope(arc.span),
            turn,
            a_g: self.drive().map_or(a_g, |drive| a_g + drive),
            F_t: Polynomials::Load(Ramp { value: value.F_t, slope: slope.F_t }, arc.span),
            a_v: self.lift().map_or(a_v, |lift| a_v + lift),
        }
    }

    /// ÿ on ground that gives, m/s².
    pub(crate) fn lift(&self) -> Option<Terms> {
        Some(self.acceleration(Q::foundation(self.piece.level.structure())?.place))
    }

    /// ẍ of a base that may slide, m/s².
    pub(crate) fn drive(&self) -> Option<Terms> {
        let place = Q::foundation(self.piece.level.structure())?.slide()?;
        (self.piece.before.phase.contact().friction != Friction::Sticks).then(|| self.acceleration(place))
    }

    /// The acceleration of the lateral coordinate at this `place`.
    fn acceleration(&self, place: usize) -> Terms {
        Polynomials::Motion(self.arc.used(&self.arc.u_dot)).of(place).slope(self.arc.span)
    }

    /// Bounds of the magnitudes.
    pub(crate) fn most(&self) -> Magnitudes<'a, Q> {
        let loads = [self.from, self.from + self.arc.duration()].map(|tau| self.piece.load.at(tau));
        self.most_under(self.piece.level.structure(), &loads, &self.arc.end())
    }

    /// Bounds of the magnitudes, given the loads at both ends and the state at the last.
    #[inline(always)]
    fn most_under(&self, structure: &Structure, loads: &[Load<Q>; 2], end: &State<Q>) -> Magnitudes<'a, Q> {
        let &Expansion { piece, arc, .. } = self;
        let most = magnitudes(structure, piece.before.phase, loads, arc.most(end));
        let a_g = || Ramp { value: loads[0].a_g, slope: piece.load.slope.a_g };
        let has_feedthrough = structure.gauges().has_feedthrough;
        let needs_arc = has_feedthrough || Q::foundation(structure).is_some();
        let most_of = |of: Option<Terms>| of.map_or(0.0, |of| sum_of_magnitudes(of.used()));
        let [drive, lift] = match has_feedthrough {
            true => [most_of(self.drive()), most_of(self.lift())],
            false => [0.0; 2],
        };
        let arc = needs_arc.then(|| (arc, a_g(), Q::settlements(&piece.before.settled)));
        Magnitudes { arc, a_g: most.a_g + drive, a_v: most.a_v + lift, ..most }
    }

    /// Shows the series of outputs in σ, each with its polynomial. This polynomial is shown whole, or in parts if sin θ and cos θ need
    /// more terms than it has.
    pub(crate) fn series(&self, outputs: &[Output], show: &mut dyn FnMut(&Expansion<Q>, &[Terms])) {
        self.in_parts(&mut |part, is_finest| {
            let (over, end) = (part.over(true), part.shown(part.arc.reach));
            let series = |output: &Output| {
                let series = output.smooth(&over);
                let is_whole = is_finest || output.is_component();
                (is_whole || part.has_converged(&series, output.smooth(&end), CONVERGED)).then_some(series)
            };
            let Some(series) = outputs.iter().map(series).collect::<Option<Vec<_>>>() else { return false };
            show(part, &series);
            true
        });
    }
}
