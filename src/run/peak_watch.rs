//! The search for the peaks of a motion, piece by piece.
//!
//! A bound of a piece tells most of the time that it holds nothing larger than what has been seen. A piece that may hold more is
//! first kept, since most are soon beaten by the end of another.

use crate::engine::piece::{Piece, Room, Sample, Watch};
use crate::engine::{MOST_POLYNOMIALS, Moves};
use crate::series::taylor::{Arc, LONGEST_SPAN};
use crate::{Detail, LinearLoad, Motion, State, Structure, Transition};
use std::fmt::Debug;

/// How many pieces are kept at most.
const MOST_CANDIDATES: usize = 32;

/// Lateral coordinates of the structures whose peaks are found.
pub trait Peaked: Moves {
    /// Exact peaks of a motion.
    type Peaks: Clone + Debug;

    /// Bounds of the magnitudes over a piece.
    type Bounds: Debug;

    /// Peaks of `structure` at the level `detail` from `time` (s) on, before any motion.
    fn none(time: f64, structure: &Structure, detail: Detail) -> Self::Peaks;

    /// Whether `peaks` are of a motion that has begun.
    fn goes_on(peaks: &Self::Peaks) -> bool;

    /// Sees the ground acceleration `a_g` (m/s²) at `time` (s).
    fn see_ground(peaks: &mut Self::Peaks, a_g: f64, time: f64);

    /// Sees the values of `sample`, which need not be in a piece.
    fn see_instant(peaks: &mut Self::Peaks, sample: &Sample<Self>);

    /// Sees the values in `state`, `tau` seconds after the start of `piece`.
    fn see(peaks: &mut Self::Peaks, piece: &Piece<Self>, tau: f64, state: &State<Self>);

    /// Bounds that cost little.
    fn bounds(peaks: &Self::Peaks, piece: &Piece<Self>) -> Self::Bounds;

    /// Whether magnitudes within `bounds` may equal or exceed a peak.
    fn may_be_same(peaks: &Self::Peaks, bounds: &Self::Bounds) -> bool;

    /// Whether magnitudes within `bounds` at `time` (s) or later may change a peak.
    fn may_change(peaks: &Self::Peaks, bounds: &Self::Bounds, time: f64) -> bool;

    /// Looks for larger magnitudes between the ends of `piece`.
    fn look(peaks: &mut Self::Peaks, piece: &Piece<Self>);
}

/// Looks for peaks in the pieces of a motion.
#[derive(Debug)]
pub struct PeakWatch<'a, Q: Peaked = f64> {
    peaks: &'a mut Q::Peaks,
    /// Pieces that may hold more than what has been seen.
    kept: Vec<Candidate<Q>>,
    /// The level of the kept pieces, and room for their polynomials.
    level: Option<Box<Q::Level>>,
    room: Room<Q>,
    /// Whether the next piece may begin with other outputs than the last one ended with.
    is_torn: bool,
    /// Whether the next piece is the first since other peaks: the step of a host is often no more, and not put off.
    is_first: bool,
}

/// A piece that is looked at after others have been shown.
#[derive(Debug)]
struct Candidate<Q: Peaked> {
    bounds: Q::Bounds,
    before: Motion<Q>,
    duration: f64,
    load: LinearLoad<Q>,
    end: State<Q>,
    arc: Option<Box<Arc<Q>>>,
}

impl<'a, Q: Peaked> PeakWatch<'a, Q> {
    /// The watcher that searches for larger `peaks`.
    pub(super) fn new(peaks: &'a mut Q::Peaks) -> PeakWatch<'a, Q> {
        let is_first = Q::goes_on(peaks);
        PeakWatch { peaks, kept: Vec::new(), level: None, room: Room::default(), is_torn: true, is_first }
    }

    /// Peaks of the pieces so far.
    pub(super) fn so_far(&mut self) -> &Q::Peaks {
        self.look_back();
        self.peaks
    }

    /// Passes a piece with these `ends` if magnitudes within `bounds` certainly are no peaks. Otherwise the piece is to be shown.
    #[cfg(feature = "lanes")]
    #[inline]
    pub(super) fn passes(&mut self, bounds: &Q::Bounds, ends: [(f64, f64); 2]) -> bool {
        if Q::may_be_same(self.peaks, bounds) {
            return false;
        }
        ends.into_iter().for_each(|(time, a_g)| Q::see_ground(self.peaks, a_g, time));
        (self.is_torn, self.is_first) = (false, false);
        true
    }

    /// Looks at what has been kept, the latest first, which is often the largest.
    fn look_back(&mut self) {
        let Some(level) = &self.level else { return };
        while let Some(Candidate { bounds, before, duration, load, end, arc }) = self.kept.pop() {
            if Q::may_change(self.peaks, &bounds, before.time) {
                let (arc, room) = (arc.as_deref(), &self.room);
                room.left.set(MOST_POLYNOMIALS); // never used up: only short leaps are kept
                Q::look(self.peaks, &Piece { before: &before, duration, load, end, level, arc, room });
            }
        }
    }
}

impl<Q: Peaked> Drop for PeakWatch<'_, Q> {
    fn drop(&mut self) {
        self.look_back();
    }
}

impl<Q: Peaked> Watch<Q> for PeakWatch<'_, Q> {
    const SEES_PIECES: bool = true;

    fn piece(&mut self, piece: &Piece<Q>) {
        let &Piece { before, duration, load, end, level, arc, .. } = piece;
        for tau in [0.0, duration] {
            Q::see_ground(self.peaks, load.at(tau).a_g, before.time + tau);
        }
        let bounds = Q::bounds(self.peaks, piece);
        let [is_torn, is_first] = [&mut self.is_torn, &mut self.is_first].map(std::mem::take);
        if !Q::may_be_same(self.peaks, &bounds) {
            return;
        }
        if is_torn {
            Q::see(self.peaks, piece, 0.0, &before.state);
        }
        Q::see(self.peaks, piece, duration, &end);
        if !Q::may_change(self.peaks, &bounds, before.time) {
            return;
        }
        let is_long = arc.is_none() && duration * level.structure().vibration().rocking[1] > LONGEST_SPAN;
        if is_first || is_long {
            return Q::look(self.peaks, piece);
        }
        if self.kept.len() == MOST_CANDIDATES {
            self.kept.retain(|kept| Q::may_change(self.peaks, &kept.bounds, kept.before.time));
        }
        if self.kept.len() == MOST_CANDIDATES {
            self.look_back();
        }
        self.level.get_or_insert_with(|| Box::new(level.clone()));
        self.kept.push(Candidate { bounds, before: *before, duration, load, end, arc: arc.cloned().map(Box::new) });
    }

    fn transition(&mut self, _transition: &Transition<Q>) {
        self.is_torn = true;
    }
}
