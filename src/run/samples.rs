//! A motion at given instants, read from its pieces.

use crate::engine::Motion;
use crate::load::Load;
use crate::piece::{Piece, Watch};
use crate::{Engine, Outputs, Reactions};
use std::iter::Peekable;

/// The motion at one instant; at a transition, just after it.
#[derive(Clone, Copy, Debug)]
pub struct Sample {
    /// Time, state and phase, transitions and impulses so far.
    pub motion: Motion,
    /// What acts.
    pub load: Load,
    /// The outputs.
    pub outputs: Outputs,
    /// The reactions.
    pub reactions: Reactions,
}

/// Shows a motion at given instants.
pub(crate) struct Samples<Times: Iterator<Item = f64>, Show> {
    times: Peekable<Times>,
    show: Show,
    /// What acts at the end of the last piece.
    load: Load,
}

impl<Times: Iterator<Item = f64>, Show: FnMut(&Sample)> Samples<Times, Show> {
    pub(crate) fn new(times: impl IntoIterator<IntoIter = Times>, show: Show) -> Self {
        Samples { times: times.into_iter().peekable(), show, load: Load::default() }
    }

    /// Shows the end, where `engine` is.
    pub(crate) fn end(mut self, engine: &Engine) {
        let (motion, load) = (*engine.motion(), self.load);
        let (outputs, reactions) = (engine.outputs(load), engine.reactions(load));
        (self.show)(&Sample { motion, load, outputs, reactions });
    }
}

impl<Times: Iterator<Item = f64>, Show: FnMut(&Sample)> Watch for Samples<Times, Show> {
    const SEES_PIECES: bool = true;

    fn piece(&mut self, piece: &mut Piece) {
        let before = piece.before;
        self.load = piece.load.at(piece.duration);
        while let Some(time) = self.times.next_if(|time| *time < before.time + piece.duration) {
            let tau = time - before.time;
            if tau < 0.0 {
                continue;
            }
            let state = piece.state_at(tau);
            let (outputs, reactions) = piece.shown(&state, tau);
            let load = piece.load.at(tau);
            (self.show)(&Sample { motion: Motion { time, state, ..before }, load, outputs, reactions });
        }
    }
}
