//! A motion at given instants, read from its pieces.

use crate::engine::piece::{Piece, Watch};
use crate::engine::sample::Sample;
use crate::levels::level::Level;
use crate::mechanics::lateral::Coordinates;
use crate::mechanics::load::Load;
use crate::{Engine, Motion};
use std::iter::Peekable;

/// Shows a motion at given instants, none of which is before the start. A piece lasts until the next one begins: its own end, start
/// plus duration, misses this instant by the rounding of the clock.
pub(crate) struct Sampler<Times: Iterator<Item = f64>, Show, Q: Coordinates> {
    times: Peekable<Times>,
    show: Show,
    /// Motion and load at the end of the last piece.
    last: Option<Motion<Q>>,
    load: Load<Q>,
}

impl<Q: Coordinates, Times: Iterator<Item = f64>, Show: FnMut(&Sample<Q>)> Sampler<Times, Show, Q> {
    pub(crate) fn new(times: Times, show: Show) -> Self {
        Sampler { times: times.peekable(), show, last: None, load: Load::NONE }
    }

    /// Shows the instants before `time` (s) that are left, at the end of the last piece.
    fn until(&mut self, time: f64, level: &dyn Level<Q>) {
        let Some(last) = self.last else { return };
        while let Some(time) = self.times.next_if(|next| *next < time) {
            (self.show)(&Sample { motion: Motion { time, ..last }, load: self.load, level });
        }
    }

    /// Shows the end, where `engine` is.
    pub(crate) fn end(mut self, engine: &Engine<Q>) {
        let end = engine.sample(self.load);
        self.until(end.motion.time, end.level);
        (self.show)(&end);
    }
}

impl<Q: Coordinates, Times: Iterator<Item = f64>, Show: FnMut(&Sample<Q>)> Watch<Q> for Sampler<Times, Show, Q> {
    fn piece(&mut self, piece: &Piece<Q>) {
        self.until(piece.before.time, piece.level);
        let end = piece.before.time + piece.duration;
        let certain = end - 2.0 * f64::EPSILON * end.abs();
        while let Some(time) = self.times.next_if(|time| *time < certain) {
            (self.show)(&piece.sample(time));
        }
        let Sample { motion, load, .. } = piece.sample(end);
        (self.last, self.load) = (Some(motion), load);
    }
}
