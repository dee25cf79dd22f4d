//! A motion at given instants, read from its pieces.

use crate::engine::piece::{Piece, Sample, Watch};
use crate::mechanics::load::Load;
use crate::{Engine, engine::Moves};
use std::iter::Peekable;

/// Shows a motion at given instants.
pub(crate) struct Samples<Times: Iterator<Item = f64>, Show, Q> {
    times: Peekable<Times>,
    show: Show,
    /// Load at the end of the last piece.
    load: Load<Q>,
}

impl<Q: Moves, Times: Iterator<Item = f64>, Show: FnMut(&Sample<Q>)> Samples<Times, Show, Q> {
    pub(crate) fn new(times: impl IntoIterator<IntoIter = Times>, show: Show) -> Self {
        Samples { times: times.into_iter().peekable(), show, load: Load { a_g: 0.0, F_t: Q::ZERO, a_v: 0.0 } }
    }

    /// Shows the end, where `engine` is.
    pub(crate) fn end(mut self, engine: &Engine<Q>) {
        (self.show)(&engine.sample(self.load));
    }
}

impl<Q: Moves, Times: Iterator<Item = f64>, Show: FnMut(&Sample<Q>)> Watch<Q> for Samples<Times, Show, Q> {
    const SEES_PIECES: bool = true;

    fn piece(&mut self, piece: &Piece<Q>) {
        let start = piece.before.time;
        self.load = piece.load.at(piece.duration);
        while let Some(time) = self.times.next_if(|time| *time < start + piece.duration) {
            if time >= start {
                (self.show)(&piece.sample(time));
            }
        }
    }
}
