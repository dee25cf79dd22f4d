//! A motion at given instants, read from its pieces.

use crate::Engine;
use crate::engine::piece::{Piece, Sample, Watch};
use crate::mechanics::load::Load;
use std::iter::Peekable;

/// Shows a motion at given instants.
pub(crate) struct Samples<Times: Iterator<Item = f64>, Show> {
    times: Peekable<Times>,
    show: Show,
    /// Load at the end of the last piece.
    load: Load,
}

impl<Times: Iterator<Item = f64>, Show: FnMut(&Sample)> Samples<Times, Show> {
    pub(crate) fn new(times: impl IntoIterator<IntoIter = Times>, show: Show) -> Self {
        Samples { times: times.into_iter().peekable(), show, load: Load::default() }
    }

    /// Shows the end, where `engine` is.
    pub(crate) fn end(mut self, engine: &Engine) {
        (self.show)(&engine.sample(self.load));
    }
}

impl<Times: Iterator<Item = f64>, Show: FnMut(&Sample)> Watch for Samples<Times, Show> {
    const SEES_PIECES: bool = true;

    fn piece(&mut self, piece: &Piece) {
        let start = piece.before.time;
        self.load = piece.load.at(piece.duration);
        while let Some(time) = self.times.next_if(|time| *time < start + piece.duration) {
            if time >= start {
                (self.show)(&piece.sample(time));
            }
        }
    }
}
