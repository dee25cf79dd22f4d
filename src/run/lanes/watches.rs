//! What watchers of runs that step together seek, and the samples that these runs go through.

use crate::engine::lanes::number::put;
use crate::engine::lanes::rocking::SegmentEnds;
use crate::engine::lanes::sought::{Passes, Sought};
use crate::mechanics::lateral::Coordinates;
use crate::run::fall::FallWatch;
use crate::run::ground_motion::{GroundMotion, Segments};
use crate::run::peaks::Searched;
use crate::{Engine, Piece};

impl<'a> Segments<'a> {
    /// The samples that end whole segments, and those before them, unless the ground moves vertically.
    #[inline]
    pub(super) fn samples(&self) -> Option<SegmentEnds<'a>> {
        let &Segments { motion: GroundMotion { record, .. }, next, last, .. } = self;
        let (a_g, last) = (record.acceleration(), last.min(record.acceleration().len()));
        let samples = SegmentEnds { times: record.times(), a_g, next, last };
        (next < last && record.vertical().is_none()).then_some(samples)
    }
}

impl<Q: Coordinates> Passes<Q> for FallWatch<Q> {
    fn seek(&self, engine: &Engine<Q>, lane: usize, sought: &mut Sought<Q>) {
        let (structure, phase) = (engine.structure(), engine.motion().phase);
        let quantity = |of: &Searched| {
            let reach = &structure.reaches()[of.place];
            let (turn, elastic) = reach.weights(of.output, structure, phase);
            (of.peak.least(), turn, if reach.is_curved { f64::INFINITY } else { 0.0 }, elastic)
        };
        sought.seek((lane, structure.modes().len()), self.all.peaks.searched.iter().map(quantity));
        let angle = self.no_return.unwrap_or(f64::INFINITY);
        put(&mut sought.turned, lane, if self.fall.is_some() { [angle, f64::INFINITY] } else { [-1.0, angle] });
    }

    #[inline(always)]
    fn pass(&mut self) {
        (self.all.is_torn, self.all.is_first) = (false, false);
    }

    fn put_off(&mut self, piece: &Piece<Q>, bounds: &[f64]) {
        let (&Piece { before, duration, ref end, .. }, all) = (piece, &mut self.all);
        if std::mem::take(&mut all.is_torn) {
            all.peaks.see(&piece.shown(0.0, &before.state), before.time);
        }
        all.is_first = false;
        all.peaks.see(&piece.shown(duration, end), before.time + duration);
        if all.peaks.may_change_within(bounds, before.time) {
            let mut own = all.spare.1.pop().unwrap_or_default();
            own.clear();
            own.extend(bounds);
            all.keep(piece, own);
        }
    }
}
