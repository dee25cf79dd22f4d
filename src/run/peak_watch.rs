//! The search for the peaks of a motion, piece by piece.
//!
//! A bound of a piece tells most of the time that it holds nothing larger than what has been seen. A piece that may hold more is
//! first kept, since most are soon beaten by the end of another.

use super::peaks::Peaks;
use crate::engine::MOST_POLYNOMIALS;
use crate::engine::piece::{LeapRoom, Piece, Watch};
use crate::levels::level::Level;
use crate::mechanics::arc::Arc;
use crate::mechanics::lateral::Coordinates;
use crate::series::taylor::LONGEST_SPAN;
use crate::structure::gauge::Reach;
use crate::{LinearLoad, Motion, State, Transition};

/// How many pieces are kept before those that have been beaten are dropped, and how many at most.
const CANDIDATES: usize = 32;
const MOST_CANDIDATES: usize = 256;

/// After so many pieces whose bounds were found in vain the common reach is found again, which takes about as long as one of them.
const IN_VAIN: u32 = 4;

/// Looks for peaks in the pieces of a motion.
#[derive(Debug)]
pub struct PeakWatch<Q: Coordinates = f64> {
    pub(super) peaks: Peaks,
    /// Pieces that may hold more than what has been seen.
    kept: Vec<Candidate<Q>>,
    /// Polynomials and bounds of pieces that are kept no more.
    pub(super) spare: (Vec<Box<Arc<Q>>>, Vec<Vec<f64>>),
    /// The level of the kept pieces, and room for their polynomials.
    level: Option<Box<dyn Level<Q>>>,
    room: LeapRoom<Q>,
    /// Whether the next piece may begin with other outputs than the last one ended with.
    pub(super) is_torn: bool,
    /// Room for the bounds of a piece.
    bounds: Vec<f64>,
    /// Of many masses: how far all that is searched reaches, in these or earlier peaks, and how many pieces needed the bounds of all
    /// outputs in vain.
    reach: Option<Box<Reach>>,
    in_vain: u32,
    /// Whether the next piece is the first since other peaks: the step of a host is often no more, and not put off.
    pub(super) is_first: bool,
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
    /// The watcher that searches the pieces of a motion for larger peaks; [`PeakWatch::end`] gives the peaks back.
    pub fn watch<Q: Coordinates>(self) -> PeakWatch<Q> {
        let is_first = self.goes_on();
        PeakWatch {
            peaks: self,
            kept: Vec::new(),
            spare: (Vec::new(), Vec::new()),
            level: None,
            room: LeapRoom::default(),
            bounds: Vec::new(),
            reach: None,
            in_vain: 0,
            is_torn: true,
            is_first,
        }
    }
}

impl<Q: Coordinates> PeakWatch<Q> {
    /// Peaks of the pieces so far.
    pub(super) fn so_far(&mut self) -> &Peaks {
        self.look_back();
        &self.peaks
    }

    /// The peaks, once the motion has been watched.
    pub fn end(mut self) -> Peaks {
        self.look_back();
        self.peaks
    }

    /// Sees all of a `piece` but the forces of dissipators.
    fn see(&mut self, piece: &Piece<Q>) {
        let &Piece { duration, ref load, level, arc, .. } = piece;
        let (loads, structure) = ([load.value, load.at(duration)], level.structure());
        let [is_torn, is_first] = [&mut self.is_torn, &mut self.is_first].map(std::mem::take);
        let most = piece.whole().most_under(structure, &loads);
        if self.reach.as_ref().is_some_and(|reach| reach.bound_together(&most) < 1.0) {
            return;
        }
        if !self.peaks.may_be_same(structure, &most) {
            self.in_vain += 1;
            if !Q::IS_ONE && self.in_vain.is_multiple_of(IN_VAIN) {
                self.reach = self.peaks.reach(structure).map(Box::new);
            }
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
        let bounds = std::mem::replace(&mut self.bounds, self.spare.1.pop().unwrap_or_default());
        self.keep(piece, bounds);
    }

    /// Looks at what has been kept, first where most may be more than its peak.
    fn look_back(&mut self) {
        let Some(level) = &self.level else { return };
        self.kept.sort_by_cached_key(|kept| self.peaks.over(&kept.bounds).to_bits());
        while let Some(mut kept) = self.kept.pop() {
            if self.peaks.may_change_within(&kept.bounds, kept.before.time) {
                self.room.left.set(MOST_POLYNOMIALS); // never used up: only short leaps are kept
                self.peaks.look(&kept.piece(&**level, &self.room), &kept.bounds);
            }
            kept.put_by(&mut self.spare);
        }
    }

    /// Keeps a piece that may change a peak within these `bounds`.
    pub(super) fn keep(&mut self, piece: &Piece<Q>, bounds: Vec<f64>) {
        let &Piece { before, duration, load, end, level, arc, .. } = piece;
        self.level.get_or_insert_with(|| level.boxed());
        if !self.kept.is_empty() && self.kept.len().is_multiple_of(CANDIDATES) {
            let (peaks, spare) = (&self.peaks, &mut self.spare);
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
        self.kept.push(Candidate { before: *before, duration, load, end, arc, bounds });
    }
}

impl<Q: Coordinates> Candidate<Q> {
    fn piece<'a>(&'a self, level: &'a dyn Level<Q>, room: &'a LeapRoom<Q>) -> Piece<'a, Q> {
        let &Candidate { ref before, duration, load, end, ref arc, .. } = self;
        Piece { before, duration, load, end, level, arc: arc.as_deref(), room }
    }

    /// Puts the polynomial and the bounds by for another piece.
    fn put_by(&mut self, (arcs, bounds): &mut (Vec<Box<Arc<Q>>>, Vec<Vec<f64>>)) {
        arcs.extend(self.arc.take());
        bounds.push(std::mem::take(&mut self.bounds));
    }
}

impl<Q: Coordinates> Watch<Q> for PeakWatch<Q> {
    fn piece(&mut self, piece: &Piece<Q>) {
        if piece.level.structure().base().has_dissipators() {
            self.peaks.look_at_dissipators(piece);
        }
        if !(self.peaks.is_of_theta() && piece.before.phase.properties().is_down) {
            self.see(piece);
        }
    }

    fn transition(&mut self, _transition: &Transition<Q>) {
        self.is_torn = true;
    }
}
