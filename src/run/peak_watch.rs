//! The search for the peaks of a motion, piece by piece.
//!
//! A bound of a piece tells most of the time that it holds nothing larger than what has been seen. A piece that may hold more is
//! first kept, since most are soon beaten by the end of another.

use super::peaks::Peaks;
use crate::engine::MOST_POLYNOMIALS;
use crate::engine::piece::{Piece, Room, Watch};
use crate::levels::level::Level;
use crate::mechanics::lateral::Coordinates;
use crate::series::taylor::{Arc, LONGEST_SPAN};
use crate::{LinearLoad, Motion, State, Transition};

/// How many pieces are kept at most.
const MOST_CANDIDATES: usize = 32;

/// Looks for peaks in the pieces of a motion.
#[derive(Debug)]
pub struct PeakWatch<'a, Q: Coordinates = f64> {
    pub(super) peaks: &'a mut Peaks,
    /// Pieces that may hold more than what has been seen.
    kept: Vec<Candidate<Q>>,
    /// Polynomials and bounds of pieces that are kept no more.
    spare: (Vec<Box<Arc<Q>>>, Vec<Vec<f64>>),
    /// The level of the kept pieces, and room for their polynomials.
    level: Option<Box<dyn Level<Q>>>,
    room: Room<Q>,
    /// Whether the next piece may begin with other outputs than the last one ended with.
    is_torn: bool,
    /// Room for the bounds of a piece.
    bounds: Vec<f64>,
    /// Whether the next piece is the first since other peaks: the step of a host is often no more, and not put off.
    is_first: bool,
}

/// A piece that is looked at after others have been shown.
#[derive(Debug)]
struct Candidate<Q: Coordinates> {
    before: Motion<Q>,
    duration: f64,
    load: LinearLoad<Q>,
    end: State<Q>,
    arc: Option<Box<Arc<Q>>>,
    /// Bounds of what is searched.
    bounds: Vec<f64>,
}

impl Peaks {
    /// The watcher that searches the pieces of a motion for larger peaks. The peaks are complete once the watcher is dropped.
    pub fn watch<Q: Coordinates>(&mut self) -> PeakWatch<'_, Q> {
        let is_first = self.goes_on();
        PeakWatch {
            peaks: self,
            kept: Vec::new(),
            spare: (Vec::new(), Vec::new()),
            level: None,
            room: Room::default(),
            bounds: Vec::new(),
            is_torn: true,
            is_first,
        }
    }
}

impl<Q: Coordinates> PeakWatch<'_, Q> {
    /// Peaks of the pieces so far.
    pub(super) fn so_far(&mut self) -> &Peaks {
        self.look_back();
        self.peaks
    }

    /// Passes a piece that holds no peak.
    #[cfg(feature = "lanes")]
    #[inline]
    pub(super) fn pass(&mut self) {
        (self.is_torn, self.is_first) = (false, false);
    }

    /// Looks at what has been kept, the latest first, which is often the largest.
    fn look_back(&mut self) {
        let Some(level) = &self.level else { return };
        while let Some(mut kept) = self.kept.pop() {
            if self.peaks.may_change_within(&kept.bounds, kept.before.time) {
                self.room.left.set(MOST_POLYNOMIALS); // never used up: only short leaps are kept
                self.peaks.look(&kept.piece(&**level, &self.room), &kept.bounds);
            }
            kept.put_by(&mut self.spare);
        }
    }
}

impl<Q: Coordinates> Candidate<Q> {
    fn piece<'a>(&'a self, level: &'a dyn Level<Q>, room: &'a Room<Q>) -> Piece<'a, Q> {
        let &Candidate { ref before, duration, load, end, ref arc, .. } = self;
        Piece { before, duration, load, end, level, arc: arc.as_deref(), room }
    }

    /// Puts the polynomial and the bounds by for another piece.
    fn put_by(&mut self, (arcs, bounds): &mut (Vec<Box<Arc<Q>>>, Vec<Vec<f64>>)) {
        arcs.extend(self.arc.take());
        bounds.push(std::mem::take(&mut self.bounds));
    }
}

impl<Q: Coordinates> Drop for PeakWatch<'_, Q> {
    fn drop(&mut self) {
        self.look_back();
    }
}

impl<Q: Coordinates> Watch<Q> for PeakWatch<'_, Q> {
    fn piece(&mut self, piece: &Piece<Q>) {
        let &Piece { before, duration, ref load, ref end, level, arc, .. } = piece;
        let (until, loads, structure) = (before.time + duration, [load.value, load.at(duration)], level.structure());
        self.peaks.see_ground(loads[0].a_g, before.time);
        self.peaks.see_ground(loads[1].a_g, until);
        if structure.base().has_dissipators() {
            self.peaks.look_at_dissipators(piece);
        }
        let [is_torn, is_first] = [&mut self.is_torn, &mut self.is_first].map(std::mem::take);
        let most = piece.whole().most_under(structure, &loads);
        if !self.peaks.may_be_same(structure, &most) {
            return;
        }
        let is_long = arc.is_none() && duration * structure.vibration().rocking[1] > LONGEST_SPAN;
        let is_now = is_first || is_long;
        self.bounds.clear();
        if !self.peaks.see_ends(piece, is_torn, &most, (!is_now).then_some(&mut self.bounds)) {
            return;
        }
        if is_now {
            return self.peaks.look(piece, &[]);
        }
        self.level.get_or_insert_with(|| level.boxed());
        if self.kept.len() == MOST_CANDIDATES {
            let (peaks, spare) = (&*self.peaks, &mut self.spare);
            self.kept.retain_mut(|kept| {
                let stays = peaks.may_change_within(&kept.bounds, kept.before.time);
                if !stays {
                    kept.put_by(spare);
                }
                stays
            });
        }
        if self.kept.len() == MOST_CANDIDATES {
            self.look_back();
        }
        let arc = arc.map(|arc| {
            let mut own = self.spare.0.pop().unwrap_or_default();
            own.be(arc);
            own
        });
        let bounds = std::mem::replace(&mut self.bounds, self.spare.1.pop().unwrap_or_default());
        self.kept.push(Candidate { before: *before, duration, load: *load, end: *end, arc, bounds });
    }

    fn transition(&mut self, _transition: &Transition<Q>) {
        self.is_torn = true;
    }
}
